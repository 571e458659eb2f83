"""K_v over speed with errors of teeth, drawn many times: of a System whose nominal teeth are known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.deviations import ErrorDistribution
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.tooth_errors.result import ErrorStudy, ToothLaw
from gearcad.dynamics.tooth_errors.sampling import Run, Sampling
from gearcad.dynamics.tooth_errors.sources import assumptions, with_short_period
from gearcad.dynamics.tooth_errors.teeth import Draw, MeshTeeth
from gearcad.dynamics.trains.system import System
from gearcad.errors import ParameterError
from gearcad.notice import Notice

__all__ = ["ErrorPlan", "errors_seconds", "study_errors"]


@dataclass(frozen=True, kw_only=True)
class ErrorPlan:
    """How errors are drawn: `samples` of a `distribution` by a `seed`, for an accuracy `grade`; None where teeth have none."""

    law: ToothLaw
    samples: int
    distribution: ErrorDistribution
    seed: int
    grade: int | None


def study_errors(
    system: System,
    excitation: Excitation,
    teeth: Sequence[MeshTeeth],
    speeds: Floats,
    pinion_teeth: int,
    plan: ErrorPlan,
    tell: Callable[[float], None] = lambda _part: None,
) -> ErrorStudy:
    """At rising speeds (s,) in rpm of the first pinion, which has so many teeth; `excitation` is that of nominal teeth.

    Raises ParameterError where all speeds are too low, GeometryError and SolverError.
    """
    sampling, samples = _sampling(system, excitation, teeth, plan)
    draws: list[Draw | None] = [Draw(plan.distribution, plan.seed, number) for number in range(samples)]
    frequencies = speeds * pinion_teeth / 60
    quick = frequencies >= sampling.lowest
    if not quick.any():
        least = sampling.lowest * 60 / pinion_teeth
        permitted = (
            f"must be above {least:.4g} rpm: below, teeth ring out long before the next pair comes, and nothing is drawn"
        )
        raise ParameterError("speed_to", float(speeds[-1]), permitted, "rpm")
    found = sampling.run(frequencies[quick], [None, *draws], tell)
    return _study(sampling, plan, speeds[quick], found, (*_left_out(speeds[quick], speeds), *_assumed(sampling)))


def errors_seconds(
    system: System, excitation: Excitation, teeth: Sequence[MeshTeeth], speeds: Floats, pinion_teeth: int, plan: ErrorPlan
) -> float:
    """Return the CPU seconds that `study_errors` takes, about."""
    sampling, samples = _sampling(system, excitation, teeth, plan)
    frequencies = speeds * pinion_teeth / 60
    return sampling.seconds(frequencies[frequencies >= sampling.lowest], samples + 1)


def _sampling(system: System, excitation: Excitation, teeth: Sequence[MeshTeeth], plan: ErrorPlan) -> tuple[Sampling, int]:
    """What is run, and how many samples: teeth that have no errors are all alike."""
    kept = with_short_period(teeth, [mesh.frequency_ratio for mesh in excitation.meshes])
    sampling = Sampling(system=system, excitation=excitation, teeth=kept, law=plan.law)
    return sampling, plan.samples if any(not each.exact for each in teeth) else 1


def _assumed(sampling: Sampling) -> tuple[Notice, ...]:
    law = assumptions(sampling.teeth, sampling.forces, sampling.excitation.backlashes)
    return (*law, *_hardly_damped(sampling))


def _study(sampling: Sampling, plan: ErrorPlan, speeds: Floats, found: Run, assumed: tuple[Notice, ...]) -> ErrorStudy:
    """The first sample is that without errors."""
    return ErrorStudy(
        law=plan.law,
        speeds=speeds,
        factors=np.moveaxis(found.factors[:, 1:], 0, 1),
        nominal=found.factors[:, 0],
        settled=found.settled[:, 1:].T,
        nominal_settled=found.settled[:, 0],
        teeth=sampling.looked_at,
        whole=sampling.whole,
        grade=plan.grade,
        distribution=plan.distribution,
        seed=plan.seed,
        mesh_names=sampling.system.names[0],
        assumed=assumed,
    )


def _left_out(kept: Floats, asked: Floats) -> tuple[Notice, ...]:
    if len(kept) == len(asked):
        return ()
    text = (
        f"tooth errors were drawn from {kept[0]:.4g} rpm on: below, the vibration of the teeth would have to be followed"
        " hundreds of times from one pair to the next, and it has died away long before"
    )
    return (Notice("errors-from-speed", text),)


def _hardly_damped(sampling: Sampling) -> tuple[Notice, ...]:
    if not sampling.hardly_damped:
        return ()
    decay = "never" if sampling.decay <= 0 else f"only in {1 / sampling.decay:.3g} s, to a third,"
    text = (
        f"vibrations that the teeth feel die away {decay} longer than was waited for: with tooth errors the start is still seen"
    )
    return (Notice("errors-hardly-damped", text),)

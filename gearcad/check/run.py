"""The structural check of a pair: one mesh cycle by finite elements, refined to tell its error, and judged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.check.comparison import Comparison
from gearcad.check.convergence import Convergence, study_convergence
from gearcad.check.judge import compare
from gearcad.check.options import CheckOptions
from gearcad.check.summary import Summary, figures, summarise
from gearcad.errors import GeometryError, ParameterError
from gearcad.fea.cycle import Cycle, run_cycle, single_stiffness
from gearcad.fea.flexible_pair import FlexiblePair, flexible_pair
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating import Rating, rate

__all__ = ["CheckResult", "Progress", "SweepPoint", "check_pair"]

Floats = NDArray[np.float64]

Progress = Callable[[str, int, int], None]
"""Called with what is being done, how many steps are done, and how many there are."""

_STEPS = ("mesh cycle", "convergence", "torque sweep", "rating")
_SWEEP_POSITIONS = 12
_SWEEP = (0.1, 0.3, 0.55, 0.77, 1.0)
"""Torques of the sweep, as parts of the load's."""


@dataclass(frozen=True)
class SweepPoint:
    """One torque (N·m on the pinion) of the sweep: mean mesh stiffness (N/(mm µm)), and M/phi of each gear (N·m/rad)."""

    torque: float
    mesh_stiffness: float
    contact_pressure: float
    root_tension: tuple[float, float]
    torsional_stiffness: tuple[float, float]

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        named = {"torque": self.torque, "mesh_stiffness": self.mesh_stiffness, "contact_pressure": self.contact_pressure}
        for name, values in (("root_tension", self.root_tension), ("torsional_stiffness", self.torsional_stiffness)):
            named |= {f"{name}_{gear}": value for gear, value in zip(("pinion", "wheel"), values, strict=True)}
        return named


@dataclass(frozen=True, kw_only=True)
class CheckResult:
    """Everything the check found out; `pair` is as mounted."""

    pair: GearPair
    material: Material
    load: Load
    mounting: Mounting
    options: CheckOptions
    cycle: Cycle
    summary: Summary
    sweep: tuple[SweepPoint, ...]
    convergence: tuple[Convergence, ...]
    rating: Rating
    comparisons: tuple[Comparison, ...]
    warnings: tuple[str, ...]

    @property
    def bodies(self) -> dict[str, str]:
        """How each body is taken, in words."""
        gears = {"pinion": self.pair.pinion, "wheel": self.pair.wheel}
        diameters = self.options.body.inner_diameters
        return {
            name: self.options.body.describe(gear, inner) for (name, gear), inner in zip(gears.items(), diameters, strict=True)
        }

    @property
    def passed(self) -> bool:
        """True if every gate is passed."""
        return all(comparison.passed for comparison in self.comparisons if comparison.role.value == "gate")


def check_pair(
    pair: GearPair,
    material: Material,
    load: Load,
    options: CheckOptions | None = None,
    progress: Progress | None = None,
    mounting: Mounting | None = None,
) -> CheckResult:
    """Check a pair under a load, in the transverse section through the middle of its common face width.

    Raises ParameterError and GeometryError for input that cannot be checked, SolverError where a solver fails.
    """
    options, mounting = options or CheckOptions(), mounting or Mounting()
    pair = mounting.mounted(pair)
    torque = load.torque * load.application_factor
    _require_meshing(pair, torque)
    tell = _teller(progress)
    tell("mesh cycle")
    model = flexible_pair(pair, material, plane=options.plane_state, body=options.body, pitch_error=mounting.pitch_error)
    cycle = run_cycle(model, torque, options.positions)
    summary = summarise(cycle, single_stiffness(model, torque))
    tell("convergence")
    convergence = study_convergence(model, material, options, torque)
    tell("torque sweep")
    sweep = tuple(_sweep_point(model, each) for each in options.torques or tuple(part * abs(torque) for part in _SWEEP))
    tell("rating")
    rating = rate(pair, material, load)
    comparisons = compare(cycle, summary, convergence, rating, material, options)
    return CheckResult(
        pair=pair,
        material=material,
        load=load,
        mounting=mounting,
        options=options,
        cycle=cycle,
        summary=summary,
        sweep=sweep,
        convergence=convergence,
        rating=rating,
        comparisons=comparisons,
        warnings=_warnings(cycle, summary, options, mounting),
    )


def _teller(progress: Progress | None) -> Callable[[str], None]:
    return lambda step: progress(step, _STEPS.index(step), len(_STEPS)) if progress is not None else None


def _require_meshing(pair: GearPair, torque: float) -> None:
    """Raise for what a plane contact analysis can make no sense of."""
    if pair.pinion.helix_angle:
        permitted = "needs --model 3d, which is not there yet: the lines of contact of helical teeth run across the flank"
        raise GeometryError("pair.helix_angle", pair.pinion.helix_angle, permitted, "deg")
    if not torque:
        raise ParameterError("load.torque", torque, "must not be 0: without torque there is nothing to check", "N·m")
    if pair.transverse_contact_ratio < 1:
        ratio = pair.transverse_contact_ratio
        raise GeometryError("pair.transverse_contact_ratio", ratio, "must be at least 1: the teeth lose each other")


def _sweep_point(model: FlexiblePair, torque: float) -> SweepPoint:
    cycle = run_cycle(model, torque, _SWEEP_POSITIONS)
    few = figures(cycle)
    turns = np.array([position.approach_parts for position in cycle.positions]).mean(axis=0)
    # A gear whose flank gives way by u along the line of action turns by u/r_b under the torque F r_b.
    radii = np.array([model.pair.pinion.base_diameter, model.pair.wheel.base_diameter]) / 2
    force = model.force(torque) * model.width
    first, second = (force * radii**2 / turns / 1000).tolist()
    return SweepPoint(torque, few.mesh_stiffness, few.contact_pressure, few.root_tension, (first, second))


def _warnings(cycle: Cycle, summary: Summary, options: CheckOptions, mounting: Mounting) -> tuple[str, ...]:
    pair = cycle.model.pair
    gears = (("pinion", pair.pinion), ("wheel", pair.wheel))
    found = list(pair.warnings)
    strain = summary.contact_pressure / cycle.model.modulus
    if strain > 0.03:
        found.append(f"the contact pressure is {strain:.1%} of the modulus: linear elasticity means little there")
    if summary.corner_positions:
        found.append(
            f"a tip corner touches at {summary.corner_positions} of {len(cycle.positions)} positions: its pressure depends on "
            "the mesh and is left out; tip relief would avoid it"
        )
    left_out = [f"the {name}'s modifications along the face width" for name, gear in gears if gear.modification.along_face]
    left_out += ["the misalignment"] if mounting.misalignment or mounting.misalignment_across else []
    if left_out:
        found.append(f"the plane model leaves out {' and '.join(left_out)}; --model 3d has them")
    inner_diameters = options.body.inner_diameters
    for place, (name, gear) in enumerate(gears):
        hub = (cycle.model.pinion, cycle.model.wheel)[place].hub_radius
        rim = gear.root_diameter / 2 - hub
        if rim < (gear.tip_diameter - gear.root_diameter) / 2:
            found.append(f"the {name}'s rim below the root ({rim:.3g} mm) is thinner than its teeth are high")
        if not gear.body.bore and inner_diameters[place] is None:
            found.append(f"the {name} has no bore: its body is taken as held on diameter {2 * hub:.6g} mm")
    return tuple(found)

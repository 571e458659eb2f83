"""The Campbell study of a pair: its motion at each speed, on all cores."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from gearcad.dynamics.tooth_springs.campbell_study import CampbellStudy
from gearcad.dynamics.tooth_springs.contact_model import ContactModel
from gearcad.dynamics.tooth_springs.history import Start
from gearcad.dynamics.tooth_springs.motion import checked_samples, time_history
from gearcad.dynamics.tooth_springs.speed_spectra import SpeedRow
from gearcad.errors import ParameterError, require_number
from gearcad.threads import on_all_cores

__all__ = ["campbell"]


HIGHEST_FREQUENCY = 15000.0
"""Default end of the spectra (Hz): twice the tooth frequency of the thesis's fastest speed, and more."""


def campbell(
    model: ContactModel,
    speeds: ArrayLike,
    *,
    duration: float = 1.0,
    sampling: float = 200000.0,
    highest_frequency: float = HIGHEST_FREQUENCY,
    start: Start | None = None,
    counted: Callable[[int, int], None] = lambda _done, _count: None,
) -> CampbellStudy:
    """The motion at each speed (rpm, rising, not negative) from the same start, on all cores; each speed by itself.

    `counted` hears how many speeds are done, and of how many.
    """
    checked = _checked_speeds(np.atleast_1d(np.asarray(speeds, float)).tolist())
    checked_samples(duration, sampling)
    require_number("highest_frequency", highest_frequency, "Hz", above=0)

    def row(speed: float) -> SpeedRow:
        motion = time_history(model, speed, duration=duration, sampling=sampling, start=start)
        settled = motion.settled
        return SpeedRow(
            motion.spectrum(highest_frequency).amplitude,
            motion.approach_spectrum(highest_frequency).amplitude,
            float(settled.mean()),
            float(settled.max()),
            float(motion.approach.max()),
            motion.out_of_contact,
            motion.growth,
            motion.digits_lost,
            motion.chaotic,
        )

    # Integration and FFT leave the interpreter to other threads: no motion is held longer than its row takes.
    rows = on_all_cores(row, checked, counted)
    columns = {name: np.array(values) for name, values in zip(SpeedRow._fields, zip(*rows, strict=True), strict=True)}
    frequency = np.arange(columns["approach"].shape[1]) * (sampling / checked_samples(duration, sampling))
    arrays = {"speeds": np.array(checked), "frequency": frequency, **columns}
    for array in arrays.values():
        array.flags.writeable = False
    return CampbellStudy(model=model, duration=float(duration), sampling=float(sampling), **arrays)


def _checked_speeds(speeds: Sequence[float]) -> Sequence[float]:
    if len(speeds) == 0:
        raise ParameterError("speeds", speeds, "must be at least one speed", "rpm")
    for number, speed in enumerate(speeds):
        require_number(f"speeds[{number}]", speed, "rpm", at_least=0)
        if number and speed <= speeds[number - 1]:
            raise ParameterError(f"speeds[{number}]", speed, f"must be above {speeds[number - 1]:g} rpm: speeds rise", "rpm")
    return speeds

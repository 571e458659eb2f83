"""One pair at one speed: its motion over time, exact but for rounding."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcad.dynamics.tooth_springs.contact_model import ContactModel, EngagedPairs
from gearcad.dynamics.tooth_springs.history import SETTLED, Start, TimeHistory
from gearcad.errors import ParameterError, require_number

if TYPE_CHECKING:
    from gearcad.dynamics.tooth_springs.event_exact import Motion

__all__ = ["checked_samples", "time_history"]


MOST_SAMPLES = 10**8

_EVEN = 1e9
"""A base pitch (m) so long that no second pair ever comes."""


def time_history(
    model: ContactModel, speed: float, *, duration: float = 1.0, sampling: float = 200000.0, start: Start | None = None
) -> TimeHistory:
    """The motion at a mean speed of the pinion in rpm (not negative) over a duration (s), sampled so many times a second (Hz).

    Without a start the flanks just touch, without relative speed, and a flank of the pinion begins at T1.
    """
    from gearcad.dynamics.tooth_springs.event_exact import run

    samples = checked_samples(duration, sampling)
    require_number("speed", speed, "rpm", at_least=0)
    begin = start or Start()
    y, drift = 1e-6 * begin.approach, speed * math.pi / 30 * 1e-3 * model.base_radii.pinion
    travel = 1e-3 * begin.place - model.pinion_share * y
    state = (travel, y, 1e-3 * begin.approach_rate)
    approach, rate = np.empty(samples), np.empty(samples)
    outcome = run(_motion(model), float(drift), state, 1 / sampling, SETTLED * samples / sampling, approach, rate)
    approach *= 1e6
    rate *= 1e3
    for array in (approach, rate):
        array.flags.writeable = False
    return TimeHistory(
        model=model,
        speed=float(speed),
        sampling=float(sampling),
        start=begin,
        approach=approach,
        approach_rate=rate,
        out_of_contact=outcome.free / ((1 - SETTLED) * samples / sampling),
        growth=outcome.growth,
        digits_lost=outcome.gain / math.log(10),
        events=outcome.events,
        held=outcome.held,
    )


def checked_samples(duration: float, sampling: float) -> int:
    """Number of samples; raises ParameterError unless they are at least 2 and can be held."""
    require_number("duration", duration, "s", above=0)
    require_number("sampling", sampling, "Hz", above=0)
    samples = round(duration * sampling)
    if not 2 <= samples <= MOST_SAMPLES:
        permitted = f"must give between 2 and {MOST_SAMPLES} samples at {sampling:g} Hz"
        raise ParameterError("duration", duration, permitted, "s")
    return samples


def _motion(model: ContactModel) -> Motion:
    """The model in SI units, reduced to the approach."""
    from gearcad.dynamics.tooth_springs.event_exact import Motion, Zone

    mass, share = model.reduced_mass, model.pinion_share
    pitch, first, last = (1e-3 * x for x in (model.base_pitch, model.first_contact, model.last_contact))
    wheel_share = share - 1 if model.zone is EngagedPairs.PENETRATING_TIPS else share
    gap = math.inf if model.backlash is None else 1e-3 * model.backlash
    front = Zone(first, last, wheel_share, share)
    back = front
    if model.back_place is not None:
        mirror = 1e-3 * model.back_place
        # On the back flanks the penetration is -(y + backlash): it moves the wheel's end by the backlash.
        moved = gap if model.zone is EngagedPairs.PENETRATING_TIPS else 0.0
        back = Zone(mirror - last, mirror - first + moved, share, wheel_share)
    if model.zone is EngagedPairs.ONE_PAIR:
        pitch, front = _EVEN, Zone(-_EVEN / 2, _EVEN / 2, share, share)
        back = front
    stiffness = 1e6 * model.pair_stiffness
    return Motion(stiffness / mass, model.damping / (2 * mass), model.force / mass, pitch, gap, front, back)

"""How a planetary train turns in an animation."""

from __future__ import annotations

import math
from collections.abc import Mapping

from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.shafts import shafts_of
from gearcad.planetary.speeds import speeds
from gearcad.solids.files.turning import Turning
from gearcad.solids.train_layout import TrainLayout

__all__ = ["turning_of", "turns_of"]

_SECONDS = 10.0
"""That an animation takes at least."""

_MOST_TURNS = 60.0
"""Of anything, after which an animation ends even if the carrier has not come round."""

_FASTEST = 1.5
"""Turns a second of anything: what is faster cannot be followed."""

_WHOLE = 1e-6
"""Of a pitch: what is no nearer to whole ones does not come round."""


def turning_of(layout: TrainLayout, given: Mapping[str, float] | None = None) -> Turning:
    """As `turns_of` says: once, or so often that all teeth come round, where nothing turns over _MOST_TURNS times.

    Raises ParameterError for speeds that contradict each other.
    """
    turns = turns_of(layout, given)
    most = max(map(abs, turns.values()))
    times = _times_round(layout, turns, most) if most <= _MOST_TURNS else _MOST_TURNS / most
    return Turning(duration=max(_SECONDS, times * most / _FASTEST), turns={name: times * turn for name, turn in turns.items()})


def turns_of(layout: TrainLayout, given: Mapping[str, float] | None = None) -> dict[str, float]:
    """Turns of all axles by name, seen from what carries each, while the carrier turns once, or the input where it does not.

    As `given` speeds (rpm) say; where they do not suffice, the input turns with its sign in them, or positively. Then a
    differential's member that is neither input nor output stands still. Raises ParameterError for speeds that contradict each
    other.
    """
    train = layout.train
    found = speeds(train, _given(train, given or {}))
    turns = {**found.members, **{planet[0].axle.name: found.planet_relative for planet in layout.planets}}
    once = next((abs(turns[name]) for name in (train.carrier.name, train.input) if turns[name]), max(map(abs, turns.values())))
    return {name: speed / once for name, speed in turns.items()}


def _times_round(layout: TrainLayout, turns: Mapping[str, float], most: float) -> int:
    """How often these turns bring every body to where it looks as at first; 1 if that takes too long."""
    pitches: dict[str, int] = {layout.carrier.name: 1}
    for standing in layout.standing:
        # All gears of an axle come round together.
        name, teeth = standing.axle.name, standing.body.gear.tooth_count
        pitches[name] = math.gcd(pitches.get(name, 0), teeth)
    for times in range(1, int(_MOST_TURNS / most) + 1):
        passed = [times * turns[name] * count for name, count in pitches.items()]
        if all(abs(each - round(each)) < _WHOLE for each in passed):
            return times
    return 1


def _given(train: PlanetaryTrain, known: Mapping[str, float]) -> Mapping[str, float]:
    """The speeds (rpm) that say how all turns."""
    if len(known) >= (1 if train.fixed else 2) and any(known.values()):
        return known
    given = {train.input: math.copysign(1.0, known.get(train.input, 1.0))}
    if train.fixed is None:
        shafts = shafts_of(train)
        busy = {shafts[name].member for name in (train.input, train.output)}
        given[next(name for name in train.members if name not in busy)] = 0.0
    return given

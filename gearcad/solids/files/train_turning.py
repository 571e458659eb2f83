"""How a planetary train turns in an animation."""

from __future__ import annotations

from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.shafts import shafts_of
from gearcad.planetary.speeds import speeds
from gearcad.solids.files.turning import Turning
from gearcad.solids.train_layout import TrainLayout

__all__ = ["turning_of"]

_SECONDS = 10.0
"""That an animation takes at least: one turn of the carrier, or of what is driven where the carrier stands still."""

_MOST_TURNS = 60.0
"""Of anything, after which an animation ends even if the carrier has not come round."""

_FASTEST = 1.5
"""Turns a second of anything: what is faster cannot be followed."""


def turning_of(layout: TrainLayout) -> Turning:
    """The input turns, the fixed member stands still, and of a differential the member that is neither input nor output."""
    train = layout.train
    found = speeds(train, _given(train))
    turns = {**found.members, **{planet[0].axle.name: found.planet_relative for planet in layout.planets}}
    of_carrier = found.members[train.carrier.name]
    share = 1 / (of_carrier or found.members[train.input])
    most = max(abs(speed * share) for speed in turns.values())
    share *= min(1.0, _MOST_TURNS / most)
    most = min(most, _MOST_TURNS)
    return Turning(duration=max(_SECONDS, most / _FASTEST), turns={name: speed * share for name, speed in turns.items()})


def _given(train: PlanetaryTrain) -> dict[str, float]:
    """The speeds (rpm) that say how all turns."""
    given = {train.input: 1.0}
    if train.fixed is None:
        shafts = shafts_of(train)
        busy = {shafts[name].member for name in (train.input, train.output)}
        given[next(name for name in train.members if name not in busy)] = 0.0
    return given

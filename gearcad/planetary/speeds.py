"""Speeds of a planetary train by Willis's equation, which is exact in whole numbers of teeth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gearcad.errors import ParameterError
from gearcad.planetary.shafts import Shaft, shafts_of, willis_row
from gearcad.planetary.train_data import TrainData
from gearcad.ranges import SPEED

__all__ = ["Speeds", "check_speeds", "speeds"]


@dataclass(frozen=True, kw_only=True)
class Speeds:
    """Speeds in rpm, positive counter-clockwise seen from +z.

    `members` has those of the set's members and of all shafts of stages by name; `planet` is that of a planet, and
    `planet_relative` the same seen from the carrier, as its pin feels it.
    """

    members: Mapping[str, float]
    planet: float
    planet_relative: float

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"members": dict(self.members), "planet": self.planet, "planet_relative": self.planet_relative}


def speeds(train: TrainData, given: Mapping[str, float]) -> Speeds:
    """All speeds (rpm) from those `given` by names of members or shafts: one where a member is fixed, two of a differential.

    Raises ParameterError where a speed is missing, or follows from the others.
    """
    shafts = shafts_of(train)
    known = _known(train, shafts, given)
    row = willis_row(train)
    (missing,) = set(row) - set(known)
    # Zero is added where a product of signs would print as -0.
    known[missing] = -sum(row[name] * speed for name, speed in known.items()) / row[missing] + 0.0
    members = {shaft.name: float(shaft.speed_ratio * known[shaft.member]) + 0.0 for shaft in shafts.values()}
    central, turning = train.centrals[0], known[train.carrier.name]
    relative = -central.gear.teeth * (known[central.name] - turning) / train.rim_of(central).gear.teeth + 0.0
    return Speeds(members=members, planet=turning + relative, planet_relative=relative)


def check_speeds(train: TrainData, given: Mapping[str, float]) -> None:
    """Raise ParameterError where one of the speeds `given` (rpm) is of no member, or follows from those before it."""
    _told(train, shafts_of(train), given)


def _known(train: TrainData, shafts: Mapping[str, Shaft], given: Mapping[str, float]) -> dict[str, float]:
    """The two speeds of members that were given. Raises ParameterError."""
    known, by = _told(train, shafts, given)
    if len(known) < 2:
        free = [shaft.name for shaft in shafts.values() if shaft.member not in by]
        count, reason = ("one", "") if known else ("two", ": no member is fixed")
        raise ParameterError("speeds", sorted(given), f"must have {count} more, of {', '.join(free)}{reason}")
    return known


def _told(train: TrainData, shafts: Mapping[str, Shaft], given: Mapping[str, float]) -> tuple[dict[str, float], dict[str, str]]:
    """The speeds of members that were given, at the most two, and by the name of which shaft each. Raises ParameterError."""
    told = {train.fixed: 0.0} if train.fixed else {}
    known: dict[str, float] = {}
    by: dict[str, str] = {}
    for name, speed in [*told.items(), *given.items()]:
        key = f"speeds.{name}"
        if name not in shafts:
            raise ParameterError(key, speed, f"is of no member: there are {', '.join(shafts)}", "rpm")
        SPEED.require(key, speed)
        member = shafts[name].member
        if member in by:
            other = "is fixed" if by[member] == train.fixed else "is given"
            with_it = f"{by[member]} {other}" if name == by[member] else f"it turns with {by[member]}, which {other}"
            raise ParameterError(key, speed, f"must not be given too: {with_it}", "rpm")
        if len(known) == 2:
            raise ParameterError(key, speed, f"must not be given too: it follows from {_words(by)}", "rpm")
        by[member] = name
        known[member] = float(speed / shafts[name].speed_ratio) if speed else 0.0
    return known, by


def _words(by: Mapping[str, str]) -> str:
    return " and ".join(by.values())

"""Which shift diagram a design has: what is varied in it, under which keys of the spec, and where the design stands."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.designs.auto import AUTO
from gearcad.designs.design import Design
from gearcad.designs.kinds.gear import GearDesign
from gearcad.designs.kinds.pair import PairDesign
from gearcad.designs.kinds.rack_pair import RackPairDesign
from gearcad.errors import GearcadError
from gearcad.geometry import Gear
from gearcad.geometry.derived import is_given
from gearcad.per_gear import Role
from gearcad.sizing.shift_map import Axis, Free, ShiftMap, gear_map, pair_map

__all__ = ["LimitMap", "Variable", "limit_map"]

_SIZE = 49
"""Values of an axis: between them lines are straight."""

_SHIFTS, _HELIX, _TEETH = (-0.8, 1.4), (0.0, 30.0), (5, 60)
"""What the axes show at least."""


@dataclass(frozen=True)
class Variable:
    """An input that one moves: its value, its keys with the sign that it has under each, and between what it is shown."""

    free: Free
    value: float
    keys: Mapping[str, int]
    least: float
    most: float

    @property
    def step(self) -> float:
        """How far one step moves it."""
        return {Free.TEETH: 1.0, Free.HELIX: 0.1}.get(self.free, 0.01)

    def typed(self, value: float) -> dict[str, str]:
        """What one would type for another value, under its keys."""
        if self.free is Free.TEETH:
            return {key: str(round(value)) for key in self.keys}
        digits = 1 if self.free is Free.HELIX else 3
        return {key: repr(round(sign * value, digits) + 0.0) for key, sign in self.keys.items()}

    @property
    def axis(self) -> Axis:
        """The values that a map has of it."""
        return Axis(self.free, _between(self.least, self.most))


@dataclass(frozen=True)
class LimitMap:
    """A map, what is across and up in it, and what else one moves beside it."""

    map: ShiftMap
    across: Variable
    up: Variable
    others: tuple[Variable, ...]

    @property
    def variables(self) -> tuple[Variable, ...]:
        """All that one moves: the axes first."""
        return (self.across, self.up, *self.others)


def limit_map(design: Design, tables: Mapping[str, Any]) -> LimitMap | None:
    """The shift diagram of a design, whose spec has these tables; None for a kind that has none."""
    try:
        if isinstance(design, PairDesign):
            return _of_pair(design, tables)
        if isinstance(design, GearDesign):
            return _of_gear(design.gear, "gear", _helix(design.gear, {"gear.helix_angle": 1}))
        if isinstance(design, RackPairDesign):
            return _of_gear(design.gears["pinion"], "pinion", None)
    except GearcadError:
        pass
    return None


def _of_gear(gear: Gear, table: str, helix: Variable | None) -> LimitMap:
    most = max(_TEETH[1], math.ceil(gear.teeth * 1.2 / 20) * 20)
    teeth = Variable(Free.TEETH, gear.teeth, {f"{table}.teeth": 1}, min(_TEETH[0], gear.teeth), most)
    shift = _shift(Free.FIRST, gear, f"{table}.profile_shift")
    found = gear_map(gear, teeth.axis.values, shift.axis.values)
    return LimitMap(found, teeth, shift, () if helix is None else (helix,))


def _of_pair(design: PairDesign, tables: Mapping[str, Any]) -> LimitMap:
    pair, own = design.pair, {role: _table(tables, role.value) for role in Role}
    shifts = {
        Role.PINION: _shift(Free.FIRST, pair.pinion, "pinion.profile_shift"),
        Role.WHEEL: _shift(Free.SECOND, pair.wheel, "wheel.profile_shift"),
    }
    helix = _helix(pair.pinion, _helix_keys(tables, mirrored=1 if pair.internal else -1))
    tips = [table.get("tip_alteration", _table(tables, "pair").get("tip_alteration", AUTO)) for table in own.values()]
    options = {"distance": is_given(pair.centre_distance), "auto_tips": tips == [AUTO, AUTO]}
    automatic = [role for role in Role if own[role].get("profile_shift") == AUTO]
    if automatic:
        rest = automatic[-1]
        across = shifts[rest.mate]
        return LimitMap(pair_map(pair, across.axis, helix.axis, rest=rest, **options), across, helix, ())
    across, up = shifts[Role.PINION], shifts[Role.WHEEL]
    return LimitMap(pair_map(pair, across.axis, up.axis, rest=None, **options), across, up, (helix,))


def _shift(free: Free, gear: Gear, key: str) -> Variable:
    x = gear.profile_shift
    least, most = min(_SHIFTS[0], math.floor(2 * x) / 2 - 0.3), max(_SHIFTS[1], math.ceil(2 * x) / 2 + 0.4)
    return Variable(free, x, {key: 1}, least, most)


def _helix(gear: Gear, keys: Mapping[str, int]) -> Variable:
    """Its magnitude; the hand stays."""
    hand, size = (-1 if gear.helix_angle < 0 else 1), abs(gear.helix_angle)
    most = max(_HELIX[1], math.ceil(size / 10) * 10)
    return Variable(Free.HELIX, size, {key: hand * sign for key, sign in keys.items()}, _HELIX[0], most)


def _helix_keys(tables: Mapping[str, Any], mirrored: int) -> dict[str, int]:
    """Where the spec of a pair has its helix angle, or would have it."""
    signs = {"pinion": 1, "wheel": mirrored}
    of_gears = {f"{table}.helix_angle": sign for table, sign in signs.items() if "helix_angle" in _table(tables, table)}
    return of_gears or {"pair.helix_angle": 1}


def _table(tables: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = tables.get(name)
    return table if isinstance(table, Mapping) else {}


def _between(least: float, most: float) -> Floats:
    return np.linspace(least, most, _SIZE)

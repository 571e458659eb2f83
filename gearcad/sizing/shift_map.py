"""Shift diagrams: what limits the profile shifts of gears, over a grid of two of their inputs.

Each limit is a field over the grid, whose lines of equal values one draws: undercut, thickness of tips, contact ratio,
interference, backlash. External gears from hobs. Interference is that of circles - a tip that reaches below the root form
circle of its mate - and is not judged on teeth that are undercut.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import ParameterError
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.derived import is_given
from gearcad.per_gear import PerGear, Role
from gearcad.sizing.columns import Numbers
from gearcad.sizing.geometry import distance_for, shift_sum_at
from gearcad.sizing.many_teeth import ManyTeeth, involute_of

__all__ = ["Axis", "Free", "Limit", "LimitKind", "ShiftMap", "gear_map", "pair_map"]

_ROUNDING = 1e-4
"""Overlap at the working circle, in normal modules, that a GearPair takes for rounding."""


class Free(Enum):
    """An input that a map varies."""

    TEETH = "teeth"
    HELIX = "helix_angle"
    FIRST = "pinion.profile_shift"
    SECOND = "wheel.profile_shift"


class LimitKind(Enum):
    """What limits: its name, the least that is made at all, and the least that nobody is warned of."""

    UNDERCUT = ("undercut", -math.inf, 0.0)
    THICKNESS = ("thickness", 0.0, 0.0)
    TIP = ("tip", 0.0, 0.2)
    CONTACT_RATIO = ("contact_ratio", 0.0, 1.0)
    INTERFERENCE = ("interference", -math.inf, 0.0)
    BACKLASH = ("backlash", -_ROUNDING, 0.0)
    CLEARANCE = ("clearance", 0.0, 0.0)

    @property
    def refused(self) -> float:
        """At or below this nothing is made of it."""
        return self.value[1]

    @property
    def warned(self) -> float:
        """Below this there is a notice."""
        return self.value[2]


class Axis(NamedTuple):
    """An input and its values."""

    free: Free
    values: Floats


class Limit(NamedTuple):
    """A field over the grid - in normal modules, or a ratio - and the gear whose teeth it is about; None for both.

    `values` has a row for each value of the axis up, a column for each of that across; nan where there is no mesh.
    """

    kind: LimitKind
    role: Role | None
    values: Floats


@dataclass(frozen=True)
class ShiftMap:
    """What limits gears over two of their inputs, all others as they are."""

    across: Axis
    up: Axis
    limits: tuple[Limit, ...]


def gear_map(gear: Gear, teeth: Floats, shifts: Floats) -> ShiftMap:
    """Numbers of teeth across, as if they were not whole, profile shifts up. Raises ParameterError for what no hob cuts."""
    across, up = np.meshgrid(teeth, shifts)
    many = _teeth(gear, across, abs(gear.helix_angle), up, gear.tip_alteration)
    return ShiftMap(Axis(Free.TEETH, teeth), Axis(Free.FIRST, shifts), tuple(_of_teeth(many, None)))


def pair_map(pair: GearPair, across: Axis, up: Axis, *, rest: Role | None, distance: bool, auto_tips: bool) -> ShiftMap:
    """The limits of pairs like one, whose inputs are varied.

    With `distance` the centre distance stays, else it is that without backlash; the gear `rest` takes what is left of the shift
    sum at that distance. With `auto_tips` tips are altered to keep the clearance. Raises ParameterError for what no hob cuts,
    and for rings.
    """
    if pair.internal:
        raise ParameterError("wheel.teeth", pair.wheel.teeth, "must be above 0 for a shift diagram")
    grid = dict(zip((across.free, up.free), np.meshgrid(across.values, up.values), strict=True))
    module, angle, teeth = pair.pinion.normal_module, pair.pinion.rack.pressure_angle, pair.pinion.teeth + pair.wheel.teeth
    helix: Numbers = grid.get(Free.HELIX, np.full(np.shape(grid[across.free]), abs(pair.pinion.helix_angle)))
    first: Numbers = grid.get(Free.FIRST, pair.pinion.profile_shift)
    second: Numbers = grid.get(Free.SECOND, pair.wheel.profile_shift)
    sums = np.full(np.shape(helix), float(teeth))
    if rest is not None:
        total = shift_sum_at(pair.centre_distance, sums, np.full_like(sums, module), np.asarray(helix), angle)
        first, second = (total - second, second) if rest is Role.PINION else (first, total - first)
    at: Floats = (
        np.full_like(sums, pair.centre_distance)
        if distance
        else distance_for(np.asarray(first + second), sums, np.full_like(sums, module), np.asarray(helix), angle)
    )
    change = (at - sums * module / np.cos(np.radians(helix)) / 2) / module
    auto = np.minimum(change - (first + second), 0.0)
    gears = PerGear(
        *(
            _teeth(gear, float(gear.teeth), helix, shift, auto if auto_tips else gear.tip_alteration)
            for gear, shift in zip(pair.gears, (first, second), strict=True)
        )
    )
    return ShiftMap(
        across, up, (*_of_teeth(gears.pinion, Role.PINION), *_of_teeth(gears.wheel, Role.WHEEL), *_of_mesh(gears, at))
    )


def _teeth(gear: Gear, teeth: Numbers, helix: Numbers, shift: Numbers, alteration: Numbers) -> ManyTeeth:
    """Gears like one. Raises ParameterError."""
    if gear.internal or gear.cutter.teeth is not None:
        raise ParameterError("teeth", gear.teeth, "must be those of an external gear from a hob for a shift diagram")
    return ManyTeeth(
        teeth=teeth,
        normal_module=gear.normal_module,
        helix_angle=helix,
        shift=shift,
        rack=gear.rack,
        tip_alteration=alteration,
        thinning=float(gear.tooth_thinning),
        tip_chamfer=gear.body.tip_chamfer,
        given_tip=gear.tip_diameter if is_given(gear.tip_diameter) else None,
        given_root=gear.root_diameter if is_given(gear.root_diameter) else None,
    )


def _of_teeth(gear: ManyTeeth, role: Role | None) -> tuple[Limit, ...]:
    """Undercut, and thickness of the teeth and their tips."""
    m = gear.normal_module
    return (
        Limit(LimitKind.THICKNESS, role, gear.tooth_thickness * np.cos(np.radians(gear.helix_angle)) / m),
        Limit(LimitKind.UNDERCUT, role, gear.form_reach / m),
        Limit(LimitKind.TIP, role, gear.tip_thickness / m),
    )


def _of_mesh(gears: PerGear[ManyTeeth], distance: Floats) -> tuple[Limit, ...]:
    """What both have together, at a centre distance (mm); nan where base circles overlap."""
    first, second = gears
    m = first.normal_module
    bases = np.asarray(first.base_diameter + second.base_diameter)
    with np.errstate(invalid="ignore"):
        working = np.arccos(np.where(bases < 2 * distance, bases / (2 * distance), np.nan))
    tangent = distance * np.sin(working)
    pitch = math.pi * first.base_diameter / first.teeth
    ratio = (first.tip_reach + second.tip_reach - tangent) / pitch
    limits = [Limit(LimitKind.CONTACT_RATIO, None, ratio)]
    for role, own in gears.items():
        margin = tangent - gears.pick(role.mate).tip_reach - own.form_reach
        limits.append(Limit(LimitKind.INTERFERENCE, role, np.where(own.form_reach < 0, np.nan, margin / m)))
        clearance = distance - (own.tip_diameter + gears.pick(role.mate).root_diameter) / 2
        limits.append(Limit(LimitKind.CLEARANCE, role, clearance / m))
    return (*limits, Limit(LimitKind.BACKLASH, None, _backlash(gears, distance, working) / m))


def _backlash(gears: PerGear[ManyTeeth], distance: Floats, working: Floats) -> Floats:
    """j_wt: the working pitch less both tooth thicknesses on the working pitch circles."""
    whole = np.asarray(gears.pinion.teeth + gears.wheel.teeth)
    left = 2 * math.pi / gears.pinion.teeth + np.zeros_like(distance)
    for gear in gears:
        half = gear.tooth_thickness / gear.diameter + involute_of(gear.transverse_angle)
        left = left - 2 * gear.teeth / gears.pinion.teeth * (half - involute_of(working))
    result: Floats = left * distance * gears.pinion.teeth / whole
    return result

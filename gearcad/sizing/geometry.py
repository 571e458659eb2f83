"""Geometry of many external pairs at once: the formulas of Gear and GearPair (ISO 21771) as arrays; shift diagrams.

Lengths in mm, angles in radians, but for the helix angle, which is in degrees as in a Gear. Teeth are hobbed.

Lengths in mm, angles in radians, but for the helix angle, which is in degrees as in a Gear. Flanks have no backlash and gears
no thinning; tips are altered as `tip_alteration = "auto"` has it, to keep the clearance of the rack.

Each limit is a field over the grid, whose lines of equal values one draws: undercut, thickness of tips, contact ratio,
interference, backlash. External gears from hobs. Interference is that of circles - a tip that reaches below the root form
circle of its mate - and is not judged on teeth that are undercut.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from enum import Enum
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.quantities import is_given
from gearcad.core.records import Bools, Floats, PerGear, Role, Wholes
from gearcad.geometry import BasicRack, Gear, GearPair
from gearcad.geometry.involute import inverse_involute, involute

Numbers = float | Floats
"""One for each variant, or one that holds for all."""


@dataclass(frozen=True, kw_only=True)
class Columns:
    """Arrays of one shape as fields, some of them PerGear or other Columns; what else is a field holds for all variants."""

    def map(self, change: Callable[[np.ndarray[Any, Any]], np.ndarray[Any, Any]]) -> Self:
        """Return the columns with a function applied to every array."""
        return type(self)(**{each.name: _changed(getattr(self, each.name), change) for each in fields(self)})

    def picked(self, which: Any) -> Self:
        """Return the variants with these indices, or where a mask is true; any other index of numpy changes the shape."""
        return self.map(lambda array: array[which])

    @classmethod
    def joined(cls, parts: list[Self]) -> Self:
        """Return several columns joined one after another; values that hold for all variants are those of the first."""
        return cls(**{each.name: _joined([getattr(part, each.name) for part in parts]) for each in fields(parts[0])})


def _joined(values: list[Any]) -> Any:
    first = values[0]
    if isinstance(first, PerGear):
        return PerGear(*(_joined(list(each)) for each in zip(*values, strict=True)))
    if isinstance(first, Columns):
        return type(first).joined(values)
    return np.concatenate(values) if isinstance(first, np.ndarray) else first


def _changed(value: Any, change: Callable[[np.ndarray[Any, Any]], np.ndarray[Any, Any]]) -> Any:
    if isinstance(value, PerGear):
        return PerGear(*(_changed(each, change) for each in value))
    if isinstance(value, Columns):
        return value.map(change)
    return change(value) if isinstance(value, np.ndarray) else value


def involute_of(angle: Numbers) -> Numbers:
    """Involute of an angle in radians."""
    result: Numbers = np.tan(angle) - angle
    return result


def form_reach(diameter: Numbers, transverse_angle: Numbers, depth: Numbers) -> Floats:
    """r sin alpha_t - h/sin alpha_t: length of the base tangent out to the root form circle that a hob leaves.

    `depth` h is that of the end of its straight flanks (mm) below the reference circle. Below 0 the tooth is undercut.
    """
    sine = np.sin(transverse_angle)
    result: Floats = diameter / 2 * sine - depth / sine
    return result


def tip_thickness(
    diameter: Numbers, base: Numbers, tip: Numbers, thickness: Numbers, transverse_angle: Numbers, helix_angle: Numbers
) -> Floats:
    """s_at = d_a (s_t/d + inv alpha_t - inv alpha_at), times cos beta_a; below 0 the flanks meet before.

    `thickness` s_t is that on the reference circle.
    """
    at_tip = np.arccos(np.minimum(base / tip, 1.0))
    transverse = tip * (thickness / diameter + involute_of(transverse_angle) - involute_of(at_tip))
    result: Floats = transverse / np.hypot(1.0, np.tan(np.radians(helix_angle)) * tip / diameter)
    return result


@dataclass(frozen=True, kw_only=True)
class ManyTeeth:
    """Gears by their given values: numbers, or arrays that go together; helix angles in degrees, thinning in mm.

    `given_tip` and `given_root` are diameters (mm) that do not follow from the profile shift.
    """

    teeth: Numbers
    normal_module: float
    helix_angle: Numbers
    shift: Numbers
    rack: BasicRack
    tip_alteration: Numbers = 0.0
    thinning: float = 0.0
    tip_chamfer: float = 0.0
    given_tip: float | None = None
    given_root: float | None = None

    @cached_property
    def transverse_angle(self) -> Numbers:
        """Transverse pressure angle alpha_t."""
        result: Numbers = np.arctan(math.tan(math.radians(self.rack.pressure_angle)) / self._cosine)
        return result

    @property
    def _cosine(self) -> Numbers:
        result: Numbers = np.cos(np.radians(self.helix_angle))
        return result

    @cached_property
    def diameter(self) -> Numbers:
        """Reference diameter d (mm)."""
        return self.teeth * self.normal_module / self._cosine

    @cached_property
    def base_diameter(self) -> Numbers:
        """Base diameter d_b (mm)."""
        result: Numbers = self.diameter * np.cos(self.transverse_angle)
        return result

    @cached_property
    def tip_diameter(self) -> Numbers:
        """Tip diameter d_a (mm)."""
        if self.given_tip is not None:
            return self.given_tip
        return self.diameter + 2 * self.normal_module * (self.rack.addendum + self.shift + self.tip_alteration)

    @cached_property
    def root_diameter(self) -> Numbers:
        """Root diameter d_f (mm)."""
        return self.diameter - 2 * self.normal_module * (self.dedendum - self.shift)

    @property
    def dedendum(self) -> Numbers:
        """h_fP of the tool in normal modules, where the root circle is given that which cuts it."""
        if self.given_root is None:
            return self.rack.dedendum
        return (self.diameter - self.given_root) / (2 * self.normal_module) + self.shift

    @property
    def root_radius(self) -> Numbers:
        """rho_fP in normal modules, with "full" resolved."""
        if self.rack.root_radius != "full":
            return float(self.rack.root_radius)
        full = self.rack.full_root_radius(thinning=self.thinning / self.normal_module)
        angle = math.radians(self.rack.pressure_angle)
        return full - (self.dedendum - self.rack.dedendum) * math.sin(angle) / (1 - math.sin(angle))

    @cached_property
    def form_reach(self) -> Floats:
        """Length of the base tangent out to the root form circle; below 0 the tooth is undercut."""
        straight = self.dedendum - self.root_radius * (1 - math.sin(math.radians(self.rack.pressure_angle)))
        return form_reach(self.diameter, self.transverse_angle, self.normal_module * (straight - self.shift))

    @cached_property
    def tip_reach(self) -> Floats:
        """Length of the base tangent out to where the flank ends: the tip circle, less a chamfer."""
        end, base = self.tip_diameter - 2 * self.tip_chamfer, self.base_diameter
        result: Floats = np.sqrt(np.maximum((end - base) * (end + base), 0.0)) / 2
        return result

    @property
    def tooth_thickness(self) -> Numbers:
        """s_t on the reference circle."""
        tangent = math.tan(math.radians(self.rack.pressure_angle))
        return (self.normal_module * (math.pi / 2 + 2 * self.shift * tangent) - self.thinning) / self._cosine

    @cached_property
    def tip_thickness(self) -> Floats:
        """s_an, before a tip chamfer."""
        parts = (self.diameter, self.base_diameter, self.tip_diameter, self.tooth_thickness)
        return tip_thickness(*parts, self.transverse_angle, self.helix_angle)


@dataclass(frozen=True, kw_only=True)
class ManyPairs(Columns):
    """Pairs by their given values, arrays of one shape; all derived values have that shape.

    `key` is the place of a variant in the whole search, which does not depend on the order in which anything was given.
    """

    key: Wholes
    teeth: PerGear[Floats]
    normal_module: Floats
    helix_angle: Floats
    centre_distance: Floats
    shifts: PerGear[Floats]
    rack: BasicRack

    # ------------------------------------------------------------------ angles

    @cached_property
    def normal_angle(self) -> float:
        """alpha_n."""
        return math.radians(self.rack.pressure_angle)

    @cached_property
    def cosine(self) -> Floats:
        """Cosine of the helix angle beta."""
        return np.cos(np.radians(self.helix_angle))

    @cached_property
    def transverse_angle(self) -> Floats:
        """Transverse pressure angle alpha_t."""
        return np.arctan(math.tan(self.normal_angle) / self.cosine)

    @cached_property
    def base_helix(self) -> Floats:
        """Base helix angle beta_b."""
        return np.arcsin(np.sin(np.radians(np.abs(self.helix_angle))) * math.cos(self.normal_angle))

    @cached_property
    def working_angle(self) -> Floats:
        """alpha_wt, of a centre distance beyond the base circles."""
        bases = self.base_diameters.pinion + self.base_diameters.wheel
        result: Floats = np.arccos(np.minimum(bases / (2 * self.centre_distance), 1.0))
        return result

    # ------------------------------------------------------------------ circles

    @cached_property
    def transverse_module(self) -> Floats:
        """Transverse module m_t (mm)."""
        return self.normal_module / self.cosine

    @cached_property
    def diameters(self) -> PerGear[Floats]:
        """Reference diameters d (mm)."""
        return PerGear(*(z * self.transverse_module for z in self.teeth))

    @cached_property
    def base_diameters(self) -> PerGear[Floats]:
        """Base diameters d_b (mm)."""
        across = np.cos(self.transverse_angle)
        return PerGear(*(d * across for d in self.diameters))

    @cached_property
    def tip_alteration(self) -> Floats:
        """k of both gears: (a - a_d)/m_n - (x_1 + x_2), never positive."""
        change = (self.centre_distance - (self.diameters.pinion + self.diameters.wheel) / 2) / self.normal_module
        result: Floats = np.minimum(change - (self.shifts.pinion + self.shifts.wheel), 0.0)
        return result

    @cached_property
    def tip_diameters(self) -> PerGear[Floats]:
        """Tip diameters d_a (mm)."""
        rise = self.rack.addendum + self.tip_alteration
        return PerGear(*(d + 2 * self.normal_module * (rise + x) for d, x in zip(self.diameters, self.shifts, strict=True)))

    @cached_property
    def root_diameters(self) -> PerGear[Floats]:
        """Root diameters d_f (mm)."""
        dedendum = self.rack.dedendum
        return PerGear(*(d - 2 * self.normal_module * (dedendum - x) for d, x in zip(self.diameters, self.shifts, strict=True)))

    @cached_property
    def virtual_teeth(self) -> PerGear[Floats]:
        """z_n = z/(cos^2 beta_b cos beta)."""
        divisor = np.cos(self.base_helix) ** 2 * self.cosine
        return PerGear(*(z / divisor for z in self.teeth))

    @property
    def ratio(self) -> Floats:
        """Gear ratio u."""
        return self.teeth.wheel / self.teeth.pinion

    # ------------------------------------------------------------------ path of contact

    @cached_property
    def tangent(self) -> Floats:
        """T1T2 = a sin alpha_wt."""
        result: Floats = self.centre_distance * np.sin(self.working_angle)
        return result

    @cached_property
    def tip_reach(self) -> PerGear[Floats]:
        """Length of the base tangent out to the tip circle, of either gear; 0 inside the base circle."""
        return PerGear(
            *(
                np.sqrt(np.maximum((tip - base) * (tip + base), 0.0)) / 2
                for tip, base in zip(self.tip_diameters, self.base_diameters, strict=True)
            )
        )

    @property
    def lowest_contact(self) -> PerGear[Floats]:
        """Length of the base tangent out to the lowest point that the mate's tip reaches; negative beyond the base circle."""
        return PerGear(self.tangent - self.tip_reach.wheel, self.tangent - self.tip_reach.pinion)

    @property
    def form_reach(self) -> PerGear[Floats]:
        """Length of the base tangent out to the root form circle that a hob leaves; below 0 the tooth is undercut."""
        return PerGear(*map(self._form_reach, self.diameters, self.shifts))

    def _form_reach(self, diameter: Floats, shift: Floats) -> Floats:
        straight = self.rack.dedendum - self.root_radius * (1 - math.sin(self.normal_angle))
        return form_reach(diameter, self.transverse_angle, self.normal_module * (straight - shift))

    @property
    def root_radius(self) -> float:
        """rho_fP in normal modules, with "full" resolved."""
        radius = self.rack.root_radius
        return self.rack.full_root_radius() if radius == "full" else float(radius)

    @cached_property
    def base_pitch(self) -> Floats:
        """Transverse base pitch p_bt (mm)."""
        return math.pi * self.transverse_module * np.cos(self.transverse_angle)

    @cached_property
    def contact_ratio(self) -> Floats:
        """eps_alpha, from the tip circles."""
        return (self.tip_reach.pinion + self.tip_reach.wheel - self.tangent) / self.base_pitch

    @property
    def sliding(self) -> PerGear[Floats]:
        """Specific sliding at the lowest point of either flank, where it is greatest in size: 1 - (z/z_mate) rho_mate/rho.

        Minus infinity where the mate's tip reaches the base tangent point.
        """
        own, tips = self.lowest_contact, self.tip_reach
        made = []
        for role in Role:
            ratio, rho = self.teeth.pick(role) / self.teeth.pick(role.mate), own.pick(role)
            with np.errstate(divide="ignore", invalid="ignore"):
                made.append(np.where(rho > 0, 1 - ratio * tips.pick(role.mate) / rho, -np.inf))
        return PerGear(*made)

    # ------------------------------------------------------------------ tips

    @property
    def tip_thicknesses(self) -> PerGear[Floats]:
        """s_an, normal tooth thickness on the tip circle; below 0 the flanks meet before."""
        parts = (self.diameters, self.base_diameters, self.tip_diameters, self.shifts)
        return PerGear(*map(self._tip_thickness, *parts))

    def _tip_thickness(self, d: Floats, base: Floats, tip: Floats, shift: Floats) -> Floats:
        thickness = self.transverse_module * (math.pi / 2 + 2 * shift * math.tan(self.normal_angle))
        return tip_thickness(d, base, tip, thickness, self.transverse_angle, self.helix_angle)

    @property
    def meshes(self) -> Bools:
        """Mask of the pairs whose base circles are apart."""
        result: Bools = self.base_diameters.pinion + self.base_diameters.wheel < 2 * self.centre_distance
        return result


def shift_sum_at(
    distance: Floats | float, teeth: Floats, normal_module: Floats, helix_angle: Floats, pressure_angle: float
) -> Floats:
    """x_1 + x_2 without backlash at a centre distance (mm), for sums of teeth; nan where the base circles overlap.

    As `profile_shift_sum` of one pair; angles in degrees.
    """
    cosine = np.cos(np.radians(helix_angle))
    transverse = np.arctan(math.tan(math.radians(pressure_angle)) / cosine)
    nearest = normal_module / cosine * teeth / 2 * np.cos(transverse)
    with np.errstate(invalid="ignore"):
        working = np.arccos(np.where(nearest < distance, nearest / distance, np.nan))
    result: Floats = teeth * (involute_of(working) - involute_of(transverse)) / (2 * math.tan(math.radians(pressure_angle)))
    return result


def distance_for(shift_sum: Floats, teeth: Floats, normal_module: Floats, helix_angle: Floats, pressure_angle: float) -> Floats:
    """Centre distance (mm) without backlash with x_1 + x_2, for sums of teeth; nan where there is none.

    As `zero_backlash_centre_distance` of one pair; angles in degrees.
    """
    cosine = np.cos(np.radians(helix_angle))
    transverse = np.arctan(math.tan(math.radians(pressure_angle)) / cosine)
    value = involute(np.degrees(transverse)) + 2 * math.tan(math.radians(pressure_angle)) * shift_sum / teeth
    working = np.radians(inverse_involute(np.maximum(value, 0.0)))
    reference = normal_module / cosine * teeth / 2
    result: Floats = np.where(value > 0, reference * np.cos(transverse) / np.cos(working), np.nan)
    return result


_ROUNDING = 1e-4
"""Overlap at the working circle, in normal modules, that a GearPair takes for rounding."""


class Free(Enum):
    """An input that a map varies."""

    TEETH = "teeth"
    HELIX = "helix_angle"
    FIRST = "pinion.profile_shift"
    SECOND = "wheel.profile_shift"


class LimitKind(Enum):
    """What limits: its name, the value at or below which nothing is made, and the value below which a notice is given."""

    UNDERCUT = ("undercut", -math.inf, 0.0)
    THICKNESS = ("thickness", 0.0, 0.0)
    TIP = ("tip", 0.0, 0.2)
    CONTACT_RATIO = ("contact_ratio", 0.0, 1.0)
    INTERFERENCE = ("interference", -math.inf, 0.0)
    BACKLASH = ("backlash", -_ROUNDING, 0.0)
    CLEARANCE = ("clearance", 0.0, 0.0)

    @property
    def refused(self) -> float:
        """Value at or below which nothing is made."""
        return self.value[1]

    @property
    def warned(self) -> float:
        """Value below which there is a notice."""
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
    """Return the limits of gears over numbers of teeth (across, as if not whole) and profile shifts (up).

    Raises ParameterError for gears that no hob cuts.
    """
    across, up = np.meshgrid(teeth, shifts)
    many = _teeth(gear, across, abs(gear.helix_angle), up, gear.tip_alteration)
    return ShiftMap(Axis(Free.TEETH, teeth), Axis(Free.FIRST, shifts), tuple(_of_teeth(many, None)))


def pair_map(pair: GearPair, across: Axis, up: Axis, *, rest: Role | None, distance: bool, auto_tips: bool) -> ShiftMap:
    """Return the limits of pairs like a given one, over two varied inputs.

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
    """Return the limits of a mesh at a centre distance (mm); nan where base circles overlap."""
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

"""Geometry of many external pairs at once: the formulas of Gear and GearPair (ISO 21771) on arrays; shift diagrams.

Lengths in mm, angles in degrees. Teeth are hobbed. Variants of a search have no backlash and no thinning. Their tips are
altered as by `tip_alteration = "auto"`, which keeps the clearance of the rack.

Each limit of a shift diagram is a field over the grid, whose lines of equal values are drawn: undercut, thickness of tips,
contact ratio, interference, backlash. Interference is that of circles: a tip reaches below the root form circle of its mate.
It is not judged on teeth that are undercut.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from enum import Enum
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.quantities import is_given
from gearcad.core.records import Bools, Floats, PerGear, Role, Wholes
from gearcad.core.values import Numbers
from gearcad.geometry import BasicRack, Gear, GearPair
from gearcad.geometry.fits import backlash
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.pair_data import (
    PairSizes,
    clearance_alteration,
    shift_sum_between,
    transverse_section,
    working_involute,
)
from gearcad.geometry.path_of_contact import BaseTangent
from gearcad.geometry.toothed import GearSizes, Toothed


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


@dataclass(frozen=True, kw_only=True)
class ManyTeeth(GearSizes[Numbers]):
    """Gears by their given values: numbers, or arrays that go together; `given_...` are diameters (mm) that are prescribed.

    Form circle and tip thickness are in closed form here. A Gear measures them at its outline, which is of one tooth.
    """

    teeth: Numbers
    normal_module: Numbers
    helix_angle: Numbers
    profile_shift: Numbers
    rack: BasicRack
    tip_alteration: Numbers = 0.0
    tooth_thinning: float = 0.0
    tip_chamfer: float = 0.0
    given_tip_diameter: float | None = None
    given_root_diameter: float | None = None

    @cached_property
    def tip_diameter(self) -> Numbers:
        """Tip diameter d_a (mm)."""
        return self.standard_tip_diameter if self.given_tip_diameter is None else self.given_tip_diameter

    @property
    def tip_form_diameter(self) -> Numbers:
        """d_Fa: the tip circle less the tip chamfers."""
        return self.tip_diameter - 2 * self.tip_chamfer

    @property
    def root_diameter(self) -> Numbers:
        """Root diameter d_f (mm)."""
        return self.standard_root_diameter if self.given_root_diameter is None else self.given_root_diameter

    @cached_property
    def form_reach(self) -> Floats:
        """Length of the base tangent out to the root form circle that a hob leaves; below 0 the tooth is undercut.

        r sin alpha_t - h/sin alpha_t, h the depth at which the straight flanks of the hob end, below the reference circle.
        """
        corner = self.root_radius * (1 - math.sin(math.radians(self.rack.pressure_angle)))
        depth, sine = self.dedendum - corner - self.profile_shift, np.sin(np.radians(self.transverse_pressure_angle))
        return np.asarray(self.reference_diameter / 2 * sine - self.normal_module * depth / sine)

    @property
    def tip_thickness(self) -> Floats:
        """s_an, before a tip chamfer: d_a (s_t/d + inv alpha_t - inv alpha_at) cos beta_a; below 0 the flanks meet before."""
        tip, d = self.tip_diameter, self.reference_diameter
        at_tip = np.degrees(np.arccos(np.minimum(self.base_diameter / tip, 1.0)))
        half = np.radians(self.base_half_angle) - involute(at_tip)
        return np.asarray(tip * half / np.hypot(1.0, np.tan(np.radians(self.helix_angle)) * tip / d))


@dataclass(frozen=True, kw_only=True)
class PairedTeeth(ManyTeeth):
    """Teeth of one gear of many pairs. Both gears have the section of the `pairs`, whose angles are found once."""

    pairs: Toothed[Numbers]
    tip_radius: Numbers | None = None
    """Tip radius of the tool (normal modules) where it goes with the module."""

    @property
    def root_radius(self) -> Numbers:
        """Radius of the tool's tip in normal modules."""
        return super().root_radius if self.tip_radius is None else self.tip_radius

    @property
    def helix_cosine(self) -> Numbers:
        """Cosine of the helix angle beta."""
        return self.pairs.helix_cosine

    @property
    def transverse_module(self) -> Numbers:
        """Transverse module m_t (mm)."""
        return self.pairs.transverse_module

    @property
    def transverse_pressure_angle(self) -> Numbers:
        """Transverse pressure angle alpha_t."""
        return self.pairs.transverse_pressure_angle

    @property
    def base_helix_angle(self) -> Numbers:
        """Base helix angle beta_b."""
        return self.pairs.base_helix_angle


@dataclass(frozen=True, kw_only=True)
class ManyPairs(Columns, PairSizes[Numbers], Toothed[Numbers]):
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
    tip_radius: Floats | None = None

    # ------------------------------------------------------------------ teeth

    @cached_property
    def gears(self) -> PerGear[PairedTeeth]:
        """Teeth of both gears."""
        return PerGear.each(self._gear)

    def _gear(self, role: Role) -> PairedTeeth:
        return PairedTeeth(
            pairs=self,
            teeth=self.teeth.pick(role),
            normal_module=self.normal_module,
            helix_angle=self.helix_angle,
            profile_shift=self.shifts.pick(role),
            rack=self.rack,
            tip_alteration=self.tip_alteration,
            tip_radius=self.tip_radius,
        )

    @cached_property
    def tip_alteration(self) -> Floats:
        """k of both gears: (a - a_d)/m_n - (x_1 + x_2), never positive."""
        references = (self.teeth.pinion + self.teeth.wheel) * self.transverse_module / 2
        return _tip_alteration(self.centre_distance - references, self.normal_module, self.shifts.pinion + self.shifts.wheel)

    @cached_property
    def diameters(self) -> PerGear[Floats]:
        """Reference diameters d (mm)."""
        return self.gears.map(lambda gear: np.asarray(gear.reference_diameter))

    @cached_property
    def base_diameters(self) -> PerGear[Floats]:
        """Base diameters d_b (mm)."""
        return self.gears.map(lambda gear: np.asarray(gear.base_diameter))

    @cached_property
    def tip_diameters(self) -> PerGear[Floats]:
        """Tip diameters d_a (mm)."""
        return self.gears.map(lambda gear: np.asarray(gear.tip_diameter))

    @cached_property
    def root_diameters(self) -> PerGear[Floats]:
        """Root diameters d_f (mm)."""
        return self.gears.map(lambda gear: np.asarray(gear.root_diameter))

    @property
    def tip_thicknesses(self) -> PerGear[Floats]:
        """s_an, normal tooth thickness on the tip circle; below 0 the flanks meet before."""
        return self.gears.map(lambda gear: gear.tip_thickness)

    # ------------------------------------------------------------------ path of contact

    @property
    def form_reach(self) -> PerGear[Floats]:
        """Length of the base tangent out to the root form circle that a hob leaves; below 0 the tooth is undercut."""
        return self.gears.map(lambda gear: gear.form_reach)

    @property
    def lowest_contact(self) -> PerGear[Floats]:
        """Length of the base tangent out to the lowest point that the mate's tip reaches; negative beyond the base circle."""
        return self.base_tangent.lowest(self.path_of_contact).map(np.asarray)

    @property
    def contact_ratio(self) -> Floats:
        """eps_alpha, from the tip circles."""
        return np.asarray(self.transverse_contact_ratio)

    @property
    def sliding(self) -> PerGear[Floats]:
        """Specific sliding at the lowest point of either flank, where it is greatest in size.

        Minus infinity where the mate's tip reaches the base tangent point.
        """
        path, lowest = self.path_of_contact, self.lowest_contact
        first, last = self.specific_sliding_at(path.A).pinion, self.specific_sliding_at(path.E).wheel
        return PerGear(np.where(lowest.pinion > 0, first, -np.inf), np.where(lowest.wheel > 0, last, -np.inf))

    @property
    def meshes(self) -> Bools:
        """Mask of the pairs whose base circles are apart."""
        result: Bools = self.base_diameters.pinion + self.base_diameters.wheel < 2 * self.centre_distance
        return result


def _tip_alteration(apart: Numbers, module: Numbers, shift_sum: Numbers) -> Floats:
    """k (normal modules) that keeps the clearance of the rack, never positive; `apart` is a - a_d (mm)."""
    return np.minimum(clearance_alteration(apart, module, shift_sum), 0.0)


def shift_sum_at(
    distance: Floats | float, teeth: Floats, normal_module: Floats, helix_angle: Floats, pressure_angle: float
) -> Floats:
    """x_1 + x_2 without backlash at a centre distance (mm), for sums of teeth; nan where the base circles overlap.

    As `profile_shift_sum` of one pair; angles in degrees.
    """
    _, nearest, transverse = transverse_section(normal_module, teeth, helix_angle, pressure_angle)
    with np.errstate(invalid="ignore"):
        working = np.degrees(np.arccos(np.where(nearest < distance, nearest / distance, np.nan)))
    return np.asarray(shift_sum_between(teeth, transverse, working, pressure_angle))


def distance_for(shift_sum: Floats, teeth: Floats, normal_module: Floats, helix_angle: Floats, pressure_angle: float) -> Floats:
    """Return the centre distance (mm) without backlash with x_1 + x_2, for sums of teeth; nan where there is none.

    As `zero_backlash_centre_distance` of one pair; angles in degrees.
    """
    _, nearest, transverse = transverse_section(normal_module, teeth, helix_angle, pressure_angle)
    value = np.asarray(working_involute(shift_sum, teeth, transverse, pressure_angle))
    working = np.radians(inverse_involute(np.maximum(value, 0.0)))
    return np.where(value > 0, nearest / np.cos(working), np.nan)


_ROUNDING = 1e-4
"""Overlap at the working circle, in normal modules, that a GearPair takes for rounding."""


class Free(Enum):
    """An input that a map varies."""

    TEETH = "teeth"
    HELIX = "helix_angle"
    FIRST = "pinion.profile_shift"
    SECOND = "wheel.profile_shift"


class LimitKind(Enum):
    """Kind of a limit: its name, the value at or below which nothing is made, and the value below which a notice is given."""

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
    """Map of the limits of gears over two of their inputs, all others fixed."""

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
    auto = _tip_alteration(at - sums * module / np.cos(np.radians(helix)) / 2, module, first + second)
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
    """Return arrays of gears with the data of one gear. Raises ParameterError."""
    if gear.internal or gear.root_cutter.teeth is not None or gear.premachining.present:
        raise ParameterError("teeth", gear.teeth, "must be those of an external gear from a hob for a shift diagram")
    return ManyTeeth(
        teeth=teeth,
        normal_module=gear.normal_module,
        helix_angle=helix,
        profile_shift=shift,
        rack=gear.rack,
        tip_alteration=alteration,
        tooth_thinning=float(gear.tooth_thinning),
        tip_chamfer=gear.body.tip_chamfer,
        given_tip_diameter=gear.tip_diameter if is_given(gear.tip_diameter) else None,
        given_root_diameter=gear.given_root_diameter,
    )


def _of_teeth(gear: ManyTeeth, role: Role | None) -> tuple[Limit, ...]:
    """Undercut, and thickness of the teeth and their tips."""
    m = gear.normal_module
    return (
        Limit(LimitKind.THICKNESS, role, np.asarray(gear.normal_tooth_thickness / m)),
        Limit(LimitKind.UNDERCUT, role, gear.form_reach / m),
        Limit(LimitKind.TIP, role, gear.tip_thickness / m),
    )


def _of_mesh(gears: PerGear[ManyTeeth], distance: Floats) -> tuple[Limit, ...]:
    """Return the limits of a mesh at a centre distance (mm); nan where base circles overlap."""
    with np.errstate(invalid="ignore"):
        return tuple(_limits_of_mesh(gears, distance))


def _limits_of_mesh(gears: PerGear[ManyTeeth], distance: Floats) -> Iterator[Limit]:
    pinion, m = gears.pinion, gears.pinion.normal_module
    bases = gears.map(lambda gear: gear.base_diameter)
    working = np.degrees(np.arccos((bases.pinion + bases.wheel) / (2 * distance)))
    line = BaseTangent(bases, distance, working, pinion.transverse_base_pitch)
    path = line.path(gears.map(lambda gear: gear.tip_form_diameter))
    yield Limit(LimitKind.CONTACT_RATIO, None, np.asarray((path.E - path.A) / line.pitch))
    for role, own in gears.items():
        margin = line.lowest(path).pick(role) - own.form_reach
        yield Limit(LimitKind.INTERFERENCE, role, np.where(own.form_reach < 0, np.nan, margin / m))
        clearance = distance - (own.tip_diameter + gears.pick(role.mate).root_diameter) / 2
        yield Limit(LimitKind.CLEARANCE, role, np.asarray(clearance / m))
    gap = backlash(
        teeth=gears.map(lambda gear: gear.teeth),
        base_half_angles=gears.map(lambda gear: gear.base_half_angle),
        base_diameters=bases,
        base_helix_angle=pinion.base_helix_angle,
        centre_distance=distance,
    )
    yield Limit(LimitKind.BACKLASH, None, np.asarray(gap.circumferential / m))

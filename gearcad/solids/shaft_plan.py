"""Plans of shafts as bodies: their cylinders, their places in the assembly of a pair, and the seats of gears on them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby, pairwise
from typing import NamedTuple

from gearcad.core.errors import GeometryError
from gearcad.core.records import JsonObject, Notice, PerGear, Role
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.bore_teeth import free_bore
from gearcad.shafts.beam import ShaftSegment, SteppedShaft

_SAME = 1e-9
"""Distance (mm) below which two positions or diameters are one."""

_BESIDE = 1e-6
"""Distance (mm) to both sides of the middle of a bearing at which the diameter of its seat is taken."""

_UNDER_ROOT = 0.5
"""Normal modules that a shaft without thinner neighbours stays below the root circle of the gear that is one piece with it."""


class Cylinder(NamedTuple):
    """A cylinder about the axis of a shaft: its radius (mm; 0 where a bore is closed), and its ends from the left one (mm)."""

    radius: float
    low: float
    high: float


@dataclass(frozen=True)
class TurnedPlan:
    """Cylinders of a shaft, outside and of its bore, neighbours of one diameter as one.

    Raises GeometryError for a bore that reaches neither end, and for neighbours that have no ring in common.
    """

    shaft: SteppedShaft

    def __post_init__(self) -> None:
        for number, (one, other) in enumerate(pairwise(self.shaft.segments), 1):
            for wide, narrow in ((one, other), (other, one)):
                if wide.inner_diameter >= narrow.outer_diameter:
                    permitted = (
                        f"must be above {wide.inner_diameter:g} mm, the inner diameter of its neighbour, to be one solid"
                    )
                    at = number - 1 if narrow is one else number
                    raise GeometryError(f"shaft[{at}].outer_diameter", narrow.outer_diameter, permitted, "mm")
        bores = [list(group) for _, group in groupby(self.bore, lambda each: each.radius > 0)]
        for group in bores:
            if group[0].radius and group[0].low > _SAME and group[-1].high < self.shaft.length - _SAME:
                number = next(i for i, end in enumerate(self.shaft.ends) if abs(end - group[0].low) <= _SAME)
                diameter, permitted = 2 * group[0].radius, "must reach an end of the shaft: a closed cavity cannot be made"
                raise GeometryError(f"shaft[{number}].inner_diameter", diameter, permitted, "mm")

    @cached_property
    def outside(self) -> tuple[Cylinder, ...]:
        """Outer cylinders from left to right."""
        return self._cylinders([each.outer_diameter for each in self.shaft.segments])

    @cached_property
    def bore(self) -> tuple[Cylinder, ...]:
        """Cylinders of the bore from left to right, of radius 0 where there is none."""
        return self._cylinders([each.inner_diameter for each in self.shaft.segments])

    def _cylinders(self, diameters: Sequence[float]) -> tuple[Cylinder, ...]:
        found: list[Cylinder] = []
        for diameter, (low, high) in zip(diameters, pairwise(self.shaft.ends), strict=True):
            if found and abs(2 * found[-1].radius - diameter) <= _SAME:
                found[-1] = found[-1]._replace(high=high)
            else:
                found.append(Cylinder(diameter / 2, low, high))
        return tuple(found)

    @property
    def volume(self) -> float:
        """Volume (mm³): the sum over the segments."""
        return math.fsum(each.area * each.length for each in self.shaft.segments)

    @property
    def polar(self) -> float:
        """Second moment of the volume about the axis (mm⁵)."""
        return math.fsum(2 * each.second_moment * each.length for each in self.shaft.segments)

    @property
    def mass(self) -> float:
        """Mass (kg)."""
        return 1e-9 * math.fsum(each.density * each.area * each.length for each in self.shaft.segments)

    @property
    def surface_area(self) -> float:
        """Area (mm²) of the surface: cylinders, shoulders and ends."""
        every = (*self.outside, *self.bore)
        walls = math.fsum(2 * math.pi * each.radius * (each.high - each.low) for each in every)
        steps = [abs(one.radius**2 - two.radius**2) for row in (self.outside, self.bore) for one, two in pairwise(row)]
        ends = [self.outside[k].radius ** 2 - self.bore[k].radius ** 2 for k in (0, -1)]
        return walls + math.pi * math.fsum(steps + ends)

    @property
    def bored_through(self) -> bool:
        """Whether the bore goes from end to end."""
        return all(each.radius for each in self.bore)

    @property
    def largest(self) -> float:
        """Largest outer diameter (mm)."""
        return 2 * max(each.radius for each in self.outside)

    def meridian(self) -> list[tuple[float, float]]:
        """Return the corners (z, radius) in mm of half the section through the axis, in turn from the left end."""
        upper = [(z, each.radius) for each in self.outside for z in (each.low, each.high)]
        lower = [(z, each.radius) for each in reversed(self.bore) for z in (each.high, each.low)]
        return upper + lower


def diameters_within(shaft: SteppedShaft, low: float, high: float) -> list[float]:
    """Return the outer diameters (mm) of a shaft between two positions (mm), from left to right."""
    spans = zip(shaft.segments, pairwise(shaft.ends), strict=True)
    return [each.outer_diameter for each, (start, end) in spans if end > low + _SAME and start < high - _SAME]


@dataclass(frozen=True)
class SeatedShaft:
    """A shaft of a gear of a pair: its `role`, the shaft as its spec has it, its gear, and where it stands in the assembly.

    `x` is the position of its axis, `z` that of its left end, `low` and `high` are the ends of its gear with hubs,
    `middle` is that of the common face, all in mm; it is turned with its gear by `rotation` (degrees).
    """

    role: Role
    given: SteppedShaft
    gear: Gear
    x: float
    z: float
    low: float
    high: float
    middle: float
    rotation: float = 0.0

    @property
    def position(self) -> float:
        """Position of the middle of the common face on the shaft (mm from its left end)."""
        return self.middle - self.z

    @property
    def one_piece(self) -> bool:
        """Whether gear and shaft are one piece: the gear has no bore."""
        return not self.gear.body.bore and bool(self.within)

    @property
    def own_mass(self) -> float:
        """Mass (kg) of what is not within a gear that is one piece with it."""
        if not self.one_piece:
            return self.plan.mass
        low, high = self.low - self.z, self.high - self.z
        spans = zip(self.given.segments, pairwise(self.given.ends), strict=True)
        outside = ((each, end - start - max(0.0, min(end, high) - max(start, low))) for each, (start, end) in spans)
        return 1e-9 * math.fsum(each.density * each.area * length for each, length in outside)

    @property
    def name(self) -> str:
        """ "pinion shaft" or "wheel shaft"."""
        return f"{self.role.value} shaft"

    @property
    def file(self) -> str:
        """First part of the names of its files."""
        return f"{self.role.value}-shaft"

    @cached_property
    def plan(self) -> TurnedPlan:
        """Cylinders of the shaft as it is made. Raises GeometryError, its parameter led by the role."""
        try:
            return TurnedPlan(self.shaft)
        except GeometryError as error:
            raise error.within(self.role.value) from None

    @cached_property
    def within(self) -> list[float]:
        """Outer diameters (mm) of the given shaft within the gear."""
        return diameters_within(self.given, self.low - self.z, self.high - self.z)

    @property
    def most(self) -> float:
        """Largest diameter (mm) of the solid within the gear: the bore's, else the neighbours', below the root circle."""
        if self.gear.body.bore:
            return free_bore(self.gear)
        low, high = self.low - self.z, self.high - self.z
        beside = diameters_within(self.given, -1.0, low)[-1:] + diameters_within(self.given, high, math.inf)[:1]
        return min(max(beside, default=math.inf), self.gear.root_diameter - 2 * _UNDER_ROOT * self.gear.normal_module)

    @cached_property
    def shaft(self) -> SteppedShaft:
        """The shaft as it is made: within the gear no thicker than `most`.

        Where the beam is thicker it stands for the body of the gear, which has a solid of its own.
        """
        if max(self.within, default=0.0) <= self.most + _SAME:
            return self.given
        found: list[ShaftSegment] = []
        low, high = self.low - self.z, self.high - self.z
        for each, (start, end) in zip(self.given.segments, pairwise(self.given.ends), strict=True):
            stops = [start, *(stop for stop in (low, high) if start + _SAME < stop < end - _SAME), end]
            for begin, stop in pairwise(stops):
                inside = low - _SAME <= begin and stop <= high + _SAME
                outer = min(each.outer_diameter, self.most) if inside else each.outer_diameter
                found.append(replace(each, length=stop - begin, outer_diameter=outer))
        return replace(self.given, segments=tuple(found))

    @cached_property
    def rings(self) -> dict[int, tuple[TurnedPlan, float]]:
        """Rings of the bearings whose sizes are given, by their numbers from 1, with the height z (mm) of the lower end."""
        found = {}
        for number, bearing in enumerate(self.given.bearings, 1):
            if (ring := bearing.ring) is not None:
                inner, outer, width = ring
                body = ShaftSegment(length=width, outer_diameter=outer, inner_diameter=inner)
                plan = TurnedPlan(SteppedShaft(segments=(body,), bearings=()))
                found[number] = plan, self.z + bearing.position - width / 2
        return found

    def _bearing_notices(self) -> Iterator[Notice]:
        """Yield notices about bearings whose bore differs from the shaft."""
        for number, bearing in enumerate(self.given.bearings, 1):
            seat = diameters_within(self.given, bearing.position - _BESIDE, bearing.position + _BESIDE)
            if bearing.d is not None and all(abs(each - bearing.d) > _SAME for each in seat):
                text = f"the bearing has a bore of {bearing.d:g} mm, the shaft {seat[0]:g} mm there"
                yield Notice("bearing-seat", text, where=f"{self.role.value}: {bearing.name or number}")

    @property
    def notices(self) -> Iterator[Notice]:
        """Notices about seats: diameters of shaft and bore that differ, a pinion shaft, and bearings."""
        yield from self._gear_notices()
        yield from self._bearing_notices()

    def _gear_notices(self) -> Iterator[Notice]:
        """Yield notices about the seat of the gear."""
        bore, role = self.gear.body.bore and free_bore(self.gear), self.role.value
        if not self.within:
            return
        thin, thick, root = min(self.within), max(self.within), self.gear.root_diameter
        if not bore and thick > root + _SAME:
            text = f"pinion shaft: the shaft has {thick:g} mm at the face, more than the root circle of {root:.6g} mm,"
            yield Notice("pinion-shaft", f"{text} and stands for the body of the gear there; they are one piece", where=role)
        elif not bore:
            text = f"the gear has no bore, and the shaft {thick:g} mm at the face: they are one piece"
            yield Notice("one-piece", text, where=role)
        elif thick > bore + _SAME:
            text = (
                f"the shaft has {thick:g} mm at the face, more than the bore of {bore:g} mm: the solid is as thick as the bore"
            )
            yield Notice("seat-thicker", text, where=role)
        if bore and thin < bore - _SAME:
            text = f"the shaft has {thin:g} mm at the face, less than the bore of {bore:g} mm: they leave a gap"
            yield Notice("seat-thinner", text, where=role)

    def to_dict(self) -> JsonObject:
        """Return length, place and mass of the shaft as it is made."""
        return {
            "length": self.given.length,
            "largest_diameter": self.plan.largest,
            "mass": self.plan.mass,
            "left_end": [self.x, 0.0, self.z],
        }


def pair_shafts(pair: GearPair, shafts: PerGear[SteppedShaft | None], positions: PerGear[float]) -> tuple[SeatedShaft, ...]:
    """Return the shafts of a pair where they stand in its assembly: the pinion's axis is at x = 0, z = 0 its lower end.

    `positions` (mm) are those of the middle of the common face width on each shaft, from its left end.
    """
    pose = pair.wheel_pose()
    middle = pair.pinion.face_width / 2 + pair.common_width.offset
    places = PerGear((0.0, 0.0, 0.0), (pose.x, pose.z, pose.rotation))
    found = []
    for role, shaft in shafts.items():
        if shaft is not None:
            gear, (x, z, turn) = pair.gears.pick(role), places.pick(role)
            back, front = gear.body.hub_ends
            start = middle - positions.pick(role)
            found.append(SeatedShaft(role, shaft, gear, x, start, z - back, z + gear.face_width + front, middle, turn))
    return tuple(found)

"""Plan of a train of pairs as bodies: axes, heights and rotations of its gears and shafts, in mesh in all meshes at once.

The pinion of the first mesh turns about z, its teeth begin at z = 0. A mesh has an angle: where the wheel's axis lies from the
pinion's, counter-clockwise from x. Gears of one shaft have one axis. Lengths in mm, angles in degrees.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import NamedTuple

from gearcad.core.errors import GeometryError
from gearcad.core.records import JsonObject, Notice, PerGear, Role
from gearcad.geometry import Gear, GearPair
from gearcad.shafts.beam import SteppedShaft
from gearcad.solids.shaft_plan import SeatedShaft, TurnedPlan

_SAME = 1e-6
"""Distance (mm), and share of a pitch, below which two places are one."""

_GAP = 2.0
"""Distance along the axes between meshes whose places are not given, in the largest normal module."""


class GearKey(NamedTuple):
    """A gear of a train: its mesh and its role there."""

    mesh: str
    role: Role


@dataclass(frozen=True, kw_only=True)
class TrainMeshPlan:
    """A pair of a train: the names of its gears, the lines of shafts on which they are, and the angle of the mesh."""

    name: str
    pair: GearPair
    gears: PerGear[str]
    lines: PerGear[int]
    angle: float = 0.0


@dataclass(frozen=True, kw_only=True)
class ShaftPlan:
    """A shaft of a train: its line, and the position of the middle of the common face of each gear on it, from its left end."""

    name: str
    line: int
    shaft: SteppedShaft
    positions: Mapping[GearKey, float]


@dataclass(frozen=True)
class StandingGear:
    """A gear in its place: turned by `rotation` about an axis through (x, y), its teeth from the height z on."""

    name: str
    key: GearKey
    gear: Gear
    line: int
    x: float
    y: float
    z: float
    rotation: float

    @property
    def extent(self) -> tuple[float, float]:
        """Lowest and highest z of the gear, hubs included."""
        back, front = self.gear.body.hub_ends
        return self.z - back, self.z + self.gear.face_width + front

    @property
    def radii(self) -> tuple[float, float]:
        """Least and largest radius of the space in which the gear turns."""
        if self.gear.internal:
            return abs(self.gear.tip_diameter) / 2, (self.gear.body.rim_diameter or abs(self.gear.root_diameter)) / 2
        return 0.0, self.gear.tip_diameter / 2


@dataclass(frozen=True)
class StandingShaft:
    """A shaft in its place: its left end at (x, y, z), turned with its first gear; `plan` are its cylinders as it is made."""

    name: str
    line: int
    plan: TurnedPlan
    x: float
    y: float
    z: float
    rotation: float


@dataclass(frozen=True)
class GearTrainPlan:
    """Places of all gears and shafts of a train of pairs. Raises GeometryError for places that contradict each other."""

    name: str
    meshes: tuple[TrainMeshPlan, ...]
    shafts: tuple[ShaftPlan, ...] = ()

    # ------------------------------------------------------------------ axes

    @cached_property
    def axes(self) -> dict[int, tuple[float, float]]:
        """Axes (x, y) of the lines of shafts, from mesh to mesh."""
        found = {self.meshes[0].lines.pinion: (0.0, 0.0)}
        waiting = list(self.meshes)
        while waiting:
            mesh = next((each for each in waiting if any(line in found for line in each.lines)), None)
            if mesh is None:  # a train hangs together, by shafts or meshes
                found[waiting[0].lines.pinion] = (0.0, 0.0)
                continue
            waiting.remove(mesh)
            x, y = self._between(mesh)
            pinion, wheel = (found.get(line) for line in mesh.lines)
            if pinion is not None and wheel is not None:
                off = math.hypot(wheel[0] - pinion[0] - x, wheel[1] - pinion[1] - y)
                if off > _SAME:
                    apart = math.hypot(wheel[0] - pinion[0], wheel[1] - pinion[1])
                    permitted = (
                        f"must lead to the axis that other meshes give: it is {apart:.6g} mm from the pinion's,"
                        f" and {off:.6g} mm from where this mesh has it; change the angles of the loop"
                    )
                    raise GeometryError(f"{mesh.name}.mesh_angle", mesh.angle, permitted, "deg")
            elif pinion is not None:
                found[mesh.lines.wheel] = (pinion[0] + x, pinion[1] + y)
            elif wheel is not None:
                found[mesh.lines.pinion] = (wheel[0] - x, wheel[1] - y)
        return found

    @staticmethod
    def _between(mesh: TrainMeshPlan) -> tuple[float, float]:
        """Return the way (x, y) from the pinion's axis to the wheel's."""
        distance, angle = abs(mesh.pair.centre_distance), math.radians(mesh.angle)
        return distance * math.cos(angle), distance * math.sin(angle)

    # ------------------------------------------------------------------ bodies

    @cached_property
    def bodies(self) -> dict[GearKey, GearKey]:
        """The gear that each gear of a mesh is: one of two meshes, as an idler, stands for both where they are equal."""
        first: dict[tuple[str, int], list[GearKey]] = {}
        found: dict[GearKey, GearKey] = {}
        for mesh in self.meshes:
            for role, gear in mesh.pair.gears.items():
                key, home = GearKey(mesh.name, role), (mesh.gears.pick(role), mesh.lines.pick(role))
                same = (each for each in first.setdefault(home, []) if _nameless(self.gear(each)) == _nameless(gear))
                found[key] = next(same, key)
                if found[key] == key:
                    first[home].append(key)
        return found

    def gear(self, key: GearKey) -> Gear:
        """Return the gear of a mesh."""
        return self.mesh(key.mesh).pair.gears.pick(key.role)

    def mesh(self, name: str) -> TrainMeshPlan:
        """Return the mesh of a name."""
        return next(mesh for mesh in self.meshes if mesh.name == name)

    # ------------------------------------------------------------------ heights

    @cached_property
    def _heights(self) -> tuple[dict[str, float], bool]:
        """Bottom of the pinion's teeth (z) of each mesh, and whether some are assumed: one mesh behind the other."""
        found: dict[str, float] = {}
        assumed = False
        for mesh in self.meshes:
            if mesh.name in found:
                continue
            group = self._group(mesh.name)
            if not found:
                start = 0.0
            else:
                assumed = True
                module = max(each.pair.pinion.normal_module for each in self.meshes)
                low = min(self._extent(name, z)[0] for name, z in group.items())
                start = max(self._extent(name, z)[1] for name, z in found.items()) + _GAP * module - low
            found |= {name: start + z for name, z in group.items()}
        return found, assumed

    def _group(self, first: str) -> dict[str, float]:
        """Return the heights of the meshes that shafts and gears tie to a mesh, which is at 0."""
        found, waiting = {first: 0.0}, [first]
        while waiting:
            here = waiting.pop(0)
            for one, other, apart in self._ties:
                for name, mate, by in ((one, other, apart), (other, one, -apart)):
                    if name != here:
                        continue
                    if mate not in found:
                        found[mate] = found[here] + by
                        waiting.append(mate)
                    elif abs(found[mate] - found[here] - by) > _SAME:
                        off = found[mate] - found[here] - by
                        permitted = f"must agree with the other shafts and gears: {mate} is {off:.6g} mm off along the axes"
                        raise GeometryError(f"{here}.position", found[here], permitted, "mm")
        return found

    @cached_property
    def _ties(self) -> list[tuple[str, str, float]]:
        """Pairs of meshes, and how much higher the bottom of the second one's pinion is: by shafts, and by gears of both."""
        found = []
        for shaft in self.shafts:
            for (one, at), (other, place) in combinations(shaft.positions.items(), 2):
                middles = [self._middle(self.mesh(each.mesh).pair) for each in (one, other)]
                found.append((one.mesh, other.mesh, place - at - middles[1] + middles[0]))
        for key, body in self.bodies.items():
            if key != body:
                found.append((body.mesh, key.mesh, self._bottom(body) - self._bottom(key)))
        return [each for each in found if each[0] != each[1] or abs(each[2]) > _SAME]

    @staticmethod
    def _middle(pair: GearPair) -> float:
        """Return the height of the middle of the common face over the bottom of the pinion."""
        return pair.pinion.face_width / 2 + pair.common_width.offset

    def _bottom(self, key: GearKey) -> float:
        """Return the height of the bottom of a gear over that of the pinion of its mesh."""
        return self.mesh(key.mesh).pair.wheel_pose().z if key.role is Role.WHEEL else 0.0

    def _extent(self, mesh: str, z: float) -> tuple[float, float]:
        ends = []
        for role in Role:
            key = GearKey(mesh, role)
            back, front = self.gear(key).body.hub_ends
            ends += [z + self._bottom(key) - back, z + self._bottom(key) + self.gear(key).face_width + front]
        return min(ends), max(ends)

    # ------------------------------------------------------------------ rotations

    @cached_property
    def _rotations(self) -> dict[GearKey, float]:
        """Rotation of each body (degrees): a tooth in a space in every mesh, the backlash split evenly."""
        found: dict[GearKey, float] = {}
        waiting = list(self.meshes)
        while waiting:
            mesh = next((each for each in waiting if any(body in found for body in self._bodies_of(each))), waiting[0])
            waiting.remove(mesh)
            pinion, wheel = self._bodies_of(mesh)
            pair, turned = mesh.pair, mesh.angle + (180.0 if mesh.pair.internal else 0.0)
            rate = pair.wheel_pose(1.0).rotation - pair.wheel_pose(0.0).rotation
            if pinion in found:
                own = found[pinion] - turned
            elif wheel in found:
                own = (found[wheel] - turned - pair.wheel_pose(0.0).rotation) / rate
            else:
                own = 0.0
            found.setdefault(pinion, own + turned)
            place = pair.wheel_pose(own).rotation + turned
            off = (found.setdefault(wheel, place) - place) / 360 * pair.wheel.tooth_count
            if abs(off - round(off)) > _SAME:
                permitted = f"must let the teeth of the loop mesh: they are {abs(off - round(off)):.4g} pitches off"
                raise GeometryError(f"{mesh.name}.mesh_angle", mesh.angle, permitted, "deg")
        return found

    def _bodies_of(self, mesh: TrainMeshPlan) -> PerGear[GearKey]:
        return PerGear.each(lambda role: self.bodies[GearKey(mesh.name, role)])

    # ------------------------------------------------------------------ what stands

    @cached_property
    def gears(self) -> tuple[StandingGear, ...]:
        """The gears in their places, each body once."""
        heights, _ = self._heights
        names = self._names
        found = []
        for mesh in self.meshes:
            for role, gear in mesh.pair.gears.items():
                key = GearKey(mesh.name, role)
                if self.bodies[key] == key:
                    x, y = self.axes[mesh.lines.pick(role)]
                    z = heights[mesh.name] + self._bottom(key)
                    rotation = self._rotations[key] % 360
                    found.append(StandingGear(names[key], key, gear, mesh.lines.pick(role), x, y, z, rotation))
        return tuple(found)

    @cached_property
    def _names(self) -> dict[GearKey, str]:
        """Names of bodies: those of the gears in the train, with the mesh where a name has several bodies."""
        own = {key: self.mesh(key.mesh).gears.pick(key.role) for key, body in self.bodies.items() if key == body}
        several = {name for name in own.values() if list(own.values()).count(name) > 1}
        return {key: f"{name} {key.mesh}" if name in several else name for key, name in own.items()}

    @cached_property
    def standing(self) -> dict[GearKey, StandingGear]:
        """The body of each gear of a mesh."""
        own = {each.key: each for each in self.gears}
        return {key: own[body] for key, body in self.bodies.items()}

    @cached_property
    def standing_shafts(self) -> tuple[StandingShaft, ...]:
        """The shafts in their places; within a gear none is thicker than its bore, or than its neighbours below the teeth."""
        found = []
        taken = {each.name for each in self.gears}
        for each in self.shafts:
            if not each.positions:
                continue
            shaft, first = each.shaft, next(iter(each.positions))
            x, y = self.axes[each.line]
            middle = self._heights[0][first.mesh] + self._middle(self.mesh(first.mesh).pair)
            z = middle - each.positions[first]
            for key in each.positions:
                body = self.standing[key]
                shaft = SeatedShaft(key.role, shaft, body.gear, x, z, *body.extent, z + each.positions[key]).shaft
            name = each.name if each.name not in taken else f"{each.name} shaft"
            try:
                plan = TurnedPlan(shaft)
            except GeometryError as error:
                raise error.within(each.name) from None
            found.append(StandingShaft(name, each.line, plan, x, y, z, self.standing[first].rotation))
        return tuple(found)

    @property
    def pitch_point(self) -> tuple[float, float]:
        """Pitch point (x, y) of the first mesh."""
        mesh = self.meshes[0]
        (x, y), radius = self.axes[mesh.lines.pinion], mesh.pair.working_pitch_diameters.pinion / 2
        angle = math.radians(mesh.angle + (180.0 if mesh.pair.internal else 0.0))
        return x + radius * math.cos(angle), y + radius * math.sin(angle)

    # ------------------------------------------------------------------ what to know of it

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of places that are assumed, and of bodies that stand in each other."""
        return (*self._assumed, *self._clashes)

    @property
    def _assumed(self) -> Iterator[Notice]:
        if self._heights[1]:
            text = (
                "the places of meshes along the axes are assumed, one mesh behind the other: positions of gears on shafts"
                " with segments give them"
            )
            yield Notice("assumed-places", text)

    @property
    def _clashes(self) -> Iterator[Notice]:
        """Yield a notice for two gears that are not in mesh, or a gear and a shaft beside it, in one place."""
        meshing = {
            frozenset((self.bodies[GearKey(m.name, Role.PINION)], self.bodies[GearKey(m.name, Role.WHEEL)]))
            for m in self.meshes
        }
        for one, other in combinations(self.gears, 2):
            if frozenset((one.key, other.key)) not in meshing and _overlap(one.extent, other.extent) and _meet(one, other):
                text = f"{one.name} and {other.name} stand in each other: change the angle of a mesh, or places on the shafts"
                yield Notice("clash", text)
        for shaft in self.standing_shafts:
            for gear in self.gears:
                if gear.line != shaft.line and _hits(shaft, gear):
                    text = f"the shaft {shaft.name} stands in {gear.name}: change the angle of a mesh, or places on the shafts"
                    yield Notice("clash", text)

    def to_dict(self) -> JsonObject:
        """Return the places of the arrangement: gears and shafts with axis, height and rotation (mm, degrees)."""
        return {
            "gears": {
                each.name: {"mesh": each.key.mesh, "x": each.x, "y": each.y, "z": each.z, "rotation": each.rotation}
                for each in self.gears
            },
            "shafts": {each.name: {"x": each.x, "y": each.y, "z": each.z} for each in self.standing_shafts},
            "meshes": {
                mesh.name: {"centre_distance": mesh.pair.centre_distance, "mesh_angle": mesh.angle} for mesh in self.meshes
            },
        }


def _nameless(gear: Gear) -> Gear:
    return replace(gear, name="gear")


def _overlap(one: tuple[float, float], other: tuple[float, float]) -> bool:
    return one[0] < other[1] - _SAME and other[0] < one[1] - _SAME


def _meet(one: StandingGear, other: StandingGear) -> bool:
    """Return whether the circles in which two gears turn have a place in common."""
    apart = math.hypot(one.x - other.x, one.y - other.y)
    if apart < _SAME:
        return _overlap(one.radii, other.radii)
    inside = any(apart + each.radii[1] <= mate.radii[0] + _SAME for each, mate in ((one, other), (other, one)))
    return not inside and apart < one.radii[1] + other.radii[1] - _SAME


def _hits(shaft: StandingShaft, gear: StandingGear) -> bool:
    """Return whether a cylinder of a shaft reaches into the circle in which a gear beside it turns."""
    apart = math.hypot(shaft.x - gear.x, shaft.y - gear.y)
    inner, outer = gear.radii
    for each in shaft.plan.outside:
        beside = _overlap((shaft.z + each.low, shaft.z + each.high), gear.extent)
        if beside and apart - each.radius < outer - _SAME and apart + each.radius > inner + _SAME:
            return True
    return False

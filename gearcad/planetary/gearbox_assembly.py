"""Assembly of the planetary sets of a gearbox: axes, pairs in mesh, tooth positions of all planets, clearances, phases."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, InputError, at_least
from gearcad.core.quantities import NOT_GIVEN
from gearcad.core.records import Floats, JsonObject
from gearcad.geometry import Gear, GearPair, involute
from gearcad.geometry.gear_data import twist
from gearcad.planetary.gearbox_sets import MOST_PLANETS, MemberSet, SetGear, SetGearing
from gearcad.planetary.poses import GearPlace

_MISFIT = 1e-7
"""Pitches by which teeth may miss their spaces because of rounding."""

_APART = 1e-9
"""Lengths (mm) and angles (rad) that are rounding."""


class SetAxis(NamedTuple):
    """Axis of planet 1 of a body: `radius` (mm) from that of the set, `angle` (rad) from the first body of its group."""

    radius: float
    angle: float


class PartMesh(NamedTuple):
    """The mesh of a central or planet with a planet, by their names."""

    first: str
    second: str

    @property
    def name(self) -> str:
        """Name such as "sun-planet"."""
        return f"{self.first}-{self.second}"


class Clearance(NamedTuple):
    """The least distance (mm) between the tips of two gears that do not mesh, and the names of these."""

    between: tuple[str, str]
    distance: float


@dataclass(frozen=True, kw_only=True)
class GearboxPhases:
    """Phases of the contacts of a mesh in base pitches (0 to 1), by planets: `ahead` of the pitch point in the direction in
    which contact moves, and `relative` to planet 1, which stays as the set turns. `left_flanks` of the second gear carry.
    """

    ahead: tuple[float, ...]
    relative: tuple[float, ...]
    left_flanks: bool

    def to_dict(self) -> JsonObject:
        """Return plain lists."""
        return {"ahead": list(self.ahead), "relative": list(self.relative), "left_flanks": self.left_flanks}


@dataclass(frozen=True, eq=False)
class SetAssembly:
    """A set whose gears are known, put together: planets of each name at equal angles, in mesh, backlash split.

    Carrier at angle 0: planet 1 of the first body of the set stands on +x.
    """

    subject: MemberSet

    def check(self) -> None:
        """Raise GeometryError, whose parameter begins with the name of the set, for gears that do not fit each other, teeth
        that miss their spaces, and gears that have no room.
        """
        try:
            _ = self.pairs
            self._check_teeth()
            self._check_room()
        except InputError as error:
            raise error.within(self.subject.name) from None

    # ------------------------------------------------------------------ parts

    @cached_property
    def gearing(self) -> SetGearing:
        """Gears and number of planets. Raises GeometryError where they are not known."""
        if self.subject.gearing is None:
            raise GeometryError(self.subject.name, None, "must have gears: give planets, normal_module and face_width")
        return self.subject.gearing

    @cached_property
    def meshes(self) -> tuple[PartMesh, ...]:
        """Meshes of the centrals, then of planets with planets."""
        return tuple(PartMesh(part.name, part.meshes) for part in self.subject.parts if part.meshes)

    @cached_property
    def _centrals(self) -> frozenset[str]:
        return frozenset(each.name for each in self.subject.centrals)

    @cached_property
    def _body(self) -> dict[str, str]:
        return {each.name: self.subject.body_of(each.name) for each in self.subject.planets}

    @cached_property
    def groups(self) -> tuple[tuple[str, ...], ...]:
        """Bodies that mesh with each other, in the order in which they are put in."""
        links = [{self._body[mesh.first], self._body[mesh.second]} for mesh in self.meshes if mesh.first not in self._centrals]
        found: list[tuple[str, ...]] = []
        for body in dict.fromkeys(self._body.values()):
            if any(body in group for group in found):
                continue
            group = [body]
            for own in group:
                group += [other for link in links if own in link for other in sorted(link) if other not in group]
            found.append(tuple(group))
        return tuple(found)

    @property
    def turning(self) -> tuple[str, ...]:
        """Names of the carrier, the centrals and the bodies of planets."""
        return (self.subject.carrier, *(each.name for each in self.subject.centrals), *dict.fromkeys(self._body.values()))

    def reach(self, name: str) -> tuple[float, float]:
        """Return the radii (mm) from the axis of the set between which a gear passes."""
        radius = abs(self._gear(name).tip_diameter) / 2
        if name in self._centrals:
            return (radius, math.inf) if self._gear(name).internal else (0.0, radius)
        axis = self.axes[self._body[name]].radius
        return max(axis - radius, 0.0), axis + radius

    def _gear(self, name: str) -> Gear:
        return self.gearing.gears[name].gear

    def tip_alterations(self, *, clear: bool = False) -> dict[str, float]:
        """Return the tip alteration of each gear, in normal modules, that keeps the tip clearance in all meshes; 0 of rings.

        With `clear` those of rings whose tips stay off the fillets of their planets. Raises InputError.
        """
        found = {name: 0.0 for name in self.gearing.gears}
        for mesh in self.meshes:
            pair = self.pairs[mesh.name]
            for name in mesh:
                gear = self._gear(name)
                if not gear.internal:
                    found[name] = min(found[name], pair.tip_alteration)
                elif clear and (tip := pair.clear_tip_diameter) is not None:
                    found[name] = min(gear.tip_alteration + (tip - gear.tip_diameter) / (2 * gear.normal_module), 0.0)
        return found

    # ------------------------------------------------------------------ axes

    @cached_property
    def axes(self) -> Mapping[str, SetAxis]:
        """Axes of the bodies by their names. Raises GeometryError."""
        found: dict[str, SetAxis] = {}
        for group in self.groups:
            found[group[0]] = SetAxis(self._radius(group[0]), 0.0)
            for body in group[1:]:
                mesh, beside = next(
                    (mesh, other)
                    for mesh in self.meshes
                    if mesh.first not in self._centrals
                    for other in found
                    if {self._body[mesh.first], self._body[mesh.second]} == {body, other}
                )
                found[body] = self._beside(body, mesh, found[beside])
        return found

    def _beside(self, body: str, mesh: PartMesh, other: SetAxis) -> SetAxis:
        """Return the axis of a body that stands counter-clockwise of another one with which it meshes."""
        apart = self.gearing.gears[mesh.first].mate_distance or abs(self._pair_at(mesh, None).centre_distance)
        radius = self._radius(body)
        cosine = (radius**2 + other.radius**2 - apart**2) / (2 * radius * other.radius)
        if not -1 <= cosine <= 1:
            low, high = abs(radius - other.radius), radius + other.radius
            axes = f"for axes at {radius:.6g} and {other.radius:.6g} mm from the middle"
            permitted = f"must be from {low:.6g} to {high:.6g} mm, {axes}"
            raise GeometryError(f"{mesh.first}.mate_distance", apart, permitted, "mm")
        return SetAxis(radius, other.angle + math.acos(cosine))

    def _radius(self, body: str) -> float:
        """Return the distance (mm) of a body's axis from the middle: the given one, or that of its first central."""
        own = [name for name, of in self._body.items() if of == body]
        given = [self.gearing.gears[name].centre_distance for name in own]
        for value in given:
            if value is not None:
                return value
        for mesh in self.meshes:
            if mesh.first in self._centrals and mesh.second in own:
                return abs(self._pair_at(mesh, None).centre_distance)
        raise GeometryError(f"{body}.centre_distance", None, "must be given in mm: no sun and no ring meshes with it")

    def distance(self, mesh: PartMesh) -> float:
        """Return the distance (mm) of the axes of a mesh."""
        if mesh.first in self._centrals:
            return self.axes[self._body[mesh.second]].radius
        one, other = (self.axes[self._body[name]] for name in mesh)
        return math.sqrt(one.radius**2 + other.radius**2 - 2 * one.radius * other.radius * math.cos(one.angle - other.angle))

    @cached_property
    def pairs(self) -> Mapping[str, GearPair]:
        """The pair of each mesh at its distance, the smaller external gear as pinion, by names. Raises InputError."""
        return {mesh.name: self._pair_at(mesh, self.distance(mesh)) for mesh in self.meshes}

    def _pair_at(self, mesh: PartMesh, distance: float | None) -> GearPair:
        first, second = (self.gearing.gears[name] for name in mesh)
        if min(first.top, second.top) - max(first.axial_position, second.axial_position) <= _APART:
            permitted = f"must bring it to the height of {mesh.second}, with which it meshes"
            raise GeometryError(f"{mesh.first}.axial_position", first.axial_position, permitted, "mm")
        pinion, wheel = self._roles(first, second)
        offset = (wheel.top + wheel.axial_position - pinion.top - pinion.axial_position) / 2
        signed = NOT_GIVEN if distance is None else -distance if wheel.gear.internal else distance
        try:
            return GearPair(pinion=pinion.gear, wheel=wheel.gear, name=mesh.name, axial_offset=offset, centre_distance=signed)
        except InputError as error:
            raise error.within(mesh.name) from None

    def _roles(self, first: SetGear, second: SetGear) -> tuple[SetGear, SetGear]:
        """Return two gears in mesh as pinion and wheel."""
        swapped = first.gear.internal or (not second.gear.internal and first.gear.teeth > second.gear.teeth)
        return (second, first) if swapped else (first, second)

    # ------------------------------------------------------------------ tooth positions

    @cached_property
    def _pitches(self) -> dict[str, Fraction]:
        """Pitches by which each planet turns, counter-clockwise, while the first of its group turns by one."""
        found: dict[str, Fraction] = {}
        for group in self.groups:
            found[group[0]] = Fraction(1)
            names = [name for name, body in self._body.items() if body in group]
            while missing := [name for name in names if name not in found]:
                for name in missing:
                    for mesh in self.meshes:
                        if name in mesh and (mate := mesh.first if mesh.second == name else mesh.second) in found:
                            found[name] = -found[mate]
                    for other in (other for other in names if self._body[other] == self._body[name] and other in found):
                        found.setdefault(name, found[other] * self._gear(name).teeth / self._gear(other).teeth)
        return found

    def _place(self, name: str, number: int) -> complex:
        """Return where the axis of a gear stands (mm), that of planet `number` counted from 0."""
        if name in self._centrals:
            return 0j
        axis = self.axes[self._body[name]]
        angle = axis.angle + math.tau * number / self.gearing.planets
        return complex(axis.radius * math.cos(angle), axis.radius * math.sin(angle))

    def place_of(self, body: str, number: int) -> complex:
        """Return where the axis of planet `number` (from 0) of a body stands (mm), with the carrier at angle 0."""
        return self._place(body, number)

    def _towards(self, mesh: PartMesh, number: int) -> tuple[float, float]:
        """Return the directions (rad) from the axes of both gears to where they mesh."""
        first, second = (self._place(name, number) for name in mesh)
        angle = math.atan2((second - first).imag, (second - first).real)
        return angle, angle if self._gear(mesh.first).internal else angle + math.pi

    def _off(self, mesh: PartMesh, number: int, first: Floats, second: Floats) -> Floats:
        """Return by how many pitches, -0.5 to 0.5, teeth are off the middle of their spaces at rotations (n,) in rad."""
        height = max(self.gearing.gears[name].axial_position for name in mesh)
        total: Floats = np.full(np.broadcast(first, second).shape, 0.5)
        for name, turn, towards in zip(mesh, (first, second), self._towards(mesh, number), strict=True):
            own = self.gearing.gears[name]
            total = total + own.gear.teeth * (towards - turn - twist(own.gear, height - own.axial_position)) / math.tau
        return total - np.round(total)

    @cached_property
    def _fit(self) -> tuple[dict[str, float], list[dict[str, float]], list[tuple[float, str]]]:
        """Rotations (rad) of centrals, of planets of each number, and of each number the greatest misfit and its mesh."""
        centrals: dict[str, float] = {}
        turns: list[dict[str, float]] = [{} for _ in range(self.gearing.planets)]
        misfits = [(0.0, "") for _ in turns]
        for group in self.groups:
            names = [name for name, body in self._body.items() if body in group]
            inner = [mesh for mesh in self.meshes if mesh.first in names and mesh.second in names]
            outer = [mesh for mesh in self.meshes if mesh.first in self._centrals and mesh.second in names]
            for number, own in enumerate(turns):
                if not outer:
                    raise GeometryError(f"{group[0]}.meshes", None, "must be given of a sun or a ring that meshes with it")
                root = next((mesh for mesh in outer if mesh.first in centrals), outer[0])
                centrals.setdefault(root.first, 0.0)
                found = self._turned_by(root, number, centrals[root.first], names, inner)
                judged = [mesh for mesh in (*inner, *outer) if mesh.first not in self._centrals or mesh.first in centrals]
                zero = np.zeros(1)
                off = [
                    np.abs(
                        self._off(mesh, number, found.get(mesh.first, zero + centrals.get(mesh.first, 0.0)), found[mesh.second])
                    )
                    for mesh in judged
                ]
                off = [np.broadcast_to(each, found[names[0]].shape) for each in off]
                best = int(np.argmin(np.round(np.max(off, axis=0), 9)))
                own |= {name: float(found[name][best]) for name in names}
                worst = max(((float(each[best]), mesh.name) for mesh, each in zip(judged, off, strict=True)), default=(0.0, ""))
                misfits[number] = max(misfits[number], worst)
                for mesh in outer:
                    if mesh.first not in centrals:
                        centrals[mesh.first] = self._meshing(mesh, number, own[mesh.second], of_first=True)
        return centrals, turns, misfits

    @property
    def misfits(self) -> tuple[tuple[float, str], ...]:
        """Pitches by which the teeth of each planet miss their spaces, and the mesh in which they miss them most."""
        return tuple(self._fit[2])

    def _turned_by(
        self, root: PartMesh, number: int, central: float, names: list[str], inner: list[PartMesh]
    ) -> dict[str, Floats]:
        """Return rotations (n,) in rad of the planets of a group, for each of n pitches at which its first one can stand."""
        pitches = self._pitches
        found = {root.second: self._meshing(root, number, central, of_first=False)}
        while missing := [name for name in names if name not in found]:
            for name in missing:
                for mesh in inner:
                    if mesh.second == name and mesh.first in found:
                        found[name] = self._meshing(mesh, number, found[mesh.first], of_first=False)
                    elif mesh.first == name and mesh.second in found:
                        found[name] = self._meshing(mesh, number, found[mesh.second], of_first=True)
                for other in (other for other in names if self._body[other] == self._body[name] and other in found):
                    clocking = self.gearing.gears[name].clocking - self.gearing.gears[other].clocking
                    found.setdefault(name, found[other] + math.radians(clocking))
        unit = {name: pitches[name] / pitches[root.second] for name in names}
        count = math.lcm(*(each.denominator for each in unit.values()))
        steps = np.arange(count)
        turned = {name: float(unit[name]) * math.tau / self._gear(name).teeth for name in names}
        return {name: np.asarray(found[name] + steps * turned[name], float) for name in names}

    def _meshing(self, mesh: PartMesh, number: int, turn: float, *, of_first: bool) -> float:
        """Return the rotation (rad) at which a gear meshes with its mate, which is turned by another."""
        zero, own = np.zeros(1), np.array([turn])
        name = mesh.first if of_first else mesh.second
        off = self._off(mesh, number, zero, own) if of_first else self._off(mesh, number, own, zero)
        return float(off[0]) * math.tau / self._gear(name).teeth

    def _check_teeth(self) -> None:
        """Raise GeometryError unless the teeth of all planets meet their spaces."""
        for number, (off, mesh) in enumerate(self.misfits, 1):
            if off > _MISFIT:
                why = f"must let the teeth fit: those of planet {number} are {off:.4g} pitches off in {mesh}"
                raise GeometryError("planets", self.gearing.planets, f"{why}; {self._fitting_words}")

    @property
    def _fitting_words(self) -> str:
        """Which numbers of planets have teeth that fit, and room."""
        fitting = [str(planets) for planets in range(1, MOST_PLANETS + 1) if self._would_fit(planets)]
        return f"planets = {' or '.join(fitting)} would do" if fitting else "no number of planets would do"

    def _would_fit(self, planets: int) -> bool:
        """Return whether teeth and room let so many planets stand."""
        other = SetAssembly(replace(self.subject, gearing=replace(self.gearing, planets=planets)))
        return all(off <= _MISFIT for off, _ in other.misfits) and all(each.distance > 0 for each in other.clearances)

    # ------------------------------------------------------------------ room

    @cached_property
    def clearances(self) -> tuple[Clearance, ...]:
        """Least clearance of each two names of gears at the same height that do not mesh, from planet 1 to all others."""
        least: dict[tuple[str, str], Clearance] = {}
        for first, second in itertools.combinations_with_replacement(self.gearing.gears, 2):
            one, other = self.gearing.gears[first], self.gearing.gears[second]
            if min(one.top, other.top) - max(one.axial_position, other.axial_position) <= _APART:
                continue
            for number in range(self.gearing.planets):
                if self._apart(first, second, number):
                    distance = _tip_distance(one.gear, other.gear, abs(self._place(first, 0) - self._place(second, number)))
                    names = self._called(first, 0), self._called(second, number)
                    found = Clearance(names, distance)
                    least[first, second] = min(least.get((first, second), found), found, key=lambda each: each.distance)
        return tuple(least.values())

    def _apart(self, first: str, second: str, number: int) -> bool:
        """Return whether planet 1 of the first and planet `number` (from 0) of the second are two gears that do not mesh."""
        if first == second:
            return number > 0 and first not in self._centrals
        if {first, second} <= self._centrals:
            return number == 0
        meshes = any({first, second} == set(mesh) for mesh in self.meshes)
        if first in self._centrals or second in self._centrals:
            return not meshes and number == 0
        return number > 0 or not meshes

    def _called(self, name: str, number: int) -> str:
        return name if name in self._centrals else f"{name} {number + 1}"

    def _check_room(self) -> None:
        """Raise GeometryError for gears that do not mesh and reach into each other."""
        for each in self.clearances:
            if each.distance <= 0:
                first, second = each.between
                numbers = {name.rpartition(" ")[2] for name in each.between if name not in self._centrals}
                reach = f"their tips reach {at_least(-each.distance)} mm into each other"
                if len(numbers) > 1:
                    why = f"must keep {first} and {second} apart: {reach}; {self._fitting_words}"
                    raise GeometryError("planets", self.gearing.planets, why)
                owner = second.rpartition(" ")[0] or second
                permitted = f"must keep {first} and {second} apart: {reach}"
                raise GeometryError(f"{owner}.axial_position", self.gearing.gears[owner].axial_position, permitted, "mm")

    @property
    def least_clearance(self) -> Clearance | None:
        """The least of all clearances; None where no gears stand side by side."""
        return min(self.clearances, key=lambda each: each.distance, default=None)

    # ------------------------------------------------------------------ poses and phases

    def places(self, turns: Mapping[str, float] | None = None, bottom: float = 0.0) -> dict[str, GearPlace]:
        """Return the gears in mesh by their names, such as "sun" and "planet 2", above the `bottom` of the set (mm).

        `turns` (degrees) are those of centrals, of the carrier and of the planets' bodies from where they were put together.
        """
        turns = {} if turns is None else turns
        centrals, planets, _ = self._fit
        found = {}
        for name, own in self.gearing.gears.items():
            height = bottom + own.axial_position
            if name in self._centrals:
                found[name] = GearPlace(math.degrees(centrals[name]) + turns.get(name, 0.0), 0.0, 0.0, height)
                continue
            carrier = np.exp(1j * math.radians(turns.get(self.subject.carrier, 0.0)))
            for number, rotations in enumerate(planets):
                at = complex(self._place(name, number) * carrier)
                rotation = math.degrees(rotations[name]) + turns.get(self._body[name], 0.0)
                found[self._called(name, number)] = GearPlace(rotation, at.real, at.imag, height)
        return found

    def phases(self, mesh: PartMesh, *, side: int, turning: int) -> GearboxPhases:
        """Return the phases of a mesh whose second gear, a planet, turns with `turning` against its carrier.

        1 is counter-clockwise, -1 clockwise; its left flanks carry with `side` 1, the right ones with -1. lambda = z (theta +-
        psi_w - psi)/2 pi of the flank of tooth 0, where it cuts the working circle, in the middle of the common width.
        """
        first, second = (self.gearing.gears[name] for name in mesh)
        gear, pair = second.gear, self.pairs[mesh.name]
        middle = (max(first.axial_position, second.axial_position) + min(first.top, second.top)) / 2
        half = math.radians(gear.base_half_angle) - involute(pair.working_transverse_pressure_angle)
        ahead = []
        for number, rotations in enumerate(self._fit[1]):
            flank = rotations[mesh.second] + twist(gear, middle - second.axial_position) + side * half
            ahead.append(turning * gear.teeth * (flank - self._towards(mesh, number)[1]) / math.tau)
        relative = tuple(_fraction(each - ahead[0]) for each in ahead)
        return GearboxPhases(ahead=tuple(map(_fraction, ahead)), relative=relative, left_flanks=side > 0)

    def to_dict(self) -> JsonObject:
        """Return axes, pairs, rotations and clearances (mm, degrees)."""
        centrals, planets, _ = self._fit
        axes = {body: {"radius": axis.radius, "angle": math.degrees(axis.angle)} for body, axis in self.axes.items()}
        meshes = {
            name: {
                "centre_distance": pair.centre_distance,
                "circumferential_backlash": pair.circumferential_backlash,
                "transverse_contact_ratio": pair.transverse_contact_ratio,
                "overlap_ratio": pair.overlap_ratio,
            }
            for name, pair in self.pairs.items()
        }
        rotations = {name: math.degrees(turn) for name, turn in centrals.items()}
        rotations |= {self._called(name, n): math.degrees(turn) for n, of in enumerate(planets) for name, turn in of.items()}
        return {
            "planets": self.gearing.planets,
            "axes": axes,
            "meshes": meshes,
            "rotations": rotations,
            "clearances": [{"between": list(each.between), "distance": each.distance} for each in self.clearances],
        }


def _tip_distance(one: Gear, other: Gear, apart: float) -> float:
    """Return the distance (mm) between the tips of two gears at a distance of their axes; negative where they reach into each
    other.
    """
    first, second = (abs(gear.tip_diameter) / 2 for gear in (one, other))
    if one.internal and other.internal:
        return -min(one.face_width, other.face_width)
    if one.internal:
        return first - apart - second
    if other.internal:
        return second - apart - first
    return apart - first - second


def _fraction(pitches: float) -> float:
    """Return the fraction of a number of base pitches; a rounding error below a whole pitch gives 0."""
    within = pitches % 1.0
    return 0.0 if within > 1 - 1e-9 else within

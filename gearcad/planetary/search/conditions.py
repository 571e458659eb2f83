"""What sets must meet to be assembled and to run, of many sets at once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats, Indices, Wholes
from gearcad.geometry.involute import involute
from gearcad.planetary.mesh import SetType
from gearcad.planetary.search.grid import TeethGrid
from gearcad.planetary.search.sizes import RACK, ROUNDING, MeshSizes, SetSizes, tip_radius
from gearcad.planetary.search.task import MEMBERS, SearchTask

__all__ = ["CONDITIONS", "ManySets", "ratios"]


def ratios(task: SearchTask, kind: SetType, teeth: TeethGrid) -> Floats:
    """Speed of the input over speed of the output: what is fixed adds nothing to Willis's sum."""
    row, members, roles = teeth.row, MEMBERS[kind], task.roles(kind)
    result: Floats = -row[members.index(roles.output)] / row[members.index(roles.input)]
    return result


@dataclass(frozen=True)
class ManySets:
    """Sets of one type, each with a number of planets, (n,)."""

    task: SearchTask
    kind: SetType
    teeth: TeethGrid
    planets: Wholes

    def picked(self, which: Bools | Indices) -> ManySets:
        """Those with these numbers, or where a mask is true."""
        return ManySets(self.task, self.kind, self.teeth.picked(which), self.planets[which])

    @cached_property
    def sizes(self) -> SetSizes:
        """Their centre distances and profile shifts."""
        return SetSizes.of(self.task, self.teeth, stepped=self.kind is not SetType.A)

    @property
    def ratio(self) -> Floats:
        """Speed of the input over that of the output."""
        return ratios(self.task, self.kind, self.teeth)

    @cached_property
    def efficiency(self) -> Floats:
        """From input to output, with the sign of the rolling power that agrees with itself, as `balance` has it."""
        members, roles = MEMBERS[self.kind], self.task.roles(self.kind)
        driving, driven, held = (members.index(name) for name in roles)
        speeds: list[Floats] = [np.ones_like(self.ratio)] * 3
        speeds[driven], speeds[held] = 1 / self.ratio, np.zeros_like(self.ratio)
        of_a, of_b, _ = (each.astype(float) for each in self.teeth.row)
        best = np.full_like(self.ratio, -np.inf)
        for sign in (1, -1):
            lossy = of_b * self.task.mesh_efficiency ** (2 * sign)
            torques = (of_a, lossy, -(of_a + lossy))
            with np.errstate(divide="ignore", invalid="ignore"):
                found = -torques[driven] * speeds[driven] / torques[driving]
                rolls = of_a / torques[driving] * (speeds[0] - speeds[2]) * sign >= 0
            best = np.where(rolls & (found > best), found, best)
        return best

    @property
    def in_phase(self) -> Wholes:
        """How many meshes have all planets in phase: z mod N = 0."""
        result: Wholes = (self.teeth.a % self.planets == 0).astype(int) + (self.teeth.b % self.planets == 0)
        return result

    @property
    def common(self) -> Wholes:
        """Product of the common divisors of the teeth that mesh: 1 is a hunting tooth everywhere."""
        teeth = self.teeth
        result: Wholes = np.gcd(teeth.a, teeth.rim_a) * np.gcd(teeth.b, teeth.rim_b)
        return result


def _fits(sets: ManySets) -> Bools:
    result: Bools = sets.teeth.positions % sets.planets == 0
    return result


def _coaxial(sets: ManySets) -> Bools:
    return sets.sizes.coaxial


def _whole_involutes(sets: ManySets) -> Bools:
    """No undercut of outer gears."""
    sizes = sets.sizes
    whole = np.ones(len(sets.planets), bool)
    for mesh, rim, central in zip(sizes.meshes, sizes.rim_shifts, sizes.central_shifts, strict=True):
        whole &= (rim >= mesh.least_shift(mesh.rim) - ROUNDING) & (
            mesh.ring | (central >= mesh.least_shift(mesh.central) - ROUNDING)
        )
    return whole


def _meshing(sets: ManySets) -> Bools:
    """A contact ratio of 1 or more between the tips, all of it on involutes, and no tips that foul each other in a ring."""
    sizes, good = sets.sizes, np.ones(len(sets.planets), bool)
    parts = zip(sizes.meshes, sizes.rim_tips, sizes.central_tips, sizes.rim_shifts, sizes.central_shifts, strict=True)
    for mesh, rim_tip, central_tip, rim_shift, central_shift in parts:
        angle = mesh.working_angle(sizes.distance)
        tangent = sizes.distance * np.sin(angle)
        rim, central = (_reach(mesh, teeth, tip) for teeth, tip in ((mesh.rim, rim_tip), (mesh.central, central_tip)))
        pitch = math.pi * mesh.transverse_module * math.cos(mesh.transverse_angle)
        path = np.where(mesh.ring, rim - (central - tangent), rim + central - tangent)
        begins = np.where(mesh.ring, central > tangent, np.maximum(rim, central) < tangent)
        clear = ~mesh.ring | (_tip_margin(mesh, sizes.distance, (rim_tip, central_tip), (rim_shift, central_shift)) >= 0)
        good &= (path >= pitch) & begins & clear & (central > 0)
    return good


def _reach(mesh: MeshSizes, teeth: Wholes, tip: Floats) -> Floats:
    """Length of the base tangent out to a tip circle; 0 inside the base circle."""
    base = mesh.base_radius(teeth)
    result: Floats = np.sqrt(np.maximum((tip - base) * (tip + base), 0.0))
    return result


def _tip_margin(mesh: MeshSizes, distance: Floats, tips: tuple[Floats, Floats], shifts: tuple[Floats, Floats]) -> Floats:
    """Angle by which the tips of planet and ring pass each other where their tip circles cross; infinite where they do not."""
    outer, inner = tips
    half = []  # tooth angle of the rim, space angle of the ring, at the tips
    for teeth, tip, shift, sign in zip((mesh.rim, -mesh.central), tips, shifts, (1, -1), strict=True):
        thick = (math.pi / 2 + sign * 2 * shift * math.tan(math.radians(RACK.pressure_angle))) / teeth
        at_tip = np.degrees(np.arccos(np.clip(mesh.base_radius(teeth) / tip, -1.0, 1.0)))
        half.append(thick + involute(math.degrees(mesh.transverse_angle)) - involute(at_tip))
    first = (inner**2 - outer**2 - distance**2) / (2 * distance * outer)
    second = (distance**2 + inner**2 - outer**2) / (2 * distance * inner)
    crossing = (np.abs(first) < 1) & (np.abs(second) < 1)
    angles = [np.arccos(np.clip(each, -1.0, 1.0)) for each in (first, second)]
    margin = (angles[0] - half[0]) * mesh.rim / np.abs(mesh.central) + half[1] - angles[1]
    return np.where(crossing, margin, np.inf)


def _tips_clear(sets: ManySets) -> Bools:
    """Tips stay off the roots of a ring and its planets; those at suns keep the clearance of the rack."""
    sizes, good = sets.sizes, np.ones(len(sets.planets), bool)
    parts = zip(sizes.meshes, sizes.rim_tips, sizes.central_tips, sizes.rim_shifts, sizes.central_shifts, strict=True)
    for mesh, rim_tip, central_tip, rim_shift, central_shift in parts:
        root_of_ring = -tip_radius(mesh, mesh.central, central_shift - RACK.addendum - RACK.dedendum)
        root_of_rim = tip_radius(mesh, mesh.rim, rim_shift - RACK.addendum - RACK.dedendum)
        inside = (root_of_ring - sizes.distance > rim_tip) & (central_tip - sizes.distance > root_of_rim)
        good &= ~mesh.ring | inside
    return good


def _neighbours(sets: ManySets) -> Bools:
    """Tips of planets keep their distance, rim by rim."""
    apart = 2 * sets.sizes.distance * np.sin(math.pi / sets.planets)
    most = np.maximum(*sets.sizes.rim_tips)
    result: Bools = (sets.planets == 1) | (apart - 2 * most >= sets.task.least_distance)
    return result


def _small(sets: ManySets) -> Bools:
    most = math.inf if sets.task.diameter is None else sets.task.diameter
    result: Bools = sets.sizes.diameter <= most
    return result


def _turns(sets: ManySets) -> Bools:
    result: Bools = sets.efficiency > 0
    return result


CONDITIONS: dict[str, Callable[[ManySets], Bools]] = {
    "planets at equal angles": _fits,
    "one centre distance": _coaxial,
    "no undercut": _whole_involutes,
    "clearance of tips": _tips_clear,
    "contact ratio and interference": _meshing,
    "distance of planets": _neighbours,
    "diameter": _small,
    "no self-locking": _turns,
}
"""Words of each condition, and where it is met: in this order, each of the sets that met all before."""

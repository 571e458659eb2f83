"""Centre distance, profile shifts and circles of many sets at once, by one simple rule for gears of ISO 53 A.

Magnitudes in mm; angles in radians. The centre distance is the one at which the outer gears of a mesh with a sun have
SHIFT each, as far as no shift sum leaves its limits: 0 to MOST_SHIFT_SUM at a sun, -MOST_SHIFT_SUM to 0 in a ring.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.geometry import BasicRack
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.planetary.search.grid import TeethGrid
from gearcad.planetary.search.task import MOST_SHIFT_SUM, SearchTask

__all__ = ["SHIFT", "MeshSizes", "SetSizes"]

SHIFT = 0.25
"""Profile shift that planets in rings get, and suns and planets where the centre distance lets them."""

ROUNDING = 1e-9
"""Of lengths, in modules."""

SHIFT_DIGITS = 4
"""Of the profile shifts of planets."""

RACK = BasicRack()


@dataclass(frozen=True, kw_only=True)
class MeshSizes:
    """The meshes of centrals with rims, by their signed teeth (n,), at a centre distance that may not be known yet.

    What is an array has one value for each of them (n,); lengths in mm, angles in rad.
    """

    central: Wholes
    rim: Wholes
    module: float
    helix_angle: float

    @property
    def ring(self) -> Bools:
        """Where the central is one."""
        result: Bools = self.central < 0
        return result

    @cached_property
    def transverse_angle(self) -> float:
        """alpha_t."""
        return math.atan(math.tan(math.radians(RACK.pressure_angle)) / math.cos(self.helix_angle))

    @property
    def transverse_module(self) -> float:
        """m_t."""
        return self.module / math.cos(self.helix_angle)

    @property
    def reference_distance(self) -> Floats:
        """|a_d|."""
        result: Floats = self.transverse_module * np.abs(self.central + self.rim) / 2
        return result

    @property
    def _involute(self) -> float:
        return involute(math.degrees(self.transverse_angle))

    def distance_for(self, shift_sum: Floats | float) -> Floats:
        """|a| without backlash with x_1 + x_2."""
        total = self.central + self.rim
        value = self._involute + 2 * math.tan(math.radians(RACK.pressure_angle)) * shift_sum / total
        cosine = np.cos(np.radians(inverse_involute(value)))
        result: Floats = self.reference_distance * math.cos(self.transverse_angle) / cosine
        return result

    def working_angle(self, distance: Floats) -> Floats:
        """alpha_wt."""
        result: Floats = np.arccos(self.reference_distance * math.cos(self.transverse_angle) / distance)
        return result

    def shift_sum_at(self, distance: Floats) -> Floats:
        """x_1 + x_2 without backlash at |a|."""
        change = involute(np.degrees(self.working_angle(distance))) - self._involute
        result: Floats = (self.central + self.rim) * change / (2 * math.tan(math.radians(RACK.pressure_angle)))
        return result

    @property
    def limits(self) -> tuple[Floats, Floats]:
        """Least and greatest |a| that profile shift takes up: a sun's mesh takes a positive sum, a ring's a negative one."""
        most = np.where(self.ring, -MOST_SHIFT_SUM, MOST_SHIFT_SUM)
        return self.reference_distance, self.distance_for(most)

    def base_radius(self, teeth: Wholes) -> Floats:
        """r_b, a magnitude."""
        result: Floats = self.transverse_module * np.abs(teeth) / 2 * math.cos(self.transverse_angle)
        return result

    def form_reach(self, teeth: Wholes, shift: Floats) -> Floats:
        """Length of the base tangent out to the root form circle of an outer gear; below 0 it is undercut."""
        result: Floats = self.module * (shift - self.least_shift(teeth)) / math.sin(self.transverse_angle)
        return result

    def least_shift(self, teeth: Wholes) -> Floats:
        """That of an outer gear without undercut: h_fP - rho (1 - sin alpha_n) - z sin^2 alpha_t/(2 cos beta)."""
        straight = RACK.dedendum - float(RACK.root_radius) * (1 - math.sin(math.radians(RACK.pressure_angle)))
        a_tooth = math.sin(self.transverse_angle) ** 2 / (2 * math.cos(self.helix_angle))
        result: Floats = straight - a_tooth * teeth.astype(float)
        return result


@dataclass(frozen=True, kw_only=True)
class SetSizes:
    """Sets of one type with their centre distance and profile shifts; what is not `coaxial` has no meaning."""

    meshes: tuple[MeshSizes, MeshSizes]
    stepped: bool

    @classmethod
    def of(cls, task: SearchTask, teeth: TeethGrid, *, stepped: bool) -> SetSizes:
        """Those of a grid."""
        helix = math.radians(task.helix_angle)
        pairs = ((teeth.a, teeth.rim_a), (teeth.b, teeth.rim_b))
        first, second = (
            MeshSizes(central=central, rim=rim, module=module, helix_angle=helix)
            for (central, rim), module in zip(pairs, task.modules, strict=True)
        )
        return cls(meshes=(first, second), stepped=stepped)

    @cached_property
    def _limits(self) -> tuple[Floats, Floats]:
        lows, highs = zip(*(mesh.limits for mesh in self.meshes), strict=True)
        return np.maximum(*lows), np.minimum(*highs)

    @property
    def coaxial(self) -> Bools:
        """Where one centre distance serves both meshes."""
        low, high = self._limits
        result: Bools = low <= high + ROUNDING * self.meshes[0].module
        return result

    @cached_property
    def distance(self) -> Floats:
        """|a|: the wanted one within the limits, in round figures where these are within them, too."""
        low, high = self._limits
        wanted: Floats = low
        for mesh in self.meshes:
            at_sun = np.where(mesh.ring, 0.0, mesh.distance_for(np.where(mesh.ring, 0.0, 2 * SHIFT)))
            wanted = np.maximum(wanted, at_sun).astype(float)
        wanted = np.minimum(wanted, high).astype(float)
        figures = rounded_up(wanted, -math.floor(math.log10(self.meshes[0].module / 50)))
        return np.where(figures <= high, np.maximum(figures, low), wanted)

    @cached_property
    def rim_shifts(self) -> tuple[Floats, Floats]:
        """x of the rims, to four digits; of a plain planet that of the sun's mesh for both."""
        first = self._rim_shift(self.meshes[0])
        return first, self._rim_shift(self.meshes[1]) if self.stepped else first

    def _rim_shift(self, mesh: MeshSizes) -> Floats:
        """In a ring SHIFT, at a sun half of the sum; more or less where one of the gears would be undercut."""
        total, least = mesh.shift_sum_at(self.distance), mesh.least_shift(mesh.rim)
        at_sun = np.minimum(total / 2, total - mesh.least_shift(mesh.central))
        shift = np.maximum(np.where(mesh.ring, SHIFT, at_sun), least)
        return rounded_up(shift, SHIFT_DIGITS)

    @cached_property
    def central_shifts(self) -> tuple[Floats, Floats]:
        """x of the centrals, from the centre distance."""
        first, second = (
            mesh.shift_sum_at(self.distance) - shift for mesh, shift in zip(self.meshes, self.rim_shifts, strict=True)
        )
        return first, second

    @cached_property
    def tip_alterations(self) -> tuple[Floats, Floats]:
        """k of both gears of a mesh with a sun, that keeps the tip clearance; 0 in a ring, but a plain planet has one k."""
        first, second = (self._tip_alteration(mesh) for mesh in self.meshes)
        return first, second

    def _tip_alteration(self, mesh: MeshSizes) -> Floats:
        change = (self.distance - mesh.reference_distance) / mesh.module - mesh.shift_sum_at(self.distance)
        result: Floats = np.where(mesh.ring, 0.0, np.minimum(change, 0.0))
        return result

    @cached_property
    def central_alterations(self) -> tuple[Floats, Floats]:
        """k of the centrals: of rings what ends their flanks on the planets' root form circles."""
        parts = zip(self.meshes, self.tip_alterations, self.rim_shifts, self.central_shifts, strict=True)
        first, second = (np.where(mesh.ring, self._clear_alteration(mesh, rim, central), k) for mesh, k, rim, central in parts)
        return first, second

    def _clear_alteration(self, mesh: MeshSizes, rim_shift: Floats, central_shift: Floats) -> Floats:
        """Of a ring: |d_a2| >= 2 sqrt(r_b2^2 + (|T1T2| + t_Ff1)^2)."""
        tangent = self.distance * np.sin(mesh.working_angle(self.distance)) + mesh.form_reach(mesh.rim, rim_shift)
        least = np.hypot(mesh.base_radius(mesh.central), tangent)
        change = (np.abs(tip_radius(mesh, mesh.central, central_shift)) - least) / mesh.module
        return -rounded_up(np.maximum(-change, 0.0), SHIFT_DIGITS) + 0.0

    @cached_property
    def rim_tips(self) -> tuple[Floats, Floats]:
        """Tip radii of the rims."""
        first, second = self.tip_alterations
        alterations = (first, second) if self.stepped else (np.minimum(first, second),) * 2
        one, other = (
            tip_radius(mesh, mesh.rim, shift + k)
            for mesh, shift, k in zip(self.meshes, self.rim_shifts, alterations, strict=True)
        )
        return one, other

    @cached_property
    def central_tips(self) -> tuple[Floats, Floats]:
        """Tip radii of the centrals."""
        one, other = (
            np.abs(tip_radius(mesh, mesh.central, shift + k))
            for mesh, shift, k in zip(self.meshes, self.central_shifts, self.central_alterations, strict=True)
        )
        return one, other

    @property
    def diameter(self) -> Floats:
        """The greatest over all teeth: root circles of rings, and what the planets sweep."""
        reach = [2 * (self.distance + tip) for tip in self.rim_tips]
        for mesh, shift in zip(self.meshes, self.central_shifts, strict=True):
            root = mesh.transverse_module * np.abs(mesh.central) + 2 * mesh.module * (RACK.dedendum - shift)
            reach.append(np.where(mesh.ring, root, 0.0))
        result: Floats = np.max(reach, axis=0)
        return result


def rounded_up(value: Floats, digits: int) -> Floats:
    """To so many digits behind the point, but for rounding."""
    result: Floats = np.round(np.ceil(value * 10.0**digits - 1e-6) / 10.0**digits, max(digits, 0)) + 0.0
    return result


def tip_radius(mesh: MeshSizes, teeth: Wholes, rise: Floats) -> Floats:
    """Signed r_a with x + k."""
    result: Floats = mesh.transverse_module * teeth / 2 + mesh.module * (RACK.addendum + rise)
    return result

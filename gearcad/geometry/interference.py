"""Interference of teeth in mesh: tips against fillets, and a pinion inside a ring, each with its margin.

The classical check compares circles: the lowest point that the mate's tip touches on the involute against the form
circle. It is not enough: a tip edge that leaves the involute in time may still cut the fillet further down, where the
mate rolls in closer than the tool did. So the path of the edge itself is compared with the fillet: by bounds, which are enough
for most pairs, else point by point.

On plain numbers, all of them magnitudes: lengths in mm, angles in radians. The ring's axis is the origin and the pinion's lies
on +x, where they mesh; both turn the same way, counter-clockwise, and the pinion's flanks that lead drive. "Touching" is with
these flanks in contact, all backlash behind them: so they run, and where the tips foul, backlash does not help them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry.curves import FilletChain, RootCurve
from gearcad.geometry.involute import involute

if TYPE_CHECKING:
    from gearcad.geometry.profile import ToothProfile

EdgePath = Callable[[Floats], tuple[Floats, Floats]]
"""Path of an edge of a mate, by its angle from the line of centres about the mate's axis (rad). It gives the radius (mm) about
the gear's own axis, and the angle (rad) beside the middle of the gear's tooth."""


class FilletCut(NamedTuple):
    """Depth (mm, along the circle) of the cut of a mate's tip edge into a fillet, and the diameter (mm) where it is deepest."""

    depth: float
    diameter: float


def fillet_cut(
    own: ToothProfile, mate: ToothProfile, *, centre_distance: float, pressure_angle: float, rounding: float
) -> FilletCut | None:
    """Return the deepest cut by the tip edges of `mate` into the fillet of `own` while flanks touch. None if it is no deeper
    than `rounding` (mm).

    The gears stand at a centre distance (mm) with its working transverse pressure angle (degrees). Where contact already ends
    in the fillet (d_Ff above d_Nf) the cut includes what the involute of the mate overlaps.
    """
    edges = sorted({_flank_end(mate), _land_edge(mate)})
    cuts = (_cut_by_edge(own, mate, radius, angle, centre_distance, pressure_angle) for radius, angle in edges)
    return max((cut for cut in cuts if cut and cut.depth > rounding), default=None)


def tip_edges(profile: ToothProfile) -> tuple[tuple[float, float], ...]:
    """Return the edges of a tip: radius (mm) and half tooth angle (rad), where the involute ends and, behind a chamfer, the tip
    land.
    """
    return (_flank_end(profile), _land_edge(profile)) if profile.tip_chamfer else (_land_edge(profile),)


def _flank_end(profile: ToothProfile) -> tuple[float, float]:
    return profile.tip_form_diameter / 2, math.radians(profile.half_angle(profile.tip_form_diameter / 2))


def _land_edge(profile: ToothProfile) -> tuple[float, float]:
    return profile.tip_diameter / 2, profile.land_half_angle


def deepest_cut(own: ToothProfile, path: EdgePath, farthest: float) -> FilletCut:
    """Return the deepest cut of an edge into the fillet of a gear, where the edge is within an angle (rad) of the line of
    centres.
    """
    low, high = sorted((own.root_diameter / 2, own.form_diameter / 2))
    t = np.linspace(-farthest, farthest, 513)
    for _ in range(2):
        radius, beside = path(t)
        # The edge enters at the root circle at the lowest: a pair whose tips reach further is refused.
        at = np.clip(radius, low, high)
        clear = beside - np.radians(own.half_angle(at))
        worst = int(np.argmin(clear * at))
        depth, diameter = -float(clear[worst] * at[worst]), 2 * float(at[worst])
        t = np.linspace(t[max(worst - 1, 0)], t[min(worst + 1, t.size - 1)], 65)
    return FilletCut(depth, diameter)


_STEPS = 129
_CHORDS = 65
_SURE = 1e-6
"""Steps of an edge's path, chords of a fillet, and the clearance between their bounds (rad) that is no rounding."""


@dataclass(frozen=True)
class RollingEdge:
    """The edge of a mate at `radius` (mm) from its axis that rolls on a gear with flanks touching, at a centre distance (mm).

    An edge t (rad) beyond the line of centres is at the angle A(t) about the gear's axis, while the gear has turned by
    `start` + `ratio` t from where the middle of its tooth is on that line; beyond `farthest` it is outside the form circle.
    """

    radius: float
    distance: float
    ratio: float
    start: float
    farthest: float

    @classmethod
    def of(
        cls, own: ToothProfile, mate: ToothProfile, radius: float, angle: float, distance: float, pressure_angle: float
    ) -> Self | None:
        """Return the mate's edge at `radius` (mm) and half tooth `angle` (rad); None if it stays outside the form circle of the
        gear.

        At a centre distance (mm) and its working transverse pressure angle (degrees). When the edge is t beyond the line of
        centres, the gear has turned by (t - psi_w,mate + angle) z_mate/z_gear - psi_w,gear, with the half tooth angles psi_w
        on the working pitch circles.
        """
        working = involute(pressure_angle)
        psi_own, psi_mate = (math.radians(each.base_half_angle) - working for each in (own, mate))
        cosine = (distance**2 + radius**2 - (own.form_diameter / 2) ** 2) / (2 * distance * radius)
        if cosine >= 1:
            return None
        ratio = mate.teeth / own.teeth
        return cls(radius, distance, ratio, (angle - psi_mate) * ratio - psi_own, math.acos(max(cosine, -1.0)))

    def path(self, t: Floats) -> tuple[Floats, Floats]:
        """Return the radius (mm) about the gear's axis, and the angle beside the middle of its tooth (rad)."""
        across, along = self.distance - self.radius * np.cos(t), self.radius * np.sin(t)
        return np.hypot(across, along), np.arctan2(along, across) - (self.start + self.ratio * t)

    def stays_off(self, fillet: RootCurve | FilletChain) -> bool:
        """Return whether the edge is sure to be clear of the fillet of a gear without undercut.

        In every step it is at least as far beside the tooth, and the fillet at most as far, as its bounds: A(t) - ratio t is
        concave on the one side, so no less than at the ends; on the other side convex, so above its tangents. The fillet is
        widest at the least radius, and hollow, so inside its chords.
        """
        if math.cos(self.farthest) * self.distance <= self.radius:
            return False  # A does not grow all the way
        radii, half_angles = fillet.polar(np.linspace(0.0, 1.0, _CHORDS))
        if not (np.all(np.diff(radii) > 0) and np.all(np.diff(half_angles) < 0)):
            return False
        t = np.linspace(0.0, self.farthest, _STEPS)
        cosine = np.cos(t)
        across, along = self.distance - self.radius * cosine, self.radius * np.sin(t)
        square = across**2 + along**2
        widest = np.interp(np.sqrt(square[:-1]), radii, half_angles)
        beside = np.arctan2(along, across) - self.ratio * t
        ahead = np.minimum(beside[:-1], beside[1:])
        rise = (self.ratio - self.radius * (self.distance * cosine - self.radius) / square) * t[1]
        behind = np.maximum(np.minimum(rise[:-1], 0.0) - beside[:-1], -np.maximum(rise[1:], 0.0) - beside[1:])
        return bool(np.min(np.minimum(ahead - widest - self.start, behind - widest - self.start)) > _SURE)


def _cut_by_edge(
    own: ToothProfile, mate: ToothProfile, radius: float, angle: float, distance: float, pressure_angle: float
) -> FilletCut | None:
    """Return the cut by the mate's edge at `radius` (mm) and half tooth `angle` (rad); None if it stays off the fillet."""
    edge = RollingEdge.of(own, mate, radius, angle, distance, pressure_angle)
    if edge is None or (not own.undercut and edge.stays_off(own.fillet)):
        return None
    return deepest_cut(own, edge.path, edge.farthest)


CHAMFER_POINTS = 33
"""Points of a tip chamfer that are looked at."""

_GRID = 65
_REFINEMENTS = 4


class InterferenceMargins(NamedTuple):
    """Margins (mm) of an internal pair against each interference; a negative margin means fouling.

    Along the line of action: `involute` from the base tangent point T1 to the end of the ring's tip (A); `pinion_fillet` from
    the pinion's root form circle to it; `wheel_fillet` from the end of the pinion's tip (E) to the ring's root form circle.
    Beside the mesh, along the ring's tip circle: `trochoid`, between the tips with flanks touching; and `radial`, between them
    while the pinion is pushed in along the line of centres, backlash split, in the worst of its positions.
    """

    involute: float
    pinion_fillet: float
    wheel_fillet: float
    trochoid: float
    radial: float


@dataclass(frozen=True)
class ToothTips:
    """Corners of the tips of one gear, which could foul its mate.

    `base_half_angle` (rad) is that of the profile. `edges` (radius in mm, half tooth angle in rad) go from the end of the
    involute to the tip land; they are one without a tip chamfer.
    """

    teeth: int
    base_radius: float
    base_half_angle: float
    edges: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, profile: ToothProfile) -> ToothTips:
        """Return the tips of a tooth profile."""
        edges = tip_edges(profile)
        return cls(round(profile.teeth), profile.base_diameter / 2, math.radians(profile.base_half_angle), edges)

    @classmethod
    def sharp(cls, teeth: int, base_radius: float, base_half_angle: float, tip_radius: float) -> ToothTips:
        """Return the tips of a ring without tip chamfers; radii in mm, the half angle on the base circle in radians."""
        roll = math.sqrt((tip_radius - base_radius) * (tip_radius + base_radius)) / base_radius
        return cls(teeth, base_radius, base_half_angle, ((tip_radius, base_half_angle + roll - math.atan(roll)),))

    @property
    def reach(self) -> float:
        """Roll length (mm) of the end of the involute."""
        radius = self.edges[0][0]
        return math.sqrt(max((radius - self.base_radius) * (radius + self.base_radius), 0.0))

    @cached_property
    def corner(self) -> tuple[Floats, Floats]:
        """Points between flank and tip land: radius (mm) and half tooth angle (rad), each (n,); one where it is sharp."""
        if len(self.edges) == 1:
            ((radius, angle),) = self.edges
            return np.array([radius]), np.array([angle])
        (x, y), (u, v) = ((radius * math.cos(angle), radius * math.sin(angle)) for radius, angle in self.edges)
        s = np.linspace(0.0, 1.0, CHAMFER_POINTS)
        along, across = x + s * (u - x), y + s * (v - y)
        return np.hypot(along, across), np.arctan2(across, along)


@dataclass(frozen=True)
class InternalTips:
    """Tips of a pinion inside a ring whose axis is `centre_distance` (mm) away."""

    pinion: ToothTips
    ring: ToothTips
    centre_distance: float

    @cached_property
    def pressure_angle(self) -> float:
        """Working transverse pressure angle alpha_wt (rad)."""
        return math.acos((self.ring.base_radius - self.pinion.base_radius) / self.centre_distance)

    @property
    def tangent(self) -> float:
        """Length |T1T2| of the line of action (mm)."""
        return self.centre_distance * math.sin(self.pressure_angle)

    @property
    def first(self) -> float:
        """First contact A (mm from T1)."""
        return self.ring.reach - self.tangent

    @property
    def last(self) -> float:
        """Last contact E (mm from T1)."""
        return self.pinion.reach

    @property
    def _ratio(self) -> float:
        """Turn of the ring per turn of the pinion."""
        return self.pinion.teeth / self.ring.teeth

    @cached_property
    def _working_half_angles(self) -> tuple[float, float]:
        """Half tooth angles (rad) of pinion and ring on the working pitch circles."""
        working = math.tan(self.pressure_angle) - self.pressure_angle
        return self.pinion.base_half_angle - working, self.ring.base_half_angle + working

    # ------------------------------------------------------------------ beside the mesh

    @property
    def trochoid_margin(self) -> float:
        """Least distance (mm) of the tips where their circles cross, with flanks touching; negative where they interfere.

        A point of the pinion's tip on r_1 and half angle theta_1 crosses the circle r_2 of a point of the ring's at d_1 from
        the line of centres about the pinion's axis, at d_2 about the ring's:
        r_2 [(d_1 - theta_1 + psi_w1) z_1/z_2 + psi_w2 - theta_2 - d_2] >= 0.
        """
        a, own, mate = self.centre_distance, *self._working_half_angles
        r, theta = (each[:, None] for each in self.pinion.corner)
        R, space = self.ring.corner
        if (far := a + float(R.min()) - float(r.max())) < 0:
            return far  # the tip circles do not even cross: the pinion reaches the ring's teeth on the far side
        d_1 = np.arccos(np.clip((R**2 - r**2 - a**2) / (2 * a * r), -1, 1))
        d_2 = np.arccos(np.clip((a**2 + R**2 - r**2) / (2 * a * R), -1, 1))
        return float((R * ((d_1 - theta + own) * self._ratio + mate - space - d_2)).min())

    @property
    def radial_margin(self) -> float:
        """Least distance (mm) of the tips, across the line of centres, while the pinion moves in along it; negative where they
        interfere.

        min over u of r_2 sin(u z_1/z_2 + eta_2) - r_1 sin(u + psi_1), with half tooth angle psi_1 of the pinion and half space
        angle eta_2 of the ring at their tips; u is the angle of a tooth from the line of centres.
        """
        return min(self._radial(one, other) for one, other in product(self.pinion.edges, self.ring.edges))

    def _radial(self, pinion: tuple[float, float], ring: tuple[float, float]) -> float:
        (r_1, psi_1), (r_2, theta_2) = pinion, ring
        eta_2 = math.pi / self.ring.teeth - theta_2
        low, high = 0.0, math.pi / 2
        for _ in range(_REFINEMENTS):
            u = np.linspace(low, high, _GRID)
            margin = r_2 * np.sin(u * self._ratio + eta_2) - r_1 * np.sin(u + psi_1)
            least = int(np.argmin(margin))
            low, high = u[max(least - 1, 0)], u[min(least + 1, _GRID - 1)]
        return float(margin[least])

    # ------------------------------------------------------------------ paths of edges

    def in_ring(self, radius: float, angle: float) -> EdgePath:
        """Return the path of a point of the pinion, at `radius` and half tooth `angle`,
        before the ring's flank that it faces.
        """
        own, mate = self._working_half_angles

        def path(t: Floats) -> tuple[Floats, Floats]:
            across, along = self.centre_distance + radius * np.cos(t), radius * np.sin(t)
            turned = mate + (t - angle + own) * self._ratio
            return np.hypot(across, along), turned - np.arctan2(along, across)

        return path

    def in_pinion(self, radius: float, angle: float) -> EdgePath:
        """Return the path of a point of the ring, at `radius` and half tooth `angle`,
        before the pinion's flank that it faces.
        """
        own, mate = self._working_half_angles

        def path(t: Floats) -> tuple[Floats, Floats]:
            across, along = radius * np.cos(t) - self.centre_distance, radius * np.sin(t)
            turned = (t + angle - mate) / self._ratio - own
            return np.hypot(across, along), np.arctan2(along, across) - turned

        return path


def internal_fillet_cut(own: ToothProfile, mate: ToothProfile, *, centre_distance: float, rounding: float) -> FilletCut | None:
    """Return the deepest cut by the tip edges of `mate` into the fillet of `own` while flanks touch. One of the gears is a
    ring.

    None if the cut is no deeper than `rounding` (mm). Where contact already ends in the fillet the cut includes what the
    involute of the mate overlaps.
    """
    pinion, ring = (mate, own) if own.internal else (own, mate)
    tips = InternalTips(ToothTips.of(pinion), ToothTips.of(ring), centre_distance)
    form = own.form_diameter / 2
    path_of: Callable[[float, float], EdgePath] = tips.in_ring if own.internal else tips.in_pinion

    def cut(radius: float, angle: float) -> FilletCut | None:
        # Beyond the ring's form circle, or within the pinion's, is the edge at less than this from the line of centres.
        side = 1 if own.internal else -1
        cosine = side * (form**2 - centre_distance**2 - radius**2) / (2 * centre_distance * radius)
        return None if cosine >= 1 else deepest_cut(own, path_of(radius, angle), math.acos(max(cosine, -1.0)))

    cuts = (cut(*edge) for edge in tip_edges(mate))
    return max((each for each in cuts if each and each.depth > rounding), default=None)

"""Fillet interference: whether the tip of one gear sweeps through the fillet of its mate.

The classical check compares circles: the lowest point that the mate's tip touches on the involute against the form
circle. It is not enough: a tip edge that leaves the involute in time may still cut the fillet further down, where the
mate rolls in closer than the tool did. So the path of the edge itself is compared with the fillet: by bounds, which are enough
for most pairs, else point by point.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.curves import Fillet
from gearcad.geometry.involute import involute
from gearcad.geometry.profile import ToothProfile

__all__ = ["EdgePath", "FilletCut", "RollingEdge", "deepest_cut", "fillet_cut", "tip_edges"]

EdgePath = Callable[[Floats], tuple[Floats, Floats]]
"""Where an edge of a mate is, by its angle from the line of centres about the mate's axis (rad): the radius (mm) about the
gear's own axis, and the angle (rad) by which it is beside the middle of the gear's tooth."""


class FilletCut(NamedTuple):
    """How deep (mm, along the circle) a mate's tip edge cuts into a fillet, and on which diameter (mm) it is deepest."""

    depth: float
    diameter: float


def fillet_cut(
    own: ToothProfile, mate: ToothProfile, *, centre_distance: float, pressure_angle: float, rounding: float
) -> FilletCut | None:
    """What the tip edges of `mate` cut from the fillet of `own` while flanks touch; None if it is no more than `rounding`.

    At a centre distance (mm) and its working transverse pressure angle (degrees). Where contact already ends in the fillet
    (d_Ff above d_Nf) this includes what the involute of the mate overlaps.
    """
    edges = sorted({_flank_end(mate), _land_edge(mate)})
    cuts = (_cut_by_edge(own, mate, radius, angle, centre_distance, pressure_angle) for radius, angle in edges)
    return max((cut for cut in cuts if cut and cut.depth > rounding), default=None)


def tip_edges(profile: ToothProfile) -> tuple[tuple[float, float], ...]:
    """Edges of a tip: radius (mm) and half tooth angle (rad), where the involute ends and, behind a chamfer, the tip land."""
    return (_flank_end(profile), _land_edge(profile)) if profile.tip_chamfer else (_land_edge(profile),)


def _flank_end(profile: ToothProfile) -> tuple[float, float]:
    return profile.tip_form_diameter / 2, math.radians(profile.half_angle(profile.tip_form_diameter / 2))


def _land_edge(profile: ToothProfile) -> tuple[float, float]:
    return profile.tip_diameter / 2, profile.land_half_angle


def deepest_cut(own: ToothProfile, path: EdgePath, farthest: float) -> FilletCut:
    """The deepest cut of an edge into the fillet of a gear, where the edge is within an angle (rad) of the line of centres."""
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
        """The mate's edge at `radius` (mm) and half tooth `angle` (rad); None if it stays outside the form circle of the gear.

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
        """Radius (mm) about the gear's axis, and the angle beside the middle of its tooth (rad)."""
        across, along = self.distance - self.radius * np.cos(t), self.radius * np.sin(t)
        return np.hypot(across, along), np.arctan2(along, across) - (self.start + self.ratio * t)

    def stays_off(self, fillet: Fillet) -> bool:
        """True if the edge is sure to be clear of the fillet of a gear without undercut.

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
    """The cut by the mate's edge at `radius` (mm) and half tooth `angle` (rad); None if it stays off the fillet."""
    edge = RollingEdge.of(own, mate, radius, angle, distance, pressure_angle)
    if edge is None or (not own.undercut and edge.stays_off(own.fillet)):
        return None
    return deepest_cut(own, edge.path, edge.farthest)

"""Fillet interference: whether the tip of one gear sweeps through the fillet of its mate.

The classical check compares circles: the lowest point that the mate's tip touches on the involute against the form
circle. It is not enough: a tip edge that leaves the involute in time may still cut the fillet further down, where the
mate rolls in closer than the tool did. So the path of the edge itself is compared with the fillet.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.involute import involute
from gearcad.geometry.profile import ToothProfile

__all__ = ["EdgePath", "FilletCut", "deepest_cut", "fillet_cut", "tip_edges"]

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
    return profile.tip_diameter / 2, float(profile.curves[-1].polar(0.0)[1])


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


def _cut_by_edge(
    own: ToothProfile, mate: ToothProfile, radius: float, angle: float, distance: float, pressure_angle: float
) -> FilletCut | None:
    """The cut by the mate's edge at `radius` (mm) and half tooth `angle` (rad); None if it stays outside the form circle.

    The mate rolls on the gear with flanks touching: when the edge is t beyond the line of centres, the gear has turned by
    (t - psi_w,mate + angle) z_mate/z_gear - psi_w,gear, with the half tooth angles psi_w on the working pitch circles.
    """
    working = involute(pressure_angle)
    psi_own, psi_mate = (math.radians(each.base_half_angle) - working for each in (own, mate))
    cosine = (distance**2 + radius**2 - (own.form_diameter / 2) ** 2) / (2 * distance * radius)
    if cosine >= 1:
        return None

    def path(t: Floats) -> tuple[Floats, Floats]:
        across, along = distance - radius * np.cos(t), radius * np.sin(t)
        turned = (t - psi_mate + angle) * (mate.teeth / own.teeth) - psi_own
        return np.hypot(across, along), np.arctan2(along, across) - turned

    return deepest_cut(own, path, math.acos(max(cosine, -1.0)))

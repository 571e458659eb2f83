"""Fillet interference: whether the tip of one gear sweeps through the fillet of its mate.

The classical check compares circles: the lowest point that the mate's tip touches on the involute against the form
circle. It is not enough: a tip edge that leaves the involute in time may still cut the fillet further down, where the
mate rolls in closer than the tool did. So the path of the edge itself is compared with the fillet.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.geometry.involute import involute

if TYPE_CHECKING:
    from gearcad.geometry.gear import Gear
    from gearcad.geometry.pair import GearPair

__all__ = ["FilletCut", "fillet_cut"]

DEEPEST_ROUNDING = 1e-9
"""Overlap of edge and fillet, in normal modules, that counts as rounding."""


class FilletCut(NamedTuple):
    """How deep (mm, along the circle) a mate's tip edge cuts into a fillet, and on which diameter (mm) it is deepest."""

    depth: float
    diameter: float


def fillet_cut(pair: GearPair, gear: Gear, mate: Gear) -> FilletCut | None:
    """What the tip edges of `mate` cut from the fillet of `gear` while the flanks of the pair touch; None if nothing.

    Where contact already ends in the fillet (d_Ff above d_Nf) this includes what the involute of the mate overlaps.
    """
    edges = {(mate.tip_form_diameter / 2, math.radians(mate.profile.half_angle(mate.tip_form_diameter / 2)))}
    edges.add((mate.tip_diameter / 2, float(mate.profile.curves[-1].polar(0.0)[1])))
    cuts = [cut for radius, angle in sorted(edges) if (cut := _cut_by_edge(pair, gear, mate, radius, angle))]
    return max(cuts, default=None)


def _cut_by_edge(pair: GearPair, gear: Gear, mate: Gear, radius: float, angle: float) -> FilletCut | None:
    """The cut by the edge of `mate` at `radius` (mm) and half tooth angle `angle` (rad).

    The mate rolls on the gear with flanks touching: when the edge is t beyond the line of centres, the gear has turned by
    (t - psi_w,mate + angle) z_mate/z_gear - psi_w,gear, with the half tooth angles psi_w on the working pitch circles.
    """
    distance, ratio = pair.centre_distance, mate.teeth / gear.teeth
    working = involute(pair.working_transverse_pressure_angle)
    own, other = (math.radians(one.profile.base_half_angle) - working for one in (gear, mate))
    reach = gear.form_diameter / 2
    cosine = (distance**2 + radius**2 - reach**2) / (2 * distance * radius)
    if cosine >= 1:  # the edge stays outside the form circle
        return None
    farthest = math.acos(max(cosine, -1.0))
    t = np.linspace(-farthest, farthest, 513)
    for _ in range(2):
        across, along = distance - radius * np.cos(t), radius * np.sin(t)
        # The edge enters at the root circle at the lowest: a pair whose tips reach further is refused.
        at = np.clip(np.hypot(across, along), gear.root_diameter / 2, reach)
        turned = (t - other + angle) * ratio - own
        clear = np.arctan2(along, across) - turned - np.radians(gear.profile.half_angle(at))
        worst = int(np.argmin(clear * at))
        depth, diameter = -float(clear[worst] * at[worst]), 2 * float(at[worst])
        t = np.linspace(t[max(worst - 1, 0)], t[min(worst + 1, t.size - 1)], 65)
    return FilletCut(depth, diameter) if depth > DEEPEST_ROUNDING * gear.normal_module else None

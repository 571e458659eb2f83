"""Tips of a pinion and a rack in each other's fillets: the way of their edges against the exact outlines.

As with gears (see `interference`) the classical comparison of lines is not enough: an edge that leaves the flank in time may
still cut the fillet further down.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.profile import ToothProfile
from gearcad.geometry.rack_profile import RackProfile

__all__ = ["EdgeCut", "RackPlace", "cut_by_pinion", "cut_by_rack"]

_STEPS = 513
_FINE = 65


class EdgeCut(NamedTuple):
    """How deep an edge cuts (mm, along pitch line or circle; below 0 it stays clear), and where it is deepest."""

    depth: float
    place: float


class RackPlace(NamedTuple):
    """How a rack stands to its pinion while their flanks touch (mm).

    `distance` of the reference line from the axis, and how far along the pitch line the middles of two teeth in contact are
    apart there: half of both transverse thicknesses.
    """

    distance: float
    touching: float


def cut_by_rack(pinion: ToothProfile, rack: RackProfile, place: RackPlace) -> EdgeCut:
    """What the tip edges of a rack cut from the pinion's fillet while flanks touch; the place is a diameter (mm) there."""
    working, reach = pinion.reference_diameter / 2, pinion.form_diameter / 2

    def clearance(height: float, half: float) -> tuple[float, Callable[[Floats], tuple[Floats, Floats]]]:
        distance = place.distance - height
        farthest = math.sqrt(max(reach**2 - distance**2, 0.0))

        def clear(t: Floats) -> tuple[Floats, Floats]:
            # The edge is t beyond the line of centres; the pinion has then rolled by (t + half - place.touching)/r.
            at = np.clip(np.hypot(distance, t), pinion.root_diameter / 2, reach)
            turned = (t + half - place.touching) / working
            return at, (np.arctan2(t, distance) - turned - np.radians(pinion.half_angle(at))) * at

        return farthest, clear

    cuts = []
    for height, half in _rack_edges(rack):
        farthest, clear = clearance(height, half)
        if farthest > 0:
            at, depth = _deepest(clear, farthest)
            cuts.append(EdgeCut(depth, 2 * at))
    return max(cuts, default=EdgeCut(0.0, 0.0))


def cut_by_pinion(pinion: ToothProfile, rack: RackProfile, place: RackPlace) -> EdgeCut:
    """The same of the pinion's tip edges in the rack's fillet; the place is a height over the reference line (mm)."""
    working = pinion.reference_diameter / 2
    edges = {(pinion.tip_form_diameter / 2, math.radians(pinion.half_angle(pinion.tip_form_diameter / 2)))}
    edges.add((pinion.tip_diameter / 2, float(pinion.curves[-1].polar(0.0)[1])))
    cuts = []
    for radius, angle in sorted(edges):
        cosine = (place.distance + rack.form_depth) / radius
        if cosine >= 1:
            continue

        def clear(t: Floats, radius: float = radius, angle: float = angle) -> tuple[Floats, Floats]:
            # The edge is at the angle t, so the pinion has turned by t - angle, and the rack has moved with it.
            height = np.clip(place.distance - radius * np.cos(t), -rack.root_depth, -rack.form_depth)
            middle = working * (t - angle) + place.touching
            return height, middle - radius * np.sin(t) - rack.half_thickness(height)

        at, depth = _deepest(clear, math.acos(cosine))
        cuts.append(EdgeCut(depth, at))
    return max(cuts, default=EdgeCut(0.0, 0.0))


def _rack_edges(rack: RackProfile) -> list[tuple[float, float]]:
    """Height and half thickness (mm) at the ends of the flank and of the tip land."""
    end, tip = rack.tip_height - rack.tip_chamfer, rack.tip_height
    return sorted({(end, rack.half_thickness_on_flank(end)), (tip, rack.half_thickness(tip))})


def _deepest(clear: Callable[[Floats], tuple[Floats, Floats]], farthest: float) -> tuple[float, float]:
    """Where (the first result) the second one is least between -farthest and farthest, and how far below zero it is."""
    t = np.linspace(-farthest, farthest, _STEPS)
    for _ in range(3):
        at, room = clear(t)
        worst = int(np.argmin(room))
        found = float(at[worst]), -float(room[worst])
        t = np.linspace(t[max(worst - 1, 0)], t[min(worst + 1, t.size - 1)], _FINE)
    return found

"""The outline of a tooth and half a space on both sides, standing upright: tip of a gear's tooth up, of a ring's down.

Lengths in mm of the part, about the axis of a gear or the middle of a rack's tooth on its reference line.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from gearcad.arrays import Floats
from gearcad.drawing.shapes import Vertex
from gearcad.geometry import Gear, Rack
from gearcad.geometry.curves import PlaneCurve
from gearcad.geometry.rack_profile import FilletArc
from gearcad.solids.files.arcs import Arcs, arcs_of, joined

__all__ = ["tooth_outline"]

ACCURACY = 0.0005
"""Greatest distance (mm of the part) of the outline from the exact curve."""

_NOTHING = 1e-9
"""Length (mm) of a curve that is but a point."""


def tooth_outline(gear: Gear | Rack) -> tuple[Vertex, ...]:
    """From the middle of the space on the left to that on the right: the exact profile, without modifications, as arcs."""
    half = _half_of_rack(gear) if isinstance(gear, Rack) else _half_of_gear(gear)
    x, y = half.vertices.T
    vertices = np.concatenate([half.vertices, np.stack([-x, y], -1)[-2::-1]])
    bulges = np.r_[half.bulges, half.bulges[::-1], 0.0]
    return tuple((float(x), float(y), float(bulge)) for (x, y), bulge in zip(vertices, bulges, strict=True))


def _half_of_gear(gear: Gear) -> Arcs:
    """What stands on +x in the profile is turned to +y: the flank with y > 0 is then that on the left."""
    half = _arcs(gear.profile.curves)
    x, y = half.vertices.T
    return Arcs(np.stack([-y, x], -1), half.bulges)


def _half_of_rack(rack: Rack) -> Arcs:
    return _arcs(rack.profile.curves)


def _arcs(curves: Iterable[PlaneCurve]) -> Arcs:
    """Curves in a row; lands are whole arcs."""
    return joined([_arc(curve) for curve in curves if _length(curve) > _NOTHING])


def _length(curve: PlaneCurve) -> float:
    start, end = curve.points(np.array([0.0, 1.0]))
    return math.dist(start, end)


def _arc(curve: PlaneCurve) -> Arcs:
    """One arc where the curve is one, or a line; pairs of them of involute and trochoid."""
    ends = np.array([0.0, 1.0])
    heading: Floats = curve.direction(ends)
    if _turns_evenly(curve):
        return Arcs(curve.points(ends), np.array([math.tan((heading[1] - heading[0]) / 4)]))
    return arcs_of(curve, ACCURACY)


def _turns_evenly(curve: PlaneCurve) -> bool:
    """Whether a curve is a line or an arc of a circle: lands, chamfers, flanks of racks, fillets of spur racks."""
    if isinstance(curve, FilletArc):
        return curve.stretch == 1
    return curve.kind.value not in ("trochoid", "involute")

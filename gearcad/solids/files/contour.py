"""The transverse profile as modified, as one closed contour of true arcs."""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.turned import middle_section
from gearcad.solids.files.arcs import arcs_of, joined

__all__ = ["extent_of", "gear_contour"]


def gear_contour(gear: Gear, accuracy: float = 0.0005) -> Floats:
    """Closed contour (n, 3), counter-clockwise: x, y in mm and the bulge of the arc to the next vertex, as in DXF.

    The lands are single arcs, tip chamfers straight, involute and trochoid pairs of arcs that follow the exact tangents
    and stay within `accuracy` (mm) of the exact curve. Every joint is one shared vertex; the last arc ends in the first.
    Profile modifications are in it as they are at mid face width. On a ring what it encloses is the opening.
    """
    require_number("accuracy", accuracy, "mm", at_least=1e-7)
    curves = middle_section(gear)
    flank = joined([arcs_of(curve, accuracy) for curve in curves if curve.kind not in (CurveKind.ROOT, CurveKind.TIP)])
    half_pitch = math.pi / gear.tooth_count
    land = curves[0].kind is CurveKind.ROOT
    if not land:  # the fillet ends in the middle of the space, where that of the next tooth begins
        flank.vertices[0] = gear.profile.root_diameter / 2 * np.array([math.cos(half_pitch), math.sin(half_pitch)])
    right, left = flank.vertices * [1, -1], flank.vertices[::-1]
    root_angle, tip_angle = (math.atan2(flank.vertices[i, 1], flank.vertices[i, 0]) for i in (0, -1))
    lands = math.tan(tip_angle / 2), math.tan((half_pitch - root_angle) / 2)
    x, y = np.concatenate([right, left]).T
    bulge = np.r_[-flank.bulges, lands[0], -flank.bulges[::-1], lands[1]]
    if not land:
        x, y, bulge = x[:-1], y[:-1], bulge[:-1]
    turn = 2 * half_pitch * np.arange(gear.tooth_count)[:, None]
    cosine, sine = np.cos(turn), np.sin(turn)
    columns = np.broadcast_arrays(cosine * x - sine * y, sine * x + cosine * y, bulge)
    return np.stack(columns, -1).reshape(-1, 3)


def extent_of(contour: Floats) -> tuple[Floats, Floats]:
    """Least and greatest x and y (mm) of a closed contour (n, 3) of arcs: at vertices, or where an arc is level or upright."""
    start, bulge = contour[:, :2], contour[:, 2]
    chord = np.roll(start, -1, axis=0) - start
    with np.errstate(divide="ignore", invalid="ignore"):  # straight ones have no centre, and no point inside
        middle = start + chord / 2 + (0.25 / bulge - 0.25 * bulge)[:, None] * np.stack([-chord[:, 1], chord[:, 0]], -1)
        radius = np.hypot(*(start - middle).T)
        ends = middle[:, None] + radius[:, None, None] * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
        away = ends - start[:, None]
        # An arc is what of its circle lies right of its chord if it turns left, and the other way round.
        inside = (chord[:, None, 0] * away[..., 1] - chord[:, None, 1] * away[..., 0]) * bulge[:, None] < 0
    points = np.concatenate([start, ends[inside]])
    return points.min(axis=0), points.max(axis=0)

"""DXF of the transverse profile as modified: one closed contour of true arcs for laser and wire cutting."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import SolverError, require_number
from gearcad.geometry import Body, Gear
from gearcad.geometry.curves import Curve, CurveKind
from gearcad.solids.turned import middle_section

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import Modelspace

__all__ = ["gear_contour", "write_dxf"]


_LAYERS = {"PROFILE": (7, "CONTINUOUS"), "BORE": (7, "CONTINUOUS")}
_CIRCLES = {"CIRCLES": (8, "CENTER")}
"""Colour (AutoCAD index) and line type of layers; circles are grey and dash-dotted, as they are not to be cut."""

_CHECKED = np.linspace(0.0, 1.0, 17)[1:-1]
"""Where between its ends a pair of arcs is compared with the curve."""

_MOST_PAIRS = 1000

_fixed_meta_data = Lock()
"""Held while the global option of ezdxf is changed, so that threads do not restore each other's value."""

_MILLIMETRES, _METRIC = 4, 1


@dataclass(frozen=True)
class _Arcs:
    """A chain of arcs: `vertices` (n + 1, 2) in mm, `bulges` (n,), tan of a quarter of the arc's angle (0: straight)."""

    vertices: Floats
    bulges: Floats


def write_dxf(gear: Gear, path: Path | str, *, accuracy: float = 0.0005, circles: bool = False) -> None:
    """Write the transverse section as DXF (R2010, mm): tooth 0 on +x.

    The flanks are as modified at mid face width, where modifications along the face are nothing (see `middle_section`).
    Layer PROFILE holds the contour, one closed polyline of arcs (see `gear_contour`); BORE the bore, a circle, or with a
    keyway a closed polyline; CIRCLES, with `circles`, the tip, reference, base and root circles, which are not to be cut.
    The header states how far the drawing reaches. Equal input gives equal bytes.
    Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    import ezdxf

    contour = gear_contour(gear, accuracy)
    with _fixed_meta_data:
        # The only way to keep ezdxf from writing the time and new identifiers into the file is this global option.
        before = ezdxf.options.write_fixed_meta_data_for_testing
        ezdxf.options.write_fixed_meta_data_for_testing = True
        try:
            document = _document()
            space = document.modelspace()
            space.add_lwpolyline(contour.tolist(), format="xyb", close=True, dxfattribs={"layer": "PROFILE"})
            _draw_bore(space, gear.body)
            low, high = _extent(contour)
            if circles:
                low, high = _draw_circles(document, gear)
            space.reset_extents((*low, 0.0), (*high, 0.0))
            with Path(path).open("w", encoding=document.output_encoding, errors="dxfreplace", newline="\n") as stream:
                document.write(stream)
        finally:
            ezdxf.options.write_fixed_meta_data_for_testing = before


def gear_contour(gear: Gear, accuracy: float = 0.0005) -> Floats:
    """Closed contour (n, 3), counter-clockwise: x, y in mm and the bulge of the arc to the next vertex, as in DXF.

    The lands are single arcs, tip chamfers straight, involute and trochoid pairs of arcs that follow the exact tangents
    and stay within `accuracy` (mm) of the exact curve. Every joint is one shared vertex; the last arc ends in the first.
    Profile modifications are in it as they are at mid face width.
    """
    require_number("accuracy", accuracy, "mm", at_least=1e-7)
    curves = middle_section(gear)
    flank = _joined([_arcs_of(curve, accuracy) for curve in curves if curve.kind not in (CurveKind.ROOT, CurveKind.TIP)])
    half_pitch = math.pi / gear.teeth
    land = curves[0].kind is CurveKind.ROOT
    if not land:  # the fillet ends in the middle of the space, where that of the next tooth begins
        flank.vertices[0] = gear.root_diameter / 2 * np.array([math.cos(half_pitch), math.sin(half_pitch)])
    right, left = flank.vertices * [1, -1], flank.vertices[::-1]
    root_angle, tip_angle = (math.atan2(flank.vertices[i, 1], flank.vertices[i, 0]) for i in (0, -1))
    lands = math.tan(tip_angle / 2), math.tan((half_pitch - root_angle) / 2)
    x, y = np.concatenate([right, left]).T
    bulge = np.r_[-flank.bulges, lands[0], -flank.bulges[::-1], lands[1]]
    if not land:
        x, y, bulge = x[:-1], y[:-1], bulge[:-1]
    turn = 2 * half_pitch * np.arange(gear.teeth)[:, None]
    cosine, sine = np.cos(turn), np.sin(turn)
    columns = np.broadcast_arrays(cosine * x - sine * y, sine * x + cosine * y, bulge)
    return np.stack(columns, -1).reshape(-1, 3)


# ---------------------------------------------------------------------- curves as arcs


def _arcs_of(curve: Curve, accuracy: float) -> _Arcs:
    """A curve as pairs of arcs, as few as stay within `accuracy`; the pairs are shorter where its curvature changes fast."""
    if curve.kind is CurveKind.CHAMFER:
        return _Arcs(curve.points(np.array([0.0, 1.0])), np.zeros(1))
    fine = np.linspace(0.0, 1.0, 257)
    length = np.hypot(*np.diff(curve.points(fine), axis=0).T)
    curvature = np.diff(curve.direction(fine)) / length
    # A pair of arcs over the length h is off by some |curvature'| h^3, so each takes an equal share of this effort.
    effort = np.cbrt(np.abs(np.gradient(curvature)) * length**2)
    effort = np.r_[0.0, np.cumsum(effort + 1e-3 * effort.max() + 1e-12)]
    pairs = 1
    while pairs <= _MOST_PAIRS:
        s = np.interp(np.linspace(0.0, effort[-1], pairs + 1), effort, fine)
        arcs = _pairs_of_arcs(curve, s)
        error = _deviation(curve, s, arcs)
        if error <= accuracy:
            return arcs
        pairs = max(pairs + 1, math.floor(pairs * (error / accuracy) ** (1 / 3)))
    raise SolverError(f"the {curve.kind.value} cannot be drawn within {accuracy:g} mm by {_MOST_PAIRS} pairs of arcs")


def _pairs_of_arcs(curve: Curve, s: Floats) -> _Arcs:
    """Biarcs through the points at s (n + 1,) with the exact tangents there: 2 n arcs.

    The tangents at both ends of a pair have equal lengths d up to where they meet the common tangent of its two arcs.
    """
    points, heading = curve.points(s), curve.direction(s)
    tangent = np.stack([np.cos(heading), np.sin(heading)], -1)
    start, end, first, last = points[:-1], points[1:], tangent[:-1], tangent[1:]
    chord = end - start
    along = np.sum(chord * (first + last), -1)
    square = np.sum(chord * chord, -1)
    opening = 4 * np.sin(np.diff(heading) / 2) ** 2
    d = square / (along + np.sqrt(along**2 + opening * square))
    joint = 0.5 * (start + end + d[:, None] * (first - last))
    bulges = np.stack([_half_tangent(first, joint - start), _half_tangent(end - joint, last)], -1).ravel()
    vertices = np.concatenate([np.stack([start, joint], 1).reshape(-1, 2), end[-1:]])
    return _Arcs(vertices, bulges)


def _half_tangent(one: Floats, other: Floats) -> Floats:
    """Tangent of half the angle from one vector to another, (n, 2) each."""
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    result: Floats = np.tan(0.5 * np.arctan2(cross, np.sum(one * other, -1)))
    return result


def _deviation(curve: Curve, s: Floats, arcs: _Arcs) -> float:
    """Largest distance (mm) of points of the curve from the pair of arcs between s[i] and s[i + 1]."""
    points = curve.points(s[:-1, None] + np.diff(s)[:, None] * _CHECKED)
    starts, ends = arcs.vertices[:-1].reshape(-1, 2, 1, 2), arcs.vertices[1:].reshape(-1, 2, 1, 2)
    bulge = arcs.bulges.reshape(-1, 2, 1)
    half = 0.5 * (ends - starts)
    size = np.hypot(half[..., 0], half[..., 1])
    offset = points[:, None] - 0.5 * (starts + ends)
    across = (half[..., 0] * offset[..., 1] - half[..., 1] * offset[..., 0]) / size
    # The circle in the frame of its chord: b (x^2 + y^2 - c^2) = y c (1 - b^2), gradient c (1 + b^2) on the circle.
    square = np.sum(offset**2, -1) - size**2
    distance = np.abs(bulge * square - across * size * (1 - bulge**2)) / (size * (1 + bulge**2))
    forward = np.sum((points[:, None] - ends[:, :1]) * half[:, :1], -1)[:, 0] > 0  # beyond the joint of the pair
    return float(np.where(forward, distance[:, 1], distance[:, 0]).max())


def _joined(chains: list[_Arcs]) -> _Arcs:
    vertices = [chains[0].vertices[:1], *(chain.vertices[1:] for chain in chains)]
    return _Arcs(np.concatenate(vertices), np.concatenate([chain.bulges for chain in chains]))


# ---------------------------------------------------------------------- drawing


def _document() -> Drawing:
    import ezdxf

    document = ezdxf.new("R2010", setup=["linetypes"])
    # ezdxf adds these from a set when it writes, in an order that changes from process to process.
    document.classes.add_required_classes(document.dxfversion)
    document.classes.classes = OrderedDict(sorted(document.classes.classes.items()))
    document.header["$INSUNITS"], document.header["$MEASUREMENT"] = _MILLIMETRES, _METRIC
    _add_layers(document, _LAYERS)
    return document


def _add_layers(document: Drawing, layers: Mapping[str, tuple[int, str]]) -> None:
    for name, (colour, linetype) in layers.items():
        document.layers.add(name, color=colour, linetype=linetype)


def _draw_circles(document: Drawing, gear: Gear) -> tuple[Floats, Floats]:
    """The circles of reference; how far they reach."""
    _add_layers(document, _CIRCLES)
    for diameter in (gear.tip_diameter, gear.reference_diameter, gear.base_diameter, gear.root_diameter):
        document.modelspace().add_circle((0, 0), diameter / 2, dxfattribs={"layer": "CIRCLES"})
    reach = np.full(2, gear.tip_diameter / 2)
    return -reach, reach


def _extent(contour: Floats) -> tuple[Floats, Floats]:
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


def _draw_bore(space: Modelspace, body: Body) -> None:
    radius, half_width = body.bore / 2, body.keyway_width / 2
    if not radius:
        return
    if not half_width:
        space.add_circle((0, 0), radius, dxfattribs={"layer": "BORE"})
        return
    end = math.asin(half_width / radius)
    corner, floor = radius * math.cos(end), radius + body.keyway_depth
    # The arc goes the long way round, from the keyway's upper to its lower wall.
    points = [
        (corner, half_width, math.tan((math.pi - end) / 2)),
        (corner, -half_width, 0.0),
        (floor, -half_width, 0.0),
        (floor, half_width, 0.0),
    ]
    space.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": "BORE"})

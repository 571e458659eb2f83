"""DXF of transverse profiles as modified: closed contours of true arcs for laser and wire cutting."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.dxf import CUT, NOT_CUT, add_layers, drawing
from gearcad.core.errors import SolverError, require_number
from gearcad.core.records import Floats
from gearcad.geometry import Body, Gear
from gearcad.geometry.bore_teeth import bore_teeth
from gearcad.geometry.curves import Chamfer, Curve, CurveKind, PlaneCurve
from gearcad.geometry.gear import middle_section
from gearcad.geometry.rack import Rack
from gearcad.geometry.rack_root import RackCurveKind
from gearcad.solids.body_plan import SNAP, OutlinePiece, keyway_half_angle, outline_pieces

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import Modelspace


_CHECKED = np.linspace(0.0, 1.0, 33)
"""Places where a pair of arcs is compared with the curve."""

_UNSEEN = 1e-3
"""Share of a deviation by which its peak may be higher than it looks from there."""

_MOST_PAIRS = 1000


@dataclass(frozen=True)
class Arcs:
    """A chain of arcs: `vertices` (n + 1, 2) in mm, `bulges` (n,), tan of a quarter of the arc's angle (0: straight)."""

    vertices: Floats
    bulges: Floats


def arcs_of(curve: PlaneCurve, accuracy: float) -> Arcs:
    """Return a curve as pairs of arcs, as few as stay within `accuracy`; the pairs are shorter where its curvature changes
    fast.
    """
    if isinstance(getattr(curve, "curve", curve), Chamfer):
        return Arcs(curve.points(np.array([0.0, 1.0])), np.zeros(1))
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
        error = (1 + _UNSEEN) * _deviation(curve, s, arcs)
        if error <= accuracy:
            return arcs
        pairs = max(pairs + 1, math.floor(pairs * (error / accuracy) ** (1 / 3)))
    raise SolverError(f"the {curve.kind.value} cannot be drawn within {accuracy:g} mm by {_MOST_PAIRS} pairs of arcs")


def _pairs_of_arcs(curve: PlaneCurve, s: Floats) -> Arcs:
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
    return Arcs(vertices, bulges)


def _half_tangent(one: Floats, other: Floats) -> Floats:
    """Return the tangent of half the angle from one vector to another, (n, 2) each."""
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    result: Floats = np.tan(0.5 * np.arctan2(cross, np.sum(one * other, -1)))
    return result


def _deviation(curve: PlaneCurve, s: Floats, arcs: Arcs) -> float:
    """Return the largest distance (mm) of points of the curve from the pair of arcs between s[i] and s[i + 1]."""
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
    return _highest(np.where(forward, distance[:, 1], distance[:, 0]))


def _highest(values: Floats) -> float:
    """Highest of curves that are zero at both ends, of values (n, k) in equal steps: of the parabolas through its peaks."""
    before, here, after = values[:, :-2], values[:, 1:-1], values[:, 2:]
    peak = (here > before) & (here >= after)
    before, here, after = before[peak], here[peak], after[peak]
    return float((here + (after - before) ** 2 / (8 * (2 * here - before - after))).max(initial=0.0))


def joined(chains: list[Arcs]) -> Arcs:
    vertices = [chains[0].vertices[:1], *(chain.vertices[1:] for chain in chains)]
    return Arcs(np.concatenate(vertices), np.concatenate([chain.bulges for chain in chains]))


def gear_contour(gear: Gear, accuracy: float = 0.0005) -> Floats:
    """Closed contour (n, 3), counter-clockwise: x, y in mm and the bulge of the arc to the next vertex, as in DXF.

    The lands are single arcs, tip chamfers straight, involute and trochoid pairs of arcs that follow the exact tangents
    and stay within `accuracy` (mm) of the exact curve. Every joint is one shared vertex; the last arc ends in the first.
    Profile modifications are in it as they are at mid face width. On a ring what it encloses is the opening.
    """
    require_number("accuracy", accuracy, "mm", at_least=1e-7)
    return contour_of(middle_section(gear), gear.tooth_count, gear.profile.root_diameter, accuracy)


def contour_of(curves: Sequence[Curve], teeth: int, root_diameter: float, accuracy: float) -> Floats:
    """Closed contour (n, 3) of teeth whose half outline is `curves`, root to tip: see `gear_contour`."""
    flank = joined([arcs_of(curve, accuracy) for curve in curves if curve.kind not in (CurveKind.ROOT, CurveKind.TIP)])
    half_pitch = math.pi / teeth
    land = curves[0].kind is CurveKind.ROOT
    if not land:  # the fillet ends in the middle of the space, where that of the next tooth begins
        flank.vertices[0] = root_diameter / 2 * np.array([math.cos(half_pitch), math.sin(half_pitch)])
    right, left = flank.vertices * [1, -1], flank.vertices[::-1]
    root_angle, tip_angle = (math.atan2(flank.vertices[i, 1], flank.vertices[i, 0]) for i in (0, -1))
    lands = math.tan(tip_angle / 2), math.tan((half_pitch - root_angle) / 2)
    x, y = np.concatenate([right, left]).T
    bulge = np.r_[-flank.bulges, lands[0], -flank.bulges[::-1], lands[1]]
    if not land:
        x, y, bulge = x[:-1], y[:-1], bulge[:-1]
    turn = 2 * half_pitch * np.arange(teeth)[:, None]
    cosine, sine = np.cos(turn), np.sin(turn)
    columns = np.broadcast_arrays(cosine * x - sine * y, sine * x + cosine * y, bulge)
    return np.stack(columns, -1).reshape(-1, 3)


def extent_of(contour: Floats) -> tuple[Floats, Floats]:
    """Return the least and greatest x and y (mm) of a closed contour (n, 3) of arcs: at vertices, or where an arc is level or
    upright.
    """
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


_LAYERS = {"PROFILE": CUT, "BORE": CUT}
_RING_LAYERS = {"PROFILE": CUT, "RIM": CUT, "BOLTS": CUT}
_CIRCLES = {"CIRCLES": NOT_CUT}


def write_dxf(gear: Gear, path: Path | str, *, accuracy: float = 0.0005, circles: bool = False) -> None:
    """Write the transverse section as DXF (R2010, mm): tooth 0 on +x.

    The flanks are as modified at mid face width, where modifications along the face are nothing (see `middle_section`).
    Layer PROFILE holds the contour, one closed polyline of arcs (see `gear_contour`); BORE the bore, a circle, or with a
    keyway or the teeth of a spline a closed polyline; CIRCLES, with `circles`, the tip, reference, base and root circles, which
    are not to be cut. A ring's contour is that of its opening; it has no BORE but RIM, the circle outside if it has one, and
    BOLTS, its holes.
    The header states how far the drawing reaches. Equal input gives equal bytes.
    Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    contour = gear_contour(gear, accuracy)
    with drawing(path, _RING_LAYERS if gear.internal else _LAYERS) as document:
        space = document.modelspace()
        draw_section(space, gear, contour, accuracy)
        low, high = extent_of(contour)
        if circles:
            low, high = draw_circles(document, gear)
        if gear.body.rim_diameter is not None:
            high = np.full(2, gear.body.rim_diameter / 2)
            low = -high
        space.reset_extents((*low, 0.0), (*high, 0.0))


def draw_section(space: Modelspace, gear: Gear, contour: Floats, accuracy: float = 0.0005) -> None:
    """Draw the contour of the teeth, and what else of a gear is cut, about the origin; a splined bore within `accuracy`
    (mm).
    """
    space.add_lwpolyline(contour.tolist(), format="xyb", close=True, dxfattribs={"layer": "PROFILE"})
    if (teeth := bore_teeth(gear)) is not None:
        opening = gear_contour(teeth, accuracy).tolist()
        space.add_lwpolyline(opening, format="xyb", close=True, dxfattribs={"layer": "BORE"})
        return
    (_draw_rim if gear.internal else _draw_bore)(space, gear.body)


def draw_circles(document: Drawing, gear: Gear) -> tuple[Floats, Floats]:
    """Return the circles of reference about the origin; how far they reach."""
    add_layers(document, _CIRCLES)
    profile = gear.profile
    for diameter in (profile.tip_diameter, profile.reference_diameter, profile.base_diameter, profile.root_diameter):
        document.modelspace().add_circle((0, 0), diameter / 2, dxfattribs={"layer": "CIRCLES"})
    reach = np.full(2, max(profile.tip_diameter, profile.root_diameter) / 2)
    return -reach, reach


def _draw_rim(space: Modelspace, body: Body) -> None:
    if body.rim_diameter is not None:
        space.add_circle((0, 0), body.rim_diameter / 2, dxfattribs={"layer": "RIM"})
    for k in range(body.bolt_holes):
        angle = 2 * math.pi * k / body.bolt_holes
        middle = (body.bolt_circle / 2 * math.cos(angle), body.bolt_circle / 2 * math.sin(angle))
        space.add_circle(middle, body.bolt_diameter / 2, dxfattribs={"layer": "BOLTS"})


def _draw_bore(space: Modelspace, body: Body) -> None:
    radius, half_width = body.bore / 2, body.keyway_width / 2
    if not radius:
        return
    if not half_width:
        space.add_circle((0, 0), radius, dxfattribs={"layer": "BORE"})
        return
    end = keyway_half_angle(body)
    corner, floor = radius * math.cos(end), radius + body.keyway_depth
    # The arc goes the long way round, from the keyway's upper to its lower wall.
    points = [
        (corner, half_width, math.tan((math.pi - end) / 2)),
        (corner, -half_width, 0.0),
        (floor, -half_width, 0.0),
        (floor, half_width, 0.0),
    ]
    space.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": "BORE"})


@dataclass(frozen=True)
class _FilletPart:
    """A fillet from left to right between two of its angles from the lowest point (rad, in the normal section)."""

    piece: OutlinePiece
    first: float
    last: float
    kind: RackCurveKind = RackCurveKind.FILLET

    def points(self, s: ArrayLike) -> Floats:
        theta, fillet = self._theta(s), self.piece.fillet
        assert fillet is not None
        across = self.piece.centre + fillet.radius * np.sin(theta) * fillet.stretch
        return np.stack([across, fillet.y - fillet.radius * np.cos(theta)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        theta, fillet = self._theta(s), self.piece.fillet
        assert fillet is not None
        return np.arctan2(np.sin(theta), np.cos(theta) * fillet.stretch)

    def _theta(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)


def rack_contour(rack: Rack, accuracy: float = 0.0005) -> Floats:
    """Closed contour (n, 3), counter-clockwise: x, y in mm and the bulge of the arc to the next vertex, as in DXF.

    From the back at x = 0 along it and back over the teeth. Fillets of a spur rack are single arcs, those of a helical one,
    ellipses here, pairs of arcs within `accuracy` (mm).
    """
    require_number("accuracy", accuracy, "mm", at_least=1e-7)
    chains = [chain for piece in outline_pieces(rack) if (chain := _chain(piece, rack.length, accuracy)) is not None]
    teeth = joined(chains)
    vertices, bulges = teeth.vertices[::-1], -teeth.bulges[::-1]
    back = np.array([[0.0, -rack.height, 0.0], [rack.length, -rack.height, 0.0]])
    return np.concatenate([back, np.column_stack([vertices, np.r_[bulges, 0.0]])])


def _chain(piece: OutlinePiece, length: float, accuracy: float) -> Arcs | None:
    """Return the arcs of a piece between x = 0 and `length`, from left to right; None if nothing lies there."""
    (first, _), (last, _) = piece.start, piece.end
    low, high = max(first, 0.0), min(last, length)
    if high - low < SNAP:
        return None
    if piece.fillet is None:
        left = piece.start if low == first else (low, piece.height(low))
        right = piece.end if high == last else (high, piece.height(high))
        return Arcs(np.array([left, right]), np.zeros(1))
    scale = piece.fillet.radius * piece.fillet.stretch
    start, end = (math.asin(max(-1.0, min(1.0, (c - piece.centre) / scale))) for c in (low, high))
    part = _FilletPart(piece, start, end)
    if piece.fillet.stretch == 1:
        return Arcs(part.points(np.array([0.0, 1.0])), np.array([math.tan((part.last - part.first) / 4)]))
    return arcs_of(part, accuracy)


def write_rack_dxf(rack: Rack, path: Path | str, *, accuracy: float = 0.0005, lines: bool = False) -> None:
    """Write the section at z = 0 as DXF (R2010, mm), as a `Rack` lies: teeth up, the reference line on y = 0.

    Layer PROFILE holds the contour (see `rack_contour`); LINES, with `lines`, those of tips, reference and roots, which are not
    to be cut. The header states how far the drawing reaches. Equal input gives equal bytes.
    Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    contour = rack_contour(rack, accuracy)
    with drawing(path, {"PROFILE": CUT}) as document:
        space = document.modelspace()
        space.add_lwpolyline(contour.tolist(), format="xyb", close=True, dxfattribs={"layer": "PROFILE"})
        if lines:
            add_layers(document, {"LINES": NOT_CUT})
            for y in (rack.tip_height, 0.0, -rack.root_depth):
                space.add_line((0.0, y), (rack.length, y), dxfattribs={"layer": "LINES"})
        low, high = extent_of(contour)
        space.reset_extents((*low, 0.0), (*high, 0.0))

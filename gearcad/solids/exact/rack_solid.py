"""Exact solid of a rack: planes, and cylinders along the teeth.

A section of such a cylinder by an end face is an ellipse, on which u of the cylinder is the ellipse's parameter and a quarter
turn: what the edge is in the cylinder's parameters is a sine, which a polynomial follows to 1e-10 mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry.rack import Rack
from gearcad.solids.body_plan import Edge, OutlinePiece, RackPlan, RackSide, Strip, outline_pieces
from gearcad.solids.exact import boundary
from gearcad.solids.exact.boundary import (
    BezierOnSurface,
    Boundary,
    Chain,
    CircleCurve,
    CylinderSurface,
    EllipseCurve,
    Frame,
    LineOnSurface,
    OnSurface,
    PlaneSurface,
    Recorder,
    Vector,
    backward,
    straight_line,
    unit,
    vector,
)
from gearcad.solids.exact.solid import cad_solid

if TYPE_CHECKING:
    import cadquery


_QUARTER = math.pi / 2
_CLOSE = 1e-10
"""Largest error (mm) of an edge's curve in the cylinder's parameters."""


def flat_surface(piece: OutlinePiece, drift: float) -> PlaneSurface:
    """Return the plane of a straight piece, its normal up."""
    (c, y), (to_c, to_y) = piece.start, piece.end
    normal, along = (y - to_y, to_c - c, drift * (to_y - y)), (drift, 0.0, 1.0)
    return PlaneSurface(Frame((c, y, 0.0), unit(normal), unit(along)))


@dataclass(frozen=True)
class FilletSurface:
    """The cylinder of a fillet: u = 0 is straight up from its axis, v runs along the axis from z = 0.

    Its normal points away from the axis, into the rack.
    """

    piece: OutlinePiece
    drift: float

    @property
    def _radius(self) -> float:
        assert self.piece.fillet is not None
        return self.piece.fillet.radius

    @property
    def _axis(self) -> tuple[float, float]:
        assert self.piece.fillet is not None
        return self.piece.centre, self.piece.fillet.y

    @property
    def _stretch(self) -> float:
        return math.hypot(1.0, self.drift)

    def surface(self) -> CylinderSurface:
        """Return the cylinder of the surface."""
        c, y = self._axis
        return CylinderSurface(Frame((c, y, 0.0), unit((self.drift, 0.0, 1.0)), (0.0, 1.0, 0.0)), self._radius)

    def u(self, c: float) -> float:
        """Return the parameter u (rad) of the line of constant c on the surface: pi at the lowest line, larger to the left of
        +x.
        """
        sine = (self._axis[0] - c) / (self._radius * self._stretch)
        return math.pi - math.asin(min(max(sine, -1.0), 1.0))

    def v(self, c: float, z: float) -> float:
        """Return v (mm) of a place on the cylinder."""
        return self._stretch * z - self.drift * self._radius * math.sin(self.u(c))

    def along_teeth(self, c: float, z: float) -> OnSurface:
        """Return the line of constant c from height z on, in the parameters of the surface."""
        return LineOnSurface(self.u(c), self.v(c, z), 0, 1)

    def level(self, z: float) -> CircleCurve | EllipseCurve:
        """Return the ellipse at height z, with the parameter u - pi/2."""
        c, y = self._axis
        frame = Frame((c + self.drift * z, y, z), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0))
        if self.drift == 0:
            return CircleCurve(frame, self._radius)
        return EllipseCurve(frame, self._radius * self._stretch, self._radius)

    def on_level(self, z: float, first: float, last: float) -> OnSurface:
        """Return that ellipse in the parameters of the surface, between two parameters of the ellipse."""
        if self.drift == 0:
            return LineOnSurface(_QUARTER, z, 1, 0)
        return self._sine(self._stretch * z, -self.drift * self._radius, first, last)

    def upright(self, x: float) -> EllipseCurve:
        """Return the ellipse in the plane of constant x, with the parameter u - pi/2."""
        c, y = self._axis
        side = math.copysign(1.0, self.drift)
        frame = Frame((x, y, (x - c) / self.drift), (side, 0.0, 0.0), (0.0, 0.0, side))
        return EllipseCurve(frame, self._radius * self._stretch / abs(self.drift), self._radius)

    def on_upright(self, x: float, first: float, last: float) -> OnSurface:
        """Return that ellipse in the parameters of the surface, between two parameters of the ellipse."""
        return self._sine(self._stretch * (x - self._axis[0]) / self.drift, self._radius / self.drift, first, last)

    def _sine(self, middle: float, amplitude: float, first: float, last: float) -> OnSurface:
        """Return the curve u = t + pi/2, v = middle + amplitude sin u for t from `first` to `last`."""

        def curve(share: Floats) -> Floats:
            t = first + share * (last - first)
            return np.stack([t + _QUARTER, middle + amplitude * np.cos(t)], -1)

        def error(values: Floats, share: Floats) -> Floats:
            return np.asarray(np.abs(values - curve(share)).max(-1))

        close = max(_CLOSE, 1e-15 * (abs(middle) + abs(amplitude)))
        poles = boundary.fit(curve, error, close)
        assert poles is not None  # a sine over less than half a turn
        return BezierOnSurface(poles, first, last)


_TOLERANCE = 1e-6
"""Tolerance (mm) of edges and vertices: planes, cylinders and ellipses are exact, lines through corners may miss by so much."""

_NORMALS = {RackSide.BOTTOM: (0, 0, -1), RackSide.TOP: (0, 0, 1), RackSide.START: (-1, 0, 0), RackSide.END: (1, 0, 0)}
_ENDS = {
    RackSide.BOTTOM: ((RackSide.START, RackSide.BOTTOM), (RackSide.END, RackSide.BOTTOM)),
    RackSide.TOP: ((RackSide.START, RackSide.TOP), (RackSide.END, RackSide.TOP)),
    RackSide.START: ((RackSide.START, RackSide.BOTTOM), (RackSide.START, RackSide.TOP)),
    RackSide.END: ((RackSide.END, RackSide.BOTTOM), (RackSide.END, RackSide.TOP)),
}
"""The corners of the plan between which a side runs, along +x or +z."""


def rack_boundary(rack: Rack) -> Boundary:
    """Return the rack as a closed boundary: flanks and lands are planes, fillets cylinders of their true radius.

    As a `Rack` lies: along x, teeth up (+y), z = 0 ... face width.
    """
    return _Builder(rack).boundary()


def rack_solid(rack: Rack) -> cadquery.Solid:
    """Return the rack as a CadQuery solid: see `rack_boundary`."""
    return cad_solid(rack_boundary(rack))


class _Builder:
    """Vertices and edges of one rack, and the faces between them."""

    def __init__(self, rack: Rack) -> None:
        self.rack, self.recorder = rack, Recorder(_TOLERANCE / 2)
        self.pieces = outline_pieces(rack)
        lines = np.array([piece.start[0] for piece in self.pieces])
        self.plan = RackPlan(lines, rack.drift, rack.length, rack.face_width)
        self.points = self._points()
        self.vertices = [self.recorder.vertex(point) for point in self.points.tolist()]
        self.edges: dict[tuple[int, int], int] = {}

    def boundary(self) -> Boundary:
        """Return the boundary of the whole rack."""
        for strip in self.plan.strips:
            self._strip(strip)
        for side in RackSide:
            self._side(side)
        self._back()
        return self.recorder.boundary()

    def _points(self) -> Floats:
        """Return the vertices of the plan at their heights, then the back's corners."""
        plan, pieces = self.plan, self.pieces
        inside = {}
        for strip in plan.strips:
            for way in strip.ways:
                for edge in way:
                    inside[edge.start], inside[edge.end] = pieces[strip.piece], pieces[strip.piece]
        heights = [
            pieces[line].start[1] if line >= 0 else inside[number].height(c)
            for number, (line, c) in enumerate(zip(plan.line.tolist(), plan.along.tolist(), strict=True))
        ]
        (x, z), back = plan.places.T, -self.rack.height
        self.back = {corner: len(heights) + i for i, corner in enumerate(plan.corners)}
        under = [[x[number], back, z[number]] for number in plan.corners.values()]
        return np.concatenate([np.stack([x, heights, z], -1), under])

    # ------------------------------------------------------------------ edges

    def _straight(self, start: int, end: int) -> tuple[int, bool]:
        """Return the straight edge between two vertices, and whether it runs this way: upwards, or from the lesser number."""
        low, high = sorted((start, end), key=lambda number: (self.points[number, 2], number))
        if (low, high) not in self.edges:
            line, length = straight_line(self.points[low].tolist(), self.points[high].tolist())
            self.edges[low, high] = self.recorder.edge(line, self.vertices[low], self.vertices[high], 0.0, length)
        return self.edges[low, high], start == low

    def _on_rim(self, edge: Edge, piece: OutlinePiece) -> tuple[int, bool]:
        """Return the edge between the toothed side and an end face, and whether it runs in the order of c."""
        if piece.fillet is None or (self.rack.drift == 0 and edge.side in (RackSide.START, RackSide.END)):
            return self._straight(edge.start, edge.end)
        key = edge.start, edge.end
        if key not in self.edges:
            self.edges[key] = self._arc(edge, FilletSurface(piece, self.rack.drift))
        return self.edges[key], True

    def _arc(self, edge: Edge, fillet: FilletSurface) -> int:
        """Return an ellipse between two vertices; c rises with its parameter."""
        ends = edge.start, edge.end
        first, last = (fillet.u(float(self.plan.along[number])) - math.pi / 2 for number in ends)
        x, _, z = self.points[edge.start].tolist()
        curve = fillet.level(z) if edge.side in (RackSide.BOTTOM, RackSide.TOP) else fillet.upright(x)
        return self.recorder.edge(curve, self.vertices[edge.start], self.vertices[edge.end], first, last)

    # ------------------------------------------------------------------ faces

    def _strip(self, strip: Strip) -> None:
        """The face of a strip: one way along the rim and back the other is counter-clockwise seen from above."""
        piece, recorder = self.pieces[strip.piece], self.recorder
        one, other = ([(edge, *self._on_rim(edge, piece)) for edge in way] for way in strip.ways)
        loop: Chain = [(made, along) for _, made, along in one]
        if strip.ends[0] != strip.ends[1]:
            loop.append(self._straight(*strip.ends))
        loop += [(made, not along) for _, made, along in reversed(other)]
        if strip.starts[0] != strip.starts[1]:
            loop.append(self._straight(*reversed(strip.starts)))
        if piece.fillet is None:
            recorder.face(flat_surface(piece, self.rack.drift), [loop])
            return
        fillet = FilletSurface(piece, self.rack.drift)
        surface = fillet.surface()
        for edge, made, _ in (*one, *other):
            self._lay_on_rim(edge, made, fillet, surface)
        for line in {strip.starts, strip.ends}:
            if line[0] != line[1]:
                low = min(line, key=lambda number: self.points[number, 2])
                made, _ = self._straight(*line)
                recorder.lay(made, surface, fillet.along_teeth(self._c(low), self.points[low, 2]))
        recorder.face(surface, [backward(loop)], outward=False)

    def _c(self, number: int) -> float:
        return float(self.plan.along[number])

    def _lay_on_rim(self, edge: Edge, made: int, fillet: FilletSurface, surface: CylinderSurface) -> None:
        """The curve of an edge of the rim in the parameters of a fillet."""
        recorder, (x, _, z) = self.recorder, self.points[edge.start].tolist()
        first, last = (fillet.u(self._c(number)) - math.pi / 2 for number in (edge.start, edge.end))
        if edge.side in (RackSide.BOTTOM, RackSide.TOP):
            recorder.lay(made, surface, fillet.on_level(z, first, last))
        elif self.rack.drift == 0:
            recorder.lay(made, surface, fillet.along_teeth(self._c(edge.start), 0.0))
        else:
            recorder.lay(made, surface, fillet.on_upright(x, first, last))

    def _side(self, side: RackSide) -> None:
        """An end face: the outline's section, and three straight edges; seen along +z and -x they run clockwise."""
        piece_of = {edge: strip.piece for strip in self.plan.strips for way in strip.ways for edge in way}
        loop: Chain = []
        for edge in self.plan.rim(side):
            as_made = edge if edge in piece_of else Edge(edge.end, edge.start, side)
            made, along = self._on_rim(as_made, self.pieces[piece_of[as_made]])
            loop.append((made, along == (as_made == edge)))
        first, last = _ENDS[side]
        below = [self.plan.corners[last], self.back[last], self.back[first], self.plan.corners[first]]
        loop += [self._straight(start, end) for start, end in pairwise(below)]
        if side in (RackSide.TOP, RackSide.START):
            loop = backward(loop)
        self.recorder.face(self._plane(below[0], _NORMALS[side]), [loop])

    def _back(self) -> None:
        """The face opposite the teeth."""
        around = [self.back[corner] for corner in (*_ENDS[RackSide.BOTTOM], *reversed(_ENDS[RackSide.TOP]))]
        loop = [self._straight(start, end) for start, end in pairwise([*around, around[0]])]
        self.recorder.face(self._plane(around[0], (0, -1, 0)), [loop])

    def _plane(self, number: int, normal: Vector) -> PlaneSurface:
        """Return the plane through a vertex."""
        along = (0.0, 0.0, 1.0) if normal[0] else (1.0, 0.0, 0.0)
        return PlaneSurface(Frame(vector(self.points[number]), normal, along))

"""The toothed side of a gear as exact screw faces on shared edges, with the cones of the end chamfer.

A face of a flank is S(u, z) = R(kappa z) C(u): its poles are the section's poles times the Bezier coefficients of
(cos, sin) over the twist, so that nothing is approximated twice and neighbours share their edge curves pole for pole.
Everything is laid out once for tooth 0 and then turned to the other teeth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.geometry.gear import Gear
from gearcad.solids import bezier
from gearcad.solids.ends import End, gear_ends
from gearcad.solids.kernel import Kernel, bezier_curve, bezier_curve_2d, bezier_surface
from gearcad.solids.outline import Arc, Piece, Span, accuracy_for, parameter_at_radius, tooth_outline

__all__ = ["add_teeth"]

Floats = NDArray[np.float64]
Edges = list[tuple[Any, bool]]


@dataclass(frozen=True)
class _Segment:
    """A stretch of one piece's edge on one end, between two of the end's stations (indices, see `_stations`)."""

    piece: int
    start: int
    end: int
    first: float
    last: float
    on_cone: bool


@dataclass(frozen=True)
class _Drawn:
    """Curves of a segment, for tooth 0: in space, on its own face, and on the cone (None on the plane)."""

    curve: Any
    on_face: Any
    on_cone: Any


class _Layout:
    """Tooth 0: pieces, screw, and for each end the stations and segments of the outline."""

    def __init__(self, gear: Gear, kernel: Kernel) -> None:
        self.gear, self.kernel = gear, kernel
        self.width = gear.face_width
        self.pieces: tuple[Piece, ...] = tooth_outline(gear)
        self.ends = gear_ends(gear)
        self.tolerance = accuracy_for(gear)
        self.rate = math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2)
        self.screw = self._screw_poles()
        self.junctions = np.array([self._start(piece) for piece in self.pieces])
        self.segments = [self._segments(end) for end in self.ends]

    # -------------------------------------------------------------- screw

    def _screw_poles(self) -> Floats:
        """Bezier poles (m + 1, 2) of (cos, sin) of the twist over 0 ... width, to a quarter of the section's tolerance."""
        twist = self.rate * self.width
        if twist == 0:
            return np.array([[1.0, 0.0], [1.0, 0.0]])

        def rotation(t: Floats) -> Floats:
            return np.stack([np.cos(twist * t), np.sin(twist * t)], -1)

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs(values - rotation(t)).max(-1))

        bound = 0.25 * self.tolerance / (self.gear.tip_diameter / 2)
        poles = bezier.fit(rotation, error, bound)
        return poles if poles is not None else bezier.interpolate(rotation, bezier.MOST_DEGREE)

    def sweep(self, poles: Floats) -> Floats:
        """Poles (n, m + 1, 3) of the screw surface through section poles (n, 2)."""
        x, y = poles[:, :1], poles[:, 1:]
        cosine, sine = self.screw.T
        heights = np.broadcast_to(np.linspace(0, self.width, len(cosine)), (len(poles), len(cosine)))
        return np.stack([x * cosine - y * sine, x * sine + y * cosine, heights], -1)

    # -------------------------------------------------------------- stations of the outline

    @staticmethod
    def _start(piece: Piece) -> tuple[float, float]:
        """Radius and polar angle (rad) where a piece starts."""
        if isinstance(piece, Arc):
            return piece.radius, piece.first
        x, y = piece.poles[0]
        return math.hypot(x, y), math.atan2(y, x)

    def _segments(self, end: End) -> tuple[list[_Segment], Floats]:
        """Segments of one end, and the (radius, angle at z = 0) of its stations: the junctions, then the breaks.

        Station `len(pieces)` of a segment's end means the first junction of the next tooth.
        """
        count, found, breaks = len(self.pieces), list[_Segment](), list[tuple[float, float]]()
        for k, piece in enumerate(self.pieces):
            first, last = piece.radii if isinstance(piece, Span) else (0.0, 0.0)
            if isinstance(piece, Arc):
                found.append(_Segment(k, k, k + 1, piece.first, piece.last, piece.radius > end.edge_radius))
            elif end.edge_radius >= max(first, last) or end.edge_radius <= min(first, last):
                found.append(_Segment(k, k, k + 1, 0.0, 1.0, end.edge_radius <= min(first, last)))
            else:
                u = parameter_at_radius(piece, end.edge_radius)
                angle = float(piece.polar(np.array([u]))[1][0])
                station = count + 1 + len(breaks)
                breaks.append((end.edge_radius, angle))
                found.append(_Segment(k, k, station, 0.0, u, first > last))
                found.append(_Segment(k, station, k + 1, u, 1.0, first < last))
        following = (self.junctions[0, 0], self.junctions[0, 1] + 2 * math.pi / self.gear.teeth)
        return found, np.array([*self.junctions, following, *breaks])

    def place(self, end: End, stations: Floats) -> Floats:
        """Points (n, 3) of stations (radius, angle at z = 0) on an end of tooth 0."""
        radius, angle = stations.T
        z = end.height(radius)
        angle = angle + self.rate * z
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)

    # -------------------------------------------------------------- curves

    def draw(self, end: End, segment: _Segment) -> _Drawn:
        """The curves of one segment."""
        piece, line = self.pieces[segment.piece], self.kernel.line_2d
        if isinstance(piece, Arc):
            z = float(end.height(piece.radius))
            on_cone = None
            if segment.on_cone:
                on_cone = line(0, (piece.radius - end.edge_radius) / end.sine, end.inward, 0)
            return _Drawn(self.kernel.circle(piece.radius, z), line(0, z, 1, 0), on_cone)
        if segment.on_cone:
            return self._draw_on_cone(end, segment, piece)
        turn = self.rate * end.z
        cosine, sine = math.cos(turn), math.sin(turn)
        x, y = piece.poles.T
        poles = np.stack([cosine * x - sine * y, sine * x + cosine * y, np.full(len(x), end.z)], -1)
        return _Drawn(bezier_curve(poles), line(0, end.z, 1, 0), None)

    def _draw_on_cone(self, end: End, segment: _Segment, piece: Span) -> _Drawn:
        """Where a flank meets the cone: z follows from the radius, so the curve is explicit in the flank's own u."""
        first, span = segment.first, segment.last - segment.first

        def curve(t: Floats) -> Floats:
            radius, angle = piece.polar(first + t * span)
            z = end.height(radius)
            angle = angle + self.rate * z
            slant = (radius - end.edge_radius) / end.sine
            return np.stack([radius * np.cos(angle), radius * np.sin(angle), z, end.inward * angle, slant], -1)

        scale = np.array([1, 1, 1, self.gear.tip_diameter / 2, 1.0])

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs((values - curve(t)) * scale).max(-1))

        poles = bezier.fit(curve, error, 0.25 * self.tolerance, least=3)
        if poles is None:
            poles = bezier.interpolate(curve, bezier.MOST_DEGREE)
        along = np.linspace(first, segment.last, len(poles))
        on_face = bezier_curve_2d(np.stack([along, poles[:, 2]], -1), first, segment.last)
        on_cone = bezier_curve_2d(poles[:, 3:], first, segment.last)
        return _Drawn(bezier_curve(poles[:, :3], first, segment.last), on_face, on_cone)

    def side(self, k: int) -> tuple[Any, Any, Any, Any]:
        """Side edge at junction k: curve over z, and its curves on the piece after, the piece before, and a cylinder."""
        radius, angle = self.junctions[k]
        start = np.array([[radius * math.cos(angle), radius * math.sin(angle)]])
        after, before = self.kernel.line_2d(0, 0, 0, 1), self.kernel.line_2d(1, 0, 0, 1)
        if self.rate == 0:
            x, y = start[0]
            return self.kernel.line((x, y, 0.0), (x, y, 1.0))[0], after, before, self.kernel.line_2d(angle, 0, 0, 1)
        on_cylinder = np.array([[angle, 0.0], [angle + self.rate * self.width, self.width]])
        curve = bezier_curve(self.sweep(start)[0], 0.0, self.width)
        return curve, after, before, bezier_curve_2d(on_cylinder, 0.0, self.width)


def add_teeth(gear: Gear, kernel: Kernel) -> tuple[Edges, Edges]:
    """Add all faces of the toothed side to the kernel's shell; returns the outer loops of the lower and the upper end face.

    The loops run counter-clockwise seen from +z.
    """
    layout = _Layout(gear, kernel)
    ring = _Ring(layout)
    ring.add_sides()
    return ring.close_end(0), ring.close_end(1)


class _Ring:
    """Turns the layout of tooth 0 into the vertices, edges and faces of all teeth."""

    def __init__(self, layout: _Layout) -> None:
        self.layout, self.kernel = layout, layout.kernel
        self.teeth = layout.gear.teeth
        self.pitch = 2 * math.pi / self.teeth
        self.turns = [self.kernel.turn(i * self.pitch) for i in range(self.teeth)]
        self.vertices = [self._vertices(which) for which in (0, 1)]
        self.drawn = [[layout.draw(end, s) for s in layout.segments[e][0]] for e, end in enumerate(layout.ends)]
        self.edges = [self._end_edges(which) for which in (0, 1)]
        self.side_curves = [layout.side(k) for k in range(len(layout.pieces))]
        self.side_edges = [self._side_edges(i) for i in range(self.teeth)]

    def _around(self, points: Floats) -> Floats:
        """Points (n, 3) of tooth 0 turned to every tooth: (teeth, n, 3)."""
        angle = self.pitch * np.arange(self.teeth)[:, None]
        x, y, z = points.T
        cosine, sine = np.cos(angle), np.sin(angle)
        return np.stack([cosine * x - sine * y, sine * x + cosine * y, np.broadcast_to(z, (self.teeth, len(z)))], -1)

    def _vertices(self, which: int) -> list[list[Any]]:
        """Vertices of an end by tooth and station; the station after the last junction belongs to the next tooth."""
        layout, count = self.layout, len(self.layout.pieces)
        places = self._around(layout.place(layout.ends[which], layout.segments[which][1])).tolist()
        made = [[None if k == count else self.kernel.vertex(p) for k, p in enumerate(tooth)] for tooth in places]
        for i, tooth in enumerate(made):
            tooth[count] = made[(i + 1) % self.teeth][0]
        return made

    def _end_edges(self, which: int) -> list[list[Any]]:
        """Edges of an end by tooth and segment."""
        layout, kernel, edges = self.layout, self.kernel, []
        end = layout.ends[which]
        for i in range(self.teeth):
            row, vertices = [], self.vertices[which][i]
            for segment, drawn in zip(layout.segments[which][0], self.drawn[which], strict=True):
                piece, turn = layout.pieces[segment.piece], 0.0
                if isinstance(piece, Arc):
                    turn = layout.rate * float(end.height(piece.radius))
                ends = vertices[segment.start], vertices[segment.end]
                row.append(
                    kernel.edge(drawn.curve.Transformed(self.turns[i]), *ends, segment.first + turn, segment.last + turn)
                )
            edges.append(row)
        return edges

    def _side_edges(self, i: int) -> list[Any]:
        layout, row = self.layout, []
        for k, (curve, *_) in enumerate(self.side_curves):
            low, high = (float(end.height(layout.junctions[k, 0])) for end in layout.ends)
            ends = self.vertices[0][i][k], self.vertices[1][i][k]
            row.append(self.kernel.edge(curve.Transformed(self.turns[i]), *ends, low, high))
        return row

    def add_sides(self) -> None:
        """The faces of flanks, fillets, chamfers and lands."""
        layout, count = self.layout, len(self.layout.pieces)
        cylinders = {piece.radius: self.kernel.cylinder(piece.radius) for piece in layout.pieces if isinstance(piece, Arc)}
        surfaces = [bezier_surface(layout.sweep(p.poles), layout.width) if isinstance(p, Span) else None for p in layout.pieces]
        for i in range(self.teeth):
            for k, piece in enumerate(layout.pieces):
                follows = (i, k + 1) if k + 1 < count else ((i + 1) % self.teeth, 0)
                right = self.side_edges[follows[0]][follows[1]]
                left = self.side_edges[i][k]
                if isinstance(piece, Arc):
                    surface = cylinders[piece.radius]
                    self._lay_on_cylinder(surface, i, k, left, right)
                else:
                    surface = surfaces[k].Transformed(self.turns[i])
                    self.kernel.lay(left, surface, self.side_curves[k][1])
                    self.kernel.lay(right, surface, self.side_curves[k][2])
                    for edge, drawn in self._chain(0, i, k) + self._chain(1, i, k):
                        self.kernel.lay(edge, surface, drawn.on_face)
                lower = [(edge, True) for edge, _ in self._chain(0, i, k)]
                upper = [(edge, False) for edge, _ in reversed(self._chain(1, i, k))]
                self.kernel.face(surface, [[*lower, (right, True), *upper, (left, False)]])

    def _lay_on_cylinder(self, surface: Any, i: int, k: int, left: Any, right: Any) -> None:
        """Curves of a land's edges on the cylinder that all lands of its radius share: tooth 0's, moved along its angle."""
        wraps, after = divmod(k + 1, len(self.layout.pieces))
        self.kernel.lay(left, surface, _moved(self.side_curves[k][3], i * self.pitch))
        self.kernel.lay(right, surface, _moved(self.side_curves[after][3], (i + wraps) * self.pitch))
        for which in (0, 1):
            for edge, drawn in self._chain(which, i, k):
                self.kernel.lay(edge, surface, _moved(drawn.on_face, i * self.pitch))

    def _chain(self, which: int, i: int, k: int) -> list[tuple[Any, _Drawn]]:
        """(edge, curves) of piece k of tooth i at an end, counter-clockwise."""
        segments, drawn, edges = self.layout.segments[which][0], self.drawn[which], self.edges[which][i]
        return [(edges[j], drawn[j]) for j, segment in enumerate(segments) if segment.piece == k]

    # -------------------------------------------------------------- ends

    def close_end(self, which: int) -> Edges:
        """Add the cone faces of an end and return the outer loop of its plane."""
        end, segments = self.layout.ends[which], self.layout.segments[which][0]
        if not end.chamfered:
            return [(edge, True) for tooth in self.edges[which] for edge in tooth]
        cones = [self._cone(end).Transformed(turn) for turn in self.turns]
        for cone, edges in zip(cones, self.edges[which], strict=True):
            for edge, drawn, segment in zip(edges, self.drawn[which], segments, strict=True):
                if segment.on_cone:
                    self.kernel.lay(edge, cone, drawn.on_cone)
        if all(segment.on_cone for segment in segments):
            return self._cone_below_root(which, end, cones)
        return self._cone_on_teeth(which, end, cones)

    def _cone(self, end: End) -> Any:
        from OCP.Geom import Geom_ConicalSurface

        return Geom_ConicalSurface(self.kernel.frame(end.z, up=end.inward > 0), math.asin(end.sine), end.edge_radius)

    def _cone_on_teeth(self, which: int, end: End, cones: list[Any]) -> Edges:
        """One piece of cone per tooth; the plane's loop crosses each tooth on the arc where the cone begins."""
        segments, stations = self.layout.segments[which]
        conic = [j for j, segment in enumerate(segments) if segment.on_cone]
        start, stop = segments[conic[0]].start, segments[conic[-1]].end
        first, last = stations[[start, stop], 1] + self.layout.rate * end.z
        loop: Edges = []
        for i, edges in enumerate(self.edges[which]):
            vertices = self.vertices[which][i]
            arc = self._foot(end, i, cones[i], vertices[start], vertices[stop], first, last)
            self._add_cone_face(end, cones[i], [(edges[j], True) for j in conic], arc)
            loop += [(edge, True) for edge in [*edges[: conic[0]], arc, *edges[conic[-1] + 1 :]]]
        return loop

    def _cone_below_root(self, which: int, end: End, cones: list[Any]) -> Edges:
        """One piece of cone per pitch, parted by generators from the start of each right flank; the plane is a disc."""
        radius, angle = self.layout.junctions[0]
        angle += self.layout.rate * float(end.height(radius))
        foot = [end.edge_radius * math.cos(angle), end.edge_radius * math.sin(angle), end.z]
        feet = [self.kernel.vertex(tooth[0]) for tooth in self._around(np.array([foot])).tolist()]
        top = self.layout.place(end, self.layout.segments[which][1][:1])[0]
        line, length = self.kernel.line(foot, top)
        generators = [
            self.kernel.edge(line.Transformed(turn), feet[i], self.vertices[which][i][0], 0.0, length)
            for i, turn in enumerate(self.turns)
        ]
        loop: Edges = []
        for i, cone in enumerate(cones):
            after = (i + 1) % self.teeth
            arc = self._foot(end, i, cone, feet[i], feet[after], angle, angle + self.pitch)
            self.kernel.lay(generators[i], cone, self.kernel.line_2d(end.inward * angle, 0, 0, 1))
            self.kernel.lay(generators[after], cone, self.kernel.line_2d(end.inward * (angle + self.pitch), 0, 0, 1))
            rim = [(edge, True) for edge in self.edges[which][i]]
            self._add_cone_face(end, cone, rim, arc, (generators[i], generators[after]))
            loop.append((arc, True))
        return loop

    def _foot(self, end: End, i: int, cone: Any, start: Any, stop: Any, first: float, last: float) -> Any:
        """The arc on an end's plane where the cone of tooth i begins."""
        circle = self.kernel.circle(end.edge_radius, end.z).Transformed(self.turns[i])
        arc = self.kernel.edge(circle, start, stop, first, last)
        self.kernel.lay(arc, cone, self.kernel.line_2d(0, 0, end.inward, 0))
        return arc

    def _add_cone_face(self, end: End, cone: Any, rim: Edges, foot: Any, sides: tuple[Any, ...] = ()) -> None:
        """A piece of cone between `foot` (on the plane) and `rim` (on the teeth), both counter-clockwise seen from +z.

        `sides` are the generators at the start and the end of the rim, both pointing to the rim, if it does not close on the foot.
        """
        before, after = ([(edge, True)] for edge in sides) if sides else ([], [])
        around = [*before, *rim, *_backward(after), (foot, False)]
        self.kernel.face(cone, [_backward(around) if end.inward > 0 else around])


def _backward(loop: Edges) -> Edges:
    """A chain of edges run the other way."""
    return [(edge, not along) for edge, along in reversed(loop)]


def _moved(curve: Any, along: float) -> Any:
    """A curve in the parameters of a surface of revolution, moved along its angle."""
    from OCP.gp import gp_Vec2d

    return curve.Translated(gp_Vec2d(along, 0))

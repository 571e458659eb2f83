"""The toothed side of a gear: the layout of tooth 0 turned to all teeth, on shared vertices and edges."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.geometry.gear import Gear
from gearcad.solids.ends import End
from gearcad.solids.kernel import Kernel, bezier_surface
from gearcad.solids.layout import Layout
from gearcad.solids.outline import Arc

__all__ = ["add_teeth"]

Floats = NDArray[np.float64]
Edges = list[tuple[Any, bool]]


def add_teeth(gear: Gear, kernel: Kernel) -> tuple[Edges, Edges]:
    """Add all faces of the toothed side to the kernel's shell; returns the outer loops of the lower and the upper end face.

    The loops run counter-clockwise seen from +z.
    """
    layout = Layout(gear, kernel)
    ring = _Ring(layout)
    ring.add_sides()
    return ring.close_end(0), ring.close_end(1)


class _Ring:
    """Turns the layout of tooth 0 into the vertices, edges and faces of all teeth.

    Curves and surfaces are tooth 0's own, used again at the place of every tooth.
    """

    def __init__(self, layout: Layout) -> None:
        self.layout, self.kernel = layout, layout.kernel
        self.teeth = layout.gear.teeth
        self.pitch = 2 * math.pi / self.teeth
        self.places = [self.kernel.turned(i * self.pitch) for i in range(self.teeth)]
        self.vertices = [self._vertices(which) for which in (0, 1)]
        self.drawn = [[layout.draw(end, s) for s in layout.segments[e][0]] for e, end in enumerate(layout.ends)]
        self.edges = [self._end_edges(which) for which in (0, 1)]
        self.side_curves = [layout.side(k) for k in range(len(layout.pieces))]
        self.side_edges = self._side_edges()

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
        segments, drawn = self.layout.segments[which][0], self.drawn[which]
        return [
            [
                self.kernel.edge(d.curve, vertices[s.start], vertices[s.end], d.first, d.last, place)
                for s, d in zip(segments, drawn, strict=True)
            ]
            for place, vertices in zip(self.places, self.vertices[which], strict=True)
        ]

    def _side_edges(self) -> list[list[Any]]:
        """Edges along the teeth by tooth and junction."""
        low, high = (end.height(self.layout.junctions[:, 0]).tolist() for end in self.layout.ends)
        return [
            [
                self.kernel.edge(side.curve, lower[k], upper[k], low[k], high[k], place)
                for k, side in enumerate(self.side_curves)
            ]
            for place, lower, upper in zip(self.places, *self.vertices, strict=True)
        ]

    def add_sides(self) -> None:
        """The faces of flanks, fillets, chamfers and lands."""
        kernel = self.kernel
        for k, piece in enumerate(self.layout.pieces):
            land = isinstance(piece, Arc)
            if isinstance(piece, Arc):
                surface = kernel.cylinder(piece.radius)
            else:
                surface = bezier_surface(self.layout.sweep(piece.poles), self.layout.width)
            wraps, after = divmod(k + 1, len(self.layout.pieces))
            left_curve = self.side_curves[k].after(land)
            right_curve = self.side_curves[after].before(land, wraps * self.pitch)
            chains = [[j for j, s in enumerate(segments) if s.piece == k] for segments, _ in self.layout.segments]
            for i, place in enumerate(self.places):
                left, right = self.side_edges[i][k], self.side_edges[(i + wraps) % self.teeth][after]
                kernel.lay(left, surface, left_curve, place=place)
                kernel.lay(right, surface, right_curve, place=place)
                for which, chain in enumerate(chains):
                    for j in chain:
                        kernel.lay(self.edges[which][i][j], surface, self.drawn[which][j].on_face, place=place)
                lower = [(self.edges[0][i][j], True) for j in chains[0]]
                upper = [(self.edges[1][i][j], False) for j in reversed(chains[1])]
                kernel.face(surface, [[*lower, (right, True), *upper, (left, False)]], place=place)

    # -------------------------------------------------------------- ends

    def close_end(self, which: int) -> Edges:
        """Add the cone faces of an end and return the outer loop of its plane."""
        end, segments = self.layout.ends[which], self.layout.segments[which][0]
        if not end.chamfered:
            return [(edge, True) for tooth in self.edges[which] for edge in tooth]
        cone = self.kernel.cone(end.edge_radius, end.sine, end.z, up=end.inward > 0)
        for place, edges in zip(self.places, self.edges[which], strict=True):
            for edge, drawn, segment in zip(edges, self.drawn[which], segments, strict=True):
                if segment.on_cone:
                    self.kernel.lay(edge, cone, drawn.on_cone, place=place)
        if all(segment.on_cone for segment in segments):
            return self._cone_below_root(which, end, cone)
        return self._cone_on_teeth(which, end, cone)

    def _cone_on_teeth(self, which: int, end: End, cone: Any) -> Edges:
        """One piece of cone per tooth; the plane's loop crosses each tooth on the arc where the cone begins."""
        segments, stations = self.layout.segments[which]
        conic = [j for j, segment in enumerate(segments) if segment.on_cone]
        start, stop = segments[conic[0]].start, segments[conic[-1]].end
        first, last = stations[[start, stop], 1] + self.layout.rate * end.z
        loop: Edges = []
        for i, edges in enumerate(self.edges[which]):
            vertices = self.vertices[which][i]
            arc = self._foot(end, i, cone, vertices[start], vertices[stop], first, last)
            self._add_cone_face(end, i, cone, [(edges[j], True) for j in conic], arc)
            loop += [(edge, True) for edge in [*edges[: conic[0]], arc, *edges[conic[-1] + 1 :]]]
        return loop

    def _cone_below_root(self, which: int, end: End, cone: Any) -> Edges:
        """One piece of cone per pitch, parted by generators from the start of each right flank; the plane is a disc."""
        radius, angle = self.layout.junctions[0]
        angle += self.layout.rate * float(end.height(radius))
        foot = [end.edge_radius * math.cos(angle), end.edge_radius * math.sin(angle), end.z]
        feet = [self.kernel.vertex(tooth[0]) for tooth in self._around(np.array([foot])).tolist()]
        line, length = self.kernel.line(foot, self.layout.place(end, self.layout.segments[which][1][:1])[0])
        generators = [
            self.kernel.edge(line, feet[i], self.vertices[which][i][0], 0.0, length, place)
            for i, place in enumerate(self.places)
        ]
        before, after = (self.kernel.line_2d(end.inward * at, 0, 0, 1) for at in (angle, angle + self.pitch))
        loop: Edges = []
        for i, place in enumerate(self.places):
            follows = (i + 1) % self.teeth
            arc = self._foot(end, i, cone, feet[i], feet[follows], angle, angle + self.pitch)
            self.kernel.lay(generators[i], cone, before, place=place)
            self.kernel.lay(generators[follows], cone, after, place=place)
            rim = [(edge, True) for edge in self.edges[which][i]]
            self._add_cone_face(end, i, cone, rim, arc, (generators[i], generators[follows]))
            loop.append((arc, True))
        return loop

    def _foot(self, end: End, i: int, cone: Any, start: Any, stop: Any, first: float, last: float) -> Any:
        """The arc on an end's plane where the cone of tooth i begins."""
        arc = self.kernel.edge(self.kernel.circle(end.edge_radius, end.z), start, stop, first, last, self.places[i])
        self.kernel.lay(arc, cone, self.kernel.line_2d(0, 0, end.inward, 0), place=self.places[i])
        return arc

    def _add_cone_face(self, end: End, i: int, cone: Any, rim: Edges, foot: Any, sides: tuple[Any, ...] = ()) -> None:
        """A piece of cone between `foot` (on the plane) and `rim` (on the teeth), both counter-clockwise seen from +z.

        `sides`: generators at the start and the end of the rim, pointing to it, where it does not close on the foot.
        """
        before, after = ([(edge, True)] for edge in sides) if sides else ([], [])
        around = [*before, *rim, *_backward(after), (foot, False)]
        self.kernel.face(cone, [_backward(around) if end.inward > 0 else around], place=self.places[i])


def _backward(loop: Edges) -> Edges:
    """A chain of edges run the other way."""
    return [(edge, not along) for edge, along in reversed(loop)]

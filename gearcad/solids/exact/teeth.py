"""Toothed side of a gear: tooth 0 turned to all teeth, on shared vertices and edges, and the gap of double helices."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry.gear import Gear, halves
from gearcad.solids.body_plan import End
from gearcad.solids.exact.boundary import (
    ORIGIN,
    BezierCurve,
    BezierSurface,
    BoundaryEdge,
    Chain,
    ConeSurface,
    LineOnSurface,
    Point,
    Recorder,
    SurfaceForm,
    backward,
    cone_about_z,
    cylinder_along_z,
    level_circle,
    level_plane,
    straight_line,
)
from gearcad.solids.exact.tooth_layout import FlankSpan, LandArc, ToothLayout


@dataclass(frozen=True)
class Contour:
    """Edges of a closed contour at one height, counter-clockwise seen from +z, and the vertex each starts from."""

    edges: list[int]
    starts: list[int]

    def loop(self, *, along: bool) -> Chain:
        loop = [(edge, True) for edge in self.edges]
        return loop if along else backward(loop)


def circle(recorder: Recorder, radius: float, z: float, axis: Point = ORIGIN) -> Contour:
    """Return a circle about an axis through the point (x, y); it starts on the side of +x."""
    start = recorder.vertex((axis[0] + radius, axis[1], z))
    return Contour([recorder.edge(level_circle(radius, z, axis), start, start, 0.0, 2 * math.pi)], [start])


def tube(
    recorder: Recorder, radius: float, heights: tuple[float, float], axis: Point = ORIGIN, *, outward: bool
) -> list[Contour]:
    """Add a round wall about an axis from one height to the other; its circles at both."""
    low, high = (circle(recorder, radius, z, axis) for z in heights)
    add_tube(recorder, radius, low, high, heights, axis, outward=outward)
    return [low, high]


def add_tube(
    recorder: Recorder,
    radius: float,
    low: Contour,
    high: Contour,
    heights: Sequence[float],
    axis: Point = ORIGIN,
    *,
    outward: bool,
) -> None:
    """A full cylinder between two circles; its seam lies on the side of +x."""
    surface, x, y = cylinder_along_z(radius, axis), axis[0] + radius, axis[1]
    line, length = straight_line((x, y, heights[0]), (x, y, heights[1]))
    seam = recorder.edge(line, low.starts[0], high.starts[0], 0.0, length)
    recorder.lay(seam, surface, LineOnSurface(2 * math.pi, heights[0], 0, 1), LineOnSurface(0, heights[0], 0, 1))
    for ring, z in zip((low, high), heights, strict=True):
        recorder.lay(ring.edges[0], surface, LineOnSurface(0, z, 1, 0))
    loop = [(low.edges[0], True), (seam, True), (high.edges[0], False), (seam, False)]
    recorder.face(surface, [loop], outward=outward)


def add_teeth(gear: Gear, recorder: Recorder) -> tuple[Chain, Chain]:
    """Take down all faces of the toothed side of a gear; returns its loops on the lower and the upper end face.

    The loops run counter-clockwise seen from +z: about the end faces of an external gear, about the opening of a ring.
    """
    ring = _ToothRing(ToothLayout(gear), recorder)
    ring.add_sides()
    return ring.close_end(0), ring.close_end(1)


class _ToothRing:
    """Turns the layout of tooth 0 into the vertices, edges and faces of all teeth.

    Curves and surfaces are tooth 0's own, used again at the place of every tooth.
    """

    def __init__(self, layout: ToothLayout, recorder: Recorder) -> None:
        self.layout, self.recorder = layout, recorder
        self.teeth = layout.gear.tooth_count
        self.outward = not layout.gear.internal  # surfaces have their normals away from the axis
        self.pitch = 2 * math.pi / self.teeth
        self.places = [self.recorder.turned(i * self.pitch) for i in range(self.teeth)]
        self.vertices = [self._vertices(which) for which in (0, 1)]
        self.drawn = [[layout.draw(end, s) for s in layout.segments[e][0]] for e, end in enumerate(layout.ends)]
        self.edges = [self._end_edges(which) for which in (0, 1)]
        self.chains = [self._chains(which) for which in (0, 1)]
        self.columns = self._columns()
        self.side_curves = [layout.sides(k) for k in range(len(layout.pieces))]
        self.side_edges = self._side_edges()

    def _vertices_around(self, points: Floats) -> list[list[int]]:
        """Return the vertices at points (n, 3) of tooth 0 and of every other tooth, by tooth."""
        angle = self.pitch * np.arange(self.teeth)[:, None]
        x, y, z = points.T
        cosine, sine = np.cos(angle), np.sin(angle)
        turned = [cosine * x - sine * y, sine * x + cosine * y, np.broadcast_to(z, (self.teeth, len(z)))]
        return self.recorder.vertices_around(np.stack(turned, -1), self.places)

    def _vertices(self, which: int) -> list[list[int]]:
        """Return the vertices of an end by tooth and station; the station after the last junction belongs to the next tooth."""
        layout, count = self.layout, len(self.layout.pieces)
        stations = layout.place(layout.ends[which], layout.segments[which][1])
        made = self._vertices_around(np.delete(stations, count, axis=0))
        for i, tooth in enumerate(made):
            tooth.insert(count, made[(i + 1) % self.teeth][0])
        return made

    def _end_edges(self, which: int) -> list[list[int]]:
        """Chain of an end by tooth and segment."""
        drawn = list(zip(self.layout.segments[which][0], self.drawn[which], strict=True))
        count, first = (
            len(drawn),
            self.recorder.edges(
                BoundaryEdge(d.curve, place, vertices[s.start], vertices[s.end], d.first, d.last)
                for place, vertices in zip(self.places, self.vertices[which], strict=True)
                for s, d in drawn
            ),
        )
        return [list(range(first + i * count, first + (i + 1) * count)) for i in range(self.teeth)]

    def _chains(self, which: int) -> list[list[int]]:
        """Segments of an end face's outline, by piece."""
        segments = self.layout.segments[which][0]
        return [[j for j, segment in enumerate(segments) if segment.piece == k] for k in range(len(self.layout.pieces))]

    def _columns(self) -> list[list[list[int]]]:
        """Return the vertices along the teeth, upwards, by tooth and junction."""
        layout = self.layout
        columns = []
        for k, rises in enumerate(layout.rises):
            radius, angle = layout.junctions[k]
            z = np.array([rise.high for rise in rises[:-1]])
            angle = angle + layout.turn(k, z)
            columns.append(self._vertices_around(np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)))
        lower, upper = self.vertices
        return [[[lower[i][k], *inner[i], upper[i][k]] for k, inner in enumerate(columns)] for i in range(self.teeth)]

    def _side_edges(self) -> list[list[list[int]]]:
        """Chain along the teeth, upwards, by tooth and junction."""
        return [
            [
                [
                    self.recorder.edge(side.curve, *ends, rise.low, rise.high, place)
                    for side, rise, ends in zip(sides, rises, pairwise(column), strict=True)
                ]
                for sides, rises, column in zip(self.side_curves, self.layout.rises, columns, strict=True)
            ]
            for place, columns in zip(self.places, self.columns, strict=True)
        ]

    def add_sides(self) -> None:
        """The faces of flanks, fillets, chamfers and lands."""
        for k, piece in enumerate(self.layout.pieces):
            if isinstance(piece, LandArc):
                self._add_land(k, piece)
            else:
                self._add_flank(k, piece)

    def _add_land(self, k: int, piece: LandArc) -> None:
        """Add one face per tooth, over the whole width."""
        recorder, surface = self.recorder, cylinder_along_z(piece.radius)
        wraps, after = divmod(k + 1, len(self.layout.pieces))
        left_curves = [side.on_cylinder(0.0) for side in self.side_curves[k]]
        right_curves = [side.on_cylinder(wraps * self.pitch) for side in self.side_curves[after]]
        lefts = [sides[k] for sides in self.side_edges]
        rights = [self.side_edges[(i + wraps) % self.teeth][after] for i in range(self.teeth)]
        for sides, curves in ((lefts, left_curves), (rights, right_curves)):
            for edges, curve in zip(zip(*sides, strict=True), curves, strict=True):
                recorder.lay_copies(edges, surface, curve, self.places)
        lower, upper = (self._lay_end(which, k, surface) for which in (0, 1))
        for i, place in enumerate(self.places):
            up, down = [(edge, True) for edge in rights[i]], [(edge, False) for edge in reversed(lefts[i])]
            self._face(surface, [*lower[i], *up, *backward(upper[i]), *down], place)

    def _add_flank(self, k: int, piece: FlankSpan) -> None:
        """Add one face per tooth and stretch of the face width."""
        recorder, heights, stretches = self.recorder, self.layout.sweep.heights, self.layout.stretches(k)
        patches = self.layout.sweep.patches(piece)
        wraps, after = divmod(k + 1, len(self.layout.pieces))
        surfaces = {n: BezierSurface(patches[n], *heights[n : n + 2]) for n in stretches}
        curves = {n: BezierCurve(patches[n][:, 0]) for n in stretches[1:]}
        on_left, on_right = LineOnSurface(0, 0, 0, 1), LineOnSurface(1, 0, 0, 1)
        follows = [(i + wraps) % self.teeth for i in range(self.teeth)]
        crossings = self._crossings(curves, k, after, follows)
        loops: list[list[tuple[BezierSurface, Chain]]] = [[] for _ in self.places]
        below: list[Chain] = []
        for n in stretches:
            surface, left, right = surfaces[n], self._rises(k, n), self._rises(after, n)
            right = [right[i] for i in follows]
            for sides, curve in ((left, on_left), (right, on_right)):
                for edges in zip(*sides, strict=True):
                    recorder.lay_copies([edge for edge, _ in edges], surface, curve, self.places)
            if n == stretches[0]:
                below = self._lay_end(0, k, surface)
            else:
                recorder.lay_copies(crossings[n], surface, LineOnSurface(0, heights[n], 1, 0), self.places)
            if n == stretches[-1]:
                above = self._lay_end(1, k, surface)
            else:
                above = [[(edge, True)] for edge in crossings[n + 1]]
                recorder.lay_copies(crossings[n + 1], surface, LineOnSurface(0, heights[n + 1], 1, 0), self.places)
            for i, faces in enumerate(loops):
                faces.append((surface, [*below[i], *right[i], *backward(above[i]), *backward(left[i])]))
            below = above
        for place, faces in zip(self.places, loops, strict=True):
            for patch, loop in faces:
                self._face(patch, loop, place)

    def _crossings(self, curves: dict[int, BezierCurve], k: int, after: int, follows: list[int]) -> dict[int, list[int]]:
        """Return the edges by tooth where two stretches of a flank meet, by the height (its number) at which they do."""
        found: dict[int, list[int]] = {height: [] for height in curves}
        for i, (j, place) in enumerate(zip(follows, self.places, strict=True)):
            for height, curve in curves.items():
                ends = self._vertex(i, k, height), self._vertex(j, after, height)
                found[height].append(self.recorder.edge(curve, *ends, 0.0, 1.0, place))
        return found

    def _face(self, surface: SurfaceForm, loop: Chain, place: int) -> None:
        """A face of the toothed side at the place of a tooth; its loop runs counter-clockwise about the surface's normal."""
        self.recorder.face(surface, [loop], outward=self.outward, place=place)

    def _lay_end(self, which: int, k: int, surface: SurfaceForm) -> list[Chain]:
        """Return the edges of an end on a piece of every tooth, by tooth, laid on its surface."""
        chain, edges = self.chains[which][k], self.edges[which]
        for j in chain:
            self.recorder.lay_copies([tooth[j] for tooth in edges], surface, self.drawn[which][j].on_face, self.places)
        return [[(tooth[j], True) for j in chain] for tooth in edges]

    def _rises(self, k: int, stretch: int) -> list[Chain]:
        """Return the edges by tooth at a junction on a stretch of the face width; none where an end chamfer has taken them."""
        place = stretch - self.layout.rises[k][0].stretch
        if 0 <= place < len(self.layout.rises[k]):
            return [[(sides[k][place], True)] for sides in self.side_edges]
        return [[] for _ in self.side_edges]

    def _vertex(self, i: int, k: int, height: int) -> int:
        """Return the vertex at a junction of a tooth where a stretch begins or the one before ends."""
        return self.columns[i][k][height - self.layout.rises[k][0].stretch]

    # -------------------------------------------------------------- ends

    def close_end(self, which: int) -> Chain:
        """Add the cone faces of an end and return the loop of its plane."""
        end, segments = self.layout.ends[which], self.layout.segments[which][0]
        if not end.cone.present:
            return [(edge, True) for tooth in self.edges[which] for edge in tooth]
        cone = cone_about_z(end.cone.face_radius, end.cone.sine, end.z, up=end.widens > 0)
        for place, edges in zip(self.places, self.edges[which], strict=True):
            for edge, drawn in zip(edges, self.drawn[which], strict=True):
                if drawn.on_cone is not None:
                    self.recorder.lay(edge, cone, drawn.on_cone, place=place)
        if all(segment.on_cone for segment in segments):
            return self._cone_below_root(which, end, cone)
        return self._cone_on_teeth(which, end, cone)

    def _cone_on_teeth(self, which: int, end: End, cone: ConeSurface) -> Chain:
        """Add one piece of cone per tooth; the plane's loop crosses each tooth on the arc where the cone begins."""
        segments, stations = self.layout.segments[which]
        conic = [j for j, segment in enumerate(segments) if segment.on_cone]
        start, stop = segments[conic[0]].start, segments[conic[-1]].end
        first, last = stations[[start, stop], 1]
        loop: Chain = []
        for i, edges in enumerate(self.edges[which]):
            vertices = self.vertices[which][i]
            arc = self._foot(end, i, cone, vertices[start], vertices[stop], first, last)
            self._add_cone_face(end, i, cone, [(edges[j], True) for j in conic], arc)
            loop += [(edge, True) for edge in [*edges[: conic[0]], arc, *edges[conic[-1] + 1 :]]]
        return loop

    def _cone_below_root(self, which: int, end: End, cone: ConeSurface) -> Chain:
        """Add one piece of cone per pitch, parted by generators from the start of each right flank; the plane has a circle."""
        angle = self.layout.segments[which][1][0, 1]
        foot = [end.cone.face_radius * math.cos(angle), end.cone.face_radius * math.sin(angle), end.z]
        feet = [foot for (foot,) in self._vertices_around(np.array([foot]))]
        line, length = straight_line(foot, self.layout.place(end, self.layout.segments[which][1][:1])[0])
        generators = [
            self.recorder.edge(line, feet[i], self.vertices[which][i][0], 0.0, length, place)
            for i, place in enumerate(self.places)
        ]
        before, after = (LineOnSurface(end.widens * at, 0, 0, end.cone.side) for at in (angle, angle + self.pitch))
        loop: Chain = []
        for i, place in enumerate(self.places):
            follows = (i + 1) % self.teeth
            arc = self._foot(end, i, cone, feet[i], feet[follows], angle, angle + self.pitch)
            self.recorder.lay(generators[i], cone, before, place=place)
            self.recorder.lay(generators[follows], cone, after, place=place)
            rim = [(edge, True) for edge in self.edges[which][i]]
            self._add_cone_face(end, i, cone, rim, arc, (generators[i], generators[follows]))
            loop.append((arc, True))
        return loop

    def _foot(self, end: End, i: int, cone: ConeSurface, start: int, stop: int, first: float, last: float) -> int:
        """Return the arc on an end's plane where the cone of tooth i begins."""
        arc = self.recorder.edge(level_circle(end.cone.face_radius, end.z), start, stop, first, last, self.places[i])
        self.recorder.lay(arc, cone, LineOnSurface(0, 0, end.widens, 0), place=self.places[i])
        return arc

    def _add_cone_face(self, end: End, i: int, cone: ConeSurface, rim: Chain, foot: int, sides: tuple[int, ...] = ()) -> None:
        """A piece of cone between `foot` (on the plane) and `rim` (on the teeth), both counter-clockwise seen from +z.

        `sides`: generators at the start and the end of the rim, pointing to it, where it does not close on the foot.
        """
        before, after = ([(edge, True)] for edge in sides) if sides else ([], [])
        around = [*before, *rim, *backward(after), (foot, False)]
        self._face(cone, backward(around) if end.inward > 0 else around, self.places[i])


def add_halves(gear: Gear, recorder: Recorder) -> tuple[Chain, Chain]:
    """Add the toothed sides of both halves, and what is between them.

    Returns the loops of the lower and the upper end face, counter-clockwise seen from +z.
    """
    lower, upper = halves(gear)
    first, below = add_teeth(lower.gear, recorder)
    above, last = add_teeth(upper.gear, recorder.moved(upper.z, math.radians(upper.rotation)))
    heights, radius = (gear.half_width, upper.z), gear.gap_diameter / 2
    rings = tube(recorder, radius, heights, outward=True)
    for ring, loop, z, outward in zip(rings, (below, above), heights, (True, False), strict=True):
        recorder.face(level_plane(z), [loop, ring.loop(along=False)], outward=outward)
    return first, last

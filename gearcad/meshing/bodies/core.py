"""The middle of a gear without a bore: a disc of quadrangles or triangles on the nodes of the circle round it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.meshing.bodies.names import BORE
from gearcad.meshing.section.sector import fill_polygon
from gearcad.meshing.section.transfinite import transfinite

__all__ = ["Disc", "disc", "filled"]


_COARSER = 2.0
"""How many times longer edges must be wanted before three become one."""

_LONGEST = 0.25
"""Longest edge over the radius."""

_FEWEST = 12
"""Least edges of a circle that is left after three of them became one."""

_EVENED = 0.4
"""How much of what distances along a circle differ is taken off from one ring to the next."""

_CORE = 0.55
"""Where the sides of the core are in their middle, over the radius of the circle round it."""

_ROUND = 0.5
"""How round the core is: 0 is a square, 1 a circle."""


def filled(ring: ElementMesh, growth: float) -> ElementMesh:
    """A ring and the disc in it. Raises SolverError if gmsh fails."""
    shape, nodes = ring.element.shape, len(ring.points)
    faces = ring.face_cells(BORE)
    faces = faces[np.argsort(np.arctan2(*ring.points[faces[:, 2], 1::-1].T))]
    circle = faces[:, 1]  # the ring is on their left, so they go clockwise, and begin where the next one ends
    inside = disc(ring.points[circle, :2], ring.element, growth)
    number = np.r_[circle, nodes + np.arange(len(inside.points) - len(circle))]
    corners = number[inside.cells]
    pairs = np.sort(corners[:, np.array(shape.edges)].reshape(-1, 2), axis=1)
    edges, which = np.unique(np.r_[np.sort(faces[:, :2], axis=1), pairs], axis=0, return_inverse=True)
    known = np.full(len(edges), -1)
    known[which[: len(faces)]] = faces[:, 2]
    new = known < 0
    vertices = np.r_[ring.points[:, :2], inside.points[len(circle) :]]
    known[new] = len(vertices) + np.arange(int(new.sum()))
    cells = np.c_[corners, known[which[len(faces) :]].reshape(len(corners), -1)]
    points = np.r_[vertices, vertices[edges[new]].mean(axis=1)]
    first, added = int(ring.cells[:, : shape.vertices].max()) + 1, len(vertices) - nodes
    last = np.arange(len(vertices), len(points))
    place = np.r_[np.arange(first), np.arange(first, nodes) + added, first + np.arange(added), last]  # vertices first
    order = np.argsort(place)
    every = place[np.r_[ring.cells, cells]].astype(np.int32)
    sides = {name: side for name, side in ring.sides.items() if name != BORE}
    space = np.c_[points[order], np.zeros(len(points))]
    return ElementMesh(ring.element, space, every, {name: slice(0, len(every)) for name in ring.parts}, sides)


@dataclass(frozen=True)
class Disc:
    """Vertices (n, 2) in mm, those of the circle first, and elements (m, vertices of one), counter-clockwise."""

    points: Floats
    cells: Wholes


def disc(circle: Floats, element: Element, growth: float) -> Disc:
    """Fill a circle with vertices (n, 2) at `circle`, counter-clockwise about the origin; of quadrangles, n is even.

    Edges grow inwards by `growth` times the distance. Raises SolverError if gmsh fails.
    """
    if element is Element.TRI6:
        points, triangles = fill_polygon(circle, growth)
        return Disc(points, triangles)
    return _Rings(circle, growth).filled()


@dataclass
class _Rings:
    """Circles of vertices from the outside inwards, and the quadrangles between them; `last` is the innermost one."""

    circle: Floats
    growth: float
    points: list[Floats] = field(init=False)
    quads: list[Wholes] = field(init=False)
    last: Wholes = field(init=False)

    def __post_init__(self) -> None:
        self.points, self.quads, self.last = [self.circle], [], np.arange(len(self.circle))

    def filled(self) -> Disc:
        """Rings until edges are as long as they may be, then a core."""
        outer = float(np.hypot(*self.circle[0]))
        while len(self.last) // 3 >= _FEWEST and _COARSER * self._edge < _LONGEST * outer:
            wanted = self._first_edge + self.growth * (outer - self._radius)
            if wanted >= _COARSER * self._edge:
                self._three_to_one(2 * self._edge)
            else:
                self._ring(min(wanted, 1.5 * self._edge))
        self._core()
        return Disc(np.concatenate(self.points), np.concatenate(self.quads))

    @property
    def _first_edge(self) -> float:
        return 2 * math.pi * float(np.hypot(*self.circle[0])) / len(self.circle)

    @property
    def _places(self) -> Floats:
        return np.concatenate(self.points)[self.last]

    @property
    def _radius(self) -> float:
        return float(np.hypot(*self._places[0]))

    @property
    def _edge(self) -> float:
        return 2 * math.pi * self._radius / len(self.last)

    def _add(self, points: Floats) -> Wholes:
        """Numbers of new vertices."""
        count = sum(len(each) for each in self.points)
        self.points.append(points)
        return count + np.arange(len(points))

    def _ring(self, thickness: float) -> None:
        """One quadrangle inside every edge."""
        scaled = self._places * (1 - thickness / self._radius)
        inside = self._add(_evenly(scaled, _EVENED))
        self.quads.append(_band(self.last, inside))
        self.last = inside

    def _three_to_one(self, thickness: float) -> None:
        """One edge inside three, and four quadrangles between; in even distances one inside one where three do not go up.

        a--b--c--d      the circle
        |  |  |  |
        |  p--q  |
        | /    \\ |
        A--------D      its inside
        """
        count = len(self.last)
        triples = count // 3
        starts = np.sort((np.arange(triples) * count) // triples)
        within: Bools = np.zeros(count, bool)  # vertices b and c
        within[starts + 1] = within[starts + 2] = True
        inner, half = np.full(count, -1), np.full(count, -1)
        inner[~within] = self._add(_evenly(self._places[~within] * (1 - thickness / self._radius)))
        a, b, c, d = (self.last[(starts + step) % count] for step in range(4))
        first, second = inner[starts], inner[(starts + 3) % count]
        places = np.concatenate(self.points)
        half[starts + 1] = self._add((places[b] + (2 * places[first] + places[second]) / 3) / 2)
        half[starts + 2] = self._add((places[c] + (places[first] + 2 * places[second]) / 3) / 2)
        p, q = half[starts + 1], half[starts + 2]
        # Seen along the circle, counter-clockwise, its inside is on the left.
        self.quads += [
            np.stack(quad, -1) for quad in ((a, b, p, first), (b, c, q, p), (c, d, second, q), (first, p, q, second))
        ]
        single = np.flatnonzero(~within & ~np.roll(within, -1))
        after = (single + 1) % count
        self.quads.append(np.stack([self.last[single], self.last[after], inner[after], inner[single]], -1))
        self.last = inner[~within]

    def _core(self) -> None:
        """A rounded square grid, and rings between it and the circle."""
        count, radius = len(self.last), self._radius
        long = (count // 2 + 1) // 2
        short = count // 2 - long
        sides = (long, short, long, short)
        turn = np.concatenate([np.linspace(-math.pi / 4, math.pi / 4, side, endpoint=False) for side in sides])
        share = _CORE * ((1 - _ROUND) / np.cos(turn) + _ROUND)
        rim, layers = self._places, max(1, round((1 - _CORE) * radius / self._edge))
        for layer in range(1, layers + 1):
            inside = self._add(rim * (1 + (share - 1) * layer / layers)[:, None])
            self.quads.append(_band(self.last, inside))
            self.last = inside
        edge = np.r_[self.last, self.last[:1]]
        lower, right = edge[: long + 1], edge[long : long + short + 1]
        upper, left = edge[long + short : 2 * long + short + 1][::-1], edge[2 * long + short :][::-1]
        every = np.concatenate(self.points)
        grid = transfinite(every[lower], every[upper], every[left], every[right])
        numbers = np.empty((short + 1, long + 1), int)
        numbers[0], numbers[-1], numbers[:, 0], numbers[:, -1] = lower, upper, left, right
        numbers[1:-1, 1:-1] = self._add(grid[1:-1, 1:-1].reshape(-1, 2)).reshape(short - 1, long - 1)
        corners = (numbers[:-1, :-1], numbers[:-1, 1:], numbers[1:, 1:], numbers[1:, :-1])
        self.quads.append(np.stack([part.ravel() for part in corners], -1))


def _evenly(points: Floats, share: float = 1.0) -> Floats:
    """Points (n, 2) of a circle moved along it to equal distances, or by a share of the way."""
    angles = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    even = 2 * math.pi * np.arange(len(points)) / len(points)
    even += float(np.mean(angles - even))
    angles += share * (even - angles)
    return float(np.hypot(*points[0])) * np.stack([np.cos(angles), np.sin(angles)], -1)


def _band(outside: Wholes, inside: Wholes) -> Wholes:
    """Quadrangles between two circles of as many vertices."""
    result: Wholes = np.stack([outside, np.roll(outside, -1), np.roll(inside, -1), inside], -1)
    return result

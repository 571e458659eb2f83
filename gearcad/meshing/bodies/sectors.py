"""Sectors of the teeth of a gear, finer where teeth touch, and the disc in the middle of a gear without a bore."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import ParameterError, require_number
from gearcad.core.records import Bools, Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, Involute
from gearcad.meshing.bodies.element_mesh import BORE, ElementMesh
from gearcad.meshing.fem import Element
from gearcad.meshing.outline import (
    EdgeLength,
    HalfLengths,
    MeshSizes,
    OutlineSide,
    SectorSides,
    bent_lengths,
    require_fillet,
    rim_radius,
)
from gearcad.meshing.quads import SectorLayout, fill_layout, quadrangles, transfinite
from gearcad.meshing.sector import fill_polygon, mesh_sector

_GROWTH = 0.25
"""Growth of edges outside the zone, as a share of the distance from the zone."""


@dataclass(frozen=True, kw_only=True)
class ContactRefinement:
    """Edges of `edge` (mm) over `half_width` (mm of arc) on both sides of the flank's point at roll length `length` (mm).

    It is on the left flank, or, if not `left`, on the right one; signs of roll lengths do not matter. Raises ParameterError.
    """

    length: float
    half_width: float
    edge: float
    left: bool = True

    def __post_init__(self) -> None:
        require_number("length", self.length)
        require_number("half_width", self.half_width, at_least=0.0)
        require_number("edge", self.edge, above=0)


def lengths_near(gear: Gear, zone: ContactRefinement) -> HalfLengths:
    """Longest edges on all curves of the half of the tooth whose flank has the zone."""
    curves = gear.profile.curves
    flank = next(curve for curve in curves if isinstance(curve, Involute))
    first, last = (roll * flank.base_radius for roll in (flank.first, flank.last))
    at, whole = (abs(length**2 - first**2) / (2 * flank.base_radius) for length in (zone.length, last))
    # Distances on the other curves are counted as if each of them began where the involute ends.
    begins = {CurveKind.INVOLUTE: 0.0, CurveKind.CHAMFER: whole, CurveKind.TIP: whole + _length(curves, CurveKind.CHAMFER)}

    def lengths(kind: CurveKind) -> EdgeLength:
        def on_curve(run: Floats, own: float) -> Floats:
            distance = np.abs(run + begins.get(kind, -own) - at)
            longest: Floats = zone.edge + _GROWTH * np.maximum(distance - zone.half_width, 0.0)
            return longest

        return on_curve

    return HalfLengths({kind: lengths(kind) for kind in (CurveKind.FILLET, *begins)})


def _length(curves: tuple[Curve, ...], kind: CurveKind) -> float:
    """Return the length (mm) of a straight piece of the outline, 0 if there is none."""
    return sum(
        float(np.hypot(*np.diff(curve.points(np.array([0.0, 1.0])), axis=0)[0])) for curve in curves if curve.kind is kind
    )


_COARSER = 2.0
"""Ratio of wanted to present edge length from which three edges become one."""

_LONGEST = 0.25
"""Largest ratio of an edge to the radius."""

_FEWEST = 12
"""Least number of edges of a circle after three of them became one."""

_EVENED = 0.4
"""Share of the differences of distances along a circle that is taken off from one ring to the next."""

_CORE = 0.55
"""Distance of the middle of the core's sides from the centre, over the radius of the circle round it."""

_ROUND = 0.5
"""Roundness of the core: 0 is a square, 1 a circle."""


def filled(ring: ElementMesh, growth: float) -> ElementMesh:
    """Return the mesh of a ring and of the disc in it. Raises SolverError if gmsh fails."""
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
        """Return rings until edges reach their permitted length, then a core."""
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
        """Return the numbers of new vertices."""
        count = sum(len(each) for each in self.points)
        self.points.append(points)
        return count + np.arange(len(points))

    def _ring(self, thickness: float) -> None:
        """Add a ring with one quadrangle inside every edge."""
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
    """Return the points (n, 2) of a circle moved along it to equal distances, or by a share of the way."""
    angles = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    even = 2 * math.pi * np.arange(len(points)) / len(points)
    even += float(np.mean(angles - even))
    angles += share * (even - angles)
    return float(np.hypot(*points[0])) * np.stack([np.cos(angles), np.sin(angles)], -1)


def _band(outside: Wholes, inside: Wholes) -> Wholes:
    """Return the quadrangles between two circles of as many vertices."""
    result: Wholes = np.stack([outside, np.roll(outside, -1), np.roll(inside, -1), inside], -1)
    return result


_BESIDE = 1.5
"""First edge of a cut over that of the root land or fillet beside it, at most."""


class SectorCount(NamedTuple):
    """Elements of a sector; edges of its outline but for the cuts, those of them on the inner circle, those of a cut."""

    elements: int
    outline: int
    inner: int
    cut: int


class _Kind(NamedTuple):
    """Kind of a tooth's sector: its zone of short edges, and whether it is as fine as sizes ask for."""

    zone: ContactRefinement | None
    fine: bool


@dataclass(frozen=True)
class Sectors:
    """Sectors of tooth 0 as each tooth has them; equal ones are meshed once. `held_radius` (mm) 0 is of a full disc, that of
    a ring is its rim's.

    `zones` are those of the teeth by number, from 0. Raises ParameterError and GeometryError.
    """

    gear: Gear
    held_radius: float
    sizes: MeshSizes
    element: Element
    zones: Mapping[int, ContactRefinement]
    known: dict[_Kind, SectorSides] = field(default_factory=dict)
    counted: dict[_Kind, SectorCount] = field(default_factory=dict)

    @classmethod
    def of_gear(
        cls, gear: Gear, held_radius: float, sizes: MeshSizes, element: Element, contacts: Mapping[int, ContactRefinement]
    ) -> Sectors:
        """Return the sectors of a gear. Zones may go by any number of a tooth: -1 is the last tooth."""
        return cls(gear, held_radius, sizes, element, {tooth % gear.tooth_count: zone for tooth, zone in contacts.items()})

    def __post_init__(self) -> None:
        if self.element not in (Element.QUAD8, Element.TRI6):
            raise ParameterError("element", self.element.value, 'must be "quad8" or "tri6" for a section')
        require_fillet(self.gear)
        root = self.gear.profile.root_diameter / 2
        if self.gear.internal:
            require_number("held_radius", self.held_radius, "mm", above=root)
        else:
            require_number("held_radius", self.held_radius, "mm", at_least=0, below=root)

    @property
    def disc(self) -> bool:
        """True if there is no bore."""
        return self.held_radius == 0

    @property
    def inside(self) -> float:
        """Radius (mm) where the sectors end."""
        return rim_radius(self.gear) if self.disc else self.held_radius

    def of(self, tooth: int) -> SectorSides:
        """Return the sector of a tooth. Raises GeometryError and SolverError."""
        kind = self._kind(tooth)
        if kind not in self.known:
            self.known[kind] = self._meshed(kind)
        return self.known[kind]

    def count(self, tooth: int) -> SectorCount:
        """Return the counts of a tooth's sector.

        Quadrangles are counted without a mesh. Raises GeometryError and SolverError.
        """
        kind = self._kind(tooth)
        if kind not in self.counted:
            self.counted[kind] = self._count(kind) if self.element is Element.QUAD8 else _counted(self.of(tooth))
        return self.counted[kind]

    def _count(self, kind: _Kind) -> SectorCount:
        across, up, outer, deep = counts = self._layout(kind.zone).counts
        return SectorCount(round(quadrangles(*counts)), 2 * (across + up + 2 * outer), across + 2 * outer, deep)

    def _kind(self, tooth: int) -> _Kind:
        near = not self.zones or any((tooth + step) % self.gear.tooth_count in self.zones for step in (-1, 0, 1))
        return _Kind(self.zones.get(tooth % self.gear.tooth_count), near or self.element is Element.QUAD8)

    def _meshed(self, kind: _Kind) -> SectorSides:
        zone = kind.zone
        if self.element is Element.QUAD8:
            return fill_layout(self._layout(zone))
        gear, sizes = self.gear, replace(self.sizes, cut=self._cut)
        sizes = sizes if kind.fine else _carrying(sizes)
        plain, zoned = self._lengths(sizes, None), self._lengths(sizes, zone)
        left, right = (zoned, plain) if zone and zone.left != gear.internal else (plain, zoned)
        return mesh_sector(gear, self.inside, sizes, left, right)

    @cached_property
    def _cut(self) -> float:
        """Edge length (normal modules) of the cuts of all teeth at the root: not much longer than those beside it."""
        root = self.gear.profile.curves[0]
        beside = float(self._lengths(self.sizes, None).curves[root.kind](np.zeros(1), 0.0)[0])
        return min(self.sizes.cut, _BESIDE * beside / self.gear.normal_module)

    def _layout(self, zone: ContactRefinement | None) -> SectorLayout:
        plain = self._lengths(self.sizes, None)
        rows = self._lengths(self.sizes, zone) if zone else None
        # Quadrangles fill circles of an even number of edges only.
        return SectorLayout(self.gear, self.inside, self.sizes, plain, rows, self.disc and self.gear.tooth_count % 2 == 1)

    def _lengths(self, sizes: MeshSizes, zone: ContactRefinement | None) -> HalfLengths:
        near = lengths_near(self.gear, zone) if zone else None
        return bent_lengths(self.gear, sizes, near, whole=self.element is Element.TRI6)


def _counted(sector: SectorSides) -> SectorCount:
    edges = {side: (len(chain) - 1) // 2 for side, chain in sector.sides.items()}
    cut = edges[OutlineSide.AHEAD]
    return SectorCount(len(sector.cells), sum(edges.values()) - 2 * cut, edges[OutlineSide.HELD], cut)


def _carrying(sizes: MeshSizes) -> MeshSizes:
    """Return the sizes of a tooth that only carries on."""
    coarse = sizes.coarse()
    longer = {name: max(getattr(sizes, name), getattr(coarse, name)) for name in ("flank", "corner", "fillet", "outline")}
    return replace(sizes, **longer, fillet_turn=None)

"""A tooth sector in triangles, filled by gmsh on its exact outline, or in hexahedra, swept along the helix."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.gear_data import twist
from gearcad.meshing.outline import HalfLengths, MeshSizes, OutlineSide, SectorSides, Stretch, sector_outline

if TYPE_CHECKING:
    from gearcad.meshing.quads import QuadMesh

_INSTEAD = 'solid checks (model = "3d"), stiffness "potential-energy" and all that is not meshed do without'


def load_gmsh() -> Any:
    """Return the module gmsh. Raises SolverError where it is not installed, or lacks a library of the system."""
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise SolverError(f"gmsh cannot be loaded ({error}): pip install gmsh; {_INSTEAD}") from error
    return gmsh


_DIGITS = 9
"""Decimals of the extent of a polygon that gmsh is told: far below any edge, far above the last bits."""

_EDGES = ((0, 1), (1, 2), (2, 0))
"""Vertices of the three edges of a triangle, in the order of its mid-side nodes."""


@dataclass(frozen=True)
class SectorMesh(SectorSides):
    """Quadratic triangles of tooth 0, centred on +x, and its share of the body.

    `points` (n, 2) in mm, vertices first; `triangles` (m, 6), three vertices and the nodes between 0-1, 1-2, 2-0,
    counter-clockwise. `straight` sectors, those of a rack, follow each other along y and not round a circle.
    """

    points: Floats
    triangles: Wholes
    sides: Mapping[OutlineSide, Wholes]
    straight: bool = False

    @property
    def cells(self) -> Wholes:
        return self.triangles


def mesh_sector(
    gear: Gear,
    held_radius: float,
    sizes: MeshSizes | None = None,
    left: HalfLengths | None = None,
    right: HalfLengths | None = None,
) -> SectorMesh:
    """Mesh tooth 0 of the gear's transverse section up to `held_radius` (mm). Raises SolverError if gmsh fails,
    GeometryError for a tooth without a fillet.

    `left` and `right` are edge lengths along the halves of the tooth, where they are not those of `sizes`.
    """
    outline = sector_outline(gear, held_radius, sizes or MeshSizes(), left, right)
    corners = np.concatenate([stretch.ends[:-1] for stretch in outline])
    points, triangles = fill_polygon(corners)
    return quadratic_sector(points, triangles, outline)


def fill_polygon(outline: Floats, growth: float | None = None) -> tuple[Floats, Wholes]:
    """Return the points and triangles (m, 3) that fill a polygon without adding to its corners, which come first.

    Triangles have edges as the outline has near them; or, in a circle about the origin, longer ones by `growth` times the
    distance. Raises SolverError if gmsh fails.
    """
    gmsh = load_gmsh()
    count = len(outline)
    gmsh.initialize(interruptible=False)  # the other way works in the main thread only
    try:
        gmsh.option.set_number("General.Terminal", 0)
        gmsh.option.set_number("Mesh.MeshSizeFromPoints", 0)
        gmsh.option.set_number("Mesh.MeshSizeExtendFromBoundary", 1)
        gmsh.option.set_number("Mesh.Algorithm", 6)
        # In round numbers of its own extent: which triangles a polygon gets must not hang on its size, or on the last bits.
        extent = float(np.abs(outline).max())
        for number, (x, y) in enumerate(np.round(outline / extent, _DIGITS), 1):
            gmsh.model.geo.add_point(x, y, 0, tag=number)
        for number in range(1, count + 1):
            gmsh.model.geo.add_line(number, number % count + 1, tag=number)
            gmsh.model.geo.mesh.set_transfinite_curve(number, 2)
        surface = gmsh.model.geo.add_plane_surface([gmsh.model.geo.add_curve_loop(list(range(1, count + 1)))])
        gmsh.model.geo.synchronize()
        if growth is not None:
            edge = float(np.hypot(*(outline[1] - outline[0]))) / extent
            gmsh.option.set_number("Mesh.MeshSizeExtendFromBoundary", 0)
            gmsh.model.mesh.set_size_callback(
                lambda _dimension, _tag, x, y, _z, _size: edge + growth * max(1 - math.hypot(x, y), 0.0)
            )
        gmsh.model.mesh.generate(2)
        tags, coordinates, _ = gmsh.model.mesh.get_nodes()
        corners = [int(gmsh.model.mesh.get_nodes(0, number)[0][0]) for number in range(1, count + 1)]
        found = gmsh.model.mesh.get_elements_by_type(2, surface)[1].astype(int)
    except Exception as error:
        raise SolverError(f"gmsh could not mesh the section: {error}") from error
    finally:
        gmsh.finalize()
    inside = [int(tag) for tag in tags if int(tag) not in set(corners)]
    order = np.array([*corners, *inside])
    place = np.full(int(tags.max()) + 1, -1)
    place[order] = np.arange(len(order))
    row = np.empty(int(tags.max()) + 1, int)
    row[tags.astype(int)] = np.arange(len(tags))
    points = extent * coordinates.reshape(-1, 3)[row[order], :2]
    points[: len(outline)] = outline
    return points, place[found].reshape(-1, 3)


def quadratic_sector(points: Floats, triangles: Wholes, outline: list[Stretch], *, straight: bool = False) -> SectorMesh:
    """Add mid-side nodes: on the exact curve along the outline, half-way elsewhere."""
    x, y = (points[triangles][:, :, axis] for axis in (0, 1))
    area = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
    triangles = np.where(area[:, None] < 0, triangles[:, ::-1], triangles)
    pairs = np.sort(triangles[:, _EDGES].reshape(-1, 2), axis=1)
    edges, which = np.unique(pairs, axis=0, return_inverse=True)
    middles = points[edges].mean(axis=1)
    number = {(int(a), int(b)): index for index, (a, b) in enumerate(edges)}
    sides: dict[OutlineSide, Wholes] = {}
    count, start = sum(len(stretch.mids) for stretch in outline), 0
    for stretch in outline:
        ends = (start + np.arange(len(stretch.ends))) % count
        start += len(stretch.mids)
        between = np.array([number[min(a, b), max(a, b)] for a, b in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)])
        middles[between] = stretch.mids
        chain = np.empty(len(ends) + len(between), int)
        chain[::2], chain[1::2] = ends, len(points) + between
        # The tip comes in two halves, one after the other.
        sides[stretch.side] = np.r_[sides[stretch.side], chain[1:]] if stretch.side in sides else chain
    nodes = np.c_[triangles, len(points) + which.reshape(-1, 3)]
    return SectorMesh(np.r_[points, middles], nodes, sides, straight)


_HOLLOW = 0.03
"""Ratio of inner to outer diameter of the hollow shaft that replaces a solid one: a wedge cannot end in a point."""

_LONGEST = 0.25
"""Longest edge along a radius, over the radius."""

_GROWTH = 1.3
"""An edge along a radius over the one outside it."""


def with_shaft(mesh: SectorMesh, shaft_bore: float) -> SectorMesh:
    """Return the sector and its share of a shaft with a bore of `shaft_bore` (mm), 0 for a solid one.

    The sector's nodes and triangles come first; its cuts go on through the shaft, and it is held in the shaft's bore.
    """
    arc = mesh.sides[OutlineSide.HELD]
    outer, angle = np.hypot(*mesh.points[arc[0]]), 2 * np.arctan2(*mesh.points[arc[0], ::-1])
    radii = _radii(float(outer), max(shaft_bore / 2, _HOLLOW * float(outer)), float(angle) / (len(arc) // 2))
    added = (radii[1:, None, None] / outer) * mesh.points[arc]
    numbers = np.concatenate([arc[None], len(mesh.points) + np.arange(added[..., 0].size).reshape(added.shape[:2])])
    sides = dict(mesh.sides)
    sides[OutlineSide.AHEAD] = np.r_[sides[OutlineSide.AHEAD], numbers[1:, 0]]
    sides[OutlineSide.BEHIND] = np.r_[numbers[:0:-1, -1], sides[OutlineSide.BEHIND]]
    sides[OutlineSide.HELD] = numbers[-1]
    return SectorMesh(np.r_[mesh.points, added.reshape(-1, 2)], np.r_[mesh.triangles, _triangles(numbers)], sides)


def _radii(outer: float, inner: float, angle: float) -> Floats:
    """Return the radii (mm) of the circles of nodes: edges as long as they are wide at first, `angle` (rad), then longer by and
    by.
    """
    ends = [outer]
    while ends[-1] > inner * (1 + angle / 2):
        ends.append(max(inner, ends[-1] * (1 - min(angle, _LONGEST))))
        angle *= _GROWTH
    ends[-1] = inner
    return np.interp(np.arange(2 * len(ends) - 1) / 2, np.arange(len(ends)), ends)


def _triangles(numbers: Wholes) -> Wholes:
    """Return two quadratic triangles in every cell of a grid of nodes, whose rows go inwards and whose columns go clockwise."""

    def at(row: int, column: int) -> Wholes:
        rows, columns = numbers.shape
        return numbers[row : row + rows - 2 : 2, column : column + columns - 2 : 2].ravel()

    upper = (at(0, 0), at(2, 0), at(2, 2), at(1, 0), at(2, 1), at(1, 1))
    lower = (at(0, 0), at(2, 2), at(0, 2), at(1, 1), at(1, 2), at(0, 1))
    triangles: Wholes = np.r_[np.stack(upper, -1), np.stack(lower, -1)]
    return triangles


_CROWDING = 0.5
"""Share by which the layers at the ends are thinner than the mean, and those in the middle thicker."""


def layer_planes(width: float, layers: int) -> Floats:
    """Return the heights (layers + 1,) in mm of the planes between layers, closer together towards both ends."""
    share = np.linspace(0.0, 1.0, layers + 1)
    planes: Floats = width * (share - _CROWDING * np.sin(2 * np.pi * share) / (2 * np.pi))
    return planes


@dataclass(frozen=True)
class Stack:
    """Numbering of the nodes of a swept section, whose vertices come first: `nodes` of each plane in turn, then the vertices,
    `half` of them, half-way up each layer; elements of first order have none there.
    """

    nodes: int
    half: int
    layers: int

    @property
    def total(self) -> int:
        """Number of nodes in all."""
        return self.middle(self.layers)

    def plane(self, k: int) -> int:
        """Return the number of the first node of plane k."""
        return k * self.nodes

    def middle(self, k: int) -> int:
        """Return the number of the first node half-way up layer k."""
        return (self.layers + 1) * self.nodes + k * self.half

    def elements(self, quads: Wholes, layer: int) -> Wholes:
        """Hexahedra (m, 20) over section quadrangles (m, 8): nodes of the lower plane, of the upper one, and half-way up.

        Over four vertices without nodes half-way, those of first order (m, 8).
        """
        above = [quads[:, :4] + self.middle(layer)] if self.half else []
        return np.concatenate([quads + self.plane(layer), quads + self.plane(layer + 1), *above], axis=1)

    def over(self, nodes: Wholes) -> Wholes:
        """Return all nodes above section nodes: plane by plane, then half-way up layer by layer."""
        half = nodes[nodes < self.half]
        flat = [nodes + self.plane(k) for k in range(self.layers + 1)]
        return np.concatenate([*flat, *(half + self.middle(k) for k in range(self.layers))])


@dataclass(frozen=True)
class SweptMesh:
    """The section turned by `rate` (rad/mm) along z: nodes of each plane in turn, then the vertices half-way up each layer.

    Vectors at a node are seen from axes that turn with the section, so equal layers have equal matrices.
    """

    section: QuadMesh
    planes: Floats
    rate: float

    @property
    def layers(self) -> int:
        """Layers of hexahedra."""
        return len(self.planes) - 1

    @property
    def _stack(self) -> Stack:
        return Stack(len(self.section.points), self.section.vertices, self.layers)

    @property
    def nodes(self) -> int:
        """Number of nodes in all."""
        return self._stack.total

    def plane(self, k: int) -> int:
        """Return the number of the first node of plane k."""
        return self._stack.plane(k)

    def elements(self, quads: Wholes, layer: int) -> Wholes:
        """Hexahedra (m, 20) over section quadrangles (m, 8): nodes of the lower plane, of the upper one, and half-way up."""
        return self._stack.elements(quads, layer)

    def side_faces(self, edges: Wholes, layer: int) -> Wholes:
        """Return the faces (n, 8) of a layer over edges (n, 3) of the section - end, end,
        middle - seen with the sweep upwards.
        """
        first, second, middle = edges.T
        low, high, half = self._stack.plane(layer), self._stack.plane(layer + 1), self._stack.middle(layer)
        corners = [first + low, second + low, second + high, first + high]
        return np.stack([*corners, middle + low, second + half, middle + high, first + half], -1)

    def over(self, nodes: Wholes) -> Wholes:
        """Return all nodes of the mesh above section nodes: plane by plane, then half-way up layer by layer."""
        return self._stack.over(nodes)

    @cached_property
    def _section_node(self) -> Wholes:
        every = np.arange(len(self.section.points))
        result: Wholes = np.r_[np.tile(every, len(self.planes)), np.tile(every[: self.section.vertices], self.layers)]
        return result

    @cached_property
    def heights(self) -> Floats:
        """z (n,) of every node (mm)."""
        middles = (self.planes[1:] + self.planes[:-1]) / 2
        result: Floats = np.r_[np.repeat(self.planes, len(self.section.points)), np.repeat(middles, self.section.vertices)]
        return result

    @cached_property
    def points(self) -> Floats:
        """Places (n, 3) of all nodes (mm)."""
        result: Floats = np.c_[turned(self.section.points[self._section_node], self.rate * self.heights), self.heights]
        return result

    @property
    def in_section(self) -> Floats:
        """Places (n, 2) of all nodes in the turning axes (mm)."""
        return self.section.points[self._section_node]

    def to_space(self, vectors: Floats, nodes: Wholes | slice = slice(None)) -> Floats:
        """Return the vectors (n, 3, ...) at the nodes, or some of them, from the turning axes to fixed ones."""
        return _turned_vectors(vectors, self.rate * self.heights[nodes])

    def to_turning(self, vectors: Floats, nodes: Wholes | slice = slice(None)) -> Floats:
        """Return the vectors (n, 3, ...) at the nodes, or some of them, from fixed axes to the turning ones."""
        return _turned_vectors(vectors, -self.rate * self.heights[nodes])

    def side(self, side: OutlineSide) -> Wholes:
        """Section nodes of a side of the outline."""
        return self.section.sides[side]


def turned(points: Floats, angles: Floats) -> Floats:
    """Return the points (n, 2) turned by angles (n,) in rad."""
    cosine, sine = np.cos(angles), np.sin(angles)
    x, y = points.T
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], -1)


def _turned_vectors(vectors: Floats, angles: Floats) -> Floats:
    shape = (-1, *[1] * (vectors.ndim - 2))
    cosine, sine = np.cos(angles).reshape(shape), np.sin(angles).reshape(shape)
    x, y, z = vectors[:, 0], vectors[:, 1], vectors[:, 2]
    result: Floats = np.empty(vectors.shape)
    np.subtract(cosine * x, sine * y, out=result[:, 0])
    np.add(sine * x, cosine * y, out=result[:, 1])
    result[:, 2] = z
    return result


def sweep(gear: Gear, section: QuadMesh, layers: int) -> SweptMesh:
    """Sweep the section of a gear over its face width."""
    return SweptMesh(section, layer_planes(gear.face_width, layers), twist(gear))

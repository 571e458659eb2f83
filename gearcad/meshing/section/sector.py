"""A quadratic triangle mesh of one tooth sector. gmsh fills the outline; the outline itself is exact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import SolverError
from gearcad.geometry import Gear
from gearcad.meshing.gmsh_library import load_gmsh
from gearcad.meshing.section.outline import HalfLengths, MeshSizes, SectorSides, Side, Stretch, sector_outline

__all__ = ["MeshSizes", "SectorMesh", "fill_polygon", "mesh_sector"]


_DIGITS = 9
"""Decimals of the extent of a polygon that gmsh is told: far below any edge, far above the last bits."""

_EDGES = ((0, 1), (1, 2), (2, 0))
"""Vertices of the three edges of a triangle, in the order of its mid-side nodes."""


@dataclass(frozen=True)
class SectorMesh(SectorSides):
    """Quadratic triangles of tooth 0, centred on +x, and its share of the body.

    `points` (n, 2) in mm, vertices first; `triangles` (m, 6), three vertices and the nodes between 0-1, 1-2, 2-0,
    counter-clockwise.
    """

    points: Floats
    triangles: Wholes
    sides: Mapping[Side, Wholes]

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
    return _quadratic(points, triangles, outline)


def fill_polygon(outline: Floats, growth: float | None = None) -> tuple[Floats, Wholes]:
    """Points and triangles (m, 3) that fill a polygon without adding to its corners, which come first.

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


def _quadratic(points: Floats, triangles: Wholes, outline: list[Stretch]) -> SectorMesh:
    """Add mid-side nodes: on the exact curve along the outline, half-way elsewhere."""
    x, y = (points[triangles][:, :, axis] for axis in (0, 1))
    area = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
    triangles = np.where(area[:, None] < 0, triangles[:, ::-1], triangles)
    pairs = np.sort(triangles[:, _EDGES].reshape(-1, 2), axis=1)
    edges, which = np.unique(pairs, axis=0, return_inverse=True)
    middles = points[edges].mean(axis=1)
    number = {(int(a), int(b)): index for index, (a, b) in enumerate(edges)}
    sides: dict[Side, Wholes] = {}
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
    return SectorMesh(np.r_[points, middles], nodes, sides)

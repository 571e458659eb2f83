"""A mesh of quadratic quadrangles of one tooth sector, to be swept along the helix."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gearcad.geometry import Gear
from gearcad.meshing.outline import MeshSizes, Side, Stretch, sector_outline
from gearcad.meshing.sector import fill_polygon

__all__ = ["QuadMesh", "mesh_quads"]

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class QuadMesh:
    """Quadrangles of tooth 0, centred on +x, and its share of the body.

    `points` (n, 2) in mm, the `vertices` first; `quads` (m, 8), four vertices counter-clockwise and the nodes between 0-1,
    1-2, 2-3, 3-0; `sides` gives the nodes of each side in order along the outline: end, middle, end ... end.
    """

    points: Floats
    vertices: int
    quads: Indices
    sides: Mapping[Side, Indices]

    @property
    def ahead(self) -> Indices:
        """Nodes of the cut at plus half a pitch, from the root inwards."""
        return self.sides[Side.AHEAD]

    @property
    def behind(self) -> Indices:
        """Nodes of the cut at minus half a pitch, from the root inwards: the k-th meets the k-th of `ahead`."""
        return self.sides[Side.BEHIND][::-1]


def mesh_quads(gear: Gear, inner_radius: float, sizes: MeshSizes) -> QuadMesh:
    """Mesh tooth 0 of the transverse section down to `inner_radius` (mm); the edges are half as long as `sizes` says.

    gmsh fills the outline with triangles and quadrangles, each of which is divided into three or four. Raises SolverError.
    """
    outline = sector_outline(gear, inner_radius, sizes)
    corners = np.concatenate([stretch.ends[:-1] for stretch in outline])
    points, triangles, quads = fill_polygon(corners, recombine=True)
    cells = [_counter_clockwise(points, cell) for cell in (triangles, quads)]
    halved = _Edges.of([(int(a), int(b)) for cell in cells for row in cell for a, b in _around(row.tolist())])
    middles = points[halved.ends].mean(axis=1)
    chains = list(_chains(outline, len(corners)))
    for stretch, chain in chains:
        middles[[halved.number(a, b) for a, b in pairwise(chain)]] = stretch.mids
    centres = [points[cell].mean(axis=1) for cell in cells]
    vertices = np.r_[points, middles, *centres]
    small, centre = [], len(points) + len(middles)
    for cell in cells:
        for row in cell.tolist():
            middle = [len(points) + halved.number(a, b) for a, b in _around(row)]
            small += [[row[k], middle[k], centre, middle[k - 1]] for k in range(len(row))]
            centre += 1
    return _with_middles(vertices, np.array(small), chains, halved, len(points))


def _with_middles(
    vertices: Floats, quads: Indices, chains: list[tuple[Stretch, list[int]]], halved: _Edges, corners: int
) -> QuadMesh:
    """Add the nodes between the vertices: on the exact curve along the outline, half-way elsewhere."""
    edges = _Edges.of([(int(a), int(b)) for row in quads for a, b in _around(row.tolist())])
    middles = vertices[edges.ends].mean(axis=1)
    sides: dict[Side, Indices] = {}
    for stretch, chain in chains:
        fine = [chain[0]]
        for a, b in pairwise(chain):
            fine += [corners + halved.number(a, b), b]
        between = [edges.number(a, b) for a, b in pairwise(fine)]
        middles[between] = stretch.points[1::2]
        nodes = np.empty(len(fine) + len(between), int)
        nodes[::2], nodes[1::2] = fine, len(vertices) + np.array(between)
        # The tip comes in two halves, one after the other.
        sides[stretch.side] = np.r_[sides[stretch.side], nodes[1:]] if stretch.side in sides else nodes
    mids = np.array([[len(vertices) + edges.number(a, b) for a, b in _around(row)] for row in quads.tolist()])
    return QuadMesh(np.r_[vertices, middles], len(vertices), np.c_[quads, mids], sides)


@dataclass(frozen=True)
class _Edges:
    """The edges between pairs of nodes, each once."""

    ends: Indices
    numbers: Mapping[tuple[int, int], int]

    @classmethod
    def of(cls, pairs: list[tuple[int, int]]) -> _Edges:
        ordered = sorted({(min(pair), max(pair)) for pair in pairs})
        return cls(np.array(ordered), {pair: index for index, pair in enumerate(ordered)})

    def number(self, a: int, b: int) -> int:
        return self.numbers[min(a, b), max(a, b)]


def _around(row: list[int]) -> list[tuple[int, int]]:
    """The edges of a polygon."""
    return list(zip(row, [*row[1:], row[0]], strict=True))


def _counter_clockwise(points: Floats, cells: Indices) -> Indices:
    x, y = (points[cells][..., axis] for axis in (0, 1))
    twice_area = (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    result: Indices = np.where(twice_area[:, None] < 0, cells[:, ::-1], cells)
    return result


def _chains(outline: list[Stretch], corners: int) -> list[tuple[Stretch, list[int]]]:
    """Each stretch with the numbers of the corners along it."""
    found, start = [], 0
    for stretch in outline:
        found.append((stretch, ((start + np.arange(len(stretch.ends))) % corners).tolist()))
        start += len(stretch.mids)
    return found

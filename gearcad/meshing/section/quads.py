"""A mesh of quadratic quadrangles of one tooth sector, mapped block by block, to be swept along the helix."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import SolverError
from gearcad.geometry import Gear
from gearcad.meshing.section.layout import LogPlane, Piece, SectorLayout, shares
from gearcad.meshing.section.outline import OTHER_SIDE, MeshSizes, SectorSides, Side
from gearcad.meshing.section.quality import LEAST_SCALED_JACOBIAN, scaled_jacobians
from gearcad.meshing.section.transfinite import transfinite

__all__ = ["QuadMesh", "fill_layout", "mesh_quads"]


_FLIPPED = np.array([-1.0, 1.0])
"""Turns angles over and leaves radii as they are."""


@dataclass(frozen=True)
class QuadMesh(SectorSides):
    """Quadrangles of tooth 0, centred on +x, and its share of the body.

    `points` (n, 2) in mm, the `vertices` first; `quads` (m, 8), four vertices counter-clockwise and the nodes between 0-1,
    1-2, 2-3, 3-0.
    """

    points: Floats
    vertices: int
    quads: Wholes
    sides: Mapping[Side, Wholes]

    @property
    def cells(self) -> Wholes:
        return self.quads


def mesh_quads(gear: Gear, held_radius: float, sizes: MeshSizes) -> QuadMesh:
    """Mesh tooth 0 of the transverse section up to `held_radius` (mm), symmetric about the middle of the tooth.

    The number of quadrangles follows the square of the sizes. Raises GeometryError for a tooth without a fillet, SolverError
    where quadrangles would be too distorted.
    """
    return fill_layout(SectorLayout(gear, held_radius, sizes))


def fill_layout(layout: SectorLayout) -> QuadMesh:
    """The quadrangles of a layout. Raises SolverError where they would be too distorted."""
    mesh = _quadratic(_Blocks(layout))
    worst = float(scaled_jacobians(mesh.points[mesh.quads]).min())
    if worst < LEAST_SCALED_JACOBIAN:
        raise SolverError(
            f"the section of the gear with {layout.gear.teeth} teeth makes too bad a mesh: least scaled Jacobian {worst:.3f}, "
            f"must be at least {LEAST_SCALED_JACOBIAN}"
        )
    return mesh


@dataclass(frozen=True)
class _Blocks:
    """The sector as two grids of vertices, columns from the left (y > 0) to the right, rows towards the tip: body and tooth.

    The tooth stands on the middle of the body's last row.
    """

    layout: SectorLayout

    @property
    def _plane(self) -> LogPlane:
        return self.layout.plane

    @cached_property
    def root(self) -> Floats:
        """Ends and middles (2 outer + 1, 2) from the cut to the split of the fillet (mm)."""
        return _along(self.layout.root, self.layout.counts.outer)

    @cached_property
    def flank(self) -> Floats:
        """Ends and middles (2 up + 1, 2) from the split of the fillet to the tip land (mm)."""
        return _along(self.layout.flank, self.layout.counts.up)

    @cached_property
    def tip(self) -> Floats:
        """Ends and middles (2 across + 1, 2) of the tip land from left to right (mm)."""
        return _along(self.layout.tip, self.layout.counts.across)

    @cached_property
    def tooth(self) -> Floats:
        """Vertices (up + 1, across + 1, 2) as angles and logarithms of radii."""
        left = self._plane.places(self.flank[::2])
        return transfinite(self._across, self._plane.places(self.tip[::2]), left, left * _FLIPPED)

    @cached_property
    def body(self) -> Floats:
        """Vertices (deep + 1, outer + across + outer + 1, 2) as angles and logarithms of radii."""
        layout, counts = self.layout, self.layout.counts
        down = layout.down_line(layout.down.ends(counts.deep))
        cut = layout.cut_line(down)
        left = transfinite(np.linspace(cut[0], down[0], counts.outer + 1), self._plane.places(self.root[::2]), cut, down)
        core = transfinite(np.linspace(down[0], down[0] * _FLIPPED, counts.across + 1), self._across, down, down * _FLIPPED)
        return np.concatenate([left[:, :-1], core, left[:, -2::-1] * _FLIPPED], axis=1)

    @cached_property
    def _across(self) -> Floats:
        return self.layout.across_line(self.layout.across.ends(self.layout.counts.across))

    @cached_property
    def numbers(self) -> tuple[Wholes, Wholes]:
        """Numbers of the vertices of body and tooth, each vertex once."""
        counts = self.layout.counts
        rows, columns, _ = self.body.shape
        body = np.arange(rows * columns).reshape(rows, columns)
        above = body.size + np.arange(counts.up * (counts.across + 1)).reshape(counts.up, -1)
        return body, np.r_[body[-1:, counts.outer : counts.outer + counts.across + 1], above]

    @property
    def points(self) -> Floats:
        """All vertices (n, 2) in mm, as they are numbered."""
        places = np.concatenate([self.body.reshape(-1, 2), self.tooth[1:].reshape(-1, 2)])
        return self._plane.points(places)

    @property
    def quads(self) -> Wholes:
        """Vertices (m, 4) of all quadrangles, counter-clockwise."""
        grids = ([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]] for grid in self.numbers)
        quads = np.concatenate([np.stack([part.ravel() for part in grid], -1) for grid in grids])
        return quads[:, ::-1] if self._plane.inward else quads

    @cached_property
    def sides(self) -> list[tuple[Side, Wholes, Floats]]:
        """The outline in order: vertices (n + 1,), and the ends and middles (2 n + 1, 2) of their edges (mm)."""
        body, tooth = self.numbers
        outer = self.layout.counts.outer
        # From the cut over the root and up to the tip: numbers on both sides, points on the left.
        left, right = np.r_[body[-1, :outer], tooth[:, 0]], np.r_[body[-1, : -outer - 1 : -1], tooth[:, -1]]
        points = np.concatenate([self.root[:-1], self.flank])
        pieces = [*shares(self.layout.root, outer), *shares(self.layout.flank, self.layout.counts.up)]
        stops = np.cumsum([0, *(count for _, count in pieces)])
        up = [
            (piece.side, slice(a, b + 1), slice(2 * a, 2 * b + 1))
            for (piece, _), (a, b) in zip(pieces, pairwise(stops), strict=True)
        ]
        angles = self.body[0, :, 0]
        arc = np.stack([_with_middles(angles), np.full(2 * len(angles) - 1, self.body[0, 0, 1])], -1)
        return [
            *((OTHER_SIDE[side], right[ends], mirrored(points[both])) for side, ends, both in up),
            (Side.TIP, tooth[-1, ::-1], self.tip[::-1]),
            *((side, left[ends][::-1], points[both][::-1]) for side, ends, both in reversed(up)),
            (Side.AHEAD, body[::-1, 0], self._straight(self.body[::-1, 0])),
            (Side.HELD, body[0], self._plane.points(arc)),
            (Side.BEHIND, body[:, -1], self._straight(self.body[:, -1])),
        ]

    def _straight(self, places: Floats) -> Floats:
        return _with_middles(self._plane.points(places))


def _along(pieces: tuple[Piece, ...], count: int) -> Floats:
    """Ends and middles (2 count + 1, 2) of the edges of pieces that follow each other (mm)."""
    every = [piece.points(own) for piece, own in shares(pieces, count)]
    return np.concatenate([*(points[:-1] for points in every[:-1]), every[-1]])


def _with_middles(ends: Floats) -> Floats:
    """Values (n + 1, ...) with the means of neighbours between them."""
    result = np.empty((2 * len(ends) - 1, *ends.shape[1:]))
    result[::2], result[1::2] = ends, (ends[1:] + ends[:-1]) / 2
    return result


def mirrored(points: Floats) -> Floats:
    """Points (n, 2) on the other side of the tooth."""
    result: Floats = points * np.array([1.0, -1.0])
    return result


def _quadratic(blocks: _Blocks) -> QuadMesh:
    """Vertices and the nodes between them: on the exact curves along the outline, half-way elsewhere."""
    points, quads = blocks.points, blocks.quads
    pairs = np.stack([quads, np.roll(quads, -1, axis=1)], -1).reshape(-1, 2)
    edges, which = np.unique(np.sort(pairs, axis=1), axis=0, return_inverse=True)
    middles = points[edges].mean(axis=1)
    keys = edges[:, 0] * len(points) + edges[:, 1]
    sides: dict[Side, Wholes] = {}
    for side, chain, exact in blocks.sides:
        low, high = np.minimum(chain[1:], chain[:-1]), np.maximum(chain[1:], chain[:-1])
        between = np.searchsorted(keys, low * len(points) + high)
        points[chain], middles[between] = exact[::2], exact[1::2]
        nodes = np.empty(len(exact), int)
        nodes[::2], nodes[1::2] = chain, len(points) + between
        # Tip and fillets come in pieces, one after the other.
        sides[side] = np.r_[sides[side], nodes[1:]] if side in sides else nodes
    return QuadMesh(np.r_[points, middles], len(points), np.c_[quads, len(points) + which.reshape(-1, 4)], sides)

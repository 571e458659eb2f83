"""Curved tetrahedra that came out badly: middles of their inner edges moved until they are as good as that can make them."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Bools, Floats, Indices
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.mesh import Cells
from gearcad.meshing.bodies.quality import scaled_jacobians

__all__ = ["mended", "poor_elements"]

_POOR = 0.06
"""Scaled Jacobian below which it is tried to make an element better."""

_ROUNDS = 6

_SHARES = (1.0, 0.5, 0.25, 0.1, -0.1, -0.25)
"""Shares of the way along which middles are tried."""

_CHUNK = 100_000


def mended(points: Floats, cells: Cells, free: Bools) -> Floats:
    """Points (n, 3) with some of the `free` ones moved, which are middles of inner edges of tetrahedra (m, 10).

    Where a surface curves into flat elements, their other edges have to bend with it. A middle is tried along the mean way that
    the others of its element have gone from half-way, and stays where the worst element that has it is best.
    """
    points = points.copy()
    quality = _of_all(points, cells)
    for _ in range(_ROUNDS):
        poor = np.flatnonzero(quality < _POOR)
        before = quality[poor].copy()
        for element in poor[np.argsort(before)]:
            for node, way in _ways(points, cells[element], free):
                around = np.flatnonzero((cells[:, 4:] == node).any(-1))
                _try(points, cells[around], node, way)
                quality[around] = _least(points, cells[around])
        if np.allclose(quality[poor], before, atol=1e-4):
            break
    return points


def poor_elements(points: Floats, cells: Cells) -> Indices:
    """Numbers of the elements that are poor."""
    return np.flatnonzero(_of_all(points, cells) < _POOR)


def _of_all(points: Floats, cells: Cells) -> Floats:
    return np.concatenate([_least(points, cells[start : start + _CHUNK]) for start in range(0, len(cells), _CHUNK)])


def _least(points: Floats, cells: Cells) -> Floats:
    least: Floats = scaled_jacobians(Element.TET10, points[cells]).min(-1)
    return least


def _ways(points: Floats, cell: Cells, free: Bools) -> list[tuple[int, Floats]]:
    """The free middles of an element, and the mean way that its others have gone from half-way."""
    ends = points[cell[np.array(Element.TET10.shape.edges)]]
    off = points[cell[4:]] - ends.mean(1)
    fixed = ~free[cell[4:]]
    mean = off[fixed].sum(0) / max(np.count_nonzero(fixed), 1)
    return [(int(node), mean) for node in cell[4:][~fixed]]


def _try(points: Floats, cells: Cells, node: int, way: Floats) -> None:
    """Move a node along a way to where the worst of its elements is best, if that is anywhere else."""
    start = points[node].copy()
    best, place = float(_least(points, cells).min()), start
    for share in _SHARES:
        points[node] = start + share * way
        if (worst := float(_least(points, cells).min())) > best:
            best, place = worst, points[node].copy()
    points[node] = place

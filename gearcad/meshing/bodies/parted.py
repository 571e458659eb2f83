"""Tetrahedra with two faces on one smooth surface are parted: however they bend, they are flat where these faces meet."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.mesh import Cells

__all__ = ["inner_edges", "part_edges"]

_INWARDS = (0.0, 0.1, 0.2, 0.35, 0.5)
"""Shares of the way from the middle of an edge to the other vertices around it, along which the new vertex is tried."""

_EDGES = np.array(Element.TET10.shape.edges)


def inner_edges(cells: Cells, inner: Bools) -> list[tuple[int, int]]:
    """Edges inside that are their tetrahedron's only ones there; `inner` (m, 6) tells which are."""
    lone = np.flatnonzero(inner.sum(-1) == 1)
    pairs = np.take_along_axis(cells[lone], _EDGES[inner[lone].argmax(-1)], -1)
    return sorted({(int(min(pair)), int(max(pair))) for pair in pairs})


def part_edges(points: Floats, cells: Cells, edges: list[tuple[int, int]]) -> tuple[Floats, Cells]:
    """Points (n, 3) and tetrahedra (m, 4) with a vertex more in each of these edges, as long as none has two of them."""
    taken, more, halves = set[int](), list[Floats](), list[Cells]()
    cells = cells.copy()
    for edge in edges:
        around = np.flatnonzero(np.isin(cells, edge).sum(-1) == 2)
        if taken.intersection(around.tolist()):
            continue
        taken.update(around.tolist())
        number = len(points) + len(more)
        first, second = (np.where(cells[around] == end, number, cells[around]) for end in edge)
        more.append(_best(points, edge, cells[around], np.concatenate([first, second])))
        cells[around] = first
        halves.append(second.astype(np.int32))
    return np.concatenate([points, np.reshape(more, (-1, 3))]), np.concatenate([cells, *halves])


def _best(points: Floats, edge: tuple[int, int], whole: Cells, parts: Cells) -> Floats:
    """Where the new vertex of an edge makes the worst of the new tetrahedra best."""
    middle = points[list(edge)].mean(0)
    way = points[np.setdiff1d(whole, edge)].mean(0) - middle
    tried = [middle + share * way for share in _INWARDS]
    best: Floats = tried[int(np.argmax([_worst(np.concatenate([points, place[None]]), parts) for place in tried]))]
    return best


def _worst(points: Floats, parts: Cells) -> float:
    """Six times the least volume over the cube of the longest edge; any vertex beyond the others is the last point."""
    places = points[np.minimum(parts, len(points) - 1)]
    volume = np.linalg.det(places[:, 1:] - places[:, :1])
    lengths = np.linalg.norm(places[:, _EDGES[:, 0]] - places[:, _EDGES[:, 1]], axis=-1)
    return float((volume / lengths.max(-1) ** 3).min())

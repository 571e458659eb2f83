"""Flat tetrahedra that no bending makes good are parted: a vertex more, in an edge inside of them or where two of these cross.

With two faces on one smooth surface they are flat where these meet. With two edges that nearly cross they are flat all over,
and vanish when both edges run through one vertex.
"""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Bools, Floats, Indices
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.mesh import Cells

__all__ = ["inner_edges", "part_edges"]

_INWARDS = (0.0, 0.1, 0.2, 0.35, 0.5)
"""Shares of the way from the middle of an edge to the other vertices around it, along which the new vertex is tried."""

_EDGES = np.array(Element.TET10.shape.edges)

_OPPOSITE = np.array([(0, 5), (1, 3), (2, 4)])
"""Edges of a tetrahedron that have no vertex in common."""

_CROSSING = 0.25
"""Edges whose middles are so near, in shares of the longer one, nearly cross."""

Edges = tuple[tuple[int, int], ...]
"""Edges, as vertices, that shall run through one new vertex: one, or two that cross."""


def inner_edges(points: Floats, cells: Cells, inner: Bools) -> list[Edges]:
    """The edges in which tetrahedra (m, 4) can be parted; `inner` (m, 6) tells which of theirs are inside."""
    found = dict[Edges, None]()
    for cell, free in zip(cells, inner, strict=True):
        if free.sum() == 1:
            found[(_pair(cell, int(free.argmax())),)] = None
        elif crossing := _crossing(points[cell], free):
            found[_pair(cell, crossing[0]), _pair(cell, crossing[1])] = None
    return list(found)


def _pair(cell: Cells, edge: int) -> tuple[int, int]:
    low, high = sorted(cell[_EDGES[edge]].tolist())
    return low, high


def _crossing(places: Floats, free: Bools) -> tuple[int, int] | None:
    """Two edges inside that nearly cross, of a tetrahedron with vertices at places (4, 3)."""
    ends = places[_EDGES]
    middles, lengths = ends.mean(1), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1)
    for one, other in _OPPOSITE.tolist():
        near = float(np.linalg.norm(middles[one] - middles[other]))
        if free[one] and free[other] and near < _CROSSING * max(lengths[one], lengths[other]):
            return one, other
    return None


def part_edges(points: Floats, cells: Cells, wanted: list[Edges]) -> tuple[Floats, Cells]:
    """Points (n, 3) and tetrahedra (m, 4) with a vertex more for each of these; left out are those beside another one."""
    taken, more = set[int](), list[Floats]()
    kept, added = np.ones(len(cells), bool), list[Cells]()
    for edges in wanted:
        rings = [np.flatnonzero(np.isin(cells, edge).sum(-1) == 2) for edge in edges]
        around = np.unique(np.concatenate(rings))
        if taken.intersection(around.tolist()):
            continue
        taken.update(around.tolist())
        new = len(points) + len(more)
        parts = _parts(cells, rings, edges, new)
        more.append(_best(points, edges, cells[around], np.concatenate(parts)))
        kept[around] = False
        added += parts
    return np.concatenate([points, np.reshape(more, (-1, 3))]), np.concatenate([cells[kept], *added]).astype(np.int32)


def _parts(cells: Cells, rings: list[Indices], edges: Edges, new: int) -> list[Cells]:
    """What becomes of the tetrahedra around each edge: those that are around both vanish, each other one is two."""
    both = np.intersect1d(rings[0], rings[-1]) if len(rings) == 2 else rings[0][:0]
    found = []
    for ring, edge in zip(rings, edges, strict=True):
        whole = cells[np.setdiff1d(ring, both)]
        found += [np.where(whole == end, new, whole) for end in edge]
    return found


def _best(points: Floats, edges: Edges, whole: Cells, parts: Cells) -> Floats:
    """Where the new vertex makes the worst of the new tetrahedra best."""
    ends = np.unique(edges)
    middle = points[ends].mean(0)
    way = points[np.setdiff1d(whole, ends)].mean(0) - middle
    tried = [middle + share * way for share in _INWARDS]
    best: Floats = tried[int(np.argmax([_worst(np.concatenate([points, place[None]]), parts) for place in tried]))]
    return best


def _worst(points: Floats, parts: Cells) -> float:
    """Six times the least volume over the cube of the longest edge; any vertex beyond the others is the last point."""
    places = points[np.minimum(parts, len(points) - 1)]
    volume = np.linalg.det(places[:, 1:] - places[:, :1])
    lengths = np.linalg.norm(places[:, _EDGES[:, 0]] - places[:, _EDGES[:, 1]], axis=-1)
    return float((volume / lengths.max(-1) ** 3).min())

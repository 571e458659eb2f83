"""The kinds of elements: how many nodes they have and in which order, and which of them are on which side."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

__all__ = ["Element", "Shape"]


@dataclass(frozen=True)
class Shape:
    """An element: its vertices come first, then, if it is of second order, the nodes half-way along its edges.

    `edges` are pairs of vertices, in the order of the nodes between them; `faces` the local nodes of each side, vertices
    first, in an order in which its normal points out of the element. Of plane elements they are edges: end, end, middle.
    Order of nodes and sides are those of Abaqus and CalculiX, so side k, counted from 1, is their S(k).
    """

    dimension: int
    order: int
    vertices: int
    edges: tuple[tuple[int, int], ...]
    faces: tuple[tuple[int, ...], ...]
    face: str

    @property
    def nodes(self) -> int:
        """Nodes of one element."""
        return self.vertices + (len(self.edges) if self.order == 2 else 0)


class Element(Enum):
    """What meshes are made of; the value is the word of commands and files."""

    TRI6 = "tri6"
    QUAD8 = "quad8"
    HEX8 = "hex8"
    HEX20 = "hex20"
    TET10 = "tet10"

    @property
    def shape(self) -> Shape:
        """Its nodes and sides."""
        return _SHAPES[self]


_HEX_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
_HEX_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
_TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))


def _with_middles(
    faces: tuple[tuple[int, ...], ...], edges: tuple[tuple[int, int], ...], vertices: int
) -> tuple[tuple[int, ...], ...]:
    """Sides of an element of second order: after their vertices the nodes between those that follow each other."""
    number = {frozenset(edge): vertices + k for k, edge in enumerate(edges)}
    return tuple((*face, *(number[frozenset(pair)] for pair in zip(face, face[1:] + face[:1], strict=True))) for face in faces)


def _plane(vertices: int) -> Shape:
    """A triangle or quadrangle of second order."""
    edges = tuple((k, (k + 1) % vertices) for k in range(vertices))
    return Shape(2, 2, vertices, edges, tuple((*edge, vertices + k) for k, edge in enumerate(edges)), "line3")


_SHAPES = {
    Element.TRI6: _plane(3),
    Element.QUAD8: _plane(4),
    Element.HEX8: Shape(3, 1, 8, _HEX_EDGES, _HEX_FACES, "quad4"),
    Element.HEX20: Shape(3, 2, 8, _HEX_EDGES, _with_middles(_HEX_FACES, _HEX_EDGES, 8), "quad8"),
    Element.TET10: Shape(3, 2, 4, _TET_EDGES, _with_middles(_TET_FACES, _TET_EDGES, 4), "tri6"),
}

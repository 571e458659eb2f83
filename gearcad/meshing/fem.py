"""Finite elements: scikit-fem's shape functions, quadrature and mappings, for nodes in the order of Abaqus and CalculiX.

Local coordinates are those of scikit-fem: from 0 to 1 along the edges that meet at the first vertex of an element.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.records import Floats, Wholes


@dataclass(frozen=True)
class ElementShape:
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
    """Element of a mesh; the value is the word of commands and files."""

    TRI6 = "tri6"
    QUAD8 = "quad8"
    HEX8 = "hex8"
    HEX20 = "hex20"
    TET10 = "tet10"

    @property
    def shape(self) -> ElementShape:
        """Nodes and sides of the element."""
        return _SHAPES[self]


_HEX_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
_HEX_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
_TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))


def _with_middles(
    faces: tuple[tuple[int, ...], ...], edges: tuple[tuple[int, int], ...], vertices: int
) -> tuple[tuple[int, ...], ...]:
    """Return the sides of an element of second order: after their vertices the nodes between those that follow each other."""
    number = {frozenset(edge): vertices + k for k, edge in enumerate(edges)}
    return tuple((*face, *(number[frozenset(pair)] for pair in zip(face, face[1:] + face[:1], strict=True))) for face in faces)


def _plane(vertices: int) -> ElementShape:
    """Return a triangle or quadrangle of second order."""
    edges = tuple((k, (k + 1) % vertices) for k in range(vertices))
    return ElementShape(2, 2, vertices, edges, tuple((*edge, vertices + k) for k, edge in enumerate(edges)), "line3")


_SHAPES = {
    Element.TRI6: _plane(3),
    Element.QUAD8: _plane(4),
    Element.HEX8: ElementShape(3, 1, 8, _HEX_EDGES, _HEX_FACES, "quad4"),
    Element.HEX20: ElementShape(3, 2, 8, _HEX_EDGES, _with_middles(_HEX_FACES, _HEX_EDGES, 8), "quad8"),
    Element.TET10: ElementShape(3, 2, 4, _TET_EDGES, _with_middles(_TET_FACES, _TET_EDGES, 4), "tri6"),
}


# ---------------------------------------------------------------------- shape functions

SWEPT = "hex20 by levels"
"""Quadratic hexahedra of a swept section: the eight nodes of their lower face, of their upper face, the four half-way up."""

BY_LEVELS = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19]
"""Nodes of hex20, level by level; and, the other way round, those of SWEPT in the order of hex20."""

_LIBRARY = {
    "line3": ("ElementLineP2", "MeshLine1"),
    "tri6": ("ElementTriP2", "MeshTri1"),
    "quad4": ("ElementQuad1", "MeshQuad1"),
    "quad8": ("ElementQuadS2", "MeshQuad1"),
    "hex8": ("ElementHex1", "MeshHex1"),
    "hex20": ("ElementHexS2", "MeshHex1"),
    SWEPT: ("ElementHexS2", "MeshHex1"),
    "tet10": ("ElementTetP2", "MeshTet1"),
}
"""Elements and meshes of scikit-fem for each kind of element or face."""

_QUAD = ((0, 0), (1, 0), (1, 1), (0, 1))
_HEX = (*((*place, 0) for place in _QUAD), *((*place, 1) for place in _QUAD))


def node_places(kind: str) -> Floats:
    """Return the local places (n, dimension) of the nodes of an element or a face."""
    if kind == SWEPT:
        return node_places("hex20")[BY_LEVELS]
    if kind in ("line3", "quad4"):
        return np.array([[0.0], [1.0], [0.5]]) if kind == "line3" else np.array(_QUAD, float)
    shape = Element(kind).shape
    simplex = np.eye(shape.dimension + 1, shape.dimension, -1)
    vertices = simplex if kind in ("tri6", "tet10") else np.array(_QUAD if shape.dimension == 2 else _HEX, float)
    edges = np.array(shape.edges[: shape.nodes - shape.vertices], int).reshape(-1, 2)
    return np.concatenate([vertices, vertices[edges].mean(axis=1)])


class _Library(NamedTuple):
    """scikit-fem's element, its class of mesh, and which of its shape functions (n,) belong to our nodes."""

    element: Any
    mesh: Any
    numbers: Wholes


@cache
def _library(kind: str) -> _Library:
    import skfem

    element, mesh = (getattr(skfem, name) for name in _LIBRARY[kind])
    away = np.abs(node_places(kind)[:, None] - element.doflocs).sum(axis=-1)
    return _Library(element(), mesh, away.argmin(axis=1))


def shape_values(kind: str, places: Floats) -> Floats:
    """Return the values (p, n) of the shape functions of an element or a face ("quad8") at local places (p, dimension)."""
    element, _, numbers = _library(kind)
    return np.stack([element.lbasis(places.T, k)[0] for k in numbers], -1)


def shape_slopes(kind: str, places: Floats) -> Floats:
    """Return the derivatives (p, dimension, n) of the shape functions along the local coordinates."""
    element, _, numbers = _library(kind)
    return np.stack([np.transpose(element.lbasis(places.T, k)[1]) for k in numbers], -1)


class Rule(NamedTuple):
    """Local places (p, dimension) and weights (p,) of a quadrature."""

    places: Floats
    weights: Floats


@cache
def quadrature(kind: str, order: int) -> Rule:
    """Return the rule that integrates polynomials up to an order over an element or a face. Its arrays must not be changed."""
    from skfem.quadrature import get_quadrature

    places, weights = get_quadrature(_library(kind).element, order)
    return Rule(np.ascontiguousarray(places.T), weights)


# ---------------------------------------------------------------------- elements in space


class Mapped(NamedTuple):
    """Elements mapped from local coordinates: gradients (m, n, dimension, p) of their shape functions in 1/mm, and weights
    (m, p) in mm² or mm³, at the places of a rule.
    """

    gradients: Floats
    weights: Floats


def mapped(kind: str, nodes: Floats, rule: Rule) -> Mapped:
    """Map elements with nodes at `nodes` (m, n, dimension) in mm, each for itself."""
    from skfem import CellBasis

    if not len(nodes):  # the library has no mesh without elements
        return Mapped(np.zeros((*nodes.shape, len(rule.weights))), np.zeros((0, len(rule.weights))))
    element, mesh, numbers = _library(kind)
    own = np.empty((nodes.shape[1], len(nodes)), int)
    own[numbers] = np.arange(nodes.shape[0] * nodes.shape[1]).reshape(len(nodes), -1).T
    elements = mesh(np.ascontiguousarray(nodes.reshape(-1, nodes.shape[2]).T), own, elem=type(element), affine=False)
    basis = CellBasis(elements, element, quadrature=(rule.places.T, rule.weights), disable_doflocs=True)
    gradients = np.stack([basis.basis[k][0].grad.swapaxes(0, 1) for k in numbers], axis=1)
    return Mapped(gradients, basis.dx)


def stiffness_matrices(kind: str, nodes: Floats, lame: tuple[float, float], order: int) -> Floats:
    """Return the stiffness (m, n d, n d) of elements with nodes at (m, n, d), dof d a + i, by Lamé's constants (MPa).

    The integral of lambda div u div v + mu (grad u + grad u^T) : grad v, in N/mm, of plane elements per mm of width.
    """
    gradients, weights = mapped(kind, nodes, quadrature(kind, order))
    count, size, dimension, places = gradients.shape
    flat = gradients.reshape(count, size * dimension, places)
    products = ((flat * weights[:, None]) @ flat.swapaxes(1, 2)).reshape(count, size, dimension, size, dimension)
    trace = np.einsum("maibi->mab", products)
    matrices = lame[0] * products + lame[1] * products.swapaxes(2, 4)
    for direction in range(dimension):
        matrices[:, :, direction, :, direction] += lame[1] * trace
    return matrices.reshape(count, size * dimension, size * dimension)


def mass_matrices(kind: str, nodes: Floats, order: int) -> Floats:
    """Return the integrals (m, n d, n d) of N^T N over elements with nodes at (m, n, d), in mm² or mm³."""
    rule, dimension = quadrature(kind, order), nodes.shape[2]
    shapes = shape_values(kind, rule.places)
    products = np.einsum("eq,qa,qb->eab", mapped(kind, nodes, rule).weights, shapes, shapes)
    result: Floats = np.kron(products, np.eye(dimension))
    return result


def field_gradients(kind: str, nodes: Floats, values: Floats, places: Floats) -> Floats:
    """Return the gradients (m, p, dimension, c) at local places (p, dimension) of fields with `values` (m, n, c) at nodes."""
    gradients, _ = mapped(kind, nodes, Rule(places, np.ones(len(places))))
    result: Floats = np.einsum("mnip,mnc->mpic", gradients, values, optimize=True)
    return result


def laplacian(points: Floats, cells: Wholes) -> Any:
    """Return the matrix (scipy CSR, n x n) of Laplace's equation on points (n, 2) of linear triangles (m, 3) or quadrangles
    (m, 4).
    """
    from skfem import Basis, ElementQuad1, ElementTriP1, MeshQuad1, MeshTri1
    from skfem.models.poisson import laplace

    mesh, element = (MeshQuad1, ElementQuad1) if cells.shape[1] == 4 else (MeshTri1, ElementTriP1)
    return laplace.assemble(Basis(mesh(np.ascontiguousarray(points.T), np.ascontiguousarray(cells.T)), element()))


# ---------------------------------------------------------------------- scaled Jacobians

_NOTHING = 1e-300
"""Instead of a length or a volume of zero, so that an element without one can be measured."""


def scaled_jacobians(element: Element, nodes: Floats) -> Floats:
    """Return scaled Jacobians (m, places) of elements with nodes at (m, nodes, dimension): at the nodes and in the centre."""
    dimension = element.shape.dimension
    flat = np.moveaxis(nodes, 2, 1).reshape(-1, nodes.shape[1]) @ _slopes(element)
    directions = flat.reshape(len(nodes), dimension, -1, dimension)  # of coordinates, at places, along axes of the element
    tangents = [np.moveaxis(directions[..., axis], 1, 0) for axis in range(dimension)]
    volume = _spanned(tangents)
    if element in (Element.TRI6, Element.TET10):
        volume *= 2 / math.sqrt(3) if dimension == 2 else math.sqrt(2)
        longest = _longest_at_a_vertex(tangents)
    else:
        longest = np.prod([_length(tangent) for tangent in tangents], axis=0)
    result: Floats = volume / np.maximum(longest, _NOTHING)
    return result


@cache
def _slopes(element: Element) -> Floats:
    """Return the derivatives (nodes, places * dimension) of the shape functions at the nodes and at the centre."""
    places = node_places(element.value)
    centre = places[: element.shape.vertices].mean(axis=0)
    slopes = shape_slopes(element.value, np.concatenate([places, centre[None]]))
    return np.ascontiguousarray(slopes.reshape(-1, slopes.shape[-1]).T)


def _length(vectors: Floats) -> Floats:
    result: Floats = np.sqrt((vectors**2).sum(axis=0))
    return result


def _spanned(tangents: list[Floats]) -> Floats:
    """Volume, or area, that vectors (dimension, ...) span."""
    if len(tangents) == 2:
        (a, b), (c, d) = tangents
        area: Floats = a * d - b * c
        return area
    (a, b, c), (d, e, f), (g, h, i) = tangents
    volume: Floats = a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g)
    return volume


def _longest_at_a_vertex(tangents: list[Floats]) -> Floats:
    """Return the greatest product of the lengths of the edges that meet at a vertex of the simplex that the directions span."""
    corners = [np.zeros_like(tangents[0]), *tangents]
    products = [np.prod([_length(a - b) for a in corners if a is not b], axis=0) for b in corners]
    longest: Floats = np.maximum.reduce(products)
    return longest

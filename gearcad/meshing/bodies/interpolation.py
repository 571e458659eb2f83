"""Shape functions of all kinds of elements and of their faces: the polynomials that are 1 at a node and 0 at the others."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.meshing.bodies.elements import Element

__all__ = ["local_places", "shape_slopes", "shape_values"]


_QUAD = ((-1, -1), (1, -1), (1, 1), (-1, 1))
_TRI = ((0, 0), (1, 0), (0, 1))

_VERTICES: dict[str, tuple[tuple[int, ...], ...]] = {
    "line3": ((-1,), (1,)),
    "tri6": _TRI,
    "quad4": _QUAD,
    "quad8": _QUAD,
    "hex8": (*((*place, -1) for place in _QUAD), *((*place, 1) for place in _QUAD)),
    "tet10": ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)),
}
_VERTICES["hex20"] = _VERTICES["hex8"]

_FACE_EDGES = {"line3": ((0, 1),), "quad4": ()}
"""Pairs of vertices with a node between them, of faces that are no elements of their own."""

_LINEAR = ("quad4", "hex8")
_SIMPLICES = ("tri6", "tet10")


@cache
def local_places(kind: str) -> Floats:
    """Places (n, dimension) of the nodes of an element or a face in its own coordinates: -1 to 1, or 0 to 1 in simplices."""
    vertices = np.array(_VERTICES[kind], float)
    shape = Element(kind).shape if kind not in _FACE_EDGES else None
    pairs = _FACE_EDGES[kind] if shape is None else shape.edges[: shape.nodes - shape.vertices]
    middles = vertices[np.array(pairs, int).reshape(-1, 2)].mean(axis=1)
    return np.concatenate([vertices, middles])


@cache
def _powers(kind: str) -> Wholes:
    """Exponents (n, dimension) of the monomials: up to second order in simplices, else with one square at the most."""
    every = np.array(list(product(range(3), repeat=len(_VERTICES[kind][0]))))
    if kind in _SIMPLICES:
        chosen = every.sum(axis=1) <= 2
    else:
        chosen = (every == 2).sum(axis=1) <= (0 if kind in _LINEAR else 1)
    result: Wholes = every[chosen]
    return result


@cache
def _coefficients(kind: str) -> Floats:
    """Of the monomials (n,) in the shape functions (n,)."""
    result: Floats = np.linalg.inv(np.prod(local_places(kind)[:, None] ** _powers(kind), axis=-1))
    return result


def shape_values(kind: str, places: Floats) -> Floats:
    """Values (p, n) at local places (p, dimension) of the shape functions of an element or a face ("quad8")."""
    monomials = np.prod(places[:, None] ** _powers(kind), axis=-1)
    result: Floats = monomials @ _coefficients(kind)
    return result


def shape_slopes(kind: str, places: Floats) -> Floats:
    """Their derivatives (p, dimension, n) along the local coordinates."""
    powers = _powers(kind)
    found = []
    for axis in range(powers.shape[1]):
        lower = np.maximum(powers - np.eye(powers.shape[1], dtype=int)[axis], 0)
        found.append(np.prod(places[:, None] ** lower, axis=-1) * powers[:, axis] @ _coefficients(kind))
    return np.stack(found, 1)

"""What gmsh calls elements, how it orders their nodes, and which part a node is of."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gearcad.arrays import Bools, Indices
from gearcad.meshing.bodies import Element, ElementMesh

__all__ = ["KINDS", "ORDERS", "nodes_of_parts"]

KINDS = {"tri6": 9, "quad8": 16, "hex8": 5, "hex20": 17, "tet10": 11, "line3": 8, "quad4": 3}
"""Numbers of elements and faces. Faces have gmsh's order of nodes already."""

ORDERS: dict[Element, list[int] | slice] = dict.fromkeys(Element, slice(None)) | {
    Element.HEX20: [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
    Element.TET10: [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
}
"""Our nodes in gmsh's order (gmsh reference manual, "Node ordering")."""


def nodes_of_parts(mesh: ElementMesh) -> Iterator[Indices]:
    """Of each part the nodes, in order, that no part before it has."""
    waiting: Bools = np.ones(len(mesh.points), bool)
    for part in mesh.parts.values():
        own = np.zeros_like(waiting)
        own[mesh.cells[part]] = True
        nodes = np.flatnonzero(own & waiting)
        waiting[nodes] = False
        yield nodes

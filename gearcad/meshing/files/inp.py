"""Decks of Abaqus and CalculiX: nodes, elements, node sets and surfaces; numbers count from 1.

What writes them takes an open text file, so that a deck has them where it wants them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.files.digits import Letters, chunks, decimals, decimals_width, lines, wholes

__all__ = ["element_type", "node_sets", "write_elements", "write_inp", "write_node_set", "write_nodes", "write_surface"]

_ENTRIES = 16
"""Most numbers of a line."""

_SOLIDS = {Element.HEX8: "C3D8", Element.HEX20: "C3D20", Element.TET10: "C3D10"}


def element_type(element: Element, *, plane_strain: bool = True) -> str:
    """The element's name; of sections: in plane strain, or else in plane stress."""
    return _SOLIDS.get(element) or f"{'CPE' if plane_strain else 'CPS'}{element.shape.nodes}"


def write_inp(mesh: ElementMesh, path: Path, *, plane_strain: bool = True) -> None:
    """A mesh that a deck includes: its parts as element sets, its sides as node sets and as surfaces of the same name."""
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write("*HEADING\ngearcad, mm\n")
        write_nodes(file, mesh.points)
        write_elements(file, mesh, element_type(mesh.element, plane_strain=plane_strain))
        for name, nodes in node_sets(mesh).items():
            write_node_set(file, name, nodes)
        for name, faces in mesh.sides.items():
            write_surface(file, name, faces)


def write_nodes(file: TextIO, points: Floats, name: str = "nodes") -> None:
    """All nodes, in a node set. Raises ParameterError for points a kilometre away."""
    file.write(f"*NODE, NSET={name}\n")
    width, digits = decimals_width(float(np.abs(points).max())), _digits(len(points))
    for rows in chunks(len(points)):
        numbers = np.arange(rows.start + 1, rows.stop + 1)
        file.write(lines(wholes(numbers, digits), _listed(decimals(points[rows], width))))


def write_elements(file: TextIO, mesh: ElementMesh, kind: str) -> None:
    """All elements, as what CalculiX calls `kind` ("C3D20"), each part in the element set of its name."""
    digits = _digits(max(len(mesh.points), len(mesh.cells)))
    for name, part in mesh.parts.items():
        file.write(f"*ELEMENT, TYPE={kind}, ELSET={name}\n")
        for rows in chunks(part.stop, part.start):
            numbers = wholes(np.arange(rows.start + 1, rows.stop + 1), digits)
            nodes = _listed(wholes(mesh.cells[rows] + 1, digits))
            first, more = nodes[:, : _ENTRIES - 1], nodes[:, _ENTRIES - 1 :]
            # The comma before a number ends the line before it.
            text = (numbers, first, b",\n", more.reshape(len(more), -1)[:, 1:]) if more.size else (numbers, first)
            file.write(lines(*text))


def node_sets(mesh: ElementMesh) -> Mapping[str, NDArray[np.integer]]:
    """Nodes of all sides, by name; of matched cuts in such an order that the k-th of one meets the k-th of the other."""
    ascending = {cut: pairs[np.argsort(pairs[:, 0])] for cut, pairs in mesh.matched.items()}  # of quadrangles both are, then
    matched = {f"{cut}_{end}": pairs[:, k] for cut, pairs in ascending.items() for k, end in enumerate(("behind", "ahead"))}
    return {name: mesh.nodes(name) for name in mesh.sides} | matched


def write_node_set(file: TextIO, name: str, nodes: NDArray[np.integer]) -> None:
    """A node set; where its nodes (from 0) do not ascend their order matters, and is to be kept."""
    ascending = bool(np.all(np.diff(nodes) > 0))
    if not ascending:
        file.write(
            "** The order matters. Abaqus keeps it where UNSORTED says so; CalculiX always does, and warns of this word.\n"
        )
    file.write(f"*NSET, NSET={name}{'' if ascending else ', UNSORTED'}\n")
    digits, full = _digits(int(nodes.max()) + 1), len(nodes) // _ENTRIES * _ENTRIES
    for row in (nodes[:full].reshape(-1, _ENTRIES), nodes[full:].reshape(1, -1)):
        if row.size:
            file.write(lines(_listed(wholes(row + 1, digits)).reshape(len(row), -1)[:, 1:]))


def write_surface(file: TextIO, name: str, faces: Faces) -> None:
    """A surface of sides of elements."""
    file.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\n")
    numbers = faces.elements + 1
    file.write(lines(wholes(numbers, _digits(int(numbers.max()))), b", S", wholes(faces.sides[:, None] + 1, 1)))


def _listed(columns: Letters) -> Letters:
    """Columns (n, k, width) with a comma before each."""
    return np.concatenate([np.full((*columns.shape[:2], 1), ord(","), np.uint8), columns], axis=2)


def _digits(most: int) -> int:
    return len(str(most))

"""Bulk data of Nastran: nodes, elements and sets of nodes; numbers count from 1."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from gearcad.errors import ParameterError
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.files.digits import Letters, chunks, decimals, decimals_width, lines, wholes

__all__ = ["write_bdf"]

_CARDS = {
    Element.TRI6: "CTRIA6",
    Element.QUAD8: "CQUAD8",
    Element.HEX8: "CHEXA",
    Element.HEX20: "CHEXA",
    Element.TET10: "CTETRA",
}

_ORDERS = {Element.HEX20: [*range(12), *range(16, 20), *range(12, 16)]}
"""Our nodes in Nastran's order: between bottom and top come the edges from one to the other."""

_FIELDS, _FIELD, _LONG_FIELD = 8, 8, 16
"""Fields of a line between its name and its end; characters of each, and of each of the four in a line of long fields."""

_MOST_NODES = 10**_FIELD - 1


def write_bdf(mesh: ElementMesh, path: Path) -> None:
    """Each part has a property number, from 1, each side is a SET1 of its nodes; comments tell their names.

    Coordinates have 16 characters: 1e-11 mm below a metre. Raises ParameterError for more than 99,999,999 nodes or elements.
    """
    most = max(len(mesh.points), len(mesh.cells))
    if most > _MOST_NODES:
        raise ParameterError("mesh", most, f"must have at most {_MOST_NODES} nodes and elements in .bdf")
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write("$ gearcad, mm\n")
        file.writelines(f"$ property {number}: {name}\n" for number, name in enumerate(mesh.parts, 1))
        file.write("SOL 101\nCEND\nBEGIN BULK\n")  # many readers want a whole deck
        _write_nodes(file, mesh)
        _write_elements(file, mesh)
        for number, name in enumerate(mesh.sides, 1):
            file.write(f"$ set {number}: {name}\n")
            _write_set(file, number, mesh.nodes(name))
        file.write("ENDDATA\n")


def _write_nodes(file: TextIO, mesh: ElementMesh) -> None:
    width = decimals_width(float(np.abs(mesh.points).max()))
    for rows in chunks(len(mesh.points)):
        numbers = wholes(np.arange(rows.start + 1, rows.stop + 1), _LONG_FIELD)
        # Decimals that do not fit are cut off; what is shorter stands at the end of its field.
        places = decimals(mesh.points[rows], width)[..., :_LONG_FIELD]
        places = np.pad(places, ((0, 0), (0, 0), (_LONG_FIELD - places.shape[2], 0)), constant_values=ord(" "))
        file.write(lines(b"GRID*   ", numbers, b" " * _LONG_FIELD, places[:, :2], b"*\n*       ", places[:, 2]))


def _write_elements(file: TextIO, mesh: ElementMesh) -> None:
    order, name = _ORDERS.get(mesh.element, slice(None)), _CARDS[mesh.element].ljust(_FIELD).encode()
    for number, part in enumerate(mesh.parts.values(), 1):
        for rows in chunks(part.stop, part.start):
            numbers = wholes(np.arange(rows.start + 1, rows.stop + 1), _FIELD)
            nodes = wholes(mesh.cells[rows][:, order] + 1, _FIELD)
            file.write(lines(name, numbers, f"{number:{_FIELD}}".encode(), *_continued(nodes, _FIELDS - 2)))


def _write_set(file: TextIO, number: int, nodes: NDArray[np.integer]) -> None:
    file.write(lines(f"SET1    {number:{_FIELD}}".encode(), *_continued(wholes(nodes[None] + 1, _FIELD), _FIELDS - 1)))


def _continued(fields: Letters, first: int) -> list[bytes | Letters]:
    """Fields (n, k, 8) over several lines: so many on the first, eight on each other."""
    starts = [0, *range(first, fields.shape[1], _FIELDS), fields.shape[1]]
    pieces: list[bytes | Letters] = [fields[:, : starts[1]]]
    for start, stop in pairwise(starts[1:]):
        pieces += [b"+\n+       ", fields[:, start:stop]]
    return pieces

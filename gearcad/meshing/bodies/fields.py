"""Named sides as numbers of nodes: what viewers colour by, and select by."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from gearcad.meshing.bodies.mesh import ElementMesh

__all__ = ["NOWHERE", "part_numbers", "side_fields"]

NOWHERE = -1
"""Of nodes that are on no tooth's side of that kind."""

_TOOTH = re.compile(r"(.+)_(\d+)")


def side_fields(mesh: ElementMesh) -> Iterator[tuple[str, NDArray[np.int16] | NDArray[np.uint8]]]:
    """A field of the nodes for each kind of side, one at a time.

    "left_flank" holds the tooth's number on the nodes of all left flanks, and -1 elsewhere; what is there once, as "bore",
    is 1 on its nodes and 0 elsewhere.
    """
    kinds = [
        (match[1], int(match[2]), name) if (match := _TOOTH.fullmatch(name)) else (name, None, name) for name in mesh.sides
    ]
    for kind, sides in groupby(sorted(kinds, key=lambda each: each[0]), key=lambda each: each[0]):
        field: NDArray[np.int16] | NDArray[np.uint8] | None = None
        for _, tooth, name in sides:
            if field is None:
                field = np.zeros(len(mesh.points), np.uint8) if tooth is None else np.full(len(mesh.points), NOWHERE, np.int16)
            field[mesh.face_cells(name)] = 1 if tooth is None else tooth
        assert field is not None
        yield kind, field


def part_numbers(mesh: ElementMesh) -> NDArray[np.uint8]:
    """Of each element: which of the parts it belongs to, from 1."""
    numbers = np.empty(len(mesh.cells), np.uint8)
    for number, part in enumerate(mesh.parts.values(), 1):
        numbers[part] = number
    return numbers

"""Binary .msh, version 4.1 of gmsh's format (gmsh reference manual, "MSH file format"), in chunks.

gmsh itself would write the same, but holds eight times the memory of the mesh meanwhile.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.mesh import Cells
from gearcad.meshing.files.digits import chunks
from gearcad.meshing.files.gmsh_kinds import KINDS, ORDERS, nodes_of_parts

__all__ = ["write_msh"]

_DIMENSIONS = 4
"""Of entities: points, curves, surfaces and volumes."""


def write_msh(mesh: ElementMesh, path: Path) -> None:
    """Parts are physical groups of elements, sides of their own elements after those; groups count from 1, the parts first."""
    with path.open("wb") as file:
        file.write(b"$MeshFormat\n4.1 1 8\n" + _whole(1) + b"\n$EndMeshFormat\n")
        _write_names(file, mesh)
        _write_entities(file, mesh)
        _write_nodes(file, mesh)
        _write_elements(file, mesh)


def _whole(*numbers: int) -> bytes:
    return np.array(numbers, "<i4").tobytes()


def _count(*numbers: int) -> bytes:
    return np.array(numbers, "<i8").tobytes()


def _groups(mesh: ElementMesh) -> dict[str, tuple[int, int]]:
    """Dimension and number of each group by its name; each has one entity, of the same number."""
    dimension = mesh.element.shape.dimension
    parts = {name: (dimension, number) for number, name in enumerate(mesh.parts, 1)}
    return parts | {name: (dimension - 1, number) for number, name in enumerate(mesh.sides, 1 + len(parts))}


def _write_names(file: BinaryIO, mesh: ElementMesh) -> None:
    groups = _groups(mesh)
    lines = "".join(f'{dimension} {number} "{name}"\n' for name, (dimension, number) in groups.items())
    file.write(f"$PhysicalNames\n{len(groups)}\n{lines}$EndPhysicalNames\n".encode())


def _write_entities(file: BinaryIO, mesh: ElementMesh) -> None:
    """Entities, those of least dimension first, with their boxes and groups; nothing is said of what bounds them."""
    groups = sorted(_groups(mesh).items(), key=lambda item: item[1])
    counts = [sum(dimension == each for _, (each, _) in groups) for dimension in range(_DIMENSIONS)]
    file.write(b"$Entities\n" + _count(*counts))
    for name, (_, number) in groups:
        cells = mesh.cells[mesh.parts[name]] if name in mesh.parts else mesh.face_cells(name)
        file.write(_whole(number) + _box(mesh.points, cells).tobytes() + _count(1) + _whole(number) + _count(0))
    file.write(b"\n$EndEntities\n")


def _box(points: Floats, cells: Cells) -> NDArray[Any]:
    """Least and greatest coordinates (2, 3) of the nodes of elements."""
    used = np.zeros(len(points), bool)
    used[cells] = True
    return np.stack([points[used].min(axis=0), points[used].max(axis=0)]).astype("<f8")


def _write_nodes(file: BinaryIO, mesh: ElementMesh) -> None:
    file.write(b"$Nodes\n" + _count(len(mesh.parts), len(mesh.points), 1, len(mesh.points)))
    for number, nodes in enumerate(nodes_of_parts(mesh), 1):
        file.write(_whole(mesh.element.shape.dimension, number, 0) + _count(len(nodes)) + (nodes + 1).astype("<i8").tobytes())
        for rows in chunks(len(nodes)):
            file.write(mesh.points[nodes[rows]].astype("<f8", copy=False).tobytes())
    file.write(b"\n$EndNodes\n")


def _write_elements(file: BinaryIO, mesh: ElementMesh) -> None:
    shape, groups = mesh.element.shape, _groups(mesh)
    every = len(mesh.cells) + sum(map(len, mesh.sides.values()))
    file.write(b"$Elements\n" + _count(len(groups), every, 1, every))
    order, before = ORDERS[mesh.element], 0
    for name, (dimension, number) in groups.items():
        is_part = name in mesh.parts
        cells = mesh.cells[mesh.parts[name]] if is_part else mesh.face_cells(name)
        kind = KINDS[mesh.element.value if is_part else shape.face]
        file.write(_whole(dimension, number, kind) + _count(len(cells)))
        for rows in chunks(len(cells)):
            table = np.empty((rows.stop - rows.start, 1 + cells.shape[1]), "<i8")
            table[:, 0] = np.arange(before + rows.start + 1, before + rows.stop + 1)
            table[:, 1:] = cells[rows][:, order if is_part else slice(None)] + 1
            file.write(table.tobytes())
        before += len(cells)
    file.write(b"\n$EndElements\n")

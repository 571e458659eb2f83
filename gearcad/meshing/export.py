"""Meshes for other programs: one sector, or all teeth of a gear, as VTU, Abaqus/CalculiX or gmsh files (meshio)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import ParameterError
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.sector import SectorMesh

__all__ = ["MESH_SUFFIXES", "BodyMesh", "ring_mesh", "sector_mesh", "write_mesh"]


MESH_SUFFIXES = (".vtu", ".inp", ".msh")

_NUMBER = ".12e"
"""Of .inp: CalculiX reads 20 characters of a number."""

_ELEMENTS = {True: "CPE6", False: "CPS6"}
"""Abaqus and CalculiX: quadratic triangles in plane strain, or else in plane stress."""


@dataclass(frozen=True)
class BodyMesh:
    """Quadratic triangles (m, 6) with nodes at `points` (n, 2) in mm.

    Node sets: "hub", and "flank", the loaded one of tooth 0.
    """

    points: Floats
    triangles: Wholes
    sets: Mapping[str, Wholes]


def sector_mesh(sector: SectorMesh) -> BodyMesh:
    """The sector of tooth 0 alone."""
    return ring_mesh(sector, 1)


def ring_mesh(sector: SectorMesh, teeth: int) -> BodyMesh:
    """A full ring of `teeth` sectors turned into place, their common cuts merged; 1 leaves the one sector open."""
    count = len(sector.points)
    if teeth == 1:
        number = np.arange(count)[None]
    else:
        own = np.setdiff1d(np.arange(count), sector.behind)
        number = np.empty((teeth, count), int)
        number[:, own] = np.arange(teeth * len(own)).reshape(teeth, -1)
        number[:, sector.behind] = np.roll(number[:, sector.ahead], 1, axis=0)
    points = np.empty((int(number.max()) + 1, 2))
    turns = 2 * np.pi * np.arange(len(number)) / teeth
    for row, turn in zip(number, turns, strict=True):
        cosine, sine = np.cos(turn), np.sin(turn)
        points[row] = sector.points @ np.array([[cosine, sine], [-sine, cosine]])
    sets = {"hub": np.unique(number[:, sector.sides[Side.INNER]]), "flank": number[0, sector.sides[Side.LEFT_FLANK]]}
    return BodyMesh(points, number[:, sector.triangles].reshape(-1, 6), sets)


def write_mesh(mesh: BodyMesh, path: Path | str, *, plane_strain: bool = True) -> None:
    """Write VTU, .inp or .msh, by the suffix of `path`. Raises ParameterError for another one.

    The node sets are sets in .inp, whose elements are CPE6 or CPS6 in the element set "body"; elsewhere they are fields that
    are 1 on their nodes.
    """
    import meshio

    path = Path(path)
    if path.suffix not in MESH_SUFFIXES:
        raise ParameterError("suffix", path.suffix, f"must be one of {', '.join(MESH_SUFFIXES)}")
    cells, solid = [("triangle6", mesh.triangles)], np.c_[mesh.points, np.zeros(len(mesh.points))]
    if path.suffix == ".inp":
        everything = {"body": [np.arange(len(mesh.triangles))]}
        deck = meshio.Mesh(solid, cells, point_sets=dict(mesh.sets), cell_sets=everything)
        deck.write(path, float_fmt=_NUMBER)
        # meshio knows one name only for these triangles.
        path.write_text(path.read_text("ascii").replace("TYPE=CPE6", f"TYPE={_ELEMENTS[plane_strain]}"), "ascii")
        return
    fields = {name: np.isin(np.arange(len(solid)), nodes).astype(float) for name, nodes in mesh.sets.items()}
    # .msh is ANSYS's suffix too.
    meshio.Mesh(solid, cells, point_data=fields).write(path, file_format="gmsh" if path.suffix == ".msh" else "vtu")

"""The formats of meshes: what each holds, and what writes it - an entry here, and a file of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from importlib.util import find_spec
from pathlib import Path

from gearcad.errors import ParameterError, as_choice
from gearcad.meshing.bodies import ElementMesh

__all__ = ["SUFFIXES", "MeshFormat", "write"]


class MeshFormat(Enum):
    """What an ElementMesh can be written as; the value is the suffix of the file."""

    MSH = "msh"
    VTU = "vtu"
    INP = "inp"
    BDF = "bdf"
    MED = "med"
    UNV = "unv"
    XDMF = "xdmf"

    @property
    def entry(self) -> Entry:
        """What there is to know of it."""
        return _ENTRIES[self]

    def require(self) -> None:
        """Raise ParameterError where a library that it needs is missing."""
        library = self.entry.library
        if library and find_spec(library) is None:
            raise ParameterError("format", self.value, f'needs {library}: pip install "gearcad[mesh]"')


@dataclass(frozen=True)
class Entry:
    """One format: what it holds, in words; what writes it, and how names of other files end that it writes beside; which
    library it needs that gearcad does without.
    """

    words: str
    write: Callable[[ElementMesh, Path], None]
    beside: tuple[str, ...] = ()
    library: str = ""


def write(mesh: ElementMesh, path: Path | str) -> None:
    """Write a mesh in the format of the path's suffix. Raises ParameterError for another one, or where a library is missing."""
    path = Path(path)
    kind = as_choice("format", path.suffix.removeprefix("."), MeshFormat)
    kind.require()
    kind.entry.write(mesh, path)


def _msh(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files.msh import write_msh

    write_msh(mesh, path)


def _with_gmsh(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files.gmsh_files import write_with_gmsh

    write_with_gmsh(mesh, path)


def _vtu(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files.vtu import write_vtu

    write_vtu(mesh, path)


def _inp(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files.inp import write_inp

    write_inp(mesh, path)


def _bdf(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files.bdf import write_bdf

    write_bdf(mesh, path)


def _xdmf(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files.xdmf import write_xdmf

    write_xdmf(mesh, path)


_ENTRIES = {
    MeshFormat.MSH: Entry("gmsh, FEniCS; parts and sides are physical groups", _msh),
    MeshFormat.VTU: Entry("ParaView, PyVista; sides are fields of the nodes", _vtu),
    MeshFormat.INP: Entry("CalculiX, Abaqus; element sets, node sets and surfaces", _inp),
    MeshFormat.BDF: Entry("Nastran; properties, and sets of nodes", _bdf),
    MeshFormat.MED: Entry("Code_Aster, Salome; groups of elements and of sides", _with_gmsh),
    MeshFormat.UNV: Entry("Salome, FreeCAD and others; groups of elements, sides and nodes", _with_gmsh),
    MeshFormat.XDMF: Entry(
        "FEniCS, ParaView; sides in a file of their own", _xdmf, beside=(".h5", "_sides.xdmf"), library="h5py"
    ),
}

SUFFIXES = frozenset(name.rpartition(".")[2] for kind in MeshFormat for name in (kind.value, *kind.entry.beside))
"""Of all files that formats write."""

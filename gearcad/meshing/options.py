"""MeshOptions: the [mesh] table of a spec, and the formats of mesh files."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, NamedTuple, TypeVar

from gearcad.core.errors import ParameterError, as_choice, require_name
from gearcad.core.quantities import LENGTH, Choice, Range, Whole, Words, require_fields
from gearcad.core.records import concise
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.fem import Element


class MeshFormat(Enum):
    """Format of a file of an ElementMesh; the value is the suffix of the file."""

    MSH = "msh"
    VTU = "vtu"
    INP = "inp"
    BDF = "bdf"
    MED = "med"
    UNV = "unv"
    XDMF = "xdmf"

    @property
    def entry(self) -> MeshFileFormat:
        """Entry of this format: words, writer, names of other files and required library."""
        return _ENTRIES[self]

    def require(self) -> None:
        """Raise ParameterError where a library that it needs is missing."""
        library = self.entry.library
        if library and find_spec(library) is None:
            raise ParameterError("format", self.value, f'needs {library}: pip install "gearcad[mesh]"')


@dataclass(frozen=True)
class MeshFileFormat:
    """One format of mesh files: contents in words, writer, endings of further files, and required library.

    `beside` has the endings of names of files that are written beside; `library` is one that gearcad does without.
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
    from gearcad.meshing.files import write_msh

    write_msh(mesh, path)


def _with_gmsh(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files import write_with_gmsh

    write_with_gmsh(mesh, path)


def _vtu(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.bodies.element_mesh import vtk_grid
    from gearcad.meshing.files import write_vtu

    write_vtu(vtk_grid(mesh), path)


def _inp(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files import write_inp

    write_inp(mesh, path)


def _bdf(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files import write_bdf

    write_bdf(mesh, path)


def _xdmf(mesh: ElementMesh, path: Path) -> None:
    from gearcad.meshing.files import write_xdmf

    write_xdmf(mesh, path)


_ENTRIES = {
    MeshFormat.MSH: MeshFileFormat("gmsh, FEniCS; parts and sides are physical groups", _msh),
    MeshFormat.VTU: MeshFileFormat("ParaView, PyVista; sides are fields of the nodes", _vtu),
    MeshFormat.INP: MeshFileFormat("CalculiX, Abaqus; element sets, node sets and surfaces", _inp),
    MeshFormat.BDF: MeshFileFormat("Nastran; properties, and sets of nodes", _bdf),
    MeshFormat.MED: MeshFileFormat("Code_Aster, Salome; groups of elements and of sides", _with_gmsh),
    MeshFormat.UNV: MeshFileFormat("Salome, FreeCAD and others; groups of elements, sides and nodes", _with_gmsh),
    MeshFormat.XDMF: MeshFileFormat(
        "FEniCS, ParaView; sides in a file of their own", _xdmf, beside=(".h5", "_sides.xdmf"), library="h5py"
    ),
}

SUFFIXES = frozenset(name.rpartition(".")[2] for kind in MeshFormat for name in (kind.value, *kind.entry.beside))
"""Suffixes of all files that formats write."""


AUTO = "auto"

_BOTH = "both"

Member = TypeVar("Member", bound=Enum)


class What(Enum):
    """Part of the gears that is meshed."""

    SECTOR = "sector"
    """One tooth with its share of the body."""

    TEETH = "teeth"
    """Neighbouring teeth with the rim below them."""

    RING = "ring"
    """All teeth, down to the bore."""

    PAIR = "pair"
    """Pinion and wheel in mesh."""

    PART = "part"
    """The whole part with its bore, keyway, hub and chamfers."""


class DeckKind(Enum):
    """Decks: input of CalculiX that runs as it is."""

    PAIR = "pair"
    """Both gears in mesh, pressed together by the torque."""

    TOOTH = "tooth"
    """Each gear under the contact loads that our own check finds."""

    SHAFTS = "shafts"
    """Both gears in mesh as whole rings on their shafts: beams and bearings as springs. Solid bodies only."""


class Extent(NamedTuple):
    """Extent of a mesh: `teeth` of each gear, None for all of them."""

    what: What
    teeth: int | None = None


_EXTENT = re.compile(r"(sector|ring|part|pair)|(teeth|pair):([0-9]{1,4})")

_EXTENTS = 'must be "sector", "teeth:5" (any odd number), "ring", "pair", "pair:5" or "part"'


@dataclass(frozen=True, kw_only=True)
class MeshOptions:
    """Options of a mesh. Raises ParameterError.

    `what` is "sector" (one tooth with its share of the body), "teeth:5" (any odd number of them), "ring" (all teeth, down to
    the bore), "pair" (both rings in mesh), "pair:5" (so many teeth of each in mesh) or "part" (the whole part, of tetrahedra);
    "auto" is the ring of a single gear, and of two the pair: where it is 3d with the teeth that carry and one beside them on
    each side. `model` is "2d" (a transverse section) or "3d" (a body); "auto" is that of the element, else 3d where teeth are
    helical. `element` is "quad8" or "tri6" of sections, "hex20" or "hex8" of bodies, "tet10" of parts; "auto" is the first of
    them, and of sections in mesh "tri6". `gear` is one of a pair, or "both".

    `size` (mm) is the edge of elements on the flanks and all others follow it, or there are so many `elements` in each file
    (both None: as root stress asks for); about `fillet_elements` of them over 30 degrees of a fillet (None: 4, of tetrahedra
    1). `refined_teeth`, numbers with commas between them, have finer tetrahedra. `roll` (deg, of the pinion) is where a pair
    stands in mesh, 0 at the pitch point. `format` names the formats of the files, with commas between them. `deck` names what
    is added as input of CalculiX, "pair" (it under its load), "tooth" (each gear under the contact loads of our own check) and
    "shafts" (the pair as whole rings on its shafts), at `positions` evenly over one base pitch around `roll`.
    """

    what: Annotated[str, Words("what is meshed: sector, teeth:N, ring, pair, pair:N or part")] = AUTO
    model: Annotated[str, Choice(("2d", "3d", AUTO)), Words("section (2d) or body (3d)")] = AUTO
    element: Annotated[str, Choice((*(each.value for each in Element), AUTO)), Words("kind of element")] = AUTO
    gear: Annotated[str, Choice(("pinion", "wheel", _BOTH)), Words("which gear of a pair is meshed")] = _BOTH
    size: Annotated[float | None, LENGTH, Words("edge of an element on the flanks")] = None
    elements: Annotated[int | None, Whole(10, 100_000_000), Words("elements in each file")] = None
    fillet_elements: Annotated[int | None, Whole(1, 100), Words("elements over 30° of a fillet, about")] = None
    refined_teeth: Annotated[str, Words("teeth with finer tetrahedra, by their numbers")] = ""
    format: Annotated[str, Words("formats of the files, with commas between them")] = "vtu,msh"
    deck: Annotated[str, Words("decks that CalculiX runs: pair, tooth, shafts, with commas between them")] = ""
    positions: Annotated[int, Whole(1, 200), Words("decks over one base pitch")] = 1
    roll: Annotated[float, Range("deg", 0.0, 360.0, signed=True), Words("roll angle of the pinion in mesh")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        _ = self.extent, self.formats, self.refined, self.decks
        if self.size is not None and self.elements is not None:
            raise ParameterError("elements", self.elements, "must not be given beside size: one follows from the other")
        if self.positions > 1 and not self.decks:
            raise ParameterError("positions", self.positions, "must be 1 where no deck is wanted: a mesh stands at one of them")

    @property
    def decks(self) -> tuple[DeckKind, ...]:
        """The decks that are wanted, each once. Raises ParameterError."""
        return _members("deck", self.deck, DeckKind)

    @property
    def refined(self) -> tuple[int, ...]:
        """Numbers of the teeth that have finer tetrahedra. Raises ParameterError."""
        try:
            return tuple(int(number) for number in self.refined_teeth.replace(",", " ").split())
        except (AttributeError, TypeError, ValueError):
            permitted = 'must be whole numbers with commas between them, such as "0, 1"'
            raise ParameterError("refined_teeth", self.refined_teeth, permitted) from None

    @property
    def formats(self) -> tuple[MeshFormat, ...]:
        """The formats of the files, each once. Raises ParameterError."""
        require_name("format", self.format)
        return _members("format", self.format, MeshFormat)

    @property
    def extent(self) -> Extent | None:
        """Extent of the gears to be meshed; None for the extent that suits the design. Raises ParameterError."""
        if not isinstance(self.what, str):
            raise ParameterError("what", self.what, _EXTENTS)
        if self.what == AUTO:
            return None
        match = _EXTENT.fullmatch(self.what)
        if match is None:
            raise ParameterError("what", self.what, _EXTENTS)
        plain, counted, count = match.groups()
        if plain:
            return Extent(What(plain), 1 if plain == What.SECTOR.value else None)
        if int(count) % 2 == 0:
            raise ParameterError("what", self.what, "must be of an odd number of teeth: tooth 0 stands in the middle")
        return Extent(What(counted), int(count))


def _members(parameter: str, text: str, kind: type[Member]) -> tuple[Member, ...]:
    """Return the members of an enum by a text of their values with commas between them, each once. Raises ParameterError."""
    if not isinstance(text, str):
        raise ParameterError(parameter, text, "must be a text, words with commas between them")
    names = text.replace(",", " ").lower().split()
    return tuple(dict.fromkeys(as_choice(parameter, name, kind) for name in names))

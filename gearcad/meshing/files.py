"""Writers of mesh files: Nastran, Abaqus and CalculiX, gmsh, UNV and MED, VTK, XDMF.

What writes them takes an open text file, so that a deck has them where it wants them.

gmsh itself would write the same, but holds eight times the memory of the mesh meanwhile.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, BinaryIO, TextIO
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import ParameterError, SolverError
from gearcad.core.records import Bools, Floats, Indices
from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.bodies.element_mesh import Cells, part_numbers
from gearcad.meshing.sector import load_gmsh

Letters = NDArray[np.uint8]
"""Characters of ASCII; those of a column are the last axis."""

DECIMALS = 12
"""Digits behind the point: 1e-12 mm is what a float holds of a gear. CalculiX reads 20 characters of a number."""

_CHUNK = 1 << 14
"""Rows at a time: text that fits into the cache is written fastest."""

_MOST_DIGITS = 6
"""Largest number of digits before the decimal point."""

_WITH_ZEROS, _WITH_BLANKS = (np.array([form % k for k in range(10000)], "S4").view(np.uint32) for form in (b"%04d", b"%4d"))
_BLANKS = np.frombuffer(b"    ", np.uint32)[0]


def chunks(stop: int, start: int = 0) -> Iterator[slice]:
    """Yield the rows from `start` to `stop`, as many at a time as are written fastest."""
    return (slice(at, min(at + _CHUNK, stop)) for at in range(start, stop, _CHUNK))


def wholes(numbers: NDArray[np.integer], width: int) -> Letters:
    """Whole numbers (...), not negative, below 2**32 and right-aligned in columns (..., width), which must be wide enough."""
    words = -(-width // 4)
    text = np.empty((*numbers.shape, words), np.uint32)
    rest = numbers.astype(np.uint32)
    for word in reversed(range(words)):
        rest, low = rest // 10000, rest % 10000
        first = rest == 0
        text[..., word] = np.where(first, _WITH_BLANKS[low], _WITH_ZEROS[low])
        if word < words - 1:
            text[..., word][first & (low == 0)] = _BLANKS
    return text.view(np.uint8)[..., 4 * words - width :]


def decimals_width(largest: float) -> int:
    """Return the width of the columns that hold numbers up to this size (mm). Raises ParameterError from a kilometre on."""
    whole = round(largest, DECIMALS)  # as it is written: 9.9999999999999 has two digits before the point
    if not whole < 10**_MOST_DIGITS:
        raise ParameterError("mesh", largest, f"must lie within {10**_MOST_DIGITS} mm of the origin", "mm")
    return len(str(int(whole))) + 2 + DECIMALS


def decimals(numbers: Floats, width: int) -> Letters:
    """Return the numbers (...) with 12 decimals, right-aligned in columns (..., width), whose width is that of
    `decimals_width`.
    """
    scaled = np.rint(numbers * 10.0**DECIMALS)
    rest = np.abs(scaled).astype(np.int64)
    text = np.empty((*numbers.shape, DECIMALS // 4), np.uint32)
    for word in reversed(range(DECIMALS // 4)):
        rest, low = rest // 10000, rest % 10000
        text[..., word] = _WITH_ZEROS[low]
    before = _before_point(width - DECIMALS - 2)
    # A number that rounds to zero has no sign.
    return np.concatenate([before[(scaled < 0).view(np.int8), rest], text.view(np.uint8)], axis=-1)


@cache
def _before_point(digits: int) -> Letters:
    """Return the text (2, n, digits + 2) of whole numbers with their point, without and with a minus sign."""
    texts = [f"{sign}{k}.".rjust(digits + 2) for sign in ("", "-") for k in range(10**digits)]
    return np.frombuffer("".join(texts).encode(), np.uint8).reshape(2, 10**digits, digits + 2)


def lines(*pieces: bytes | Letters) -> str:
    """Return the text of as many lines as the columns among the pieces have rows (n, ...); what is the same in each line is
    bytes.
    """
    columns = [piece if isinstance(piece, bytes) else piece.reshape(len(piece), -1) for piece in (*pieces, b"\n")]
    rows = next(len(column) for column in columns if not isinstance(column, bytes))
    text = np.empty((rows, sum(len(each) if isinstance(each, bytes) else each.shape[1] for each in columns)), np.uint8)
    place = 0
    for column in columns:
        letters = np.frombuffer(column, np.uint8) if isinstance(column, bytes) else column
        text[:, place : place + letters.shape[-1]] = letters
        place += letters.shape[-1]
    return text.tobytes().decode("ascii")


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
        _bdf_write_nodes(file, mesh)
        _bdf_write_elements(file, mesh)
        for number, name in enumerate(mesh.sides, 1):
            file.write(f"$ set {number}: {name}\n")
            _write_set(file, number, mesh.nodes(name))
        file.write("ENDDATA\n")


def _bdf_write_nodes(file: TextIO, mesh: ElementMesh) -> None:
    width = decimals_width(float(np.abs(mesh.points).max()))
    for rows in chunks(len(mesh.points)):
        numbers = wholes(np.arange(rows.start + 1, rows.stop + 1), _LONG_FIELD)
        # Decimals that do not fit are cut off; what is shorter stands at the end of its field.
        places = decimals(mesh.points[rows], width)[..., :_LONG_FIELD]
        places = np.pad(places, ((0, 0), (0, 0), (_LONG_FIELD - places.shape[2], 0)), constant_values=ord(" "))
        file.write(lines(b"GRID*   ", numbers, b" " * _LONG_FIELD, places[:, :2], b"*\n*       ", places[:, 2]))


def _bdf_write_elements(file: TextIO, mesh: ElementMesh) -> None:
    order, name = _ORDERS.get(mesh.element, slice(None)), _CARDS[mesh.element].ljust(_FIELD).encode()
    for number, part in enumerate(mesh.parts.values(), 1):
        for rows in chunks(part.stop, part.start):
            numbers = wholes(np.arange(rows.start + 1, rows.stop + 1), _FIELD)
            nodes = wholes(mesh.cells[rows][:, order] + 1, _FIELD)
            file.write(lines(name, numbers, f"{number:{_FIELD}}".encode(), *_continued(nodes, _FIELDS - 2)))


def _write_set(file: TextIO, number: int, nodes: NDArray[np.integer]) -> None:
    file.write(lines(f"SET1    {number:{_FIELD}}".encode(), *_continued(wholes(nodes[None] + 1, _FIELD), _FIELDS - 1)))


def _continued(fields: Letters, first: int) -> list[bytes | Letters]:
    """Return fields (n, k, 8) over several lines: so many on the first, eight on each further line."""
    starts = [0, *range(first, fields.shape[1], _FIELDS), fields.shape[1]]
    pieces: list[bytes | Letters] = [fields[:, : starts[1]]]
    for start, stop in pairwise(starts[1:]):
        pieces += [b"+\n+       ", fields[:, start:stop]]
    return pieces


KINDS = {"tri6": 9, "quad8": 16, "hex8": 5, "hex20": 17, "tet10": 11, "line3": 8, "quad4": 3}
"""Numbers of elements and faces. Faces have gmsh's order of nodes already."""

ORDERS: dict[Element, list[int] | slice] = dict.fromkeys(Element, slice(None)) | {
    Element.HEX20: [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
    Element.TET10: [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
}
"""Our nodes in gmsh's order (gmsh reference manual, "Node ordering")."""


def nodes_of_parts(mesh: ElementMesh) -> Iterator[Indices]:
    """Yield, for each part, its nodes in order, without those of parts before it."""
    waiting: Bools = np.ones(len(mesh.points), bool)
    for part in mesh.parts.values():
        own = np.zeros_like(waiting)
        own[mesh.cells[part]] = True
        nodes = np.flatnonzero(own & waiting)
        waiting[nodes] = False
        yield nodes


_END_OF_UNV = b"    -1\n"
"""Line that ends each part of a universal file."""


def write_with_gmsh(mesh: ElementMesh, path: Path) -> None:
    """Write the format that the suffix of `path` names. Parts are groups of elements, sides groups of their own elements after
    those.

    Groups count from 1, the parts first. Raises SolverError where gmsh cannot write the file.
    """
    gmsh = load_gmsh()
    with _model(gmsh):
        _add_parts(gmsh.model, mesh)
        _add_sides(gmsh.model, mesh)
        try:
            gmsh.write(str(path))
        except Exception as error:  # gmsh raises nothing finer
            raise SolverError(f"gmsh could not write {path.name}: {error}") from error
    if path.suffix == ".unv" and not _ends_with(path, _END_OF_UNV):  # gmsh does not look at what it writes
        raise SolverError(f"gmsh could not write all of {path.name}: the disk is full, or larger files are not permitted")


def _ends_with(path: Path, end: bytes) -> bool:
    with path.open("rb") as file:
        file.seek(-min(len(end), path.stat().st_size), os.SEEK_END)
        return file.read() == end


@contextmanager
def _model(gmsh: Any) -> Iterator[None]:
    """Yield a gmsh model for our own use that leaves the models of a caller who uses gmsh unchanged."""
    ours = not gmsh.is_initialized()
    if ours:
        gmsh.initialize(interruptible=False)  # the other way works in the main thread only
    terminal = gmsh.option.get_number("General.Terminal")
    try:
        gmsh.option.set_number("General.Terminal", 0)
        gmsh.model.add("gearcad")
        yield
    finally:
        if ours:
            gmsh.finalize()
        else:
            gmsh.model.remove()
            gmsh.option.set_number("General.Terminal", terminal)


def _add_parts(model: Any, mesh: ElementMesh) -> None:
    """The parts as entities with the nodes that no part before them has."""
    dimension = mesh.element.shape.dimension
    parts = zip(mesh.parts.items(), nodes_of_parts(mesh), strict=True)
    for tag, ((name, part), nodes) in enumerate(parts, 1):
        model.add_discrete_entity(dimension, tag)
        model.mesh.add_nodes(dimension, tag, nodes + 1, mesh.points[nodes].ravel())
        _add_elements(model, tag, mesh.element.value, mesh.cells[part][:, ORDERS[mesh.element]], part.start)
        model.add_physical_group(dimension, [tag], tag, name)


def _add_sides(model: Any, mesh: ElementMesh) -> None:
    """The sides as entities, whose nodes are there already."""
    dimension, elements = mesh.element.shape.dimension - 1, len(mesh.cells)
    for tag, name in enumerate(mesh.sides, len(mesh.parts) + 1):
        faces = mesh.face_cells(name)
        model.add_discrete_entity(dimension, tag)
        _add_elements(model, tag, mesh.element.shape.face, faces, elements)
        model.add_physical_group(dimension, [tag], tag, name)
        elements += len(faces)


def _add_elements(model: Any, tag: int, kind: str, cells: Cells, before: int) -> None:
    """Elements of an entity, numbered from the next after `before`."""
    numbers = np.arange(before + 1, before + 1 + len(cells))
    model.mesh.add_elements_by_type(tag, KINDS[kind], numbers, cells.ravel() + np.int64(1))


_ENTRIES = 16
"""Largest number of entries in a line."""

_SOLIDS = {Element.HEX8: "C3D8", Element.HEX20: "C3D20", Element.TET10: "C3D10"}


def element_type(element: Element, *, plane_strain: bool = True) -> str:
    """Return the element's name; of sections: in plane strain, or else in plane stress."""
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
    """Return the nodes of all sides, by name; of matched cuts in such an order that the k-th of one meets the k-th of the
    other.
    """
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
    """Return the columns (n, k, width) with a comma before each."""
    return np.concatenate([np.full((*columns.shape[:2], 1), ord(","), np.uint8), columns], axis=2)


def _digits(most: int) -> int:
    return len(str(most))


_DIMENSIONS = 4
"""Dimensions of entities: points, curves, surfaces and volumes."""


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
    """Return the dimension and number of each group by its name; each has one entity, of the same number."""
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
    """Return the least and greatest coordinates (2, 3) of the nodes of elements."""
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


def write_vtu(grid: Any, path: Path) -> None:
    """Write a vtkUnstructuredGrid, binary and compressed. Raises OSError for a place that cannot be written."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    # Raw data behind the XML would be a quarter less and a third quicker, but meshio confuses the arrays of such files.
    writer.SetDataModeToBinary()
    writer.SetHeaderTypeToUInt64()
    # zlib everyone reads; higher levels take much longer for little.
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(1)
    if not writer.Write():
        raise OSError(f"VTK could not write {path}")


_KINDS = {
    "tri6": "Triangle_6",
    "quad8": "Quadrilateral_8",
    "hex8": "Hexahedron",
    "hex20": "Hexahedron_20",
    "tet10": "Tetrahedron_10",
    "line3": "Edge_3",
    "quad4": "Quadrilateral",
}
"""Names of elements and faces in XDMF; the order of their nodes is ours."""

_PAGE = """<?xml version="1.0"?>
<Xdmf Version="3.0"><Domain><Grid Name="Grid">
<Information Name="{field}" Value="{field}"><![CDATA[<main>{names}</main>]]></Information>
<Geometry GeometryType="XYZ">{points}</Geometry>
<Topology TopologyType="{kind}" NumberOfElements="{count}" NodesPerElement="{nodes}">{cells}</Topology>
<Attribute Name="{field}" AttributeType="Scalar" Center="Cell">{numbers}</Attribute>
</Grid></Domain></Xdmf>
"""

_NAME = '<map key={name} dim="{dimension}">{number}</map>'
"""A number and its name, as meshio has them."""

_ITEM = '<DataItem DataType="{kind}" Precision="{size}" Dimensions="{shape}" Format="HDF">{file}:{place}</DataItem>'


def write_xdmf(mesh: ElementMesh, path: Path) -> None:
    """Elements with their "part" in `path`, the faces of all sides with their "side" in NAME_sides.xdmf, arrays in NAME.h5.

    Both numbers count from 1 and have their names in the file.
    """
    import h5py

    shape = mesh.element.shape
    with h5py.File(path.with_suffix(".h5"), "w") as store:
        points = _stored(store, "points", mesh.points)
        parts = _page(store, points, mesh.element.value, mesh.cells, "part", part_numbers(mesh), mesh.parts, shape.dimension)
        path.write_text(parts, encoding="utf-8", newline="\n")
        if mesh.sides:
            faces = [mesh.face_cells(name) for name in mesh.sides]
            numbers = np.repeat(np.arange(1, len(faces) + 1), [len(each) for each in faces])
            sides = _page(store, points, shape.face, np.concatenate(faces), "side", numbers, mesh.sides, shape.dimension - 1)
            path.with_name(f"{path.stem}_sides{path.suffix}").write_text(sides, encoding="utf-8", newline="\n")


def _page(
    store: Any,
    points: str,
    kind: str,
    cells: Cells,
    field: str,
    numbers: NDArray[np.integer],
    names: Iterable[str],
    dimension: int,
) -> str:
    """Return the text of a file whose elements or faces have numbers, which have names."""
    table = (_NAME.format(number=number, dimension=dimension, name=quoteattr(name)) for number, name in enumerate(names, 1))
    return _PAGE.format(
        field=field,
        names="".join(table),
        points=points,
        kind=_KINDS[kind],
        count=len(cells),
        nodes=cells.shape[1],
        cells=_stored(store, f"{field}_nodes", cells),
        numbers=_stored(store, field, numbers.astype(np.int32)),
    )


def _stored(store: Any, name: str, values: NDArray[Any]) -> str:
    """Put an array into the HDF5 file; the element that refers to it."""
    store.create_dataset(name, data=values, compression="gzip", compression_opts=1, shuffle=True)
    return _ITEM.format(
        kind="Float" if values.dtype.kind == "f" else "Int",
        size=values.itemsize,
        shape=" ".join(map(str, values.shape)),
        file=Path(store.filename).name,
        place=f"/{name}",
    )

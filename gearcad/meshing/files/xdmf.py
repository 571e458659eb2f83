"""XDMF over HDF5, as ParaView and FEniCS read it: elements in one file, the faces of sides in another, one .h5 below both."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.fields import part_numbers
from gearcad.meshing.bodies.mesh import Cells

__all__ = ["write_xdmf"]

_KINDS = {
    "tri6": "Triangle_6",
    "quad8": "Quadrilateral_8",
    "hex8": "Hexahedron",
    "hex20": "Hexahedron_20",
    "tet10": "Tetrahedron_10",
    "line3": "Edge_3",
    "quad4": "Quadrilateral",
}
"""What XDMF calls elements and faces; the order of their nodes is ours."""

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
        path.write_text(parts, "utf-8")
        if mesh.sides:
            faces = [mesh.face_cells(name) for name in mesh.sides]
            numbers = np.repeat(np.arange(1, len(faces) + 1), [len(each) for each in faces])
            sides = _page(store, points, shape.face, np.concatenate(faces), "side", numbers, mesh.sides, shape.dimension - 1)
            path.with_name(f"{path.stem}_sides{path.suffix}").write_text(sides, "utf-8")


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
    """Text of a file whose elements or faces have numbers, which have names."""
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

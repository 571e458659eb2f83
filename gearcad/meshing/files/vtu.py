"""VTU, the unstructured grids of VTK: what ParaView and PyVista open."""

from __future__ import annotations

from pathlib import Path

from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.conversions import vtk_grid

__all__ = ["write_vtu"]


def write_vtu(mesh: ElementMesh, path: Path) -> None:
    """Binary and compressed, with the fields that `vtk_grid` has. Raises OSError for a place that cannot be written."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(vtk_grid(mesh))
    writer.SetFileName(str(path))
    # Raw data behind the XML would be a quarter less and a third quicker, but meshio confuses the arrays of such files.
    writer.SetDataModeToBinary()
    writer.SetHeaderTypeToUInt64()
    # zlib everyone reads; higher levels take much longer for little.
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(1)
    if not writer.Write():
        raise OSError(f"VTK could not write {path}")

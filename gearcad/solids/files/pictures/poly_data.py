"""Facets and lines as VTK has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.solids.facets.tessellation import Facets

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

__all__ = ["line_data", "poly_data"]


def poly_data(facets: Facets) -> vtkPolyData:
    """Triangles."""
    mesh = _points(facets.vertices)
    mesh.SetPolys(_cells(facets.faces))
    return mesh


def line_data(vertices: Floats, ends: Wholes) -> vtkPolyData:
    """Lines between pairs (n, 2) of vertices."""
    mesh = _points(vertices)
    mesh.SetLines(_cells(ends))
    return mesh


def _points(vertices: Floats) -> vtkPolyData:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    mesh, places = vtkPolyData(), vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(vertices), deep=True))
    mesh.SetPoints(places)
    return mesh


def _cells(numbers: Wholes) -> vtkCellArray:
    """Cells of as many points as a row (n, k) has."""
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    cells = vtkCellArray()
    cells.SetData(numbers.shape[1], numpy_to_vtkIdTypeArray(np.ascontiguousarray(numbers, np.int64).ravel(), deep=True))
    return cells

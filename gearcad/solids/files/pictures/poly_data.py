"""Facets and lines as VTK has them, and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.solids.facets.tessellation import Facets

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

__all__ = ["arrays_of", "line_data", "poly_data"]


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


def arrays_of(mesh: vtkPolyData) -> tuple[Floats, Wholes, Wholes]:
    """Points (n, 3), triangles (m, 3) and the numbers (m,) on them."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if not mesh.GetNumberOfCells():
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64), np.zeros(0, np.int64)
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    cells = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).astype(np.int64).reshape(-1, 3)
    return points, cells, vtk_to_numpy(mesh.GetCellData().GetScalars()).astype(np.int64)


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

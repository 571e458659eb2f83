"""Shapes: what is drawn of parts, whole or cut open - surfaces in their colours, and the edges in front of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.colours import Colour
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.cutaway import Cut, CutFace, cut_away
from gearcad.solids.files.pictures.edges import FEATURE_ANGLE, Edges
from gearcad.solids.files.pictures.poly_data import line_data, poly_data

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkPolyData

__all__ = ["Shape", "cut_shape", "whole_shape"]

_CUT, _CUT_SHARE = (0.96, 0.38, 0.28), 0.7
"""Colour of cut faces, and its share in them: the rest is the part's."""


@dataclass(frozen=True, eq=False)
class Shape:
    """Surfaces with normals, each in a colour, the edges of facets, and lines (n, 2, 3) that are drawn always."""

    facets: Facets
    edges: Edges
    surfaces: tuple[tuple[vtkPolyData, Colour], ...]
    outlines: Floats

    def lines(self, towards: Floats) -> vtkPolyData:
        """What is drawn for an eye that way (3,)."""
        vertices, ends = self.facets.vertices, self.edges.drawn(towards)
        own = len(vertices) + np.arange(2 * len(self.outlines)).reshape(-1, 2)
        return line_data(np.concatenate([vertices, self.outlines.reshape(-1, 3)]), np.concatenate([ends, own]))


def whole_shape(part: Part) -> Shape:
    """A part before it is put in its place."""
    return Shape(part.facets, Edges.of(part.facets), ((_smoothed(part.facets), part.colour),), np.zeros((0, 2, 3)))


def cut_shape(part: Part, cut: Cut) -> Shape:
    """A part in its place without what a cut takes off."""
    vertices = part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3]
    left = cut_away(Facets(vertices, part.facets.faces), cut)
    red, green, blue = (float(each) for each in _CUT_SHARE * np.array(_CUT) + (1 - _CUT_SHARE) * np.array(part.colour))
    surfaces = [(_smoothed(left.facets), part.colour), *((_flat(face), (red, green, blue)) for face in left.faces)]
    outlines = np.concatenate([face.outline for face in left.faces])
    return Shape(left.facets, Edges.of(left.facets), tuple(surfaces), outlines)


def _smoothed(facets: Facets) -> vtkPolyData:
    """With normals that are smooth but for sharp edges."""
    from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

    smooth = vtkPolyDataNormals()
    smooth.SetInputData(poly_data(facets))
    smooth.SetFeatureAngle(FEATURE_ANGLE)
    smooth.ConsistencyOff()
    smooth.Update()
    found: vtkPolyData = smooth.GetOutput()
    return found


def _flat(face: CutFace) -> vtkPolyData:
    """With the normal of its plane: slim triangles have none that is exact."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    points = face.triangles.reshape(-1, 3)
    mesh = poly_data(Facets(points, np.arange(len(points)).reshape(-1, 3)))
    mesh.GetPointData().SetNormals(numpy_to_vtk(np.tile(face.normal, (len(points), 1)), deep=True))
    return mesh

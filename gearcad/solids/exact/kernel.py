"""A thin, quick way to make OpenCASCADE topology by hand: shared vertices and edges, no sewing, no booleans."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from copy import copy
from functools import cache
from typing import Any

import numpy as np

from gearcad.arrays import Floats

__all__ = ["ORIGIN", "Edges", "Kernel", "Point", "backward", "bezier_curve", "bezier_curve_2d", "bezier_surface"]


Edges = list[tuple[Any, bool]]
"""Edges of a chain in order, each with True if it is run along its own direction."""

Point = tuple[float, float]

ORIGIN: Point = (0.0, 0.0)

PRECISION = 1e-7
"""OpenCASCADE's own smallest distance (mm)."""


@cache
def _knots(degree: int, first: float, last: float) -> tuple[Any, Any]:
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

    knots, counts = TColStd_Array1OfReal(1, 2), TColStd_Array1OfInteger(1, 2)
    knots.SetValue(1, first)
    knots.SetValue(2, last)
    counts.SetValue(1, degree + 1)
    counts.SetValue(2, degree + 1)
    return knots, counts


def bezier_curve(poles: Floats, first: float = 0.0, last: float = 1.0) -> Any:
    """Geom_BSplineCurve of one span with poles (n + 1, 3), parameter first ... last."""
    from OCP.Geom import Geom_BSplineCurve
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array1OfPnt

    array = TColgp_Array1OfPnt(1, len(poles))
    for i, point in enumerate(poles.tolist(), 1):
        array.SetValue(i, gp_Pnt(*point))
    return Geom_BSplineCurve(array, *_knots(len(poles) - 1, first, last), len(poles) - 1)


def bezier_curve_2d(poles: Floats, first: float = 0.0, last: float = 1.0) -> Any:
    """Geom2d_BSplineCurve of one span with poles (n + 1, 2), parameter first ... last."""
    from OCP.Geom2d import Geom2d_BSplineCurve
    from OCP.gp import gp_Pnt2d
    from OCP.TColgp import TColgp_Array1OfPnt2d

    array = TColgp_Array1OfPnt2d(1, len(poles))
    for i, point in enumerate(poles.tolist(), 1):
        array.SetValue(i, gp_Pnt2d(*point))
    return Geom2d_BSplineCurve(array, *_knots(len(poles) - 1, first, last), len(poles) - 1)


def bezier_surface(poles: Floats, low: float, high: float) -> Any:
    """Geom_BSplineSurface of one span with poles (n + 1, m + 1, 3), parameters u in 0 ... 1 and v in low ... high."""
    from OCP.Geom import Geom_BSplineSurface
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array2OfPnt

    rows, columns = poles.shape[:2]
    array = TColgp_Array2OfPnt(1, rows, 1, columns)
    for i, row in enumerate(poles.tolist(), 1):
        for j, point in enumerate(row, 1):
            array.SetValue(i, j, gp_Pnt(*point))
    along, across = _knots(rows - 1, 0.0, 1.0), _knots(columns - 1, low, high)
    return Geom_BSplineSurface(array, along[0], across[0], along[1], across[1], rows - 1, columns - 1)


def backward(chain: Edges) -> Edges:
    """A chain of edges run the other way."""
    return [(edge, not along) for edge, along in reversed(chain)]


class Kernel:
    """Makes vertices, edges and faces of one solid (lengths in mm).

    Vertices and edges get twice the `tolerance` to which their curves are fitted: a curve and its surface may differ by
    as much from the exact shape, to opposite sides.
    """

    def __init__(self, tolerance: float) -> None:
        from OCP.BRep import BRep_Builder
        from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt
        from OCP.TopLoc import TopLoc_Location
        from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shell, TopoDS_Vertex, TopoDS_Wire

        self.tolerance = max(2 * tolerance, PRECISION)
        self.here = TopLoc_Location()
        self._point, self._vertex, self._edge, self._wire, self._face = (
            gp_Pnt,
            TopoDS_Vertex,
            TopoDS_Edge,
            TopoDS_Wire,
            TopoDS_Face,
        )
        self._builder = BRep_Builder()
        self._shell = TopoDS_Shell()
        self._builder.MakeShell(self._shell)
        self._axis = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))

    def moved(self, z: float, angle: float) -> Kernel:
        """The same kernel, but what is made by it stands higher by `z` (mm) and turned by `angle` (rad) in the same solid."""
        from OCP.gp import gp_Trsf, gp_Vec
        from OCP.TopLoc import TopLoc_Location

        moved, place, rotation = copy(self), gp_Trsf(), gp_Trsf()
        place.SetTranslation(gp_Vec(0, 0, z))
        rotation.SetRotation(self._axis, angle)
        place.Multiply(rotation)
        moved.here = TopLoc_Location(place)
        return moved

    # ------------------------------------------------------------------ geometry about the z axis, or a parallel one

    def turned(self, angle: float) -> Any:
        """The place of a thing turned about z (rad)."""
        from OCP.gp import gp_Trsf
        from OCP.TopLoc import TopLoc_Location

        rotation = gp_Trsf()
        rotation.SetRotation(self._axis, angle)
        return self.here * TopLoc_Location(rotation)

    def frame(self, z: float, *, up: bool = True, axis: Point = ORIGIN) -> Any:
        """Right-handed frame at height z on an axis through the point (x, y), its X along +x and its Z along +z or -z."""
        from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

        return gp_Ax3(gp_Pnt(*axis, z), gp_Dir(0, 0, 1 if up else -1), gp_Dir(1, 0, 0))

    def circle(self, radius: float, z: float, axis: Point = ORIGIN) -> Any:
        from OCP.Geom import Geom_Circle

        return Geom_Circle(self.frame(z, axis=axis).Ax2(), radius)

    def line(self, start: Sequence[float], end: Sequence[float]) -> tuple[Any, float]:
        """Geom_Line through two points, and the parameter (distance) of the second."""
        from OCP.Geom import Geom_Line
        from OCP.gp import gp_Dir, gp_Pnt

        step = np.subtract(end, start)
        length = float(np.linalg.norm(step))
        return Geom_Line(gp_Pnt(*start), gp_Dir(*(step / length))), length

    def cylinder(self, radius: float, axis: Point = ORIGIN) -> Any:
        from OCP.Geom import Geom_CylindricalSurface

        return Geom_CylindricalSurface(self.frame(0.0, axis=axis), radius)

    def cone(self, radius: float, sine: float, z: float, *, up: bool) -> Any:
        """Cone of `radius` at height z that widens upwards (or downwards); `sine` of its half angle. Slant is its v."""
        from OCP.Geom import Geom_ConicalSurface

        return Geom_ConicalSurface(self.frame(z, up=up), math.asin(sine), radius)

    def plane(self, z: float) -> Any:
        from OCP.Geom import Geom_Plane

        return Geom_Plane(self.frame(z))

    def upright_plane(self, start: Sequence[float], along: Sequence[float]) -> Any:
        """Plane through a point, containing the horizontal direction `along` (x, y) and z; normal along x z."""
        from OCP.Geom import Geom_Plane
        from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

        return Geom_Plane(gp_Ax3(gp_Pnt(*start), gp_Dir(along[1], -along[0], 0), gp_Dir(along[0], along[1], 0)))

    def line_2d(self, u: float, v: float, du: float, dv: float) -> Any:
        from OCP.Geom2d import Geom2d_Line
        from OCP.gp import gp_Dir2d, gp_Pnt2d

        return Geom2d_Line(gp_Pnt2d(u, v), gp_Dir2d(du, dv))

    # ------------------------------------------------------------------ topology

    def vertex(self, point: Sequence[float]) -> tuple[Any, Any]:
        """A vertex as (forward, reversed)."""
        vertex = self._vertex()
        place = self._point(*point)
        if not self.here.IsIdentity():
            place.Transform(self.here.Transformation())
        self._builder.MakeVertex(vertex, place, self.tolerance)
        return vertex, vertex.Reversed()

    def edge(
        self, curve: Any, start: tuple[Any, Any], end: tuple[Any, Any], first: float, last: float, place: Any = None
    ) -> Any:
        """An edge on a curve (moved to `place`) from `start` at parameter `first` to `end` at `last`."""
        edge = self._edge()
        self._builder.MakeEdge(edge, curve, place or self.here, self.tolerance)
        self._builder.Add(edge, start[0])
        self._builder.Add(edge, end[1])
        self._builder.Range(edge, first, last)
        return edge

    def lay(self, edge: Any, surface: Any, *curves: Any, place: Any = None) -> None:
        """Give an edge its curve in the parameters of a surface; two curves make it the seam of a closed one."""
        self._builder.UpdateEdge(edge, *curves, surface, place or self.here, self.tolerance)

    def wire(self, loop: Edges) -> Any:
        wire = self._wire()
        self._builder.MakeWire(wire)
        for edge, along in loop:
            self._builder.Add(wire, edge if along else edge.Reversed())
        wire.Closed(True)
        return wire

    def face(self, surface: Any, loops: Iterable[Edges], *, outward: bool = True, place: Any = None) -> None:
        """Add a face to the shell; its loops run counter-clockwise (holes clockwise) about the surface's own normal."""
        face = self._face()
        self._builder.MakeFace(face, surface, place or self.here, PRECISION)
        for loop in loops:
            self._builder.Add(face, self.wire(loop))
        self._builder.Add(self._shell, face if outward else face.Reversed())

    def solid(self) -> Any:
        """Close the shell into a TopoDS_Solid."""
        from OCP.TopoDS import TopoDS_Solid

        self._shell.Closed(True)
        solid = TopoDS_Solid()
        self._builder.MakeSolid(solid)
        self._builder.Add(solid, self._shell)
        return solid

"""A boundary as a solid of the OpenCASCADE kernel: topology by hand, no sewing, no booleans."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from gearcad.solids.exact.boundary import PRECISION, Boundary, Chain, Turn
from gearcad.solids.exact.forms import (
    BezierCurve,
    BezierOnSurface,
    BezierSurface,
    CircleCurve,
    ConeSurface,
    CurveForm,
    CylinderSurface,
    EllipseCurve,
    Frame,
    LineOnSurface,
    OnSurface,
    PlaneSurface,
    StraightLine,
    SurfaceForm,
)

__all__ = ["kernel_solid", "local_axes"]


def kernel_solid(boundary: Boundary) -> Any:
    """TopoDS_Solid of a boundary. Forms that are used at several places are made once."""
    return _Maker(boundary).solid()


class _Maker:
    """Makes vertices, edges and faces of one solid."""

    def __init__(self, boundary: Boundary) -> None:
        from OCP.BRep import BRep_Builder

        self.boundary, self.builder = boundary, BRep_Builder()
        self.places = _locations(boundary.places)
        self.forms: dict[CurveForm | SurfaceForm | OnSurface, Any] = {}
        self.vertices = self._vertices()
        self.edges = self._edges()
        self._lay()

    def solid(self) -> Any:
        """The closed solid."""
        from OCP.TopoDS import TopoDS_Face, TopoDS_Shell, TopoDS_Solid

        builder, shell, solid = self.builder, TopoDS_Shell(), TopoDS_Solid()
        builder.MakeShell(shell)
        for surface, place, loops, outward in self.boundary.faces:
            face = TopoDS_Face()
            builder.MakeFace(face, self._form(surface), self.places[place], PRECISION)
            for loop in loops:
                builder.Add(face, self._wire(loop))
            builder.Add(shell, face if outward else face.Reversed())
        shell.Closed(True)
        builder.MakeSolid(solid)
        builder.Add(solid, shell)
        return solid

    def _form(self, form: CurveForm | SurfaceForm | OnSurface) -> Any:
        """A curve or surface of the kernel, the same one whenever it is asked for."""
        made = self.forms.get(form)
        if made is None:
            made = self.forms[form] = _made(form)
        return made

    def _vertices(self) -> list[tuple[Any, Any]]:
        """Every vertex as the start and as the end of an edge."""
        from OCP.gp import gp_Pnt
        from OCP.TopoDS import TopoDS_Vertex

        make, tolerance, made = self.builder.MakeVertex, self.boundary.tolerance, []
        for x, y, z in self.boundary.vertices:
            vertex = TopoDS_Vertex()
            make(vertex, gp_Pnt(x, y, z), tolerance)
            made.append((vertex, vertex.Reversed()))
        return made

    def _edges(self) -> list[tuple[Any, Any]]:
        """Every edge, run backward and along its own direction."""
        from OCP.TopoDS import TopoDS_Edge

        make, add, limit, form = self.builder.MakeEdge, self.builder.Add, self.builder.Range, self._form
        places, vertices, tolerance = self.places, self.vertices, self.boundary.tolerance
        made = []
        for curve, place, start, end, first, last in self.boundary.edges:
            edge = TopoDS_Edge()
            make(edge, form(curve), places[place], tolerance)
            add(edge, vertices[start][0])
            add(edge, vertices[end][1])
            limit(edge, first, last)
            made.append((edge.Reversed(), edge))
        return made

    def _lay(self) -> None:
        """Give edges their curves on surfaces."""
        update, form, edges, places = self.builder.UpdateEdge, self._form, self.edges, self.places
        tolerance = self.boundary.tolerance
        for edge, surface, place, curves in self.boundary.laid:
            update(edges[edge][True], *map(form, curves), form(surface), places[place], tolerance)

    def _wire(self, loop: Chain) -> Any:
        from OCP.TopoDS import TopoDS_Wire

        wire, add, edges = TopoDS_Wire(), self.builder.Add, self.edges
        self.builder.MakeWire(wire)
        for edge, along in loop:
            add(wire, edges[edge][along])
        wire.Closed(True)
        return wire


def _locations(places: Sequence[Turn]) -> list[Any]:
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    axis, made = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), []
    for place in places:
        if place == (0.0, 0.0):
            made.append(TopLoc_Location())
            continue
        moved = gp_Trsf()
        moved.SetRotation(axis, place.angle)
        if place.z:
            moved.SetTranslationPart(gp_Vec(0, 0, place.z))
        made.append(TopLoc_Location(moved))
    return made


def _made(form: CurveForm | SurfaceForm | OnSurface) -> Any:
    """The kernel's curve or surface."""
    from OCP.Geom import (
        Geom_Circle,
        Geom_ConicalSurface,
        Geom_CylindricalSurface,
        Geom_Ellipse,
        Geom_Line,
        Geom_Plane,
    )
    from OCP.Geom2d import Geom2d_Line
    from OCP.gp import gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d

    match form:
        case StraightLine(start, direction):
            return Geom_Line(gp_Pnt(*start), gp_Dir(*direction))
        case CircleCurve(frame, radius):
            return Geom_Circle(local_axes(frame).Ax2(), radius)
        case EllipseCurve(frame, major, minor):
            return Geom_Ellipse(local_axes(frame).Ax2(), major, minor)
        case PlaneSurface(frame):
            return Geom_Plane(local_axes(frame))
        case CylinderSurface(frame, radius):
            return Geom_CylindricalSurface(local_axes(frame), radius)
        case ConeSurface(frame, radius, half_angle):
            return Geom_ConicalSurface(local_axes(frame), half_angle, radius)
        case LineOnSurface(u, v, du, dv):
            return Geom2d_Line(gp_Pnt2d(u, v), gp_Dir2d(du, dv))
        case BezierOnSurface():
            return _bezier_2d(form)
        case BezierCurve():
            return _bezier_curve(form)
        case BezierSurface():
            return _bezier_surface(form)


def local_axes(frame: Frame) -> Any:
    from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

    return gp_Ax3(gp_Pnt(*frame.origin), gp_Dir(*frame.axis), gp_Dir(*frame.along))


def _bezier_curve(curve: BezierCurve) -> Any:
    from OCP.Geom import Geom_BSplineCurve
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array1OfPnt

    poles, degree = curve.poles, len(curve.poles) - 1
    array = TColgp_Array1OfPnt(1, len(poles))
    for i, point in enumerate(poles.tolist(), 1):
        array.SetValue(i, gp_Pnt(*point))
    return Geom_BSplineCurve(array, *_knots(degree, curve.first, curve.last), degree)


def _bezier_2d(curve: BezierOnSurface) -> Any:
    from OCP.Geom2d import Geom2d_BSplineCurve
    from OCP.gp import gp_Pnt2d
    from OCP.TColgp import TColgp_Array1OfPnt2d

    poles, degree = curve.poles, len(curve.poles) - 1
    array = TColgp_Array1OfPnt2d(1, len(poles))
    for i, point in enumerate(poles.tolist(), 1):
        array.SetValue(i, gp_Pnt2d(*point))
    return Geom2d_BSplineCurve(array, *_knots(degree, curve.first, curve.last), degree)


def _bezier_surface(surface: BezierSurface) -> Any:
    from OCP.Geom import Geom_BSplineSurface
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array2OfPnt

    rows, columns = surface.poles.shape[:2]
    array = TColgp_Array2OfPnt(1, rows, 1, columns)
    for i, row in enumerate(surface.poles.tolist(), 1):
        for j, point in enumerate(row, 1):
            array.SetValue(i, j, gp_Pnt(*point))
    along, across = _knots(rows - 1, 0.0, 1.0), _knots(columns - 1, surface.low, surface.high)
    return Geom_BSplineSurface(array, along[0], across[0], along[1], across[1], rows - 1, columns - 1)


def _knots(degree: int, first: float, last: float) -> tuple[Any, Any]:
    """Knots of one span, and how often each is there."""
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

    knots, counts = TColStd_Array1OfReal(1, 2), TColStd_Array1OfInteger(1, 2)
    knots.SetValue(1, first)
    knots.SetValue(2, last)
    counts.SetValue(1, degree + 1)
    counts.SetValue(2, degree + 1)
    return knots, counts

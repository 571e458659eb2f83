"""A boundary as a solid of the OpenCASCADE kernel: topology by hand, no sewing, no booleans."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from gearcad.solids.exact.boundary import (
    PRECISION,
    BezierCurve,
    BezierOnSurface,
    BezierSurface,
    Boundary,
    Chain,
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
    Turn,
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
        self.places = _Places(boundary.places)
        self.forms: dict[CurveForm | SurfaceForm | OnSurface, Any] = {}
        self.vertices: dict[tuple[int, int], tuple[Any, Any]] = {}
        self.edges: dict[int, Any] = {}
        self.sources, self.turned = self._copies()
        self._lay()

    def solid(self) -> Any:
        """Return the closed solid."""
        from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid

        builder, shell, solid = self.builder, TopoDS_Shell(), TopoDS_Solid()
        builder.MakeShell(shell)
        for face in self._faces():
            builder.Add(shell, face)
        shell.Closed(True)
        builder.MakeSolid(solid)
        builder.Add(solid, shell)
        return solid

    def _faces(self) -> Iterator[Any]:
        """Yield every face, its normal outwards; those of other teeth are those of the first one, moved."""
        from OCP.TopoDS import TopoDS_Face

        turns, moved, sources, turned = self.places.turns, self.places.moved, self.sources, self.turned
        first_of: dict[tuple[Any, ...], tuple[Any, float]] = {}
        for surface, place, loops, outward in self.boundary.faces:
            turn = turns[place]
            key = (
                surface,
                outward,
                tuple([(sources[edge], along, turned[edge] - turn) for loop in loops for edge, along in loop]),
            )
            known = first_of.get(key)
            if known is not None:
                yield known[0].Moved(moved[turn - known[1]])
                continue
            face = TopoDS_Face()
            self.builder.MakeFace(face, self._form(surface), self.places.locations[place], PRECISION)
            for loop in loops:
                self.builder.Add(face, self._wire(loop))
            shape = face if outward else face.Reversed()
            first_of[key] = shape, turn
            yield shape

    def _form(self, form: CurveForm | SurfaceForm | OnSurface) -> Any:
        """Return a curve or surface of the kernel, the same one whenever it is asked for."""
        made = self.forms.get(form)
        if made is None:
            made = self.forms[form] = _kernel_form(form)
        return made

    def _vertex(self, source: tuple[int, int]) -> tuple[Any, Any]:
        """Return a vertex, as a copy of its source at a place, as the start and as the end of an edge."""
        made = self.vertices.get(source)
        if made is not None:
            return made
        from OCP.gp import gp_Pnt
        from OCP.TopoDS import TopoDS_Vertex

        number, place = source
        if place:
            vertex = self._vertex((number, 0))[0].Moved(self.places.locations[place])
        else:
            vertex = TopoDS_Vertex()
            self.builder.MakeVertex(vertex, gp_Pnt(*self.boundary.vertices[number]), self.boundary.tolerance)
        made = self.vertices[source] = vertex, vertex.Reversed()
        return made

    def _copies(self) -> tuple[list[int], list[float]]:
        """Return, for every edge, the edge that it copies and the pitches by which it is turned from that: itself and 0 for
        others.

        Edges of other teeth are those of the first one, moved: they share curves, vertices and curves on surfaces.
        """
        from_vertices, turns, edges = self.boundary.sources, self.places.turns, self.boundary.edges
        first_of: dict[tuple[Any, ...], int] = {}
        sources, turned = [], []
        for number, (curve, place, start, end, first, last) in enumerate(edges):
            (one, here), (other, there), turn = from_vertices[start], from_vertices[end], turns[place]
            source = first_of.setdefault((curve, first, last, one, other, turns[here] - turn, turns[there] - turn), number)
            sources.append(source)
            turned.append(turn - turns[edges[source].place] if source != number else 0)
        return sources, turned

    def _edge(self, number: int) -> Any:
        """Return an edge that is no copy, with its curve and vertices."""
        shape = self.edges.get(number)
        if shape is not None:
            return shape
        from OCP.TopoDS import TopoDS_Edge

        curve, place, start, end, first, last = self.boundary.edges[number]
        shape = self.edges[number] = TopoDS_Edge()
        self.builder.MakeEdge(shape, self._form(curve), self.places.locations[place], self.boundary.tolerance)
        self.builder.Add(shape, self._vertex(self.boundary.sources[start])[0])
        self.builder.Add(shape, self._vertex(self.boundary.sources[end])[1])
        self.builder.Range(shape, first, last)
        return shape

    def _lay(self) -> None:
        """Give edges their curves on surfaces, once for all copies that lie on them in the same way."""
        form, sources, turned = self._form, self.sources, self.turned
        turns, locations, moved = self.places.turns, self.places.locations, self.places.moved
        done = set()
        for numbers, surface, places, curves in self.boundary.laid:
            for number, place in zip(numbers, places, strict=True):
                source, more = sources[number], turned[number]
                turn = turns[place] - more
                if (source, surface, turn) not in done:
                    done.add((source, surface, turn))
                    location = moved[turn] if more else locations[place]
                    laid = *map(form, curves), form(surface), location, self.boundary.tolerance
                    self.builder.UpdateEdge(self._edge(source), *laid)

    def _wire(self, loop: Chain) -> Any:
        """Return a closed loop of edges."""
        from OCP.TopoDS import TopoDS_Wire

        wire, add, moved, turned = TopoDS_Wire(), self.builder.Add, self.places.moved, self.turned
        self.builder.MakeWire(wire)
        for number, along in loop:
            edge = self._edge(self.sources[number])
            if more := turned[number]:
                edge = edge.Moved(moved[more])
            add(wire, edge if along else edge.Reversed())
        wire.Closed(True)
        return wire


class _Places:
    """Locations of the kernel, and how many pitches each is turned by: those of teeth are powers of one turn by a pitch, so
    that a copy of what stands at a tooth is the same in the kernel's eyes as what is made there.
    """

    def __init__(self, places: Sequence[Turn]) -> None:
        from OCP.TopLoc import TopLoc_Location

        pitch = min((place.angle for place in places if place.angle > 0 and not place.z), default=0.0)
        self.moved = _Powers(_location(Turn(0.0, pitch)) if pitch else TopLoc_Location())
        self.turns = [_pitches(place, pitch, -number) for number, place in enumerate(places)]
        self.locations = [
            self.moved[turn] if turn == int(turn) else _location(place) for turn, place in zip(self.turns, places, strict=True)
        ]


class _Powers(dict[float, Any]):
    """Locations turned by a number of pitches, made when first asked for."""

    def __init__(self, pitch: Any) -> None:
        super().__init__()
        self._pitch = pitch

    def __missing__(self, turns: float) -> Any:
        self[turns] = made = self._pitch.Powered(int(turns))
        return made


def _pitches(place: Turn, pitch: float, number: int) -> float:
    """Whole pitches by which a place is turned; a broken number that no other place has where there are none."""
    turns = place.angle / pitch if pitch else 0.0
    whole = round(turns)
    return whole if not place.z and abs(turns - whole) < 1e-9 and (pitch or not place.angle) else number - 0.5


def _location(place: Turn) -> Any:
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    moved = gp_Trsf()
    moved.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), place.angle)
    if place.z:
        moved.SetTranslationPart(gp_Vec(0, 0, place.z))
    return TopLoc_Location(moved)


def _kernel_form(form: CurveForm | SurfaceForm | OnSurface) -> Any:
    """Return the kernel's curve or surface."""
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

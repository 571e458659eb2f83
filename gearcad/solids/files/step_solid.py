"""A boundary as entities of STEP (ISO 10303-42, AP214): no curves in parameter space, which readers make again themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.exact.boundary import Boundary, Chain
from gearcad.solids.exact.forms import (
    BezierCurve,
    BezierSurface,
    CircleCurve,
    ConeSurface,
    CurveForm,
    CylinderSurface,
    EllipseCurve,
    Frame,
    PlaneSurface,
    StraightLine,
    SurfaceForm,
    Vector,
)
from gearcad.solids.files.part21 import DataSection, listed, real

__all__ = ["frame_entity", "solid_entity"]

_Form = CurveForm | SurfaceForm
_Text = Callable[[DataSection, list[int], list[int]], str]
"""The text of a form, of the numbers of its points and directions; adds what else it needs to the data."""


def solid_entity(data: DataSection, boundary: Boundary) -> int:
    """Add a boundary to the data; the number of its MANIFOLD_SOLID_BREP."""
    return _SolidWriter(data, boundary).solid()


def frame_entity(data: DataSection, frame: Frame) -> int:
    """Add an AXIS2_PLACEMENT_3D; its number."""
    origin = data.shared(_triple("CARTESIAN_POINT", frame.origin))
    axis, along = (data.shared(_triple("DIRECTION", direction)) for direction in (frame.axis, frame.along))
    return data.shared(f"AXIS2_PLACEMENT_3D('',#{origin},#{axis},#{along})")


def _triple(kind: str, values: Vector) -> str:
    text = "%r,%r,%r" % values  # noqa: UP031 - the quickest
    if "e" in text:
        text = ",".join(real(value) for value in values)
    return f"{kind}('',({text}))"


class _SolidWriter:
    """Writes one solid. What many edges and faces have in common is there once: points, directions, placements."""

    def __init__(self, data: DataSection, boundary: Boundary) -> None:
        self.data, self.boundary = data, boundary
        self.points: dict[Vector, int] = {}
        self.directions: dict[Vector, int] = {}
        angles = np.array([place.angle for place in boundary.places])
        self.cosines, self.sines = np.cos(angles), np.sin(angles)
        self.lifts = np.array([place.z for place in boundary.places])

    def solid(self) -> int:
        """All of it."""
        boundary, add = self.boundary, self.data.add
        vertices = [add(f"VERTEX_POINT('',#{self._point(point)})") for point in boundary.vertices]
        curves = self._placed((edge.curve, edge.place) for edge in boundary.edges)
        edges = [
            add(f"EDGE_CURVE('',#{vertices[edge.start]},#{vertices[edge.end]},#{curves[edge.curve, edge.place]},.T.)")
            for edge in boundary.edges
        ]
        surfaces = self._placed((face.surface, face.place) for face in boundary.faces)
        faces = []
        for surface, place, loops, outward in boundary.faces:
            sense = ".T." if outward else ".F."
            bounds = [add(f"FACE_BOUND('',#{self._loop(loop, edges)},{sense})") for loop in loops]
            faces.append(add(f"ADVANCED_FACE('',({listed(bounds)}),#{surfaces[surface, place]},{sense})"))
        shell = add(f"CLOSED_SHELL('',({listed(faces)}))")
        return add(f"MANIFOLD_SOLID_BREP('',#{shell})")

    def _loop(self, loop: Chain, edges: Sequence[int]) -> int:
        add = self.data.add
        run = [add(f"ORIENTED_EDGE('',*,*,#{edges[edge]},{'.T.' if along else '.F.'})") for edge, along in loop]
        return add(f"EDGE_LOOP('',({listed(run)}))")

    def _point(self, point: Vector) -> int:
        number = self.points.get(point)
        if number is None:
            number = self.points[point] = self.data.add(_triple("CARTESIAN_POINT", point))
        return number

    def _direction(self, direction: Vector) -> int:
        number = self.directions.get(direction)
        if number is None:
            number = self.directions[direction] = self.data.add(_triple("DIRECTION", direction))
        return number

    def _placed(self, uses: Iterable[tuple[_Form, int]]) -> dict[tuple[_Form, int], int]:
        """Every form at every place where it is used, form by form: its points are turned to all places at once."""
        places: dict[_Form, dict[int, None]] = {}
        for form, place in uses:
            places.setdefault(form, {})[place] = None
        found = {}
        for form, used in places.items():
            points, directions, text = _parts(form)
            at = list(used)
            for place, turned, pointing in zip(at, self._turned(points, at, 1), self._turned(directions, at, 0), strict=True):
                numbers = [self._point((x, y, z)) for x, y, z in turned]
                axes = [self._direction((x, y, z)) for x, y, z in pointing]
                found[form, place] = self.data.add(text(self.data, numbers, axes))
        return found

    def _turned(self, vectors: Floats, at: list[int], lift: int) -> list[list[list[float]]]:
        """Vectors (n, 3) as they are at places, points lifted."""
        cosine, sine = self.cosines[at, None], self.sines[at, None]
        x, y, z = vectors.T
        turned = [cosine * x - sine * y, sine * x + cosine * y, z + lift * self.lifts[at, None]]
        found: list[list[list[float]]] = np.stack(turned, -1).tolist()
        return found


def _parts(form: _Form) -> tuple[Floats, Floats, _Text]:
    """Points (n, 3) and directions (m, 3) of a form, and its text of their numbers."""
    match form:
        case BezierCurve():
            return form.poles, np.empty((0, 3)), _bezier_curve(form)
        case BezierSurface():
            return form.poles.reshape(-1, 3), np.empty((0, 3)), _bezier_surface(form)
        case StraightLine(start, direction):
            return np.array([start]), np.array([direction]), _line
        case CircleCurve(frame, radius):
            return _framed(frame, "CIRCLE", radius)
        case EllipseCurve(frame, major, minor):
            return _framed(frame, "ELLIPSE", major, minor)
        case PlaneSurface(frame):
            return _framed(frame, "PLANE")
        case CylinderSurface(frame, radius):
            return _framed(frame, "CYLINDRICAL_SURFACE", radius)
        case ConeSurface(frame, radius, half_angle):
            return _framed(frame, "CONICAL_SURFACE", radius, half_angle)


def _framed(frame: Frame, kind: str, *sizes: float) -> tuple[Floats, Floats, _Text]:
    """A form that is its frame and some sizes."""
    last = "".join(f",{real(size)}" for size in sizes)

    def text(data: DataSection, points: list[int], directions: list[int]) -> str:
        axis, along = directions
        placement = data.shared(f"AXIS2_PLACEMENT_3D('',#{points[0]},#{axis},#{along})")
        return f"{kind}('',#{placement}{last})"

    return np.array([frame.origin]), np.array([frame.axis, frame.along]), text


def _line(data: DataSection, points: list[int], directions: list[int]) -> str:
    reach = data.shared(f"VECTOR('',#{directions[0]},1.)")
    return f"LINE('',#{points[0]},#{reach})"


def _bezier_curve(curve: BezierCurve) -> _Text:
    order = len(curve.poles)
    rest = f".UNSPECIFIED.,.F.,.F.,({order},{order}),({real(curve.first)},{real(curve.last)}),.PIECEWISE_BEZIER_KNOTS."

    def text(_data: DataSection, points: list[int], _directions: list[int]) -> str:
        return f"B_SPLINE_CURVE_WITH_KNOTS('',{order - 1},({listed(points)}),{rest})"

    return text


def _bezier_surface(surface: BezierSurface) -> _Text:
    rows, columns = surface.poles.shape[:2]
    knots = f"({rows},{rows}),({columns},{columns}),(0.,1.),({real(surface.low)},{real(surface.high)})"
    rest = f".UNSPECIFIED.,.F.,.F.,.F.,{knots},.PIECEWISE_BEZIER_KNOTS."

    def text(_data: DataSection, points: list[int], _directions: list[int]) -> str:
        net = ",\n".join(f"({listed(points[i : i + columns])})" for i in range(0, len(points), columns))
        return f"B_SPLINE_SURFACE_WITH_KNOTS('',{rows - 1},{columns - 1},({net}),{rest})"

    return text

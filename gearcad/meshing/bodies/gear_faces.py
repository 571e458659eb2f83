"""Faces of a gear's boundary representation, meshed by gmsh, and the length of edges on each."""

from __future__ import annotations

import math
import signal
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from enum import Enum
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event, current_thread, main_thread
from typing import Any

import numpy as np

from gearcad.core.errors import SolverError, require_number
from gearcad.core.records import Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind
from gearcad.geometry.gear import FlankCurve, flank_curves
from gearcad.geometry.gear_data import section_turn
from gearcad.meshing.bodies.element_mesh import GAP, RIM, Cells, named_left
from gearcad.meshing.outline import EdgeLength, MeshSizes, bent_lengths
from gearcad.meshing.sector import load_gmsh

_CURVES, _SURFACES, _VOLUMES = 1, 2, 3
_TRIANGLE, _TETRAHEDRON = 2, 4
"""gmsh's numbers of dimensions and of kinds of elements."""

_LONGEST = 1e22
"""Largest edge length that gmsh itself sets."""

_FRONTAL, _HXT = 6, 10
"""gmsh's numbers of its algorithms for faces and for volumes."""


class SurfaceKind(Enum):
    """Kind of surface on which a face lies; the value is gmsh's word for it."""

    PLANE = "Plane"
    CYLINDER = "Cylinder"
    CONE = "Cone"
    SPLINE = "BSpline surface"


class Stage(Enum):
    """Stages of meshing in gmsh, one after the other."""

    CURVES = "edges"
    SURFACES = "faces"
    VOLUMES = "tetrahedra"


@dataclass(frozen=True)
class BrepFace:
    """A face of the shape: a point (mm) and the normal in the middle of its parameters, its area (mm²) and the box round it
    (2, 3) in mm.
    """

    surface: SurfaceKind
    middle: Floats
    normal: Floats
    area: float
    box: Floats

    @property
    def width(self) -> float:
        """Width (mm) of the face, which may be long: area over the diagonal of its box."""
        return self.area / float(np.linalg.norm(self.box[1] - self.box[0]))


@dataclass(frozen=True)
class RadialLengths:
    """Lengths (mm) that change with the distance from the z axis: `lengths` at `first` and then every `step` (mm).

    `mean` is that of triangles of one size, were they as many.
    """

    first: float
    step: float
    lengths: Sequence[float]
    mean: float

    def refined(self, factor: float) -> RadialLengths:
        """Return all lengths, shorter by a factor."""
        return replace(self, lengths=[length / factor for length in self.lengths], mean=self.mean / factor)

    def at(self, radius: float) -> float:
        """Return the length at a radius (mm), or that at the next end."""
        place = min(max((radius - self.first) / self.step, 0.0), len(self.lengths) - 1.001)
        low = int(place)
        return self.lengths[low] + (place - low) * (self.lengths[low + 1] - self.lengths[low])


@dataclass(frozen=True)
class EdgeLengths:
    """Largest edge lengths (mm): on each face, there and on its edges by the radius too, unless that is None, and inside;
    inwards they grow by `growth` times the distance.
    """

    faces: Sequence[float]
    radial: Sequence[RadialLengths | None]
    inside: float
    growth: float


@dataclass(frozen=True)
class TetrahedronMesh:
    """Tetrahedra (m, 4) with nodes at `points` (n, 3) in mm, and the triangles (k, 3) on each face of the shape."""

    points: Floats
    tetrahedra: Cells
    triangles: Sequence[Cells]


def fill_brep(
    shape: Any, lengths: Callable[[Sequence[BrepFace]], EdgeLengths], stage: Callable[[Stage], None] = lambda _stage: None
) -> TetrahedronMesh:
    """Fill a shape of the CAD kernel (TopoDS_Solid). `lengths` is asked how long edges shall be, `stage` told what begins.

    After an interrupt all that is left of a stage is made as coarse as can be, and the interrupt raised. Raises SolverError if
    gmsh fails, and what `lengths` raises.
    """
    with _gmsh() as gmsh:
        faces = _imported(gmsh, shape)
        wanted = lengths([_face(gmsh, tag) for tag in faces])
        with _refusals("fill the solid"):
            _set_sizes(gmsh, faces, wanted)
        with _interrupts_kept() as interrupted:
            gmsh.model.mesh.set_size_callback(_length_callback(_by_radius(gmsh, faces, wanted.radial), interrupted))
            for dimension, each in enumerate(Stage, 1):
                stage(each)
                with _refusals("fill the solid"):
                    gmsh.model.mesh.generate(dimension)
                if interrupted.is_set():
                    break
        with _refusals("fill the solid"):
            gmsh.model.mesh.optimize("Relocate3D")
            return _filled(gmsh, faces)


@contextmanager
def _gmsh() -> Iterator[Any]:
    """gmsh, which is one for the whole process, from its begin to its end."""
    gmsh = load_gmsh()
    gmsh.initialize(interruptible=False)  # the other way works in the main thread only
    try:
        gmsh.option.set_number("General.Terminal", 0)
        yield gmsh
    finally:
        gmsh.finalize()


@contextmanager
def _refusals(what: str) -> Iterator[None]:
    """Raise SolverError in place of any error of gmsh, whose own errors are plain Exceptions."""
    try:
        yield
    except Exception as error:
        raise SolverError(f"gmsh could not {what}: {error}") from error


def _imported(gmsh: Any, shape: Any) -> list[int]:
    """Read the shape, which goes through a file, since gmsh has a CAD kernel of its own; the tags of its faces."""
    from OCP.BRepTools import BRepTools

    with TemporaryDirectory() as folder, _refusals("read the solid"):
        path = str(Path(folder, "shape.brep"))
        BRepTools.Write_s(shape, path)
        gmsh.model.occ.import_shapes(path)
    gmsh.model.occ.synchronize()
    return [tag for _, tag in gmsh.model.get_entities(_SURFACES)]


def _face(gmsh: Any, tag: int) -> BrepFace:
    low, high = gmsh.model.get_parametrization_bounds(_SURFACES, tag)
    middle = (np.array(low) + high) / 2
    return BrepFace(
        SurfaceKind(gmsh.model.get_type(_SURFACES, tag)),
        np.array(gmsh.model.get_value(_SURFACES, tag, middle)),
        np.array(gmsh.model.get_normal(tag, middle)),
        float(gmsh.model.occ.get_mass(_SURFACES, tag)),
        np.reshape(gmsh.model.get_bounding_box(_SURFACES, tag), (2, 3)),
    )


def _set_sizes(gmsh: Any, faces: Sequence[int], wanted: EdgeLengths) -> None:
    """Set gmsh's edge lengths. Faces get the least length that they and their neighbours need; lengths grow into faces and
    inwards.
    """
    for name, value in _OPTIONS.items():
        gmsh.option.set_number(f"Mesh.{name}", value)
    fields = [_constant(gmsh, length, tags) for length, tags in _grouped(faces, wanted.faces).items()]
    least = min(wanted.faces)
    fields.append(_growing(gmsh, faces, least, wanted))
    smallest = gmsh.model.mesh.field.add("Min")
    gmsh.model.mesh.field.set_numbers(smallest, "FieldsList", fields)
    gmsh.model.mesh.field.set_as_background_mesh(smallest)


_OPTIONS: Mapping[str, float] = {
    "Algorithm": _FRONTAL,
    "Algorithm3D": _HXT,
    "MeshSizeFromPoints": 0,
    "MeshSizeExtendFromBoundary": 0,  # a field does that
    "Optimize": 1,
    "LcIntegrationPrecision": 1e-4,  # the usual 1e-9 asks for millions of lengths
}


@contextmanager
def _interrupts_kept() -> Iterator[Event]:
    """Keep an interrupt until the end, and tell of it meanwhile: raised in what gmsh calls, it would be lost."""
    interrupted = Event()
    # No other thread hears of interrupts, or may ask for them; and who started this may want them ignored.
    if current_thread() is not main_thread() or signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        yield interrupted
        return
    before = signal.signal(signal.SIGINT, lambda _number, _frame: interrupted.set())
    try:
        yield interrupted
    finally:
        signal.signal(signal.SIGINT, before if before is not None else signal.SIG_DFL)
        if interrupted.is_set():
            signal.raise_signal(signal.SIGINT)


def _length_callback(radial: Mapping[tuple[int, int], RadialLengths], interrupted: Event) -> Callable[..., float]:
    """Return a callback that tells gmsh the length (mm) at a place; after an interrupt the greatest length, to finish soon."""

    def length(dimension: int, tag: int, x: float, y: float, _z: float, length: float) -> float:
        if interrupted.is_set():
            return _LONGEST
        lengths = radial.get((dimension, tag))
        return length if lengths is None else min(length, lengths.at(math.hypot(x, y)))

    return length


def _by_radius(gmsh: Any, faces: Sequence[int], radial: Sequence[RadialLengths | None]) -> dict[tuple[int, int], RadialLengths]:
    """Return the lengths of faces and of their edges, by gmsh's dimensions and tags."""
    found = {(_SURFACES, tag): lengths for tag, lengths in zip(faces, radial, strict=True) if lengths is not None}
    for (_, tag), lengths in list(found.items()):
        found |= {(_CURVES, int(curve)): lengths for curve in gmsh.model.get_adjacencies(_SURFACES, tag)[1]}
    return found


def _grouped(faces: Sequence[int], lengths: Sequence[float]) -> dict[float, list[int]]:
    found: dict[float, list[int]] = {}
    for face, length in zip(faces, lengths, strict=True):
        found.setdefault(length, []).append(face)
    return found


def _constant(gmsh: Any, length: float, faces: Sequence[int]) -> int:
    """Return the field of a length on faces and their edges."""
    field = gmsh.model.mesh.field.add("Constant")
    gmsh.model.mesh.field.set_number(field, "VIn", length)
    gmsh.model.mesh.field.set_numbers(field, "SurfacesList", faces)
    return int(field)


def _growing(gmsh: Any, faces: Sequence[int], least: float, wanted: EdgeLengths) -> int:
    """Return the field of lengths that grow away from edges that are meshed, into the faces, and from these into the body."""
    field = gmsh.model.mesh.field.add("Extend")
    curves = [tag for _, tag in gmsh.model.get_entities(_CURVES)]
    gmsh.model.mesh.field.set_numbers(field, "CurvesList", curves)
    gmsh.model.mesh.field.set_numbers(field, "SurfacesList", faces)
    gmsh.model.mesh.field.set_number(field, "SizeMax", wanted.inside)
    gmsh.model.mesh.field.set_number(field, "DistMax", max((wanted.inside - least) / wanted.growth, least))
    return int(field)


def _filled(gmsh: Any, faces: Sequence[int]) -> TetrahedronMesh:
    tags, coordinates, _ = gmsh.model.mesh.get_nodes()
    place = np.full(int(tags.max()) + 1, -1, np.int32)

    def cells(kind: int, nodes: int, tag: int) -> Cells:
        found: Cells = place[gmsh.model.mesh.get_elements_by_type(kind, tag)[1].astype(int)].reshape(-1, nodes)
        return found

    place[tags.astype(int)] = np.arange(len(tags), dtype=np.int32)
    tetrahedra = cells(_TETRAHEDRON, 4, -1)
    if not len(tetrahedra):
        raise SolverError("the solid has no tetrahedra inside")
    return TetrahedronMesh(coordinates.reshape(-1, 3), tetrahedra, [cells(_TRIANGLE, 3, tag) for tag in faces])


ROOT = "root"
"""Name of a root land, which is of two teeth."""

_NEAR = 1e-6
"""Radii and heights (mm) closer than this are the same: the CAD kernel's are exact to rounding."""

_NAMES = {CurveKind.FILLET: "fillet", CurveKind.INVOLUTE: "flank"}
"""Names of what the left and the right of a tooth each have; tip chamfers belong to the tip."""


@dataclass(frozen=True)
class GearFace:
    """A face of a gear. `name` is that of its side, where it has one only: a root land is of `tooth` and the next.

    `curve` is the number of the flank curve that it is swept from (None: no flank), on the side of its tooth that is `left` of
    the middle counter-clockwise, as y > 0 is of a tooth on +x; `radius` (mm) is that of a cylinder about `axis` (mm).
    """

    surface: SurfaceKind
    name: str
    tooth: int = 0
    curve: int | None = None
    left: bool = True
    radius: float = 0.0
    axis: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class GearFaces:
    """The faces of one gear, told apart."""

    gear: Gear

    @cached_property
    def curves(self) -> list[FlankCurve]:
        """The curves that flanks are swept from, root to tip."""
        return flank_curves(self.gear)

    def told(self, faces: Sequence[BrepFace]) -> list[GearFace]:
        """Return the kind of each of these faces. Raises SolverError for a face that a gear does not have."""
        return [_SURFACE_RULES[face.surface](self, face) for face in faces]

    def _tooth(self, face: BrepFace) -> tuple[int, float]:
        """Return the tooth whose middle is nearest, and the angle (rad) from there."""
        x, y, z = face.middle
        pitch = 2 * math.pi / self.gear.tooth_count
        angle = math.atan2(y, x) - float(section_turn(self.gear, np.asarray(z)))
        tooth = round(angle / pitch)
        return tooth % self.gear.tooth_count, angle - tooth * pitch

    def _swept(self, face: BrepFace) -> GearFace:
        tooth, angle = self._tooth(face)
        inwards = -1 if self.gear.internal else 1
        ends = [inwards * float(curve.curve.polar(1.0)[0]) for curve in self.curves]
        number = min(int(np.searchsorted(ends, inwards * math.hypot(*face.middle[:2]))), len(ends) - 1)
        name = _NAMES.get(self.curves[number].curve.kind)
        side = "left" if named_left(self.gear, positive=angle > 0) else "right"
        return GearFace(face.surface, f"{side}_{name}_{tooth}" if name else f"tip_{tooth}", tooth, number, angle > 0)

    def _round(self, face: BrepFace) -> GearFace:
        gear, profile, radius = self.gear, self.gear.profile, math.hypot(*face.middle[:2])
        tooth, angle = self._tooth(face)
        middle = (profile.root_diameter + profile.tip_diameter) / 4
        if gear.internal and radius > profile.root_diameter / 2 + _NEAR:
            return self._outside(face, radius)
        if gear.double_helix.gap_width and abs(radius - gear.gap_diameter / 2) < _NEAR:
            return GearFace(face.surface, GAP, radius=gear.gap_diameter / 2)
        if radius < gear.body.bore / 2 + _NEAR:
            name, known = "bore", gear.body.bore / 2
        elif not -_NEAR < face.middle[2] < gear.face_width + _NEAR:
            name, known = "hub", gear.body.hub_diameter / 2
        elif (radius < middle) != gear.internal:
            name, known = ROOT, profile.root_diameter / 2
            tooth -= angle < 0
        else:
            name, known = f"tip_{tooth}", profile.tip_diameter / 2
        if abs(radius - known) > _NEAR:
            raise SolverError(f"the solid has a cylinder of radius {radius:.6g} mm that the gear does not have")
        return GearFace(face.surface, name, tooth % gear.tooth_count, radius=known)

    def _outside(self, face: BrepFace, radius: float) -> GearFace:
        """Return the rim of a ring, or one of its bolt holes."""
        body = self.gear.body
        if body.rim_diameter is not None and abs(radius - body.rim_diameter / 2) < _NEAR:
            return GearFace(face.surface, RIM, radius=body.rim_diameter / 2)
        pitch = 2 * math.pi / max(body.bolt_holes, 1)
        place = pitch * round(math.atan2(face.middle[1], face.middle[0]) / pitch)
        axis = (body.bolt_circle / 2 * math.cos(place), body.bolt_circle / 2 * math.sin(place))
        if abs(math.dist(axis, face.middle[:2]) - body.bolt_diameter / 2) > _NEAR:
            raise SolverError(f"the solid has a cylinder at {radius:.6g} mm from the axis that the ring does not have")
        return GearFace(face.surface, "bolt_holes", radius=body.bolt_diameter / 2, axis=axis)

    def _conical(self, face: BrepFace) -> GearFace:
        return GearFace(face.surface, "end_chamfers")

    def _flat(self, face: BrepFace) -> GearFace:
        if abs(face.normal[2]) < 0.5:
            return GearFace(face.surface, "keyway")
        back, front = self.gear.body.hub_ends
        heights = {"end_back": 0.0, "end_front": self.gear.face_width}
        if self.gear.double_helix.gap_width:
            half = self.gear.half_width
            heights |= {"gap_back": half, "gap_front": self.gear.face_width - half}
        heights |= {"hub_back": -back} if back else {}
        heights |= {"hub_front": self.gear.face_width + front} if front else {}
        for name, height in heights.items():
            if abs(face.middle[2] - height) < _NEAR:
                return GearFace(face.surface, name)
        raise SolverError(f"the solid has an end at z = {face.middle[2]:.6g} mm that the gear does not have")


_SURFACE_RULES = {
    SurfaceKind.SPLINE: GearFaces._swept,
    SurfaceKind.CYLINDER: GearFaces._round,
    SurfaceKind.CONE: GearFaces._conical,
    SurfaceKind.PLANE: GearFaces._flat,
}


FILLET_ANGLE = 30.0
"""Standards of stress in fillets count elements over so much of an arc (deg)."""

_PLACES = 1025
"""Places of a curve at which lengths are kept."""

_CUSP, _SLACK = 0.03, 2.5
"""Where an involute begins at its base circle it bends without end, and an edge of length h is off by so much of
h (h/r_b)^(1/2), measured; there edges may be off this many times as far as they should, else lengths would vanish.
"""

_ROUND = 24
"""Least number of edges round a bore or a hub."""

_NARROW = 2.0
"""Largest ratio of an edge to the width of its face: flatter tetrahedra would be poor."""

_ABOVE, _GROWN = 0.9, 0.6
"""Tetrahedra above a triangle of the surface: this many, and so many over the growth; measured on many gears."""

_THIN = 1.5
"""Least number of edges through a rim, or over the face width."""


@dataclass(frozen=True, kw_only=True)
class TetrahedronGrading:
    """Rules by which the edges of tetrahedra differ from the one size that is asked for.

    At least `fillet_elements` stand over 30 degrees of a fillet, and edges in transverse sections are at most about `deviation`
    (µm) off the curve; None: as far as comes of it. On refined teeth edges are `refinement` times as fine. Inwards they grow by
    `growth` times the distance, up to `inside` times the size. Raises ParameterError.
    """

    fillet_elements: float = 1.0
    deviation: float | None = 0.1
    refinement: float = 3.0
    inside: float = 6.0
    growth: float = 0.3

    def __post_init__(self) -> None:
        for each in fields(self):
            if (value := getattr(self, each.name)) is not None:
                require_number(each.name, value, above=0)


def edge_lengths(
    gear: Gear,
    size: float,
    grading: TetrahedronGrading,
    refined: Collection[int],
    told: Sequence[GearFace],
    faces: Sequence[BrepFace],
) -> EdgeLengths:
    """Return the lengths on these faces, of which it was told what they are: `size` (mm) on teeth that are not `refined`, and
    less.
    """
    inside = min(grading.inside * size, _thickness(gear) / _THIN)
    size = min(size, inside)
    usual = _along_flanks(gear, size, grading)
    fine = {kind: lengths.refined(grading.refinement) for kind, lengths in usual.items()}
    kinds = [curve.curve.kind for curve in flank_curves(gear)]

    def wanted(face: GearFace) -> float:
        if face.surface is SurfaceKind.CYLINDER and not (face.name == ROOT or face.name.startswith("tip")):
            return min(inside, 2 * math.pi * face.radius / _ROUND)
        if face.surface not in (SurfaceKind.SPLINE, SurfaceKind.CYLINDER):
            return inside
        return size / grading.refinement if face.tooth in refined else size

    limits = [min(wanted(face), _NARROW * shape.width) for face, shape in zip(told, faces, strict=True)]
    radial = [None if face.curve is None else (fine if face.tooth in refined else usual)[kinds[face.curve]] for face in told]
    return EdgeLengths(limits, radial, inside, grading.growth)


def _along_flanks(gear: Gear, size: float, grading: TetrahedronGrading) -> dict[CurveKind, RadialLengths]:
    """Return the lengths on what flanks are swept from, as sections have them: at most `size` (mm), less where they bend."""
    module, cosine = gear.normal_module, math.cos(math.radians(gear.helix_angle))
    plain = dict.fromkeys(("flank", "corner", "fillet", "outline", "cut", "rim"), size / module)
    turn = FILLET_ANGLE * cosine**2 / grading.fillet_elements  # in the section normal to the helix fillets bend the more
    off = None if grading.deviation is None else grading.deviation / 1000 / module
    sizes = MeshSizes(**plain, growth=grading.growth, fillet_turn=turn, deviation=off)
    lengths = bent_lengths(gear, sizes).curves
    base = gear.profile.base_diameter / 2
    least = 0.0 if off is None else min(size, base * (_SLACK * off * module / _CUSP / base) ** (2 / 3))
    return {
        curve.kind: _tetrahedron_sizes_by_radius(curve, lengths[curve.kind], least)
        for curve in gear.profile.joined_curves
        if curve.kind not in (CurveKind.ROOT, CurveKind.TIP)
    }


def _tetrahedron_sizes_by_radius(curve: Curve, length: EdgeLength, least: float) -> RadialLengths:
    """Return the lengths over the radius, `least` (mm) at the least."""
    s = np.linspace(0.0, 1.0, _PLACES)
    run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(curve.points(s), axis=0).T))]
    lengths, radius = np.maximum(length(run, float(run[-1])), least), curve.polar(s)[0]
    mean = float(np.trapezoid(lengths**-2, run) / run[-1]) ** -0.5
    if radius[-1] < radius[0]:
        lengths, radius = lengths[::-1], radius[::-1]
    even = np.linspace(radius[0], radius[-1], _PLACES)
    return RadialLengths(float(even[0]), float(even[1] - even[0]), np.interp(even, radius, lengths).tolist(), mean)


def expected_tetrahedra(lengths: EdgeLengths, faces: Sequence[BrepFace]) -> float:
    """Return the approximate number of tetrahedra.

    Most of them lie next to the triangles of the surface. The slower the edges grow inwards, the more there are.
    """
    usual = [
        limit if radial is None else min(limit, radial.mean)
        for limit, radial in zip(lengths.faces, lengths.radial, strict=True)
    ]
    triangles = sum(face.area / length**2 for face, length in zip(faces, usual, strict=True)) * 4 / math.sqrt(3)
    return triangles * (_ABOVE + _GROWN / lengths.growth)


def _thickness(gear: Gear) -> float:
    """Return the least of rim, hub and face width (mm), whatever there is of them."""
    body, root = gear.body, gear.profile.root_diameter
    outside = body.rim_diameter or root
    rim = (outside - root if gear.internal else root - body.opening_diameter) / 2
    hub = (body.hub_diameter - body.opening_diameter) / 2 if body.hub_diameter else math.inf
    return min(gear.face_width, rim, hub)

"""gmsh fills a boundary representation with tetrahedra. It meshes the faces as they are, and knows nothing of gears."""

from __future__ import annotations

import math
import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event, current_thread, main_thread
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import SolverError
from gearcad.meshing.bodies.mesh import Cells
from gearcad.meshing.gmsh_library import load_gmsh

__all__ = ["BrepFace", "EdgeLengths", "Filled", "RadialLengths", "Stage", "Surface", "fill_brep"]

_CURVES, _SURFACES, _VOLUMES = 1, 2, 3
_TRIANGLE, _TETRAHEDRON = 2, 4
"""gmsh's numbers of dimensions and of kinds of elements."""

_LONGEST = 1e22
"""gmsh's own greatest length."""

_FRONTAL, _HXT = 6, 10
"""gmsh's numbers of its algorithms for faces and for volumes."""


class Surface(Enum):
    """What a face lies on; the value is gmsh's word for it."""

    PLANE = "Plane"
    CYLINDER = "Cylinder"
    CONE = "Cone"
    SPLINE = "BSpline surface"


class Stage(Enum):
    """What gmsh does one after the other."""

    CURVES = "edges"
    SURFACES = "faces"
    VOLUMES = "tetrahedra"


@dataclass(frozen=True)
class BrepFace:
    """A face of the shape: a point (mm) and the normal in the middle of its parameters, its area (mm²) and the box round it
    (2, 3) in mm.
    """

    surface: Surface
    middle: Floats
    normal: Floats
    area: float
    box: Floats

    @property
    def width(self) -> float:
        """How wide (mm) it is, which may be long."""
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
        """All of them shorter by a factor."""
        return replace(self, lengths=[length / factor for length in self.lengths], mean=self.mean / factor)

    def at(self, radius: float) -> float:
        """The length at a radius (mm), or that at the next end."""
        place = min(max((radius - self.first) / self.step, 0.0), len(self.lengths) - 1.001)
        low = int(place)
        return self.lengths[low] + (place - low) * (self.lengths[low + 1] - self.lengths[low])


@dataclass(frozen=True)
class EdgeLengths:
    """How long edges shall be (mm) at most: on each face, there and on its edges by the radius too, unless that is None, and
    inside; inwards they grow by `growth` times the distance.
    """

    faces: Sequence[float]
    radial: Sequence[RadialLengths | None]
    inside: float
    growth: float


@dataclass(frozen=True)
class Filled:
    """Tetrahedra (m, 4) with nodes at `points` (n, 3) in mm, and the triangles (k, 3) on each face of the shape."""

    points: Floats
    tetrahedra: Cells
    triangles: Sequence[Cells]


def fill_brep(
    shape: Any, lengths: Callable[[Sequence[BrepFace]], EdgeLengths], stage: Callable[[Stage], None] = lambda _stage: None
) -> Filled:
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
            gmsh.model.mesh.set_size_callback(_asked(_by_radius(gmsh, faces, wanted.radial), interrupted))
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
    """What gmsh raises is an Exception and no more."""
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
        Surface(gmsh.model.get_type(_SURFACES, tag)),
        np.array(gmsh.model.get_value(_SURFACES, tag, middle)),
        np.array(gmsh.model.get_normal(tag, middle)),
        float(gmsh.model.occ.get_mass(_SURFACES, tag)),
        np.reshape(gmsh.model.get_bounding_box(_SURFACES, tag), (2, 3)),
    )


def _set_sizes(gmsh: Any, faces: Sequence[int], wanted: EdgeLengths) -> None:
    """On faces the least of what they and their neighbours want; into faces and inwards it grows."""
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


def _asked(radial: Mapping[tuple[int, int], RadialLengths], interrupted: Event) -> Callable[..., float]:
    """What tells gmsh the length at a place: after an interrupt the greatest there is, so that it is done soon."""

    def length(dimension: int, tag: int, x: float, y: float, _z: float, length: float) -> float:
        if interrupted.is_set():
            return _LONGEST
        lengths = radial.get((dimension, tag))
        return length if lengths is None else min(length, lengths.at(math.hypot(x, y)))

    return length


def _by_radius(gmsh: Any, faces: Sequence[int], radial: Sequence[RadialLengths | None]) -> dict[tuple[int, int], RadialLengths]:
    """The lengths of faces and of their edges, by gmsh's dimensions and tags."""
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
    """The field of a length on faces and their edges."""
    field = gmsh.model.mesh.field.add("Constant")
    gmsh.model.mesh.field.set_number(field, "VIn", length)
    gmsh.model.mesh.field.set_numbers(field, "SurfacesList", faces)
    return int(field)


def _growing(gmsh: Any, faces: Sequence[int], least: float, wanted: EdgeLengths) -> int:
    """The field of lengths that grow away from edges that are meshed, into the faces, and from these into the body."""
    field = gmsh.model.mesh.field.add("Extend")
    curves = [tag for _, tag in gmsh.model.get_entities(_CURVES)]
    gmsh.model.mesh.field.set_numbers(field, "CurvesList", curves)
    gmsh.model.mesh.field.set_numbers(field, "SurfacesList", faces)
    gmsh.model.mesh.field.set_number(field, "SizeMax", wanted.inside)
    gmsh.model.mesh.field.set_number(field, "DistMax", max((wanted.inside - least) / wanted.growth, least))
    return int(field)


def _filled(gmsh: Any, faces: Sequence[int]) -> Filled:
    tags, coordinates, _ = gmsh.model.mesh.get_nodes()
    place = np.full(int(tags.max()) + 1, -1, np.int32)

    def cells(kind: int, nodes: int, tag: int) -> Cells:
        found: Cells = place[gmsh.model.mesh.get_elements_by_type(kind, tag)[1].astype(int)].reshape(-1, nodes)
        return found

    place[tags.astype(int)] = np.arange(len(tags), dtype=np.int32)
    tetrahedra = cells(_TETRAHEDRON, 4, -1)
    if not len(tetrahedra):
        raise SolverError("there is nothing in it")
    return Filled(coordinates.reshape(-1, 3), tetrahedra, [cells(_TRIANGLE, 3, tag) for tag in faces])

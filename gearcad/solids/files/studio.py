"""Studio: images of scenes (VTK off screen, Pillow). Equal pixels give equal bytes."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import OutputError
from gearcad.core.records import Bools, Floats, Wholes
from gearcad.solids.body_plan import Colour
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.cutaway import Camera, CutFace, CutPlanes, ViewDirection, cut_away, framed, points_of
from gearcad.solids.files.scenes import ScenePart

if TYPE_CHECKING:
    from PIL.Image import Image
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow


_OSMESA = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
"""Libraries with which VTK draws where neither an X server nor EGL is there."""


@contextmanager
def window_in_memory(size: tuple[int, int]) -> Iterator[vtkRenderWindow]:
    """A window of so many pixels, without what VTK says where there is no screen. Raises OutputError without OpenGL."""
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the renderer
    from vtkmodules.vtkCommonCore import vtkLogger
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        window = vtkRenderWindow()
        require_opengl(window)
        try:
            window.SetOffScreenRendering(1)
            window.SetMultiSamples(0)
            window.SetAlphaBitPlanes(1)
            window.SetSize(*size)
            yield window
        finally:
            window.Finalize()
    finally:
        vtkLogger.SetStderrVerbosity(before)


def require_opengl(window: vtkRenderWindow) -> None:
    """Raise OutputError where VTK would draw with a library that is not there: it then ends the whole process."""
    if window.GetClassName() != "vtkOSOpenGLRenderWindow":
        return
    for name in _OSMESA:
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return
    remedy = "install libegl1 (Debian, Ubuntu) or mesa-libEGL (Fedora)"
    raise OutputError("picture", "png", f"cannot be drawn, as there is no OpenGL here, neither EGL nor OSMesa: {remedy}")


def poly_data(facets: Facets) -> vtkPolyData:
    """Return the facets as triangles of VTK."""
    mesh = _points(facets.vertices)
    mesh.SetPolys(_cells(facets.faces))
    return mesh


def line_data(vertices: Floats, ends: Wholes) -> vtkPolyData:
    """Return the lines between pairs (n, 2) of vertices."""
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
    """Return the cells of as many points as a row (n, k) has."""
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    cells = vtkCellArray()
    cells.SetData(numbers.shape[1], numpy_to_vtkIdTypeArray(np.ascontiguousarray(numbers, np.int64).ravel(), deep=True))
    return cells


FEATURE_ANGLE = 25.0
"""Degrees between faces from which on their edge is drawn, and not smoothed."""

_ACROSS = 1e-6
"""Cosine between a normal and the way to the eye that counts as none: walls along the view are not seen from either side."""

_SLIMMEST = 1e-9
"""Height over length of a triangle whose direction is known."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges between two faces: their `ends` (n, 2) by number of vertex, the `normals` (n, 2, 3) of both, which are `sharp`."""

    ends: Wholes
    normals: Floats
    sharp: Bools

    @classmethod
    def of(cls, facets: Facets) -> Self:
        """Return the edges between two facets that have a direction: where they are open there are none."""
        faces = facets.faces
        a, b, c = (facets.vertices[faces[:, corner]] for corner in range(3))
        across = np.cross(b - a, c - a)
        lengths = np.linalg.norm(across, axis=1)
        normals = across / np.where(lengths > 0, lengths, 1.0)[:, None]
        ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        key = ends[:, 0] * len(facets.vertices) + ends[:, 1]
        order = np.argsort(key, kind="stable")
        first = np.flatnonzero(key[order][1:] == key[order][:-1])
        one, other = order[first], order[first + 1]
        both = np.stack([normals[one % len(faces)], normals[other % len(faces)]], axis=1)
        bent = np.einsum("ij,ij->i", both[:, 0], both[:, 1]) < np.cos(np.radians(FEATURE_ANGLE))
        longest = np.linalg.norm([b - a, c - b, a - c], axis=2).max(axis=0)
        solid = lengths > _SLIMMEST * longest**2
        known = solid[one % len(faces)] & solid[other % len(faces)]
        return cls(ends[one][known], both[known], bent[known])

    def drawn(self, towards: Floats) -> Wholes:
        """Ends (k, 2) of the sharp edges and of those at which the surface turns away from an eye that way (3,)."""
        facing = self.normals @ towards > _ACROSS
        ends: Wholes = self.ends[self.sharp | (facing[:, 0] != facing[:, 1])]
        return ends


_CUT, _CUT_SHARE = (0.96, 0.38, 0.28), 0.7
"""Colour of cut faces, and its share in them: the rest is the part's."""


@dataclass(frozen=True, eq=False)
class StudioShape:
    """Surfaces with normals, each in a colour, the edges of facets, and lines (n, 2, 3) that are drawn always."""

    facets: Facets
    edges: Edges
    surfaces: tuple[tuple[vtkPolyData, Colour], ...]
    outlines: Floats

    def lines(self, towards: Floats) -> vtkPolyData:
        """Return the lines to draw for an eye in the direction `towards` (3,)."""
        vertices, ends = self.facets.vertices, self.edges.drawn(towards)
        own = len(vertices) + np.arange(2 * len(self.outlines)).reshape(-1, 2)
        return line_data(np.concatenate([vertices, self.outlines.reshape(-1, 3)]), np.concatenate([ends, own]))


def whole_shape(part: ScenePart) -> StudioShape:
    """Return a part before it is put in its place."""
    return StudioShape(part.facets, Edges.of(part.facets), ((_smoothed(part.facets), part.colour),), np.zeros((0, 2, 3)))


def cut_shape(part: ScenePart, cut: CutPlanes) -> StudioShape:
    """Return a part in its place without what a cut takes off."""
    vertices = part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3]
    left = cut_away(Facets(vertices, part.facets.faces), cut)
    red, green, blue = (float(each) for each in _CUT_SHARE * np.array(_CUT) + (1 - _CUT_SHARE) * np.array(part.colour))
    surfaces = [(_smoothed(left.facets), part.colour), *((_flat(face), (red, green, blue)) for face in left.faces)]
    outlines = np.concatenate([face.outline for face in left.faces])
    return StudioShape(left.facets, Edges.of(left.facets), tuple(surfaces), outlines)


def _smoothed(facets: Facets) -> vtkPolyData:
    """Return the facets with normals that are smooth except at sharp edges."""
    from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

    smooth = vtkPolyDataNormals()
    smooth.SetInputData(poly_data(facets))
    smooth.SetFeatureAngle(FEATURE_ANGLE)
    smooth.ConsistencyOff()
    smooth.Update()
    found: vtkPolyData = smooth.GetOutput()
    return found


def _flat(face: CutFace) -> vtkPolyData:
    """Return the triangles of a cut face with the normal of its plane: slim triangles have no exact normal of their own."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    points = face.triangles.reshape(-1, 3)
    mesh = poly_data(Facets(points, np.arange(len(points)).reshape(-1, 3)))
    mesh.GetPointData().SetNormals(numpy_to_vtk(np.tile(face.normal, (len(points), 1)), deep=True))
    return mesh


Pixels = NDArray[np.uint8]
"""Rows from above, columns, and red, green, blue, opacity (height, width, 4)."""

_FINE, _LESS_FINE, _FINE_UP_TO = 3, 2, 5_000_000
"""Into how many finer pixels each way one is divided, and in pictures of more pixels than so many."""

_EDGE = (0.10, 0.11, 0.13)
"""Colour of edge lines."""

_LINE = 1.3 / 900
"""Width of lines, in heights of the picture."""

_LIGHTS = (((-0.55, 0.75, 0.65), 0.66), ((0.80, 0.15, 0.55), 0.36), ((-0.25, -0.55, 0.60), 0.26))
"""Directions (right, up, towards the eye) and strengths."""

_AMBIENT, _SHINE = 0.28, 0.12

_BAND = 128
"""Rows that are computed at a time, as floats need more memory than pixels."""


@dataclass(frozen=True, eq=False)
class Studio:
    """A window of `size` (width, height) in pixels. Shapes of parts that are photographed often are made once."""

    window: vtkRenderWindow
    size: tuple[int, int]
    transparent: bool
    finer: int
    shapes: dict[int, StudioShape] = field(default_factory=dict)

    def photograph(self, parts: Sequence[ScenePart], camera: Camera, cuts: Mapping[str, CutPlanes] | None = None) -> Pixels:
        """Show the parts, without the pieces that cuts remove from parts of these names, and return the image."""
        renderer = _renderer(camera)
        for part in parts:
            for actor in self._actors(part, camera, (cuts or {}).get(part.name)):
                renderer.AddActor(actor)
        renderer.ResetCameraClippingRange()
        self.window.AddRenderer(renderer)
        try:
            return self._taken()
        finally:
            self.window.RemoveRenderer(renderer)

    def _taken(self) -> Pixels:
        """Return the picture that the camera takes (height, width, 4): each pixel is the mean of its finer ones."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

        image = vtkWindowToImageFilter()
        image.SetInput(self.window)
        image.SetScale(self.finer)
        image.SetInputBufferTypeToRGBA()
        image.ReadFrontBufferOff()
        image.Update()
        width, height = self.size
        found = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())
        found = found.reshape(height, self.finer, width, self.finer, 4)[::-1]
        pixels = np.empty((height, width, 4), np.uint8)
        for start in range(0, height, _BAND):
            pixels[start : start + _BAND] = _on(_mean(found[start : start + _BAND]), self.transparent)
        return pixels

    def _actors(self, part: ScenePart, camera: Camera, cut: CutPlanes | None) -> Iterator[vtkActor]:
        pose = part.pose if cut is None else np.eye(4)
        shape = self._shape(part) if cut is None else cut_shape(part, cut)
        for surface, colour in shape.surfaces:
            actor = _actor(surface, colour, pose)
            look = actor.GetProperty()
            look.SetAmbient(_AMBIENT)
            look.SetSpecularColor(1, 1, 1)
            look.SetSpecular(_SHINE)
            look.SetSpecularPower(25)
            yield actor
        lines = _actor(shape.lines(camera.axes[2] @ pose[:3, :3]), _EDGE, pose)
        lines.GetProperty().LightingOff()
        lines.GetProperty().SetLineWidth(max(1.0, _LINE * self.finer * min(self.size)))
        yield lines

    def _shape(self, part: ScenePart) -> StudioShape:
        key = id(part.facets)  # the shape holds the facets, so nothing else can come to this number
        if key not in self.shapes:
            self.shapes[key] = whole_shape(part)
        return self.shapes[key]


@contextmanager
def studio(size: tuple[int, int], *, transparent: bool = False, finer: int | None = None) -> Iterator[Studio]:
    """A studio for pictures of so many pixels, each divided `finer` ways (None: as fine as is good, and memory allows).

    Raises OutputError on a machine without OpenGL.
    """
    with window_in_memory(size) as window:
        yield Studio(window, size, transparent, finer or (_FINE if size[0] * size[1] <= _FINE_UP_TO else _LESS_FINE))


def _renderer(camera: Camera) -> vtkRenderer:
    """Return a renderer with a transparent background and a parallel projection."""
    from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer

    renderer = vtkRenderer()
    renderer.SetBackground(0, 0, 0)
    renderer.SetBackgroundAlpha(0)
    for direction, strength in _LIGHTS:
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(*direction)
        light.SetFocalPoint(0, 0, 0)
        light.SetIntensity(strength)
        light.PositionalOff()
        renderer.AddLight(light)
    eye = renderer.GetActiveCamera()
    eye.ParallelProjectionOn()
    eye.SetFocalPoint(*camera.middle)
    eye.SetPosition(*(camera.middle + (camera.distance + camera.half_height) * camera.axes[2]))
    eye.SetViewUp(*camera.axes[1])
    eye.SetParallelScale(camera.half_height)
    return renderer


def _actor(data: vtkPolyData, colour: Colour, pose: Floats) -> vtkActor:
    """Surfaces or lines in their place."""
    from vtkmodules.vtkCommonMath import vtkMatrix4x4
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    mapper, actor, place = vtkPolyDataMapper(), vtkActor(), vtkMatrix4x4()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor.SetMapper(mapper)
    place.DeepCopy(pose.ravel().tolist())
    actor.SetUserMatrix(place)
    actor.GetProperty().SetColor(*colour)
    return actor


def _mean(finer: Pixels) -> NDArray[np.float32]:
    """Return the mean (height, width, 4) of finer pixels (height, n, width, n, 4). Their colours are multiplied by their
    opacity.
    """
    sums = np.zeros((len(finer), finer.shape[2], 4), np.uint16)
    for row in range(finer.shape[1]):
        for column in range(finer.shape[3]):
            sums += finer[:, row, :, column]
    return sums.astype(np.float32) / np.float32(finer.shape[1] * finer.shape[3])


def _on(taken: NDArray[np.float32], transparent: bool) -> Pixels:
    """Return the pixels on a transparent or a white background."""
    colours, opacity = taken[..., :3], taken[..., 3:]
    if transparent:
        colours = np.divide(255 * colours, opacity, out=np.zeros_like(colours), where=opacity > 0)
    else:
        colours, opacity = colours + 255 - opacity, np.full_like(opacity, 255)
    pixels: Pixels = np.rint(np.concatenate([colours, opacity], axis=-1)).clip(0, 255).astype(np.uint8)
    return pixels


class Animation(Enum):
    """Format of moving images; the value is the suffix of the file."""

    GIF = "gif"
    APNG = "apng"
    WEBP = "webp"


_COLOURS = 255
"""Colours of a GIF; one more is for transparency."""

_SAMPLES = 6
"""Frames from which a GIF takes its colours."""

_QUALITY = 90
"""Quality of WebP, which blurs a little."""


def write_png(pixels: Pixels, path: Path) -> None:
    """Write pixels, without opacity where all of them are opaque."""
    _image(pixels).save(path, "PNG")


def write_animation(frames: Iterable[Pixels], path: Path, kind: Animation, milliseconds: int) -> None:
    """Write frames that follow each other for ever, each for so long; a GIF is either opaque or not at a pixel."""
    images = list(map(_image, frames))
    first, *others = _of_few_colours(images) if kind is Animation.GIF else images
    shared = {"save_all": True, "append_images": others, "duration": milliseconds, "loop": 0}
    if kind is Animation.GIF:
        clear = {"transparency": _COLOURS, "disposal": 2} if "transparency" in first.info else {}
        first.save(path, "GIF", optimize=False, **shared, **clear)
    elif kind is Animation.APNG:
        first.save(path, "PNG", **shared)
    else:
        first.save(path, "WEBP", quality=_QUALITY, method=4, **shared)


def _image(pixels: Pixels) -> Image:
    from PIL import Image

    opaque = bool((pixels[..., 3] == 255).all())
    return Image.fromarray(np.ascontiguousarray(pixels[..., :3] if opaque else pixels))


def _of_few_colours(images: list[Image]) -> list[Image]:
    """Return the images in the colours that some of them have most; what is more clear than not is transparent."""
    from PIL import Image

    step = max(1, len(images) // _SAMPLES)
    some = [np.asarray(image.convert("RGB")) for image in images[::step]]
    palette = Image.fromarray(np.concatenate(some)).quantize(_COLOURS, Image.Quantize.MEDIANCUT)
    return [_in_colours(image, palette) for image in images]


def _in_colours(image: Image, palette: Image) -> Image:
    """Return an image in the colours of another one, with one more that is clear."""
    from PIL import Image

    found = image.convert("RGB").quantize(palette=palette, dither=Image.Dither.NONE)
    if image.mode != "RGBA":
        return found
    numbers = np.asarray(found).copy()
    numbers[np.asarray(image)[..., 3] < 128] = _COLOURS
    clear = Image.fromarray(numbers)
    clear.putpalette(found.getpalette() or [])
    clear.info["transparency"] = _COLOURS
    return clear


_SIZE = 760
"""Pixels of the height and the width of each view."""

_FRONT = ViewDirection((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
_SIDE = ViewDirection((0.0, -1.0, 0.0), (0.0, 0.0, 1.0))
_CORNER = ViewDirection((0.55, -0.9, 0.8), (0.0, 0.0, 1.0))


def write_picture(parts: Sequence[ScenePart], path: Path | str, apart: Sequence[ScenePart] = ()) -> None:
    """Write PNG: views along the axis, from the side and from above one corner, beside each other; then `apart`, if given.

    Each view is as large as its parts allow. Raises OutputError on a machine without OpenGL.
    """
    views = [(parts, view) for view in (_FRONT, _SIDE, _CORNER)] + ([(apart, _CORNER)] if apart else [])
    columns = 2 if len(views) == 4 else len(views)
    with studio((_SIZE, _SIZE), finer=2) as room:
        taken = [room.photograph(shown, framed(points_of(shown), view, 1.0)) for shown, view in views]
    rows = [np.concatenate(taken[start : start + columns], axis=1) for start in range(0, len(taken), columns)]
    write_png(np.concatenate(rows), Path(path))

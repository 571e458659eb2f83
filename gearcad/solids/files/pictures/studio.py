"""Studio: a window in memory in which scenes are photographed (VTK, off screen, no display needed)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Bools, Floats
from gearcad.solids.colours import Colour
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.cutaway import Cut, cut_away
from gearcad.solids.files.pictures.edges import FEATURE_ANGLE, Edges
from gearcad.solids.files.pictures.opengl import window_in_memory
from gearcad.solids.files.pictures.poly_data import line_data, poly_data
from gearcad.solids.files.pictures.views import Camera

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow

__all__ = ["Pixels", "Studio", "studio"]

Pixels = NDArray[np.uint8]
"""Rows from above, columns, and red, green, blue, opacity (height, width, 4)."""

_FINE, _LESS_FINE, _FINE_UP_TO = 3, 2, 5_000_000
"""Into how many finer pixels each way one is divided, and in pictures of more pixels than so many."""

_EDGE = (0.10, 0.11, 0.13)
_CUT = (0.96, 0.38, 0.28)
_CUT_SHARE = 0.7
"""Colour of lines; that of cut faces, and its share in them: the rest is the part's."""

_LINE = 1.3 / 900
"""Width of lines, in heights of the picture."""

_LIGHTS = (((-0.55, 0.75, 0.65), 0.66), ((0.80, 0.15, 0.55), 0.36), ((-0.25, -0.55, 0.60), 0.26))
"""Directions (right, up, towards the eye) and strengths."""

_AMBIENT, _SHINE = 0.28, 0.12


_BAND = 128
"""Rows that are computed at a time, as floats need more memory than pixels."""


@dataclass(frozen=True, eq=False)
class _Shape:
    """What is drawn of facets: surfaces, and the edges in front of them."""

    facets: Facets
    edges: Edges
    surface: Any


@dataclass(frozen=True, eq=False)
class Studio:
    """A window of `size` (width, height) in pixels. Shapes of parts that are photographed often are made once."""

    window: vtkRenderWindow
    size: tuple[int, int]
    transparent: bool
    finer: int
    shapes: dict[int, _Shape] = field(default_factory=dict)

    def photograph(self, parts: Sequence[Part], camera: Camera, cuts: Mapping[str, Cut] | None = None) -> Pixels:
        """The parts, those with a cut by their name without what that takes off."""
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
        """What stands before the camera: each pixel the mean of its finer ones."""
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

    def _actors(self, part: Part, camera: Camera, cut: Cut | None) -> Iterator[vtkActor]:
        from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

        pose = part.pose if cut is None else np.eye(4)
        shape = self._shape(part) if cut is None else _cut_shape(part, cut)
        if not len(shape.facets.faces):
            return
        lines = line_data(shape.facets.vertices, shape.edges.drawn(camera.axes[2] @ pose[:3, :3]))
        for data, colour in ((shape.surface, part.colour), (lines, _EDGE)):
            mapper, actor = vtkPolyDataMapper(), vtkActor()
            mapper.SetInputData(data)
            mapper.SetScalarVisibility(cut is not None and data is shape.surface)
            actor.SetMapper(mapper)
            actor.SetUserMatrix(_matrix(pose))
            look = actor.GetProperty()
            look.SetColor(*colour)
            if data is lines:
                look.LightingOff()
                look.SetLineWidth(max(1.0, _LINE * self.finer * min(self.size)))
            else:
                look.SetAmbient(_AMBIENT)
                look.SetSpecularColor(1, 1, 1)
                look.SetSpecular(_SHINE)
                look.SetSpecularPower(25)
            yield actor

    def _shape(self, part: Part) -> _Shape:
        key = id(part.facets)  # the shape holds the facets, so nothing else can come to this number
        if key not in self.shapes:
            self.shapes[key] = _Shape(part.facets, Edges.of(part.facets), _smoothed(part.facets))
        return self.shapes[key]


@contextmanager
def studio(size: tuple[int, int], *, transparent: bool = False, finer: int | None = None) -> Iterator[Studio]:
    """A studio for pictures of so many pixels, each divided `finer` ways (None: as fine as is good, and memory allows).

    Raises OutputError on a machine without OpenGL.
    """
    with window_in_memory(size) as window:
        yield Studio(window, size, transparent, finer or (_FINE if size[0] * size[1] <= _FINE_UP_TO else _LESS_FINE))


def _renderer(camera: Camera) -> vtkRenderer:
    """On nothing, seen without perspective."""
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


def _smoothed(facets: Facets, colours: NDArray[np.uint8] | None = None) -> Any:
    """Surfaces with normals that are smooth but for sharp edges; `colours` (m, 3) of the faces, if they have their own."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

    mesh = poly_data(facets)
    if colours is not None:
        mesh.GetCellData().SetScalars(numpy_to_vtk(colours, deep=True))
    smooth = vtkPolyDataNormals()
    smooth.SetInputData(mesh)
    smooth.SetFeatureAngle(FEATURE_ANGLE)
    smooth.ConsistencyOff()
    smooth.Update()
    return smooth.GetOutput()


def _cut_shape(part: Part, cut: Cut) -> _Shape:
    """A part in its place without what a cut takes off; it has its colours itself."""
    vertices = part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3]
    left = cut_away(Facets(vertices, part.facets.faces), cut)
    edges = Edges.of(left.facets)
    colours = _colours(part.colour, left.caps)
    return _Shape(left.facets, edges.only(~left.between(edges.ends)), _smoothed(left.facets, colours))


def _colours(colour: Colour, caps: Bools) -> NDArray[np.uint8]:
    """Red, green and blue (m, 3) of faces of a part, 0 ... 255."""
    own = np.array(colour)
    cut = _CUT_SHARE * np.array(_CUT) + (1 - _CUT_SHARE) * own
    colours: NDArray[np.uint8] = np.rint(255 * np.where(caps[:, None], cut, own)).astype(np.uint8)
    return colours


def _matrix(pose: Floats) -> Any:
    from vtkmodules.vtkCommonMath import vtkMatrix4x4

    matrix = vtkMatrix4x4()
    matrix.DeepCopy(pose.ravel().tolist())
    return matrix


def _mean(finer: Pixels) -> NDArray[np.float32]:
    """Of finer pixels (height, n, width, n, 4); their colours are multiplied by their opacity."""
    sums = np.zeros((len(finer), finer.shape[2], 4), np.uint16)
    for row in range(finer.shape[1]):
        for column in range(finer.shape[3]):
            sums += finer[:, row, :, column]
    return sums.astype(np.float32) / np.float32(finer.shape[1] * finer.shape[3])


def _on(taken: NDArray[np.float32], transparent: bool) -> Pixels:
    """The pixels on nothing, or on white."""
    colours, opacity = taken[..., :3], taken[..., 3:]
    if transparent:
        colours = np.divide(255 * colours, opacity, out=np.zeros_like(colours), where=opacity > 0)
    else:
        colours, opacity = colours + 255 - opacity, np.full_like(opacity, 255)
    pixels: Pixels = np.rint(np.concatenate([colours, opacity], axis=-1)).clip(0, 255).astype(np.uint8)
    return pixels

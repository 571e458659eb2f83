"""Studio: a window in memory in which scenes are photographed (VTK, off screen, no display needed)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.solids.colours import Colour
from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.cutaway import Cut
from gearcad.solids.files.pictures.opengl import window_in_memory
from gearcad.solids.files.pictures.shapes import Shape, cut_shape, whole_shape
from gearcad.solids.files.pictures.views import Camera

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow

__all__ = ["Pixels", "Studio", "studio"]

Pixels = NDArray[np.uint8]
"""Rows from above, columns, and red, green, blue, opacity (height, width, 4)."""

_FINE, _LESS_FINE, _FINE_UP_TO = 3, 2, 5_000_000
"""Into how many finer pixels each way one is divided, and in pictures of more pixels than so many."""

_EDGE = (0.10, 0.11, 0.13)
"""Colour of lines."""

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
    shapes: dict[int, Shape] = field(default_factory=dict)

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

    def _shape(self, part: Part) -> Shape:
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

"""PNG: a scene as it looks from the front, from the side and from above one corner, off screen through VTK."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.files.part import Part

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow

__all__ = ["write_picture"]

_SIZE = 760
"""Pixels of the height and the width of each view."""

_FEATURE_ANGLE = 25.0
"""Degrees between faces from which on their edge is drawn, and not smoothed."""

_EDGE = (0.12, 0.13, 0.15)
_LIGHTS = (((-0.6, -0.9, 1.3), 0.85), ((0.9, -0.7, 0.5), 0.55), ((0.0, 1.0, 0.4), 0.3))
"""Directions and strengths."""

_MARGIN = 1.06


class _View(NamedTuple):
    """From where one looks, and what is up."""

    eye: tuple[float, float, float]
    up: tuple[float, float, float]


_FRONT = _View((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
_SIDE = _View((0.0, -1.0, 0.0), (0.0, 0.0, 1.0))
_CORNER = _View((0.55, -0.9, 0.8), (0.0, 0.0, 1.0))


def write_picture(parts: Sequence[Part], path: Path | str, apart: Sequence[Part] = ()) -> None:
    """Write PNG: views along the axis, from the side and from above one corner, beside each other; then `apart`, if given.

    Each view is as large as its parts allow.
    """
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

    views = [(parts, view) for view in (_FRONT, _SIDE, _CORNER)] + ([(apart, _CORNER)] if apart else [])
    columns = 2 if len(views) == 4 else len(views)
    rows = len(views) // columns
    surfaces: dict[int, Any] = {}
    with _window(columns * _SIZE, rows * _SIZE) as window:
        for number, (shown, view) in enumerate(views):
            column, row = number % columns, rows - 1 - number // columns
            renderer = _rendered(shown, view, surfaces)
            renderer.SetViewport(column / columns, row / rows, (column + 1) / columns, (row + 1) / rows)
            window.AddRenderer(renderer)
        window.Render()
        image, writer = vtkWindowToImageFilter(), vtkPNGWriter()
        image.SetInput(window)
        image.ReadFrontBufferOff()
        writer.SetFileName(str(path))
        writer.SetInputConnection(image.GetOutputPort())
        writer.Write()


@contextmanager
def _window(width: int, height: int) -> Iterator[vtkRenderWindow]:
    """A window of so many pixels in memory, without what VTK says of a machine that has no screen."""
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the renderer
    from vtkmodules.vtkCommonCore import vtkLogger
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    window = vtkRenderWindow()
    try:
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(8)
        window.SetSize(width, height)
        yield window
    finally:
        window.Finalize()
        vtkLogger.SetStderrVerbosity(before)


def _rendered(parts: Sequence[Part], view: _View, surfaces: dict[int, Any]) -> vtkRenderer:
    """Parts on white, seen without perspective, filling the view."""
    from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer

    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for part in parts:
        for actor in _actors(part, surfaces):
            renderer.AddActor(actor)
    for direction, strength in _LIGHTS:
        light = vtkLight()
        light.SetLightTypeToCameraLight() if view is not _CORNER else light.SetLightTypeToSceneLight()
        light.SetPosition(*direction)
        light.SetIntensity(strength)
        light.PositionalOff()
        renderer.AddLight(light)
    middle, half = _framed(parts, view)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + 10 * half * np.array(view.eye)))
    camera.SetViewUp(*view.up)
    camera.SetParallelScale(half)
    renderer.ResetCameraClippingRange()
    return renderer


def _framed(parts: Sequence[Part], view: _View) -> tuple[Floats, float]:
    """The point in the middle of a view, and half of the view's height (mm)."""
    ahead = -np.array(view.eye) / np.linalg.norm(view.eye)
    right = np.cross(ahead, view.up)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(right, ahead), ahead])
    seen = np.concatenate([(part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3]) @ axes.T for part in parts])
    low, high = seen.min(axis=0), seen.max(axis=0)
    return (low + high) / 2 @ axes, _MARGIN * float((high - low)[:2].max()) / 2


def _actors(part: Part, surfaces: dict[int, Any]) -> list[vtkActor]:
    """A shaded body and its sharp edges; what of them is of the facets alone is made once."""
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    if id(part.facets) not in surfaces:
        surfaces[id(part.facets)] = _surface(part)
    place = part.pose
    made = []
    for source, shade in zip(surfaces[id(part.facets)], (part.colour, _EDGE), strict=True):
        mapper, actor = vtkPolyDataMapper(), vtkActor()
        mapper.SetInputConnection(source.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor.SetMapper(mapper)
        actor.SetPosition(*place[:3, 3])
        actor.RotateZ(part.rotation)
        actor.GetProperty().SetColor(*shade)
        made.append(actor)
    made[0].GetProperty().SetSpecular(0.35)
    made[0].GetProperty().SetSpecularPower(25)
    return made


def _surface(part: Part) -> tuple[Any, Any]:
    """Smoothed facets, and the edges between those that meet sharply."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkPolyDataNormals

    mesh, places, triangles = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(part.facets.vertices), deep=True))
    triangles.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(part.facets.faces, np.int64).ravel(), deep=True))
    mesh.SetPoints(places)
    mesh.SetPolys(triangles)
    smooth, edges = vtkPolyDataNormals(), vtkFeatureEdges()
    for each in (smooth, edges):
        each.SetInputData(mesh)
        each.SetFeatureAngle(_FEATURE_ANGLE)
    edges.BoundaryEdgesOff()
    edges.ColoringOff()
    return smooth, edges

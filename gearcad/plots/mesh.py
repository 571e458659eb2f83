"""Pictures of meshes: sections with all their elements, bodies as they are seen from outside."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.meshing.bodies.elements import Shape
from gearcad.meshing.bodies.mesh import ElementMesh
from gearcad.plots.paper import DARK, GEARS, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot_body_mesh", "plot_mesh", "plot_section_mesh"]


_FILLS = {"pinion": GEARS.pinion[1], "wheel": GEARS.wheel[1], "gear": GEARS.pinion[1]}
"""Colours of the parts."""

_PALE = 0.22
"""How much of its colour a part's elements have: lines are to be seen on them."""

_SHADES = {"flank": "#5b9bd0", "fillet": "#f0a35e", "root": "#d9c27a", "tip": "#8fb996", "": "#d5d9dd"}
"""Colours of the sides of a body, by what their names hold; "" of all others."""

_LIGHT = np.array([-0.45, 0.55, 0.7])
"""From where light falls on a body, as it is seen: to the right, up, towards us."""

_EDGE_ON = 1e-9
"""Faces whose normal has less than this towards us are not seen."""

_DIM = 0.45
"""Brightness of what light does not reach."""


def plot_mesh(mesh: ElementMesh, ax: Axes | None = None) -> Axes:
    """All elements of a section, or the surface of a body."""
    return (plot_body_mesh if mesh.element.shape.dimension == 3 else plot_section_mesh)(mesh, ax)


def plot_section_mesh(mesh: ElementMesh, ax: Axes | None = None, *, window: tuple[float, float, float] | None = None) -> Axes:
    """All elements of a section, curved as they are, each part in its colour.

    `window` is the middle (x, y) of what is shown and half its height, in mm; None shows all. Elements outside are left out.
    """
    from matplotlib.collections import PolyCollection

    axes = new_figure((6.6, 6.6)).subplots() if ax is None else ax
    rim = _rim(mesh.element.shape)
    for name, part in mesh.parts.items():
        outlines = mesh.points[mesh.cells[part][:, rim], :2]
        if window is not None:
            near = np.abs(outlines - np.array(window[:2])).max(axis=(1, 2)) < 3 * window[2]
            outlines = outlines[near]
        colour = _FILLS.get(name, DARK)
        drawn = PolyCollection(list(outlines), facecolors=[_mixed(colour, _PALE)], edgecolors=colour)
        drawn.set_linewidth(_width(len(outlines)))
        axes.add_collection(drawn)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.01)
    if window is not None:
        x, y, half = window
        corners = axes.get_position()
        figure = axes.figure.bbox
        wide = half * corners.width * figure.width / (corners.height * figure.height)
        axes.set_xlim(x - wide, x + wide)
        axes.set_ylim(y - half, y + half)
    axes.set_axis_off()
    return axes


def plot_body_mesh(mesh: ElementMesh, ax: Axes | None = None, *, yaw: float = 35.0, pitch: float = 30.0) -> Axes:
    """The surface of a body with the edges of its elements, seen from `yaw` (deg, about its axis) and `pitch` above its end.

    Flanks, fillets, roots and tips have colours of their own.
    """
    from matplotlib.collections import PolyCollection

    axes = new_figure((6.6, 6.6)).subplots() if ax is None else ax
    outlines, colours = [], []
    look = _look(yaw, pitch)
    for name in mesh.sides:
        seen = mesh.points[mesh.face_cells(name)] @ look.T
        normals = _normals(seen)
        front = normals[:, 2] > _EDGE_ON
        outlines.append(seen[front][:, _rim_of_face(seen.shape[1])])
        colours.append(_shaded(_colour(name), normals[front]))
    polygons, shades = np.concatenate(outlines), np.concatenate(colours)
    order = np.argsort(polygons[:, :, 2].mean(axis=1), kind="stable")
    drawn = PolyCollection(list(polygons[order, :, :2]), facecolors=shades[order], edgecolors=DARK)
    drawn.set_linewidth(_width(len(order)))
    axes.add_collection(drawn)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.01)
    axes.set_axis_off()
    return axes


def _rim(shape: Shape) -> list[int]:
    """Nodes of a plane element all round: vertices and those between them in turn."""
    return [node for k in range(shape.vertices) for node in (k, shape.vertices + k)]


def _rim_of_face(nodes: int) -> list[int]:
    """The same of a face of a body."""
    vertices = nodes if nodes == 4 else nodes // 2
    return list(range(4)) if nodes == 4 else [node for k in range(vertices) for node in (k, vertices + k)]


def _width(elements: int) -> float:
    """Width of lines (points), thinner where there are many."""
    return float(np.clip(18 / math.sqrt(max(elements, 1)), 0.08, 0.6))


def _look(yaw: float, pitch: float) -> Floats:
    """Axes (3, 3) to the right, up and towards us of a body whose axis of rotation is z, x to the right at yaw 0."""
    a, b = math.radians(yaw), math.radians(pitch)
    right = np.array([math.cos(a), math.sin(a), 0.0])
    towards = np.array([math.sin(a) * math.cos(b), -math.cos(a) * math.cos(b), math.sin(b)])
    return np.stack([right, np.cross(towards, right), towards])


def _normals(faces: Floats) -> Floats:
    """Unit normals (n, 3) outwards of faces (n, nodes, 3) by their first three vertices."""
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    result: Floats = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    return result


def _colour(side: str) -> str:
    return next(colour for word, colour in _SHADES.items() if word in side)


def _mixed(colour: str, share: float) -> tuple[float, ...]:
    """A colour with white."""
    from matplotlib.colors import to_rgb

    return tuple(1 - share * (1 - channel) for channel in to_rgb(colour))


def _shaded(colour: str, normals: Floats) -> Floats:
    """Colours (n, 3) of faces by their normals (n, 3)."""
    from matplotlib.colors import to_rgb

    light = np.maximum(normals @ (_LIGHT / np.linalg.norm(_LIGHT)), 0.0)
    bright = _DIM + (1 - _DIM) * light
    result: Floats = np.clip(bright[:, None] * np.array(to_rgb(colour)) * 1.15, 0, 1)
    return result

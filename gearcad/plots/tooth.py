"""A still picture of the surface of a solid tooth sector coloured by its stress."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.solid.pictures import ToothSurface
from gearcad.plots.paper import new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["COLOUR_MAP", "PITCH", "YAW", "plot_tooth", "viewed"]


COLOUR_MAP = "viridis"

YAW, PITCH = 50.0, 25.0
"""From where a tooth is looked at (deg): turned about its height so that the loaded flank shows, and tilted towards us."""

_AXES = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""To the right, up and towards us, of a tooth seen along its axis: it stands upright."""


def viewed(points: Floats) -> Floats:
    """Points (n, 3) as they are seen: to the right, up, and towards us."""
    yaw, pitch = math.radians(YAW), math.radians(PITCH)
    turn = np.array([[math.cos(yaw), 0, math.sin(yaw)], [0, 1, 0], [-math.sin(yaw), 0, math.cos(yaw)]])
    tilt = np.array([[1, 0, 0], [0, math.cos(pitch), -math.sin(pitch)], [0, math.sin(pitch), math.cos(pitch)]])
    result: Floats = points @ (tilt @ turn @ _AXES).T
    return result


def plot_tooth(surface: ToothSurface, ax: Axes | None = None) -> Axes:
    """A still picture: triangles that face us, the farthest first."""
    from matplotlib.collections import PolyCollection

    axes = new_figure().subplots() if ax is None else ax
    seen = viewed(surface.points)[surface.triangles]
    normals = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    order = np.argsort(seen[:, :, 2].mean(axis=1))
    order = order[normals[order, 2] > 0]
    values = surface.von_mises[surface.triangles].mean(axis=1)
    drawn = PolyCollection(list(seen[order, :, :2]), array=values[order], cmap=COLOUR_MAP, edgecolors="face", linewidths=0.3)
    drawn.set_clim(0, surface.most)
    axes.add_collection(drawn)
    axes.figure.colorbar(drawn, ax=axes, label="von Mises stress in MPa", extend="max")
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()
    return axes

"""The surface of a solid tooth sector coloured by its stress: its triangles, and a still picture of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.check.solid.result import SolidCheck
from gearcad.contact.solid.field import shown_stress, worst_field
from gearcad.per_gear import Role
from gearcad.plots.paper import new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["COLOUR_MAP", "PITCH", "YAW", "ToothSurface", "plot_tooth", "tooth_surface", "viewed"]


COLOUR_MAP = "viridis"

YAW, PITCH = 50.0, 25.0
"""From where a tooth is looked at (deg): turned about its height so that the loaded flank shows, and tilted towards us."""

_BELOW = 2.0
"""How much of the body below the root circle is shown, in normal modules."""

_PARTS = np.array([[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6], [4, 5, 6], [4, 6, 7]])
"""A face of four corners and four middles in triangles."""

_AXES = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""To the right, up and towards us, of a tooth seen along its axis: it stands upright."""


@dataclass(frozen=True)
class ToothSurface:
    """Points (n, 3) in mm from the middle of the sector, triangles (m, 3) seen from outside, von Mises stress (n,) in MPa.

    Colours end at `most` (MPa), a little above the greatest of the fillets.
    """

    points: Floats
    triangles: Wholes
    von_mises: Floats
    most: float


def tooth_surface(result: SolidCheck, role: Role) -> ToothSurface:
    """The most stressed tooth of a gear, with the body just below it."""
    field, own = worst_field(result.cycle, role), result.pair.gears.pick(role)
    faces = field.above(own.root_diameter / 2 - _BELOW * own.normal_module).surface
    used, index = np.unique(faces, return_inverse=True)
    triangles = index.reshape(faces.shape)[:, _PARTS].reshape(-1, 3)
    points, stress = field.points[used], field.von_mises[used]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    return ToothSurface(points - middle, triangles, stress, shown_stress(result.cycle, role, field))


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

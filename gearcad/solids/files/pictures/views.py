"""Which way one looks at a scene, and what of it fills the picture."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.files.part import Part

__all__ = ["Camera", "Direction", "View", "close_up", "framed", "points_of"]

_MARGIN = 1.06
"""The picture's extent over that of what it shows."""


class View(Enum):
    """From where a scene is seen: above one corner, along the axes, from the right, from above (as a sheet's views are), and
    close by, along the axes, where teeth mesh.
    """

    CORNER = "corner"
    FRONT = "front"
    SIDE = "side"
    TOP = "top"
    MESH = "mesh"


class Direction(NamedTuple):
    """Where the eye is, seen from the scene, and what is up in the picture."""

    eye: tuple[float, float, float]
    up: tuple[float, float, float]

    @property
    def axes(self) -> Floats:
        """Right, up and towards the eye, as unit vectors (3, 3)."""
        towards = np.array(self.eye) / np.linalg.norm(self.eye)
        right = np.cross(self.up, towards)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(towards, right), towards])


@dataclass(frozen=True, eq=False)
class Camera:
    """An eye without perspective: `axes` (3, 3) right, up and towards the eye, the point (3,) in the middle of the picture,
    half of what it shows in height, and a `distance` from that point at which nothing is behind the eye (mm).
    """

    axes: Floats
    middle: Floats
    half_height: float
    distance: float


def framed(points: Floats, direction: Direction, aspect: float) -> Camera:
    """The camera that has all points (n, 3) in a picture of width over height `aspect`, with a margin."""
    axes = direction.axes
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    width, height, depth = high - low
    return Camera(axes, (low + high) / 2 @ axes, _MARGIN * max(float(height), float(width) / aspect) / 2, float(depth))


def close_up(points: Floats, direction: Direction, place: tuple[float, float], half_height: float) -> Camera:
    """The camera above all points (n, 3) that looks down on a place (x, y), and sees so much (mm) above and below it."""
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    return Camera(direction.axes, np.array([*place, high]), half_height, high - low)


def points_of(parts: Iterable[Part]) -> Floats:
    """All points (n, 3) of parts in their places."""
    return np.concatenate([part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3] for part in parts])

"""Places on the loaded flank of a solid tooth: its exact shape there, grids of them, and splines between those."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.engaged import LoadedFlank

__all__ = ["Grid", "GridSpline", "Places", "SolidFlank"]


Places = tuple[Floats, Floats]
"""Roll lengths (n,) and heights z (n,) of places on a flank, in mm."""


@dataclass(frozen=True)
class SolidFlank(LoadedFlank):
    """The loaded flank over the face width, turned by `rate` (rad/mm); places on it are roll lengths and heights z (mm)."""

    rate: float

    @property
    def helix(self) -> float:
        """Base helix angle (rad), signed."""
        return math.radians(self.gear.base_helix_angle)

    def points(self, places: Places) -> Floats:
        """Points (n, 3) in space (mm)."""
        length, z = np.broadcast_arrays(*places)
        radius, start = self.polar(length)
        angle = start + self.rate * z
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)

    def inward(self, places: Places) -> Floats:
        """Unit normals (n, 3) into the tooth."""
        length, z = np.broadcast_arrays(*places)
        heading = self.heading(length) + self.rate * z
        flat, rise = math.cos(self.helix), math.sin(self.helix)
        return np.stack([flat * np.sin(heading), -flat * np.cos(heading), np.full(heading.shape, rise)], -1)


@dataclass(frozen=True)
class Grid:
    """Places on the flank in rows and columns: roll lengths (rows,) and heights (columns,); a place is column * rows + row."""

    lengths: Floats
    heights: Floats

    @property
    def places(self) -> Places:
        """Roll lengths and heights (rows x columns,) of all places, column by column."""
        return np.tile(self.lengths, len(self.heights)), np.repeat(self.heights, len(self.lengths))


class GridSpline:
    """Bicubic spline through a grid as weights on its values, in coordinates spread out towards tip and end faces.

    Near an edge of the flank the response varies like the logarithm of the distance from it.
    """

    def __init__(self, grid: Grid, tip: float, corner: float, width: float) -> None:
        from scipy.interpolate import CubicSpline

        self._tip, self._corner, self._width = tip, corner, width
        self._margin = width / 20
        rows, columns = self._up(grid.lengths), self._along(grid.heights)
        self._rows = CubicSpline(rows, np.eye(len(rows)))
        self._columns = CubicSpline(columns, np.eye(len(columns)))
        self._bounds = ((grid.lengths[0], min(grid.lengths[-1], tip - corner / 2)), (grid.heights[0], grid.heights[-1]))

    def _up(self, lengths: Floats) -> Floats:
        result: Floats = -np.log(np.maximum(self._tip - lengths, 0) + self._corner)
        return result

    def _along(self, heights: Floats) -> Floats:
        result: Floats = np.log((heights + self._margin) / (self._width - heights + self._margin))
        return result

    def weights(self, places: Places) -> Floats:
        """Weights (n, places of the grid) at places."""
        (low, high), (back, front) = self._bounds
        rows = self._rows(self._up(np.clip(places[0], low, high)))
        columns = self._columns(self._along(np.clip(places[1], back, front)))
        result: Floats = (columns[:, :, None] * rows[:, None, :]).reshape(len(rows), -1)
        return result

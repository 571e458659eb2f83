"""Least distances of points from what the outline of a tooth sweeps, by search: no formula of a parallel is used."""

from __future__ import annotations

import numpy as np

from gearcad.geometry import Gear


def nearest(gear: Gear, scale: float, points: np.ndarray, twist: float = 0.0) -> np.ndarray:
    """Return least distances (n,) in mm of points in the section z = 0 from what the scaled nominal outline sweeps.

    Places along each curve and, of helical teeth, heights are searched on a grid that shrinks about its best point.
    """
    best = np.full(len(points), np.inf)
    heights = np.linspace(-1.0, 1.0, 41 if twist else 1) if twist else np.zeros(1)
    for curve in gear.profile.curves:
        s, z = np.full(len(points), 0.5), np.zeros(len(points))
        reach_s, reach_z = 0.5, 0.6
        least = np.full(len(points), np.inf)
        for step in range(30):
            grid_s = np.clip(s[:, None] + reach_s * np.linspace(-1, 1, 201 if step == 0 else 21), 0, 1)
            grid_z = z[:, None] + reach_z * heights[:: 1 if step == 0 else 2]
            radius, angle = (each[:, :, None] for each in curve.polar(grid_s))
            turned = angle + twist * grid_z[:, None, :]
            x, y = scale * radius * np.cos(turned), scale * radius * np.sin(turned)
            away = np.sqrt((x - points[:, 0, None, None]) ** 2 + (y - points[:, 1, None, None]) ** 2 + grid_z[:, None, :] ** 2)
            flat = away.reshape(len(points), -1).argmin(axis=1)
            i, j = np.unravel_index(flat, away.shape[1:])
            rows = np.arange(len(points))
            least, s, z = away[rows, i, j], grid_s[rows, i], grid_z[rows, j]
            reach_s, reach_z = reach_s * (0.03 if step == 0 else 0.35), reach_z * 0.35
        best = np.minimum(best, least)
    return best

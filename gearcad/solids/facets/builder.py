"""What all gears of triangles have in common: vertices and faces as they are added, and the side of the teeth."""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.solids.facets.sampling import ToothGrid
from gearcad.solids.facets.tolerance import arc_step

__all__ = ["LEAST_SIDES", "Builder", "wall"]


LEAST_SIDES = 8
"""A hole keeps at least so many sides, however small it is."""


class Builder:
    """Collects the vertices and faces of one gear."""

    def __init__(self, gear: Gear, grid: ToothGrid, chord_error: float) -> None:
        self.gear, self.grid, self.chord_error = gear, grid, chord_error
        self.vertices: list[Floats] = []
        self.faces: list[Wholes] = []
        self.count = 0

    def add(self, points: Floats) -> Wholes:
        """Append points (n, 3); their vertex numbers."""
        self.vertices.append(points)
        self.count += len(points)
        return np.arange(self.count - len(points), self.count)

    def side(self) -> Wholes:
        """The faces of all teeth, away from the axis: layers x teeth x period, every cell cut along its better diagonal."""
        grid, layers = self.grid, self.grid.layers
        radius, setback, angle = grid.outline
        z = layers.heights(setback)[:, None, :]
        turn = angle[:, None, :] + 2 * np.pi / grid.teeth * np.arange(grid.teeth)[:, None] + layers.turn(z)
        x, y, z = np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), z)
        numbers = self.add(np.stack([x, y, z], -1).reshape(-1, 3)).reshape(layers.count + 1, -1)
        a, d = numbers[:-1], numbers[1:]
        b, c = np.roll(a, -1, axis=1), np.roll(d, -1, axis=1)
        falling = np.tile(grid.falling_cells, grid.teeth)
        first = np.stack([a, b, np.where(falling, d, c)], -1)
        second = np.stack([np.where(falling, b, a), c, d], -1)
        faces: Wholes = np.stack([first, second], -2).reshape(-1, 3)
        return faces

    def circle(self, radius: float, parts: int = 1) -> Floats:
        """Points (n, 2) in mm of a regular polygon about the axis, from the far side; sides that would do in `parts` each."""
        sides = parts * max(LEAST_SIDES, math.ceil(2 * math.pi / arc_step(radius, self.chord_error)))
        angle = -np.pi + 2 * np.pi / sides * np.arange(sides)
        return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def wall(low: Wholes, high: Wholes) -> Wholes:
    """Wall between two equal rings, facing away from the axis."""
    following, above = np.roll(low, -1), np.roll(high, -1)
    return np.concatenate([np.stack([low, following, above], -1), np.stack([low, above, high], -1)])

"""Turning: how the axles of a scene turn, and the same as an animation of glTF 2.0."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.files.gltf import Arrays

__all__ = ["Turning", "quaternions"]

_STEP = 1 / 24
"""Largest turn between two keyframes: 15 degrees, over which viewers that interpolate quaternions without the sphere still
turn within 0.01 degrees; beyond half a turn all would take the short way round."""


@dataclass(frozen=True, kw_only=True)
class Turning:
    """Even rotation about upright axes over `duration` seconds: `turns` of the axles by name, seen from what carries each.

    Positive is counter-clockwise seen from +z.
    """

    duration: float
    turns: Mapping[str, float]

    def turns_of(self, name: str) -> float:
        """Of an axle by its name; nothing else turns."""
        return self.turns.get(name, 0.0)

    def keyframes(self) -> Floats:
        """Shares of the duration (n,) from 0 to 1."""
        most = max((abs(turns) for turns in self.turns.values()), default=0.0)
        return np.linspace(0.0, 1.0, math.ceil(most / _STEP) + 2)

    def animation(self, begins: Mapping[int, tuple[str, float]], arrays: Arrays) -> dict[str, Any]:
        """A sampler of quaternions and a channel for each node, by its number: what it is called and its angle (rad) at 0 s."""
        shares = self.keyframes()
        times = arrays.add(shares * self.duration)
        samplers: list[dict[str, Any]] = []
        channels: list[dict[str, Any]] = []
        for node, (name, begin) in begins.items():
            values = arrays.add(quaternions(begin + 2 * math.pi * self.turns_of(name) * shares))
            channels.append({"sampler": len(samplers), "target": {"node": node, "path": "rotation"}})
            samplers.append({"input": times, "output": values, "interpolation": "LINEAR"})
        return {"name": "turning", "channels": channels, "samplers": samplers}


def quaternions(angles: Floats) -> Floats:
    """Rotations (n, 4) about z: x, y, z, w. Neighbours that are close turn the short way, as their halves are close too."""
    half = 0.5 * angles
    zero = np.zeros_like(half)
    return np.stack([zero, zero, np.sin(half), np.cos(half)], -1)

"""Turning: how the axles of a scene turn, and the same as an animation of glTF 2.0."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcad.arrays import Floats

__all__ = ["Turning", "add_animation"]

_STEP = 1 / 24
"""Largest turn between two keyframes: 15 degrees, over which viewers that interpolate quaternions without the sphere still
turn within 0.01 degrees; beyond half a turn all would take the short way round."""

_FLOAT = 5126
"""A component type of glTF."""


@dataclass(frozen=True, kw_only=True)
class Turning:
    """Even rotation about upright axes over `duration` seconds: `turns` of the axles by name, seen from what carries each.

    Positive is counter-clockwise seen from +z.
    """

    duration: float
    turns: Mapping[str, float]

    def keyframes(self) -> Floats:
        """Shares of the duration (n,) from 0 to 1."""
        most = max((abs(turns) for turns in self.turns.values()), default=0.0)
        return np.linspace(0.0, 1.0, math.ceil(most / _STEP) + 2)


def add_animation(buffers: dict[Any, bytes], tree: dict[str, Any], *, turning: Turning) -> None:
    """Let the nodes of glTF that are called as axles turn: a sampler of quaternions and a channel for each.

    `buffers` and `tree` are as trimesh has them before it writes: an accessor, or a buffer, for each key in order.
    """
    shares = turning.keyframes()
    times = _accessor(buffers, tree, "times", shares * turning.duration)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for number, node in enumerate(tree["nodes"]):
        turns = turning.turns.get(node["name"], 0.0)
        if not turns:
            continue
        start = _unfold(node)
        values = _accessor(buffers, tree, f"turns of {node['name']}", _quaternions(start + 2 * math.pi * turns * shares))
        channels.append({"sampler": len(samplers), "target": {"node": number, "path": "rotation"}})
        samplers.append({"input": times, "output": values, "interpolation": "LINEAR"})
    if channels:
        tree["animations"] = [{"name": "turning", "channels": channels, "samplers": samplers}]


def _unfold(node: dict[str, Any]) -> float:
    """Give a node translation and rotation for its matrix, which animated ones must not have; the angle about z (rad)."""
    matrix = np.array(node.pop("matrix", np.eye(4).ravel())).reshape(4, 4).T
    angle = math.atan2(matrix[1, 0], matrix[0, 0])
    node["translation"] = matrix[:3, 3].tolist()
    node["rotation"] = _quaternions(np.array([angle]))[0].tolist()
    return angle


def _quaternions(angles: Floats) -> Floats:
    """Rotations (n, 4) about z: x, y, z, w. Neighbours that are close turn the short way, as their halves are close too."""
    half = 0.5 * angles
    zero = np.zeros_like(half)
    return np.stack([zero, zero, np.sin(half), np.cos(half)], -1)


def _accessor(buffers: dict[Any, bytes], tree: dict[str, Any], key: str, values: Floats) -> int:
    """The number of an accessor of these values, (n,) or (n, 4)."""
    single = values.astype("<f4")
    buffers[key] = single.tobytes()
    tree["accessors"][key] = {
        "bufferView": len(buffers) - 1,
        "componentType": _FLOAT,
        "count": len(single),
        "type": "SCALAR" if single.ndim == 1 else "VEC4",
        "min": np.atleast_1d(single.min(axis=0)).tolist(),
        "max": np.atleast_1d(single.max(axis=0)).tolist(),
    }
    return len(tree["accessors"]) - 1

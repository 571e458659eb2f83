"""GLB read by hand: where every node is at a time of an animation, by the rules of glTF 2.0 alone."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.core.records import Floats

_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_TYPES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


class Glb:
    """A file: `tree` is its JSON."""

    def __init__(self, path: Path) -> None:
        content = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        chunks, at = {}, 12
        while at < length:
            size, kind = struct.unpack_from("<II", content, at)
            assert size % 4 == 0
            chunks[kind] = content[at + 8 : at + 8 + size]
            at += 8 + size
        self.tree: dict[str, Any] = json.loads(chunks[_JSON])
        self._binary = chunks[_BINARY]
        assert self.tree["buffers"][0]["byteLength"] <= len(self._binary)

    def values(self, number: int) -> Floats:
        """An accessor of single precision, (n, k); its least and most are as it says."""
        accessor = self.tree["accessors"][number]
        view = self.tree["bufferViews"][accessor["bufferView"]]
        assert accessor["componentType"] == 5126
        width = _TYPES[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        assert start % 4 == 0 and accessor["count"] * width * 4 <= view["byteLength"]
        found = np.frombuffer(self._binary, "<f4", accessor["count"] * width, start).reshape(-1, width)
        if "min" in accessor:
            np.testing.assert_array_equal(found.min(axis=0), np.float32(accessor["min"]))
            np.testing.assert_array_equal(found.max(axis=0), np.float32(accessor["max"]))
        return found.astype(float)

    @property
    def duration(self) -> float:
        """Of the only animation (s)."""
        (animation,) = self.tree["animations"]
        return max(float(self.values(sampler["input"])[-1, 0]) for sampler in animation["samplers"])

    def places(self, time: float) -> dict[str, Floats]:
        """Places (4, 4) of all nodes beneath the first at a time (s), as seen from there."""
        turned = self._turned(time) if "animations" in self.tree else {}
        nodes, found = self.tree["nodes"], {}

        def visit(number: int, parent: Floats) -> None:
            node = nodes[number]
            place = parent @ _place(node, turned.get(number))
            found[node["name"]] = place
            for child in node.get("children", ()):
                visit(child, place)

        (root,) = self.tree["scenes"][0]["nodes"]
        for child in nodes[root]["children"]:
            visit(child, np.eye(4))
        return found

    def turned(self, name: str, time: float) -> float:
        """How far (degrees) a node has turned about z until then, the short way from keyframe to keyframe."""
        (animation,) = self.tree["animations"]
        for channel in animation["channels"]:
            if self.tree["nodes"][channel["target"]["node"]]["name"] == name:
                sampler = animation["samplers"][channel["sampler"]]
                times, keys = self.values(sampler["input"])[:, 0], self.values(sampler["output"])
                angles = 2 * np.degrees(np.arctan2(keys[:, 2], keys[:, 3]))
                steps = (np.diff(angles) + 180) % 360 - 180
                return float(np.interp(time, times, np.r_[0.0, np.cumsum(steps)]))
        return 0.0

    def _turned(self, time: float) -> dict[int, Floats]:
        """Quaternions of animated nodes, on the great circle between their keyframes."""
        (animation,) = self.tree["animations"]
        found = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            assert (sampler["interpolation"], channel["target"]["path"]) == ("LINEAR", "rotation")
            node = channel["target"]["node"]
            assert "matrix" not in self.tree["nodes"][node]
            times, keys = self.values(sampler["input"])[:, 0], self.values(sampler["output"])
            after = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1))
            share = (time - times[after - 1]) / (times[after] - times[after - 1])
            found[node] = _slerp(keys[after - 1], keys[after], share)
        return found


def _slerp(one: Floats, other: Floats, share: float) -> Floats:
    """Always the short way."""
    cosine = float(one @ other)
    other = other if cosine >= 0 else -other
    angle = np.arccos(min(abs(cosine), 1.0))
    if angle < 1e-9:
        return one
    return (np.sin((1 - share) * angle) * one + np.sin(share * angle) * other) / np.sin(angle)


def _place(node: dict[str, Any], rotation: Floats | None) -> Floats:
    if "matrix" in node:
        return np.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1)) if rotation is None else rotation
    place = np.eye(4)
    place[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    place[:3, 3] = node.get("translation", (0, 0, 0))
    return place

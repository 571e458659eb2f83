"""GLB: a scene for viewers, which may turn. Equal input gives equal bytes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.axle import Axle
from gearcad.solids.files.gltf import Arrays, glb_bytes
from gearcad.solids.files.part import Part
from gearcad.solids.files.turning import Turning, quaternions

__all__ = ["write_glb"]

_ROOT = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])
"""From millimetres with z up to the metres with y up that glTF prescribes."""

_METALLIC, _ROUGHNESS = 0.6, 0.45
_TRIANGLES = 4
"""A mode of glTF."""

_SHADES = 255
"""Steps of a colour of a material, as of one on a screen."""


def write_glb(parts: Sequence[Part], path: Path | str, turning: Turning | None = None) -> None:
    """Write every part as a named, coloured body in its place, and how they turn.

    glTF knows only metres with y up, so the data stay in mm with z up, and the node "gearcad" above all parts scales by
    0.001 and turns z to y: viewers and Blender show true size and posture. Axles are nodes, those they carry beneath them.
    """
    arrays, shapes = Arrays(), _Shapes()
    nodes: list[dict[str, Any]] = [{"name": "gearcad", "matrix": _listed(_ROOT), "children": []}]
    axles: dict[str, int] = {}
    begins: dict[int, tuple[str, float]] = {}
    for name, parent, place, part in _nodes(parts):
        number = len(nodes)
        nodes[0 if parent is None else axles[parent]].setdefault("children", []).append(number)
        node: dict[str, Any] = {"name": name}
        if turning is not None and turning.turns_of(name):
            begins[number] = name, _angle(place)
            node |= _unfolded(place)
        elif not np.array_equal(place, np.eye(4)):
            node["matrix"] = _listed(place)
        if part is not None:
            node["mesh"] = shapes.number_of(part, arrays)
        axles.setdefault(name, number)
        nodes.append(node)
    tree: dict[str, Any] = {"asset": {"version": "2.0", "generator": "gearcad"}, "scene": 0, "scenes": [{"nodes": [0]}]}
    tree |= {"nodes": nodes, "meshes": shapes.meshes, "materials": shapes.materials}
    if turning is not None and begins:
        tree["animations"] = [turning.animation(begins, arrays)]
    Path(path).write_bytes(glb_bytes(tree, arrays))


class _Node(NamedTuple):
    """A node, its place (4, 4) beneath an axle by its name or in the scene, and the part it shows."""

    name: str
    parent: str | None
    place: Floats
    part: Part | None


def _nodes(parts: Sequence[Part]) -> Iterator[_Node]:
    """Axles before what turns about them, parts in their order. An axle and the part of its name are one node."""
    same = {part.axle.name: part for part in parts if part.axle is not None and part.axle.name == part.name}
    made: set[str] = set()

    def axle_nodes(axle: Axle) -> Iterator[_Node]:
        if axle.name in made:
            return
        made.add(axle.name)
        if axle.on is not None:
            yield from axle_nodes(axle.on)
        part = same.get(axle.name)
        yield _Node(axle.name, *beneath(axle.on, place_of(axle)), part)

    def place_of(axle: Axle) -> Floats:
        if axle.name in same:
            return same[axle.name].pose
        place = np.eye(4)
        place[:2, 3] = axle.x, axle.y
        return place

    def beneath(axle: Axle | None, place: Floats) -> tuple[str | None, Floats]:
        return (None, place) if axle is None else (axle.name, np.linalg.inv(place_of(axle)) @ place)

    for part in parts:
        if part.axle is not None:
            yield from axle_nodes(part.axle)
        if part.name not in same:
            yield _Node(part.name, *beneath(part.axle, part.pose), part)


class _Shapes:
    """Meshes and their materials: parts with the same facets share them."""

    def __init__(self) -> None:
        self.meshes: list[dict[str, Any]] = []
        self.materials: list[dict[str, Any]] = []
        self._numbers: dict[int, int] = {}

    def number_of(self, part: Part, arrays: Arrays) -> int:
        """That of the mesh of a part."""
        number = self._numbers.setdefault(id(part.facets), len(self.meshes))
        if number == len(self.meshes):
            # Without normals viewers shade every triangle flat; averaged ones would round off the edges of the teeth.
            corners, points = arrays.add(part.facets.faces.ravel()), arrays.add(part.facets.vertices)
            body = {"attributes": {"POSITION": points}, "indices": corners, "mode": _TRIANGLES, "material": number}
            self.meshes.append({"name": part.made_as, "primitives": [body]})
            self.materials.append(_material(part))
        return number


def _material(part: Part) -> dict[str, Any]:
    colour = [*(round(_SHADES * _linear(value)) / _SHADES for value in part.colour), 1.0]
    looks = {"baseColorFactor": colour, "metallicFactor": _METALLIC, "roughnessFactor": _ROUGHNESS}
    return {"name": part.made_as, "pbrMetallicRoughness": looks, "doubleSided": False}


def _linear(value: float) -> float:
    """sRGB to the linear light of glTF (IEC 61966-2-1)."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def _unfolded(place: Floats) -> dict[str, Any]:
    """Translation and rotation for a matrix, which animated nodes must not have."""
    return {"translation": place[:3, 3].tolist(), "rotation": quaternions(np.array([_angle(place)]))[0].tolist()}


def _angle(place: Floats) -> float:
    """About z (rad)."""
    return math.atan2(place[1, 0], place[0, 0])


def _listed(place: Floats) -> list[float]:
    """Column by column."""
    return [float(value) for value in place.T.ravel()]

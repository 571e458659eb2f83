"""GLB: a scene for viewers, which may turn. Equal input gives equal bytes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.axle import Axle
from gearcad.solids.files.part import Part
from gearcad.solids.files.turning import Turning, add_animation

__all__ = ["write_glb"]

_GLTF_ROOT = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])
"""From millimetres with z up to the metres with y up that glTF prescribes."""

_METALLIC, _ROUGHNESS = 0.6, 0.45


def write_glb(parts: Sequence[Part], path: Path | str, turning: Turning | None = None) -> None:
    """Write every part as a named, coloured body in its place, and how they turn.

    glTF knows only metres with y up, so the data stay in mm with z up, and the node "gearcad" above all parts scales by
    0.001 and turns z to y: viewers and Blender show true size and posture. Axles are nodes, those they carry beneath them.
    """
    import trimesh
    from trimesh.exchange.gltf import export_glb

    scene = trimesh.Scene()
    scene.graph.update(frame_to="gearcad", frame_from=scene.graph.base_frame, matrix=_GLTF_ROOT)
    geometries: dict[int, str] = {}
    for name, parent, place, part in _nodes(parts):
        if part is None:
            scene.graph.update(frame_to=name, frame_from=parent, matrix=place)
        elif (made := geometries.get(id(part.facets))) is not None:
            scene.graph.update(frame_to=name, frame_from=parent, matrix=place, geometry=made)
        else:
            geometries[id(part.facets)] = part.made_as
            scene.add_geometry(_mesh(part), name, part.made_as, parent_node_name=parent, transform=place)
    animate = partial(add_animation, turning=turning) if turning else None
    # Without normals viewers shade every triangle flat; averaged ones would round off the edges of the teeth.
    Path(path).write_bytes(export_glb(scene, include_normals=False, buffer_postprocessor=animate))


class _Node(NamedTuple):
    """A node, its place (4, 4) in its parent, and the part it shows."""

    name: str
    parent: str
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

    def beneath(axle: Axle | None, place: Floats) -> tuple[str, Floats]:
        return ("gearcad", place) if axle is None else (axle.name, np.linalg.inv(place_of(axle)) @ place)

    for part in parts:
        if part.axle is not None:
            yield from axle_nodes(part.axle)
        if part.name not in same:
            yield _Node(part.name, *beneath(part.axle, part.pose), part)


def _mesh(part: Part) -> Any:
    import trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    mesh = trimesh.Trimesh(part.facets.vertices, part.facets.faces, process=False, validate=False)
    material = PBRMaterial(
        name=part.made_as,
        baseColorFactor=[*map(_linear, part.colour), 1.0],
        metallicFactor=_METALLIC,
        roughnessFactor=_ROUGHNESS,
    )
    mesh.visual = TextureVisuals(material=material)
    return mesh


def _linear(value: float) -> float:
    """sRGB to the linear light of glTF (IEC 61966-2-1)."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4

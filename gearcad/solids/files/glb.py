"""GLB: a scene for viewers. Equal input gives equal bytes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gearcad.solids.files.part import Part

__all__ = ["write_glb"]

_GLTF_ROOT = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])
"""From millimetres with z up to the metres with y up that glTF prescribes."""

_METALLIC, _ROUGHNESS = 0.6, 0.45


def write_glb(parts: Sequence[Part], path: Path | str) -> None:
    """Write every part as a named, coloured body in its place.

    glTF knows only metres with y up, so the data stay in mm with z up, and the node "gearcad" above all parts scales by
    0.001 and turns z to y: viewers and Blender show true size and posture.
    """
    import trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    scene = trimesh.Scene()
    scene.graph.update(frame_to="gearcad", frame_from=scene.graph.base_frame, matrix=_GLTF_ROOT)
    for part in parts:
        mesh = trimesh.Trimesh(part.facets.vertices, part.facets.faces, process=False, validate=False)
        material = PBRMaterial(
            name=part.name,
            baseColorFactor=[*map(_linear, part.colour), 1.0],
            metallicFactor=_METALLIC,
            roughnessFactor=_ROUGHNESS,
        )
        mesh.visual = TextureVisuals(material=material)
        scene.add_geometry(mesh, part.name, part.name, parent_node_name="gearcad", transform=part.pose)
    # Without normals viewers shade every triangle flat; averaged ones would round off the edges of the teeth.
    Path(path).write_bytes(scene.export(file_type="glb", include_normals=False))


def _linear(value: float) -> float:
    """sRGB to the linear light of glTF (IEC 61966-2-1)."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4

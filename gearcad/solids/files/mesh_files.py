"""Mesh files: STL of one gear, 3MF and GLB of named, coloured parts. Equal input gives equal bytes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import ParameterError
from gearcad.solids.facets.tessellation import Facets

__all__ = ["Part", "write_scene", "write_stl"]


_GLTF_ROOT = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])
"""From millimetres with z up to the metres with y up that glTF prescribes."""

_METALLIC, _ROUGHNESS = 0.6, 0.45


@dataclass(frozen=True, kw_only=True)
class Part:
    """One body of a scene: turned by `rotation` (degrees, about its own z axis), then moved by `offset` (mm).

    `colour` is red, green and blue as seen on a screen (sRGB), 0 ... 1.
    """

    name: str
    facets: Facets
    colour: tuple[float, float, float] = (0.62, 0.66, 0.72)
    rotation: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def pose(self) -> Floats:
        """Homogeneous matrix (4, 4) of the part's place."""
        matrix = np.eye(4)
        cosine, sine = math.cos(math.radians(self.rotation)), math.sin(math.radians(self.rotation))
        matrix[:2, :2] = [[cosine, -sine], [sine, cosine]]
        matrix[:3, 3] = self.offset
        return matrix


def write_stl(facets: Facets, path: Path | str) -> None:
    """Write binary STL, in mm (the format states no unit) and single precision."""
    Path(path).write_bytes(_trimesh(facets).export(file_type="stl"))


def write_scene(parts: Sequence[Part], path: Path | str) -> None:
    """Write 3MF or GLB, by the suffix of `path`: every part a named, coloured body in its place.

    3MF states the millimetre. glTF knows only metres with y up, so in GLB the data stay in mm with z up, and the node
    "gearcad" above all parts scales by 0.001 and turns z to y: viewers and Blender show true size and posture.
    Raises ParameterError for another suffix.
    """
    writers = {".3mf": _three_mf, ".glb": _glb}
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in writers:
        raise ParameterError("path", str(path), "must end in .3mf or .glb")
    path.write_bytes(writers[suffix](parts))


def _trimesh(facets: Facets) -> Any:
    import trimesh

    return trimesh.Trimesh(facets.vertices, facets.faces, process=False, validate=False)


def _glb(parts: Sequence[Part]) -> bytes:
    import trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    scene = trimesh.Scene()
    scene.graph.update(frame_to="gearcad", frame_from=scene.graph.base_frame, matrix=_GLTF_ROOT)
    for part in parts:
        mesh = _trimesh(part.facets)
        material = PBRMaterial(
            name=part.name,
            baseColorFactor=[*map(_linear, part.colour), 1.0],
            metallicFactor=_METALLIC,
            roughnessFactor=_ROUGHNESS,
        )
        mesh.visual = TextureVisuals(material=material)
        scene.add_geometry(mesh, part.name, part.name, parent_node_name="gearcad", transform=part.pose)
    # Without normals viewers shade every triangle flat; averaged ones would round off the edges of the teeth.
    data: bytes = scene.export(file_type="glb", include_normals=False)
    return data


def _linear(value: float) -> float:
    """sRGB to the linear light of glTF (IEC 61966-2-1)."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


# ---------------------------------------------------------------------- 3MF
# Written here, as the exporter of trimesh leaves out colours and makes up new identifiers and dates every time.

_CONTENT_TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"""

_RELATIONS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="rel0" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"""

_MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<metadata name="Application">gearcad</metadata>
<resources>
<basematerials id="1">
{materials}
</basematerials>
{objects}
</resources>
<build>
{items}
</build>
</model>
"""

_FIRST_OBJECT = 2
"""Resource identifiers count through materials and objects alike; 1 is the list of materials."""


def _three_mf(parts: Sequence[Part]) -> bytes:
    from io import BytesIO

    model = _MODEL.format(
        materials="\n".join(_material(part) for part in parts),
        objects="\n".join(_object(part, i) for i, part in enumerate(parts)),
        items="\n".join(
            f'<item objectid="{_FIRST_OBJECT + i}" transform="{_numbers(part.pose[:3].T.ravel())}"/>'
            for i, part in enumerate(parts)
        ),
    )
    contents = {"[Content_Types].xml": _CONTENT_TYPES, "_rels/.rels": _RELATIONS, "3D/3dmodel.model": model}
    stream = BytesIO()
    with ZipFile(stream, "w") as archive:
        for name, text in contents.items():  # ZipInfo's own date is 1 January 1980
            archive.writestr(ZipInfo(name), text, compress_type=ZIP_DEFLATED, compresslevel=6)
    return stream.getvalue()


def _material(part: Part) -> str:
    shades = "".join(f"{round(255 * value):02X}" for value in part.colour)
    return f'<base name={quoteattr(part.name)} displaycolor="#{shades}FF"/>'


def _object(part: Part, index: int) -> str:
    vertices, faces = part.facets.vertices, part.facets.faces
    points = '<vertex x="%.9g" y="%.9g" z="%.9g"/>' * len(vertices) % tuple(vertices.ravel().tolist())
    triangles = '<triangle v1="%d" v2="%d" v3="%d"/>' * len(faces) % tuple(faces.ravel().tolist())
    return (
        f'<object id="{_FIRST_OBJECT + index}" type="model" name={quoteattr(part.name)} pid="1" pindex="{index}"><mesh>\n'
        f"<vertices>{points}</vertices>\n<triangles>{triangles}</triangles>\n</mesh></object>"
    )


def _numbers(values: Floats) -> str:
    return " ".join(f"{value:.12g}" for value in values)

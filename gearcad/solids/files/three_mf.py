"""3MF: a scene for printing. Equal input gives equal bytes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from gearcad.arrays import Floats
from gearcad.solids.files.part import Part

__all__ = ["write_3mf"]

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


def write_3mf(parts: Sequence[Part], path: Path | str) -> None:
    """Write every part as a named, coloured body in its place; the file states the millimetre.

    Written here, as the exporter of trimesh leaves out colours and makes up new identifiers and dates every time.
    """
    model = _MODEL.format(
        materials="\n".join(_material(part) for part in parts),
        objects="\n".join(_object(part, i) for i, part in enumerate(parts)),
        items="\n".join(
            f'<item objectid="{_FIRST_OBJECT + i}" transform="{_numbers(part.pose[:3].T.ravel())}"/>'
            for i, part in enumerate(parts)
        ),
    )
    contents = {"[Content_Types].xml": _CONTENT_TYPES, "_rels/.rels": _RELATIONS, "3D/3dmodel.model": model}
    with ZipFile(path, "w") as archive:
        for name, text in contents.items():  # ZipInfo's own date is 1 January 1980
            archive.writestr(ZipInfo(name), text, compress_type=ZIP_DEFLATED, compresslevel=6)


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

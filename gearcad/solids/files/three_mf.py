"""3MF: a scene for printing. Equal input gives equal bytes."""

from __future__ import annotations

from collections import Counter
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

    Parts that are one product are components that hold its mesh, which is written once.
    """
    uses = Counter(id(part.facets) for part in parts)
    objects: list[str] = []
    materials: list[str] = []
    items: list[str] = []
    meshes: dict[int, int] = {}

    def add(text: str) -> int:
        objects.append(text)
        return _FIRST_OBJECT + len(objects) - 1

    for part in parts:
        number = meshes.get(id(part.facets))
        if number is None:
            materials.append(_material(part))
            number = meshes[id(part.facets)] = add(_object(part, _FIRST_OBJECT + len(objects), len(materials) - 1))
        if uses[id(part.facets)] > 1:
            number = add(_component(part, _FIRST_OBJECT + len(objects), number))
        items.append(f'<item objectid="{number}" transform="{_numbers(part.pose[:3].T.ravel())}"/>')
    model = _MODEL.format(materials="\n".join(materials), objects="\n".join(objects), items="\n".join(items))
    contents = {"[Content_Types].xml": _CONTENT_TYPES, "_rels/.rels": _RELATIONS, "3D/3dmodel.model": model}
    with ZipFile(path, "w") as archive:
        for name, text in contents.items():  # ZipInfo's own date is 1 January 1980
            archive.writestr(ZipInfo(name), text, compress_type=ZIP_DEFLATED, compresslevel=6)


def _material(part: Part) -> str:
    shades = "".join(f"{round(255 * value):02X}" for value in part.colour)
    return f'<base name={quoteattr(part.made_as)} displaycolor="#{shades}FF"/>'


def _object(part: Part, number: int, material: int) -> str:
    """The mesh of a part, with an identifier and a material by their numbers."""
    vertices, faces = part.facets.vertices, part.facets.faces
    points = '<vertex x="%.9g" y="%.9g" z="%.9g"/>' * len(vertices) % tuple(vertices.ravel().tolist())
    triangles = '<triangle v1="%d" v2="%d" v3="%d"/>' * len(faces) % tuple(faces.ravel().tolist())
    return (
        f'<object id="{number}" type="model" name={quoteattr(part.made_as)} pid="1" pindex="{material}"><mesh>\n'
        f"<vertices>{points}</vertices>\n<triangles>{triangles}</triangles>\n</mesh></object>"
    )


def _component(part: Part, number: int, mesh: int) -> str:
    """A part whose mesh is an object by itself."""
    name = quoteattr(part.name)
    return f'<object id="{number}" type="model" name={name}><components><component objectid="{mesh}"/></components></object>'


def _numbers(values: Floats) -> str:
    return " ".join(f"{value:.12g}" for value in values)

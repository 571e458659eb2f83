"""Scenes of named, coloured parts as GLB, which may turn, and as 3MF. Equal input gives equal bytes."""

from __future__ import annotations

import json
import math
import struct
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, Wholes
from gearcad.solids.body_plan import STEEL, Axle, Colour
from gearcad.solids.facets.tessellation import Facets

_COMPONENTS = {"<f4": 5126, "<u4": 5125}
_WIDTHS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_JSON, _BINARY = 0x4E4F534A, 0x004E4942


class Arrays:
    """Arrays of the binary chunk, one behind the other; the tree knows each by the number of its accessor."""

    def __init__(self) -> None:
        self._arrays: list[bytes] = []
        self._accessors: list[dict[str, Any]] = []

    def add(self, values: Floats | Wholes) -> int:
        """Return the number of an accessor of values (n,) or (n, k), in single precision or as whole numbers from 0 on."""
        kind = "<f4" if values.dtype.kind == "f" else "<u4"
        rows: NDArray[Any] = values.astype(kind).reshape(len(values), -1)
        self._accessors.append(
            {
                "bufferView": len(self._arrays),
                "componentType": _COMPONENTS[kind],
                "count": len(rows),
                "type": _WIDTHS[rows.shape[1]],
                "min": rows.min(axis=0).tolist(),
                "max": rows.max(axis=0).tolist(),
            }
        )
        self._arrays.append(rows.tobytes())
        return len(self._accessors) - 1

    @property
    def tables(self) -> dict[str, Any]:
        """Tables of the JSON tree that describe the arrays: accessors, buffer views and the buffer."""
        sizes = [len(array) for array in self._arrays]
        starts = np.cumsum([0, *sizes]).tolist()
        views = [{"buffer": 0, "byteOffset": start, "byteLength": size} for start, size in zip(starts, sizes, strict=False)]
        return {"accessors": self._accessors, "bufferViews": views, "buffers": [{"byteLength": starts[-1]}]}

    def joined(self) -> bytes:
        """Return the chunk: every component takes four bytes, so nothing has to be filled up."""
        return b"".join(self._arrays)


def glb_bytes(tree: dict[str, Any], arrays: Arrays) -> bytes:
    """Return the file of a tree: the chunk of its JSON, with the tables of its arrays, and that of the arrays."""
    text = json.dumps(tree | arrays.tables, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary = arrays.joined()
    head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary))
    return b"".join((head, struct.pack("<II", len(text), _JSON), text, struct.pack("<II", len(binary), _BINARY), binary))


@dataclass(frozen=True, kw_only=True)
class ScenePart:
    """One body of a scene: turned by `rotation` (degrees, about its own z axis), then moved by `offset` (mm).

    `colour` is red, green and blue as seen on a screen (sRGB), 0 ... 1. Parts with the same facets, the very object, are one
    `product` in several places. `axle` is what it turns about in scenes that turn; a part called as its axle is turns with it.
    """

    name: str
    facets: Facets
    colour: Colour = STEEL
    rotation: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    product: str = ""
    axle: Axle | None = None

    @property
    def pose(self) -> Floats:
        """Homogeneous matrix (4, 4) of the part's place."""
        matrix = np.eye(4)
        cosine, sine = math.cos(math.radians(self.rotation)), math.sin(math.radians(self.rotation))
        matrix[:2, :2] = [[cosine, -sine], [sine, cosine]]
        matrix[:3, 3] = self.offset
        return matrix

    @property
    def made_as(self) -> str:
        """Name of the part as a product: its own name if it occurs only once."""
        return self.product or self.name


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
        """Return the turns of an axle, by its name; 0 for anything else, which does not turn."""
        return self.turns.get(name, 0.0)

    def keyframes(self) -> Floats:
        """Return the shares of the duration (n,) from 0 to 1."""
        most = max((abs(turns) for turns in self.turns.values()), default=0.0)
        return np.linspace(0.0, 1.0, math.ceil(most / _STEP) + 2)

    def animation(self, begins: Mapping[int, tuple[str, float]], arrays: Arrays) -> dict[str, Any]:
        """Return a sampler of quaternions and a channel for each node, by its number: what it is called and its angle (rad) at
        0 s.
        """
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


_ROOT = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])
"""Matrix from millimetres with z up to the metres with y up that glTF prescribes."""

_METALLIC, _ROUGHNESS = 0.6, 0.45
_TRIANGLES = 4
"""Number of the mode "triangles" of glTF."""

_SHADES = 255
"""Steps of a colour of a material, as of one on a screen."""


def write_glb(parts: Sequence[ScenePart], path: Path | str, turning: Turning | None = None) -> None:
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
    part: ScenePart | None


def _nodes(parts: Sequence[ScenePart]) -> Iterator[_Node]:
    """Yield the nodes of a scene: each axle before the parts that turn about it. An axle and a part of
    one name are one node.
    """
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

    def number_of(self, part: ScenePart, arrays: Arrays) -> int:
        """Return the number of the mesh of a part; adds the mesh and its material if they are new."""
        number = self._numbers.setdefault(id(part.facets), len(self.meshes))
        if number == len(self.meshes):
            # Without normals viewers shade every triangle flat; averaged ones would round off the edges of the teeth.
            corners, points = arrays.add(part.facets.faces.ravel()), arrays.add(part.facets.vertices)
            body = {"attributes": {"POSITION": points}, "indices": corners, "mode": _TRIANGLES, "material": number}
            self.meshes.append({"name": part.made_as, "primitives": [body]})
            self.materials.append(_material(part))
        return number


def _material(part: ScenePart) -> dict[str, Any]:
    colour = [*(round(_SHADES * _linear(value)) / _SHADES for value in part.colour), 1.0]
    looks = {"baseColorFactor": colour, "metallicFactor": _METALLIC, "roughnessFactor": _ROUGHNESS}
    return {"name": part.made_as, "pbrMetallicRoughness": looks, "doubleSided": False}


def _linear(value: float) -> float:
    """Return sRGB values as the linear light of glTF (IEC 61966-2-1)."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def _unfolded(place: Floats) -> dict[str, Any]:
    """Translation and rotation for a matrix, which animated nodes must not have."""
    return {"translation": place[:3, 3].tolist(), "rotation": quaternions(np.array([_angle(place)]))[0].tolist()}


def _angle(place: Floats) -> float:
    """Return the angle about z (rad)."""
    return math.atan2(place[1, 0], place[0, 0])


def _listed(place: Floats) -> list[float]:
    """Return the entries column by column."""
    return [float(value) for value in place.T.ravel()]


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


def write_3mf(parts: Sequence[ScenePart], path: Path | str) -> None:
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
            materials.append(_three_mf_material(part))
            number = meshes[id(part.facets)] = add(_object(part, _FIRST_OBJECT + len(objects), len(materials) - 1))
        if uses[id(part.facets)] > 1:
            number = add(_component(part, _FIRST_OBJECT + len(objects), number))
        items.append(f'<item objectid="{number}" transform="{_numbers(part.pose[:3].T.ravel())}"/>')
    model = _MODEL.format(materials="\n".join(materials), objects="\n".join(objects), items="\n".join(items))
    contents = {"[Content_Types].xml": _CONTENT_TYPES, "_rels/.rels": _RELATIONS, "3D/3dmodel.model": model}
    with ZipFile(path, "w") as archive:
        for name, text in contents.items():  # ZipInfo's own date is 1 January 1980
            archive.writestr(ZipInfo(name), text, compress_type=ZIP_DEFLATED, compresslevel=6)


def _three_mf_material(part: ScenePart) -> str:
    shades = "".join(f"{round(255 * value):02X}" for value in part.colour)
    return f'<base name={quoteattr(part.made_as)} displaycolor="#{shades}FF"/>'


def _object(part: ScenePart, number: int, material: int) -> str:
    """Return the mesh of a part, with an identifier and a material by their numbers."""
    vertices, faces = part.facets.vertices, part.facets.faces
    points = '<vertex x="%.9g" y="%.9g" z="%.9g"/>' * len(vertices) % tuple(vertices.ravel().tolist())
    triangles = '<triangle v1="%d" v2="%d" v3="%d"/>' * len(faces) % tuple(faces.ravel().tolist())
    return (
        f'<object id="{number}" type="model" name={quoteattr(part.made_as)} pid="1" pindex="{material}"><mesh>\n'
        f"<vertices>{points}</vertices>\n<triangles>{triangles}</triangles>\n</mesh></object>"
    )


def _component(part: ScenePart, number: int, mesh: int) -> str:
    """Return a part whose mesh is an object by itself."""
    name = quoteattr(part.name)
    return f'<object id="{number}" type="model" name={name}><components><component objectid="{mesh}"/></components></object>'


def _numbers(values: Floats) -> str:
    return " ".join(f"{value:.12g}" for value in values)


def write_scene(parts: Sequence[ScenePart], path: Path | str) -> None:
    """Write 3MF or GLB, by the suffix of `path` (see `write_3mf`, `write_glb`). Raises ParameterError for another suffix."""
    writers = {".3mf": write_3mf, ".glb": write_glb}
    suffix = Path(path).suffix.lower()
    if suffix not in writers:
        raise ParameterError("path", str(path), "must end in .3mf or .glb")
    writers[suffix](parts, path)

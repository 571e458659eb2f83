"""Judge of facets: STL, 3MF and GLB files read by trimesh, and held against the exact surface."""

from __future__ import annotations

import hashlib
import re
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from gearcad.core.records import Floats, Wholes
from gearcad.solids.body_plan import Colour
from gearcad.solids.exact.solid import Product
from gearcad.verification.assemblies import OUTLINES, PlacedMesh, PlacedPart, judge_places
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.step import of_light, solid_products, told_places

if TYPE_CHECKING:
    from trimesh import Trimesh

SUBJECTS = {"stl": ClaimSubject.STL, "3mf": ClaimSubject.THREE_MF, "glb": ClaimSubject.GLB}
"""Subjects of the claims by the endings of the files."""

_ROUNDING = {"stl": 2.0**-24, "glb": 2.0**-24, "3mf": 0.0}
"""Rounding of a coordinate as a share of it: STL and GLB have single precision."""

_LAST_DIGIT = {"stl": 0.0, "glb": 0.0, "3mf": 5.1e-8}
"""Rounding of a coordinate (mm): 3MF has seven decimals."""

_PLACE = {"stl": 0.0, "glb": 2e-4, "3mf": 1e-6}
"""Rounding (mm at the working circle) of the place of a part: GLB has quaternions and shifts in single precision."""

_LEAST = 1e-5
"""Distance (mm) of a vertex from the exact surface that is permitted beside the rounding of the file."""

_BODY = 1.05
"""Factor on the chord error for the middle of a triangle: it is bounded for the sides of triangles."""


_NUMBER = "number"
"""Attribute of the empty element that stands for a mesh while the tree of a 3MF is read."""


@dataclass(frozen=True)
class JudgedFacets:
    """Facets in the files of one design that were read and judged before.

    `claims` are those about bodies, by the rounding of the file, the part and the digest of the facets. `meshes` of 3MF files
    are kept by the digests of their texts: to read these takes longest, and an assembly has those of its parts.
    """

    claims: dict[tuple[tuple[float, float], str, str], list[Claim]] = field(default_factory=dict)
    meshes: dict[bytes, Trimesh] = field(default_factory=dict)


@dataclass(frozen=True)
class FacetPart:
    """One body of a file: its name, its facets in mm where the part stands by itself, and its place (4, 4) in the file.

    `colour` is as the file has it, and `unit` is that of the file; "" where it has none.
    """

    name: str
    mesh: Trimesh
    place: Floats
    colour: str = ""
    unit: str = ""


def read_facets(path: Path, judged: JudgedFacets | None = None) -> list[FacetPart]:
    """Return the bodies of an STL, 3MF or GLB file in mm, z along the gear's axis. Raises what trimesh raises.

    Meshes of 3MF files that are known are not read again.
    """
    import trimesh

    if path.suffix == ".stl":
        return [FacetPart("", trimesh.load_mesh(path), np.eye(4))]
    if path.suffix == ".3mf":
        return _read_3mf(path, {} if judged is None else judged.meshes)
    scene = trimesh.load_scene(path)
    # A GLB has its vertices in mm below a node that turns y up and scales to metres.
    found, to_world = [], np.linalg.inv(_GLB)
    for node in scene.graph.nodes_geometry:
        place, geometry = scene.graph[node]
        mesh = scene.geometry[geometry]
        found.append(FacetPart(str(geometry), mesh, to_world @ place, _colour_of_glb(mesh), str(scene.units or "")))
    return found


def _read_3mf(path: Path, known: dict[bytes, Trimesh]) -> list[FacetPart]:
    """Return the bodies of a 3MF file, an item of its build each, from its XML (3MF Core Specification 1.3).

    trimesh would need two further packages for it, and reads no colours. The tree is read without the meshes, which are nearly
    all of the text. Those that are not `known` by the digests of their texts are read and added.
    """
    with zipfile.ZipFile(path) as archive:
        model = next(name for name in archive.namelist() if name.endswith(".model"))
        first, *rest = archive.read(model).split(b"<mesh>")
    pieces = [each.partition(b"</mesh>") for each in rest]
    marks = (b'<mesh %b="%d"/>%b' % (_NUMBER.encode(), number, after) for number, (_, _, after) in enumerate(pieces))
    root = ElementTree.fromstring(first + b"".join(marks))
    space = root.tag.partition("}")[0] + "}"
    colours = {
        group.get("id"): [base.get("displaycolor", "")[:7] for base in group] for group in root.iter(f"{space}basematerials")
    }
    objects = {each.get("id"): each for each in root.iter(f"{space}object")}
    found = []
    for item in root.iter(f"{space}item"):
        body, place = objects[item.get("objectid")], _place_in_3mf(item)
        while (component := next(body.iter(f"{space}component"), None)) is not None:  # the same gear in several places
            body, place = objects[component.get("objectid")], place @ _place_in_3mf(component)
        shades = colours.get(body.get("pid"))
        colour = "" if shades is None else shades[int(body.get("pindex", "0"))]
        number = next((each.get(_NUMBER) for each in body.iter(f"{space}mesh")), None)
        mesh = _mesh_of(body, space) if number is None else _known_mesh(pieces[int(number)][0], known)
        found.append(FacetPart(body.get("name", ""), mesh, place, colour, root.get("unit", "millimeter")))
    return found


def _place_in_3mf(element: ElementTree.Element) -> Floats:
    """Return the place (4, 4) of an item or a component of a 3MF, that of its parent without a transform of its own."""
    place = np.eye(4)
    if given := element.get("transform"):
        place[:3] = np.array(given.split(), float).reshape(4, 3).T
    return place


def _known_mesh(text: bytes, known: dict[bytes, Trimesh]) -> Trimesh:
    """Return the mesh of this text of a 3MF, read unless it is known."""
    digest = hashlib.sha256(text).digest()
    if digest not in known:
        known[digest] = _plain_mesh_of(text) or _mesh_of(ElementTree.fromstring(b"<mesh>%b</mesh>" % text))
    return known[digest]


def _plain_mesh_of(text: bytes) -> Trimesh | None:
    """Return the mesh of this text if it is written as plainly as can be, which takes a quarter of the time, else None."""
    import trimesh

    if _PLAIN_MESH.fullmatch(text) is None:
        return None
    vertices, _, triangles = text.partition(b"</vertices>")
    points, corners = (np.array(each.split(b'"')[1::2]).reshape(-1, 3) for each in (vertices, triangles))
    return trimesh.Trimesh(points.astype(float), corners.astype(int))


def _mesh_of(element: ElementTree.Element, space: str = "") -> Trimesh:
    """Return the mesh of the vertices and triangles in an element of a 3MF; `space` is that of their names."""
    import trimesh

    vertices = np.array([[float(each.get(axis, "nan")) for axis in "xyz"] for each in element.iter(f"{space}vertex")])
    corners = [[int(each.get(corner, "-1")) for corner in ("v1", "v2", "v3")] for each in element.iter(f"{space}triangle")]
    return trimesh.Trimesh(vertices, np.array(corners, int))


def _colour_of_glb(mesh: Trimesh) -> str:
    """Return the colour of a body of a GLB in eight bits of each share of light."""
    material = getattr(mesh.visual, "material", None)
    factor = getattr(material, "baseColorFactor", None)
    return "" if factor is None else _hex([int(share) for share in factor[:3]])


def _told_colour(colour: Colour, ending: str) -> str:
    """Return a colour as a file of this ending has it: as seen on a screen, or as shares of light."""
    shares = [of_light(value) for value in colour] if ending == "glb" else colour
    return _hex([round(255 * share) for share in shares])


def _hex(shares: Sequence[int]) -> str:
    return "#" + "".join(f"{share:02X}" for share in shares)


_PLAIN_MESH = re.compile(
    rb"\s*<vertices>(?:<vertex%b%b%b/>)+</vertices>\s*<triangles>(?:<triangle%b%b%b/>)+</triangles>\s*"
    % (*[rb' %b="[-+.\deE]+"' % axis for axis in (b"x", b"y", b"z")], *[rb' v%d="\d+"' % corner for corner in (1, 2, 3)])
)

_GLB = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])
"""Matrix of a GLB, whose unit is the metre and whose y axis points up, for points in mm with z up."""


def judge_facets(
    path: Path,
    parts: Mapping[str, ExactPart],
    chord_error: float,
    meshes: Sequence[PlacedMesh] = (),
    *,
    names: bool = True,
    judged: JudgedFacets | None = None,
    product: Product | None = None,
    colour: Colour | None = None,
) -> Iterator[Claim]:
    """Judge every body of a file against the parts that it should have, by their names; of an assembly also the `meshes`.

    `chord_error` (mm) bounds how far facets may be off. `names`: whether the file has the names of its parts (STL has not).
    The colours and places of the bodies are held against those of a `product`, if one is given; a `colour` is that of a
    part by itself. The
    same facets as those of a body that was `judged` in a file of the same rounding have the same claims; others are added.
    """
    ending = path.suffix[1:]
    judge = Judge(SUBJECTS[ending], VerificationLevel.FILES, path.name, "trimesh")
    try:
        found = read_facets(path, judged)
    except Exception as error:  # a reader may raise anything for a broken file
        yield judge.holds("is read", False, place=f"{type(error).__name__}: {error}")
        return
    bodies = {part.name: part for part in found}
    if names:
        yield judge.equal("names of the parts", ", ".join(sorted(parts)), ", ".join(sorted(bodies)))
    else:
        yield judge.equal("number of bodies", len(parts), len(found))
        bodies = dict(zip(parts, found, strict=False))
    if names and product is not None:
        yield from _judge_looks(judge, found, product, ending, colour)
    for name, part in parts.items():
        if name in bodies:
            of_part = Judge(judge.subject, judge.level, path.name if len(parts) == 1 else f"{path.name}: {name}", judge.name)
            key, before = (_written(ending), name, _digest(bodies[name].mesh)), judged.claims if judged is not None else {}
            if key in before:
                yield from (replace(claim, subject=of_part.subject, where=of_part.where) for claim in before[key])
                continue
            before[key] = []
            for claim in _judge_body(of_part, bodies[name].mesh, part, ending, chord_error):
                before[key].append(claim)
                yield claim
    placed = [PlacedPart(part.name, part.place[:3]) for part in found]
    places = Judge(judge.subject, judge.level, path.name, OUTLINES)
    yield from judge_places(places, meshes, placed, rounding=_PLACE[ending])


def _judge_looks(
    judge: Judge, found: Sequence[FacetPart], product: Product, ending: str, colour: Colour | None
) -> Iterator[Claim]:
    """Judge unit, colours and places of the bodies of a file against those of a product; a `colour` is that of all."""
    if ending == "3mf":
        yield judge.equal("unit", "millimeter", next((part.unit for part in found), ""))
    told = {each.name: each.colour for each in solid_products(product) if each.colour is not None}
    told |= {} if colour is None else dict.fromkeys(told, colour)
    for name, own in told.items():
        shown = next((part.colour for part in found if part.name == name), "")
        yield judge.equal(f"colour of {name}", _told_colour(own, ending), shown)
    places = list(told_places(product))
    yield judge.equal("bodies", len(places), len(found))
    off, place = 0.0, ""
    for part in found:
        size = float(np.abs(part.mesh.vertices).max(initial=0.0))
        away = [
            float(
                np.abs(each.place[:, 3] - part.place[:3, 3]).max() + size * np.abs(each.place[:, :3] - part.place[:3, :3]).max()
            )
            for each in places
            if each.product == part.name
        ]
        if min(away, default=np.inf) > off:
            off, place = min(away, default=np.inf), f"{part.name} is not where it should be"
    yield judge.below("distance of bodies from their places", 1e3 * off, 1e3 * _PLACE[ending], "µm", place=place)


def _written(ending: str) -> tuple[float, float]:
    """How files of an ending round coordinates: as a share, and in mm."""
    return _ROUNDING[ending], _LAST_DIGIT[ending]


def _digest(mesh: Trimesh) -> str:
    """Digest of the triangles of a body and of how they share vertices, whose order does not matter."""
    flat = np.asarray(mesh.faces).ravel()
    _, first, number = np.unique(flat, return_index=True, return_inverse=True)
    order = np.argsort(first)  # vertices by the first triangle that has them
    shared = np.argsort(order)[number]
    found = hashlib.sha256(np.ascontiguousarray(mesh.vertices[flat[first[order]]], float).tobytes())
    found.update(np.ascontiguousarray(shared, np.int64).tobytes())
    found.update(str(len(mesh.vertices)).encode())
    return found.hexdigest()


def _judge_body(judge: Judge, mesh: Trimesh, part: ExactPart, ending: str, chord_error: float) -> Iterator[Claim]:
    """Judge one body: its topology, its volume, its vertices and the middles of its triangles."""
    if not len(mesh.faces):
        yield judge.holds("has facets", False)
        return
    size = float(np.abs(mesh.vertices).max())
    share, digit = _written(ending)
    permitted = _LEAST + share * size * np.sqrt(3) + digit
    closed = bool(mesh.is_watertight)
    yield judge.holds("is watertight", closed, place="" if closed else _open_edge(mesh))
    yield judge.holds("triangles are turned outwards", bool(mesh.is_winding_consistent) and mesh.volume > 0)
    yield judge.equal("Euler number", part.euler_number, int(mesh.euler_number))
    yield judge.near("volume", part.moments.volume, float(mesh.volume), float(mesh.area) * chord_error, "mm³")
    surface = part.surface
    vertices, faces = np.asarray(mesh.vertices, float), np.asarray(mesh.faces)
    apart = part.distances(vertices)
    corners = apart[:, faces].max(axis=2)
    off = corners.min(axis=0)
    yield judge.below(
        "distance of vertices from the exact surface",
        1e3 * off.max(),
        1e3 * permitted,
        "µm",
        place=_where(surface, vertices[faces], off),
    )
    middles = vertices[faces].mean(axis=1)
    away = np.where(corners <= permitted, surface.distances(middles), np.inf).min(axis=0)
    away = np.where(off <= permitted, away, 0.0)  # those are told above
    yield judge.below(
        "distance of facets from the exact surface",
        1e3 * away.max(),
        1e3 * (_BODY * chord_error + permitted),
        "µm",
        place=_where(surface, vertices[faces], away),
    )
    if not part.teeth:
        return
    on_flanks = (corners[surface.flanks] <= permitted).any(axis=0)
    numbers = set(surface.teeth(middles[on_flanks]).tolist())  # a helical rack has parts of more teeth at its ends
    yield judge.equal("number of teeth", part.teeth, len(numbers.intersection(range(part.teeth))))


def _where(surface: Any, triangles: Floats, off: Floats) -> str:
    """Return in words where the greatest of the distances (n,) of triangles (n, 3, 3) is."""
    worst = triangles[int(off.argmax())].mean(axis=0)
    tooth = int(surface.teeth(worst[None])[0])
    x, y, z = (f"{value:.4g}" for value in worst)
    return f"at tooth {tooth}, x {x}, y {y}, z {z} mm"


def _open_edge(mesh: Trimesh) -> str:
    """Return in words where an edge has not two triangles, or "" if all have."""
    edges: Wholes = np.sort(mesh.edges, axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    broken = unique[count != 2]
    if not len(broken):
        return ""
    x, y, z = (f"{value:.4g}" for value in mesh.vertices[broken[0]].mean(axis=0))
    return f"{len(broken)} edges have not two triangles, the first at x {x}, y {y}, z {z} mm"

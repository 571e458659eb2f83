"""Judge of STEP files: read back by the CAD kernel, its solids held against exact integrals and the exact surface."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.core.records import Floats
from gearcad.solids.body_plan import Colour
from gearcad.solids.exact.boundary import Frame
from gearcad.solids.exact.inertia import moments
from gearcad.solids.exact.solid import AssembledProduct, Product, SolidProduct
from gearcad.solids.exact.tooth_layout import accuracy_for
from gearcad.verification.assemblies import OUTLINES, PlacedMesh, PlacedPart, judge_places
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.step_entities import JudgedSolids
from gearcad.verification.surfaces import ExactSurface

_SAME = 1e-6
"""Relative difference of volume, area and inertia that is permitted."""

_FITS = 4
"""Multiple of the accuracy to which sections are fitted that a face may be off the exact surface."""

_LEAST = 1e-6
"""Distance (mm) of corners from the exact surface that is permitted: the kernel's own is 1e-7 mm."""

_OF_SPHERE = [1, 1, 3, 2]
"""Solids, faces, edges and vertices of a sphere as the kernel has it: a seam, and both poles."""


@dataclass(frozen=True, eq=False)
class StepNode:
    """One product as it occurs in a file: its name there and as a product, its place (3, 4), its colour (sRGB), its solid."""

    name: str
    product: str
    place: Floats
    colour: Colour | None
    shape: Any
    children: tuple[StepNode, ...]

    def parts(self) -> Iterator[StepNode]:
        """Yield the parts of the tree, which have no children."""
        if not self.children:
            yield self
        for child in self.children:
            yield from child.parts()


def read_step(path: Path, content: bytes | None = None) -> list[StepNode]:
    """Return the free products of a STEP file with their trees, read by the CAD kernel. Raises ValueError if it cannot.

    With `content` the kernel reads the file, and makes the products of this text.
    """
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDF import TDF_LabelSequence
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    document, reader = TDocStd_Document(TCollection_ExtendedString("BinXCAF")), STEPCAFControl_Reader()
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    read = reader.ReadFile(str(path)) == IFSelect_RetDone
    if read and content is not None:
        reader = STEPCAFControl_Reader()
        read = reader.ReadStream(path.name, BytesIO(content)) == IFSelect_RetDone
    if not read or not reader.Transfer(document):
        raise ValueError("the CAD kernel cannot read it")
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(labels)
    return [_node(labels.Value(i)) for i in range(1, labels.Length() + 1)]


def _node(label: Any) -> StepNode:
    from OCP.TDF import TDF_Label, TDF_LabelSequence
    from OCP.XCAFDoc import XCAFDoc_ShapeTool

    referred = TDF_Label()
    product = referred if XCAFDoc_ShapeTool.GetReferredShape_s(label, referred) else label
    components = TDF_LabelSequence()
    XCAFDoc_ShapeTool.GetComponents_s(product, components)
    turn = XCAFDoc_ShapeTool.GetLocation_s(label).Transformation()
    place = np.array([[turn.Value(i, j) for j in (1, 2, 3, 4)] for i in (1, 2, 3)])
    children = tuple(_node(components.Value(i)) for i in range(1, components.Length() + 1))
    shape = None if children else XCAFDoc_ShapeTool.GetShape_s(product)
    return StepNode(_name(label), _name(product), place, _colour(product), shape, children)


def _name(label: Any) -> str:
    from OCP.TDataStd import TDataStd_Name

    attribute = TDataStd_Name()
    return str(attribute.Get().ToExtString()) if label.FindAttribute(TDataStd_Name.GetID_s(), attribute) else ""


def _colour(label: Any) -> Colour | None:
    """The colour of a product as seen on a screen (sRGB); the kernel has it as shares of light."""
    from OCP.Quantity import Quantity_Color
    from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorTool

    colour = Quantity_Color()
    for kind in (XCAFDoc_ColorSurf, XCAFDoc_ColorGen):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, colour):
            red, green, blue = (on_screen(share) for share in (colour.Red(), colour.Green(), colour.Blue()))
            return red, green, blue
    return None


def on_screen(light: float) -> float:
    """Return the value of a share of light on a screen (IEC 61966-2-1)."""
    return 12.92 * light if light <= 0.0031308 else 1.055 * float(light ** (1 / 2.4)) - 0.055


def of_light(shown: float) -> float:
    """Return the share of light of a value on a screen (IEC 61966-2-1)."""
    return shown / 12.92 if shown <= 0.04045 else float(((shown + 0.055) / 1.055) ** 2.4)


def judge_step(
    path: Path,
    product: Product,
    parts: Mapping[str, ExactPart],
    meshes: Sequence[PlacedMesh] = (),
    judged: JudgedSolids | None = None,
) -> Iterator[Claim]:
    """Judge a STEP file that should hold a product; `parts` are its gears and racks by their names as products.

    `meshes` are those of an assembly, whose gears must be in their places. Solids that are among those `judged`, entity for
    entity, have the same claims; others are added to them.
    """
    judge = Judge(ClaimSubject.STEP, VerificationLevel.FILES, path.name, "Open CASCADE")
    judged = JudgedSolids() if judged is None else judged
    products = solid_products(product)
    try:
        entities = judged.read(path.read_bytes())
        known = judged.known(entities, [made.name for made in products])
        nodes = read_step(path, entities.without_solids() if entities is not None and known else None)
    except Exception as error:  # the kernel may raise anything for a broken file
        yield judge.holds("is read", False, place=f"{type(error).__name__}: {error}")
        return
    yield judge.equal("names and places in the tree", _told_tree(product), "; ".join(_found_tree(node) for node in nodes))
    found: dict[str, StepNode] = {}
    for node in (part for root in nodes for part in root.parts()):
        found.setdefault(node.product, node)
    for made in products:
        where = path.name if isinstance(product, SolidProduct) else f"{path.name}: {made.name}"
        of_part = Judge(judge.subject, judge.level, where, judge.name)
        if made.name not in found:
            yield of_part.holds("is in the file", False, place=f"there is no product {made.name}")
            continue
        node = found[made.name]
        yield of_part.equal("colour", _hex(made.colour), _hex(node.colour))
        if entities is not None and known:
            again = judged.of_sphere(entities, _sphere(node.shape), made.name, where)
            yield from [of_part.holds("has the solid of its part alone", False)] if again is None else again
            continue
        claims = list[Claim]()
        for claim in _judge_solid(of_part, node.shape, made, parts.get(made.name)):
            claims.append(claim)
            yield claim
        if entities is not None and len(products) == 1 == len(entities.solids):
            judged.claims[entities.forms[entities.solids[0]], made.name] = claims
    placed = [part for root in nodes for part in _placed(root)]
    yield from judge_places(Judge(judge.subject, judge.level, path.name, OUTLINES), meshes, placed)


def _placed(node: StepNode, place: Floats | None = None) -> Iterator[PlacedPart]:
    """The parts of a tree in their places."""
    here = (np.eye(4) if place is None else place) @ np.vstack([node.place, [0.0, 0.0, 0.0, 1.0]])
    if not node.children:
        yield PlacedPart(node.product, here[:3])
    for child in node.children:
        yield from _placed(child, here)


def solid_products(product: Product) -> list[SolidProduct]:
    """The different parts of a product."""
    if isinstance(product, SolidProduct):
        return [product]
    every = [part for occurrence in product.occurrences for part in solid_products(occurrence.product)]
    return list(dict.fromkeys(every))


def told_places(product: Product, place: Floats | None = None) -> Iterator[PlacedPart]:
    """Yield the parts of a product in the places where it has them."""
    here = np.eye(4) if place is None else place
    if isinstance(product, SolidProduct):
        yield PlacedPart(product.name, here[:3])
    for each in _occurrences(product):
        yield from told_places(each.product, here @ np.vstack([_matrix(each.frame), [0.0, 0.0, 0.0, 1.0]]))


def _told_tree(product: Product, name: str = "", frame: Frame | None = None) -> str:
    """The tree of a product as text."""
    place = _place_text(_matrix(frame)) if frame is not None else ""
    inside = ", ".join(_told_tree(each.product, each.name, each.frame) for each in _occurrences(product))
    return f"{name or product.name}{place}{f' ({inside})' if inside else ''}"


def _occurrences(product: Product) -> tuple[Any, ...]:
    return product.occurrences if isinstance(product, AssembledProduct) else ()


def _found_tree(node: StepNode, inner: bool = False) -> str:
    place = _place_text(node.place) if inner else ""
    inside = ", ".join(_found_tree(child, inner=True) for child in node.children)
    return f"{node.name or node.product}{place}{f' ({inside})' if inside else ''}"


def _matrix(frame: Frame) -> Floats:
    """Return the homogeneous matrix (3, 4) of a frame."""
    axis, x = np.array(frame.axis), np.array(frame.along)
    return np.column_stack([x, np.cross(axis, x), axis, np.array(frame.origin)])


def _place_text(place: Floats) -> str:
    """Return the place of a part as text: shift (mm), rotation about z (degrees); empty if it is not moved."""
    if np.abs(place - np.eye(3, 4)).max() < 1e-9:
        return ""
    shift = ", ".join(f"{value + 0.0:.6f}" for value in np.round(place[:, 3], 6))
    turn = np.degrees(np.arctan2(place[1, 0], place[0, 0]))
    return f" at {shift} turned {np.round(turn, 6) + 0.0:.6f}"


def _hex(colour: Colour | None) -> str:
    return "none" if colour is None else ", ".join(f"{value:.4f}" for value in colour)


def _judge_solid(judge: Judge, shape: Any, made: SolidProduct, part: ExactPart | None) -> Iterator[Claim]:
    """Judge one solid: validity, closure, volume, area, inertia, and its faces against the exact surface."""
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID

    solids, shells = _within(shape, TopAbs_SOLID), _within(shape, TopAbs_SHELL)
    yield judge.equal("solids", 1, len(solids))
    yield judge.holds("is valid (BRepCheck)", bool(BRepCheck_Analyzer(shape).IsValid()))
    yield judge.holds("is closed", len(shells) == 1 and _closed(shape))
    exact = part.moments if part is not None else moments(made.boundary)
    found, area = _volume(shape), GProp_GProps()
    yield judge.near("volume", exact.volume, found.Mass(), _SAME, "", relative=True)
    if part is None:
        return
    if part.area is None:
        yield judge.not_judged("area", "the exact area is not known with end chamfers")
    else:
        BRepGProp.SurfaceProperties_s(shape, area)
        yield judge.near("area", part.area, area.Mass(), _SAME, "", relative=True)
    if part.gear is not None:
        from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt

        polar = found.MomentOfInertia(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)))
        yield judge.near("moment of inertia about the axis", exact.polar, polar, _SAME, "", relative=True)
    yield from _judge_faces(judge, shape, part)


def _sphere(shape: Any) -> float:
    """Volume (mm³) of a shape that is nothing but a sphere, else 0."""
    from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID, TopAbs_VERTEX

    counts = [len(_within(shape, kind)) for kind in (TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX)]
    return float(_volume(shape).Mass()) if counts == _OF_SPHERE else 0.0


def _volume(shape: Any) -> Any:
    """Properties of the volume of a shape, as the kernel has them."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    found = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, found)
    return found


def _within(shape: Any, kind: Any) -> list[Any]:
    """All shapes of a kind within a shape."""
    from OCP.TopExp import TopExp
    from OCP.TopTools import TopTools_IndexedMapOfShape

    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(i) for i in range(1, found.Extent() + 1)]


def _closed(shape: Any) -> bool:
    """Whether every edge lies between two faces."""
    from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
    from OCP.TopExp import TopExp
    from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

    faces = TopTools_IndexedDataMapOfShapeListOfShape()
    TopExp.MapShapesAndAncestors_s(shape, TopAbs_EDGE, TopAbs_FACE, faces)
    return all(faces.FindFromIndex(i).Extent() == 2 for i in range(1, faces.Extent() + 1))


def _judge_faces(judge: Judge, shape: Any, part: ExactPart) -> Iterator[Claim]:
    """Judge points between the knots of every tooth face, the corners of all faces, and the number of teeth."""
    from OCP.BRep import BRep_Tool
    from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_VERTEX
    from OCP.TopoDS import TopoDS

    surface = part.surface
    corners = np.array([_coordinates(BRep_Tool.Pnt_s(TopoDS.Vertex_s(each))) for each in _within(shape, TopAbs_VERTEX)])
    points, middles = list[Floats](), list[Floats]()
    for face in _within(shape, TopAbs_FACE):
        found = _between_knots(TopoDS.Face_s(face))
        (middles if found is None else points).append(_middle(TopoDS.Face_s(face)) if found is None else found)
    on_edges = (_on_edge(TopoDS.Edge_s(each)) for each in _within(shape, TopAbs_EDGE))
    corners = np.concatenate([corners, *middles, *on_edges])
    off = surface.distances(corners).min(axis=0)
    yield judge.below(
        "distance of edges and plain faces from the exact surface",
        1e3 * off.max(),
        1e3 * _LEAST,
        "µm",
        place=_place(surface, corners, off),
    )
    on_teeth = np.concatenate(points) if points else corners[surface.tooth_distances(corners) <= _LEAST]
    if part.bore is not None:
        assert part.gear is not None
        in_bore = np.hypot(on_teeth[:, 0], on_teeth[:, 1]) <= part.gear.body.bore / 2 + _LEAST
        yield from _judge_bore(judge, on_teeth[in_bore], part.bore)
        on_teeth = on_teeth[~in_bore]
    if points:
        away, permitted = (
            surface.tooth_distances(on_teeth),
            _FITS * accuracy_for(part.gear) if part.gear is not None else _LEAST,
        )
        place = _place(surface, on_teeth, away)
        yield judge.below(
            "distance of tooth faces from the exact surface", 1e3 * away.max(), 1e3 * permitted, "µm", place=place
        )
    if not part.teeth:
        return
    yield judge.equal("number of teeth", part.teeth, len(set(surface.teeth(on_teeth).tolist()).intersection(range(part.teeth))))


def _judge_bore(judge: Judge, points: Floats, bore: ExactPart) -> Iterator[Claim]:
    """Judge points (n, 3) of the faces of a splined bore: on its exact surface, and on all its teeth."""
    away = bore.surface.tooth_distances(points)
    permitted, place = _FITS * accuracy_for(bore.gear) if bore.gear is not None else _LEAST, _place(bore.surface, points, away)
    quantity = "distance of the faces of the splined bore from the exact surface"
    yield judge.below(quantity, 1e3 * away.max(), 1e3 * permitted, "µm", place=place)
    yield judge.equal("number of teeth of the splined bore", bore.teeth, len(set(bore.surface.teeth(points).tolist())))


def _on_edge(edge: Any) -> Floats:
    """Points (3, 3) in mm on an edge, between its ends."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve

    curve = BRepAdaptor_Curve(edge)
    first, last = curve.FirstParameter(), curve.LastParameter()
    return np.array([_coordinates(curve.Value(first + share * (last - first))) for share in (0.25, 0.5, 0.75)])


def _middle(face: Any) -> Floats:
    """Point (1, 3) on a plane, a cylinder or a cone, in the middle of the face's bounds."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.BRepTools import BRepTools

    low_u, high_u, low_v, high_v = BRepTools.UVBounds_s(face)
    point = BRepAdaptor_Surface(face).Value((low_u + high_u) / 2, (low_v + high_v) / 2)
    return np.array([_coordinates(point)])


def _between_knots(face: Any) -> Floats | None:
    """Points (n, 3) on a spline face, as many between two knots as it has poles there, or None for other faces.

    There are points near the greatest effect of every pole.
    """
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_BezierSurface, GeomAbs_BSplineSurface

    adaptor = BRepAdaptor_Surface(face)
    kind = adaptor.GetType()
    if kind == GeomAbs_BSplineSurface:
        spline = adaptor.BSpline()
        knots = [
            [spline.UKnot(i) for i in range(1, spline.NbUKnots() + 1)],
            [spline.VKnot(i) for i in range(1, spline.NbVKnots() + 1)],
        ]
    elif kind == GeomAbs_BezierSurface:
        knots = [[0.0, 1.0], [0.0, 1.0]]
    else:
        return None
    u, v = (_samples(ends, degree) for ends, degree in zip(knots, (adaptor.UDegree(), adaptor.VDegree()), strict=True))
    return np.array([_coordinates(adaptor.Value(one, two)) for one in u for two in v])


def _samples(knots: list[float], degree: int) -> Floats:
    """Parameters between knots: one more than the degree in each stretch."""
    shares = (np.arange(degree + 1) + 0.5) / (degree + 1)
    low, high = np.array(knots[:-1])[:, None], np.array(knots[1:])[:, None]
    samples: Floats = (low + (high - low) * shares).ravel()
    return samples


def _coordinates(point: Any) -> tuple[float, float, float]:
    coordinates: tuple[float, float, float] = point.Coord()
    return coordinates


def _place(surface: ExactSurface, points: Floats, off: Floats) -> str:
    """Return in words where the greatest of the distances (n,) of points (n, 3) is."""
    worst = points[int(off.argmax())]
    x, y, z = (f"{value:.4g}" for value in worst)
    return f"at tooth {int(surface.teeth(worst[None])[0])}, x {x}, y {y}, z {z} mm"

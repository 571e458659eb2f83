"""STEP files by others: as the CAD kernel reads them, two beside each other, and whether the text is well formed."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cadquery
import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepTools import BRepTools
from OCP.IFSelect import IFSelect_RetDone
from OCP.Quantity import Quantity_Color
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorTool, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool


def opened_document(path: Path) -> Any:
    """A document (XCAF) of all that a file has, read by the kernel."""
    document, reader = TDocStd_Document(TCollection_ExtendedString("BinXCAF")), STEPCAFControl_Reader()
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    assert reader.ReadFile(str(path)) == IFSelect_RetDone
    assert reader.Transfer(document)
    return document


_TOKEN = re.compile(
    r"\s*(?:(?P<string>'(?:[^'\\\x00-\x1f\x7f-\U0010ffff]|''|\\\\|\\X\\[0-9A-F]{2}|\\X2\\(?:[0-9A-F]{4})+\\X0\\|\\X4\\(?:[0-9A-F]{8})+\\X0\\)*')"
    r"|(?P<reference>#[1-9][0-9]*)|(?P<real>[+-]?[0-9]+\.[0-9]*(?:E[+-]?[0-9]+)?)|(?P<integer>[+-]?[0-9]+)"
    r"|(?P<enumeration>\.[A-Z][A-Z0-9_]*\.)|(?P<keyword>[A-Z][A-Z0-9_]*)|(?P<mark>[()=,;*$]))"
)
"""6.3 and 6.4: what may stand in the data section, once comments are ruled out."""

_PARAMETERS = {
    "ADVANCED_BREP_SHAPE_REPRESENTATION": 3, "ADVANCED_FACE": 4, "APPLICATION_CONTEXT": 1, "APPLICATION_PROTOCOL_DEFINITION": 4,
    "AXIS2_PLACEMENT_3D": 4, "B_SPLINE_CURVE_WITH_KNOTS": 9, "B_SPLINE_SURFACE_WITH_KNOTS": 13, "CARTESIAN_POINT": 2,
    "CIRCLE": 3, "CLOSED_SHELL": 2, "COLOUR_RGB": 4, "CONICAL_SURFACE": 4, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION": 2,
    "CYLINDRICAL_SURFACE": 3, "DIRECTION": 2, "EDGE_CURVE": 5, "EDGE_LOOP": 2, "ELLIPSE": 4, "FACE_BOUND": 3,
    "FILL_AREA_STYLE": 2, "FILL_AREA_STYLE_COLOUR": 2, "GEOMETRIC_REPRESENTATION_CONTEXT": 1,
    "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT": 1, "GLOBAL_UNIT_ASSIGNED_CONTEXT": 1, "ITEM_DEFINED_TRANSFORMATION": 4,
    "LENGTH_MEASURE": 1, "LENGTH_UNIT": 0, "LINE": 3, "MANIFOLD_SOLID_BREP": 2,
    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION": 3, "NAMED_UNIT": 1, "NEXT_ASSEMBLY_USAGE_OCCURRENCE": 6,
    "ORIENTED_EDGE": 5, "PLANE": 2, "PLANE_ANGLE_UNIT": 0, "PRESENTATION_STYLE_ASSIGNMENT": 1, "PRODUCT": 4,
    "PRODUCT_CONTEXT": 3, "PRODUCT_DEFINITION": 4, "PRODUCT_DEFINITION_CONTEXT": 3, "PRODUCT_DEFINITION_FORMATION": 3,
    "PRODUCT_DEFINITION_SHAPE": 3, "PRODUCT_RELATED_PRODUCT_CATEGORY": 3, "REPRESENTATION_CONTEXT": 2,
    "REPRESENTATION_RELATIONSHIP": 4, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION": 1,
    "SHAPE_DEFINITION_REPRESENTATION": 2,
    "SHAPE_REPRESENTATION": 3, "SHAPE_REPRESENTATION_RELATIONSHIP": 0, "SI_UNIT": 2, "SOLID_ANGLE_UNIT": 0, "STYLED_ITEM": 3,
    "SURFACE_SIDE_STYLE": 2, "SURFACE_STYLE_FILL_AREA": 1, "SURFACE_STYLE_USAGE": 2, "UNCERTAINTY_MEASURE_WITH_UNIT": 4,
    "VECTOR": 3, "VERTEX_POINT": 2,
}  # fmt: skip
"""Entities of AP214 that solids and assemblies need, and how many parameters each has."""

_TOP = {
    "APPLICATION_PROTOCOL_DEFINITION", "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", "PRODUCT_RELATED_PRODUCT_CATEGORY",
    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION", "SHAPE_DEFINITION_REPRESENTATION",
}  # fmt: skip
"""Those that nothing refers to."""


@dataclass(frozen=True)
class CheckedText:
    """How many entities of each kind there are, and how long the longest line is."""

    kinds: Counter[str]
    longest: int


def checked_text(text: str) -> CheckedText:
    """Check a file: AssertionError where it is none."""
    head, data = text.split("DATA;\n")
    assert text.isascii()
    assert head.startswith("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(") and head.endswith("ENDSEC;\n")
    data, end = data.rsplit("ENDSEC;\n", 1)
    assert end == "END-ISO-10303-21;\n"
    defined, referred, kinds = set[str](), set[str](), Counter[str]()
    for number, kind, references in _entities(data):
        assert number not in defined, f"{number} twice"
        defined.add(number)
        referred |= references
        kinds[kind] += 1
        if kind in _TOP:
            referred.add(number)
    assert referred == defined, (sorted(referred - defined)[:5], sorted(defined - referred)[:5])
    return CheckedText(kinds, max(map(len, text.splitlines())))


def _entities(data: str) -> list[tuple[str, str, set[str]]]:
    """Number, kind and references of each entity."""
    found, tokens, at = [], list[tuple[str, str]](), 0
    data = data.rstrip()
    while at < len(data):
        match = _TOKEN.match(data, at)
        assert match is not None, data[at : at + 60]
        at = match.end()
        assert match.lastgroup is not None
        if match[match.lastgroup] == ";":
            found.append(_entity(tokens))
            tokens = []
        else:
            tokens.append((match.lastgroup, match[match.lastgroup]))
    assert not tokens
    return found


def _entity(tokens: list[tuple[str, str]]) -> tuple[str, str, set[str]]:
    (kind, number), (_, equals), *rest = tokens
    assert (kind, equals) == ("reference", "="), tokens[:4]
    words = [text for kind, text in rest if kind == "keyword"]
    assert words and set(words) <= set(_PARAMETERS), words
    names = rest[1:-1] if rest[0][1] == "(" else rest  # several types at once
    at = 0
    while at < len(names):
        assert names[at][0] == "keyword", names[at]
        at = _instance(names, at)
    name = "" if rest[0][1] == "(" else words[0]
    return number, name, {text for kind, text in rest if kind == "reference"}


def _instance(tokens: list[tuple[str, str]], at: int) -> int:
    """Behind a type and its parameters, which are as many as it has."""
    name, depth, count, empty = tokens[at][1], 0, 0, True
    assert tokens[at + 1][1] == "("
    for place in range(at + 1, len(tokens)):
        text = tokens[place][1]
        if text == "(" or (tokens[place][0] == "keyword"):
            depth += text == "("
            empty = empty and depth < 2
        elif text == ")":
            depth -= 1
            if depth == 0:
                assert count + (not empty) == _PARAMETERS[name], (name, count, tokens[at : place + 1])
                return place + 1
        elif text == "," and depth == 1:
            count += 1
        else:
            empty = False
    raise AssertionError(f"{name} has no end")


SAME = 1e-9
"""Relative, and in mm: the kernel writes 13 digits."""

_GRID = np.linspace(0.0, 1.0, 5)


@dataclass(frozen=True)
class Node:
    """A product as one occurs: its name there, its own, its place (12 numbers), its colour; what it consists of."""

    name: str
    product: str
    place: tuple[float, ...]
    colour: tuple[float, ...]
    children: tuple[Node, ...]


def assert_same_solids(ours: Path, witness: Path) -> None:
    """Both files have the same valid closed solids, face by face."""
    found, expected = (cadquery.importers.importStep(str(path)).solids().vals() for path in (ours, witness))
    assert len(found) == len(expected) > 0
    for solid, other in zip(found, expected, strict=True):
        _assert_whole(solid)
        assert _counts(solid) == _counts(other)
        size = max(1.0, other.BoundingBox().DiagonalLength)
        for one, two in ((solid.Volume(), other.Volume()), (solid.Area(), other.Area())):
            assert abs(one - two) <= SAME * abs(two), (one, two)
        assert (solid.Center() - other.Center()).Length <= SAME * size
        for face, same in zip(solid.Faces(), other.Faces(), strict=True):
            assert np.abs(_points(face) - _points(same)).max() <= SAME * size


def _assert_whole(solid: Any) -> None:
    assert BRepCheck_Analyzer(solid.wrapped).IsValid()
    (shell,) = solid.Shells()
    assert shell.wrapped.Closed()
    faces = TopTools_IndexedDataMapOfShapeListOfShape()
    TopExp.MapShapesAndAncestors_s(solid.wrapped, TopAbs_EDGE, TopAbs_FACE, faces)
    assert all(faces.FindFromIndex(i).Extent() == 2 for i in range(1, faces.Extent() + 1))


def _counts(solid: Any) -> tuple[int, ...]:
    return len(solid.Faces()), len(solid.Edges()), len(solid.Vertices()), len(solid.Wires())


def _points(face: Any) -> np.ndarray:
    """Points (25, 3) of a face's surface, between the bounds of the face."""
    surface, bounds = BRepAdaptor_Surface(face.wrapped), BRepTools.UVBounds_s(face.wrapped)
    low_u, high_u, low_v, high_v = bounds
    at = [surface.Value(low_u + s * (high_u - low_u), low_v + t * (high_v - low_v)) for s in _GRID for t in _GRID]
    return np.array([(point.X(), point.Y(), point.Z()) for point in at])


def product_tree(path: Path) -> tuple[Node, ...]:
    """The products of a file as they stand in each other; numbers to 1e-6, so that trees can be compared."""
    document = opened_document(path)
    shapes, labels = XCAFDoc_DocumentTool.ShapeTool_s(document.Main()), TDF_LabelSequence()
    shapes.GetFreeShapes(labels)
    return tuple(_node(labels.Value(i)) for i in range(1, labels.Length() + 1))


def _node(label: Any) -> Node:
    product = TDF_Label()
    made = product if XCAFDoc_ShapeTool.GetReferredShape_s(label, product) else label
    parts = TDF_LabelSequence()
    XCAFDoc_ShapeTool.GetComponents_s(made, parts)
    place = XCAFDoc_ShapeTool.GetLocation_s(label).Transformation()
    numbers = tuple(round(place.Value(i, j), 6) + 0.0 for i in (1, 2, 3) for j in (1, 2, 3, 4))
    children = tuple(_node(parts.Value(i)) for i in range(1, parts.Length() + 1))
    return Node(_name(label), _name(made), numbers, _colour(made), children)


def _name(label: Any) -> str:
    attribute = TDataStd_Name()
    return attribute.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), attribute) else ""


def _colour(label: Any) -> tuple[float, ...]:
    colour = Quantity_Color()
    for kind in (XCAFDoc_ColorSurf, XCAFDoc_ColorGen):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, colour):
            return tuple(round(value, 5) for value in (colour.Red(), colour.Green(), colour.Blue()))
    return ()

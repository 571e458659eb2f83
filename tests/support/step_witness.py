"""Solids of two STEP files beside each other, read by the CAD kernel: are they whole, and are they the same?"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cadquery
import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepTools import BRepTools
from OCP.Quantity import Quantity_Color
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorTool, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from support.kernel_step import opened_document

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

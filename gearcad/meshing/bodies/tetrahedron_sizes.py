"""How long the edges of tetrahedra shall be on each face of a gear."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, fields

import numpy as np

from gearcad.errors import require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.turned import flank_curves
from gearcad.meshing.bodies.brep import BrepFace, EdgeLengths, Surface
from gearcad.meshing.bodies.gear_faces import GearFace

__all__ = ["TetrahedronGrading", "edge_lengths", "expected_tetrahedra"]

_FILLET_ANGLE = math.radians(30)
"""Standards of stress in fillets count elements over so much of an arc."""

_ROUND = 24
"""Least edges round a bore or a hub."""

_NARROW = 2.0
"""Edges are at most so many times as long as a face is wide: flatter tetrahedra would be poor ones."""

_ABOVE, _GROWN = 0.9, 0.6
"""Tetrahedra above a triangle of the surface: this many, and so many over the growth; measured on many gears."""

_THIN = 1.5
"""Least edges through a rim, or over the face width."""


@dataclass(frozen=True, kw_only=True)
class TetrahedronGrading:
    """How edges of tetrahedra differ in length, beside the one size that is asked for.

    At least `fillet_elements` stand over 30 degrees of a fillet. On refined teeth edges are `refinement` times as fine. Inwards
    they grow by `growth` times the distance, up to `inside` times the size. Raises ParameterError.
    """

    fillet_elements: float = 1.0
    refinement: float = 3.0
    inside: float = 6.0
    growth: float = 0.3

    def __post_init__(self) -> None:
        for each in fields(self):
            require_number(each.name, getattr(self, each.name), above=0)


def edge_lengths(
    gear: Gear,
    size: float,
    grading: TetrahedronGrading,
    refined: Collection[int],
    told: Sequence[GearFace],
    faces: Sequence[BrepFace],
) -> EdgeLengths:
    """Lengths on these faces, of which it was told what they are: `size` (mm) on teeth that are not `refined`, and less."""
    fillet = _least_radius(gear) * _FILLET_ANGLE / grading.fillet_elements
    inside = min(grading.inside * size, _thickness(gear) / _THIN)
    kinds = [curve.curve.kind for curve in flank_curves(gear)]

    def wanted(face: GearFace) -> float:
        finer = grading.refinement if face.tooth in refined else 1.0
        if face.curve is not None and kinds[face.curve] is CurveKind.FILLET:
            return min(size, fillet) / finer
        if face.surface is Surface.CYLINDER and face.radius < gear.root_diameter / 2:
            return min(inside, 2 * math.pi * face.radius / _ROUND)
        return min(size, inside) / finer if face.surface in (Surface.SPLINE, Surface.CYLINDER) else inside

    return EdgeLengths(
        [min(wanted(face), _NARROW * shape.width) for face, shape in zip(told, faces, strict=True)], inside, grading.growth
    )


def expected_tetrahedra(lengths: EdgeLengths, faces: Sequence[BrepFace]) -> float:
    """About how many there will be: most stand on the triangles of the surface, the more the slower edges grow inwards."""
    triangles = sum(face.area / length**2 for face, length in zip(faces, lengths.faces, strict=True)) * 4 / math.sqrt(3)
    return triangles * (_ABOVE + _GROWN / lengths.growth)


def _least_radius(gear: Gear) -> float:
    """Least radius of curvature (mm) of a fillet. It is less in the section normal to the helix than in the transverse one."""
    s = np.linspace(0.0, 1.0, 257)
    least = math.inf
    for piece in flank_curves(gear):
        if piece.curve.kind is CurveKind.FILLET:
            length = np.hypot(*np.diff(piece.curve.points(s), axis=0).T)
            least = min(least, float((length / np.abs(np.diff(piece.curve.direction(s)))).min()))
    return least * math.cos(math.radians(gear.helix_angle)) ** 2


def _thickness(gear: Gear) -> float:
    """The least of rim, hub and face width (mm), whatever there is of them."""
    body = gear.body
    rim = (gear.root_diameter - body.opening_diameter) / 2
    hub = (body.hub_diameter - body.opening_diameter) / 2 if body.hub_diameter else math.inf
    return min(gear.face_width, rim, hub)

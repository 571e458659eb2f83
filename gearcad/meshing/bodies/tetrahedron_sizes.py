"""How long the edges of tetrahedra shall be on each face of a gear."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, fields

import numpy as np

from gearcad.errors import require_number
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind
from gearcad.geometry.turned import flank_curves
from gearcad.meshing.bodies.brep import BrepFace, EdgeLengths, RadialLengths, Surface
from gearcad.meshing.bodies.gear_faces import ROOT, GearFace
from gearcad.meshing.section.edge_lengths import bent_lengths
from gearcad.meshing.section.outline import EdgeLength, MeshSizes

__all__ = ["FILLET_ANGLE", "TetrahedronGrading", "edge_lengths", "expected_tetrahedra"]

FILLET_ANGLE = 30.0
"""Standards of stress in fillets count elements over so much of an arc (deg)."""

_PLACES = 1025
"""Places of a curve at which lengths are kept."""

_CUSP, _SLACK = 0.03, 2.5
"""Where an involute begins at its base circle it bends without end, and an edge of length h is off by so much of
h (h/r_b)^(1/2), measured; there edges may be off this many times as far as they should, else lengths would vanish.
"""

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

    At least `fillet_elements` stand over 30 degrees of a fillet, and edges in transverse sections are at most about `deviation`
    (µm) off the curve; None: as far as comes of it. On refined teeth edges are `refinement` times as fine. Inwards they grow by
    `growth` times the distance, up to `inside` times the size. Raises ParameterError.
    """

    fillet_elements: float = 1.0
    deviation: float | None = 0.1
    refinement: float = 3.0
    inside: float = 6.0
    growth: float = 0.3

    def __post_init__(self) -> None:
        for each in fields(self):
            if (value := getattr(self, each.name)) is not None:
                require_number(each.name, value, above=0)


def edge_lengths(
    gear: Gear,
    size: float,
    grading: TetrahedronGrading,
    refined: Collection[int],
    told: Sequence[GearFace],
    faces: Sequence[BrepFace],
) -> EdgeLengths:
    """Lengths on these faces, of which it was told what they are: `size` (mm) on teeth that are not `refined`, and less."""
    inside = min(grading.inside * size, _thickness(gear) / _THIN)
    size = min(size, inside)
    usual = _along_flanks(gear, size, grading)
    fine = {kind: lengths.refined(grading.refinement) for kind, lengths in usual.items()}
    kinds = [curve.curve.kind for curve in flank_curves(gear)]

    def wanted(face: GearFace) -> float:
        if face.surface is Surface.CYLINDER and not (face.name == ROOT or face.name.startswith("tip")):
            return min(inside, 2 * math.pi * face.radius / _ROUND)
        if face.surface not in (Surface.SPLINE, Surface.CYLINDER):
            return inside
        return size / grading.refinement if face.tooth in refined else size

    limits = [min(wanted(face), _NARROW * shape.width) for face, shape in zip(told, faces, strict=True)]
    radial = [None if face.curve is None else (fine if face.tooth in refined else usual)[kinds[face.curve]] for face in told]
    return EdgeLengths(limits, radial, inside, grading.growth)


def _along_flanks(gear: Gear, size: float, grading: TetrahedronGrading) -> dict[CurveKind, RadialLengths]:
    """Lengths on what flanks are swept from, as sections have them: at most `size` (mm), less where they bend."""
    module, cosine = gear.normal_module, math.cos(math.radians(gear.helix_angle))
    plain = dict.fromkeys(("flank", "corner", "fillet", "outline", "cut", "rim"), size / module)
    turn = FILLET_ANGLE * cosine**2 / grading.fillet_elements  # in the section normal to the helix fillets bend the more
    off = None if grading.deviation is None else grading.deviation / 1000 / module
    sizes = MeshSizes(**plain, growth=grading.growth, fillet_turn=turn, deviation=off)
    lengths = bent_lengths(gear, sizes).curves
    base = gear.profile.base_diameter / 2
    least = 0.0 if off is None else min(size, base * (_SLACK * off * module / _CUSP / base) ** (2 / 3))
    return {
        curve.kind: _by_radius(curve, lengths[curve.kind], least)
        for curve in gear.profile.curves
        if curve.kind not in (CurveKind.ROOT, CurveKind.TIP)
    }


def _by_radius(curve: Curve, length: EdgeLength, least: float) -> RadialLengths:
    """Lengths over the radius, `least` (mm) at the least."""
    s = np.linspace(0.0, 1.0, _PLACES)
    run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(curve.points(s), axis=0).T))]
    lengths, radius = np.maximum(length(run, float(run[-1])), least), curve.polar(s)[0]
    mean = float(np.trapezoid(lengths**-2, run) / run[-1]) ** -0.5
    if radius[-1] < radius[0]:
        lengths, radius = lengths[::-1], radius[::-1]
    even = np.linspace(radius[0], radius[-1], _PLACES)
    return RadialLengths(float(even[0]), float(even[1] - even[0]), np.interp(even, radius, lengths).tolist(), mean)


def expected_tetrahedra(lengths: EdgeLengths, faces: Sequence[BrepFace]) -> float:
    """About how many there will be: most stand on the triangles of the surface, the more the slower edges grow inwards."""
    usual = [
        limit if radial is None else min(limit, radial.mean)
        for limit, radial in zip(lengths.faces, lengths.radial, strict=True)
    ]
    triangles = sum(face.area / length**2 for face, length in zip(faces, usual, strict=True)) * 4 / math.sqrt(3)
    return triangles * (_ABOVE + _GROWN / lengths.growth)


def _thickness(gear: Gear) -> float:
    """The least of rim, hub and face width (mm), whatever there is of them."""
    body, root = gear.body, gear.profile.root_diameter
    outside = body.rim_diameter or root
    rim = (outside - root if gear.internal else root - body.opening_diameter) / 2
    hub = (body.hub_diameter - body.opening_diameter) / 2 if body.hub_diameter else math.inf
    return min(gear.face_width, rim, hub)

"""Outline and mesh of a tooth of a rack in its transverse section, with its share of the body down to the back.

The frame is that in which a wheel's tooth 0 stands on +x: x is the height over the reference line, tips up, and y runs along
the rack, so that the left flanks, y > 0, carry and sectors follow each other along y.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats
from gearcad.geometry import Rack
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.rack_root import FilletArc, RackCurve, RackCurveKind
from gearcad.meshing.outline import OTHER_SIDE, EdgeLength, MeshSizes, OutlineSide, Stretch, graded, graded_cut, plain_lengths
from gearcad.meshing.sector import SectorMesh, fill_polygon, quadratic_sector

_SIDES = {
    RackCurveKind.ROOT: OutlineSide.LEFT_ROOT,
    RackCurveKind.FILLET: OutlineSide.LEFT_FILLET,
    RackCurveKind.FLANK: OutlineSide.LEFT_FLANK,
    RackCurveKind.CHAMFER: OutlineSide.TIP,
    RackCurveKind.TIP: OutlineSide.TIP,
}

_KINDS = {
    RackCurveKind.ROOT: CurveKind.ROOT,
    RackCurveKind.FILLET: CurveKind.FILLET,
    RackCurveKind.FLANK: CurveKind.INVOLUTE,
    RackCurveKind.CHAMFER: CurveKind.CHAMFER,
    RackCurveKind.TIP: CurveKind.TIP,
}

_OF_RADIUS = 7.6
"""Edges of a fillet are at most its radius over this: those of the usual size in a fillet of 0.38 m_n."""


@dataclass(frozen=True)
class FineZone:
    """Edges of `edge` (mm) over `half_width` (mm) on both sides of a place of a flank, the left one or not.

    The place is as far above the reference line along the flank as `along` (mm).
    """

    along: float
    half_width: float
    edge: float
    left: bool


def rack_outline(rack: Rack, sizes: MeshSizes, zone: FineZone | None = None) -> list[Stretch]:
    """Return the closed outline of tooth 0 and its share of the body, in the order of `SectorSides`.

    One of its flanks may have a fine zone. Raises GeometryError for a tooth without a fillet.
    """
    if not any(curve.kind is RackCurveKind.FILLET for curve in rack.profile.curves):
        permitted = "must be larger for finite elements: the sharp tool leaves a corner and no fillet"
        raise GeometryError("rack.root_radius", rack.root_radius, permitted, "m_n")
    half = rack.transverse_pitch / 2
    own = {zone.left: zone} if zone is not None else {}
    first, second = (_half_tooth(rack, sizes, loaded=left, zone=own.get(left)) for left in (False, True))
    root, back_height = -rack.root_depth, -rack.height

    def down(s: Floats) -> Floats:
        return np.stack([root + s * (back_height - root), np.full_like(s, half)], -1)

    cut = graded_cut(down, sizes, rack.normal_module)
    behind = cut.mirrored(OutlineSide.BEHIND).backwards()
    last = float(np.hypot(*(cut.ends[-1] - cut.ends[-2])))
    edges = max(1, math.ceil(2 * half / last))
    back = np.stack([np.full(2 * edges + 1, back_height), np.linspace(half, -half, 2 * edges + 1)], -1)
    return [
        *(stretch.mirrored(OTHER_SIDE[stretch.side]) for stretch in first),
        *(stretch.backwards() for stretch in reversed(second)),
        cut,
        Stretch(OutlineSide.HELD, back),
        behind,
    ]


def mesh_rack_sector(rack: Rack, sizes: MeshSizes, zone: FineZone | None = None) -> SectorMesh:
    """Mesh tooth 0 of the rack's transverse section down to its back. Raises SolverError if gmsh fails, GeometryError for a
    tooth without a fillet.
    """
    outline = rack_outline(rack, sizes, zone)
    points, triangles = fill_polygon(np.concatenate([stretch.ends[:-1] for stretch in outline]))
    return quadratic_sector(points, triangles, outline, straight=True)


def _half_tooth(rack: Rack, sizes: MeshSizes, *, loaded: bool, zone: FineZone | None) -> list[Stretch]:
    """Return the stretches of the left half, from the middle of the space to the middle of the tooth."""
    lengths, profile = plain_lengths(rack.normal_module, sizes, loaded=loaded), rack.profile
    if zone is None:
        return [_stretch(curve, lengths[_KINDS[curve.kind]], sizes.fillet_turn) for curve in profile.curves]
    # Distances from the zone are counted along the outline from where the flank begins.
    cosine = math.cos(math.radians(rack.transverse_pressure_angle))
    place, found, before = zone.along + profile.form_depth / cosine, list[Stretch](), 0.0
    kinds = [curve.kind for curve in profile.curves]
    before = -sum(map(_length, profile.curves[: kinds.index(RackCurveKind.FLANK)]))
    for curve in profile.curves:
        found.append(_stretch(curve, lengths[_KINDS[curve.kind]], sizes.fillet_turn, zone, place - before))
        before += _length(curve)
    return found


def _length(curve: RackCurve) -> float:
    """Return the length (mm) of a curve."""
    return float(np.hypot(*np.diff(curve.points(np.linspace(0.0, 1.0, _PLACES)), axis=0).T).sum())


_PLACES = 129
"""Places at which a curve is measured."""

_ZONE_GROWTH = 0.25
"""Growth of edges beside a fine zone, over the distance from it."""


def _stretch(
    curve: RackCurve, length: EdgeLength, turned: float | None, zone: FineZone | None = None, place: float = 0.0
) -> Stretch:
    """Return a curve with edges of the wanted lengths, finer in small radii, and near a zone at a `place` (mm) along it.

    Edges of fillets turn by `turned` (deg) at the most, if it is given.
    """

    def size(run: Floats, whole: float) -> Floats:
        wanted = length(run, whole)
        if zone is not None:
            wanted = np.minimum(wanted, zone.edge + _ZONE_GROWTH * np.maximum(np.abs(run - place) - zone.half_width, 0.0))
        if not isinstance(curve, FilletArc):
            return wanted
        turn = 1 / _OF_RADIUS if turned is None else math.radians(turned)
        return np.minimum(wanted, turn * curve.radius)

    def points(s: Floats) -> Floats:
        along, height = np.moveaxis(curve.points(s), -1, 0)
        return np.stack([height, -along], -1)

    grading = graded(points, size)
    edges = max(1, math.ceil(grading.edges - 1e-9))
    return Stretch(_SIDES[curve.kind], points(grading.ends(2 * edges)))

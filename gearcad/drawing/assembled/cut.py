"""What the plane of a section through its axis cuts of a gear, a ring or a rack. Lengths of the part in mm.

The plane has z along the axes and y across them, the keyway and a bolt hole turned into it, upwards.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

from gearcad.drawing.assembled.hiding import Polygon, Segment
from gearcad.drawing.gear_views.meridian import strips
from gearcad.drawing.shapes import Point
from gearcad.geometry import Gear, Rack
from gearcad.rating.rim import outer_diameter
from gearcad.solids.cone import EndCone

__all__ = ["Cut", "cut_gear", "cut_rack"]


@dataclass(frozen=True)
class Cut:
    """What is cut: `areas` of material, hatched up to the roots, and `teeth` beyond them, which are not.

    `edges` are lines of the part that lie behind the plane, `axes` centre lines of holes; nothing of other parts is seen
    behind the `opening` of a bore, whose far wall is there.
    """

    areas: tuple[Polygon, ...]
    teeth: tuple[Polygon, ...] = ()
    edges: tuple[Segment, ...] = ()
    axes: tuple[Segment, ...] = ()
    opening: tuple[Polygon, ...] = ()
    broken: tuple[Segment, ...] = ()
    """Edges of areas where a part goes on, nobody said how far: a ring without a rim."""

    @property
    def covers(self) -> tuple[Polygon, ...]:
        """Behind which nothing of other parts is seen."""
        return self.areas + self.teeth + self.opening


@dataclass(frozen=True)
class _Half:
    """The outline of a gear above its axis, z from the bottom of its teeth: (z, r) left to right."""

    roots: tuple[Point, ...]
    """The body under the teeth, its hubs and the groove between halves with it."""

    teeth: tuple[Polygon, ...]


def cut_gear(gear: Gear, z: float = 0.0, height: float = 0.0) -> Cut:
    """A gear whose teeth begin at `z`, its axis at a `height` (mm)."""
    return _placed(_ring(gear) if gear.internal else _disc(gear), z, height)


def cut_rack(rack: Rack, z: float, height: float) -> Cut:
    """A rack square to its length, teeth up, its reference line at a `height` (mm), its end face at `z`."""
    width, root, tip = rack.face_width, -rack.root_depth, rack.tip_height
    body = ((0.0, -rack.height), (width, -rack.height), (width, root), (0.0, root))
    return _placed(Cut((body,), (((0.0, root), (0.0, tip), (width, tip), (width, root)),)), z, height)


def _half(gear: Gear) -> _Half:
    cone, root, tip = EndCone.of(gear), gear.profile.root_diameter / 2, gear.profile.tip_diameter / 2
    chamfer, face = gear.body.end_chamfer, cone.face_radius if cone.present else tip
    into = max(cone.side * (root - face), 0.0)  # a cone may go deeper than the teeth
    setback = into / cone.slope
    back, front = gear.body.hub_ends
    hub, groove = gear.body.hub_diameter / 2, abs(gear.gap_diameter) / 2
    roots: list[Point] = [(-back, hub), (0.0, hub)] if back else []
    teeth: list[Polygon] = []
    for number, (low, high) in enumerate(strips(gear)):
        if number:
            roots += [(roots[-1][0], groove), (low, groove)]
        ends = [(low, face), (low + setback, root), (high - setback, root), (high, face)]
        roots += ends if into else [(low, root), (high, root)]
        flat = [(low + chamfer, tip), (high - chamfer, tip)]
        outline = ends[1:2] + flat + ends[2:3] if into else [(low, root), (low, face), *flat, (high, face), (high, root)]
        teeth.append(tuple(dict.fromkeys(outline)))
    if front:
        roots += [(gear.face_width, hub), (gear.face_width + front, hub)]
    return _Half(tuple(dict.fromkeys(roots)), tuple(teeth))


def _disc(gear: Gear) -> Cut:
    half, body = _half(gear), gear.body
    left, right = half.roots[0][0], half.roots[-1][0]
    teeth = half.teeth + tuple(map(_mirrored, half.teeth))
    if not body.bore:
        return Cut(((*half.roots, *_mirrored(half.roots)[::-1]),), teeth)
    bore = body.bore / 2
    opening = bore + body.keyway_depth
    upper = (*half.roots, (right, opening), (left, opening))
    lower = _mirrored((*half.roots, (right, bore), (left, bore)))
    edges: list[Segment] = [((z, -bore), (z, opening)) for z in (left, right)]
    if body.keyway_width:
        side = math.sqrt(bore**2 - (body.keyway_width / 2) ** 2)
        edges.append(((left, side), (right, side)))
    through = ((left, -bore), (right, -bore), (right, opening), (left, opening))
    return Cut((upper, lower), teeth, tuple(edges), opening=(through,))


def _ring(gear: Gear) -> Cut:
    half, body = _half(gear), gear.body
    rim, width = outer_diameter(gear) / 2, gear.face_width
    areas: list[Polygon] = []
    axes: list[Segment] = []
    edges = _openings(gear)
    hole = body.bolt_circle / 2
    inner, outer = hole - body.bolt_diameter / 2, hole + body.bolt_diameter / 2
    for mirror, holed in ((_same, body.bolt_holes > 0), (_mirrored, body.bolt_holes > 0 and body.bolt_holes % 2 == 0)):
        if not holed:
            areas.append(mirror((*half.roots, (width, rim), (0.0, rim))))
            continue
        areas.append(mirror((*half.roots, (width, inner), (0.0, inner))))
        areas.append(mirror(((0.0, outer), (width, outer), (width, rim), (0.0, rim))))
        edges += [_ends(mirror(((z, inner), (z, outer)))) for z in (0.0, width)]
        axes.append(_ends(mirror(((0.0, hole), (width, hole)))))
    teeth = half.teeth + tuple(map(_mirrored, half.teeth))
    broken = () if body.rim_diameter else tuple(_ends(((0.0, side * rim), (width, side * rim))) for side in (1, -1))
    return Cut(tuple(areas), teeth, tuple(edges), tuple(axes), broken=broken)


def _openings(gear: Gear) -> list[Segment]:
    """The circles of a ring's teeth behind the plane, where they begin and end: lines across its opening."""
    cone, tip = EndCone.of(gear), gear.profile.tip_diameter / 2
    circles: list[Point] = []
    for low, high in strips(gear):
        circles += [(z, cone.face_radius if cone.present else tip) for z in (low, high)]
        if cone.present:
            circles += [(z, tip) for z in (low + gear.body.end_chamfer, high - gear.body.end_chamfer)]
    return [((z, -radius), (z, radius)) for z, radius in circles]


def _same(polygon: Polygon) -> Polygon:
    return polygon


def _mirrored(polygon: Polygon) -> Polygon:
    """Below the axis."""
    return tuple((z, -r) for z, r in polygon)


def _ends(points: Polygon) -> Segment:
    start, end = points
    return start, end


def _placed(cut: Cut, z: float, height: float) -> Cut:
    move = partial(_moved, z=z, height=height)
    return Cut(
        tuple(map(move, cut.areas)),
        tuple(map(move, cut.teeth)),
        tuple(_ends(move(each)) for each in cut.edges),
        tuple(_ends(move(each)) for each in cut.axes),
        tuple(map(move, cut.opening)),
        tuple(_ends(move(each)) for each in cut.broken),
    )


def _moved(points: Polygon, z: float, height: float) -> Polygon:
    return tuple((x + z, y + height) for x, y in points)

"""What the plane of a section through its axis cuts of a gear, a ring or a rack. Lengths of the part in mm.

The plane has z along the axes and y across them, the keyway and a bolt hole turned into it, upwards.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

from gearcad.drawing.assembled.hiding import Polygon, Segment
from gearcad.drawing.gear_views.meridian import Corner, along_strip, contour, opening_radius, overall, strips
from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.geometry import Gear, Rack

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


def cut_gear(gear: Gear, z: float = 0.0, height: float = 0.0) -> Cut:
    """A gear whose teeth begin at `z`, its axis at a `height` (mm)."""
    return _placed(_ring(gear) if gear.internal else _disc(gear), z, height)


def cut_rack(rack: Rack, z: float, height: float) -> Cut:
    """A rack square to its length, teeth up, its reference line at a `height` (mm), its end face at `z`."""
    width, root, tip = rack.face_width, -rack.root_depth, rack.tip_height
    body = ((0.0, -rack.height), (width, -rack.height), (width, root), (0.0, root))
    return _placed(Cut((body,), (((0.0, root), (0.0, tip), (width, tip), (width, root)),)), z, height)


def _disc(gear: Gear) -> Cut:
    body, (left, right), root = gear.body, overall(gear), gear.root_diameter / 2
    strip = partial(along_strip, gear)
    halves = [_tooth(strip(*ends, root), strip(*ends, gear.tip_diameter / 2)) for ends in strips(gear)]
    teeth = (*halves, *map(_mirrored, halves))
    if not body.bore:
        half = contour(gear, root, 0.0)[1:-1]
        return Cut(((*half, *_mirrored(half)[::-1]),), teeth)
    bore, opening = body.bore / 2, opening_radius(gear)
    edges: list[Segment] = [((z, -bore), (z, opening)) for z in (left, right)]
    if body.keyway_width:
        side = math.sqrt(bore**2 - (body.keyway_width / 2) ** 2)
        edges.append(((left, side), (right, side)))
    through = ((left, -bore), (right, -bore), (right, opening), (left, opening))
    areas = (tuple(contour(gear, root, opening)), _mirrored(contour(gear, root, bore)))
    return Cut(areas, teeth, tuple(edges), opening=(through,))


def _ring(gear: Gear) -> Cut:
    ring, body, width = Meridian(gear, 1.0), gear.body, gear.face_width
    rim, roots = ring.rim, ring.along_teeth(ring.root)
    areas: list[Polygon] = []
    axes: list[Segment] = []
    edges: list[Segment] = [((z, -radius), (z, radius)) for z, radius in ring.edges]
    for mirror, holed in ((_same, body.bolt_holes > 0), (_mirrored, body.bolt_holes > 0 and body.bolt_holes % 2 == 0)):
        if ring.holes is None or not holed:
            areas.append(mirror((*roots, (width, rim), (0.0, rim))))
            continue
        inner, outer = ring.holes
        areas.append(mirror((*roots, (width, inner), (0.0, inner))))
        areas.append(mirror(((0.0, outer), (width, outer), (width, rim), (0.0, rim))))
        edges += [_ends(mirror(((z, inner), (z, outer)))) for z in (0.0, width)]
        axes.append(_ends(mirror(((0.0, sum(ring.holes) / 2), (width, sum(ring.holes) / 2)))))
    tooth = _tooth(roots, ring.along_teeth(ring.tip))
    broken = tuple(_ends(((0.0, side * rim), (width, side * rim))) for side in (1, -1)) if ring.is_open else ()
    return Cut(tuple(areas), (tooth, _mirrored(tooth)), tuple(edges), tuple(axes), broken=broken)


def _tooth(roots: list[Corner], tips: list[Corner]) -> Polygon:
    """Between the roots and the tips of a strip of teeth, either with end chamfers: one deeper than the teeth is at both."""
    start, *under, end = roots
    return (under[0], *tips[1:-1], under[-1]) if under else (start, *tips, end)


def _same(polygon: Polygon) -> Polygon:
    return polygon


def _mirrored(polygon: Iterable[Corner]) -> Polygon:
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

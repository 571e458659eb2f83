"""Bodies of an assembly in section and along their axes, with balloons (ISO 6433, ISO 128-3, ISO 2203). Lengths in mm.

The plane of the section has z along the axes and y across them; keyways and bolt holes are turned into it, upwards.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import partial
from itertools import chain, combinations, pairwise, permutations, product
from typing import NamedTuple

from gearcad.drawing.dimensions import Side, linear_dimension
from gearcad.drawing.drawing_symbols import centre_circle, freehand
from gearcad.drawing.shapes import Anchor, Box, Circle, Figure, Hatching, Line, Pen, Point, Polyline, Shape, Text
from gearcad.drawing.views.gear_figures import Corner, along_strip, contour, opening, opening_radius, overall, strips
from gearcad.drawing.views.ring_views import Meridian, hole_places
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.bore_teeth import free_bore

Polygon = tuple[Point, ...]
"""Corners of a polygon in turn, the last joined to the first."""

Segment = tuple[Point, Point]

_NEAR = 1e-6
"""Distance (mm) up to which a point is on an edge."""


class Where(Enum):
    """Position of a piece of a line relative to polygons."""

    OUTSIDE = "outside"
    EDGE = "edge"
    """Along an edge of a polygon, within none."""

    INSIDE = "inside"


def pieces(segment: Segment, polygons: Sequence[Polygon]) -> Iterator[tuple[Segment, Where]]:
    """Yield the pieces of a segment from its start on with their positions, neighbours of one kind as one."""
    near = [each for each in polygons if _may_meet(segment, each)]
    stops = sorted({0.0, 1.0, *(stop for polygon in near for stop in _stops(segment, polygon))})
    begin, last = 0.0, None
    for low, high in pairwise(stops):
        where = _where(_at(segment, (low + high) / 2), near)
        if last is not None and where is not last:
            yield (_at(segment, begin), _at(segment, low)), last
            begin = low
        last = where
    if last is not None:
        yield (_at(segment, begin), segment[1]), last


def visible(segments: Iterable[Segment], covers: Sequence[Polygon]) -> Iterator[Segment]:
    """Yield the pieces of segments that covers in front of them do not hide. Pieces along an edge of a cover are left out, as
    the edge is drawn.
    """
    for segment in segments:
        yield from (piece for piece, where in pieces(segment, covers) if where is Where.OUTSIDE)


def _at(segment: Segment, share: float) -> Point:
    (x, y), (to_x, to_y) = segment
    return x + share * (to_x - x), y + share * (to_y - y)


def _edges(polygon: Polygon) -> Iterator[Segment]:
    return pairwise((*polygon, polygon[0]))


def _may_meet(segment: Segment, polygon: Polygon) -> bool:
    """Return whether the boxes of a segment and a polygon touch."""
    return all(
        min(one[axis] for one in segment) <= max(one[axis] for one in polygon) + _NEAR
        and min(one[axis] for one in polygon) <= max(one[axis] for one in segment) + _NEAR
        for axis in (0, 1)
    )


def _stops(segment: Segment, polygon: Polygon) -> Iterator[float]:
    """Yield the positions along a segment (0 to 1) where it crosses edges, or where corners lie on it."""
    (x, y), (to_x, to_y) = segment
    way = to_x - x, to_y - y
    length = math.hypot(*way)
    if length < _NEAR:
        return
    for (a, b), (to_a, to_b) in _edges(polygon):
        edge = to_a - a, to_b - b
        cross = way[0] * edge[1] - way[1] * edge[0]
        if abs(cross) > _NEAR * length:
            along = ((a - x) * edge[1] - (b - y) * edge[0]) / cross
            across = ((a - x) * way[1] - (b - y) * way[0]) / cross
            if _NEAR < along * length < length - _NEAR and -_NEAR <= across <= 1 + _NEAR:
                yield along
        elif abs((a - x) * way[1] - (b - y) * way[0]) <= _NEAR * length:
            for corner in ((a, b), (to_a, to_b)):
                along = ((corner[0] - x) * way[0] + (corner[1] - y) * way[1]) / length**2
                if _NEAR < along * length < length - _NEAR:
                    yield along


def _where(point: Point, polygons: Sequence[Polygon]) -> Where:
    on_edge = False
    for polygon in polygons:
        if any(distance(point, edge) <= _NEAR for edge in _edges(polygon)):
            on_edge = True
        elif within(point, polygon):
            return Where.INSIDE
    return Where.EDGE if on_edge else Where.OUTSIDE


def distance(point: Point, edge: Segment) -> float:
    """Return the distance (mm) of a point from a segment."""
    (x, y), (to_x, to_y) = edge
    way = to_x - x, to_y - y
    square = way[0] ** 2 + way[1] ** 2
    share = 0.0 if not square else max(0.0, min(1.0, ((point[0] - x) * way[0] + (point[1] - y) * way[1]) / square))
    return math.dist(point, (x + share * way[0], y + share * way[1]))


def within(point: Point, polygon: Polygon) -> bool:
    """Return whether a point is in a polygon: a ray to the right crosses its edges an odd number of times."""
    x, y = point
    crossed = [
        (to_x - from_x) * (y - from_y) / (to_y - from_y) + from_x > x
        for (from_x, from_y), (to_x, to_y) in _edges(polygon)
        if (from_y > y) is not (to_y > y)
    ]
    return sum(crossed) % 2 == 1


@dataclass(frozen=True)
class Cut:
    """The section of a part: `areas` of material, hatched up to the roots, and `teeth` beyond them, which are not hatched.

    `edges` are lines of the part behind the plane, `axes` centre lines of holes. The `opening` of a bore hides other parts,
    because its far wall is in front of them.
    """

    areas: tuple[Polygon, ...]
    teeth: tuple[Polygon, ...] = ()
    edges: tuple[Segment, ...] = ()
    axes: tuple[Segment, ...] = ()
    opening: tuple[Polygon, ...] = ()
    broken: tuple[Segment, ...] = ()
    """Edges of areas beyond which a part has no given end: a ring without a rim diameter."""

    @property
    def covers(self) -> tuple[Polygon, ...]:
        """Polygons that hide the parts behind them."""
        return self.areas + self.teeth + self.opening


def cut_gear(gear: Gear, z: float = 0.0, height: float = 0.0) -> Cut:
    """Return the section of a gear whose teeth begin at `z`, its axis at a `height` (mm)."""
    return _placed(_cut_ring(gear) if gear.internal else _cut_disc(gear), z, height)


def cut_rack(rack: Rack, z: float, height: float) -> Cut:
    """Return the section of a rack square to its length, teeth up, its reference line at a `height` and its end face at `z`
    (mm).
    """
    width, root, tip = rack.face_width, -rack.root_depth, rack.tip_height
    body = ((0.0, -rack.height), (width, -rack.height), (width, root), (0.0, root))
    return _placed(Cut((body,), (((0.0, root), (0.0, tip), (width, tip), (width, root)),)), z, height)


def _cut_disc(gear: Gear) -> Cut:
    body, (left, right), root = gear.body, overall(gear), gear.root_diameter / 2
    strip = partial(along_strip, gear)
    halves = [_tooth(strip(*ends, root), strip(*ends, gear.tip_diameter / 2)) for ends in strips(gear)]
    teeth = (*halves, *map(_mirrored, halves))
    if not body.bore:
        half = contour(gear, root, 0.0)[1:-1]
        return Cut(((*half, *_mirrored(half)[::-1]),), teeth)
    bore, opening = body.bore / 2, opening_radius(gear)
    if body.bore_spline:
        return _cut_splined(gear, teeth)
    edges: list[Segment] = [((z, -bore), (z, opening)) for z in (left, right)]
    if body.keyway_width:
        side = math.sqrt(bore**2 - (body.keyway_width / 2) ** 2)
        edges.append(((left, side), (right, side)))
    through = ((left, -bore), (right, -bore), (right, opening), (left, opening))
    areas = (tuple(contour(gear, root, opening)), _mirrored(contour(gear, root, bore)))
    return Cut(areas, teeth, tuple(edges), opening=(through,))


def _cut_splined(gear: Gear, teeth: tuple[Polygon, ...]) -> Cut:
    """Return the section of a gear with a splined bore, whose teeth are not hatched."""
    (left, right), roots, tips = overall(gear), gear.body.bore / 2, free_bore(gear) / 2
    upper = tuple(contour(gear, gear.root_diameter / 2, roots))
    of_bore = ((left, tips), (right, tips), (right, roots), (left, roots))
    through = ((left, -tips), (right, -tips), (right, tips), (left, tips))
    edges = tuple(((z, -tips), (z, tips)) for z in (left, right))
    return Cut((upper, _mirrored(upper)), (*teeth, of_bore, _mirrored(of_bore)), edges, opening=(through,))


def _cut_ring(gear: Gear) -> Cut:
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
    """Return the polygon between the roots and the tips of a strip of teeth, with end chamfers. A chamfer deeper than the
    teeth cuts both.
    """
    start, *under, end = roots
    return (under[0], *tips[1:-1], under[-1]) if under else (start, *tips, end)


def _same(polygon: Polygon) -> Polygon:
    return polygon


def _mirrored(polygon: Iterable[Corner]) -> Polygon:
    """Return the points mirrored to the other side of the axis."""
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


_FINEST, _STROKES = 0.9, 4
"""Least distance of hatching lines (mm of paper), and how many a narrow area should have at least."""

BEYOND_PITCH = 3.0
"""Length of pitch lines beyond the teeth (mm of paper)."""


@dataclass(frozen=True)
class Across:
    """Transformation from the plane of a section (mm: z along the axes, height across them) to paper, `middle` and height 0 at
    the origin.

    `direction` is 1 where z goes to the right, -1 to the left.
    """

    scale: float
    middle: float = 0.0
    direction: int = 1

    def point(self, point: Point) -> Point:
        return self.direction * self.scale * (point[0] - self.middle), self.scale * point[1]

    def points(self, points: Iterable[Point]) -> list[Point]:
        return [self.point(each) for each in points]


@dataclass(frozen=True)
class Sectioned:
    """A body as shown in a section: its cut, hatched at an angle (degrees; None leaves a pin or a shaft blank).

    `pitch` are lines (z to z at a height) where pitch surfaces are cut. Hatching lines are `spacing` (mm of paper) apart.
    """

    cut: Cut
    angle: float | None = 45.0
    pitch: tuple[Segment, ...] = ()
    spacing: float = 2.5


def pitch_lines(low: float, high: float, height: float, radius: float) -> tuple[Segment, ...]:
    """Return the two lines in which a pitch cylinder is cut, from z = `low` to `high`; its axis is at a height (mm)."""
    return tuple(((low, height + side * radius), (high, height + side * radius)) for side in (1, -1))


def section_figure(bodies: Sequence[Sectioned], across: Across) -> Figure:
    """Return the section of bodies in order: the teeth of one are in front of those of all that follow, whose hidden parts are
    dashed.
    """
    shapes: list[Shape] = []
    for number, body in enumerate(bodies):
        shapes += (shape for area in body.cut.areas for shape in _outlined(area, body.cut.broken, across))
        if body.angle is not None:
            shapes += (_hatched(area, body.angle, body.spacing, across) for area in body.cut.areas)
        others = [cover for other in bodies if other is not body for cover in other.cut.covers]
        before = [tooth for other in bodies[:number] for tooth in other.cut.teeth]
        shapes += _teeth(body.cut, before, across)
        shapes += (_line(each, across) for each in visible(body.cut.edges, others))
        shapes += (_line(each, across, Pen.CENTRE, BEYOND_PITCH) for each in body.cut.axes)
    shapes += (_line(each, across, Pen.CENTRE, BEYOND_PITCH) for each in _joined(chain.from_iterable(b.pitch for b in bodies)))
    return Figure(tuple(shapes))


def _outlined(area: Polygon, broken: Sequence[Segment], across: Across) -> Iterator[Polyline]:
    """Yield the outline of an area as one closed line; where a part is broken off, an open line and a freehand one."""
    points, broken_off = across.points(area), {frozenset(each) for each in broken}
    row = [number for number, end in enumerate(area) if frozenset((area[number - 1], end)) in broken_off]
    if not row:
        yield Polyline.straight(points, closed=True)
        return
    around = points[row[0] :] + points[: row[0]]
    yield Polyline.straight(around)
    yield freehand([around[-1], around[0]])


def _hatched(area: Polygon, angle: float, spacing: float, across: Across) -> Hatching:
    """Return the hatching of an area; its lines are closer where the area is narrow."""
    points = across.points(area)
    box = Box.around(points)
    closer = min(spacing, max(_FINEST, min(box.width, box.height) / _STROKES))
    return Hatching((tuple((x, y, 0.0) for x, y in points),), angle, closer)


def _line(segment: Segment, across: Across, pen: Pen = Pen.OUTLINE, beyond: float = 0.0) -> Line:
    (x, y), (right, top) = sorted(across.points(segment))
    return Line((x - beyond, y), (right + beyond, top), pen)


def _teeth(cut: Cut, before: Sequence[Polygon], across: Across) -> Iterator[Shape]:
    """Yield the outlines of teeth without the root lines, which belong to the areas; dashed behind other teeth."""
    for tooth in cut.teeth:
        shown: list[Segment] = []
        for segment in pairwise(tooth):
            for piece, where in pieces(segment, before):
                if where is Where.OUTSIDE:
                    shown.append(piece)
                elif where is Where.INSIDE:
                    yield _line(piece, across, Pen.HIDDEN)
        yield from (Polyline.straight(across.points(chained)) for chained in _chained(shown))


def _chained(segments: Iterable[Segment]) -> list[list[Point]]:
    """Return segments that follow each other as rows of points."""
    rows: list[list[Point]] = []
    for start, end in segments:
        if rows and rows[-1][-1] == start:
            rows[-1].append(end)
        else:
            rows.append([start, end])
    return rows


_SAME = 1e-6
"""Difference of heights (mm) up to which lines are one: the pitch lines of gears in mesh touch."""


def _joined(lines: Iterable[Segment]) -> list[Segment]:
    """Return the lines with level ones that meet at one height as one."""
    found: list[Segment] = []
    for line in lines:
        (low, height), (high, _) = sorted(line)
        for other in [each for each in found if abs(each[0][1] - height) <= _SAME]:
            (from_z, _), (to_z, _) = other
            if from_z <= high and low <= to_z:
                low, high = min(low, from_z), max(high, to_z)
                found.remove(other)
        found.append(((low, height), (high, height)))
    return found


BEYOND_AXIS = 6.0
"""Length of centre lines beyond their outlines (mm of paper)."""


@dataclass(frozen=True)
class FrontView:
    """A gear seen from its upper end: its axis `centre` (mm of the part), and the radii of the drawn pitch circles (mm).

    Its keyway or first bolt hole is up. `tip` is the pen of its tip circle; a `bare` one has nothing but tip and pitch circles.
    """

    gear: Gear
    centre: Point = (0.0, 0.0)
    pitch_radii: tuple[float, ...] = ()
    tip: Pen = Pen.OUTLINE
    bare: bool = False

    @property
    def reach(self) -> float:
        """Outer radius of the gear or ring (mm)."""
        return Meridian(self.gear, 1.0).rim if self.gear.internal else self.gear.tip_diameter / 2

    def figure(self, scale: float) -> Figure:
        """Return the figure of the gear on paper, without centre lines."""
        gear, at = self.gear, (scale * self.centre[0], scale * self.centre[1])
        shapes: list[Shape] = [Circle(at, scale * gear.profile.tip_diameter / 2, self.tip)]
        shapes += (Circle(at, scale * radius, Pen.CENTRE) for radius in self.pitch_radii)
        if self.bare:
            return Figure(tuple(shapes))
        shapes += (shape.moved(*at) for shape in (_rim_front(gear, scale) if gear.internal else _disc_front(gear, scale)))
        return Figure(tuple(shapes))


def _disc_front(gear: Gear, scale: float) -> Iterator[Shape]:
    body = gear.body
    if body.hub_ends[1]:
        yield Circle((0.0, 0.0), scale * body.hub_diameter / 2)
    yield from opening(gear, scale)


def _rim_front(gear: Gear, scale: float) -> Iterator[Shape]:
    ring = Meridian(gear, scale)
    yield Circle((0.0, 0.0), scale * ring.rim, Pen.THIN if ring.is_open else Pen.OUTLINE)
    if ring.holes is not None:
        places = hole_places(ring)
        yield from centre_circle(scale * sum(ring.holes) / 2, places).shapes
        yield from (Circle(place, scale * gear.body.bolt_diameter / 2) for place in places)


_RADIUS = 5.0
_APART = 2 * _RADIUS + 2.5
"""Least distance of the middles of two rings in a row."""

_DOT = 0.25
"""Radius of a circle whose line fills it."""

_OUT = (14.0, 24.0, 36.0, 50.0, 80.0)
"""Distances from the outlines to the row of rings."""

_MOST = 40
"""Largest number of arrangements with crossing leaders."""

_ROUNDING = 1e-6

_SLANTS = (6.0, -6.0, 12.0, -12.0, 20.0, -20.0)
"""Distances of a ring from its dot along its side: leaders should be neither level nor upright."""

BALLOON_SIDES = ((Side.LEFT, Side.ABOVE), (Side.LEFT,), (Side.ABOVE,), (Side.LEFT, Side.RIGHT, Side.ABOVE), (Side.RIGHT,))

_PLACES = ((0.5, 0.5), (0.25, 0.5), (0.75, 0.5), (0.5, 0.75), (0.5, 0.25), (0.1, 0.5), (0.9, 0.5))
"""Positions of a dot in the box of an area, over width and height."""


def dots(areas: Sequence[Polygon], across: Across) -> tuple[Point, ...]:
    """Return points on paper in the areas of a section, at least one for each area."""
    found = []
    for area in areas:
        box = Box.around(area)
        points = ((box.left + x * box.width, box.bottom + y * box.height) for x, y in _PLACES)
        inside = [point for point in points if within(point, area)]
        found += across.points(inside or area[:1])
    return tuple(found)


def balloons(
    parts: Mapping[int, Sequence[Point]], around: Box, sides: Sequence[Sequence[Side]] = BALLOON_SIDES
) -> Iterator[Figure]:
    """Yield all item numbers of a view beside its outlines, in rows that clear each other, in each possible arrangement, best
    first.

    `parts` has points on each part by its item number, `around` is the box of the outlines, `sides` are the sides on which
    the rows may be, best first.
    """
    ways = (_in_rows(parts, around, *way) for way in product(_OUT, sides, _SLANTS))
    crossing: list[tuple[int, list[_Balloon]]] = []
    for way in (way for way in ways if not _hit(way)):
        if crossings := _crossings(way):
            crossing.append((crossings, way))
        else:
            yield _balloon_figures(way)
    for _, way in sorted(crossing, key=lambda each: each[0])[:_MOST]:
        yield _balloon_figures(way)


class _Balloon(NamedTuple):
    """A balloon: the item number, the point on its part, and the middle of its ring."""

    number: int
    dot: Point
    ring: Point


def _in_rows(
    parts: Mapping[int, Sequence[Point]], around: Box, out: float, sides: Sequence[Side], slant: float
) -> list[_Balloon]:
    """Return the balloons, each number on the side that is nearest to a point of its part."""
    rows: dict[Side, list[tuple[float, int, Point]]] = {}
    for number, points in parts.items():
        depths = [(abs(_edge(around, side) - side.out(dot)), order, dot) for order, side in enumerate(sides) for dot in points]
        _, order, dot = min(depths, key=lambda each: (round(each[0], 3), each[1], -each[2][1]))
        rows.setdefault(sides[order], []).append((sides[order].along(dot), number, dot))
    found = []
    for side, row in rows.items():
        row.sort()
        level = _edge(around, side) + side.outwards * out
        places = _spread([along + slant for along, _, _ in row])
        found += [_Balloon(number, dot, side.point(along, level)) for (_, number, dot), along in zip(row, places, strict=True)]
    return found


def _spread(wanted: Sequence[float]) -> list[float]:
    """Return places in a row, far enough apart, in the order of the wanted ones and with the same mean (mm)."""
    places: list[float] = []
    for each in wanted:
        places.append(max(each, places[-1] + _APART) if places else each)
    back = sum(place - each for place, each in zip(places, wanted, strict=True)) / len(places)
    return [place - back for place in places]


def _hit(way: Sequence[_Balloon]) -> bool:
    """Return whether a leader would run into the ring of another, or rings of two rows into each other."""
    return any(
        math.dist(one.ring, other.ring) < _APART - _ROUNDING or distance(other.ring, (one.dot, one.ring)) < _RADIUS + 1.0
        for one, other in permutations(way, 2)
    )


def _crossings(way: Sequence[_Balloon]) -> int:
    """Return the number of leaders that cross each other."""
    return sum(_cross((one.dot, one.ring), (other.dot, other.ring)) for one, other in combinations(way, 2))


def _cross(one: Segment, other: Segment) -> bool:
    """Return whether two segments cross: the ends of each are on both sides of the other."""
    return all(_side(line, across[0]) * _side(line, across[1]) < 0 for line, across in ((one, other), (other, one)))


def _side(line: Segment, point: Point) -> float:
    """Return the side of a line on which a point is: positive at the left."""
    (x, y), (to_x, to_y) = line
    return (to_x - x) * (point[1] - y) - (to_y - y) * (point[0] - x)


def _edge(box: Box, side: Side) -> float:
    return {Side.LEFT: box.left, Side.RIGHT: box.right, Side.ABOVE: box.top, Side.BELOW: box.bottom}[side]


def _balloon_figures(way: Sequence[_Balloon]) -> Figure:
    return Figure.of(*(_balloon_figure(*balloon) for balloon in way))


def _balloon_figure(number: int, dot: Point, ring: Point) -> Figure:
    share = 1.0 - _RADIUS / math.dist(dot, ring)
    end = dot[0] + share * (ring[0] - dot[0]), dot[1] + share * (ring[1] - dot[1])
    return Figure.of(
        Circle(dot, _DOT, Pen.OUTLINE),
        Line(dot, end, Pen.SYMBOL),
        Polyline(((ring[0] - _RADIUS, ring[1], 1.0), (ring[0] + _RADIUS, ring[1], 1.0)), Pen.SYMBOL, closed=True),
        Text(str(number), ring, 5.0, Anchor.MIDDLE, pen=Pen.TEXT),
    )


def overall_height(box: Box, value: float, draughting: Draughting, prefix: str = "") -> Iterator[Figure]:
    """Yield dimensions of the height of a box of outlines on paper, at the right, then at the left. The value is in mm of the
    part.
    """
    size = Size(value=value, prefix=prefix, reference=True)
    for side, edge in ((Side.RIGHT, box.right), (Side.LEFT, box.left)):
        yield from linear_dimension((edge, box.bottom), (edge, box.top), side, size, draughting, clear=edge)


def overall_width(box: Box, value: float, draughting: Draughting) -> Iterator[Figure]:
    """Yield dimensions of the width of a box of outlines on paper, below, then above. The value is in mm of the part."""
    size = Size(value=value, reference=True)
    for side, edge in ((Side.BELOW, box.bottom), (Side.ABOVE, box.top)):
        yield from linear_dimension((box.left, edge), (box.right, edge), side, size, draughting, clear=edge)


def distance_size(pair: GearPair | RackPair) -> Size:
    """Return the size (mm, a magnitude) of the distance from axis to axis, or from a pinion's axis to a rack's reference
    line.
    """
    if isinstance(pair, RackPair):
        return Size(value=pair.mounting_distance)
    if pair.centre_distance_tolerance is None:
        return Size(value=abs(pair.centre_distance))
    allowance = pair.centre_distance_allowance / 1000
    return Size(value=abs(pair.centre_distance), fit=pair.centre_distance_tolerance, upper=allowance, lower=-allowance)

"""Drawing symbols: centre lines, break lines, section arrows, surface texture, method of projection. Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from gearcad.drawing.dimensions import Side, arrow, leader
from gearcad.drawing.options import Projection
from gearcad.drawing.shapes import Anchor, Arc, Box, Circle, Figure, Line, Pen, Point, Polyline, Shape, Text, Vertex, text_width
from gearcad.drawing.words import Draughting

_ON_LINE = 1e-6
"""Distance (mm) up to which a point is taken to be on a line."""


def centre_line(*points: Point) -> Figure:
    """Return a centre line from the first to the last of points in a row; other lines cross it at the points between."""
    pieces = list(pairwise(points))
    if len(pieces) > 1:  # the first one too begins at the crossing
        pieces[0] = pieces[0][::-1]
    return Figure(tuple(Line(*piece, Pen.CENTRE) for piece in pieces))


def centre_cross(centre: Point, reach: float) -> Figure:
    """Return a level and an upright centre line that extend by `reach` (mm) to each side of a centre."""
    x, y = centre
    return centre_line((x - reach, y), centre, (x + reach, y)) + centre_line((x, y - reach), centre, (x, y + reach))


def centre_star(box: Box, places: Sequence[Point], half: float) -> Figure:
    """Return the level and upright centre line of a box, and radial ones that extend by `half` (mm) to each side of places.

    A place on one of the two has no line of its own.
    """
    level, upright = ([(0.0, 0.0), *(each for each in places if abs(each[axis]) <= _ON_LINE)] for axis in (1, 0))
    figure = centre_line((box.left, 0.0), *sorted(level), (box.right, 0.0))
    figure += centre_line((0.0, box.bottom), *sorted(upright, key=lambda each: each[1]), (0.0, box.top))
    for x, y in places:
        if min(abs(x), abs(y)) > _ON_LINE:
            inner, outer = (1 + side * half / math.hypot(x, y) for side in (-1, 1))
            figure += centre_line((inner * x, inner * y), (x, y), (outer * x, outer * y))
    return figure


def centre_circle(radius: float, places: Iterable[Point]) -> Figure:
    """Return a centre circle about the origin, divided at the places where other lines cross it."""
    turns = sorted(math.degrees(math.atan2(y, x)) for x, y in places)
    if len(turns) < 2:
        return Figure.of(Circle((0.0, 0.0), radius, Pen.CENTRE))
    return Figure(tuple(Arc((0.0, 0.0), radius, *ends, Pen.CENTRE) for ends in pairwise([*turns, turns[0]])))


_WAVE = 4.0
"""Length of half a wave, more where a line would have more than `_MOST` of them: it is then longer than any paper."""

_MOST = 1000

_BULGE = 0.22
"""Bulge of each half wave: about half a millimetre off the path."""

_TOOTH = 2.0
"""Half the height of a zigzag, and twice its width."""


def freehand(path: list[Point], *, closed: bool = False) -> Polyline:
    """Return a thin wavy line along a path of straight pieces; a closed one ends at its start."""
    row = [*path, path[0]] if closed else path
    wave = max(_WAVE, sum(math.dist(*piece) for piece in pairwise(row)) / _MOST)
    vertices: list[Vertex] = []
    for (x, y), (to_x, to_y) in pairwise(row):
        halves = max(1, round(math.dist((x, y), (to_x, to_y)) / wave))
        for i in range(halves):
            side = -1 if len(vertices) % 2 else 1
            vertices.append((x + (to_x - x) * i / halves, y + (to_y - y) * i / halves, side * _BULGE))
    if not closed:
        vertices.append((*row[-1], 0.0))
    return Polyline(tuple(vertices), Pen.THIN, closed)


def zigzag(start: Point, end: Point) -> Polyline:
    """Return a thin straight line with a zigzag in its middle."""
    length = math.dist(start, end)
    along = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
    high = min(_TOOTH, length / 4)

    def at(place: float, aside: float) -> Point:
        """Return the point `place` (mm) from the start and `aside` (mm) to the left of the line."""
        return start[0] + along[0] * place - along[1] * aside, start[1] + along[1] * place + along[0] * aside

    middle = length / 2
    steps = [
        (0.0, 0.0),
        (middle - high / 2, 0.0),
        (middle - high / 4, high),
        (middle + high / 4, -high),
        (middle + high / 2, 0.0),
    ]
    return Polyline.straight([at(*step) for step in (*steps, (length, 0.0))], Pen.THIN)


_STROKE, _STEM = 8.0, 9.0


def section_arrows(start: Point, end: Point, looking: Side, letter: str = "A") -> Figure:
    """Return the thick ends of a cutting line, arrows in the viewing direction, and the letter beside each.

    The line is vertical where one looks to the left or right, horizontal otherwise; `start` and `end` are outside the outline.
    """
    shapes: list[Shape] = []
    across = looking.value
    length = abs(end[0] - start[0]) + abs(end[1] - start[1])
    along = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    for point, way in ((start, -1.0), (end, 1.0)):
        tail = point[0] + way * _STROKE * along[0], point[1] + way * _STROKE * along[1]
        shapes.append(Line(point, tail, Pen.OUTLINE))
        tip = point[0] + way * _STROKE / 2 * along[0], point[1] + way * _STROKE / 2 * along[1]
        foot = tip[0] - _STEM * across[0], tip[1] - _STEM * across[1]
        shapes += [Line(foot, tip, Pen.SYMBOL), arrow(tip, across, Pen.SYMBOL)]
        place = foot[0] + 4.0 * way * along[0], foot[1] + 4.0 * way * along[1]
        shapes.append(Text(letter, place, 5.0, Anchor.MIDDLE, pen=Pen.TEXT))
    return Figure(tuple(shapes))


def view_label(words: str, above: Point, height: float = 5.0) -> Figure:
    """Return the name of a view ("A–A", "X (5:1)"), its line centred on the point `above`."""
    return Figure.of(Text(words, above, height, Anchor.CENTRE, pen=Pen.TEXT))


_LOW, _HIGH = 1.4, 3.0
"""Heights of the two legs over that of the text (ISO 1302:2002, annex A)."""

_SLOPE = math.tan(math.radians(60.0))
_PLACES = (0.5, 0.3, 0.7, 0.15, 0.85)
"""Positions of a symbol along an edge, over its length."""


def roughness_symbol(value: str, *, height: float = 2.5, side: Side = Side.ABOVE, count: str = "") -> Figure:
    """Return the roughness symbol for required removal of material, with its value ("Ra 1.6").

    Its point is at (0, 0). It stands upright, or with `side` LEFT is read from the right. `count` ("2×") stands before it: the
    number of surfaces it applies to. Raises ValueError for the other sides.
    """
    if side not in (Side.ABOVE, Side.LEFT):
        raise ValueError("A symbol would stand upside down: it needs a leader.")
    low, high = _LOW * height, _HIGH * height
    start = high / _SLOPE + 0.25 * height
    tail = start + text_width(value, height) + 0.25 * height
    check = (_at(-low / _SLOPE, low, side), (0.0, 0.0), _at(high / _SLOPE, high, side), _at(tail, high, side))
    bar = Line(_at(-low / _SLOPE, low, side), _at(low / _SLOPE, low, side), Pen.SYMBOL)
    rotation = 90.0 if side.is_upright else 0.0
    text = Text(value, _at(start, high - 1.4 * height, side), height, rotation=rotation)
    before = -low / _SLOPE - 0.3 * height - text_width(count, height)
    counted = [Text(count, _at(before, 0.3 * height, side), height, rotation=rotation)] if count else []
    return Figure.of(Polyline.straight(check, Pen.SYMBOL), bar, text, *counted)


def roughness(start: Point, end: Point, side: Side, value: str, draughting: Draughting, *, count: str = "") -> Iterator[Figure]:
    """Yield a roughness symbol in each of its possible places, best first, for an edge or an extension line.

    The edge runs from `start` to `end`, its outside at `side`. ABOVE and LEFT the symbol stands on the edge, then on a leader;
    BELOW and RIGHT on a leader only. `count` ("2×") is the number of surfaces it applies to.
    """
    places = [(start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part) for part in _PLACES]
    if side in (Side.ABOVE, Side.LEFT):
        for place in places:
            yield roughness_symbol(value, side=side, count=count).moved(*place)
    for place in places:
        yield from _on_leader(place, side, roughness_symbol(value, count=count), draughting)


def _on_leader(place: Point, side: Side, symbol: Figure, draughting: Draughting) -> Iterator[Figure]:
    """Yield the symbol on the horizontal part of a leader, in each of its possible places."""
    directions = {
        Side.ABOVE: (60.0, 120.0, 30.0, 150.0),
        Side.BELOW: (-60.0, -120.0, -30.0, -150.0),
        Side.LEFT: (135.0, -135.0, 160.0, -160.0),
        Side.RIGHT: (45.0, -45.0, 20.0, -20.0),
    }[side]
    box = symbol.box
    foot = Line((box.left, 0.0), (box.right, 0.0), Pen.DIMENSION)
    yield from leader(place, Figure.of(symbol, foot), draughting, directions)


def general_roughness(value: str, at: Point = (0.0, 0.0), *, height: float = 3.5) -> Figure:
    """Return the general roughness: the symbol with its value, and a bare one in brackets; its point is at `at`. It applies to
    all surfaces without a symbol of their own.
    """
    symbol = roughness_symbol(value, height=height)
    low, high = _LOW * height, _HIGH * height
    start = symbol.box.right + 0.6 * height
    bracket = 1.4 * height
    foot = start + text_width("(", bracket) + low / _SLOPE + 0.1 * height
    bare = Polyline.straight([(foot - low / _SLOPE, low), (foot, 0.0), (foot + high / _SLOPE * 0.8, high * 0.8)], Pen.SYMBOL)
    shapes: tuple[Shape, ...] = (
        Text("(", (start, 0.4 * height), bracket),
        bare,
        Text(")", (foot + high / _SLOPE * 0.8 + 0.1 * height, 0.4 * height), bracket, Anchor.LEFT),
    )
    return Figure.of(symbol, *shapes).moved(*at)


def _at(along: float, up: float, side: Side) -> Point:
    """Return a point of a symbol, turned by 90 degrees if the outside is at the left or the right."""
    return (-up, along) if side.is_upright else (along, up)


def projection_symbol(projection: Projection, at: Point = (0.0, 0.0), *, height: float = 8.0) -> Figure:
    """Return the projection symbol: a truncated cone from its side and from its small end. Its left end is on the axis at
    `at`.

    First angle: the cone is at the left, its small end at the left, and the rings are at the right. Third angle: the rings are
    at the left.
    """
    big, small, length, air = height / 2, height / 4, height, 0.5 * height
    over = 0.25 * height
    cone_left, rings = over, over + length + air + big
    if projection is Projection.THIRD:
        cone_left, rings = over + 2 * big + air, over + big
    corners = [(cone_left, -small), (cone_left, small), (cone_left + length, big), (cone_left + length, -big)]
    width = length + air + 2 * big + 2 * over
    return Figure.of(
        Polyline.straight(corners, Pen.SYMBOL, closed=True),
        Circle((rings, 0.0), big, Pen.SYMBOL),
        Circle((rings, 0.0), small, Pen.SYMBOL),
        centre_line((0.0, 0.0), (rings, 0.0), (width, 0.0)),
        centre_line((rings, -big - over), (rings, 0.0), (rings, big + over)),
    ).moved(*at)

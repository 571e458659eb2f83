"""Placement of boxes on a sheet: occupied areas, clashes with them, and free places. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gearcad.core.records import Bools, Floats
from gearcad.drawing.shapes import (
    Box,
    Dimension,
    Figure,
    Hatching,
    Line,
    MeasuredDistance,
    Pen,
    Point,
    Polyline,
    Segment,
    Shape,
)

_AIR = 0.6
"""Least distance (mm) of a text from other texts and lines."""

_LANE = 6.0
"""Least distance of dimension lines that run beside each other."""

_BESIDE = 1.5
"""Least distance of a dimension line from other lines that run beside it."""

_LEVEL = 0.15
"""Slope up to which a line runs beside a dimension line: the top of a circle too."""

_ALONG = 1.0
"""Length (mm) up to which lines may run beside each other, because their ends are rounded."""

_DOUBLE, _SAME = 1.0, 1e-6
"""Distances (mm): nearer lines of marks look like one line drawn twice; lines nearer than the second lie upon each other."""


class Occupied:
    """The occupied parts of a sheet. No text may meet another text, a line or hatching; lines may cross lines, but not
    symbols.

    Dimension lines keep away from each other and from lines that run beside them.
    """

    def __init__(self, *figures: Figure, taken: Iterable[Box] = (), within: Box | None = None) -> None:
        """Occupy the places of figures. Nothing may enter the `taken` areas or leave the area `within`."""
        self._texts, self._symbols = _no_rows(), _no_rows()
        self._segments, self._marks = _no_rows(), _no_rows()
        self._spans: dict[MeasuredDistance, Floats] = {
            each: _no_rows(3) for each in (MeasuredDistance.HORIZONTAL, MeasuredDistance.VERTICAL)
        }
        self._hatched: list[Floats] = []
        self._taken, self._within = list(taken), within
        for figure in figures:
            self.add(figure)

    def add(self, figure: Figure) -> None:
        """Add a figure to the occupied places."""
        self._texts = np.concatenate([self._texts, _text_boxes(figure)])
        self._symbols = np.concatenate([self._symbols, _symbol_boxes(figure)])
        self._segments = np.concatenate([self._segments, _as_rows(figure.segments)])
        self._marks = np.concatenate([self._marks, _mark_lines(figure)])
        for measured, spans in self._spans.items():
            self._spans[measured] = np.concatenate([spans, _spans(figure, measured)])
        self._hatched += [_edges(shape) for shape in figure.shapes if isinstance(shape, Hatching)]

    def clashes(self, figure: Figure) -> bool:
        """Return whether a figure would meet an occupied place, or leave the area it must stay within."""
        box = figure.box
        if self._within is not None and not self._within.holds(box):
            return True
        if any(box.meets(each) for each in self._taken):
            return True
        texts, rows = _grown(_text_boxes(figure), _AIR), _as_rows(figure.segments)
        symbols = _symbol_boxes(figure)
        return bool(
            _meet(texts, self._texts).any()
            or _meet(_grown(symbols, _AIR), self._symbols).any()
            or _meet(texts, self._symbols).any()
            or _meet(symbols, self._texts).any()
            or _crossed(texts, self._segments).any()
            or _crossed(_grown(self._texts, _AIR), rows).any()
            or _crossed(_grown(symbols, -0.05), self._segments).any()
            or _crossed(_grown(self._symbols, -0.05), rows).any()
            or any(_hatched(texts, edges).any() for edges in self._hatched)
            or any(self._too_near(figure, measured) for measured in self._spans)
        )

    def crossings(self, figure: Figure) -> int:
        """Return the number of dimension, leader and symbol lines that a figure would cross or double with its own.

        That is permitted, but better avoided.
        """
        lines = _mark_lines(figure)
        return int(_intersecting(lines, self._marks).sum() + _doubled(lines, self._marks).sum())

    def _too_near(self, figure: Figure, measured: MeasuredDistance) -> bool:
        """Return whether a dimension line would run beside another, or beside any other line."""
        spans = _spans(figure, measured)
        lines = self._segments if measured is MeasuredDistance.HORIZONTAL else self._segments[:, [1, 0, 3, 2]]
        level = lines[np.abs(lines[:, 1] - lines[:, 3]) <= _LEVEL * np.abs(lines[:, 0] - lines[:, 2])]
        heights = (level[:, 1] + level[:, 3]) / 2
        others = np.stack([np.minimum(level[:, 0], level[:, 2]), np.maximum(level[:, 0], level[:, 2]), heights], axis=1)
        return bool(_near_spans(spans, self._spans[measured], _LANE).any() or _near_spans(spans, others, _BESIDE).any())


def _no_rows(width: int = 4) -> Floats:
    return np.empty((0, width))


def _text_boxes(figure: Figure) -> Floats:
    return np.array([text.box for text in figure.texts], dtype=float).reshape(-1, 4)


def _symbol_boxes(figure: Figure) -> Floats:
    """Return the boxes of frames and roughness symbols, shape (n, 4); nothing may cross them."""
    boxes = [shape.box for shape in figure.shapes if isinstance(shape, Polyline) and shape.pen is Pen.SYMBOL]
    return np.array(boxes, dtype=float).reshape(-1, 4)


def _as_rows(segments: list[Segment]) -> Floats:
    return np.array([(*start, *end) for start, end in segments], dtype=float).reshape(-1, 4)


def _edges(hatching: Hatching) -> Floats:
    return np.concatenate([_as_rows(Polyline(edge, closed=True).segments) for edge in hatching.edges])


def _parts(figure: Figure) -> Iterator[Shape]:
    for shape in figure.shapes:
        yield from shape.parts if isinstance(shape, Dimension) else (shape,)


def _mark_lines(figure: Figure) -> Floats:
    """Return the dimension, extension and leader lines of a figure as rows (x, y, x, y), shape (n, 4)."""
    lines = (part for part in _parts(figure) if isinstance(part, Line) and part.pen in (Pen.DIMENSION, Pen.SYMBOL))
    return _as_rows([(line.start, line.end) for line in lines])


def _spans(figure: Figure, measured: MeasuredDistance) -> Floats:
    """Return the dimension lines of one direction as (from, to, height), shape (n, 3). For vertical lines y is along, x the
    height.
    """
    found = []
    for shape in figure.shapes:
        if isinstance(shape, Dimension) and shape.measured is measured:
            turn = 1 if measured is MeasuredDistance.HORIZONTAL else -1
            for part in shape.parts:
                if isinstance(part, Line):
                    (low, height), (high, other) = part.start[::turn], part.end[::turn]
                    if abs(height - other) < 1e-9:
                        found.append((min(low, high), max(low, high), height))
    return np.array(found, dtype=float).reshape(-1, 3)


def _grown(boxes: Floats, by: float) -> Floats:
    grown: Floats = boxes + np.array([-by, -by, by, by])
    return grown


def _meet(ones: Floats, others: Floats) -> Bools:
    """Return which boxes have an area in common, shape (ones, others)."""
    one, other = ones[:, None, :], others[None, :, :]
    met: Bools = np.all((one[..., :2] < other[..., 2:]) & (other[..., :2] < one[..., 2:]), axis=-1)
    return met


def _near_spans(spans: Floats, others: Floats, distance: float) -> Bools:
    """Return which spans run beside which others, nearer than a distance, shape (spans, others)."""
    one, other = spans[:, None, :], others[None, :, :]
    shared = np.minimum(one[..., 1], other[..., 1]) - np.maximum(one[..., 0], other[..., 0])
    return (shared > _ALONG) & (np.abs(one[..., 2] - other[..., 2]) < distance)


def _doubled(ones: Floats, others: Floats) -> Bools:
    """Return which level or upright segments look like one line drawn twice, because they run so near each other, shape (ones,
    others).
    """
    found = np.zeros((len(ones), len(others)), dtype=bool)
    for turn in ([0, 1, 2, 3], [1, 0, 3, 2]):
        one, other = _level_spans(ones[:, turn]), _level_spans(others[:, turn])
        apart = np.abs(one[:, None, 2] - other[None, :, 2])
        found |= _near_spans(one, other, _DOUBLE) & (apart > _SAME)
    return found


def _level_spans(segments: Floats) -> Floats:
    """Return segments as (from, to, height), shape (n, 3); the height is NaN for segments that are not level."""
    height = np.where(np.abs(segments[:, 1] - segments[:, 3]) < _SAME, segments[:, 1], np.nan)
    return np.stack([np.minimum(segments[:, 0], segments[:, 2]), np.maximum(segments[:, 0], segments[:, 2]), height], axis=1)


def _crossed(boxes: Floats, segments: Floats) -> Bools:
    """Return which segments have points within which boxes, shape (boxes, segments) (Liang and Barsky)."""
    low, high = boxes[:, None, :2], boxes[:, None, 2:]
    start, way = segments[None, :, :2], segments[None, :, 2:] - segments[None, :, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (low - start) / way, (high - start) / way
    still = way == 0
    outside = (still & ((start <= low) | (start >= high))).any(axis=-1)
    enter = np.where(still, -np.inf, np.minimum(near, far)).max(axis=-1)
    leave = np.where(still, np.inf, np.maximum(near, far)).min(axis=-1)
    crossed: Bools = ~outside & (np.maximum(enter, 0) < np.minimum(leave, 1))
    return crossed


def _hatched(boxes: Floats, edges: Floats) -> Bools:
    """Return which boxes have their middle within hatching, or its edge across them, shape (boxes,)."""
    x, y = ((boxes[:, None, side] + boxes[:, None, side + 2]) / 2 for side in (0, 1))
    (x1, y1, x2, y2) = edges.T[:, None, :]
    spanned = (y1 <= y) != (y2 <= y)
    with np.errstate(divide="ignore", invalid="ignore"):
        right = spanned & (x < x1 + (y - y1) * (x2 - x1) / (y2 - y1))
    within: Bools = (right.sum(axis=1) % 2 == 1) | _crossed(boxes, edges).any(axis=1)
    return within


def _intersecting(ones: Floats, others: Floats) -> Bools:
    """Return which segments cross which others, shape (ones, others); ends that only touch do not count."""
    p, r = ones[:, None, :2], ones[:, None, 2:] - ones[:, None, :2]
    q, s = others[None, :, :2], others[None, :, 2:] - others[None, :, :2]
    cross = r[..., 0] * s[..., 1] - r[..., 1] * s[..., 0]
    apart = q - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (apart[..., 0] * s[..., 1] - apart[..., 1] * s[..., 0]) / cross
        u = (apart[..., 0] * r[..., 1] - apart[..., 1] * r[..., 0]) / cross
        inside: Bools = (t > 1e-6) & (t < 1 - 1e-6) & (u > 1e-6) & (u < 1 - 1e-6)
    return inside


_ROUNDS = 3
"""Number of rounds; each group moves once a round, with the others at their current places."""

_LIMITING_DISTANCE = 5.0
"""Distance (mm) aside within which boxes limit the move of a group."""


def balanced(groups: Sequence[Sequence[Box]], across: Sequence[bool], taken: Sequence[Box], free: Box) -> list[Point]:
    """Return the move (mm) of each group of boxes as one, to the middle of its free room. Groups move up or down, and sideways
    only where `across` is true.
    """
    stood = [list(group) for group in groups]
    for _ in range(_ROUNDS):
        for number, sideways in enumerate(across):
            others = [*taken, *(box for each, group in enumerate(stood) if each != number for box in group)]
            up = _to_middle(stood[number], others, free)
            stood[number] = [box.moved(0.0, up) for box in stood[number]]
            if sideways:
                right = _to_middle(map(_turned, stood[number]), list(map(_turned, others)), _turned(free))
                stood[number] = [box.moved(right, 0.0) for box in stood[number]]
    starts = [group[0] if group else Box(0.0, 0.0, 0.0, 0.0) for group in groups]
    ends = [group[0] if group else Box(0.0, 0.0, 0.0, 0.0) for group in stood]
    return [(end.left - start.left, end.bottom - start.bottom) for start, end in zip(starts, ends, strict=True)]


def _to_middle(group: Iterable[Box], others: Sequence[Box], free: Box) -> float:
    """Return the distance up (mm) that gives boxes as much room above as below them."""
    above, below = [], []
    for box in group:
        beside = [
            each for each in others if each.left < box.right + _LIMITING_DISTANCE and box.left - _LIMITING_DISTANCE < each.right
        ]
        above.append(min([free.top, *(each.bottom for each in beside if each.bottom >= box.top)]) - box.top)
        below.append(box.bottom - max([free.bottom, *(each.top for each in beside if each.top <= box.bottom)]))
    return (min(above) - min(below)) / 2 if above else 0.0


def _turned(box: Box) -> Box:
    """Return a box with its x and y exchanged."""
    return Box(box.bottom, box.left, box.top, box.right)


_STEP = 4.0
"""Step between the heights that are tried for an axis, and between places for a block."""

_ENOUGH_AIR = 12.0
"""Air (mm) around a row beyond which a height is no better."""

_TRIED = 8
"""Number of heights of a row's axis that are tried further."""

_LOOSE = (20.0, 12.0, 7.0)
"""Distances that are tried around blocks."""


@dataclass(frozen=True)
class Room:
    """An area, and the boxes within it that are taken.

    Views stand at least `between` mm from each other, and `around` from the edge of the area and from what is taken.
    """

    free: Box
    taken: tuple[Box, ...] = ()
    between: float = 10.0
    around: float = 5.0

    @property
    def tight(self) -> Room:
        """The same area with less air, for views that have no room otherwise."""
        return replace(self, between=6.0, around=2.0)

    @property
    def tightest(self) -> Room:
        """The same area with the least air that is still legible."""
        return replace(self, between=3.0, around=0.5)

    def places(
        self, rows: Sequence[Sequence[Box]], blocks: Sequence[Box] = (), *, aligned: int = 0
    ) -> list[list[Point]] | None:
        """Return the places of the origins of views and blocks, the blocks as a last row; None where there is no room.

        Boxes are relative to the origins of their views. Views of a row have their origins at one height, and rows follow each
        other downwards. The views of number `aligned` (-1 the last) of all rows have their origins one below the other.
        """
        found = next(self._rows(rows, blocks, aligned, None, self.free.top), None)
        return None if found is None else self._balanced(rows, blocks, found)

    def _balanced(
        self, rows: Sequence[Sequence[Box]], blocks: Sequence[Box], places: Sequence[Sequence[Point]]
    ) -> list[list[Point]]:
        """Return the places with rows moved to the middle of the room above and below them, and blocks also sideways."""
        stood = [
            [box.moved(*place) for box, place in zip(row, ats, strict=True)]
            for row, ats in zip((*rows, blocks), places, strict=True)
        ]
        groups = [*stood[:-1], *([box] for box in stood[-1])]
        moves = balanced(groups, [number >= len(rows) for number in range(len(groups))], self.taken, self.free)
        shifted = [[(x, y + up) for x, y in row] for row, (_, up) in zip(places[:-1], moves, strict=False)]
        return [*shifted, [(x + right, y + up) for (x, y), (right, up) in zip(places[-1], moves[len(rows) :], strict=True)]]

    def _rows(
        self, rows: Sequence[Sequence[Box]], blocks: Sequence[Box], aligned: int, column: float | None, below: float
    ) -> Iterator[list[list[Point]]]:
        """Yield the places of all rows in each way tried, best first."""
        if not rows:
            found = self._blocks(blocks)
            if found is not None:
                yield [found]
            return
        for places in self._row(rows[0], aligned, column, below):
            boxes = tuple(box.moved(*place) for box, place in zip(rows[0], places, strict=True))
            room = replace(self, taken=self.taken + boxes)
            foot = min((box.bottom - self.between for box in boxes), default=below)
            for rest in room._rows(rows[1:], blocks, aligned, places[aligned][0] if places else column, foot):
                yield [places, *rest]

    def _row(self, boxes: Sequence[Box], aligned: int, column: float | None, below: float) -> list[list[Point]]:
        """Return the places of a row at several heights: first those with enough air around it, from the top, then those with
        less.
        """
        if not boxes:
            return [[]]
        top, bottom = max(box.top for box in boxes), min(box.bottom for box in boxes)
        high, low = min(below, self.free.top - self.around) - top, self.free.bottom + self.around - bottom
        found = []
        for axis in np.arange(high, low - 1e-9, -_STEP):
            places = self._along(boxes, float(axis), aligned, column)
            if places is not None:
                found.append((self._air([box.moved(*place) for box, place in zip(boxes, places, strict=True)]), places))
        found.sort(key=lambda each: -min(each[0], _ENOUGH_AIR))  # what is alike stays in order, from the top
        chosen = found[:_TRIED] + found[_TRIED :: max(1, len(found) // _TRIED)]
        return [places for _, places in chosen]

    def _along(self, boxes: Sequence[Box], axis: float, aligned: int, column: float | None) -> list[Point] | None:
        """Return the places of views from left to right on an axis, with as much air between them as there is; None without
        room.
        """
        if column is not None:
            return self._in_column(boxes, axis, aligned, column)
        lefts, cursor = [], self.free.left + self.around
        for box in boxes:
            left = self._clear(box.moved(-box.left, axis), cursor)
            if left is None:
                return None
            lefts.append(left)
            cursor = left + box.width + self.between
        last = boxes[-1].moved(lefts[-1] - boxes[-1].left, axis)
        walls = (
            each.left for each in self.taken if each.left >= last.right and each.bottom < last.top and last.bottom < each.top
        )
        spare = min([self.free.right, *walls]) - self.around - last.right
        for share in (1.0, 0.75, 0.5, 0.25):
            each = spare * share / (len(boxes) + 1)
            wider = [left + each * (number + 1) for number, left in enumerate(lefts)]
            if all(self._is_clear(box.moved(left - box.left, axis)) for box, left in zip(boxes, wider, strict=True)):
                lefts = wider
                break
        return [(left - box.left, axis) for box, left in zip(boxes, lefts, strict=True)]

    def _in_column(self, boxes: Sequence[Box], axis: float, aligned: int, column: float) -> list[Point] | None:
        """Return the places of a row whose aligned view is at x = `column`; None without room. The others are at its right, or
        (aligned -1) at its left.
        """
        others = [number for number in range(len(boxes)) if number != aligned % len(boxes)]
        pinned = boxes[aligned].moved(column, axis)
        if not self._is_clear(pinned):
            return None
        places: list[Point] = [(column, axis)] * len(boxes)
        edge = pinned.right + self.between if aligned == 0 else pinned.left - self.between
        for number in others if aligned == 0 else reversed(others):
            box = boxes[number]
            left = self._clear(box.moved(-box.left, axis), edge) if aligned == 0 else edge - box.width
            if left is None or not self._is_clear(box.moved(left - box.left, axis)):
                return None
            places[number] = left - box.left, axis
            edge = left + box.width + self.between if aligned == 0 else left - self.between
        return places

    def _clear(self, box: Box, left: float) -> float | None:
        """Return the least left side (mm), from `left` on, at which a box with its left side at 0 is clear. None if there is
        none.
        """
        while True:
            stood = box.moved(left, 0.0)
            if stood.right > self.free.right - self.around + 1e-9:
                return None
            hit = [each.right for each in self.taken if each.meets(stood.grown(self.around - 1e-9))]
            if not hit:
                return left
            left = max(hit) + self.around

    def _is_clear(self, box: Box) -> bool:
        wide = box.grown(self.around - 1e-9)
        return self.free.holds(wide) and not any(each.meets(wide) for each in self.taken)

    def _air(self, boxes: Sequence[Box]) -> float:
        """Return the least distance (mm) of any box from the edge of the area and from taken boxes."""
        air = min(
            min(box.left - self.free.left, self.free.right - box.right, box.bottom - self.free.bottom, self.free.top - box.top)
            for box in boxes
        )
        return min([air, *(_apart(box, each) for box in boxes for each in self.taken)])

    def _blocks(self, blocks: Sequence[Box]) -> list[Point] | None:
        """Return the places of blocks as loosely as all have room. The larger ones come first, each as low and then as far
        left as it can be. None without room.
        """
        for air in _LOOSE:
            found = self._packed(blocks, air)
            if found is not None:
                return found
        return None

    def _packed(self, blocks: Sequence[Box], air: float) -> list[Point] | None:
        taken = list(self.taken)
        places: dict[int, Point] = {}
        for number in sorted(range(len(blocks)), key=lambda each: -blocks[each].width * blocks[each].height):
            block = blocks[number]
            corner = self._corner(block.width, block.height, taken, air)
            if corner is None:
                return None
            places[number] = corner[0] - block.left, corner[1] - block.bottom
            taken.append(block.moved(*places[number]))
        return [places[number] for number in range(len(blocks))]

    def _corner(self, width: float, height: float, taken: Sequence[Box], air: float) -> Point | None:
        """Return the lower left corner of the lowest free place, of these the leftmost; None without one."""
        margin = min(air, 8.0)
        across = np.arange(self.free.left + margin, self.free.right - margin - width + 1e-9, _STEP)
        up = np.arange(self.free.bottom + margin, self.free.top - margin - height + 1e-9, _STEP)
        clear = np.ones((len(up), len(across)), dtype=bool)
        for each in taken:
            wide = each.grown(air)
            clear &= ~(
                ((across > wide.left - width) & (across < wide.right))[None, :]
                & ((up > wide.bottom - height) & (up < wide.top))[:, None]
            )
        found = np.argwhere(clear)
        return (float(across[found[0, 1]]), float(up[found[0, 0]])) if len(found) else None


def _apart(one: Box, other: Box) -> float:
    """Return the distance (mm) between boxes, across or upwards, whichever is more."""
    across = max(one.left - other.right, other.left - one.right)
    up = max(one.bottom - other.top, other.bottom - one.top)
    return max(across, up)

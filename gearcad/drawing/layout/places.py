"""Where boxes have room: rows of views on a common axis, and blocks anywhere. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gearcad.drawing.layout.balance import balanced
from gearcad.drawing.shapes import Box, Point

__all__ = ["Room"]

_STEP = 4.0
"""Between the heights that are tried for an axis, and between places for a block."""

_ENOUGH_AIR = 12.0
"""Around a row; more makes a height no better."""

_TRIED = 8
"""So many heights of a row's axis are gone on with."""

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
        """The same with less air, for what would else have no room."""
        return replace(self, between=6.0, around=2.0)

    @property
    def tightest(self) -> Room:
        """The same with as little air as can be read."""
        return replace(self, between=3.0, around=0.5)

    def places(
        self, rows: Sequence[Sequence[Box]], blocks: Sequence[Box] = (), *, aligned: int = 0
    ) -> list[list[Point]] | None:
        """Where the origins of views and blocks would stand, the blocks as a last row; None where there is no room.

        Boxes are relative to the origins of what they hold. Views of a row have their origins at one height; rows follow each
        other downwards, and their views of number `aligned` (-1 the last) have their origins one below the other.
        """
        found = next(self._rows(rows, blocks, aligned, None, self.free.top), None)
        return None if found is None else self._balanced(rows, blocks, found)

    def _balanced(
        self, rows: Sequence[Sequence[Box]], blocks: Sequence[Box], places: Sequence[Sequence[Point]]
    ) -> list[list[Point]]:
        """Rows in the middle of the room above and below them, blocks also across."""
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
        """All ways that are tried, best first."""
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
        """A row at several heights: those with enough air around it from the top, then those with less."""
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
        """Views from left to right on an axis, as much air between them as there is."""
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
        """The aligned view at its x, the others beside it: at its right, or (aligned -1) at its left."""
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
        """The least left side from `left` on where a box, its own left side at 0, is clear; None where it never is."""
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
        """The least distance of any from what is around it."""
        air = min(
            min(box.left - self.free.left, self.free.right - box.right, box.bottom - self.free.bottom, self.free.top - box.top)
            for box in boxes
        )
        return min([air, *(_apart(box, each) for box in boxes for each in self.taken)])

    def _blocks(self, blocks: Sequence[Box]) -> list[Point] | None:
        """The larger first, each as far to the lower left as it can; as loosely as all have room."""
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
        """The lower left corner of a place, the lowest and of those the leftmost."""
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
    """How far boxes are from each other, across or upwards, whichever is more."""
    across = max(one.left - other.right, other.left - one.right)
    up = max(one.bottom - other.top, other.bottom - one.top)
    return max(across, up)

"""The marks of a view find their places: each the first of its own where it clashes with nothing that stands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import NamedTuple

from gearcad.drawing.layout.view import Candidates, View
from gearcad.drawing.shapes import Box, Dimension, Figure, Measured, Occupied

__all__ = ["dressed"]

_ANEW = 4
"""So often marks are placed anew, another one first."""

_CHOICE = 24
"""So many places that would do are compared where marks cross each other's lines, or are in each other's way."""


def dressed(view: View, *, within: Box | None = None, obstacles: Iterable[Figure] = ()) -> Figure | None:
    """The view with all its marks; None where one of them has no place.

    Of dimensions on the same side the shorter come first, so that they are inside the longer; else the order is that of the
    view. Where lines of marks would cross, a later place without crossings is taken, if there is one. For a mark that has no
    place left another one goes elsewhere; where that does not help, it chooses before all others.
    """
    marks, standing = _in_order(view), _Standing((view.figure, *obstacles), within)
    for _ in range(_ANEW):
        chosen: list[Figure] = []
        blocked = next((mark for number, mark in enumerate(marks) if not _placed(marks[: number + 1], chosen, standing)), None)
        if blocked is None:
            return Figure.of(view.figure, *chosen)
        marks = [blocked, *(each for each in marks if each is not blocked)]
    return None


class _Standing(NamedTuple):
    """What is there before any mark."""

    figures: tuple[Figure, ...]
    within: Box | None

    def and_of(self, marks: Iterable[Figure]) -> Occupied:
        return Occupied(*self.figures, *marks, within=self.within)


def _placed(marks: list[_Places], chosen: list[Figure], standing: _Standing) -> bool:
    """Place the last of some marks beside those that are `chosen`, of which one may be placed elsewhere for it."""
    occupied = standing.and_of(chosen)
    figure = _best(_free(marks[-1], occupied), occupied)
    if figure is not None:
        chosen.append(figure)
        return True
    for number in reversed(range(len(chosen))):
        others = standing.and_of(each for each in chosen if each is not chosen[number])
        pair = _pair(list(_free(marks[-1], others)), _free(marks[number], others))
        if pair is not None:
            chosen[number], mine = pair
            chosen.append(mine)
            return True
    return False


def _pair(mine: list[Figure], others: Iterable[Figure]) -> tuple[Figure, Figure] | None:
    """One of the others and one of mine that do not clash; the first whose lines cross least."""
    best: tuple[int, Figure, Figure] | None = None
    for other in others if mine else ():
        alone = Occupied(other)
        beside = next((each for each in mine if not alone.clashes(each)), None)
        crossings = 0 if beside is None else alone.crossings(beside)
        if beside is not None and (best is None or crossings < best[0]):
            best = crossings, other, beside
        if best is not None and not best[0]:
            break
    return None if best is None else best[1:]


def _free(places: Iterable[Figure], occupied: Occupied) -> Iterator[Figure]:
    return islice((each for each in places if not occupied.clashes(each)), _CHOICE)


def _best(free: Iterable[Figure], occupied: Occupied) -> Figure | None:
    """The first without crossings, or else that with the fewest."""
    best: tuple[int, Figure] | None = None
    for figure in free:
        crossings = occupied.crossings(figure)
        if not crossings:
            return figure
        if best is None or crossings < best[0]:
            best = crossings, figure
    return None if best is None else best[1]


class _Places:
    """The places of a mark, each made once, when it is asked for."""

    def __init__(self, candidates: Candidates) -> None:
        self._coming, self._made = iter(candidates()), list[Figure]()

    def __iter__(self) -> Iterator[Figure]:
        yield from self._made
        for figure in self._coming:
            self._made.append(figure)
            yield figure


class _Beside(NamedTuple):
    """Of a linear dimension: its direction, whether its line is above (right of) what it measures, and its length."""

    measured: Measured
    above: bool
    length: float


def _in_order(view: View) -> list[_Places]:
    """Dimensions of a side change places among themselves, by their lengths; what has no place at all is nothing to say."""
    marks = [(places, first) for each in view.annotations if (first := next(iter(places := _Places(each)), None)) is not None]
    sides = [_beside(first) for _, first in marks]
    order = list(range(len(marks)))
    for side in {(each.measured, each.above) for each in sides if each is not None}:
        found = {number: each.length for number, each in enumerate(sides) if each is not None and each[:2] == side}
        for slot, number in zip(found, sorted(found, key=found.__getitem__), strict=True):
            order[slot] = number
    return [marks[number][0] for number in order]


def _beside(first: Figure) -> _Beside | None:
    dimension = first.shapes[0]
    if not isinstance(dimension, Dimension):
        return None
    axis = 0 if dimension.measured is Measured.HORIZONTAL else 1
    above = 2 * dimension.line[1 - axis] > dimension.first[1 - axis] + dimension.second[1 - axis]
    return _Beside(dimension.measured, above, abs(dimension.second[axis] - dimension.first[axis]))

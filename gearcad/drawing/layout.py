"""Layout of a sheet: its format, its scale, the places of its views and of their marks. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import NamedTuple

from gearcad.core.errors import ParameterError
from gearcad.drawing.options import SCALES, Projection, SheetSize
from gearcad.drawing.placement import Occupied, Room
from gearcad.drawing.shapes import Box, Dimension, Figure, MeasuredDistance, Point

Candidates = Callable[[], Iterable[Figure]]
"""One mark in all places where it may stand, best first."""


@dataclass(frozen=True)
class View:
    """A view: `figure` is its outline at the scale of the paper, its origin on the axis shared with the views beside it.

    `annotations` are its marks in order of importance, each by its possible places.
    """

    name: str
    figure: Figure
    annotations: tuple[Candidates, ...] = ()


_ANEW = 4
"""Number of attempts to place all marks, each with another mark first."""

_CHOICE = 24
"""Number of free places compared where marks cross or block each other."""


def dressed(view: View, *, within: Box | None = None, obstacles: Iterable[Figure] = ()) -> Figure | None:
    """Return the view with all its marks; None where one of them has no place.

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
    """Figures that are present before any mark."""

    figures: tuple[Figure, ...]
    within: Box | None

    def and_of(self, marks: Iterable[Figure]) -> Occupied:
        return Occupied(*self.figures, *marks, within=self.within)


def _placed(marks: list[_Places], chosen: list[Figure], standing: _Standing) -> bool:
    """Place the last of some marks beside the `chosen` ones, one of which may be moved for it. Return whether it has a
    place.
    """
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
    """Return one of the others and one of mine that do not clash: the first such pair with the fewest crossings; None without
    one.
    """
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
    """Return the first figure without crossings, else the one with the fewest; None without any."""
    best: tuple[int, Figure] | None = None
    for figure in free:
        crossings = occupied.crossings(figure)
        if not crossings:
            return figure
        if best is None or crossings < best[0]:
            best = crossings, figure
    return None if best is None else best[1]


class _Places:
    """Possible places of a mark, each made once, on demand."""

    def __init__(self, candidates: Candidates) -> None:
        self._coming, self._made = iter(candidates()), list[Figure]()

    def __iter__(self) -> Iterator[Figure]:
        yield from self._made
        for figure in self._coming:
            self._made.append(figure)
            yield figure


class _DimensionOrder(NamedTuple):
    """Order of a linear dimension: its direction, whether its line is above (right of) the measured points, and its length."""

    measured: MeasuredDistance
    above: bool
    length: float


def _in_order(view: View) -> list[_Places]:
    """Return the marks of a view in the order of placement. Dimensions of one side are sorted by length; a mark without any
    place is left out.
    """
    marks = [(places, first) for each in view.annotations if (first := next(iter(places := _Places(each)), None)) is not None]
    sides = [_dimension_order(first) for _, first in marks]
    order = list(range(len(marks)))
    for side in {(each.measured, each.above) for each in sides if each is not None}:
        found = {number: each.length for number, each in enumerate(sides) if each is not None and each[:2] == side}
        for slot, number in zip(found, sorted(found, key=found.__getitem__), strict=True):
            order[slot] = number
    return [marks[number][0] for number in order]


def _dimension_order(first: Figure) -> _DimensionOrder | None:
    dimension = first.shapes[0]
    if not isinstance(dimension, Dimension):
        return None
    axis = 0 if dimension.measured is MeasuredDistance.HORIZONTAL else 1
    above = 2 * dimension.line[1 - axis] > dimension.first[1 - axis] + dimension.second[1 - axis]
    return _DimensionOrder(dimension.measured, above, abs(dimension.second[axis] - dimension.first[axis]))


_LARGEST = 50.0
_CHOSEN = tuple(name for name, factor in SCALES.items() if factor <= _LARGEST)
"""Scales that the layout may choose, the largest first."""

_SHEETS = (SheetSize.A3, SheetSize.A2, SheetSize.A1, SheetSize.A0)
"""Sheets that the layout may choose, the smallest first."""

_ENOUGH = (*((sheet, 1 / 2) for sheet in _SHEETS[:2]), *((sheet, 1 / 5) for sheet in _SHEETS))
"""The first of these sheets is taken that has room at its scale or a larger one.

What would need 1:5 on A3 is often some 300 mm wide: there the lines at tip and root of its teeth nearly meet, at 1:2 on A2
they do not. Still larger sheets are unhandy; they are taken where A2 has no room at 1:5 either.
"""


@dataclass(frozen=True)
class Fixed:
    """Content of a sheet apart from its views: border, title block, tables, notes.

    `free` is the area within the frame, `taken` those within it where something stands.
    """

    figure: Figure
    free: Box
    taken: tuple[Box, ...] = ()


@dataclass(frozen=True)
class Views:
    """Views in rows, as arranged in first angle projection, and blocks that may stand anywhere (details, diagrams).

    Views of a row have their origins on one axis; the first views of all rows have theirs one below the other. The view from
    the left is at the right, the view from above is below. In third angle projection they are at the other side.
    """

    rows: tuple[tuple[View, ...], ...]
    blocks: tuple[View, ...] = ()


@dataclass(frozen=True)
class Arrangement:
    """A laid-out sheet: `scale` is one of ISO 5455, `origins` are the places of the views' origins, `figure` is the whole
    content.
    """

    sheet: SheetSize
    scale: str
    figure: Figure = field(repr=False)
    origins: Mapping[str, Point]

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the paper (mm)."""
        return self.sheet.size

    @property
    def factor(self) -> float:
        """mm of paper for a mm of the part."""
        return SCALES[self.scale]


def arranged(
    views: Callable[[float], Views],
    fixed: Callable[[SheetSize, str], Fixed],
    *,
    sheet: SheetSize = SheetSize.AUTO,
    scale: str = "auto",
    projection: Projection = Projection.FIRST,
) -> Arrangement:
    """Return the arrangement of all views with all their marks on a sheet, none over another.

    `views` makes them at a scale (mm of paper for a mm of the part). `fixed` makes the rest of a sheet, which may name the
    scale ("1:2") but has the same size at any scale. "auto" for both takes the largest scale with room on A3, or else on A2,
    if it is 1:2 or larger. Else it takes the smallest sheet with room at 1:5 or larger, else the sheet with the largest scale.
    Raises ParameterError of `scale` or `sheet`, which names a choice with room.
    """
    trial = _Trial(views, fixed, projection)
    scales = _CHOSEN if scale == "auto" else (scale,)
    sheets = _SHEETS if sheet is SheetSize.AUTO else (sheet,)
    enough = _ENOUGH if scale == "auto" else tuple((each, 0.0) for each in sheets)
    tried = (trial.largest(each, scales, least) for each, least in enough if each in sheets)
    good = (each for each in tried if each is not None)
    best = next(good, None)
    for each in sheets if best is None else ():
        found = trial.largest(each, scales)
        best = found if best is None or (found is not None and found.factor > best.factor) else best
    if best is None:
        raise _refusal(trial, sheet, scale)
    return best


@dataclass
class _Trial:
    """Views at several scales and the fixed content of several sheets, each made once."""

    views: Callable[[float], Views]
    fixed: Callable[[SheetSize, str], Fixed]
    projection: Projection
    crowded: str = ""
    """A view whose marks had no place at some scale."""

    _rooms: dict[SheetSize, Room] = field(default_factory=dict)
    _bare: dict[str, _ViewFigures] = field(default_factory=dict)
    _dressed: dict[str, _ViewFigures | None] = field(default_factory=dict)

    def largest(self, sheet: SheetSize, scales: Sequence[str], least: float = 0.0) -> Arrangement | None:
        """Return the arrangement at the first of the scales that has room and is no smaller than `least`; None if there is
        none.
        """
        good = (scale for scale in scales if SCALES[scale] >= least)
        return next((found for scale in good if (found := self.at(sheet, scale)) is not None), None)

    def at(self, sheet: SheetSize, scale: str) -> Arrangement | None:
        """Return the arrangement on a sheet at a scale; None where there is no room."""
        room = self._room(sheet, scale)
        if not self._outlines(scale).may_fit(room.free):
            return None
        shown = self._with_marks(scale)
        if shown is None:
            return None
        aligned = 0 if self.projection is Projection.FIRST else -1
        rooms = (room, room.tight, *([room.tightest] if sheet is SheetSize.A4 else []))  # nothing is narrower than A4
        tried = (each.places(shown.boxes, shown.block_boxes, aligned=aligned) for each in rooms)
        places = next((each for each in tried if each is not None), None)
        if places is None:
            return None
        stood = {
            name: (figure, at)
            for row, ats in zip((*shown.rows, shown.blocks), places, strict=True)
            for (name, figure), at in zip(row, ats, strict=True)
        }
        whole = self.fixed(sheet, scale).figure
        figures = Figure.of(whole, *(figure.moved(*at) for figure, at in stood.values()))
        return Arrangement(sheet, scale, figures, {name: at for name, (_, at) in stood.items()})

    def _room(self, sheet: SheetSize, scale: str) -> Room:
        if sheet not in self._rooms:
            fixed = self.fixed(sheet, scale)
            self._rooms[sheet] = Room(fixed.free, fixed.taken)
        return self._rooms[sheet]

    def _made(self, scale: str) -> Views:
        made = self.views(SCALES[scale])
        if self.projection is Projection.FIRST:
            return made
        return Views(tuple(tuple(reversed(row)) for row in reversed(made.rows)), made.blocks)

    def _outlines(self, scale: str) -> _ViewFigures:
        if scale not in self._bare:
            self._bare[scale] = _ViewFigures.of(self._made(scale), lambda view: view.figure)
        return self._bare[scale]

    def _with_marks(self, scale: str) -> _ViewFigures | None:
        if scale not in self._dressed:
            try:
                self._dressed[scale] = _ViewFigures.of(self._made(scale), _with_all)
            except _Crowded as crowded:
                self._dressed[scale], self.crowded = None, str(crowded)
        return self._dressed[scale]


class _Crowded(Exception):
    """A mark of the named view has no place."""


def _with_all(view: View) -> Figure:
    figure = dressed(view)
    if figure is None:
        raise _Crowded(view.name)
    return figure


class _ViewFigures(NamedTuple):
    """Figures of views by their names."""

    rows: tuple[tuple[tuple[str, Figure], ...], ...]
    blocks: tuple[tuple[str, Figure], ...]

    @classmethod
    def of(cls, views: Views, shown: Callable[[View], Figure]) -> _ViewFigures:
        rows = tuple(tuple((view.name, shown(view)) for view in row) for row in views.rows)
        return cls(rows, tuple((view.name, shown(view)) for view in views.blocks))

    @property
    def boxes(self) -> list[list[Box]]:
        return [[figure.box for _, figure in row] for row in self.rows]

    @property
    def block_boxes(self) -> list[Box]:
        return [figure.box for _, figure in self.blocks]

    def may_fit(self, free: Box) -> bool:
        """Return whether the views of each row together are no wider than an area, and the rows together no higher."""
        rows = [row for row in self.boxes if row]
        heights = (max(box.top for box in row) - min(box.bottom for box in row) for row in rows)
        return sum(heights) <= free.height and all(sum(box.width for box in row) <= free.width for row in rows)


def _refusal(trial: _Trial, sheet: SheetSize, scale: str) -> ParameterError:
    """Return the error for a sheet or scale without room; it names the choices that have room."""
    larger = [each for each in _SHEETS if each is not sheet] if sheet is not SheetSize.AUTO else []
    asked = _CHOSEN if scale == "auto" else (scale,)
    elsewhere = next((found for each in larger if (found := trial.largest(each, asked)) is not None), None)
    would_do = (
        [] if elsewhere is None else [f"sheet {elsewhere.sheet.value} has" + f" at {elsewhere.scale}" * (scale == "auto")]
    )
    where = "on any sheet up to A0" if sheet is SheetSize.AUTO else f"on {sheet.value}"
    if scale != "auto":
        there = _SHEETS[-1] if sheet is SheetSize.AUTO else sheet
        smaller = trial.largest(there, _CHOSEN)
        if smaller is not None:
            would_do.insert(0, f"{smaller.scale} has")
        return ParameterError("scale", scale, f"has no room {where}" + "".join(f"; {each}" for each in would_do))
    crowded = f"; the marks of {trial.crowded} have no place" if trial.crowded and not would_do else ""
    return ParameterError(
        "sheet", sheet.value, f"no scale has room {where}" + "".join(f"; {each}" for each in would_do) + crowded
    )

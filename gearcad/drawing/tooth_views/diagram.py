"""A diagram of depths over places: the curves, the places numbered below, and a table of them. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gearcad.drawing.marks import Cell, plain, symbol, table
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Polyline, Shape, Text
from gearcad.drawing.tooth_views.depths import Depths
from gearcad.drawing.tooth_views.spread import spread
from gearcad.drawing.words import Draughting, Words

__all__ = ["depth_diagram"]

_WIDTH, _HEIGHT = 60.0, 15.0
"""Of the curves."""

_SMALL, _TITLE = 2.5, 3.5
"""Heights of texts."""

_ROW = 4.2
_CELL_AIR = 1.6
_NUMBER_GAP = 3.5
_DROP = 3.0
"""From the lowest depth to the numbers of the places."""

_PENS = {"profile_start": Pen.THIN, "profile_end": Pen.HIDDEN, "flank_left": Pen.HIDDEN}
"""Those of curves that are not thick."""


@dataclass(frozen=True)
class _Plot:
    """Where places and depths are on paper; the unmodified flank is at height 0, material taken off below it."""

    depths: Depths

    def across(self, place: float) -> float:
        first, last = self.depths.places[[0, -1]]
        return float(_WIDTH * (place - first) / (last - first))

    def up(self, depth: float) -> float:
        low, high = self.depths.extent
        return -_HEIGHT * float(depth) / (high - low)

    @property
    def floor(self) -> float:
        return self.up(self.depths.extent[1])


def depth_diagram(title: str, place_symbol: str, depths: Depths, notes: Sequence[str], draughting: Draughting) -> Figure:
    """The diagram with its title above and notes below; `place_symbol` is that of the places."""
    plot = _Plot(depths)
    top = max(plot.up(depths.extent[0]), 0.0)
    drawn = Figure.of(_curves(plot), _places(plot), _names(plot, draughting.words))
    drawn = Figure.of(Text(title, (0.0, top + 4.0), _TITLE, pen=Pen.TEXT), drawn)
    grid = _table(place_symbol, depths, draughting.words)
    below = drawn.box.bottom - 3.0
    rows = (plain(line, _SMALL).at((0.0, below - grid.box.height - _ROW * (i + 1))) for i, line in enumerate(notes))
    return Figure.of(drawn, grid.moved(0.0, below), *rows)


def _curves(plot: _Plot) -> Figure:
    depths = plot.depths
    curves = (
        Polyline.straight(
            [(plot.across(x), plot.up(y)) for x, y in zip(depths.fine, each.along, strict=True)],
            _PENS.get(each.key, Pen.OUTLINE),
        )
        for each in depths.series
    )
    return Figure.of(Line((-3.0, 0.0), (_WIDTH + 3.0, 0.0), Pen.CENTRE), *curves)


def _places(plot: _Plot) -> Figure:
    """A thin line down from each place to its number."""
    across = [plot.across(place) for place in plot.depths.places]
    numbers = spread(across, _NUMBER_GAP)
    end, low = plot.floor - 1.0, plot.floor - _DROP
    parts: list[Shape] = []
    for i, (x, at) in enumerate(zip(across, numbers, strict=True)):
        parts += [Line((x, 0.0), (x, end), Pen.THIN), Line((x, end), (at, low), Pen.THIN)]
        parts.append(Text(str(i + 1), (at, low - 0.8 - _SMALL), _SMALL, Anchor.CENTRE))
    return Figure.of(*parts)


def _names(plot: _Plot, words: Words) -> Figure:
    """Those of the curves at their right ends, where there are several."""
    series = sorted(plot.depths.series, key=lambda each: plot.up(each.along[-1]))
    if len(series) == 1:
        return Figure()
    ends = [plot.up(each.along[-1]) for each in series]
    rows = spread(ends, 4.0)
    parts: list[Shape] = []
    for each, end, row in zip(series, ends, rows, strict=True):
        parts.append(Line((_WIDTH, end), (_WIDTH + 5.0, row), Pen.THIN))
        parts.append(Text(words[f"rings.{each.key}"], (_WIDTH + 6.0, row), _SMALL, Anchor.MIDDLE_LEFT))
    return Figure.of(*parts)


def _table(place_symbol: str, depths: Depths, words: Words) -> Figure:
    """Its upper left corner at the origin: number, diameter, place (mm), depths (µm)."""
    several = len(depths.series) > 1
    columns = [["", *(str(i + 1) for i in range(len(depths.places)))]]
    if depths.diameters is not None:
        columns.append(["⌀", *(words.number(size, 3) for size in depths.diameters)])
    columns.append([place_symbol, *(words.number(place, 3) for place in abs(depths.places))])
    for each in depths.series:
        head = f"{words['rings.' + each.key]} µm" if several else "µm"
        columns.append([head, *(words.number(depth, 1) for depth in each.at_places)])
    heads, *rows = zip(*columns, strict=True)
    cells = [[Cell(each, symbolic=True, anchor=Anchor.RIGHT) for each in heads]]
    cells += [[Cell(each, anchor=Anchor.RIGHT) for each in row] for row in rows]
    widths = [max(symbol(each, _SMALL).width for each in column) + 2 * _CELL_AIR for column in columns]
    return table(widths, cells, row_height=_ROW, height=_SMALL)[0]

"""Diagrams of flank modifications over the profile and along the face (ISO 21771). Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from gearcad.core.records import Floats
from gearcad.drawing.annotation_text import Cell, plain, symbol, table
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Polyline, Shape, Text
from gearcad.drawing.views.tooth_detail import spread
from gearcad.drawing.words import Draughting, SheetWords
from gearcad.geometry import Gear

_BETWEEN = 24
"""Points of a curve between two places where it is not smooth."""


@dataclass(frozen=True)
class Series:
    """One curve: the key of its words, and its depths (µm) at the `places` and at the `fine` places of its Depths."""

    key: str
    at_places: Floats
    along: Floats


@dataclass(frozen=True)
class Depths:
    """Depths (µm) over roll lengths or heights z (mm): `places` are the ends, the middle, and the starts of reliefs.

    `fine` are the places of a curve's points. `diameters` are the diameters (mm) at the places; None along the face.
    """

    places: Floats
    fine: Floats
    series: tuple[Series, ...]
    diameters: Floats | None = None

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest of all depths and 0 (µm)."""
        every = np.concatenate([[0.0], *(each.along for each in self.series)])
        return float(every.min()), float(every.max())

    @property
    def turned(self) -> Self:
        """The same depths from the last place to the first."""
        series = tuple(replace(each, at_places=each.at_places[::-1], along=each.along[::-1]) for each in self.series)
        diameters = None if self.diameters is None else self.diameters[::-1]
        return replace(self, places=self.places[::-1], fine=self.fine[::-1], series=series, diameters=diameters)


def profile_depths(gear: Gear) -> Depths | None:
    """Return depths over roll lengths from root form to tip form circle, at mid face width; with twist at both ends too.

    Modifications along the face only are left out. None without a modification of the profile.
    """
    form = gear.flank_form
    if not form.modification.on_profile:
        return None
    middle = (form.first + form.last) / 2
    centre = [middle] if form.modification.profile_crowning else []
    places = np.array(sorted({form.first, *form.relief_starts, *centre, form.last}))
    heights = {"profile_middle": form.width / 2}
    if form.modification.twist:
        heights = {"profile_start": 0.0, **heights, "profile_end": form.width}

    def depth(rolls: Floats, z: float) -> Floats:
        along: Floats = form.depth(middle, z) - form.depth(middle, form.width / 2)
        result: Floats = 1000 * (form.depth(rolls, z) - along)
        return result

    fine = _fine(np.union1d(places, form.roll_breaks))
    series = tuple(Series(key, depth(places, z), depth(fine, z)) for key, z in heights.items())
    return Depths(places, fine, series, 2 * np.hypot(form.base_radius, places))


def helix_depths(gear: Gear) -> Depths | None:
    """Return depths along the face at mid profile, without the modification of the profile there; for both flanks if they
    differ.

    None without a modification along the face.
    """
    form = gear.flank_form
    of = form.modification
    if not any((of.lead_crowning, of.end_relief, of.helix_angle_modification)):
        return None
    middle = (form.first + form.last) / 2
    places = np.array(sorted({0.0, *form.height_breaks, form.width / 2, form.width}))
    fine = _fine(places)
    right = gear.internal  # with its tip up, the flank of a ring's tooth with y > 0 is the one on the right
    flanks = {"flank_right": right, "flank_left": not right} if of.helix_angle_modification else {"flanks": True}

    def depth(heights: Floats, left: bool) -> Floats:
        at_middle = form.depth(middle, form.width / 2, left=left)
        result: Floats = 1000 * (form.depth(middle, heights, left=left) - at_middle)
        return result

    return Depths(places, fine, tuple(Series(key, depth(places, left), depth(fine, left)) for key, left in flanks.items()))


def _fine(places: Floats) -> Floats:
    """Return the places and points between them."""
    steps = np.arange(len(places) * _BETWEEN - _BETWEEN + 1) / _BETWEEN
    result: Floats = np.interp(steps, np.arange(len(places)), places)
    return result


_WIDTH, _HEIGHT = 60.0, 15.0
"""Width and height of the curves (mm of paper)."""

_SMALL, _TITLE = 2.5, 3.5
"""Heights (mm) of small texts and of titles."""

_ROW = 4.2
_CELL_AIR = 1.6
_NUMBER_GAP = 3.5
_DROP = 3.0
"""Distance from the lowest depth to the numbers of the places."""

_PENS = {"profile_start": Pen.THIN, "profile_end": Pen.HIDDEN, "flank_left": Pen.HIDDEN}
"""Pens of the curves that are not thick."""


@dataclass(frozen=True)
class _Plot:
    """Scales from places and depths to paper; the unmodified flank is at height 0, removed material below it."""

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
    """Return the diagram with its title above and its table and notes below; `place_symbol` is the symbol of the places."""
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
    """Return a thin line down from each place to its number."""
    across = [plot.across(place) for place in plot.depths.places]
    numbers = spread(across, _NUMBER_GAP)
    end, low = plot.floor - 1.0, plot.floor - _DROP
    parts: list[Shape] = []
    for i, (x, at) in enumerate(zip(across, numbers, strict=True)):
        parts += [Line((x, 0.0), (x, end), Pen.THIN), Line((x, end), (at, low), Pen.THIN)]
        parts.append(Text(str(i + 1), (at, low - 0.8 - _SMALL), _SMALL, Anchor.CENTRE))
    return Figure.of(*parts)


def _names(plot: _Plot, words: SheetWords) -> Figure:
    """Return the names of the curves at their right ends; empty for a single curve."""
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


def _table(place_symbol: str, depths: Depths, words: SheetWords) -> Figure:
    """Return the table of number, diameter (mm), place (mm) and depths (µm), its upper left corner at the origin."""
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


def modification_figures(drawn: DrawnGear, draughting: Draughting) -> tuple[Figure, ...]:
    """Return the diagram of the profile and the diagram along the face, each if there is something to show; none for a rack.

    The diagram along the face has the direction of the gear's section; both state the end from which z is counted.
    """
    gear, words = drawn.gear, draughting.words
    if not isinstance(gear, Gear):
        return ()
    figures = []
    if (profile := profile_depths(gear)) is not None:
        notes = tuple(_notes(gear, profile, drawn.direction, words))
        figures.append(depth_diagram(words["rings.profile_diagram"], "L", profile, notes, draughting))
    if (helix := helix_depths(gear)) is not None:
        notes = tuple(_notes(gear, helix, drawn.direction, words))
        lying = helix if gear.double_helix.present or drawn.direction > 0 else helix.turned
        figures.append(depth_diagram(words["rings.helix_diagram"], "z", lying, notes, draughting))
    return tuple(figures)


def _notes(gear: Gear, depths: Depths, direction: int, words: SheetWords) -> Iterator[str]:
    """Yield notes on the sign of depths and, if it matters, on the origin of z and the viewing direction of flanks."""
    yield words["rings.depth_sign"]
    near, far = ("left", "right") if direction > 0 else ("right", "left")
    several = len(depths.series) > 1
    if several or depths.diameters is None:
        yield words["rings.z_of_halves" if gear.double_helix.present else f"rings.z_from_{near}"]
    if any(each.key.startswith("flank_") for each in depths.series):
        yield words[f"rings.flanks_from_{far}"]

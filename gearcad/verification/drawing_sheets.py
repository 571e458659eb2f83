"""Judge of drawings: sheets read and audited by ezdxf, every row of their tables parsed from the drawn texts."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.drawing_figures import TableFigure
from gearcad.verification.drawings import read_dxf
from gearcad.verification.limits_of_fit import fit_limits, is_class

_OUTLINE, _TABLE = "OUTLINE", "TABLE"
"""Layers of the outlines and of the lines of tables."""

_NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(?:\.\d+)?")

_SAME = 0.01
"""Distance (mm of paper) of lines and texts that are in line."""

_ROUNDED = 1e-6
"""Share of half a unit of the last digit that is permitted beside it, for values that end with a five."""

_DIMENSION, _SIZE = 2, 3
"""Fewest decimals of dimensions, unless these end with zeros, and of sizes that parts have as inputs."""

_DASH = "—"

_BESIDE, _LINE = 30.0, 3.0
"""Distances (mm of paper) along and across the line at which size, tolerance class and limits stand together."""

_LIMIT = re.compile(r"[±+−-]\d|0$")
"""Beginning of a limit deviation."""


class Letters(NamedTuple):
    """A drawn text at its lower left end (mm of paper)."""

    x: float
    y: float
    words: str


@dataclass(frozen=True)
class DrawnRow:
    """A row of a table as it is drawn: its words and symbol without spaces, and its value, limits behind it."""

    words: str
    symbol: str
    value: str


@dataclass(frozen=True)
class ExpectedSheet:
    """What a sheet must show: the `rows` of the table under its `heading`, the `title`, and `sizes` (mm) by their names.

    `texts` stand anywhere, by their names. `mass` (kg) is None where the sheet has none. Numbers have the `decimal_mark`.
    """

    heading: str
    rows: Sequence[TableFigure]
    title: str
    sizes: Mapping[str, float]
    texts: Mapping[str, str] = field(default_factory=dict)
    decimal_mark: str = "."
    mass: float | None = None


class _Sheet:
    """A sheet as it was read: its texts, and the tables' lines."""

    def __init__(self, document: Any, decimal_mark: str) -> None:
        space = document.modelspace()
        self.mark = decimal_mark
        self.dimensions = list(space.query("DIMENSION"))
        self.letters = [_letters(each) for each in space.query("TEXT")]
        self.measured = [self._in_block(document, each) for each in self.dimensions]
        self.boxes = [
            _box(each) for each in space.query("LWPOLYLINE") if each.dxf.layer == _OUTLINE and each.closed and len(each) == 4
        ]
        lines = [each for each in space.query("LINE") if each.dxf.layer == _TABLE]
        self.lines = [(*each.dxf.start.vec2, *each.dxf.end.vec2) for each in lines]

    @staticmethod
    def _in_block(document: Any, dimension: Any) -> list[str]:
        """Texts of a dimension as it is drawn."""
        block = document.blocks.get(dimension.dxf.geometry)
        return [] if block is None else [each.plain_text() for each in block.query("TEXT")]

    def table(self, heading: str) -> tuple[float, float, float, float] | None:
        """Return the box of the table under a heading: left, bottom, right, top (mm of paper)."""
        for x, y, words in self.letters:
            holding = [box for box in self.boxes if words == heading and _holds(box, x, y)]
            if holding:
                return max(holding, key=lambda box: (box[2] - box[0]) * (box[3] - box[1]))
        return None

    def rows(self, table: tuple[float, float, float, float]) -> list[DrawnRow]:
        """Return the rows of a table, column by column from the top."""
        found = []
        inside = [box for box in self.boxes if box[3] < table[3] - _SAME and _holds(table, box[0], (box[1] + box[3]) / 2)]
        for left, bottom, right, top in sorted(inside):
            lines = [each for each in self.lines if _holds((left, bottom, right, top), each[0], (each[1] + each[3]) / 2)]
            upright = sorted(each[0] for each in lines if abs(each[0] - each[2]) < _SAME)
            level = sorted(each[1] for each in lines if abs(each[1] - each[3]) < _SAME)
            cells: dict[tuple[int, int], list[Letters]] = {}
            for each in self.letters:
                if _holds((left, bottom, right, top), each.x, each.y):
                    place = bisect_right(level, each.y), bisect_right(upright, each.x)
                    cells.setdefault(place, []).append(each)
            for row in range(len(level), -1, -1):
                texts = [cells.get((row, column), []) for column in range(3)]
                symbol = "".join(_squeezed(each.words) for each in sorted(texts[1]))
                found.append(DrawnRow(_squeezed(_read(texts[0])), symbol, _read(texts[2])))
        return found

    def has(self, text: str) -> bool:
        """Return whether a text is drawn, in one line or in several, or its beginning with an ellipsis."""
        words = [_squeezed(each.words) for each in self.letters]
        whole = _squeezed(text)
        downwards = sorted(self.letters, key=lambda each: (round(each.x, 2), -each.y))
        one = "".join(_squeezed(each.words) for each in downwards)
        return whole in one or any(_begins(each, whole) for each in words)

    def fits_of_dimensions(self) -> Iterator[tuple[str, str, list[str]]]:
        """Yield each tolerance class of a dimension with the text before it and the limits behind it."""
        for texts in self.measured:
            for place, text in enumerate(texts):
                if place and is_class(text):
                    alike = texts[place + 1 : place + 2]
                    limits = alike if alike and alike[0].startswith("±") else texts[place + 1 : place + 3]
                    yield texts[place - 1], text, limits

    def fits_of_texts(self) -> Iterator[tuple[str, str, list[str]]]:
        """Yield each tolerance class of a leader with the size at its left and the limits at its right, the upper first."""
        for each in self.letters:
            if not is_class(each.words):
                continue
            level = [other for other in self.letters if abs(other.y - each.y) < _SAME]
            before = [other for other in level if each.x - _BESIDE < other.x < each.x and self.digits(other.words)]
            behind = [
                other
                for other in self.letters
                if each.x < other.x < each.x + _BESIDE and abs(other.y - each.y) < _LINE and _LIMIT.match(other.words)
            ]
            nearest = sorted(behind, key=lambda other: other.x)
            if before and behind:
                alike = nearest[0].words.startswith("±")
                found = nearest[:1] if alike else sorted(nearest[:2], key=lambda other: -other.y)
                yield max(before, key=lambda other: other.x).words, each.words, [other.words for other in found]

    def digits(self, text: str) -> list[str]:
        """Return the numbers in a text as they are written, with a decimal point."""
        return _NUMBER.findall(text.replace("−", "-").replace(self.mark, "."))


def judge_sheet(path: Path, expected: ExpectedSheet) -> Iterator[Claim]:
    """Judge a sheet: readable, title, every row of its table, dimensions that tell what they measure, sizes, and mass."""
    judge = Judge(ClaimSubject.DRAWING, VerificationLevel.FILES, path.name, "ezdxf")
    document, claims = read_dxf(path, judge)
    yield from claims
    if document is None:
        return
    sheet = _Sheet(document, expected.decimal_mark)
    yield _titled(judge, document, sheet, expected.title)
    table = sheet.table(expected.heading)
    yield judge.holds("has its table", table is not None, place=f"no table under {expected.heading}")
    if table is not None:
        yield from _judge_rows(judge, sheet, sheet.rows(table), expected.rows)
    yield from _judge_dimensions(judge, sheet)
    yield from _judge_fits(judge, sheet)
    for name, text in expected.texts.items():
        yield judge.holds(name, sheet.has(text), place=f"{text} is nowhere")
    outside = [each.words for each in sheet.letters if table is None or not _holds(table, each.x, each.y)]
    outside += [text for texts in sheet.measured for text in texts]
    yield from _judge_sizes(judge, sheet, outside, expected.sizes)
    if expected.mass is not None:
        yield _weighed(judge, sheet, outside, expected.mass)


def _titled(judge: Judge, document: Any, sheet: _Sheet, title: str) -> Claim:
    """Judge the title: in the properties of the file, and among the texts, in one or more lines."""
    named = document.header.custom_vars.get("Title") or ""
    drawn = sheet.has(title)
    found = named if named != title[: len(named)] or not named else title if drawn else "not drawn"
    return judge.equal("title", title, found)


def _judge_rows(judge: Judge, sheet: _Sheet, drawn: Sequence[DrawnRow], expected: Sequence[TableFigure]) -> Iterator[Claim]:
    """Judge each row of a table; a row of the same words as another is the next of them."""
    left = list(expected)
    for row in drawn:
        of_row = next((each for each in left if _is_row(row.words, each.words)), None)
        if of_row is None:
            yield judge.holds(row.words, False, place=f"no figure for the row {row.words}: {row.value}")
            continue
        left.remove(of_row)
        yield _judge_row(judge, sheet, row, of_row)
    for missing in left:
        if missing.required:
            yield judge.holds(missing.words, False, place="the row is missing")


def _judge_row(judge: Judge, sheet: _Sheet, row: DrawnRow, expected: TableFigure) -> Claim:
    """Judge one row: its symbol, and its text, its dash, or its numbers to half a unit of their last digits."""
    symbol = _squeezed(expected.symbol.replace("_", ""))
    if row.symbol != symbol:
        return judge.equal(expected.words, symbol, row.symbol, place="symbol")
    if expected.text:
        same = _begins(_squeezed(row.value), _squeezed(expected.text))
        return judge.equal(expected.words, expected.text, expected.text if same else row.value)
    if expected.absent:
        return judge.equal(expected.words, _DASH, row.value[:1], place=row.value)
    digits = sheet.digits(row.value)[: len(expected.values)]
    shown = [_shown(value, decimals, text) for (value, decimals), text in zip(expected.values, digits, strict=False)]
    shown += [f"{value:.{decimals}f}" for value, decimals in expected.values[len(digits) :]]
    return judge.equal(expected.words, "; ".join(shown), "; ".join(digits), place=row.value)


def _shown(value: float, decimals: int, text: str) -> str:
    """Return the written number `text` if it is a value rounded to this many decimals, or to those that it has, if more."""
    places = max(decimals, len(text.partition(".")[2]))
    half = 0.5 * 10.0**-places
    return text if abs(float(text) - value) <= half * (1 + _ROUNDED) else f"{value:.{places}f}"


def _judge_dimensions(judge: Judge, sheet: _Sheet) -> Iterator[Claim]:
    """Judge that every dimension says what lies between its points, in its drawn text and in the text that CAD writes."""
    faults = []
    for dimension, texts in zip(sheet.dimensions, sheet.measured, strict=True):
        factor = float(dimension.override().get("dimlfac", 1.0))
        measured = float(dimension.get_measurement()) * factor
        written = [text for text in texts if sheet.digits(text)]
        nominal = sheet.digits(written[0])[-1] if written else ""
        if not nominal or _shown(measured, _DIMENSION, nominal) != nominal:
            faults.append(f"{' '.join(texts)} measures {measured:.6g} mm")
        if "<>" not in dimension.dxf.text and nominal not in dimension.dxf.text.replace(sheet.mark, "."):
            faults.append(f"{dimension.dxf.text} is drawn as {' '.join(texts)}")
    count = len(sheet.dimensions)
    yield judge.equal("dimensions that tell what they measure", count, count - len(faults), place="; ".join(faults))


def _judge_fits(judge: Judge, sheet: _Sheet) -> Iterator[Claim]:
    """Judge the limits beside each tolerance class, of dimensions and of texts, by ISO 286-1."""
    fits = Judge(judge.subject, judge.level, judge.where, "ISO 286-1")
    for number, (nominal, name, limits) in enumerate((*sheet.fits_of_dimensions(), *sheet.fits_of_texts()), 1):
        # Without the size, so that a baseline of another size has the same claims.
        quantity, sizes = f"limits of fit {number}, {name}", sheet.digits(nominal)
        deviations = [1e3 * float(each) for text in limits for each in sheet.digits(text)]
        expected = fit_limits(name, float(sizes[-1])) if sizes else None
        if sizes and expected is None:
            yield fits.not_judged(quantity, f"the formulas of the judge have no limits of {name} at this size")
            continue
        if len(limits) == 1 and limits[0].startswith("±"):
            deviations = [deviations[0], -deviations[0]]
        if expected is None or len(deviations) != 2:
            yield fits.holds(quantity, False, place=f"no size or no two limits: {' '.join((nominal, name, *limits))}")
            continue
        upper, lower = deviations
        drawn = f"{nominal} {name}: {upper:+g} and {lower:+g} µm are drawn"
        place = f"{drawn}, {expected.upper:+.3g} and {expected.lower:+.3g} µm are the limits"
        yield fits.holds(quantity, expected.has(upper, lower), place=place)


def _judge_sizes(judge: Judge, sheet: _Sheet, texts: Sequence[str], sizes: Mapping[str, float]) -> Iterator[Claim]:
    """Judge that each size is among the texts of the views."""
    written = [number for text in texts for number in sheet.digits(text)]
    for name, size in sizes.items():
        there = any(_shown(size, _SIZE, number) == number for number in written)
        yield judge.holds(f"size, {name}", there, place=f"{size:.3f} mm is nowhere")


def _weighed(judge: Judge, sheet: _Sheet, texts: Sequence[str], mass: float) -> Claim:
    """Judge the mass in the title block against the exact volume's."""
    grams = {"kg": 1.0, "g": 1e-3}
    found = []
    for text in texts:
        number, _, unit = text.replace("\N{NO-BREAK SPACE}", " ").rpartition(" ")
        if unit in grams and sheet.digits(number) == [number.replace(sheet.mark, ".")]:
            found.append((float(number.replace(sheet.mark, ".")), grams[unit]))
    if not found:
        return judge.holds("mass", False, place="no mass in the title block")
    value, factor = found[0]
    return judge.near("mass", value * factor, mass, _MASS, "", relative=True)


_MASS = 0.0052
"""Share of a mass that its three digits may be off (0.5 % at most) with the 0.02 % of its mesh."""


def _letters(entity: Any) -> Letters:
    x, y, _ = entity.dxf.insert
    return Letters(float(x), float(y), entity.plain_text())


def _box(polyline: Any) -> tuple[float, float, float, float]:
    across, up = zip(*((point[0], point[1]) for point in polyline), strict=True)
    return float(min(across)), float(min(up)), float(max(across)), float(max(up))


def _holds(box: tuple[float, float, float, float], x: float, y: float) -> bool:
    return box[0] - _SAME <= x <= box[2] + _SAME and box[1] - _SAME <= y <= box[3] + _SAME


def _read(letters: Sequence[Letters]) -> str:
    """Return the texts of a cell in one: those at its left from the top down, then what stands behind them."""
    if not letters:
        return ""
    left = min(each.x for each in letters)
    ordered = sorted(letters, key=lambda each: (each.x > left + _SAME, -each.y))
    return " ".join(each.words for each in ordered)


def _squeezed(words: str) -> str:
    return "".join(words.split())


def _begins(drawn: str, expected: str) -> bool:
    """Whether a text is the expected one, or its beginning with an ellipsis."""
    return drawn == expected or (drawn.endswith("…") and expected.startswith(drawn[:-1]))


def _is_row(drawn: str, words: str) -> bool:
    return _begins(drawn, _squeezed(words))

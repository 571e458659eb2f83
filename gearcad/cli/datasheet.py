"""The geometry data sheet on the screen: words, symbol, unit and value of everything a design derives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from gearcad.designs.design import Design, DesignKind
from gearcad.notice import Notice, texts
from gearcad.sheet import Block, Row, Section, Sheet, sheet_of
from gearcad.symbols import Symbol

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["plain_datasheet", "print_datasheet"]

_WIDE = 96
"""Console width from which the column of sources fits."""

_WIDTH = 12
"""Least of a column of values."""

_TRAIN_WORDS, _TRAIN_UNIT = 50, 9
"""Widths of columns on the sheet of a train; one of values is as wide as its longest."""

_NOTHING = Symbol("", "", "", "")


class _Line(NamedTuple):
    """One line of the sheet and its style on a terminal."""

    text: str
    style: str = ""


def plain_datasheet(design: Design, width: int) -> str:
    """The sheet as `print_datasheet` prints it on what knows no styles, for a window of so many characters."""
    return "".join(f"{line.text}\n" for line in _lines(design, wide=width >= _WIDE))


def print_datasheet(design: Design, console: Console) -> None:
    """Print the sheet: a column per gear, then the pair, material, load, mounting and rating, then the warnings."""
    from rich.text import Text

    for line in _lines(design, wide=console.width >= _WIDE):
        # Soft wrap: a narrow window may break a line, but never cut a number.
        console.print(Text(line.text, style=line.style), soft_wrap=True)


def _lines(design: Design, *, wide: bool) -> Iterator[_Line]:
    sheet = sheet_of(design)
    clauses = sheet.clauses if wide else ""
    yield _Line(f"{sheet.name}: {sheet.title}", "bold")
    yield _Line(", ".join(filter(None, (sheet.units, clauses))), "dim")
    yield _Line("")
    yield from _train_lines(sheet) if design.kind is DesignKind.TRAIN else _usual_lines(sheet, with_source=bool(clauses))
    yield from _warnings(sheet.notices)


def _usual_lines(sheet: Sheet, *, with_source: bool) -> Iterator[_Line]:
    for section in sheet.sections:
        width = max(_WIDTH, *(len(name) + 2 for name in section.columns), 0)
        if section.columns:
            yield _Line(_columns(_NOTHING, section.columns, width), "bold")
        for title, rows in section.blocks:
            yield _Line(title, "bold cyan")
            for row in rows:
                yield _Line(_columns(row.symbol, row.texts, width, with_source=with_source))
            yield _Line("")


def _columns(symbol: Symbol, values: Iterable[str], width: int, *, with_source: bool = False) -> str:
    """One line of 76 characters, or some more with the source behind."""
    numbers = "".join(f"{value:>{width}}" for value in values)
    line = f"  {symbol.words:<37}{symbol.symbol:<6} {symbol.unit:<6}{numbers}"
    return f"{line:<{max(80, len(line) + 2)}}{symbol.source}".rstrip() if with_source else line.rstrip()


def _train_lines(sheet: Sheet) -> Iterator[_Line]:
    """A train's parts have names of their own, which stand above the columns of each block."""
    for section in sheet.sections:
        for block in section.blocks:
            yield from _train_block(section, block)


def _train_block(section: Section, block: Block) -> Iterator[_Line]:
    names = section.columns or ("",)
    columns = zip(names, *(row.texts for row in block.rows), strict=True)
    widths = [max(_WIDTH, *(len(each) + 2 for each in column)) for column in columns]
    yield _Line(_train_line(block.title, Row("", _NOTHING, (), names), widths), "bold cyan")
    for row in block.rows:
        yield _Line(_train_line(f"  {row.symbol.words}", row, widths))
    yield _Line("")


def _train_line(words: str, row: Row, widths: list[int]) -> str:
    cells = "".join(f"{value:>{width}}" for value, width in zip(row.texts, widths, strict=True))
    return f"{words:<{_TRAIN_WORDS}} {row.symbol.symbol:<6}{row.symbol.unit:<{_TRAIN_UNIT}}{cells}".rstrip()


def _warnings(notices: tuple[Notice, ...]) -> Iterator[_Line]:
    said = texts(notices)
    if not said:
        yield _Line("No warnings.", "green")
        return
    yield _Line(f"Warnings ({len(said)})", "bold yellow")
    for warning in said:
        yield _Line(f"  {warning}", "yellow")

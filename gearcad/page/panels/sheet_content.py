"""Sections of a sheet as the browser shows them: rows in the page's words, with what changed, and what a kept design has."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from gearcad.page.panels.sheet_words import called, quantity_in, value_in
from gearcad.page.words import Words
from gearcad.sheet import Row, Section

__all__ = ["Cell", "Cells", "cells_of", "changed_cells", "shown_sections"]


_SAID = {"Mesh": "Gear mesh"}
"""Titles that the page has for something else."""


class Cell(NamedTuple):
    """A value with all its digits, and as shown."""

    value: Any
    text: str


Cells = Mapping[tuple[str, str], Cell]
"""What stands on a sheet, by the keys of rows and the names of columns; in a single column by ""."""


def cells_of(sections: Iterable[Section]) -> Cells:
    """Everything that stands on a sheet."""
    return {place: cell for section in sections for row in _rows(section) for place, cell in _places(row, section)}


def changed_cells(cells: Cells, former: Cells) -> dict[tuple[str, str], str]:
    """What those that are shown otherwise than before were; what was not there before has not changed."""
    return {place: former[place].text for place, cell in cells.items() if place in former and former[place].text != cell.text}


def shown_sections(
    sections: Iterable[Section],
    words: Words,
    *,
    folded: Collection[str] = (),
    changed: Mapping[tuple[str, str], str] | None = None,
    kept: Cells | None = None,
) -> list[dict[str, Any]]:
    """What the browser makes tables of; blocks whose English titles are `folded` are shut until somebody opens them."""
    before, beside = changed or {}, kept or {}
    return [
        {
            "columns": [called(words, name) for name in section.columns],
            "blocks": [
                {
                    "id": " ".join(filter(None, (section.name, *section.columns, block.title))),
                    "title": ": ".join(filter(None, (called(words, section.name), _title(block.title, words)))),
                    "folded": block.title in folded,
                    "rows": [_row(row, section, words, before, beside) for row in block.rows],
                }
                for block in section.blocks
            ],
        }
        for section in sections
    ]


def _title(title: str, words: Words) -> str:
    """That of a block: what it is about, or the gear that it is of."""
    known = words[_SAID.get(title, title)]
    return called(words, title) if known == title else known


def _rows(section: Section) -> Iterator[Row]:
    for block in section.blocks:
        yield from block.rows


def _places(row: Row, section: Section) -> Iterator[tuple[tuple[str, str], Cell]]:
    columns = section.columns if len(row.values) > 1 else ("",)
    for column, value, text in zip(columns, row.values, row.texts, strict=True):
        yield (row.key, column), Cell(value, text)


def _row(row: Row, section: Section, words: Words, changed: Mapping[tuple[str, str], str], kept: Cells) -> dict[str, Any]:
    return {
        "key": row.key,
        "words": words.divided(quantity_in(words, row.symbol.words)),
        "symbol": row.symbol.symbol,
        "unit": "°" if row.symbol.unit == "deg" else row.symbol.unit,
        "source": row.symbol.source,
        "cells": [
            {
                "text": value_in(words, cell.text),
                "former": value_in(words, changed.get(place, "")),
                **_beside(cell, kept.get(place), words),
            }
            for place, cell in _places(row, section)
        ],
    }


def _beside(cell: Cell, kept: Cell | None, words: Words) -> dict[str, str]:
    """What the kept design has, where that is shown otherwise, and how much more this one has."""
    if kept is None or kept.text == cell.text:
        return {}
    return {"kept": value_in(words, kept.text), "difference": _difference(cell, kept)}


def _difference(cell: Cell, kept: Cell) -> str:
    """With as many decimals as are shown; "" where there is no difference of numbers."""
    numbers = all(isinstance(each, int | float) and not isinstance(each, bool) for each in (cell.value, kept.value))
    if not numbers or not all(math.isfinite(each.value) for each in (cell, kept)):
        return ""
    decimals = max(len(each.text.partition(".")[2]) for each in (cell, kept))
    difference = cell.value - kept.value
    return f"{difference:+.3e}" if any("e" in each.text for each in (cell, kept)) else f"{difference:+.{decimals}f}"

"""Panel that compares designs: in one table what differs between the edited design and those beside it, the best marked."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad.core import symbols
from gearcad.core.errors import GearcadError
from gearcad.core.symbols import Better, Symbol, parts_of
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.material import Material
from gearcad.page.panels import Panel
from gearcad.page.panels.sheet_content import (
    SheetCell,
    called,
    cells_of,
    clause_in,
    quantity_in,
    sections_in,
    strength_figures,
    title_of,
    value_in,
)
from gearcad.page.panels.views import sheet_figures
from gearcad.page.words import PageWords
from gearcad.sheet import Block, Row, Section
from gearcad.sheet.blocks import ABSENT

if TYPE_CHECKING:
    from gearcad.page.panels.spec import BesidePanel

Place = tuple[str, str]
"""Key of a row, and name of a column; that of a single column is ""."""


class ComparedDesign(NamedTuple):
    """The figures of a design that can be compared, by their places: title of the block, symbol, and cell."""

    name: str
    cells: Mapping[Place, tuple[str, Symbol, SheetCell]]


def compared_design(design: Design) -> tuple[Section, ...]:
    """Return the sections of a design that are compared: masses, safeties, and the data sheet."""
    return (*_masses(design), *strength_figures(design).sections, *sheet_figures(design).sections)


def _masses(design: Design) -> Iterator[Section]:
    """Yield a section with the masses (kg) of the gears, and of all of them; None for a ring without an outside."""
    if not design.gears:
        return
    from gearcad.solids.exact.inertia import mass_properties

    found: dict[str, float | None] = dict.fromkeys(design.gears)
    for name, gear in design.gears.items():
        with suppress(GearcadError):
            found[name] = float(mass_properties(gear, _material(design, name).density).mass)
    symbol = symbols.MASS
    texts = tuple(ABSENT if mass is None else f"{mass:.4g}" for mass in found.values())
    yield Section(tuple(found), (Block("Body", (Row("mass", symbol, tuple(found.values()), texts),)),))


def _material(design: Design, name: str) -> Material:
    """Return the material of a gear; steel if none is given."""
    materials: Any = getattr(design, "materials", None) or getattr(design, "material", None)
    if isinstance(materials, tuple):
        materials = dict(zip(design.gears, materials, strict=False))
    found = materials.get(name) if isinstance(materials, Mapping) else materials
    return found if isinstance(found, Material) else Material()


def _compared(name: str, sections: Sequence[Section]) -> ComparedDesign:
    cells = cells_of(sections)
    found: dict[Place, tuple[str, Symbol, SheetCell]] = {}
    for section in sections:
        for block in section.blocks:
            title = ": ".join(filter(None, (section.name, block.title)))
            for row in block.rows:
                for column in section.columns if len(row.values) > 1 else ("",):
                    found.setdefault((row.key, column), (title, row.symbol, cells[row.key, column]))
    return ComparedDesign(name, found)


def compared_rows(designs: Sequence[ComparedDesign], words: PageWords) -> list[dict[str, Any]]:
    """Return a row for each quantity that differs between designs: its words, and a cell of each, the best of them marked."""
    places = dict.fromkeys(place for design in designs for place in design.cells)
    rows = []
    for place in places:
        found = [design.cells[place][2] if place in design.cells else None for design in designs]
        cells = [None if cell is None or cell.text == ABSENT else cell for cell in found]
        if len({"" if cell is None else cell.text for cell in cells}) < 2:
            continue
        title, symbol, _ = next(design.cells[place] for design in designs if place in design.cells)
        best = _best(symbol.better, cells)
        rows.append(
            {
                "key": " ".join(filter(None, place)),
                "block": title_of(title, words),
                "words": parts_of(words.divided(quantity_in(words, symbol.words))),
                "gear": called(words, place[1]),
                "symbol": symbol.parts,
                "unit": words.unit_name(symbol.unit),
                "source": clause_in(words, symbol.source),
                "cells": [
                    {"text": "–" if cell is None else value_in(words, cell.text), "best": at in best}
                    for at, cell in enumerate(cells)
                ],
            }
        )
    return rows


def _best(better: Better | None, cells: Sequence[SheetCell | None]) -> set[int]:
    """Return the places of the best cells, all that read alike; none where nobody knows which is better."""
    numbers = {at: _number(cell.value) for at, cell in enumerate(cells) if cell is not None}
    values = {at: number for at, number in numbers.items() if number is not None}
    if better is None or len(values) < 2:
        return set()
    best = (max if better is Better.HIGHER else min)(values, key=lambda at: values[at])
    return {at for at, cell in enumerate(cells) if cell is not None and cell.text == cells[best].text}  # type: ignore[union-attr]


def _number(value: Any) -> float | None:
    """Return a value as a number that can be compared, a life without end too; None for any other word."""
    from gearcad.rating.strength.duty import INFINITE  # only here: it brings all ratings with it

    if value == INFINITE:
        return math.inf
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and not math.isnan(value)
    return float(value) if is_number else None


class ComparePanel(Panel[tuple[Section, ...]]):
    """The table of what differs from the design of a `name`; `beside` swaps kept designs and lets go of them."""

    keeps_all = True

    def __init__(self, words: PageWords, name: Callable[[], str], beside: BesidePanel) -> None:
        from gearcad.page.components.elements import CompareView  # only here: other processes need no NiceGUI

        self._words, self._name = words, name
        own = {
            "title": words["Compare"],
            "hint": words["Keep up to four designs by “Beside”: what differs from this one stands here."],
            "same": words["Nothing differs."],
            "edited": words["edited"],
            "best": words["best"],
            "swap": words["edit this one, and keep the edited one"],
            "go": words["let go"],
        }
        self._view = CompareView(beside.swap, beside.let_go, own)
        self._kept: tuple[tuple[str, tuple[Section, ...]], ...] = ()
        self._present: tuple[Section, ...] = ()

    def aside(self, design: Design) -> Callable[[Design], tuple[Section, ...]] | None:
        return compared_design if design.kind is DesignKind.PLANETARY else None

    def find(self, design: Design) -> tuple[Section, ...]:
        return compared_design(design)

    def show(self, found: tuple[Section, ...]) -> None:
        self._present = found
        self._show()

    def clear(self) -> None:
        self._view.show([], [])

    def wait(self) -> None:
        self._view.wait()

    def keep_all(self, found: Sequence[tuple[str, tuple[Section, ...]]]) -> None:
        self._kept = tuple(found)
        self._show()

    def _show(self) -> None:
        """Show the edited design first, then those that are kept."""
        if not self._kept or not self._present:
            self.clear()
            return
        units = self._words.units
        named = ((self._name(), self._present), *self._kept)
        designs = [_compared(name, sections_in(sections, units)) for name, sections in named]
        self._view.show([design.name for design in designs], compared_rows(designs, self._words))

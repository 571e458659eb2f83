"""The data sheet: every derived quantity, what of it changed by the last step, and what to know before making the gears."""

from __future__ import annotations

from typing import Any, NamedTuple

from gearcad.designs.design import Design
from gearcad.page.components.sheet import SheetView
from gearcad.page.fields import fields_of
from gearcad.page.panels import Panel
from gearcad.page.panels.sheet_content import Cells, cells_of, changed_cells, shown_sections
from gearcad.page.panels.sheet_notices import shown_notices
from gearcad.page.words import Words
from gearcad.sheet import Sheet, sheet_of

__all__ = ["PINS", "SheetFound", "SheetPanel", "found_of", "shown_sheet", "view_words"]

_PINNED = {
    "gear": "teeth normal_module helix_angle profile_shift tip_diameter",
    "pair": "centre_distance working_transverse_pressure_angle transverse_contact_ratio overlap_ratio total_contact_ratio"
    " normal_backlash circumferential_backlash",
    "rack": "teeth normal_module helix_angle length",
    "planetary": "ratio centre_distance planets",
    "train": "name",
}
"""The figures that an engineer looks at first: on top until somebody chooses others."""

PINS = [f"{table}.{key}" for table, keys in _PINNED.items() for key in keys.split()]

_FOLDED = ("Basic rack", "Shaper cutter", "Transverse section", "Line of action, from T1", "Body", "Material", "Rating")
"""Blocks that are shut at first: inputs, and what few look for."""


class SheetFound(NamedTuple):
    """The sheet of a design, all that stands on it, and the keys of the fields of its spec."""

    sheet: Sheet
    cells: Cells
    keys: frozenset[str]


class SheetPanel(Panel[SheetFound]):
    """Every derived quantity in blocks; against those of a kept design, if there is one."""

    def __init__(self, words: Words) -> None:
        self._words = words
        self._view = SheetView(words["data sheet"], "gearcad-sheet", view_words(words))
        self._former: Cells = {}
        self._changed: dict[tuple[str, str], str] = {}
        self._kept: Cells | None = None

    def find(self, design: Design) -> SheetFound:
        return found_of(design)

    def show(self, found: SheetFound) -> None:
        if found.cells != self._former:
            self._changed = changed_cells(found.cells, self._former)
            self._former = found.cells
        self._view.show(shown_sheet(found, self._words, self._changed, self._kept))


def view_words(words: Words) -> dict[str, str]:
    """What tables of quantities say of themselves."""
    return {
        "search": words["find a quantity"],
        "pins": words["First figures"],
        "notices": words["Warnings"],
        "changed": words["values changed"],
        "kept": words["kept"],
        "difference": words["difference"],
    }


def found_of(design: Design) -> SheetFound:
    """What is to be shown of a design."""
    sheet = sheet_of(design)
    keys = (field["key"] for table in fields_of(design, {}) for group in table["groups"] for field in group["fields"])
    return SheetFound(sheet, cells_of(sheet.sections), frozenset(keys))


def shown_sheet(
    found: SheetFound, words: Words, changed: dict[tuple[str, str], str] | None = None, kept: Cells | None = None
) -> dict[str, Any]:
    """The sheet as the browser has it."""
    sheet = found.sheet
    return {
        "title": "",
        "verdict": "",
        "lines": [f"{sheet.name}: {sheet.title}"],
        "changes": len(changed or {}),
        "notices": shown_notices(sheet.notices, found.keys),
        "pins": PINS,
        "sections": shown_sections(sheet.sections, words, folded=_FOLDED, changed=changed, kept=kept),
    }

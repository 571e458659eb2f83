"""The data sheet: every derived quantity, and what to know before making the gears."""

from __future__ import annotations

from gearcad.designs.design import Design
from gearcad.errors import GearcadError
from gearcad.page.panels.figures import Figures, FiguresPanel, figures
from gearcad.page.panels.sheet_notices import keys_of, shown_notices
from gearcad.page.words import Words
from gearcad.sheet import sheet_of

__all__ = ["SheetPanel", "sheet_figures"]

_PINNED = {
    "gear": "teeth normal_module helix_angle profile_shift tip_diameter",
    "pair": "centre_distance working_transverse_pressure_angle transverse_contact_ratio overlap_ratio total_contact_ratio"
    " normal_backlash circumferential_backlash",
    "rack": "teeth normal_module helix_angle length",
    "planetary": "ratio centre_distance planets",
}
"""The figures that an engineer looks at first: on top until somebody chooses others."""

_PINS = [f"{table}.{key}" for table, keys in _PINNED.items() for key in keys.split()]

_FOLDED = ("Basic rack", "Shaper cutter", "Transverse section", "Line of action, from T1", "Body", "Material", "Rating")
"""Blocks that are shut at first: inputs, and what few look for."""


class SheetPanel(FiguresPanel):
    """Every derived quantity in blocks."""

    def __init__(self, words: Words) -> None:
        super().__init__(words["data sheet"], "gearcad-sheet", words)

    def find(self, design: Design) -> Figures:
        return sheet_figures(design)


def sheet_figures(design: Design) -> Figures:
    """Those of the sheet of a design."""
    try:
        sheet = sheet_of(design)
    except GearcadError as error:
        return Figures((), {}, notices=({"text": str(error), "keys": []},))
    return figures(
        sheet.sections,
        name=sheet.name,
        what=sheet.title,
        notices=shown_notices(sheet.notices, keys_of(design)),
        pins=_PINS,
        folded=_FOLDED,
    )

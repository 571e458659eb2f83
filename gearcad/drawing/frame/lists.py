"""What stands above the title block and grows upwards: the parts list (ISO 7573), and the revisions. Lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gearcad.drawing.frame.framed import Framed
from gearcad.drawing.frame.grid import grid_upwards
from gearcad.drawing.frame.template import SheetTemplate
from gearcad.drawing.options import Revision
from gearcad.drawing.words import Words
from gearcad.notice import Notice

__all__ = ["PartLine", "parts_list", "revisions"]


@dataclass(frozen=True, kw_only=True)
class PartLine:
    """A line of the parts list: `item` is the number in the balloon."""

    item: int
    quantity: int = 1
    number: str = ""
    title: str = ""
    material: str = ""
    remarks: str = ""

    @property
    def texts(self) -> tuple[str, ...]:
        return str(self.item), str(self.quantity), self.number, self.title, self.material, self.remarks


def parts_list(parts: Sequence[PartLine], template: SheetTemplate, words: Words) -> Framed:
    """Its heading at the bottom, the first item above it; the lower right corner at (0, 0). Empty without parts."""
    if not parts:
        return Framed()
    sizes = template.parts_list
    names = ("item", "quantity", "part_number", "part_title", "part_material", "remarks")
    rows = [tuple(words[f"frame.{name}"] for name in names), *(each.texts for each in parts)]
    keys = ["parts_list", *(f"item {each.item}" for each in parts)]
    found = grid_upwards(rows, keys, sizes.columns, sizes.row, sizes.text, "the parts list")
    return found.moved(-sum(sizes.columns), 0.0)


def revisions(changes: Sequence[Revision], template: SheetTemplate, words: Words) -> Framed:
    """The heading at the bottom, the first revision above it; the lower right corner at (0, 0). Empty without revisions."""
    if not changes:
        return Framed()
    sizes = template.revisions
    shown = changes[-sizes.most :]
    names = ("revision_index", "revision_text", "revision_date", "revision_name")
    rows = [tuple(words[f"frame.{name}"] for name in names)]
    rows += [(each.index, each.text, each.date, each.name) for each in shown]
    keys = ["revisions", *(f"revision {each.index}" for each in shown)]
    found = grid_upwards(rows, keys, sizes.columns, sizes.row, sizes.text, "the table of revisions")
    if len(shown) < len(changes):
        text = f"the table of revisions shows the last {len(shown)} of {len(changes)}"
        found += Framed(notices=(Notice("drawing-shortened", text, where="revisions"),))
    return found.moved(-sum(sizes.columns), 0.0)

"""What a panel of figures shows - a data sheet, a rating - and how it follows: what changed, and what a kept design has."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, NamedTuple

from gearcad.page.panels import Panel
from gearcad.page.panels.sheet_content import Cells, cells_of, changed_cells, shown_sections
from gearcad.page.panels.sheet_words import title_in
from gearcad.page.words import Words
from gearcad.sheet import Section

__all__ = ["Figures", "FiguresPanel", "figures", "shown_figures"]


class Figures(NamedTuple):
    """Sections and all that stands in them, with labelled lines before them, and notices as `shown_notices` gives them.

    `name` is that of the design, if `what` it is is told. Lines without a label are words of the page or names of standards.
    `pins` are the keys of rows that stand on top at first, `folded` the titles of blocks that are shut at first. `title` is a
    verdict, and `verdict` the class by which it is coloured.
    """

    sections: tuple[Section, ...]
    cells: Cells
    lines: tuple[tuple[str, str], ...] = ()
    notices: tuple[dict[str, Any], ...] = ()
    pins: Collection[str] = ()
    folded: Collection[str] = ()
    title: str = ""
    verdict: str = ""
    name: str = ""
    what: str = ""


def figures(sections: tuple[Section, ...], **others: Any) -> Figures:
    """Those of sections."""
    return Figures(sections, cells_of(sections), **others)


class FiguresPanel(Panel[Figures]):
    """Tables of figures: those that the last step changed beside what they were; below them those of a kept design."""

    compares = True

    def __init__(self, label: str, store: str, words: Words) -> None:
        from gearcad.page.components.sheet import SheetView  # only here: who finds figures elsewhere needs no NiceGUI

        self._words = words
        own = {
            "search": words["find a quantity"],
            "pins": words["First figures"],
            "notices": words["Warnings"],
            "changed": words["values changed"],
            "kept": words["kept"],
            "difference": words["difference"],
            "assumed": words["assumed"],
            "verify": words["to verify"],
            "pin": words["Enter or double click: on top"],
            "unpin": words["Enter or double click: not on top"],
            "waiting": words["being computed"],
        }
        self._view = SheetView(label, store, own)
        self._former: Cells = {}
        self._changed: dict[tuple[str, str], str] = {}
        self._kept: Figures | None = None

    def show(self, found: Figures) -> None:
        if found.cells != self._former:
            self._changed = changed_cells(found.cells, self._former)
            self._former = found.cells
        self._view.show(shown_figures(found, self._words, self._changed, self._kept))

    def keep(self, found: Figures | None) -> None:
        self._kept = found

    def wait(self) -> None:
        self._view.wait()


def shown_figures(
    found: Figures, words: Words, changed: dict[tuple[str, str], str] | None = None, kept: Figures | None = None
) -> dict[str, Any]:
    """As the browser has them."""
    beside = None if kept is None else kept.cells
    title, reason = _headline(found.title, words)
    told = [{"label": "", "text": f"{found.name}: {title_in(words, found.what)}"}] if found.what else []
    return {
        "title": title,
        "reason": reason,
        "verdict": found.verdict,
        "lines": told + [{"label": label, "text": text if label else words[text]} for label, text in found.lines],
        "beside": "" if kept is None else _headline(kept.title, words)[0],
        "changes": len(changed or {}),
        "notices": [each | {"about": words.notices.get(each.get("code", ""), "")} for each in found.notices],
        "pins": list(found.pins),
        "sections": shown_sections(found.sections, words, folded=found.folded, changed=changed, kept=beside),
    }


def _headline(verdict: str, words: Words) -> tuple[str, str]:
    """What a verdict comes to, in the language of the page, and why."""
    heads = {
        "strength passed": words["strength passed"],
        "strength NOT passed": words["strength NOT passed"],
        "strength not judged": words["strength not judged"],
        "strength not asked for": words["strength not asked for"],
    }
    head = next((each for each in heads if verdict.startswith(each)), "")
    return heads.get(head, ""), verdict.removeprefix(head).removeprefix(": ")

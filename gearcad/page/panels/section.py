"""The transverse section that the page draws: outlines in mesh, their circles, the path of contact, where flanks touch."""

from __future__ import annotations

from typing import Any

from gearcad.designs.design import Design
from gearcad.page.components.section import SectionView
from gearcad.page.panels import Panel
from gearcad.page.panels.section_content import section_of
from gearcad.page.panels.section_parts import plain
from gearcad.page.panels.sheet_words import called
from gearcad.page.words import Words

__all__ = ["SectionPanel", "section_in"]


class SectionPanel(Panel[dict[str, Any] | None]):
    """The mesh in its transverse section; the outlines of a design that is kept are dashed in it."""

    compares = True

    def __init__(self, words: Words) -> None:
        self._words, self._view = words, SectionView(words["transverse section"], _own(words))
        self._kept: dict[str, Any] | None = None

    def find(self, design: Design) -> dict[str, Any] | None:
        found = section_of(design)
        return None if found is None else section_in(self._words, plain(found))

    def show(self, found: dict[str, Any] | None) -> None:
        self._view.show(found, self._kept)

    def keep(self, found: dict[str, Any] | None) -> None:
        self._kept = found


def section_in(words: Words, found: dict[str, Any]) -> dict[str, Any]:
    """A section whose gears are called in the words of the page."""
    return found | {"bodies": [body | {"name": called(words, body["name"])} for body in found["bodies"]]}


def _own(words: Words) -> dict[str, str]:
    """What the script of the view says."""
    return {
        "tip": words["tip circle"],
        "reference": words["reference circle"],
        "base": words["base circle"],
        "form": words["root form circle"],
        "root": words["root circle"],
        "active": words["active root circle"],
        "pitch": words["working pitch circle"],
        "fit": words["all of it"],
        "mesh": words["the mesh"],
        "flanks": words["flanks that touch"],
        "left": words["left flanks"],
        "right": words["right flanks"],
        "both": words["both, backlash split"],
        "height": words["height of the section"],
        "nothing": words["This kind of design has no section."],
    }

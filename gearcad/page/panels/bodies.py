"""The solid bodies of a design, as the page shows them in mesh."""

from __future__ import annotations

from typing import Any

from gearcad.designs.design import Design
from gearcad.page.components.bodies import BodiesView
from gearcad.page.panels import Panel
from gearcad.page.panels.bodies_content import Bodies, bodies_of
from gearcad.page.panels.section_parts import plain
from gearcad.page.words import Words

__all__ = ["BodiesPanel"]


class BodiesPanel(Panel[Bodies]):
    """The gears in mesh, as solid bodies."""

    def __init__(self, words: Words) -> None:
        self._words, self._number = words, 0
        self._shown: Bodies | None = None
        self._view = BodiesView(words["the gears in mesh"], _own(words))

    def find(self, design: Design) -> Bodies:
        return bodies_of(design)

    def show(self, found: Bodies) -> None:
        if found == self._shown:
            return
        former = self._shown.surfaces if self._shown else {}
        self._number += 1
        self._shown = found
        bodies: list[dict[str, Any]] = [plain(body._asdict()) for body in found.bodies]
        surfaces = {key: content for key, content in found.surfaces.items() if key not in former}
        self._view.show(self._number, bodies, surfaces, float(found.error), self._words[found.why_not])


def _own(words: Words) -> dict[str, str]:
    """What the script of the view says."""
    return {
        "front": words["front"],
        "top": words["top"],
        "iso": words["oblique"],
        "fit": words["all of it"],
        "edges": words["edges"],
        "cut": words["cut across"],
        "whole": words["not cut"],
        "measure": words["measure"],
        "click": words["click at two points"],
        "facets": words["error of the facets"],
        "noWebGL": words["This browser has no WebGL: bodies cannot be drawn. All else works."],
        "lost": words["The graphics card gave up: bodies come back when it does."],
    }

"""Panels that show: section, solid bodies, roll angle, load shares, data sheet."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from gearcad.core.errors import GearcadError
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.page.components.elements import BodiesView, RollView, SectionView
from gearcad.page.panels import Panel
from gearcad.page.panels.drawn_data import Bodies, bodies_of, plain, section_of
from gearcad.page.panels.sheet_content import Figures, FiguresPanel, called, figures, keys_of, shown_notices
from gearcad.page.words import PageWords
from gearcad.sheet import sheet_of


class SectionPanel(Panel[dict[str, Any] | None]):
    """The mesh in its transverse section; the outlines of a design that is kept are dashed in it."""

    compares = True

    def __init__(self, words: PageWords) -> None:
        self._words, self._view = words, SectionView(words["transverse section"], _own(words))
        self._kept: dict[str, Any] | None = None

    def find(self, design: Design) -> dict[str, Any] | None:
        found = section_of(design)
        return None if found is None else section_in(self._words, plain(found))

    def show(self, found: dict[str, Any] | None) -> None:
        self._view.show(found, self._kept)

    def clear(self) -> None:
        self._view.clear_content()

    def keep(self, found: dict[str, Any] | None) -> None:
        self._kept = found


def section_in(words: PageWords, found: dict[str, Any]) -> dict[str, Any]:
    """A section whose gears are called in the words of the page."""
    return found | {"bodies": [body | {"name": called(words, body["name"])} for body in found["bodies"]]}


def _own(words: PageWords) -> dict[str, str]:
    """Return the words that the script of the section view uses."""
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


class BodiesPanel(Panel[Bodies]):
    """The gears in mesh, as solid bodies."""

    def __init__(self, words: PageWords) -> None:
        self._words, self._number = words, 0
        self._shown: Bodies | None = None
        self._view = BodiesView(words["the gears in mesh"], _bodies_own(words))

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
        self._view.show(self._number, bodies, surfaces, float(found.error), self._words.message(found.why_not))

    def clear(self) -> None:
        self.show(Bodies())

    def colour(self, kinds: Sequence[Mapping[str, Any]]) -> None:
        """Colour the teeth of the bodies that are shown by kinds of stress, or by none."""
        self._view.colour(kinds)


def _bodies_own(words: PageWords) -> dict[str, str]:
    """Return the words that the script of the bodies view uses."""
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


class RollPanel(Panel[float]):
    """Panel for the angle by which the first gear is turned."""

    def __init__(self, words: PageWords) -> None:
        self._view = RollView(_roll_own(words))
        self._shown = 0.0

    def find(self, design: Design) -> float:
        """The angular pitch of the first gear (rad); 0 where nothing turns."""
        found = section_of(design)
        return 0.0 if found is None else float(found["pitch"])

    def show(self, found: float) -> None:
        if found != self._shown:
            self._shown = found
            self._view.show(found)

    def clear(self) -> None:
        self.show(0.0)


def _roll_own(words: PageWords) -> dict[str, str]:
    """Return the words that the script of the roll slider uses."""
    return {
        "roll": words["roll angle"],
        "turn": words["let the gears turn (space)"],
        "stop": words["stop the gears (space)"],
        "speed": words["base pitches a second"],
    }


class SharesPanel(Panel[dict[str, Any] | None]):
    """Panel with a bar for each planet of a train: its least and its greatest load; empty for other designs."""

    def __init__(self, words: PageWords) -> None:
        from gearcad.page.components.elements import SharesView  # only here: who finds shares elsewhere needs no NiceGUI

        self._words, self._shown = words, False
        self._view = SharesView(
            {
                "title": words["load shares of the planets"],
                "planet": words["Planet"],
                "factor": words["mesh load factor"],
            }
        )

    def aside(self, design: Design) -> Callable[[Design], dict[str, Any] | None] | None:
        return shares_of if design.kind is DesignKind.PLANETARY else None

    def find(self, design: Design) -> dict[str, Any] | None:
        return shares_of(design)

    def wait(self) -> None:
        self._view.wait()

    def show(self, found: dict[str, Any] | None) -> None:
        if found is not None or self._shown:
            why_not = self._words.message((found or {}).get("why_not", ""))
            self._view.show(found and found | ({"why_not": why_not} if why_not else {}))
        self._shown = found is not None

    def clear(self) -> None:
        self.show(None)


def shares_of(design: Design) -> dict[str, Any] | None:
    """Shares of all planets, 1 where all carry alike, and K_gamma, or why there are none. None for what has no planets."""
    if design.kind is not DesignKind.PLANETARY:
        return None
    from gearcad.page.panels.drawn_data import train_study

    try:
        study = train_study(design)
    except GearcadError as error:
        return {"shares": [], "why_not": str(error)}
    if study.sharing is None:
        return {"shares": [], "why_not": study.why_not.get("sharing", "")}
    found = study.sharing.to_dict()
    shares = zip(found["least_shares"], found["shares"], found["greatest_shares"], strict=True)
    return {"shares": [[float(each) for each in three] for three in shares], "factor": float(found["mesh_load_factor"])}


_PINNED = {
    "gear": "teeth normal_module helix_angle profile_shift tip_diameter",
    "pair": "centre_distance working_transverse_pressure_angle transverse_contact_ratio overlap_ratio total_contact_ratio"
    " normal_backlash circumferential_backlash",
    "rack": "teeth normal_module helix_angle length",
    "planetary": "ratio centre_distance planets",
}
"""Figures that an engineer looks at first, at the top until the user chooses others."""

_PINS = [f"{table}.{key}" for table, keys in _PINNED.items() for key in keys.split()]

_FOLDED = ("Basic rack", "Shaper cutter", "Transverse section", "Line of action, from T1", "Body", "Material", "Rating")
"""Blocks that are shut at first: inputs, and what few look for."""


class SheetPanel(FiguresPanel):
    """Panel with the data sheet: every derived quantity in blocks."""

    def __init__(self, words: PageWords) -> None:
        super().__init__(words["data sheet"], "gearcad-sheet", words)

    def find(self, design: Design) -> Figures:
        return sheet_figures(design)


def sheet_figures(design: Design) -> Figures:
    """Return the figures of the data sheet of a design."""
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

"""Panel of the drawing: the sheets that `gearcad draw` makes, as they are for the present inputs."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.core.errors import GearcadError
from gearcad.designs.design import Design
from gearcad.page.panels import Panel
from gearcad.page.panels.sheet_content import called
from gearcad.page.words import PageWords

__all__ = ["DrawingPanel", "DrawnSheet", "drawn_sheets"]


class DrawnSheet(NamedTuple):
    """A sheet by the name of its file, with its title, its paper and scale, and the SVG that `gearcad draw` writes."""

    name: str
    title: str
    paper: str
    svg: str


class DrawnSheets(NamedTuple):
    """The sheets of a design, or the reason why there are none."""

    sheets: tuple[DrawnSheet, ...] = ()
    why_not: str = ""
    language: str = ""
    """Code of the language of the sheets."""


_NO_DRAWING = "This kind of design has no drawing."


def drawn_sheets(design: Design) -> DrawnSheets:
    """Return the sheets of a design as `gearcad draw` makes them."""
    from gearcad.jobs.draw import Draw, SheetFormat

    job = Draw(formats=(SheetFormat.SVG,))
    if design.kind not in job.accepts:
        return DrawnSheets(why_not=_NO_DRAWING)
    try:
        drawing = job.run(design)
        document = job.document(drawing)
        with tempfile.TemporaryDirectory() as folder:
            sheets = []
            for sheet in document["sheets"]:
                (name,) = (each for each in sheet["files"] if each.endswith(".svg"))
                path = Path(folder) / name
                job.files(drawing)[name](path)
                paper = f"{sheet['size']}, {sheet['scale']}"
                sheets.append(DrawnSheet(sheet["name"], sheet["title"], paper, path.read_text(encoding="utf-8")))
    except GearcadError as error:
        return DrawnSheets(why_not=str(error))
    return DrawnSheets(tuple(sheets), language=_language_of(design))


def _language_of(design: Design) -> str:
    """Return the code of the language in which the sheets of a design are drawn, whatever the language of the page is."""
    from gearcad.drawing.options import DrawingOptions

    options = getattr(design, "drawing", None)
    return (options if isinstance(options, DrawingOptions) else DrawingOptions()).language.value


class DrawingPanel(Panel[DrawnSheets]):
    """The sheets of the design, which follow it when the hand rests; calls `make` for the file with all of them, and `change`
    with the language that is chosen for them: a drawing has its own, which the page leaves as it is.
    """

    def __init__(self, words: PageWords, make: Callable[[], None], change: Callable[[Mapping[str, str]], None]) -> None:
        from gearcad.drawing.words import Language
        from gearcad.page.components.elements import DrawingView  # only here: other processes need no NiceGUI

        self._words, self._change, self._codes = words, change, {each.value for each in Language}
        names = {Language.ENGLISH: words["English"], Language.GERMAN: words["German"], Language.SWEDISH: words["Swedish"]}
        own: dict[str, Any] = {
            "title": words["Drawing"],
            "larger": words["larger"],
            "smaller": words["smaller"],
            "fit": words["all of it"],
            "pdf": words["drawing (PDF)"],
            "waiting": words["being computed"],
            "language": words["language of the sheets"],
            "languages": [(each.value, names[each]) for each in Language],
        }
        self._view = DrawingView(make, self._speak, own)

    def _speak(self, code: str) -> None:
        """Write the language of the sheets into the spec."""
        if code in self._codes:
            self._change({"drawing.language": code})

    def aside(self, design: Design) -> Callable[[Design], DrawnSheets]:
        return drawn_sheets

    def find(self, design: Design) -> DrawnSheets:
        return drawn_sheets(design)

    def wait(self) -> None:
        self._view.wait()

    def show(self, found: DrawnSheets) -> None:
        words = self._words
        names = {"assembly": words["Assembly"]}
        names |= {"pinion-shaft": words["Shaft of the pinion"], "wheel-shaft": words["Shaft of the wheel"]}
        sheets = [each._asdict() | {"name": names.get(each.name) or called(words, each.name)} for each in found.sheets]
        reasons = {_NO_DRAWING: words["This kind of design has no drawing."]}
        self._view.show(sheets, reasons.get(found.why_not) or words.message(found.why_not), found.language)

    def clear(self) -> None:
        self._view.show([], "", "")

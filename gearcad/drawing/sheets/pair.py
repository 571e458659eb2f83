"""The assembly sheet of a pair: section through both axes, both parts along them, centre distance, backlash, parts list."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gearcad.drawing.frame import Furniture, SheetTemplate
from gearcad.drawing.mass import mass_of_pair
from gearcad.drawing.options import DrawingOptions, PartDrawing
from gearcad.drawing.pair_views import PairPlaces, pair_face, pair_section
from gearcad.drawing.sheets.assembly import AssemblySheet
from gearcad.drawing.sheets.drawing import Sheet
from gearcad.drawing.sheets.items import pair_items
from gearcad.drawing.sheets.pair_rows import pair_rows
from gearcad.drawing.subject import DrawnPair
from gearcad.drawing.words import Words
from gearcad.geometry import GearPair, RackPair
from gearcad.notice import Notice

__all__ = ["draw_pair"]

NAME = "assembly"
"""Of the sheet, and of its files."""

_Z_TO_THE_LEFT = -1
"""The end that the other view shows is at the left of the section."""

_SAME_PITCH = 5e-4
"""Diameters (mm) that three decimals do not tell apart."""


def draw_pair(drawn: DrawnPair, options: DrawingOptions, parts: Mapping[str, PartDrawing] | None = None) -> Sheet:
    """The sheet of a pair; `parts` is what the parts' own sheets have, by their roles ("pinion", "wheel", "rack").

    Raises ParameterError where sheet or scale asked for have no room for it.
    """
    template = SheetTemplate.of(options.template)
    words = template.words(options.language)
    pair = drawn.pair
    rows, places = pair_rows(drawn, words), PairPlaces.of(pair)
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["assembly.data"],
        notes=tuple(_remarks(drawn, words)),
        parts=pair_items(drawn, options, parts or {}, words),
    )
    sheet = AssemblySheet(
        furniture=furniture,
        rows=rows,
        views=lambda draughting: (pair_section(pair, draughting, _Z_TO_THE_LEFT), pair_face(pair, draughting)),
        title=drawn.name,
        document_type=words["frame.document_assembly"],
        extent=max(places.front.width, places.front.height, places.extent.width),
        mass=mass_of_pair(drawn),
    )
    return sheet.drawn(NAME, tuple(_notices(pair)))


def _remarks(drawn: DrawnPair, words: Words) -> Iterator[str]:
    """What one must know of the views: pitch circles that are not the reference circles, a rim that nobody gave."""
    pair = drawn.pair
    if isinstance(pair, RackPair):
        if abs(pair.pitch_line_height) > _SAME_PITCH:
            height = words.number(pair.pitch_line_height, 3, signed=True)
            yield words["assembly.note_pitch_line"].format(height=height)
        return
    working = pair.working_pitch_diameters
    if abs(working.pinion - pair.pinion.reference_diameter) > _SAME_PITCH:
        sizes = (f"{item}: ⌀{words.number(abs(diameter), 3)}" for item, diameter in enumerate(working, 1))
        yield words["assembly.note_pitch"].format(diameters="; ".join(sizes))
    if pair.internal and pair.wheel.body.rim_diameter is None:
        yield words["assembly.note_rim"].format(item=2)


def _notices(pair: GearPair | RackPair) -> Iterator[Notice]:
    if isinstance(pair, RackPair):
        yield Notice(
            "no-limits", "the sheet has it without limits: racks have none here, say them in notes", where="mounting distance"
        )
    if isinstance(pair, GearPair) and pair.centre_distance_tolerance is None:
        text = 'the sheet has it without limits: none are given (centre_distance_tolerance in [pair], such as "js7")'
        yield Notice("no-limits", text, where="centre distance")
    if isinstance(pair, GearPair) and pair.internal and pair.wheel.body.rim_diameter is None:
        yield Notice("rim-assumed", "the outside that is drawn is assumed: body.rim_diameter is not given", where="wheel")

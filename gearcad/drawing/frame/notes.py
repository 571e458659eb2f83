"""Notes: what holds for all of a sheet, and what its user has to say. Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from gearcad.drawing.frame.fitting import fit, shortened_notice
from gearcad.drawing.frame.framed import Framed
from gearcad.drawing.frame.template import SheetTemplate
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.shapes import Pen
from gearcad.drawing.shapes.font import STRETCH
from gearcad.drawing.words import Words

__all__ = ["OUTER_EDGE", "common_notes", "notes"]

OUTER_EDGE, INNER_EDGE = -0.3, 0.2
"""Limits (mm) of edges that nothing else is said of (ISO 13715)."""

_MOST_LINES = 12
"""Of one note."""


def common_notes(options: DrawingOptions, template: SheetTemplate, words: Words) -> Iterator[str]:
    """General tolerances, unless the title block has them; edges, and the standards that sizes go by."""
    if options.general_tolerance and not any("general_tolerance" in cell.names for cell in template.cells.values()):
        yield f"{words['frame.general_tolerance']} {options.general_tolerance}"
    outer, inner = (words.number(limit, 1, signed=True) for limit in (OUTER_EDGE, INNER_EDGE))
    yield words["frame.note_edges"].format(outer=outer, inner=inner)
    yield words["frame.note_sizes"]


def notes(lines: Sequence[str], template: SheetTemplate, width: float | None = None) -> Framed:
    """Notes one below the other, long ones wrapped, the lower left corner at (0, 0). Empty without lines."""
    sizes = template.notes
    room = sizes.width if width is None else width
    found, bottom = Framed(), 0.0
    for number, line in reversed(list(enumerate(lines, 1))):
        fitted = fit(line, room, sizes.text, depth=sizes.text * 1.6 * _MOST_LINES, least=sizes.text, closest=STRETCH)
        figure = fitted.at((0.0, bottom), pen=Pen.FINE_TEXT)
        found += Framed(figure, shortened_notice(f"note {number}", line, fitted, "the sheet"))
        bottom += fitted.depth - fitted.height + sizes.pitch
    return found

"""What to know of the letters of a sheet: those that its PDF cannot show."""

from __future__ import annotations

from gearcad.drawing.files.lettering import unshowable
from gearcad.drawing.files.plain import one_line
from gearcad.drawing.shapes import Figure
from gearcad.notice import Notice

__all__ = ["unshown"]


def unshown(figure: Figure) -> tuple[Notice, ...]:
    """A notice for letters that the font of the sheets lacks."""
    found = unshowable(one_line(text.words) for text in figure.texts)
    if not found:
        return ()
    text = f"the PDF has a small box in place of letters that its font lacks, DXF and SVG leave them to others: {found}"
    return (Notice("letters-not-shown", text),)

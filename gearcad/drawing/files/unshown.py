"""What to know of the letters of a sheet: those that its PDF cannot show, or leaves to the fonts of who reads it."""

from __future__ import annotations

from gearcad.drawing.files.lettering import unshowable
from gearcad.drawing.files.plain import one_line
from gearcad.drawing.shapes import Figure
from gearcad.notice import Notice

__all__ = ["unshown"]


def unshown(figure: Figure) -> tuple[Notice, ...]:
    """A notice for letters of no font, one for those whose font is not in the PDF."""
    found = unshowable(one_line(text.words) for text in figure.texts)
    none = found.pop(None, "")
    notices = []
    if none:
        text = f"the PDF has a small box in place of letters that no font of ours has: {none}"
        notices.append(Notice("letters-not-shown", text))
    if found:
        text = f"the fonts of some letters are not in the PDF, the reader must have them: {''.join(found.values())}"
        notices.append(Notice("letters-of-other-fonts", text))
    return tuple(notices)

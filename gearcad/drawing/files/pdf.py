"""PDF of sheets, a page each: exactly the paper, its texts as text in the embedded font."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache, singledispatchmethod
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from gearcad.drawing.files.document import LANGUAGE, TITLE
from gearcad.drawing.files.items import Area, Stroked, items, line_widths, paper_size
from gearcad.drawing.files.lettering import set_letters
from gearcad.drawing.shapes import Pen, Text, Vertex
from gearcad.drawing.shapes.font import CAPITAL_HEIGHT, font_file
from gearcad.version import __version__

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from reportlab.pdfgen.canvas import Canvas
    from reportlab.pdfgen.pathobject import PDFPathObject

__all__ = ["write_pdf"]

_POINT = 25.4 / 72
"""In mm."""

_FONT = "DejaVuSans"

_ROUND, _BUTT = 1, 0

_MOST_OF_A_BEZIER = math.radians(45.0)
"""So one is within 5e-6 of the radius."""


def write_pdf(documents: Iterable[Drawing], path: Path) -> None:
    """Write documents as one PDF, whose title and language are those of the first. Equal input gives equal bytes."""
    from reportlab.pdfgen.canvas import Canvas

    sheets = list(documents)
    properties = sheets[0].header.custom_vars
    canvas = Canvas(str(path), invariant=True, pageCompression=1, lang=properties.get(LANGUAGE), initialFontName=_font())
    canvas.setTitle(properties.get(TITLE))
    canvas.setCreator(f"gearcad {__version__}")
    canvas.setAuthor("")
    canvas.setSubject("")
    for sheet in sheets:
        across, up = paper_size(sheet)
        canvas.setPageSize((across / _POINT, up / _POINT))
        canvas.bookmarkPage(title := sheet.header.custom_vars.get(TITLE))
        canvas.addOutlineEntry(title, title)
        page = _Page(canvas, line_widths(sheet))
        for item in items(sheet):
            page.show(item)
        canvas.showPage()
    canvas.save()


class _Page:
    """What is drawn on the page of a canvas, in mm."""

    def __init__(self, canvas: Canvas, widths: Mapping[Pen, float]) -> None:
        self._canvas = canvas
        self._widths = widths
        self._pen: Pen | None = None
        canvas.scale(1 / _POINT, 1 / _POINT)
        canvas.setLineJoin(_ROUND)

    @singledispatchmethod
    def show(self, item: object) -> None:
        raise NotImplementedError(type(item))

    @show.register
    def _(self, line: Stroked) -> None:
        self._take(line)
        path = self._canvas.beginPath()
        path.moveTo(*line.vertices[0][:2])
        row = [*line.vertices, line.vertices[0]] if line.closed else line.vertices
        for start, end in pairwise(row):
            _draw_to(path, start, end)
        if line.closed:
            path.close()
        self._canvas.drawPath(path)

    def _take(self, line: Stroked) -> None:
        """Change to the pen of a line."""
        if line.pen is not self._pen:
            self._pen = line.pen
            self._canvas.setLineWidth(self._widths[line.pen])
            self._canvas.setLineCap(_BUTT if line.pen.stroke.dashes else _ROUND)
            self._canvas.setDash()
        if line.pen.stroke.dashes:
            self._canvas.setDash(list(line.dashes))

    @show.register
    def _(self, area: Area) -> None:
        path = self._canvas.beginPath()
        path.moveTo(*area.points[0])
        for point in area.points[1:]:
            path.lineTo(*point)
        path.close()
        self._canvas.drawPath(path, stroke=0, fill=1)

    @show.register
    def _(self, text: Text) -> None:
        if not text.words.strip():
            return
        size, words = text.height / CAPITAL_HEIGHT, set_letters(text.words)
        cosine, sine = math.cos(math.radians(text.rotation)), math.sin(math.radians(text.rotation))
        letters = self._canvas.beginText()
        letters.setTextTransform(cosine, sine, -sine, cosine, *text.start)
        # Joined letters are not as wide as those that the length was found for.
        letters.setHorizScale(100 * text.width / _width(words, size))
        letters.setFont(_font(), size)
        letters.textOut(words)
        self._canvas.drawText(letters)


def _width(words: str, size: float) -> float:
    from reportlab.pdfbase.pdfmetrics import stringWidth

    return float(stringWidth(words, _font(), size))


def _draw_to(path: PDFPathObject, start: Vertex, end: Vertex) -> None:
    """A line, or an arc by Bezier curves."""
    if not start[2]:
        path.lineTo(*end[:2])
        return
    turn = 4 * math.atan(start[2])
    across, up = end[0] - start[0], end[1] - start[1]
    towards = 1 / (2 * math.tan(turn / 2))  # of the chord, from its middle to the left
    x, y = (start[0] + end[0]) / 2 - towards * up, (start[1] + end[1]) / 2 + towards * across
    count = math.ceil(abs(turn) / _MOST_OF_A_BEZIER - 1e-9)
    step = turn / count
    handle = 4 / 3 * math.tan(step / 4)
    cosine, sine = math.cos(step), math.sin(step)
    u, v = start[0] - x, start[1] - y
    for _ in range(count):
        p, q = u * cosine - v * sine, u * sine + v * cosine
        path.curveTo(x + u - handle * v, y + v + handle * u, x + p + handle * q, y + q - handle * p, x + p, y + q)
        u, v = p, q


@cache
def _font() -> str:
    """The name of the font of the sheets, once the library knows it."""
    from reportlab.pdfbase.pdfmetrics import registerFont
    from reportlab.pdfbase.ttfonts import TTFont

    registerFont(TTFont(_FONT, str(font_file())))
    return _FONT

"""SVG of a sheet: in mm, its texts as text of the length that they have in the document."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from functools import singledispatchmethod
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

from gearcad.drawing.files.document import LANGUAGE, TITLE
from gearcad.drawing.files.items import Area, Stroked, items, line_widths, paper_size
from gearcad.drawing.shapes import Pen, Text, Vertex
from gearcad.drawing.shapes.font import CAPITAL_HEIGHT

if TYPE_CHECKING:
    from ezdxf.document import Drawing

__all__ = ["write_svg"]

_DECIMALS = 3


def write_svg(document: Drawing, path: Path) -> None:
    """Write a document as SVG; each of its layers is a group."""
    path.write_text("\n".join(_lines(document)) + "\n", encoding="utf-8")


def _lines(document: Drawing) -> Iterator[str]:
    across, up = paper_size(document)
    page, properties, widths = _Page(up), document.header.custom_vars, line_widths(document)
    groups: dict[Pen, list[str]] = {pen: [] for pen in Pen}
    for item in items(document):
        groups[item.pen] += page.shown(item)
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    size = f'width="{_number(across)}mm" height="{_number(up)}mm" viewBox="0 0 {_number(across)} {_number(up)}"'
    yield f'<svg xmlns="http://www.w3.org/2000/svg" {size} xml:lang={quoteattr(properties.get(LANGUAGE))}>'
    yield f"<title>{escape(properties.get(TITLE))}</title>"
    yield f'<rect width="{_number(across)}" height="{_number(up)}" fill="#fff"/>'
    yield '<g fill="none" stroke="#000" stroke-linejoin="round" font-family="\'DejaVu Sans\',Verdana,sans-serif">'
    for pen, elements in groups.items():
        if elements:
            cap = "butt" if pen.stroke.dashes else "round"
            yield f'<g id="{pen.value}" stroke-width="{_number(widths[pen])}" stroke-linecap="{cap}">'
            yield from elements
            yield "</g>"
    yield "</g>"
    yield "</svg>"


class _Page:
    """Elements of what is on paper of this height: there y is upwards, here down."""

    def __init__(self, height: float) -> None:
        self._height = height

    @singledispatchmethod
    def shown(self, item: object) -> list[str]:
        raise NotImplementedError(type(item))

    @shown.register
    def _(self, line: Stroked) -> list[str]:
        dashes = f' stroke-dasharray="{" ".join(map(_number, line.dashes))}"' if line.dashes else ""
        return [f'<path d="{self._course(line)}"{dashes}/>']

    @shown.register
    def _(self, area: Area) -> list[str]:
        corners = " ".join(self._place(*point) for point in area.points)
        return [f'<polygon points="{corners}" fill="#000" stroke="none"/>']

    @shown.register
    def _(self, text: Text) -> list[str]:
        if not text.words.strip():
            return []
        cosine, sine = math.cos(math.radians(text.rotation)), math.sin(math.radians(text.rotation))
        x, y = text.start
        turn = (text.stretch * cosine, -text.stretch * sine, sine, cosine, x, self._height - y)
        place = f'transform="matrix({" ".join(map(_number, turn))})"'
        size = f'font-size="{_number(text.height / CAPITAL_HEIGHT)}"'
        length = f'textLength="{_number(text.width / text.stretch)}" lengthAdjust="spacingAndGlyphs"'
        return [f'<text {place} {size} {length} fill="#000" stroke="none" xml:space="preserve">{escape(text.words)}</text>']

    def _course(self, line: Stroked) -> str:
        row = [*line.vertices, line.vertices[0]] if line.closed else line.vertices
        steps = [self._step(start, end) for start, end in itertools.pairwise(row)]
        return f"M{self._place(*row[0][:2])}{''.join(steps)}{'Z' if line.closed else ''}"

    def _step(self, start: Vertex, end: Vertex) -> str:
        bulge, place = start[2], self._place(*end[:2])
        if not bulge:
            return f"L{place}"
        radius = _number(math.dist(start[:2], end[:2]) * (1 + bulge**2) / (4 * abs(bulge)))
        return f"A{radius} {radius} 0 {int(abs(bulge) > 1)} {int(bulge < 0)} {place}"

    def _place(self, x: float, y: float) -> str:
        return f"{_number(x)} {_number(self._height - y)}"


def _number(value: float) -> str:
    """Without zeros at its end."""
    return f"{value:.{_DECIMALS}f}".rstrip("0").rstrip(".") if value else "0"

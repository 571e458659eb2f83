"""SVG and PDF of sheets, drawn from their DXF documents. Lengths in mm of paper."""

from __future__ import annotations

import itertools
import math
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, singledispatchmethod
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

from gearcad.core.records import Notice
from gearcad.drawing.dxf_export import LANGUAGE, TITLE, as_read, one_line
from gearcad.drawing.shapes import CAPITAL_HEIGHT, Anchor, Figure, Pen, Point, Polyline, Text, Vertex, font_file, has_glyph
from gearcad.version import __version__

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities import DXFEntity
    from reportlab.pdfgen.canvas import Canvas
    from reportlab.pdfgen.pathobject import PDFPathObject


_SHORTEST = 1e-6


def hatch_lines(edges: Iterable[Iterable[Vertex]], angle: float, spacing: float) -> Iterator[tuple[Point, Point]]:
    """Yield hatch lines inside an odd number of closed edges, as start and end (mm), at an angle (degrees).

    One of the lines would pass through the origin if it were long enough. A line through a corner counts as inside one of its
    two sides only, so none is lost or goes astray there.
    """
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    turned = [
        [(x * cosine + y * sine, (y * cosine - x * sine) / spacing) for x, y in Polyline(tuple(edge), closed=True).points]
        for edge in edges
    ]
    sides = [side for row in turned for side in pairwise(row)]
    crossings: dict[int, list[float]] = {}
    for (x, low), (far, high) in sides:
        for number in range(math.ceil(min(low, high)), math.ceil(max(low, high))):
            crossings.setdefault(number, []).append(x + (far - x) * (number - low) / (high - low))
    for number in sorted(crossings):
        row, up = sorted(crossings[number]), number * spacing
        for start, end in zip(row[::2], row[1::2], strict=True):
            if end - start > _SHORTEST:
                yield _rotated(start, up, cosine, sine), _rotated(end, up, cosine, sine)


def _rotated(along: float, up: float, cosine: float, sine: float) -> Point:
    return along * cosine - up * sine, along * sine + up * cosine


@dataclass(frozen=True)
class Stroked:
    """Lines and arcs in a row, by vertices with bulges."""

    vertices: tuple[Vertex, ...]
    closed: bool
    pen: Pen

    @property
    def dashes(self) -> tuple[float, ...]:
        """Lengths of dashes and gaps (mm), stretched so that the line begins and ends with a whole dash; empty if too short
        for two.
        """
        pattern = self.pen.stroke.dashes
        if not pattern:
            return ()
        row = [*self.vertices, self.vertices[0]] if self.closed else self.vertices
        length = sum(_length(*each) for each in pairwise(row))
        last = 0.0 if self.closed else pattern[0]
        times = round((length - last) / sum(pattern))
        return tuple(length / (times * sum(pattern) + last) * each for each in pattern) if times > 0 else ()


@dataclass(frozen=True)
class Area:
    """A filled polygon."""

    points: tuple[Point, ...]
    pen: Pen


Item = Stroked | Area | Text


def items(document: Drawing) -> Iterator[Item]:
    """Return all items that a document shows, in its order."""
    return _all_items(document.modelspace(), document)


def line_widths(document: Drawing) -> dict[Pen, float]:
    """Return the width (mm) of each pen's lines on this sheet."""
    return {pen: document.layers.get(pen.value).dxf.lineweight / 100 for pen in Pen}


def paper_size(document: Drawing) -> tuple[float, float]:
    """Return width and height of the sheet (mm)."""
    across, up = document.header["$LIMMAX"]
    return across, up


def _all_items(entities: object, document: Drawing) -> Iterator[Item]:
    for entity in entities:  # type: ignore[attr-defined] # a layout: type checkers do not see the library
        yield from _entity_items(entity, document)


def _entity_items(entity: DXFEntity, document: Drawing) -> Iterator[Item]:
    kind, dxf = entity.dxftype(), entity.dxf
    if kind == "DIMENSION":
        yield from _all_items(document.blocks.get(dxf.geometry), document)
        return
    pen = Pen(dxf.layer)
    match kind:
        case "LINE":
            yield Stroked(((*dxf.start.vec2, 0.0), (*dxf.end.vec2, 0.0)), False, pen)
        case "LWPOLYLINE":
            yield Stroked(tuple(entity.get_points("xyb")), entity.closed, pen)
        case "CIRCLE":
            (x, y), radius = dxf.center.vec2, dxf.radius
            yield Stroked(((x + radius, y, 1.0), (x - radius, y, 1.0)), True, pen)
        case "ARC":
            yield Stroked(_arc(dxf.center.vec2, dxf.radius, dxf.start_angle, dxf.end_angle), False, pen)
        case "SOLID":
            yield Area(tuple((point.x, point.y) for point in entity.vertices()), pen)
        case "TEXT":
            yield _text(entity, pen)
        case "HATCH":
            edges = [path.vertices for path in entity.paths]
            pattern = entity.pattern.lines[0]
            for start, end in hatch_lines(edges, pattern.angle, pattern.offset.magnitude):
                yield Stroked(((*start, 0.0), (*end, 0.0)), False, pen)
        case _:  # nothing else is put in by `draw`
            raise NotImplementedError(kind)


def _text(entity: DXFEntity, pen: Pen) -> Text:
    alignment, place, _ = entity.get_placement()
    dxf = entity.dxf
    return Text(as_read(dxf.text), (place.x, place.y), dxf.height, Anchor(alignment.name), dxf.rotation, pen, dxf.width)


def _arc(centre: Point, radius: float, start: float, end: float) -> tuple[Vertex, ...]:
    """Return an arc (degrees, counter-clockwise) as two halves."""
    turn = (end - start) % 360.0
    bulge = math.tan(math.radians(turn) / 8)
    angles = (math.radians(start + part * turn) for part in (0.0, 0.5, 1.0))
    (x, y), bulges = centre, (bulge, bulge, 0.0)
    return tuple((x + radius * math.cos(a), y + radius * math.sin(a), b) for a, b in zip(angles, bulges, strict=True))


def _length(start: Vertex, end: Vertex) -> float:
    chord, turn = math.dist(start[:2], end[:2]), 4 * math.atan(start[2])
    return chord if not turn else chord * abs(turn / 2 / math.sin(turn / 2))


_DECIMALS = 3


def write_svg(document: Drawing, path: Path) -> None:
    """Write a document as SVG; each of its layers is a group."""
    path.write_text("\n".join(_lines(document)) + "\n", encoding="utf-8", newline="\n")


def _lines(document: Drawing) -> Iterator[str]:
    across, up = paper_size(document)
    page, properties, widths = _SvgPage(up), document.header.custom_vars, line_widths(document)
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


class _SvgPage:
    """SVG elements of a page of this height (mm): y is upwards on the sheet, downwards in SVG."""

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
    """Return a number as a text without zeros at its end."""
    return f"{value:.{_DECIMALS}f}".rstrip("0").rstrip(".") if value else "0"


_MISSING = "□"

_RIGHT_TO_LEFT = ("R", "AL")
_DIGITS = ("EN", "AN")


def set_letters(words: str) -> str:
    """Return a text with its letters in visual order, from left to right. A small box replaces letters that the font of the
    sheets lacks.

    Fonts of other scripts are not named in the PDF instead: without them, readers and printers leave the letters out.

    >>> set_letters("Rad 齿轮 1")
    'Rad □□ 1'
    """
    return "".join(letter if has_glyph(letter) else _MISSING for letter in _visual_order(words))


def unshowable(words: Iterable[str]) -> str:
    """Return the letters of texts that the font of the sheets lacks, each once."""
    return "".join(sorted({letter for text in words for letter in text if not has_glyph(letter)}))


def _visual_order(words: str) -> str:
    """Return a text as seen from left to right: right-to-left parts reversed, except their numbers, and Arabic letters joined.

    A simple case of the Unicode bidirectional algorithm (UAX 9): one level, in a line that runs from left to right.
    """
    kinds = [unicodedata.bidirectional(letter) for letter in words]
    at = [place for place, kind in enumerate(kinds) if kind in _RIGHT_TO_LEFT]
    if not at:
        return words
    # Words that run to the right part what runs to the left: "אב cd אב".
    spans, start = [], at[0]
    for before, after in pairwise(at):
        if "L" in kinds[before:after]:
            spans.append((start, before + 1))
            start = after
    spans.append((start, at[-1] + 1))
    found, end = "", 0
    for low, high in spans:
        while high < len(words) and kinds[high] == "NSM":
            high += 1
        found += words[end:low] + _right_to_left(_joined(words[low:high]))
        end = high
    return found + words[end:]


def _right_to_left(words: str) -> str:
    """Return a right-to-left text reversed: marks stay behind their letters, numbers keep their order, and brackets are
    mirrored.
    """
    parts: list[str] = []
    for letter in words:
        kind = unicodedata.bidirectional(letter)
        if parts and (kind == "NSM" or (kind in _DIGITS and unicodedata.bidirectional(parts[-1][-1]) in _DIGITS)):
            parts[-1] += letter
        else:
            parts.append(_BRACKETS.get(letter, letter))
    return "".join(reversed(parts))


_BRACKETS = dict(zip("()[]{}<>", ")(][}{><", strict=True))


def _joined(words: str) -> str:
    """Return Arabic letters in the forms that they have between their neighbours."""
    forms = [_forms().get(letter, {}) for letter in words]
    found = ""
    for place, letter in enumerate(words):
        before = place > 0 and "initial" in forms[place - 1] and "final" in forms[place]
        after = place + 1 < len(words) and "initial" in forms[place] and "final" in forms[place + 1]
        name = ("isolated", "initial", "final", "medial")[2 * before + after]
        found += forms[place].get(name, letter)
    return found


@cache
def _forms() -> dict[str, dict[str, str]]:
    """Return the forms of each letter, as Unicode has them for programs that do not join letters."""
    found: dict[str, dict[str, str]] = {}
    for code in (*range(0xFB50, 0xFC00), *range(0xFE80, 0xFEF5)):
        name, _, origin = unicodedata.decomposition(chr(code)).partition("> ")
        if len(origin) == 4:
            found.setdefault(chr(int(origin, 16)), {})[name[1:]] = chr(code)
    return found


def unshown(figure: Figure) -> tuple[Notice, ...]:
    """Return a notice of letters that the font of the sheets lacks; empty without such letters."""
    found = unshowable(one_line(text.words) for text in figure.texts)
    if not found:
        return ()
    text = f"the PDF has a small box in place of letters that its font lacks, DXF and SVG leave them to others: {found}"
    return (Notice("letters-not-shown", text),)


_POINT = 25.4 / 72
"""Typographic point (mm)."""

_FONT = "DejaVuSans"

_ROUND, _BUTT = 1, 0

_MOST_OF_A_BEZIER = math.radians(45.0)
"""Largest angle (radians) of one Bezier curve: it is then within 5e-6 of the radius."""


def write_pdf(documents: Iterable[Drawing], path: Path) -> None:
    """Write documents as one PDF with the title and language of the first. Equal input gives equal bytes."""
    from reportlab.pdfgen.canvas import Canvas

    sheets = list(documents)
    properties = sheets[0].header.custom_vars
    canvas = Canvas(str(path), invariant=True, pageCompression=1, lang=properties.get(LANGUAGE), initialFontName=pdf_font())
    canvas.setTitle(properties.get(TITLE))
    canvas.setCreator(f"gearcad {__version__}")
    canvas.setAuthor("")
    canvas.setSubject("")
    for sheet in sheets:
        across, up = paper_size(sheet)
        canvas.setPageSize((across / _POINT, up / _POINT))
        canvas.bookmarkPage(title := sheet.header.custom_vars.get(TITLE))
        canvas.addOutlineEntry(title, title)
        page = _PdfPage(canvas, line_widths(sheet))
        for item in items(sheet):
            page.show(item)
        canvas.showPage()
    canvas.save()


class _PdfPage:
    """A page of a PDF canvas, on which items are drawn in mm."""

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
        letters.setFont(pdf_font(), size)
        letters.textOut(words)
        self._canvas.drawText(letters)


def _width(words: str, size: float) -> float:
    from reportlab.pdfbase.pdfmetrics import stringWidth

    return float(stringWidth(words, pdf_font(), size))


def _draw_to(path: PDFPathObject, start: Vertex, end: Vertex) -> None:
    """Draw a line, or an arc by Bezier curves."""
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
@cache
def pdf_font() -> str:
    """Return the name of the font of the sheets, registered with the library."""
    from reportlab.pdfbase.pdfmetrics import registerFont
    from reportlab.pdfbase.ttfonts import TTFont

    registerFont(TTFont(_FONT, str(font_file())))
    return _FONT

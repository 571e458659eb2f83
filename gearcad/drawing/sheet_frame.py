"""Frame of a sheet: border (ISO 5457), title block (ISO 7200), notes, and the places of the tables. Lengths in mm of paper."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from gearcad.core.records import Notice
from gearcad.drawing.drawing_symbols import projection_symbol
from gearcad.drawing.options import DrawingOptions, Projection, SheetSize
from gearcad.drawing.shapes import STRETCH, Anchor, Box, Figure, Line, Pen, Point, Polyline, Shape, Text
from gearcad.drawing.sheet_tables import (
    Framed,
    PartLine,
    TableRow,
    data_table,
    fit,
    outlined,
    parts_list,
    revisions,
    shortened_notice,
)
from gearcad.drawing.sheet_template import CAPTION_TOP, DataTableSizes, FrameSizes, SheetTemplate, TitleCell
from gearcad.drawing.words import SheetWords

_AIR = 6.0
"""Least distance of views from the frame, where centring marks reach."""

_LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
"""Letters of fields, without I and O, which look like numbers."""

_LEAST_FIELD = 15.0
"""A shorter rest at the corners is added to the field beside it."""


def inside_frame(size: SheetSize, sizes: FrameSizes) -> Box:
    """Return the box that the frame encloses (mm); the paper's lower left corner is (0, 0)."""
    width, height = size.size
    return Box(sizes.binding_margin, sizes.margin, width - sizes.margin, height - sizes.margin)


def free_area(size: SheetSize, sizes: FrameSizes) -> Box:
    """Return the box where views may stand (mm): inside the frame and clear of its centring marks. On A4 it reaches as far as
    these.
    """
    return inside_frame(size, sizes).grown(-sizes.centring if size is SheetSize.A4 else -_AIR)


def border(size: SheetSize, sizes: FrameSizes, taken: Iterable[Box] = ()) -> Figure:
    """Return the border: edge of the paper, frame, centring marks, and fields with letters down the sides and numbers along
    top and bottom.

    Marks do not reach into areas that are `taken`. A4 has its fields at the top and at the right only.
    """
    paper, frame = Box(0.0, 0.0, *size.size), inside_frame(size, sizes)
    strip = frame.grown(sizes.grid_width)
    shapes: list[Shape] = [_rectangle(paper, Pen.TABLE), _rectangle(frame, Pen.FRAME)]
    shapes += _centring(paper, frame, strip, sizes.centring, tuple(taken))
    if sizes.grid_width:
        shapes.append(_rectangle(strip, Pen.GRID))
        shapes += _fields(paper, frame, strip, sizes, every_side=size is not SheetSize.A4)
    return Figure(tuple(shapes))


def _rectangle(box: Box, pen: Pen) -> Polyline:
    corners = [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)]
    return Polyline.straight(corners, pen, closed=True)


def _centring(paper: Box, frame: Box, strip: Box, into: float, taken: tuple[Box, ...]) -> Iterator[Line]:
    """Yield the centring marks, from the outer edge of the strip over the frame, and into it where nothing stands."""
    across, up = paper.middle
    ends: tuple[tuple[Point, Point, Point], ...] = (
        ((across, strip.bottom), (across, frame.bottom), (across, frame.bottom + into)),
        ((across, strip.top), (across, frame.top), (across, frame.top - into)),
        ((strip.left, up), (frame.left, up), (frame.left + into, up)),
        ((strip.right, up), (frame.right, up), (frame.right - into, up)),
    )
    for outer, edge, inner in ends:
        free = not any(Box.around((edge, inner)).grown(0.1).meets(each) for each in taken)
        yield Line(outer, inner if free else edge, Pen.FRAME)


def _fields(paper: Box, frame: Box, strip: Box, sizes: FrameSizes, *, every_side: bool) -> Iterator[Shape]:
    """Yield the lines between fields and the names of fields, on two opposite sides each. The middle of the sheet is between
    fields.
    """
    middle = paper.middle
    for along in (0, 1):
        places = _divisions(frame[along], frame[along + 2], middle[along], sizes.grid_pitch)
        other = 1 - along
        names = _names(len(places) - 1, letters=along == 1)
        for near, far in ((frame[other], strip[other]), (frame[other + 2], strip[other + 2])):
            if not every_side and near == frame[other]:
                continue
            for place in places[1:-1]:
                if abs(place - middle[along]) > sizes.grid_pitch / 2:
                    yield Line(_point(along, place, near), _point(along, place, far), Pen.GRID)
            for name, (low, high) in zip(names, pairwise(places), strict=True):
                at = _point(along, (low + high) / 2, (near + far) / 2)
                yield Text(name, at, sizes.grid_text, Anchor.MIDDLE, pen=Pen.FINE_TEXT)


def _point(along: int, place: float, across: float) -> Point:
    return (place, across) if along == 0 else (across, place)


def _divisions(low: float, high: float, middle: float, pitch: float) -> list[float]:
    """Return the ends of fields (mm) of one pitch from the middle on; those at the corners have the rest."""
    below, above = int((middle - low) / pitch), int((high - middle) / pitch)
    inner = [middle + step * pitch for step in range(-below, above + 1)]
    if inner[0] - low < _LEAST_FIELD and len(inner) > 1:
        inner = inner[1:]
    if high - inner[-1] < _LEAST_FIELD and len(inner) > 1:
        inner = inner[:-1]
    return [low, *inner, high]


def _names(count: int, *, letters: bool) -> list[str]:
    """Return the names of fields from left to right, or from the bottom up. Letters begin at the top, with AA behind Z."""
    if not letters:
        return [str(number + 1) for number in range(count)]
    full = len(_LETTERS)
    return [_LETTERS[number % full] * (1 + number // full) for number in reversed(range(count))]


_CLEAR = 0.3
"""Distance between the ink of a value and the lines and the caption of its cell."""

_MARGIN = 1.2
"""Distance from the side of a cell to its text."""

_CAPTION_LEAST = 1.8

_OWNER = "the title block"


def title_values(
    options: DrawingOptions,
    words: SheetWords,
    *,
    title: str,
    document_type: str,
    size: SheetSize,
    scale: str,
    sheet: int = 1,
    sheets: int = 1,
    material: str = "",
    heat_treatment: str = "",
    mass: float | None = None,
) -> dict[str, str]:
    """Return the texts of the title block's cells by the names of `VALUES`. `title`, `material` ... apply where `options` have
    none; mass in kg.
    """
    return {
        "number": options.number,
        "title": options.title or title,
        "supplementary_title": options.supplementary_title,
        "owner": options.owner,
        "department": options.department,
        "technical_reference": options.technical_reference,
        "creator": options.creator,
        "approver": options.approver,
        "document_type": options.document_type or document_type,
        "status": options.status,
        "classification": options.classification,
        "revision": options.index,
        "date": options.issued,
        "language": options.language.value,
        "scale": scale,
        "size": size.value,
        "sheet": str(sheet),
        "sheets": str(sheets),
        "general_tolerance": options.general_tolerance,
        "material": options.material or material,
        "heat_treatment": options.heat_treatment or heat_treatment,
        "mass": "" if mass is None else _mass(mass, words),
    }


def _mass(mass: float, words: SheetWords) -> str:
    """Return a mass (kg) as a text with three digits, in kg, or in g below 0.1 kg."""
    value, unit = (mass, "kg") if mass >= 0.1 else (mass * 1e3, "g")
    digits = f"{value:.3g}"
    decimals = len(digits.partition(".")[2]) if "e" not in digits else 0
    return f"{words.number(float(digits), decimals)} {unit}"


def title_block(values: Mapping[str, str], template: SheetTemplate, words: SheetWords, projection: Projection) -> Framed:
    """Return the title block, its lower right corner at (0, 0)."""
    sizes = template.title
    whole = Box(0.0, 0.0, sizes.width, sizes.height)
    found = Framed(Figure((outlined(whole), *_lines([cell.box for cell in template.cells.values()], whole))))
    for name, cell in template.cells.items():
        found += _cell(name, cell, values, words, sizes.caption, projection)
    return found.moved(-sizes.width, 0.0)


def _lines(boxes: Sequence[Box], whole: Box) -> Iterator[Line]:
    """Yield the lines between cells, each drawn once over its whole length; none on the outline of the whole."""
    upright, level = defaultdict[float, list[tuple[float, float]]](list), defaultdict[float, list[tuple[float, float]]](list)
    for box in boxes:
        for across in {box.left, box.right} - {whole.left, whole.right}:
            upright[across].append((box.bottom, box.top))
        for up in {box.bottom, box.top} - {whole.bottom, whole.top}:
            level[up].append((box.left, box.right))
    for across, spans in upright.items():
        yield from (Line((across, low), (across, high), Pen.TABLE) for low, high in _joined(spans))
    for up, spans in level.items():
        yield from (Line((low, up), (high, up), Pen.TABLE) for low, high in _joined(spans))


def _joined(spans: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the spans with those that touch or overlap as one."""
    found: list[tuple[float, float]] = []
    for low, high in sorted(spans):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(high, found[-1][1]))
        else:
            found.append((low, high))
    return found


def _cell(
    name: str, cell: TitleCell, values: Mapping[str, str], words: SheetWords, caption_height: float, projection: Projection
) -> Framed:
    """Return the caption and the value, or the symbol, of a cell."""
    box, room = cell.box, cell.width - 2 * _MARGIN
    found = Framed()
    if text := _caption(name, cell, words):
        caption = fit(text, room, caption_height, least=min(_CAPTION_LEAST, caption_height))
        place = (box.left + _MARGIN, box.top - CAPTION_TOP - caption.height)
        notices = shortened_notice(f"{name}.caption", text, caption, _OWNER)
        found += Framed(caption.at(place, pen=Pen.FINE_TEXT), notices)
    if cell.symbol:
        return found + Framed(_symbol(projection, Box(box.left, box.bottom, box.right, cell.value_top(caption_height))))
    if value := cell.filled(values):
        bottom = cell.value_bottom
        depth = cell.value_top(caption_height) - bottom
        fitted = fit(value, room, min(cell.text, depth), depth=depth)
        figure = fitted.at((box.left + _MARGIN, bottom + max(0.0, depth - fitted.depth) / 2))
        ceiling = found.figure.box.bottom if text else box.top
        figure = _between(figure, box.bottom + _CLEAR, ceiling - _CLEAR)
        found += Framed(figure, shortened_notice(name, value, fitted, _OWNER))
    return found


def _between(figure: Figure, floor: float, ceiling: float) -> Figure:
    """Return a text moved down, and made smaller if necessary, so that marks above its letters (Kuggstång) meet nothing
    above.
    """
    box = figure.box
    if box.height > ceiling - floor:
        share = (ceiling - floor) / box.height
        texts = (replace(each, height=each.height * share) for each in figure.texts)
        figure = Figure(tuple(each.moved(0.0, (share - 1) * (each.at[1] - floor)) for each in texts))
        box = figure.box
    return figure.moved(0.0, min(0.0, ceiling - box.top) + max(0.0, floor - box.bottom))


def _caption(name: str, cell: TitleCell, words: SheetWords) -> str:
    """Return the caption of a cell: the word of [frame] that the cell names, or its own text."""
    asked = name if cell.caption is None else cell.caption
    return words.labels.get(f"frame.{asked}", "" if cell.caption is None else asked)


def _symbol(projection: Projection, box: Box) -> Figure:
    """Return the symbol of the method of projection in the middle of a box."""
    height = min(5.0, 0.8 * box.height)
    symbol = projection_symbol(projection, height=height)
    across, up = symbol.box.middle
    return symbol.moved(box.middle[0] - across, box.middle[1] - up)


OUTER_EDGE, INNER_EDGE = -0.3, 0.2
"""Limits (mm) of edges without an indication of their own (ISO 13715)."""

_MOST_LINES = 12
"""Largest number of lines of one note."""


def common_notes(options: DrawingOptions, template: SheetTemplate, words: SheetWords) -> Iterator[str]:
    """Yield the notes on general tolerances (unless the title block has them), on edges, and on the standards for sizes."""
    if options.general_tolerance and not any("general_tolerance" in cell.names for cell in template.cells.values()):
        yield f"{words['frame.general_tolerance']} {options.general_tolerance}"
    outer, inner = (words.number(limit, 1, signed=True) for limit in (OUTER_EDGE, INNER_EDGE))
    yield words["frame.note_edges"].format(outer=outer, inner=inner)
    yield words["frame.note_sizes"]


def notes(lines: Sequence[str], template: SheetTemplate, width: float | None = None) -> Framed:
    """Return notes one below the other, long ones wrapped, the lower left corner at (0, 0). Empty without lines."""
    sizes = template.notes
    room = sizes.width if width is None else width
    found, bottom = Framed(), 0.0
    for number, line in reversed(list(enumerate(lines, 1))):
        fitted = fit(line, room, sizes.text, depth=sizes.text * 1.6 * _MOST_LINES, least=sizes.text, closest=STRETCH)
        figure = fitted.at((0.0, bottom), pen=Pen.FINE_TEXT)
        found += Framed(figure, shortened_notice(f"note {number}", line, fitted, "the sheet"))
        bottom += fitted.depth - fitted.height + sizes.pitch
    return found


_GAP = 4.0
"""Distance between tables, and from the frame to the notes."""

_MANY = 12
"""Largest number of rows of a table that is never drawn in two narrowed columns."""

_ONCE = ("material", "heat_treatment")
"""Keys of rows that title blocks may also have."""

_LEAST_NOTES = 60.0
"""Width of the narrowest notes beside the title block; on narrower sheets they stand above it."""


@dataclass(frozen=True)
class Furnished:
    """A sheet without its views: these may stand in the box `free`, except in the boxes that are `taken`."""

    figure: Figure = field(repr=False)
    free: Box
    taken: tuple[Box, ...]
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Furniture:
    """The content of a sheet beside its views, independent of the size of the sheet.

    `notes` come before those of the options; the common ones (edges, standards) before both. `table_title` and `rows` are the
    gear data table.
    """

    options: DrawingOptions
    template: SheetTemplate
    words: SheetWords
    rows: Sequence[TableRow] = ()
    table_title: str = ""
    notes: Sequence[str] = ()
    parts: Sequence[PartLine] = ()

    def on(self, size: SheetSize, values: Mapping[str, str]) -> Furnished:
        """Return the furniture on a sheet, the paper's lower left corner at (0, 0); `values` are those of `title_values`.

        The table gets lower rows or several columns if it has no room above the title block. It leaves out material and heat
        treatment if the title block has them. `free` is empty if the furniture has no room at all.
        """
        frame = inside_frame(size, self.template.frame)
        stack = self._stack(values, frame)
        texts = self._notes(frame, stack.box)
        above = texts if not texts.empty and texts.box.bottom > stack.box.top else stack
        table = self._table(self._rows(values), frame, frame.top - above.box.top - _GAP)
        parts = [each for each in (stack, table, texts) if not each.empty]
        taken = tuple(each.box for each in parts)
        figure = border(size, self.template.frame, taken)
        notices = tuple(notice for each in parts for notice in each.notices)
        crowded = any(one.meets(other) for one in taken for other in taken if one is not other)
        outside = any(not frame.grown(1e-6).holds(each) for each in taken)
        free = free_area(size, self.template.frame)
        if crowded or outside:
            free = Box(free.left, free.bottom, free.left, free.bottom)
        return Furnished(Figure.of(figure, *(each.figure for each in parts)), free, taken, notices)

    def _stack(self, values: Mapping[str, str], frame: Box) -> Framed:
        """Return title block, parts list and revisions above each other, in the lower right corner."""
        block = title_block(values, self.template, self.words, self.options.projection)
        found = block.moved(frame.right, frame.bottom)
        for each in (
            parts_list(self.parts, self.template, self.words),
            revisions(self.options.changes, self.template, self.words),
        ):
            found = found if each.empty else found + each.moved(frame.right, found.box.top)
        return found

    def _rows(self, values: Mapping[str, str]) -> list[TableRow]:
        """Return the rows of the table, without material and heat treatment if the title block has cells for them."""
        titled = {name for cell in self.template.cells.values() for name in cell.names if values.get(name)}
        return [row for row in self.rows if row.key not in titled or row.key not in _ONCE]

    def _table(self, rows: Sequence[TableRow], frame: Box, room: float) -> Framed:
        """Return the gear data table in the upper right corner, in the first form that is no higher than `room` (mm), else the
        last.
        """
        table = Framed()
        for sizes, columns, low in self._forms(len(rows), frame.width):
            table = data_table(rows, self.table_title, sizes, columns=columns, low=low)
            if table.empty or table.box.height <= room:
                break
        return table.moved(frame.right, frame.top)

    def _forms(self, rows: int, width: float) -> Iterator[tuple[DataTableSizes, int, bool]]:
        """Yield sizes, number of columns, and whether rows are low. Narrow paper has two narrower columns for many rows
        first.
        """
        sizes = self.template.data_table
        most = int(width / sizes.width)
        if most < 2 and rows > _MANY:
            yield sizes.narrowed(width / 2), 2, True
        yield from ((sizes, columns, low) for columns in range(1, max(most, 1) + 1) for low in (False, True))

    def _notes(self, frame: Box, stack: Box) -> Framed:
        """Return the notes left of the title block, else above the tables that stand on it."""
        lines = [*common_notes(self.options, self.template, self.words), *self.notes, *self.options.notes]
        beside = stack.left - frame.left - 2 * _GAP
        if beside >= _LEAST_NOTES:
            width = min(beside, self.template.notes.width)
            return notes(lines, self.template, width).moved(frame.left + _GAP, frame.bottom + _GAP)
        return notes(lines, self.template, frame.width - 2 * _GAP).moved(frame.left + _GAP, stack.top + _GAP)

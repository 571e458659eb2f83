"""The title block by ISO 7200: cells as the template has them, with values that are made to fit. Lengths in mm."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from gearcad.drawing.frame.fitting import fit, shortened_notice
from gearcad.drawing.frame.framed import Framed
from gearcad.drawing.frame.grid import outlined
from gearcad.drawing.frame.sizes import CAPTION_TOP, TitleCell
from gearcad.drawing.frame.template import SheetTemplate
from gearcad.drawing.marks import projection_symbol
from gearcad.drawing.options import DrawingOptions, Projection, SheetSize
from gearcad.drawing.shapes import Box, Figure, Line, Pen
from gearcad.drawing.words import Words

__all__ = ["title_block", "title_values"]

_CLEAR = 0.3
"""Between the ink of a value and the lines and the caption of its cell."""

_MARGIN = 1.2
"""From the side of a cell to its text."""

_CAPTION_LEAST = 1.8

_OWNER = "the title block"


def title_values(
    options: DrawingOptions,
    words: Words,
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
    """What stands in the cells, by the names of `VALUES`: `title`, `material` ... where `options` have none; mass in kg."""
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


def _mass(mass: float, words: Words) -> str:
    """With three digits, in kg, or in g below 0.1 kg."""
    value, unit = (mass, "kg") if mass >= 0.1 else (mass * 1e3, "g")
    digits = f"{value:.3g}"
    decimals = len(digits.partition(".")[2]) if "e" not in digits else 0
    return f"{words.number(float(digits), decimals)} {unit}"


def title_block(values: Mapping[str, str], template: SheetTemplate, words: Words, projection: Projection) -> Framed:
    """The title block, its lower right corner at (0, 0)."""
    sizes = template.title
    whole = Box(0.0, 0.0, sizes.width, sizes.height)
    found = Framed(Figure((outlined(whole), *_lines([cell.box for cell in template.cells.values()], whole))))
    for name, cell in template.cells.items():
        found += _cell(name, cell, values, words, sizes.caption, projection)
    return found.moved(-sizes.width, 0.0)


def _lines(boxes: Sequence[Box], whole: Box) -> Iterator[Line]:
    """Between cells, each once, as long as it goes on; none on the outline of the whole."""
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
    """Spans that touch or overlap as one."""
    found: list[tuple[float, float]] = []
    for low, high in sorted(spans):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(high, found[-1][1]))
        else:
            found.append((low, high))
    return found


def _cell(
    name: str, cell: TitleCell, values: Mapping[str, str], words: Words, caption_height: float, projection: Projection
) -> Framed:
    """Its caption and value."""
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
    """A text lower, and if it must be smaller, where marks above its letters would meet what is above: Kuggstång."""
    box = figure.box
    if box.height > ceiling - floor:
        share = (ceiling - floor) / box.height
        texts = (replace(each, height=each.height * share) for each in figure.texts)
        figure = Figure(tuple(each.moved(0.0, (share - 1) * (each.at[1] - floor)) for each in texts))
        box = figure.box
    return figure.moved(0.0, min(0.0, ceiling - box.top) + max(0.0, floor - box.bottom))


def _caption(name: str, cell: TitleCell, words: Words) -> str:
    """The word of [frame] that the cell names, or its own text."""
    asked = name if cell.caption is None else cell.caption
    return words.labels.get(f"frame.{asked}", "" if cell.caption is None else asked)


def _symbol(projection: Projection, box: Box) -> Figure:
    """The symbol of the method of projection in the middle of a box."""
    height = min(5.0, 0.8 * box.height)
    symbol = projection_symbol(projection, height=height)
    across, up = symbol.box.middle
    return symbol.moved(box.middle[0] - across, box.middle[1] - up)

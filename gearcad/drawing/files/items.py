"""What a document shows, in the three ways that pages know: lines, filled areas, texts. Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from gearcad.drawing.files.hatch_lines import hatch_lines
from gearcad.drawing.files.plain import as_read
from gearcad.drawing.shapes import Anchor, Pen, Point, Text, Vertex

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities import DXFEntity

__all__ = ["Area", "Item", "Stroked", "items", "line_widths", "paper_size"]


@dataclass(frozen=True)
class Stroked:
    """Lines and arcs in a row, by vertices with bulges."""

    vertices: tuple[Vertex, ...]
    closed: bool
    pen: Pen

    @property
    def dashes(self) -> tuple[float, ...]:
        """Those of its pen, so stretched that it begins and ends with a whole dash; none where it is too short for two."""
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
    """All that a document shows, in its order."""
    return _of_all(document.modelspace(), document)


def line_widths(document: Drawing) -> dict[Pen, float]:
    """Of the lines of each pen on this sheet."""
    return {pen: document.layers.get(pen.value).dxf.lineweight / 100 for pen in Pen}


def paper_size(document: Drawing) -> tuple[float, float]:
    """Width and height of the sheet."""
    across, up = document.header["$LIMMAX"]
    return across, up


def _of_all(entities: object, document: Drawing) -> Iterator[Item]:
    for entity in entities:  # type: ignore[attr-defined] # a layout: type checkers do not see the library
        yield from _of(entity, document)


def _of(entity: DXFEntity, document: Drawing) -> Iterator[Item]:
    kind, dxf = entity.dxftype(), entity.dxf
    if kind == "DIMENSION":
        yield from _of_all(document.blocks.get(dxf.geometry), document)
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
    """An arc (degrees, counter-clockwise) by two halves."""
    turn = (end - start) % 360.0
    bulge = math.tan(math.radians(turn) / 8)
    angles = (math.radians(start + part * turn) for part in (0.0, 0.5, 1.0))
    (x, y), bulges = centre, (bulge, bulge, 0.0)
    return tuple((x + radius * math.cos(a), y + radius * math.sin(a), b) for a, b in zip(angles, bulges, strict=True))


def _length(start: Vertex, end: Vertex) -> float:
    chord, turn = math.dist(start[:2], end[:2]), 4 * math.atan(start[2])
    return chord if not turn else chord * abs(turn / 2 / math.sin(turn / 2))

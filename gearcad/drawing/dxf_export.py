"""DXF documents of sheets: layers of pens, true dimensions and hatches. Lengths in mm."""

from __future__ import annotations

import math
import re
import unicodedata
from functools import singledispatch
from typing import TYPE_CHECKING, Any

from gearcad.core.dxf import new_document
from gearcad.drawing.shapes import (
    STRETCH,
    Arc,
    Box,
    Circle,
    Dimension,
    Figure,
    Filled,
    Hatching,
    Line,
    MeasuredDistance,
    Pen,
    Polyline,
    Shape,
    Text,
    font_file,
)
from gearcad.drawing.words import Language

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import BaseLayout, BlockLayout


_PERCENT = re.compile(r"%(?=%)|(?<=%)%")
_BACKSLASH, _AS_CODE = re.compile(r"\\(?=[UM]\+)", re.IGNORECASE), r"\U+005C"
_REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


def one_line(words: str) -> str:
    """Return a text without control characters: a space replaces each, and a replacement mark each half of a surrogate pair,
    which no file can hold.
    """
    return "".join(map(_printable, words))


def as_code(words: str) -> str:
    """Return a text as the code of a DXF entity, in which "%%c", "^J", and a backslash with "U+2300" or "M+18140" would be
    codes.

    >>> as_code("90 %, 50%%c")
    '90 %, 50%%%%%%c'
    """
    words = _BACKSLASH.sub(lambda _: _AS_CODE, one_line(words))
    return _PERCENT.sub("%%%", words).replace("^", "^ ")


def as_read(code: str) -> str:
    """Return the text from which `as_code` made a code.

    >>> as_read(as_code("90 %, 50%%c ^ <&>"))
    '90 %, 50%%c ^ <&>'
    """
    return code.replace("%%%", "%").replace("^ ", "^").replace(_AS_CODE, "\\")


def _printable(letter: str) -> str:
    kind = unicodedata.category(letter)
    if kind == "Cs":
        return _REPLACEMENT
    return " " if kind in ("Cc", "Zl", "Zp") else letter


_STYLE = "ISO129"

_LINEAR, _OWN_BLOCK, _TEXT_STAYS = 0, 32, 128

_WIDER, _SPARE = 1.25, 2.0
"""Largest width of other programs' fonts over ours, and room (mm) that a text should have left."""

_LOOK = {
    "dimtxt": 3.5,  # height of the text
    "dimasz": 3.2,  # length of an arrow
    "dimexo": 0.8,  # gap before an extension line
    "dimexe": 1.5,  # how far it goes on
    "dimgap": 0.9,  # between text and line
    "dimtad": 1,  # text above the line
    "dimtih": 0,  # and along it
    "dimtoh": 0,
    "dimzin": 8,  # no zeros at the end
    "dimdec": 3,
    "dimtdec": 3,
    "dimtfac": 0.7,  # height of tolerances over that of the text
    "dimlwd": 25,
    "dimlwe": 25,
    "dimtofl": 1,  # a line between extension lines though the text is outside
}


def add_dimension_style(document: Drawing, text_style: str, scale: float, decimal_mark: str) -> None:
    """Add the style of all dimensions to a document; parts are on paper `scale` times as large as they are."""
    style = document.dimstyles.add(_STYLE)
    look = {**_LOOK, "dimlfac": 1 / scale, "dimdsep": ord(decimal_mark)}
    style.dxf.update({**look, "dimtxsty": text_style})
    document.header["$DIMSTYLE"] = _STYLE
    for name, value in look.items():  # there are programs that read no styles
        document.header[f"${name.upper()}"] = value


def add_dimension(dimension: Dimension, space: BaseLayout, attributes: dict[str, Any]) -> BlockLayout:
    """Add a dimension and return its block, in which its parts are to be drawn."""
    from ezdxf.entities import Dimension as Entity

    document = space.doc
    block = document.blocks.new_anonymous_block("D")
    of_sheet = document.dimstyles.get(_STYLE).dxf.dimlfac
    factor = of_sheet if dimension.scale is None else 1 / dimension.scale
    entity: Entity = space.new_entity("DIMENSION", attributes)
    entity.dxf.update(_points(dimension))
    entity.dxf.update(
        {
            "dimstyle": _STYLE,
            "geometry": block.name,
            "text": one_line(dimension.words),
            "text_midpoint": _text_box(dimension).middle,
            "actual_measurement": _length(dimension) * factor,
        }
    )
    if not math.isclose(factor, of_sheet):
        from ezdxf.entities.dimstyleoverride import DimStyleOverride

        DimStyleOverride(entity, {"dimlfac": factor}).commit()
    return block


def _points(dimension: Dimension) -> dict[str, Any]:
    """Return the DXF attributes of a dimension's type, direction, measured points and line."""
    upright = dimension.measured is MeasuredDistance.VERTICAL
    end = (dimension.line[0], dimension.second[1]) if upright else (dimension.second[0], dimension.line[1])
    kind = _LINEAR | _OWN_BLOCK | _TEXT_STAYS
    return {
        "dimtype": kind,
        "angle": 90.0 if upright else 0.0,
        "defpoint": end,
        "defpoint2": dimension.first,
        "defpoint3": dimension.second,
    }


def is_drawn_alike(dimension: Dimension) -> bool:
    """Return whether programs that redraw a dimension leave its text in place: between the measured points.

    LibreCAD pushes texts aside that are longer than what is measured, from wherever they were put.
    """
    axis = _axis(dimension)
    box = _text_box(dimension)
    low, high = sorted((dimension.first[axis], dimension.second[axis]))
    longer = ((box[2 + axis] - box[axis]) * (_WIDER - 1) + _SPARE) / 2
    return low <= box[axis] - longer and box[2 + axis] + longer <= high


def _axis(dimension: Dimension) -> int:
    """Return the axis along which a dimension measures: 0 for x, 1 for y."""
    return 1 if dimension.measured is MeasuredDistance.VERTICAL else 0


def _length(dimension: Dimension) -> float:
    """Return the measured length on paper (mm)."""
    axis = _axis(dimension)
    return abs(dimension.second[axis] - dimension.first[axis])


def _text_box(dimension: Dimension) -> Box:
    """Return the box of a dimension's texts, or the point of its line if it has none."""
    boxes = [part.box for part in dimension.parts if isinstance(part, Text)]
    return Box.of_all(boxes) if boxes else Box.around([dimension.line])


TITLE, LANGUAGE = "Title", "Language"
"""Names of properties of a document."""

TEXT_STYLE = "lc_opengost-br"
"""Name of the text style. LibreCAD takes its own font of this name, with nearly all our letters; others use the font file."""

_BLACK = 7

_LINE_TYPES = {Pen.CENTRE: "CENTER", Pen.HIDDEN: "HIDDEN"}
"""Names of line types, for programs that know them by name only; dashes are in mm, as pens have them."""

_LARGEST_OF_GROUP_05 = 594.0
"""Longer side of A2: larger sheets have lines of group 0.7 (ISO 128-2)."""

_GROUP_07 = {18: 25, 25: 35, 35: 50, 50: 70}
"""Widths of that group (hundredths of mm) by those of group 0.5."""

_SAME_ON_ALL = (Pen.FRAME, Pen.GRID)
"""ISO 5457 has one width for all sizes."""

_ANSI31_SPACING, _ANSI31_ANGLE = 3.175, 45.0
_MOST_OF_A_PROPERTY = 250


def sheet_document(
    figure: Figure, size: tuple[float, float], scale: float, *, title: str, language: Language = Language.ENGLISH
) -> Drawing:
    """Return a document with one sheet of paper of a `size` (across, up; mm), on which parts are `scale` times as large as
    they are.

    Model space is the paper. Dimensions measure the part: a program that draws them anew writes its sizes.
    """
    document = new_document()
    _add_layers(document, size)
    _add_styles(document, scale, language)
    _set_paper(document, size)
    properties = document.header.custom_vars
    properties.append(TITLE, one_line(title)[:_MOST_OF_A_PROPERTY])
    properties.append(LANGUAGE, language.value)
    space = document.modelspace()
    # Hatches last: FreeCAD 0.20 passes over what follows one.
    for shape in sorted(figure.shapes, key=lambda each: isinstance(each, Hatching)):
        draw(shape, space)
    return document


def _add_layers(document: Drawing, size: tuple[float, float]) -> None:
    """Add a layer and a line type for each pen."""
    for pen in Pen:
        width, dashes = pen.stroke
        line_type = _LINE_TYPES.get(pen, "CONTINUOUS")
        if line_type not in document.linetypes:
            lengths = [length * (-1) ** k for k, length in enumerate(dashes)]
            document.linetypes.add(line_type, [sum(dashes), *lengths], description=f"ISO 128-2, {line_type.lower()}")
        weight = round(100 * width)
        if max(size) > _LARGEST_OF_GROUP_05 and pen not in _SAME_ON_ALL:
            weight = _GROUP_07[weight]
        document.layers.add(pen.value, color=_BLACK, linetype=line_type, lineweight=weight)


def _add_styles(document: Drawing, scale: float, language: Language) -> None:
    """Add the style of texts and the style of dimensions."""
    document.header["$LTSCALE"] = 1.0
    document.styles.add(TEXT_STYLE, font=font_file().name).dxf.width = STRETCH
    add_dimension_style(document, TEXT_STYLE, scale, language.decimal_mark)


def _set_paper(document: Drawing, size: tuple[float, float]) -> None:
    """Set the extents of the sheet (mm), its view as a whole, and its plot settings: one to one, without margins."""
    across, up = size
    space = document.modelspace()
    space.reset_extents((0, 0, 0), (across, up, 0))
    space.reset_limits((0, 0), (across, up))
    header = document.header  # of which the library does not change what begins at the origin
    header["$EXTMIN"], header["$EXTMAX"] = (0, 0, 0), (across, up, 0)
    header["$LIMMIN"], header["$LIMMAX"] = (0, 0), (across, up)
    document.set_modelspace_vport(1.05 * up, (across / 2, up / 2), dxfattribs={"aspect_ratio": across / up})
    millimetres, limits, one_to_one = 1, 2, 16
    plot = {"paper_width": across, "paper_height": up, "plot_paper_units": millimetres, "plot_type": limits}
    margins = dict.fromkeys(("left_margin", "bottom_margin", "right_margin", "top_margin"), 0.0)
    space.dxf_layout.dxf.update({**plot, **margins, "standard_scale_type": one_to_one})


@singledispatch
def draw(shape: Shape, space: BaseLayout) -> None:
    """Add a shape as entities."""
    for part in getattr(shape, "parts"):  # noqa: B009 - that of compound shapes
        draw(part, space)


@draw.register(Line)
def _(line: Line, space: BaseLayout) -> None:
    space.add_line(line.start, line.end, _on(line.pen))


@draw.register(Polyline)
def _(line: Polyline, space: BaseLayout) -> None:
    space.add_lwpolyline(line.vertices, "xyb", close=line.closed, dxfattribs=_on(line.pen))


@draw.register(Circle)
def _(circle: Circle, space: BaseLayout) -> None:
    space.add_circle(circle.centre, circle.radius, _on(circle.pen))


@draw.register(Arc)
def _(arc: Arc, space: BaseLayout) -> None:
    space.add_arc(arc.centre, arc.radius, arc.start, arc.end, dxfattribs=_on(arc.pen))


@draw.register(Filled)
def _(area: Filled, space: BaseLayout) -> None:
    corners = list(area.points)
    corners[2:] = reversed(corners[2:])  # of a quadrilateral DXF has the corners crosswise
    space.add_solid(corners, _on(area.pen))


@draw.register(Text)
def _(text: Text, space: BaseLayout) -> None:
    from ezdxf.enums import TextEntityAlignment

    style = {"style": TEXT_STYLE, "width": text.stretch, "rotation": text.rotation}
    entity = space.add_text(as_code(text.words), height=text.height, dxfattribs=_on(text.pen) | style)
    entity.set_placement(text.at, align=TextEntityAlignment[text.anchor.value])


@draw.register(Hatching)
def _(hatching: Hatching, space: BaseLayout) -> None:
    hatch = space.add_hatch(color=256, dxfattribs=_on(hatching.pen) | {"hatch_style": 0})
    hatch.set_pattern_fill("ANSI31", color=256, scale=hatching.spacing / _ANSI31_SPACING, angle=hatching.angle - _ANSI31_ANGLE)
    for edge in hatching.edges:
        hatch.paths.add_polyline_path(edge, is_closed=True)


@draw.register(Dimension)
def _(dimension: Dimension, space: BaseLayout) -> None:
    """Add a dimension with a block of its parts; add only the parts if other programs would redraw it differently."""
    seen = add_dimension(dimension, space, _on(Pen.DIMENSION)) if is_drawn_alike(dimension) else space
    for part in dimension.parts:
        draw(part, seen)


def _on(pen: Pen) -> dict[str, Any]:
    """Return the attributes of entities drawn with a pen: the layer, which has all other properties."""
    return {"layer": pen.value}

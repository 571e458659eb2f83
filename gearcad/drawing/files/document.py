"""A sheet as a document of DXF: layers of pens, true dimensions and hatches, and the paper that it fills. Lengths in mm."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING, Any

from gearcad.drawing.files.dimensions import add_dimension, add_dimension_style, is_drawn_alike
from gearcad.drawing.files.plain import as_code, one_line
from gearcad.drawing.shapes import Arc, Circle, Dimension, Figure, Filled, Hatching, Line, Pen, Polyline, Shape, Text
from gearcad.drawing.shapes.font import STRETCH, font_file
from gearcad.drawing.words import Language
from gearcad.dxf import new_document

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import BaseLayout

__all__ = ["LANGUAGE", "TITLE", "sheet_document"]

TITLE, LANGUAGE = "Title", "Language"
"""Names of properties of a document."""

TEXT_STYLE = "lc_opengost-br"
"""LibreCAD has fonts of its own and takes the one of this name, which has nearly all our letters; others go by the file."""

_BLACK = 7

_LINE_TYPES = {Pen.CENTRE: "CENTER", Pen.HIDDEN: "HIDDEN"}
"""Names that programs know which do not read what line types are made of; dashes are in mm, as pens have them."""

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
    """A document with one sheet of paper of a `size` (across, up), on which parts are `scale` times as large as they are.

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
    """A layer and a line type for each pen."""
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
    """The style of texts and that of dimensions."""
    document.header["$LTSCALE"] = 1.0
    document.styles.add(TEXT_STYLE, font=font_file().name).dxf.width = STRETCH
    add_dimension_style(document, TEXT_STYLE, scale, language.decimal_mark)


def _set_paper(document: Drawing, size: tuple[float, float]) -> None:
    """How far the sheet reaches, that it is seen whole, and how it is plotted: one to one, without margins."""
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
    """With a block of its parts; only the parts, where other programs would make something else of it."""
    seen = add_dimension(dimension, space, _on(Pen.DIMENSION)) if is_drawn_alike(dimension) else space
    for part in dimension.parts:
        draw(part, seen)


def _on(pen: Pen) -> dict[str, Any]:
    """Attributes of what is drawn with a pen: its layer has the rest."""
    return {"layer": pen.value}

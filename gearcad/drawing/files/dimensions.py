"""Dimensions of DXF: what they measure, in the style of ISO 129-1, and a block with what they look like. Lengths in mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gearcad.drawing.files.plain import one_line
from gearcad.drawing.shapes import Box, Dimension, Measured, Text

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import BaseLayout, BlockLayout

__all__ = ["add_dimension", "add_dimension_style", "is_drawn_alike"]

_STYLE = "ISO129"

_LINEAR, _OWN_BLOCK, _TEXT_STAYS = 0, 32, 128

_WIDER, _SPARE = 1.25, 2.0
"""Fonts of other programs are so much wider than ours, and a text should have so much room left (mm)."""

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
    """The style of all dimensions: parts are on paper `scale` times as large as they are."""
    style = document.dimstyles.add(_STYLE)
    look = {**_LOOK, "dimlfac": 1 / scale, "dimdsep": ord(decimal_mark)}
    style.dxf.update({**look, "dimtxsty": text_style})
    document.header["$DIMSTYLE"] = _STYLE
    for name, value in look.items():  # there are programs that read no styles
        document.header[f"${name.upper()}"] = value


def add_dimension(dimension: Dimension, space: BaseLayout, attributes: dict[str, Any]) -> BlockLayout:
    """Add a dimension, and give back its block, in which its parts are to be drawn."""
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
    """What is measured, and where the line of the dimension is."""
    upright = dimension.measured is Measured.VERTICAL
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
    """Whether programs that draw a dimension anew set its text where it is: between the points that are measured.

    LibreCAD pushes texts aside that are longer than what is measured, from wherever they were put.
    """
    axis = _axis(dimension)
    box = _text_box(dimension)
    low, high = sorted((dimension.first[axis], dimension.second[axis]))
    longer = ((box[2 + axis] - box[axis]) * (_WIDER - 1) + _SPARE) / 2
    return low <= box[axis] - longer and box[2 + axis] + longer <= high


def _axis(dimension: Dimension) -> int:
    """Along which it measures: 0 for x, 1 for y."""
    return 1 if dimension.measured is Measured.VERTICAL else 0


def _length(dimension: Dimension) -> float:
    """On paper."""
    axis = _axis(dimension)
    return abs(dimension.second[axis] - dimension.first[axis])


def _text_box(dimension: Dimension) -> Box:
    """That of its texts, or the point of the line where it has none."""
    boxes = [part.box for part in dimension.parts if isinstance(part, Text)]
    return Box.of_all(boxes) if boxes else Box.around([dimension.line])

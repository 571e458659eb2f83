"""Sizes of all that frames a sheet, and the cells of its title block: what each can be. Lengths in mm of paper."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

from gearcad.drawing.shapes import Box
from gearcad.errors import ParameterError
from gearcad.ranges import Choice, Range, Whole
from gearcad.schema import require_fields

__all__ = [
    "CAPTION_TOP",
    "LEAST",
    "VALUES",
    "DataTableSizes",
    "FrameSizes",
    "NoteSizes",
    "PartsListSizes",
    "RevisionSizes",
    "TitleCell",
    "TitleSizes",
]

_MM = Range("mm", 0.0, 1e3)
_EDGE = Range("mm", 0.0, 60.0)
_SOME = Range("mm", 5.0, 1e3)
_TEXT = Range("mm", 1.0, 20.0)
"""Heights of letters."""

LEAST = 2.0
"""Height of the smallest letters that values are written with."""

VALUES = (
    "number",
    "title",
    "supplementary_title",
    "owner",
    "department",
    "technical_reference",
    "creator",
    "approver",
    "document_type",
    "status",
    "classification",
    "revision",
    "date",
    "language",
    "scale",
    "size",
    "sheet",
    "sheets",
    "general_tolerance",
    "material",
    "heat_treatment",
    "mass",
)
"""What the value of a cell may have in braces."""

CAPTION_TOP = 1.0
"""From the top of a cell to its caption."""

_CAPTION_AIR = 0.7
"""Between the caption and the value of a cell."""

_AIR = 0.65
"""Least distance of a value from the bottom of its cell."""

_BELOW = 0.33
"""How far letters reach below their line, over their height."""

_IN_BRACES = re.compile(r"\{([^{}]*)\}")


@dataclass(frozen=True, kw_only=True)
class FrameSizes:
    """Margins, and the strip with letters and numbers."""

    binding_margin: Annotated[float, _EDGE]
    margin: Annotated[float, _EDGE]
    grid_width: Annotated[float, _EDGE]
    grid_pitch: Annotated[float, Range("mm", 20.0, 200.0)]
    grid_text: Annotated[float, _TEXT]
    centring: Annotated[float, _EDGE]

    def __post_init__(self) -> None:
        require_fields(self)
        if self.grid_width > min(self.margin, self.binding_margin):
            raise ParameterError("grid_width", self.grid_width, "must have room in both margins", "mm")
        if self.grid_text > self.grid_width > 0:
            raise ParameterError("grid_text", self.grid_text, "must have room in grid_width", "mm")


@dataclass(frozen=True, kw_only=True)
class TitleSizes:
    """The title block as a whole."""

    width: Annotated[float, _SOME]
    height: Annotated[float, _SOME]
    caption: Annotated[float, _TEXT]


@dataclass(frozen=True, kw_only=True)
class TitleCell:
    """A cell of the title block, from its lower left corner; without `caption` that of its name."""

    left: Annotated[float, _MM]
    bottom: Annotated[float, _MM]
    width: Annotated[float, _SOME]
    height: Annotated[float, _SOME]
    caption: str | None = None
    value: str = ""
    text: Annotated[float, _TEXT] = 3.5
    symbol: Annotated[str, Choice(("", "projection"))] = ""

    @property
    def value_bottom(self) -> float:
        """Where the line of its value may be at the lowest: letters reach below it."""
        return self.bottom + _AIR + _BELOW * self.text

    def value_top(self, caption: float) -> float:
        """How far up the value may reach, below a caption of this height."""
        return self.bottom + self.height - CAPTION_TOP - (0.0 if self.caption == "" else caption + _CAPTION_AIR)

    @property
    def box(self) -> Box:
        """Where it is in the title block."""
        return Box(self.left, self.bottom, self.left + self.width, self.bottom + self.height)

    def filled(self, values: Mapping[str, str]) -> str:
        """Its value with what stands in braces put in."""
        return " ".join(_IN_BRACES.sub(lambda found: values.get(found[1], ""), self.value).split())

    @property
    def names(self) -> list[str]:
        """What its value has in braces."""
        return _IN_BRACES.findall(self.value)


@dataclass(frozen=True, kw_only=True)
class DataTableSizes:
    """Columns and rows of the gear data table."""

    words: Annotated[float, _SOME]
    symbol: Annotated[float, _SOME]
    value: Annotated[float, _SOME]
    heading: Annotated[float, _SOME]
    row: Annotated[float, _SOME]
    least_row: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]

    @property
    def columns(self) -> tuple[float, float, float]:
        return self.words, self.symbol, self.value

    @property
    def width(self) -> float:
        return sum(self.columns)

    def narrowed(self, width: float) -> DataTableSizes:
        """With columns that have such a width together."""
        part = width / self.width
        return replace(self, words=part * self.words, symbol=part * self.symbol, value=part * self.value)


@dataclass(frozen=True, kw_only=True)
class PartsListSizes:
    """Columns and rows of the parts list."""

    item: Annotated[float, _SOME]
    quantity: Annotated[float, _SOME]
    number: Annotated[float, _SOME]
    title: Annotated[float, _SOME]
    material: Annotated[float, _SOME]
    remarks: Annotated[float, _SOME]
    row: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]

    @property
    def columns(self) -> tuple[float, ...]:
        return self.item, self.quantity, self.number, self.title, self.material, self.remarks


@dataclass(frozen=True, kw_only=True)
class RevisionSizes:
    """Columns and rows of the table of revisions."""

    index: Annotated[float, _SOME]
    text_width: Annotated[float, _SOME]
    date: Annotated[float, _SOME]
    name: Annotated[float, _SOME]
    row: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]
    most: Annotated[int, Whole(1, 100)]

    @property
    def columns(self) -> tuple[float, ...]:
        return self.index, self.text_width, self.date, self.name


@dataclass(frozen=True, kw_only=True)
class NoteSizes:
    """The notes: how wide, and how far their lines are apart."""

    width: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]
    pitch: Annotated[float, _TEXT]

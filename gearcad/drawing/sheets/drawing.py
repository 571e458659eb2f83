"""Sheet and Drawing: what is drawn of a design, before it is a file. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from gearcad.drawing.files import sheet_document
from gearcad.drawing.shapes import Box, Figure
from gearcad.drawing.words import Language
from gearcad.notice import Notice

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

__all__ = ["Drawing", "Sheet"]


@dataclass(frozen=True, kw_only=True)
class Sheet:
    """One page: `name` is that of its files ("pinion", "assembly"), `number` what identifies it, `size` that of the paper.

    `scale` is mm of paper for a mm of the part. `shown` are the exact values of the numbers on it by their keys in documents
    ("reference_diameter"), as they are before they are rounded. `notices` say what was shortened, assumed or left out.
    """

    name: str
    title: str
    number: str = ""
    size: tuple[float, float]
    scale: float
    language: Language
    figure: Figure = field(repr=False)
    shown: Mapping[str, float] = field(default_factory=dict, repr=False)
    notices: tuple[Notice, ...] = ()

    def document(self) -> Document:
        """As one document of DXF, of which all its files are written."""
        return sheet_document(self.figure, self.size, self.scale, title=self.title, language=self.language)

    @property
    def paper(self) -> Box:
        """The page, its lower left corner at the origin."""
        return Box(0.0, 0.0, *self.size)


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """The sheets of a design, in order."""

    name: str
    sheets: tuple[Sheet, ...]

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Those of all sheets, each with the sheet it is about."""
        return tuple(notice.within(sheet.name) for sheet in self.sheets for notice in sheet.notices)

"""Sheet and Drawing: what is drawn of a design, before it is a file. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from gearcad.drawing.shapes import Box, Figure
from gearcad.drawing.words import Language
from gearcad.notice import Notice

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

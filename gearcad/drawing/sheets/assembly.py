"""Sheets of assemblies: one row of views, the data of their meshes, a parts list above the title block."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from gearcad.drawing.frame import Furnished, Furniture, title_values
from gearcad.drawing.gear_data import Row
from gearcad.drawing.layout import Arrangement, Fixed, View, Views, arranged
from gearcad.drawing.options import SheetSize
from gearcad.drawing.sheets.drawing import Sheet
from gearcad.drawing.words import Draughting
from gearcad.notice import Notice

__all__ = ["AssemblySheet"]

_LEGIBLE = 80.0
"""Least size over all (mm of paper) of an assembly, unless no larger paper makes it larger."""


@dataclass(frozen=True, kw_only=True)
class AssemblySheet:
    """A sheet to be laid out: what frames its views, and these at any scale; `extent` (mm) is the largest size over all.

    `mass` (kg) is that of all parts, None where it is not known.
    """

    furniture: Furniture
    rows: Sequence[Row]
    views: Callable[[Draughting], tuple[View, ...]]
    title: str
    document_type: str
    extent: float
    mass: float | None = None

    def drawn(self, name: str, notices: Sequence[Notice] = ()) -> Sheet:
        """It, on the paper and at the scale asked for or found; where nothing is asked for, on larger paper if it is small.

        Raises ParameterError where what was asked for has no room.
        """
        options, found = self.furniture.options, self._found
        shown = {key: value for row in self.rows for key, value in row.numbers.items()}
        if self.mass is not None:
            shown["mass"] = self.mass
        return Sheet(
            name=name,
            title=options.title or self.title,
            number=options.number,
            size=found.size,
            scale=found.factor,
            language=options.language,
            figure=found.figure,
            shown=shown,
            notices=(*notices, *self._furnished(found.sheet, found.scale).notices),
        )

    @cached_property
    def _found(self) -> Arrangement:
        options = self.furniture.options
        found = self._on(options.sheet)
        if options.sheet is SheetSize.AUTO and options.scale == "auto" and self.extent * found.factor < _LEGIBLE:
            larger = (each for each in SheetSize if each is not SheetSize.AUTO and each.size[0] > found.size[0])
            found = next((other for each in larger if (other := self._on(each)).factor > found.factor), found)
        return found

    def _on(self, sheet: SheetSize) -> Arrangement:
        options, words = self.furniture.options, self.furniture.words
        return arranged(
            lambda scale: Views((self.views(Draughting(words, scale)),)),
            self._fixed,
            sheet=sheet,
            scale=options.scale,
            projection=options.projection,
        )

    def _fixed(self, size: SheetSize, scale: str) -> Fixed:
        found = self._furnished(size, scale)
        return Fixed(found.figure, found.free, found.taken)

    def _furnished(self, size: SheetSize, scale: str) -> Furnished:
        options, words = self.furniture.options, self.furniture.words
        values = title_values(
            options,
            words,
            title=self.title,
            document_type=self.document_type,
            size=size,
            scale=scale,
            mass=self.mass,
        )
        return self.furniture.on(size, values)

"""What a rating goes by: the [rating] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from gearcad.errors import require_whole
from gearcad.geometry import Gear
from gearcad.rating.duty_options import DutyOptions
from gearcad.rating.editions import Edition
from gearcad.rating.load_factor_options import LoadFactorOptions
from gearcad.rating.lubricant_options import LubricantOptions
from gearcad.rating.tolerances import Accuracy, grades
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["RatingOptions", "RootShift"]


class RootShift(StrEnum):
    """The profile shift that root stresses go by."""

    GENERATING = "generating"
    """x_E of the tooth as cut: with its thinning (ISO 6336-3)."""

    NOMINAL = "nominal"
    """x, which is the default of KISSsoft."""


@dataclass(frozen=True, kw_only=True)
class _Standards:
    standard: Annotated[Edition, Words("standard of the rating")] = Edition.ISO_2006
    accuracy: Annotated[Accuracy, Words("standard of the accuracy grade")] = Accuracy.ISO_1995
    accuracy_grade: Annotated[int, Words("accuracy grade", "", "ISO 1328-1")] = 6
    root_shift: Annotated[RootShift, Words("profile shift of root stresses", "x_E", "ISO 6336-3")] = RootShift.GENERATING


@dataclass(frozen=True, kw_only=True)
class RatingOptions(LubricantOptions, LoadFactorOptions, DutyOptions, _Standards):
    """The `standard`, the `accuracy_grade` of both gears in an edition of ISO 1328-1 (`accuracy`), and all else of a rating.

    The grade decides on K_v and, from grade 4 on, on the root stress of deep teeth; a gear may have its own. What stands for
    both gears as a number may be a list [pinion, wheel]. Raises ParameterError, and GeometryError for an oil that no oil is.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        first, last = grades(self.accuracy)
        require_whole("accuracy_grade", self.accuracy_grade, at_least=first, at_most=last)
        self._check_duty()
        self._check_load_factors()
        self._check_lubricant()

    def grade_of(self, gear: Gear) -> int:
        """A gear's own accuracy grade, else that of both."""
        return self.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade

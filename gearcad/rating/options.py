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
from gearcad.schema import AssumedCount, Words, is_assumed, require_fields

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
    accuracy_grade: Annotated[int, Words("accuracy grade", "", "ISO 1328-1")] = AssumedCount(6)
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

    @property
    def asks_strength(self) -> bool:
        """Return whether a required safety is given, which asks for a verdict on strength."""
        safeties = (self.required_safety_flank, self.required_safety_root, self.required_safety_scuffing)
        return any(each is not None and not is_assumed(each) for each in safeties)

    @property
    def given_compensation(self) -> float | None:
        """Return what a proven contact pattern takes off the deflection (µm): a given f_ma by DIN 3990-1:1987; else None.

        ISO 6336-1 takes the helix slope deviation of grade 5 (53), and so does DIN 3990-1 here where no f_ma is given.
        """
        return self.manufacturing_misalignment if self.standard is Edition.DIN_1987 else None

    def grade_of(self, gear: Gear) -> int:
        """A gear's own accuracy grade, else that of both."""
        return self.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade

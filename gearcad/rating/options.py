"""What a rating goes by: the [rating] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.errors import as_choice, plain_numbers, require_whole
from gearcad.rating.editions import Edition
from gearcad.rating.iso1328 import Accuracy, grades
from gearcad.reprs import concise

__all__ = ["RatingOptions"]


@dataclass(frozen=True, kw_only=True)
class RatingOptions:
    """The `standard`, and the `accuracy_grade` of both gears in an edition of ISO 1328-1 (`accuracy`). Raises ParameterError.

    The grade decides on K_v and, from grade 4 on, on the root stress of deep teeth.
    """

    standard: Edition = Edition.ISO_2006
    accuracy: Accuracy = Accuracy.ISO_1995
    accuracy_grade: int = 6

    __repr__ = concise

    def __post_init__(self) -> None:
        plain_numbers(self)
        object.__setattr__(self, "standard", as_choice("standard", self.standard, Edition))
        object.__setattr__(self, "accuracy", as_choice("accuracy", self.accuracy, Accuracy))
        first, last = grades(self.accuracy)
        require_whole("accuracy_grade", self.accuracy_grade, at_least=first, at_most=last)

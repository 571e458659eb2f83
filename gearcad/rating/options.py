"""What a rating goes by: the [rating] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from gearcad.errors import require_whole
from gearcad.rating.editions import Edition
from gearcad.rating.iso1328 import Accuracy, grades
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["RatingOptions"]


@dataclass(frozen=True, kw_only=True)
class RatingOptions:
    """The `standard`, and the `accuracy_grade` of both gears in an edition of ISO 1328-1 (`accuracy`). Raises ParameterError.

    The grade decides on K_v and, from grade 4 on, on the root stress of deep teeth.
    """

    standard: Annotated[Edition, Words("standard of the rating")] = Edition.ISO_2006
    accuracy: Annotated[Accuracy, Words("standard of the accuracy grade")] = Accuracy.ISO_1995
    accuracy_grade: Annotated[int, Words("accuracy grade", "", "ISO 1328-1")] = 6

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        first, last = grades(self.accuracy)
        require_whole("accuracy_grade", self.accuracy_grade, at_least=first, at_most=last)

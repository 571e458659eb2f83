"""Which edition of ISO 1328-1: its grades, the sizes that it covers, and its equations."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Protocol

from gearcad.ranges import Range, Whole
from gearcad.rating.factors.elementwise import Values
from gearcad.rating.tolerances import iso1328_1995, iso1328_2013

__all__ = ["Accuracy", "Equations", "covered", "equations", "grades"]


class Accuracy(StrEnum):
    """The editions of the standard, whose grades are not the same."""

    ISO_1995 = "ISO 1328-1:1995"
    """Accuracy grades 0 to 12, to which ISO 6336:2006 refers."""

    ISO_2013 = "ISO 1328-1:2013"
    """Flank tolerance classes 1 to 11."""


class Equations(Protocol):
    """What both editions have equations for."""

    def single_pitch(self, d: Values, m_n: Values, /) -> Values: ...
    def sector_pitch(self, d: Values, m_n: Values, k: Values, teeth: Values, /) -> Values: ...
    def cumulative_pitch(self, d: Values, m_n: Values, /) -> Values: ...
    def profile_slope(self, d: Values, m_n: Values, /) -> Values: ...
    def profile_form(self, d: Values, m_n: Values, /) -> Values: ...
    def profile_total(self, d: Values, m_n: Values, /) -> Values: ...
    def helix_slope(self, d: Values, b: Values, /) -> Values: ...
    def helix_form(self, d: Values, b: Values, /) -> Values: ...
    def helix_total(self, d: Values, b: Values, /) -> Values: ...
    def runout(self, d: Values, m_n: Values, /) -> Values: ...


_EQUATIONS: Mapping[Accuracy, Equations] = {Accuracy.ISO_1995: iso1328_1995, Accuracy.ISO_2013: iso1328_2013}
_GRADES = {Accuracy.ISO_1995: (0, 12), Accuracy.ISO_2013: (1, 11)}

_MODULES = Range("mm", 0.5, 70)
_COVERED: Mapping[Accuracy, Mapping[str, Range | Whole]] = {
    Accuracy.ISO_1995: MappingProxyType(
        {"reference_diameter": Range("mm", 5, 10_000), "normal_module": _MODULES, "face_width": Range("mm", 4, 1000)}
    ),
    Accuracy.ISO_2013: MappingProxyType(
        {
            "teeth": Whole(5, 1000),
            "helix_angle": Range("deg", 0, 45),
            "reference_diameter": Range("mm", 5, 15_000),
            "normal_module": _MODULES,
            "face_width": Range("mm", 4, 1200),
        }
    ),
}


def equations(accuracy: Accuracy) -> Equations:
    """Those of an edition, for grade 5."""
    return _EQUATIONS[accuracy]


def covered(accuracy: Accuracy) -> Mapping[str, Range | Whole]:
    """The sizes that an edition covers, as magnitudes; one that is not named is not limited."""
    return _COVERED[accuracy]


def grades(accuracy: Accuracy) -> tuple[int, int]:
    """First and last grade of an edition."""
    return _GRADES[accuracy]

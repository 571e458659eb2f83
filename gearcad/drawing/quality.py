"""What the accuracy grade of a gear asks of its surfaces where nobody said otherwise; ours, to be verified for each use.

Roughness and deviations in µm, sizes in mm.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from gearcad.drawing.subject import DrawnGear
from gearcad.errors import ParameterError
from gearcad.geometry import Gear
from gearcad.geometry.iso286 import standard_tolerance
from gearcad.rating.options import RatingOptions

__all__ = ["Roughness", "cylindricity", "face_runout", "flank_roughness", "grade_of", "seat_roughness", "tip_runout"]


class Roughness(NamedTuple):
    """What a roughness is called ("Ra", "Rz") and how large it may be (µm), and whether somebody gave it."""

    parameter: str
    value: float
    given: bool = True

    def text(self, number: str) -> str:
        """With its value as a language writes it."""
        return f"{self.parameter} {number}"


_FLANKS = ((4, 0.4), (6, 0.8), (7, 1.6), (8, 3.2))
"""Ra of flanks up to a grade: values of the preferred series that grinding, fine hobbing and hobbing reach."""

_COARSEST = 6.3

_GROUND = 5
"""Last accuracy grade that is not reached without grinding."""

_RUNOUTS = ((5, 4), (7, 5), (8, 6), (9, 7))
_COARSEST_RUNOUT = 8
"""Tolerance grades of ISO 286 up to an accuracy grade."""


def grade_of(drawn: DrawnGear) -> int:
    """Its accuracy grade, and where nobody gave one that of which ratings go out."""
    return RatingOptions().accuracy_grade if drawn.grade is None else drawn.grade


def flank_roughness(drawn: DrawnGear) -> Roughness:
    """Rz as it was given, else Ra by the grade."""
    given = drawn.gear.flank_roughness if isinstance(drawn.gear, Gear) else None
    if given is not None:
        return Roughness("Rz", given)
    grade = grade_of(drawn)
    return Roughness("Ra", next((value for most, value in _FLANKS if grade <= most), _COARSEST), given=False)


def seat_roughness(drawn: DrawnGear) -> float:
    """Ra of bore, rim and end faces: 0.8 of the grades that are ground, else 1.6."""
    return 0.8 if grade_of(drawn) <= _GROUND else 1.6


def tip_runout(drawn: DrawnGear, diameter: float) -> float | None:
    """Run-out of the tip cylinder: IT of its diameter, of a fineness that goes by the accuracy grade (ours).

    IT4 up to grade 5 (IT5 above 500 mm), IT5 of 6 and 7, IT6 of 8, IT7 of 9, else IT8; None beyond the sizes of ISO 286.
    """
    fineness = next((tolerance for most, tolerance in _RUNOUTS if grade_of(drawn) <= most), _COARSEST_RUNOUT)
    return _tolerance(fineness, diameter) or _tolerance(max(fineness, 5), diameter)


def face_runout(drawn: DrawnGear, diameter: float) -> float | None:
    """Axial run-out of the faces, likewise."""
    return tip_runout(drawn, diameter)


def cylindricity(diameter: float, fit: str) -> float | None:
    """Of a bore or a rim: a quarter of the tolerance of its fit, in whole µm; None without a fit, and beyond ISO 286."""
    grade = re.search(r"\d+", fit)
    tolerance = None if grade is None else _tolerance(int(grade[0]), diameter)
    return None if tolerance is None else max(float(tolerance // 4), 1.0)


def _tolerance(grade: int, size: float) -> float | None:
    try:
        return standard_tolerance(grade, size)
    except ParameterError:
        return None

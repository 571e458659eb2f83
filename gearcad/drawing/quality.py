"""What the accuracy grade of a gear asks of its surfaces where nobody said otherwise; ours, to be verified for each use.

Roughness and deviations in µm, sizes in mm.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from gearcad.drawing.subject import DrawnGear
from gearcad.errors import ParameterError
from gearcad.geometry import Gear, Rack
from gearcad.geometry.iso286 import LARGEST_SIZE, grade_of_class, standard_tolerance
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances import gear_tolerances

__all__ = [
    "Roughness",
    "back_parallelism",
    "blank_runout",
    "cylindricity",
    "flank_roughness",
    "grade_of",
    "hole_position",
    "seat_roughness",
]


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

_POSITION, _STEP, _ROUNDING = 0.035, 0.05, 1e-9
"""Position tolerance of bolt holes over their diameter, its step (mm), and what is nothing of that."""

_GROUND_FIT = 6
"""Last grade of ISO 286 to which bores and rims are ground."""


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


def seat_roughness(drawn: DrawnGear, fit: str = "") -> float:
    """Ra of bore, rim and end faces: 0.8 of the grades that are ground, and with a fit that asks for it, else 1.6."""
    ground = grade_of(drawn) <= _GROUND or (bool(fit) and grade_of_class(fit) <= _GROUND_FIT)
    return 0.8 if ground else 1.6


def blank_runout(drawn: DrawnGear) -> float | None:
    """Run-out of tip cylinder and end faces: half of F_r, the run-out of the teeth by ISO 1328, in whole µm (ours).

    None for a rack, and where the standard does not cover the teeth.
    """
    if not isinstance(drawn.gear, Gear):
        return None
    try:
        teeth = gear_tolerances(drawn.gear, grade_of(drawn), drawn.accuracy).runout
    except ParameterError:
        return None
    return max(float(teeth // 2), 1.0)


def back_parallelism(drawn: DrawnGear, rack: Rack) -> float:
    """Of tips to the back of a rack: the standard tolerance IT of its grade, 5 to 11, for its length."""
    grade = min(max(grade_of(drawn), 5), 11)
    return standard_tolerance(grade, round(min(rack.length, LARGEST_SIZE), 3))


def hole_position(diameter: float) -> float:
    """Of bolt holes: 3.5 % of their diameter in whole 0.05 mm, no more than half the clearance of medium holes (ISO 273)."""
    return max(math.floor(_POSITION * diameter / _STEP + _ROUNDING) * _STEP, _STEP / 2) * 1000


def cylindricity(diameter: float, fit: str) -> float | None:
    """Of a bore or a rim: a quarter of the tolerance of its fit, in whole µm; None without a fit, and beyond ISO 286."""
    if not fit:
        return None
    try:
        return max(float(standard_tolerance(grade_of_class(fit), diameter) // 4), 1.0)
    except ParameterError:
        return None

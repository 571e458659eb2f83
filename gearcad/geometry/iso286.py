"""ISO 286: tolerance grades, and the limit deviations of holes and shafts. Deviations in µm, sizes in mm."""

from __future__ import annotations

import re
from bisect import bisect_left
from typing import NamedTuple

from gearcad.errors import ParameterError, require_number

__all__ = [
    "LARGEST_SIZE",
    "LimitDeviations",
    "grade_of_class",
    "limit_deviations",
    "require_hole",
    "require_shaft",
    "standard_tolerance",
]


class LimitDeviations(NamedTuple):
    """What a size may be off by at the most and at the least (µm)."""

    upper: float
    lower: float


_UP_TO = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000, 1250, 1600, 2000, 2500, 3150)
"""Ranges of sizes; the upper limit belongs to a range."""

LARGEST_SIZE = float(_UP_TO[-1])

_LARGEST_FIT = 500
"""Largest size of which fits are tabled here; h and H, like js and JS, reach as far as their grade."""

_GRADES = {
    1: (0.8, 1, 1, 1.2, 1.5, 1.5, 2, 2.5, 3.5, 4.5, 6, 7, 8),
    2: (1.2, 1.5, 1.5, 2, 2.5, 2.5, 3, 4, 5, 7, 8, 9, 10),
    3: (2, 2.5, 2.5, 3, 4, 4, 5, 6, 8, 10, 12, 13, 15),
    4: (3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27, 32, 36, 40, 47, 55, 65, 78, 96),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40, 44, 50, 56, 66, 78, 92, 110, 135),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63, 70, 80, 90, 105, 125, 150, 175, 210),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97, 110, 125, 140, 165, 195, 230, 280, 330),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155, 175, 200, 230, 260, 310, 370, 440, 540),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250, 280, 320, 360, 420, 500, 600, 700, 860),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400, 440, 500, 560, 660, 780, 920, 1100, 1350),
    12: (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630),
    13: (140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970),
    14: (250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550),
}
"""IT of each grade."""

_CLEARANCE = {
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
}
"""How far below the size a shaft, and above it a hole of that letter, ends."""

_TRANSITION = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}
_FINE_UP_TO = (
    3,
    6,
    10,
    18,
    24,
    30,
    40,
    50,
    65,
    80,
    100,
    120,
    140,
    160,
    180,
    200,
    225,
    250,
    280,
    315,
    355,
    400,
    450,
    500,
)
_INTERFERENCE = {
    "r": (10, 15, 19, 23, 28, 28, 34, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132),
    "s": (14, 19, 23, 28, 35, 35, 43, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140, 158, 170, 190, 208, 232, 252),
    "u": (18, 23, 28, 33, 41, 48, 60, 70, 87, 102, 124, 144, 170, 190, 210, 236, 258, 284, 315, 350, 390, 435, 490, 540),
}
"""How far above the size a shaft of that letter begins, r, s and u in finer ranges."""

_J = {
    5: (-2, -2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    6: (-2, -2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    7: (-4, -4, -5, -6, -8, -10, -12, -15, -18, -21, -26, -28, -32),
}
"""Lower deviation of shafts j5, j6 and j7."""

_DELTA = {
    3: (0, 1, 1, 1, 1.5, 1.5, 2, 2, 3, 3, 4, 4, 5),
    4: (0, 1.5, 1.5, 2, 2, 3, 3, 4, 4, 4, 4, 5, 5),
    5: (0, 1, 2, 3, 3, 4, 5, 5, 6, 6, 7, 7, 7),
    6: (0, 3, 3, 3, 4, 5, 6, 7, 7, 9, 9, 11, 13),
    7: (0, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    8: (0, 6, 7, 9, 12, 14, 16, 19, 23, 26, 29, 32, 34),
}
"""What holes K, M and N to grade 8, and P to U to grade 7, begin higher than the mirrored shaft."""

_CLASS = re.compile(r"([A-Za-z]{1,2})(\d{1,2})")
_LETTERS = ("js", "j", "h", *_CLEARANCE, *_TRANSITION, *_INTERFERENCE)


def standard_tolerance(grade: int, size: float) -> float:
    """IT of a grade (µm). Raises ParameterError for sizes above 500 mm, of grades 5 to 11 above 3150 mm."""
    table = _GRADES[grade]
    require_number("size", size, "mm", above=0, at_most=_UP_TO[len(table) - 1])
    return float(table[bisect_left(_UP_TO, size)])


def limit_deviations(tolerance_class: str, size: float) -> LimitDeviations:
    """Those of a hole ("H7") or a shaft ("g6"): letters d to h, js, j (shafts), k, m, n, p, r, s and u; up to 500 mm.

    Classes js, JS, h and H reach as far as their grade. Raises ParameterError.

    >>> limit_deviations("H7", 40), limit_deviations("g6", 40)
    (LimitDeviations(upper=25.0, lower=0.0), LimitDeviations(upper=-9.0, lower=-25.0))
    """
    letter, grade = _parted(tolerance_class)
    tolerance, hole, small = standard_tolerance(grade, size), letter.isupper(), letter.lower()
    if small == "js":
        return LimitDeviations(tolerance / 2, -tolerance / 2)
    if small == "h":
        return LimitDeviations(tolerance, 0.0) if hole else LimitDeviations(0.0, -tolerance)
    require_number("size", size, "mm", above=0, at_most=_LARGEST_FIT)
    place = bisect_left(_UP_TO, size)
    if small in _CLEARANCE:
        gap = float(_CLEARANCE[small][place])
        return LimitDeviations(gap + tolerance, gap) if hole else LimitDeviations(0.0 - gap, -gap - tolerance)
    if hole:
        upper = _hole_upper(small, grade, size)
        return LimitDeviations(upper, upper - tolerance)
    lower = float(_J[grade][place]) if small == "j" else _shaft_lower(small, grade, size)
    return LimitDeviations(lower + tolerance, lower)


def grade_of_class(tolerance_class: str) -> int:
    """The grade of a class: 7 of "H7". Raises ParameterError."""
    return _parted(tolerance_class)[1]


def require_hole(parameter: str, tolerance_class: str) -> None:
    """Raise ParameterError unless a class is that of a hole, whose letters are capitals."""
    if not tolerance_class[:1].isupper():
        permitted = f'must be the class of a hole, in capitals, such as "{tolerance_class.upper()}"; small letters are shafts'
        raise ParameterError(parameter, tolerance_class, permitted)


def require_shaft(parameter: str, tolerance_class: str) -> None:
    """Raise ParameterError unless a class is that of a shaft, whose letters are small."""
    if not tolerance_class[:1].islower():
        permitted = f'must be the class of a shaft, in small letters, such as "{tolerance_class.lower()}"; capitals are holes'
        raise ParameterError(parameter, tolerance_class, permitted)


def _parted(tolerance_class: str) -> tuple[str, int]:
    """Letter and grade of a class. Raises ParameterError."""
    found = _CLASS.fullmatch(tolerance_class) if isinstance(tolerance_class, str) else None
    if found:
        letter, grade = found[1], int(found[2])
        known = letter.lower() in _LETTERS and letter in (letter.lower(), letter.upper()) and letter != "J"
        if known and grade in (_J if letter == "j" else _GRADES):
            return letter, grade
    permitted = (
        'must be a letter (d to h, js, j, k, m, n, p, r, s, u) and a grade (1 to 14; of j 5 to 7) of ISO 286, as in "H7"'
    )
    raise ParameterError("tolerance_class", tolerance_class, permitted)


def _shaft_lower(letter: str, grade: int, size: float) -> float:
    """Lower deviation of shafts k to u: k is 0 outside of grades 4 to 7."""
    if letter in _INTERFERENCE:
        return float(_INTERFERENCE[letter][bisect_left(_FINE_UP_TO, size)])
    if letter == "k" and not 4 <= grade <= 7:
        return 0.0
    return float(_TRANSITION[letter][bisect_left(_UP_TO, size)])


def _hole_upper(letter: str, grade: int, size: float) -> float:
    """Upper deviation of holes K to U: that of the shaft mirrored, and Δ in fine grades; with what the standard excepts."""
    if letter == "k" and grade > 8:
        return 0.0
    if letter == "n" and grade > 8:
        return -4.0 if size <= 3 else 0.0
    if (letter, grade) == ("m", 6) and 250 < size <= 315:
        return -9.0
    finest = 8 if letter in "kmn" else 7
    lift = _DELTA[grade][bisect_left(_UP_TO, size)] if grade in _DELTA and grade <= finest else 0.0
    # The hole mirrors the shaft of the letter; the 0 of k outside its own grades is the shaft's alone.
    return lift - _shaft_lower(letter, 4 if letter == "k" else grade, size)

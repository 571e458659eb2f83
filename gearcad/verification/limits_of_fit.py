"""Limits of fit by ISO 286-1, from another source than the drawings have them: typed widths, and formulas of the letters.

The widths of the grades 5 to 11 are those that mechguru.com prints ("DIN ISO 286 standard tolerance zone size table"); five
grades more are ten times as wide. Where a letter puts its limit follows from the formulas of ISO 286-1:1988, annex A, with the
geometric mean of the range; the tables round these, so a small difference is permitted.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_left
from dataclasses import dataclass

_RANGES = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000, 1250, 1600, 2000, 2500, 3150)
"""Upper ends of the ranges of sizes (mm), which belong to them."""

_TYPED = """
0 to 3 | 0.004 | 0.006 | 0.010 | 0.014 | 0.025 | 0.040 | 0.060
3 to 6 | 0.005 | 0.008 | 0.012 | 0.018 | 0.030 | 0.048 | 0.075
6 to 10 | 0.006 | 0.009 | 0.015 | 0.022 | 0.036 | 0.058 | 0.090
10 to 18 | 0.008 | 0.011 | 0.018 | 0.027 | 0.043 | 0.070 | 0.110
18 to 30 | 0.009 | 0.013 | 0.021 | 0.033 | 0.052 | 0.084 | 0.130
30 to 50 | 0.011 | 0.016 | 0.025 | 0.039 | 0.062 | 0.100 | 0.160
50 to 80 | 0.013 | 0.019 | 0.030 | 0.046 | 0.074 | 0.120 | 0.190
80 to 120 | 0.015 | 0.022 | 0.035 | 0.054 | 0.087 | 0.140 | 0.220
120 to 180 | 0.018 | 0.025 | 0.040 | 0.063 | 0.100 | 0.160 | 0.250
180 to 250 | 0.020 | 0.029 | 0.046 | 0.072 | 0.115 | 0.185 | 0.290
250 to 315 | 0.023 | 0.032 | 0.052 | 0.081 | 0.130 | 0.210 | 0.320
315 to 400 | 0.025 | 0.036 | 0.057 | 0.089 | 0.140 | 0.230 | 0.360
400 to 500 | 0.027 | 0.040 | 0.063 | 0.097 | 0.155 | 0.250 | 0.400
500 to 630 | 0.032 | 0.044 | 0.070 | 0.110 | 0.175 | 0.280 | 0.440
630 to 800 | 0.036 | 0.050 | 0.080 | 0.125 | 0.200 | 0.320 | 0.500
800 to 1000 | 0.040 | 0.056 | 0.090 | 0.140 | 0.230 | 0.360 | 0.560
1000 to 1250 | 0.047 | 0.066 | 0.105 | 0.165 | 0.260 | 0.420 | 0.660
1250 to 1600 | 0.055 | 0.078 | 0.125 | 0.195 | 0.310 | 0.500 | 0.780
1600 to 2000 | 0.065 | 0.092 | 0.150 | 0.230 | 0.370 | 0.600 | 0.920
2000 to 2500 | 0.078 | 0.110 | 0.175 | 0.280 | 0.440 | 0.700 | 1.100
2500 to 3150 | 0.096 | 0.135 | 0.210 | 0.330 | 0.540 | 0.860 | 1.350
"""
"""Widths (mm) of the grades 5 to 11 by ranges of sizes, as they are printed there."""

_WIDTHS = tuple(tuple(1e3 * float(cell) for cell in line.split("|")[1:]) for line in _TYPED.strip().splitlines())
_FIRST_TYPED, _LAST_TYPED = 5, 11

_COARSEST = 16

_ROUNDED, _LEAST = 0.06, 1.5
"""Share of a limit, and µm, that tables round away of a formula."""

_LOOSE = {"m": 3.5, "p": 3.5}
"""The same (µm) of letters whose formulas are rules with a choice: p is IT7 and 0 to 5 µm; the tables have exceptions of M."""

_NO_RULE = ("n", "p")
"""Letters whose limits do not follow the formulas in the first range."""

_WIDTH = 0.05
"""Difference (µm) of a width: digits of its source."""

_LARGEST_OF_LETTERS = 500
"""Size (mm) up to which the formulas of the letters hold, but those of h and js."""

_CLASS = re.compile(r"(JS|js|[A-HJ-Z]|[a-hj-z])(\d{1,2})")


@dataclass(frozen=True)
class FitLimits:
    """Upper and lower deviation (µm) of a size, and how far (µm) the middle and the width may be off them."""

    upper: float
    lower: float
    place: float
    width: float

    def has(self, upper: float, lower: float) -> bool:
        """Return whether these deviations (µm) are the limits."""
        middle = (upper + lower - self.upper - self.lower) / 2
        return abs((upper - lower) - (self.upper - self.lower)) <= self.width and abs(middle) <= self.place


def is_class(text: str) -> bool:
    """Return whether a text is a tolerance class, such as H7."""
    return _CLASS.fullmatch(text) is not None


def fit_limits(name: str, size: float) -> FitLimits | None:
    """Return the limits of a tolerance class at a size (mm), None for a letter, a grade or a size that is not known here."""
    found = _CLASS.fullmatch(name)
    if found is None or not 0 < size <= _RANGES[-1]:
        return None
    letter, grade = found[1], int(found[2])
    width = _width(grade, size)
    if width is None:
        return None
    if letter in ("JS", "js"):
        return FitLimits(width / 2, -width / 2, _WIDTH, 1.0 + _WIDTH)  # halves of odd widths may be rounded
    if letter in ("H", "h"):
        upper = width if letter == "H" else 0.0
        return FitLimits(upper, upper - width, _WIDTH, _WIDTH)
    ruled = letter.lower() not in _NO_RULE or size > _RANGES[0]
    near = _nearer_limit(letter, grade, size) if ruled and size <= _LARGEST_OF_LETTERS else None
    if near is None:
        return None
    above = (letter.islower() and letter >= "k") or (letter.isupper() and letter < "H")
    upper = near + width if above else near
    place = max(_LOOSE.get(letter.lower(), _LEAST), _ROUNDED * abs(near))
    return FitLimits(upper, upper - width, place, _WIDTH)


def _mean(size: float) -> float:
    """Geometric mean (mm) of the range of a size; the first begins at 1 mm."""
    place = bisect_left(_RANGES, size)
    return math.sqrt((_RANGES[place - 1] if place else 1) * _RANGES[place])


def _width(grade: int, size: float) -> float | None:
    """Width (µm) of a grade at a size (mm)."""
    if _LAST_TYPED < grade <= _COARSEST:
        return 10 * _WIDTHS[bisect_left(_RANGES, size)][grade - _FIRST_TYPED - 5]
    known = _FIRST_TYPED <= grade <= _LAST_TYPED
    return _WIDTHS[bisect_left(_RANGES, size)][grade - _FIRST_TYPED] if known else None


def _nearer_limit(letter: str, grade: int, size: float) -> float | None:
    """Deviation (µm) of the limit nearer to the size; holes mirror shafts, those of interference are shifted by two grades."""
    mean, shaft = _mean(size), letter.lower()
    of_shaft = {
        "d": -16 * mean**0.44,
        "e": -11 * mean**0.41,
        "f": -5.5 * mean**0.41,
        "g": -2.5 * mean**0.34,
        "k": 0.6 * math.cbrt(mean) if 4 <= grade <= 7 else 0.0,
        "n": 5 * mean**0.34,
    }
    widths = [_width(each, size) for each in (6, 7)]
    if widths[0] is not None and widths[1] is not None:
        of_shaft |= {"m": widths[1] - widths[0], "p": widths[1] + 2.5}
    if shaft not in of_shaft:
        return None
    if letter.islower() or letter < "H":
        at_shaft = float(of_shaft[shaft])
        return at_shaft if letter.islower() else -at_shaft
    finer, own = _width(grade - 1, size), _width(grade, size)
    shifted = grade <= (7 if shaft == "p" else 8) and size > _RANGES[0]
    if shifted and (finer is None or own is None):
        return None
    if shaft == "n" and grade > 8:
        return 0.0
    if shaft == "k" and not shifted:
        return None
    shift = own - finer if shifted and own is not None and finer is not None else 0.0
    return shift - (0.6 * math.cbrt(mean) if shaft == "k" else of_shaft[shaft])

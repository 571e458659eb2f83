"""Fits of holes and shafts (ISO 286), tooth thickness (DIN 3967), centre distances (DIN 3964), and the backlash they leave.

Deviations in µm, sizes and backlash in mm.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_left
from typing import Generic, NamedTuple, Protocol

from gearcad.core.errors import GeometryError, ParameterError, require_number
from gearcad.core.quantities import derive, is_given
from gearcad.core.records import PerGear
from gearcad.core.values import Values, arccos, cos, degrees, radians
from gearcad.geometry.involute import involute


class LimitDeviations(NamedTuple):
    """Greatest and least deviation of a size (µm)."""

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
"""Standard tolerance IT of each grade."""

_CLEARANCE = {
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
}
"""Distance (µm) from the size to the nearer limit of that letter: below the size for a shaft, above it for a hole."""

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
"""Distance above the size at which a shaft of that letter begins, r, s and u in finer ranges."""

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
"""Additions by which holes K, M and N to grade 8, and P to U to grade 7, begin higher than the mirrored shaft."""

_CLASS = re.compile(r"([A-Za-z]{1,2})(\d{1,2})")
_LETTERS = ("js", "j", "h", *_CLEARANCE, *_TRANSITION, *_INTERFERENCE)


def standard_tolerance(grade: int, size: float) -> float:
    """IT of a grade (µm). Raises ParameterError for sizes above 500 mm, of grades 5 to 11 above 3150 mm."""
    table = _GRADES[grade]
    require_number("size", size, "mm", above=0, at_most=_UP_TO[len(table) - 1])
    return float(table[bisect_left(_UP_TO, size)])


def limit_deviations(tolerance_class: str, size: float) -> LimitDeviations:
    """Return the limit deviations (µm) of a hole ("H7") or a shaft ("g6") of `size` (mm).

    Letters d to h, js, j (shafts), k, m, n, p, r, s and u are covered, up to 500 mm. Classes js, JS, h and H reach as far as
    their grade. Raises ParameterError.

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
    """Return the grade of a class: 7 of "H7". Raises ParameterError."""
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
    """Return the lower deviation of shafts k to u: k is 0 outside of grades 4 to 7."""
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


THINNING_OR_ALLOWANCE = ("tooth_thinning", "tooth_allowance")
"""Fields of a gear that say how thick its teeth are: one of them, or a thinning and a series of DIN 3967 without its letter."""


class _Toothed(Protocol):
    @property
    def tooth_thinning(self) -> float: ...
    @property
    def tooth_allowance(self) -> str | None: ...
    @property
    def reference_diameter(self) -> float: ...


class ToothAllowance(NamedTuple):
    """Upper and lower allowance A_sne and A_sni of the normal tooth thickness (µm, 0 or negative; of a ring's teeth too)."""

    upper: float
    lower: float

    @property
    def tolerance(self) -> float:
        """T_sn = A_sne - A_sni (µm)."""
        return self.upper - self.lower

    @property
    def mean_thinning(self) -> float:
        """|A_sne + A_sni|/2 in mm: what teeth in the middle of the tolerance are thinner by."""
        return abs(self.upper + self.lower) / 2 / 1000


_TOOTH_ALLOWANCE_UP_TO = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10_000)
"""Ranges of the reference diameter; the upper limit belongs to a range."""

_ROUNDING = 1e-9
"""Relative excess of a diameter over a limit that is rounding."""

_LARGEST = float(_TOOTH_ALLOWANCE_UP_TO[-1])

_UPPER = {
    "a": (100, 135, 180, 250, 330, 450, 600, 820, 1100, 1500, 2000),
    "ab": (85, 110, 150, 200, 280, 370, 500, 680, 920, 1250, 1650),
    "b": (70, 95, 125, 170, 230, 310, 420, 560, 760, 1020, 1350),
    "bc": (58, 75, 105, 140, 190, 260, 340, 460, 620, 840, 1150),
    "c": (48, 65, 85, 115, 155, 210, 290, 390, 520, 700, 940),
    "cd": (40, 54, 70, 95, 130, 175, 240, 320, 430, 580, 780),
    "d": (33, 44, 60, 80, 110, 145, 200, 270, 360, 480, 640),
    "e": (22, 30, 40, 56, 75, 100, 135, 180, 250, 330, 450),
    "f": (10, 14, 19, 26, 35, 48, 64, 85, 115, 155, 210),
    "g": (5, 7, 9, 12, 17, 22, 30, 41, 56, 75, 100),
    "h": (0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0),
}
"""Upper allowance -A_sne of each letter."""

_TOLERANCES = {
    21: (3, 5, 6, 8, 10, 12, 16, 20, 25, 30, 40),
    22: (5, 8, 10, 12, 16, 20, 25, 30, 40, 50, 60),
    23: (8, 12, 16, 20, 25, 30, 40, 50, 60, 80, 100),
    24: (12, 20, 25, 30, 40, 50, 60, 80, 100, 130, 160),
    25: (20, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250),
    26: (30, 50, 60, 80, 100, 130, 160, 200, 250, 300, 400),
    27: (50, 80, 100, 130, 160, 200, 250, 300, 400, 500, 600),
    28: (80, 130, 160, 200, 250, 300, 400, 500, 600, 800, 1000),
    29: (130, 200, 250, 300, 400, 500, 600, 800, 1000, 1300, 1600),
    30: (200, 300, 400, 500, 600, 800, 1000, 1300, 1600, 2000, 2400),
}
"""Tooth thickness tolerance T_sn of each series."""

_NAME = re.compile(f"({'|'.join(_UPPER)})?({'|'.join(map(str, _TOLERANCES))})")


def require_allowance(name: object, parameter: str = "tooth_allowance") -> None:
    """Raise ParameterError unless `name` is a letter and a series of DIN 3967, as in "cd25", or a series alone."""
    if isinstance(name, str) and _NAME.fullmatch(name):
        return
    plain = "".join(name.split()).lower() if isinstance(name, str) else ""
    meant = f' (write "{plain}")' if _NAME.fullmatch(plain) else ""
    letters = (
        'a letter a to h (ab, bc and cd too) and a series 21 to 30 of DIN 3967, such as "cd25"; or, beside tooth_thinning, "25"'
    )
    raise ParameterError(parameter, name, f"must be {letters}{meant}")


def tooth_thickness_allowance(name: str, reference_diameter: float, thinning: float = 0.0) -> ToothAllowance:
    """Return the allowances of "cd25" and its like at a reference diameter d (mm; a ring's may be negative, as ISO 21771 has
    it).

    A series alone, as "25", has its tolerance with the `thinning` (mm) in the middle.
    Raises ParameterError for another name, and beyond 10,000 mm.

    >>> tooth_thickness_allowance("cd25", 82.0)
    ToothAllowance(upper=-70.0, lower=-110.0)
    """
    require_allowance(name)
    require_number("reference_diameter", reference_diameter, "mm", at_least=-_LARGEST, at_most=_LARGEST)
    place = bisect_left(_TOOTH_ALLOWANCE_UP_TO, abs(reference_diameter) * (1 - _ROUNDING))
    letter, tolerance = name[:-2], _TOLERANCES[int(name[-2:])][place]
    upper = 0.0 - _UPPER[letter][place] if letter else round(tolerance / 2 - 1000 * thinning, 9)
    return ToothAllowance(upper, upper - tolerance)


def derive_thinning(gear: _Toothed) -> None:
    """Let the thinning be the mean of the allowance, without one 0.

    Raises GeometryError where both are given, and where a series without a letter has no thinning that makes room for it.
    """
    name = gear.tooth_allowance
    if name is None:
        derive(gear, "tooth_thinning", 0.0)
        return
    if abs(gear.reference_diameter) > _LARGEST:
        permitted = f"must be left out, and tooth_thinning given: DIN 3967 ends at a reference diameter of {_LARGEST:g} mm"
        raise GeometryError("tooth_allowance", name, permitted)
    if len(name) == 2:
        derive(gear, "tooth_thinning", 0.0)
        if (thick := tooth_thickness_allowance(name, gear.reference_diameter, gear.tooth_thinning).upper) > 0:
            least = gear.tooth_thinning + thick / 1000
            permitted = f'must have a letter, as in "cd{name}", or tooth_thinning of at least {least:g} mm beside it'
            raise GeometryError("tooth_allowance", name, permitted)
        return
    mean = tooth_thickness_allowance(name, gear.reference_diameter).mean_thinning
    if is_given(gear.tooth_thinning):
        permitted = f"must be left out where tooth_thinning is given ({gear.tooth_thinning:g} mm): it has a mean of {mean:g} mm"
        raise GeometryError("tooth_allowance", name, permitted)
    derive(gear, "tooth_thinning", mean)


_CLASSES = tuple(f"js{grade}" for grade in range(5, 12))

LARGEST_DISTANCE = 3150.0


def require_class(name: object, parameter: str = "centre_distance_tolerance") -> None:
    """Raise ParameterError unless `name` is one of js5 to js11."""
    if isinstance(name, str) and name in _CLASSES:
        return
    plain = "".join(name.split()).lower() if isinstance(name, str) else ""
    meant = f' (write "{plain}")' if plain in _CLASSES else ""
    raise ParameterError(parameter, name, f'must be one of js5 to js11 of DIN 3964, such as "js7"{meant}')


def centre_distance_allowance(name: str, centre_distance: float) -> float:
    """A_a (µm): half the tolerance grade of ISO 286 at a centre distance (mm; with a ring it may be negative).

    Raises ParameterError for another class, and beyond 3150 mm.
    """
    require_class(name)
    require_number("centre_distance", centre_distance, "mm", at_least=-LARGEST_DISTANCE, at_most=LARGEST_DISTANCE)
    return standard_tolerance(int(name.removeprefix("js")), abs(centre_distance)) / 2


_BACKLASH_ROUNDING = 1e-12
"""Relative difference below which backlash is rounding and is reported as 0."""


def settled(difference: float, size: float) -> float:
    """Return a difference of numbers of that size, 0 where rounding alone is left of it."""
    return 0.0 if abs(difference) <= _BACKLASH_ROUNDING * abs(size) else difference


class Backlash(NamedTuple, Generic[Values]):
    """j_wt along the working pitch circles, and j_bn along the base normal (mm); negative where teeth would overlap."""

    circumferential: Values
    normal: Values


class BacklashLimits(NamedTuple):
    """Backlash at the least, of thick teeth on near axes, and at the most (mm).

    Of the allowances of tooth thickness and, by `centre_distance_allowance` A_a (µm, ±), of the distance; not of deviations of
    flanks and axes, of temperature or of bent shafts.
    """

    centre_distance_allowance: float
    circumferential_least: float
    circumferential_greatest: float
    normal_least: float
    normal_greatest: float


def backlash(
    *,
    teeth: PerGear[Values],
    base_half_angles: PerGear[Values],
    base_diameters: PerGear[Values],
    base_helix_angle: Values,
    centre_distance: Values,
) -> Backlash[Values]:
    """Return the working pitch less both tooth thicknesses on the working pitch circles, of gears at a centre distance."""
    ratio = teeth.wheel / teeth.pinion
    pressure_angle = degrees(arccos((base_diameters.pinion + base_diameters.wheel) / (2 * centre_distance)))
    working = involute(pressure_angle)
    gap = 2 * math.pi / teeth.pinion
    for half_angle, turn in ((base_half_angles.pinion, 1.0), (base_half_angles.wheel, ratio)):
        gap = gap - 2 * turn * (radians(half_angle) - working)
    along = gap * (2 * centre_distance / (1 + ratio)) / 2
    return Backlash(along, along * cos(radians(pressure_angle)) * cos(radians(base_helix_angle)))

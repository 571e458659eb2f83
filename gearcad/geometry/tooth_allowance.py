"""DIN 3967: by how much teeth are made thinner for backlash, and how much that may vary. Allowances in µm, sizes in mm."""

from __future__ import annotations

import re
from bisect import bisect_left
from typing import NamedTuple, Protocol

from gearcad.errors import GeometryError, ParameterError, require_number
from gearcad.geometry.derived import derive, is_given

__all__ = ["THINNING_OR_ALLOWANCE", "ToothAllowance", "derive_thinning", "require_allowance", "tooth_thickness_allowance"]

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


_UP_TO = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10_000)
"""Ranges of the reference diameter; the upper limit belongs to a range."""

_ROUNDING = 1e-9
"""Relative excess of a diameter over a limit that is rounding."""

_LARGEST = float(_UP_TO[-1])

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
"""-A_sne of each letter."""

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
"""T_sn of each series."""

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
    """The allowances of "cd25" and its like at a reference diameter d (mm; a ring's may be negative, as ISO 21771 has it).

    A series alone, as "25", has its tolerance with the `thinning` (mm) in the middle.
    Raises ParameterError for another name, and beyond 10,000 mm.

    >>> tooth_thickness_allowance("cd25", 82.0)
    ToothAllowance(upper=-70.0, lower=-110.0)
    """
    require_allowance(name)
    require_number("reference_diameter", reference_diameter, "mm", at_least=-_LARGEST, at_most=_LARGEST)
    place = bisect_left(_UP_TO, abs(reference_diameter) * (1 - _ROUNDING))
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

"""DIN 6885-1: parallel keys, and the keyways in hubs that go with bores. Lengths in mm."""

from __future__ import annotations

from bisect import bisect_left
from typing import NamedTuple

from gearcad.errors import GeometryError

__all__ = ["LARGEST_BORE", "SMALLEST_BORE", "Keyway", "depth_allowance", "keyway_of"]


class Keyway(NamedTuple):
    """Width b of a keyway, and its depth t2 from the bore outwards."""

    width: float
    depth: float


SMALLEST_BORE = 6.0
"""The first range has it too, as charts of makers do."""

_UP_TO = (8, 10, 12, 17, 22, 30, 38, 44, 50, 58, 65, 75, 85, 95, 110, 130, 150, 170, 200, 230, 260, 290, 330, 380, 440, 500)
"""Ranges of bores; the upper limit belongs to a range."""

LARGEST_BORE = float(_UP_TO[-1])

_WIDTHS = (2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 22, 25, 28, 32, 36, 40, 45, 50, 56, 63, 70, 80, 90, 100)
_DEPTHS = (
    *(1.0, 1.4, 1.8, 2.3, 2.8, 3.3, 3.3, 3.3, 3.8, 4.3, 4.4, 4.9, 5.4, 5.4, 6.4, 7.4, 8.4, 9.4, 10.4, 11.4),
    *(12.4, 12.4, 14.4, 15.4, 17.4, 19.5),
)

_ALLOWANCES = ((6, 100.0), (32, 200.0), (100, 300.0))
"""How much deeper (µm) a keyway may be, up to a width."""


def keyway_of(bore: float) -> Keyway:
    """Of a bore from 6 to 500 mm. Raises GeometryError for another one.

    >>> keyway_of(40.0)
    Keyway(width=12.0, depth=3.3)
    """
    if not SMALLEST_BORE <= bore <= LARGEST_BORE:
        permitted = f"must be from {SMALLEST_BORE:g} to {LARGEST_BORE:g} mm for a keyway of DIN 6885"
        raise GeometryError("bore", bore, permitted, "mm")
    place = bisect_left(_UP_TO, bore)
    return Keyway(float(_WIDTHS[place]), _DEPTHS[place])


def depth_allowance(width: float) -> float | None:
    """Upper deviation (µm) of the depth t2 of a keyway of a width, the lower one is 0; None where no key is so wide."""
    return next((allowance for most, allowance in _ALLOWANCES if width <= most), None)

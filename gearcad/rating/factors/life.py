"""Life factors Z_NT (ISO 6336-2:2006, clause 11) and Y_NT (ISO 6336-3:2006, clause 12): straight lines in log-log.

Points are (load cycles, factor). Before the first the factor is the static one, after the last it stays.
"""

from __future__ import annotations

import math

from gearcad.errors import require_number
from gearcad.material import MaterialGroup
from gearcad.rating.factors.elementwise import Values, chosen, interpolated_in_logs
from gearcad.rating.factors.families import Family, per_family

__all__ = [
    "LONG_LIFE",
    "Points",
    "cycles_at",
    "endurance_cycles",
    "flank_life_factor",
    "flank_points",
    "root_life_factor",
    "root_points",
    "static_cycles",
]

Points = tuple[tuple[float, float], ...]
"""Load cycles and factors, cycles rising, factors not."""

LONG_LIFE = 1e10
"""Load cycles from which on a factor is that of long life."""

_STEEL = (
    Family.STRUCTURAL,
    Family.THROUGH_HARDENED,
    Family.CASE_HARDENED,
    Family.SURFACE_HARDENED,
)
_NITRIDED_AND_IRON = (Family.NITRIDED, Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON)

_FLANK: dict[Family, Points] = per_family(
    {
        _STEEL: ((1e5, 1.6), (5e7, 1.0)),
        _NITRIDED_AND_IRON: ((1e5, 1.3), (2e6, 1.0)),
        (Family.NITROCARBURISED,): ((1e5, 1.1), (2e6, 1.0)),
    }
)
_FLANK_WITH_PITTING: Points = ((6e5, 1.6), (1e7, 1.3), (1e9, 1.0))
"""Of steel; the standard has no such line of others."""

_ROOT: dict[Family, Points] = per_family(
    {
        (Family.STRUCTURAL, Family.THROUGH_HARDENED): ((1e4, 2.5), (3e6, 1.0)),
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): ((1e3, 2.5), (3e6, 1.0)),
        _NITRIDED_AND_IRON: ((1e3, 1.6), (3e6, 1.0)),
        (Family.NITROCARBURISED,): ((1e3, 1.1), (3e6, 1.0)),
    }
)


def flank_points(group: MaterialGroup, *, pitting: bool = False, long_life: float = 0.85) -> Points:
    """Z_NT (table 2): from the static strength over the endurance limit to `long_life` at 10^10 cycles.

    `pitting`: some of it is permitted, which the standard knows of steel that is not nitrided; others take no notice.
    `long_life` is from 0.85, to 1.0 where lubrication, material and experience are best. Raises ParameterError.
    """
    family = Family.of(group)
    points = _FLANK_WITH_PITTING if pitting and family in _STEEL else _FLANK[family]
    return _to_long_life(points, long_life)


def root_points(group: MaterialGroup, *, long_life: float = 0.85) -> Points:
    """Y_NT (table 1): as `flank_points`."""
    return _to_long_life(_ROOT[Family.of(group)], long_life)


def flank_life_factor(cycles: Values, group: MaterialGroup, *, pitting: bool = False, long_life: float = 0.85) -> Values:
    """Z_NT after so many load cycles of a flank, see `flank_points`. Raises ParameterError."""
    return interpolated_in_logs(cycles, flank_points(group, pitting=pitting, long_life=long_life))


def root_life_factor(cycles: Values, group: MaterialGroup, *, long_life: float = 0.85) -> Values:
    """Y_NT after so many load cycles of a root, see `root_points`. Raises ParameterError."""
    return interpolated_in_logs(cycles, root_points(group, long_life=long_life))


def static_cycles(points: Points) -> float:
    """Load cycles up to which the static strength holds."""
    return points[0][0]


def endurance_cycles(points: Points) -> float:
    """Load cycles from which on the endurance limit would hold, were it not for long life: the last corner but one."""
    return points[-2][0]


def cycles_at(factor: Values, points: Points) -> Values:
    """The most load cycles that have a factor: the inverse of the life factor.

    0 for more than the static factor, infinite for that of long life and less.
    """
    rising = [(value, number) for number, value in reversed(points)]
    limited = interpolated_in_logs(factor, rising)
    return chosen(factor > points[0][1], 0.0, chosen(factor <= points[-1][1], math.inf, limited))


def _to_long_life(points: Points, long_life: float) -> Points:
    require_number("long_life", long_life, at_least=0.85, at_most=1.0)
    return (*points, (LONG_LIFE, long_life))

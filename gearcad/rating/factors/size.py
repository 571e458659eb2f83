"""How size tells: Z_X (ISO 6336-2:2006, clause 14; DIN 3990-2) and Y_X (ISO 6336-3:2006, clause 15).

Of static strength both are 1.
"""

from __future__ import annotations

from gearcad.material import MaterialGroup
from gearcad.rating.editions import Edition
from gearcad.rating.factors.elementwise import Values, bounded, chosen
from gearcad.rating.factors.families import Family, per_family

__all__ = ["flank_size_factor", "root_size_factor"]

_FLANK_DIN = per_family(
    {
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): (10.0, 1.05, 0.005, 0.9),
        (Family.NITRIDED, Family.NITROCARBURISED): (7.5, 1.08, 0.011, 0.75),
    }
)
"""Normal module from which on it tells, and a, b and the least of a - b m_n."""

_ROOT = per_family(
    {
        (Family.STRUCTURAL, Family.THROUGH_HARDENED): (1.03, 0.006, 0.85),
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED, Family.NITRIDED, Family.NITROCARBURISED): (1.05, 0.01, 0.8),
        (Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON): (1.075, 0.015, 0.7),
    }
)
"""a, b and the least of a - b m_n; each is 1 at m_n = 5 mm."""


def flank_size_factor(normal_module: Values, group: MaterialGroup, edition: Edition) -> Values:
    """Z_X: 1, but in DIN 3990-2 for large modules (mm) of hardened surfaces, 1.05 - 0.005 m_n or 1.08 - 0.011 m_n."""
    start, a, b, least = (0.0, 1.0, 0.0, 1.0)
    if edition is Edition.DIN_1987:
        start, a, b, least = _FLANK_DIN.get(Family.of(group), (start, a, b, least))
    return chosen(normal_module > start, bounded(a - b * normal_module, least, 1.0), 1.0)


def root_size_factor(normal_module: Values, group: MaterialGroup) -> Values:
    """Y_X (table 3): 1 up to a normal module of 5 mm, then 1.03 - 0.006 m_n and the like, down to a least value."""
    a, b, least = _ROOT[Family.of(group)]
    return bounded(a - b * normal_module, least, 1.0)

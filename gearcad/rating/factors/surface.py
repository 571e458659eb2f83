"""The roughness of the fillet: Y_RrelT of ISO 6336-3:2006, clause 14. Of static strength it is 1."""

from __future__ import annotations

from gearcad.material import MaterialGroup
from gearcad.rating.factors.elementwise import Values, chosen, power
from gearcad.rating.factors.families import Family, per_family

__all__ = ["ROUGHEST", "root_surface_factor"]

ROUGHEST = 40.0
"""Rz (µm) up to which the standard states the formulas."""

_BRITTLE_OR_NITRIDED = (Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON, Family.NITRIDED, Family.NITROCARBURISED)

_COLUMNS = per_family(
    {
        (Family.THROUGH_HARDENED, Family.CASE_HARDENED, Family.SURFACE_HARDENED): (1.12, 1.674, 0.529, 0.1),
        (Family.STRUCTURAL,): (1.07, 5.306, 4.203, 0.01),
        _BRITTLE_OR_NITRIDED: (
            1.025,
            4.299,
            3.259,
            0.0058,
        ),
    }
)
"""Y of smooth fillets; a, b and c of a - b (Rz + 1)^c."""


def root_surface_factor(roughness: Values, group: MaterialGroup) -> Values:
    """Y_RrelT = 1.674 - 0.529 (Rz + 1)^0.1 and the like, Rz of the fillet in µm; below 1 µm a number, 1.12.

    The numbers do not meet at 1 µm: there the standard jumps by 0.004 to 0.013. Beyond `ROUGHEST` the formulas go on.
    """
    smooth, a, b, c = _COLUMNS[Family.of(group)]
    return chosen(roughness < 1, smooth, a - b * power(roughness + 1, c))

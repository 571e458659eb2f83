"""Roots that are not loaded one way only: Y_M of ISO 6336-3:2006, annex B (to be verified but for the three plain values)."""

from __future__ import annotations

from gearcad.errors import ParameterError
from gearcad.material import MaterialGroup
from gearcad.rating.factors.elementwise import Values, bounded
from gearcad.rating.factors.families import Family, is_cast_steel, per_family

__all__ = ["IDLER", "OCCASIONALLY_REVERSED", "ONE_WAY", "mean_stress_factor", "mean_stress_sensitivity"]

ONE_WAY = 1.0
OCCASIONALLY_REVERSED = 0.9
IDLER = 0.7
"""Y_M of idlers and planets, loaded both ways in every turn."""

_LEVEL = per_family(
    {
        (Family.CASE_HARDENED,): (0.8, 0.7),
        (Family.SURFACE_HARDENED,): (0.4, 0.6),
        (Family.NITRIDED, Family.NITROCARBURISED): (0.3, 0.3),
        (Family.STRUCTURAL, Family.THROUGH_HARDENED): (0.3, 0.5),
    }
)
"""M of endurance and of static strength; the former less 0.15 Y_S where case-hardened."""

_CAST_STEEL = (0.4, 0.6)


def mean_stress_factor(stress_ratio: Values, sensitivity: Values) -> Values:
    """Y_M = 1/(1 - R (1 - M)/(1 + M)) (B.2): R is least over greatest stress at the root, and counts up to 0, one way."""
    return 1 / (1 - bounded(stress_ratio, -1e9, 0) * (1 - sensitivity) / (1 + sensitivity))


def mean_stress_sensitivity(
    group: MaterialGroup, stress_correction_factor: Values, *, static: bool = False, shot_peened: bool = False
) -> Values:
    """M (table B.1): how much the mean stress counts. `static` is that of static strength.

    `shot_peened` counts for case-hardened roots. Raises ParameterError for cast iron, of which the annex has none.
    """
    family = Family.of(group)
    if family not in _LEVEL or group in (MaterialGroup.NODULAR_IRON, MaterialGroup.MALLEABLE_IRON):
        raise ParameterError("group", group.value, "must be a steel: ISO 6336-3, annex B has no cast iron")
    hard = family is Family.CASE_HARDENED
    peened = hard and shot_peened
    endurance, ultimate = _CAST_STEEL if is_cast_steel(group) else _LEVEL[Family.SURFACE_HARDENED if peened else family]
    falling = 0.15 if hard and not peened and not static else 0.0
    return (ultimate if static else endurance) - falling * stress_correction_factor

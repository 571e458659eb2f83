"""Dynamic factor K_v by ISO 6336-1:2006, Method C (6.6): for pairs that run well below their main resonance.

Specific load F_t K_A/b in N/mm, speed at the reference circle in m/s. Numbers give a number, arrays broadcast.
"""

from __future__ import annotations

from gearcad.errors import require_whole
from gearcad.rating.editions import Edition
from gearcad.rating.factors.elementwise import Values, chosen, root

__all__ = ["LEAST_LOAD", "STATED", "dynamic_factor_c", "speed_measure", "speed_measure_limit"]

LEAST_LOAD = 100.0
"""Specific load (N/mm) below which Method C takes no notice of it."""

_SPUR = (2.1, 3.9, 7.5, 14.9, 26.8, 39.1, 52.8, 76.6, 102.6, 146.3)
_HELICAL = (1.9, 3.5, 6.7, 13.3, 23.9, 34.8, 47.0, 68.2, 91.4, 130.3)
_FIRST_GRADE, _LAST_GRADE = 3, 12
"""K_1 of grades 3 to 12 of ISO 1328-1:1995."""

STATED = 3.0
"""Speed measure (m/s) up to which Method C is stated for all gears."""

_K2_SPUR, _K2_HELICAL = 0.0193, 0.0087


def speed_measure(speed: Values, teeth: Values, gear_ratio: Values) -> Values:
    """v z_1/100 sqrt(u^2/(1 + u^2)) in m/s: what K_v rises with. Of a ring u is negative."""
    return speed * teeth / 100 * root(gear_ratio**2 / (1 + gear_ratio**2))


def speed_measure_limit(overlap_ratio: float) -> float:
    """Up to where Method C is stated: 3 m/s, and 10 m/s for helical gears with an overlap ratio of at least 1."""
    return 10.0 if overlap_ratio >= 1 else STATED


def dynamic_factor_c(
    specific_load: Values, measure: Values, overlap_ratio: Values, accuracy_grade: int, edition: Edition = Edition.ISO_2006
) -> Values:
    """K_v = 1 + (K_1/(F_t K_A/b) + K_2) K_3 v z_1/100 sqrt(u^2/(1 + u^2)), between spur and helical by eps_beta up to 1.

    `measure` is that of `speed_measure`. K_3 is 2 up to 0.2 m/s of it and 2.071 - 0.357 times it up to 3 m/s, where it is 1 and
    stays so: the printed line would let K_v fall from there on, below 1 at last. DIN 3990-1 has no K_3. Raises ParameterError
    for an accuracy grade below 3.
    """
    require_whole("accuracy_grade", accuracy_grade, at_least=_FIRST_GRADE, at_most=_LAST_GRADE)
    load = chosen(specific_load > LEAST_LOAD, specific_load, LEAST_LOAD)
    k_3 = chosen(measure <= 0.2, 2.0, chosen(measure < STATED, 2.071 - 0.357 * measure, 1.0))
    factor = measure if edition is Edition.DIN_1987 else measure * k_3
    spur = 1 + (_SPUR[accuracy_grade - _FIRST_GRADE] / load + _K2_SPUR) * factor
    helical = 1 + (_HELICAL[accuracy_grade - _FIRST_GRADE] / load + _K2_HELICAL) * factor
    return spur - chosen(overlap_ratio < 1, overlap_ratio, 1.0) * (spur - helical)

"""Tolerances of flanks by ISO 1328-1. Deviations in µm, lengths in mm.

A grade more is the square root of 2 more; values are rounded as the standard has them. A grade of 1995 and the class of 2013
of the same number are not the same tolerance.
"""

from __future__ import annotations

import math
from enum import StrEnum
from typing import NamedTuple

from gearcad.errors import require_number, require_whole

__all__ = ["Accuracy", "FlankTolerances", "flank_tolerances", "grades"]

_FIFTH = 5
"""The grade that the equations hold for."""

_DIAMETERS = (5, 20, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6000, 8000, 10000)
_MODULES = (0.5, 2, 3.5, 6, 10, 16, 25, 40, 70)
"""Ranges of 1995; the upper limit belongs to a range."""


class Accuracy(StrEnum):
    """The editions of the standard, whose grades are not the same."""

    ISO_1995 = "ISO 1328-1:1995"
    """Accuracy grades 0 to 12, to which ISO 6336:2006 refers."""

    ISO_2013 = "ISO 1328-1:2013"
    """Flank tolerance classes 1 to 11."""


class FlankTolerances(NamedTuple):
    """Tolerances (µm): f_pt, F_p, f_Halpha and f_falpha; f_pT, F_pT, f_HalphaT and f_falphaT of 2013."""

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float


def grades(accuracy: Accuracy) -> tuple[int, int]:
    """First and last grade of an edition."""
    return (0, 12) if accuracy is Accuracy.ISO_1995 else (1, 11)


def flank_tolerances(
    accuracy_grade: int, reference_diameter: float, normal_module: float, accuracy: Accuracy = Accuracy.ISO_1995
) -> FlankTolerances:
    """For d from 5 to 10,000 mm (15,000 mm in 2013) and m_n from 0.5 to 70 mm. Raises ParameterError beyond."""
    first, last = grades(accuracy)
    require_whole("accuracy_grade", accuracy_grade, at_least=first, at_most=last)
    old = accuracy is Accuracy.ISO_1995
    require_number("reference_diameter", reference_diameter, "mm", at_least=5, at_most=10_000 if old else 15_000)
    require_number("normal_module", normal_module, "mm", at_least=0.5, at_most=70)
    fifth = _fifth_1995(reference_diameter, normal_module) if old else _fifth_2013(reference_diameter, normal_module)
    return FlankTolerances(*(_rounded(each * math.sqrt(2) ** (accuracy_grade - _FIFTH)) for each in fifth))


def _fifth_1995(reference_diameter: float, normal_module: float) -> tuple[float, float, float, float]:
    """Annex A of ISO 1328-1:1995: by the geometric means of the ranges that d and m_n lie in."""
    d, m_n = _mean(reference_diameter, _DIAMETERS), _mean(normal_module, _MODULES)
    return (
        0.3 * (m_n + 0.4 * math.sqrt(d)) + 4,
        0.3 * m_n + 1.25 * math.sqrt(d) + 7,
        2 * math.sqrt(m_n) + 0.14 * math.sqrt(d) + 0.5,
        2.5 * math.sqrt(m_n) + 0.17 * math.sqrt(d) + 0.5,
    )


def _fifth_2013(d: float, m_n: float) -> tuple[float, float, float, float]:
    """ISO 1328-1:2013, (5) to (8)."""
    return (
        0.001 * d + 0.4 * m_n + 5,
        0.002 * d + 0.55 * math.sqrt(d) + 0.7 * m_n + 12,
        0.4 * m_n + 0.001 * d + 4,
        0.55 * m_n + 5,
    )


def _mean(value: float, limits: tuple[float, ...]) -> float:
    """Geometric mean of the range that holds a value."""
    upper = next(number for number, limit in enumerate(limits[1:], 1) if value <= limit)
    return math.sqrt(limits[upper - 1] * limits[upper])


def _rounded(value: float) -> float:
    """To whole µm above 10, to halves from 5, to tenths below."""
    step = 1.0 if value > 10 else 0.5 if value >= 5 else 0.1
    return round(math.floor(value / step + 0.5) * step, 1)

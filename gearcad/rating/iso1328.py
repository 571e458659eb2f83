"""Tolerances of flanks by ISO 1328-1. Deviations in µm, lengths in mm."""

from __future__ import annotations

import math
from typing import NamedTuple

from gearcad.errors import require_number, require_whole

__all__ = ["FlankTolerances", "flank_tolerances"]


class FlankTolerances(NamedTuple):
    """Tolerances (µm) of ISO 1328-1:2013: f_pT, F_pT, f_HalphaT and f_falphaT."""

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float


def flank_tolerances(tolerance_class: int, reference_diameter: float, normal_module: float) -> FlankTolerances:
    """ISO 1328-1:2013, equations (5) to (8), not rounded; classes 1 to 11, d from 5 to 15,000 mm, m_n from 0.5 to 70 mm."""
    require_whole("tolerance_class", tolerance_class, at_least=1, at_most=11)
    require_number("reference_diameter", reference_diameter, "mm", at_least=5, at_most=15000)
    require_number("normal_module", normal_module, "mm", at_least=0.5, at_most=70)
    d, m_n, step = reference_diameter, normal_module, math.sqrt(2) ** (tolerance_class - 5)
    return FlankTolerances(
        (0.001 * d + 0.4 * m_n + 5) * step,
        (0.002 * d + 0.55 * math.sqrt(d) + 0.7 * m_n + 12) * step,
        (0.4 * m_n + 0.001 * d + 4) * step,
        (0.55 * m_n + 5) * step,
    )

"""Tolerances of flanks by ISO 1328-1 that go by diameter and module alone. Deviations in µm, lengths in mm.

A grade more is the square root of 2 more; values are rounded as the standard has them. A grade of 1995 and the class of 2013
of the same number are not the same tolerance.
"""

from __future__ import annotations

from typing import NamedTuple

from gearcad.rating.tolerances.editions import Accuracy
from gearcad.rating.tolerances.gear_tolerances import GearTolerances

__all__ = ["FlankTolerances", "flank_tolerances"]


class FlankTolerances(NamedTuple):
    """Tolerances (µm): f_pt, F_p, f_Halpha and f_falpha; f_pT, F_pT, f_HalphaT and f_falphaT of 2013."""

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float


_ANY_TEETH, _ANY_WIDTH = 20, 10.0
"""Which none of these tolerances minds."""


def flank_tolerances(
    accuracy_grade: int, reference_diameter: float, normal_module: float, accuracy: Accuracy = Accuracy.ISO_1995
) -> FlankTolerances:
    """For d from 5 to 10,000 mm (15,000 mm in 2013) and m_n from 0.5 to 70 mm. Raises ParameterError beyond."""
    of = GearTolerances[float](
        accuracy=accuracy,
        grade=accuracy_grade,
        teeth=_ANY_TEETH,
        reference_diameter=reference_diameter,
        normal_module=normal_module,
        face_width=_ANY_WIDTH,
        helix_angle=0.0,
    )
    return FlankTolerances(of.single_pitch, of.cumulative_pitch, of.profile_slope, of.profile_form)

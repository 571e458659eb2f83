"""Deviations of the flanks of a pair that a rating goes by: those given, else the tolerances of the gears' grades. In µm."""

from __future__ import annotations

import math
from functools import lru_cache

from gearcad.geometry import Gear, GearPair
from gearcad.per_gear import PerGear, Role
from gearcad.rating.both import both
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances import FlankTolerances, flank_tolerances, gear_tolerances

__all__ = [
    "accuracy_grades",
    "base_pitch_deviations",
    "helix_slope_deviations",
    "helix_slopes_of_grade_five",
    "profile_form_deviations",
]

_FIFTH = 5


def accuracy_grades(pair: GearPair, options: RatingOptions) -> PerGear[int]:
    """Each gear's own grade, else that of the options."""
    return pair.gears.map(options.grade_of)


def base_pitch_deviations(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_pb = f_pt cos alpha_t. Raises ParameterError as `flank_tolerances` does."""
    if options.base_pitch_deviation is not None:
        return both(options.base_pitch_deviation)
    across = math.cos(math.radians(pair.pinion.transverse_pressure_angle))
    return _tolerances(pair, options).map(lambda each: across * each.single_pitch)


def profile_form_deviations(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_falpha. Raises ParameterError as `flank_tolerances` does."""
    if options.profile_form_deviation is not None:
        return both(options.profile_form_deviation)
    return _tolerances(pair, options).map(lambda each: each.profile_form)


def helix_slope_deviations(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_Hbeta. Raises ParameterError for sizes that the standard does not cover."""
    if options.helix_slope_deviation is not None:
        return both(options.helix_slope_deviation)
    grades = accuracy_grades(pair, options)

    def of(role: Role) -> float:
        return gear_tolerances(pair.gears.pick(role), grades.pick(role), options.accuracy).helix_slope

    return PerGear.each(of)


def helix_slopes_of_grade_five(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_Hbeta5, whatever the grades of the gears. Raises ParameterError for sizes that the standard does not cover."""
    return pair.gears.map(lambda gear: gear_tolerances(gear, _FIFTH, options.accuracy).helix_slope)


def _tolerances(pair: GearPair, options: RatingOptions) -> PerGear[FlankTolerances]:
    grades = accuracy_grades(pair, options)

    def of(gear: Gear, grade: int) -> FlankTolerances:
        return _of_sizes(grade, abs(gear.reference_diameter), gear.normal_module, options.accuracy)

    return PerGear.each(lambda role: of(pair.gears.pick(role), grades.pick(role)))


_of_sizes = lru_cache(64)(flank_tolerances)
"""Known for the last gears: loads of a spectrum and torques that are sought ask for them again."""

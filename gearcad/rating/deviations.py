"""Deviations of the flanks of a pair that a rating goes by: those given, else the tolerances of the gears' grades. In µm."""

from __future__ import annotations

import math

from gearcad.geometry import Gear, GearPair
from gearcad.per_gear import PerGear
from gearcad.rating.both import both
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances import FlankTolerances, flank_tolerances

__all__ = ["accuracy_grades", "base_pitch_deviations", "profile_form_deviations"]


def accuracy_grades(pair: GearPair, options: RatingOptions) -> PerGear[int]:
    """Each gear's own grade, else that of the options."""
    return pair.gears.map(lambda gear: options.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade)


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


def _tolerances(pair: GearPair, options: RatingOptions) -> PerGear[FlankTolerances]:
    grades = accuracy_grades(pair, options)

    def of(gear: Gear, grade: int) -> FlankTolerances:
        return flank_tolerances(grade, abs(gear.reference_diameter), gear.normal_module, options.accuracy)

    return PerGear.each(lambda role: of(pair.gears.pick(role), grades.pick(role)))

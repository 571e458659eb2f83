"""Load factors of many pairs at once, by the functions of `rating.load_factors`: what `LoadFactors.of` has for one pair.

Deviations in µm, loads per face width in N/mm. Each factor sees the load times all those before it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools
from gearcad.per_gear import PerGear, Role
from gearcad.rating.both import Both, both
from gearcad.rating.dynamic_factor import flank_wear
from gearcad.rating.face_load import face_load_factor, root_face_load_factor
from gearcad.rating.load_factor_options import AlphaDeviation, ContactPattern
from gearcad.rating.load_factors.below_resonance import dynamic_factor_c, speed_measure
from gearcad.rating.load_factors.masses import body_mass, pair_mass
from gearcad.rating.load_factors.misalignment import (
    UNLOADED_ENDS,
    arrangement_factor,
    helix_factors,
    initial_misalignment,
    least_misalignment,
    manufacturing_misalignment,
    proven_misalignment,
    shaft_deflection,
    shaft_term,
)
from gearcad.rating.load_factors.transverse import flank_limit, root_limit, transverse_load_factor, within
from gearcad.rating.options import RatingOptions
from gearcad.rating.resonance import dynamic_factor_b, resonance_speed
from gearcad.rating.running_in import FlankWear, running_in_relief
from gearcad.rating.tolerances import GearTolerances
from gearcad.sizing.columns import Numbers
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.stresses import NominalStresses
from gearcad.sizing.task import SizeTask

__all__ = ["ManyLoadFactors"]

_FINE = 5
"""The coarsest accuracy grade whose tip relief, from running in, counts."""

_FIFTH = 5
"""The accuracy grade whose f_Hbeta stands for what lies opposite to the deflection of the shafts (7.5, (53))."""


@dataclass(frozen=True)
class ManyLoadFactors:
    """Of pairs with face widths under the load of a task, by its options. `nominal` has their stiffness."""

    task: SizeTask
    nominal: NominalStresses

    @property
    def pairs(self) -> ManyPairs:
        """The pairs."""
        return self.nominal.pairs

    @property
    def _options(self) -> RatingOptions:
        return self.task.rating

    @cached_property
    def _wear(self) -> FlankWear:
        return flank_wear(self.task.materials)

    @cached_property
    def speed(self) -> Numbers:
        """v (m/s) at the reference circle."""
        return math.pi * self.pairs.diameters.pinion * abs(self.task.load.speed) / 60_000

    @cached_property
    def outer_load(self) -> Numbers:
        """F_t K_A K_gamma/b."""
        return self.nominal.specific_load

    @cached_property
    def total_contact_ratio(self) -> Numbers:
        """eps_gamma."""
        return self.pairs.contact_ratio + self.nominal.overlap_ratio

    # ------------------------------------------------------------------ deviations

    def _tolerances(self, grade: int) -> PerGear[GearTolerances[Numbers]]:
        """Of both gears; nan where the standard has none."""
        pairs, accuracy = self.pairs, self._options.accuracy

        def of(teeth: Numbers, diameter: Numbers) -> GearTolerances[Numbers]:
            return GearTolerances(
                accuracy=accuracy,
                grade=grade,
                teeth=teeth,
                reference_diameter=diameter,
                normal_module=pairs.normal_module,
                face_width=self.nominal.width,
                helix_angle=pairs.helix_angle,
            )

        return PerGear(*map(of, pairs.teeth, pairs.diameters))

    def _deviations(self, given: Both | None, tolerance: Callable[[GearTolerances[Numbers]], Numbers]) -> PerGear[Numbers]:
        """Those given, else those of the grade."""
        if given is not None:
            return PerGear(*(np.asarray(value, float) for value in both(given)))
        return PerGear(*map(tolerance, self._tolerances(self._options.accuracy_grade)))

    @cached_property
    def base_pitch_deviation(self) -> Numbers:
        """f_pb, the larger of both gears."""
        across = np.cos(self.pairs.transverse_angle)
        return _larger(self._deviations(self._options.base_pitch_deviation, lambda each: across * each.single_pitch))

    @cached_property
    def profile_form_deviation(self) -> Numbers:
        """f_falpha, the larger of both gears."""
        return _larger(self._deviations(self._options.profile_form_deviation, lambda each: each.profile_form))

    @cached_property
    def helix_slope_deviations(self) -> PerGear[Numbers]:
        """f_Hbeta."""
        return self._deviations(self._options.helix_slope_deviation, lambda each: each.helix_slope)

    @property
    def known(self) -> Bools:
        """Where the standard has all tolerances that the factors go by."""
        options = self._options
        needed: list[Numbers] = []
        if options.face_load_factor == "C":
            needed += self.helix_slope_deviations
        if options.dynamic_factor == "B" or options.transverse_load_factor == "B":
            needed += [self.base_pitch_deviation, self.profile_form_deviation]
        result: Bools = np.isfinite(sum(needed, np.zeros_like(self.outer_load)))
        return result

    # ------------------------------------------------------------------ K_v

    @cached_property
    def dynamic(self) -> Numbers:
        """K_v."""
        method = self._options.dynamic_factor
        if method == "C":
            measure = speed_measure(self.speed, self.pairs.teeth.pinion, self.pairs.ratio)
            grade, edition = self._options.accuracy_grade, self._options.standard
            return dynamic_factor_c(self.outer_load, measure, self.nominal.overlap_ratio, grade, edition)
        return self._by_resonance if method == "B" else np.full_like(self.outer_load, method)

    @property
    def _by_resonance(self) -> Numbers:
        f_pb, f_fa, stiff = self.base_pitch_deviation, self.profile_form_deviation, self.nominal.single / self.outer_load
        resonance = resonance_speed(self.pairs.teeth.pinion, self.nominal.mesh_alpha, self.mass)
        return dynamic_factor_b(
            abs(self.task.load.speed) / resonance,
            self.outer_load,
            self.total_contact_ratio,
            pitch_effect=stiff * (f_pb - self._wear.alpha(f_pb, self.speed)),
            profile_effect=stiff * (f_fa - self._wear.alpha(f_fa, self.speed)),
            relief_effect=np.abs(1 - stiff * self._tip_relief),
        )

    @cached_property
    def mass(self) -> Numbers:
        """m_red (kg/mm) of both bodies, solid discs."""
        return pair_mass(self._body(Role.PINION), self._body(Role.WHEEL))

    def _body(self, role: Role) -> Numbers:
        sizes = (self.pairs.tip_diameters, self.pairs.root_diameters, self.pairs.base_diameters)
        tip, root, base = (each.pick(role) for each in sizes)
        solid: Numbers = 0.0
        density: Numbers = self.task.materials.pick(role).density
        return body_mass(tip, root, base, solid, density)

    @property
    def _tip_relief(self) -> float:
        """C_a (µm) that running in makes, which counts for fine grades alone."""
        limits = [each.contact or 0.0 for each in self.task.limits]
        return 0.0 if self._options.accuracy_grade > _FINE else sum(map(running_in_relief, limits)) / 2

    # ------------------------------------------------------------------ K_Hbeta, K_Fbeta

    @cached_property
    def _mean_load(self) -> Numbers:
        """F_m/b."""
        return self.outer_load * self.dynamic

    @cached_property
    def face_flank(self) -> Numbers:
        """K_Hbeta."""
        given = self._options.face_load_factor
        if not isinstance(given, str):
            return np.full_like(self.outer_load, given)
        initial = self._misalignment
        left = initial - self._wear.beta(initial, self.speed)
        return face_load_factor(left, 0.85 * self.nominal.mesh_alpha, self._mean_load)

    @property
    def _misalignment(self) -> Numbers:
        """F_beta_x."""
        options, slopes = self._options, self.helix_slope_deviations
        factors = helix_factors(options.helix_modification, options.standard)
        least = least_misalignment(self._mean_load, _larger(slopes))
        if options.contact_pattern is ContactPattern.PROVEN:
            pinion, wheel = (each.helix_slope for each in self._tolerances(_FIFTH))
            fifth: Numbers = np.minimum(pinion, wheel)
            compensation = options.given_compensation
            return proven_misalignment(self._deflection, fifth if compensation is None else compensation, factors, least)
        given = options.manufacturing_misalignment
        made = manufacturing_misalignment(*slopes) if given is None else given
        return initial_misalignment(self._deflection, made, factors, least)

    @property
    def _deflection(self) -> Numbers:
        """f_sh."""
        options, d_1 = self._options, self.pairs.diameters.pinion
        if options.shaft_deflection is not None:
            return options.shaft_deflection
        bent: Numbers = 0.0
        if options.pinion_offset and options.bearing_span is not None and options.shaft_diameter is not None:
            shaft = options.shaft_diameter
            place = arrangement_factor(options.pinion_place, options.stiffening, d_1 / shaft)
            bent = shaft_term(place, options.bearing_span, options.pinion_offset, d_1, shaft)
        compliance = helix_factors(options.helix_modification, options.standard).compliance
        return shaft_deflection(self._mean_load, self.nominal.width, d_1, shaft_term=bent, compliance=compliance)

    @property
    def face_root(self) -> Numbers:
        """K_Fbeta."""
        if self._options.helix_modification in UNLOADED_ENDS:
            return self.face_flank
        pairs = self.pairs
        tips = zip(pairs.tip_diameters, pairs.root_diameters, strict=True)
        height = _larger(PerGear(*((tip - root) / 2 for tip, root in tips)))
        return root_face_load_factor(self.face_flank, self.nominal.width / height)

    # ------------------------------------------------------------------ K_Halpha, K_Falpha

    @cached_property
    def _transverse(self) -> Numbers:
        f_pb, f = self.base_pitch_deviation, np.maximum(self.base_pitch_deviation, self.profile_form_deviation)
        runs_in = f_pb if self._options.alpha_deviation_rule is AlphaDeviation.KISSSOFT_2017 else f
        worn, load = self._wear.alpha(runs_in, self.speed), self._mean_load * self.face_flank
        return transverse_load_factor(self.total_contact_ratio, self.nominal.mesh_alpha, f, worn, load)

    @property
    def transverse_flank(self) -> Numbers:
        """K_Halpha."""
        given, ratio = self._options.transverse_load_factor, self.pairs.contact_ratio
        if not isinstance(given, str):
            return np.full_like(self.outer_load, given)
        limit = flank_limit(self.total_contact_ratio, ratio, self.nominal.contact_ratio_factor)
        return within(self._transverse, limit)

    @property
    def transverse_root(self) -> Numbers:
        """K_Falpha."""
        given = self._options.transverse_load_factor
        if not isinstance(given, str):
            return np.full_like(self.outer_load, given)
        return within(self._transverse, root_limit(self.total_contact_ratio, self.pairs.contact_ratio))

    # ------------------------------------------------------------------ all of them

    @cached_property
    def flank(self) -> Numbers:
        """K_A K_gamma K_v K_Hbeta K_Halpha."""
        return self.nominal.outer_factor * self.dynamic * self.face_flank * self.transverse_flank

    @cached_property
    def root(self) -> Numbers:
        """K_A K_gamma K_v K_Fbeta K_Falpha."""
        return self.nominal.outer_factor * self.dynamic * self.face_root * self.transverse_root


def _larger(values: PerGear[Numbers]) -> Numbers:
    """The larger of both gears."""
    result: Numbers = np.maximum(values.pinion, values.wheel)
    return result

"""Rating of many variants at once: load factors, safeties, masses and temperatures.

Deviations in µm, loads per face width in N/mm. Each factor sees the load times all those before it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from gearcad.core.records import Bools, Floats, Indices, PerGear, Role, Wholes
from gearcad.core.values import Numbers
from gearcad.geometry.tooth_friction import loss_factors
from gearcad.rating.dynamic_factor import effective_relief, flank_wear
from gearcad.rating.editions import Both, both
from gearcad.rating.friction import mean_coefficient
from gearcad.rating.load_factor_formulas import (
    UNLOADED_ENDS,
    DeviationEffects,
    FlankWear,
    body_mass,
    circumferential_speed,
    dynamic_factor_b,
    dynamic_factor_c,
    face_load_factor,
    flank_limit,
    pair_mass,
    resonance_speed,
    root_face_load_factor,
    root_limit,
    speed_measure,
    transverse_load_factor,
    within,
)
from gearcad.rating.load_factors import Misalignment, alpha_deviations, deflection_of
from gearcad.rating.options import RatingOptions
from gearcad.rating.scuffing import RZ_OVER_RA, USUAL_ROUGHNESS
from gearcad.rating.scuffing_temperatures import (
    LUBRICATION,
    IntegralTemperature,
    Oil,
    SlidingMesh,
    mating_factor,
    thermo_elastic_factor,
)
from gearcad.rating.tolerances import GearTolerances
from gearcad.sizing.geometry import Columns, ManyPairs
from gearcad.sizing.stresses import NominalStresses, Strengths
from gearcad.sizing.task import SizeTask

_FIFTH = 5
"""The accuracy grade whose f_Hbeta stands for what lies opposite to the deflection of the shafts (7.5, (53))."""


@dataclass(frozen=True)
class ManyLoadFactors:
    """Load factors of pairs with face widths under the load of a task, by its options. `nominal` has their stiffness."""

    task: SizeTask
    nominal: NominalStresses

    @property
    def pairs(self) -> ManyPairs:
        """The pairs that are rated."""
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
        return circumferential_speed(self.pairs.diameters.pinion, self.task.load.speed)

    @cached_property
    def outer_load(self) -> Numbers:
        """F_t K_A K_gamma/b."""
        return self.nominal.specific_load

    @cached_property
    def total_contact_ratio(self) -> Numbers:
        """Total contact ratio eps_gamma."""
        return self.pairs.contact_ratio + self.nominal.overlap_ratio

    # ------------------------------------------------------------------ deviations

    def _tolerances(self, grade: int) -> PerGear[GearTolerances[Numbers]]:
        """Return the tolerances of both gears; nan where the standard has none."""
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
        """Return the given deviations (µm) of both gears, or else those of the accuracy grade."""
        if given is not None:
            return PerGear(*(np.asarray(value, float) for value in both(given)))
        return PerGear(*map(tolerance, self._tolerances(self._options.accuracy_grade)))

    @cached_property
    def base_pitch_deviation(self) -> Numbers:
        """f_pb, the larger of both gears."""
        across = np.cos(np.radians(self.pairs.gears.pinion.transverse_pressure_angle))
        return _larger(self._deviations(self._options.base_pitch_deviation, lambda each: across * each.single_pitch))

    @cached_property
    def profile_form_deviation(self) -> Numbers:
        """f_falpha, the larger of both gears."""
        return _larger(self._deviations(self._options.profile_form_deviation, lambda each: each.profile_form))

    @cached_property
    def helix_slope_deviations(self) -> PerGear[Numbers]:
        """Helix slope deviations f_Hbeta (µm)."""
        return self._deviations(self._options.helix_slope_deviation, lambda each: each.helix_slope)

    @property
    def known(self) -> Bools:
        """Mask of the variants for which the standard has all tolerances that the factors depend on."""
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
        """Dynamic factor K_v."""
        method = self._options.dynamic_factor
        if method == "C":
            measure = speed_measure(self.speed, self.pairs.teeth.pinion, self.pairs.gear_ratio)
            grade, edition = self._options.accuracy_grade, self._options.standard
            return dynamic_factor_c(self.outer_load, measure, self.nominal.overlap_ratio, grade, edition)
        return self._by_resonance if method == "B" else np.full_like(self.outer_load, method)

    @property
    def _by_resonance(self) -> Numbers:
        f_pb, f_fa, stiffness = self.base_pitch_deviation, self.profile_form_deviation, self.nominal.stiffness
        pitch, profile, relief = DeviationEffects.of(
            stiffness.single,
            self.outer_load,
            f_pb - self._wear.alpha(f_pb, self.speed),
            f_fa - self._wear.alpha(f_fa, self.speed),
            effective_relief(self.task.limits, self._options.accuracy_grade),
        )
        return dynamic_factor_b(
            abs(self.task.load.speed) / resonance_speed(self.pairs.teeth.pinion, stiffness.mesh_alpha, self.mass),
            self.outer_load,
            self.total_contact_ratio,
            pitch_effect=pitch,
            profile_effect=profile,
            relief_effect=relief,
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

    # ------------------------------------------------------------------ K_Hbeta, K_Fbeta

    @cached_property
    def _mean_load(self) -> Numbers:
        """Mean load F_m/b (N/mm)."""
        return self.outer_load * self.dynamic

    @cached_property
    def face_flank(self) -> Numbers:
        """Face load factor K_Hbeta of the flanks."""
        given = self._options.face_load_factor
        if not isinstance(given, str):
            return np.full_like(self.outer_load, given)
        options = self._options
        deflection = deflection_of(options, self._mean_load, self.nominal.width, self.pairs.diameters.pinion)
        initial = Misalignment.from_options(
            options, deflection, self.helix_slope_deviations, self._slopes_of_grade_five, self._mean_load
        ).initial
        left = initial - self._wear.beta(initial, self.speed)
        stiffness = self.nominal.stiffness.mesh_beta if options.face_mesh_stiffness is None else options.face_mesh_stiffness
        return face_load_factor(left, stiffness, self._mean_load)

    def _slopes_of_grade_five(self) -> PerGear[Numbers]:
        return self._tolerances(_FIFTH).map(lambda each: each.helix_slope)

    @property
    def face_root(self) -> Numbers:
        """Face load factor K_Fbeta of the roots."""
        if self._options.helix_modification in UNLOADED_ENDS:
            return self.face_flank
        pairs = self.pairs
        tips = zip(pairs.tip_diameters, pairs.root_diameters, strict=True)
        height = _larger(PerGear(*((tip - root) / 2 for tip, root in tips)))
        return root_face_load_factor(self.face_flank, self.nominal.width / height)

    # ------------------------------------------------------------------ K_Halpha, K_Falpha

    @cached_property
    def _transverse(self) -> Numbers:
        f, running_in = alpha_deviations(self._options, self.base_pitch_deviation, self.profile_form_deviation)
        worn, load = self._wear.alpha(running_in, self.speed), self._mean_load * self.face_flank
        return transverse_load_factor(self.total_contact_ratio, self.nominal.stiffness.mesh_alpha, f, worn, load)

    @property
    def transverse_flank(self) -> Numbers:
        """Transverse load factor K_Halpha of the flanks."""
        given, ratio = self._options.transverse_load_factor, self.pairs.contact_ratio
        if not isinstance(given, str):
            return np.full_like(self.outer_load, given)
        limit = flank_limit(self.total_contact_ratio, ratio, self.nominal.contact_ratio_factor)
        return within(self._transverse, limit)

    @property
    def transverse_root(self) -> Numbers:
        """Transverse load factor K_Falpha of the roots."""
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
    """Return the larger of both gears."""
    result: Numbers = np.maximum(values.pinion, values.wheel)
    return result


FLANK, ROOT, SCUFFING, MASS = REQUIRED = ("flank safety", "root safety", "scuffing safety", "mass")
"""Requirements of variants that have a rating, in words."""


@dataclass(frozen=True, kw_only=True)
class Rated(Columns):
    """Pairs with a face width `width` (mm), arrays (n,). `order` is the place of each in the whole search.

    `flank_safeties` S_H, `root_safeties` S_F; `margin` is the least of S_H/S_Hmin and S_F/S_Fmin, `mass` (kg) that of both
    gears, `temperature` (°C) the integral temperature, nan without a speed, `load_factors` K_A K_gamma K_v K_Hbeta K_Halpha.
    `efficiency` of the mesh is nan where Ohlendorf's loss factor does not hold, None without friction.
    """

    order: Wholes
    pairs: ManyPairs
    width: Floats
    mass: Floats
    overlap_ratio: Floats
    flank_safeties: PerGear[Floats]
    root_safeties: PerGear[Floats]
    margin: Floats
    temperature: Floats
    load_factors: Floats
    efficiency: Floats | None = None

    @property
    def total_contact_ratio(self) -> Floats:
        """Total contact ratio eps_gamma."""
        return self.pairs.contact_ratio + self.overlap_ratio

    @property
    def sliding(self) -> Floats:
        """Greatest specific sliding of both gears, a magnitude."""
        result: Floats = np.max(np.abs(self.pairs.sliding), axis=0)
        return result

    @property
    def ripple(self) -> Floats:
        """Change of the length of the lines of contact over the mesh, over its mean."""
        return line_ripple(self.pairs.contact_ratio, self.overlap_ratio)

    def meets(self, condition: str, task: SizeTask) -> Bools:
        """Return a mask of the variants that meet a condition, one of REQUIRED."""
        if condition == MASS:
            return np.ones(len(self.order), bool) if task.max_mass is None else self.mass <= task.max_mass
        if condition == SCUFFING:
            most = task.most_temperature
            return np.ones(len(self.order), bool) if most is None else self.temperature <= most
        flank = condition == FLANK
        least = task.rating.required_safety_flank if flank else task.rating.required_safety_root
        result: Bools = np.minimum(*(self.flank_safeties if flank else self.root_safeties)) >= least
        return result

    def safe(self, task: SizeTask) -> Bools:
        """Return a mask of the variants that meet all conditions."""
        result: Bools = np.logical_and.reduce([self.meets(each, task) for each in REQUIRED])
        return result


def line_ripple(contact_ratio: Floats, overlap_ratio: Floats) -> Floats:
    """(l_max - l_min)/l_mean of all lines of contact: what noise goes by before the transmission error is known.

    Lines are b/cos beta_b long at eps_beta >= 1 only in part, but what is beyond whole numbers p, q of both ratios is all that
    changes: min(p, q) - max(0, p + q - 1), over eps_alpha eps_beta. Of a spur pair the limit, 1/eps_alpha.
    """
    p, q = np.mod(contact_ratio, 1.0), np.mod(overlap_ratio, 1.0)
    changing = np.minimum(p, q) - np.maximum(p + q - 1, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        helical = changing / (contact_ratio * overlap_ratio)
    return np.where(overlap_ratio > 0, helical, np.where(p > 0, 1 / contact_ratio, 0.0))


def disc_mass(pairs: ManyPairs, width: Floats, densities: PerGear[float]) -> Floats:
    """Return the mass of both gears (kg), each a disc whose section is midway between those of its tip and its root circle.

    That is within 1 % of the mass of the exact solids.
    """
    parts = zip(pairs.tip_diameters, pairs.root_diameters, densities, strict=True)
    sections = sum(math.pi / 8 * (tip**2 + root**2) * density for tip, root, density in parts)
    return np.asarray(sections * 1e-9) * width


RATED = "range of the rating"
"""Words of what a variant is removed by that has no rating: deviations, root section or single contact out of all range."""


def nominal_of(task: SizeTask, pairs: ManyPairs, width: Floats) -> NominalStresses:
    """Return the stresses without load factors of pairs that share their shape or scale with their widths."""
    return NominalStresses(
        pairs=pairs,
        width=width,
        torque=task.load.torque,
        outer_factor=task.load.application_factor * task.rating.mesh_load_factor,
        materials=task.materials,
        edition=task.rating.standard,
        accuracy_grade=task.rating.accuracy_grade,
    )


def rate_many(task: SizeTask, pairs: ManyPairs, width: Floats, wanted: Bools, order: Wholes) -> Rated:
    """Rate n pairs with w face widths (mm) each, (n, w), where they are `wanted`; those that have a rating, in one row.

    What does not depend on the width is worked out once for each pair.
    """
    with np.errstate(invalid="ignore", divide="ignore"):  # what has no rating is nan, and left out
        return _rated(task, pairs, width, wanted, order)


def _rated(task: SizeTask, pairs: ManyPairs, width: Floats, wanted: Bools, order: Wholes) -> Rated:
    column = pairs.picked((slice(None), None))
    nominal = nominal_of(task, column, width)
    loads = ManyLoadFactors(task, nominal)
    strengths = Strengths(task, column, nominal.roots)
    common = nominal.nominal_contact_stress * np.sqrt(loads.flank)
    parts = zip(strengths.flanks, nominal.contact_factors, strict=True)
    flanks = PerGear(*(strength / (factor * common) for strength, factor in parts))
    pairs_of = zip(strengths.roots, nominal.roots, strict=True)
    roots = PerGear(*(strength / (root.nominal_stress * loads.root) for strength, root in pairs_of))
    least = task.rating
    margin = np.minimum(np.minimum(*flanks) / least.required_safety_flank, np.minimum(*roots) / least.required_safety_root)
    rows, columns = np.nonzero(wanted & loads.known & np.isfinite(margin))
    return Rated(
        order=order[rows, columns],
        pairs=pairs.picked(rows),
        **{
            name: _flat(values, width.shape, rows, columns)
            for name, values in {
                "width": width,
                "mass": disc_mass(column, width, PerGear(*(each.density for each in task.materials))),
                "overlap_ratio": nominal.overlap_ratio,
                "flank_safeties": flanks,
                "root_safeties": roots,
                "margin": margin,
                "temperature": _temperature(task, nominal, loads),
                "load_factors": loads.flank,
                **({} if task.friction is None else {"efficiency": _efficiency(task, nominal, loads)}),
            }.items()
        },
    )


def _flat(values: Floats | PerGear[Floats], shape: tuple[int, ...], rows: Indices, columns: Indices) -> Any:
    """Return the values of the wanted variants, one after another."""
    if isinstance(values, PerGear):
        return PerGear(*(_flat(each, shape, rows, columns) for each in values))
    return np.broadcast_to(values, shape)[rows, columns]


def _temperature(task: SizeTask, nominal: NominalStresses, loads: ManyLoadFactors) -> Floats:
    """Integral temperature (°C) without tip relief; nan without a speed."""
    if task.load.speed == 0:
        return np.full(nominal.width.shape, np.nan)
    return np.asarray(_sliding_mesh(task, nominal, loads, loads.flank).value)


def _sliding_mesh(task: SizeTask, nominal: NominalStresses, loads: ManyLoadFactors, factors: Numbers) -> IntegralTemperature:
    """Return the integral temperature of meshes without tip relief, under F_t times `factors`."""
    options = task.rating
    oil = Oil.of(options)
    return IntegralTemperature(
        mesh=SlidingMesh.of(nominal.pairs, loads.total_contact_ratio),
        specific_load=nominal.tangential_force * factors / nominal.width,
        speed=loads.speed,
        roughness=USUAL_ROUGHNESS / RZ_OVER_RA,
        viscosity=oil.dynamic_viscosity,
        lubricant=oil.lubricant_factor,
        thermo_elastic=thermo_elastic_factor(task.materials),
        lubrication=LUBRICATION[options.oil_supply],
        mating=mating_factor(max(both(options.contacts_per_turn))),
        oil_temperature=oil.temperature,
    )


def _efficiency(task: SizeTask, nominal: NominalStresses, loads: ManyLoadFactors) -> Floats:
    """Return the efficiencies of meshes, 1 - mu H_V; nan where H_V does not hold. Of load factors mu has K_A alone."""
    pairs, law, application = nominal.pairs, task.friction, task.load.application_factor
    coefficient: Numbers
    if law is None or isinstance(law, float | int):
        coefficient = law or 0.0
    else:
        mesh = _sliding_mesh(task, nominal, loads, application)
        if law == "integral":
            coefficient = np.asarray(mesh.friction)
        else:
            radius = pairs.base_diameters.pinion / 2
            tangent = np.tan(np.radians(np.asarray(pairs.working_transverse_pressure_angle)))
            coefficient = mean_coefficient(
                task.load.torque * application * 1000 / radius / nominal.width,
                2 * math.pi * abs(task.load.speed) / 30_000 * radius * tangent,
                np.asarray(mesh.mesh.pitch_radius),
                mesh.viscosity,
                USUAL_ROUGHNESS / RZ_OVER_RA,
                mesh.lubricant,
            )
    return np.asarray(1 - coefficient * loss_factors(pairs))

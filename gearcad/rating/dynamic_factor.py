"""DynamicFactor: the inputs of K_v by ISO 6336-1:2006, Method B (clause 6.5).

Stiffness per face width in N/(mm·µm), mass per face width in kg/mm, deviations in µm, specific load F_t K_A/b in N/mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, plain_numbers, require_number, require_whole
from gearcad.core.records import Floats, Notice, PerGear, texts
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material, Materials, of_both
from gearcad.rating.load_factor_formulas import (
    DeviationEffects,
    FlankWear,
    RunningIn,
    dynamic_factor_b,
    resonance_speed,
    running_in_relief,
)
from gearcad.rating.material_limits import EnduranceLimits, endurance_limits_of
from gearcad.rating.nominal_rating import rate
from gearcad.rating.options import RatingOptions, accuracy_grades, base_pitch_deviations, profile_form_deviations
from gearcad.rating.tooth_stiffness import MeshStiffness

_FINE = 5
"""The coarsest accuracy grade whose tip relief counts."""

_NO_GROUP = Notice(
    "no-material-group",
    "K_v of ISO 6336-1: the material has no group, so its flanks run in as those of hardened steel, which wear least; "
    'give [material] group, such as "Eh", "V" or "GG"',
)


def reduced_mass(inertias: PerGear[float], base_radii: PerGear[float], width: float) -> float:
    """m_red (kg/mm) of a pair along the line of action: J1 J2/(J1 r_b2^2 + J2 r_b1^2), over the face width.

    Moments of inertia J in kg·m², base radii and face width in mm. Infinite inertia is that of a gear that is held.
    """
    j_1, j_2 = inertias
    r_1, r_2 = (radius / 1000 for radius in base_radii)
    for name, value in (("inertias", min(inertias)), ("base_radii", min(base_radii)), ("width", width)):
        require_number(name, float(value), above=0)
    if math.inf in inertias:
        return (j_1 / r_1**2 if math.isinf(j_2) else j_2 / r_2**2) / width
    return j_1 * j_2 / (j_1 * r_2**2 + j_2 * r_1**2) / width


@dataclass(frozen=True, kw_only=True)
class DynamicFactor:
    """Inputs of Method B; `values(speed)` gives K_v.

    `pitch_deviation` f_pb and `profile_deviation` f_falpha are those before running-in, which takes off y_alpha (18), (19) of
    the kind `running_in` (None: nothing) by the speed on the pinion's `reference_diameter` (mm) and by `flank_limit` (MPa); of
    two materials, given as PerGear of both, it is the mean.
    `tip_relief` C_a is 0 for grade 6 and coarser, for which B_k is 1. Stiffnesses are those of the load, `specific_load` is
    F_t K_A/b. `notices`: what to know before trusting it. Not part of it: gears of a planetary train or with several mates,
    whose mass differs.
    """

    teeth: int
    total_contact_ratio: float
    single_stiffness: float
    mesh_stiffness: float
    reduced_mass: float
    specific_load: float
    pitch_deviation: float
    profile_deviation: float
    tip_relief: float = 0.0
    reference_diameter: float = 0.0
    running_in: RunningIn | PerGear[RunningIn] | None = None
    flank_limit: float | PerGear[float | None] | None = None
    notices: tuple[Notice, ...] = ()

    @classmethod
    def of(
        cls,
        pair: GearPair,
        material: Materials,
        load: Load,
        inertias: PerGear[float],
        options: RatingOptions | None = None,
    ) -> DynamicFactor:
        """Return the inputs of K_v for a pair of one material or two, with the tolerances of the options' accuracy grade.

        `inertias` are in kg·m².

        Raises ParameterError and GeometryError: as `rate` and `flank_tolerances` do, and for through-hardened material without
        contact_endurance_limit.
        """
        options, materials = options or RatingOptions(), of_both(material)
        rating = rate(pair, materials, load, options)
        radii = pair.gears.map(lambda gear: abs(gear.base_diameter) / 2)
        mass = reduced_mass(inertias, radii, pair.common_width.width)
        return cls.at(pair, materials, rating.specific_load, rating.stiffness, mass, options)

    @classmethod
    def at(
        cls,
        pair: GearPair,
        materials: PerGear[Material],
        specific_load: float,
        stiffness: MeshStiffness[float],
        mass: float,
        options: RatingOptions,
    ) -> DynamicFactor:
        """Return the inputs of K_v for a pair at a specific load.

        `specific_load` is in N/mm, `stiffness` is the mesh stiffness under that load, `mass` is the reduced mass m_red (kg/mm).
        """
        limits = endurance_limits_of(materials)
        return cls(
            teeth=pair.pinion.teeth,
            total_contact_ratio=pair.total_contact_ratio,
            single_stiffness=stiffness.single,
            mesh_stiffness=stiffness.mesh_alpha,
            reduced_mass=mass,
            specific_load=specific_load,
            pitch_deviation=max(base_pitch_deviations(pair, options)),
            profile_deviation=max(profile_form_deviations(pair, options)),
            tip_relief=_tip_relief(pair, limits, max(accuracy_grades(pair, options))),
            reference_diameter=pair.pinion.reference_diameter,
            running_in=flank_wear(materials).kinds,
            flank_limit=limits.map(lambda each: each.contact),
            notices=(_NO_GROUP,) if any(each.group is None for each in materials) else (),
        )

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_whole("teeth", self.teeth, at_least=1, at_most=100_000)
        require_number("total_contact_ratio", self.total_contact_ratio, above=1)
        require_number("single_stiffness", self.single_stiffness, "N/(mm·µm)", above=0)
        require_number("mesh_stiffness", self.mesh_stiffness, "N/(mm·µm)", above=0)
        require_number("reduced_mass", self.reduced_mass, "kg/mm", above=0)
        require_number("specific_load", self.specific_load, "N/mm", above=0)
        for name in ("pitch_deviation", "profile_deviation", "tip_relief"):
            require_number(name, getattr(self, name), "µm", at_least=0)
        if self.running_in is not None:
            require_number("reference_diameter", self.reference_diameter, "mm", above=0)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    @property
    def resonance_speed(self) -> float:
        """n_E1 in rpm (6)."""
        return resonance_speed(self.teeth, self.mesh_stiffness, self.reduced_mass)

    def effects(self, speed: ArrayLike) -> DeviationEffects[Any]:
        """B_p, B_f and B_k at speeds of the pinion in rpm: how much of the deviations runs in depends on them."""
        y_p, y_f = self.allowances(speed)
        left = self.pitch_deviation - y_p, self.profile_deviation - y_f  # (18), (19)
        return DeviationEffects.of(self.single_stiffness, self.specific_load, *left, self.tip_relief)

    def allowances(self, speed: ArrayLike) -> tuple[Floats, Floats]:
        """Return y_p and y_f (µm), the running-in allowances of f_pb and f_falpha at speeds of the pinion in rpm."""
        rpm = np.asarray(speed, float)
        if self.running_in is None:
            return np.zeros_like(rpm), np.zeros_like(rpm)
        along = math.pi * self.reference_diameter / 60_000 * rpm
        kinds = self.running_in if isinstance(self.running_in, PerGear) else PerGear(self.running_in, self.running_in)
        limits = self.flank_limit if isinstance(self.flank_limit, PerGear) else PerGear(self.flank_limit, self.flank_limit)
        wear = FlankWear(kinds, limits)
        return wear.alpha(self.pitch_deviation, along), wear.alpha(self.profile_deviation, along)

    def values(self, speed: ArrayLike) -> Floats:
        """K_v at speeds of the pinion in rpm, by the resonance ratio N = n1/n_E1 (9); see `dynamic_factor_b`."""
        b_p, b_f, b_k = self.effects(speed)
        result = dynamic_factor_b(
            np.abs(np.asarray(speed, float)) / self.resonance_speed,
            self.specific_load,
            self.total_contact_ratio,
            pitch_effect=b_p,
            profile_effect=b_f,
            relief_effect=b_k,
        )
        return np.asarray(result, float)


def flank_wear(materials: PerGear[Material]) -> FlankWear:
    """Return the kind of running-in of both gears and their limits sigma_Hlim (MPa).

    Raises ParameterError if the kind depends on a limit that is not known.
    """
    limits = endurance_limits_of(materials).map(lambda limits: limits.contact)
    if materials.pinion == materials.wheel:  # errors need not say whose
        kind = _running_in(materials.pinion, limits.pinion)
        return FlankWear(PerGear(kind, kind), limits)
    return FlankWear(PerGear.each(lambda role: _running_in(materials.pick(role), limits.pick(role))), limits)


def _running_in(material: Material, flank_limit: float | None) -> RunningIn:
    """Return the kind of running-in of a material's flanks.

    A material without a group counts as hardened steel, which wears least. Raises ParameterError if the kind needs a flank
    limit and none is given.
    """
    kind = RunningIn.SURFACE_HARDENED if material.group is None else RunningIn.of(material.group)
    if kind.needs_flank_limit and flank_limit is None:
        permitted = f"must be given for material group {material.group}: how its flanks run in depends on it"
        raise ParameterError("material.contact_endurance_limit", None, permitted)
    return kind


def _tip_relief(pair: GearPair, limits: PerGear[EnduranceLimits], grade: int) -> float:
    designed = min(gear.modification.tip_relief for gear in pair.gears)
    return effective_relief(limits, grade, designed)


def effective_relief(limits: PerGear[EnduranceLimits], grade: int, designed: float = 0.0) -> float:
    """Return C_a (µm): 0 for coarse grades, else the designed relief of both gears, or else that by running-in, if known."""
    if grade > _FINE:
        return 0.0
    known = [running_in_relief(each.contact) for each in limits if each.contact is not None]
    return designed or (sum(known) / 2 if len(known) == 2 else 0.0)

"""Dynamic factor K_v of ISO 6336-1:2006, Method B (clause 6.5): a function per equation.

Stiffness per face width in N/(mm·µm), mass per face width in kg/mm, deviations in µm, specific load F_t K_A/b in N/mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import ParameterError, plain_numbers, require_number, require_whole
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material, of_both
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear
from gearcad.rating.iso6336_5 import endurance_limits_of
from gearcad.rating.options import RatingOptions
from gearcad.rating.rate import rate
from gearcad.rating.running_in import RunningIn, running_in_alpha, running_in_relief
from gearcad.rating.tolerances.iso1328 import flank_tolerances

__all__ = ["DynamicFactor", "RunningFactors", "reduced_mass", "resonance_speed", "running_factors"]


_MAIN_END, _SUPERCRITICAL = 1.15, 1.5
"""Resonance ratios at which the main resonance range ends, and the supercritical one begins."""


_FINE = 5
"""The coarsest accuracy grade whose tip relief counts."""

_NO_GROUP = Notice(
    "no-material-group",
    "K_v of ISO 6336-1: the material has no group, so its flanks run in as those of hardened steel, which wear least; "
    '[material] group = "Eh", "V", "GG" ... tells',
)


class RunningFactors(NamedTuple):
    """C_v1 ... C_v7 of table 8: pitch, profile and cyclic-stiffness effects below, at and above the main resonance."""

    c_v1: float
    c_v2: float
    c_v3: float
    c_v4: float
    c_v5: float
    c_v6: float
    c_v7: float


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


def resonance_speed(teeth: int, mesh_stiffness: float, mass: float) -> float:
    """n_E1 (rpm) = 30000/(pi z1) sqrt(c_gamma_alpha/m_red) (6)."""
    return 30000 / (math.pi * teeth) * math.sqrt(mesh_stiffness / mass)


def lower_limit(specific_load: float) -> float:
    """N_S (11), (12): where the main resonance begins; lower for loads below 100 N/mm."""
    return 0.5 + 0.35 * math.sqrt(specific_load / 100) if specific_load < 100 else 0.85


def running_factors(total_contact_ratio: float) -> RunningFactors:
    """Table 8, for a total contact ratio above 1."""
    e = total_contact_ratio
    require_number("total_contact_ratio", e, above=1)
    if e <= 2:
        c_v2, c_v3, c_v4, c_v6 = 0.34, 0.23, 0.90, 0.47
    else:
        c_v2, c_v3, c_v4, c_v6 = 0.57 / (e - 0.3), 0.096 / (e - 1.56), (0.57 - 0.05 * e) / (e - 1.44), 0.12 / (e - 1.74)
    c_v7 = 0.75 if e <= 1.5 else 0.125 * math.sin(math.pi * (e - 2)) + 0.875 if e <= 2.5 else 1.0
    return RunningFactors(0.32, c_v2, c_v3, c_v4, 0.47, c_v6, c_v7)


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
        material: Material | PerGear[Material],
        load: Load,
        inertias: PerGear[float],
        options: RatingOptions | None = None,
    ) -> DynamicFactor:
        """Of a pair of one material or two, with the deviations of the options' accuracy grade; inertias in kg·m².

        Raises ParameterError and GeometryError: as `rate` and `flank_tolerances` do, and for through-hardened material without
        contact_endurance_limit.
        """
        options, materials = options or RatingOptions(), of_both(material)
        rating = rate(pair, materials, load, options)
        tolerances = [
            flank_tolerances(options.accuracy_grade, abs(gear.reference_diameter), gear.normal_module, options.accuracy)
            for gear in pair.gears
        ]
        across = math.cos(math.radians(pair.pinion.transverse_pressure_angle))
        radii = pair.gears.map(lambda gear: abs(gear.base_diameter) / 2)
        limits = endurance_limits_of(materials).map(lambda limits: limits.contact)
        if materials.pinion == materials.wheel:
            kind: RunningIn | PerGear[RunningIn] = _running_in(materials.pinion, limits.pinion)
        else:
            kind = PerGear.each(lambda role: _running_in(materials.pick(role), limits.pick(role)))
        return cls(
            teeth=pair.pinion.teeth,
            total_contact_ratio=pair.total_contact_ratio,
            single_stiffness=rating.stiffness.single,
            mesh_stiffness=rating.stiffness.mesh_alpha,
            reduced_mass=reduced_mass(inertias, radii, pair.common_width.width),
            specific_load=rating.specific_load,
            pitch_deviation=across * max(each.single_pitch for each in tolerances),
            profile_deviation=max(each.profile_form for each in tolerances),
            tip_relief=_tip_relief(pair, limits, options.accuracy_grade),
            reference_diameter=pair.pinion.reference_diameter,
            running_in=kind,
            flank_limit=limits if isinstance(kind, PerGear) else limits.pinion,
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

    def effects(self, speed: ArrayLike) -> tuple[Floats, Floats, float]:
        """B_p (15), B_f (16), B_k (17): deviations and relief over the deflection c' would have under the load.

        At speeds of the pinion in rpm: how much of the deviations runs in depends on them.
        """
        stiffness = self.single_stiffness / self.specific_load
        pitch, profile = (self._left(each, speed) for each in (self.pitch_deviation, self.profile_deviation))
        return stiffness * pitch, stiffness * profile, abs(1 - stiffness * self.tip_relief)

    def _left(self, deviation: float, speed: ArrayLike) -> Floats:
        """f - y_alpha (18), (19)."""
        rpm = np.asarray(speed, float)
        if self.running_in is None:
            return np.full_like(rpm, deviation)
        along = math.pi * self.reference_diameter / 60_000 * rpm
        kinds = self.running_in if isinstance(self.running_in, PerGear) else PerGear(self.running_in, self.running_in)
        limits = self.flank_limit if isinstance(self.flank_limit, PerGear) else PerGear(self.flank_limit, self.flank_limit)
        pinion, wheel = (running_in_alpha(deviation, kind, along, limit) for kind, limit in zip(kinds, limits, strict=True))
        return deviation - (pinion + wheel) / 2

    def values(self, speed: ArrayLike) -> Floats:
        """K_v at speeds of the pinion in rpm: (13), (14) below, (20) at, (22) between, (21) above the main resonance.

        By the resonance ratio N = n1/n_E1 (9).
        """
        ratio = np.abs(np.asarray(speed, float)) / self.resonance_speed
        c, (b_p, b_f, b_k) = running_factors(self.total_contact_ratio), self.effects(speed)
        subcritical = ratio * (c.c_v1 * b_p + c.c_v2 * b_f + c.c_v3 * b_k) + 1
        main = c.c_v1 * b_p + c.c_v2 * b_f + c.c_v4 * b_k + 1
        supercritical = c.c_v5 * b_p + c.c_v6 * b_f + c.c_v7
        between = supercritical + (main - supercritical) * (_SUPERCRITICAL - ratio) / (_SUPERCRITICAL - _MAIN_END)
        result: Floats = np.select(
            [ratio <= lower_limit(self.specific_load), ratio <= _MAIN_END, ratio < _SUPERCRITICAL],
            [subcritical, np.full_like(ratio, main), between],
            supercritical,
        )
        return result


def _running_in(material: Material, flank_limit: float | None) -> RunningIn:
    """How flanks of a material run in. Raises ParameterError where that depends on a limit that is not known."""
    kind = RunningIn.SURFACE_HARDENED if material.group is None else RunningIn.of(material.group)
    if kind.needs_flank_limit and flank_limit is None:
        permitted = f"must be given for material group {material.group}: how its flanks run in depends on it"
        raise ParameterError("material.contact_endurance_limit", None, permitted)
    return kind


def _tip_relief(pair: GearPair, limits: PerGear[float | None], grade: int) -> float:
    """C_a: 0 for coarse grades; else what both gears have by design, or else what running in makes, if that is known."""
    if grade > _FINE:
        return 0.0
    designed = min(gear.modification.tip_relief for gear in pair.gears)
    known = [running_in_relief(limit) for limit in limits if limit is not None]
    return designed or (sum(known) / 2 if len(known) == 2 else 0.0)

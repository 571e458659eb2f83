"""Dynamic factor K_v of ISO 6336-1:2006, Method B (clause 6.5): a function per equation.

Stiffness per face width in N/(mm·µm), mass per face width in kg/mm, deviations in µm, specific load F_t K_A/b in N/mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.errors import plain_numbers, require_number, require_whole
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.rating.iso1328 import flank_tolerances
from gearcad.rating.rate import rate

__all__ = ["DynamicFactor", "RunningFactors", "SpeedRange", "reduced_mass", "resonance_speed", "running_factors"]

Floats = NDArray[np.float64]

_MAIN_END, _SUPERCRITICAL = 1.15, 1.5
"""Resonance ratios at which the main resonance range ends, and the supercritical one begins."""


_RUN_IN = 0.075
"""y_alpha of case-hardened and nitrided steels (ISO 6336-1:2006, 8.3.5): share of the base pitch deviation that wears off."""


class SpeedRange(Enum):
    """Where a speed lies (6.5.3)."""

    SUBCRITICAL = "subcritical"
    MAIN_RESONANCE = "main resonance"
    INTERMEDIATE = "intermediate"
    SUPERCRITICAL = "supercritical"


class RunningFactors(NamedTuple):
    """C_v1 ... C_v7 of table 8: pitch, profile and cyclic-stiffness effects below, at and above the main resonance."""

    c_v1: float
    c_v2: float
    c_v3: float
    c_v4: float
    c_v5: float
    c_v6: float
    c_v7: float


def reduced_mass(inertias: tuple[float, float], base_radii: tuple[float, float], width: float) -> float:
    """m_red (kg/mm) of a pair along the line of action: J1 J2/(J1 r_b2^2 + J2 r_b1^2), over the face width.

    Moments of inertia J in kg·m², base radii and face width in mm.
    """
    (j_1, j_2), (r_1, r_2) = inertias, (radius / 1000 for radius in base_radii)
    for name, value in (("inertias", min(inertias)), ("base_radii", min(base_radii)), ("width", width)):
        require_number(name, float(value), above=0)
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

    `pitch_deviation` f_pb eff and `profile_deviation` f_falpha eff are those left after running-in (18), (19); `tip_relief`
    C_a is the design value for grades up to 5, what running-in leaves for coarser ones (the caller decides on both).
    Stiffnesses are those of the load, `specific_load` is F_t K_A/b. Not part of it: gears of a planetary train or with several
    mates, whose mass differs.
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

    @classmethod
    def of(cls, pair: GearPair, material: Material, load: Load, inertias: tuple[float, float], grade: int) -> DynamicFactor:
        """Of a pair with deviations of a grade of ISO 1328-1, less what running-in of hard steel takes; inertias in kg·m².

        The tip relief counts where both gears have one. Raises ParameterError and GeometryError, as `rate` and
        `flank_tolerances` do.
        """
        rating = rate(pair, material, load)
        gears = (pair.pinion, pair.wheel)
        tolerances = [flank_tolerances(grade, gear.reference_diameter, gear.normal_module) for gear in gears]
        kept = 1 - _RUN_IN
        across = math.cos(math.radians(pair.pinion.transverse_pressure_angle))
        radii = (pair.pinion.base_diameter / 2, pair.wheel.base_diameter / 2)
        return cls(
            teeth=pair.pinion.teeth,
            total_contact_ratio=pair.total_contact_ratio,
            single_stiffness=rating.stiffness.single,
            mesh_stiffness=rating.stiffness.mesh_alpha,
            reduced_mass=reduced_mass(inertias, radii, pair.common_width.width),
            specific_load=rating.specific_load,
            pitch_deviation=kept * across * max(each.single_pitch for each in tolerances),
            profile_deviation=kept * max(each.profile_form for each in tolerances),
            tip_relief=min(gear.modification.tip_relief for gear in gears),
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

    @property
    def resonance_speed(self) -> float:
        """n_E1 in rpm (6)."""
        return resonance_speed(self.teeth, self.mesh_stiffness, self.reduced_mass)

    @property
    def effects(self) -> tuple[float, float, float]:
        """B_p (15), B_f (16), B_k (17): deviations and relief over the deflection c' would have under the load."""
        stiffness = self.single_stiffness / self.specific_load
        return (
            stiffness * self.pitch_deviation,
            stiffness * self.profile_deviation,
            abs(1 - stiffness * self.tip_relief),
        )

    def range_at(self, speed: float) -> SpeedRange:
        """Of a speed of the pinion in rpm, by its resonance ratio N = n1/n_E1 (9)."""
        ratio = abs(speed) / self.resonance_speed
        if ratio <= lower_limit(self.specific_load):
            return SpeedRange.SUBCRITICAL
        if ratio <= _MAIN_END:
            return SpeedRange.MAIN_RESONANCE
        return SpeedRange.INTERMEDIATE if ratio < _SUPERCRITICAL else SpeedRange.SUPERCRITICAL

    def values(self, speed: ArrayLike) -> Floats:
        """K_v at speeds of the pinion in rpm: (13), (14) below, (20) at, (22) between, (21) above the main resonance."""
        ratio = np.abs(np.asarray(speed, float)) / self.resonance_speed
        c, (b_p, b_f, b_k) = running_factors(self.total_contact_ratio), self.effects
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

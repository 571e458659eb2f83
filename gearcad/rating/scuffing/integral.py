"""Integral temperature (ISO/TR 13989-2:2000, ISO/TS 6336-21): a mean of the temperature along the flanks.

Numbers in the text are equations of ISO/TR 13989-2. All functions take numbers, or arrays of many meshes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.rating.scuffing.heat import helical_load_factor
from gearcad.rating.scuffing.sliding import Size, SlidingMesh

__all__ = ["IntegralTemperature", "approach_factor", "contact_ratio_factor", "scuffing_temperature", "tip_relief_factor"]

LEAST_LOAD = 150.0
"""w_Bt (N/mm) below which friction falls no further (5.1)."""

GREATEST_SPEED = 50.0
"""Circumferential speed (m/s) beyond which it does not (5.1)."""

BULK, MEAN = 0.7, 1.5
"""C_1 and C_2: how much the mean flash temperature counts in that of the bulk, and in the integral temperature."""


def contact_ratio_factor(pinion_part: Size, wheel_part: Size) -> Size:
    """X_eps (39 to 44): the mean flash temperature over that at the pinion's tip, for contact ratios up to 3."""
    e_1, e_2 = pinion_part, wheel_part
    e_a = e_1 + e_2
    alone = e_1**2 + e_2**2
    double = 0.70 * alone - 0.22 * e_a + 0.52 - 0.60 * e_1 * e_2
    long_recess = 0.18 * e_1**2 + 0.70 * e_2**2 + 0.82 * e_1 - 0.52 * e_2 - 0.30 * e_1 * e_2
    long_approach = 0.70 * e_1**2 + 0.18 * e_2**2 - 0.52 * e_1 + 0.82 * e_2 - 0.30 * e_1 * e_2
    deep_recess = 0.44 * e_1**2 + 0.59 * e_2**2 + 0.30 * e_1 - 0.30 * e_2 - 0.15 * e_1 * e_2
    deep_approach = 0.59 * e_1**2 + 0.44 * e_2**2 - 0.30 * e_1 + 0.30 * e_2 - 0.15 * e_1 * e_2
    cases = [
        (e_a < 1, alone),
        ((e_a >= 2) & (e_1 >= e_2), deep_recess),
        (e_a >= 2, deep_approach),
        (e_1 >= 1, long_recess),
        (e_2 >= 1, long_approach),
    ]
    found: Size = np.select([case for case, _ in cases], [value for _, value in cases], double)[()] / (2 * e_a * e_1)
    return found


def approach_factor(recess: Size, approach: Size) -> Size:
    """X_Q (25 to 29): from 1 at epsilon_f/epsilon_a = 1.5 down to 0.6 at 3."""
    found: Size = 1.4 - 4 / 15 * np.clip(approach / recess, 1.5, 3.0)
    return found


def tip_relief_factor(pinion_part: Size, wheel_part: Size, relief: Size) -> Size:
    """X_Ca (32), `relief` the effective tip relief over the one that the load asks for, C_a/C_eff, at most 1."""
    e, q = np.maximum(pinion_part, wheel_part), np.clip(relief, 0.0, 1.0)
    found: Size = 1 + (0.06 + 0.18 * q) * e + (0.02 + 0.69 * q) * e**2
    return found


def scuffing_temperature(test_torque: float, viscosity_40: float, lubricant: float, structure: float) -> float:
    """theta_intS (°C) (94 to 96): the integral temperature at which an oil fails in the test, for flanks of X_W."""
    bulk = 80 + 0.23 * test_torque * lubricant
    mean = 0.2 * test_torque * math.pow(100 / viscosity_40, 0.02) * lubricant
    return bulk + structure * MEAN * mean


@dataclass(frozen=True, kw_only=True)
class IntegralTemperature:
    """The integral temperature of a mesh, and what it is made of. Numbers, or arrays of one shape.

    `specific_load` w_Bt in N/mm, all load factors in it; `speed` at the reference circle in m/s, above 0; `roughness` the mean
    Ra of both flanks as run in (µm; X_E = 1), `viscosity` eta of the oil in the sump (mPa·s), `relief` C_a/C_eff of the gear
    whose tip relief counts, `lubricant` X_L of the kind of oil, `thermo_elastic` X_M, `lubrication` X_S, `mating` X_mp,
    `oil_temperature` in °C.
    """

    mesh: SlidingMesh
    specific_load: Size
    speed: Size
    roughness: Size
    viscosity: float
    thermo_elastic: float
    oil_temperature: float
    relief: Size = 0.0
    lubricant: float = 1.0
    lubrication: float = 1.0
    mating: float = 1.0

    @cached_property
    def helical_load(self) -> Size:
        """K_Bgamma."""
        return helical_load_factor(self.mesh.total_contact_ratio)

    @property
    def curvature(self) -> Size:
        """rho_redC (mm) (3): at the pitch point, in the normal section."""
        return self.mesh.pitch_radius / np.cos(np.radians(self.mesh.base_helix_angle))

    @property
    def roughness_factor(self) -> Size:
        """X_R = 2.2 (Ra/rho_redC)^0.25 (7)."""
        return 2.2 * (self.roughness / self.curvature) ** 0.25

    @cached_property
    def friction(self) -> Size:
        """mu_mC = 0.045 (w_Bt K_Bgamma/(v_SC rho_redC))^0.2 eta^-0.05 X_R X_L, v_SC = 2 v tan alpha_wt cos alpha_t (1, 2)."""
        a_t, a_wt = np.radians(self.mesh.transverse_pressure_angle), np.radians(self.mesh.working_pressure_angle)
        load = np.maximum(self.specific_load, LEAST_LOAD) * self.helical_load
        rolling = 2 * np.minimum(self.speed, GREATEST_SPEED) * np.tan(a_wt) * np.cos(a_t)
        oil = self.viscosity**-0.05 * self.lubricant
        found: Size = 0.045 * (load / (rolling * self.curvature)) ** 0.2 * oil * self.roughness_factor
        return found

    @cached_property
    def geometry_factor(self) -> Size:
        """X_BE (22): of the pinion's tip, rho_E2 = a sin alpha_wt - rho_E1."""
        u, rho_1 = self.mesh.gear_ratio, self.mesh.tip_curvature
        rho_2 = self.mesh.base_tangent - rho_1
        slid = np.sqrt(rho_1) - np.sqrt(rho_2 / u)
        found: Size = 0.51 * np.sqrt(np.abs(u + 1)) * slid / (rho_1 * np.abs(rho_2)) ** 0.25
        return found

    @cached_property
    def contact_ratio_factor(self) -> Size:
        """X_eps."""
        return contact_ratio_factor(self.mesh.pinion_part, self.mesh.wheel_part)

    @cached_property
    def approach_factor(self) -> Size:
        """X_Q."""
        return approach_factor(self.mesh.recess, self.mesh.approach)

    @cached_property
    def tip_relief_factor(self) -> Size:
        """X_Ca."""
        return tip_relief_factor(self.mesh.pinion_part, self.mesh.wheel_part, self.relief)

    @cached_property
    def tip_flash(self) -> Size:
        """theta_flaE (K) (19): the flash temperature at the pinion's tip, as if it carried all load."""
        size = self.specific_load * self.helical_load
        heat = size**0.75 * np.sqrt(self.speed) / np.abs(self.mesh.centre_distance) ** 0.25
        shape = self.thermo_elastic * self.geometry_factor * self.mesh.angle_factor
        return self.friction * shape * heat / (self.approach_factor * self.tip_relief_factor)

    @property
    def mean_flash(self) -> Size:
        """theta_flaint (K) (18): its mean over the path of contact."""
        return self.tip_flash * self.contact_ratio_factor

    @property
    def bulk(self) -> Size:
        """theta_M (°C) (20): of the teeth."""
        return self.oil_temperature + BULK * self.lubrication * self.mating * self.mean_flash

    @property
    def value(self) -> Size:
        """theta_int (°C) (17)."""
        return self.bulk + MEAN * self.mean_flash

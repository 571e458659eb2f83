"""Where flanks slide: what both temperatures need to know of a mesh. Numbers, or arrays of many meshes.

Lengths in mm, angles in degrees. With a ring as the wheel gear ratio and centre distance are negative (ISO 21771).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import GearPair
from gearcad.per_gear import Role

__all__ = ["Size", "SlidingMesh"]

Size = float | Floats
"""A number, or an array of many meshes; functions of numbers give a number."""


@dataclass(frozen=True, kw_only=True)
class SlidingMesh:
    """Sizes of a mesh. Where the pinion drives, contact begins at the wheel's tip, A, and ends at the pinion's, E.

    `wheel_part` and `pinion_part` are the contact ratios of their tips, epsilon_2 and epsilon_1, on either side of the pitch
    point; `tip_curvature` is the pinion's radius of curvature at E in the transverse section.
    """

    gear_ratio: Size
    centre_distance: Size
    normal_pressure_angle: Size
    helix_angle: Size
    transverse_pressure_angle: Size
    working_pressure_angle: Size
    base_helix_angle: Size
    wheel_part: Size
    pinion_part: Size
    tip_curvature: Size
    total_contact_ratio: Size
    driver: Role = Role.PINION

    @classmethod
    def of(cls, pair: GearPair, driver: Role = Role.PINION) -> SlidingMesh:
        """Those of a pair, on the path of contact between the tip form circles."""
        path, pitch, pinion = pair.path_of_contact, pair.pinion.transverse_base_pitch, pair.pinion
        return cls(
            gear_ratio=pair.gear_ratio,
            centre_distance=pair.centre_distance,
            normal_pressure_angle=pinion.rack.pressure_angle,
            helix_angle=abs(pinion.helix_angle),
            transverse_pressure_angle=pinion.transverse_pressure_angle,
            working_pressure_angle=pair.working_transverse_pressure_angle,
            base_helix_angle=abs(pinion.base_helix_angle),
            wheel_part=(path.C - path.A) / pitch,
            pinion_part=(path.E - path.C) / pitch,
            tip_curvature=path.E,
            total_contact_ratio=pair.total_contact_ratio,
            driver=driver,
        )

    @property
    def approach(self) -> Size:
        """epsilon_f: the contact ratio until the pitch point, of the tip that is driven."""
        return self.wheel_part if self.driver is Role.PINION else self.pinion_part

    @property
    def recess(self) -> Size:
        """epsilon_a: the contact ratio from the pitch point on, of the tip that drives."""
        return self.pinion_part if self.driver is Role.PINION else self.wheel_part

    @property
    def base_tangent(self) -> Size:
        """T1T2 = a sin alpha_wt."""
        return self.centre_distance * np.sin(np.radians(self.working_pressure_angle))

    @cached_property
    def pitch_radius(self) -> Size:
        """rho of both flanks together at the pitch point, transverse: u/(1 + u)^2 a sin alpha_wt (13989-1, 6)."""
        u = self.gear_ratio
        return u / (1 + u) ** 2 * self.base_tangent

    @cached_property
    def angle_factor(self) -> Size:
        """X_alpha_beta = 1.22 (sin alpha_wt cos alpha_n cos beta)^0.25/sqrt(cos alpha_wt cos alpha_t) (13989-2, 13).

        Part 1 prints a shorter form (A.8), 2 to 3 % below the table that both parts have; this one is the table's.
        """
        a_n, beta = np.radians(self.normal_pressure_angle), np.radians(self.helix_angle)
        a_t, a_wt = np.radians(self.transverse_pressure_angle), np.radians(self.working_pressure_angle)
        found: Size = 1.22 * (np.sin(a_wt) * np.cos(a_n) * np.cos(beta)) ** 0.25 / np.sqrt(np.cos(a_wt) * np.cos(a_t))
        return found

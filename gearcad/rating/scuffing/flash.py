"""Flash temperature along the path of contact (ISO/TR 13989-1:2000, ISO/TS 6336-20), after Blok.

Numbers in the text are equations of ISO/TR 13989-1. Places are Gamma = (T1Y - T1C)/T1C: 0 at the pitch point.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, freeze
from gearcad.geometry import GearPair
from gearcad.per_gear import Role
from gearcad.rating.scuffing.sliding import SlidingMesh

__all__ = ["FlashPath", "FlashTemperature", "scuffing_temperature"]

GREATEST_SPEED = 50.0
"""Circumferential speed (m/s) beyond which friction falls no further."""

BULK = 0.47
"""How much of the mean flash temperature the bulk takes (22)."""

_STEPS = 40
"""Intervals of each of the stretches AB, BD and DE."""


def scuffing_temperature(stage: float, lubricant: float, structure: float) -> float:
    """Theta_S (°C) = 80 + (0.85 + 1.4 X_W) X_L FZG^2 (99)."""
    return 80 + (0.85 + 1.4 * structure) * lubricant * stage**2


@dataclass(frozen=True, eq=False)
class FlashPath:
    """Places along the path of contact and the share of the load X_Gamma that a flank carries there; read-only arrays.

    The limits of single contact, B and D, stand twice among the places: X_Gamma jumps there.
    """

    places: Floats
    shares: Floats

    def __post_init__(self) -> None:
        freeze(self)

    @classmethod
    def of(cls, pair: GearPair, grade: int) -> FlashPath:
        """That of a pair of an accuracy grade, with unmodified profiles (9.2, 9.4, 9.6).

        Up to a total contact ratio of 2 a flank takes (Q - 2)/15 of the load at A and E and 1/3 more at B and D, where it
        is left alone, Q the grade and at least 7 (57 to 60); above it 1/eps_alpha, the mean of all.
        """
        path = pair.path_of_contact
        first, left, right, last = ((each - path.C) / path.C for each in (path.A, path.B, path.D, path.E))
        if pair.total_contact_ratio > 2:
            places = np.linspace(first, last, 3 * _STEPS + 1)
            shares = np.full_like(places, 1 / pair.transverse_contact_ratio)
        else:
            places = np.concatenate([np.linspace(a, b, _STEPS + 1) for a, b in ((first, left), (left, right), (right, last))])
            grown = (max(grade, 7) - 2) / 15 + np.linspace(0, 1, _STEPS + 1) / 3
            shares = np.minimum(np.concatenate([grown, np.ones(_STEPS + 1), grown[::-1]]), 1.0)
        return cls(places, shares * buttressing(places, pair))

    @property
    def extent(self) -> float:
        """Gamma_E - Gamma_A."""
        return float(self.places[-1] - self.places[0])


def buttressing(places: Floats, pair: GearPair) -> Floats:
    """X_but (49 to 56): lines of contact are stiffer where they begin and end, over 0.2 sin beta_b; 1 of spur gears."""
    stretch = 0.2 * np.sin(np.radians(abs(pair.pinion.base_helix_angle)))
    if stretch == 0:
        return np.ones_like(places)
    peak = 0.3 * min(pair.overlap_ratio, 1.0)
    near = np.minimum(places - places[0], places[-1] - places)
    grown: Floats = 1 + peak * np.clip(1 - near / stretch, 0, None)
    return grown


@dataclass(frozen=True, kw_only=True)
class FlashTemperature:
    """The flash temperature along a path, and what it is made of.

    `specific_load` w_Bt in N/mm, all load factors in it; `speed` v_t at the working pitch circle in m/s, above 0; `roughness`
    the mean Ra of both flanks (µm), `lubricant` X_L with the viscosity in it, `relief_wanting` the tip relief (µm) that the
    driven tip lacks for the load, C_eff - C_a; `thermo_elastic` X_M, `lubrication` X_S, `mating` X_mp; `oil_temperature` in
    °C.
    """

    mesh: SlidingMesh
    path: FlashPath
    specific_load: float
    speed: float
    roughness: float
    lubricant: float
    thermo_elastic: float
    oil_temperature: float
    relief_wanting: float = 0.0
    lubrication: float = 1.0
    mating: float = 1.0

    @property
    def roughness_factor(self) -> float:
        """X_R = sqrt(Ra) (28), as printed reports have it."""
        return float(self.roughness**0.5)

    @cached_property
    def friction(self) -> float:
        """mu_m = 0.06 (w_Bt/(v_SC rho_C))^0.2 X_L X_R, v_SC = 2 v_t sin alpha_wt (25, 26)."""
        rolling = 2 * min(self.speed, GREATEST_SPEED) * np.sin(np.radians(self.mesh.working_pressure_angle))
        load = self.specific_load / (rolling * self.mesh.pitch_radius)
        return float(0.06 * load**0.2 * self.lubricant * self.roughness_factor)

    @cached_property
    def approach_factor(self) -> Floats:
        """X_J of each place (45 to 48): the shock where teeth meet without enough relief, before the pitch point only."""
        side = -1 if self.mesh.driver is Role.PINION else 1
        before = np.clip(side * self.path.places / self.path.extent, 0, None)
        return 1 + max(self.relief_wanting, 0.0) / 50 * before**3

    @cached_property
    def geometry_factor(self) -> Floats:
        """X_G of each place (A.6, A.7): 0 at the pitch point, where nothing slides."""
        u, place = float(self.mesh.gear_ratio), self.path.places
        slid = np.abs(np.sqrt(1 + place) - np.sqrt(1 - place / u))
        round_ = ((1 + place) * np.abs(u - place)) ** 0.25
        found: Floats = 0.51 * self.mesh.angle_factor * np.sqrt(abs(u + 1)) * slid / round_
        return found

    @cached_property
    def flash(self) -> Floats:
        """Theta_fl (K) of each place (A.5)."""
        heat = self.friction * self.thermo_elastic * self.speed**0.5 / abs(float(self.mesh.centre_distance)) ** 0.25
        load = (self.path.shares * self.specific_load) ** 0.75
        found: Floats = heat * self.approach_factor * self.geometry_factor * load
        found.flags.writeable = False
        return found

    @property
    def mean_flash(self) -> float:
        """Theta_flm (K) (24)."""
        return float(np.trapezoid(self.flash, self.path.places)) / self.path.extent

    @property
    def bulk(self) -> float:
        """Theta_M (°C) = Theta_oil + 0.47 X_S X_mp Theta_flm (22): of the teeth."""
        return self.oil_temperature + BULK * self.lubrication * self.mating * self.mean_flash

    @property
    def contact(self) -> Floats:
        """Theta_B (°C) of each place (1)."""
        found: Floats = self.bulk + self.flash
        found.flags.writeable = False
        return found

    @property
    def value(self) -> float:
        """Theta_Bmax (°C) (2)."""
        return self.bulk + float(self.flash.max())

    @property
    def hottest(self) -> float:
        """Gamma of the highest contact temperature."""
        return float(self.path.places[np.argmax(self.flash)])

"""Scuffing: what is known of the temperatures of a pair, and of the margins to those at which its oil fails."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcad.notice import Notice
from gearcad.rating.scuffing.flash import FlashTemperature
from gearcad.rating.scuffing.integral import IntegralTemperature
from gearcad.rating.scuffing.limits import ScuffingLimits
from gearcad.rating.scuffing.oil import Oil
from gearcad.rating.scuffing.risk import Risk, flash_risk, integral_risk

__all__ = ["Scuffing"]


@dataclass(frozen=True, kw_only=True)
class Scuffing:
    """Temperatures in °C where there are any, `limits` where the oil's load stage is known; else `reason` says why not.

    `flash` alone can be missing: its notice says why.
    """

    oil: Oil
    integral: IntegralTemperature | None = None
    flash: FlashTemperature | None = None
    limits: ScuffingLimits | None = None
    assumed: tuple[str, ...] = ()
    verify: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
    reason: str = ""

    @property
    def judged(self) -> bool:
        """Whether there is a safety."""
        return self.integral_safety is not None

    @property
    def integral_safety(self) -> float | None:
        """S_int = theta_intS/theta_int (ISO/TR 13989-2, 14)."""
        if self.integral is None or self.limits is None:
            return None
        return self.limits.integral / float(self.integral.value)

    @property
    def load_safety(self) -> float | None:
        """S_SL = (theta_intS - theta_oil)/(theta_int - theta_oil) (ISO/TR 13989-2, 15): about how much more load would do."""
        if self.integral is None or self.limits is None:
            return None
        return (self.limits.integral - self.oil.temperature) / (float(self.integral.value) - self.oil.temperature)

    @property
    def flash_safety(self) -> float | None:
        """S_B = (Theta_S - Theta_oil)/(Theta_B - Theta_oil) (ISO/TR 13989-1, 100)."""
        if self.flash is None or self.limits is None:
            return None
        return (self.limits.flash - self.oil.temperature) / (self.flash.value - self.oil.temperature)

    @property
    def margin(self) -> float | None:
        """Theta_S - Theta_B (K) (ISO/TR 13989-1, 10.5)."""
        return None if self.flash is None or self.limits is None else self.limits.flash - self.flash.value

    @property
    def integral_risk(self) -> Risk | None:
        """By S_int."""
        return None if self.integral_safety is None else integral_risk(self.integral_safety)

    @property
    def flash_risk(self) -> Risk | None:
        """By Theta_S - Theta_B."""
        return None if self.margin is None else flash_risk(self.margin)

    @property
    def risk(self) -> Risk | None:
        """The worse of both."""
        known = [each for each in (self.integral_risk, self.flash_risk) if each is not None]
        return min(known, key=list(Risk).index) if known else None

    def to_dict(self) -> dict[str, Any]:
        """Values under their symbols, by method; what is not known is left out."""
        return {
            "oil": self._oil(),
            **({} if self.integral is None else {"integral": self._integral(self.integral)}),
            **({} if self.flash is None else {"flash": self._flash(self.flash)}),
            **({} if self.risk is None else {"risk": self.risk.value}),
            **({"reason": self.reason} if self.reason else {}),
            "assumed": list(self.assumed),
            "verify": list(self.verify),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def _oil(self) -> dict[str, Any]:
        oil, limits = self.oil, self.limits
        test = {} if limits is None else {"FZG": limits.stage, "T_1T": limits.test_torque, "X_W": limits.structure}
        return {
            "type": oil.kind.value,
            "nu_40": oil.viscosity_40,
            "nu_100": oil.viscosity_100,
            "rho_15": oil.density,
            "theta_oil": oil.temperature,
            "nu_oil": oil.kinematic_viscosity,
            "eta_oil": oil.dynamic_viscosity,
            **test,
        }

    def _integral(self, found: IntegralTemperature) -> dict[str, Any]:
        values = {
            "w_Bt": found.specific_load,
            "K_Bgamma": found.helical_load,
            "v": found.speed,
            "mu_mC": found.friction,
            "X_L": found.lubricant,
            "X_R": found.roughness_factor,
            "X_M": found.thermo_elastic,
            "X_alphabeta": found.mesh.angle_factor,
            "X_BE": found.geometry_factor,
            "X_eps": found.contact_ratio_factor,
            "X_Q": found.approach_factor,
            "X_Ca": found.tip_relief_factor,
            "X_S": found.lubrication,
            "X_mp": found.mating,
            "theta_flaE": found.tip_flash,
            "theta_flaint": found.mean_flash,
            "theta_M": found.bulk,
            "theta_int": found.value,
            **({} if self.limits is None else {"theta_intS": self.limits.integral}),
            **({} if self.integral_safety is None else {"S_int": self.integral_safety}),
            **({} if self.load_safety is None else {"S_SL": self.load_safety}),
        }
        risk = {} if self.integral_risk is None else {"risk": self.integral_risk.value}
        return {**{name: float(value) for name, value in values.items()}, **risk}

    def _flash(self, found: FlashTemperature) -> dict[str, Any]:
        path, hottest = found.path, int(np.argmax(found.flash))
        values = {
            "w_Bt": found.specific_load,
            "v_t": found.speed,
            "mu_m": found.friction,
            "X_L": found.lubricant,
            "X_R": found.roughness_factor,
            "X_M": found.thermo_elastic,
            "X_J": found.approach_factor[hottest],
            "X_Gamma": path.shares[hottest],
            "Gamma": found.hottest,
            "Gamma_A": path.places[0],
            "Gamma_E": path.places[-1],
            "theta_flm": found.mean_flash,
            "theta_flmax": found.flash[hottest],
            "theta_M": found.bulk,
            "theta_B": found.value,
            **({} if self.limits is None else {"theta_S": self.limits.flash}),
            **({} if self.flash_safety is None else {"S_B": self.flash_safety}),
            **({} if self.margin is None else {"margin": self.margin}),
        }
        along = {"Gamma": path.places, "X_Gamma": path.shares, "theta_fl": found.flash, "theta_B": found.contact}
        return {
            **{name: float(value) for name, value in values.items()},
            **({} if self.flash_risk is None else {"risk": self.flash_risk.value}),
            "path": {name: values.tolist() for name, values in along.items()},
        }

"""The temperatures at which an oil fails, from its load stage in the FZG test A/8.3/90 (ISO 14635-1)."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.rating.scuffing import flash, integral
from gearcad.rating.scuffing.oil import Oil, stage_torque

__all__ = ["ScuffingLimits"]


@dataclass(frozen=True, kw_only=True)
class ScuffingLimits:
    """theta_intS and Theta_S (°C) of an oil between flanks of a structure factor X_W; `test_torque` T_1T in N·m."""

    stage: int
    structure: float
    test_torque: float
    integral: float
    flash: float

    @classmethod
    def of(cls, oil: Oil, stage: int, structure: float) -> ScuffingLimits:
        """Those of an oil that fails in a load stage."""
        torque, lubricant = stage_torque(stage), oil.lubricant_factor
        return cls(
            stage=stage,
            structure=structure,
            test_torque=torque,
            integral=integral.scuffing_temperature(torque, oil.viscosity_40, lubricant, structure),
            flash=flash.scuffing_temperature(stage, lubricant * oil.dynamic_viscosity**-0.05, structure),
        )

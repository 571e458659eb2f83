"""Load: the torque and speed a pair runs at, and what its teeth run in."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from gearcad.core.quantities import (
    APPLICATION_FACTOR,
    SPEED,
    TORQUE,
    WHEN_GIVEN,
    AssumedNumber,
    Range,
    Words,
    require_fields,
)
from gearcad.core.records import concise

__all__ = ["Load", "ToothLubrication"]


class ToothLubrication(StrEnum):
    """Lubrication of teeth of plastic, which decides their friction and temperature (VDI 2736-2)."""

    DRY = "dry"
    GREASE = "grease"
    OIL = "oil"
    """Bath or jet of oil, whose temperature is then the ambient one."""


@dataclass(frozen=True, kw_only=True)
class Load:
    """`torque` on the pinion in N·m (positive turns it counter-clockwise seen from +z), `speed` in rpm.

    `application_factor` K_A multiplies the torque in the ratings. The others are for teeth of plastic: `ambient_temperature`
    theta_0 (°C), in oil that of the oil, `duty` ED, the share of the time under load, `lubrication`, and of a housing
    `housing_area` A_G (m²) and `housing_resistance` R_lambdaG (K·m²/W), without which it is open. Raises ParameterError.
    """

    torque: Annotated[float, TORQUE, Words("torque on the pinion", "T_1", "ISO 6336-1")]
    speed: Annotated[float, SPEED, Words("speed of the pinion", "n_1", "ISO 6336-1")] = 0.0
    application_factor: Annotated[float, APPLICATION_FACTOR, Words("application factor", "K_A", "ISO 6336-1")] = AssumedNumber(
        1.0
    )
    ambient_temperature: Annotated[
        float | None, Range("°C", -100.0, 400.0), Words("ambient temperature", "θ_0", "VDI 2736-2"), WHEN_GIVEN
    ] = None
    duty: Annotated[
        float | None, Range("", 1e-6, 1.0), Words("share of the time under load", "ED", "VDI 2736-2"), WHEN_GIVEN
    ] = None
    lubrication: Annotated[ToothLubrication | None, Words("lubrication of plastic teeth", "", "VDI 2736-2"), WHEN_GIVEN] = None
    housing_area: Annotated[
        float | None, Range("m²", 1e-8, 1e6), Words("surface of the housing", "A_G", "VDI 2736-2"), WHEN_GIVEN
    ] = None
    housing_resistance: Annotated[
        float | None, Range("K·m²/W", 0.0, 100.0), Words("thermal resistance of the housing", "R_λG", "VDI 2736-2"), WHEN_GIVEN
    ] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)

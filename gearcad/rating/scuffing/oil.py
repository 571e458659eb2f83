"""The oil in the sump: how thin heat makes it, and what its kind and its way to the teeth do to their temperature."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from gearcad.errors import ParameterError
from gearcad.rating.lubricant_options import Lubrication, OilType
from gearcad.rating.options import RatingOptions

__all__ = ["LUBRICANT", "LUBRICATION", "Oil", "kinematic_viscosity", "stage_torque", "usual_density", "usual_viscosity_100"]

LUBRICANT = {
    OilType.MINERAL: 1.0,
    OilType.POLYALPHAOLEFIN: 0.8,
    OilType.POLYGLYCOL: 0.7,
    OilType.SOLUBLE_POLYGLYCOL: 0.6,
    OilType.ESTER: 1.3,
    OilType.TRACTION: 1.5,
}
"""X_L without the viscosity (ISO/TR 13989-1, 27; 13989-2, 5.1)."""

LUBRICATION = {Lubrication.DIP: 1.0, Lubrication.SPRAY: 1.2, Lubrication.SUBMERGED: 0.2}
"""X_S (ISO/TR 13989-1, 22)."""

Given = TypeVar("Given")

USUAL_VISCOSITY, USUAL_TEMPERATURE = 220.0, 70.0
"""What is assumed of an oil of which nothing is said: mm²/s at 40 °C, and °C."""

_USUAL_100 = (
    *((10, 2.637), (15, 3.381), (22, 4.254), (32, 5.290), (46, 6.644), (68, 8.530), (100, 11.067)),
    *((150, 14.544), (220, 18.749), (320, 23.952), (460, 30.34), (680, 39.056), (1000, 49.863), (1500, 64.213)),
)
"""Viscosities (mm²/s) at 40 and 100 °C of oils of viscosity index 95, from the tables L and H of ASTM D2270."""

_TEST_TORQUES = (0.0, 3.3, 13.7, 35.3, 60.8, 94.1, 135.3, 183.4, 239.3, 302.0, 372.6, 450.1, 534.5)
"""Torque (N·m) on the pinion of the load stages 0 to 12 of the FZG test A/8.3/90 (ISO 14635-1)."""


def kinematic_viscosity(viscosity_40: float, viscosity_100: float, temperature: float) -> float:
    """nu (mm²/s) at a temperature (°C), by Walther's line through both: lg lg(nu + 0.7) over lg T (ASTM D341)."""
    cold, hot, now = (math.log10(each + 273.15) for each in (40.0, 100.0, temperature))
    thick, thin = (math.log10(math.log10(each + 0.7)) for each in (viscosity_40, viscosity_100))
    return float(10**10 ** (thick - (thick - thin) * (now - cold) / (hot - cold)) - 0.7)


def usual_viscosity_100(viscosity_40: float) -> float:
    """nu_100 (mm²/s) of viscosity index 95; above ISO VG 1500 in proportion. Raises ParameterError below ISO VG 10."""
    cold, hot = np.log(_USUAL_100).T
    if (thick := math.log(viscosity_40)) < cold[0]:
        permitted = f"must be given, in mm²/s, of an oil below 10 mm²/s at 40 °C, here {viscosity_40:g} mm²/s"
        raise ParameterError("oil_viscosity_100", None, permitted)
    return math.exp(float(np.interp(thick, cold, hot)) + max(thick - float(cold[-1]), 0.0))


def usual_density(viscosity_40: float) -> float:
    """Density (kg/m³) of a mineral oil at 15 °C: 43.37 lg nu_40 + 805.5 (ISO/TR 15144-1, 21)."""
    return 43.37 * math.log10(viscosity_40) + 805.5


def stage_torque(stage: float) -> float:
    """T_1T (N·m) of a load stage: that of the test up to 12, and 3.726 FZG^2 (ISO/TR 13989-2, 97) above it."""
    return 3.726 * stage**2 if stage > 12 else float(np.interp(stage, range(13), _TEST_TORQUES))


@dataclass(frozen=True, kw_only=True)
class Oil:
    """An oil: viscosities in mm²/s, its `density` at 15 °C in kg/m³, its `temperature` in °C; and what of it is `assumed`."""

    viscosity_40: float
    viscosity_100: float
    density: float
    temperature: float
    kind: OilType = OilType.MINERAL
    assumed: tuple[str, ...] = ()

    @classmethod
    def of(cls, options: RatingOptions) -> Oil:
        """That of a rating; what is not given is assumed, and said."""
        assumed: list[str] = []

        def known(value: Given | None, usual: Given, words: str) -> Given:
            if value is None:
                assumed.append(words)
            return usual if value is None else value

        nu_40 = known(
            options.oil_viscosity_40,
            USUAL_VISCOSITY,
            f"oil_viscosity_40 = {USUAL_VISCOSITY:g} mm²/s: oil ISO VG {USUAL_VISCOSITY:g}",
        )
        temperature = known(options.oil_temperature, USUAL_TEMPERATURE, f"oil_temperature = {USUAL_TEMPERATURE:g} °C")
        nu_100, density = options.oil_viscosity_100, usual_density(nu_40)
        if nu_100 is None:
            nu_100 = usual_viscosity_100(nu_40)
            assumed.append(f"oil_viscosity_100 = {nu_100:.4g} mm²/s: of viscosity index 95")
        return cls(
            viscosity_40=nu_40,
            viscosity_100=nu_100,
            density=known(options.oil_density, density, f"oil_density = {density:.4g} kg/m³: of a mineral oil"),
            temperature=temperature,
            kind=known(options.oil_type, OilType.MINERAL, f"oil_type = {OilType.MINERAL.value}"),
            assumed=tuple(assumed),
        )

    @property
    def kinematic_viscosity(self) -> float:
        """nu (mm²/s) at the oil's temperature."""
        return kinematic_viscosity(self.viscosity_40, self.viscosity_100, self.temperature)

    @property
    def dynamic_viscosity(self) -> float:
        """eta (mPa·s) at the oil's temperature, which takes 0.7 kg/m³ from the density for each degree."""
        return self.kinematic_viscosity * (self.density - 0.7 * (self.temperature - 15)) / 1000

    @property
    def lubricant_factor(self) -> float:
        """X_L of the kind of oil, without its viscosity."""
        return LUBRICANT[self.kind]

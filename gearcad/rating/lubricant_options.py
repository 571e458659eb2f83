"""What of the [rating] table says of the oil."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from gearcad.errors import GeometryError, ParameterError
from gearcad.ranges import Range, Whole
from gearcad.schema import Words

__all__ = ["LubricantOptions", "Lubrication", "OilType"]


class OilType(StrEnum):
    """Kinds of gear oil, as the coefficient of friction goes by them."""

    MINERAL = "mineral"
    POLYALPHAOLEFIN = "PAO"
    POLYGLYCOL = "PG"
    """Not soluble in water."""

    SOLUBLE_POLYGLYCOL = "PG (water-soluble)"
    ESTER = "ester"
    """Phosphate ester."""

    TRACTION = "traction"
    """Traction fluid."""


class Lubrication(StrEnum):
    """How oil comes to the teeth."""

    DIP = "dip"
    SPRAY = "spray"
    SUBMERGED = "submerged"


_VISCOSITY = Range("mm²/s", 0.5, 1e5)

_OF_OIL = ("oil_viscosity_100", "oil_temperature", "oil_density", "oil_type", "scuffing_stage")


@dataclass(frozen=True, kw_only=True)
class LubricantOptions:
    """The oil, and what it stands in the FZG test A/8.3/90 (`scuffing_stage`). Nothing of it given: a rating assumes one."""

    oil_viscosity_40: Annotated[float | None, _VISCOSITY, Words("viscosity of the oil at 40 °C", "ν_40")] = None
    oil_viscosity_100: Annotated[float | None, _VISCOSITY, Words("viscosity of the oil at 100 °C", "ν_100")] = None
    oil_temperature: Annotated[float | None, Range("°C", -60.0, 250.0), Words("temperature of the oil", "θ_oil")] = None
    oil_density: Annotated[float | None, Range("kg/m³", 500.0, 2000.0), Words("density of the oil at 15 °C", "ρ_15")] = None
    oil_type: Annotated[OilType | None, Words("kind of oil", "X_L")] = None
    lubrication: Annotated[Lubrication | None, Words("how oil comes to the teeth", "X_S")] = None
    scuffing_stage: Annotated[int | None, Whole(1, 14), Words("FZG load stage of the oil, A/8.3/90", "", "ISO 14635-1")] = None
    relative_structure_factor: Annotated[float | None, Range("", 0.1, 3.0), Words("relative structure factor", "X_W")] = None

    @property
    def oil_supply(self) -> Lubrication:
        """The `lubrication`, "dip" where none is given."""
        return self.lubrication or Lubrication.DIP

    def _check_lubricant(self) -> None:
        """An oil of which something is given has a viscosity, which heat lowers. Raises ParameterError and GeometryError."""
        known = next((name for name in _OF_OIL if getattr(self, name) is not None), None)
        if self.oil_viscosity_40 is None:
            if known is not None:
                raise ParameterError("oil_viscosity_40", None, f"must be given, in mm²/s at 40 °C, with {known}")
        elif self.oil_viscosity_100 is not None and self.oil_viscosity_100 >= self.oil_viscosity_40:
            permitted = f"must be below oil_viscosity_40, {self.oil_viscosity_40:g} mm²/s"
            raise GeometryError("oil_viscosity_100", self.oil_viscosity_100, permitted, "mm²/s")

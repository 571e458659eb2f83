"""Material: what a gear is made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from gearcad.errors import ParameterError
from gearcad.ranges import DENSITY, MODULUS, POISSON_RATIO, STRENGTH
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["STEEL_MODULUS", "Material", "MaterialGroup"]

STEEL_MODULUS = 206000.0
"""Young's modulus (MPa) of steel: of what nothing else is said about."""


class MaterialGroup(StrEnum):
    """Groups of gear materials under their abbreviations in ISO 6336-5."""

    STRUCTURAL_STEEL = "St"
    """Structural steel, wrought or cast."""

    THROUGH_HARDENED = "V"
    """Through-hardened steel, wrought or cast."""

    NODULAR_IRON = "GGG"
    """Nodular cast iron, perlitic or bainitic."""

    FERRITIC_NODULAR_IRON = "GGG (ferr.)"
    MALLEABLE_IRON = "GTS"
    GREY_IRON = "GG"
    CASE_HARDENED = "Eh"
    SURFACE_HARDENED = "IF"
    """Flame or induction hardened."""

    NITRIDING_STEEL = "NT"
    NITRIDED = "NV"
    """Through-hardening or case-hardening steel, nitrided or nitrocarburised."""


_Limit = float | tuple[float, float] | None
"""An allowable stress (MPa), the range in which it lies, or none."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """Linear elastic material. `youngs_modulus` and the limits in MPa, `density` in kg/m³.

    `contact_limit` and `root_limit` are allowable stresses, or the range (low, high) in which that of the material lies;
    None gives no verdict. `group` says how flanks run in, and `contact_endurance_limit` (sigma_H_lim, MPa) how much where
    they are not hardened on the surface. Raises ParameterError.
    """

    name: Annotated[str, Words("material")] = "steel"
    youngs_modulus: Annotated[float, MODULUS, Words("Young's modulus", "E")] = STEEL_MODULUS
    poisson_ratio: Annotated[float, POISSON_RATIO, Words("Poisson's ratio", "ν")] = 0.3
    density: Annotated[float, DENSITY, Words("density", "ρ")] = 7850.0
    yield_strength: Annotated[float | None, STRENGTH, Words("yield strength", "σ_y")] = None
    contact_limit: Annotated[_Limit, STRENGTH, Words("permissible contact stress", "σ_HP", "ISO 6336-2")] = None
    root_limit: Annotated[_Limit, STRENGTH, Words("permissible root stress", "σ_FP", "ISO 6336-3")] = None
    group: Annotated[MaterialGroup | None, Words("material group", "", "ISO 6336-5")] = None
    contact_endurance_limit: Annotated[
        float | None, STRENGTH, Words("endurance limit of contact stress", "σ_Hlim", "ISO 6336-5")
    ] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        for name in ("contact_limit", "root_limit"):
            if isinstance(value := getattr(self, name), list | tuple):
                object.__setattr__(self, name, _range(name, value))


def _range(name: str, values: Sequence[float]) -> tuple[float, float]:
    """Two limits, the lower one first."""
    if len(values) != 2 or values[0] >= values[1]:
        raise ParameterError(name, list(values), "must be a number, or a range [low, high]", "MPa")
    return float(values[0]), float(values[1])

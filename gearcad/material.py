"""Material: what a gear is made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from gearcad.errors import ParameterError, as_choice, plain_numbers
from gearcad.ranges import DENSITY, MODULUS, POISSON_RATIO, STRENGTH
from gearcad.reprs import concise

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


@dataclass(frozen=True, kw_only=True)
class Material:
    """Linear elastic material. `youngs_modulus` and the limits in MPa, `density` in kg/m^3.

    `contact_limit` and `root_limit` are allowable stresses, or the range (low, high) in which that of the material lies;
    None gives no verdict. `group` says how flanks run in, and `contact_endurance_limit` (sigma_H_lim, MPa) how much where
    they are not hardened on the surface. Raises ParameterError.
    """

    name: str = "steel"
    youngs_modulus: float = STEEL_MODULUS
    poisson_ratio: float = 0.3
    density: float = 7850.0
    yield_strength: float | None = None
    contact_limit: float | tuple[float, float] | None = None
    root_limit: float | tuple[float, float] | None = None
    group: MaterialGroup | None = None
    contact_endurance_limit: float | None = None

    __repr__ = concise

    def __post_init__(self) -> None:
        plain_numbers(self)
        MODULUS.require("youngs_modulus", self.youngs_modulus)
        POISSON_RATIO.require("poisson_ratio", self.poisson_ratio)
        DENSITY.require("density", self.density)
        if self.group is not None:
            object.__setattr__(self, "group", as_choice("group", self.group, MaterialGroup))
        for name in ("yield_strength", "contact_endurance_limit"):
            if getattr(self, name) is not None:
                STRENGTH.require(name, getattr(self, name))
        for name in ("contact_limit", "root_limit"):
            value = getattr(self, name)
            if isinstance(value, list | tuple):
                object.__setattr__(self, name, _range(name, value))
            elif value is not None:
                STRENGTH.require(name, value)


def _range(name: str, values: Sequence[float]) -> tuple[float, float]:
    """A range of limits, checked."""
    for value in values:
        STRENGTH.require(name, value)
    if len(values) != 2 or values[0] >= values[1]:
        raise ParameterError(name, list(values), "must be a number, or a range [low, high]", "MPa")
    return float(values[0]), float(values[1])

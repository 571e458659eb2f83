"""Material: what a gear is made of."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.errors import plain_numbers, require_number

__all__ = ["Material"]


@dataclass(frozen=True, kw_only=True)
class Material:
    """Linear elastic material. `youngs_modulus` and the limits in MPa, `density` in kg/m^3.

    `contact_limit` and `root_limit` are allowable stresses; None gives no verdict. Raises ParameterError.
    """

    name: str = "steel"
    youngs_modulus: float = 206000.0
    poisson_ratio: float = 0.3
    density: float = 7850.0
    yield_strength: float | None = None
    contact_limit: float | None = None
    root_limit: float | None = None

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_number("youngs_modulus", self.youngs_modulus, "MPa", above=0)
        require_number("poisson_ratio", self.poisson_ratio, at_least=0, below=0.5)
        require_number("density", self.density, "kg/m^3", above=0)
        for name in ("yield_strength", "contact_limit", "root_limit"):
            if getattr(self, name) is not None:
                require_number(name, getattr(self, name), "MPa", above=0)

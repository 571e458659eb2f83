"""Family: groups of materials that the factors of permissible stress do not tell apart."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import TypeVar

from gearcad.material import MaterialGroup

__all__ = ["Family", "is_cast_steel", "per_family"]

_T = TypeVar("_T")


class Family(Enum):
    """The columns of the tables of ISO 6336-2 and -3."""

    STRUCTURAL = "St"
    THROUGH_HARDENED = "V"
    """With perlitic and bainitic nodular iron and malleable iron."""

    GREY_IRON = "GG"
    FERRITIC_NODULAR_IRON = "GGG (ferr.)"
    CASE_HARDENED = "Eh"
    SURFACE_HARDENED = "IF"
    NITRIDED = "NT, NV"
    NITROCARBURISED = "NV (nitrocar.)"

    @classmethod
    def of(cls, group: MaterialGroup) -> Family:
        """That of a group."""
        return _FAMILIES[group]


_FAMILIES = {
    MaterialGroup.STRUCTURAL_STEEL: Family.STRUCTURAL,
    MaterialGroup.CAST_STEEL: Family.STRUCTURAL,
    MaterialGroup.THROUGH_HARDENED: Family.THROUGH_HARDENED,
    MaterialGroup.THROUGH_HARDENED_CARBON: Family.THROUGH_HARDENED,
    MaterialGroup.THROUGH_HARDENED_CAST: Family.THROUGH_HARDENED,
    MaterialGroup.THROUGH_HARDENED_CAST_CARBON: Family.THROUGH_HARDENED,
    MaterialGroup.NODULAR_IRON: Family.THROUGH_HARDENED,
    MaterialGroup.MALLEABLE_IRON: Family.THROUGH_HARDENED,
    MaterialGroup.FERRITIC_NODULAR_IRON: Family.FERRITIC_NODULAR_IRON,
    MaterialGroup.GREY_IRON: Family.GREY_IRON,
    MaterialGroup.CASE_HARDENED: Family.CASE_HARDENED,
    MaterialGroup.SURFACE_HARDENED: Family.SURFACE_HARDENED,
    MaterialGroup.NITRIDING_STEEL: Family.NITRIDED,
    MaterialGroup.NITRIDED: Family.NITRIDED,
    MaterialGroup.NITROCARBURISED: Family.NITROCARBURISED,
}

_CAST_STEELS = (
    MaterialGroup.CAST_STEEL,
    MaterialGroup.THROUGH_HARDENED_CAST,
    MaterialGroup.THROUGH_HARDENED_CAST_CARBON,
)


def per_family(columns: Mapping[tuple[Family, ...], _T]) -> dict[Family, _T]:
    """A table as the standard prints it, where families share columns, by family."""
    return {family: entry for families, entry in columns.items() for family in families}


def is_cast_steel(group: MaterialGroup) -> bool:
    """Structural or through-hardened steel that was cast."""
    return group in _CAST_STEELS

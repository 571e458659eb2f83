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


_FAMILIES: Mapping[str, Family] = {
    "St": Family.STRUCTURAL,
    "St (cast)": Family.STRUCTURAL,
    "V": Family.THROUGH_HARDENED,
    "V (carbon)": Family.THROUGH_HARDENED,
    "V (cast)": Family.THROUGH_HARDENED,
    "V (cast carbon)": Family.THROUGH_HARDENED,
    "GGG": Family.THROUGH_HARDENED,
    "GTS": Family.THROUGH_HARDENED,
    "GGG (ferr.)": Family.FERRITIC_NODULAR_IRON,
    "GG": Family.GREY_IRON,
    "Eh": Family.CASE_HARDENED,
    "IF": Family.SURFACE_HARDENED,
    "NT": Family.NITRIDED,
    "NV": Family.NITRIDED,
    "NV (nitrocar.)": Family.NITROCARBURISED,
}
"""By the abbreviations of ISO 6336-5."""


def per_family(columns: Mapping[tuple[Family, ...], _T]) -> dict[Family, _T]:
    """A table as the standard prints it, where families share columns, by family."""
    return {family: entry for families, entry in columns.items() for family in families}


def is_cast_steel(group: MaterialGroup) -> bool:
    """Structural or through-hardened steel that was cast."""
    return "(cast" in group.value

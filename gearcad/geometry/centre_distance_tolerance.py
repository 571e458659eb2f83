"""DIN 3964: how far the axes of a pair may stand from their centre distance, ±A_a. Allowances in µm, distances in mm."""

from __future__ import annotations

from gearcad.errors import ParameterError, require_number
from gearcad.geometry.iso286 import standard_tolerance

__all__ = ["LARGEST_DISTANCE", "centre_distance_allowance", "require_class"]

_CLASSES = tuple(f"js{grade}" for grade in range(5, 12))

LARGEST_DISTANCE = 3150.0


def require_class(name: object, parameter: str = "centre_distance_tolerance") -> None:
    """Raise ParameterError unless `name` is one of js5 to js11."""
    if isinstance(name, str) and name in _CLASSES:
        return
    plain = "".join(name.split()).lower() if isinstance(name, str) else ""
    meant = f' (write "{plain}")' if plain in _CLASSES else ""
    raise ParameterError(parameter, name, f'must be one of js5 to js11 of DIN 3964, such as "js7"{meant}')


def centre_distance_allowance(name: str, centre_distance: float) -> float:
    """A_a (µm): half the tolerance grade of ISO 286 at a centre distance (mm; with a ring it may be negative).

    Raises ParameterError for another class, and beyond 3150 mm.
    """
    require_class(name)
    require_number("centre_distance", centre_distance, "mm", at_least=-LARGEST_DISTANCE, at_most=LARGEST_DISTANCE)
    return standard_tolerance(int(name.removeprefix("js")), abs(centre_distance)) / 2

"""The extremes that a check tells: they are sought between the positions, and it is known what may be missed of them."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

from gearcad.contact.shared.extremes import Extreme, Quantity
from gearcad.contact.shared.loaded import LoadedPosition
from gearcad.contact.solid.cycle import SolidPosition
from gearcad.per_gear import PerGear, Role

__all__ = ["ERRORS", "PLANE", "PRESSURE", "ROOTS", "SOLID", "STRESSES", "Extremes"]

_Position: TypeAlias = LoadedPosition[Any]
_Quantities: TypeAlias = tuple[Quantity[_Position], ...]

Extremes: TypeAlias = dict[str, Extreme | None]
"""By name; None for what has no value at any position."""


def _tension(role: Role) -> Quantity[_Position]:
    return Quantity(f"root_tension_{role.value}", lambda position: position.tension.pick(role).stress)


def _compression(role: Role) -> Quantity[_Position]:
    return Quantity(f"root_compression_{role.value}", lambda position: position.compression.pick(role).stress, least=True)


def _bore(role: Role) -> Quantity[_Position]:
    def tension(position: _Position) -> float:
        found = position.bore_tension.pick(role)
        return math.nan if found is None else found

    return Quantity(f"bore_tension_{role.value}", tension)


ROOTS: _Quantities = PerGear.each(_tension)
PRESSURE: Quantity[_Position] = Quantity("contact_pressure", lambda position: position.contact_pressure)
STRESSES: _Quantities = (*ROOTS, PRESSURE)

ERRORS: _Quantities = (
    Quantity("transmission_error_max", lambda position: position.transmission_error, swing=True),
    Quantity("transmission_error_min", lambda position: position.transmission_error, least=True, swing=True),
)
_COURSES: _Quantities = (
    *ERRORS,
    Quantity("mesh_stiffness_max", lambda position: position.stiffness, swing=True),
    Quantity("mesh_stiffness_min", lambda position: position.stiffness, least=True, swing=True),
)
"""What goes up and down over the mesh, and is told by how far it does."""

PLANE: _Quantities = (*STRESSES, *PerGear.each(_compression), *PerGear.each(_bore), *_COURSES)
SOLID: tuple[Quantity[SolidPosition], ...] = (*PLANE, Quantity("line_load_max", lambda position: position.line_load))
"""All that a summary tells."""

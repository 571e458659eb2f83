"""The extremes that a check tells: they are sought between the positions, and it is known what may be missed of them."""

from __future__ import annotations

import math
from typing import TypeAlias

from gearcad.contact.plane.cycle import PlanePosition
from gearcad.contact.shared.extremes import Extreme, Quantity
from gearcad.contact.solid.cycle import SolidPosition

__all__ = ["PLANE", "PRESSURE", "ROOTS", "SOLID", "STRESSES", "Extremes"]

_Position: TypeAlias = PlanePosition | SolidPosition
_Quantities: TypeAlias = tuple[Quantity[_Position], ...]

Extremes: TypeAlias = dict[str, Extreme | None]
"""By name; None for what has no value at any position."""

_GEARS = ("pinion", "wheel")


def _tension(gear: int) -> Quantity[_Position]:
    return Quantity(f"root_tension_{_GEARS[gear]}", lambda position: position.tension[gear].stress)


def _compression(gear: int) -> Quantity[_Position]:
    return Quantity(f"root_compression_{_GEARS[gear]}", lambda position: position.compression[gear].stress, least=True)


def _bore(gear: int) -> Quantity[_Position]:
    def tension(position: _Position) -> float:
        found = position.bore_tension[gear]
        return math.nan if found is None else found

    return Quantity(f"bore_tension_{_GEARS[gear]}", tension)


ROOTS: _Quantities = (_tension(0), _tension(1))
PRESSURE: Quantity[_Position] = Quantity("contact_pressure", lambda position: position.contact_pressure)
STRESSES: _Quantities = (*ROOTS, PRESSURE)

_COURSES: _Quantities = (
    Quantity("transmission_error_max", lambda position: position.transmission_error, swing=True),
    Quantity("transmission_error_min", lambda position: position.transmission_error, least=True, swing=True),
    Quantity("mesh_stiffness_max", lambda position: position.stiffness, swing=True),
    Quantity("mesh_stiffness_min", lambda position: position.stiffness, least=True, swing=True),
)
"""What goes up and down over the mesh, and is told by how far it does."""

PLANE: _Quantities = (*STRESSES, _compression(0), _compression(1), _bore(0), _bore(1), *_COURSES)
SOLID: tuple[Quantity[SolidPosition], ...] = (*PLANE, Quantity("line_load_max", lambda position: position.line_load))
"""All that a summary tells."""

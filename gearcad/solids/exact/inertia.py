"""Mass and inertia of a gear, and the mass of a rack, from their exact solids: bore, keyway, hubs and chamfers included."""

from __future__ import annotations

from typing import NamedTuple

from gearcad.geometry import Gear, Rack
from gearcad.solids.exact.moments import moments
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import gear_boundary

__all__ = ["MassProperties", "mass_properties", "rack_mass"]


class MassProperties(NamedTuple):
    """Mass in kg, moment of inertia about the gear's axis in kg·m²."""

    mass: float
    inertia: float


def mass_properties(gear: Gear, density: float) -> MassProperties:
    """Of a gear made of a material of `density` (kg/m³). Raises what `gear_boundary` raises."""
    found = moments(gear_boundary(gear))
    return MassProperties(found.volume * density * 1e-9, found.polar * density * 1e-15)


def rack_mass(rack: Rack, density: float) -> float:
    """Mass (kg) of a rack made of a material of `density` (kg/m³)."""
    return moments(rack_boundary(rack)).volume * density * 1e-9

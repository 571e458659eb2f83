"""Mass and inertia of a gear, and the mass of a rack, from their exact solids: bore, keyway, hubs and chamfers included."""

from __future__ import annotations

from typing import Any, NamedTuple

from gearcad.geometry import Gear, Rack
from gearcad.solids.exact.boundary import Boundary
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import gear_boundary

__all__ = ["MassProperties", "mass_properties", "rack_mass"]


class MassProperties(NamedTuple):
    """Mass in kg, moment of inertia about the gear's axis in kg·m²."""

    mass: float
    inertia: float


def mass_properties(gear: Gear, density: float) -> MassProperties:
    """Of a gear made of a material of `density` (kg/m³). Raises what `gear_boundary` raises."""
    from OCP.gp import gp

    properties = _volume_properties(gear_boundary(gear))
    volume, moment = properties.Mass(), properties.MomentOfInertia(gp.OZ_s())  # mm³, mm⁵
    return MassProperties(volume * density * 1e-9, moment * density * 1e-15)


def rack_mass(rack: Rack, density: float) -> float:
    """Mass (kg) of a rack made of a material of `density` (kg/m³)."""
    volume: float = _volume_properties(rack_boundary(rack)).Mass()  # mm³
    return volume * density * 1e-9


def _volume_properties(boundary: Boundary) -> Any:
    """GProp_GProps of the kernel's solid."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(kernel_solid(boundary), properties)
    return properties

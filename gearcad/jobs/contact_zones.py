"""Where the flanks of a loaded pair are meshed finely: as far as Hertz presses them flat, and somewhat beyond."""

from __future__ import annotations

from collections.abc import Mapping

from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.posed import contacts
from gearcad.per_gear import PerGear
from gearcad.rating.mesh_contact import base_normal_force, contact_at

__all__ = ["contact_zones"]


_EDGES = 4
"""Edges over the half width of a contact: with one of them the pressure is 2 % low (measured)."""

_REACH = 1.6
"""Half widths on each side of a contact over which edges stay short."""

_SHORTEST = 0.002
"""Shortest edge in normal modules: near the base circle flanks are curved most, and contacts narrower than is of any use."""


def contact_zones(pair: GearPair, material: Materials, load: Load, roll_angle: float) -> PerGear[Mapping[int, ContactZone]]:
    """Zones of the teeth of pinion and wheel that touch at a roll angle (deg), which share the load evenly.

    A negative torque presses right flanks. No torque makes no zones.
    """
    torque = load.torque * load.application_factor
    if not torque:
        return PerGear({}, {})
    left = torque > 0
    touching = contacts(pair, roll_angle, left=left)
    force = base_normal_force(pair, torque) / max(len(touching.pinion), 1)

    def zone(place: float, own: float) -> ContactZone:
        half = contact_at(pair, material, distance=place, force=force).half_width
        edge = max(half / _EDGES, _SHORTEST * pair.pinion.normal_module)
        return ContactZone(length=own, half_width=_REACH * half, edge=edge, left=left)

    whole = pair.base_tangent.length
    return PerGear(
        {tooth: zone(place, place) for tooth, place in touching.pinion.items()},
        {tooth: zone(whole - place, place) for tooth, place in touching.wheel.items()},
    )

"""What check.json tells of solid bodies only: the load along every line of contact, and load and stress along the face."""

from __future__ import annotations

from typing import Any

from gearcad.contact.solid.contact import SolidPairContact
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.per_gear import Role

__all__ = ["load_distribution", "over_face"]


def load_distribution(cycle: SolidCycle) -> list[list[dict[str, Any]]]:
    """Position by position, the lines of contact that carry; their lists go cell by cell along the face width."""
    return [[_line(contact) for contact in position.contacts] for position in cycle.positions]


def _line(contact: SolidPairContact) -> dict[str, Any]:
    """`across` (mm) from the middle of the common face width, lengths in mm, loads in N/mm, pressures in MPa."""
    line = contact.line
    return {
        "tooth": contact.tooth,
        "across": line.across.tolist(),
        "pinion_roll_length": line.places.pinion[0].tolist(),
        "wheel_roll_length": line.places.wheel[0].tolist(),
        "length": line.lengths.tolist(),
        "line_load": contact.line_loads.tolist(),
        "pressure": contact.pressures.tolist(),
        "half_width": contact.half_widths.tolist(),
        "on_edge": line.on_edge.tolist(),
        "interior": contact.interior.tolist(),
    }


def over_face(cycle: SolidCycle) -> dict[str, Any]:
    """Load per width (N/mm, transverse), mean of all positions, over the common face width; each gear's root tension over z."""
    across, load = cycle.load_along_face
    face: dict[str, Any] = {"across": across.tolist(), "load": load.tolist()}
    for role in Role:
        heights, stress = cycle.root_along_face(role)
        face[role.value] = {"height": heights.tolist(), "root_tension": stress.tolist()}
    return face

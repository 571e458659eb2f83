"""What check.json tells of every line of contact of solid bodies."""

from __future__ import annotations

from typing import Any

from gearcad.contact.solid.contact import SolidPairContact
from gearcad.contact.solid.cycle import SolidCycle

__all__ = ["load_distribution"]


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

"""The figures of a mesh cycle that one reads first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcad.fea.cycle import Cycle, PairContact, pitch_point_contact
from gearcad.fea.subsurface import greatest_von_mises

__all__ = ["Summary", "summarise"]


@dataclass(frozen=True, kw_only=True)
class Summary:
    """Stiffness in N/(mm µm) of common face width, stresses in MPa, half width in mm, transmission error in µm.

    `contact_pressure` is the greatest away from the ends of the flanks; `corner_positions` counts positions where a tip corner
    touches, whose pressure is not told.
    """

    mesh_stiffness_mean: float
    mesh_stiffness_max: float
    mesh_stiffness_min: float
    single_stiffness: float
    transmission_error_peak_to_peak: float
    contact_pressure: float
    contact_pressure_pitch_point: float
    half_width_pitch_point: float
    share_pitch_point: float
    von_mises: float
    von_mises_depth: float
    root_tension: tuple[float, float]
    root_compression: tuple[float, float]
    corner_positions: int

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        document: dict[str, Any] = {}
        for name, value in vars(self).items():
            if isinstance(value, tuple):
                document |= {f"{name}_{gear}": one for gear, one in zip(("pinion", "wheel"), value, strict=True)}
            else:
                document[name] = value
        return document


def summarise(cycle: Cycle, single: float) -> Summary:
    """Summarise a cycle; `single` is the stiffness of one pair of teeth alone."""
    stiffness, error = cycle.values("stiffness"), cycle.values("transmission_error")
    at_pitch = pitch_point_contact(cycle.model, cycle.torque)
    worst = max(
        (contact for _, contact in cycle.interior_contacts), key=lambda contact: contact.peak_pressure, default=at_pitch
    )
    mises, depth = _von_mises(cycle, worst)
    tension = [max(position.tension[gear].stress for position in cycle.positions) for gear in (0, 1)]
    compression = [min(position.compression[gear].stress for position in cycle.positions) for gear in (0, 1)]
    return Summary(
        mesh_stiffness_mean=float(stiffness.mean()),
        mesh_stiffness_max=float(stiffness.max()),
        mesh_stiffness_min=float(stiffness.min()),
        single_stiffness=single,
        transmission_error_peak_to_peak=float(np.ptp(error)),
        contact_pressure=worst.peak_pressure,
        contact_pressure_pitch_point=at_pitch.peak_pressure,
        half_width_pitch_point=at_pitch.half_width,
        share_pitch_point=at_pitch.share,
        von_mises=mises,
        von_mises_depth=depth,
        root_tension=(tension[0], tension[1]),
        root_compression=(compression[0], compression[1]),
        corner_positions=sum(any(contact.edge_distance < 0 for contact in position.contacts) for position in cycle.positions),
    )


def _von_mises(cycle: Cycle, contact: PairContact) -> tuple[float, float]:
    cells = contact.pair.cells
    return greatest_von_mises(
        cells.place, cells.width, contact.pressures, contact.hertz_half_width, cycle.model.pinion.elasticity
    )

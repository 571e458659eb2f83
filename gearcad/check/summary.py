"""The figures of a mesh cycle that one reads first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from gearcad.fea.cycle import Cycle, pitch_point_contact
from gearcad.fea.stress_field import contact_frame, tooth_field
from gearcad.fea.subsurface import greatest_von_mises

__all__ = ["Figures", "Summary", "figures", "summarise"]

_NEAR = 2.0
"""Half widths around a contact within which the stress below it is greatest."""


@dataclass(frozen=True, kw_only=True)
class Summary:
    """Stiffness in N/(mm µm) of common face width, stresses in MPa, half width in mm, transmission error in µm.

    `contact_pressure` is the greatest away from the ends of the flanks, `von_mises` the greatest below that contact, and
    `von_mises_half_plane` what its pressures alone would make in a half-plane. `corner_positions` counts positions where
    a tip corner touches, whose pressure is not told.
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
    von_mises_half_plane: float
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


class Figures(NamedTuple):
    """The few that a sweep or a refinement needs, as in Summary."""

    mesh_stiffness: float
    contact_pressure: float
    root_tension: tuple[float, float]


def figures(cycle: Cycle) -> Figures:
    """Mean mesh stiffness, greatest interior pressure and root tensions of a cycle."""
    _, worst = cycle.worst_contact
    tension = [max(position.tension[gear].stress for position in cycle.positions) for gear in (0, 1)]
    return Figures(float(cycle.values("stiffness").mean()), worst.peak_pressure, (tension[0], tension[1]))


def summarise(cycle: Cycle, single: float) -> Summary:
    """Summarise a cycle; `single` is the stiffness of one pair of teeth alone."""
    stiffness, error = cycle.values("stiffness"), cycle.values("transmission_error")
    at_pitch = pitch_point_contact(cycle.model, cycle.torque)
    few = figures(cycle)
    mises, depth = max(_below(cycle, gear) for gear in (0, 1))
    compression = [min(position.compression[gear].stress for position in cycle.positions) for gear in (0, 1)]
    return Summary(
        mesh_stiffness_mean=few.mesh_stiffness,
        mesh_stiffness_max=float(stiffness.max()),
        mesh_stiffness_min=float(stiffness.min()),
        single_stiffness=single,
        transmission_error_peak_to_peak=float(np.ptp(error)),
        contact_pressure=few.contact_pressure,
        contact_pressure_pitch_point=at_pitch.peak_pressure,
        half_width_pitch_point=at_pitch.half_width,
        share_pitch_point=at_pitch.share,
        von_mises=mises,
        von_mises_depth=depth,
        von_mises_half_plane=_half_plane(cycle),
        root_tension=few.root_tension,
        root_compression=(compression[0], compression[1]),
        corner_positions=sum(any(contact.edge_distance < 0 for contact in position.contacts) for position in cycle.positions),
    )


def _below(cycle: Cycle, gear: int) -> tuple[float, float]:
    """Greatest von Mises stress (MPa) of a gear near the worst contact, and its depth (mm)."""
    position, contact = cycle.worst_contact
    field = tooth_field(cycle, position, gear, contact.pair.tooth)
    centre, frame = contact_frame(cycle, contact)
    across, into_wheel = ((field.points - centre) @ frame).T
    near = np.hypot(across, into_wheel) < _NEAR * contact.hertz_half_width
    at = int(np.argmax(np.where(near, field.von_mises, 0.0)))
    return float(field.von_mises[at]), float(into_wheel[at] * (-1, 1)[gear])


def _half_plane(cycle: Cycle) -> float:
    _, contact = cycle.worst_contact
    cells = contact.pair.cells
    stress, _ = greatest_von_mises(
        cells.place, cells.width, contact.pressures, contact.hertz_half_width, cycle.model.pinion.elasticity
    )
    return stress

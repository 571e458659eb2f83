"""The figures of a mesh cycle that one reads first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from gearcad.fea.cycle import Cycle, pitch_point_contact
from gearcad.fea.stress_field import contact_frame, tooth_field
from gearcad.fea.subsurface import greatest_von_mises
from gearcad.ltca.solid_cycle import SolidCycle

__all__ = ["Figures", "OfGears", "PlaneSummary", "Summary", "by_name", "common_summary", "figures", "summarise"]

_NEAR = 2.0
"""Half widths around a contact within which the stress below it is greatest."""


class OfGears(NamedTuple):
    """A quantity of both gears."""

    pinion: float
    wheel: float


def by_name(values: Mapping[str, Any]) -> dict[str, Any]:
    """As `check.json` has it: what both gears have gets a name for each, `root_tension_pinion`."""
    document: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, OfGears):
            document |= {f"{name}_{gear}": of for gear, of in value._asdict().items()}
        else:
            document[name] = value
    return document


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What every model tells: stiffness in N/(mm µm) of common face width, stresses in MPa, transmission error in µm.

    `contact_pressure` is the greatest away from the edges of the flanks, `von_mises` the greatest below that contact,
    `von_mises_depth` (mm) below the flank. `corner_positions` counts positions where the edge of a tip touches, whose pressure
    is not told. At the pitch point: pressure, half width (mm), and share of the load that the pair of teeth carries.
    `bore_tension_pinion` and `_wheel` are None where the bore is kept round; where it is not, root stresses are of all teeth.
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
    root_tension: OfGears
    root_compression: OfGears
    bore_tension_pinion: float | None
    bore_tension_wheel: float | None
    corner_positions: int

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return by_name(vars(self))


@dataclass(frozen=True, kw_only=True)
class PlaneSummary(Summary):
    """That of a plane cycle; `von_mises_half_plane` is what the pressures alone would make in a half-plane."""

    von_mises_half_plane: float


class Figures(NamedTuple):
    """The few that a sweep or a refinement needs, as in Summary."""

    mesh_stiffness: float
    contact_pressure: float
    root_tension: OfGears


def figures(cycle: Cycle | SolidCycle) -> Figures:
    """Mean mesh stiffness, greatest interior pressure and root tensions of a cycle."""
    _, worst = cycle.worst_contact
    tension = OfGears(*(cycle.worst_position(gear).tension[gear].stress for gear in (0, 1)))
    return Figures(float(cycle.values("stiffness").mean()), worst.peak_pressure, tension)


def common_summary(cycle: Cycle | SolidCycle, single: float) -> dict[str, Any]:
    """Fields of a Summary that are found in every model alike; `single` is the stiffness of one pair of teeth alone."""
    stiffness, error = cycle.values("stiffness"), cycle.values("transmission_error")
    few = figures(cycle)
    compression = (min(position.compression[gear].stress for position in cycle.positions) for gear in (0, 1))
    return {
        "mesh_stiffness_mean": few.mesh_stiffness,
        "mesh_stiffness_max": float(stiffness.max()),
        "mesh_stiffness_min": float(stiffness.min()),
        "single_stiffness": single,
        "transmission_error_peak_to_peak": float(np.ptp(error)),
        "contact_pressure": few.contact_pressure,
        "root_tension": few.root_tension,
        "root_compression": OfGears(*compression),
        "bore_tension_pinion": cycle.bore_tension(0),
        "bore_tension_wheel": cycle.bore_tension(1),
    }


def summarise(cycle: Cycle, single: float) -> PlaneSummary:
    """Summarise a plane cycle; `single` is the stiffness of one pair of teeth alone."""
    at_pitch = pitch_point_contact(cycle.model, cycle.torque)
    mises, depth = max(_below(cycle, gear) for gear in (0, 1))
    return PlaneSummary(
        **common_summary(cycle, single),
        contact_pressure_pitch_point=at_pitch.peak_pressure,
        half_width_pitch_point=at_pitch.half_width,
        share_pitch_point=at_pitch.share,
        von_mises=mises,
        von_mises_depth=depth,
        von_mises_half_plane=_half_plane(cycle),
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

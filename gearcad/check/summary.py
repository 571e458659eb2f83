"""The figures of a mesh cycle that one reads first."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

import numpy as np

from gearcad.check.extremes import Extremes, found
from gearcad.contact.plane.cycle import INTERIOR, Cycle, PairContact, Position, pitch_point_contact
from gearcad.contact.plane.field import contact_frame, tooth_field
from gearcad.contact.plane.subsurface import greatest_von_mises
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.per_gear import PerGear

__all__ = ["Figures", "PlaneSummary", "Summary", "by_name", "common_summary", "figures", "summarise"]

T = TypeVar("T")

_ABOUT = ("missing", "extremes", "mean_error")

_NEAR = 2.0
"""Half widths around a contact within which the stress below it is greatest."""


def by_name(values: Mapping[str, Any]) -> dict[str, Any]:
    """As `check.json` has it: what both gears have gets a name for each, `root_tension_pinion`."""
    document: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, PerGear):
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

    A figure that no position has is None, and `missing` has the reason. `extremes` are those found between the positions too,
    `mean_error` is what the positions may miss of the mean stiffness.
    """

    mesh_stiffness_mean: float
    mesh_stiffness_max: float
    mesh_stiffness_min: float
    single_stiffness: float
    transmission_error_peak_to_peak: float
    contact_pressure: float | None
    contact_pressure_pitch_point: float | None
    half_width_pitch_point: float | None
    share_pitch_point: float
    von_mises: float | None
    von_mises_depth: float | None
    root_tension: PerGear[float]
    root_compression: PerGear[float]
    bore_tension_pinion: float | None
    bore_tension_wheel: float | None
    corner_positions: int
    missing: dict[str, str]
    extremes: Extremes
    mean_error: float

    @property
    def sampling_error(self) -> dict[str, float]:
        """By name, what the positions may miss: of an extreme, relative to it or to its swing, and of the mean stiffness."""
        known = {name: of.error for name, of in self.extremes.items() if of is not None}
        return {"mesh_stiffness_mean": self.mean_error, **known}

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it; what tells about the figures is no part of it."""
        return by_name({name: value for name, value in vars(self).items() if name not in _ABOUT})


@dataclass(frozen=True, kw_only=True)
class PlaneSummary(Summary):
    """That of a plane cycle; `von_mises_half_plane` is what the pressures alone would make in a half-plane."""

    von_mises_half_plane: float | None


class Figures(NamedTuple):
    """The few that a sweep or a refinement needs, as in Summary."""

    mesh_stiffness: float
    contact_pressure: float | None
    root_tension: PerGear[float]


def figures(cycle: Cycle | SolidCycle) -> Figures:
    """Mean mesh stiffness, greatest interior pressure and root tensions of a cycle."""
    worst = cycle.worst_contact
    tension = PerGear(*(cycle.worst_position(gear).tension[gear].stress for gear in (0, 1)))
    return Figures(float(cycle.mean("stiffness")[0]), worst[1].peak_pressure if worst else None, tension)


def common_summary(cycle: Cycle | SolidCycle, single: float) -> dict[str, Any]:
    """Fields of a Summary that are found in every model alike; `single` is the stiffness of one pair of teeth alone."""
    extremes = found(cycle)
    value = {name: of.value if of is not None else None for name, of in extremes.items()}
    mean, off = map(float, cycle.mean("stiffness"))
    return {
        "mesh_stiffness_mean": mean,
        "mean_error": off / mean,
        "mesh_stiffness_max": value["mesh_stiffness_max"],
        "mesh_stiffness_min": value["mesh_stiffness_min"],
        "single_stiffness": single,
        "transmission_error_peak_to_peak": _swing(extremes, "transmission_error"),
        "contact_pressure": value["contact_pressure"],
        "root_tension": PerGear(value["root_tension_pinion"], value["root_tension_wheel"]),
        "root_compression": PerGear(value["root_compression_pinion"], value["root_compression_wheel"]),
        "bore_tension_pinion": value["bore_tension_pinion"],
        "bore_tension_wheel": value["bore_tension_wheel"],
        "extremes": extremes,
    }


def _swing(extremes: Extremes, name: str) -> float | None:
    """From the least value to the greatest."""
    most, least = extremes[f"{name}_max"], extremes[f"{name}_min"]
    return most.value - least.value if most is not None and least is not None else None


_PRESSURES = ("contact_pressure", "von_mises", "von_mises_depth", "von_mises_half_plane")
"""What the worst contact away from the ends of the flanks decides."""

_AT_PITCH = ("contact_pressure_pitch_point", "half_width_pitch_point")


def summarise(cycle: Cycle, single: float) -> PlaneSummary:
    """Summarise a plane cycle; `single` is the stiffness of one pair of teeth alone."""
    contact, worst = pitch_point_contact(cycle.model, cycle.torque), cycle.worst_contact
    below = [each for gear in (0, 1) if (each := _below(cycle, *worst, gear)) is not None] if worst else []
    mises, depth = max(below, default=(None, None))
    pressure, width, reason = _at_pitch(contact)
    return PlaneSummary(
        **common_summary(cycle, single),
        contact_pressure_pitch_point=pressure,
        half_width_pitch_point=width,
        share_pitch_point=contact.share if contact is not None else 0.0,
        von_mises=mises,
        von_mises_depth=depth,
        von_mises_half_plane=_half_plane(cycle, worst[1]) if worst else None,
        corner_positions=sum(any(contact.edge_distance < 0 for contact in position.contacts) for position in cycle.positions),
        missing=(dict.fromkeys(_AT_PITCH, reason) if reason else {}) | _missing(cycle, bool(worst), bool(below)),
    )


def _missing(cycle: Cycle, inside: bool, below: bool) -> dict[str, str]:
    """Why the figures of the worst contact are not told."""
    if not inside:
        reason = (
            f"at none of {len(cycle.every)} positions is a contact with a tenth of the load more than {INTERIOR:g} half widths "
            "away from the ends of both flanks and their reliefs"
        )
        return dict.fromkeys(_PRESSURES, reason)
    return {} if below else dict.fromkeys(_PRESSURES[1:3], "no point of the elements lies near enough to the contact")


def _at_pitch(contact: PairContact | None) -> tuple[float | None, float | None, str]:
    """Pressure and half width at the pitch point, or why there are none."""
    if contact is None:
        return None, None, "the pair of teeth at the pitch point does not touch"
    if not contact.interior:
        return None, None, f"the pitch point lies within {INTERIOR:g} half widths of an end of a flank, or of a relief"
    if math.isnan(contact.half_width):
        return None, None, "the pressures at the pitch point have no width to tell"
    return contact.peak_pressure, contact.half_width, ""


def _below(cycle: Cycle, position: Position, contact: PairContact, gear: int) -> tuple[float, float] | None:
    """Greatest von Mises stress (MPa) of a gear near a contact, and its depth (mm); None if no point of the field is near."""
    field = tooth_field(cycle, position, gear, contact.pair.tooth)
    centre, frame = contact_frame(cycle, contact)
    across, into_wheel = ((field.points - centre) @ frame).T
    near = np.hypot(across, into_wheel) < _NEAR * contact.hertz_half_width
    if not near.any():
        return None
    at = int(np.argmax(np.where(near, field.von_mises, 0.0)))
    return float(field.von_mises[at]), float(into_wheel[at] * (-1, 1)[gear])


def _half_plane(cycle: Cycle, contact: PairContact) -> float:
    cells = contact.pair.cells
    stress, _ = greatest_von_mises(
        cells.place, cells.width, contact.pressures, contact.hertz_half_width, cycle.model.pinion.elasticity
    )
    return stress

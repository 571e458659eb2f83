"""The figures of a mesh cycle of solid gears that one reads first."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.check.summary import OfGears, Summary, common_summary
from gearcad.ltca.solid_cycle import SolidContact, SolidCycle, SolidPosition
from gearcad.rating import LineContact

__all__ = ["MiddleContact", "SolidSummary", "WorstCell", "middle_contacts", "summarise_solid", "worst_cell"]

Floats = NDArray[np.float64]

_HARMONICS = 5


@dataclass(frozen=True, kw_only=True)
class SolidSummary(Summary):
    """That of a cycle of solid gears: also where the greatest are, radii and heights in mm, `across` from the middle of the
    common face width.

    `transmission_error_harmonics` (µm) at the tooth frequency and its multiples; `contact_length_mean` (mm) of the lines that
    carry, all together; `line_load_max` (N/mm) away from the edges of the flanks; the face load factors are K_H_beta, of the
    whole cycle, and K_F_beta.
    """

    transmission_error_harmonics: tuple[float, ...]
    contact_pressure_across: float
    contact_pressure_radius: OfGears
    root_tension_height: OfGears
    root_tension_radius: OfGears
    contact_length_mean: float
    line_load_max: float
    face_load_factor: float
    root_face_load_factor: OfGears


class WorstCell(NamedTuple):
    """The cell of the greatest pressure away from the edges of the flanks, or of all where no cell is away from them."""

    position: SolidPosition
    contact: SolidContact
    cell: int


class MiddleContact(NamedTuple):
    """Where a line of contact crosses the middle of the common face width: the place (mm from T1) on the line of action."""

    place: float
    share: float
    pressure: float
    half_width: float


def worst_cell(cycle: SolidCycle) -> WorstCell:
    """Where the greatest pressure is."""
    position, contact = cycle.worst_contact
    pressures = np.where(contact.interior, contact.pressures, 0.0) if contact.interior.any() else contact.pressures
    return WorstCell(position, contact, int(np.argmax(pressures)))


def middle_contacts(cycle: SolidCycle) -> list[MiddleContact]:
    """All contacts of the cycle in the order in which one pair of teeth goes through them; 0 where the middle is unloaded."""
    found = []
    for position in cycle.positions:
        for contact in position.contacts:
            across = contact.line.across
            place = float(contact.line.nominal[0] - across[0] * math.tan(cycle.model.helix))
            pressure, width = (float(np.interp(0, across, of, 0, 0)) for of in (contact.pressures, contact.half_widths))
            found.append(MiddleContact(place, contact.share, pressure, width))
    return sorted(found)


def summarise_solid(cycle: SolidCycle, single: float) -> SolidSummary:
    """Summarise a cycle; `single` is the stiffness of one pair of teeth alone."""
    _, contact, cell = worst_cell(cycle)
    below = line_contact(cycle, contact, cell).greatest_von_mises
    lengths = (contact.line.pinion[0][cell], contact.line.wheel[0][cell])
    bases = (cycle.model.pinion.flank.base_radius, cycle.model.wheel.flank.base_radius)
    peaks = [cycle.worst_position(gear).tension[gear] for gear in (0, 1)]
    places, shares, pressures, widths = np.array(middle_contacts(cycle)).T
    at_pitch = [float(np.interp(cycle.model.pair.path_of_contact.C, places, of)) for of in (pressures, widths, shares)]
    common = common_summary(cycle, single) | {"contact_pressure": float(contact.pressures[cell])}
    return SolidSummary(
        **common,
        contact_pressure_pitch_point=at_pitch[0],
        half_width_pitch_point=at_pitch[1],
        share_pitch_point=at_pitch[2],
        von_mises=below.value,
        von_mises_depth=below.depth,
        corner_positions=sum(any(each.edge for each in position.contacts) for position in cycle.positions),
        transmission_error_harmonics=tuple(cycle.harmonics[:_HARMONICS].tolist()),
        contact_pressure_across=float(contact.line.across[cell]),
        contact_pressure_radius=OfGears(*map(math.hypot, bases, lengths)),
        root_tension_height=OfGears(*(peak.height for peak in peaks)),
        root_tension_radius=OfGears(*(peak.radius for peak in peaks)),
        contact_length_mean=float(np.mean([_loaded_length(position) for position in cycle.positions])),
        line_load_max=max(_interior_loads(cycle), default=float(contact.line_loads[cell])),
        face_load_factor=cycle.face_load_factor,
        root_face_load_factor=OfGears(*(cycle.root_face_load_factor(gear) for gear in (0, 1))),
    )


def line_contact(cycle: SolidCycle, contact: SolidContact, cell: int) -> LineContact:
    """Two cylinders of the curvature of the flanks under the line load of a cell."""
    materials = (cycle.model.pinion.material, cycle.model.wheel.material)
    return LineContact(
        load_per_width=float(contact.line_loads[cell]),
        radius=float(contact.radii[cell]),
        modulus=1 / sum((1 - of.poisson_ratio**2) / of.youngs_modulus for of in materials),
        poisson_ratio=materials[0].poisson_ratio,
    )


def _loaded_length(position: SolidPosition) -> float:
    return sum(float(contact.line.lengths[contact.forces > 0].sum()) for contact in position.contacts)


def _interior_loads(cycle: SolidCycle) -> Iterator[float]:
    contacts = (contact for position in cycle.positions for contact in position.contacts)
    return (float(contact.line_loads[contact.interior].max()) for contact in contacts if contact.interior.any())

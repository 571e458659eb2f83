"""The figures of a mesh cycle of solid gears that one reads first."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.extremes import SOLID
from gearcad.check.summary import AtPitchPoint, Summary, common_figures
from gearcad.contact.shared.loaded import INTERIOR
from gearcad.contact.solid.contact import SolidPairContact
from gearcad.contact.solid.cycle import SolidCycle, SolidPosition
from gearcad.per_gear import PerGear
from gearcad.rating.hertz import LineContact

__all__ = ["SolidSummary", "WorstPlace", "summarise_solid", "worst_place"]


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
    contact_pressure_across: float | None
    contact_pressure_radius: PerGear[float] | PerGear[None]
    root_tension_height: PerGear[float]
    root_tension_radius: PerGear[float]
    contact_length_mean: float
    line_load_max: float | None
    face_load_factor: float
    root_face_load_factor: PerGear[float]

    @property
    def own_face_factors(self) -> dict[str, float]:
        """K_F_beta is the lesser of both gears."""
        return {"K_Hbeta": self.face_load_factor, "K_Fbeta": min(self.root_face_load_factor)}


class WorstPlace(NamedTuple):
    """Where the greatest pressure away from the edges of the flanks is: `place` in cells of the line."""

    position: SolidPosition
    contact: SolidPairContact
    place: float

    def of(self, values: Floats) -> float:
        """What values (n,) of the line's cells are there."""
        return float(self.contact.between(values, self.place))


def worst_place(cycle: SolidCycle) -> WorstPlace | None:
    """Where the greatest pressure is; None if no place is away from the edges."""
    if (worst := cycle.worst_contact) is None:
        return None
    position, contact = worst
    return WorstPlace(position, contact, float(contact.inside[contact.between(contact.pressures, contact.inside).argmax()]))


def summarise_solid(cycle: SolidCycle, single: float) -> SolidSummary:
    """Summarise a cycle; `single` is the stiffness of one pair of teeth alone."""
    peaks = PerGear.each(lambda role: cycle.worst_position(role).tension.pick(role))
    worst, at_pitch = worst_place(cycle), _at_pitch(cycle.pitch_point_contact)
    below = _below(cycle, worst) if worst is not None else _Below(None, None, None, PerGear(None, None))
    extremes = {quantity.name: cycle.extreme(quantity) for quantity in SOLID}
    line_load = extremes["line_load_max"]
    return SolidSummary(
        **common_figures(cycle, extremes, single, at_pitch),
        von_mises=below.von_mises,
        von_mises_depth=below.depth,
        contact_pressure_across=below.across,
        contact_pressure_radius=below.radius,
        transmission_error_harmonics=tuple(cycle.harmonics[:_HARMONICS].tolist()),
        root_tension_height=peaks.map(lambda peak: peak.height),
        root_tension_radius=peaks.map(lambda peak: peak.radius),
        contact_length_mean=float(np.mean([_loaded_length(position) for position in cycle.positions])),
        line_load_max=line_load.value if line_load is not None else None,
        face_load_factor=cycle.face_load_factor,
        root_face_load_factor=PerGear.each(cycle.root_face_load_factor),
        missing=at_pitch.missing | ({} if worst else _nothing_inside(cycle)),
    )


_AT_WORST = ("contact_pressure", "contact_pressure_across", "contact_pressure_radius", "von_mises", "von_mises_depth")


def _nothing_inside(cycle: SolidCycle) -> dict[str, str]:
    """Why the figures of the worst place are not told."""
    reason = (
        f"at none of {len(cycle.every)} positions do places more than {INTERIOR:g} half widths away from the edges of both "
        "flanks carry a tenth of the load"
    )
    return dict.fromkeys((*_AT_WORST, "line_load_max"), reason)


class _Below(NamedTuple):
    """Where the greatest pressure is (mm), and the stress below it (MPa) and its depth (mm)."""

    von_mises: float | None
    depth: float | None
    across: float | None
    radius: PerGear[float] | PerGear[None]


def _below(cycle: SolidCycle, worst: WorstPlace) -> _Below:
    line, stress = worst.contact.line, line_contact(cycle, worst).greatest_von_mises
    bodies, lengths = cycle.model.bodies, line.places.map(lambda places: worst.of(places[0]))
    radii = PerGear.each(lambda role: math.hypot(bodies.pick(role).flank.base_radius, lengths.pick(role)))
    return _Below(stress.value, stress.depth, worst.of(line.across), radii)


def _at_pitch(contact: SolidPairContact | None) -> AtPitchPoint:
    """Pressure and half width at the pitch point in the middle of the common face width, or why there are none."""
    if contact is None:
        return AtPitchPoint(0.0, reason="the pair of teeth at the pitch point does not touch")
    across = contact.line.across
    place = float(np.interp(0, across, np.arange(len(across)), math.nan, math.nan))
    if math.isnan(place) or not min(contact.forces[[math.floor(place), math.ceil(place)]]) > 0:
        return AtPitchPoint(
            contact.share, reason="nothing is carried at the pitch point in the middle of the common face width"
        )
    if not float(contact.between(contact.margin, place)) > 0:
        return AtPitchPoint(contact.share, reason=f"the pitch point lies within {INTERIOR:g} half widths of an edge")
    pressure, half_width = (float(contact.between(of, place)) for of in (contact.pressures, contact.half_widths))
    return AtPitchPoint(contact.share, pressure, half_width)


def line_contact(cycle: SolidCycle, worst: WorstPlace) -> LineContact:
    """Two cylinders of the curvature of the flanks under the line load of a place."""
    materials = [body.material for body in cycle.model.bodies]
    return LineContact(
        load_per_width=worst.of(worst.contact.line_loads),
        radius=worst.of(worst.contact.radii),
        modulus=1 / sum((1 - of.poisson_ratio**2) / of.youngs_modulus for of in materials),
        poisson_ratio=materials[0].poisson_ratio,
    )


def _loaded_length(position: SolidPosition) -> float:
    return sum(float(contact.line.lengths[contact.forces > 0].sum()) for contact in position.contacts)

"""The figures of a mesh cycle in the plane that one reads first."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.check.extremes import PLANE
from gearcad.check.summary import AtPitchPoint, Summary, common_figures
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact, PlanePosition
from gearcad.contact.plane.field import contact_frame, tooth_field
from gearcad.contact.plane.subsurface import greatest_von_mises
from gearcad.contact.shared.loaded import INTERIOR
from gearcad.per_gear import PerGear, Role

__all__ = ["PlaneSummary", "summarise_plane"]

_NEAR = 2.0
"""Half widths around a contact within which the stress below it is greatest."""

_PRESSURES = ("contact_pressure", "von_mises", "von_mises_depth", "von_mises_half_plane")
"""What the worst contact away from the ends of the flanks decides."""


@dataclass(frozen=True, kw_only=True)
class PlaneSummary(Summary):
    """That of a plane cycle; `von_mises_half_plane` is what the pressures alone would make in a half-plane."""

    von_mises_half_plane: float | None


def summarise_plane(cycle: PlaneCycle, single: float) -> PlaneSummary:
    """Summarise a plane cycle; `single` is the stiffness of one pair of teeth alone."""
    worst, at_pitch = cycle.worst_contact, _at_pitch(cycle.pitch_point_contact)
    below = [each for role in Role if (each := _below(cycle, *worst, role)) is not None] if worst else []
    mises, depth = max(below, default=(None, None))
    extremes = {quantity.name: cycle.extreme(quantity) for quantity in PLANE}
    return PlaneSummary(
        **common_figures(cycle, extremes, single, at_pitch),
        von_mises=mises,
        von_mises_depth=depth,
        von_mises_half_plane=_half_plane(cycle, worst[1]) if worst else None,
        missing=at_pitch.missing | _missing(cycle, bool(worst), bool(below)),
    )


def _missing(cycle: PlaneCycle, inside: bool, below: bool) -> dict[str, str]:
    """Why the figures of the worst contact are not told."""
    if not inside:
        reason = (
            f"at none of {len(cycle.every)} positions is a contact with a tenth of the load more than {INTERIOR:g} half widths "
            "away from the ends of both flanks and the starts of their linear reliefs"
        )
        return dict.fromkeys(_PRESSURES, reason)
    return {} if below else dict.fromkeys(_PRESSURES[1:3], "no point of the elements lies near enough to the contact")


def _at_pitch(contact: PlanePairContact | None) -> AtPitchPoint:
    """Pressure and half width at the pitch point, or why there are none."""
    if contact is None:
        return AtPitchPoint(0.0, reason="the pair of teeth at the pitch point does not touch")
    if not contact.interior:
        return AtPitchPoint(
            contact.share,
            reason=f"the pitch point lies within {INTERIOR:g} half widths of an end of a flank, or of the start of a relief",
        )
    if math.isnan(contact.half_width):
        return AtPitchPoint(contact.share, reason="the pressures at the pitch point have no width to tell")
    return AtPitchPoint(contact.share, contact.peak_pressure, contact.half_width)


def _below(cycle: PlaneCycle, position: PlanePosition, contact: PlanePairContact, role: Role) -> tuple[float, float] | None:
    """Greatest von Mises stress (MPa) of a gear near a contact, and its depth (mm); None if no point of the field is near."""
    field = tooth_field(cycle, position, role, contact.tooth)
    centre, frame = contact_frame(cycle, contact)
    across, into_wheel = ((field.points - centre) @ frame).T
    near = np.hypot(across, into_wheel) < _NEAR * contact.hertz_half_width
    if not near.any():
        return None
    at = int(np.argmax(np.where(near, field.von_mises, 0.0)))
    return float(field.von_mises[at]), float(into_wheel[at] * PerGear(-1, 1).pick(role))


def _half_plane(cycle: PlaneCycle, contact: PlanePairContact) -> float:
    cells = contact.pair.cells
    stress, _ = greatest_von_mises(
        cells.place, cells.width, contact.pressures, contact.hertz_half_width, cycle.model.pinion.elasticity
    )
    return stress

"""What the figures of a check in the plane show, in sentences made of its numbers."""

from __future__ import annotations

import numpy as np

from gearcad.check.plane.result import PlaneCheck
from gearcad.contact.plane.cycle import PlanePairContact
from gearcad.contact.plane.field import ToothField
from gearcad.per_gear import Role
from gearcad.plots.paper import short
from gearcad.plots.stresses import hertz_contact, shown_contact
from gearcad.report.check.captions import number

__all__ = [
    "contact_pressure",
    "contact_zone",
    "convergence",
    "depth_profile",
    "fillets",
    "load_share",
    "share_at",
    "stress_field",
]


def stress_field(result: PlaneCheck) -> str:
    """Caption of the teeth."""
    position, contact = shown_contact(result)
    where = (
        f"the contact pressure away from the corners of the flanks is greatest ({short(contact.peak_pressure)} MPa)"
        if result.cycle.worst_contact is not None
        else "a pair of teeth carries most; no contact of this load is away from the corners of the flanks"
    )
    return (
        f"Von Mises stress of both gears at roll angle {position.roll_angle:.2f}°, where {where}. "
        "Look at the fillets below the contact: "
        "tension on "
        "the loaded side, compression behind. The colours end a tenth above the greatest fillet stress of this position; the "
        "contact lies above and is shown in the next figure. The teeth are drawn as they stand before they bend; loads on "
        "teeth "
        "more than a neighbour away are left out."
    )


def contact_zone(result: PlaneCheck, contact: PlanePairContact, fields: list[ToothField]) -> str:
    """Caption of the zone of contact."""
    most = max(float(field.von_mises.max()) for field in fields)
    alone = result.summary.von_mises_half_plane
    text = (
        f"The same contact, {short(2 * contact.half_width)} mm wide. The finite elements carry the smooth part of the field; "
        "that of the pressures is added in closed form, as on a half-plane along the flank's tangent, so that nothing of the "
        f"contact rests on the size of an element. The greatest von Mises stress here is {short(most)} MPa"
    )
    if alone is None:
        return text + "."
    return text + (
        f"; a half-plane under the same pressures alone has {short(alone)} MPa. The difference of "
        f"{100 * (most / alone - 1):+.1f} % is the stress of the tooth itself."
    )


def contact_pressure(result: PlaneCheck) -> str:
    """Caption of the pressures along the path."""
    contacts = [contact for _, contact in result.cycle.interior_contacts]
    corners, count = result.summary.corner_positions, len(result.cycle.positions)
    text = "Peak pressure of a pair of teeth from its first contact to its last. "
    if contacts:
        worst = max(abs(contact.peak_pressure / contact.hertz_pressure - 1) for contact in contacts)
        text += (
            f"At the {len(contacts)} contacts away from the ends of the flanks it differs from Hertz's pressure under the "
            "load that "
            f"the pair carries by {100 * worst:.2f} % at most; the greatest is {number(result.summary.contact_pressure)} MPa. "
        )
    else:
        text += "At no position is a contact away from the ends of the flanks: there is no pressure to tell. "
    text += (
        "Near the ends of a flank, and where a corner touches, no line is drawn: that pressure is decided by the edge, not by "
    )
    text += "the curvature, and depends on the mesh. "
    text += f"A corner touches at {corners} of {count} positions." if corners else "No corner touches at this load."
    return text


def depth_profile(result: PlaneCheck, contact: PlanePairContact) -> str:
    """Caption of the depth profiles."""
    hertz = hertz_contact(result, contact)
    peak, shear = hertz.greatest_von_mises, hertz.greatest_shear
    return (
        "Stresses of a half-plane below the middle of the contact with the greatest pressure, under the pressures that were "
        "found "
        f"(lines) and under Hertz's (dots), for {short(contact.force)} N per mm of width. Hertz has the greatest von Mises "
        "stress, "
        f"{short(peak.value)} MPa, {short(peak.depth)} mm deep, and the greatest shear, {short(shear.value)} MPa, "
        f"{short(shear.depth)} mm "
        f"deep; in the teeth the greatest von Mises stress is {number(result.summary.von_mises)} MPa at "
        f"{number(result.summary.von_mises_depth)} mm."
    )


def load_share(result: PlaneCheck) -> str:
    """Caption of the load share."""
    path = result.pair.path_of_contact
    at = {letter: f"{100 * share_at(result, getattr(path, letter)):.0f} % at {letter}" for letter in "BCD"}
    text = "The part of the load that one pair of teeth carries while it is in mesh. "
    if path.B < path.D:
        text += "Rigid teeth would share between A and B and between D and E, and carry all of it from B to D. "
    return text + (
        f"Here a pair carries {at['B']}, {at['C']} (the pitch point) and {at['D']}: teeth that bend let the next pair come "
        "in early "
        "and the last one leave late."
    )


def fillets(result: PlaneCheck) -> str:
    """Caption of the fillets."""
    angles = [result.cycle.worst_position(role).tension.pick(role).tangent_angle for role in Role]
    return (
        "Stress along the surface of both fillets, each gear where its tension is greatest. The tangent's angle grows from "
        "the flank "
        f"towards the root circle. ISO 6336-3 takes the section at 30°; here the maximum is at {angles[0]:.0f}° on the "
        "pinion and at "
        f"{angles[1]:.0f}° on the wheel. Below 20° the curve ends: there the contact itself can press on the fillet."
    )


def convergence(result: PlaneCheck) -> str:
    """Caption of the convergence."""
    errors = ", ".join(f"{100 * each.error:.2g} % ({each.quantity})" for each in result.convergence)
    return (
        "The same figures on three meshes, each with edges half as long as the one before; 1 is the mesh of this check. "
        f"Estimated error of the check: {errors}. Where the changes are that small, the observed order says little."
    )


def share_at(result: PlaneCheck, length: float) -> float:
    """Load share of a pair of teeth at a place on the line of action (mm from T1), between the positions solved."""
    contacts = sorted((contact.place, contact.share) for position in result.cycle.every for contact in position.contacts)
    places, shares = zip(*contacts, strict=True)
    return float(np.interp(length, places, shares))

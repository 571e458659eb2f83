"""What each figure shows, in sentences made of the numbers of the check."""

from __future__ import annotations

import math

import numpy as np

from gearcad.check.run import CheckResult
from gearcad.fea.stress_field import ToothField
from gearcad.plots.paper import short
from gearcad.plots.stresses import hertz_contact

__all__ = [
    "contact_pressure",
    "contact_zone",
    "convergence",
    "depth_profile",
    "fillets",
    "load_share",
    "mesh_stiffness",
    "root_stress",
    "stress_field",
    "sweep_pressure",
    "sweep_stiffness",
    "transmission_error",
]


def stress_field(result: CheckResult) -> str:
    """Caption of the teeth."""
    position, contact = result.cycle.worst_contact
    return (
        f"Von Mises stress of both gears at roll angle {position.roll_angle:.2f}°, where the contact pressure away from the "
        f"corners of the flanks is greatest ({short(contact.peak_pressure)} MPa). Look at the fillets below the contact: "
        "tension on "
        "the loaded side, compression behind. The colours end a tenth above the greatest fillet stress of this position; the "
        "contact lies above and is shown in the next figure. The teeth are drawn as they stand before they bend; loads on "
        "teeth "
        "more than a neighbour away are left out."
    )


def contact_zone(result: CheckResult, fields: list[ToothField]) -> str:
    """Caption of the zone of contact."""
    most = max(float(field.von_mises.max()) for field in fields)
    alone = result.summary.von_mises_half_plane
    _, contact = result.cycle.worst_contact
    return (
        f"The same contact, {short(2 * contact.half_width)} mm wide. The finite elements carry the smooth part of the field; "
        "that of the pressures is added in closed form, as on a half-plane along the flank's tangent, so that nothing of the "
        f"contact rests on the size of an element. The greatest von Mises stress here is {short(most)} MPa; a half-plane "
        "under the same "
        f"pressures alone has {short(alone)} MPa. The difference of "
        f"{100 * (most / alone - 1):+.1f} % is the stress of the tooth itself."
    )


def contact_pressure(result: CheckResult) -> str:
    """Caption of the pressures along the path."""
    contacts = [contact for _, contact in result.cycle.interior_contacts]
    corners, count = result.summary.corner_positions, len(result.cycle.positions)
    text = "Peak pressure of a pair of teeth from its first contact to its last. "
    if contacts:
        worst = max(abs(contact.peak_pressure / contact.hertz_pressure - 1) for contact in contacts)
        text += (
            f"At the {len(contacts)} contacts away from the ends of the flanks it differs from Hertz's pressure under the "
            "load that "
            f"the pair carries by {100 * worst:.2f} % at most; the greatest is {short(result.summary.contact_pressure)} MPa. "
        )
    text += (
        "Near the ends of a flank, and where a corner touches, no line is drawn: that pressure is decided by the edge, not by "
    )
    text += "the curvature, and depends on the mesh. "
    text += f"A corner touches at {corners} of {count} positions." if corners else "No corner touches at this load."
    return text


def depth_profile(result: CheckResult) -> str:
    """Caption of the depth profiles."""
    _, contact = result.cycle.worst_contact
    hertz = hertz_contact(result, contact)
    peak, shear = hertz.greatest_von_mises, hertz.greatest_shear
    return (
        "Stresses of a half-plane below the middle of the contact with the greatest pressure, under the pressures that were "
        "found "
        f"(lines) and under Hertz's (dots), for {short(contact.force)} N per mm of width. Hertz has the greatest von Mises "
        "stress, "
        f"{short(peak.value)} MPa, {short(peak.depth)} mm deep, and the greatest shear, {short(shear.value)} MPa, "
        f"{short(shear.depth)} mm "
        f"deep; in the teeth the greatest von Mises stress is {short(result.summary.von_mises)} MPa at "
        f"{short(result.summary.von_mises_depth)} mm."
    )


def load_share(result: CheckResult) -> str:
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


def mesh_stiffness(result: CheckResult) -> str:
    """Caption of the stiffness."""
    summary, positions = result.summary, result.cycle.positions
    single = sum(len(position.contacts) == 1 for position in positions)
    return (
        "Normal force over the approach of the gears, per mm of common face width. It goes from "
        f"{short(summary.mesh_stiffness_min)} to {short(summary.mesh_stiffness_max)} N/(mm µm), "
        f"{short(summary.mesh_stiffness_mean)} on the mean. At {single} of {len(positions)} positions one pair of teeth "
        "carries alone. "
        "The body below the teeth counts: see how it is held."
    )


def transmission_error(result: CheckResult) -> str:
    """Caption of the transmission error."""
    parts = 1000 * result.cycle.values("approach_parts").mean(axis=0)
    total = float(result.cycle.values("transmission_error").mean())
    return (
        "How far the wheel lags behind the pinion along the line of action; it swings by "
        f"{short(result.summary.transmission_error_peak_to_peak)} µm. Of {short(total)} µm on the mean the pinion gives "
        f"{short(parts[0])} µm and the wheel {short(parts[1])} µm, flattening of the flanks included; what is left closes gaps."
    )


def root_stress(result: CheckResult) -> str:
    """Caption of the root stresses."""
    texts = []
    for gear, name in enumerate(("pinion", "wheel")):
        tension, compression = result.summary.root_tension[gear], result.summary.root_compression[gear]
        texts.append(
            f"The {name} reaches {short(tension)} MPa in tension at roll angle "
            f"{result.cycle.worst_position(gear).roll_angle:.2f}° "
            f"and {short(compression)} MPa in compression, {100 * (abs(compression) / tension - 1):+.0f} % in size."
        )
    return (
        "Greatest stress along the fillets of the teeth in contact: tension on the loaded side (lines), compression on the "
        "other "
        "(dashed), and the nominal stress of ISO 6336-3 (dotted). " + " ".join(texts)
    )


def fillets(result: CheckResult) -> str:
    """Caption of the fillets."""
    angles = [result.cycle.worst_position(gear).tension[gear].tangent_angle for gear in (0, 1)]
    return (
        "Stress along the surface of both fillets, each gear where its tension is greatest. The tangent's angle grows from "
        "the flank "
        f"towards the root circle. ISO 6336-3 takes the section at 30°; here the maximum is at {angles[0]:.0f}° on the "
        "pinion and at "
        f"{angles[1]:.0f}° on the wheel. Below 20° the curve ends: there the contact itself can press on the fillet."
    )


def sweep_pressure(result: CheckResult) -> str:
    """Caption of the pressure over torque."""
    exponent = _exponent(result, [point.contact_pressure for point in result.sweep])
    roots = [_exponent(result, [point.root_tension[gear] for point in result.sweep]) for gear in (0, 1)]
    text = "Greatest pressure away from the corners at each torque. "
    if exponent is not None:
        text += (
            f"It grows as the torque to the power {exponent:.2f}: not linearly, because the contact widens with the load "
            "(Hertz: 0.50 "
            "for a share that stays). "
        )
    if None not in roots:
        text += (
            f"The root tension grows with the power {roots[0]:.2f} on the pinion and {roots[1]:.2f} on the wheel (1 is linear)."
        )
    return text


def sweep_stiffness(result: CheckResult) -> str:
    """Caption of the stiffness over torque."""
    points = sorted(result.sweep, key=lambda point: point.torque)
    first, last = points[0], points[-1]
    if len(points) < 2:
        return f"Only {short(last.torque)} N·m was asked for, so this shows no trend."
    rise = 100 * (last.mesh_stiffness / first.mesh_stiffness - 1)
    turns = [100 * (high / low - 1) for low, high in zip(first.torsional_stiffness, last.torsional_stiffness, strict=True)]
    return (
        f"From {short(first.torque)} to {short(last.torque)} N·m the mesh stiffness changes by {rise:+.1f} %, M/φ of the "
        "pinion by "
        f"{turns[0]:+.1f} % and of the wheel by {turns[1]:+.1f} %. M/φ is the torque on a gear over the mean turn of its teeth "
        "against its hub. The material is linear; what is not is the contact: it widens with the load, and pairs come in "
        "earlier and leave later."
    )


def convergence(result: CheckResult) -> str:
    """Caption of the convergence."""
    errors = ", ".join(f"{100 * each.error:.2g} % ({each.quantity})" for each in result.convergence)
    return (
        "The same figures on three meshes, each with edges half as long as the one before; 1 is the mesh of this check. "
        f"Estimated error of the check: {errors}. Where the changes are that small, the observed order says little."
    )


def share_at(result: CheckResult, length: float) -> float:
    """Load share of a pair of teeth at a place on the line of action (mm from T1), between the positions solved."""
    contacts = sorted(
        (contact.pair.pinion, contact.share) for position in result.cycle.positions for contact in position.contacts
    )
    places, shares = zip(*contacts, strict=True)
    return float(np.interp(length, places, shares))


def _exponent(result: CheckResult, values: list[float]) -> float | None:
    """Power with which a quantity grows from the least torque of the sweep to the greatest; None for a single torque."""
    found = sorted(zip([point.torque for point in result.sweep], values, strict=True))
    (low, first), (high, last) = found[0], found[-1]
    return math.log(last / first) / math.log(high / low) if high > low else None

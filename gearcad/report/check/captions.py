"""What the figures of every check show, in sentences made of its numbers."""

from __future__ import annotations

import math

from gearcad.check.result import CheckResult
from gearcad.geometry import GearPair
from gearcad.per_gear import Role
from gearcad.plots.paper import short

__all__ = ["mesh_stiffness", "number", "pair", "root_stress", "sweep_pressure", "sweep_stiffness", "transmission_error"]


def number(value: float | None) -> str:
    """A figure, or that there is none."""
    return "none" if value is None else short(value)


def pair(of: GearPair) -> str:
    """Caption of the pair in mesh."""
    return (
        f"Transverse section, {of.pinion.teeth} teeth of the pinion (left) and {of.wheel.teeth} of the wheel at "
        f"{short(of.centre_distance)} mm; working pitch circles, and the line of action with the path of contact from A to E "
        "for a pinion that drives counter-clockwise."
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
    parts = 1000 * result.cycle.mean("approach_parts")[0]
    total = float(result.cycle.mean("transmission_error")[0])
    return (
        "How far the wheel lags behind the pinion along the line of action; it swings by "
        f"{short(result.summary.transmission_error_peak_to_peak)} µm. Of {short(total)} µm on the mean the pinion gives "
        f"{short(parts[0])} µm and the wheel {short(parts[1])} µm, flattening of the flanks included; what is left closes gaps."
    )


def root_stress(result: CheckResult) -> str:
    """Caption of the root stresses."""
    texts = []
    for role in Role:
        tension, compression = result.summary.root_tension.pick(role), result.summary.root_compression.pick(role)
        texts.append(
            f"The {role.value} reaches {short(tension)} MPa in tension at roll angle "
            f"{result.cycle.worst_position(role).roll_angle:.2f}° "
            f"and {short(compression)} MPa in compression, {100 * (abs(compression) / tension - 1):+.0f} % in size."
        )
    return (
        "Greatest stress along the fillets of the teeth in contact: tension on the loaded side (lines), compression on the "
        "other "
        f"(dashed), and the nominal stress of {result.rating.edition.part(3)} (dotted). " + " ".join(texts)
    )


def sweep_pressure(result: CheckResult) -> str:
    """Caption of the pressure over torque."""
    pressures = [point.contact_pressure for point in result.sweep if point.contact_pressure is not None]
    exponent = _exponent(result, pressures) if len(pressures) == len(result.sweep) else None
    roots = [_exponent(result, [point.root_tension[gear] for point in result.sweep]) for gear in (0, 1)]
    text = "Greatest pressure away from the corners at each torque"
    text += "; none where all contacts are near them. " if len(pressures) < len(result.sweep) else ". "
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


def _exponent(result: CheckResult, values: list[float]) -> float | None:
    """Power with which a quantity grows from the least torque of the sweep to the greatest; None for a single torque."""
    found = sorted(zip([point.torque for point in result.sweep], values, strict=True))
    (low, first), (high, last) = found[0], found[-1]
    return math.log(last / first) / math.log(high / low) if high > low else None

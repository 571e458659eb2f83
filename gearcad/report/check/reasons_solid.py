"""Why solid bodies and ISO 6336 differ for this pair, told by numbers that separate the reasons."""

from __future__ import annotations

import numpy as np

from gearcad.check.face import face_factors
from gearcad.check.solid.result import SolidCheck
from gearcad.check.solid.summary import WorstPlace, worst_place
from gearcad.per_gear import Role
from gearcad.plots.paper import short

__all__ = ["face_reasons", "solid_root_reasons"]


def solid_root_reasons(result: SolidCheck) -> list[str]:
    """A sentence or more for each gear: width, unevenness along the face, and what remains."""
    return [_root_reason(result, role) for role in Role]


def _root_reason(result: SolidCheck, role: Role) -> str:
    rating, summary, name = result.rating.roots.pick(role), result.summary, role.value
    found, standard = summary.root_tension.pick(role), result.rating.root_stresses.pick(role)
    uneven = summary.root_face_load_factor.pick(role)
    width = result.cycle.model.width
    same_width = standard * rating.width / width
    text = (
        f"{name.capitalize()}: {short(found)} MPa by finite elements, {short(standard)} MPa by {result.rating.edition.part(3)} "
        f"({100 * (found / standard - 1):+.1f} %). "
    )
    if abs(rating.width / width - 1) > 1e-6:
        text += (
            f"Width: ISO spreads the load over b = {short(rating.width)} mm of the {name}, the finite elements over the common "
            f"width of {short(width)} mm: on that width ISO would have {short(same_width)} MPa. "
        )
    peak = result.cycle.worst_position(role).tension.pick(role)
    mean = found / uneven
    return text + (
        f"Along the face: the greatest tension stands at z = {short(peak.height)} mm and is K_Fβ = {uneven:.3f} times the mean "
        f"along the common width, {short(mean)} MPa; ISO's nominal stress takes the load as even. What remains, "
        f"{100 * (mean / same_width - 1):+.1f} % with the mean on the same width, is how the pairs of teeth share the load, "
        "how a load "
        "at one height is carried by the tooth beside it, the true fillet and the body: the maximum lies at a tangent angle of "
        f"{peak.tangent_angle:.0f}°, not at 30°, and ISO has a beam with Y_F = {rating.form_factor:.3f}, Y_S = "
        f"{rating.stress_correction_factor:.3f} and, for the slant of the lines, Y_β = {rating.helix_angle_factor:.3f}."
    )


def face_reasons(result: SolidCheck) -> list[str]:
    """Load along the lines of contact, and along the face width."""
    summary, rating, factors = result.summary, result.rating, face_factors(result.task)
    length = result.pair.contact_line_lengths.mean
    mean = rating.normal_force * rating.application_factor / length
    worst = worst_place(result.cycle)
    across, load = result.cycle.load_along_face
    greatest = across[np.abs(load - summary.face_load_factor * load.mean()).argmin()]
    pressure = "none away from the edges" if worst is None else _pressure_reason(worst)
    return [
        f"Pressure: {pressure}. ISO has the "
        f"mean, F_bn K_A over {short(length)} mm of lines: {short(mean)} N/mm, on the radius "
        f"{short(rating.pitch_point.radius)} mm "
        "of the pitch point, and carries it to the inner point of single contact by Z_B and Z_D.",
        f"Lines of contact: {short(summary.contact_length_mean)} mm carry on the mean; the rigid gears' lines are "
        f"{short(length)} mm "
        "long. Teeth that bend touch before and after them.",
        f"Along the face: K_Hβ = {summary.face_load_factor:.3f}, greatest {short(float(greatest))} mm from the middle. "
        "Method C has "
        f"{factors.flank:.3f} for F_βy = {short(abs(factors.misalignment))} µm, which is what misalignment and helix angle "
        "modifications make; ends of the faces, at which the teeth are stiffer or softer, crowning and relief, and the turning "
        "of the bodies are in the finite elements alone.",
    ]


def _pressure_reason(worst: WorstPlace) -> str:
    line = worst.contact
    return (
        f"{short(worst.of(line.pressures))} MPa at roll angle {worst.position.roll_angle:.2f}°, "
        f"{short(worst.of(line.line.across))} mm from the middle of the common width, where the line load is "
        f"{short(worst.of(line.line_loads))} N/mm and the reduced radius {short(worst.of(line.radii))} mm"
    )

"""Why root stresses in the plane and ISO 6336 differ for this pair, told by numbers that separate the reasons."""

from __future__ import annotations

from gearcad.check.plane.result import PlaneCheck
from gearcad.meshing.outline import Side
from gearcad.per_gear import PerGear, Role
from gearcad.plots.paper import short
from gearcad.report.check.captions_plane import share_at

__all__ = ["plane_root_reasons", "root_at_single_contact"]


def root_at_single_contact(result: PlaneCheck, role: Role) -> float:
    """Root tension (MPa) of a gear with all of the load on one pair at its outer point, D or B."""
    model, path = result.cycle.model, result.pair.path_of_contact
    length = PerGear(path.D, model.line.whole - path.B).pick(role)
    load = (0, length, model.force(result.cycle.torque))
    return model.fillets.pick(role).extreme(Side.LEFT_FILLET, [load]).stress


def plane_root_reasons(result: PlaneCheck) -> list[str]:
    """A sentence or more for each gear."""
    return [_root_reason(result, role) for role in Role]


def _root_reason(result: PlaneCheck, role: Role) -> str:
    path, rating = result.pair.path_of_contact, result.rating.roots.pick(role)
    found, standard = result.summary.root_tension.pick(role), result.rating.root_stresses.pick(role)
    alone, name = root_at_single_contact(result, role), role.value
    letter, place = PerGear(("D", path.D), ("B", path.B)).pick(role)
    angle = result.cycle.worst_position(role).tension.pick(role).tangent_angle
    text = (
        f"{name.capitalize()}: {short(found)} MPa by finite elements, {short(standard)} MPa by {result.rating.edition.part(3)} "
        f"({100 * (found / standard - 1):+.1f} %). ISO puts the whole load on one pair of teeth at {letter}. Loaded like "
        "that, the "
        f"finite elements have {short(alone)} MPa; sharing the load makes {100 * (found / alone - 1):+.1f} % of it "
        f"(at {letter} a pair carries {100 * share_at(result, place):.0f} %). "
    )
    width = result.cycle.model.width
    same_width = standard * rating.width / width
    if abs(rating.width / width - 1) > 1e-6:
        text += (
            f"ISO spreads the load over b = {short(rating.width)} mm of the {name}, the finite elements over the common "
            "width of "
            f"{short(width)} mm: on that width ISO would have {short(same_width)} MPa. "
        )
    if result.cycle.model.bodies.pick(role).ring.support.bends:
        text += (
            f"The rim bends. ISO raises the tension for that, by Y_B = {rating.rim_thickness_factor:.3g}; the finite elements "
            f"have it in the compression, {short(result.summary.root_compression.pick(role))} MPa, and it changes sign as "
            "the gear turns. "
        )
    return text + (
        f"What remains, {100 * (alone / same_width - 1):+.1f} % with the same load at the same place and width, is the true "
        f"fillet and the body: the maximum lies at a tangent angle of {angle:.0f}°, not at 30°, and the stress is that of the "
        f"surface instead of a beam's with the factors Y_F = {rating.form_factor:.3f} and Y_S = "
        f"{rating.stress_correction_factor:.3f}."
    )

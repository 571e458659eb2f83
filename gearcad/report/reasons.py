"""Why the finite elements and ISO 6336 differ for this pair, told by numbers that separate the reasons."""

from __future__ import annotations

from gearcad.check.run import CheckResult
from gearcad.fea.root import Fillets
from gearcad.meshing.outline import Side
from gearcad.plots.paper import short
from gearcad.report.captions import share_at

__all__ = ["root_at_single_contact", "root_reasons", "stiffness_reasons"]


def root_at_single_contact(result: CheckResult, gear: int) -> float:
    """Root tension (MPa) of the pinion (0) or wheel (1) with all of the load on one pair at its outer point, D or B."""
    model, path = result.cycle.model, result.pair.path_of_contact
    length = (path.D, model.line.whole - path.B)[gear]
    load = (0, length, model.force(result.cycle.torque))
    return Fillets((model.pinion, model.wheel)[gear]).greatest(Side.LEFT_FILLET, [load]).stress


def root_reasons(result: CheckResult) -> list[str]:
    """A sentence or more for each gear."""
    return [_root_reason(result, gear, name) for gear, name in enumerate(("pinion", "wheel"))]


def _root_reason(result: CheckResult, gear: int, name: str) -> str:
    path, rating = result.pair.path_of_contact, (result.rating.pinion, result.rating.wheel)[gear]
    found, standard = result.summary.root_tension[gear], result.rating.root_stresses[gear]
    alone = root_at_single_contact(result, gear)
    letter, place = (("D", path.D), ("B", path.B))[gear]
    angle = result.cycle.worst_position(gear).tension[gear].tangent_angle
    text = (
        f"{name.capitalize()}: {short(found)} MPa by finite elements, {short(standard)} MPa by ISO 6336-3 "
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
    return text + (
        f"What remains, {100 * (alone / same_width - 1):+.1f} % with the same load at the same place and width, is the true "
        f"fillet and the body: the maximum lies at a tangent angle of {angle:.0f}°, not at 30°, and the stress is that of the "
        f"surface instead of a beam's with the factors Y_F = {rating.form_factor:.3f} and Y_S = "
        f"{rating.stress_correction_factor:.3f}."
    )


def stiffness_reasons(result: CheckResult) -> list[str]:
    """The bodies, the load and the state of stress."""
    summary, standard, model = result.summary, result.rating.stiffness, result.cycle.model
    parts = result.cycle.values("approach_parts").mean(axis=0)
    rims = []
    for gear, body in zip((result.pair.pinion, result.pair.wheel), (model.pinion, model.wheel), strict=True):
        rims.append((gear.root_diameter / 2 - body.hub_radius) / gear.normal_module)
    reasons = [
        f"Mean mesh stiffness: {short(summary.mesh_stiffness_mean)} N/(mm µm) by finite elements, "
        f"{short(standard.mesh_alpha)} by "
        f"ISO 6336-1 ({100 * (summary.mesh_stiffness_mean / standard.mesh_alpha - 1):+.1f} %); one pair alone "
        f"{short(summary.single_stiffness)} against c' = {short(standard.single)} "
        f"({100 * (summary.single_stiffness / standard.single - 1):+.1f} %).",
        f"Bodies: the finite element bodies are flexible down to {rims[0]:.1f} m_n below the root circle on the pinion and "
        f"{rims[1]:.1f} m_n on the wheel, and rigid inside; ISO knows the body only by C_R = {standard.blank_factor:g}. Of the "
        f"approach {100 * parts[0] / parts.sum():.0f} % is the pinion's and {100 * parts[1] / parts.sum():.0f} % the wheel's.",
        f"Load: ISO's values are those from 100 N/mm on; this pair carries F_t K_A/b = {short(result.rating.specific_load)} "
        "N/mm"
        + (
            f", for which ISO lowers them by the factor {standard.low_load_factor:.3f}."
            if standard.low_load_factor < 1
            else "."
        )
        + " Over the torques of the sweep the finite elements go from "
        f"{short(min(point.mesh_stiffness for point in result.sweep))} to "
        f"{short(max(point.mesh_stiffness for point in result.sweep))} N/(mm µm).",
        f"Sharing: ISO has the mean from c' by 0.75 ε_α + 0.25 = {0.75 * result.pair.transverse_contact_ratio + 0.25:.3f}; "
        "here the mean "
        f"is {summary.mesh_stiffness_mean / summary.single_stiffness:.3f} times the greatest of one pair.",
    ]
    return reasons

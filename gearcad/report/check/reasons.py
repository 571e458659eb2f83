"""Why stiffness by finite elements and by ISO 6336 differ for this pair, told by numbers that separate the reasons."""

from __future__ import annotations

from gearcad.check.result import CheckResult
from gearcad.plots.paper import short

__all__ = ["stiffness_reasons"]


def stiffness_reasons(result: CheckResult) -> list[str]:
    """The bodies, the load and the state of stress."""
    summary, standard, model = result.summary, result.rating.stiffness, result.cycle.model
    parts = result.cycle.values("approach_parts").mean(axis=0)
    rims = []
    for gear, body in zip((result.pair.pinion, result.pair.wheel), (model.pinion, model.wheel), strict=True):
        rims.append((gear.root_diameter / 2 - body.hub_radius) / gear.normal_module)
    reasons = [
        f"Mean mesh stiffness: {short(summary.mesh_stiffness_mean)} N/(mm µm) by finite elements, "
        f"{short(standard.mesh_alpha)} by {result.rating.edition.part(1)} "
        f"({100 * (summary.mesh_stiffness_mean / standard.mesh_alpha - 1):+.1f} %); one pair alone "
        f"{short(summary.single_stiffness)} against c' = {short(standard.single)} "
        f"({100 * (summary.single_stiffness / standard.single - 1):+.1f} %).",
        f"Bodies: the finite element bodies are flexible down to {rims[0]:.1f} m_n below the root circle on the pinion and "
        f"{rims[1]:.1f} m_n on the wheel, and rigid inside; ISO knows the body only by C_R = {standard.blank_factor:g}. Of the "
        f"approach {100 * parts[0] / parts.sum():.0f} % is the pinion's and {100 * parts[1] / parts.sum():.0f} % the wheel's.",
        f"Load: this pair carries F_t K_A/b = {short(result.rating.specific_load)} N/mm"
        + (
            f", below the 100 N/mm from which on ISO's stiffness is whole: of it {standard.low_load_factor:.3f} is left."
            if standard.low_load_factor < 1
            else "; from 100 N/mm on ISO's stiffness knows no load."
        )
        + " Over the torques of the sweep the finite elements go from "
        f"{short(min(point.mesh_stiffness for point in result.sweep))} to "
        f"{short(max(point.mesh_stiffness for point in result.sweep))} N/(mm µm).",
        f"Sharing: ISO has the mean from c' by 0.75 ε_α + 0.25 = {0.75 * result.pair.transverse_contact_ratio + 0.25:.3f}; "
        "here the mean "
        f"is {summary.mesh_stiffness_mean / summary.single_stiffness:.3f} times the greatest of one pair.",
    ]
    return reasons

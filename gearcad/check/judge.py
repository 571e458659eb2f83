"""The comparisons that checks of both models have: gates that decide, and references with a band that inform."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.check.comparison import Comparison, Role, Subject, against, at_most
from gearcad.check.convergence import LEAST_ORDER, Convergence
from gearcad.check.extremes import PRESSURE, ROOTS
from gearcad.check.rim import bending_notes
from gearcad.check.summary import Summary
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle

__all__ = ["farness", "material_limits", "mesh_errors", "reactions", "sampling", "standards"]

_REACTION = 0.005
"""Torque on a hub against that applied: interpolation between unit loads, not equilibrium, makes up what is missing."""

_SAMPLING = 0.002
"""What positions may miss of a stress."""


def farness(computed: float, expected: float) -> float:
    """Relative distance; infinite for what is no number, which is the worst of all."""
    found = abs(computed / expected - 1)
    return found if math.isfinite(found) else math.inf


def reactions(cycle: Cycle, source: str) -> Iterator[Comparison]:
    """Torques (N·m) on the hubs, position by position, against those applied, where they differ most."""
    model = cycle.model
    force = model.force(cycle.torque) * model.width / 1000
    for role, body in model.bodies.items():
        applied = force * body.flank.base_radius
        worst = max((position.torques.pick(role) for position in cycle.every), key=lambda torque: farness(torque, applied))
        yield against(f"torque reaction of the {role.value}", worst, applied, _REACTION, "N·m", source, Role.GATE)


def mesh_errors(convergence: tuple[Convergence, ...], limits: tuple[float, ...], summary: Summary) -> Iterator[Comparison]:
    """The estimated error of each quantity, by mesh and positions together, against what it may be (relative)."""
    for each, limit in zip(convergence, limits, strict=bool(convergence)):
        unclear = "the changes from mesh to mesh show no order"
        order = unclear if each.order is None or each.order < LEAST_ORDER else f"observed order {each.order:.1f}"
        between = summary.sampling_error[each.key]
        source = "three meshes, Richardson, and what the positions may miss"
        note = f"{100 * each.error:.2g} % by the mesh ({order}), {100 * between:.2g} % by the positions"
        told = 100 * (each.error + between)
        yield at_most(f"discretisation error, {each.quantity}", told, 100 * limit, "%", source, note)


def sampling(summary: Summary, of_pressure: float = _SAMPLING) -> Iterator[Comparison]:
    """What the positions may miss of the stresses that are told, against what they may (relative)."""
    errors = summary.sampling_error
    for words, names, limit in (("root stresses", ROOTS, _SAMPLING), ("contact pressure", (PRESSURE,), of_pressure)):
        worst = max((each.name for each in names), key=lambda name: errors.get(name, math.inf))
        error = errors.get(worst, math.inf)
        yield at_most(
            f"sampling error of the {words}",
            100 * error,
            100 * limit,
            "%",
            "what can stand between the positions, by the curve beside them",
            reason="" if math.isfinite(error) else summary.missing.get(worst, "nothing is known of what stands beside it"),
        )


def material_limits(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """What the material gives a limit for."""
    material = task.material
    deep = f"{summary.von_mises_depth:.3g} mm deep" if summary.von_mises_depth is not None else ""
    away, missing = "the greatest away from the corners of the flanks", summary.missing.get
    for words, value, limit, note, reason in (
        ("contact pressure", summary.contact_pressure, material.contact_limit, away, missing("contact_pressure", "")),
        ("root stress, pinion", summary.root_tension.pinion, material.root_limit, "tension", ""),
        ("root stress, wheel", summary.root_tension.wheel, material.root_limit, "tension", ""),
        ("von Mises stress below the flank", summary.von_mises, material.yield_strength, deep, missing("von_mises", "")),
    ):
        if isinstance(limit, tuple):
            note += f"; the limit of this material lies between {limit[0]:g} and {limit[1]:g} MPa, and the lower one counts"
            limit = limit[0]
        if limit is not None:
            yield at_most(words, value, limit, "MPa", f"limit of {material.name}", note, Subject.STRENGTH, reason)


def standards(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """Root stress and stiffness against ISO 6336 or DIN 3990, with a band for what the two leave out differently."""
    edition = task.rating.edition
    root, stiffness = task.options.root_band / 100, task.options.stiffness_band / 100
    sharing = "ISO puts the whole load on one pair of teeth at its outer point; the FE shares it, and sees the true fillet"
    widths = task.rating.roots.map(lambda root: root.width)
    for owner, value, reference, width, bent in zip(
        ("pinion", "wheel"), summary.root_tension, task.rating.root_stresses, widths, bending_notes(task, summary), strict=True
    ):
        source = f"sigma_F0, {edition.dated_part(3)} Method B, over b = {width:.4g} mm"
        yield against(f"root stress, {owner}", value, reference, root, "MPa", source, Role.INFORMATION, sharing + bent)
    body = "ISO's discs are stiffer or softer than this body; see how the bodies are held"
    for words, value, reference, source in (
        (
            "mean mesh stiffness",
            summary.mesh_stiffness_mean,
            task.rating.stiffness.mesh_alpha,
            f"c_gamma_alpha, {edition.dated_part(1)} Method B",
        ),
        (
            "single stiffness",
            summary.single_stiffness,
            task.rating.stiffness.single,
            f"c', {edition.dated_part(1)} Method B",
        ),
    ):
        yield against(words, value, reference, stiffness, "N/(mm µm)", source, Role.INFORMATION, body)

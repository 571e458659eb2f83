"""The comparisons that checks of both models have: gates that decide, and references with a band that inform."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.check.comparison import Comparison, Subject, agrees, at_most, beside
from gearcad.check.convergence import LEAST_ORDER, Convergence
from gearcad.check.extremes import PRESSURE, ROOTS
from gearcad.check.rim import bending_limits, bending_notes, rim_gates
from gearcad.check.strength import CheckStrength, strength_comparisons
from gearcad.check.summary import Summary
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle
from gearcad.material import Limit, Material, by_gear

__all__ = ["compare_common", "farness", "standards"]

_REACTION = 0.005
"""Torque on a hub against that applied: interpolation between unit loads, not equilibrium, makes up what is missing."""

_SAMPLING = 0.002
"""What positions may miss of a stress."""


def compare_common(
    task: CheckTask,
    cycle: Cycle,
    summary: Summary,
    convergence: tuple[Convergence, ...],
    *,
    equilibrium: str,
    errors: tuple[float, ...],
    flicker: float = _SAMPLING,
) -> Iterator[Comparison]:
    """Gates first.

    `equilibrium` says where torques on the hubs are held against those applied, `errors` are what the mesh may do to each
    quantity, `flicker` is what positions may miss of a pressure.
    """
    yield from _reactions(cycle, equilibrium)
    yield from _mesh_errors(convergence, errors, summary)
    yield from _sampling(summary, flicker)
    yield from rim_gates(task)
    yield from _material_limits(task, summary)
    yield from bending_limits(task, summary)
    yield from strength_comparisons(CheckStrength.of(task, summary))
    yield from standards(task, summary)


def farness(computed: float, expected: float) -> float:
    """Relative distance; infinite for what is no number, which is the worst of all."""
    found = abs(computed / expected - 1)
    return found if math.isfinite(found) else math.inf


def _reactions(cycle: Cycle, source: str) -> Iterator[Comparison]:
    """Torques (N·m) on the hubs, position by position, against those applied, where they differ most."""
    model = cycle.model
    force = model.force(cycle.torque) * model.width / 1000
    for role, body in model.bodies.items():
        applied = force * body.flank.base_radius
        worst = max((position.torques.pick(role) for position in cycle.every), key=lambda torque: farness(torque, applied))
        yield agrees(f"torque reaction of the {role.value}", worst, applied, _REACTION, "N·m", source)


def _mesh_errors(convergence: tuple[Convergence, ...], limits: tuple[float, ...], summary: Summary) -> Iterator[Comparison]:
    """The estimated error of each quantity, by mesh and positions together, against what it may be (relative)."""
    for each, limit in zip(convergence, limits, strict=bool(convergence)):
        unclear = "the changes from mesh to mesh show no order"
        order = unclear if each.order is None or each.order < LEAST_ORDER else f"observed order {each.order:.1f}"
        between = summary.sampling_error[each.key]
        source = "three meshes, Richardson, and what the positions may miss"
        note = f"{100 * each.error:.2g} % by the mesh ({order}), {100 * between:.2g} % by the positions"
        told = 100 * (each.error + between)
        yield at_most(f"discretisation error, {each.quantity}", told, 100 * limit, "%", source, note)


def _sampling(summary: Summary, of_pressure: float) -> Iterator[Comparison]:
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


def _material_limits(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """What the materials give a limit for."""
    deep = f"{summary.von_mises_depth:.3g} mm deep" if summary.von_mises_depth is not None else ""
    away, missing = "the greatest away from the corners of the flanks", summary.missing.get
    every = [(f", {gear}" if gear else "", of) for gear, of in by_gear(task.material).items()]
    pressures = [(f"contact pressure{whose}", summary.contact_pressure, of, of.contact_limit) for whose, of in every]
    tensions = summary.root_tension
    roots = [(f"root stress, {role.value}", tensions.pick(role), of, of.root_limit) for role, of in task.materials.items()]
    below = [(f"von Mises stress below the flank{whose}", summary.von_mises, of, of.yield_strength) for whose, of in every]
    for found, told, reason in (
        (pressures, away, missing("contact_pressure", "")),
        (roots, "tension", ""),
        (below, deep, missing("von_mises", "")),
    ):
        for words, value, material, limit in found:
            yield from _within_limit(words, value, material, limit, told, reason)


def _within_limit(
    words: str, value: float | None, material: Material, limit: Limit, note: str, reason: str
) -> Iterator[Comparison]:
    """A stress (MPa) against the limit of a material, if it has one."""
    if isinstance(limit, tuple):
        note += f"; the limit of this material lies between {limit[0]:g} and {limit[1]:g} MPa, and the lower one counts"
        limit = limit[0]
    if limit is not None:
        yield at_most(words, value, limit, "MPa", f"limit of {material.name}", note, reason, subject=Subject.STRENGTH)


def standards(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """Root stress and stiffness against ISO 6336 or DIN 3990, with a band for what the two leave out differently."""
    edition = task.rating.edition
    root, stiffness = task.options.root_band / 100, task.options.stiffness_band / 100
    sharing = "ISO puts the whole load on one pair of teeth at its outer point; the FE shares it, and sees the true fillet"
    notes = bending_notes(task, summary)
    for role, rating in task.rating.roots.items():
        source = f"sigma_F0, {edition.dated_part(3)} Method B, over b = {rating.width:.4g} mm"
        value, reference = summary.root_tension.pick(role), task.rating.root_stresses.pick(role)
        yield beside(f"root stress, {role.value}", value, reference, root, "MPa", source, sharing + notes.pick(role))
    standard = task.rating.stiffness
    body = "ISO's discs are stiffer or softer than this body; see how the bodies are held"
    for words, value, reference, symbol in (
        ("mean mesh stiffness", summary.mesh_stiffness_mean, standard.mesh_alpha, "c_gamma_alpha"),
        ("single stiffness", summary.single_stiffness, standard.single, "c'"),
    ):
        source = f"{symbol}, {edition.dated_part(1)} Method B"
        yield beside(words, value, reference, stiffness, "N/(mm µm)", source, body)

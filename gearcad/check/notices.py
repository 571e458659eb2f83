"""Notices that an engineer should know before trusting a check."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.check.gates import rim_notices
from gearcad.check.summary import Summary
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle
from gearcad.core.records import Notice, Role
from gearcad.geometry import Gear
from gearcad.geometry.gear_data import RING_RIM_LIMIT
from gearcad.meshing.outline import round_bore_notice

__all__ = ["common_notices", "elastic_end"]

_ABSURD = 0.03
"""Stress over modulus above which strains are no longer small."""


def common_notices(task: CheckTask, cycle: Cycle, summary: Summary) -> Iterator[Notice]:
    """Yield the notices of every model: the pair, the load, the bodies and their rims, tips whose edge touches."""
    yield from task.pair.notices
    yield from _strain(task, summary)
    yield from _elastic(task, summary)
    yield from _few_teeth(task, cycle)
    yield from _bodies(task, cycle)
    yield from rim_notices(task, summary)
    yield from _corners(task, cycle, summary)


_STEEL, _METAL = 206000.0, 40000.0
"""Modulus of elasticity (MPa) to which the bounds below belong, and from which on a material is taken for a metal."""

_CONTACT, _ROOT = 4000.0, 2500.0
"""Bounds (MPa) where no yield strength is given: the static limit of rolling contact along lines (ISO 76), and about the
greatest tensile strength of steels."""

_ONSET = 1.79
"""Pressure over yield strength at which a line contact begins to yield below its surface (von Mises, nu 0.3)."""

_FEW_TEETH = 7
"""Teeth of a body between cuts from which on its mesh is within 1 % of the full ring's where pairs share the load."""


def elastic_end(task: CheckTask, summary: Summary) -> str:
    """Return in words which stress is beyond linear elasticity, of which gear and beyond which bound; empty if none is."""
    found = []
    for role, material in task.materials.items():
        own = task.rating.names.pick(role)
        known, scale = material.yield_strength, material.youngs_modulus / _STEEL
        if known is None and material.youngs_modulus < _METAL:
            continue
        words = (
            "its yield strength" if known else "the bound for the hardest steels, scaled by the modulus; give yield_strength"
        )
        contact, root = (known * _ONSET, known) if known else (_CONTACT * scale, _ROOT * scale)
        onset = f"{_ONSET} times {words}" if known else words
        for name, stress, bound, source in (
            ("contact pressure", summary.contact_pressure or 0.0, contact, onset),
            ("root stress", summary.root_tension.pick(role), root, words),
        ):
            if stress > bound:
                found.append(f"{name} of the {own} {stress:.0f} MPa exceeds {bound:.0f} MPa ({source})")
    return "; ".join(found)


def _elastic(task: CheckTask, summary: Summary) -> Iterator[Notice]:
    if text := elastic_end(task, summary):
        advice = "the material yields, so stresses and shares are not those that are told; reduce the load"
        yield Notice("beyond-elasticity", f"linear elasticity is exceeded: {text}: {advice}")


def _few_teeth(task: CheckTask, cycle: Cycle) -> Iterator[Notice]:
    teeth = task.options.body_teeth or None
    held = [task.body.teeth_held(gear) for gear in task.gears.values()]
    shared = any(len(position.contacts) > 1 for position in cycle.positions)
    if teeth is not None and shared and any(each is not None and each < _FEW_TEETH for each in held):
        text = (
            f"body_teeth = {teeth}: where several pairs of teeth share the load, the outer ones stand beside the cuts, and the "
            f"transmission error can be off by more than 3 %; use body_teeth = {_FEW_TEETH} or more, or leave it out"
        )
        yield Notice("few-teeth", text)


def _strain(task: CheckTask, summary: Summary) -> Iterator[Notice]:
    softest = min(task.materials, key=lambda material: material.youngs_modulus)
    modulus = softest.youngs_modulus
    across = modulus / (2 * (1 - softest.poisson_ratio**2))
    for words, stress, stiff in (
        ("contact pressure", summary.contact_pressure or 0.0, across),
        ("root stress", max(summary.root_tension), modulus),
    ):
        if stress > _ABSURD * stiff:
            text = f"the {words} is {stress / stiff:.1%} of the modulus: linear elasticity means little there"
            yield Notice("large-strain", text)


def _bodies(task: CheckTask, cycle: Cycle) -> Iterator[Notice]:
    for role, gear in task.gears.items():
        if gear.body.web_thickness:
            text = f"the {role.value}'s web is in the standard's stiffness alone (C_R): the finite elements are a full disc"
            yield Notice("full-disc", text)
        if gear.internal:
            yield from _rim_of(gear, cycle.model.bodies.pick(role).hub_radius)
        elif gear.body.bore_spline:
            yield round_bore_notice(gear).within(role.value)
        elif not gear.body.bore and task.body.inner_diameters.pick(role) is None:
            diameter = 2 * cycle.model.bodies.pick(role).hub_radius
            yield Notice("no-bore", f"the {role.value} has no bore: its body is taken as held on diameter {diameter:.6g} mm")


def _rim_of(ring: Gear, radius: float) -> Iterator[Notice]:
    if ring.body.rim_diameter is None:
        held = f"its body is taken as held on diameter {2 * radius:.6g} mm, {RING_RIM_LIMIT:g} m_n outside its roots"
        text = f"the ring has no body.rim_diameter: {held}"
        yield Notice("no-rim", text)


def _corners(task: CheckTask, cycle: Cycle, summary: Summary) -> Iterator[Notice]:
    if summary.corner_positions:
        relieved = any(gear.modification.tip_relief for gear in task.gears.values())
        advice = "the tip relief given does not prevent it under this load" if relieved else "tip relief would avoid it"
        early, late = cycle.tip_positions(Role.WHEEL), cycle.tip_positions(Role.PINION)
        mate = task.rating.names.wheel
        where = f"the {mate}'s before the path of contact begins at {early}, the pinion's after its end at {late}"
        yield Notice(
            "corner-contact",
            f"a tip corner touches at {summary.corner_positions} of {len(cycle.positions)} positions ({where}): its pressure "
            f"depends on the mesh and is left out; {advice}",
        )

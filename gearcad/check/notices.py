"""What an engineer should know before trusting a check."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.check.rim import rim_notices
from gearcad.check.summary import Summary
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle
from gearcad.geometry import Gear
from gearcad.notice import Notice
from gearcad.rating.rim import RING_RIM_LIMIT

__all__ = ["common_notices"]

_ABSURD = 0.03
"""Stress over modulus above which strains are no longer small."""


def common_notices(task: CheckTask, cycle: Cycle, summary: Summary) -> Iterator[Notice]:
    """Of every model: the pair, the load, the bodies and their rims, tips whose edge touches."""
    yield from task.pair.notices
    yield from _strain(task, summary)
    yield from _bodies(task, cycle)
    yield from rim_notices(task, summary)
    yield from _corners(cycle, summary)


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
    for role, gear in task.pair.gears.items():
        if gear.body.web_thickness:
            text = f"the {role.value}'s web is in the standard's stiffness alone (C_R): the finite elements are a full disc"
            yield Notice("full-disc", text)
        if gear.internal:
            yield from _rim_of(gear, cycle.model.bodies.pick(role).hub_radius)
        elif not gear.body.bore and task.body.inner_diameters.pick(role) is None:
            diameter = 2 * cycle.model.bodies.pick(role).hub_radius
            yield Notice("no-bore", f"the {role.value} has no bore: its body is taken as held on diameter {diameter:.6g} mm")


def _rim_of(ring: Gear, radius: float) -> Iterator[Notice]:
    if ring.body.rim_diameter is None:
        held = f"its body is taken as held on diameter {2 * radius:.6g} mm, {RING_RIM_LIMIT:g} m_n outside its roots"
        text = f"the ring has no body.rim_diameter: {held}"
        yield Notice("no-rim", text)


def _corners(cycle: Cycle, summary: Summary) -> Iterator[Notice]:
    if summary.corner_positions:
        yield Notice(
            "corner-contact",
            f"a tip corner touches at {summary.corner_positions} of {len(cycle.positions)} positions: its pressure depends on "
            "the mesh and is left out; tip relief would avoid it",
        )

"""What an engineer should know before trusting a check, in sentences with numbers."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.check.summary import Summary
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle

__all__ = ["corner_warnings", "general_warnings"]

_ABSURD = 0.03
"""Stress over modulus above which strains are no longer small."""


def general_warnings(task: CheckTask, cycle: Cycle, summary: Summary) -> Iterator[str]:
    """Of the pair, of the load, and of the bodies."""
    yield from task.pair.warnings
    modulus = task.material.youngs_modulus
    across = modulus / (2 * (1 - task.material.poisson_ratio**2))
    for words, stress, stiff in (
        ("contact pressure", summary.contact_pressure or 0.0, across),
        ("root stress", max(summary.root_tension), modulus),
    ):
        if stress > _ABSURD * stiff:
            yield f"the {words} is {stress / stiff:.1%} of the modulus: linear elasticity means little there"
    gears, bodies = (task.pair.pinion, task.pair.wheel), (cycle.model.pinion, cycle.model.wheel)
    given = task.body.inner_diameters
    for name, gear, body, inner in zip(("pinion", "wheel"), gears, bodies, given, strict=True):
        if gear.body.web_thickness:
            yield f"the {name}'s web is in the standard's stiffness alone (C_R): the finite elements are a full disc"
        if not gear.body.bore and inner is None:
            yield f"the {name} has no bore: its body is taken as held on diameter {2 * body.hub_radius:.6g} mm"


def corner_warnings(cycle: Cycle, summary: Summary) -> Iterator[str]:
    """Of tips whose edge touches."""
    if summary.corner_positions:
        yield (
            f"a tip corner touches at {summary.corner_positions} of {len(cycle.positions)} positions: its pressure depends on "
            "the mesh and is left out; tip relief would avoid it"
        )

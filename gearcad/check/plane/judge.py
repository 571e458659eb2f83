"""The comparisons of a check in the plane: gates that decide, and references with a band that inform."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.check.comparison import Comparison, Role, against
from gearcad.check.convergence import Convergence
from gearcad.check.judge import farness, material_limits, mesh_errors, reactions, sampling, standards
from gearcad.check.plane.summary import PlaneSummary
from gearcad.check.rim import bending_limits, rim_gates
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact

__all__ = ["compare_plane"]

_HERTZ = 0.01
_DISCRETISATION = 0.01


def compare_plane(
    task: CheckTask, cycle: PlaneCycle, summary: PlaneSummary, convergence: tuple[Convergence, ...]
) -> tuple[Comparison, ...]:
    """All comparisons, gates first."""
    return (
        *_hertz(cycle, summary),
        *reactions(cycle, "equilibrium: the torque that is applied through the teeth"),
        *mesh_errors(convergence, 3 * (_DISCRETISATION,), summary),
        *sampling(summary),
        *rim_gates(task),
        *material_limits(task, summary),
        *bending_limits(task, summary),
        *standards(task, summary),
    )


def _hertz(cycle: PlaneCycle, summary: PlaneSummary) -> Iterator[Comparison]:
    """Peak pressure and half width against two cylinders under the load carried, where they are furthest apart."""
    contacts = list(cycle.interior_contacts)
    source = "Hertz: two cylinders of the flanks' curvature under the load that this pair of teeth carries"

    def deviation(of: tuple[object, PlanePairContact], name: str, reference: str) -> float:
        computed, expected = float(getattr(of[1], name)), float(getattr(of[1], reference))
        return farness(computed, expected)

    for words, name, reference, unit in (
        ("peak contact pressure", "peak_pressure", "hertz_pressure", "MPa"),
        ("half width of contact", "half_width", "hertz_half_width", "mm"),
    ):
        if not contacts:
            reason = summary.missing["contact_pressure"]
            yield against(words, None, None, _HERTZ, unit, source, Role.GATE, reason=reason)
            continue
        position, contact = max(contacts, key=lambda of: deviation(of, name, reference))
        note = f"the worst of {len(contacts)} interior contacts, at roll angle {position.roll_angle:.2f} deg"
        reason = "its pressures have no width to tell" if math.isnan(getattr(contact, name)) else ""
        yield against(words, getattr(contact, name), getattr(contact, reference), _HERTZ, unit, source, Role.GATE, note, reason)

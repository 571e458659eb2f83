"""The comparisons of a check in the plane: gates that decide, and references with a band that inform."""

from __future__ import annotations

import math
from collections.abc import Iterator
from operator import attrgetter, itemgetter

from gearcad.check.comparison import Comparison, agrees, beside
from gearcad.check.convergence import Convergence
from gearcad.check.judge import compare_common, farness
from gearcad.check.plane.summary import PlaneSummary
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.limits import conformal

__all__ = ["compare_plane"]

_PRESSURE = 0.01
_HALF_WIDTH = 0.02
"""What contact and Hertz may differ by. The width is less sharp than the pressure: flanks are no parabolas up to the ends of
the contact, and teeth bend along it. High teeth (m 2, h_a 1.35) have 1.25 % on any mesh, with pressures within 0.8 %.
"""
_DISCRETISATION = 0.01


def compare_plane(
    task: CheckTask, cycle: PlaneCycle, summary: PlaneSummary, convergence: tuple[Convergence, ...]
) -> tuple[Comparison, ...]:
    """All comparisons, gates first."""
    equilibrium = "equilibrium: the torque that is applied through the teeth"
    common = compare_common(task, cycle, summary, convergence, equilibrium=equilibrium, errors=3 * (_DISCRETISATION,))
    return (*_hertz(cycle, summary), *common)


def _hertz(cycle: PlaneCycle, summary: PlaneSummary) -> Iterator[Comparison]:
    """Peak pressure and half width against two cylinders under the load carried, where they are furthest apart.

    Contacts too wide for two cylinders, or beside a parabolic relief, are left out; where there are no others the
    comparison is for information.
    """
    every = [found for found in cycle.interior_contacts if found[1].two_cylinders]
    narrow = [found for found in every if not conformal(found[1])]
    contacts, compared = (every, beside) if every and not narrow else (narrow, agrees)
    source = "Hertz: two cylinders of the flanks' curvature under the load that this pair of teeth carries"
    for words, computed, reference, tolerance, unit in (
        ("peak contact pressure", attrgetter("peak_pressure"), attrgetter("hertz_pressure"), _PRESSURE, "MPa"),
        ("half width of contact", attrgetter("half_width"), attrgetter("hertz_half_width"), _HALF_WIDTH, "mm"),
    ):
        if not contacts:
            reason = summary.missing.get("contact_pressure", "all contacts are on parabolic reliefs, whose curvature changes")
            yield compared(words, None, None, tolerance, unit, source, reason=reason)
            continue
        found = [(farness(computed(contact), reference(contact)), position, contact) for position, contact in contacts]
        _, position, contact = max(found, key=itemgetter(0))
        note = f"the worst of {len(contacts)} interior contacts, at roll angle {position.roll_angle:.2f} deg"
        reason = "its pressures have no width to tell" if math.isnan(computed(contact)) else ""
        yield compared(words, computed(contact), reference(contact), tolerance, unit, source, note, reason)

"""The comparisons of a check of solid bodies: gates that decide, and references with a band that inform."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.check.comparison import Comparison, beside
from gearcad.check.convergence import Convergence
from gearcad.check.face import face_factors
from gearcad.check.judge import compare_common
from gearcad.check.solid.summary import SolidSummary
from gearcad.check.task import CheckTask
from gearcad.contact.solid.cycle import SolidCycle

__all__ = ["compare_solid"]

_ERRORS = (0.01, 0.02, 0.02)
"""What the mesh may do to the mesh stiffness, and to the root stresses of both gears, each of which is that of one point."""


_FLICKER = 0.03
"""What positions may miss of a pressure: where lines cross the start of a linear relief, it flickers from cell to cell."""


def compare_solid(
    task: CheckTask, cycle: SolidCycle, summary: SolidSummary, convergence: tuple[Convergence, ...]
) -> tuple[Comparison, ...]:
    """All comparisons, gates first."""
    equilibrium = f"equilibrium: the torque that is applied through the teeth, at the worst of {len(cycle.every)} positions"
    common = compare_common(task, cycle, summary, convergence, equilibrium=equilibrium, errors=_ERRORS, flicker=_FLICKER)
    return (*common, *_contact(task, summary), *_face(task, summary))


def _contact(task: CheckTask, summary: SolidSummary) -> Iterator[Comparison]:
    """Pressure and lines of contact against part 2 of the standard and the geometry."""
    band, rating = task.options.contact_band / 100, task.rating
    away, middle = "the FE's is the greatest of all places away from edges", "in the middle of the common face width"
    standard = rating.edition.dated_part(2)
    nominal = rating.flank.nominal_stress * math.sqrt(rating.application_factor)
    for words, key, reference, source, note in (
        ("contact pressure, pinion", "contact_pressure", rating.contact_stresses.pinion, "Z_B sigma_H0", away),
        ("contact pressure, wheel", "contact_pressure", rating.contact_stresses.wheel, "Z_D sigma_H0", away),
        ("contact pressure at the pitch point", "contact_pressure_pitch_point", nominal, "sigma_H0", middle),
    ):
        value, source, reason = getattr(summary, key), f"{source}, {standard} Method B", summary.missing.get(key, "")
        yield beside(words, value, reference, band, "MPa", source, note, reason)
    lengths = task.pair.contact_line_lengths
    yield beside(
        "mean length of the lines of contact",
        summary.contact_length_mean,
        lengths.mean,
        band,
        "mm",
        "epsilon_alpha b/cos beta_b",
        "the FE counts cells that carry: bent teeth touch early and late, and modified or misaligned flanks not everywhere",
    )
    yield beside(
        "greatest line load",
        summary.line_load_max,
        rating.normal_force * rating.application_factor / lengths.minimum,
        band,
        "N/mm",
        "F_bn over the least length of the lines of contact",
        "rigid gears, load even along all lines, where these are shortest: the FE is above it by how uneven the load is",
        summary.missing.get("line_load_max", ""),
    )


def _face(task: CheckTask, summary: SolidSummary) -> Iterator[Comparison]:
    """Face load factors against Method C."""
    band, factors = task.options.contact_band / 100, face_factors(task)
    note = (
        f"Method C knows F_beta_y = {abs(factors.misalignment):.3g} µm, from misalignment and helix angle modifications alone: "
        "no edges, crowning, or deflection of the bodies"
    )
    source = "ISO 6336-1:2006 Method C"
    for words, value, reference in (
        ("face load factor K_Hbeta", summary.face_load_factor, factors.flank),
        ("face load factor K_Fbeta, pinion", summary.root_face_load_factor.pinion, factors.root),
        ("face load factor K_Fbeta, wheel", summary.root_face_load_factor.wheel, factors.root),
    ):
        yield beside(words, value, reference, band, "", source, note)

"""Why solid bodies and ISO 6336 differ: width, unevenness along the face, the load along the lines of contact, what remains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.check.explanation import Compared, Explanation, Explanations, RootCompared, root_compared
from gearcad.check.face import face_factors
from gearcad.check.solid.summary import SolidSummary, worst_place
from gearcad.check.task import CheckTask
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.per_gear import PerGear, Role

__all__ = [
    "GreatestPressure",
    "LinesExplanation",
    "SolidExplanations",
    "SolidRootExplanation",
    "explain_lines",
    "explain_roots",
]


@dataclass(frozen=True, kw_only=True)
class SolidRootExplanation(Explanation):
    """The greatest tension stands at a `height` (mm) and is `face_load_factor` (K_F_beta) times the `mean` (MPa) along the
    common width; `helix_angle_factor` is Y_beta.
    """

    compared: RootCompared
    height: float
    face_load_factor: float
    mean: float
    helix_angle_factor: float


@dataclass(frozen=True, kw_only=True)
class GreatestPressure(Explanation):
    """The greatest pressure (MPa) away from the edges: its roll angle (deg), place `across` (mm) from the middle of the common
    width, the line load (N/mm) and the reduced radius (mm) there.
    """

    pressure: float
    roll_angle: float
    across: float
    line_load: float
    radius: float


@dataclass(frozen=True, kw_only=True)
class LinesExplanation(Explanation):
    """The load along the lines of contact and along the face.

    `length` (mm) is the mean of the lines that carry, and that of rigid gears; the standard spreads F_bn K_A over the latter,
    to `mean_line_load` (N/mm) on `pitch_point_radius` (mm). K_H_beta of Method C comes from `misalignment` (F_beta_y, µm);
    that of the cycle is `greatest_across` mm from the middle.
    """

    greatest_pressure: GreatestPressure | None
    length: Compared
    mean_line_load: float
    pitch_point_radius: float
    face_load_factor: Compared
    greatest_across: float
    misalignment: float


@dataclass(frozen=True, kw_only=True)
class SolidExplanations(Explanations[SolidRootExplanation]):
    """With what solid bodies have of their lines of contact."""

    lines_of_contact: LinesExplanation


def explain_roots(task: CheckTask, cycle: SolidCycle, summary: SolidSummary) -> PerGear[SolidRootExplanation]:
    """Of both gears."""
    compared = root_compared(task, cycle, summary)

    def explained(role: Role) -> SolidRootExplanation:
        uneven = summary.root_face_load_factor.pick(role)
        return SolidRootExplanation(
            compared=compared.pick(role),
            height=summary.root_tension_height.pick(role),
            face_load_factor=uneven,
            mean=summary.root_tension.pick(role) / uneven,
            helix_angle_factor=task.rating.roots.pick(role).helix_angle_factor,
        )

    return PerGear.each(explained)


def explain_lines(task: CheckTask, cycle: SolidCycle, summary: SolidSummary) -> LinesExplanation:
    """Of the cycle."""
    rating, factors = task.rating, face_factors(task)
    length = task.pair.contact_line_lengths.mean
    across, load = cycle.load_along_face
    greatest = across[np.abs(load - summary.face_load_factor * load.mean()).argmin()]
    return LinesExplanation(
        greatest_pressure=_greatest_pressure(cycle),
        length=Compared(computed=summary.contact_length_mean, standard=length),
        mean_line_load=rating.normal_force * rating.application_factor / length,
        pitch_point_radius=rating.pitch_point.radius,
        face_load_factor=Compared(computed=summary.face_load_factor, standard=factors.flank),
        greatest_across=float(greatest),
        misalignment=factors.misalignment,
    )


def _greatest_pressure(cycle: SolidCycle) -> GreatestPressure | None:
    if (worst := worst_place(cycle)) is None:
        return None
    contact = worst.contact
    return GreatestPressure(
        pressure=worst.of(contact.pressures),
        roll_angle=worst.position.roll_angle,
        across=worst.of(contact.line.across),
        line_load=worst.of(contact.line_loads),
        radius=worst.of(contact.radii),
    )

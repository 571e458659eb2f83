"""Why finite elements and ISO 6336 differ for a pair: numbers that separate the reasons, those of every model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from gearcad.check.summary import Summary, root_peaks
from gearcad.check.sweep import SweepPoint
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle
from gearcad.per_gear import PerGear, Role
from gearcad.rating.iso6336_1 import mesh_stiffness_alpha

__all__ = [
    "Compared",
    "Explanation",
    "Explanations",
    "RootCompared",
    "StiffnessExplanation",
    "explain_stiffness",
    "root_compared",
]

_SAME_WIDTH = 1e-6
"""Part of the width below which two are one."""


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """Figures that explain a difference."""

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return {name: _plain(value) for name, value in vars(self).items()}


def _plain(value: Any) -> Any:
    if isinstance(value, PerGear):
        return {role.value: _plain(of) for role, of in value.items()}
    return value.to_dict() if isinstance(value, Explanation) else value


@dataclass(frozen=True, kw_only=True)
class Compared(Explanation):
    """A figure by finite elements, and what the standard has for it."""

    computed: float
    standard: float


@dataclass(frozen=True, kw_only=True)
class StiffnessExplanation(Explanation):
    """Stiffness in N/(mm·µm) of common face width: the `mean` of the mesh and the greatest of a `single` pair of teeth.

    `rim_depths`: how far below the root circle each body is flexible - outside that of a ring - (normal modules),
    `approach_shares` its part of the approach. `specific_load` (N/mm) is F_t K_A/b, `low_load_factor` what it leaves of the
    standard's stiffness, `sweep_least` and `sweep_greatest` what the torques of the sweep make of the mean. `mean_to_single`
    is the mean over the single stiffness.
    """

    mean: Compared
    single: Compared
    rim_depths: PerGear[float]
    blank_factor: float
    approach_shares: PerGear[float]
    specific_load: float
    low_load_factor: float
    sweep_least: float
    sweep_greatest: float
    mean_to_single: Compared


@dataclass(frozen=True, kw_only=True)
class RootCompared(Explanation):
    """Root stress (MPa) of one gear, at a tangent angle (deg) to the middle of the tooth.

    The standard spreads the load over its `width` (mm), the finite elements over the `common_width`: `on_common_width` (MPa) is
    what the standard would have there. The factors are Y_F and Y_S.
    """

    stress: Compared
    width: float
    common_width: float
    on_common_width: float
    tangent_angle: float
    form_factor: float
    stress_correction_factor: float

    @property
    def other_width(self) -> bool:
        """True if the two widths differ."""
        return abs(self.width / self.common_width - 1) > _SAME_WIDTH


R = TypeVar("R", bound=Explanation)


@dataclass(frozen=True, kw_only=True)
class Explanations(Explanation, Generic[R]):
    """Of what a standard has for every check."""

    stiffness: StiffnessExplanation
    root_stress: PerGear[R]


def root_compared(task: CheckTask, cycle: Cycle, summary: Summary) -> PerGear[RootCompared]:
    """Of both gears."""
    width, standards, peaks = cycle.model.width, task.rating.root_stresses, root_peaks(cycle)

    def compared(role: Role) -> RootCompared:
        standard, rating = standards.pick(role), task.rating.roots.pick(role)
        return RootCompared(
            stress=Compared(computed=summary.root_tension.pick(role), standard=standard),
            width=rating.width,
            common_width=width,
            on_common_width=standard * rating.width / width,
            tangent_angle=peaks.pick(role).tangent_angle,
            form_factor=rating.form_factor,
            stress_correction_factor=rating.stress_correction_factor,
        )

    return PerGear.each(compared)


def explain_stiffness(task: CheckTask, cycle: Cycle, summary: Summary, sweep: Sequence[SweepPoint]) -> StiffnessExplanation:
    """The bodies, the load, and how pairs of teeth share it."""
    standard, model = task.rating.stiffness, cycle.model
    parts = cycle.values("approach_parts").mean(axis=0)
    rims = [
        body.flank.upward * (gear.profile.root_diameter / 2 - body.hub_radius) / gear.normal_module
        for gear, body in zip(task.pair.gears, model.bodies, strict=True)
    ]
    swept = [point.mesh_stiffness for point in sweep]
    return StiffnessExplanation(
        mean=Compared(computed=summary.mesh_stiffness_mean, standard=standard.mesh_alpha),
        single=Compared(computed=summary.single_stiffness, standard=standard.single),
        rim_depths=PerGear(*rims),
        blank_factor=standard.blank_factor,
        approach_shares=PerGear(*(parts / parts.sum()).tolist()),
        specific_load=task.rating.specific_load,
        low_load_factor=standard.low_load_factor,
        sweep_least=min(swept),
        sweep_greatest=max(swept),
        mean_to_single=Compared(
            computed=summary.mesh_stiffness_mean / summary.single_stiffness,
            standard=mesh_stiffness_alpha(1.0, task.pair.transverse_contact_ratio),
        ),
    )

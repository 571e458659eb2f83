"""What a check is about, and what it found out."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

from gearcad.check.comparison import Comparison, Subject, Verdict, verdict
from gearcad.check.convergence import Convergence
from gearcad.check.options import CheckOptions, Model
from gearcad.check.solid_summary import SolidSummary
from gearcad.check.summary import PlaneSummary, Summary, by_name
from gearcad.contact.plane.cycle import Cycle
from gearcad.contact.plane.pair import BodyModel
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.per_gear import PerGear
from gearcad.rating import Rating, RatingOptions, rate

__all__ = ["CheckResult", "PlaneCheck", "SolidCheck", "SweepPoint", "Task"]


@dataclass(frozen=True, kw_only=True)
class Task:
    """What is to be checked; `pair` is as mounted."""

    pair: GearPair
    material: Material
    load: Load
    mounting: Mounting
    options: CheckOptions
    rating_options: RatingOptions = field(default_factory=RatingOptions)

    @property
    def torque(self) -> float:
        """On the pinion, with the application factor (N·m)."""
        return self.load.torque * self.load.application_factor

    @property
    def torques(self) -> tuple[float, ...]:
        """Of the sweep (N·m)."""
        return self.options.torques or tuple(part * abs(self.torque) for part in (0.1, 0.3, 0.55, 0.77, 1.0))

    @property
    def body(self) -> BodyModel:
        """The bodies as the model of the pair takes them."""
        body = self.options.body
        return body.of_solids() if self.options.model_for(self.pair) is Model.SOLID else body

    @property
    def inputs(self) -> dict[str, Any]:
        """The fields of a task by their names."""
        return {each.name: getattr(self, each.name) for each in fields(Task)}

    @cached_property
    def rating(self) -> Rating:
        """By ISO 6336 or DIN 3990, Method B."""
        return rate(self.pair, self.material, self.load, self.rating_options)


class SweepPoint(NamedTuple):
    """One torque (N·m on the pinion) of the sweep: mean mesh stiffness (N/(mm µm)), greatest pressure (None where all contacts
    are near edges) and root tensions (MPa).

    `torsional_stiffness` is M/phi of each gear (N·m/rad).
    """

    torque: float
    mesh_stiffness: float
    contact_pressure: float | None
    root_tension: PerGear[float]
    torsional_stiffness: PerGear[float]

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return by_name(self._asdict())


@dataclass(frozen=True, kw_only=True)
class CheckResult(Task):
    """A task, and everything that its check found out, whatever the model."""

    cycle: Cycle | SolidCycle
    summary: Summary
    sweep: tuple[SweepPoint, ...]
    convergence: tuple[Convergence, ...]
    comparisons: tuple[Comparison, ...]
    warnings: tuple[str, ...]

    model: ClassVar[Model]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.pair.name!r} at {self.torque:g} N·m: {self.verdict}>"

    @property
    def bodies(self) -> dict[str, str]:
        """How each body is taken, in words."""
        return self.body.describe(self.pair)

    @property
    def numerics(self) -> Verdict:
        """Whether the numbers are those of the model."""
        return verdict(self.comparisons, Subject.NUMERICS)

    @property
    def strength(self) -> Verdict:
        """Whether the material bears them; not judged without a limit."""
        return verdict(self.comparisons, Subject.STRENGTH)

    @property
    def passed(self) -> bool:
        """True if no gate fails; strength may not have been judged."""
        return Verdict.FAILED not in (self.numerics, self.strength)

    @property
    def without_limit(self) -> tuple[str, ...]:
        """What the material gives no limit for, in words."""
        material = self.material
        limits = {
            "contact pressure": material.contact_limit,
            "root stress": material.root_limit,
            "von Mises stress below the flank": material.yield_strength,
        }
        return tuple(words for words, limit in limits.items() if limit is None)

    @property
    def verdict(self) -> str:
        """Numerics and strength in one line."""
        numerics = "NOT passed" if self.numerics is Verdict.FAILED else self.numerics.value
        strength = "not judged: no limit given" if self.strength is Verdict.NOT_JUDGED else self.strength.value
        if self.without_limit and self.strength is not Verdict.NOT_JUDGED:
            strength += f"; not judged, no limit given: {', '.join(self.without_limit)}"
        return f"numerics {numerics}; strength {strength}"

    @property
    def notices(self) -> tuple[str, ...]:
        """What to know before trusting the check: its own warnings, and those of the rating."""
        return (*self.warnings, *(f"rating: {warning}" for warning in self.rating.warnings))


@dataclass(frozen=True, kw_only=True, repr=False)
class PlaneCheck(CheckResult):
    """A check in the transverse section through the middle of the common face width."""

    cycle: Cycle
    summary: PlaneSummary

    model: ClassVar[Model] = Model.PLANE


@dataclass(frozen=True, kw_only=True, repr=False)
class SolidCheck(CheckResult):
    """A check of solid bodies; under a negative torque `cycle` is that of the mirrored pair."""

    cycle: SolidCycle
    summary: SolidSummary

    model: ClassVar[Model] = Model.SOLID

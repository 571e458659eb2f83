"""CheckResult: what a check found out, whatever the model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from gearcad.check.comparison import Comparison, Subject, Verdict, verdict
from gearcad.check.convergence import Convergence
from gearcad.check.options import CheckOptions, Model
from gearcad.check.summary import Summary
from gearcad.check.sweep import SweepPoint
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating import Rating

__all__ = ["CheckResult"]


@dataclass(frozen=True, kw_only=True)
class CheckResult:
    """A task, and everything that its check found out."""

    task: CheckTask
    cycle: PlaneCycle | SolidCycle
    summary: Summary
    sweep: tuple[SweepPoint, ...]
    convergence: tuple[Convergence, ...]
    comparisons: tuple[Comparison, ...]
    warnings: tuple[str, ...]

    model: ClassVar[Model]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.pair.name!r} at {self.torque:g} N·m: {self.verdict}>"

    # ------------------------------------------------------------------ the task

    @property
    def pair(self) -> GearPair:
        """As mounted."""
        return self.task.pair

    @property
    def material(self) -> Material:
        """Of both gears."""
        return self.task.material

    @property
    def load(self) -> Load:
        """As it was given."""
        return self.task.load

    @property
    def mounting(self) -> Mounting:
        """How the pair stands; its change of the centre distance is in the pair already."""
        return self.task.mounting

    @property
    def options(self) -> CheckOptions:
        """As they were given."""
        return self.task.options

    @property
    def torque(self) -> float:
        """On the pinion, with the application factor (N·m)."""
        return self.task.torque

    @property
    def rating(self) -> Rating:
        """By ISO 6336 or DIN 3990, Method B."""
        return self.task.rating

    # ------------------------------------------------------------------ the verdict

    @property
    def bodies(self) -> dict[str, str]:
        """How each body is taken, in words."""
        return self.task.body.describe(self.pair)

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

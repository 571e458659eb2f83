"""CheckResult: what a check found out, whatever the model."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from gearcad.check.comparison import Comparison, Subject, verdict
from gearcad.check.convergence import Convergence
from gearcad.check.explanation import Explanations
from gearcad.check.load_share import LoadShare
from gearcad.check.notices import elastic_end
from gearcad.check.options import CheckOptions, Model
from gearcad.check.relief_start import ReliefStart
from gearcad.check.stiffness import StiffnessMethods, stiffness_methods
from gearcad.check.strength import CheckStrength
from gearcad.check.summary import Summary, root_peaks
from gearcad.check.sweep import SweepPoint, SweepTrends
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle, LoadedPosition, RootStress
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials, by_gear
from gearcad.mounting import Mounting
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear
from gearcad.rating.rate import Rating
from gearcad.rating.strength import Part
from gearcad.reprs import Pictured
from gearcad.stiffness import StiffnessMethod
from gearcad.verdict import NOT_ASKED_WORDS, Verdict, strength_verdict

__all__ = ["CheckResult"]


class MeanLag(NamedTuple):
    """How far the wheel lags behind the pinion on the mean, and what each gear gives of it (µm along the line of action)."""

    whole: float
    parts: PerGear[float]


@dataclass(frozen=True, kw_only=True)
class CheckResult(Pictured, ABC):
    """A task, and everything that its check found out."""

    task: CheckTask
    cycle: Cycle
    summary: Summary
    sweep: tuple[SweepPoint, ...]
    convergence: tuple[Convergence, ...]
    comparisons: tuple[Comparison, ...]
    notices: tuple[Notice, ...]
    relief_starts: tuple[ReliefStart, ...] = ()

    model: ClassVar[Model]

    shown_by_reports: ClassVar[tuple[str, ...]]
    """What is solved for reports only."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.pair.name!r} at {self.torque:g} N·m: {self.verdict}>"

    # ------------------------------------------------------------------ the task

    @property
    def pair(self) -> GearPair:
        """As mounted."""
        return self.task.pair

    @property
    def material(self) -> Materials:
        """Of both gears, or of each."""
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
        """By ISO 6336 or DIN 3990, Method B: nominal stresses with K_A."""
        return self.task.rating

    @cached_property
    def safeties(self) -> CheckStrength:
        """The full rating, and safeties by the stresses of finite elements beside its own."""
        return CheckStrength.of(self.task, self.summary)

    # ------------------------------------------------------------------ over the mesh

    @property
    def single_positions(self) -> int:
        """How many of the even positions have one pair of teeth in contact."""
        return sum(len(position.contacts) == 1 for position in self.cycle.positions)

    @property
    def mean_lag(self) -> MeanLag:
        """The transmission error on the mean."""
        whole, parts = (self.cycle.mean(name)[0] for name in ("transmission_error", "approach_parts"))
        return MeanLag(float(whole), PerGear(*(1000 * parts).tolist()))

    @property
    def bending(self) -> PerGear[bool]:
        """Whether the rim of each gear bends."""
        return self.task.body.supports(self.pair).map(lambda support: support.bends)

    @cached_property
    def load_share(self) -> LoadShare:
        """Of one pair of teeth while it goes through the mesh."""
        return LoadShare.of(self.cycle)

    @cached_property
    def root_positions(self) -> PerGear[LoadedPosition[Any]]:
        """Where the root tension of each gear is greatest."""
        return PerGear.each(self.cycle.worst_position)

    @property
    def root_peaks(self) -> PerGear[RootStress]:
        """The greatest root tension of each gear."""
        return root_peaks(self.cycle)

    @property
    def trends(self) -> SweepTrends:
        """How the figures go with the torque."""
        return SweepTrends.of(self.sweep)

    def solve_shown(self) -> None:
        """Solve now what reports show, which is else solved when it is first asked for."""
        for name in self.shown_by_reports:
            getattr(self, name)

    @property
    @abstractmethod
    def explanations(self) -> Explanations[Any]:
        """Why finite elements and the standard differ."""

    @cached_property
    def stiffness_methods(self) -> StiffnessMethods:
        """The mesh stiffness by the check's own model beside closed forms; solved when it is first asked for."""
        return stiffness_methods(self.task, self._as_method, len(self.cycle.positions))

    @abstractmethod
    def _as_method(self, mounting: Mounting) -> StiffnessMethod:
        """The bodies of the check as a method of mesh stiffness, for the pair as it is mounted."""

    # ------------------------------------------------------------------ files and documents

    @property
    def own_document(self) -> dict[str, Any]:
        """What `check.json` has of this model only."""
        return {}

    @property
    def stress_files(self) -> Mapping[str, Callable[[Path], None]]:
        """What writes stress fields to a path, by the names of files; there are none in the plane."""
        return {}

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
        """The verdict on strength by `strength_verdict`: the rating's, with the limits of local stresses as further gates."""
        rating = self.safeties.rating
        gates = verdict(self.comparisons, Subject.STRENGTH)
        return strength_verdict(rating.asked, rating.required_verdicts, [gates] if gates is Verdict.FAILED else [])

    @property
    def passed(self) -> bool:
        """Whether no gate of the numerics fails, and strength is passed or not asked for."""
        return self.numerics is not Verdict.FAILED and not self.strength.falls_short

    @property
    def without_limit(self) -> tuple[str, ...]:
        """What neither the material has a limit for nor the rating judges, in words."""
        limits = {
            "contact pressure": ("contact_limit", Part.FLANK),
            "root stress": ("root_limit", Part.ROOT),
            "von Mises stress below the flank": ("yield_strength", None),
        }
        return tuple(
            f"{words} of the {gear}" if gear else words
            for words, (limit, part) in limits.items()
            for gear, material in by_gear(self.material).items()
            if getattr(material, limit) is None and not self._rates(part)
        )

    def _rates(self, part: Part | None) -> bool:
        """Whether the rating judges this of both gears."""
        return part is not None and all(each.rated.safety is not None for each in self.safeties.parts[part])

    @property
    def verdict(self) -> str:
        """Numerics and strength in one line."""
        numerics = "NOT passed" if self.numerics is Verdict.FAILED else self.numerics.value
        strength = {
            Verdict.NOT_JUDGED: f"not judged: {self._not_judged}",
            Verdict.NOT_ASKED: NOT_ASKED_WORDS,
        }.get(self.strength, self.strength.value)
        if below := self.safeties.below_required:
            standard = self.safeties.rating.options.standard.part(2)[:-2]
            strength += f" by {standard}; by finite elements {', '.join(below)}"
        if self.without_limit and self.strength in (Verdict.PASSED, Verdict.FAILED):
            strength += f"; not judged, no limit given: {', '.join(self.without_limit)}"
        ended = "; linear elasticity has ended, see the warnings" if elastic_end(self.task, self.summary) else ""
        return f"numerics {numerics}{ended}; strength {strength}"

    @property
    def _not_judged(self) -> str:
        """Why strength was not: each reason of the rating once."""
        return "; ".join(dict.fromkeys(self.safeties.rating.not_judged.values()))

    # ------------------------------------------------------------------ what to know before trusting it

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    @property
    def all_notices(self) -> tuple[Notice, ...]:
        """Its own, and those of the rating."""
        return (*self.notices, *(notice.within("rating") for notice in self.rating.notices))

"""LevelStudy: a train by several of its models, side by side, and which of them is enough."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from gearcad.dynamics.levels.agreement import OUTSIDE, SHIFT, NotJudged
from gearcad.dynamics.levels.verdict import LevelStatus, LevelVerdict
from gearcad.dynamics.operating import OperatingRange
from gearcad.dynamics.side_by_side import SideBySide
from gearcad.dynamics.trains.train import TrainModel

__all__ = ["LevelStudy", "finest_first"]


_COARSEST_FIRST = (
    TrainModel.ISOLATED,
    TrainModel.MASSLESS,
    TrainModel.MODES,
    TrainModel.ELEMENTS,
    TrainModel.EXACT,
)


def finest_first(models: Iterable[TrainModel]) -> list[TrainModel]:
    """The models by how much they know of the shafts."""
    return sorted(models, key=_COARSEST_FIRST.index, reverse=True)


@dataclass(frozen=True, kw_only=True, eq=False)
class LevelStudy(SideBySide):
    """Models of one train held against the finest of them, over the speeds at which it runs under load.

    A model is enough if, at every speed of that range, for K_v of every mesh and the overload of every shaft that it has:
    the reference's greatest load is at most `tolerance` above the greatest that the model has within `SHIFT` of that speed
    (else the model says too little), and the model's is at most `tolerance` above the greatest that the reference has there
    (else it says too much, which is on the safe side). Loads are the greater of running up and down, in parts of the
    reference's load at rest. A resonance is missed if K_v of the reference rises to it by more than the tolerance, the model
    says too little there by more than that, and has no maximum within 10 % of its speed. `verdicts` are of all models
    but the reference, the coarsest first.
    """

    over: OperatingRange
    tolerance: float
    verdicts: tuple[LevelVerdict, ...]

    @property
    def models(self) -> tuple[TrainModel, ...]:
        """In the order of the studies."""
        return tuple(study.train.model for study in self.studies)

    @property
    def reference(self) -> int:
        """The finest model."""
        return self.models.index(finest_first(self.models)[0])

    @property
    def speed_tolerance(self) -> float:
        """How far (relative) a resonance may be off in speed."""
        return SHIFT

    @property
    def enough(self) -> LevelVerdict | None:
        """The coarsest model that is, if any but the reference."""
        return next((each for each in self.verdicts if each.status is LevelStatus.ENOUGH), None)

    @property
    def idle_shafts(self) -> tuple[str, ...]:
        """Shafts that carry next to nothing at rest in any model: their overload says nothing."""
        known = dict.fromkeys(name for study in self.studies for name in study.up.shaft_names)
        return tuple(name for name in known if name not in self.shaft_names)

    @property
    def sentence(self) -> str:
        """Which model is enough, with its numbers, and what decides: all in one."""
        return " ".join(self.sentences)

    @property
    def sentences(self) -> tuple[str, ...]:
        """The same, one of all and then one of each model."""
        return self._said(f"{each.sentence}." for each in self.verdicts)

    @property
    def headlines(self) -> tuple[str, ...]:
        """Of the sentences what comes first, for the screen."""
        return self._said(f"{each.headline}." for each in self.verdicts)

    @property
    def beyond_charts(self) -> tuple[NotJudged, ...]:
        """What of the operating range no chart shows."""
        found = (each for verdict in self.verdicts for each in verdict.agreement.not_judged if each.reason in OUTSIDE)
        return tuple({(each.first, each.last): each for each in found}.values())

    def _said(self, verdicts: Iterable[str]) -> tuple[str, ...]:
        """What is found of all, with what is left out of it; of each model; and of shafts that are not judged."""
        finest = f'"{self.models[self.reference].value}"'
        found = f"no model coarser than {finest} is shown to be enough"
        if self.enough is not None:
            found = f'the coarsest model that is enough is "{self.enough.model.value}"'
        allowed = f"within {100 * self.tolerance:.3g} % of the load at rest and {100 * self.speed_tolerance:.3g} % of the speed"
        gaps = [f"{each.first:.5g} to {each.last:.5g} rpm, {each.reason.value}" for each in self.beyond_charts]
        words = self.over.words[0].upper() + self.over.words[1:]
        over = f"{words}, of which not judged: {'; '.join(gaps)}" if gaps else words
        parts = [f"{over}, held against {finest}, {allowed}: {found}.", *verdicts]
        if self.idle_shafts:
            parts.append(f"Shafts that carry next to nothing at rest are not judged: {', '.join(self.idle_shafts)}.")
        return tuple(parts)

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {
            **super().to_dict(),
            "operating_range": self.over.to_dict(),
            "level_tolerance": self.tolerance,
            "speed_tolerance": self.speed_tolerance,
            "verdicts": [each.to_dict() for each in self.verdicts],
            "enough": None if self.enough is None else self.enough.model.value,
            "idle_shafts": list(self.idle_shafts),
            "sentence": self.sentence,
        }

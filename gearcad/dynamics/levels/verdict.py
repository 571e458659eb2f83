"""LevelVerdict: whether one model of a train is enough, with the numbers that say so, and what decides."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

from gearcad.dynamics.levels.agreement import Agreement, CurveName, Difference, percent
from gearcad.dynamics.levels.deciding import Decision
from gearcad.dynamics.trains.train import TrainModel

__all__ = ["LevelResonance", "LevelStatus", "LevelVerdict"]


_SAID = 2
"""Modes of which a sentence says what they have where; tables have all of them."""


class LevelStatus(Enum):
    """What is said of a model."""

    ENOUGH = "enough"
    """All loads agree at all speeds."""
    NOT_ENOUGH = "not enough"
    """Some load is too small or too great at some speed."""
    OPEN = "not shown"
    """All loads agree where that can be judged, but it cannot be everywhere."""


class LevelResonance(NamedTuple):
    """A resonance of the reference, higher than the tolerance, at a `speed` (rpm), and the greatest K_v of the level `near`
    that; `own_speed` and `own_factor` are those of the level's resonance, None where it has none there. It is `missed` if the
    level has none there and says too little."""

    mesh: str
    speed: float
    factor: float
    near: float
    own_speed: float | None
    own_factor: float | None
    missed: bool

    @property
    def moved(self) -> float | None:
        """How far (relative) the level has it off."""
        return None if self.own_speed is None else self.own_speed / self.speed - 1

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {**self._asdict(), "moved": self.moved}


@dataclass(frozen=True, kw_only=True, eq=False)
class LevelVerdict:
    """Of a `model` held against the `reference`: loads may differ by `tolerance`, in parts of the load at rest.

    `resonances` are those of the reference in the range; `decisions` say what the model lacks where it fails.
    """

    model: TrainModel
    reference: TrainModel
    tolerance: float
    agreement: Agreement
    resonances: tuple[LevelResonance, ...]
    decisions: tuple[Decision, ...]

    @property
    def status(self) -> LevelStatus:
        """Open where nothing is wrong, but not all can be judged."""
        if self.too_little is not None or self.too_much is not None:
            return LevelStatus.NOT_ENOUGH
        found = self.agreement
        unjudged = found.not_judged or found.unheld or found.doubts or not found.under
        return LevelStatus.OPEN if unjudged else LevelStatus.ENOUGH

    @property
    def too_little(self) -> Difference | None:
        """Where the model is most on the unsafe side, if by more than the tolerance."""
        return self._beyond(self.agreement.underestimate)

    @property
    def too_much(self) -> Difference | None:
        """Where it is most on the safe side, if by more than the tolerance."""
        return self._beyond(self.agreement.overestimate)

    def _beyond(self, found: Difference | None) -> Difference | None:
        return found if found is not None and found.excess > self.tolerance else None

    @property
    def missed(self) -> tuple[LevelResonance, ...]:
        """Those of which the model says least first."""
        return tuple(sorted((each for each in self.resonances if each.missed), key=lambda each: each.near - each.factor))

    # ------------------------------------------------------------------ in words

    @property
    def sentence(self) -> str:
        """With its numbers."""
        return f'"{self.model.value}" {"; ".join(self._clauses())}'

    @property
    def headline(self) -> str:
        """Its first clause, with the first of its failures only."""
        first = next(self._clauses())
        if self.status is LevelStatus.NOT_ENOUGH:
            first = f"is not enough: {next(self._failures())}"
        return f'"{self.model.value}" {first}'

    def _clauses(self) -> Iterator[str]:
        name, of = f'"{self.reference.value}"', self.agreement
        if of.underestimate is None or of.overestimate is None:
            yield f"cannot be held against {name} at any of these speeds"
        elif self.status is LevelStatus.NOT_ENOUGH:
            yield f"is not enough: {', and '.join(self._failures())}"
            yield from self._reasons()
        else:
            open_words = "agrees where it can be judged" if self.status is LevelStatus.OPEN else "is enough"
            yield (
                f"{open_words}: its loads are at most {percent(max(of.underestimate.excess, 0.0))} of the load at rest below "
                f"those of {name}, and {percent(max(of.overestimate.excess, 0.0))} above"
            )
        if self.model is TrainModel.ISOLATED:
            yield "of shafts it says nothing"
        yield from self._gaps()

    def _failures(self) -> Iterator[str]:
        """Too little before too much."""
        little, much, missed = self.too_little, self.too_much, self.missed
        if missed:
            yield self._missed_words()
        if little is not None and not any(_names(each, little) for each in missed[:1]):
            where = f"{_load(little.curve)} at {_rpm(little.speed)} is {little.greater:.3f}, not {little.other:.3f}"
            yield f"it says up to {percent(little.excess)} of the load too little ({where})"
        if much is not None:
            where = f"{_load(much.curve)} at {_rpm(much.speed)} is {much.other:.3f}, not {much.greater:.3f}"
            safe = ", which is on the safe side" if little is None else ""
            yield f"it says up to {percent(much.excess)} of the load too much{safe} ({where})"

    def _missed_words(self) -> str:
        first, *others = self.missed
        words = f"it misses the resonance of {first.mesh} at {_rpm(first.speed)} (K_v {first.factor:.3f}, not {first.near:.3f})"
        return words + (f" and {len(others)} other{'s' if len(others) > 1 else ''}" if others else "")

    def _reasons(self) -> Iterator[str]:
        """What it lacks, for the modes that decide most, each once."""
        first = {each.mode: each for each in reversed(self.decisions) if each.shares}
        for each in [each for each in self.decisions if first.get(each.mode) is each][:_SAID]:
            mode = f"at {_rpm(each.speed)} natural mode {each.mode} ({each.frequency:.5g} Hz) decides"
            yield f"{mode}, with {' and '.join(share.words for share in each.shares)}"

    def _gaps(self) -> Iterator[str]:
        """What is not judged."""
        for each in self.agreement.not_judged:
            charts = f" in {' and '.join(each.charts)}" if len(each.charts) == 1 else ""
            yield f"not judged from {each.first:.5g} to {each.last:.5g} rpm: {each.reason.value}{charts}"
        if self.agreement.unheld:
            yield f"not judged: the overload of {', '.join(self.agreement.unheld)}, which only one of both has"
        for doubt in self.agreement.doubts:
            yield f"not sure: {doubt.words}, in {' and '.join(doubt.charts)}"

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {
            "model": self.model.value,
            "status": self.status.value,
            "underestimates": [each.to_dict() for each in self.agreement.under],
            "overestimates": [each.to_dict() for each in self.agreement.over],
            "resonances": [each.to_dict() for each in self.resonances],
            "missed": [each.to_dict() for each in self.missed],
            "not_judged": [each.to_dict() for each in self.agreement.not_judged],
            "shafts_not_judged": list(self.agreement.unheld),
            "doubts": [each.to_dict() for each in self.agreement.doubts],
            "deciding": [each.to_dict() for each in self.decisions],
            "sentence": self.sentence,
        }


def _names(resonance: LevelResonance, difference: Difference) -> bool:
    """Whether both are of the same maximum."""
    near = abs(difference.speed / resonance.speed - 1) < 0.05
    return near and difference.curve == CurveName("mesh", resonance.mesh)


def _load(curve: CurveName) -> str:
    return f"K_v of {curve.name}" if curve.kind == "mesh" else f"the overload of shaft {curve.name}"


def _rpm(speed: float) -> str:
    return f"{speed:.5g} rpm"

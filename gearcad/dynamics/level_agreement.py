"""Agreement of a model of a train with a finer one over the operating speeds.

Loads are the greatest of a period, running up or down whichever is greater, in parts of the reference's load at rest: of meshes
K_v, of shafts their overload.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Bools, Floats, Indices, JsonObject, freeze
from gearcad.dynamics.options import OperatingRange
from gearcad.dynamics.response.kv_chart import KvChart
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.train import good_up_to

SHIFT = 0.025
"""Relative difference in speed that a resonance may have: less than the accuracy to which a speed is known or held."""


_SAME = 1e-9
"""Relative difference below which two speeds count as equal."""


class CurveName(NamedTuple):
    """Name of a load curve: its `kind` ("mesh" or "shaft") and the `name` of the mesh or shaft."""

    kind: str
    name: str


class Reason(Enum):
    """Reason for not comparing loads at some speeds."""

    BELOW = "below the first speed of the chart"
    BEYOND = "beyond the last speed of the chart"
    UNSTABLE = "no steady motion lasts"
    COARSE = "shafts have more half waves than their elements are good for"
    APART = "flanks would part, but are taken to stick"


OUTSIDE = (Reason.BELOW, Reason.BEYOND)
"""Reasons of speeds that lie outside the charts."""

_DOUBTS = {
    "long-period": "resonances between the speeds are not looked for",
    "low-resonances": "resonances at low speeds are not looked for",
    "hardly-damped": "resonances of modes that are hardly damped are higher than shown",
    "harmonics-left-out": "at some speeds more harmonics would be needed",
}
"""Doubts that the notices of a chart, by their code, raise about a comparison."""


class Doubt(NamedTuple):
    """A doubt, in words, about what the `charts` of one or both models may not show."""

    words: str
    charts: tuple[str, ...]

    def to_dict(self) -> JsonObject:
        """Return the entry of the doubt in `dynamics.json`."""
        return {"words": self.words, "charts": list(self.charts)}


class NotJudged(NamedTuple):
    """A range of speeds from `first` to `last` (rpm) that is not judged, the reason, and the labels of its charts."""

    first: float
    last: float
    reason: Reason
    charts: tuple[str, ...]

    def to_dict(self) -> JsonObject:
        """Return the entry of the range in `dynamics.json`."""
        return {**self._asdict(), "reason": self.reason.value, "charts": list(self.charts)}


class Difference(NamedTuple):
    """A load `greater` of one of two models at a `speed` (rpm), and the greatest load `other` of the other model nearby."""

    curve: CurveName
    speed: float
    greater: float
    other: float

    @property
    def excess(self) -> float:
        """Difference of both loads, in parts of the load at rest."""
        return self.greater - self.other

    def to_dict(self) -> JsonObject:
        """Return the entry of the difference in `dynamics.json`."""
        return {
            **self.curve._asdict(),
            "speed": self.speed,
            "greater": self.greater,
            "other": self.other,
            "excess": self.excess,
        }


@dataclass(frozen=True, eq=False)
class Agreement:
    """Loads of `curves` (c) at `speeds` (s,) in the range, rpm: `reference` (s, c) and `level` (s, c), and the greatest that
    each of both has near those speeds: `near_reference` and `near_level` (s, c). Some speeds (s,) are `judged`.

    `unheld` are shafts that have an overload in one of both only; `doubts` say what the charts may not show.
    """

    curves: tuple[CurveName, ...]
    speeds: Floats
    reference: Floats
    level: Floats
    near_reference: Floats
    near_level: Floats
    judged: Bools
    not_judged: tuple[NotJudged, ...]
    unheld: tuple[str, ...]
    doubts: tuple[Doubt, ...]

    def __post_init__(self) -> None:
        freeze(self)

    @cached_property
    def under(self) -> tuple[Difference, ...]:
        """Greatest excess of the reference over the level for each curve; empty where nothing is judged."""
        return self._greatest(self.reference, self.near_level)

    @cached_property
    def over(self) -> tuple[Difference, ...]:
        """Greatest excess of the level over the reference for each curve; empty where nothing is judged."""
        return self._greatest(self.level, self.near_reference)

    def _greatest(self, loads: Floats, others: Floats) -> tuple[Difference, ...]:
        if not self.judged.any():
            return ()
        rows = np.flatnonzero(self.judged)[(loads - others)[self.judged].argmax(axis=0)]
        return tuple(
            Difference(curve, float(self.speeds[row]), float(loads[row, column]), float(others[row, column]))
            for column, (curve, row) in enumerate(zip(self.curves, rows, strict=True))
        )

    def under_at(self, mesh: str, speed: float) -> Difference | None:
        """Return the load of the reference at one of the speeds and of the level near it; None where that is not judged."""
        row, column = int(np.abs(self.speeds - speed).argmin()), self.curves.index(CurveName("mesh", mesh))
        if not self.judged[row]:
            return None
        return Difference(self.curves[column], speed, float(self.reference[row, column]), float(self.near_level[row, column]))

    @property
    def underestimate(self) -> Difference | None:
        """Greatest difference of all curves by which the reference is above the level; None where nothing is judged."""
        return max(self.under, key=lambda each: each.excess, default=None)

    @property
    def overestimate(self) -> Difference | None:
        """Greatest difference of all curves by which the level is above the reference; None where nothing is judged."""
        return max(self.over, key=lambda each: each.excess, default=None)


@dataclass(frozen=True, eq=False)
class _Curves:
    """Loads (s, c) at speeds (s,), and for each reason the speeds (s,) at which loads are not to be compared."""

    speeds: Floats
    loads: Floats
    faults: dict[Reason, Bools]

    def at(self, speeds: Floats) -> _Curves:
        """Return the curves interpolated at other speeds (x,) within the same range."""
        loads = np.stack([np.interp(speeds, self.speeds, column) for column in self.loads.T], axis=1)
        faults = {
            reason: np.asarray(np.interp(speeds, self.speeds, marked.astype(float)) > 0, bool)
            for reason, marked in self.faults.items()
        }
        return _Curves(speeds, loads, faults)


def agreement(reference: TrainStudy, level: TrainStudy, labels: tuple[str, str], over: OperatingRange) -> Agreement:
    """Return the agreement of the level with the reference over a range of speeds; `labels` name reference and level.

    The level says too little where the reference has a load that the level has at no speed within `SHIFT` of that speed, and
    too much in the opposite case. A speed is judged if both models are known throughout that distance.
    """
    names, unheld = _common(reference, level)
    first, last = max(reference.speeds[0], level.speeds[0]), min(reference.speeds[-1], level.speeds[-1])
    speeds = np.union1d(reference.speeds, level.speeds)
    speeds = np.union1d(speeds, [each for each in (over.first, over.last) if first <= each <= last])
    wide = (speeds >= max(first, over.first / (1 + SHIFT))) & (speeds <= min(last, over.last * (1 + SHIFT)))
    speeds = speeds[wide]
    of, to = (_curves(each, reference, names).at(speeds) for each in (reference, level))
    window = np.searchsorted(speeds, speeds / (1 + SHIFT)), np.searchsorted(speeds, speeds * (1 + SHIFT), side="right")
    faults = [{reason: _any(marked, window) for reason, marked in each.faults.items()} for each in (of, to)]
    inside = (speeds >= over.first) & (speeds <= over.last)
    judged = ~np.any([marked for each in faults for marked in each.values()], axis=0)
    near = [_highest(each.loads, window)[inside] for each in (of, to)]
    found = _outside(over, float(first), float(last), labels) + _not_judged(speeds, inside, faults, labels)
    return Agreement(
        curves=tuple(names),
        speeds=speeds[inside],
        reference=of.loads[inside],
        level=to.loads[inside],
        near_reference=near[0],
        near_level=near[1],
        judged=judged[inside],
        not_judged=found,
        unheld=unheld,
        doubts=_doubts((reference, level), labels),
    )


def _common(reference: TrainStudy, level: TrainStudy) -> tuple[list[CurveName], tuple[str, ...]]:
    """Return the curves of both studies, and the shafts known to both of which only one study has an overload."""
    known = set(reference.up.shaft_names) & set(level.up.shaft_names)
    shafts = [name for name in reference.up.shaft_names if name in known]
    both = [name in reference.shaft_overloads and name in level.shaft_overloads for name in shafts]
    one = [name in reference.shaft_overloads or name in level.shaft_overloads for name in shafts]
    meshes = [CurveName("mesh", name) for name in reference.up.mesh_names]
    held = [CurveName("shaft", name) for name, kept in zip(shafts, both, strict=True) if kept]
    unheld = tuple(name for name, some, all_of in zip(shafts, one, both, strict=True) if some and not all_of)
    return [*meshes, *held], unheld


def _curves(study: TrainStudy, reference: TrainStudy, names: list[CurveName]) -> _Curves:
    """Return the loads of a study in parts of the reference's at rest, and the speeds at which they are not to be compared."""
    charts = [chart for _, chart in study.charts.directions()]
    loads = [np.max([_load(chart, name) for chart in charts], axis=0) / _rest(reference.up, name) for name in names]
    stuck = np.array([mesh.backlash is None for mesh in study.excitation.meshes]) | (study.down is None)
    faults = {
        Reason.UNSTABLE: np.asarray(~np.all([chart.stable for chart in charts], axis=0), bool),
        Reason.COARSE: np.asarray(study.speeds > good_up_to(study.train), bool),
        Reason.APART: np.asarray(np.any([(chart.least[:, stuck] <= 0).any(axis=1) for chart in charts], axis=0), bool),
    }
    return _Curves(study.speeds, np.stack(loads, axis=1), faults)


def _load(chart: KvChart, name: CurveName) -> Floats:
    """Return the load of a curve over speed (s,), in N for a mesh or N·m for a shaft."""
    if name.kind == "mesh":
        column = chart.mesh_names.index(name.name)
        return np.asarray(chart.factors[:, column] * chart.static_forces[column], float)
    column = chart.shaft_names.index(name.name)
    return np.asarray(chart.shaft_factors[:, column] * chart.shaft_references[column], float)


def _rest(chart: KvChart, name: CurveName) -> float:
    if name.kind == "mesh":
        return float(chart.static_forces[chart.mesh_names.index(name.name)])
    return float(chart.shaft_references[chart.shaft_names.index(name.name)])


# ---------------------------------------------------------------------- near a speed


def _highest(loads: Floats, window: tuple[Indices, Indices]) -> Floats:
    """Return the greatest load (s, c) in the window about each speed."""
    if not len(loads):
        return loads
    bounds = np.stack(window, axis=1).ravel()
    padded = np.concatenate([loads, np.full((1, loads.shape[1]), -np.inf)])
    return np.asarray(np.maximum.reduceat(padded, bounds, axis=0)[::2], float)


def _any(marked: Bools, window: tuple[Indices, Indices]) -> Bools:
    """Return whether (s,) any speed in the window about each speed is marked."""
    count = np.concatenate([[0], np.cumsum(marked)])
    return np.asarray(count[window[1]] > count[window[0]], bool)


# ---------------------------------------------------------------------- what cannot be judged


def _outside(over: OperatingRange, first: float, last: float, labels: tuple[str, str]) -> tuple[NotJudged, ...]:
    """Return the parts of the operating range that the charts do not show."""
    below = [NotJudged(over.first, min(first, over.last), Reason.BELOW, labels)] if over.first < first * (1 - _SAME) else []
    beyond = [NotJudged(max(last, over.first), over.last, Reason.BEYOND, labels)] if over.last > last * (1 + _SAME) else []
    return (*below, *beyond)


def _not_judged(
    speeds: Floats, inside: Bools, faults: list[dict[Reason, Bools]], labels: tuple[str, str]
) -> tuple[NotJudged, ...]:
    """Return the ranges of speeds within the operating range that are not judged, each reason by itself."""
    found = []
    for reason in faults[0]:
        marked = inside & (faults[0][reason] | faults[1][reason])
        turns = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int))).reshape(-1, 2)
        for start, end in turns.tolist():
            charts = tuple(label for label, each in zip(labels, faults, strict=True) if each[reason][start:end].any())
            found.append(NotJudged(float(speeds[start]), float(speeds[end - 1]), reason, charts))
    return tuple(found)


def _doubts(studies: tuple[TrainStudy, TrainStudy], labels: tuple[str, str]) -> tuple[Doubt, ...]:
    """Return the doubts that the notices of both charts raise, each with the labels of its charts."""
    found: dict[str, list[str]] = {}
    for label, study in zip(labels, studies, strict=True):
        for code in dict.fromkeys(notice.code for notice in study.notices):
            if code in _DOUBTS:
                found.setdefault(_DOUBTS[code], []).append(label)
    return tuple(Doubt(words, tuple(charts)) for words, charts in found.items())


def percent(share: float) -> str:
    """Return a share as a percentage, for use in a sentence."""
    return f"{100 * share:.1f} %" if share < 0.0995 else f"{100 * share:.0f} %"

"""Agreement of a model of a train with a finer one over the operating speeds.

Loads are the greatest of a period, running up or down whichever is greater, in parts of the reference's load at rest: of
meshes K_v, of shafts their overload.

Loads are the greatest of a period, running up or down whichever is greater, in parts of the load at rest of the reference: of
meshes K_v, of shafts their overload.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.records import Bools, Floats, Indices, freeze
from gearcad.dynamics.options import OperatingRange
from gearcad.dynamics.response.kv_chart import KvChart
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.train import good_up_to

SHIFT = 0.025
"""Relative: so far a resonance may be off in speed. It is less than a speed is known or held."""


_SAME = 1e-9
"""Relative: speeds that are one."""


class CurveName(NamedTuple):
    """Of what a load is: the mesh, or the shaft, of a name."""

    kind: str
    name: str


class Reason(Enum):
    """Why loads at some speeds are not held against each other."""

    BELOW = "below the first speed of the chart"
    BEYOND = "beyond the last speed of the chart"
    UNSTABLE = "no steady motion lasts"
    COARSE = "shafts have more half waves than their elements are good for"
    APART = "flanks would part, but are taken to stick"


OUTSIDE = (Reason.BELOW, Reason.BEYOND)
"""Those of speeds that are in no chart."""

_DOUBTS = {
    "long-period": "resonances between the speeds are not looked for",
    "low-resonances": "resonances at low speeds are not looked for",
    "hardly-damped": "resonances of modes that are hardly damped are higher than shown",
    "harmonics-left-out": "at some speeds more harmonics would be needed",
}
"""What notices of a chart mean for who holds it against another one."""


class Doubt(NamedTuple):
    """What may be missing in the `charts` of one of both, or of both."""

    words: str
    charts: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {"words": self.words, "charts": list(self.charts)}


class NotJudged(NamedTuple):
    """From `first` to `last` (rpm), why, and in the charts of which of the two."""

    first: float
    last: float
    reason: Reason
    charts: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {**self._asdict(), "reason": self.reason.value, "charts": list(self.charts)}


class Difference(NamedTuple):
    """At a `speed` (rpm) one of two models has a greater load, by `excess`, than the `other` has anywhere near."""

    curve: CurveName
    speed: float
    greater: float
    other: float

    @property
    def excess(self) -> float:
        """In parts of the load at rest."""
        return self.greater - self.other

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
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
        """For each curve where the reference is farthest above the level; none where nothing is judged."""
        return self._greatest(self.reference, self.near_level)

    @cached_property
    def over(self) -> tuple[Difference, ...]:
        """For each curve where the level is farthest above the reference; none where nothing is judged."""
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
        """The reference and what the level has near one of the speeds in the range; None where that is not judged."""
        row, column = int(np.abs(self.speeds - speed).argmin()), self.curves.index(CurveName("mesh", mesh))
        if not self.judged[row]:
            return None
        return Difference(self.curves[column], speed, float(self.reference[row, column]), float(self.near_level[row, column]))

    @property
    def underestimate(self) -> Difference | None:
        """The greatest of all curves."""
        return max(self.under, key=lambda each: each.excess, default=None)

    @property
    def overestimate(self) -> Difference | None:
        """The greatest of all curves."""
        return max(self.over, key=lambda each: each.excess, default=None)


@dataclass(frozen=True, eq=False)
class _Curves:
    """Loads (s, c) at speeds (s,), and for what reasons (s,) some are none to be held against others."""

    speeds: Floats
    loads: Floats
    faults: dict[Reason, Bools]

    def at(self, speeds: Floats) -> _Curves:
        """The same at other speeds (x,) within."""
        loads = np.stack([np.interp(speeds, self.speeds, column) for column in self.loads.T], axis=1)
        faults = {
            reason: np.asarray(np.interp(speeds, self.speeds, marked.astype(float)) > 0, bool)
            for reason, marked in self.faults.items()
        }
        return _Curves(speeds, loads, faults)


def agreement(reference: TrainStudy, level: TrainStudy, labels: tuple[str, str], over: OperatingRange) -> Agreement:
    """Of the level with the reference, whose `labels` are given in this order, over a range of speeds.

    The level says too little where the reference has a load that the level has at no speed within `SHIFT` of that, and too
    much the other way round. Speeds are judged where both are known throughout that distance.
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
    """What both have, and the shafts that both know, but of which one has no overload."""
    known = set(reference.up.shaft_names) & set(level.up.shaft_names)
    shafts = [name for name in reference.up.shaft_names if name in known]
    both = [name in reference.shaft_overloads and name in level.shaft_overloads for name in shafts]
    one = [name in reference.shaft_overloads or name in level.shaft_overloads for name in shafts]
    meshes = [CurveName("mesh", name) for name in reference.up.mesh_names]
    held = [CurveName("shaft", name) for name, kept in zip(shafts, both, strict=True) if kept]
    unheld = tuple(name for name, some, all_of in zip(shafts, one, both, strict=True) if some and not all_of)
    return [*meshes, *held], unheld


def _curves(study: TrainStudy, reference: TrainStudy, names: list[CurveName]) -> _Curves:
    """Loads in parts of those at rest of the reference."""
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
    """In N or N·m (s,)."""
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
    """(s, c): the greatest load about each speed."""
    if not len(loads):
        return loads
    bounds = np.stack(window, axis=1).ravel()
    padded = np.concatenate([loads, np.full((1, loads.shape[1]), -np.inf)])
    return np.asarray(np.maximum.reduceat(padded, bounds, axis=0)[::2], float)


def _any(marked: Bools, window: tuple[Indices, Indices]) -> Bools:
    """(s,): whether any speed about each is marked."""
    count = np.concatenate([[0], np.cumsum(marked)])
    return np.asarray(count[window[1]] > count[window[0]], bool)


# ---------------------------------------------------------------------- what cannot be judged


def _outside(over: OperatingRange, first: float, last: float, labels: tuple[str, str]) -> tuple[NotJudged, ...]:
    """What of the range the charts do not show."""
    below = [NotJudged(over.first, min(first, over.last), Reason.BELOW, labels)] if over.first < first * (1 - _SAME) else []
    beyond = [NotJudged(max(last, over.first), over.last, Reason.BEYOND, labels)] if over.last > last * (1 + _SAME) else []
    return (*below, *beyond)


def _not_judged(
    speeds: Floats, inside: Bools, faults: list[dict[Reason, Bools]], labels: tuple[str, str]
) -> tuple[NotJudged, ...]:
    """Runs of speeds in the range, each reason by itself."""
    found = []
    for reason in faults[0]:
        marked = inside & (faults[0][reason] | faults[1][reason])
        turns = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int))).reshape(-1, 2)
        for start, end in turns.tolist():
            charts = tuple(label for label, each in zip(labels, faults, strict=True) if each[reason][start:end].any())
            found.append(NotJudged(float(speeds[start]), float(speeds[end - 1]), reason, charts))
    return tuple(found)


def _doubts(studies: tuple[TrainStudy, TrainStudy], labels: tuple[str, str]) -> tuple[Doubt, ...]:
    """What the notices of both charts say of them."""
    found: dict[str, list[str]] = {}
    for label, study in zip(labels, studies, strict=True):
        for code in dict.fromkeys(notice.code for notice in study.notices):
            if code in _DOUBTS:
                found.setdefault(_DOUBTS[code], []).append(label)
    return tuple(Doubt(words, tuple(charts)) for words, charts in found.items())


def percent(share: float) -> str:
    """A share as a sentence has it."""
    return f"{100 * share:.1f} %" if share < 0.0995 else f"{100 * share:.0f} %"

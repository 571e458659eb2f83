"""Study of a train by several of its models over the same speeds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from gearcad.core.records import Floats
from gearcad.dynamics.engagement import engaged
from gearcad.dynamics.level_agreement import SHIFT, Agreement, CurveName, agreement
from gearcad.dynamics.level_verdict import Decision, LevelResonance, LevelStudy, LevelVerdict, decision, finest_first
from gearcad.dynamics.options import DynamicsOptions, OperatingRange, operating_range
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.train_study import chart_speeds, study_train
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.dynamics.trains.train_modes import natural_modes
from gearcad.dynamics.variant_comparison import joined_peaks, peaks_of

_WITHIN = 200
"""Least number of speeds of a chart within an operating range."""

_SAME = 1e-9
"""Relative difference below which two speeds count as equal."""

_EXPLAINED = 3
"""Number of missed resonances of a model, the highest, for which the deciding mode is given."""


def study_levels(
    train: Train,
    models: Sequence[TrainModel],
    options: DynamicsOptions | None = None,
    *,
    tell: Callable[[str, float], None] = lambda _step, _share: None,
) -> LevelStudy:
    """Return the studies of a train by several models, in their order, with verdicts; the finest model is the reference.

    `tell` receives the current step, the finest model first, and the share of it that is done: "exact: chart", 0.5. Raises
    ParameterError, GeometryError and SolverError.
    """
    options = options or DynamicsOptions()
    finest, *coarser = finest_first(models)
    train = engaged(replace(train, model=finest), options)
    speeds, over = _speeds(replace(train, model=finest), options)
    studies: dict[TrainModel, TrainStudy] = {}
    for model in (finest, *coarser):
        name, of = model.value, replace(train, model=model)
        studies[model] = study_train(
            of, options, speeds=speeds, tell=partial(_begun, tell, name), share=partial(tell, f"{name}: chart")
        )
        # Where the finest has its maxima, the others are looked at as well.
        speeds = _with(speeds, studies[finest].speeds)
    verdicts = (_verdict(studies[finest], studies[model], options.level_tolerance, over) for model in reversed(coarser))
    return LevelStudy(
        name=train.name,
        what="model",
        labels=tuple(model.value for model in models),
        studies=tuple(studies[model] for model in models),
        over=over,
        tolerance=options.level_tolerance,
        verdicts=tuple(verdicts),
    )


def _begun(tell: Callable[[str, float], None], model: str, step: str, share: float = 0.0) -> None:
    tell(f"{model}: {step}", share)


def _speeds(train: Train, options: DynamicsOptions) -> tuple[Floats, OperatingRange]:
    """Return the speeds of the charts (rpm), with enough of them in the operating range, and that range."""
    first, last = options.operating_from, options.operating_to
    modes = natural_modes(train, count=options.frequencies)
    speeds = chart_speeds(train, options, modes)
    if options.speed_to is None and last is not None and last * (1 + SHIFT) > speeds[-1]:
        options = replace(options, speed_to=last * (1 + SHIFT))
    if not options.speed_from and first and first / (1 + SHIFT) < speeds[0]:
        options = replace(options, speed_from=first / (1 + SHIFT))
    speeds = chart_speeds(train, options, modes)
    over = operating_range(train.speed, options, (float(speeds[0]), float(speeds[-1])))
    begin, end = (float(np.clip(each, speeds[0], speeds[-1])) for each in (over.first, over.last))
    few = ((speeds >= begin) & (speeds <= end)).sum() < _WITHIN
    return _with(speeds, np.linspace(begin, end, _WITHIN if few else 2)), over


def _with(speeds: Floats, more: Floats) -> Floats:
    """Return both arrays of speeds merged in rising order; of speeds that differ by rounding alone only the first is kept."""
    both = np.union1d(speeds, more)
    return both[np.diff(both, prepend=0.0) > _SAME * both]


def _verdict(reference: TrainStudy, level: TrainStudy, tolerance: float, over: OperatingRange) -> LevelVerdict:
    """Return the verdict on one model compared with the reference."""
    labels = reference.train.model.value, level.train.model.value
    found = agreement(reference, level, labels, over)
    verdict = LevelVerdict(
        model=level.train.model,
        reference=reference.train.model,
        tolerance=tolerance,
        agreement=found,
        resonances=tuple(_resonances(reference, level, found, tolerance)),
        decisions=(),
    )
    return replace(verdict, decisions=_decisions(reference, verdict))


def _resonances(reference: TrainStudy, level: TrainStudy, found: Agreement, tolerance: float) -> Iterator[LevelResonance]:
    """Yield the judged resonances of the reference that rise by more than the tolerance, each with that of the level."""
    for column, mesh in enumerate(reference.up.mesh_names):
        groups = joined_peaks([peaks_of(reference, column, tolerance), peaks_of(level, column)], 0)
        for peak, own in groups:
            if peak is None or not len(found.speeds) or not found.speeds[0] <= peak.speed <= found.speeds[-1]:
                continue
            there = found.under_at(mesh, peak.speed)
            if there is not None:
                missed = own is None and there.excess > tolerance
                speed, factor = (None, None) if own is None else own
                yield LevelResonance(mesh, peak.speed, peak.factor, there.other, speed, factor, missed)


def _decisions(reference: TrainStudy, verdict: LevelVerdict) -> tuple[Decision, ...]:
    """Return what decides where the model is farthest off and at the resonances it misses, too little first, each mode once."""
    little, much = verdict.too_little, verdict.too_much
    unsafe = [(each.factor - each.near, CurveName("mesh", each.mesh), each.speed) for each in verdict.missed[:_EXPLAINED]]
    if little is not None:
        unsafe.append((little.excess, little.curve, little.speed))
    places = [(curve, speed) for _, curve, speed in sorted(unsafe, key=lambda place: -place[0])]
    if much is not None:
        places.append((much.curve, much.speed))
    found: dict[tuple[CurveName, int], Decision] = {}
    for curve, speed in places:
        each = decision(reference, verdict.model, curve, speed)
        found.setdefault((curve, each.mode), each)
    return tuple(found.values())

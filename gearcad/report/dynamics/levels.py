"""Which model of a train is enough: tables of the verdicts, of resonances, of what decides, and of what is not judged."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.dynamics.levels.agreement import CurveName, Difference
from gearcad.dynamics.levels.result import LevelStudy
from gearcad.dynamics.levels.verdict import LevelVerdict
from gearcad.plots.paper import short
from gearcad.report.dynamics.tables import WordTable, factor_text

__all__ = ["deciding_table", "level_resonance_table", "unjudged_table", "verdict_table"]

_NONE = "–"  # an en dash where there is no value


def verdict_table(of: LevelStudy) -> WordTable:
    """Of every model but the reference: what it is, and where it says most too little and too much."""
    finest = of.labels[of.reference]
    heads = ("model", "is", "greatest difference", "of", "at rpm", f"{finest}", "model", "% of the load")
    rows = []
    for each in of.verdicts:
        sides = (("too little", each.agreement.underestimate), ("too much", each.agreement.overestimate))
        for number, (words, found) in enumerate(sides):
            head = (each.model.value, each.status.value) if not number else ("", "")
            rows.append((*head, words, *_difference(found, swapped=bool(number))))
    return WordTable(heads, rows, 4)


def _difference(found: Difference | None, *, swapped: bool) -> tuple[str, ...]:
    if found is None:
        return ("nothing that is judged", *(_NONE,) * 4)
    reference, level = (found.other, found.greater) if swapped else (found.greater, found.other)
    numbers = (short(found.speed), factor_text(reference), factor_text(level), f"{100 * max(found.excess, 0.0):.1f}")
    return (_curve(found.curve), *numbers)


def _curve(curve: CurveName) -> str:
    return f"{curve.kind} {curve.name}" if not curve.name.startswith(curve.kind) else curve.name


def level_resonance_table(of: LevelStudy) -> WordTable:
    """Resonances of the reference in the range, and what each model makes of them."""
    heads = ("model", "mesh", "", "at rpm", "K_v", "model: near", "its resonance, rpm", "off, %", "K_v")
    rows = []
    for verdict in of.verdicts:
        for each in verdict.resonances:
            own = (_NONE,) * 3
            if each.own_speed is not None and each.own_factor is not None and each.moved is not None:
                own = (short(each.own_speed), f"{100 * each.moved:+.2f}", factor_text(each.own_factor))
            missed = "missed" if each.missed else ""
            numbers = (short(each.speed), factor_text(each.factor), factor_text(each.near))
            rows.append((verdict.model.value, each.mesh, missed, *numbers, *own))
    return WordTable(heads, rows, 3)


def deciding_table(of: LevelStudy) -> WordTable:
    """What each model lacks where it fails."""
    heads = ("model", "of", "shaken by", "what it lacks", "at rpm", "mode", "Hz", "share, %")
    return WordTable(heads, [row for verdict in of.verdicts for row in _decisions(verdict)], 4)


def _decisions(verdict: LevelVerdict) -> Iterator[tuple[str, ...]]:
    for each in verdict.decisions:
        teeth = f"{short(each.harmonic)} × {each.teeth}"
        for share in each.shares:
            part = f"{share.part}, {share.energy} energy"
            numbers = (short(each.speed), str(each.mode), short(each.frequency), f"{100 * share.share:.1f}")
            yield (verdict.model.value, _curve(each.curve), teeth, part, *numbers)


def unjudged_table(of: LevelStudy) -> WordTable:
    """Speeds, and shafts, at which a model is not held against the reference."""
    rows = []
    for verdict in of.verdicts:
        for each in verdict.agreement.not_judged:
            charts = f", in {each.charts[0]}" if len(each.charts) == 1 else ""
            rows.append((verdict.model.value, each.reason.value + charts, short(each.first), short(each.last)))
        for shaft in verdict.agreement.unheld:
            rows.append((verdict.model.value, f"shaft {shaft} has an overload in one of both only", _NONE, _NONE))
        for doubt in verdict.agreement.doubts:
            rows.append((verdict.model.value, f"{doubt.words}, in {' and '.join(doubt.charts)}", _NONE, _NONE))
    rows += [("all", f"shaft {shaft} carries next to nothing at rest", _NONE, _NONE) for shaft in of.idle_shafts]
    return WordTable(("model", "not judged, or not sure", "from rpm", "to rpm"), rows, 2)

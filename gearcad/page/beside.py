"""Runs beside each other: the figures of all of one verb, with what the designs differ by above each."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from gearcad.designs.columns import column_of_train, column_symbol
from gearcad.errors import format_number
from gearcad.page.run import Run
from gearcad.page.run_kinds import RUNS
from gearcad.page.words import Words
from gearcad.verdict import Verdict

__all__ = ["changes_between", "figures_beside", "verb_of"]

_DIGITS = 5
_MOST_CHANGES = 12


def verb_of(run: Run) -> str:
    """What was done: runs of one verb have the same figures."""
    return RUNS[run.asked.kind].job().verb


def changes_between(former: Mapping[str, str], given: Mapping[str, str]) -> list[str]:
    """What one spec says otherwise than another, key by key."""
    keys = [key for key in dict.fromkeys((*former, *given)) if former.get(key) != given.get(key)]
    told = [f"{key} {former.get(key, '-')} → {given.get(key, '-')}" for key in keys[:_MOST_CHANGES]]
    return told if len(keys) <= _MOST_CHANGES else [*told, f"+ {len(keys) - _MOST_CHANGES}"]


def figures_beside(runs: Sequence[Run], words: Words) -> list[dict[str, Any]]:
    """A row for each figure that any of these runs of one verb has: what it is, and a cell for each run."""
    verb = verb_of(runs[0]) if runs else ""
    symbol_of = column_of_train if verb == "planetary" else column_symbol
    found = []
    for key in dict.fromkeys(key for run in runs for key in run.figures):
        cells = [_text(run.figures.get(key), words) for run in runs]
        if not any(cells):
            continue
        owner, symbol = symbol_of(f"{verb}.{key}") or ("", None)
        said = words[symbol.words] if symbol and symbol.words else key.replace("_", " ")
        found.append(
            {
                "key": key,
                "words": words.divided(f"{words.table.get(owner.capitalize(), owner)}: {said}" if owner else said),
                "symbol": symbol.symbol if symbol else "",
                "unit": symbol.unit if symbol else "",
                "cells": cells,
                "differs": len(set(cells)) > 1,
            }
        )
    return found


def _text(value: Any, words: Words) -> str:
    """A figure as the page has it; nothing where there is none."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return words["yes"] if value else words["no"]
    if (verdict := _verdicts(words).get(value)) is not None:
        return verdict
    if isinstance(value, float):
        return f"{value:.{_DIGITS}g}" if math.isfinite(value) else ""
    return format_number(value) if isinstance(value, int) else str(value)


def _verdicts(words: Words) -> dict[str, str]:
    """What a computation or a rating comes to."""
    return {
        Verdict.PASSED.value: words["passed"],
        Verdict.FAILED.value: words["not passed"],
        Verdict.NOT_JUDGED.value: words["not judged"],
        Verdict.NOT_ASKED.value: words["not asked for"],
    }

"""The files of a search for planetary sets and their sizes: a design table, the spec of the lightest and the document."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from gearcad.designs.sized_sets import write_sized_set, write_sized_sets
from gearcad.output import json_text, staged_files
from gearcad.rating.strength import Part
from gearcad.sizing.sized import unjudged_scuffing
from gearcad.sizing.sized_set import SizedSet, SizedSets

__all__ = ["write_set_sizes"]

_TABLE, _BEST, _DOCUMENT = "sets.csv", "best.toml", "size.json"


def write_set_sizes(result: SizedSets, folder: Path) -> list[Path]:
    """Write them, complete or not at all. Raises OutputError."""
    with staged_files(folder) as staging:
        best = result.found[0]
        write_sized_sets(result, staging / _TABLE)
        write_sized_set(best, list(_comments(result, best)), staging / _BEST)
        (staging / _DOCUMENT).write_text(json_text(result.to_dict()), encoding="utf-8")
    return [folder / name for name in (_TABLE, _BEST, _DOCUMENT)]


def _comments(result: SizedSets, best: SizedSet) -> Iterator[str]:
    """What the lightest is for, and what it has."""
    task = result.task
    life = "the endurance limit" if task.rating.life is None else f"{task.rating.life:g} h"
    yield f"{task.torque_words} at {task.speed:g} rpm, i = {task.sets.ratio:g}, {life}: the lightest found"
    flank, root = (best.least[part] for part in (Part.FLANK, Part.ROOT))
    safeties = f"S_H {flank:.3f}, S_F {root:.3f}"
    yield f"{best.mass:.3g} kg without bores, {safeties}; no backlash yet: planetary.tooth_thinning gives it"
    if (why := unjudged_scuffing(task.rating)) is not None:
        yield why

"""The files of a search for sizes: design tables of the best and of the front, a spec, a picture, the document."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from gearcad.designs.found_pairs import write_front, write_pair, write_pairs
from gearcad.output import json_text, staged_files
from gearcad.plots.sizing import save_front
from gearcad.sizing import SizedPair, Sizing
from gearcad.sizing.sized import unjudged_scuffing

__all__ = ["write_sizing"]

_TABLE, _BEST, _FRONT, _PICTURE, _DOCUMENT = _EVERY = ["pairs.csv", "best.toml", "front.csv", "front.png", "size.json"]


def write_sizing(result: Sizing, folder: Path) -> list[Path]:
    """Write them, complete or not at all; where nothing was found the document alone. Raises OutputError."""
    names = _EVERY if result.found else [_DOCUMENT]
    with staged_files(folder, sometimes=_EVERY) as staging:
        if (best := result.best) is not None:
            write_pairs(result, staging / _TABLE)
            write_pair(best, list(_comments(best)), staging / _BEST)
            write_front(result, staging / _FRONT)
            save_front(result, staging / _PICTURE)
        (staging / _DOCUMENT).write_text(json_text(result.to_dict()), encoding="utf-8")
    return [folder / name for name in names]


def _comments(best: SizedPair) -> Iterator[str]:
    """What the best is for, and what it has."""
    load, rating = best.task.load, best.task.rating
    life = "the endurance limit" if rating.life is None else f"{rating.life:g} h"
    yield f"{load.torque:g} N·m at {load.speed:g} rpm, u = {best.task.ratio:g}, {life}: best by {best.task.criterion.value}"
    roots = " and ".join(f"{each:.3f}" for each in best.root_safeties)
    width = "" if best.least_width is None else f"; face width at least {best.least_width:.4g} mm"
    yield f"{best.mass:.3g} kg, S_H {min(best.flank_safeties):.3f}, S_F {roots}{width}"
    if (why := unjudged_scuffing(rating)) is not None:
        yield why
    if best.strength is not None:
        yield from map(str, best.strength.notices)
    yield "no backlash yet: tooth_thinning or tooth_allowance gives it"

"""A design table of the planetary sets that a search has found, which `batch` then makes."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path

from gearcad.designs.auto import AUTO
from gearcad.errors import ParameterError
from gearcad.output import staged_files
from gearcad.planetary.search import Candidate, SearchResult

__all__ = ["set_keys", "write_found"]

_GEARS = ("sun", "planet", "ring", "planet_2", "sun_2", "ring_2")

_RIM = 5.0
"""What the rim of a ring has outside its root circle, in modules of diameter."""


def write_found(result: SearchResult, path: Path) -> None:
    """Write it: complete or not at all. Raises ParameterError for a name that is no table's, and if nothing was found."""
    if path.suffix.lower() != ".csv":
        raise ParameterError("output", str(path), "must end in .csv")
    if not result.found:
        raise ParameterError("output", str(path), "cannot be written: no set was found")
    rows = [_cells(candidate) for candidate in result.found]
    columns = _columns(rows)
    with staged_files(path.parent) as staging, (staging / path.name).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        wanted = f"i = {result.task.ratio:g} within {result.task.tolerance:g} %, module {result.task.module:g}"
        writer.writerow([f"# Planetary sets for {wanted.replace(',', ' and')}; best first. Next: gearcad batch {path.name}"])
        writer.writerow(columns)
        writer.writerows([row.get(column, "") for column in columns] for row in rows)


def _columns(rows: Sequence[dict[str, str]]) -> list[str]:
    """What any of them has: the name, the train, then gear by gear."""
    there = set().union(*rows)
    tables = ("name", "planetary", *_GEARS)
    keys = list(dict.fromkeys(key for row in rows for key in row if key in there))
    return sorted(keys, key=lambda key: tables.index(key.partition(".")[0]))


def _cells(candidate: Candidate) -> dict[str, str]:
    """A row by its columns."""
    return {"name": candidate.name} | {key: _plain(value) for key, value in set_keys(candidate).items()}


def set_keys(candidate: Candidate) -> dict[str, object]:
    """What a spec has of a set, by the keys of all tables. The shifts of centrals follow from the centre distance, so it fits.

    The thinning is there to be given: without it no set has backlash.
    """
    task, roles = candidate.task, candidate.task.roles(candidate.kind)
    train: dict[str, object] = {
        "planets": candidate.planets,
        **roles._asdict(),
        "centre_distance": candidate.centre_distance,
        "tip_distance": task.least_distance,
        "normal_module": task.module,
        "face_width": task.width,
        "tooth_thinning": 0.0,
    }
    if task.helix_angle:
        train["helix_angle"] = task.helix_angle
    found = {f"planetary.{key}": value for key, value in train.items()}
    for name in candidate.teeth:
        found |= {f"{name}.{key}": value for key, value in _of_gear(candidate, name).items()}
    return found


def _plain(value: object) -> str:
    """A cell, without the last digits of a float, which are rounding: 37.8 and not 37.800000000000004."""
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _of_gear(candidate: Candidate, name: str) -> dict[str, object]:
    """What a gear has for itself."""
    own: dict[str, object] = {"teeth": candidate.teeth[name]}
    rim = name.startswith("planet")
    own["profile_shift"] = candidate.profile_shifts[name] if rim else AUTO
    if name == "planet_2":
        own |= {"normal_module": candidate.modules[name], "axial_position": candidate.second_height}
        if candidate.task.helix_angle:
            own["helix_angle"] = candidate.helix_angles[name]
    if name.startswith("ring"):
        own["tip_alteration"] = candidate.tip_alterations[name]
        rim_diameter = abs(candidate.gear(name).root_diameter) + _RIM * candidate.modules[name]
        own["body.rim_diameter"] = float(math.ceil(rim_diameter))
    return own

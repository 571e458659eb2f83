"""Searches as runs: sizes for a task, modifications, a measured gear, and a map of two keys; each tells its best so far.

What a search takes and finds are plain values: a search runs in a process of its own, which this module serves.
"""

from __future__ import annotations

import copy
import csv
import itertools
import math
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.core.errors import GearcadError, ParameterError, printable
from gearcad.core.output import staged_files
from gearcad.core.records import texts
from gearcad.designs.design import Design, files_only_in, tables_of_text
from gearcad.designs.reader import design_from_tables
from gearcad.page.run_process import RunRequest, Teller, design_of, serve_run

if TYPE_CHECKING:
    from gearcad.designs.keys import Cell
    from gearcad.identify.candidates import Candidate
    from gearcad.sizing import SizedPair
    from gearcad.sizing.planetary_sets import SizedSet
    from gearcad.sizing.proposals import PairsSoFar

_BETWEEN = 0.4
"""Least time (s) between two reports of what was found so far."""

_HEAVY = 4.0
"""Largest mass of a variant that is drawn, over that of the heaviest pair found."""

_MOST_POINTS = 400
"""Largest number of points of a cloud that are drawn."""

MOST_CELLS = 2500
"""Largest number of designs in a map."""


@dataclass(frozen=True, kw_only=True)
class SearchKind:
    """A search by the function that does it; `report` is the file to read, `taken` the pattern of the files to download."""

    find: Callable[[RunRequest, Teller], dict[str, Any]]
    report: str = ""
    taken: str = "*"


class _Pace:
    """A clock that says now and then that a report is due."""

    def __init__(self) -> None:
        self._last = 0.0

    def due(self) -> bool:
        """Return whether the last report is old enough for another one."""
        if (now := time.monotonic()) - self._last < _BETWEEN:
            return False
        self._last = now
        return True


# ---------------------------------------------------------------------- sizes


def _size(asked: RunRequest, tell: Teller) -> dict[str, Any]:
    """Find pairs for a task, as `gearcad size` does, and write the same files."""
    from gearcad.jobs.searches import nothing_lines, write_sizing
    from gearcad.jobs.size_options import task_of
    from gearcad.sizing import search_pairs
    from gearcad.sizing.proposals import expected

    given = dict(asked.options)
    count, errors = given.pop("count"), given.pop("errors")
    task, pace = task_of(given), _Pace()
    outlook = expected(task, count, min(count, errors))
    tell(expected={"seconds": outlook.seconds, "memory": outlook.memory})

    def heard(so_far: Callable[[], PairsSoFar]) -> None:
        if pace.due():
            pairs = so_far()
            rows = _sized_rows(pairs.found)
            tell(found={"rows": rows, "front": [], "cloud": _points(pairs.cloud, rows), "rated": pairs.rated})

    result = search_pairs(task, count=count, errors=min(count, errors), progress=tell.progress, heard=heard)
    rows = _sized_rows(result.found)
    front = [row for row in _sized_rows(result.front_sample) if row["mass"] <= _most_mass(rows)]
    tell(found={"rows": rows, "front": front, "cloud": _points(result.cloud, rows), "rated": True})
    files = write_sizing(result, Path(asked.into))
    first, *more = [""] if result.found else [line.replace("--", "") for line in nothing_lines(result)]
    return _result("pairs", files, first, more)


def _sized_rows(pairs: Sequence[SizedPair]) -> list[dict[str, Any]]:
    """Return each pair with its figures and its spec."""
    from gearcad.jobs.searches import pair_spec

    return [_sized_row(pair) | {"text": pair_spec(pair, place)} for place, pair in enumerate(pairs, 1)]


def _sized_row(pair: SizedPair) -> dict[str, Any]:
    return {
        "name": pair.name,
        "mass": pair.mass,
        "margin": pair.margin,
        "S_H": min(pair.flank_safeties),
        "S_F": min(pair.root_safeties),
        "a": pair.centre_distance,
        "b": pair.face_width,
        "u": pair.ratio,
        "eps_a": pair.transverse_contact_ratio,
        "eps_b": pair.overlap_ratio,
        "sliding": pair.sliding,
        "temperature": pair.temperature,
        "ripple": 100 * pair.ripple,
        "error": pair.transmission_error,
        "efficiency": None if pair.efficiency is None else 100 * pair.efficiency,
        "front": pair.front,
    }


def _size_sets(asked: RunRequest, tell: Teller) -> dict[str, Any]:
    """Find planetary sets for a task, as `gearcad size --planetary` does, and write the same files."""
    from gearcad.jobs.searches import set_spec, write_set_sizes
    from gearcad.jobs.set_size_options import set_task_of
    from gearcad.sizing.planetary_sets import expected, size_sets

    given = dict(asked.options)
    count = given.pop("count")
    task, pace = set_task_of(given), _Pace()
    outlook = expected(task, count)
    tell(expected={"seconds": outlook.seconds, "memory": outlook.memory})

    def state(found: Sequence[SizedSet]) -> dict[str, Any]:
        rows = [_set_row(each) | {"text": set_spec(task, each, place)} for place, each in enumerate(found, 1)]
        return {"rows": rows, "front": [], "cloud": [], "rated": True}

    def heard(found: Sequence[SizedSet]) -> None:
        if pace.due():
            tell(found=state(found))

    result = size_sets(task, count, tell.progress, heard)
    tell(found=state(result.found))
    files = write_set_sizes(result, Path(asked.into))
    return _result("sets", files, "", [])


def _set_row(sized: SizedSet) -> dict[str, Any]:
    from gearcad.rating.strength import RatedPart

    own = sized.candidate
    return {
        "name": sized.name,
        "mass": sized.mass,
        "margin": min(sized.margins.values()),
        "S_H": sized.least[RatedPart.FLANK],
        "S_F": sized.least[RatedPart.ROOT],
        "i": own.ratio,
        "off": 100 * own.deviation,
        "normal_module": own.task.module,
        "b": own.task.width,
        "diameter": own.diameter,
        "a": own.centre_distance,
        "planets": own.planets,
        "K_gamma": sized.load.mesh_load_factor,
    }


def _most_mass(rows: Sequence[Mapping[str, Any]]) -> float:
    """Return the mass (kg) up to which variants are drawn beside the pairs that were found."""
    return _HEAVY * max((row["mass"] for row in rows), default=math.inf)


def _points(cloud: Any, rows: Sequence[Mapping[str, Any]]) -> list[list[float]]:
    """Return margins and masses of a cloud, without what is much heavier than the pairs found, thinned, with few digits."""
    cloud = cloud[:, cloud[0] <= _most_mass(rows)]
    step = max(1, -(-cloud.shape[1] // _MOST_POINTS))
    return [[float(f"{margin:.4g}"), float(f"{mass:.4g}")] for mass, margin in cloud[:, ::step].T.tolist()]


# ---------------------------------------------------------------------- modifications


def _modify(asked: RunRequest, tell: Teller) -> dict[str, Any]:
    """Search flank modifications, as `gearcad modify` does, and write the modified spec beside the document."""
    from gearcad.jobs.modify import Modify, modified_spec

    design = design_of(asked.text, asked.name, Path(asked.folder))
    job = Modify(**asked.options)
    proposal = job.run(design, tell.progress)
    text = modified_spec(asked.text, proposal)
    tell(
        found={
            "text": text,
            "changes": proposal.changes,
            "notes": proposal.notes,
            "before": asdict(proposal.before),
            "after": asdict(proposal.after),
            "bound": proposal.bound,
            "torque": proposal.torque,
            "variants": proposal.variants,
        }
    )
    files = job.write(proposal, Path(asked.into))
    files += _written(Path(asked.into), f"{proposal.name}.toml", text)
    return _result(design.name, files, "", texts(proposal.notices))


# ---------------------------------------------------------------------- a measured gear


def _identify(asked: RunRequest, tell: Teller) -> dict[str, Any]:
    """Find the standard gears that readings may be of, as `gearcad identify` does."""
    from gearcad.core.output import json_text
    from gearcad.designs.spec_writers import identified_text
    from gearcad.identify.measurements import Measurements
    from gearcad.jobs.job import with_summary
    from gearcad.jobs.searches import identification_verdict, identify_measured

    given = dict(asked.options)
    count, sized = given.pop("count"), given.pop("sized")
    readings: dict[str, Any] = {name: _pair(value) for name, value in given.items()}
    readings |= {name: {size: _pair(value) for size, value in pairs} for name, pairs in sized.items()}
    found = identify_measured(Measurements(**readings), count)
    rows = [_candidate_row(each) | {"text": identified_text(found, each, IDENTIFIED)} for each in found.candidates]
    tell(found={"rows": rows})
    verdict, *more = identification_verdict(found)
    files = _written(Path(asked.into), "identify.json", json_text(with_summary(found.to_dict())))
    files += _written(Path(asked.into), f"{IDENTIFIED}.toml", rows[0]["text"])
    return _result(IDENTIFIED, files, verdict, [*(line.strip() for line in more), *texts(found.notices)])


IDENTIFIED = "identified"
"""Name of the gear that was measured."""


def _pair(value: Any) -> Any:
    """Return a reading with its own uncertainty as the tuple that JSON made a list of."""
    return tuple(value) if isinstance(value, list) else value


def _candidate_row(each: Candidate) -> dict[str, Any]:
    gear = each.gear
    pitch = each.diametral_pitch
    return {
        "name": " ".join([each.series, *([f"{pitch:g}"] if pitch is not None else [])]),
        "probability": 100 * each.probability,
        "normal_module": float(gear.normal_module),
        "pressure_angle": gear.rack.pressure_angle,
        "helix_angle": gear.helix_angle,
        "shift": gear.profile_shift,
        "thinning": gear.tooth_thinning,
        "chi_square": each.chi_square,
        "rack": each.rack.name,
    }


# ---------------------------------------------------------------------- a map of two keys


def study_axes(design: Design, tables: Mapping[str, Any], vary: Sequence[str]) -> dict[str, tuple[Cell, ...]]:
    """Return the values of the keys that texts `KEY=VALUES` vary, as `gearcad study` reads them.

    Raises ParameterError for what it would refuse, and for other than two keys or too many combinations.
    """
    from gearcad.designs.variations import Choices, read_variations
    from gearcad.page.fields import given_texts

    found = read_variations(vary, design.kind, tuple(given_texts(tables)))
    axes = {each.key: each.values for each in found if isinstance(each, Choices)}
    if len(axes) != _AXES:
        raise ParameterError("vary", len(axes), f"must be {_AXES} keys: one across the map, one up")
    if (cells := math.prod(map(len, axes.values()))) > MOST_CELLS:
        raise ParameterError("vary", cells, f"must make at most {MOST_CELLS} designs together: take fewer values")
    return axes


def design_with(design: Design, tables: Mapping[str, Any], folder: Path, values: Mapping[str, Cell]) -> Design:
    """Return the design of a spec's tables with other values under dotted keys. Raises SpecError."""
    changed: dict[str, Any] = copy.deepcopy(dict(tables))
    for key, value in values.items():
        *parents, name = key.split(".")
        owner = changed
        for parent in parents:
            owner = owner.setdefault(parent, {})
        owner[name] = value
    with files_only_in(folder):
        return design_from_tables(changed, where=lambda _key: design.name, default_name=design.name)


def figures_of(design: Design) -> dict[str, float]:
    """Return every number that a design has, derived or rated, under the names of columns of a table of results."""
    from gearcad.batch.row import flat_document
    from gearcad.jobs.strength import Rate

    document = design.to_dict()
    with suppress(GearcadError):
        job = Rate(report=False)
        rated = job.figures(job.document(job.run(design)))
        document = document | {job.verb: {name: value for name, value in rated.items() if name != "warnings"}}
    return {key: float(value) for key, value in flat_document(document) if _is_number(value)}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _study(asked: RunRequest, tell: Teller) -> dict[str, Any]:
    """Compute the figures of a design with two of its keys varied, every combination, and write them as a table of results."""
    folder, result = Path(asked.folder), str(asked.options["result"])
    with files_only_in(folder):
        tables, where = tables_of_text(asked.text, f"{asked.name}.toml", folder)
        design = design_from_tables(tables, where=where, default_name=asked.name)
    axes = study_axes(design, tables, asked.options["vary"])
    across, up = axes
    points = list(itertools.product(*map(enumerate, axes.values())))
    rows, cells, pace = list[dict[str, Any]](), list[tuple[int, int, float | None, str]](), _Pace()

    def state() -> dict[str, Any]:
        ends = {"across": across, "up": up, "xs": axes[across], "ys": axes[up]}
        return {**ends, "result": result, "cells": cells, "keys": _columns(rows)}

    for number, ((column, x), (line, y)) in enumerate(points):
        tell.progress("designs", number, len(points))
        varied, why, figures = {across: x, up: y}, "", dict[str, float]()
        try:
            figures = figures_of(design_with(design, tables, folder, varied))
        except GearcadError as error:
            why = printable(str(error))
        cells.append((column, line, figures.get(result), why))
        rows.append({"name": f"{number + 1}", "status": "failed" if why else "ok", "error": why, **varied, **figures})
        if pace.due():
            tell(found=state())
    tell(found=state())
    with staged_files(Path(asked.into)) as staging, (staging / STUDY).open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, ["name", "status", "error", *axes, *(key for key in _columns(rows) if key not in axes)])
        writer.writeheader()
        writer.writerows(rows)
    return _result(design.name, [Path(asked.into) / STUDY], "", [])


STUDY = "study.csv"
"""Name of the table of a map's designs."""

_AXES = 2


def _columns(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the figures that any row has."""
    return [key for key in dict.fromkeys(key for row in rows for key in row) if key not in ("name", "status", "error")]


def study_cells(path: Path, axes: Mapping[str, Sequence[Cell]], result: str) -> list[tuple[int, int, float | None, str]]:
    """Return places, another result and faults of a map's cells, from its table."""
    places = itertools.product(*(range(len(values)) for values in axes.values()))
    with path.open(encoding="utf-8", newline="") as file:
        return [
            (column, line, float(row[result]) if row.get(result) else None, row["error"])
            for (column, line), row in zip(places, csv.DictReader(file), strict=True)
        ]


# ---------------------------------------------------------------------- all searches


def _written(folder: Path, name: str, text: str) -> list[Path]:
    """Write a text to a file, and return its path in a list."""
    with staged_files(folder) as staging:
        (staging / name).write_text(text, encoding="utf-8", newline="")
    return [folder / name]


def _result(name: str, files: Sequence[Path], conclusion: str, notices: Sequence[str]) -> dict[str, Any]:
    """Return the end of a search, as that of other runs."""
    own = {"name": name, "conclusion": conclusion, "figures": {}, "notices": list(notices)}
    return {**own, "files": [file.name for file in files]}


SEARCHES = {
    "size": SearchKind(find=_size),
    "size-sets": SearchKind(find=_size_sets),
    "modify": SearchKind(find=_modify),
    "identify": SearchKind(find=_identify),
    "study": SearchKind(find=_study),
}
"""Searches, in the order in which users need them."""


def serve() -> None:
    """Do the search that stands on stdin."""
    serve_run(lambda asked, tell: SEARCHES[asked.kind].find(asked, tell))

"""Jobs of rows beside data, build and check: their parts, their columns, and rows that they do not take."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from support.batches import lies, made_now, read_results, write_table

from gearcad.batch import BatchSummary, run_table
from gearcad.designs.variations import column_symbol
from gearcad.jobs import VERBS, job_of
from gearcad.jobs.strength import Stiffness

pytestmark = pytest.mark.usefixtures("kept_workers")

LINES = (
    "name,gear.teeth,gear.normal_module,gear.face_width,"
    "pair.normal_module,pinion.teeth,wheel.teeth,pinion.face_width,wheel.face_width,load.torque",
    "good,,,,2,20,30,20,20,60",
    "idle,,,,2,20,31,20,20,",
    "alone,20,2,20,,,,,,",
)

METHODS = ("iso6336", "weber-banaschek")


def make(folder: Path, job: Stiffness) -> BatchSummary:
    return run_table(write_table(folder / "table.csv", LINES), folder / "out", [job], jobs=1)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("rows")
    summary = make(folder, Stiffness(methods=METHODS))
    assert (summary.ok, summary.failed) == (1, 2)
    table = folder / "table.csv"
    assert summary.errors == (
        f"{table} row 3 (idle): load.torque is missing: must be given, in N·m on the pinion: stiffness depends on it",
        f"{table} row 4 (alone): kind = 'gear': must be a pair: a single gear has no mesh",
    )
    return folder / "out"


def test_columns_are_the_figures_of_the_document(made: Path) -> None:
    line = read_results(made)[0]
    document = json.loads((made / "good" / "stiffness.json").read_text(encoding="utf-8"))
    assert (line["files.data.json"], line["files.stiffness.json"]) == ("good/data.json", "good/stiffness.json")
    for method in METHODS:
        assert float(line[f"stiffness.{method}.mean"]) == document["methods"][method]["mean"]
    assert "stiffness.iso6336.maximum" not in line  # the standard knows the means only
    with (made / "columns.csv").open(encoding="utf-8", newline="") as file:
        units = {row["column"]: (row["symbol"], row["unit"]) for row in csv.DictReader(file)}
    assert units["stiffness.weber-banaschek.c_gamma_beta"] == ("c_γβ", "N/(mm·µm)")
    assert units["stiffness.iso6336.mean"] == ("", "N/µm")
    assert [heading for heading in line if heading.startswith("stiffness.") and column_symbol(heading) is None] == []


def test_parts_are_kept_while_their_options_are(made: Path) -> None:
    parts = json.loads((made / "good" / "manifest.json").read_text(encoding="utf-8"))["parts"]
    assert parts["stiffness"]["options"] == {"methods": list(METHODS)}
    assert list(parts["stiffness"]["files"]) == ["stiffness.json"]
    make(made.parent, Stiffness(methods=METHODS))
    assert "good" not in made_now(made)
    make(made.parent, Stiffness(methods=["iso6336"]))
    assert "good" in made_now(made)
    assert lies(made) == []


def test_every_job_with_a_document_of_its_own_is_a_part() -> None:
    """`build` has parts by their formats, and the document of `data`."""
    own = [verb for verb in VERBS if verb in job_of(verb)().parts]
    assert own == ["data", "draw", "picture", "verify", "check", "mesh", "rate", "stiffness", "dynamics", "planetary", "modify"]

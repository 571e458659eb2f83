"""The journal of a run, checked rows on their way to workers, and what an interrupted run tells."""

import csv
import os
import pickle
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import psutil
import pytest
from support.batches import PAIRS, write_table
from support.commands import run
from support.specs import starter_specs

from gearcad.batch import run as run_module
from gearcad.batch.row import Checked, Record, Status, Task, check_rows, inputs_hash, make_row, stages
from gearcad.batch.run import Journal
from gearcad.designs import read_spec
from gearcad.designs.table import DesignRow, open_table
from gearcad.jobs.job import Data

ROW = DesignRow(2, "a", {"gear.teeth": 20}, (), (), "table.csv", ("name", "gear.teeth"))
LARGE = {"gear.rack": "x" * 100_000}


def test_rows_come_back_in_the_order_of_the_table_with_their_records() -> None:
    journal = Journal()
    rows = [replace(ROW, number=number, name=f"row {number}") for number in (2, 4, 7, 8)]
    assert [journal.add(row) for row in rows] == [[]] * 4
    done = [Record(number=number, status=Status.OK, seconds=0.5) for number in (7, 2)]
    for record in done:
        journal.finish(record)
    assert [row.number for row, _ in journal.open_rows()] == [4, 8]
    assert len(list(journal.results())) == 4
    assert list(journal.results()) == [
        (rows[0], done[1]),
        (rows[1], Record(number=4, status=Status.NOT_RUN)),
        (rows[2], done[0]),
        (rows[3], Record(number=8, status=Status.NOT_RUN)),
    ]


def test_rows_may_be_finished_while_the_open_ones_are_read() -> None:
    """As in a run: the next row is asked for when a worker is free."""
    journal = Journal()
    for number in range(2, 8):
        journal.add(replace(ROW, number=number, name=str(number)))
    seen = []
    for row, _ in journal.open_rows():
        seen.append(row.number)
        journal.finish(Record(number=row.number, status=Status.OK))
    assert seen == [2, 3, 4, 5, 6, 7]
    assert list(journal.open_rows()) == []


def test_memory_does_not_grow_with_the_rows() -> None:
    journal, process = Journal(), psutil.Process()
    for number in range(50):
        journal.add(replace(ROW, number=number, name=str(number), values=LARGE))
    before = process.memory_info().rss
    for number in range(50, 450):
        journal.add(replace(ROW, number=number, name=str(number), values=LARGE))
    assert sum(1 for _ in journal.results()) == 450
    assert process.memory_info().rss - before < 10_000_000, "of the 40 MB that were added"


FILL = """
from dataclasses import replace
from gearcad.batch.run import Journal
from gearcad.core.errors import OutputError
from gearcad.designs.table import DesignRow
journal = Journal()
row = DesignRow(2, "a", {"gear.rack": "x" * 100_000}, (), (), "table.csv", ("name", "gear.rack"))
try:
    for number in range(100):
        journal.add(replace(row, number=number, name=str(number)))
except OutputError as error:
    print(error)
try:
    list(journal.results())
except OutputError as error:
    print(error)
"""


def test_no_room_for_temporary_files_is_told_also_by_what_comes_after(small_disk: Path) -> None:
    """In a process of its own: SQLite looks for the folder once."""
    environment = os.environ | {"TMPDIR": str(small_disk)}
    done = subprocess.run([sys.executable, "-c", FILL], capture_output=True, text=True, check=True, env=environment)
    lines = done.stdout.splitlines()
    assert len(lines) == 2 and done.stderr == ""
    for line in lines:
        assert line.startswith("temporary files = '': cannot be written (") and line.endswith("); TMPDIR names their folder")


SPECS = starter_specs()


@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_design_of_any_kind_arrives_as_it_was_sent(spec: Path) -> None:
    design = read_spec(spec)
    assert pickle.loads(pickle.dumps(design)).to_dict() == design.to_dict()


def task(row: DesignRow, checked: Checked, folder: Path) -> Task:
    workspace = folder / ".work"
    workspace.mkdir(parents=True, exist_ok=True)
    return Task(row, stages([Data()]), folder, workspace, True, checked)


def test_row_is_made_of_the_design_that_its_check_has_made(tmp_path: Path) -> None:
    first, second = open_table(write_table(tmp_path / "t.csv", PAIRS)).rows()
    one, other = check_rows([first, second])
    assert (one.faults, one.inputs) == ((), inputs_hash(first.inputs))
    swapped = task(first, Checked(inputs=one.inputs, design=other.design), tmp_path)
    assert swapped.design(one.inputs).name == second.name
    assert swapped.design("of other inputs").name == first.name
    made = make_row(task(first, one, tmp_path))
    content = (tmp_path / first.name / "data.json").read_bytes()
    shutil.rmtree(tmp_path / first.name)
    again = make_row(task(first, Checked(), tmp_path))
    assert (made.status, made.values, made.files) == (Status.OK, again.values, again.files)
    assert (tmp_path / first.name / "data.json").read_bytes() == content


def test_row_at_fault_has_no_design(tmp_path: Path) -> None:
    (row,) = open_table(write_table(tmp_path / "t.csv", (PAIRS[0], "bad,1,,2,23,0.4,2,2"))).rows()
    (checked,) = check_rows([row])
    assert (len(checked.faults), checked.design) == (1, b"")
    with pytest.raises(ValueError, match="teeth"):
        task(row, checked, tmp_path).design(inputs_hash(row.inputs))


def test_ctrl_c_tells_how_many_rows_are_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table, tell = tmp_path / "gears.csv", run_module._Run.tell
    rows = [f"gear{number},{20 + number},2,10" for number in range(5)]
    table.write_text("\n".join(["name,teeth,normal_module,face_width", *rows]) + "\n", encoding="utf-8")

    def pressed(run: run_module._Run, phase: str, failed: int, whole: int) -> None:
        tell(run, phase, failed, whole)
        if phase == "making" and run.done == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(run_module._Run, "tell", pressed)
    words = ["batch", str(table), "-o", str(tmp_path / "out"), "--do", "data", "-j", "1"]
    stopped = run(*words, status=130)
    assert stopped.stderr.splitlines()[-2:] == ["2 rows ok, 0 failed, 3 not run; the same command makes the rest", "Aborted!"]
    with (tmp_path / "out" / "results.csv").open(encoding="utf-8") as file:
        assert [row["status"] for row in csv.DictReader(file)].count("not run") == 3

"""The journal holds every row of a run outside the memory, and says so when there is no room for them."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import psutil

from gearcad.batch.row import Record, Status
from gearcad.batch.run import Journal
from gearcad.designs.table import DesignRow

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

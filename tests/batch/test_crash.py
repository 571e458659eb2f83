"""Whatever is killed whenever: no finished row is lost, no file is torn, and the next run ends as if nothing had happened."""

import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest
from support import jobs
from support.batches import lies, read_results, snapshot, write_table
from support.processes import PATIENCE, below, run_batch, send_to_all, start_batch, wait_for_end, wait_until

from gearcad.batch import run_table
from gearcad.batch.pool import close_workers, isolated
from gearcad.batch.row import Status, Task, make_row
from gearcad.designs.table import open_table
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data
from gearcad.solids import Format

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")

HEADING = "name,gear.teeth,gear.normal_module,gear.face_width,pair.normal_module,pinion.teeth,wheel.teeth,"
HEADING += "pinion.face_width,wheel.face_width"

ORPHANS_LIVE = 10.0
"""Seconds: far more than a worker takes to notice, also on a busy machine."""


def table(path: Path, rows: int, width: float) -> Path:
    """Small gears, and a pair in every fourth row; what is a gear for one width is a pair for another."""
    shift = int(width)
    lines = [
        f"row {n:02d},,,,1,{17 + n},{20 + n},{width},{width}"
        if (n + shift) % 4 == 0
        else f"row {n:02d},{12 + n},1,{width},,,,,"
        for n in range(rows)
    ]
    return write_table(path, (HEADING, *lines))


class Variant:
    """A table with its options, and the tree that an undisturbed run makes of it."""

    def __init__(self, folder: Path, *, rows: int, width: float, formats: str) -> None:
        self.options = (table(folder / f"{rows} {width} {formats}.csv", rows, width), "--format", formats, "-j", "2", "--quiet")
        began = time.monotonic()
        assert self.run(folder / f"{rows} {width} {formats}").returncode == 0
        self.seconds = time.monotonic() - began
        self.tree = snapshot(folder / f"{rows} {width} {formats}")

    def run(self, folder: Path) -> subprocess.CompletedProcess[str]:
        return run_batch(*self.options, "-o", folder)

    def start(self, folder: Path) -> subprocess.Popen[str]:
        return start_batch(*self.options, "-o", folder)


def kill_parent(process: subprocess.Popen[str]) -> None:
    process.kill()


def kill_all(process: subprocess.Popen[str]) -> None:
    send_to_all(process, signal.SIGKILL)


def kill_often(variants: list[Variant], kills: int, folder: Path, seed: int) -> None:
    """Start runs of one table and the other in one folder, and kill each at a random moment of its life.

    Half of the time only the parent is killed; half of the time the next run does not wait until its workers have gone.
    After every sixth a run ends in peace.
    """
    chance = random.Random(seed)
    for number in range(1, kills + 1):
        variant = variants[number % len(variants)]
        process = variant.start(folder)
        time.sleep(chance.uniform(0.0, 1.1 * variant.seconds))
        (kill_parent if number % 4 < 2 else kill_all)(process)
        process.communicate()
        if number % 3:
            assert wait_for_end(below(process), ORPHANS_LIVE) == []
            assert lies(folder) == []
        if number % 6 == 0:
            variant = variants[number // 6 % len(variants)]
            assert variant.run(folder).returncode == 0
            assert lies(folder) == []
            assert snapshot(folder) == variant.tree


@pytest.mark.long
def test_tree_after_kills_is_that_of_an_undisturbed_run(tmp_path: Path) -> None:
    """Two tables with other gears and other formats take turns: files are replaced and removed too."""
    variants = [
        Variant(tmp_path, rows=6, width=2.0, formats="stl,csv"),
        Variant(tmp_path, rows=6, width=3.0, formats="csv,dxf"),
    ]
    kill_often(variants, 6, tmp_path / "out", seed=1)


@pytest.mark.long
def test_tree_of_solids_after_kills_is_that_of_an_undisturbed_run(tmp_path: Path) -> None:
    kill_often([Variant(tmp_path, rows=3, width=2.0, formats="step,stl,dxf")], 6, tmp_path / "out", seed=2)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(5))
def test_tree_after_many_kills_is_that_of_an_undisturbed_run(seed: int, tmp_path: Path) -> None:
    variants = [
        Variant(tmp_path, rows=12, width=2.0, formats="step,stl,dxf,csv"),
        Variant(tmp_path, rows=12, width=3.0, formats="step,csv,dxf"),
    ]
    kill_often(variants, 24, tmp_path / "out", seed)


@pytest.mark.long
def test_workers_killed_at_random_cost_their_rows_only(tmp_path: Path) -> None:
    variant = Variant(tmp_path, rows=24, width=2.0, formats="stl,dxf")
    chance = random.Random(3)
    process = variant.start(tmp_path / "out")
    while process.poll() is None:
        time.sleep(chance.uniform(0.05, 0.3))
        if workers := below(process):
            chance.choice(workers).kill()
    _, errors = process.communicate(timeout=PATIENCE)
    assert "Traceback" not in errors
    assert lies(tmp_path / "out") == []
    lines = read_results(tmp_path / "out")
    lost = [line for line in lines if line["status"] != "ok"]
    assert process.returncode == (1 if lost else 0)
    assert {line["status"] for line in lost} <= {"failed"}
    expected = [f"row {int(line['name'][4:]) + 2} ({line['name']}): killed its process (SIGKILL, perhaps" for line in lost]
    assert [place for place, line in zip(expected, lost, strict=True) if place not in line["error"]] == []
    assert errors.count("\n") == errors.count("Error: ") == len(lost)
    assert variant.run(tmp_path / "out").returncode == 0
    assert snapshot(tmp_path / "out") == variant.tree


def test_ctrl_c_ends_the_run_at_once_with_what_there_is(tmp_path: Path) -> None:
    variant = Variant(tmp_path, rows=40, width=2.0, formats="stl")
    folder = tmp_path / "out"
    process = variant.start(folder)
    wait_until(lambda: len(list(folder.glob("row*"))) >= 3, "the first rows")
    began = time.monotonic()
    send_to_all(process, signal.SIGINT)
    output, errors = process.communicate(timeout=PATIENCE)
    assert time.monotonic() - began < ORPHANS_LIVE
    assert (process.returncode, output, errors.strip()) == (130, "", "Aborted!")
    assert wait_for_end(below(process), ORPHANS_LIVE) == []
    assert lies(folder) == []
    lines = read_results(folder)
    states = [line["status"] for line in lines]
    assert len(states) == 40 and set(states) == {"ok", "not run"}
    assert {line["name"] for line in lines if line["status"] == "ok"} <= {path.name for path in folder.glob("row*")}
    assert not list(folder.glob(".*"))
    assert variant.run(folder).returncode == 0
    assert snapshot(folder) == variant.tree


# ---------------------------------------------------------------------- killed before each change on disk


@pytest.fixture(autouse=True)
def _workers_end() -> Iterator[None]:
    yield
    close_workers()


def killed_before_every_write(action: Callable[[], object], folder: Path) -> Iterator[int]:
    """Do something again and again, killed one change on disk later each time, until it is done; the count of changes."""
    number = 1
    while isolated(jobs.killed_at, (action, number, folder), PATIENCE):
        yield number
        number += 1


GEAR = "x,20,1,2,,,,,"
PAIR = "x,,,,1,17,20,2,2"

CHANGES = {
    "nothing to a gear": (None, GEAR),
    "nothing to a pair": (None, PAIR),
    "gear to another gear": ("x,21,1,2,,,,,", GEAR),
    "gear to pair": (GEAR, PAIR),
    "pair to gear": (PAIR, GEAR),
}


_LONG = ("nothing to a gear", "nothing to a pair", "gear to another gear", "pair to gear")


@pytest.mark.parametrize("change", [pytest.param(name, marks=[pytest.mark.long] * (name in _LONG)) for name in CHANGES])
def test_worker_killed_before_any_change_on_disk_leaves_no_lie(change: str, tmp_path: Path) -> None:
    before, after = CHANGES[change]
    folder, saved, workspace = tmp_path / "out", tmp_path / "saved", tmp_path / "out" / ".work"

    def task(row: str) -> Task:
        rows = open_table(write_table(tmp_path / "table.csv", (HEADING, row))).rows()
        return Task(next(rows), (Build(formats=(Format.CSV, Format.DXF)),), folder, workspace, False)

    def make(row: str) -> None:
        shutil.rmtree(workspace, ignore_errors=True)  # as a run does when it begins
        workspace.mkdir(parents=True)
        assert isolated(make_row, task(row), PATIENCE).status is Status.OK

    make(after)
    expected = snapshot(folder)
    shutil.rmtree(folder)
    workspace.mkdir(parents=True)
    if before:
        make(before)
    shutil.copytree(folder, saved)

    moments = 0
    for moments in killed_before_every_write(partial(make_row, task(after)), folder):
        assert lies(folder) == []
        make(after)
        assert snapshot(folder) == expected, f"killed before change {moments}"
        shutil.rmtree(folder)
        shutil.copytree(saved, folder)
    assert moments > len(expected)  # one for each file at least


@pytest.mark.long
def test_parent_killed_before_any_change_on_disk_leaves_no_trace(tmp_path: Path) -> None:
    """From the output folder to the tables of results; its workers die with it."""
    rows = table(tmp_path / "table.csv", 3, 2.0)
    folder = tmp_path / "deep" / "out"
    run = partial(run_table, rows, folder, (Data(),), jobs=1)
    run()
    expected = snapshot(folder)
    shutil.rmtree(tmp_path / "deep")
    moments = 0
    for moments in killed_before_every_write(run, tmp_path / "deep"):
        assert not folder.exists() or lies(folder) == []
        assert run().failed == 0
        assert snapshot(folder) == expected, f"killed before change {moments}"
        if moments % 2:
            shutil.rmtree(tmp_path / "deep")
    assert moments > 8

"""A target that cannot be written: one clear line, no traceback, what is finished stays, and the next run ends the work."""

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.batches import GEARS, lies, read_results, snapshot, write_table
from support.processes import PATIENCE, run_batch, start_batch, wait_until

from gearcad.batch import run_table
from gearcad.core.errors import OutputError
from gearcad.core.output import mark_folder
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data
from gearcad.solids import Format

pytestmark = pytest.mark.usefixtures("kept_workers")

DATA = (Data(),)
POINTS = (Build(formats=(Format.CSV,)),)

ROWS = 30
MANY = (GEARS[0], *(f"row {number:03d},{12 + number % 50},1,2,{number % 3}" for number in range(ROWS)))


@pytest.fixture
def table(tmp_path: Path) -> Path:
    return write_table(tmp_path / "table.csv", GEARS)


@pytest.fixture
def many(tmp_path: Path) -> Path:
    return write_table(tmp_path / "many.csv", MANY)


def one_line(errors: str, start: str, end: str = "") -> None:
    """The user reads one line that says what is wrong, and no traceback."""
    lines = [line for line in errors.splitlines() if line.startswith("Error: ")]
    assert len(lines) == 1, errors
    assert lines[0].startswith(f"Error: {start}") and lines[0].endswith(end), lines[0]
    assert "Traceback" not in errors and "Exception" not in errors


@pytest.mark.parametrize("output", ["file", "file/deep/er"])
def test_output_at_or_below_a_file_is_refused_and_nothing_is_made(output: str, table: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    reason = "File exists" if output == "file" else "Not a directory"
    with pytest.raises(OutputError) as caught:
        run_table(table, tmp_path / output, DATA, jobs=1)
    assert str(caught.value) == f"output = '{tmp_path / output}': cannot be written ({reason}); give a folder you may write to"
    assert (tmp_path / "file").read_text() == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "table.csv"]


@pytest.mark.parametrize("obstacle", ["file", "link", "broken link"])
def test_row_whose_folder_is_no_folder_fails_alone(obstacle: str, table: Path, tmp_path: Path) -> None:
    """A link may lead anywhere: nothing is written through it."""
    place, outside = tmp_path / "out" / "left", tmp_path / "outside"
    (tmp_path / "out").mkdir()
    outside.mkdir()
    if obstacle == "file":
        place.write_text("mine")
        reason = "Not a directory"
    else:
        place.symlink_to(outside if obstacle == "link" else tmp_path / "nowhere")
        reason = "it is a link, which may lead anywhere"
    for _ in range(2):
        summary = run_table(table, tmp_path / "out", DATA, jobs=1)
        said = f"{table} row 3 (left): output = '{place}': cannot be written ({reason}); give a folder you may write to"
        assert (summary.ok, summary.failed, summary.errors) == (2, 1, (said,))
        assert [line["status"] for line in read_results(tmp_path / "out")] == ["ok", "failed", "ok"]
        assert list(outside.iterdir()) == [] and not (tmp_path / "nowhere").exists()
    assert obstacle != "file" or place.read_text() == "mine"
    place.unlink()
    assert run_table(table, tmp_path / "out", DATA, jobs=1).ok == 3


def test_output_may_be_a_link(table: Path, tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "out").symlink_to(tmp_path / "real")
    assert run_table(table, tmp_path / "out", DATA, jobs=1).ok == 3
    assert (tmp_path / "real" / "left" / "data.json").is_file() and (tmp_path / "real" / "results.csv").is_file()


@pytest.mark.parametrize("link", [".gearcad-batch", ".gearcad-batch/lock"])
def test_link_in_place_of_the_workspace_is_refused_and_its_target_stays(link: str, table: Path, tmp_path: Path) -> None:
    """Work would grow there, and be cleared there: all folders of the target were deleted once."""
    precious = tmp_path / "precious"
    (precious / "folder").mkdir(parents=True)
    (precious / "file").write_text("mine")
    before = snapshot(precious)
    place = tmp_path / "out" / link
    place.parent.mkdir(parents=True)
    place.symlink_to(precious if link == ".gearcad-batch" else precious / "file")
    with pytest.raises(OutputError) as caught:
        run_table(table, tmp_path / "out", DATA, jobs=1)
    reason = f"cannot be written ({link} is a link; remove it); give a folder you may write to"
    assert str(caught.value) == f"output = '{tmp_path / 'out'}': {reason}"
    assert snapshot(precious) == before and place.is_symlink()


def test_workspace_that_is_not_ours_is_refused_and_stays(table: Path, tmp_path: Path) -> None:
    """A user's folder of that name was cleared once; one that a killed run has left bears our mark, and is cleared."""
    workspace = tmp_path / "out" / ".gearcad-batch"
    (workspace / "mine").mkdir(parents=True)
    (workspace / "mine" / "file").write_text("mine")
    with pytest.raises(OutputError, match=r"\.gearcad-batch there has no mark of gearcad, so it is not cleared; move it away"):
        run_table(table, tmp_path / "out", DATA, jobs=1)
    assert (workspace / "mine" / "file").read_text() == "mine"
    mark_folder(workspace)
    assert run_table(table, tmp_path / "out", DATA, jobs=1).ok == 3
    assert not workspace.exists()


def test_results_that_cannot_be_replaced_are_status_1(table: Path, tmp_path: Path) -> None:
    """All rows are well, but nobody could read what became of them."""
    (tmp_path / "out" / "results.csv").mkdir(parents=True)
    done = run_batch(table, "-o", tmp_path / "out", "--do", "data", "--quiet")
    assert (done.returncode, done.stdout) == (1, "")
    one_line(done.stderr, f"output = '{tmp_path / 'out'}': cannot be written (results.csv is a folder there)")
    assert lies(tmp_path / "out") == [] and len(list((tmp_path / "out").glob("*/data.json"))) == 3


def test_second_run_in_the_same_folder_is_refused_while_the_first_is_at_it(many: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    with start_batch(many, "-o", folder, "--format", "dxf", "-j", "1", "--quiet") as first:
        wait_until(lambda: list(folder.glob("row*")), "the first row")
        first.send_signal(signal.SIGSTOP)  # however busy the machine is, it is still at it
        with pytest.raises(OutputError, match=r"is in use by another gearcad batch; wait for its end$"):
            run_table(many, folder, DATA, jobs=1)
        first.send_signal(signal.SIGCONT)
        _, errors = first.communicate(timeout=PATIENCE)
    assert (first.returncode, errors) == (0, "")
    assert [line["status"] for line in read_results(folder)] == ["ok"] * ROWS
    assert run_table(many, folder, POINTS, jobs=1).ok == ROWS


def test_folder_that_is_removed_during_the_run_ends_it(many: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    with start_batch(many, "-o", folder, "--format", "dxf", "-j", "2", "--quiet") as process:
        wait_until(lambda: list(folder.glob("row*")), "the first row")
        folder.rename(tmp_path / "gone")
        shutil.rmtree(tmp_path / "gone", ignore_errors=True)
        _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1
    one_line(errors, f"output = '{folder}")
    assert run_table(many, folder, POINTS, jobs=1).ok == ROWS


# ---------------------------------------------------------------------- no room

_LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), int(sys.argv[1])))
from gearcad.cli import main
main(sys.argv[2:])
"""


def run_limited(size: int, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """`gearcad batch` where no file can be larger than `size` bytes; workers inherit the limit."""
    command = [sys.executable, "-c", _LIMITED, str(size), "batch", *map(str, arguments)]
    environment = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"}  # Python would leave parts of its own files
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, env=environment)


def test_files_larger_than_the_system_permits_fail_their_rows(table: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    done = run_limited(30_000, table, "-o", folder, "--format", "dxf,csv", "-j", "1", "--quiet")
    assert done.returncode == 1 and "Traceback" not in done.stderr
    lines = [f"Error: {table} row {number} ({name}): output = '{folder / name}'" for number, name in ((2, "spur"), (3, "left"))]
    said = done.stderr.splitlines()
    assert [line.startswith(start) for line, start in zip(said, lines, strict=False)] == [True, True]
    assert all("cannot be written (File too large)" in line for line in said)
    assert [line["status"] for line in read_results(folder)] == ["failed"] * 3
    assert sorted(path.name for path in folder.iterdir()) == ["columns.csv", "results.csv", "results.parquet"]
    assert run_table(table, folder, (Build(formats=(Format.DXF, Format.CSV)),), jobs=1).ok == 3
    assert lies(folder) == []


def test_results_larger_than_the_system_permits_are_status_1(many: Path, tmp_path: Path) -> None:
    done = run_limited(6_000, many, "-o", tmp_path / "out", "--do", "data", "-j", "1", "--quiet")
    assert (done.returncode, done.stdout) == (1, "")
    one_line(done.stderr, f"output = '{tmp_path / 'out'}': cannot be written (File too large)")
    assert len(list((tmp_path / "out").iterdir())) == ROWS and lies(tmp_path / "out") == []


@pytest.mark.parametrize("formats", ["stl", *(pytest.param(each, marks=pytest.mark.long) for each in ("csv,dxf", "step"))])
def test_full_disk_ends_the_run_and_a_larger_one_the_work(formats: str, small_disk: Path, tmp_path: Path) -> None:
    table, folder, undisturbed = write_table(tmp_path / "table.csv", MANY), small_disk / "out", tmp_path / "undisturbed"
    options = ("--format", formats, "-j", "2", "--quiet")
    done = run_batch(table, "-o", folder, *options)
    assert done.returncode == 1
    one_line(done.stderr, f"output = '{folder}", "cannot be written (No space left on device); give a folder you may write to")
    finished = {path.name for path in folder.glob("row*")}
    assert lies(folder) == [] and 0 < len(finished) < ROWS
    if (folder / "results.csv").exists():
        assert {line["name"] for line in read_results(folder) if line["status"] == "ok"} <= finished
    assert not list(folder.glob(".*"))

    subprocess.run(["mount", "-o", "remount,size=64m", str(small_disk)], check=True)
    again = run_batch(table, "-o", folder, *options)
    assert (again.returncode, again.stderr) == (0, "")
    assert {line["name"] for line in read_results(folder) if not line["seconds"]} == finished
    build = Build(formats=tuple(Format(each) for each in formats.split(",")))
    assert run_table(table, undisturbed, (build,), jobs=1).ok == ROWS
    assert snapshot(folder) == snapshot(undisturbed)


@pytest.fixture
def read_only(tmp_path: Path) -> Iterator[Path]:
    """A folder that nobody may write: root may, so for root it is on a file system of its own."""
    place = tmp_path / "fixed"
    place.mkdir()
    if os.geteuid() != 0:
        place.chmod(0o555)
        yield place
        place.chmod(0o755)
        return
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "gearcad-test", str(place)], capture_output=True).returncode != 0:
        pytest.skip("root may write everywhere, and may not mount here")
    yield place
    subprocess.run(["umount", str(place)], check=True)


@pytest.mark.parametrize("output", ["fixed", "fixed/out"])
def test_read_only_target_is_refused_before_any_work(output: str, read_only: Path, table: Path, tmp_path: Path) -> None:
    done = run_batch(table, "-o", tmp_path / output, "--do", "data", "--quiet")
    assert (done.returncode, done.stdout) == (2, "")
    one_line(done.stderr, f"output = '{tmp_path / output}': cannot be written (", "; give a folder you may write to")
    assert list(read_only.iterdir()) == []

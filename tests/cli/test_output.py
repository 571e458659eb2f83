"""Files appear complete or not at all."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from support.commands import invoke
from support.processes import PATIENCE, hear_interrupts, wait_until

from gearcad import ParameterError
from gearcad.core import output
from gearcad.core.output import MARK, json_text, locked, mark_folder, staged_files
from gearcad.designs.reader import starter_text
from gearcad.jobs.mesh import Mesh


def everything(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def test_files_move_in_when_all_is_well_and_replace_their_namesakes(tmp_path: Path) -> None:
    target = tmp_path / "a" / "b"
    target.mkdir(parents=True)
    (target / "one").write_text("old")
    (target / "other").write_text("stays")
    with staged_files(target) as staging:
        (staging / "one").write_text("new")
        (staging / "two").write_text("new")
        assert (target / "one").read_text() == "old"
    assert everything(target) == ["one", "other", "two"]
    assert (target / "one").read_text() == "new"


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_a_failure_changes_nothing_and_takes_its_folders_along(tmp_path: Path, error: type[BaseException]) -> None:
    (tmp_path / "a").mkdir()
    with pytest.raises(error), staged_files(tmp_path / "a" / "b" / "c") as staging:
        (staging / "half").write_text("written")
        raise error
    assert everything(tmp_path) == ["a"]


def test_a_failure_leaves_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "one").write_text("old")
    with pytest.raises(RuntimeError), staged_files(tmp_path) as staging:
        (staging / "one").write_text("new")
        raise RuntimeError
    assert everything(tmp_path) == ["one"]
    assert (tmp_path / "one").read_text() == "old"


def test_a_folder_in_the_way_of_a_file_is_found_before_any_file_moves(tmp_path: Path) -> None:
    (tmp_path / "two").mkdir()
    with pytest.raises(ParameterError, match=r"cannot be written \(two is a folder there\)"), staged_files(tmp_path) as staging:
        (staging / "one").write_text("new")
        (staging / "two").write_text("new")
    assert everything(tmp_path) == ["two"]


def test_link_is_replaced_and_what_it_leads_to_stays(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "one").symlink_to(tmp_path / "mine")
    with staged_files(tmp_path / "out") as staging:
        (staging / "one").write_text("new")
    assert (tmp_path / "mine").read_text() == "mine"
    assert (tmp_path / "out" / "one").read_text() == "new" and not (tmp_path / "out" / "one").is_symlink()


def test_full_disk_is_a_plain_error(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"^output = '.*': cannot be written \(No space left on device\)"):
        with staged_files(tmp_path / "x"):
            raise OSError(28, os.strerror(28))
    assert everything(tmp_path) == []


def test_json_refuses_what_is_no_json() -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        json_text({"lead": float("inf")})
    assert json_text({"a": 1.0, "b": "µ"}) == '{\n  "a": 1.0,\n  "b": "\\u00b5"\n}\n'


MOVES_SLOWLY = """
import sys, time
from pathlib import Path
from gearcad.core.output import staged_files

replace = Path.replace
pause = 0.2 if sys.argv[1] == "x" else 0.01
Path.replace = lambda *to: (replace(*to), time.sleep(pause))
with staged_files(Path("out")) as staging:
    for name in "abcde":
        (staging / name).write_text(sys.argv[1])
    (staging / f"only {sys.argv[1]}").write_text(sys.argv[1])
"""


def start_slow_moves(folder: Path, *texts: str) -> list[subprocess.Popen[bytes]]:
    """Start processes that write the same files into folder/out, with pauses between the renames."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    return [subprocess.Popen([sys.executable, "-c", MOVES_SLOWLY, text], cwd=folder, env=environment) for text in texts]


def test_files_of_one_folder_are_of_one_process(tmp_path: Path) -> None:
    """One that moves its files slowly has begun when three others come: all files that they share are of the last one."""
    slow = start_slow_moves(tmp_path, "x")
    wait_until((tmp_path / "out" / "a").exists, "the first file")
    processes = [*slow, *start_slow_moves(tmp_path, "y", "y", "y")]
    assert [each.wait(PATIENCE) for each in processes] == [0] * 4
    assert everything(tmp_path) == ["out", *(f"out/{name}" for name in ("a", "b", "c", "d", "e", "only x", "only y"))]
    assert {(tmp_path / "out" / name).read_text() for name in "abcde"} == {"y"}


def test_lock_of_a_killed_process_does_not_hold(tmp_path: Path) -> None:
    """The next one writes all of its files, and removes the folder that the killed one has left."""
    (killed,) = start_slow_moves(tmp_path, "x")
    wait_until((tmp_path / "out" / "a").exists, "the first file")
    killed.kill()
    killed.wait(PATIENCE)
    assert len(list((tmp_path / "out").glob(".unfinished-*"))) == 1
    (after,) = start_slow_moves(tmp_path, "y")
    assert after.wait(PATIENCE) == 0
    assert everything(tmp_path / "out") == ["a", "b", "c", "d", "e", "only y"]
    assert {(tmp_path / "out" / name).read_text() for name in "abcde"} == {"y"}


def test_folder_that_another_process_keeps_locked_is_refused_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(output, "_LONGEST_WAIT", 0.1)
    with locked(tmp_path), pytest.raises(ParameterError) as caught, staged_files(tmp_path):
        raise AssertionError("a folder that is in use")
    said = "is in use by another process; wait for its end, or give another folder"
    assert str(caught.value) == f"output = '{tmp_path}': {said}"
    with staged_files(tmp_path) as staging:
        (staging / "one").write_text("new")
    assert everything(tmp_path) == ["one"]


def test_a_pipe_in_the_place_of_the_folder_is_refused(tmp_path: Path) -> None:
    """Its open waited for a writer for ever."""
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ParameterError, match=r"pipe': cannot be written \(Not a directory\)"), staged_files(tmp_path / "pipe"):
        raise AssertionError("no folder")


@pytest.mark.parametrize("place", ["pipe", "pipe/below", "file/new/below"])
def test_a_long_job_does_not_begin_where_nothing_can_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "file").touch()
    (tmp_path / "it.toml").write_text("[gear]\nteeth = 20\nnormal_module = 2\nface_width = 5\n")
    monkeypatch.setattr(Mesh, "run", None)
    done = invoke("mesh", str(tmp_path / "it.toml"), "-o", str(tmp_path / place))
    said = f"Error: output = '{tmp_path / place}': cannot be written (Not a directory); give a folder you may write to\n"
    assert (done.exit_code, done.stderr) == (2, said)


@pytest.mark.parametrize("results", ["pipe", "/dev/zero"])
def test_a_plot_of_what_is_no_file_is_refused(tmp_path: Path, results: str) -> None:
    """It was read until memory ended, or waited for."""
    os.mkfifo(tmp_path / "pipe")
    done = invoke("plot", str(tmp_path / results), "--x", "a", "--y", "b")
    assert done.exit_code == 2 and "must be an ordinary file; give the results.csv" in done.stderr


def test_large_files_are_not_read(tmp_path: Path) -> None:
    (tmp_path / "large").touch()
    os.truncate(tmp_path / "large", 100_000_000)
    with pytest.raises(OSError, match="it has more than 10 MB"):
        output.file_bytes(tmp_path / "large")


def test_folders_without_our_mark_stay(tmp_path: Path) -> None:
    """A user's folder may be called as ours are; a copy of ours under another name is the user's too."""
    mine = [tmp_path / name for name in (".unfinished-thesis", ".unfinished-0123456789ab", ".unfinished-copy")]
    for folder in mine:
        folder.mkdir()
        (folder / "chapter").write_text("mine")
    ours = tmp_path / ".unfinished-ba9876543210"
    ours.mkdir()
    mark_folder(ours)
    shutil.copy(ours / MARK, mine[2] / MARK)
    (mine[1] / MARK).mkdir()
    with staged_files(tmp_path) as staging:
        (staging / "one").write_text("new")
    assert not ours.exists() and (tmp_path / "one").is_file()
    assert [(folder / "chapter").read_text() for folder in mine] == ["mine"] * 3


@pytest.mark.parametrize("trial", [0, *(pytest.param(trial, marks=pytest.mark.long) for trial in (1, 2))])
def test_four_builds_of_two_specs_into_one_folder_leave_one_of_them(tmp_path: Path, trial: int) -> None:
    """One of the four is killed at some moment; the files that are there are of one of the two gears."""
    for teeth in (20, 30):
        spec = f'[gear]\nname = "it"\nteeth = {teeth}\nnormal_module = 2\nface_width = 10\n'
        (tmp_path / f"{teeth}.toml").write_text(spec)
    command = [sys.executable, "-m", "gearcad", "build", "-o", "out", "--format", "csv,dxf", "--quiet"]
    runs = [
        subprocess.Popen([*command, f"{teeth}.toml"], cwd=tmp_path, stdout=subprocess.DEVNULL) for teeth in (20, 30, 20, 30)
    ]
    time.sleep(random.Random(trial).uniform(0.3, 1.5))
    runs[trial].kill()
    statuses = [run.wait(PATIENCE) for run in runs]
    assert [status for at, status in enumerate(statuses) if at != trial] == [0] * 3
    made = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir() if not path.name.startswith(".unfinished-")}
    alone = {}
    for teeth in (20, 30):
        alone_command = [*command, f"{teeth}.toml"]
        alone_command[alone_command.index("out")] = f"alone-{teeth}"
        subprocess.run(alone_command, cwd=tmp_path, stdout=subprocess.DEVNULL, check=True)
        alone[teeth] = {path.name: path.read_bytes() for path in (tmp_path / f"alone-{teeth}").iterdir()}
    assert made in list(alone.values())


@pytest.mark.parametrize("sent", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
def test_build_that_is_stopped_leaves_no_half_written_file(sent: signal.Signals, tmp_path: Path) -> None:
    """SIGKILL cannot be caught: it may leave a hidden folder, never a file under its final name. The others clean up."""
    (tmp_path / "x.toml").write_text("[gear]\nteeth = 300\nnormal_module = 2\nface_width = 50\nhelix_angle = 20\n")
    command = [sys.executable, "-m", "gearcad", "build", "x.toml", "-o", "out", "--chord-error", "0.0005"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "preexec_fn": hear_interrupts}
    with subprocess.Popen(command, cwd=tmp_path, **pipes) as child:
        wait_until(lambda: list((tmp_path / "out").glob(".unfinished-*/gear.stl")), "a file that is being written")
        child.send_signal(sent)
        output, errors = child.communicate(timeout=60)
    assert (child.returncode, output) == (-signal.SIGKILL if sent is signal.SIGKILL else 128 + sent, ""), errors
    if sent is not signal.SIGKILL:
        assert errors.splitlines()[-1] == "Aborted!" and "Traceback" not in errors
        assert sorted(path.name for path in tmp_path.iterdir()) == ["x.toml"]
    else:
        assert [path.name for path in (tmp_path / "out").iterdir() if not path.name.startswith(".unfinished-")] == []


def stopped_at_random(number: int, sent: signal.Signals, folder: Path, *command: str) -> None:
    """Stop a command at random moments of its life, all of its group or itself: it ends at once, says so, leaves nothing."""
    whole = [sys.executable, "-m", "gearcad", *command]
    began = time.monotonic()
    subprocess.run(whole, cwd=folder, capture_output=True, check=True)
    seconds = time.monotonic() - began
    before = sorted(path.relative_to(folder) for path in folder.rglob("*"))
    chance, in_time = random.Random(1), 0
    for turn in range(number):
        with subprocess.Popen(
            whole,
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            preexec_fn=hear_interrupts,
        ) as child:
            time.sleep(chance.uniform(0.15, 0.8 * seconds))
            if child.poll() is not None:
                continue  # this machine was slower when the time was taken
            in_time += 1
            (os.killpg if turn % 2 else os.kill)(child.pid, sent)
            began = time.monotonic()
            _, errors = child.communicate(timeout=60)
            assert time.monotonic() - began < 3.0
        assert child.returncode == 128 + sent, errors
        assert errors.splitlines()[-1] == "Aborted!" and "Traceback" not in errors
        assert sorted(path.relative_to(folder) for path in folder.rglob("*")) == before
    assert in_time > number / 2


@pytest.mark.long
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_build_stopped_at_any_moment(sent: signal.Signals, tmp_path: Path) -> None:
    """Also while kernels are being imported, where Ctrl-C used to be lost or to be told as a fault."""
    (tmp_path / "pair.toml").write_text(starter_text("volvo-13-44")[1])
    stopped_at_random(20, sent, tmp_path, "build", "pair.toml")


@pytest.mark.long
@pytest.mark.parametrize("command", ["check", "stiffness", "dynamics", "modify"])
def test_numbers_stopped_at_any_moment(command: str, tmp_path: Path) -> None:
    (tmp_path / "pair.toml").write_text(starter_text("fzg-c")[1])
    options = {"stiffness": ["--method", "plane-strain"], "modify": ["--force"]}.get(command, [])
    stopped_at_random(4, signal.SIGINT, tmp_path, command, "pair.toml", *options)

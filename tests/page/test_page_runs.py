"""Runs of the page: their processes end as they should, and they make what the command writes, byte by byte."""

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest
from support.commands import invoke
from support.specs import FACETED_OR_FLAT, TEMPLATES

from gearcad.core.errors import ParameterError
from gearcad.designs.reader import read_spec, starter_text
from gearcad.jobs.draw import SheetFormat
from gearcad.page.panels.runs import expected_of, figures_beside
from gearcad.page.run_process import _LARGEST_FILE, RUNS, RunRequest
from gearcad.page.runs import Run, RunLimits, RunPermits, Runs, RunState, _kill, close_all_runs
from gearcad.page.words import PageLanguage, PageWords

ENOUGH = 60.0
PAIR = starter_text("fzg-c")[1]


@pytest.fixture
def runs() -> Iterator[Runs]:
    made = Runs()
    yield made
    made.close()


def _start(runs: Runs, kind: str, text: str = PAIR, folder: Path = Path()) -> Run:
    return runs.start(kind, text, "mine", folder, {})


def _ended(run: Run) -> Run:
    assert run.ended.wait(ENOUGH)
    return run


def _until_step(run: Run) -> None:
    end = time.monotonic() + ENOUGH
    while not run.step and time.monotonic() < end:
        time.sleep(0.02)
    assert run.step, run


def _children() -> set[str]:
    return {each.name for each in Path("/proc").glob("[0-9]*") if _parent(each) == os.getpid()}


def _parent(process: Path) -> int:
    try:
        return int((process / "stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def test_a_run_leaves_what_its_job_writes_and_nothing_else_is_its(runs: Runs) -> None:
    run = _ended(_start(runs, "data"))
    assert (run.state, run.name, run.files) == (RunState.DONE, "fzg-c", ("data.json",))
    assert (found := run.file("data.json")) is not None and found.is_file()
    assert run.file("../data.json") is None and run.file("rate.json") is None


def test_what_is_wrong_is_the_line_of_the_command_line(runs: Runs) -> None:
    wrong = _ended(_start(runs, "rate", PAIR.replace("teeth = 16", "teeth = 2")))
    assert wrong.state is RunState.FAILED
    assert wrong.line.startswith("mine.toml line ") and "teeth" in wrong.line
    assert not wrong.folder.exists()


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the system tells no process's memory")
def test_a_cancelled_run_is_gone_at_once_and_leaves_nothing(runs: Runs) -> None:
    before = _children()
    run = _start(runs, "check-3d")
    waiting = _start(runs, "rate")
    _until_step(run)
    assert _children() - before
    began = time.monotonic()
    runs.cancel(waiting)
    runs.cancel(run)
    assert _ended(run).state is RunState.CANCELLED
    assert time.monotonic() - began < 5
    assert _ended(waiting).state is RunState.CANCELLED
    assert not _children() - before
    assert not run.folder.exists()


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the system tells no process's memory")
def test_a_run_out_of_time_or_memory_is_ended_and_says_so() -> None:
    for limits, line in (
        (RunLimits(seconds=0.3), "was stopped at its time limit of 0.3 s"),
        (RunLimits(memory=1e6), "was stopped at its memory limit of 0.001 GB"),
    ):
        bounded = Runs(limits)
        run = _ended(_start(bounded, "check-3d"))
        assert (run.state, run.line) == (RunState.FAILED, line)
        bounded.close()


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the system tells no process's memory")
def test_a_process_that_dies_says_why_and_the_next_run_is_well(runs: Runs) -> None:
    before = _children()
    run = _start(runs, "check-3d")
    _until_step(run)
    for child in _children() - before:
        os.kill(int(child), 9)
    assert _ended(run).line.startswith("killed its process (SIGKILL")
    assert _ended(_start(runs, "data")).state is RunState.DONE


def test_a_closed_session_ends_its_run_and_removes_its_files() -> None:
    runs = Runs()
    done, run = _ended(_start(runs, "data")), _start(runs, "check-3d")
    folder = done.folder.parent
    assert folder.is_dir()
    runs.close()
    assert _ended(run).state is RunState.CANCELLED
    end = time.monotonic() + ENOUGH
    while folder.exists() and time.monotonic() < end:
        time.sleep(0.02)
    assert not folder.exists()
    with pytest.raises(ParameterError):
        _start(runs, "data")


def test_sessions_take_turns_in_the_order_in_which_they_came() -> None:
    """The first has the turn until the two others wait behind each other; it asks again while they do."""
    turns, told, never = RunPermits(1), list[str](), threading.Event()

    def wait_for(count: int) -> None:
        until = time.monotonic() + 60
        while len(turns._waiting) < count and time.monotonic() < until:
            time.sleep(0.001)

    def session(name: str, count: int) -> None:
        for number in range(count):
            with turns.taken(never) as has:
                assert has
                told.append(name)
                if (name, number) == ("a", 0):
                    wait_for(2)

    first, second, third = (threading.Thread(target=session, args=given) for given in (("a", 4), ("b", 1), ("c", 1)))
    first.start()
    until = time.monotonic() + 60
    while not told and time.monotonic() < until:
        time.sleep(0.001)
    second.start()
    wait_for(1)
    third.start()
    for thread in (first, second, third):
        thread.join()
    assert told == ["a", "b", "c", "a", "a", "a"]


def test_the_end_of_the_server_ends_all_and_leaves_nothing() -> None:
    runs = [Runs(), Runs()]
    started = [_start(each, "check-3d") for each in runs]
    close_all_runs()
    assert {run.state for run in started} == {RunState.CANCELLED}
    assert not any(run.folder.parent.exists() for run in started)


def test_only_so_many_wait(runs: Runs) -> None:
    asked = [_start(runs, "check-3d") for _ in range(5)]
    with pytest.raises(ParameterError, match="must wait"):
        _start(runs, "data")
    for run in asked:
        runs.cancel(run)
    assert {_ended(run).state for run in asked} == {RunState.CANCELLED}


def test_the_eldest_runs_lose_their_files(runs: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.page.runs._MOST_KEPT", 1)
    eldest = _start(runs, "check-3d")
    runs.cancel(eldest)
    _ended(eldest)
    eldest.folder.mkdir()
    eldest.files = ("check.json",)
    runs.cancel(_start(runs, "check-3d"))
    assert not eldest.files and not eldest.folder.exists()


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="needs groups of processes")
def test_what_a_run_has_started_ends_with_it() -> None:
    shell = ["sh", "-c", "sleep 60 & echo $!; wait"]
    process = subprocess.Popen(shell, stdout=subprocess.PIPE, start_new_session=True)
    assert process.stdout is not None
    started = int(process.stdout.readline())
    _kill(process)
    process.wait()
    end = time.monotonic() + ENOUGH
    while psutil.pid_exists(started) and psutil.Process(started).status() != psutil.STATUS_ZOMBIE and time.monotonic() < end:
        time.sleep(0.01)
    assert not psutil.pid_exists(started) or psutil.Process(started).status() == psutil.STATUS_ZOMBIE


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limits")
def test_no_file_of_a_run_is_larger_than_permitted() -> None:
    program = "from gearcad.page.run_process import _bound; _bound(); import resource as r; print(*r.getrlimit(r.RLIMIT_FSIZE))"
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert told.split() == [str(_LARGEST_FILE)] * 2


@pytest.mark.parametrize(
    ("option", "given", "line"),
    [
        ("--time-limit", "nan", "time_limit = nan s: must be a number above 0 s"),
        ("--time-limit", "-3", "time_limit = -3 s: must be a number above 0 s"),
        ("--memory-limit", "0", "memory_limit = 0 GB: must be a number above 0 GB"),
    ],
)
def test_limits_that_are_none_are_told_before_anything_is_served(option: str, given: str, line: str) -> None:
    told = invoke("open", option, given, "--no-browser")
    assert (told.exit_code, told.stderr) == (2, f"Error: {line}\n")


def test_limits_are_those_of_all_sessions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Runs, "permitted", RunLimits(seconds=7.0, memory=3e9))
    runs = Runs()
    runs.close()
    assert (runs.limits.seconds, runs.limits.memory) == (7.0, 3e9)


def test_what_would_not_begin_says_why() -> None:
    found = expected_of(read_spec(TEMPLATES / "volvo-13-44.toml"), PageWords.of(PageLanguage.ENGLISH))
    assert found["check-2d"].why.startswith("pair.helix_angle = 28 deg: must be 0 for model 2d")
    assert not found["check-2d"].told
    assert not found["check-3d"].why
    assert found["check-3d"].told.startswith("≈ ")
    assert "about" not in found["check-3d"].told


def test_what_a_mesh_takes_is_not_found_in_the_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """Gmsh counts its elements, which must not happen in a thread: it ends the process."""
    monkeypatch.setattr("gearcad.jobs.mesh.Mesh.expected", lambda _self, _design: pytest.fail("asked"))
    found = expected_of(read_spec(TEMPLATES / "fzg-c.toml"), PageWords.of(PageLanguage.ENGLISH))
    assert (found["mesh"].told, found["mesh"].why) == ("", "")


def test_verdicts_are_told_in_the_words_of_the_page() -> None:
    asked = RunRequest(kind="rate", text="", name="trial", folder="", into="")
    runs = [
        Run(number, asked, {}, figures={"strength": said}) for number, said in enumerate(("passed", "failed", "not judged"))
    ]
    cells = {language: figures_beside(runs, PageWords.of(language))[0]["cells"] for language in PageLanguage}
    assert cells[PageLanguage.GERMAN] == ["bestanden", "nicht bestanden", "nicht beurteilt"]
    assert cells[PageLanguage.ENGLISH] == ["passed", "not passed", "not judged"]


LONG = 900.0
"""Seconds that a run may take."""

COARSE = '\n[check]\npositions = 12\nrefinement = 0.25\nconvergence = "off"\n'

COMMAND_PAIR = starter_text("fzg-c")[1] + COARSE
RATED = starter_text("reducer")[1] + COARSE
BY_BODIES = RATED.replace("\n[rating]", '\n[rating]\nface_load_factor = "fe"', 1)

COMMANDS = {
    "check-2d": (COMMAND_PAIR, "check --model 2d"),
    "check-3d": (COMMAND_PAIR, "check --model 3d"),
    "rate": (RATED, "rate"),
    "rate-fe": (BY_BODIES, "rate"),
    "stiffness": (COMMAND_PAIR, "stiffness"),
    "dynamics": (COMMAND_PAIR, "dynamics"),
    "planetary": (starter_text("planetary-24-21-66")[1], "planetary"),
    "shafts": (starter_text("two-stage")[1], "shafts"),
    "verify": (starter_text("fzg-c")[1], "verify"),
    **{each: (RATED, f"build --format {each}") for each in ("step", *FACETED_OR_FLAT)},
    **{f"drawing-{kind.value}": (RATED, f"draw --format {kind.value}") for kind in SheetFormat},
    "data": (RATED, "data --json"),
}
"""Of each run of the page the spec and the command that does the same."""

QUICK = ("data",)


OWN = [kind for kind, run in RUNS.items() if run.mesh is None]
"""Runs on the design itself. Those on the meshes of trains have no command on the train: other tests judge them."""


@pytest.mark.parametrize("kind", [kind if kind in QUICK else pytest.param(kind, marks=pytest.mark.long) for kind in OWN])
def test_a_run_makes_what_the_command_writes(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    text, command = COMMANDS[kind]
    verb, *options = command.split()
    spec, folder = tmp_path / "mine.toml", tmp_path / "out"
    spec.write_text(text, encoding="utf-8")
    if verb != "data":
        options += ["-o", str(folder)]
    told = invoke(verb, str(spec), *options)
    assert told.exit_code in (0, 1), told.output
    written = (
        {path.name: path.read_bytes() for path in folder.iterdir()} if folder.exists() else {"data.json": told.stdout_bytes}
    )
    runs = Runs()
    try:
        run = runs.start(kind, RATED if kind == "rate-fe" else text, "mine", tmp_path, {})
        assert run.ended.wait(LONG)
        assert run.state is RunState.DONE, run.line
        assert written == {name: (run.folder / name).read_bytes() for name in run.files}
    finally:
        runs.close()
        runs.join(10)

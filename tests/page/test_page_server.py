"""The server of the page: port, terminal, what tabs hand over, and how it ends."""

import logging
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from support.processes import PATIENCE, hear_interrupts

from gearcad.core.errors import ParameterError
from gearcad.core.output import mark_folder
from gearcad.designs.reader import starter_text
from gearcad.page import session
from gearcad.page.runs import Runs, runs_of
from gearcad.page.server import _PREFIX, LOCAL, LogLimiter, _bury_the_dead, _hold, _listening_socket
from gearcad.page.session import SessionHandover, hand_over, note_link, remember, resumed, take_over
from gearcad.page.workbench import BesideDesign, Workbench

SPUR = "[gear]\nteeth = 24\nnormal_module = 2.5\nface_width = 10\n"

PROGRAM = """
import tempfile, time
from gearcad.page.server import ending
with ending():
    tempfile.mkstemp()
    print(tempfile.gettempdir(), flush=True)
    time.sleep(60)
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP", "SIGKILL"])
def test_only_who_is_killed_leaves_a_folder(name: str, tmp_path: Path) -> None:
    if not hasattr(signal, name):
        pytest.skip("needs the signals of Unix")
    own = os.environ | {"TMPDIR": str(tmp_path)}
    server = subprocess.Popen(
        [sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True, env=own, preexec_fn=hear_interrupts
    )
    assert server.stdout is not None
    folder = Path(server.stdout.readline().strip())
    assert folder.parent == tmp_path and list(folder.iterdir())
    server.send_signal(signal.Signals[name])
    killed = name == "SIGKILL"
    assert server.wait(PATIENCE) == (-signal.SIGKILL if killed else 0)
    assert folder.exists() == killed


@pytest.mark.skipif(sys.platform == "win32", reason="needs locks of Unix")
def test_the_next_removes_what_the_dead_have_left_and_nothing_else(tmp_path: Path) -> None:
    names = (f"{_PREFIX}a", f"{_PREFIX}b", f"{_PREFIX}c", "gearcad-d", f"{_PREFIX}e")
    dead, held, young, other, unmarked = (tmp_path / name for name in names)
    for folder in (dead, held, young, other, unmarked):
        (folder / "more").mkdir(parents=True)
        if folder != unmarked:
            mark_folder(folder)
    (tmp_path / f"{_PREFIX}link").symlink_to(other)
    hour = time.time() - 3600
    for folder in (dead, held, other, unmarked):
        os.utime(folder, (hour, hour))
    os.utime(tmp_path / f"{_PREFIX}link", (hour, hour), follow_symlinks=False)
    lock = _hold(str(held))
    assert lock is not None
    _bury_the_dead(tmp_path)
    assert not dead.exists()
    assert all((folder / "more").exists() for folder in (held, young, other, unmarked))
    os.close(lock)
    _bury_the_dead(tmp_path)
    assert not held.exists()


def _left() -> SessionHandover:
    return SessionHandover(BesideDesign(Workbench(starter_text("spur")[1], "mine", Path())), Runs())


def test_what_is_left_is_taken_once() -> None:
    left = _left()
    key = hand_over(left)
    assert take_over("another") is None
    assert take_over(key) is left
    assert take_over(key) is None
    left.runs.close()


def test_runs_that_nobody_takes_over_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "_SECONDS", 0.01)
    left = _left()
    key = hand_over(left)
    end = time.monotonic() + 10
    while runs_of(left.runs.key) is not None and time.monotonic() < end:
        time.sleep(0.01)
    assert runs_of(left.runs.key) is None and take_over(key) is None


def test_a_page_loaded_again_before_its_address_follows_has_the_last_keystroke(tmp_path: Path) -> None:
    bench = Workbench(SPUR, "spur", tmp_path)
    remember("tab", BesideDesign(bench))
    before = BesideDesign(Workbench(SPUR, "spur", tmp_path))
    bench.change({"gear.teeth": "25"}, 1)
    found = resumed("tab", before)
    assert found is not None and found.bench.text == bench.text
    assert found.bench.can_undo and resumed("tab", None) is not None
    note_link("tab", bench.text)
    bench.change({"gear.teeth": "26"}, 2)
    for linked in (before, BesideDesign(Workbench(found.bench.text, "spur", tmp_path))):
        latest = resumed("tab", linked)
        assert latest is not None and latest.bench.text == bench.text
    other = BesideDesign(Workbench(SPUR.replace("24", "31"), "spur", tmp_path))
    assert resumed("tab", other) is None and resumed("another", before) is None


def test_who_looks_at_the_same_time_finds_another_port() -> None:
    with _listening_socket(LOCAL, None) as first, _listening_socket(LOCAL, None) as second:
        taken = first.getsockname()[1]
        assert taken != second.getsockname()[1]
        with pytest.raises(ParameterError, match=f"port = {taken}: must be free at {LOCAL}"):
            _listening_socket(LOCAL, taken)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", ""])
def test_no_page_is_everywhere(host: str) -> None:
    with pytest.raises(ParameterError, match="one address"):
        _listening_socket(host, None)


class _Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def _told(lines: LogLimiter, message: object, error: Exception | None = None) -> str | None:
    record = logging.LogRecord(
        "nicegui", logging.ERROR, "", 0, message, (), None if error is None else (type(error), error, None)
    )
    return record.getMessage() if lines.filter(record) else None


def test_no_browser_floods_the_terminal() -> None:
    clock = _Clock()
    lines = LogLimiter(most=3, within=60.0, clock=clock)
    told = [_told(lines, "x") for _ in range(1000)]
    assert told[:2] == ["x", "x"]
    assert told[2] == "x (what else goes wrong within a minute is not told)"
    assert told[3:] == [None] * 997
    clock.now = 60.0
    assert _told(lines, "x") == "x"


def test_each_is_a_line_that_moves_no_cursor() -> None:
    lines = LogLimiter()
    assert _told(lines, "\x1b[2J\nforged: line") == "\\x1b[2J\\nforged: line"
    assert _told(lines, ValueError("a\nb")) == "a page failed (ValueError: a\\nb)"
    assert _told(lines, "while x", KeyError("id")) == "a page failed (KeyError: 'id')"
    assert _told(lines, "Traceback (most recent call last):\n  File x\nValueError: y\n") == "ValueError: y"
    assert len(_told(lines, "x" * 1_000_000) or "") == 500

"""How a server ends, and what one that was killed has left."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gearcad.core.output import mark_folder
from gearcad.page.server import _PREFIX, _bury_the_dead, _hold

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
    server = subprocess.Popen(
        [sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True, env=os.environ | {"TMPDIR": str(tmp_path)}
    )
    assert server.stdout is not None
    folder = Path(server.stdout.readline().strip())
    assert folder.parent == tmp_path and list(folder.iterdir())
    server.send_signal(signal.Signals[name])
    killed = name == "SIGKILL"
    assert server.wait(20) == (-signal.SIGKILL if killed else 0)
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

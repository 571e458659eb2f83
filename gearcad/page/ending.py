"""How a server ends: at once, with all its processes, and with all files that were only for it."""

from __future__ import annotations

import os
import shutil
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from gearcad.output import has_mark, mark_folder

__all__ = ["ending"]

_PATIENCE = 2.0
"""Seconds that threads have to end the processes of runs."""

_RUNS = "gearcad-runs"
"""What their threads are called."""

_PREFIX = "gearcad-open-"
"""What the folders of servers are called."""

_YOUNG = 60.0
"""Seconds in which who has made a folder has come to hold it."""


@contextmanager
def ending() -> Iterator[None]:
    """Temporary files of this process and its children are in one folder, which goes at the end; the process ends then.

    Ctrl-C, SIGTERM and the terminal's end are what ends a server: its exit status is 0. What other threads still compute
    nobody wants any more. Folders of servers that were killed go at the begin of the next.
    """
    _bury_the_dead(Path(tempfile.gettempdir()))
    folder = tempfile.mkdtemp(prefix=_PREFIX)
    _hold(folder)
    mark_folder(Path(folder))
    former, tempfile.tempdir = tempfile.tempdir, folder
    os.environ["TMPDIR"] = folder
    signal.signal(signal.SIGTERM, _stop)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # nohup has it ignored
        signal.signal(signal.SIGHUP, _hang_up)
    try:
        with suppress(KeyboardInterrupt):
            yield
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        _wait()
    finally:
        tempfile.tempdir = former
        shutil.rmtree(folder, ignore_errors=True)
    with suppress(OSError):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(0)


def _stop(_number: int, _frame: object) -> None:
    raise KeyboardInterrupt


def _hang_up(_number: int, _frame: object) -> None:
    """As SIGTERM, for which the server has its own handler while it serves."""
    signal.raise_signal(signal.SIGTERM)


def _hold(folder: str) -> int | None:
    """Lock a folder until this process ends, however it ends: what nobody has locked is a dead one's.

    The lock, or None where somebody has it, the folder is not ours, or the system has no such locks.
    """
    try:
        import fcntl

        held = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW)
    except (ImportError, OSError):
        return None
    try:
        if os.fstat(held).st_uid == os.getuid():
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return held
    except OSError:
        pass
    os.close(held)
    return None


def _bury_the_dead(temporary: Path) -> None:
    """Remove the folders of servers that were killed, those with our mark only."""
    for folder in filter(has_mark, temporary.glob(f"{_PREFIX}*")):
        with suppress(OSError):
            if time.time() - folder.lstat().st_mtime > _YOUNG and (held := _hold(str(folder))) is not None:
                shutil.rmtree(folder, ignore_errors=True)
                os.close(held)


def _wait() -> None:
    """Until no thread minds the process of a run any more."""
    end = time.monotonic() + _PATIENCE
    for thread in threading.enumerate():
        if thread.name == _RUNS:
            thread.join(max(end - time.monotonic(), 0.0))

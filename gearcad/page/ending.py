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

__all__ = ["ending"]

_PATIENCE = 2.0
"""Seconds that threads have to end the processes of runs."""

_RUNS = "gearcad-runs"
"""What their threads are called."""


@contextmanager
def ending() -> Iterator[None]:
    """Temporary files of this process and its children are in one folder, which goes at the end; the process ends then.

    Ctrl-C and SIGTERM are what ends a server: its exit status is 0. What other threads still compute nobody wants any more.
    """
    folder = tempfile.mkdtemp(prefix="gearcad-page-")
    former, tempfile.tempdir = tempfile.tempdir, folder
    os.environ["TMPDIR"] = folder
    signal.signal(signal.SIGTERM, _stop)
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


def _wait() -> None:
    """Until no thread minds the process of a run any more."""
    end = time.monotonic() + _PATIENCE
    for thread in threading.enumerate():
        if thread.name == _RUNS:
            thread.join(max(end - time.monotonic(), 0.0))

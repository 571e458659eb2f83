"""The command `gearcad`, which `python -m gearcad` is too."""

from __future__ import annotations

import gc
import os
import signal
import sys
from itertools import pairwise

from gearcad.core.guard import CAN_GUARD, guarded

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from typing import NoReturn

__all__ = ["run"]

_MINDS_ITSELF = ("batch", "open")
"""Commands that work in processes of their own; at Ctrl-C they report what they have, or end those processes."""


def run() -> None:
    """Run the command line, and end this process."""
    _open_standard_streams()
    words = [word for before, word in pairwise(sys.argv) if before != "--language" and not word.startswith("-")]
    command = words[0] if words else ""
    if CAN_GUARD and command not in _MINDS_ITSELF:
        guarded(_work)
        return
    if hasattr(signal, "SIGTERM") and signal.getsignal(signal.SIGTERM) is not signal.SIG_IGN:
        signal.signal(signal.SIGTERM, _terminate)
    try:
        _work()
    except KeyboardInterrupt:
        os.write(2, b"Aborted!\n")
        sys.exit(128 + signal.SIGINT)


def _open_standard_streams() -> None:
    """Open the null device in place of standard streams that the caller has closed: other files would get their numbers."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest free number, which is this one
            setattr(sys, name, open(number, "w" if number else "r", closefd=False))


_COLLECTIONS = (2_000, 10, 50)
"""Thresholds of the garbage collector: while libraries are loaded the usual ones cost 0.5 s for nothing."""


def _work() -> None:
    gc.set_threshold(*_COLLECTIONS)
    from gearcad.cli import main

    main(prog_name="gearcad")


def _terminate(number: int, _frame: object) -> NoReturn:
    """End the process through SystemExit, so that everything is cleaned up."""
    sys.exit(128 + number)


if __name__ == "__main__":
    run()

"""Child processes that answer through pipes: how one is started, how it begins, and words for how it ended.

A child is started by its command line and not by multiprocessing, which would run the user's script again in it and forbids
children to the processes of Dask. Requests reach it through stdin, whose closing ends it; answers leave it through stdout.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import IO, Any

from gearcad.core.errors import format_number
from gearcad.core.guard import death, die_with

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""The parallel unit is the process; one thread each also gives the same bytes on every machine."""


def start_child(module: str, *, own_session: bool = False) -> subprocess.Popen[bytes]:
    """Start a process that calls `serve()` of `module`, with pipes for requests and answers.

    With `own_session` the child and all processes that it starts form a group, which can be killed as one.
    """
    return subprocess.Popen(
        [sys.executable, "-c", f"import sys; sys.path[:] = {sys.path!r}; from {module} import serve; serve()"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | _ONE_THREAD,
        start_new_session=own_session,
    )


def pipes_of(child: subprocess.Popen[bytes]) -> tuple[IO[bytes], IO[bytes]]:
    """Return the pipes of a child, the first for requests, the second for answers."""
    assert child.stdin is not None and child.stdout is not None  # Popen was asked for pipes
    return child.stdin, child.stdout


def become_child() -> int:
    """Prepare this process for its work as a child, and return the file descriptor for its answers.

    It ignores Ctrl-C, which reaches all processes of a terminal: the parent decides. It dies with its parent. What a library
    prints goes to stderr, so that it does not mix with the answers.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with(os.getppid())  # the thread that reads has no say while a kernel holds the interpreter
    answers = os.dup(1)
    os.dup2(2, 1)
    return answers


def end_with_input(read: Callable[[], object], status: int) -> None:
    """Call `read`, which reads stdin until it closes, in a thread; then end this process, work in progress included.

    `status` is the exit status. Nobody waits for an answer once stdin is closed.
    """

    def reading() -> None:
        with suppress(EOFError, OSError):
            read()
        os._exit(status)

    threading.Thread(target=reading, daemon=True).start()


def limit_cpu_time(child: subprocess.Popen[Any], seconds: int) -> None:
    """Let the system end a child by SIGXCPU after so many seconds of CPU time; only Linux can."""
    if sys.platform == "linux":
        import resource

        with suppress(ProcessLookupError):
            resource.prlimit(child.pid, resource.RLIMIT_CPU, (seconds, seconds + 1))


def ending_words(status: int) -> str:
    """Return a phrase on how a child ended by itself or by a signal, from the exit status of its Popen."""
    return death(-status) if status < 0 else f"ended its process (exit status {status})"


def time_limit_words(seconds: float) -> str:
    """Return a phrase for a child that was stopped at its time limit (s)."""
    return f"was stopped at its time limit of {format_number(seconds)} s"

"""Work in a process of its own: what kills that process - a fault in a kernel, no memory, no end - costs one call, not the run.

`isolated` is what every thread of a pool runs, on this machine or on a Dask worker. A child is started by its command line and
not by multiprocessing, which would run the user's script again in it and forbids children to the processes of Dask.
"""

from __future__ import annotations

import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import IO, Any, TypeVar

from gearcad.errors import GearcadError, format_number
from gearcad.guard import death, die_with

__all__ = ["ONE_THREAD", "WorkerLostError", "close_workers", "isolated", "own_worker"]

Argument = TypeVar("Argument")
Result = TypeVar("Result")

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""The parallel unit is the row; one thread each also gives the same bytes on every machine."""

_LENGTH_BYTES = 8

_here = threading.local()
_open: set[_Worker] = set()


class WorkerLostError(GearcadError, RuntimeError):
    """The process that did the work is gone, and why."""


def isolated(function: Callable[[Argument], Result], argument: Argument, time_limit: float) -> Result:
    """`function(argument)` in the child process of this thread, which lives on and keeps what it imported.

    Raises WorkerLostError if the child dies or needs more than `time_limit` (s) - the next call has a new one - and whatever
    `function` raises.
    """
    worker: _Worker | None = getattr(_here, "worker", None)
    if worker is None or (worker.closed and not worker.only):
        worker = _here.worker = _Worker()
    answer: Result = worker.call(function, argument, time_limit)
    return answer


def own_worker() -> None:
    """Give this thread its only child: once `close_workers` has ended that, `isolated` raises WorkerLostError in this thread.

    A thread that takes calls only after this cannot begin one that `close_workers` does not see.
    """
    _here.worker = _Worker(only=True)


def close_workers() -> None:
    """End the children of all threads of this process, what they are doing included."""
    for worker in list(_open):
        worker.close()


class _Worker:
    """One child process at a time, and what is said to it through its pipes."""

    def __init__(self, *, only: bool = False) -> None:
        self.closed, self.only = False, only
        self._process: subprocess.Popen[bytes] | None = None
        self._starting = threading.Lock()
        _open.add(self)

    def call(self, function: Callable[[Any], Any], argument: Any, time_limit: float) -> Any:
        """Send the call, wait for the answer."""
        message = pickle.dumps((function, argument))
        process = self._running()
        expired = threading.Event()
        watch = threading.Timer(time_limit, _end, (process, expired))
        watch.daemon = True
        watch.start()
        try:
            _send(_pipe(process.stdin), message)
            answer = _receive(_pipe(process.stdout))
        except (EOFError, OSError):
            process.kill()
            raise WorkerLostError(_reason(process.wait(), time_limit if expired.is_set() else None)) from None
        finally:
            watch.cancel()
        succeeded, value = pickle.loads(answer)
        if not succeeded:
            raise value
        return value

    def close(self) -> None:
        """Kill the child; an unfinished call ends with WorkerLostError."""
        with self._starting:  # or a child that is just being started would escape
            self.closed = True
        _open.discard(self)
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    def _running(self) -> subprocess.Popen[bytes]:
        with self._starting:
            if self.closed:
                raise WorkerLostError("the run was ended")
            if self._process is None or self._process.poll() is not None:
                self._process = _start()
            return self._process


def _start() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-c", f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import serve; serve()"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | ONE_THREAD,
    )


def _pipe(pipe: IO[bytes] | None) -> IO[bytes]:
    assert pipe is not None  # Popen was asked for pipes
    return pipe


def _send(pipe: IO[bytes], message: bytes) -> None:
    pipe.write(len(message).to_bytes(_LENGTH_BYTES, "little") + message)
    pipe.flush()


def _receive(pipe: IO[bytes]) -> bytes:
    """A whole message, also one that nobody can make sense of: the next begins where it ends. Raises EOFError, OSError."""
    length = int.from_bytes(_read(pipe, _LENGTH_BYTES), "little")
    return _read(pipe, length)


def _read(pipe: IO[bytes], count: int) -> bytes:
    content = pipe.read(count)
    if len(content) < count:
        raise EOFError
    return content


def _end(process: subprocess.Popen[bytes], expired: threading.Event) -> None:
    expired.set()
    process.kill()


def _reason(status: int, time_limit: float | None) -> str:
    """Why a child is gone, in words."""
    if time_limit is not None:
        return f"was stopped at its time limit of {format_number(time_limit)} s"
    if status >= 0:
        return f"ended its process (exit status {status})"
    return death(-status)


def serve() -> None:
    """The child: answer calls from stdin until it closes, which also ends work in progress: nobody waits for it any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the parent decides
    die_with(os.getppid())  # the thread that listens has no say while a kernel holds the interpreter
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever a library prints must not mix with the answers
    calls: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(calls,), daemon=True).start()
    while True:
        call = calls.get()
        try:
            function, argument = pickle.loads(call)
            answer = pickle.dumps((True, function(argument)))
        except Exception as error:
            answer = pickle.dumps((False, _sendable(error)))
        with suppress(BrokenPipeError):
            _send(answers, answer)


def _listen(calls: queue.SimpleQueue[bytes]) -> None:
    while True:
        try:
            calls.put(_receive(sys.stdin.buffer))
        except (EOFError, OSError):
            os._exit(0)


def _sendable(error: Exception) -> Exception:
    """The error, or its text if it does not survive the way to the parent."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error

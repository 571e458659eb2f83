"""Guard process beside the one that works: however the work ends, no partial files remain, and Ctrl-C ends it at once.

A geometry kernel or a solver does not look at signals, and one that arrives while it is being imported is lost, or breaks it.
So the command line works in a fork of itself that ignores Ctrl-C; the process that the user has started waits, kills the fork
where a signal asks for its end, and removes what the fork has told it would be left.

Until the fork nothing minds Ctrl-C, so this module imports as little as it can.
"""

from __future__ import annotations

import os
import select
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pathlib import Path
    from typing import NoReturn


CAN_GUARD = hasattr(os, "fork")

_STAGING, _FOLDER, _BEGIN, _END = b"S", b"F", b"(", b")"
"""Messages of the worker: a folder to remove with it, one to remove if it is empty, renames that belong together."""

_PATIENCE = 2.0
"""Time (s) that such renames may take before they are interrupted after all."""

_STOPPING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
_MUCH = 1 << 16
_SHOW_CURSOR = b"\x1b[?25h\r\x1b[K"
_PR_SET_PDEATHSIG = 1

_told: int | None = None
"""The pipe to the process that minds this one, if any does."""


def _tell(kind: bytes, path: Path | None = None) -> None:
    if _told is not None:
        with suppress(OSError):
            os.write(_told, kind + (b"" if path is None else os.fsencode(path.absolute())) + b"\0")


def note_staging(folder: Path) -> None:
    """Record, before it is made, a `folder` to be removed with its contents if this process dies."""
    _tell(_STAGING, folder)


def note_folder(folder: Path) -> None:
    """Record, before it is made, a `folder` to be removed if this process dies and it is empty."""
    _tell(_FOLDER, folder)


@contextmanager
def undivided() -> Iterator[None]:
    """Keep Ctrl-C from interrupting changes on disk inside this context, which should be short."""
    _tell(_BEGIN)
    try:
        yield
    finally:
        _tell(_END)


def guarded(work: Callable[[], None]) -> None:
    """Do `work` in a fork of this process and end as it ends; the call returns in the fork only.

    A signal that ends the work (SIGINT, SIGTERM, SIGHUP) gives the exit status of a shell, 128 and its number.
    """
    heard, wake = os.pipe()
    os.set_blocking(wake, False)
    signal.set_wakeup_fd(wake)
    for number in (*filter(_is_heard, _STOPPING), signal.SIGCHLD):
        signal.signal(number, _nothing)
    listened, told = os.pipe()
    keeper = os.getpid()
    worker = os.fork()
    if worker:
        os.close(told)
        _keep(worker, heard, listened)
    signal.set_wakeup_fd(-1)
    for fd in (heard, wake, listened):
        os.close(fd)
    _become_worker(keeper, told)
    work()


def _is_heard(number: signal.Signals) -> bool:
    """Return False if the caller ignores the signal, as nohup does, and a shell for background commands."""
    return signal.getsignal(number) is not signal.SIG_IGN


def _nothing(_number: int, _frame: object) -> None:
    """Do nothing; this signal handler only wakes up the process."""


def _become_worker(keeper: int, told: int) -> None:
    global _told
    _told = told
    for number in (*filter(_is_heard, _STOPPING), signal.SIGCHLD):
        # Ctrl-C reaches all processes of a terminal, and the keeper decides.
        signal.signal(number, signal.SIG_IGN if number is signal.SIGINT else signal.SIG_DFL)
    die_with(keeper)


def die_with(parent: int) -> None:
    """Let this process, a child of `parent`, be killed when that dies, also while a kernel holds the interpreter (Linux)."""
    if sys.platform != "linux":
        return
    import ctypes

    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


def death(number: int) -> str:
    """Return a phrase on how a signal ended a process."""
    name = signal.Signals(number).name
    return f"killed its process ({name}{', perhaps for want of memory' if name == 'SIGKILL' else ''})"


def _keep(worker: int, heard: int, listened: int) -> NoReturn:
    """Wait for the worker, kill it where a signal asks for its end, bury it, and leave with its exit status."""
    notes, stopped, fds = b"", 0, [heard, listened]
    while True:
        ended, status = os.waitpid(worker, os.WNOHANG)
        if ended:
            break
        ready, _, _ = select.select(fds, [], [], _PATIENCE if stopped else None)
        if listened in ready:
            content = os.read(listened, _MUCH)
            notes += content
            fds = fds if content else [heard]
        if heard in ready:
            stopped = next((each for each in os.read(heard, _MUCH) if each != signal.SIGCHLD), stopped)
        if stopped and not (ready and _is_divided(notes)):
            os.kill(worker, signal.SIGKILL)
    if os.WIFEXITED(status):
        os._exit(os.WEXITSTATUS(status))
    while listened in fds and (content := os.read(listened, _MUCH)):
        notes += content
    _bury(notes)
    _leave(stopped or os.WTERMSIG(status))


def _is_divided(notes: bytes) -> bool:
    """Return whether some of the renames that belong together are yet to come."""
    told = notes.split(b"\0")
    return told.count(_BEGIN) > told.count(_END)


def _bury(notes: bytes) -> None:
    """Remove the files that the worker has left, except those that are gone or have been filled."""
    import shutil
    from pathlib import Path

    told = [(note[:1], os.fsdecode(note[1:])) for note in notes.split(b"\0")[:-1]]
    for kind, path in told:
        if kind == _STAGING:
            shutil.rmtree(path, ignore_errors=True)
    for kind, path in reversed(told):
        if kind == _FOLDER:
            with suppress(OSError):
                Path(path).rmdir()


def _leave(number: int) -> NoReturn:
    """End this process as one whose work a signal has ended."""
    if os.isatty(2):
        os.write(2, _SHOW_CURSOR)  # a progress bar hides it
    if number in _STOPPING:
        os.write(2, b"Aborted!\n")
        os._exit(128 + number)
    if number == signal.SIGPIPE:  # nobody reads on, as behind `| head`; files may be there by then
        os._exit(128 + number)
    os.write(2, f"Error: something in the work {death(number)}; nothing was written\n".encode())
    os._exit(1)

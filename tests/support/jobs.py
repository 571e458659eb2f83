"""What a worker process is made to do in tests; functions are found there by their name, so they cannot stand in a test."""

import ctypes
import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

from gearcad.batch import row
from gearcad.batch.row import Record, Task, make_row

WRITES = ("os.mkdir", "os.rename", "os.remove", "os.rmdir", "shutil.rmtree")
"""Audit events before something changes on disk; opening a file to write is another."""


def echo(value: Any) -> Any:
    return value


def own_process(_: Any = None) -> int:
    return os.getpid()


def repeat(byte: bytes) -> bytes:
    """An answer far larger than a pipe holds."""
    return byte * 3_000_000


def wait(seconds: float) -> None:
    time.sleep(seconds)


def work(seconds: float) -> None:
    """Like `wait`, but in Python all the time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        pass


def hold_the_interpreter(seconds: int) -> None:
    """A kernel that does not let any other thread run."""
    ctypes.PyDLL(None).sleep(seconds)


def die(how: str) -> None:
    """Lose the process in one of the ways that a kernel has."""
    if how == "exit":
        os._exit(3)
    if how == "segfault":
        ctypes.string_at(0)
    if how == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if how == "abort":
        os.abort()
    if how == "hang":
        wait(60)
    if how == "memory":
        raise MemoryError("no memory for 3 faces")


def raise_it(error: Exception) -> NoReturn:
    raise error


class Unsendable(Exception):
    """An error that does not survive the way to another process."""

    def __init__(self, one: int, two: int) -> None:
        super().__init__(f"{one} and {two}")


def raise_unsendable(_: Any) -> NoReturn:
    raise Unsendable(1, 2)


def unsendable_answer(_: Any) -> Callable[[], None]:
    return lambda: None


class Unreadable:
    """An object that can be sent but not read, and much behind it that must not be taken for what comes next."""

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[str, bytes]]:
        return refuse_to_be_read, ("no", b"\0" * 300_000)


def refuse_to_be_read(text: str, _: bytes) -> NoReturn:
    raise ImportError(text)


def unreadable(_: Any = None) -> tuple[Unreadable, bytes]:
    return Unreadable(), b"x" * 300_000


def print_everywhere(_: Any) -> str:
    """What libraries say on stdout, from Python, from C, and straight to the file."""
    print("from Python", flush=True)
    library = ctypes.CDLL(None)
    library.puts(b"from C")
    library.fflush(None)
    os.write(1, b"to the file")
    return "said"


def interrupt(_: Any) -> str:
    """Ctrl-C reaches every process of a terminal."""
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.01)
    return "still here"


def make_row_or_die(task: Task) -> Record:
    """Make the row, unless its name begins with a way to die."""
    die(task.row.name.partition("-")[0].replace("_", " "))
    return make_row(task)


def make_row_of_another_gearcad(task: Task) -> Record:
    """Make the row with a gearcad whose source differs."""
    ours, row._gearcad_hash = row._gearcad_hash, lambda: "other"
    try:
        return make_row(task)
    finally:
        row._gearcad_hash = ours


def kill_before_write(number: int, inside: Path) -> None:
    """Kill this process just before the `number`-th time (from 1) that it changes something below the folder `inside`."""
    left = number

    def watch(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal left
        changes = event in WRITES or (event == "open" and _to_write(arguments))
        if changes and str(arguments[0]).startswith(str(inside)):
            left -= 1
            if left == 0:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(watch)


def _to_write(arguments: tuple[Any, ...]) -> bool:
    return bool(arguments[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT))


def killed_at(attempt: tuple[Callable[[], Any], int, Path]) -> bool:
    """Do a thing in a fork of this process killed before its n-th change below a folder; False if it has not so many."""
    function, number, folder = attempt
    process = os.fork()
    if process == 0:
        kill_before_write(number, folder)
        function()
        os._exit(0)
    _, status = os.waitpid(process, 0)
    assert status in (0, signal.SIGKILL), status
    return status != 0

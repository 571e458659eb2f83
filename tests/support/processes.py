"""The command `gearcad batch` as a process of its own, its children, and their end."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

import psutil

PATIENCE = 60.0
"""Seconds that anything may take on a busy machine before a test gives up."""


def batch_command(*arguments: str | Path) -> list[str]:
    return [sys.executable, "-m", "gearcad", "batch", *map(str, arguments)]


def run_batch(*arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run `gearcad batch` to its end."""
    return subprocess.run(
        batch_command(*arguments), capture_output=True, text=True, timeout=10 * PATIENCE, env=os.environ | environment
    )


def hear_interrupts() -> None:
    """For `preexec_fn`: the suite may run where Ctrl-C is ignored, in the background of a shell; the child must not."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start_batch(*arguments: str | Path) -> subprocess.Popen[str]:
    """Start `gearcad batch` as the leader of a group of processes, as a terminal does."""
    return subprocess.Popen(
        batch_command(*arguments),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=hear_interrupts,
    )


def below(process: subprocess.Popen[str]) -> list[psutil.Process]:
    """The processes that a process from `start_batch` has started, also when it has gone itself."""
    found = []
    for each in psutil.process_iter():
        with suppress(ProcessLookupError):
            if each.pid != process.pid and os.getsid(each.pid) == process.pid:
                found.append(each)
    return found


def wait_for_end(processes: Iterable[psutil.Process], seconds: float) -> list[psutil.Process]:
    """Wait until all have ended; those that have not within `seconds`. A zombie that nobody has buried has ended."""
    left = list(processes)
    end = time.monotonic() + seconds
    while True:
        left = [process for process in left if _is_alive(process)]
        if not left or time.monotonic() > end:
            return left
        time.sleep(0.01)


def _is_alive(process: psutil.Process) -> bool:
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def wait_until(true: Callable[[], object], what: str) -> None:
    """Wait until `true()`; fails after a long time."""
    end = time.monotonic() + PATIENCE
    while not true():
        assert time.monotonic() < end, f"waited {PATIENCE:g} s in vain for {what}"
        time.sleep(0.005)


def send_to_all(process: subprocess.Popen[str], signal_number: signal.Signals) -> None:
    """A signal to the process and all below it at once, as a terminal sends Ctrl-C."""
    with suppress(ProcessLookupError):  # it had ended
        os.killpg(process.pid, signal_number)

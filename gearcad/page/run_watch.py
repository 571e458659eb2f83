"""The process of a run, seen from the server: it is started, heard, and ended where it must be."""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from gearcad.batch.worker import ONE_THREAD
from gearcad.errors import format_number
from gearcad.guard import death
from gearcad.page.run import GIGABYTE, Limits, Run, State
from gearcad.progress import Clock, Expected

__all__ = ["do_run"]

_LOOK = 0.2
"""Seconds between two looks at a process."""

_PAGE_SIZE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


def do_run(run: Run, limits: Limits) -> None:
    """Start the process of a run, hear it, and see that it keeps to its limits."""
    run.state = State.RUNNING
    process = _started()
    lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    assert process.stdin is not None and process.stdout is not None  # Popen was asked for pipes
    threading.Thread(target=_hear, args=(process.stdout, lines), daemon=True).start()
    try:
        with suppress(BrokenPipeError):
            process.stdin.write(run.asked.line())
            process.stdin.flush()
        _follow(run, process, lines, limits)
    finally:
        _kill(process)
        with suppress(OSError):
            process.stdin.close()
        status = process.wait()
    if not run.state.ended:
        why = death(-status) if status < 0 else f"ended its process (exit status {status})"
        run.state, run.line = State.FAILED, why


def _follow(run: Run, process: subprocess.Popen[bytes], lines: queue.SimpleQueue[bytes], limits: Limits) -> None:
    """Until it has ended, or must."""
    end, clock = time.monotonic() + limits.seconds, Clock(None)
    while not run.state.ended:
        if run.stop.is_set():
            run.state = State.CANCELLED
        elif why := _excess(process, end, limits):
            run.line, run.state = why, State.FAILED
        else:
            with suppress(queue.Empty):
                line = lines.get(timeout=_LOOK)
                if not line:
                    return
                clock = _take(run, json.loads(line), clock)


def _excess(process: subprocess.Popen[bytes], end: float, limits: Limits) -> str:
    """Which limit it exceeds, in words; "" for none."""
    if time.monotonic() > end:
        return f"was stopped at its time limit of {format_number(limits.seconds)} s"
    if _memory_of(process.pid) > limits.memory:
        return f"was stopped at its memory limit of {limits.memory / GIGABYTE:.3g} GB"
    return ""


def _take(run: Run, told: Mapping[str, Any], clock: Clock) -> Clock:
    """What a line of the process tells; the clock by which time left is told."""
    if "expected" in told:
        return Clock(Expected(**told["expected"]))
    if "step" in told:
        run.step = told["step"]
        run.share = min(told["done"] / told["whole"], 1.0) if told["whole"] else 0.0
        run.left = clock.left(run.share)
    elif "error" in told:
        run.line, run.state = told["error"], State.FAILED
    else:
        result = told["result"]
        run.line, run.figures = result["conclusion"], dict(_flat(result["figures"]))
        run.name, run.notices, run.files = result["name"], tuple(result["notices"]), tuple(result["files"])
        run.share, run.state = 1.0, State.DONE
    return clock


def _flat(figures: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Under dotted keys as a table of results has them; warnings are told as notices."""
    for key, value in figures.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{key}.")
        elif not isinstance(value, list):
            yield f"{before}{key}", value


def _started() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [
            sys.executable,
            "-c",
            f"import sys; sys.path[:] = {sys.path!r}; from gearcad.page.run_process import serve; serve()",
        ],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | ONE_THREAD,
        start_new_session=True,
    )


def _hear(pipe: Any, lines: queue.SimpleQueue[bytes]) -> None:
    """Lines as they come, b"" at the end."""
    with suppress(OSError, ValueError):
        for line in pipe:
            lines.put(line)
    lines.put(b"")


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End a process and all that it has started."""
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()


def _memory_of(pid: int) -> float:
    """Bytes that a process has; nothing where the system does not tell."""
    try:
        return float(Path(f"/proc/{pid}/statm").read_bytes().split()[1]) * _PAGE_SIZE
    except (OSError, IndexError, ValueError):
        return 0.0

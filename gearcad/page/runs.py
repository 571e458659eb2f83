"""Runs of a session: one at a time in a process of its own; their files, and files from the browser."""

from __future__ import annotations

import json
import math
import os
import queue
import secrets
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import zipfile
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from enum import Enum
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, ClassVar

from fastapi import FastAPI, Request, Response
from fastapi.responses import FileResponse

from gearcad.core.child_process import ending_words, pipes_of, start_child, time_limit_words
from gearcad.core.errors import ParameterError, require_number
from gearcad.core.runtime import Clock, Expected, cores, machine_memory
from gearcad.page.run_process import RUNS, RunKind, RunRequest
from gearcad.page.searches import SEARCHES, SearchKind

GIGABYTE = 1e9

_SHARE_OF_MEMORY = 0.5
_MOST_MEMORY = 16e9


def _most_memory() -> float:
    """Return half of the machine's memory (bytes); infinite if the system does not report the memory of a process."""
    told = Path("/proc/self/statm").exists()
    return min(_SHARE_OF_MEMORY * machine_memory(), _MOST_MEMORY) if told else math.inf


@dataclass(frozen=True, kw_only=True)
class RunLimits:
    """Limits of one run: seconds, and bytes of memory (Linux)."""

    seconds: float = 3600.0
    memory: float = field(default_factory=_most_memory)

    def __post_init__(self) -> None:
        require_number("time_limit", self.seconds, "s", above=0)
        if not math.isinf(self.memory):
            require_number("memory_limit", self.memory / GIGABYTE, "GB", above=0)


class RunState(Enum):
    """State of a run."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def ended(self) -> bool:
        return self in (RunState.DONE, RunState.FAILED, RunState.CANCELLED)


@dataclass
class Run:
    """One run: its request, and the reports of its process so far. A thread fills it, others read it."""

    number: int
    asked: RunRequest
    given: Mapping[str, str]
    """Values of the spec under its keys, by which runs are told apart."""

    state: RunState = RunState.WAITING
    step: str = ""
    share: float = 0.0
    left: str = ""
    line: str = ""
    """The verdict as the command line says it, or the error."""

    name: str = ""
    """Name of the design, as in the names of its files."""

    figures: Mapping[str, Any] = field(default_factory=dict)
    found: Mapping[str, Any] = field(default_factory=dict, repr=False)
    """What a search has found so far."""

    notices: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    stop: threading.Event = field(default_factory=threading.Event, repr=False)
    ended: threading.Event = field(default_factory=threading.Event, repr=False)

    @property
    def folder(self) -> Path:
        """Folder that holds the files of the run."""
        return Path(self.asked.into)

    def file(self, name: str) -> Path | None:
        """The path of one of its files, if it has one of this name."""
        return self.folder / name if name in self.files and self.state is RunState.DONE else None


_LOOK = 0.2
"""Seconds between two looks at a process."""

_PAGE_SIZE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


def do_run(run: Run, limits: RunLimits) -> None:
    """Start the process of a run, hear it, and see that it keeps to its limits."""
    run.state = RunState.RUNNING
    module = "searches" if run.asked.kind in SEARCHES else "run_process"
    process = start_child(f"gearcad.page.{module}", own_session=True)
    requests, answers = pipes_of(process)
    lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_queue_lines, args=(answers, lines), daemon=True).start()
    try:
        with suppress(BrokenPipeError):
            requests.write(run.asked.line())
            requests.flush()
        _follow(run, process, lines, limits)
    finally:
        _kill(process)
        with suppress(OSError):
            requests.close()
        status = process.wait()
    if not run.state.ended:
        run.state, run.line = RunState.FAILED, ending_words(status)


def _follow(run: Run, process: subprocess.Popen[bytes], lines: queue.SimpleQueue[bytes], limits: RunLimits) -> None:
    """Follow the process of a run until it ends, is cancelled or exceeds a limit."""
    end, clock = time.monotonic() + limits.seconds, Clock(None)
    while not run.state.ended:
        if run.stop.is_set():
            run.state = RunState.CANCELLED
        elif why := _excess(process, end, limits):
            run.line, run.state = why, RunState.FAILED
        else:
            with suppress(queue.Empty):
                line = lines.get(timeout=_LOOK)
                if not line:
                    return
                clock = _take(run, json.loads(line), clock)


def _excess(process: subprocess.Popen[bytes], end: float, limits: RunLimits) -> str:
    """Return in words which limit a process exceeds; "" if none."""
    if time.monotonic() > end:
        return time_limit_words(limits.seconds)
    if _memory_of(process.pid) > limits.memory:
        return f"was stopped at its memory limit of {limits.memory / GIGABYTE:.3g} GB"
    return ""


def _take(run: Run, told: Mapping[str, Any], clock: Clock) -> Clock:
    """Store the content of a line from the process in the run, and return the clock for the time left."""
    if "expected" in told:
        return Clock(Expected(**told["expected"]))
    if "found" in told:
        run.found = told["found"]
        return clock
    if "step" in told:
        run.step = told["step"]
        run.share = min(told["done"] / told["whole"], 1.0) if told["whole"] else 0.0
        run.left = clock.left(run.share)
    elif "error" in told:
        run.line, run.state = told["error"], RunState.FAILED
    else:
        result = told["result"]
        run.line, run.figures = result["conclusion"], dict(_flat(result["figures"]))
        run.name, run.notices, run.files = result["name"], tuple(result["notices"]), tuple(result["files"])
        run.share, run.state = 1.0, RunState.DONE
    return clock


def _flat(figures: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the figures under dotted keys, as in a table of results. Lists are left out: warnings are reported as notices."""
    for key, value in figures.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{key}.")
        elif not isinstance(value, list):
            yield f"{before}{key}", value


def _queue_lines(pipe: Any, lines: queue.SimpleQueue[bytes]) -> None:
    """Put the lines of a pipe into a queue as they arrive, and b"" at the end."""
    with suppress(OSError, ValueError):
        for line in pipe:
            lines.put(line)
    lines.put(b"")


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End a process and all processes that it started."""
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()


def _memory_of(pid: int) -> float:
    """Return the memory (bytes) of a process; 0 if the system does not report it."""
    try:
        return float(Path(f"/proc/{pid}/statm").read_bytes().split()[1]) * _PAGE_SIZE
    except (OSError, IndexError, ValueError):
        return 0.0


_PATIENCE = 5.0
"""Seconds that files may take to go."""

_MOST_WAITING = 4
_MOST_KEPT = 40
"""Runs whose files a session keeps: the eldest lose theirs."""


class RunPermits:
    """Permits for a limited number of runs of all sessions at a time; waiting sessions are served in order of arrival."""

    def __init__(self, count: int) -> None:
        self._free, self._waiting, self._changed = count, deque[object](), threading.Condition()

    @contextmanager
    def taken(self, stop: threading.Event) -> Iterator[bool]:
        """A turn, or False where `stop` was set meanwhile."""
        mine = object()
        with self._changed:
            self._waiting.append(mine)
            while not stop.is_set() and not (self._free and self._waiting[0] is mine):
                self._changed.wait(_LOOK)
            self._waiting.remove(mine)
            has = not stop.is_set()
            self._free -= has
            self._changed.notify_all()
        try:
            yield has
        finally:
            with self._changed:
                self._free += has
                self._changed.notify_all()


KINDS: Mapping[str, RunKind | SearchKind] = {**RUNS, **SEARCHES}
"""All kinds of runs."""

_TURNS = RunPermits(max(cores(), 1))


_OPEN: dict[str, Runs] = {}


def runs_of(key: str) -> Runs | None:
    """Return the runs of an open session by its secret key, or None."""
    return _OPEN.get(key)


def close_all_runs() -> None:
    """End the runs of all sessions and remove their files, because the server ends."""
    closed = list(_OPEN.values())
    for runs in closed:
        runs.close()
    for runs in closed:
        runs.join(_PATIENCE)


class Runs:
    """The runs of a session: one at a time, the others wait; `close` ends them and removes their files.

    `permitted` holds the limits of each run of any session.
    """

    permitted: ClassVar[RunLimits] = RunLimits()

    def __init__(self, limits: RunLimits | None = None) -> None:
        self.limits = limits or self.permitted
        self.all: list[Run] = []
        self.key = secrets.token_urlsafe(16)
        _OPEN[self.key] = self
        self._folder = tempfile.TemporaryDirectory(prefix="gearcad-", ignore_cleanup_errors=True)
        self._calls: queue.SimpleQueue[Run | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._closed = False

    def start(
        self, kind: str, text: str, name: str, folder: Path, given: Mapping[str, str], options: Mapping[str, Any] | None = None
    ) -> Run:
        """Begin a run of one of KINDS, or let it wait. Raises ParameterError where too many wait."""
        if self._closed or sum(not run.state.ended for run in self.all) > _MOST_WAITING:
            raise ParameterError("run", kind, f"must wait: {_MOST_WAITING} runs are waiting already; cancel one of them")
        number = len(self.all)
        into = Path(self._folder.name) / str(number)
        asked = RunRequest(kind=kind, text=text, name=name, folder=str(folder), into=str(into), options=options or {})
        run = Run(number, asked, given)
        self.all.append(run)
        for old in self.all[:-_MOST_KEPT]:
            old.files, old.found = (), {}
            shutil.rmtree(old.folder, ignore_errors=True)
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="gearcad-runs", daemon=True)
            self._thread.start()
        self._calls.put(run)
        return run

    def cancel(self, run: Run) -> None:
        """End a run at once."""
        run.stop.set()

    @property
    def busy(self) -> bool:
        return any(not run.state.ended for run in self.all)

    def close(self) -> None:
        """End all runs, and remove their files."""
        self._closed = True
        _OPEN.pop(self.key, None)
        for run in self.all:
            run.stop.set()
        self._calls.put(None)
        if self._thread is None:
            self._folder.cleanup()

    def join(self, seconds: float) -> None:
        """Wait until the closed runs have ended."""
        if self._thread is not None:
            self._thread.join(seconds)

    def _work(self) -> None:
        """One after the other. The thread lives as long as the session: a process dies with the thread that has started it."""
        while (run := self._calls.get()) is not None:
            with _TURNS.taken(run.stop) as has:
                if has:
                    do_run(run, self.limits)
                else:
                    run.state = RunState.CANCELLED
            if run.state is not RunState.DONE:
                shutil.rmtree(run.folder, ignore_errors=True)
            run.ended.set()
        self._folder.cleanup()


_POLICY = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "font-src data:; form-action 'none'; base-uri 'none'"
)
"""Content security policy of a report: it may run its own scripts, and reach nothing else, not even this page."""

_HEADERS = {"X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Cache-Control": "no-store"}


def add_made(app: FastAPI) -> None:
    """Answer requests for them; a path is looked up among what a run has made, and never used as one."""

    @app.get("/made/{key}/{number}")
    def files(key: str, number: int) -> Response:
        run = _run(key, number)
        return _missing() if run is None else _attached(run)

    @app.get("/made/{key}/{number}/{name}")
    def report(key: str, number: int, name: str) -> Response:
        run = _run(key, number)
        if run is None or name != KINDS[run.asked.kind].report or (path := run.file(name)) is None:
            return _missing()
        return FileResponse(path, media_type="text/html", headers={**_HEADERS, "Content-Security-Policy": _POLICY})


def download_file(run: Run) -> tuple[str, Path]:
    """Name and path of the file that holds what a run has made: the one file, or a zip of several."""
    kind = run.asked.kind
    paths = [path for name in run.files if fnmatch(name, KINDS[kind].taken) and (path := run.file(name)) is not None]
    if len(paths) == 1:
        return f"{run.name}{paths[0].suffix}", paths[0]
    packed = run.folder.with_suffix(".zip")
    if not packed.exists():
        unfinished = packed.with_suffix(f".{secrets.token_hex(4)}")
        with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as archive:
            for path in paths:
                archive.write(path, path.name)
        unfinished.replace(packed)
    return f"{run.name}-{kind}.zip", packed


def _run(key: str, number: int) -> Run | None:
    """A run that has files."""
    runs = runs_of(key)
    found = runs.all[number] if runs is not None and 0 <= number < len(runs.all) else None
    return found if found is not None and found.state is RunState.DONE and found.files else None


def _attached(run: Run) -> Response:
    name, path = download_file(run)
    return FileResponse(path, filename=name, media_type="application/octet-stream", headers=_HEADERS)


def _missing() -> Response:
    return Response("no such file\n", 404, media_type="text/plain")


Takers = Mapping[str, tuple[int, Callable[[str, bytes], None]]]
"""Greatest size in bytes, and the function that takes name and content, for each kind of file."""

_LONGEST_NAME = 200
_WAITING: dict[str, Takers] = {}


def await_files(key: str, takers: Takers | None) -> None:
    """Accept uploaded files under a session's secret key from now on; without takers, stop accepting them."""
    if takers is None:
        _WAITING.pop(key, None)
    else:
        _WAITING[key] = takers


def add_given(app: FastAPI) -> None:
    """Take them at this app."""

    @app.post("/given/{key}/{what}")
    async def given(key: str, what: str, name: str, request: Request) -> Response:
        if key not in _WAITING or what not in _WAITING[key]:
            return _text_response(404, "no such session")
        most, take = _WAITING[key][what]
        content = bytearray()
        async for part in request.stream():
            content += part
            if len(content) > most:
                return _text_response(413, f"more than {most // 1024} kB")
        take(name[:_LONGEST_NAME], bytes(content))
        return _text_response(200, "taken")


def _text_response(status: int, text: str) -> Response:
    return Response(text, status, media_type="text/plain")


def add_routes(app: FastAPI) -> None:
    """Answer them at this app, and what is not there, or goes wrong, by a line."""
    add_made(app)
    add_given(app)
    app.add_exception_handler(404, _routes_missing)
    app.add_exception_handler(Exception, _broken)


def _routes_missing(_request: Request, _error: Exception) -> Response:
    return Response("no such page\n", 404, media_type="text/plain")


def _broken(_request: Request, error: Exception) -> Response:
    return Response(f"failed ({type(error).__name__})\n", 500, media_type="text/plain")

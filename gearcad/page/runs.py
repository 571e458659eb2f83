"""Runs: what a session has asked for, one at a time in a process of its own."""

from __future__ import annotations

import queue
import secrets
import shutil
import tempfile
import threading
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import ClassVar

from gearcad.batch.pool import available_cores
from gearcad.errors import ParameterError
from gearcad.page.run import Limits, Run, State
from gearcad.page.run_process import Asked
from gearcad.page.run_watch import do_run

__all__ = ["Runs", "Turns", "close_all_runs", "runs_of"]

_LOOK = 0.2
"""Seconds between two looks at whether one that waits is wanted still."""

_PATIENCE = 5.0
"""Seconds that files may take to go."""

_MOST_WAITING = 4
_MOST_KEPT = 40
"""Runs whose files a session keeps: the eldest lose theirs."""


class Turns:
    """So many runs of all sessions at a time; sessions that wait are served in the order in which they came."""

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


_TURNS = Turns(max(available_cores(), 1))


_OPEN: dict[str, Runs] = {}


def runs_of(key: str) -> Runs | None:
    """Those of an open session by their key, which nobody else knows."""
    return _OPEN.get(key)


def close_all_runs() -> None:
    """The server ends: so do the runs of all sessions, and their files go."""
    closed = list(_OPEN.values())
    for runs in closed:
        runs.close()
    for runs in closed:
        runs.join(_PATIENCE)


class Runs:
    """Those of a session: one at a time, the others wait; `close` ends them and removes their files.

    `permitted` is what each run of any session may take.
    """

    permitted: ClassVar[Limits] = Limits()

    def __init__(self, limits: Limits | None = None) -> None:
        self.limits = limits or self.permitted
        self.all: list[Run] = []
        self.key = secrets.token_urlsafe(16)
        _OPEN[self.key] = self
        self._folder = tempfile.TemporaryDirectory(prefix="gearcad-", ignore_cleanup_errors=True)
        self._calls: queue.SimpleQueue[Run | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._closed = False

    def start(self, kind: str, text: str, name: str, folder: Path, given: Mapping[str, str]) -> Run:
        """Begin a run of one of RUNS, or let it wait. Raises ParameterError where too many wait."""
        if self._closed or sum(not run.state.ended for run in self.all) > _MOST_WAITING:
            raise ParameterError("run", kind, f"must wait: {_MOST_WAITING} others do; cancel one of them")
        number = len(self.all)
        into = Path(self._folder.name) / str(number)
        run = Run(number, Asked(kind=kind, text=text, name=name, folder=str(folder), into=str(into)), given)
        self.all.append(run)
        for old in self.all[:-_MOST_KEPT]:
            old.files = ()
            shutil.rmtree(old.folder, ignore_errors=True)
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="gearcad-runs", daemon=True)
            self._thread.start()
        self._calls.put(run)
        return run

    def cancel(self, run: Run) -> None:
        """End a run at once, whatever it does."""
        run.stop.set()

    @property
    def busy(self) -> bool:
        return any(not run.state.ended for run in self.all)

    def close(self) -> None:
        """End all, and remove what they have made."""
        self._closed = True
        _OPEN.pop(self.key, None)
        for run in self.all:
            run.stop.set()
        self._calls.put(None)
        if self._thread is None:
            self._folder.cleanup()

    def join(self, seconds: float) -> None:
        """Wait until what was closed is gone."""
        if self._thread is not None:
            self._thread.join(seconds)

    def _work(self) -> None:
        """One after the other. The thread lives as long as the session: a process dies with the thread that has started it."""
        while (run := self._calls.get()) is not None:
            with _TURNS.taken(run.stop) as has:
                if has:
                    do_run(run, self.limits)
                else:
                    run.state = State.CANCELLED
            if run.state is not State.DONE:
                shutil.rmtree(run.folder, ignore_errors=True)
            run.ended.set()
        self._folder.cleanup()

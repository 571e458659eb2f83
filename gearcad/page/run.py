"""Run: what was asked of a process, how far it is, and what came of it."""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any

from gearcad.errors import require_number
from gearcad.machine import machine_memory
from gearcad.page.run_process import Asked

__all__ = ["GIGABYTE", "Limits", "Run", "State"]

GIGABYTE = 1e9

_SHARE_OF_MEMORY = 0.5
_MOST_MEMORY = 16e9


def _most_memory() -> float:
    """Half of what the machine has; endless where the system does not tell what a process takes."""
    told = Path("/proc/self/statm").exists()
    return min(_SHARE_OF_MEMORY * machine_memory(), _MOST_MEMORY) if told else math.inf


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What one run may take: seconds, and bytes of memory (Linux)."""

    seconds: float = 3600.0
    memory: float = field(default_factory=_most_memory)

    def __post_init__(self) -> None:
        require_number("time_limit", self.seconds, "s", above=0)
        if not math.isinf(self.memory):
            require_number("memory_limit", self.memory / GIGABYTE, "GB", above=0)


class State(Enum):
    """How far a run is."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def ended(self) -> bool:
        return self in (State.DONE, State.FAILED, State.CANCELLED)


@dataclass
class Run:
    """One of them: what was asked, and what its process has told so far. A thread fills it, others read it."""

    number: int
    asked: Asked
    given: Mapping[str, str]
    """What the spec says under its keys, by which runs are told from each other."""

    state: State = State.WAITING
    step: str = ""
    share: float = 0.0
    left: str = ""
    line: str = ""
    """The verdict as the command line says it, or the error."""

    name: str = ""
    """Of the design, as its files are called."""

    figures: Mapping[str, Any] = field(default_factory=dict)
    notices: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    stop: threading.Event = field(default_factory=threading.Event, repr=False)
    ended: threading.Event = field(default_factory=threading.Event, repr=False)

    @property
    def folder(self) -> Path:
        """Where its files are."""
        return Path(self.asked.into)

    def file(self, name: str) -> Path | None:
        """The path of one of its files, if it has one of this name."""
        return self.folder / name if name in self.files and self.state is State.DONE else None

"""The process of one run: it does one job on the text of a spec, tells how far it is, and leaves its files in a folder.

It is started by its command line, as the workers of a batch are. It reads one line of JSON and answers by lines of JSON:
{"expected": ...}, {"step", "done", "whole"}, and last {"result": ...} or {"error": "the line of the command line"}.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcad.errors import GearcadError, out_of_memory, printable, shown
from gearcad.guard import die_with
from gearcad.page.run_kinds import RUNS
from gearcad.page.texts import design_of

__all__ = ["Asked", "serve"]

_BETWEEN = 0.1
"""Seconds between two lines of progress in one step."""

_LARGEST_FILE = 2 << 30
"""Bytes that one file of a result can have."""

_NICENESS = 5
"""The page itself goes before."""

_LONGEST_FAULT = 500


@dataclass(frozen=True, kw_only=True)
class Asked:
    """A run: its kind, the text and name of the design, the folder of files that it names, and where results go."""

    kind: str
    text: str
    name: str
    folder: str
    into: str

    def line(self) -> bytes:
        """It as a line of JSON."""
        return json.dumps(vars(self)).encode() + b"\n"


def serve() -> None:
    """Do the run that stands on stdin, whose closing ends it: nobody waits for it any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the parent decides
    die_with(os.getppid())
    tell = _Teller(os.dup(1))
    os.dup2(2, 1)  # whatever a library prints must not mix with the answers
    asked = Asked(**json.loads(sys.stdin.buffer.readline()))
    threading.Thread(target=_listen, daemon=True).start()
    _bound()
    tell(**_outcome(asked, tell))


def _listen() -> None:
    with suppress(OSError):
        sys.stdin.buffer.read()
    os._exit(1)


def _bound() -> None:
    """What the system itself can bound: the size of a file, who waits, and who goes first where memory ends."""
    with suppress(AttributeError, OSError):
        os.nice(_NICENESS)
    with suppress(ImportError, ValueError, OSError):  # Windows has no limits
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (_LARGEST_FILE, _LARGEST_FILE))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with suppress(OSError):  # Linux only
        Path("/proc/self/oom_score_adj").write_text("1000", encoding="ascii")


def _outcome(asked: Asked, tell: _Teller) -> Mapping[str, Any]:
    """The last line: what came of it, or the error as the command line prints it."""
    try:
        return {"result": _run(asked, tell)}
    except GearcadError as error:
        return {"error": printable(" ".join(str(error).split("\n")))}
    except MemoryError as error:
        return {"error": out_of_memory(error)}
    except Exception as error:
        what = shown(" ".join(f"{type(error).__name__}: {error}".split()), _LONGEST_FAULT)
        return {"error": f"unexpected {what} (a fault of gearcad: please report it)"}


def _run(asked: Asked, tell: _Teller) -> dict[str, Any]:
    kind = RUNS[asked.kind]
    design = kind.made(design_of(asked.text, asked.name, Path(asked.folder)))
    job = kind.job()
    expected = job.expected(design)
    if expected is not None:
        tell(expected={"seconds": expected.seconds, "memory": expected.memory})
    result = job.run(design, tell.progress)
    files = job.write(result, Path(asked.into), tell.progress)
    return {
        "name": design.name,
        "conclusion": job.conclusion(design.name, result),
        "figures": job.figures(job.document(result)),
        "notices": [str(notice) for notice in job.notices(result)],
        "files": [file.name for file in files],
    }


class _Teller:
    """Writes lines of JSON to the parent."""

    def __init__(self, fd: int) -> None:
        self._fd = fd
        self._step, self._last = "", 0.0

    def __call__(self, **content: Any) -> None:
        line = json.dumps(content, default=_plain).encode() + b"\n"
        with suppress(BrokenPipeError):
            while line:
                line = line[os.write(self._fd, line) :]

    def progress(self, step: str, done: float, whole: float) -> None:
        """A Progress: a line for each step, and now and then within it."""
        now = time.monotonic()
        if step != self._step or now - self._last >= _BETWEEN:
            self._step, self._last = step, now
            self(step=step, done=float(done), whole=float(whole))


def _plain(value: Any) -> Any:
    """Numbers of numpy as JSON has them."""
    return value.tolist() if hasattr(value, "tolist") else str(value)

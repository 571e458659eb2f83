"""One row in a worker: its design, the parts of it that are missing or changed, and what the table of results says of it."""

from __future__ import annotations

import errno
import json
import pickle
import shutil
import socket
import time
import uuid
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.batch.manifest import Manifest, Part, inputs_hash, publish, read_manifest
from gearcad.batch.stages import DATA, make_parts
from gearcad.designs import Design
from gearcad.designs.table import Row
from gearcad.errors import GearcadError, OutputError, SpecError, out_of_memory
from gearcad.jobs.job import Job
from gearcad.output import UNWRITABLE, unwritable
from gearcad.per_gear import PerGear
from gearcad.symbols import PER_GEAR

__all__ = ["Checked", "Record", "Status", "Task", "check_rows", "flat_document", "make_row"]

_HOPELESS = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.ENOENT)
"""Errors of the target that every other row would meet too."""


class Status(Enum):
    """How a row ended."""

    OK = "ok"
    FAILED = "failed"
    NOT_RUN = "not run"


@dataclass(frozen=True)
class Checked:
    """What the check of a row has found: its faults, or else the hash of its inputs and the pickled design that they make."""

    faults: tuple[str, ...] = ()
    inputs: str = ""
    design: bytes = b""


@dataclass(frozen=True)
class Task:
    """One row and the jobs to do on it: in `folder`/NAME, by way of `workspace` on the same file system."""

    row: Row
    stages: tuple[Job[Any, Any], ...]
    folder: Path
    workspace: Path
    fresh: bool
    checked: Checked = Checked()

    def design(self, inputs: str) -> Design:
        """The design of inputs with this hash: that of the check, unless a file that the row names has changed since."""
        if self.checked.design and self.checked.inputs == inputs:
            design: Design = pickle.loads(self.checked.design)
            return design
        return self.row.design()


@dataclass(frozen=True, kw_only=True)
class Record:
    """What the table of results says of a row; `stop` is set if no other row can fare better."""

    number: int
    status: Status
    error: str = ""
    warnings: tuple[str, ...] = ()
    seconds: float | None = None
    files: tuple[str, ...] = ()
    values: Mapping[str, Any] = field(default_factory=dict)
    stop: bool = False


def check_rows(rows: list[Row]) -> list[Checked]:
    """Check each row; runs in a worker."""
    return list(map(_checked, rows))


def _checked(row: Row) -> Checked:
    inputs = inputs_hash(row.inputs)  # before the design: what changes in between makes another hash
    found = row.design_or_faults()
    return Checked(faults=tuple(found)) if isinstance(found, list) else Checked(inputs=inputs, design=pickle.dumps(found))


def make_row(task: Task) -> Record:
    """Make what is missing or changed of one row; runs in a worker. What goes wrong is in the record."""
    began = time.perf_counter()
    number = task.row.number
    try:
        _require_workspace(task)
        folder = task.folder / task.row.name
        updates = [_update(task, folder, job) for job in task.stages]
        document = _document(task, folder)
    except GearcadError as error:
        stop = isinstance(error, OutputError) and getattr(error.__cause__, "errno", None) in _HOPELESS
        # An error of the table says where it is; of a full disk or the like it does not matter.
        text = str(error) if stop or isinstance(error, SpecError) else f"{task.row.where('')}: {error}"
        return Record(number=number, status=Status.FAILED, error=text, seconds=_since(began), stop=stop)
    except MemoryError as error:
        text = f"{task.row.where('')}: {out_of_memory(error)}"
        return Record(number=number, status=Status.FAILED, error=text, seconds=_since(began))
    except Exception as error:
        what = " ".join(f"unexpected {type(error).__name__}: {error}".split())
        text = f"{task.row.where('')}: {what} (a fault of gearcad: please report it)"
        return Record(number=number, status=Status.FAILED, error=text, seconds=_since(began))
    return Record(
        number=number,
        status=Status.OK,
        warnings=tuple(_warnings(document)),
        seconds=_since(began) if any(update.made for update in updates) else None,
        files=tuple(file for update in updates for part in update.parts for file in part.files),
        values=dict(flat_document(document)),
    )


def _require_workspace(task: Task) -> None:
    if not task.workspace.is_dir():
        permitted = f"is not there for the worker on {socket.gethostname()}; give a folder that all workers share"
        raise OutputError("output", str(task.folder), permitted) from FileNotFoundError(errno.ENOENT, "no workspace")


def _since(began: float) -> float:
    return round(time.perf_counter() - began, 4)


def _document(task: Task, folder: Path) -> dict[str, Any]:
    """What data.json says, and the figures of the other jobs' documents under their verbs."""
    document = _read(folder, DATA)
    for job in task.stages:
        if job.verb != DATA and job.verb in job.parts:
            document[job.verb] = document.get(job.verb, {}) | job.figures(_read(folder, job.verb))
    return document


def _read(folder: Path, verb: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads((folder / f"{verb}.json").read_text(encoding="utf-8"))
    return document


def _warnings(document: dict[str, Any]) -> Iterator[str]:
    """Each led by what it is about."""
    for part, of in document.items():
        texts = of.get("warnings") if isinstance(of, dict) else None
        # A part of a train may be called so, too.
        yield from (f"{part}: {text}" for text in (texts if isinstance(texts, list) else ()))


class _Update(NamedTuple):
    """Whether anything was made now, and the parts of a stage, all of which are there now."""

    made: bool
    parts: list[Part]


def _update(task: Task, folder: Path, job: Job[Any, Any]) -> _Update:
    """Make what is missing of a job's parts."""
    row, wanted = task.row, job.parts
    inputs = inputs_hash(row.inputs)
    before = read_manifest(folder)
    kept = _kept(before, inputs, folder)
    missing = [name for name, options in wanted.items() if task.fresh or name not in kept or kept[name].options != options]
    if missing:
        design = task.design(inputs)
        with _staging(task, folder) as staging:
            make_parts(job, design, missing, staging)
            made = _parts_in(staging, job)
            publish(staging, folder, Manifest(inputs, kept | made), before)
        kept |= made
    return _Update(bool(missing), [kept[name] for name in wanted])


@contextmanager
def _staging(task: Task, folder: Path) -> Iterator[Path]:
    """An empty folder in the workspace, for files that go to `folder`; raises OutputError."""
    staging = task.workspace / uuid.uuid4().hex
    try:
        if folder.is_symlink():
            raise OSError(errno.ELOOP, "it is a link, which may lead anywhere")
        staging.mkdir()
        yield staging
    except UNWRITABLE as error:
        raise unwritable(folder, error) from error
    except OutputError as error:  # it names the staging folder, of which the user knows nothing
        raise OutputError("output", str(folder), error.permitted) from error.__cause__
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def _kept(before: Manifest | None, inputs: str, folder: Path) -> dict[str, Part]:
    """The parts that are there and still true."""
    if before is None or before.inputs != inputs:
        return {}
    return {name: part for name, part in before.parts.items() if part.is_there(folder)}


def _parts_in(staging: Path, job: Job[Any, Any]) -> dict[str, Part]:
    options, files = job.parts, dict[str, dict[str, int]]()
    for file in sorted(staging.iterdir()):
        files.setdefault(job.part_of(file.name), {})[file.name] = file.stat().st_size
    return {name: Part(options[name], of) for name, of in files.items()}


_INPUTS_ALONE = ("drawing", "drawings")
"""Parts of documents that hold nothing but inputs, which have columns where they are given."""


_COURSES = ("specific_sliding_path",)
"""Parts of documents that hold values at many places, which are too many for a line of a table."""


def flat_document(document: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """The document's values under dotted keys; what pinion and wheel each have under their names; warnings have a column."""
    for key, value in document.items():
        if (not prefix and key in _INPUTS_ALONE) or key in _COURSES:
            continue
        if isinstance(value, dict):
            yield from flat_document(value, f"{prefix}{key}.")
        elif key in ("warnings", "notices", "verify") or not prefix:
            continue
        elif prefix == "pair." and key in PER_GEAR:
            yield from ((f"{prefix}{key}.{role.value}", of) for role, of in PerGear(*value).items())
        elif isinstance(value, list):
            yield prefix + key, tuple(value)
        else:
            # A plain float: a derived length is of a class of its own.
            yield prefix + key, float(value) if isinstance(value, float) else value

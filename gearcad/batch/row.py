"""One row of a design table in a worker: its stages, its manifest, and its line in the table of results."""

from __future__ import annotations

import errno
import hashlib
import json
import pickle
import re
import shutil
import socket
import time
import uuid
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.core.errors import GearcadError, OutputError, ParameterError, SpecError, out_of_memory
from gearcad.core.output import UNWRITABLE, files_in, json_text, locked, unwritable
from gearcad.core.records import JsonObject, PerGear
from gearcad.core.runtime import PACKAGE
from gearcad.core.symbols import PER_GEAR
from gearcad.designs import Design, DesignKind
from gearcad.designs.table import DesignRow
from gearcad.jobs import VERBS, job_for
from gearcad.jobs.job import Data, Job, write_inside
from gearcad.version import __version__

MANIFEST = "manifest.json"

_NO_NAME = r'\x00-\x1f\ud800-\udfff/\\<>:"|?*'
_PLAIN_NAME = rf"[^\s.\-{_NO_NAME}][^{_NO_NAME}]{{0,200}}"
_OUR_FILE = re.compile(rf"({_PLAIN_NAME}/)?{_PLAIN_NAME}\.[a-z0-9]{{1,10}}")
"""Pattern of file names that a row may write, in a folder of a mesh too. Some are named after gears, so any name that a folder
can have is permitted."""


@dataclass(frozen=True)
class RowPart:
    """One part of a row: the options it was made with, and its files with their sizes in bytes."""

    options: Mapping[str, Any]
    files: Mapping[str, int]

    def is_there(self, folder: Path) -> bool:
        """True if every file is there with all its bytes."""
        return all(_size(folder / file) == size for file, size in self.files.items())


@dataclass(frozen=True)
class Manifest:
    """Hash of the inputs and of gearcad, the finished parts, and files that a killed run may have left unfinished."""

    inputs: str
    parts: Mapping[str, RowPart] = field(default_factory=dict)
    unfinished: tuple[str, ...] = ()

    @property
    def files(self) -> set[str]:
        """Every file that is the manifest's to replace or remove."""
        return {file for part in self.parts.values() for file in part.files} | set(self.unfinished)

    def text(self) -> str:
        """The manifest as JSON."""
        document: dict[str, Any] = {"gearcad": __version__, "inputs": self.inputs}
        document["parts"] = {
            name: {"options": dict(part.options), "files": dict(part.files)} for name, part in sorted(self.parts.items())
        }
        if self.unfinished:
            document["unfinished"] = list(self.unfinished)
        return json_text(document)


def inputs_hash(inputs: Mapping[str, Any]) -> str:
    """SHA-256 of the inputs and of gearcad itself: its version and its source, for a checkout changes under one version."""
    return hashlib.sha256(json.dumps([_gearcad_hash(), sorted(inputs.items())]).encode()).hexdigest()


@cache
def _gearcad_hash() -> str:
    digest = hashlib.sha256(__version__.encode())
    for source in sorted(PACKAGE.rglob("*.py")):
        digest.update(source.relative_to(PACKAGE).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()


def read_manifest(folder: Path) -> Manifest | None:
    """The manifest in `folder`; None if there is none that can be understood."""
    try:
        document = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        parts = {
            str(name): RowPart(dict(part["options"]), {_plain(file): int(size) for file, size in part["files"].items()})
            for name, part in document["parts"].items()
        }
        unfinished = tuple(_plain(file) for file in document.get("unfinished", ()))
        return Manifest(str(document["inputs"]), parts, unfinished)
    except (OSError, ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError):
        return None


def _plain(file: Any) -> str:
    """Return a file name of a manifest. Raise ValueError unless it is one that we give: a manifest may have been edited, and
    its files are removed later.
    """
    if not isinstance(file, str) or not _OUR_FILE.fullmatch(file):
        raise ValueError(f"{file!r} is no file of ours")
    return file


def publish(staging: Path, folder: Path, manifest: Manifest, before: Manifest | None) -> None:
    """Move the finished files of `staging` into `folder`, so that being killed at any moment leaves no lie.

    A new folder appears by one rename, manifest and all. In a folder that exists, the manifest first gives up every part
    whose files are about to change (`before` says which there are), then the files move one by one, and the manifest says
    last that they are all there. Files that are not gearcad's stay. Raises OSError, OutputError where another process holds
    the lock of the folder.
    """
    (staging / MANIFEST).write_text(manifest.text(), encoding="utf-8", newline="\n")
    if not folder.exists():
        try:
            staging.rename(folder)
            return
        except OSError as error:  # made meanwhile by a run that was killed, and is dying
            if error.errno not in (errno.EEXIST, errno.ENOTEMPTY):
                raise
    with locked(folder):
        _replace_files(staging, folder, manifest, before)


def _replace_files(staging: Path, folder: Path, manifest: Manifest, before: Manifest | None) -> None:
    made = [file for file in files_in(staging) if file != MANIFEST]
    stale = sorted((before.files if before else set()) - manifest.files)
    touched = {*made, *stale}
    sound = {name: part for name, part in manifest.parts.items() if not touched & set(part.files)}
    _replace_manifest(staging, folder, Manifest(manifest.inputs, sound, tuple(sorted(touched))))
    for file in stale:
        (folder / file).unlink(missing_ok=True)
    for file in made:
        (folder / file).parent.mkdir(exist_ok=True)
        (staging / file).replace(folder / file)
    (staging / MANIFEST).replace(folder / MANIFEST)


def _replace_manifest(staging: Path, folder: Path, manifest: Manifest) -> None:
    interim = staging / f"{MANIFEST}.interim"
    interim.write_text(manifest.text(), encoding="utf-8", newline="\n")
    interim.replace(folder / MANIFEST)


def _size(path: Path) -> int | None:
    try:
        return path.stat().st_size
    except OSError:
        return None


DATA = "data"
"""The part that every row has: the table of results needs it."""


def stages(wanted: Sequence[Job[Any, Any]]) -> tuple[Job[Any, Any], ...]:
    """The jobs in the order in which a row does them: one that fails leaves what those before it have made.

    Raises ParameterError for none.
    """
    if not wanted:
        raise ParameterError("do", "", f"must be one or more of {', '.join(VERBS)}")
    others = sorted((job for job in wanted if job != Data()), key=lambda job: VERBS.index(job.verb))
    return tuple(others) if any(DATA in job.parts for job in others) else (Data(), *others)


def make_parts(job: Job[Any, Any], design: Design, parts: Sequence[str], folder: Path) -> None:
    """Make some of a job's parts in an empty folder."""
    maker = job_for(job.for_row(design, parts), design).headed(design)
    for name, write in maker.files(maker.run(design)).items():
        if job.part_of(name.rpartition("/")[2]):
            write_inside(folder, name, write)


_HOPELESS = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.ENOENT)
"""Errors of the target that every other row would meet too."""


class Status(Enum):
    """Final status of a row."""

    OK = "ok"
    FAILED = "failed"
    NOT_RUN = "not run"


@dataclass(frozen=True)
class Checked:
    """Result of the check of a row: its faults, or else the hash of its inputs and the pickled design that they make."""

    faults: tuple[str, ...] = ()
    inputs: str = ""
    design: bytes = b""


@dataclass(frozen=True)
class Task:
    """One row and the jobs to do on it: in `folder`/NAME, by way of `workspace` on the same file system."""

    row: DesignRow
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
    """Entry of a row in the table of results; `stop` is set if no other row can succeed either."""

    number: int
    status: Status
    error: str = ""
    warnings: tuple[str, ...] = ()
    seconds: float | None = None
    files: tuple[str, ...] = ()
    values: Mapping[str, Any] = field(default_factory=dict)
    stop: bool = False


def check_rows(rows: list[DesignRow]) -> list[Checked]:
    """Check each row; runs in a worker."""
    return list(map(_checked, rows))


def _checked(row: DesignRow) -> Checked:
    inputs = inputs_hash(row.inputs)  # before the design: what changes in between makes another hash
    found = row.design_or_faults()
    return Checked(faults=tuple(found)) if isinstance(found, list) else Checked(inputs=inputs, design=pickle.dumps(found))


def make_row(task: Task) -> Record:
    """Make what is missing or changed of one row, in a worker. Faults are in the record."""
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


def _document(task: Task, folder: Path) -> JsonObject:
    """Return the content of data.json, with the figures of the other jobs' documents under their verbs."""
    document = _read(folder, DATA)
    for job in task.stages:
        if job.verb != DATA and job.verb in job.parts:
            document[job.verb] = document.get(job.verb, {}) | _figures(job, _read(folder, job.verb))
    return document


def _figures(job: Job[Any, Any], document: JsonObject) -> JsonObject:
    """Return the figures of a job's document, which may be that of a train with one for each of its meshes."""
    if document.get("design") != DesignKind.TRAIN.value:
        return job.figures(document)
    from gearcad.jobs.train import figures_of

    return figures_of(job, document)


def _read(folder: Path, verb: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads((folder / f"{verb}.json").read_text(encoding="utf-8"))
    return document


def _warnings(document: dict[str, Any]) -> Iterator[str]:
    """Yield the warnings, each beginning with its subject."""
    for part, of in document.items():
        texts = of.get("warnings") if isinstance(of, dict) else None
        # A part of a train may be called so, too.
        yield from (f"{part}: {text}" for text in (texts if isinstance(texts, list) else ()))


class _Update(NamedTuple):
    """Result of one stage: whether it made anything now, and the parts of the row that exist afterwards."""

    made: bool
    parts: list[RowPart]


def _update(task: Task, folder: Path, job: Job[Any, Any]) -> _Update:
    """Make what is missing of a job's parts."""
    row, wanted = task.row, job.parts
    inputs = inputs_hash(row.inputs)
    before = read_manifest(folder)
    kept = _valid_parts(before, inputs, folder)
    missing = [name for name, options in wanted.items() if task.fresh or name not in kept or kept[name].options != options]
    if missing:
        design = task.design(inputs)
        with _staging(task, folder) as staging:
            make_parts(job, design, missing, staging)
            made = {name: RowPart(wanted[name], {}) for name in missing} | _parts_in(staging, job)
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


def _valid_parts(before: Manifest | None, inputs: str, folder: Path) -> dict[str, RowPart]:
    """Return the parts that exist and are still valid."""
    if before is None or before.inputs != inputs:
        return {}
    return {name: part for name, part in before.parts.items() if part.is_there(folder)}


def _parts_in(staging: Path, job: Job[Any, Any]) -> dict[str, RowPart]:
    options, files = job.parts, dict[str, dict[str, int]]()
    for name in files_in(staging):
        files.setdefault(job.part_of(name.rpartition("/")[2]), {})[name] = (staging / name).stat().st_size
    return {name: RowPart(options[name], of) for name, of in files.items()}


_INPUTS_ALONE = ("drawing", "drawings")
"""Parts of documents that hold nothing but inputs, which have columns where they are given."""


_COURSES = ("specific_sliding_path", "segments", "bearings")
"""Parts of documents that hold values at many places, which are too many for a line of a table."""


def flat_document(document: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """The document's values under dotted keys; what pinion and wheel each have under their names; warnings have a column."""
    for key, value in document.items():
        if (not prefix and key in _INPUTS_ALONE) or key in _COURSES:
            continue
        if isinstance(value, dict):
            yield from flat_document(value, f"{prefix}{key}.")
        elif key in ("warnings", "notices", "verify", "unconfirmed") or not prefix:
            continue
        elif prefix == "pair." and key in PER_GEAR:
            yield from ((f"{prefix}{key}.{role.value}", of) for role, of in PerGear(*value).items())
        elif isinstance(value, list):
            yield prefix + key, tuple(value)
        else:
            # A plain float: a derived length is of a class of its own.
            yield prefix + key, float(value) if isinstance(value, float) else value

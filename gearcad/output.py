"""Files that appear complete or not at all: written into a folder beside their place, then renamed."""

from __future__ import annotations

import json
import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from gearcad.errors import OutputError, ParameterError
from gearcad.guard import note_folder, note_staging, undivided

try:
    import fcntl
except ImportError:  # Windows: there what a killed process leaves stays
    fcntl = None  # type: ignore[assignment]

__all__ = ["UNWRITABLE", "json_text", "source_date", "staged_files", "unwritable"]

_DATE = "SOURCE_DATE_EPOCH"

_UNFINISHED = ".unfinished-"


def json_text(document: dict[str, Any]) -> str:
    """Strict JSON (no NaN, no Infinity) in ASCII, indented, the same bytes for the same document."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def source_date() -> datetime | None:
    """The date (UTC) that SOURCE_DATE_EPOCH fixes for all files, in seconds since 1970; None without it.

    Raises ParameterError. See reproducible-builds.org/specs/source-date-epoch.
    """
    text = os.environ.get(_DATE, "")
    if not text:
        return None
    try:
        if not text.isascii() or not text.isdigit():
            raise ValueError
        return datetime.fromtimestamp(int(text), UTC)
    except (ValueError, OverflowError, OSError) as error:
        permitted = "must be a whole number of seconds since 1970, before the year 10000; or leave this variable unset"
        raise ParameterError(_DATE, text, permitted) from error


UNWRITABLE = (OSError, UnicodeEncodeError)
"""What the system raises for a place that cannot be written."""


def unwritable(folder: Path, error: OSError | UnicodeEncodeError) -> OutputError:
    """The error for a place that cannot be written, whatever the system's reason."""
    if isinstance(error, UnicodeEncodeError):
        reason = f"the locale has no letter {error.object[error.start]!a}"
        return OutputError("output", str(folder), f"cannot be written ({reason}); give another name, or set LC_ALL=C.UTF-8")
    reason = error.strerror or str(error)
    return OutputError("output", str(folder), f"cannot be written ({reason}); give a folder you may write to")


@contextmanager
def staged_files(folder: Path, inside: Path | None = None) -> Iterator[Path]:
    """An empty folder to write into; on leaving, every file in it moves into `folder`, replacing its namesake.

    The folder to write into lies inside `folder`, so both are on one file system and a rename is atomic; making it at once
    proves before any work that `folder` can be written. A process that is killed leaves it behind, until the next one that
    writes there; `inside` (on the same file system) is another place for it. If anything is raised (an interrupt too)
    nothing has changed: no file moves, and folders that were made for this vanish. Raises OutputError for a place that
    cannot be written.
    """
    made: list[Path] = []
    finished = False
    try:
        _make_folder(folder, made)
        with _staging(inside or folder) as staging:
            yield staging
            _move_files(staging, folder)
        finished = True
    except UNWRITABLE as error:
        raise unwritable(folder, error) from error
    finally:
        if not finished:
            # Another program may have put a file there meanwhile: then the folder stays.
            with suppress(OSError):
                for path in reversed(made):
                    path.rmdir()


def _make_folder(folder: Path, made: list[Path]) -> None:
    """Make `folder` and its missing parents, and note in `made` which were missing, outermost first."""
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    for path in reversed(missing):
        note_folder(path)
        path.mkdir(exist_ok=True)
        made.append(path)


@contextmanager
def _staging(place: Path) -> Iterator[Path]:
    """A new folder in `place`, which is removed at the end, and with it those that others have left when they were killed."""
    staging = place / f"{_UNFINISHED}{uuid.uuid4().hex[:12]}"
    with ExitStack() as held:
        with _lock(place) as is_ours:  # between its making and its lock another one would take it for abandoned
            if is_ours:
                _clear_abandoned(place)
            note_staging(staging)
            held.callback(shutil.rmtree, staging, ignore_errors=True)
            staging.mkdir(mode=0o700)
            held.enter_context(_lock(staging))
        yield staging


def _clear_abandoned(place: Path) -> None:
    for path in place.iterdir():
        if path.name.startswith(_UNFINISHED) and not path.is_symlink() and path.is_dir():
            with _lock(path, wait=False) as is_ours:
                if is_ours:
                    shutil.rmtree(path, ignore_errors=True)


@contextmanager
def _lock(folder: Path, *, wait: bool = True) -> Iterator[bool]:
    """Lock a folder, until the end or until this process dies; False where another holds it, or the system cannot."""
    if fcntl is None:
        yield False
        return
    with ExitStack() as opened:
        try:
            fd = os.open(folder, os.O_RDONLY)
            opened.callback(os.close, fd)
            fcntl.flock(fd, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            locked = False
        else:
            locked = True
        yield locked


def _move_files(staging: Path, folder: Path) -> None:
    """Rename all or none: what cannot be replaced is found before the first file moves."""
    files = sorted(staging.iterdir())
    for file in files:
        if (folder / file.name).is_dir():
            raise IsADirectoryError(0, f"{file.name} is a folder there")
    with undivided():
        for file in files:
            file.replace(folder / file.name)

"""Output: files that appear complete or not at all, JSON, and the lock of a folder."""

from __future__ import annotations

import errno
import json
import os
import shutil
import time
import uuid
from collections.abc import Collection, Iterator
from contextlib import ExitStack, contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from gearcad.core.errors import OutputError, ParameterError
from gearcad.core.guard import note_folder, note_staging, undivided
from gearcad.version import __version__

try:
    import fcntl
except ImportError:  # Windows: there what a killed process leaves stays
    fcntl = None  # type: ignore[assignment]


_DATE = "SOURCE_DATE_EPOCH"

_UNFINISHED = ".unfinished-"
MARK = ".gearcad-mark"
"""The file whose presence tells that a folder is ours to delete."""

_SIGN = b"gearcad "

_LONGEST_WAIT = 60.0
"""Seconds to wait for the lock of a folder. It is held while files are renamed, which takes milliseconds."""

_BETWEEN_TRIALS = 0.02
"""Seconds between two trials to lock a folder."""

_MOST_BYTES = 10_000_000
"""Bytes of the largest spec or template: a spec with thousands of load bins has fewer than one million."""

_TRIALS = 3
"""Trials to make the folder and the one inside it, before the error is told."""


def file_bytes(path: Path) -> bytes:
    """Return the bytes of an input file. Raises OSError, also for a device, a pipe and a file above the size limit."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OSError(errno.EINVAL, "it is a device or a pipe, not a file")
    with path.open("rb") as file:
        content = file.read(_MOST_BYTES + 1)
    if len(content) > _MOST_BYTES:
        raise OSError(errno.EFBIG, f"it has more than {_MOST_BYTES // 1_000_000} MB")
    return content


def json_text(document: dict[str, Any]) -> str:
    """Strict JSON (no NaN, no Infinity) in ASCII, indented, the same bytes for the same document."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def source_date() -> datetime | None:
    """Return the date (UTC) that SOURCE_DATE_EPOCH fixes for all files, in seconds since 1970; None without it.

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
"""Errors of the system for a place that cannot be written."""


def unwritable(folder: Path, error: OSError | UnicodeEncodeError) -> OutputError:
    """Return the error for a place that cannot be written, whatever the system's reason."""
    if isinstance(error, UnicodeEncodeError):
        reason = f"the locale has no letter {error.object[error.start]!a}"
        return OutputError("output", str(folder), f"cannot be written ({reason}); give another name, or set LC_ALL=C.UTF-8")
    reason = error.strerror or str(error)
    return OutputError("output", str(folder), f"cannot be written ({reason}); give a folder you may write to")


def require_folder(folder: Path) -> None:
    """Raise OutputError where files cannot be written into `folder`, or it cannot be made. Nothing is made for this."""
    try:
        there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    except UNWRITABLE as error:
        raise unwritable(folder, error) from error
    for code, fits in ((errno.ENOTDIR, there.is_dir()), (errno.EACCES, os.access(there, os.W_OK | os.X_OK))):
        if not fits:
            raise unwritable(folder, OSError(code, os.strerror(code)))


def mark_folder(folder: Path) -> None:
    """Write the mark of gearcad into a folder: our name and version, and the name of the folder. Raises OSError."""
    (folder / MARK).write_bytes(_SIGN + f"{__version__} {folder.name}\n".encode())


def has_mark(folder: Path) -> bool:
    """Return whether `folder` is a folder with the mark of gearcad, and not renamed since: only then we may delete it."""
    try:
        fd = os.open(folder / MARK, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
        with os.fdopen(fd, "rb") as file:
            text = file.read(4096)
    except OSError:
        return False
    return text.startswith(_SIGN) and text.endswith(f" {folder.name}\n".encode())


@contextmanager
def staged_files(folder: Path, inside: Path | None = None, *, sometimes: Collection[str] = ()) -> Iterator[Path]:
    """Yield an empty folder to write into; on leaving, every file in it moves into `folder` and replaces its namesake.

    The folder to write into lies inside `folder`, so both are on one file system and a rename is atomic; making it at once
    proves before any work that `folder` can be written. A killed process leaves it behind until the next one that writes
    there deletes it, which it does only to folders with our mark. `inside` (on the same file system) is another place for it.

    Files move under a lock of `folder`: of two processes that write the same files, the files of one of them stay. Names in
    `sometimes` that were not written now are removed from `folder`, as files of a former result. If anything is raised (an
    interrupt too) nothing has changed: no file moves, and folders that were made for this vanish. Raises OutputError for a
    place that cannot be written.
    """
    made: list[Path] = []
    finished = False
    try:
        with _staging(folder, inside, made) as staging:
            yield staging
            with locked(folder):
                _move_files(staging, folder, sometimes, made)
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
def _staging(folder: Path, inside: Path | None, made: list[Path]) -> Iterator[Path]:
    """Yield a new folder in `inside` or `folder`, which is removed at the end; clear what killed processes left there."""
    staging = (inside or folder) / f"{_UNFINISHED}{uuid.uuid4().hex[:12]}"
    with ExitStack() as held:
        for left in reversed(range(_TRIALS)):
            try:
                _make_folder(folder, made)
                _make_staging(staging, held)
                break
            except FileNotFoundError:  # a process that failed has removed the empty folder that it had made
                if not left:
                    raise
        yield staging


def _make_staging(staging: Path, held: ExitStack) -> None:
    with locked(staging.parent) as is_ours:  # between its making and its lock another one would take it for abandoned
        if is_ours:
            _clear_abandoned(staging.parent)
        note_staging(staging)
        held.callback(shutil.rmtree, staging, ignore_errors=True)
        staging.mkdir(mode=0o700)
        mark_folder(staging)
        held.enter_context(locked(staging))


def _clear_abandoned(place: Path) -> None:
    for path in place.iterdir():
        if path.name.startswith(_UNFINISHED) and not path.is_symlink() and has_mark(path):
            with suppress(OSError, OutputError), locked(path, wait=0.0):  # one that is locked is in use
                shutil.rmtree(path, ignore_errors=True)


@contextmanager
def locked(folder: Path, *, wait: float | None = None) -> Iterator[bool]:
    """Hold the lock of a folder, until the end or until this process dies; yield False where the system has no such locks.

    Raises OutputError where another process holds it for longer than `wait` (s), OSError for a folder that is not there.
    """
    if fcntl is None:
        yield False
        return
    until = time.monotonic() + (_LONGEST_WAIT if wait is None else wait)
    while True:
        fd = os.open(folder, os.O_RDONLY | getattr(os, "O_DIRECTORY", 0))  # or the open of a pipe would wait for its writer
        try:
            has = _has_lock(fd)
            if has is None or (has and _is_there(folder, fd)):
                yield bool(has)
                return
        finally:
            os.close(fd)
        if time.monotonic() >= until:
            raise OutputError("output", str(folder), "is in use by another process; wait for its end, or give another folder")
        time.sleep(_BETWEEN_TRIALS)


def _has_lock(fd: int) -> bool | None:
    """Lock an open folder at once: False where another process holds it, None where the system cannot lock it."""
    try:
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


def _is_there(folder: Path, fd: int) -> bool:
    """Return whether the open folder still exists at this path: another process may have removed it."""
    try:
        return os.path.samestat(os.fstat(fd), folder.stat())
    except OSError:
        return False


def _move_files(staging: Path, folder: Path, sometimes: Collection[str], made: list[Path]) -> None:
    """Rename all files or none: files that cannot be replaced are found before the first file moves.

    Folders of files are made first, and noted in `made`.
    """
    files = [file for file in files_in(staging) if file != MARK]
    gone = set(sometimes).difference(files)
    for name in (*files, *gone):
        if (folder / name).is_dir():
            raise IsADirectoryError(0, f"{name} is a folder there")
    for inner in dict.fromkeys((folder / name).parent for name in files):
        _make_folder(inner, made)
    with undivided():
        for name in files:
            (staging / name).replace(folder / name)
        for name in gone:
            (folder / name).unlink(missing_ok=True)


def files_in(folder: Path) -> list[str]:
    """Return the names of the files in a folder and in the folders in it, with / behind the name of a folder, sorted."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir())

"""Files that appear complete or not at all: written into a folder beside their place, then renamed."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from gearcad.errors import OutputError, ParameterError

__all__ = ["json_text", "source_date", "staged_files", "unwritable"]

_DATE = "SOURCE_DATE_EPOCH"


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


def unwritable(folder: Path, error: OSError) -> OutputError:
    """The error for a place that cannot be written, whatever the system's reason."""
    reason = error.strerror or str(error)
    return OutputError("output", str(folder), f"cannot be written ({reason}); give a folder you may write to")


@contextmanager
def staged_files(folder: Path, inside: Path | None = None) -> Iterator[Path]:
    """An empty folder to write into; on leaving, every file in it moves into `folder`, replacing its namesake.

    The folder to write into lies inside `folder`, so both are on one file system and a rename is atomic; making it at once
    proves before any work that `folder` can be written. A process that is killed leaves it behind: `inside` (on the same
    file system) is a place for it that is cleared one day. If anything is raised (an interrupt too) nothing has changed: no
    file moves, and folders that were made for this vanish. Raises OutputError for a place that cannot be written.
    """
    made: list[Path] = []
    staging = None
    finished = False
    try:
        _make_folder(folder, made)
        staging = Path(tempfile.mkdtemp(prefix=".unfinished-", dir=inside or folder))
        yield staging
        _move_files(staging, folder)
        finished = True
    except OSError as error:
        raise unwritable(folder, error) from error
    finally:
        if staging is not None:
            shutil.rmtree(staging, ignore_errors=True)
        if not finished:
            # Another program may have put a file there meanwhile: then the folder stays.
            with suppress(OSError):
                for path in reversed(made):
                    path.rmdir()


def _make_folder(folder: Path, made: list[Path]) -> None:
    """Make `folder` and its missing parents, and note in `made` which were missing, outermost first."""
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    for path in reversed(missing):
        path.mkdir(exist_ok=True)
        made.append(path)


def _move_files(staging: Path, folder: Path) -> None:
    """Rename all or none: what cannot be replaced is found before the first file moves."""
    files = sorted(staging.iterdir())
    for file in files:
        if (folder / file.name).is_dir():
            raise IsADirectoryError(0, f"{file.name} is a folder there")
    for file in files:
        file.replace(folder / file.name)

"""The manifest of a row's folder: of which inputs and which gearcad its files are. A folder without one is not finished."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from gearcad.output import json_text, locked
from gearcad.shipped import PACKAGE
from gearcad.version import __version__

__all__ = ["MANIFEST", "Manifest", "Part", "inputs_hash", "publish", "read_manifest"]

MANIFEST = "manifest.json"

_NO_NAME = r'\x00-\x1f\ud800-\udfff/\\<>:"|?*'
_OUR_FILE = re.compile(rf"[^\s.\-{_NO_NAME}][^{_NO_NAME}]{{0,200}}\.[a-z0-9]{{1,10}}")
"""Some are called as gears are, which may be anything that a folder can be called."""


@dataclass(frozen=True)
class Part:
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
    parts: Mapping[str, Part] = field(default_factory=dict)
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
            str(name): Part(dict(part["options"]), {_plain(file): int(size) for file, size in part["files"].items()})
            for name, part in document["parts"].items()
        }
        unfinished = tuple(_plain(file) for file in document.get("unfinished", ()))
        return Manifest(str(document["inputs"]), parts, unfinished)
    except (OSError, ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError):
        return None


def _plain(file: Any) -> str:
    """A manifest may have been edited: what it names is removed one day, so it must be such a name as we give."""
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
    (staging / MANIFEST).write_text(manifest.text(), encoding="utf-8")
    if not folder.exists():
        with suppress(FileExistsError):  # made meanwhile by a run that was killed, and is dying
            staging.rename(folder)
            return
    with locked(folder):
        _replace_files(staging, folder, manifest, before)


def _replace_files(staging: Path, folder: Path, manifest: Manifest, before: Manifest | None) -> None:
    made = sorted(file.name for file in staging.iterdir() if file.name != MANIFEST)
    stale = sorted((before.files if before else set()) - manifest.files)
    touched = {*made, *stale}
    sound = {name: part for name, part in manifest.parts.items() if not touched & set(part.files)}
    _replace_manifest(staging, folder, Manifest(manifest.inputs, sound, tuple(sorted(touched))))
    for file in stale:
        (folder / file).unlink(missing_ok=True)
    for file in made:
        (staging / file).replace(folder / file)
    (staging / MANIFEST).replace(folder / MANIFEST)


def _replace_manifest(staging: Path, folder: Path, manifest: Manifest) -> None:
    interim = staging / f"{MANIFEST}.interim"
    interim.write_text(manifest.text(), encoding="utf-8")
    interim.replace(folder / MANIFEST)


def _size(path: Path) -> int | None:
    try:
        return path.stat().st_size
    except OSError:
        return None

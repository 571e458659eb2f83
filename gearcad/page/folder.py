"""The folder in which the page was started: its specs and tables by their names, and a place to save specs to."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path

from gearcad.designs.design import require_plain_name
from gearcad.designs.files import spec_text
from gearcad.designs.keys import MAIN_TABLES
from gearcad.errors import ParameterError, SpecError
from gearcad.output import staged_files

__all__ = ["LARGEST_SPEC", "LARGEST_TABLE", "SPECS", "TABLES", "Folder", "TakenError", "text_of"]

LARGEST_SPEC = 1 << 18
LARGEST_TABLE = 1 << 25
"""Bytes of a file that the page opens."""

SPECS, TABLES = (".toml",), (".csv", ".tsv")

_MOST_LISTED = 500

_KINDS = "|".join(sorted({tables[0] for tables in MAIN_TABLES.values()}))
_MAIN = re.compile(rf"^\s*(?:\[\s*(?:{_KINDS})\s*[].]|(?:{_KINDS})\s*\.)".encode(), re.MULTILINE)
"""A line of a spec, and of no other TOML that lies beside one."""


class Folder:
    """Files right in `path`, by their names. What a browser sends is looked up among these, and never used as a path."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def specs(self) -> list[str]:
        """Its specs, whether they make gears or not; no other TOML."""
        return [name for name in self.names(SPECS) if self._is_spec(name)]

    def names(self, suffixes: Collection[str]) -> list[str]:
        """Files with these suffixes, in the order of their names; none that a link finds elsewhere."""
        try:
            found = sorted(each.name for each in self.path.iterdir() if each.suffix.lower() in suffixes and self._has(each))
        except OSError:
            return []
        return found[:_MOST_LISTED]

    def find(self, name: str, suffixes: Collection[str], largest: int) -> Path:
        """The path of one of these files. Raises ParameterError for any other, and for one that is too large."""
        if name not in self.names(suffixes):
            raise ParameterError("file", name, "must be one of those in the folder of the page")
        path = self.path / name
        if path.stat().st_size > largest:
            raise ParameterError("file", name, f"must be smaller than {largest // 1024} kB")
        return path

    def spec(self, name: str) -> str:
        """The text of one of its specs. Raises ParameterError, SpecError."""
        return spec_text(self.find(name, SPECS, LARGEST_SPEC))

    def save(self, name: str, text: str, *, replace: bool) -> str:
        """Write a spec under a plain name, and return that of its file.

        Raises ParameterError for a name that is none or that is taken, unless it may be replaced, OutputError where nothing
        can be written.
        """
        name = name.strip().removesuffix(SPECS[0])
        require_plain_name(name)
        file = f"{name}{SPECS[0]}"
        require_plain_name(file)
        if not replace and file.casefold() in {each.name.casefold() for each in self.path.iterdir()}:
            raise TakenError("name", file, "is there; replace it, or give another name")
        with staged_files(self.path) as staging:
            (staging / file).write_bytes(text.encode("utf-8"))
        return file

    def _is_spec(self, name: str) -> bool:
        try:
            with (self.path / name).open("rb") as file:
                return _MAIN.search(file.read(LARGEST_SPEC)) is not None
        except OSError:
            return False

    def _has(self, path: Path) -> bool:
        return not path.name.startswith(".") and path.is_file() and path.resolve().is_relative_to(self.path.resolve())


class TakenError(ParameterError):
    """A name under which there is a file."""


def text_of(content: bytes, name: str) -> str:
    """What a browser has sent as the file of a spec. Raises SpecError."""
    if len(content) > LARGEST_SPEC:
        raise SpecError(f"{name}: is no spec: it has more than {LARGEST_SPEC // 1024} kB")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SpecError(f"{name}: is not UTF-8 text (byte {error.start}); save it as UTF-8") from error

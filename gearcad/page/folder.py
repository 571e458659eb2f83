"""Folder of specs: files by their names, and the links that hold a design."""

from __future__ import annotations

import base64
import binascii
import re
import zlib
from collections.abc import Collection
from pathlib import Path

from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.output import staged_files
from gearcad.designs.design import require_plain_name, spec_text
from gearcad.designs.keys import MAIN_TABLES

DESIGN = "design"
"""Name of the design's parameter in the address."""

NEW = "new"
"""Name of a design that was not begun yet."""

TAB = "tab"
"""Name of the parameter that finds the steps of a page that is loaded again."""

LONGEST = 8000
"""Characters of a link: what browsers, servers and mails let through."""

LARGEST_TEXT = 1 << 18
"""Largest size (bytes) of the text that a link unfolds to."""

_NO_LINK = "is no link of this page, or not all of it"
_BETWEEN = "\0"


def pack(name: str, text: str) -> str:
    """Return the part of the address that holds a design. Raises ParameterError for a text too long for an address."""
    packed = base64.urlsafe_b64encode(zlib.compress(f"{name}{_BETWEEN}{text}".encode(), 9)).decode("ascii").rstrip("=")
    if len(packed) > LONGEST:
        raise ParameterError(DESIGN, name, f"must fit into {LONGEST} characters of a link: save it to a file")
    return packed


def unpack(packed: str) -> tuple[str, str]:
    """Name and text of the design in a link. Raises ParameterError for anything else, and for what unfolds to too much."""
    try:
        if len(packed) > LONGEST or not packed.isascii():
            raise ValueError
        opened = zlib.decompressobj()
        content = opened.decompress(base64.b64decode(packed + "=" * (-len(packed) % 4), b"-_", validate=True), LARGEST_TEXT)
        if not opened.eof or opened.unused_data:
            raise ValueError
        name, between, text = content.decode("utf-8").partition(_BETWEEN)
    except (ValueError, binascii.Error, zlib.error) as error:
        raise ParameterError(DESIGN, packed, _NO_LINK) from error
    if not between:
        raise ParameterError(DESIGN, packed, _NO_LINK)
    require_plain_name(name)
    return name, text


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
        """Return the names of the specs in the folder, whether they make gears or not; no other TOML files."""
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
    """Return the text of a spec file that a browser has sent. Raises SpecError."""
    if len(content) > LARGEST_SPEC:
        raise SpecError(f"{name}: is no spec: it has more than {LARGEST_SPEC // 1024} kB")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SpecError(f"{name}: is not UTF-8 text (byte {error.start}); save it as UTF-8") from error

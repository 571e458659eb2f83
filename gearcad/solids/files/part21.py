"""Text of STEP files (ISO 10303-21): strings of any characters, numbers, lists, the header and the data section."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime

from gearcad.output import source_date
from gearcad.version import __version__

__all__ = ["DataSection", "header", "listed", "real", "string"]

_RUNS = re.compile(r"[\x20-\x7e]+|[^\x20-\x7e\U00010000-\U0010ffff]+|[\U00010000-\U0010ffff]+")
"""What a string holds as it is; what takes four hexadecimal digits; what takes eight."""

_TO_A_LINE = 12
"""References that stand on one line of a file."""

_SCHEMA = "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"

_NO_DATE = datetime(2000, 1, 1)
"""Written where nobody sets the date: files of equal input are equal."""


def string(text: str) -> str:
    r"""A text as a string of the exchange structure, on one line, so that no character is ever broken.

    ISO 10303-21:2016, 6.4.3: backslashes are doubled, \X2\...\X0\ holds characters of the basic plane and \X4\...\X0\ all
    others; the rest is ASCII. An apostrophe is \X\27, as Open CASCADE misreads one that is doubled before `)` or `,`.
    """
    return "'" + "".join(_run(run) for run in _RUNS.findall(text)) + "'"


def _run(run: str) -> str:
    if run.isascii() and run.isprintable():
        return run.replace("\\", "\\\\").replace("'", "\\X\\27")
    kind, digits = ("2", 4) if ord(run[0]) < 0x10000 else ("4", 8)
    return f"\\X{kind}\\" + "".join(f"{ord(character):0{digits}X}" for character in run) + "\\X0\\"


def real(value: float) -> str:
    """A number that reads back to the last bit: a REAL has a point, and a capital E before its power of ten (6.4.2)."""
    text = repr(float(value))
    if "e" not in text:
        return text
    mantissa, power = text.split("e")
    return f"{mantissa}{'' if '.' in mantissa else '.'}E{power}"


def listed(numbers: Sequence[int]) -> str:
    """References to entities, some to a line."""
    rows = (numbers[i : i + _TO_A_LINE] for i in range(0, len(numbers), _TO_A_LINE))
    return ",\n".join(",".join([f"#{number}" for number in row]) for row in rows)


class DataSection:
    """The data section while it grows: its entities have the numbers 1, 2, 3 ..."""

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._shared: dict[str, int] = {}

    def add(self, entity: str) -> int:
        """Add an entity; its number."""
        self._lines.append(entity)
        return len(self._lines)

    def shared(self, entity: str) -> int:
        """The number of an entity that may stand for all of the same text, added where there is none."""
        number = self._shared.get(entity)
        if number is None:
            number = self._shared[entity] = self.add(entity)
        return number

    def text(self) -> str:
        """The whole section."""
        lines = [f"#{number}={entity};\n" for number, entity in enumerate(self._lines, 1)]
        return "DATA;\n" + "".join(lines) + "ENDSEC;\n"


def header(name: str) -> str:
    """The header section of what is called `name`, in AP214: of nobody, at SOURCE_DATE_EPOCH or else in the year 2000."""
    stamp = (source_date() or _NO_DATE).strftime("%Y-%m-%dT%H:%M:%S")
    of = [string(text) for text in (name, stamp, f"gearcad {__version__}", _SCHEMA)]
    return (
        "HEADER;\n"
        f"FILE_DESCRIPTION(({of[0]}),'2;1');\n"
        f"FILE_NAME({of[0]},{of[1]},(''),(''),{of[2]},{of[2]},'');\n"
        f"FILE_SCHEMA(({of[3]}));\n"
        "ENDSEC;\n"
    )

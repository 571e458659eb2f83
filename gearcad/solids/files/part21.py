"""Text of STEP files (ISO 10303-21): strings of any characters, and the header."""

from __future__ import annotations

import re
from datetime import datetime

from gearcad.output import source_date
from gearcad.version import __version__

__all__ = ["header", "string"]

_RUNS = re.compile(r"[\x20-\x7e]+|[^\x20-\x7e\U00010000-\U0010ffff]+|[\U00010000-\U0010ffff]+")
"""What a string holds as it is; what takes four hexadecimal digits; what takes eight."""

_NO_DATE = datetime(2000, 1, 1)
"""Written where nobody sets the date: files of equal input are equal."""


def string(text: str) -> str:
    r"""A text as a string of the exchange structure, on one line, so that no character is ever broken.

    ISO 10303-21:2016, 6.4.3: apostrophes and backslashes are doubled, \X2\...\X0\ holds characters of the basic plane and
    \X4\...\X0\ all others; the rest is ASCII.
    """
    return "'" + "".join(_run(run) for run in _RUNS.findall(text)) + "'"


def _run(run: str) -> str:
    if run.isascii() and run.isprintable():
        return run.replace("\\", "\\\\").replace("'", "''")
    kind, digits = ("2", 4) if ord(run[0]) < 0x10000 else ("4", 8)
    return f"\\X{kind}\\" + "".join(f"{ord(character):0{digits}X}" for character in run) + "\\X0\\"


def header(name: str, preprocessor: str, schema: str) -> str:
    """The header section of what is called `name`: by gearcad, of nobody, at SOURCE_DATE_EPOCH or else in the year 2000."""
    stamp = (source_date() or _NO_DATE).strftime("%Y-%m-%dT%H:%M:%S")
    of = [string(text) for text in (name, stamp, preprocessor, f"gearcad {__version__}", schema)]
    return (
        "HEADER;\n"
        f"FILE_DESCRIPTION(({of[0]}),'2;1');\n"
        f"FILE_NAME({of[0]},{of[1]},(''),(''),{of[2]},{of[3]},'');\n"
        f"FILE_SCHEMA(({of[4]}));\n"
        "ENDSEC;\n"
    )

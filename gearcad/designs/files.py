"""Spec files as they are written: TOML in, its tables and the places of their keys out."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from gearcad.designs.lines import explain_syntax, find_lines, nearest_line
from gearcad.designs.named_files import find_named_files
from gearcad.designs.suffixes import is_table_name
from gearcad.errors import ParameterError, SpecError, format_number, shown, shown_path
from gearcad.output import file_bytes

__all__ = ["Where", "read_tables", "require_sane_tables", "spec_text", "tables_of_text"]

Where = Callable[[str], str]
"""Says where a key stands, such as `pair.toml line 7`, for the beginning of a message."""

_DEEPEST = 50
"""Levels of tables and lists in each other: no key of ours needs more than a few."""

_MOST_WHOLE = 10**15


def read_tables(path: Path | str) -> tuple[dict[str, Any], Where]:
    """The tables of a TOML spec as they are written, and what locates a key of theirs for messages. Raises SpecError.

    Only the files that it names are named as they are found from here.
    """
    path, text = Path(path), spec_text(path)
    try:
        return tables_of_text(text, shown_path(path), path.parent)
    except SpecError as error:
        if isinstance(error.__cause__, tomllib.TOMLDecodeError):
            _refuse_table(path)
        raise


def spec_text(path: Path | str) -> str:
    """The text of a spec. Raises SpecError."""
    path, file = Path(path), shown_path(path)
    try:
        return file_bytes(path).decode("utf-8-sig")
    except UnicodeEncodeError as error:
        raise SpecError(f"{shown(file)}: is no name that a file can have; give a spec file") from error
    except OSError as error:
        raise SpecError(
            f"{file}: cannot be read ({error.strerror}); give a spec file, or make one with `gearcad new`"
        ) from error
    except UnicodeDecodeError as error:
        _refuse_table(path)
        raise SpecError(f"{file}: is not UTF-8 text (byte {error.start}); save it as UTF-8") from error


def tables_of_text(text: str, file: str, folder: Path) -> tuple[dict[str, Any], Where]:
    """The same of a spec's text, which messages call `file`; files that it names are seen from `folder`. Raises SpecError."""
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SpecError(f"{file}{explain_syntax(error, text)}") from error
    except ValueError as error:
        raise SpecError(f"{file}: has a whole number of thousands of digits; write a smaller one") from error
    except RecursionError as error:
        raise SpecError(f"{file}: has lists or tables in each other, hundreds deep") from error
    lines = find_lines(text)

    def where(key: str) -> str:
        line = nearest_line(lines, key)
        return f"{file} line {line}" if line else file

    require_sane_tables(tables, where)
    try:
        find_named_files(tables, folder)
    except ParameterError as error:
        raise SpecError(f"{where(error.parameter)}: {error}", error.parameter) from error
    return tables, where


def _refuse_table(path: Path) -> None:
    if is_table_name(path):
        raise SpecError(f"{path}: is a design table, not the spec of one design; use `gearcad batch {path}`")


def require_sane_tables(content: Any, where: Where, key: str = "", depth: int = 0) -> None:
    """Raise SpecError for a whole number in the tables of a spec that a float could not hold, and for tables too deep."""
    if depth > _DEEPEST:
        raise SpecError(f"{where(key)}: {shown(key)}: has lists or tables in each other, more than {_DEEPEST} deep", key)
    if isinstance(content, Mapping):
        for name, inner in content.items():
            require_sane_tables(inner, where, f"{key}.{name}" if key else name, depth + 1)
    elif isinstance(content, list | tuple):
        for number, inner in enumerate(content):
            require_sane_tables(inner, where, f"{key}[{number}]" if isinstance(inner, Mapping) else key, depth + 1)
    elif isinstance(content, int) and abs(content) > _MOST_WHOLE:
        if _is_text(key):
            raise SpecError(f"{where(key)}: {ParameterError(key, content, 'must be a text, in quotation marks')}", key)
        raise SpecError(f"{where(key)}: {shown(key)}: must be a smaller number; this is {format_number(content)}", key)


def _is_text(key: str) -> bool:
    """Return whether a key of a spec takes texts only."""
    from gearcad.designs.keys import FIELDS, field_of  # which import this module

    table, _, own = key.partition(".")
    field = field_of(table, own) if table in FIELDS else None
    return own == "name" if field is None else field.text

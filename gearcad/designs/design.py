"""Design: what one spec describes, whatever its kind; the TOML text of a spec with the places of its keys."""

from __future__ import annotations

import json
import re
import tomllib
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Protocol, Self

from gearcad.core.errors import ParameterError, SpecError, format_number, shown, shown_path
from gearcad.core.output import file_bytes
from gearcad.core.records import JsonObject, Notice, concise, texts
from gearcad.core.shelf_tables import ShelfName
from gearcad.designs.keys import GEARBOX_FILE, DesignKind
from gearcad.geometry import Gear
from gearcad.geometry.tool_shelf import ToolName
from gearcad.geometry.tool_tables import FILE as TOOLS
from gearcad.material_shelf import FILE as MATERIALS
from gearcad.shafts.bearing_shelf import FILE as BEARINGS
from gearcad.version import __version__

_PART = r"""(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')"""
_DOTTED = rf"{_PART}(?:\s*\.\s*{_PART})*"
_HEADER = re.compile(rf"\s*\[\[?\s*({_DOTTED})\s*\]\]?")
_ASSIGNMENT = re.compile(rf"\s*({_DOTTED})\s*=\s*(.*)")
_INLINE = re.compile(rf"[{{,]\s*({_DOTTED})\s*=")
_MULTILINE_QUOTES = ('"""', "'''")


def _plain(dotted: str) -> str:
    """`a . "b"` as `a.b`."""
    return ".".join(part.strip("\"'") for part in re.findall(_PART, dotted))


def find_lines(text: str) -> dict[str, int]:
    """Return the line number (from 1) of every table header and key, under its full dotted name.

    Follows headers, dotted keys and inline tables on one line, counts tables in lists from 0 (`mesh[0].teeth`); skips texts
    over several lines. The first mention wins.
    The text is taken to be valid TOML: what a stranger layout hides has no line, which only costs the message its number.
    """
    lines: dict[str, int] = {}
    lists: Counter[str] = Counter()
    table, closing = "", ""
    for number, line in enumerate(text.split("\n"), start=1):
        if closing:
            closing = "" if closing in line else closing
            continue
        if header := _HEADER.match(line):
            table = _inside(_plain(header[1]), lists)
            lines.setdefault(table, number)
            if line.lstrip().startswith("[["):
                lists[table] += 1
                table = f"{table}[{lists[table] - 1}]"
                lines.setdefault(table, number)
        elif assignment := _ASSIGNMENT.match(line):
            key = ".".join(filter(None, (table, _plain(assignment[1]))))
            lines.setdefault(key, number)
            value = assignment[2]
            if value.startswith("{"):
                for inner in _INLINE.finditer(value):
                    lines.setdefault(f"{key}.{_plain(inner[1])}", number)
            closing = next((quotes for quotes in _MULTILINE_QUOTES if value.count(quotes) == 1), "")
    return lines


def _inside(table: str, lists: Counter[str]) -> str:
    """Return a table's name with its number in a list of tables: `mesh[0].pair` below [[mesh]]."""
    for name in sorted(lists, key=len, reverse=True):
        if table.startswith(f"{name}."):
            return f"{name}[{lists[name] - 1}]{table.removeprefix(name)}"
    return table


def nearest_line(lines: dict[str, int], key: str) -> int | None:
    """Return the line of `key`, or else of the innermost table around it that has one."""
    while key not in lines and "." in key:
        key = key.rpartition(".")[0]
    return lines.get(key)


def explain_syntax(error: tomllib.TOMLDecodeError, text: str) -> str:
    """Return the end of the message about broken TOML: place and reason, and the commonest mistake by its name."""
    place = re.search(r" \(at line (\d+), column (\d+)\)$", str(error))
    if place is None:
        return f": is not valid TOML: {error}"
    hint = ""
    if comma := re.search(r"=\s*([-+]?\d+),(\d+)", text.split("\n")[int(place[1]) - 1]):
        hint = f"; write {comma[1]}.{comma[2]} with a point"
    return f" line {place[1]}, column {place[2]}: is not valid TOML: {str(error)[: place.start()]}{hint}"


WORKBOOKS = (".xlsx", ".xlsm")
UNREADABLE = (".xls", ".xlsb", ".ods", ".numbers")
"""Suffixes of tables that must first be saved as files of another kind."""

_TEXTS = (".csv", ".tsv")
"""Names of tables that are texts; a text under any other name than a spec's is read as one too."""


def is_table_name(path: Path) -> bool:
    """True for a file that is named like a design table."""
    return path.suffix.lower() in (*WORKBOOKS, *UNREADABLE, *_TEXTS)


def is_spec_name(path: Path) -> bool:
    """True for a file that is named like a spec."""
    return path.suffix.lower() == ".toml"


_TEMPLATE = "drawing.template"
"""Key of the template that changes the title block of drawings."""

_BLANK = "body.step"
"""Key of a gear's blank of its own."""

_BEARING = re.compile(r"(?:^|\.)bearings?\[\d+\]\.name$")
_MATERIAL = re.compile(r"(?:^|\.)material\.name$")
"""Key of the name of a bearing of a shaft."""

_fence: ContextVar[Path | None] = ContextVar("the folder in which files must be", default=None)


@contextmanager
def files_only_in(folder: Path) -> Iterator[None]:
    """Restrict the specs that this thread reads inside this context to files in `folder`, links followed. Other files raise
    ParameterError.
    """
    token = _fence.set(folder.resolve())
    try:
        yield
    finally:
        _fence.reset(token)


_FILES_OF_TRAINS = (("mesh", "pair"), ("shaft", "layout"), ("excitation", "file"))
"""Lists of a train whose parts may name a file, and the key of it: that of `mesh.NAME.pair`."""


def names_file(key: str) -> bool:
    """Return whether a text under a key is a file: a template, a blank, a mesh's pair, a shaft's layout, a torque's curve."""
    table, _, rest = key.partition(".")
    name, _, field = rest.rpartition(".")
    if key in (_TEMPLATE, _BLANK, GEARBOX_FILE) or key.endswith(f".{_BLANK}"):
        return True
    return (table, field) in _FILES_OF_TRAINS and bool(name)


def is_inline(value: Any) -> bool:
    """Return whether the value of a key that may name a file is a table in one line of TOML, as a cell may hold it."""
    return isinstance(value, str) and value.lstrip().startswith("{")


def inline_toml(value: Any) -> str:
    """Return a value as one line of TOML, tables as inline tables."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(key)} = {inline_toml(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(inline_toml, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(str(value), ensure_ascii=False) if isinstance(value, str) else str(value)


def inline_table(key: str, text: str, folder: Path = Path()) -> dict[str, Any]:
    """Return the table that one line of TOML holds; files that it names are seen from `folder`. Raises ParameterError."""
    try:
        found: dict[str, Any] = tomllib.loads(f"{_CELL}={text}")[_CELL]
    except tomllib.TOMLDecodeError as error:
        raise ParameterError(key, text, "must be the name of a file, or a table in one line, as in TOML") from error
    find_named_files(found, folder)
    return found


_CELL = "cell"
"""Key of the table that one line holds."""


def with_files_found(values: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return the values with files, which are seen from `folder`, as they are found from here."""
    return {key: _found_value(key, each, folder) for key, each in values.items()}


def _found_value(key: str, value: Any, folder: Path) -> Any:
    """Return a value with the files that it names as they are found from here; a table in one line as a table."""
    if names_file(key) and is_inline(value):
        try:
            return inline_table(key, value, folder)
        except ParameterError as error:
            if error.parameter != key:
                raise
            return value  # no TOML: who reads it says so, and where it is
    if names_file(key):
        return _file_path(key, value, folder)
    if (table := shelf_of(key)) is not None:
        return _shelf_name(key, value, folder, table)
    return _tool_name(key, value, folder) if names_tool(key) else value


def names_tool(key: str) -> bool:
    """Return whether a text under a key is the name of a tool, which the folder of the design may have."""
    return key.rpartition(".")[2] == "tool"


def shelf_of(key: str) -> str | None:
    """Return the file of the table that may have the bearing or the material a key names; None for other keys."""
    if _MATERIAL.search(key) is not None:
        return MATERIALS
    return None if _BEARING.search(key) is None else BEARINGS


def _shelf_name(key: str, name: Any, folder: Path, table: str) -> Any:
    """Return the name of a bearing or a material with the folder of its design. What is no text stays as it is."""
    if not isinstance(name, str):
        return name
    if (fence := _fence.get()) is not None and not _resolved(folder / table).is_relative_to(fence):
        raise ParameterError(key, name, "must be of a table in the folder of the page")
    return ShelfName.of(name, folder)


def _tool_name(key: str, name: Any, folder: Path) -> Any:
    """Return the name of a tool with the folder of its design. What is no text stays as it is."""
    if not isinstance(name, str) or "\0" in name:
        return name
    beside = folder / name.rpartition("/")[0]
    for table in (folder / TOOLS, beside / TOOLS):
        if (fence := _fence.get()) is not None and not _resolved(table).is_relative_to(fence):
            raise ParameterError(key, name, "must be of a table in the folder of the page")
    return ToolName.of(name, folder)


def _find_tools(tables: Any, folder: Path, before: str = "") -> None:
    """Let the names of tools in the tables of a spec, in place, know the folder of the design."""
    if isinstance(tables, list):
        for at, each in enumerate(tables):
            _find_tools(each, folder, f"{before}[{at}]")
    elif isinstance(tables, dict):
        for key, each in tables.items():
            full = f"{before}.{key}" if before else key
            if key == "tool":
                tables[key] = _tool_name(full, each, folder)
            elif (table := shelf_of(full)) is not None:
                tables[key] = _shelf_name(full, each, folder, table)
            else:
                _find_tools(each, folder, full)


def find_named_files(tables: Mapping[str, Any], folder: Path) -> None:
    """Replace the file names in the tables of a spec in `folder`, in place, by names that are valid from here.

    The names of tools remember the folder, which may have a table of them.
    """
    _find_tools(tables, folder)
    train, drawing = tables.get("train"), tables.get("drawing")
    named: list[tuple[str, Any, str]] = []
    for part, key in _FILES_OF_TRAINS:
        listed = train.get(part) if isinstance(train, Mapping) else None
        named += [(f"train.{part}[{at}]", each, key) for at, each in enumerate(listed)] if isinstance(listed, list) else []
    for where, table, key in (*named, ("drawing", drawing, "template")):
        if isinstance(table, dict) and key in table:
            table[key] = _file_path(f"{where}.{key}", table[key], folder)
    for where, body in _bodies(tables):
        body["step"] = _file_path(f"{where}.step", body["step"], folder)


def _bodies(tables: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the tables body that name a blank, with their keys."""
    waiting: list[tuple[str, Any]] = [(name, table) for name, table in tables.items() if isinstance(table, dict)]
    while waiting:
        where, table = waiting.pop()
        if where.endswith(".body") and "step" in table:
            yield where, table
        waiting += [(f"{where}.{name}", inner) for name, inner in table.items() if isinstance(inner, dict)]


def _file_path(key: str, name: Any, folder: Path) -> Any:
    """Return the path of a file as seen from here. A name that no file can have stays as it is: whoever reads the file refuses
    it.
    """
    if not isinstance(name, str) or not name.strip() or "\0" in name or is_inline(name):
        return name
    fence, found = _fence.get(), folder / name
    if fence is not None and not _resolved(found).is_relative_to(fence):
        raise ParameterError(key, name, "must be a file in the folder of the page")
    return str(found)


def _resolved(path: Path) -> Path:
    """Return the path with all links followed, or the root folder for a path that leads nowhere (a loop of links)."""
    try:
        return path.resolve()
    except (OSError, RuntimeError):  # a loop of links
        return Path("/")


Where = Callable[[str], str]
"""Says where a key stands, such as `pair.toml line 7`, for the beginning of a message."""

_DEEPEST = 50
"""Largest permitted depth of nested tables and lists; no key needs more than a few levels."""

_MOST_WHOLE = 10**15


def read_tables(path: Path | str) -> tuple[dict[str, Any], Where]:
    """Return the tables of a TOML spec as they are written, and what locates a key of theirs for messages. Raises SpecError.

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
    """Return the text of a spec. Raises SpecError."""
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
    """Return the tables of a spec's text, and a function that locates a key for messages. Raises SpecError.

    Messages call the text `file`; files that it names are seen from `folder`.
    """
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SpecError(f"{file}{explain_syntax(error, text)}") from error
    except ValueError as error:
        raise SpecError(f"{file}: has a whole number of thousands of digits; write a smaller one") from error
    except RecursionError as error:
        raise SpecError(f"{file}: has lists or tables nested hundreds deep") from error
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
        raise SpecError(f"{where(key)}: {shown(key)}: has lists or tables nested more than {_DEEPEST} deep", key)
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


LONGEST_NAME = 100
"""Largest number of characters in the name of a design. The name becomes a folder, and file systems stop at 255 bytes."""

LONGEST_NAME_IN_BYTES = 200
"""Greatest length of a name in bytes of UTF-8, with room for suffixes of the files beside the folder."""

_RESERVED = {"CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"} | {
    f"{port}{digit}" for port in ("COM", "LPT") for digit in "0123456789¹²³"
}


class Described(Protocol):
    """An object with derived properties and notices of its own: a gear, a rack, or a pair of them."""

    @property
    def notices(self) -> tuple[Notice, ...]: ...

    def to_dict(self) -> JsonObject:
        """Return the inputs and derived properties under their field names."""


@dataclass(frozen=True, kw_only=True)
class Design(ABC):
    """The design that one spec describes, of any kind: its subject under the name of its kind, and inputs for later stages.

    `name` becomes the name of the output folder. Raises ParameterError for a name that is not a plain file name.
    """

    kind: ClassVar[DesignKind]
    elsewhere: ClassVar[str] = ""
    """Words for the commands that take designs of this kind, if hardly any job does."""

    name: str

    __repr__ = concise

    def __post_init__(self) -> None:
        require_plain_name(self.name)

    @classmethod
    @abstractmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that the tables of a spec describe; `where` locates a dotted key for messages. Raises SpecError."""

    @property
    def gears(self) -> dict[str, Gear]:
        """The gears under the names of their files; none of a kind that knows no teeth."""
        return {}

    @property
    def described(self) -> Mapping[str, Described]:
        """Objects with derived properties and notices, under their names in `data.json`."""
        return self.gears

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of all described objects: facts that an engineer should know before manufacture."""
        return tuple(notice.within(name) for name, each in self.described.items() for notice in each.notices)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words, each led by what it is about."""
        return texts(self.notices)

    def require_kind(self, *kinds: DesignKind, why: str) -> None:
        """Raise ParameterError, that ends with why no other will do, unless the design is of one of these kinds."""
        if self.kind not in kinds:
            raise ParameterError("kind", self.kind.words, f"must be {kinds_in_words(kinds)}: {self.elsewhere or why}")

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`: inputs and derived properties under their field names (mm, degrees)."""
        document: dict[str, Any] = {"kind": self.kind.value, "name": self.name, "gearcad": __version__}
        return document | {name: each.to_dict() for name, each in self.described.items()}


def kinds_in_words(accepted: Iterable[DesignKind]) -> str:
    """ "a gear, a pair or a rack"."""
    *others, last = (f"a {each.words}" for each in accepted)
    return f"{', '.join(others)} or {last}" if others else last


def require_plain_name(name: Any) -> None:
    """Raise ParameterError unless `name` can name a folder on every system, and nothing but a folder."""
    permitted = "must be a plain file name"
    if not isinstance(name, str) or not name.strip():
        raise ParameterError("name", name, f"{permitted}: a text that is not empty")
    if len(name) > LONGEST_NAME:
        raise ParameterError("name", name, f"{permitted} of at most {LONGEST_NAME} characters")
    if not name.isprintable() or any(character in '/\\<>:"|?*' for character in name):
        raise ParameterError("name", name, f'{permitted}, without / \\ < > : " | ? * and control characters')
    if len(name.encode()) > LONGEST_NAME_IN_BYTES:
        raise ParameterError("name", name, f"{permitted} of at most {LONGEST_NAME_IN_BYTES} bytes in UTF-8")
    if name[0] in ".- " or name[-1] in ". ":
        raise ParameterError(
            "name", name, f"{permitted}: not begun with a point, a dash or a space, nor ended with a point or space"
        )
    if name.split(".")[0].strip().upper() in _RESERVED:
        raise ParameterError("name", name, f"{permitted}: Windows keeps this one for itself")

"""Shelf of tools: tables `tools.csv` whose rows describe tools that cut gears, found by name and module.

A name is looked for in the folder of the design, then in the user's configuration folder, then in the table of gearcad. The
columns of a table are `name`, `normal_module` (mm; blank: every module), `source`, and the keys of a gear behind `rack.`,
`cutter.` and `premachining.`, with their units: a hob that finishes the teeth has the keys of its counterpart, the rack.
"""

from __future__ import annotations

import csv
import difflib
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

from gearcad.core.errors import (
    GeometryError,
    InputError,
    ParameterError,
    SpecError,
    format_number,
    is_finite_number,
    printable,
    shown,
    shown_path,
)
from gearcad.core.quantities import FieldSchema, is_given, schema_of
from gearcad.core.runtime import templates
from gearcad.core.units import module_of_pitch
from gearcad.geometry.gear_parts import BasicRack, NormalModule, ShaperCutter
from gearcad.geometry.premachining import Premachining

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

PARTS: Mapping[str, type[DataclassInstance]] = {"rack": BasicRack, "cutter": ShaperCutter, "premachining": Premachining}
"""Parts of a gear that a tool fills, and their types."""

FILE = "tools.csv"
"""Name of a table of tools in the folder of a design, and in that of the user's configuration."""

_OWN_FILE = "tool_shelf.csv"
_SAME = 1e-6
"""Share by which the modules of a tool and a gear may differ: digits of a diametral pitch."""

_NEAREST = 3
"""Number of names that a message suggests."""

_PLAIN = ("name", "normal_module", "source")


class Place(Enum):
    """Where the table of a tool is."""

    DESIGN = "design"
    USER = "user"
    OWN = "gearcad"


class ToolName(str):
    """The name of a tool, with the `folder` of the design that has it; `tool` is what was found, None until it is looked for.

    `Gear(tool="DIN 3972 II")` takes a plain text too, whose folder is the current one.
    """

    folder: Path = Path()
    tool: ShelfTool | None = None

    @classmethod
    def of(cls, name: str, folder: Path | None = None, tool: ShelfTool | None = None) -> ToolName:
        """Return the name as seen from a folder; without one, from that of the name itself."""
        made = cls(name)
        made.folder = getattr(name, "folder", Path()) if folder is None else folder
        made.tool = tool
        return made

    def seen_from(self, folder: Path) -> str:
        """Return the name for a design in another folder: where it is a design's own tool, with the way to its table."""
        from os.path import relpath

        rows = [row for row in Shelf(self.folder).named(self) if row.table.place is Place.DESIGN]
        if not rows or "/" in self or self.folder.resolve() == folder.resolve():
            return str(self)
        return f"{Path(relpath(self.folder, folder)).as_posix()}/{self}"


@dataclass(frozen=True, kw_only=True)
class ShelfTool:
    """A tool of the shelf: its parts of a gear, the table (`place`, `file`, `row`) and the `source` of its sizes.

    `normal_module` (mm) None: it cuts every module, as all its lengths are in modules.
    """

    name: str
    place: Place
    file: str
    row: int
    normal_module: float | None = None
    source: str = ""
    rack: BasicRack = field(default=BasicRack())
    cutter: ShaperCutter = field(default=ShaperCutter())
    premachining: Premachining = field(default=Premachining())

    @property
    def parts(self) -> dict[str, Any]:
        """The parts of a gear that the tool fills."""
        return {name: getattr(self, name) for name in PARTS}

    @property
    def kind(self) -> str:
        """ "hob" or "cutter" for a tool that makes all of the teeth, otherwise these words "before finishing"."""
        if self.premachining.present:
            return "hob before finishing" if self.premachining.cutter_teeth is None else "cutter before finishing"
        return "cutter" if self.cutter.present else "hob"

    def addendum(self, module: float) -> float:
        """Return the addendum h_aP0 of the tool (normal modules), from where its teeth are half a pitch thick.

        A tool that leaves the stock q stands q/sin alpha_n further out for that, and reaches so much less deep into the gear.
        """
        pre = self.premachining
        if not pre.present:
            return self.rack.dedendum
        sine = math.sin(math.radians(self.rack.pressure_angle))
        return pre.addendum_of(module) + pre.stock_of(module) / sine / module

    def fits(self, module: float) -> bool:
        """Return whether the tool is of a normal module (mm)."""
        return self.normal_module is None or math.isclose(self.normal_module, module, rel_tol=_SAME)

    def to_dict(self) -> dict[str, Any]:
        """Return name, table, module (mm), and the keys of the parts that differ from their defaults."""
        found: dict[str, Any] = {"name": self.name, "kind": self.kind, "place": self.place.value, "file": self.file}
        found |= {"row": self.row, "normal_module": self.normal_module, "source": self.source}
        return found | {"keys": self.keys}

    @property
    def keys(self) -> dict[str, Any]:
        """The keys of a gear, with dots, that describe the tool."""
        own = {"rack": ("pressure_angle", "addendum")} if self.premachining.present else {}
        found: dict[str, Any] = {}
        for part, kind in PARTS.items():
            if part != "rack" and not getattr(self, part).present:
                continue
            for key, value in _values_of(getattr(self, part), kind):
                if part not in own or key in own[part]:
                    found[f"{part}.{key}"] = value
        return found


def _values_of(instance: Any, kind: type[DataclassInstance]) -> Iterator[tuple[str, Any]]:
    """Yield the fields of a part with a value, those of its own parts with a dot."""
    for name, schema in schema_of(kind).items():
        value = getattr(instance, name)
        if schema.part is not None:
            yield from ((f"{name}.{key}", inner) for key, inner in _values_of(value, schema.part))
        elif value is not None and (kind is BasicRack or value != schema.default):
            yield name, value


def _flat(kind: type[DataclassInstance], owner: str) -> Iterator[tuple[str, FieldSchema]]:
    for name, schema in schema_of(kind).items():
        if schema.part is None:
            yield f"{owner}.{name}", schema
        else:
            yield from _flat(schema.part, f"{owner}.{name}")


@lru_cache(maxsize=1)
def _columns() -> dict[str, FieldSchema]:
    """Return the fields of all columns that are keys."""
    return {key: schema for part, kind in PARTS.items() for key, schema in _flat(kind, part)}


_MODULE = next(each for each in get_args(NormalModule) if hasattr(each, "require"))
"""What is permitted of a normal module."""


@dataclass(frozen=True)
class ToolRow:
    """A row of a table of tools as it is written; `number` counts rows as a spreadsheet does."""

    table: ToolTable
    number: int
    name: str
    cells: tuple[str, ...]

    def where(self, column: int | None = None) -> str:
        """Return the place for the beginning of a message."""
        at = "" if column is None else f" column {_letter(column)}"
        return f"{self.table.shown} row {self.number}{at} ({shown(self.name, 60)})"

    @cached_property
    def module(self) -> float | None:
        """Normal module (mm); None for every module. Raises SpecError."""
        value = self._value("normal_module")
        if value is None:
            return None
        try:
            _MODULE.require("normal_module", value)
        except ParameterError as error:
            raise self._fault(error) from None
        return float(value)

    def _value(self, key: str) -> Any:
        """Return the value of a cell; None for a blank one."""
        at = self.table.columns.index(key) if key in self.table.columns else len(self.cells)
        text = self.cells[at].strip() if at < len(self.cells) else ""
        if not text or key in ("name", "source"):
            return text or None
        plain = text.replace("\N{MINUS SIGN}", "-")
        if self.table.separator != ",":
            plain = plain.replace(",", ".")
        try:
            number = float(plain)
        except ValueError:
            return text
        schema = _columns().get(key)
        return int(number) if schema is not None and schema.whole and number.is_integer() else number

    def _fault(self, error: InputError) -> SpecError:
        columns = self.table.columns
        at = columns.index(error.parameter) if error.parameter in columns else None
        return SpecError(f"{self.where(at)}: {error}", error.parameter)

    @cached_property
    def tool(self) -> ShelfTool:
        """The tool. Raises SpecError with file, row and column of what is not permitted."""
        values = {key: value for key in self.table.columns if key and (value := self._value(key)) is not None}
        for at in range(len(self.table.columns), len(self.cells)):
            if self.cells[at].strip():
                raise SpecError(f"{self.where(at)}: {shown(self.cells[at].strip())}: has no heading above it")
        try:
            self._check(values)
            parts = {part: _made(kind, part, values) for part, kind in PARTS.items()}
        except InputError as error:
            raise self._fault(error) from None
        table = self.table
        return ShelfTool(
            name=self.name,
            place=table.place,
            file=table.file,
            row=self.number,
            normal_module=self.module,
            source=values.get("source", ""),
            **parts,
        )

    def _check(self, values: Mapping[str, Any]) -> None:
        """Raise InputError for a name that none can have, and for a row that describes no tool or two."""
        if "/" in self.name:
            raise ParameterError("name", self.name, "must have no /, which leads to a table in another folder")
        of = {part: [key for key in values if key.startswith(f"{part}.")] for part in PARTS}
        root = [key for key in of["rack"] if key in ("rack.dedendum", "rack.root_radius")]
        if of["premachining"]:
            for key in (*root, *of["cutter"]):
                raise GeometryError(key, values[key], "must be left out: the tool of premachining makes the root")
        elif not (root or of["cutter"]):
            permitted = "must describe a tool, such as by rack.dedendum, by cutter.teeth or by premachining.tool_addendum"
            raise GeometryError("name", self.name, permitted)
        if self.module is None:
            for key in of["premachining"]:
                if _columns()[key].symbol.unit == "mm" and isinstance(values[key], float):
                    raise GeometryError("normal_module", None, f"must be given where {key} is: it is in mm")


def _made(kind: type[DataclassInstance], owner: str, values: Mapping[str, Any]) -> Any:
    """Return a part of the values under its keys. Raises InputError, led by the owner."""
    given: dict[str, Any] = {}
    for name, schema in schema_of(kind).items():
        key = f"{owner}.{name}"
        if schema.part is not None:
            given[name] = _made(schema.part, key, values)
        elif key in values:
            given[name] = values[key]
    try:
        return kind(**given)
    except InputError as error:
        if error.parameter.startswith(f"{owner}."):
            raise
        raise error.within(owner) from None


def _letter(index: int) -> str:
    """Return the name that a spreadsheet gives the column of an index from 0."""
    letters, index = "", index + 1
    while index:
        index, letter = divmod(index - 1, 26)
        letters = chr(ord("A") + letter) + letters
    return letters


@dataclass(frozen=True)
class ToolTable:
    """A table of tools: where it is, its columns by their places, "" under a blank heading, and the sign between cells."""

    path: Path
    place: Place
    columns: tuple[str, ...] = ()
    separator: str = ","

    @property
    def shown(self) -> str:
        """The path for messages."""
        return printable(shown_path(self.path))

    @property
    def file(self) -> str:
        """The path for documents: without the folder of a design, and from the home of a user."""
        if self.place is Place.DESIGN:
            return FILE
        if self.place is Place.OWN:
            return _OWN_FILE
        try:
            return f"~/{self.path.relative_to(Path.home()).as_posix()}"
        except (ValueError, RuntimeError):  # another folder, or no home
            return str(self.path)


@lru_cache(maxsize=16)
def _rows(path: Path, place: Place, _stamp: tuple[int, int]) -> tuple[ToolRow, ...]:
    """Return the rows of a table, which has this time and size. Raises SpecError."""
    table = ToolTable(path, place)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise SpecError(f"{table.shown}: is not UTF-8 text (byte {error.start}); save it as CSV UTF-8") from None
    except OSError as error:
        raise SpecError(f"{table.shown}: cannot be read ({error.strerror})") from None
    lines = text.splitlines()
    heading = next((line for line in lines if line.strip() and not line.lstrip().startswith(("#", "sep="))), "")
    separator = max(",;\t", key=heading.count)
    try:
        records = list(enumerate(csv.reader(lines, delimiter=separator), 1))
    except csv.Error as error:
        raise SpecError(f"{table.shown}: cannot be read ({error})") from None
    filled = [
        (number, cells)
        for number, cells in records
        if any(cell.strip() for cell in cells) and not cells[0].lstrip().startswith(("#", "sep="))
    ]
    if not filled:
        raise SpecError(f"{table.shown}: has no heading; must have name and keys such as rack.dedendum")
    number, headings = filled[0]
    columns = _headings(headings, f"{table.shown} row {number}")
    table = ToolTable(path, place, columns, separator)
    named = columns.index("name")
    found = []
    for number, cells in filled[1:]:
        name = " ".join(cells[named].split()) if named < len(cells) else ""
        if not name:
            raise SpecError(f"{table.shown} row {number} column {_letter(named)}: has no name")
        found.append(ToolRow(table, number, name, tuple(cells)))
    return tuple(found)


def _headings(cells: list[str], where: str) -> tuple[str, ...]:
    """Return the key of each column. Raises SpecError, one line for a heading that is none."""
    known = (*_PLAIN, *_columns())
    columns: list[str] = []
    for at, cell in enumerate(cells):
        key = {"module": "normal_module"}.get(cell.strip(), cell.strip())
        if key and key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"did you mean {near[0]}?" if near else "must be name, normal_module, source, or a key such as rack.dedendum"
            raise SpecError(f"{where} column {_letter(at)}: {shown(cell.strip())}: unknown column; {hint}")
        if key and key in columns:
            raise SpecError(f"{where} column {_letter(at)}: {key}: is the same as column {_letter(columns.index(key))}")
        columns.append(key)
    if "name" not in columns:
        raise SpecError(f"{where}: has no column name, by which tools are found")
    return tuple(columns)


def user_table() -> Path:
    """Return the path of the table of tools in the user's configuration folder, be it there or not."""
    import platformdirs

    return Path(platformdirs.user_config_dir("gearcad", appauthor=False)) / FILE


class Shelf(NamedTuple):
    """The tables of tools that a design in a folder sees."""

    folder: Path = Path()

    @property
    def places(self) -> tuple[tuple[Path, Place], ...]:
        """The tables in the order in which a name is looked for, be they there or not."""
        own = templates() / _OWN_FILE
        return (self.folder / FILE, Place.DESIGN), (user_table(), Place.USER), (own, Place.OWN)

    def rows(self) -> Iterator[ToolRow]:
        """Yield the rows of all tables. Raises SpecError for a table that cannot be read."""
        for path, place in self.places:
            try:
                stamp = path.stat()
            except (OSError, ValueError):
                continue
            yield from _rows(path, place, (stamp.st_mtime_ns, stamp.st_size))

    @classmethod
    def own(cls) -> tuple[ToolRow, ...]:
        """Return the rows of the table of gearcad."""
        path = templates() / _OWN_FILE
        stamp = path.stat()
        return _rows(path, Place.OWN, (stamp.st_mtime_ns, stamp.st_size))

    def named(self, name: str) -> list[ToolRow]:
        """Return the rows of a name in the order of the tables; large and small letters are alike where none is spelt so."""
        plain = " ".join(name.split())
        rows = list(self.rows())
        exact = [row for row in rows if row.name == plain]
        if exact:
            return exact
        folded = [row for row in rows if row.name.casefold() == plain.casefold()]
        if folded or "/" not in plain:
            return folded
        folder, _, last = plain.rpartition("/")
        beyond = Shelf(self.folder / folder)
        return [row for row in beyond.rows() if row.table.place is Place.DESIGN and row.name == last.strip()]

    def find(self, name: str, module: float | None) -> ShelfTool:
        """Return the tool of a name for a normal module (mm), None for any. Raises InputError and SpecError."""
        rows = self.named(name)
        if not rows:
            raise ParameterError("tool", str(name), self._absent(name))
        for table in dict.fromkeys(row.table for row in rows):
            here = [row for row in rows if row.table == table]
            suits = [row for row in here if row.module is not None and _alike(row.module, module)]
            suits += [row for row in here if row.module is None]
            if suits:
                return suits[0].tool
        modules = ", ".join(format_number(each) for each in sorted({row.module for row in rows if row.module is not None}))
        permitted = f"must be a tool of module {format_number(module)} mm; it is there for module {shown(modules)} mm"
        raise GeometryError("tool", str(name), permitted)

    def _absent(self, name: str) -> str:
        names = list(dict.fromkeys(row.name for row in self.rows()))
        folded = {each.casefold(): each for each in names}
        near = difflib.get_close_matches(" ".join(name.split()).casefold(), folded, n=_NEAREST, cutoff=0.0)
        nearest = ", ".join(f'"{folded[each]}"' for each in near)
        paths = [path for path, place in self.places if place is not Place.OWN]
        if "/" in name:
            paths.append(self.folder / name.rpartition("/")[0] / FILE)
        files = ", ".join(printable(shown_path(path)) for path in paths)
        return f"must be a tool of the shelf; the nearest are {nearest}; looked in {files} and the table of gearcad"

    def text_of(self, name: str) -> str:
        """Return the rows of a name as one text, by which a change is noticed; "" where they cannot be read."""
        try:
            return "\n".join(f"{row.table.columns} {row.cells}" for row in self.named(name))
        except SpecError:
            return ""


def _alike(one: float, other: float | None) -> bool:
    return other is None or math.isclose(one, other, rel_tol=_SAME)


def find_tool(name: str, module: float | None) -> ToolName:
    """Return a name with its tool, which is looked for in the folder of the name. Raises InputError and SpecError."""
    if not isinstance(name, str):
        raise ParameterError("tool", name, "must be the name of a tool, a text in quotation marks")
    folder = getattr(name, "folder", Path())
    found = Shelf(folder).find(name, module)
    return ToolName.of(name if "/" in name else found.name, folder, found)


def module_given(module: Any, pitch: Any) -> float | None:
    """Return the normal module (mm) of what is given, or of a diametral pitch (1/inch); None where neither is a number."""
    if is_given(module) and is_finite_number(module) and module > 0:
        return float(module)
    if is_given(pitch) and is_finite_number(pitch) and pitch > 0:
        return module_of_pitch(float(pitch))
    return None


def equip(gear: Any) -> None:
    """Give a gear the rack, cutter or premachining of its tool, if it names one.

    A gear that has a tool already keeps its name as long as it has the parts of that tool. Raises InputError and SpecError.
    """
    name = gear.tool
    if name is None:
        return
    if isinstance(name, ToolName) and name.tool is not None:
        module = module_given(gear.normal_module, gear.normal_diametral_pitch)
        kept = all(getattr(gear, part) == made for part, made in name.tool.parts.items())
        if not kept or (module is not None and not name.tool.fits(module)):
            object.__setattr__(gear, "tool", None)
        return
    found = find_tool(name, module_given(gear.normal_module, gear.normal_diametral_pitch))
    assert found.tool is not None
    for part, made in found.tool.parts.items():
        given = getattr(gear, part)
        if given not in (made, PARTS[part]()):
            raise GeometryError(part, given, f'must be left out: the tool is given (tool = "{found}")')
        object.__setattr__(gear, part, made)
    object.__setattr__(gear, "tool", found)

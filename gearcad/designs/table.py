"""Design tables: one row a design; columns are the keys of a spec flattened with dots (`pinion.rack.root_radius`).

A table is read row by row, so that its length does not matter; every fault names row, column and key.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from gearcad.core.errors import GeometryError, ParameterError, SpecError, format_number, printable, shown, shown_path
from gearcad.core.records import Role
from gearcad.core.shelf_tables import ShelfName, column_letter
from gearcad.designs.cells import (
    CellReader,
    Layout,
    RawCell,
    is_blank,
    is_comment,
    kinds_of,
    plain_text,
    read_headings,
)
from gearcad.designs.design import (
    Design,
    is_inline,
    names_file,
    names_tool,
    require_plain_name,
    shelf_of,
    with_files_found,
)
from gearcad.designs.keys import FIELDS, MAIN_TABLES, OF_SETS, SHARED, Cell, DesignKind
from gearcad.designs.reader import design_from_values
from gearcad.designs.table_files import Record, RecordFile, open_sheet
from gearcad.designs.train_designs import missing_fault, missing_keys
from gearcad.designs.train_keys import ALL, TrainKey, general_key
from gearcad.geometry.gear_parts import MODULE_OR_PITCH
from gearcad.geometry.tool_shelf import Shelf
from gearcad.material_shelf import FILE as MATERIALS
from gearcad.material_shelf import text_of_material
from gearcad.shafts.bearing_shelf import text_of_bearing

Where = Callable[[str], str]

_REQUIRED: dict[str, Cell] = {"teeth": 20, "normal_module": 2.0, "face_width": 20.0, "height": 20.0}
"""Keys that a gear or a rack needs, where it has them, with values that are consistent."""

_TOOTHED = {
    kind: tuple(table for table in tables if table in FIELDS and table != "pair") for kind, tables in MAIN_TABLES.items()
}
_SOUND = {
    kind: {f"{owner}.{field}": value for field, value in _REQUIRED.items() for owner in owners if field in FIELDS[owner]}
    for kind, owners in _TOOTHED.items()
} | {DesignKind.SPLINE: {"spline.designation": "W 30 x 1.25 x 22 x 8f"}}

_TEETH = {"sun": 24, "planet": 21, "planet_2": 18, "sun_2": 27, "ring": -66, "ring_2": -63}
_SETS = {
    "planet_2": ("sun", "planet", "planet_2", "ring"),
    "sun_2": ("sun", "sun_2", "planet"),
    "ring_2": ("ring", "ring_2", "planet"),
}
"""The gears of a set that has the second of a kind."""

_RINGS: dict[str, dict[str, Cell]] = {
    owner: {f"{owner}.teeth": -70, f"{owner}.profile_shift": -0.3} for owner in ("gear", "wheel")
}
"""Values that make rings of these sound gears; diameters and centre distances are negative beside them."""


def _sound_set(owner: str) -> dict[str, Cell]:
    """Return the values of a set of planets among which those of a table are tried."""
    gears = _SETS.get(owner, ("sun", "planet", "ring"))
    train: dict[str, Cell] = {"planets": 3, "input": gears[0], "output": "carrier"}
    made = {f"{DesignKind.PLANETARY.value}.{field}": value for field, value in train.items()}
    for gear in gears:
        made |= {f"{gear}.{field}": _REQUIRED[field] for field in ("normal_module", "face_width")} | {
            f"{gear}.teeth": _TEETH[gear]
        }
    return made


def _sound_train(key: str, value: Cell) -> dict[str, Cell]:
    """Return the values of a train among which one is tried, on parts of its key's name."""
    found = TrainKey.of(key)
    name = "part" if found is None or found.name in ("", ALL) else found.name
    gear = f"other than {name}"
    teeth = len(value) if isinstance(value, tuple) else 20  # deviations are as many
    mesh: dict[str, Cell] = {"pinion": name, "wheel": gear, "base_radii": (50.0, 100.0), "stiffness": 500.0, "teeth": teeth}
    made: dict[str, Cell] = {f"inertia.{each}.inertia": 0.1 for each in (name, gear)}
    made |= {f"shaft.{name}.{field}": each for field, each in {"start": name, "end": "ground"}.items()}
    made[f"shaft.{name}.torsional_stiffness"] = 1e4
    made |= {f"mesh.{name}.{field}": each for field, each in mesh.items()}
    return made


def fault_alone(key: str, value: Cell, where: Where, *, of: DesignKind | None = None) -> SpecError | None:
    """Return the fault of a value that is wrong whatever the others are, or None. `where` locates a key for the message.

    `of` is the kind of design where it is a train or a planetary train.
    """
    if of is DesignKind.TRAIN:
        return _fault_in_train(key, value, where)
    owner, _, field = key.partition(".")
    kind = of or _home(key)
    others = (_sound_set(owner) if of else _SOUND[kind]) | ({"load.torque": 1.0} if owner == "load" else {})
    if owner in ("pair", DesignKind.PLANETARY.value):
        # What the gears have of their own would win.
        others = {other: given for other, given in others.items() if not other.endswith(f".{field}")}
    if field in MODULE_OR_PITCH:
        others = {other: given for other, given in others.items() if other.partition(".")[2] not in MODULE_OR_PITCH}
    for ring in ({}, *(rings for name, rings in _RINGS.items() if name == owner or (name == "wheel" and owner == "pair"))):
        error = _fault({**others, **ring, key: value}, kind, where)
        if error is None or error.key != key or isinstance(error.__cause__, GeometryError):
            return None
    return error


def _fault_in_train(key: str, value: Cell, where: Where) -> SpecError | None:
    """Return the fault of a value in a train that is wrong by itself, or None.

    Names of other parts are left to the check of the whole row.
    """
    found = TrainKey.of(key)
    if found is None or found.schema.members == (str,) or found.name == ALL:
        return None
    if inside := found.in_pair:
        of_pair = f"pair.{inside}" if inside in FIELDS["pair"] else inside
        error = fault_alone(of_pair, value, lambda _key: f"{where(key)}: {shown(found.name)}")
        return None if error is None else SpecError(str(error), key)
    sound = _sound_train(key, value)
    shaped = {other: given for other, given in sound.items() if not other.endswith(".torsional_stiffness")}
    shaped |= {f"shaft.{found.name or 'part'}.{field}": 1.0 for field in ("length", "diameter")}
    for rest in (sound, shaped):
        error = _fault({**rest, key: value}, DesignKind.TRAIN, where)
        if error is None or error.key != key or isinstance(error.__cause__, GeometryError):
            return None
    return error


def _home(key: str) -> DesignKind:
    """Return the kind of design among whose sound values a key is tried."""
    owner = key.partition(".")[0]
    if owner == "rack":
        return DesignKind.RACK
    if owner == "spline":
        return DesignKind.SPLINE
    if key in ("pair.mounting_distance", "material.rack"):
        return DesignKind.RACK_PAIR
    if key in (f"material.{role.value}" for role in Role):
        return DesignKind.PAIR
    return DesignKind.PAIR if owner in MAIN_TABLES[DesignKind.PAIR] else DesignKind.GEAR


@lru_cache(maxsize=4096, typed=True)
def permitted_alone(key: str, value: Cell, *, of: DesignKind | None = None) -> bool:
    """Return whether a value is not wrong by itself. The rows of a table share many of theirs."""
    return fault_alone(key, value, where=str, of=of) is None


def missing_faults(given: Collection[str], kind: DesignKind, where: Where) -> Iterator[SpecError]:
    """Yield the faults of values that are not among the keys `given`; what both gears may share is missed once."""
    if kind is DesignKind.TRAIN:
        yield from (missing_fault(key, where) for key in missing_keys(given))
        return
    if kind is DesignKind.PLANETARY:
        yield from _missing_of_set(given, where)
        return
    for field in _REQUIRED:
        fields = MODULE_OR_PITCH if field in MODULE_OR_PITCH else ("teeth", "length") if field == "teeth" else (field,)
        for owner in (each for each in _TOOTHED[kind] if f"{each}.{field}" in _SOUND[kind]):
            if not any(f"{table}.{each}" in given for each in fields for table in (owner, "pair")):
                yield from _fault_without(f"{owner}.{field}", _SOUND[kind], kind, where)
                if field in SHARED:
                    break
    if "load.torque" not in given and any(key.startswith("load.") for key in given):
        yield from _fault_without("load.torque", _SOUND[kind] | {"load.speed": 0.0}, kind, where)


def _missing_of_set(given: Collection[str], where: Where) -> Iterator[SpecError]:
    """Yield the faults of missing keys of a planetary train. Gears that its set lacks are reported where it is read."""
    kind, main = DesignKind.PLANETARY, DesignKind.PLANETARY.value
    for table in OF_SETS:
        if any(key.startswith(f"{table}.") for key in given) and f"{table}.teeth" not in given:
            yield from _fault_without(f"{table}.teeth", _sound_set(table), kind, where)
    for field in ("planets", "input", "output"):
        if f"{main}.{field}" not in given:
            yield from _fault_without(f"{main}.{field}", _sound_set(""), kind, where)


def _fault_without(key: str, values: Mapping[str, Cell], kind: DesignKind, where: Where) -> Iterator[SpecError]:
    error = _fault({other: value for other, value in values.items() if other != key}, kind, where)
    if error is not None:
        yield error


def _fault(values: Mapping[str, Cell], kind: DesignKind, where: Where) -> SpecError | None:
    try:
        design_from_values(values, kind, where=where, default_name="trial")
    except SpecError as error:
        return error
    return None


_LONGEST_SHOWN = 60
"""Largest number of characters of a name that a message repeats."""


@dataclass(frozen=True)
class DesignRow:
    """One design of a table: its values under their full keys, blank cells left out.

    `number` counts rows as a spreadsheet does. `faults` are whole messages about cells that could not be read, `unread` the
    keys of these; without keys it is the whole row that could not. `table` and `columns` (the keys by place, "" under a
    blank heading) locate a key in messages.
    """

    number: int
    name: str
    values: dict[str, Cell]
    faults: tuple[str, ...]
    unread: tuple[str, ...]
    table: str
    columns: tuple[str, ...]

    def where(self, key: str) -> str:
        """Return the place of a key for the beginning of a message: file, row, column if it has one, name of the design."""
        return _place(self.table, self.number, self._index(key), self.name)

    def design(self) -> Design:
        """Return the design. Raises SpecError for the first fault."""
        if self.faults:
            raise SpecError(self.faults[0], "".join(self.unread[:1]))
        self._require_name()
        values = with_files_found(self.values, Path(self.table).parent)
        return design_from_values(values, self._kind(), where=self.where, default_name=self.name)

    @property
    def inputs(self) -> dict[str, Any]:
        """Everything that decides what the row makes: its name and values, and the contents of the files that they name."""
        files = {key: each for key, each in self.values.items() if names_file(key) and not is_inline(each)}
        found = with_files_found(files, Path(self.table).parent)
        texts = {key: _text_of(Path(str(file))) for key, file in found.items()}
        shelf = Shelf(Path(self.table).parent)
        texts |= {key: shelf.text_of(str(each)) for key, each in self.values.items() if names_tool(key)}
        folder = Path(self.table).parent
        for key, each in self.values.items():
            if (table := shelf_of(key)) is not None:
                own = text_of_material if table == MATERIALS else text_of_bearing
                texts |= {key: text} if (text := own(ShelfName.of(str(each), folder))) else {}
        return {"name": self.name, **self.values, **{f"{key}: text": text for key, text in texts.items()}}

    def all_faults(self) -> list[str]:
        """Return every fault of the row that does not depend on another, from left to right; [] for a good row."""
        found = self.design_or_faults()
        return found if isinstance(found, list) else []

    def design_or_faults(self) -> Design | list[str]:
        """Return the design, or every fault of the row that does not depend on another, from left to right.

        They are the cells that cannot be read, or else what fails first in making the design; then every value that is
        wrong whatever the others are, and every one that is missing.
        """
        if self.faults and not self.unread:
            return list(self.faults)
        found = list(zip(self.unread, self.faults, strict=True))
        if not found:
            try:
                return self.design()
            except SpecError as error:
                found.append((error.key, str(error)))
        found += [(error.key, str(error)) for error in self._single_faults()]
        return [text for _, text in sorted(dict.fromkeys(found), key=lambda fault: self._index(fault[0]))]

    def _single_faults(self) -> Iterator[SpecError]:
        """Yield the faults of the name, of every value by itself, and of what is missing."""
        if "name" not in self.unread:
            try:
                self._require_name()
            except SpecError as error:
                yield error
        kinds = kinds_of(self.columns)
        if DesignKind.GEARBOX in kinds:
            return  # its values are those of the spec, and what the row changes
        of = next((kind for kind in (DesignKind.TRAIN, DesignKind.PLANETARY) if kind in kinds), None)
        for key, value in self.values.items():
            if names_tool(key):  # which depends on the folder and the module
                continue
            if not permitted_alone(key, value, of=of) and (fault := fault_alone(key, value, self.where, of=of)):
                yield fault
        try:
            kind = self._kind()
        except SpecError as error:
            yield error
        else:
            yield from missing_faults((*self.values, *self.unread), kind, self.where)

    def _require_name(self) -> None:
        try:
            require_plain_name(self.name)
        except ParameterError as error:
            raise SpecError(f"{self.where('name')}: {error}", "name") from error

    def _kind(self) -> DesignKind:
        """Return the kind that the table makes; if it has several, the kind of this row's values. Raises SpecError."""
        kinds = kinds_of(self.columns)
        if len(kinds) > 1:
            filled = (*self.values, *self.unread)
            kinds = kinds_of(filled)
            if len(kinds) > 1:
                raise self._of_two_kinds(filled, kinds)
            if not kinds:
                raise SpecError(f"{self.where('')}: makes nothing: every cell of gear, pair, pinion and wheel is blank")
        return next(iter(kinds), DesignKind.GEAR)

    def _of_two_kinds(self, filled: Sequence[str], kinds: Collection[DesignKind]) -> SpecError:
        """Return the fault of a row whose values are of several kinds."""
        other = "gear" if DesignKind.GEAR in kinds else "wheel" if DesignKind.PAIR in kinds else "pair"
        key = next(key for key in filled if not kinds_of([key]) & kinds_of([f"{other}."]))
        made = "a gear or a pair" if other == "gear" else "one with a wheel or with a rack"
        return SpecError(f"{self.where(key)}: {key}: cannot stand beside keys of {other}: a row makes {made}", key)

    def _index(self, key: str) -> int:
        """Place from 0 of the column with the key, else with what both gears or all parts of a train share; or -1."""
        owner, _, field = key.partition(".")
        homes = (key, f"pair.{field}" if owner in ("pinion", "wheel", "rack") else general_key(key))
        return next((self.columns.index(home) for home in homes if home and home in self.columns), -1)


@dataclass(frozen=True)
class Table:
    """A design table whose heading is in order; `columns` as in Row."""

    path: Path
    columns: tuple[str, ...]
    sheet: RecordFile

    @property
    def keys(self) -> tuple[str, ...]:
        """Full key of every column with a heading, in order; "name" is one."""
        return tuple(key for key in self.columns if key)

    def rows(self) -> Iterator[DesignRow]:
        """Yield the designs, from the first with every call. Raises SpecError where the file cannot be read on."""
        reader = CellReader(self.sheet.layout)
        with _readable(self.path):
            records = _filled(self.sheet)
            next(records, None)  # the heading
            for number, cells in records:
                yield self._row(number, cells, reader)

    def _row(self, number: int, cells: Sequence[RawCell], reader: CellReader) -> DesignRow:
        name = self._name(cells)
        values: dict[str, Cell] = {}
        faults: list[str] = []
        unread: list[str] = []
        for index, (key, cell) in enumerate(zip(self.columns, cells, strict=False)):
            if not key or cell is None or cell == "":
                continue
            try:
                value = reader.value(key, cell, number)
            except ParameterError as error:
                faults.append(f"{_place(str(self.path), number, index, name)}: {error}")
                unread.append(key)
                continue
            if value is not None and key != "name":
                values[key] = value
        if stray := self._stray(number, cells, name):
            # The cells may have moved: none can be trusted.
            values, faults, unread = {}, [stray], []
        return DesignRow(number, name, values, tuple(faults), tuple(unread), str(self.path), self.columns)

    def _name(self, cells: Sequence[RawCell]) -> str:
        index = self.columns.index("name")
        return plain_text(cells[index]) if index < len(cells) else ""

    def _stray(self, number: int, cells: Sequence[RawCell], name: str) -> str:
        """Return the fault of the first cell without a heading above it, or ""."""
        width = len(self.columns)
        for index, cell in enumerate(cells):
            if (index >= width or not self.columns[index]) and not is_blank(cell):
                hint = "; a decimal comma needs semicolons between the cells" if self.sheet.layout is Layout.COMMA else ""
                place = _place(str(self.path), number, index, name)
                return f"{place}: {format_number(plain_text(cell))}: has no heading above it{hint}"
        return ""


def open_table(path: Path | str) -> Table:
    """Return the design table in a CSV or .xlsx file. Raises SpecError with one line per fault of its heading."""
    path = Path(path)
    with _readable(path):
        sheet = open_sheet(path)
        heading = next(_filled(sheet), None)
    if heading is None:
        raise SpecError(f"{path}: has no heading; `gearcad new pairs` makes a table that has one")
    number, cells = heading
    return Table(path, read_headings(cells, f"{path} row {number}"), sheet)


def _text_of(file: Path) -> str:
    """Return the text of a file, or "" if it cannot be read; its reader reports that."""
    try:
        return file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        hint = "give a design table, or make one with `gearcad new pairs`"
        raise SpecError(f"{shown_path(path)}: cannot be read ({error.strerror or error}); {hint}") from error


def _filled(sheet: RecordFile) -> Iterator[Record]:
    """Yield the records that are neither blank nor a comment."""
    for number, cells in sheet.records():
        if not is_comment(cells) and not all(map(is_blank, cells)):
            yield number, cells


def _place(table: str, number: int, index: int, name: str) -> str:
    column = "" if index < 0 else f" column {column_letter(index)}"
    return f"{printable(table)} row {number}{column}{f' ({shown(name, _LONGEST_SHOWN)})' if name else ''}"

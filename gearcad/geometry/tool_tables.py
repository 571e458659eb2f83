"""Tables of tools, `tools.csv`: the tool that each row describes, and every fault with its row and column.

The columns are `name`, `normal_module` (mm; blank: every module), `source`, and the keys of a gear behind `rack.`, `cutter.` or
`premachining.`, with their units: a hob that finishes the teeth has the keys of its counterpart, the rack.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from gearcad.core.errors import GeometryError, InputError, ParameterError, SpecError, shown
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.core.shelf_tables import Place, ShelfTable, cell_value, column_letter, read_shelf_table, shelf_columns
from gearcad.geometry.gear_parts import BasicRack, NormalModule, ShaperCutter
from gearcad.geometry.premachining import Premachining

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

PARTS: Mapping[str, type[DataclassInstance]] = {"rack": BasicRack, "cutter": ShaperCutter, "premachining": Premachining}
"""Parts of a gear that a tool fills, and their types."""

FILE = "tools.csv"
"""Name of a table of tools in the folder of a design, and in that of the user's configuration."""

OWN_FILE = "tool_shelf.csv"
"""Name of the table of gearcad."""

SAME_MODULE = 1e-6
"""Share by which the modules of a tool and a gear may differ: digits of a diametral pitch."""

_PLAIN = ("name", "normal_module", "source")


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
        return self.normal_module is None or math.isclose(self.normal_module, module, rel_tol=SAME_MODULE)

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
"""Permitted range of a normal module."""


@dataclass(frozen=True)
class ToolRow:
    """A row of a table of tools as it is written; `number` counts rows as a spreadsheet does."""

    table: ShelfTable
    number: int
    name: str
    cells: tuple[str, ...]

    def where(self, column: int | None = None) -> str:
        """Return the place for the beginning of a message."""
        at = "" if column is None else f" column {column_letter(column)}"
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
        number = cell_value(text, self.table.separator)
        if not isinstance(number, float):
            return number
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


@lru_cache(maxsize=16)
def read_tools(path: Path, place: Place, _stamp: tuple[int, int]) -> tuple[ToolRow, ...]:
    """Return the rows of a table, which has this time and size. Raises SpecError."""
    table, rows = read_shelf_table(ShelfTable(path, place, OWN_FILE), _headings, "rack.dedendum")
    return tuple(ToolRow(table, *row) for row in rows)


def _headings(cells: Sequence[str], where: str) -> tuple[str, ...]:
    """Return the key of each column. Raises SpecError, one line for a heading that is none."""
    keys = ["normal_module" if cell.strip() == "module" else cell for cell in cells]
    otherwise = "must be name, normal_module, source, or a key such as rack.dedendum"
    return shelf_columns(keys, where, (*_PLAIN, *_columns()), otherwise=otherwise)

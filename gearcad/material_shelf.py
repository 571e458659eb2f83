"""Shelf of plastics, `materials.csv`: properties over temperature and load cycles, in the design's folder, the user's, or ours.

A row is one value: `name`, `quantity`, `temperature` (°C), `cycles`, `value`, `unit`, `source`. A blank temperature, or a blank
number of cycles, is a value for all of them. Between rows values are linear in temperature and in the logarithm of the cycles.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from gearcad.core.errors import SpecError, format_number, shown
from gearcad.core.runtime import templates
from gearcad.core.shelf_tables import Place, ShelfTable, cell_value, column_letter, read_shelf_table, shelf_columns, user_folder

FILE = "materials.csv"
"""Name of a table of materials in the folder of a design, and in that of the user's configuration."""

OWN_FILE = "material_shelf.csv"
"""Name of the table of gearcad."""

RECALLED = "recalled"
"""First word of the source of a value that rests on memory: it is shown, and decides nothing."""

_COLUMNS = ("name", "quantity", "temperature", "cycles", "value", "unit", "source")

UNITS: Mapping[str, str] = MappingProxyType(
    {
        "youngs_modulus": "MPa",
        "poisson_ratio": "",
        "density": "kg/m³",
        "yield_strength": "MPa",
        "contact_endurance_limit": "MPa",
        "root_endurance_limit": "MPa",
        "wear_coefficient": "mm³/(N·m)",
        "friction": "",
    }
)
"""Unit of each quantity that a table can have. All but the last are keys of a material."""

_SYMBOLS = {
    "E": "youngs_modulus",
    "nu": "poisson_ratio",
    "rho": "density",
    "sigma_S": "yield_strength",
    "sigma_Hlim": "contact_endurance_limit",
    "sigma_HlimN": "contact_endurance_limit",
    "sigma_Flim": "root_endurance_limit",
    "sigma_FlimN": "root_endurance_limit",
    "k_w": "wear_coefficient",
    "mu": "friction",
}
"""Symbols that may stand for a quantity."""

_SPELLINGS = {
    "mm3/(N m)": "mm³/(N·m)",
    "mm3/(N.m)": "mm³/(N·m)",
    "mm³/Nm": "mm³/(N·m)",
    "mm3/Nm": "mm³/(N·m)",
    "kg/m3": "kg/m³",
}
"""Other spellings of units."""


class SourcedValue(NamedTuple):
    """A value of a table and its source; None with the `reason` where the table has no such value."""

    value: float | None
    source: str = ""
    reason: str = ""

    @property
    def recalled(self) -> bool:
        """Whether the value rests on memory."""
        return self.source.casefold().startswith(RECALLED)


class _Point(NamedTuple):
    temperature: float | None
    cycles: float | None
    value: float
    source: str


@dataclass(frozen=True)
class PropertyTable:
    """Values of one `quantity` of a material over temperature (°C) and load cycles."""

    name: str
    quantity: str
    points: tuple[_Point, ...]

    @property
    def source(self) -> str:
        """Sources of the values, each once; those of memory first."""
        found = sorted(dict.fromkeys(each.source for each in self.points if each.source), key=_is_known)
        return "; ".join(found)

    @property
    def over_temperature(self) -> bool:
        """Whether the values hold at given temperatures only."""
        return self.points[0].temperature is not None

    def nearest(self, temperature: float) -> float:
        """Return the value of the fewest load cycles at the known temperature (°C) that is nearest to `temperature`."""

        def distance(point: _Point) -> tuple[float, float]:
            return abs((point.temperature or 0.0) - temperature), point.cycles or 0.0

        if not self.over_temperature:
            return self.points[0].value
        reading = self.at(temperature, min((each.cycles for each in self.points if each.cycles is not None), default=None))
        return min(self.points, key=distance).value if reading.value is None else reading.value

    def at(self, temperature: float | None, cycles: float | None = None) -> SourcedValue:
        """Return the value at a temperature (°C) and a number of load cycles; None stands for one that is not known."""
        temperatures = sorted({each.temperature for each in self.points if each.temperature is not None})
        if not temperatures:
            return self._along(self.points, cycles)
        if temperature is None:
            return self._missing(f"{self._named} goes by temperature, which is not known")
        if not temperatures[0] <= temperature <= temperatures[-1]:
            low, high = temperatures[0], temperatures[-1]
            return self._missing(f"{self._named} is known from {low:.4g} to {high:.4g} °C, and not at {temperature:.4g} °C")
        ends = [each for each in temperatures if each == temperature] or _around(temperatures, temperature)
        readings = [self._along([each for each in self.points if each.temperature == end], cycles) for end in ends]
        missing = next((each for each in readings if each.value is None), None)
        return missing or SourcedValue(_between(ends, [each.value or 0.0 for each in readings], temperature), self.source)

    def _along(self, points: Sequence[_Point], cycles: float | None) -> SourcedValue:
        """Return the value after so many load cycles, of points at one temperature."""
        if points[0].cycles is None:
            return SourcedValue(points[0].value, self.source)
        if cycles is None:
            return self._missing(f"{self._named} goes by load cycles, which are not known")
        known = sorted((math.log(each.cycles), each.value) for each in points if each.cycles is not None)
        places, place = [each[0] for each in known], math.log(cycles)
        slack = 1e-12 * abs(place)  # logarithms of the same number, however it was written
        if not places[0] - slack <= place <= places[-1] + slack:
            low, high = math.exp(places[0]), math.exp(places[-1])
            return self._missing(f"{self._named} is known from {low:.4g} to {high:.4g} load cycles, and not for {cycles:.4g}")
        values = dict(known)
        place = min(max(place, places[0]), places[-1])
        ends = [each for each in places if each == place] or _around(places, place)
        return SourcedValue(_between(ends, [values[each] for each in ends], place), self.source)

    @property
    def _named(self) -> str:
        return f"{self.quantity} of {self.name} in {FILE}"

    def _missing(self, reason: str) -> SourcedValue:
        return SourcedValue(None, self.source, reason)


def _is_known(source: str) -> bool:
    return not source.casefold().startswith(RECALLED)


def _around(places: Sequence[float], place: float) -> list[float]:
    """Return the two neighbours of a place that lies between the first and the last of `places`."""
    return next([low, high] for low, high in pairwise(places) if low <= place <= high)


def _between(ends: Sequence[float], values: Sequence[float], place: float) -> float:
    """Return the value at a place, which is the only end or lies between both."""
    if len(ends) == 1:
        return values[0]
    share = (place - ends[0]) / (ends[1] - ends[0])
    return values[0] + share * (values[1] - values[0])


_NOTHING: Mapping[str, PropertyTable] = MappingProxyType({})


def properties_of(name: str) -> Mapping[str, PropertyTable]:
    """Return the tables of a material by quantity; empty for a name of no table. Raises SpecError.

    `name` is a ShelfName where a design's own folder may have the table.
    """
    plain = " ".join(name.split())
    folder = getattr(name, "folder", Path())
    own = templates() / OWN_FILE
    for path, place in ((folder / FILE, Place.DESIGN), (user_folder() / FILE, Place.USER), (own, Place.OWN)):
        try:
            stamp = path.stat()
        except (OSError, ValueError):
            continue
        found = _materials(path, place, (stamp.st_mtime_ns, stamp.st_size)).get(plain)
        if found is not None:
            return found
    return _NOTHING


def text_of_material(name: str) -> str:
    """Return all that the tables have of a material as one text, by which a change is noticed; "" where they cannot be read."""
    try:
        return str({quantity: table.points for quantity, table in properties_of(name).items()} or "")
    except SpecError:
        return ""


@lru_cache(maxsize=16)
def _materials(path: Path, place: Place, _stamp: tuple[int, int]) -> Mapping[str, Mapping[str, PropertyTable]]:
    """Return the materials of a table, which has this time and size, by their names. Raises SpecError."""
    table, rows = read_shelf_table(ShelfTable(path, place, OWN_FILE), _headings, "quantity")
    found: dict[str, dict[str, list[_Point]]] = {}
    for number, name, cells in rows:
        here = f"{table.shown} row {number}"
        quantity, point = _point(table, dict(zip(table.columns, cells, strict=False)), here, name)
        points = found.setdefault(name, {}).setdefault(quantity, [])
        _require_alike(points, point, f"{here} ({shown(name, 60)}): {quantity}")
        points.append(point)
    return MappingProxyType(
        {
            name: MappingProxyType({key: PropertyTable(name, key, tuple(points)) for key, points in of.items()})
            for name, of in found.items()
        }
    )


def _point(table: ShelfTable, cells: Mapping[str, str], here: str, name: str) -> tuple[str, _Point]:
    """Return the quantity and the value of a row. Raises SpecError."""

    def place(column: str) -> str:
        return f"{here} column {column_letter(table.columns.index(column))} ({shown(name, 60)})"

    def number(column: str, *, required: bool = False, above: float = -math.inf) -> float | None:
        value = cell_value(cells.get(column, ""), table.separator)
        if value is None and not required:
            return None
        if not isinstance(value, float) or not math.isfinite(value) or value <= above:
            permitted = "must be a number" if above == -math.inf else "must be a number above 0"
            raise SpecError(f"{place(column)}: {column} = {format_number(value)}: {permitted}")
        return value

    word = cells.get("quantity", "").strip()
    quantity = _SYMBOLS.get(word, word)
    if quantity not in UNITS:
        near = difflib.get_close_matches(word, [*UNITS, *_SYMBOLS], n=1)
        hint = f"did you mean {near[0]}?" if near else f"permitted are {', '.join(UNITS)}"
        raise SpecError(f"{place('quantity')}: {shown(word)}: unknown quantity; {hint}")
    unit = cells.get("unit", "").strip()
    if _SPELLINGS.get(unit, unit) not in (UNITS[quantity], "" if UNITS[quantity] else "-"):
        raise SpecError(f"{place('unit')}: unit {shown(unit)}: must be {UNITS[quantity] or 'blank'} for {quantity}")
    value = number("value", required=True, above=0.0)
    source = " ".join(cells.get("source", "").split())
    return quantity, _Point(number("temperature"), number("cycles", above=0.0), value or 0.0, source)


def _require_alike(points: Sequence[_Point], point: _Point, where: str) -> None:
    """Raise SpecError for a value that is there already, or that differs from others in what it depends on."""
    for other in points:
        if (other.temperature is None) != (point.temperature is None) or (other.cycles is None) != (point.cycles is None):
            raise SpecError(f"{where}: must have temperature and cycles in all of its rows, or in none")
        if (other.temperature, other.cycles) == (point.temperature, point.cycles):
            raise SpecError(f"{where}: is there twice for the same temperature and cycles; keep one of them")


def _headings(cells: Sequence[str], where: str) -> tuple[str, ...]:
    """Return the key of each column. Raises SpecError, one line for a heading that is none or is not there."""
    return shelf_columns(cells, where, _COLUMNS, needed=("name", "quantity", "value", "unit"))

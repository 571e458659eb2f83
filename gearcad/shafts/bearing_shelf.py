"""Shelf of rolling bearings, `bearings.csv`: what a bearing of a name has, in the design's folder, the user's, or gearcad's.

The columns are the keys of a bearing that do not depend on its place: `name`, `kind`, sizes `d`, `D`, `B` (mm), ratings `C`,
`C0` (N), `f0`, `e`, `Y`, `Y1`, `Y2`, `C_u` (N), `pitch_diameter` (mm), stiffnesses, and `source`. A spec counts first.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gearcad.core.errors import InputError, SpecError, shown
from gearcad.core.runtime import templates
from gearcad.core.shelf_tables import Place, ShelfTable, cell_value, column_letter, read_shelf_table, shelf_columns, user_folder
from gearcad.shafts.beam import ShaftBearing

FILE = "bearings.csv"
"""Name of a table of bearings in the folder of a design, and in that of the user's configuration."""

OWN_FILE = "bearing_shelf.csv"
"""Name of the table of gearcad."""

_COLUMNS = (
    *("name", "kind", "d", "D", "B", "C", "C0", "f0", "e", "Y", "Y1", "Y2", "C_u", "pitch_diameter"),
    *("radial_stiffness", "axial_stiffness", "tilting_stiffness", "source"),
)

_NOTHING: Mapping[str, Any] = MappingProxyType({})


def bearing_of(name: str) -> Mapping[str, Any]:
    """Return what the bearing of a name has, under the keys of a spec; empty for a name of no table. Raises SpecError."""
    plain = " ".join(name.split())
    for path, place in _places(getattr(name, "folder", Path())):
        try:
            stamp = path.stat()
        except (OSError, ValueError):
            continue
        found = _bearings(path, place, (stamp.st_mtime_ns, stamp.st_size)).get(plain)
        if found is not None:
            return found
    return _NOTHING


def text_of_bearing(name: str) -> str:
    """Return what a bearing has as one text, by which a change is noticed; "" where its table cannot be read."""
    try:
        return str(dict(bearing_of(name)))
    except SpecError:
        return ""


def _places(folder: Path) -> tuple[tuple[Path, Place], ...]:
    """Return the tables in the order in which a name is looked for, be they there or not."""
    return (folder / FILE, Place.DESIGN), (user_folder() / FILE, Place.USER), (templates() / OWN_FILE, Place.OWN)


@lru_cache(maxsize=16)
def _bearings(path: Path, place: Place, _stamp: tuple[int, int]) -> Mapping[str, Mapping[str, Any]]:
    """Return the bearings of a table, which has this time and size, by their names. Raises SpecError."""
    table, rows = read_shelf_table(ShelfTable(path, place, OWN_FILE), _headings, "pitch_diameter")
    found: dict[str, Mapping[str, Any]] = {}
    for number, name, cells in rows:
        values: dict[str, Any] = {}
        for key, cell in zip(table.columns, cells, strict=False):
            value = cell_value(cell, table.separator)
            if key and value is not None and key not in ("name", "source"):
                values[key] = value
        try:
            ShaftBearing(position=0.0, **values)
        except InputError as error:
            at = table.columns.index(error.parameter) if error.parameter in table.columns else 0
            raise SpecError(f"{table.shown} row {number} column {column_letter(at)} ({shown(name, 60)}): {error}") from error
        if name in found:
            raise SpecError(f"{table.shown} row {number} ({shown(name, 60)}): is there twice; keep one of them")
        found[name] = MappingProxyType(values)
    return MappingProxyType(found)


def _headings(cells: Sequence[str], where: str) -> tuple[str, ...]:
    """Return the key of each column. Raises SpecError, one line for a heading that is none."""
    return shelf_columns(cells, where, _COLUMNS)

"""Which keys a spec may have, and what to say about one that it may not."""

from __future__ import annotations

import difflib
from dataclasses import fields

from gearcad import symbols
from gearcad.check.options import CheckOptions
from gearcad.dynamics.options import DynamicsOptions
from gearcad.geometry import BasicRack, Body, FlankModification, Gear
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating.options import RatingOptions

__all__ = [
    "COLUMNS",
    "KEYS",
    "LISTS",
    "PARTS",
    "SHARED",
    "WHOLE_FIELDS",
    "Cell",
    "explain_unknown_column",
    "explain_unknown_key",
    "explain_unknown_table",
    "nearest_table",
]

Cell = int | float | str | tuple[float, ...]
"""What a spec and a cell of a design table can both hold."""

WHOLE_FIELDS = ("teeth", "body_teeth", "positions", "speeds", "harmonics", "frequencies", "accuracy_grade", "seed")
"""Fields that are whole numbers; elsewhere 2 means 2.0."""

PARTS = ("rack", "body", "modification")
"""Fields of a gear that have fields of their own."""

_RACK = ("rack", *(f"rack.{field.name}" for field in fields(BasicRack)))
_BODY = tuple(f"body.{field.name}" for field in fields(Body))
_MODIFICATION = tuple(f"modification.{field.name}" for field in fields(FlankModification))
_PARTS = (*_RACK, *_BODY, *_MODIFICATION)
_GEAR = (*(field.name for field in fields(Gear) if field.name not in PARTS), *_PARTS)

SHARED = ("normal_module", "helix_angle", "face_width", "tip_alteration", "tooth_thinning", *_PARTS)
"""Keys of a gear that may stand in [pair] for both; the helix angle there is the pinion's."""

KEYS = {
    "gear": _GEAR,
    "pair": ("name", "centre_distance", "axial_offset", "profile_shift_split", *SHARED),
    "pinion": _GEAR,
    "wheel": _GEAR,
    "material": tuple(field.name for field in fields(Material)),
    "load": tuple(field.name for field in fields(Load)),
    "mounting": tuple(field.name for field in fields(Mounting)),
    "check": tuple(field.name for field in fields(CheckOptions)),
    "dynamics": tuple(field.name for field in fields(DynamicsOptions)),
    "rating": tuple(field.name for field in fields(RatingOptions)),
}
"""Permitted keys of each table, flattened with dots. `rack` alone is the name of a rack."""

LISTS = ("material.contact_limit", "material.root_limit", "check.torques")
"""Keys that may hold several numbers; in a cell there is space between them."""

_MOVED = {
    "check.pinion_tip_relief": "write pinion.modification.tip_relief and pinion.modification.tip_relief_length (mm)",
    "check.wheel_tip_relief": "write wheel.modification.tip_relief and wheel.modification.tip_relief_length (mm)",
    "check.tip_relief_length": "write modification.tip_relief_length of pair, pinion or wheel, in mm and not in modules",
}
"""Where keys of earlier specs went."""

_NO_COLUMN = (("gear", "name"), ("pair", "name"))

COLUMNS = {table: tuple(field for field in fields if (table, field) not in _NO_COLUMN) for table, fields in KEYS.items()}
"""The same for the columns of a design table, where the design's own name has a column `name`."""


def explain_unknown_table(table: str) -> str:
    """The end of the message about a table that is not one of ours."""
    if near := difflib.get_close_matches(table, KEYS, n=1):
        return f"unknown table; did you mean [{near[0]}]?"
    return f"unknown table; permitted are {', '.join(f'[{name}]' for name in KEYS)}"


def explain_unknown_key(table: str, key: str) -> str:
    """The end of the message about a key that `table` does not have: where it belongs, or the nearest one."""
    if (moved := _MOVED.get(f"{table}.{key}")) is not None:
        return f"is no key any more: {moved}"
    homes = [f"[{name}]" for name, keys in KEYS.items() if key in keys and name != "gear"]
    if homes and table != "gear":
        return f"unknown key here; it belongs in {' or '.join(homes)}"
    known = KEYS[table]
    if (near := _nearest(key, known)) is not None:
        return f"unknown key; did you mean {near}?"
    return f"unknown key; permitted are {', '.join(known)}"


def _nearest(key: str, known: tuple[str, ...]) -> str | None:
    """The known key whose symbol, last word or spelling is nearest."""
    entries = symbols.GEAR | symbols.PAIR | symbols.MATERIAL | symbols.LOAD | symbols.MOUNTING | symbols.RATING_OPTIONS
    by_symbol = {entries[name].symbol: name for name in known if name in entries and entries[name].symbol}
    by_tail = {name.rpartition(".")[2]: name for name in reversed(known)}
    if key in by_symbol:
        return by_symbol[key]
    for spellings in (by_tail, {name: name for name in known}):
        if near := difflib.get_close_matches(key.lower(), spellings, n=1):
            return spellings[near[0]]
    return None


def nearest_table(name: str) -> str | None:
    """The table that was meant by `name`, if any."""
    near = difflib.get_close_matches(name.lower(), KEYS, n=1, cutoff=0.75)
    return near[0] if near else None


def explain_unknown_column(heading: str, main: str) -> str:
    """The end of the message about a heading of a design table that is no key; bare keys are those of the table `main`."""
    if heading.lower() == "name":
        return "unknown column; did you mean name?"
    if (moved := _MOVED.get(heading)) is not None:
        return f"is no column any more: {moved}"
    first, dot, rest = heading.partition(".")
    table = nearest_table(first) if dot else None
    owner, field = (table, rest) if table else (main, heading)
    # A pair has no [gear]; a table with nothing but bare keys may have been meant for pairs.
    owners = [owner, *(name for name in COLUMNS if name != owner and (name != "gear" or main == "gear"))]
    for meant in (field, *(_nearest(field, COLUMNS[name]) for name in owners)):
        if homes := [f"{name}.{meant}" for name in owners if meant in COLUMNS[name]]:
            found = homes[:1] if homes[0].startswith(f"{owner}.") else homes
            return f"unknown column; did you mean {' or '.join(found)}?"
    if table:
        return f"unknown column; permitted behind {table}. are {', '.join(COLUMNS[table])}"
    examples = "gear.teeth" if main == "gear" else "pair.normal_module, pinion.teeth"
    return f"unknown column; must be name, or a key of a spec with its table, such as {examples} or load.torque"

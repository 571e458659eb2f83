"""What the columns of a table of results hold: symbol, unit and words, for columns.csv and the axes of pictures."""

from __future__ import annotations

from collections.abc import Mapping

from gearcad import symbols
from gearcad.designs.keys import FIELDS, Fields
from gearcad.designs.planetary_keys import PLANETARY
from gearcad.designs.train_keys import ALL, PARTS, TrainKey
from gearcad.drawing.options import PartDrawing
from gearcad.material import Material
from gearcad.per_gear import Role
from gearcad.planetary import Carrier, Central, PairStage, Rim
from gearcad.schema import schema_of, symbols_of
from gearcad.symbols import Symbol

__all__ = ["column_of_train", "column_symbol"]

_STATES = {
    "name": Symbol("", "", "", "name of the design, and of its folder"),
    "status": Symbol("", "", "", "how the row ended: ok, failed or not run"),
    "error": Symbol("", "", "", "why it failed"),
    "warnings": Symbol("", "", "", "what to know before making this"),
    "seconds": Symbol("", "s", "", "time to make the row"),
}


def _symbols(tables: Fields) -> dict[str, dict[str, Symbol]]:
    return {table: {key: field.symbol for key, field in fields.items()} for table, fields in tables.items()}


_INPUTS = _symbols(FIELDS)

_COMPUTED = {
    "gear": symbols.GEAR,
    "pinion": symbols.GEAR,
    "wheel": symbols.GEAR,
    "rack": symbols.RACK,
    "pair": symbols.PAIR | symbols.RACK_PAIR,
    "drive": symbols.DRIVE,
    "check": symbols.CHECK,
    "check.rating": symbols.RATING,
    "check.rating.pinion": symbols.GEAR_RATING,
    "check.rating.wheel": symbols.GEAR_RATING,
    "check.rating.wheel.formula": symbols.RING_FORMULA,
    "draw": symbols.DRAW,
    "rate": symbols.STRENGTH_FIGURES,
    "stiffness": symbols.STIFFNESS,
    "dynamics": symbols.DYNAMICS,
    "mesh": symbols.MESH,
    "modify": symbols.MODIFY,
    "modify.before": symbols.MODIFY_FIGURES,
    "modify.after": symbols.MODIFY_FIGURES,
    "modify.pinion": _INPUTS["pinion"],
    "modify.wheel": _INPUTS["wheel"],
    "": _STATES,
}

_TABLES = _COMPUTED | {table: inputs | _COMPUTED.get(table, {}) for table, inputs in _INPUTS.items()}
"""By the beginning of the heading."""

_OF_TRAINS = _symbols(PLANETARY)
_OF_TRAINS["planetary"] |= symbols.PLANETARY

_MEMBER = {key: field.symbol for kind in (Central, Rim, Carrier) for key, field in schema_of(kind).items()}
_STAGE = {key: field.symbol for key, field in schema_of(PairStage).items()}
_NAMED_OF_TRAINS = {
    "meshes": _COMPUTED["pair"] | _INPUTS["pair"],
    "stages": _COMPUTED["pair"] | _INPUTS["pair"] | _STAGE,
    "members": _MEMBER | symbols.PLANETARY_MEMBER,
}
"""What stands under the name of a mesh, stage or member."""

_NAMED = ("stiffness",)
"""Tables whose quantities stand under a name each: `stiffness.iso6336.mean`."""

_ALL_PARTS = {"inertia": "all inertias", "shaft": "all shafts", "mesh": "all meshes"}

_OWNERS = tuple(role.value for role in Role)


def column_of_train(heading: str) -> tuple[str, Symbol] | None:
    """The same in a table of planetary trains: whose it is by the name of its gear, mesh or stage."""
    table, _, field = heading.partition(".")
    kind, _, named = field.partition(".")
    if table == "planetary" and kind in _NAMED_OF_TRAINS:
        owner, _, of = named.rpartition(".") if kind == "members" else named.partition(".")
        return _found(owner, of, _NAMED_OF_TRAINS[kind])
    if table == "planetary" and kind == "mesh_stiffness":
        return named, symbols.STIFFNESS["mean"]
    if table in _OF_TRAINS and (found := _found("", field, _OF_TRAINS[table])):
        return found
    if table in _TABLES and table not in ("gear", "pinion", "wheel", "pair", "rack"):
        return column_symbol(heading)
    return _of_own(heading) or _found(table, field, _TABLES["gear"])


def _found(owner: str, field: str, known: Mapping[str, Symbol]) -> tuple[str, Symbol] | None:
    return (owner, known[field]) if field in known else None


def column_symbol(heading: str) -> tuple[str, Symbol] | None:
    """Whose the quantity of a column of results is ("pinion", "wheel", the name of a train's part, or ""), and how it is
    written; None for an unknown one.

    Columns are `pinion.tip_diameter`, `pair.tip_clearances.wheel`, `check.root_tension_pinion`, `check.rating.wheel.Y_F` or
    `shaft.input.length`.
    """
    for table, known in _TABLES.items():
        if table and not heading.startswith(f"{table}."):
            continue
        field = heading[len(table) + 1 :] if table else heading
        field = field.partition(".")[2] if table in _NAMED else field
        if field in known:
            return next((owner for owner in _OWNERS if owner in table.split(".")), ""), known[field]
        for owner in _OWNERS:
            name = field[: -len(owner) - 1]
            if field.endswith((f".{owner}", f"_{owner}")) and name in known:
                return owner, known[name]
    return _of_own(heading) or _of_part(heading)


def _of_own(heading: str) -> tuple[str, Symbol] | None:
    """Of gears that have materials or drawings of their own."""
    table, _, rest = heading.partition(".")
    owner, _, field = rest.partition(".")
    own = {"materials": Material, "drawings": PartDrawing}.get(table)
    return None if own is None else _found(owner, field, symbols_of(own))


def _of_part(heading: str) -> tuple[str, Symbol] | None:
    """Of a train: whose it is by the name of its part."""
    table, _, rest = heading.partition(".")
    if table == "train" and rest in symbols.TRAIN:
        return "", symbols.TRAIN[rest]
    if table == "dynamics":
        key, _, name = rest.partition(".")
        return (name, symbols.TRAIN_DYNAMICS[key]) if name and key in symbols.TRAIN_DYNAMICS else None
    if (found := TrainKey.of(heading)) is not None:
        return _ALL_PARTS[table] if found.name == ALL else found.name, found.schema.symbol
    name, _, key = rest.rpartition(".")
    return (name, symbols.TRAIN_PARTS[table][key]) if table in PARTS and key in symbols.TRAIN_PARTS[table] else None

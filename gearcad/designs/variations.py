"""Variations of a spec for studies: `KEY=VALUES`, every combination, and symbol, unit and words of result columns."""

from __future__ import annotations

import itertools
import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from gearcad.core import symbols
from gearcad.core.errors import ParameterError, SpecError, format_number
from gearcad.core.quantities import schema_of, symbols_of
from gearcad.core.records import Role
from gearcad.core.symbols import Symbol
from gearcad.designs.cells import CellReader, Layout, nested_text, texts_cell
from gearcad.designs.design import Design, Where, inline_toml, names_file, read_tables, with_files_found
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.designs.keys import FIELDS, KEYS, MAIN_TABLES, SPEEDS, Cell, DesignKind, Fields
from gearcad.designs.reader import design_from_values, kind_of, refuse_gearbox, type_of
from gearcad.designs.shaft_keys import (
    explain_unknown_item,
    is_of_list,
    is_of_shaft_alone,
    shaft_field,
    shaft_values,
)
from gearcad.designs.spec import Given, Spec
from gearcad.designs.train_designs import names_of, values_of
from gearcad.designs.train_keys import (
    ALL,
    COUNTS,
    LISTS,
    MAIN,
    NESTED,
    PLANETARY,
    SWITCHES,
    TEXT_LISTS,
    TEXTS,
    TORQUES,
    TRAIN_PARTS,
    TrainKey,
    explain_unknown_column,
    explain_unknown_key_of_train,
    general_key,
)
from gearcad.drawing.options import PartDrawing
from gearcad.geometry.gear_parts import MODULE_OR_PITCH
from gearcad.material import Material
from gearcad.planetary import Carrier, Central, PairStage, Rim

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


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
    "check": symbols.CHECK | symbols.CHECK_COLUMNS,
    "check.rating": symbols.RATING,
    "check.rating.pinion": symbols.GEAR_RATING,
    "check.rating.wheel": symbols.GEAR_RATING,
    "check.rating.wheel.formula": symbols.RING_FORMULA,
    "draw": symbols.DRAW,
    "rate": symbols.STRENGTH_FIGURES,
    "shaft": symbols.SHAFT,
    "shafts.pinion": symbols.SHAFT,
    "shafts.wheel": symbols.SHAFT,
    "shafts": symbols.SHAFTS,
    "stiffness": symbols.STIFFNESS,
    "dynamics": symbols.DYNAMICS,
    "mesh": symbols.MESH,
    "modify": symbols.MODIFY,
    "modify.before": symbols.MODIFY_FIGURES,
    "modify.after": symbols.MODIFY_FIGURES,
    "modify.shafts": symbols.MODIFY_ON_SHAFTS,
    "modify.pinion": _INPUTS["pinion"],
    "modify.wheel": _INPUTS["wheel"],
    "": _STATES,
}

_TABLES = _COMPUTED | {table: inputs | _COMPUTED.get(table, {}) for table, inputs in _INPUTS.items()}
"""Symbols by the beginning of the heading."""

_OF_TRAINS = _symbols(PLANETARY)
_OF_TRAINS["planetary"] |= symbols.PLANETARY

_MEMBER = {key: field.symbol for kind in (Central, Rim, Carrier) for key, field in schema_of(kind).items()}
_STAGE = {key: field.symbol for key, field in schema_of(PairStage).items()}
_NAMED_OF_TRAINS = {
    "meshes": _COMPUTED["pair"] | _INPUTS["pair"],
    "stages": _COMPUTED["pair"] | _INPUTS["pair"] | _STAGE,
    "members": _MEMBER | symbols.PLANETARY_MEMBER,
}
"""Symbols under the name of a mesh, stage or member."""

_NAMED = ("stiffness",)
"""Tables whose quantities stand under a name each: `stiffness.iso6336.mean`."""

_ALL_PARTS = {"inertia": "all inertias", "shaft": "all shafts", "mesh": "all meshes", "excitation": "all excitations"}

_OWNERS = tuple(role.value for role in Role)


MESHES = "meshes"
"""Part of a train's data.json that has the documents of its pairs."""


def column_of_train(heading: str) -> tuple[str, Symbol] | None:
    """Return the owner and the symbol of a column in a table of planetary trains, or None for an unknown one.

    The owner is the name of a gear, mesh or stage.
    """
    table, _, field = heading.partition(".")
    kind, _, named = field.partition(".")
    if table == "planetary" and kind in _NAMED_OF_TRAINS:
        owner, _, of = named.rpartition(".") if kind == "members" else named.partition(".")
        return _known_symbol(owner, of, _NAMED_OF_TRAINS[kind])
    if table == "planetary" and kind == "mesh_stiffness":
        return named, symbols.STIFFNESS["mean"]
    if table in _OF_TRAINS and (found := _known_symbol("", field, _OF_TRAINS[table])):
        return found
    if table in _TABLES and table not in ("gear", "pinion", "wheel", "pair", "rack"):
        return column_symbol(heading)
    return _of_own(heading) or _known_symbol(table, field, _TABLES["gear"])


def _known_symbol(owner: str, field: str, known: Mapping[str, Symbol]) -> tuple[str, Symbol] | None:
    return (owner, known[field]) if field in known else None


def column_symbol(heading: str) -> tuple[str, Symbol] | None:
    """Return the owner and the symbol of a result column, or None for an unknown one.

    The owner is "pinion", "wheel", the name of a train's part, or "".

    Columns are `pinion.tip_diameter`, `pair.tip_clearances.wheel`, `check.root_tension_pinion`, `check.rating.wheel.Y_F`,
    `shaft.input.length` or, of the pair of a train's mesh, `meshes.stage 1.pinion.tip_diameter` and `rate.stage 1.S_H.pinion`.
    """
    return _of_pair(heading) or _of_mesh(heading)


def _of_mesh(heading: str) -> tuple[str, Symbol] | None:
    """Return owner and symbol of a column about the pair of a train's mesh, or None; the owner begins with the mesh's name."""
    table, *parts = heading.split(".")
    before = [] if table == MESHES else [table]
    for end in range(1, len(parts)):  # a name may have points
        if (found := _of_pair(".".join([*before, *parts[end:]]))) is not None:
            return " ".join(filter(None, (".".join(parts[:end]), found[0]))), found[1]
    return None


def _of_pair(heading: str) -> tuple[str, Symbol] | None:
    """Return owner and symbol of a column that is not about the pair of a train's mesh, or None."""
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
    if (own := shaft_field(heading)) is not None:
        return next((owner for owner in _OWNERS if heading.startswith(f"{owner}.")), ""), own.symbol
    return _of_own(heading) or _of_part(heading)


def _of_own(heading: str) -> tuple[str, Symbol] | None:
    """Return owner and symbol of a column about a gear's own material or drawing, or None."""
    table, _, rest = heading.partition(".")
    owner, _, field = rest.partition(".")
    own = {"materials": Material, "drawings": PartDrawing}.get(table)
    return None if own is None else _known_symbol(owner, field, symbols_of(own))


def _of_part(heading: str) -> tuple[str, Symbol] | None:
    """Return owner and symbol of a column about a train, or None; the owner is the name of its part."""
    table, _, rest = heading.partition(".")
    if table == "train" and rest in symbols.TRAIN:
        return "", symbols.TRAIN[rest]
    if table == "dynamics":
        key, _, name = rest.partition(".")
        return (name, symbols.TRAIN_DYNAMICS[key]) if name and key in symbols.TRAIN_DYNAMICS else None
    if (found := TrainKey.of(heading)) is not None:
        gear = next((f" {owner}" for owner in _OWNERS if found.in_pair.startswith(f"{owner}.")), "")
        return (_ALL_PARTS[table] if found.name == ALL else found.name) + gear, found.schema.symbol
    name, _, key = rest.rpartition(".")
    return (name, symbols.TRAIN_PARTS[table][key]) if table in TRAIN_PARTS and key in symbols.TRAIN_PARTS[table] else None


class SpecValues(NamedTuple):
    """The content of a spec: kind, name, and its other values under their keys, each with the key that the user wrote."""

    kind: DesignKind
    name: str
    values: dict[str, Given]
    where: Where


def read_values(path: Path | str) -> SpecValues:
    """Return the values of a spec, which need not make a design. Raises SpecError."""
    tables, where = read_tables(path)
    refuse_gearbox(tables, where)
    kind = kind_of(tables)
    made, main = type_of(kind), MAIN_TABLES[kind][0]
    if kind is DesignKind.TRAIN and "shafts" in tables:
        raise SpecError(f"{where('shafts')}: [shafts]: no table holds the options of a train's shafts", "shafts")
    if kind is DesignKind.SHAFT:
        spec = Spec({}, where)
    else:
        spec = made.spec(tables, where) if issubclass(made, ToothedDesign) else Spec(values_of(tables, where), where)
    name = spec.name(main, Path(path).stem)
    spec.values.update({key: Given(value, key) for key, value in shaft_values(tables)})
    return SpecValues(kind, name, {key: given for key, given in spec.values.items() if key != f"{main}.name"}, where)


def spec_values(path: Path | str) -> tuple[DesignKind, str, dict[str, Cell]]:
    """Kind and name of a spec, and its other values under their dotted keys as a design table holds them: "auto" is a text.

    The values need not make a gear. Raises SpecError, for a value that no cell can hold too.
    """
    kind, name, values, where = read_values(path)
    listed = next((key for key in values if "[" in key), None) if kind is DesignKind.PLANETARY else None
    if listed is not None:
        raise SpecError(f"{where(listed)}: {listed}: no table holds lists of tables", listed)
    return kind, name, {key: _cell(key, given, where) for key, given in values.items()}


def _cell(key: str, given: Given, where: Where) -> Cell:
    """Return a value as a cell can hold it."""
    value = given.value
    if general_key(key) in LISTS and isinstance(value, list | tuple) and all(type(item) in (int, float) for item in value):
        return tuple(float(item) for item in value)
    if key == "train.model" and isinstance(value, tuple):
        raise SpecError(
            f"{where(key)}: {key} = {format_number(value)}: no cell of a table holds several models: give one word", key
        )
    if isinstance(value, Mapping) and names_file(key):
        return inline_toml(value)
    if general_key(key) in NESTED and isinstance(value, list | tuple):
        return nested_text(value) if all(isinstance(each, list | tuple) for each in value) else format_number(value)
    if key in TEXT_LISTS and isinstance(value, list | tuple):
        try:
            return texts_cell(value, key)
        except ParameterError as error:
            raise SpecError(f"{where(given.key)}: {error}", key) from error
    if isinstance(value, date):
        return value.isoformat()
    if isinstance(value, bool) and general_key(key) in SWITCHES:
        return "true" if value else "false"
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise SpecError(f"{where(given.key)}: {given.key} = {format_number(value)}: must be a number or a text")
    return value


MOST_ROWS = 1_000_000
"""Rows of the largest study: beyond it a number was mistyped, or one table is not the way."""

_BESIDE = {
    DesignKind.GEAR: ("material", "load", "drawing", "verify"),
    DesignKind.RACK: ("material", "drawing", "verify"),
    DesignKind.RACK_PAIR: ("material", "load", "check", "mesh", "dynamics", "rating", "drawing", "verify"),
    DesignKind.SPLINE: ("material", "load", "drawing", "mesh", "verify"),
}
"""Tables beside those of the teeth whose keys may vary; a pair has all others."""

_SIZES_OF_RACKS = ("teeth", "length")
"""Fields for the size of a rack, of which one is given."""

_INSTEAD = {
    ("mesh", "damping"): ("damping_ratio",),
    ("mesh", "damping_ratio"): ("damping",),
    ("mesh", "pair"): ("base_radii", "teeth", "internal", "stiffness", "variation", "shape", "contact_ratio"),
    ("shaft", "torsional_stiffness"): ("length", "diameter", "inner_diameter"),
    ("excitation", "file"): ("order", "amplitude", "phase"),
}
"""Keys that a part of a train loses when another key of it varies."""

_MOST_SHOWN = 6
"""Largest number of values of a wrong list that a message repeats."""


Value = TypeVar("Value")


@dataclass(frozen=True)
class Choices:
    """A key that takes one of several values; `text` gives them as the user wrote them."""

    key: str
    text: str
    values: tuple[Cell, ...]

    def at(self, fractions: NDArray[np.float64]) -> list[Cell]:
        """Return the values at fractions 0 ... 1 of the list."""
        return [self.values[int(fraction * len(self.values))] for fraction in fractions]

    def found_from(self, folder: Path) -> Choices:
        """Return the choices with file names that are relative to the `folder` of the spec made valid from here."""
        return replace(self, values=tuple(with_files_found({self.key: each}, folder)[self.key] for each in self.values))


@dataclass(frozen=True)
class KeyRange:
    """A key that takes any value between two ends, or any whole one."""

    key: str
    text: str
    first: float
    last: float
    whole: bool

    def at(self, fractions: NDArray[np.float64]) -> list[Cell]:
        """Return the values at fractions 0 ... 1 of the way from the first to the last; as likely the one as the other."""
        low, high = sorted((self.first, self.last))
        if self.whole:
            return [int(low) + int(fraction * (high - low + 1)) for fraction in fractions]
        return [float(low + fraction * (high - low)) for fraction in fractions]

    def found_from(self, _folder: Path) -> KeyRange:
        """Numbers are no files."""
        return self


def read_variations(
    texts: Sequence[str], kind: DesignKind, base: Collection[str], *, sampled: bool = False
) -> tuple[Choices | KeyRange, ...]:
    """Return the variations that several texts `KEY=VALUES` describe. Raises ParameterError, also if a key is varied twice.

    `base` holds the keys that the spec of the design has.
    """
    read = tuple(read_variation(text, kind, base, sampled=sampled) for text in texts)
    keys = [variation.key for variation in read]
    for text, key in zip(texts, keys, strict=True):
        if keys.count(key) > 1:
            raise ParameterError("vary", text, f"{key} is varied more than once; put all its values in one --vary")
    return read


def read_variation(text: str, kind: DesignKind, base: Collection[str] = (), *, sampled: bool) -> Choices | KeyRange:
    """Return the variation that one text `KEY=VALUES` describes. Raises ParameterError.

    The keys `base` of its spec say which parts a train has.
    """
    name, _, values = (part.strip() for part in _parted(text, kind, base))
    if not name or not values:
        raise ParameterError("vary", text, "must be KEY=FIRST:LAST:COUNT or KEY=VALUE,VALUE ...")
    key = _key_of_train(text, name, base) if kind is DesignKind.TRAIN else _full_key(text, name, kind)
    if ":" not in values or "," in values or general_key(key) in TEXTS:
        return _choices(text, key, values, _listed(text, key, values))
    first, last, count = _ends(text, key, values, counted=not sampled)
    if not sampled:
        return _choices(text, key, values, _spaced(text, first, last, count))
    _require_whole(text, key, (first, last))
    return KeyRange(key, values, first, last, whole=general_key(key) in COUNTS)


def _parted(text: str, kind: DesignKind, base: Collection[str]) -> tuple[str, str, str]:
    """Key and values; the names of a train's parts may have = in them."""
    if kind is DesignKind.TRAIN:
        for place in (place for place, sign in enumerate(text) if sign == "="):
            key = _known_to_train(text[:place].strip(), base)
            if key is not None:
                return key, "=", text[place + 1 :]
    return text.partition("=")


def _known_to_train(name: str, base: Collection[str]) -> str | None:
    """Return the full key of a train with these keys; None for a key that it does not have."""
    names = names_of(base)
    for key in (name, f"{MAIN}.{name}"):
        found = TrainKey.of(key)
        if found is None:
            continue
        if found.table in TRAIN_PARTS and (
            not names[found.table] if found.name == ALL else found.name not in names[found.table]
        ):
            continue
        if found.field != TORQUES or found.name in names["inertia"]:
            return key
    return None


def _key_of_train(text: str, name: str, base: Collection[str]) -> str:
    """Return the key of a train; one without a table belongs to [train]."""
    key = _known_to_train(name, base)
    if key is not None:
        return key
    if name in ("name", f"{MAIN}.name"):
        raise ParameterError("vary", text, "the study numbers the names itself; vary another key")
    raise ParameterError("vary", text, explain_unknown_key_of_train(name, names_of(base)))


def _full_key(text: str, name: str, kind: DesignKind) -> str:
    """Return the key with its table; one without belongs to [pair] or [gear]."""
    main = MAIN_TABLES[kind][0]
    if kind is DesignKind.PLANETARY:
        return _key_of_planetary(text, name)
    if is_of_list(name) or (kind in (DesignKind.PAIR, DesignKind.SHAFT) and shaft_field(name) is not None):
        return _key_of_shafts(text, name, kind)
    if kind is DesignKind.SHAFT:
        raise ParameterError("vary", text, "unknown key; must be one of a shaft, such as shaft[0].length or shafts.speed")
    table, _, field = (main, "", name) if name in KEYS[main] else name.partition(".")
    if field not in KEYS.get(table, ()):
        raise ParameterError("vary", text, explain_unknown_column(name, main))
    beside = _BESIDE.get(kind, tuple(owner for owner in KEYS if owner not in ("gear", "rack", "spline")))
    permitted = [owner for owner in KEYS if owner in (*MAIN_TABLES[kind], *beside)]
    if table not in permitted:
        tables = ", ".join(f"[{owner}]" for owner in permitted)
        raise ParameterError("vary", text, f"the spec makes a {main}; permitted are keys of {tables}")
    if (table, field) == (main, "name"):
        raise ParameterError("vary", text, "the study numbers the names itself; vary another key")
    return f"{table}.{field}"


def _key_of_shafts(text: str, name: str, kind: DesignKind) -> str:
    """Return a key of shafts of a pair, or of a shaft by itself. Raises ParameterError."""
    if shaft_field(name) is None:
        raise ParameterError("vary", text, explain_unknown_item(name))
    alone = kind is DesignKind.SHAFT
    if (is_of_list(name) and is_of_shaft_alone(name) is not alone) or kind not in (DesignKind.PAIR, DesignKind.SHAFT):
        permitted = "shaft[0].length" if alone else "pinion.shaft[0].length" if kind is DesignKind.PAIR else "its own"
        raise ParameterError("vary", text, f"the spec makes a {kind.words}; permitted are keys such as {permitted}")
    return name


def _key_of_planetary(text: str, name: str) -> str:
    """Return the key of a planetary train; one without a table belongs to [planetary]."""
    main = DesignKind.PLANETARY.value
    key = name if name.partition(".")[0] in PLANETARY else f"{main}.{name}"
    table, _, field = key.partition(".")
    if field not in PLANETARY[table] and not (table == main and field.startswith(f"{SPEEDS}.")):
        raise ParameterError("vary", text, explain_unknown_column(name, main))
    if key == f"{main}.name":
        raise ParameterError("vary", text, "the study numbers the names itself; vary another key")
    return key


def _value(key: str, text: str) -> Cell:
    """Return the value of a cell with this text; "" for a blank one. Adding 0.0 turns -0.0 into a plain zero."""
    value = CellReader(Layout.COMMA).value(key, text, 0)
    return "" if value is None else value + 0.0 if isinstance(value, float) else value


def _ends(text: str, key: str, values: str, *, counted: bool) -> tuple[float, float, str]:
    """Return the two ends of a span, and the text of the count ("" where there must be none)."""
    parts = [part.strip() for part in values.split(":")]
    ends = [value for part in parts[:2] if isinstance(value := _value(key, part), int | float)]
    if len(ends) < 2 or len(parts) != (3 if counted else 2):
        permitted = (
            "must be FIRST:LAST:COUNT in numbers" if counted else "must be FIRST:LAST in numbers; --n says how many rows"
        )
        raise ParameterError("vary", text, permitted)
    if ends[0] == ends[1]:
        raise ParameterError("vary", text, f"must not have the same number at both ends; for one value write {parts[0]}")
    return ends[0], ends[1], parts[2] if counted else ""


def _spaced(text: str, first: float, last: float, count: str) -> list[Cell]:
    """Evenly spaced values, each the nearest to the true one: 0.1 and not 0.09999999999999998."""
    number = int(count) if re.fullmatch("[0-9]{1,7}", count) else 0
    if not 2 <= number <= MOST_ROWS:
        raise ParameterError("vary", text, f"must have a whole number from 2 to {MOST_ROWS} as its count")
    start, end = Fraction(repr(first)), Fraction(repr(last))
    exact = (start + (end - start) * step / (number - 1) for step in range(number))
    return [int(value) if isinstance(first, int) and value.denominator == 1 else float(value) for value in exact]


def _listed(text: str, key: str, values: str) -> list[Cell]:
    items = [item.strip() for item in values.split(",")]
    if "" in items:
        raise ParameterError("vary", text, "must have a value on both sides of a comma")
    return [_value(key, item) for item in items]


def _choices(text: str, key: str, words: str, values: list[Cell]) -> Choices:
    _require_whole(text, key, values)
    value, times = Counter(values).most_common(1)[0]
    if times > 1:
        raise ParameterError("vary", text, f"must have each value once; {format_number(value)} is there {times} times")
    return Choices(key, words, tuple(values))


def _require_whole(text: str, key: str, values: Sequence[Cell]) -> None:
    if general_key(key) in COUNTS and not all(isinstance(value, int) for value in values):
        shown = ", ".join(map(format_number, values[:_MOST_SHOWN])) + (" ..." if len(values) > _MOST_SHOWN else "")
        raise ParameterError("vary", text, f"must make whole numbers of {key}, not {shown}")


# ---------------------------------------------------------------------- what gives way


def without_varied(base: Mapping[str, Value], varied: Collection[str]) -> dict[str, Value]:
    """Return the values of a spec that stand beside keys that vary: not those in whose place these are."""
    return {key: value for key, value in base.items() if not _replaced(key, varied)}


def _replaced(key: str, varied: Collection[str]) -> bool:
    """Return whether a varied key replaces this one: a module and a diametral pitch replace each other, and so do the teeth and
    the length of a rack.

    What a part of a train has of its own gives way to what varies for all parts.
    """
    table, _, field = key.partition(".")
    if table == "rack" and field in _SIZES_OF_RACKS:
        return any(f"rack.{other}" in varied for other in _SIZES_OF_RACKS)
    if field in MODULE_OR_PITCH:
        return any(f"{table}.{other}" in varied for other in MODULE_OR_PITCH)
    part = TrainKey.of(key) if table in TRAIN_PARTS else None
    if part is None or not part.name:
        return False
    instead = [part._replace(field=other) for (home, other), gone in _INSTEAD.items() if home == table and part.field in gone]
    return part.general in varied or any(each.general in varied or str(each) in varied for each in instead)


MOST_VARIANTS = 12
"""Largest number of curves in one chart."""

_MODEL = "train.model"

VariantValue = Cell | tuple[Cell, ...]
"""Value of a key that varies; for models, several in one tuple."""


@dataclass(frozen=True)
class Variants:
    """Designs that differ in `what`, in words with units.

    `labels` has one entry for each design: the value of the one `key`, or words if `key` is "".
    """

    what: str
    labels: tuple[str, ...]
    designs: tuple[Design, ...]
    key: str = ""


def read_variants(spec: Path | str, variations: Sequence[str]) -> Variants:
    """Return the designs of a spec (TOML) with keys varied as texts such as "shaft.*.damping_ratio=0.01,0.1" say.

    A key with one value is only set. Several models of a train, and nothing else, are those of one design: a list of models.
    Raises SpecError for the spec and for what makes no design, ParameterError for a variation and for more than MOST_VARIANTS.
    """
    base = read_values(spec)
    read = [each for each in read_variations(variations, base.kind, base.values) if isinstance(each, Choices)]
    _require_few(read)
    found = [each.found_from(Path(spec).parent) for each in read]
    several = [each for each in found if len(each.values) > 1]
    if base.kind is DesignKind.TRAIN and [each.key for each in several] == [_MODEL]:
        one = {each.key: each.values if each.key == _MODEL else each.values[0] for each in found}
        return Variants(_words(_MODEL), (several[0].text,), (_design(base, one),))
    points = [
        dict(zip((each.key for each in found), point, strict=True))
        for point in itertools.product(*(each.values for each in found))
    ]
    names = _short([each.key for each in several])
    labels = [_label({names[key]: point[key] for key in names}) for point in points]
    what = ", ".join(_words(key) for key in names)
    key = several[0].key if len(several) == 1 else ""
    return Variants(what, tuple(labels), tuple(_design(base, point) for point in points), key)


def _require_few(read: Sequence[Choices]) -> None:
    count = math.prod(len(each.values) for each in read)
    if count > MOST_VARIANTS:
        permitted = f"make {count} curves, and one chart can bear {MOST_VARIANTS}: take fewer, or a table of `gearcad study`"
        raise ParameterError("vary", ", ".join(each.key for each in read), permitted)


def _design(base: SpecValues, point: Mapping[str, VariantValue]) -> Design:
    """Return the design of the spec with the values of a point put in."""
    values = {key: given.value for key, given in without_varied(base.values, point).items()} | dict(point)
    return design_from_values(values, base.kind, where=_where(base, point), default_name=base.name)


def _where(base: SpecValues, point: Mapping[str, VariantValue]) -> Callable[[str], str]:
    """Return a function that says in words the value of a key that varies, or where another key stands in the spec."""

    def where(key: str) -> str:
        for each in (key, general_key(key)):
            if each in point:
                value = point[each]
                return f"--vary {each}={_text(value) if isinstance(value, int | float | str) else ','.join(map(str, value))}"
        return base.where(base.values[key].key if key in base.values else key)

    return where


def _words(key: str) -> str:
    """Return words for a key: the quantity, its owner and its unit. An unknown key is returned unchanged."""
    found = column_symbol(key)
    if found is None or not found[1].words:
        return key
    owner, symbol = ("" if f".{ALL}." in key else found[0]), found[1]
    return f"{symbol.words}{f' of {owner}' if owner else ''}{f' in {symbol.unit}' if symbol.unit else ''}"


def _short(keys: Sequence[str]) -> dict[str, str]:
    """Return short names of several keys: their last words if these all differ, otherwise the full keys."""
    last = [key.rpartition(".")[2].replace("_", " ") for key in keys]
    alike = len(set(last)) < len(last)
    return {key: key if alike else words for key, words in zip(keys, last, strict=True)}


def _label(values: Mapping[str, Cell]) -> str:
    if len(values) == 1:
        return _text(*values.values())
    return ", ".join(f"{name} {_text(value)}" for name, value in values.items())


def _text(value: Cell) -> str:
    """Return a value as a user would type it, to its last digit."""
    if isinstance(value, tuple):
        return " ".join(map(_text, value))
    shown = format_number(value) if isinstance(value, int | float) else value
    return repr(value) if isinstance(value, float) and float(shown) != value else shown

"""Designs of trains: `[train]` with its lists of inertias, shafts and meshes, and the pairs of its meshes."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from gearcad.check.options import CheckOptions
from gearcad.core.errors import InputError, ParameterError, SpecError, as_choice, format_number, printable, shown
from gearcad.core.quantities import ELSEWHERE, FieldSchema, parts_of, schema_of, with_assumed
from gearcad.core.records import JsonObject, Notice, Role
from gearcad.designs.design import (
    Design,
    Where,
    inline_table,
    is_inline,
    kinds_in_words,
    read_tables,
    require_plain_name,
)
from gearcad.designs.keys import BESIDE, MAIN_TABLES, OF_SETS, DesignKind, permitted_words
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.pair_keys import with_pair_value
from gearcad.designs.spec import Given
from gearcad.designs.torque_files import read_torque
from gearcad.designs.train_keys import ALL, MAIN, TORQUES, TRAIN, TRAIN_PARTS, TrainKey, explain_unknown_key_of_train
from gearcad.designs.train_shafts import LAYOUT_KEYS, read_layout, read_shaft_options, require_faces
from gearcad.dynamics.options import OF_PAIRS, OF_TRAINS_OF_PAIRS, DynamicsOptions
from gearcad.dynamics.trains.members import BESIDE_PAIR, MeshPair, Shaft, ToothMesh
from gearcad.dynamics.trains.solid_inertias import solid_notices
from gearcad.dynamics.trains.torque_excitation import TorqueExcitation
from gearcad.dynamics.trains.train import Train, TrainModel, train_document
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating.options import RatingOptions
from gearcad.shafts.arrangement import ShaftOptions

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


_SWITCH = {"true": True, "false": False}


class TrainTables(NamedTuple):
    """Tables as a spec of a train has them, and under what key each of the lists' tables stands: `train.shaft[0]` is
    `shaft.input`."""

    tables: dict[str, Any]
    names: dict[str, str]


# ---------------------------------------------------------------------- from a spec


def values_of(tables: Mapping[str, Any], where: Where) -> dict[str, Given]:
    """Return the values of a spec under the keys of tables, each with the key under which it is written; that of `train.name`
    too.

    They need not make a train. Raises SpecError for what is unknown, and for parts that no key can name.
    """
    main, found = _table(tables.get(MAIN, {}), MAIN, where), dict[str, Given]()
    for key, value in main.items():
        if key == TORQUES:
            for name, torque in _table(value, f"{MAIN}.{TORQUES}", where).items():
                found |= _value(TrainKey(MAIN, _spelt(name, f"{MAIN}.{TORQUES}.{name}", where), TORQUES), torque, None, where)
        elif key == "name":
            found["train.name"] = Given(value, "train.name")
        elif key not in TRAIN_PARTS:
            found |= _value(TrainKey(MAIN, "", key), value, None, where)
    for table in TRAIN_PARTS:
        for name, owner, content in _parts(main, table, where):
            if table == "shaft" and (layout := {key: content[key] for key in LAYOUT_KEYS if key in content}):
                content = {**{key: each for key, each in content.items() if key not in layout}, "layout": layout}
            for key, value in content.items():
                found |= _value(TrainKey(table, name, key), value, f"{owner}.{key}", where) if key != "name" else {}
    for key, value in _table(tables.get("dynamics", {}), "dynamics", where).items():
        inner = _table(value, f"dynamics.{key}", where) if key in parts_of(DynamicsOptions) else None
        each = {key: value} if inner is None else {f"{key}.{name}": its for name, its in inner.items()}
        for name, its in each.items():
            found |= _value(TrainKey("dynamics", "", name), its, None, where)
    return found


def _table(content: Any, key: str, where: Where) -> Mapping[str, Any]:
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {key} = {format_number(content)}: must be a table", key)
    return content


def _parts(main: Mapping[str, Any], table: str, where: Where) -> Iterator[tuple[str, str, Mapping[str, Any]]]:
    """Name, written key and content of each part of a kind."""
    listed = main.get(table, [])
    if not isinstance(listed, list):
        raise SpecError(f"{where(f'{MAIN}.{table}')}: {MAIN}.{table}: must be headed [[{MAIN}.{table}]], once for each")
    taken: set[str] = set()
    for number, each in enumerate(listed):
        owner = f"{MAIN}.{table}[{number}]"
        content = _table(each, owner, where)
        if "name" not in content:
            raise SpecError(f"{where(owner)}: name is missing in [[{MAIN}.{table}]]", owner)
        name = _spelt(content["name"], f"{owner}.name", where)
        if name in taken:
            raise SpecError(f"{where(f'{owner}.name')}: {shown(f'{owner}.name')} = {shown(name)!r}: names must differ", owner)
        taken.add(name)
        yield name, owner, content


def _spelt(name: Any, key: str, where: Where) -> str:
    """Return a name that the heading of a column can hold."""
    if not isinstance(name, str) or not name or name != name.strip() or not name.isprintable() or name == ALL:
        permitted = f"must be a text without space around it, and not {ALL}, which stands for all, to be the name of columns"
        raise SpecError(f"{where(key)}: {shown(key)} = {format_number(name)}: {permitted}", key)
    return name


def _value(key: TrainKey, value: Any, written: str | None, where: Where) -> dict[str, Given]:
    written = str(key) if written is None else written
    if key.field != TORQUES and key.field not in TRAIN[key.table]:
        unknown = explain_unknown_key_of_train(f"{key.table}.{key.field}" if not key.name else f"{key.table}.*.{key.field}")
        raise SpecError(f"{where(written)}: {shown(written)}: {unknown}", written)
    return {str(key): Given(_plain(value, key.schema), written)}


def _plain(value: Any, field: FieldSchema) -> Any:
    """Whole numbers as floats where floats are meant, in lists too."""
    if isinstance(value, list):
        return tuple(_plain(each, field) for each in value)
    if isinstance(value, int) and not isinstance(value, bool) and not field.whole:
        return float(value)
    return value + 0.0 if isinstance(value, float) else value


def names_of(keys: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Return the names of the parts of each kind, in their order."""
    found: dict[str, dict[str, None]] = {table: {} for table in TRAIN_PARTS}
    for key in filter(None, map(TrainKey.of, keys)):
        if key.table in TRAIN_PARTS and key.name != ALL:
            found[key.table][key.name] = None
    return {table: tuple(names) for table, names in found.items()}


# ---------------------------------------------------------------------- to a spec


def tables_of(values: Mapping[str, Any], where: Where) -> TrainTables:
    """Return the tables that values under their keys make. Raises SpecError for a value of all parts of a kind that is not
    there.
    """
    keys = {key: TrainKey.of(key) for key in values}
    names = names_of(values)
    main: dict[str, Any] = {}
    parts: dict[tuple[str, str], dict[str, Any]] = {(t, name): {"name": name} for t in TRAIN_PARTS for name in names[t]}
    other: dict[str, Any] = {}
    inside: list[tuple[str, str, TrainKey]] = []  # keys in the pairs of meshes, which come when the pairs are there
    # Those of all parts first: what a part has of its own replaces them.
    for key, found in sorted(keys.items(), key=lambda each: each[1] is not None and each[1].name != ALL):
        assert found is not None  # headings and studies have seen to it
        if found.field == TORQUES:
            main.setdefault(TORQUES, {})[found.name] = values[key]
        elif not found.name:
            owner, *part = found.field.split(".")
            content = main if found.table == MAIN else other
            (content.setdefault(owner, {}) if part else content)[part[0] if part else owner] = _typed(values[key], found.schema)
        else:
            chosen = names[found.table] if found.name == ALL else (found.name,)
            if not chosen:
                raise SpecError(f"{where(key)}: {key}: the train has no {found.table} at all", key)
            for name in chosen:
                if found.in_pair:
                    inside.append((key, name, found))
                else:
                    parts[found.table, name][found.field] = _part_value(key, values[key], found.schema, where)
    for key, name, found in inside:
        with_pair_value(parts[found.table, name], found.in_pair, _typed(values[key], found.schema), key, where)
    for table in TRAIN_PARTS:
        main[table] = [part for (home, _), part in parts.items() if home == table]
    owners = {f"{MAIN}.{t}[{number}]": f"{t}.{name}" for t in TRAIN_PARTS for number, name in enumerate(names[t])}
    return TrainTables({MAIN: main, "dynamics": other}, owners)


def _part_value(key: str, value: Any, field: FieldSchema, where: Where) -> Any:
    """Return the value of a part as a spec has it; a pair or a layout may stand in one line of TOML. Raises SpecError."""
    if ELSEWHERE not in field.marks or not is_inline(value):
        return _typed(value, field)
    try:
        return inline_table(key, value)
    except ParameterError as error:
        raise SpecError(f"{where(key)}: {error}", key) from error


def _typed(value: Any, field: FieldSchema) -> Any:
    """Return a cell's value as a spec has it: one number of a list as such, and true and false, which spreadsheets shout."""
    if field.members == (bool,) and isinstance(value, str):
        return _SWITCH.get(value.lower(), value)
    return (value,) if field.several and isinstance(value, float) else value


def missing_keys(given: Iterable[str]) -> Iterator[str]:
    """Yield the keys that parts must have but that are not among `given`."""
    fields: dict[tuple[str, str], set[str]] = {}
    for key in map(TrainKey.of, given):
        if key is not None and key.table in TRAIN_PARTS:
            fields.setdefault((key.table, key.name), set()).add(key.field)
    for (table, name), own in fields.items():
        there = own | fields.get((table, ALL), set())
        yield from (f"{table}.{name}.{field}" for field, each in TRAIN[table].items() if name != ALL and each.needed(there))


def missing_fault(key: str, where: Where) -> SpecError:
    """Return the SpecError for a missing key of a part."""
    return SpecError(f"{where(key)}: {shown(key)} is missing: must be given", key)


_GEARS = tuple(role.value for role in Role)

_OTHER_KINDS = {
    **dict.fromkeys(("train",), DesignKind.TRAIN.words),
    **dict.fromkeys(("planetary", *OF_SETS), DesignKind.PLANETARY.words),
    **dict.fromkeys(("rack",), DesignKind.RACK_PAIR.words),
    **dict.fromkeys(("gear",), DesignKind.GEAR.words),
}
"""Tables that a spec of a pair does not have, and the kinds of designs that have them."""


@dataclass(frozen=True, kw_only=True)
class DesignedPair(MeshPair):
    """Pair of a mesh, with the `design` that it belongs to."""

    design: PairDesign


def designed_pair(design: PairDesign) -> DesignedPair:
    """Return the pair of a design with its material, mounting, bodies and rating. Raises GeometryError for double helical
    gears.
    """
    return DesignedPair(
        design=design,
        pair=design.pair,
        material=design.material or Material(),
        mounting=design.mounting or Mounting(),
        body=(design.check or CheckOptions()).body,
        rating=design.rating or RatingOptions(),
        load=design.load,
    )


def read_pair(given: Any, where: Where, owner: str, mesh: str) -> DesignedPair:
    """Return the pair of a mesh from the value of its key `pair`: the name of a spec, or its tables. Raises SpecError.

    `owner` is the key as written in the spec, `mesh` the name of the mesh for messages.
    """
    if not isinstance(given, str | Mapping) or (isinstance(given, str) and (not given.strip() or "\0" in given)):
        permitted = 'must be the file of a pair\'s spec, as in pair = "fzg-c.toml", or its tables, headed [train.mesh.pair]'
        raise SpecError(f"{where(owner)}: {mesh}.pair = {format_number(given)}: {permitted}", owner)
    try:
        if isinstance(given, str):
            found = designed_pair(_of_file(Path(given)))
        else:
            found = designed_pair(_of_tables(given, _Inside(where, owner, mesh), mesh))
        found.mounted  # noqa: B018 - raises where the gears do not mesh as they are mounted
    except SpecError as error:
        if not isinstance(given, str):
            inside = error.key.removeprefix("pair.")
            raise SpecError(str(error), f"{owner}.{inside}" if inside else owner) from error.__cause__ or error
        raise SpecError(f"{where(owner)}: {mesh}.pair: {error}", owner) from error
    except InputError as error:
        file = f" {printable(given)}:" if isinstance(given, str) else ""
        raise SpecError(f"{where(owner)}: {mesh}.pair:{file} {error}", owner) from error
    return found


def _of_file(path: Path) -> PairDesign:
    tables, where = read_tables(path)
    if (other := next((table for table in tables if table in _OTHER_KINDS), None)) is not None:
        raise SpecError(
            f"{where(other)}: is the spec of a {_OTHER_KINDS[other]}; a mesh needs the spec of a pair of gears", other
        )
    return PairDesign.read(tables, where, path.stem)


@dataclass(frozen=True)
class _Inside:
    """Locator of the keys of a pair's tables inside those of a mesh."""

    where: Where
    owner: str
    mesh: str

    def __call__(self, key: str) -> str:
        written = key.removeprefix("pair.")
        return f"{self.where(f'{self.owner}.{written}')}: {self.mesh}"


def _of_tables(given: Mapping[str, Any], where: _Inside, mesh: str) -> PairDesign:
    """Return the pair of a mesh from its tables; keys outside of these tables are those of [pair]."""
    for gear in _GEARS:
        if gear not in given:
            raise SpecError(
                f"{where(gear)}: [train.mesh.pair.{gear}] is missing: a pair needs both gears, {' and '.join(_GEARS)}"
            )
    tables = {table: given[table] for table in (*_GEARS, *BESIDE) if table in given}
    shared = {key: value for key, value in given.items() if key not in tables}
    return PairDesign.read({MAIN_TABLES[DesignKind.PAIR][0]: shared, **tables}, where, plain_name(mesh))


def plain_name(text: str) -> str:
    """Return a name for files that is near to any text."""
    cleaned = "".join(each if each.isalnum() or each in " ._-+()" else "-" for each in text[:60]).strip(" .-")
    try:
        require_plain_name(cleaned)
    except ParameterError:
        return "pair"
    return cleaned


_TOLD_BY_PAIR = ("base_radii", "teeth", "internal", "stiffness", "variation", "shape", "contact_ratio")
"""Keys of a mesh that its pair has in their place."""

_NEVER_PART = "off"
"""Value of a backlash for flanks that stay together under any load."""

_LISTS = {"inertia": "inertias", "shaft": "shafts", "mesh": "meshes", "excitation": "excitations"}


@dataclass(frozen=True, kw_only=True)
class TrainDesign(Design):
    """A train of shafts and meshes, with the options for the study of its dynamics."""

    kind: ClassVar[DesignKind] = DesignKind.TRAIN
    elsewhere: ClassVar[str] = "a train is for `gearcad dynamics` and `gearcad data`"

    train: Train
    other_models: tuple[TrainModel, ...] = ()
    """Models that are studied beside the train's own."""
    dynamics: DynamicsOptions = field(default=DynamicsOptions())
    shafts: ShaftOptions = field(default=ShaftOptions())
    """Options of its shafts with segments."""

    def __post_init__(self) -> None:
        super().__post_init__()
        require_faces(self.train)
        others = tuple(as_choice("model", each, TrainModel) for each in self.other_models)
        object.__setattr__(self, "other_models", others)
        twice = next((each for number, each in enumerate(self.models) if each in self.models[:number]), None)
        if twice is not None:
            raise ParameterError("model", twice, "stands twice in the list: models side by side must differ")
        if others and not self.train.meshes:
            listed = ", ".join(each.value for each in self.models)
            permitted = "must be one model for a train without meshes: there is no load over speed to compare"
            raise ParameterError("model", listed, permitted)

    @property
    def models(self) -> tuple[TrainModel, ...]:
        """Models to study, with that of `train` first."""
        return (self.train.model, *self.other_models)

    @classmethod
    def read(
        cls, tables: Mapping[str, Any], where: Where, default_name: str, names: Mapping[str, str] = MappingProxyType({})
    ) -> Self:
        """Return the design that [train] describes; only [dynamics] and [shafts] may stand beside it. Raises SpecError.

        `names` holds the user's names for the tables of lists.
        """
        for table in tables:
            if table not in ("train", "dynamics", "shafts"):
                permitted = "permitted are [dynamics] and [shafts]"
                raise SpecError(f"{where(table)}: [{shown(table)}] cannot stand beside [train]: {permitted}")
        reader = _Reader(where, names)
        train, others = reader.train(tables["train"], default_name)
        dynamics = reader.dynamics(tables.get("dynamics", {}), train)
        shafts = read_shaft_options(tables.get("shafts", {}), where)
        with reader.blame("train"):
            return cls(name=train.name, train=train, other_models=others, dynamics=dynamics, shafts=shafts)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of the designs of the pairs, each with the name of its mesh, and of inertias that are from solids."""
        designed = ((mesh.name, mesh.pair.design) for mesh in self.train.meshes if isinstance(mesh.pair, DesignedPair))
        of_pairs = (notice.within(name) for name, design in designed for notice in design.notices)
        return (*solid_notices(self.train.inertias, self.train.meshes), *of_pairs)

    def require_kind(self, *kinds: DesignKind, why: str) -> None:
        """Raise ParameterError unless it is of one of these kinds: jobs of pairs take the specs of its pairs."""
        if self.kind not in kinds and any(mesh.pair is not None for mesh in self.train.meshes):
            pairs = "`gearcad dynamics` writes the specs of the pairs of its meshes for that, under their loads"
            raise ParameterError("kind", self.kind.words, f"must be {kinds_in_words(kinds)}: {pairs}")
        super().require_kind(*kinds, why=why)

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`: the train and its parts, each kind under its table, and the options."""
        options = {
            key: value
            for key, value in asdict(self.dynamics).items()
            if key in TRAIN["dynamics"] or (value is not None and key in parts_of(DynamicsOptions))
        }
        document = super().to_dict() | train_document(self.train) | {"dynamics": options}
        if any(shaft.layout is not None for shaft in self.train.shafts):
            document["shafts"] = asdict(self.shafts)
        if self.other_models:
            document["train"]["model"] = [each.value for each in self.models]
        return with_assumed(document)


@dataclass(frozen=True)
class _Reader:
    where: Where
    names: Mapping[str, str]

    def train(self, content: Any, default_name: str) -> tuple[Train, tuple[TrainModel, ...]]:
        """Return the train of [train] and its parts, and the models beside its own."""
        given = self._table(content, "train", (*schema_of(Train), *_LISTS))
        for plural in _LISTS.values():
            if plural in given:
                single = next(key for key, name in _LISTS.items() if name == plural)
                raise SpecError(f"{self.where(f'train.{plural}')}: train.{plural}: write one [[train.{single}]] for each")
        parts: dict[str, Any] = {plural: self._parts(given.pop(key, []), key) for key, plural in _LISTS.items()}
        name = given.pop("name", default_name)
        given["torques"] = self._torques(given.pop("torques", {}))
        with self.blame("train"):
            require_plain_name(name)
            models = _models(given.get("model"))
            if models:
                given["model"] = models[0]
            train = Train(name=name, **_numbers(Train, given), **parts)
            for model in models[1:]:
                replace(train, model=model)  # whether the train can be of this model, too
            return train, models[1:]

    def dynamics(self, content: Any, train: Train) -> DynamicsOptions:
        """Return the options of [dynamics]: some are of trains only whose meshes are those of pairs."""
        also = {OF_TRAINS_OF_PAIRS} if any(mesh.pair is not None for mesh in train.meshes) else set[str]()
        schema = schema_of(DynamicsOptions)
        permitted = tuple(key for key, field in schema.items() if OF_PAIRS not in field.marks or also & {*field.marks})
        chosen = self._table(content, "dynamics", permitted)
        for name, part in parts_of(DynamicsOptions).items():
            if name in chosen:
                owner = f"dynamics.{name}"
                given = self._table(chosen[name], owner, tuple(schema_of(part)))
                with self.blame(owner):
                    chosen[name] = part(**_numbers(part, given))
        with self.blame("dynamics"):
            return DynamicsOptions(**_numbers(DynamicsOptions, chosen))

    def _parts(self, listed: Any, key: str) -> tuple[Any, ...]:
        """Return the inertias, shafts, meshes or excitations of a train."""
        if not isinstance(listed, list):
            raise SpecError(f"{self.where(f'train.{key}')}: train.{key}: must be headed [[train.{key}]], once for each")
        kind, found = TRAIN_PARTS[key], []
        schema = schema_of(kind)
        for number, each in enumerate(listed):
            owner = f"train.{key}[{number}]"
            given = self._table(each, owner, (*schema, *(LAYOUT_KEYS if kind is Shaft else ())))
            if kind is ToothMesh:
                self._read_pair(given, owner)
            if kind is Shaft:
                read_layout(given, self.where, owner)
            if kind is TorqueExcitation and "file" in given:
                given["file"] = read_torque(given["file"], self.where, self._written(owner, "file"))
            with self.blame(owner, str(given.get("name", ""))):
                missing = [name for name, field in schema.items() if field.needed(given)]
                if missing:
                    raise self._missing(owner, missing[0])
                found.append(kind(**_numbers(kind, given)))
        return tuple(found)

    def _missing(self, owner: str, field: str) -> SpecError:
        """Return the SpecError for a field that a part must have and does not have."""
        if owner in self.names:
            return missing_fault(f"{self.names[owner]}.{field}", self.where)
        return SpecError(f"{self.where(owner)}: {field} is missing in [[{owner.partition('[')[0]}]]")

    def _read_pair(self, given: dict[str, Any], owner: str) -> None:
        """Replace the written form of a mesh's pair by the pair itself; values that the pair defines must not be given beside
        it.
        """
        name = shown(str(given.get("name", "mesh")))
        if given.get("backlash") == _NEVER_PART:
            given["backlash"] = None
        if "pair" not in given:
            return
        for key in _TOLD_BY_PAIR:
            if key in given:
                written = self._written(owner, key)
                raise SpecError(f"{self.where(written)}: {name}.{key} = {format_number(given[key])}: {BESIDE_PAIR}", written)
        given["pair"] = read_pair(given["pair"], self.where, self._written(owner, "pair"), name)

    def _torques(self, given: Any) -> dict[str, float]:
        if not isinstance(given, Mapping):
            raise SpecError(
                f"{self.where('train.torques')}: train.torques: must be a table: [train.torques], name = torque in N·m"
            )
        return {name: _number(value, whole=False) for name, value in given.items()}

    def _table(self, content: Any, owner: str, permitted: tuple[str, ...]) -> dict[str, Any]:
        """Return the values of one table, none of them unknown."""
        if not isinstance(content, Mapping):
            raise SpecError(f"{self.where(owner)}: {owner} = {format_number(content)}: must be a table")
        for key in content:
            if key not in permitted:
                words = shown(f"{owner}.{key}")
                raise SpecError(f"{self.where(f'{owner}.{key}')}: {words}: unknown key; {_hint(key, permitted)}")
        return dict(content)

    @contextmanager
    def blame(self, owner: str, name: str = "") -> Iterator[None]:
        """Turn an InputError about a part into a SpecError about the line that holds it."""
        try:
            yield
        except InputError as error:
            field = error.parameter.removeprefix(f"{name}.") if name else error.parameter
            unit = f" {error.unit}" if error.unit else ""
            key = self._written(owner, field)
            words = shown(f"{name}.{field}" if name and owner not in self.names else key)
            raise SpecError(
                f"{self.where(key)}: {words} = {format_number(error.value)}{unit}: {error.permitted}", key
            ) from error

    def _written(self, owner: str, field: str) -> str:
        """Return the key under which the user writes a field; what a train says of a part's field is about the part's table."""
        if owner in self.names:
            return f"{self.names[owner]}.{field}"
        for found in (TrainKey.of(f"{table}.{field}") for table in TRAIN_PARTS) if owner == "train" else ():
            if found is not None and f"{found.table}.{found.name}" in self.names.values():
                return str(found)
        return f"{owner}.{field}"


def _hint(key: str, permitted: tuple[str, ...]) -> str:
    """Return a hint for an unknown key: the one it resembles, otherwise the permitted keys (of many, the nearest)."""
    if near := difflib.get_close_matches(key, permitted, n=1):
        return f"did you mean {near[0]}?"
    return permitted_words(key, permitted)


def _models(given: Any) -> tuple[TrainModel, ...]:
    """Return the models of a list; empty for a single word. Raises ParameterError."""
    if not isinstance(given, list | tuple):
        return ()
    if not given:
        raise ParameterError("model", given, f"must hold one at least of {', '.join(each.value for each in TrainModel)}")
    return tuple(as_choice("model", each, TrainModel) for each in given)


def _numbers(kind: type[DataclassInstance], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of a type's fields, with numbers as the fields have them."""
    return {name: _number(value, whole=schema_of(kind)[name].whole) for name, value in given.items()}


def _number(value: Any, *, whole: bool) -> Any:
    """Whole numbers as floats where floats are meant; lists as tuples."""
    if isinstance(value, list):
        return tuple(_number(each, whole=whole) for each in value)
    return float(value) if isinstance(value, int) and not isinstance(value, bool) and not whole else value

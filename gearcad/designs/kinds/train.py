"""A train: `[train]` with its lists of inertias, shafts and meshes."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Self

from gearcad.designs.design import Design, DesignKind, kinds_in_words, require_plain_name
from gearcad.designs.files import Where
from gearcad.designs.keys import permitted_words
from gearcad.designs.kinds.train_pairs import read_pair
from gearcad.designs.train_keys import PARTS, TRAIN, TrainKey
from gearcad.designs.train_values import missing_fault
from gearcad.dynamics.options import OF_PAIRS, OF_TRAINS_OF_PAIRS, DynamicsOptions
from gearcad.dynamics.trains.document import train_document
from gearcad.dynamics.trains.members import BESIDE_PAIR, Mesh
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.errors import InputError, ParameterError, SpecError, as_choice, format_number, shown
from gearcad.schema import parts_of, schema_of, with_assumed

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["TrainDesign"]

_TOLD_BY_PAIR = ("base_radii", "teeth", "internal", "stiffness", "variation", "shape", "contact_ratio")
"""Keys of a mesh that its pair has in their place."""

_NEVER_PART = "off"
"""As a backlash: that of flanks that stay together whatever pulls them."""

_LISTS = {"inertia": "inertias", "shaft": "shafts", "mesh": "meshes"}


@dataclass(frozen=True, kw_only=True)
class TrainDesign(Design):
    """A train of shafts and meshes, and what the study of its dynamics looks at."""

    kind: ClassVar[DesignKind] = DesignKind.TRAIN
    elsewhere: ClassVar[str] = "a train is for `gearcad dynamics` and `gearcad data`"

    train: Train
    other_models: tuple[TrainModel, ...] = ()
    """Beside the train's own: all of them are studied side by side."""
    dynamics: DynamicsOptions = field(default=DynamicsOptions())

    def __post_init__(self) -> None:
        super().__post_init__()
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
        """What is studied: the model of `train` first."""
        return (self.train.model, *self.other_models)

    @classmethod
    def read(
        cls, tables: Mapping[str, Any], where: Where, default_name: str, names: Mapping[str, str] = MappingProxyType({})
    ) -> Self:
        """That of [train]; beside it there is [dynamics]. `names`: what the user calls tables of lists. Raises SpecError."""
        for table in tables:
            if table not in ("train", "dynamics"):
                raise SpecError(f"{where(table)}: [{shown(table)}] cannot stand beside [train]: permitted is [dynamics]")
        reader = _Reader(where, names)
        train, others = reader.train(tables["train"], default_name)
        dynamics = reader.dynamics(tables.get("dynamics", {}), train)
        with reader.blame("train"):
            return cls(name=train.name, train=train, other_models=others, dynamics=dynamics)

    def require_kind(self, *kinds: DesignKind, why: str) -> None:
        """Raise ParameterError unless it is of one of these kinds: jobs of pairs take the specs of its pairs."""
        if self.kind not in kinds and any(mesh.pair is not None for mesh in self.train.meshes):
            pairs = "`gearcad dynamics` writes the specs of the pairs of its meshes for that, under their loads"
            raise ParameterError("kind", self.kind.words, f"must be {kinds_in_words(kinds)}: {pairs}")
        super().require_kind(*kinds, why=why)

    def to_dict(self) -> dict[str, Any]:
        """The document of `data.json`: the train and its parts, each kind under its table, and the options."""
        options = {
            key: value
            for key, value in asdict(self.dynamics).items()
            if key in TRAIN["dynamics"] or (value is not None and key in parts_of(DynamicsOptions))
        }
        document = super().to_dict() | train_document(self.train) | {"dynamics": options}
        if self.other_models:
            document["train"]["model"] = [each.value for each in self.models]
        return with_assumed(document)


@dataclass(frozen=True)
class _Reader:
    where: Where
    names: Mapping[str, str]

    def train(self, content: Any, default_name: str) -> tuple[Train, tuple[TrainModel, ...]]:
        """The train of [train] and its parts, and the models beside its own."""
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
        """The options of [dynamics]: some are of trains only whose meshes are those of pairs."""
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
        """The inertias, shafts or meshes of a train."""
        if not isinstance(listed, list):
            raise SpecError(f"{self.where(f'train.{key}')}: train.{key}: must be headed [[train.{key}]], once for each")
        kind, found = PARTS[key], []
        schema = schema_of(kind)
        for number, each in enumerate(listed):
            owner = f"train.{key}[{number}]"
            given = self._table(each, owner, tuple(schema))
            if kind is Mesh:
                self._read_pair(given, owner)
            with self.blame(owner, str(given.get("name", ""))):
                missing = [name for name, field in schema.items() if field.needed(given)]
                if missing:
                    raise self._missing(owner, missing[0])
                found.append(kind(**_numbers(kind, given)))
        return tuple(found)

    def _missing(self, owner: str, field: str) -> SpecError:
        """What a part must have, and has not."""
        if owner in self.names:
            return missing_fault(f"{self.names[owner]}.{field}", self.where)
        return SpecError(f"{self.where(owner)}: {field} is missing in [[{owner.partition('[')[0]}]]")

    def _read_pair(self, given: dict[str, Any], owner: str) -> None:
        """The pair of a mesh in place of how it is written; what it tells must not stand beside it."""
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
        """The values of one table, none of them unknown."""
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
        """The key under which the user writes a field; what a train says of a part's field is about the part's table."""
        if owner in self.names:
            return f"{self.names[owner]}.{field}"
        for found in (TrainKey.of(f"{table}.{field}") for table in PARTS) if owner == "train" else ():
            if found is not None and f"{found.table}.{found.name}" in self.names.values():
                return str(found)
        return f"{owner}.{field}"


def _hint(key: str, permitted: tuple[str, ...]) -> str:
    """What may stand in the place of an unknown key; of many the nearest."""
    if near := difflib.get_close_matches(key, permitted, n=1):
        return f"did you mean {near[0]}?"
    return permitted_words(key, permitted)


def _models(given: Any) -> tuple[TrainModel, ...]:
    """Those of a list; none of a single word. Raises ParameterError."""
    if not isinstance(given, list | tuple):
        return ()
    if not given:
        raise ParameterError("model", given, f"must hold one at least of {', '.join(each.value for each in TrainModel)}")
    return tuple(as_choice("model", each, TrainModel) for each in given)


def _numbers(kind: type[DataclassInstance], given: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a type's fields, with numbers as the fields have them."""
    return {name: _number(value, whole=schema_of(kind)[name].whole) for name, value in given.items()}


def _number(value: Any, *, whole: bool) -> Any:
    """Whole numbers as floats where floats are meant; lists as tuples."""
    if isinstance(value, list):
        return tuple(_number(each, whole=whole) for each in value)
    return float(value) if isinstance(value, int) and not isinstance(value, bool) and not whole else value

"""A train: `[train]` with its lists of inertias, shafts and meshes."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Self

from gearcad.designs.design import Design, DesignKind, require_plain_name
from gearcad.designs.files import Where
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.trains.members import Inertia, Mesh, Shaft
from gearcad.dynamics.trains.train import Train
from gearcad.errors import InputError, SpecError, format_number, shown

__all__ = ["TrainDesign"]

_PARTS: dict[str, type[Any]] = {"inertia": Inertia, "shaft": Shaft, "mesh": Mesh}
_LISTS = {"inertia": "inertias", "shaft": "shafts", "mesh": "meshes"}
_WHOLE = ("teeth", "modes", "order", "speeds", "harmonics", "frequencies", "accuracy_grade", "seed")
_OF_PAIRS = (
    "model",
    "stiffness",
    "damping_ratio",
    "pinion_inertia",
    "wheel_inertia",
    "pinion_bearing_stiffness",
    "wheel_bearing_stiffness",
    "bearing_damping",
    "tooth_stiffness",
    "tooth_damping",
    "duration",
    "sampling",
)
"""Keys of [dynamics] that a train has in its own parts, or has no use for."""


@dataclass(frozen=True, kw_only=True)
class TrainDesign(Design):
    """A train of shafts and meshes, and what the study of its dynamics looks at."""

    kind: ClassVar[DesignKind] = DesignKind.TRAIN
    elsewhere: ClassVar[str] = "a train is for `gearcad dynamics`"

    train: Train
    dynamics: DynamicsOptions = field(default=DynamicsOptions())

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """That of [train]; beside it there is [dynamics]. Raises SpecError."""
        for table in tables:
            if table not in ("train", "dynamics"):
                raise SpecError(f"{where(table)}: [{shown(table)}] cannot stand beside [train]: permitted is [dynamics]")
        reader = _Reader(where)
        train = reader.train(tables["train"], default_name)
        return cls(name=train.name, train=train, dynamics=reader.dynamics(tables.get("dynamics", {})))


@dataclass(frozen=True)
class _Reader:
    where: Where

    def train(self, content: Any, default_name: str) -> Train:
        """The train of [train] and its parts."""
        given = self._table(content, "train", (*(field.name for field in fields(Train)), *_LISTS))
        for plural in _LISTS.values():
            if plural in given:
                single = next(key for key, name in _LISTS.items() if name == plural)
                raise SpecError(f"{self.where(f'train.{plural}')}: train.{plural}: write one [[train.{single}]] for each")
        parts: dict[str, Any] = {plural: self._parts(given.pop(key, []), key) for key, plural in _LISTS.items()}
        name = given.pop("name", default_name)
        given["torques"] = self._torques(given.pop("torques", {}))
        with self._blame("train"):
            require_plain_name(name)
            return Train(name=name, **{key: _number(key, value) for key, value in given.items()}, **parts)

    def dynamics(self, content: Any) -> DynamicsOptions:
        """The options of [dynamics]."""
        permitted = tuple(field.name for field in fields(DynamicsOptions) if field.name not in _OF_PAIRS)
        chosen = self._table(content, "dynamics", permitted)
        with self._blame("dynamics"):
            return DynamicsOptions(**{key: _number(key, value) for key, value in chosen.items()})

    def _parts(self, listed: Any, key: str) -> tuple[Any, ...]:
        """The inertias, shafts or meshes of a train."""
        if not isinstance(listed, list):
            raise SpecError(f"{self.where(f'train.{key}')}: train.{key}: must be headed [[train.{key}]], once for each")
        kind, found = _PARTS[key], []
        names = tuple(field.name for field in fields(kind))
        for number, each in enumerate(listed):
            owner = f"train.{key}[{number}]"
            given = self._table(each, owner, names)
            with self._blame(owner, str(given.get("name", ""))):
                missing = [
                    field.name for field in fields(kind) if field.default is field.default_factory and field.name not in given
                ]
                if missing:
                    raise SpecError(f"{self.where(owner)}: {missing[0]} is missing in [[train.{key}]]")
                found.append(kind(**{name: _number(name, value) for name, value in given.items()}))
        return tuple(found)

    def _torques(self, given: Any) -> dict[str, float]:
        if not isinstance(given, Mapping):
            raise SpecError(
                f"{self.where('train.torques')}: train.torques: must be a table: [train.torques], name = torque in N·m"
            )
        return {name: _number(name, value) for name, value in given.items()}

    def _table(self, content: Any, owner: str, permitted: tuple[str, ...]) -> dict[str, Any]:
        """The values of one table, none of them unknown."""
        if not isinstance(content, Mapping):
            raise SpecError(f"{self.where(owner)}: {owner} = {format_number(content)}: must be a table")
        for key in content:
            if key not in permitted:
                near = difflib.get_close_matches(key, permitted, n=1)
                hint = f"did you mean {near[0]}?" if near else f"permitted are {', '.join(permitted)}"
                raise SpecError(f"{self.where(f'{owner}.{key}')}: {shown(f'{owner}.{key}')}: unknown key; {hint}")
        return dict(content)

    @contextmanager
    def _blame(self, owner: str, name: str = "") -> Iterator[None]:
        """Turn an InputError about a part into a SpecError about the line that holds it."""
        try:
            yield
        except InputError as error:
            field = error.parameter.removeprefix(f"{name}.") if name else error.parameter
            unit = f" {error.unit}" if error.unit else ""
            key = shown(f"{owner}.{field}" if not name else f"{name}.{field}")
            text = f"{self.where(f'{owner}.{field}')}: {key} = {format_number(error.value)}{unit}: {error.permitted}"
            raise SpecError(text, f"{owner}.{field}") from error


def _number(key: str, value: Any) -> Any:
    """Whole numbers as floats where floats are meant; lists as tuples."""
    if isinstance(value, list):
        return tuple(_number(key, each) for each in value)
    whole = isinstance(value, int) and not isinstance(value, bool)
    return float(value) if whole and key not in _WHOLE else value

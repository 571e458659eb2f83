"""Spec files of trains: `[train]` with its lists of inertias, shafts and meshes; TOML in, a Train out."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from gearcad.designs.design import require_plain_name
from gearcad.designs.reader import Where, read_tables
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.trains.train import Inertia, Mesh, Shaft, Train
from gearcad.errors import InputError, SpecError, format_number, shown

__all__ = ["TrainDesign", "holds_train", "read_train"]

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

Part = TypeVar("Part")


class TrainDesign(NamedTuple):
    """A train with the name of its output folder, and what its study looks at."""

    name: str
    train: Train
    options: DynamicsOptions


def holds_train(path: Path | str) -> bool:
    """True if a spec has [train]. Raises SpecError for a file that cannot be read."""
    return "train" in read_tables(path)[0]


def read_train(path: Path | str) -> TrainDesign:
    """Read a spec with [train]. Raises SpecError, one line that names the file, the line, the key and what is permitted."""
    tables, where = read_tables(path)
    for table in tables:
        if table not in ("train", "dynamics"):
            raise SpecError(f"{where(table)}: [{shown(table)}] cannot stand beside [train]: permitted is [dynamics]")
    return _Reader(where).design(tables, Path(path).stem)


@dataclass(frozen=True)
class _Reader:
    where: Where

    def design(self, tables: Mapping[str, Any], default_name: str) -> TrainDesign:
        given = self._table(tables["train"], "train", (*(field.name for field in fields(Train)), *_LISTS))
        for plural in _LISTS.values():
            if plural in given:
                single = next(key for key, name in _LISTS.items() if name == plural)
                raise SpecError(f"{self.where(f'train.{plural}')}: train.{plural}: write one [[train.{single}]] for each")
        parts: dict[str, Any] = {plural: self._parts(given.pop(key, []), key) for key, plural in _LISTS.items()}
        name = given.pop("name", default_name)
        given["torques"] = self._torques(given.pop("torques", {}))
        with self._blame("train"):
            require_plain_name(name)
            train = Train(name=name, **{key: _number(key, value) for key, value in given.items()}, **parts)
        permitted = tuple(field.name for field in fields(DynamicsOptions) if field.name not in _OF_PAIRS)
        chosen = self._table(tables.get("dynamics", {}), "dynamics", permitted)
        with self._blame("dynamics"):
            options = DynamicsOptions(**{key: _number(key, value) for key, value in chosen.items()})
        return TrainDesign(name, train, options)

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

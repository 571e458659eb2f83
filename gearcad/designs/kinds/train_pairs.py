"""The pairs of a train's meshes: each the spec of a pair in a file beside the train's, or in tables of its mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcad.check.options import CheckOptions
from gearcad.designs.design import DesignKind, require_plain_name
from gearcad.designs.files import Where, read_tables
from gearcad.designs.keys import BESIDE, MAIN_TABLES, OF_SETS
from gearcad.designs.kinds.pair import PairDesign
from gearcad.dynamics.trains.mesh_pair import MeshPair
from gearcad.errors import InputError, ParameterError, SpecError, format_number, printable
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.per_gear import Role
from gearcad.rating.options import RatingOptions

__all__ = ["DesignedPair", "designed_pair", "plain_name", "read_pair"]

_GEARS = tuple(role.value for role in Role)

_OTHER_KINDS = {
    **dict.fromkeys(("train",), DesignKind.TRAIN.words),
    **dict.fromkeys(("planetary", *OF_SETS), DesignKind.PLANETARY.words),
    **dict.fromkeys(("rack",), DesignKind.RACK_PAIR.words),
    **dict.fromkeys(("gear",), DesignKind.GEAR.words),
}
"""Tables that a spec of a pair does not have, and what has them."""


@dataclass(frozen=True, kw_only=True)
class DesignedPair(MeshPair):
    """The pair of a mesh, and the `design` that it is of."""

    design: PairDesign


def designed_pair(design: PairDesign) -> DesignedPair:
    """The pair of a design with its material, mounting, bodies and rating. Raises GeometryError for double helical gears."""
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
    """That of the value of `owner`, the key `pair` of a mesh: the name of a spec, or its tables. Raises SpecError."""
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
            raise
        raise SpecError(f"{where(owner)}: {mesh}.pair: {error}", owner) from error
    except InputError as error:
        file = f" {printable(given)}:" if isinstance(given, str) else ""
        raise SpecError(f"{where(owner)}: {mesh}.pair:{file} {error}", owner) from error
    return found


def _of_file(path: Path) -> PairDesign:
    tables, where = read_tables(path)
    if (other := next((table for table in tables if table in _OTHER_KINDS), None)) is not None:
        raise SpecError(f"{where(other)}: is the spec of a {_OTHER_KINDS[other]}; a mesh needs that of a pair of gears", other)
    return PairDesign.read(tables, where, path.stem)


@dataclass(frozen=True)
class _Inside:
    """Where the keys of a pair's tables stand inside those of a mesh."""

    where: Where
    owner: str
    mesh: str

    def __call__(self, key: str) -> str:
        written = key.removeprefix("pair.")
        return f"{self.where(f'{self.owner}.{written}')}: {self.mesh}"


def _of_tables(given: Mapping[str, Any], where: _Inside, mesh: str) -> PairDesign:
    """Keys that stand in no table of their own are those of [pair]."""
    for gear in _GEARS:
        if gear not in given:
            raise SpecError(
                f"{where(gear)}: [train.mesh.pair.{gear}] is missing: a pair needs both gears, {' and '.join(_GEARS)}"
            )
    tables = {table: given[table] for table in (*_GEARS, *BESIDE) if table in given}
    shared = {key: value for key, value in given.items() if key not in tables}
    return PairDesign.read({MAIN_TABLES[DesignKind.PAIR][0]: shared, **tables}, where, plain_name(mesh))


def plain_name(text: str) -> str:
    """A name for files that is near to any text."""
    cleaned = "".join(each if each.isalnum() or each in " ._-+()" else "-" for each in text[:60]).strip(" .-")
    try:
        require_plain_name(cleaned)
    except ParameterError:
        return "pair"
    return cleaned

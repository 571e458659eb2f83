"""Gearboxes of a spec: [planetary] with input, output and joined members, [[planetary.set]], and [planetary.states]."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self, TypeVar

from gearcad.core.errors import InputError, ParameterError, SpecError, format_number, shown
from gearcad.core.records import JsonObject
from gearcad.designs.design import Design, Where
from gearcad.designs.keys import OF_GEARBOXES, DesignKind
from gearcad.planetary.gearbox import Gearbox, GearboxState, MemberSet, SetCentral, SetPlanet

_PERMITTED = ("name", "input", "output", "joined", "mesh_efficiency", *sorted(OF_GEARBOXES))
_OF_STATE = ("held", "joined")
_OF_CENTRAL, _OF_PLANET = ("teeth", "meshes"), ("name", "teeth", "meshes", "beside")

Part = TypeVar("Part")


@dataclass(frozen=True, kw_only=True)
class PlanetaryGearboxDesign(Design):
    """A gearbox of several planetary sets, whose members are joined, and held by brakes and clutches."""

    kind: ClassVar[DesignKind] = DesignKind.GEARBOX
    elsewhere: ClassVar[str] = "a gearbox of planetary sets is for `gearcad planetary` and `gearcad data`"

    gearbox: Gearbox

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that [planetary] with its sets and states describes. Raises SpecError."""
        for table in tables:
            if table != "planetary":
                raise SpecError(
                    f"{where(table)}: [{shown(table)}] cannot stand beside [[planetary.set]]: permitted is [planetary]"
                )
        main = tables["planetary"]
        _require_keys(main, "planetary", _PERMITTED, where)
        name = main.get("name", default_name)
        given = {key: main[key] for key in ("mesh_efficiency",) if key in main}
        sets = main.get("set", [])
        if not isinstance(sets, list):
            raise SpecError(f"{where('planetary.set')}: planetary.set: must be headed [[planetary.set]], once for each")
        gearbox = _made(
            Gearbox,
            "planetary",
            where,
            name=name,
            sets=tuple(_set(each, number, where) for number, each in enumerate(sets)),
            input=_text(main, "planetary", "input", where),
            output=_text(main, "planetary", "output", where),
            joined=_groups(main.get("joined", []), "planetary.joined", where),
            states=tuple(_states(main.get("states", {}), where)),
            **given,
        )
        return _made(cls, "planetary", where, name=name, gearbox=gearbox)

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`: sets with their teeth, joined members, input and output, states."""
        return {**super().to_dict(), "planetary": self.gearbox.to_dict()}


def _set(content: Any, number: int, where: Where) -> MemberSet:
    """Return the set of a table: its name, its carrier's, its planets, and a table for each sun and ring."""
    key = f"planetary.set[{number}]"
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {key}: must be a table")
    name = _text(content, key, "name", where)
    listed = content.get("planet", [])
    if not isinstance(listed, list):
        raise SpecError(f"{where(key)}: {key}.planet: must be headed [[planetary.set.planet]], once for each")
    planets = []
    for place, each in enumerate(listed):
        own = f"{key}.planet[{place}]"
        _require_keys(each, own, _OF_PLANET, where)
        planets.append(_made(SetPlanet, own, where, **({"name": "planet", "teeth": None} | dict(each))))
    centrals = []
    for central, each in content.items():
        if central in ("name", "carrier", "planet"):
            continue
        own = f"{key}.{central}"
        _require_keys(each, own, _OF_CENTRAL, where)
        mate = each.get("meshes", planets[0].name if len(planets) == 1 else None)
        if mate is None:
            raise SpecError(f"{where(own)}: {own}.meshes is missing: the planet that it meshes with", f"{own}.meshes")
        centrals.append(_made(SetCentral, own, where, name=central, teeth=each.get("teeth"), meshes=mate))
    carrier = content.get("carrier", "carrier")
    return _made(MemberSet, key, where, name=name, centrals=tuple(centrals), planets=tuple(planets), carrier=carrier)


def _states(content: Any, where: Where) -> Iterator[GearboxState]:
    key = "planetary.states"
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {key}: must be a table of states by their names")
    for name, each in content.items():
        own = f"{key}.{name}"
        _require_keys(each, own, _OF_STATE, where)
        (held,) = _groups([each.get("held", [])], f"{own}.held", where)
        yield GearboxState(name=name, held=held, joined=_groups(each.get("joined", []), f"{own}.joined", where))


def _groups(value: Any, key: str, where: Where) -> tuple[tuple[str, ...], ...]:
    """Return lists of lists of names as tuples."""
    lists = isinstance(value, list) and all(isinstance(group, list) for group in value)
    if not lists or not all(isinstance(name, str) for group in value for name in group):
        raise SpecError(f'{where(key)}: {key}: must be names in brackets, such as ["set1.sun", "set2.sun"]', key)
    return tuple(tuple(group) for group in value)


def _text(table: Mapping[str, Any], owner: str, key: str, where: Where) -> str:
    full, value = f"{owner}.{key}", table.get(key)
    if not isinstance(value, str) or not value:
        raise SpecError(f"{where(owner)}: {full} is missing: a name", full)
    return value


def _require_keys(table: Any, key: str, permitted: tuple[str, ...], where: Where) -> None:
    if not isinstance(table, Mapping):
        raise SpecError(
            f"{where(key)}: {shown(key)} = {format_number(table)}: must be a table with {', '.join(permitted)}", key
        )
    for name in table:
        if name not in permitted:
            full = f"{key}.{name}"
            raise SpecError(f"{where(full)}: {shown(full)}: unknown key; permitted are {', '.join(permitted)}", full)


def _made(kind: type[Part], key: str, where: Where, **values: Any) -> Part:
    """Return what a table makes. Raises SpecError with the place of what is wrong."""
    try:
        return kind(**values)
    except InputError as error:
        own = error.parameter if isinstance(error, ParameterError) and "." in error.parameter else f"{key}.{error.parameter}"
        full = own if own.startswith("planetary") else f"planetary.{own}"
        value = "is missing" if error.value is None else f"= {shown(format_number(error.value))}"
        raise SpecError(f"{where(full)}: {full} {value}: {error.permitted}", full) from error

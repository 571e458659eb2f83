"""Gearboxes of a spec: [planetary] with input, output and joined members, [[planetary.set]], and [planetary.states]."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

from gearcad.core.errors import InputError, SpecError, format_number, shown
from gearcad.core.records import JsonObject
from gearcad.designs.design import Described, Design, Where, read_tables
from gearcad.designs.keys import (
    GEAR_FIELDS,
    GEARBOX_FILE,
    OF_GEARBOXES,
    PARTS,
    SHARED,
    DesignKind,
    is_gearbox,
    nearest_of,
)
from gearcad.designs.spec import AUTO, CLEAR, Given, Spec, entries
from gearcad.geometry import Gear, GearPair
from gearcad.planetary.gearbox import Gearbox, GearboxShaft, GearboxState
from gearcad.planetary.gearbox_assembly import SetAssembly
from gearcad.planetary.gearbox_sets import MemberSet, SetCarrier, SetCentral, SetGear, SetGearing, SetPlanet

_PERMITTED = ("name", "input", "output", "joined", "mesh_efficiency", "speed", "shaft", "inertia", *sorted(OF_GEARBOXES))
_OF_STATE = ("held", "joined")
_OF_CENTRAL, _OF_PLANET = ("teeth", "meshes"), ("name", "teeth", "meshes", "beside")

_OF_SET = ("planets", "axial_position")
"""Keys of a set beside those that its gears share."""

_OF_BOTH = ("axial_position", "mass", "inertia", "mesh_stiffness", "mesh_error")
_OF_CENTRALS = ("support_stiffness", "torsional_stiffness")
_OF_PLANETS = ("clocking", "centre_distance", "mate_distance", "pin_stiffness")
_OF_PLACES = (*_OF_BOTH, *_OF_CENTRALS, *_OF_PLANETS)
"""Keys of a gear of a set beside its teeth: of any, of a sun or a ring, of a planet."""

_OF_CARRIER = ("name", "mass", "inertia", "support_stiffness", "torsional_stiffness")
_OF_SHAFT = ("name", "start", "end", "torsional_stiffness")

_OF_GEARS = {*_OF_SET, *(field.partition(".")[0] for field in SHARED)}
"""Keys of a set by which its gears are known."""

_NOT_HERE = ("double_helix", "drawing", "material")
"""Keys of gears that gearboxes do not take."""

Part = TypeVar("Part")


@dataclass(frozen=True, kw_only=True)
class PlanetaryGearboxDesign(Design):
    """A gearbox of several planetary sets, whose members are joined, and held by brakes and clutches."""

    kind: ClassVar[DesignKind] = DesignKind.GEARBOX
    elsewhere: ClassVar[str] = "a gearbox of planetary sets is for `gearcad planetary`, data and build"

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
        given = {key: main[key] for key in ("mesh_efficiency", "speed") if key in main}
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
            shafts=tuple(_shafts(main.get("shaft", []), where)),
            inertias=_inertias(main.get("inertia", {}), where),
            **given,
        )
        return _made(cls, "planetary", where, name=name, gearbox=gearbox)

    @property
    def gears(self) -> dict[str, Gear]:
        """Gears of all sets by names such as "set1.sun"; none where only teeth are known."""
        assemblies = self.gearbox.assemblies.items()
        return {f"{name}.{part}": own.gear for name, each in assemblies for part, own in each.gearing.gears.items()}

    @property
    def pairs(self) -> dict[str, GearPair]:
        """Pairs of all meshes by names such as "set1.sun-planet"."""
        return {f"{name}.{mesh}": pair for name, each in self.gearbox.assemblies.items() for mesh, pair in each.pairs.items()}

    @property
    def described(self) -> Mapping[str, Described]:
        """Gears and pairs by their names."""
        return {**self.gears, **self.pairs}

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`: sets with their teeth, joined members, input and output, states."""
        return {**super().to_dict(), "planetary": self.gearbox.to_dict()}


def gearbox_of_row(values: Mapping[str, Any], where: Where, default_name: str) -> PlanetaryGearboxDesign:
    """Return the gearbox of a row of a design table: that of the spec under `gearbox`, with the values of the row in it.

    A value is a number, a text, or a list or table in TOML, such as [["r.carrier"]]. Raises SpecError.
    """
    path = values.get(GEARBOX_FILE)
    if not isinstance(path, str):
        raise SpecError(f"{where(GEARBOX_FILE)}: {GEARBOX_FILE} is missing: the spec of a gearbox", GEARBOX_FILE)
    tables, where_in_spec = read_tables(path)
    if not is_gearbox(tables):
        raise SpecError(f"{where(GEARBOX_FILE)}: {shown(path)}: must be the spec of a gearbox of planetary sets", GEARBOX_FILE)
    changed = {key: value for key, value in values.items() if key != GEARBOX_FILE}
    for key, value in changed.items():
        _put(tables, key, value, where)
    tables["planetary"] = {key: each for key, each in tables["planetary"].items() if key != "name"}

    def whose(key: str) -> str:
        return where(key) if key in changed else f"{where(GEARBOX_FILE)}: {where_in_spec(key)}"

    return PlanetaryGearboxDesign.read(tables, whose, default_name)


_STEP = re.compile(r"([^.\[\]]+)(?:\[(\d+)\])?")


def _put(tables: dict[str, Any], key: str, value: Any, where: Where) -> None:
    """Put a value at the place of its key in the tables of a spec. Raises SpecError for a place that they do not have."""
    inner: Any = tables
    steps: list[str | int] = []
    for name, number in _STEP.findall(key):
        steps += [name, int(number)] if number else [name]
    for step in steps[:-1]:
        if isinstance(inner, dict) and isinstance(step, str):
            inner = inner.setdefault(step, {})
        elif isinstance(inner, list) and isinstance(step, int) and step < len(inner):
            inner = inner[step]
        else:
            inner = None
    last = steps[-1]
    if not isinstance(inner, dict) or not isinstance(last, str):
        raise SpecError(f"{where(key)}: {shown(key)}: the spec of the gearbox has no such place", key)
    inner[last] = _cell_value(value, inner.get(last), key, where)


def _cell_value(value: Any, before: Any, key: str, where: Where) -> Any:
    """Return the value of a cell as a spec has it: whole numbers where they are meant, lists and tables of TOML."""
    if isinstance(value, float) and value.is_integer() and (isinstance(before, int) or key.endswith((".teeth", ".planets"))):
        return int(value)
    if isinstance(value, str) and value.lstrip().startswith(("[", "{")):
        try:
            return tomllib.loads("it=" + value)["it"]
        except tomllib.TOMLDecodeError as error:
            raise SpecError(f"{where(key)}: {shown(key)}: is not valid TOML: {error}", key) from error
    return value


def _set(content: Any, number: int, where: Where) -> MemberSet:
    """Return the set of a table: its name, its carrier's, its planets, a table for each sun and ring, and what these share."""
    key = f"planetary.set[{number}]"
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {key}: must be a table")
    name = _text(content, key, "name", where)
    geared = bool(_OF_GEARS & set(content))
    shared = {each: value for each, value in content.items() if each in _OF_GEARS}
    listed = content.get("planet", [])
    if not isinstance(listed, list):
        raise SpecError(f"{where(key)}: {key}.planet: must be headed [[planetary.set.planet]], once for each")
    planets, tables = [], {}
    for place, each in enumerate(listed):
        own = f"{key}.planet[{place}]"
        _require_keys(each, own, None if geared else _OF_PLANET, where)
        _require_texts(each, own, where)
        given = {"name": "planet", "teeth": None} | {part: each[part] for part in _OF_PLANET if part in each}
        planets.append(_made(SetPlanet, own, where, **given))
        tables[planets[-1].name] = GearTable(own, each)
    centrals = []
    for central, each in content.items():
        if central in ("name", "carrier", "planet") or central in shared:
            continue
        own = f"{key}.{central}"
        _require_keys(each, own, None if geared else _OF_CENTRAL, where)
        _require_texts(each, own, where)
        mate = each.get("meshes", planets[0].name if len(planets) == 1 else None)
        if mate is None:
            raise SpecError(f"{where(own)}: {own}.meshes is missing: the planet that it meshes with", f"{own}.meshes")
        centrals.append(_made(SetCentral, own, where, name=central, teeth=each.get("teeth"), meshes=mate))
        tables[central] = GearTable(own, each)
    carrier, of_carrier = content.get("carrier", "carrier"), {}
    if isinstance(carrier, Mapping):
        _require_keys(carrier, f"{key}.carrier", _OF_CARRIER if geared else ("name",), where)
        of_carrier = {field: value for field, value in carrier.items() if field != "name"}
        carrier = carrier.get("name", "carrier")
    _require_texts({"carrier": carrier}, key, where)
    found = _made(MemberSet, key, where, name=name, centrals=tuple(centrals), planets=tuple(planets), carrier=carrier)
    if geared:
        found = SetReader(found, key, shared, tables, of_carrier, where).geared()
        _made(SetAssembly(found).check, key, where, of=name)
    return found


class GearTable(NamedTuple):
    """The key and the content of the table of a central or a planet."""

    key: str
    content: Mapping[str, Any]


@dataclass(frozen=True)
class SetReader:
    """Reader of the gears of a set: `shared` values of its table, and the tables of its centrals and planets by their names."""

    subject: MemberSet
    key: str
    shared: Mapping[str, Any]
    tables: Mapping[str, GearTable]
    carrier: Mapping[str, Any]
    where: Where

    def geared(self) -> MemberSet:
        """Return the set with its gears, every tip alteration of "auto" resolved. Raises SpecError."""
        spec = self._spec()
        inputs: dict[str, dict[str, Any]] = {}
        for name in (part.name for part in self.subject.parts):
            with spec.blame(name):
                inputs[name] = {"name": name} | spec.gear_inputs(name)
        words = {name: own.get("tip_alteration", AUTO) for name, own in inputs.items() if "tip_diameter" not in own}
        automatic = [name for name, word in words.items() if word == AUTO]
        clear = [name for name, word in words.items() if word == CLEAR and inputs[name]["teeth"] < 0]
        for name in (*automatic, *clear):
            inputs[name]["tip_alteration"] = 0.0
        found = self._with({name: self._gear(spec, name, own) for name, own in inputs.items()})
        for names, key in ((automatic, AUTO), (clear, CLEAR)):
            if names:
                altered = _made(SetAssembly(found).tip_alterations, self.key, self.where, clear=key == CLEAR)
                for name in names:
                    inputs[name]["tip_alteration"] = altered[name]
                found = self._with({name: self._gear(spec, name, own) for name, own in inputs.items()})
        return found

    def _spec(self) -> Spec:
        """Return the values of all gears under their names, with what the set shares."""
        values: dict[str, Given] = {}
        for name, table in self.tables.items():
            for field, value in entries(table.content, PARTS):
                if field not in (*_OF_PLANET[2:], *_OF_PLACES, "name"):
                    self._add(values, name, field, value, f"{table.key}.{field}")
        spec = Spec(values, self.where, {name: table.key for name, table in self.tables.items()})
        given = [(field, value) for field, value in entries(self.shared, PARTS) if field not in _OF_SET]
        senses = self._senses()
        for name in self.tables:
            giving_way = spec.giving_way(name)
            for field, value in given:
                if f"{name}.{field}" in values or field in giving_way or (field == "helix_angle" and name not in senses):
                    continue
                turned = -value if field == "helix_angle" and senses[name] < 0 and isinstance(value, int | float) else value
                self._add(values, name, field, turned, f"{self.key}.{field}")
        return spec

    def _add(self, values: dict[str, Given], name: str, field: str, value: Any, key: str) -> None:
        """Add a value of a gear. Raises SpecError for a key that gears of gearboxes do not have."""
        said = GEAR_FIELDS.get(field)
        if said is None or field.partition(".")[0] in _NOT_HERE:
            near = nearest_of(field, GEAR_FIELDS, tuple(GEAR_FIELDS))
            words = f"did you mean {near}?" if near and said is None else "no gear of a gearbox has it"
            raise SpecError(f"{self.where(key)}: {shown(key)}: unknown key; {words}", key)
        if isinstance(value, int) and not isinstance(value, bool):
            value = value if said.whole else float(value)
        values[f"{name}.{field}"] = Given(value, key)

    def _senses(self) -> dict[str, int]:
        """Return 1 for gears with the hand of the first central, -1 for those of the other hand; none beside these."""
        rings = {each.name for each in self.subject.centrals if each.teeth < 0}
        meshes = [(part.name, part.meshes) for part in self.subject.parts if part.meshes]
        found = {self.subject.centrals[0].name: 1}
        for _ in meshes:
            for one, other in meshes:
                sense = 1 if one in rings else -1
                for own, mate in ((one, other), (other, one)):
                    if own in found and mate not in found:
                        found[mate] = sense * found[own]
        return found

    def _gear(self, spec: Spec, name: str, inputs: Mapping[str, Any]) -> SetGear:
        with spec.blame(name):
            gear = Gear(**inputs)
        table = self.tables[name]
        planet = any(each.name == name for each in self.subject.planets)
        permitted = (*_OF_BOTH, *(_OF_PLANETS if planet else _OF_CENTRALS))
        given = {field: table.content[field] for field in _OF_PLACES if field in table.content}
        for field in given:
            if field not in permitted:
                key = f"{table.key}.{field}"
                raise SpecError(
                    f"{self.where(key)}: {key}: unknown key here; it belongs to {'a sun or a ring' if planet else 'a planet'}",
                    key,
                )
        return _made(SetGear, table.key, self.where, gear=gear, **given)

    def _with(self, gears: Mapping[str, SetGear]) -> MemberSet:
        given = {"planets": None} | {field: self.shared[field] for field in _OF_SET if field in self.shared}
        carrier = _made(SetCarrier, f"{self.key}.carrier", self.where, **self.carrier)
        gearing = _made(SetGearing, self.key, self.where, gears=dict(gears), carrier=carrier, **given)
        return replace(self.subject, gearing=gearing)


def _states(content: Any, where: Where) -> Iterator[GearboxState]:
    key = "planetary.states"
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {key}: must be a table of states by their names")
    for name, each in content.items():
        own = f"{key}.{name}"
        _require_keys(each, own, _OF_STATE, where)
        (held,) = _groups([each.get("held", [])], f"{own}.held", where)
        yield GearboxState(name=name, held=held, joined=_groups(each.get("joined", []), f"{own}.joined", where))


def _shafts(content: Any, where: Where) -> Iterator[GearboxShaft]:
    if not isinstance(content, list):
        raise SpecError(f"{where('planetary.shaft')}: planetary.shaft: must be headed [[planetary.shaft]], once for each")
    for number, each in enumerate(content):
        key = f"planetary.shaft[{number}]"
        _require_keys(each, key, _OF_SHAFT, where)
        ends = {end: _text(each, key, end, where) for end in ("start", "end")}
        given = {"name": each.get("name", f"shaft_{number + 1}"), "torsional_stiffness": each.get("torsional_stiffness")}
        yield _made(GearboxShaft, key, where, **ends, **given)


def _inertias(content: Any, where: Where) -> dict[str, float]:
    """Return the inertias (kg·m²) by the names of members and shafts."""
    key = "planetary.inertia"
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {key}: must be a table of inertias, such as input = 0.02", key)
    return dict(content)


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


def _require_texts(table: Mapping[str, Any], key: str, where: Where) -> None:
    """Raise SpecError for a name in a table that is no text."""
    for name in ("name", "meshes", "beside", "carrier"):
        if not isinstance(table.get(name, ""), str):
            full = f"{key}.{name}"
            raise SpecError(f"{where(full)}: {full} = {format_number(table[name])}: must be a name, in quotation marks", full)


def _require_keys(table: Any, key: str, permitted: tuple[str, ...] | None, where: Where) -> None:
    """Raise SpecError unless something is a table, with permitted keys where these are known here."""
    if not isinstance(table, Mapping):
        words = f"a table with {', '.join(permitted)}" if permitted else "a table, such as { teeth = 24 }"
        raise SpecError(f"{where(key)}: {shown(key)} = {format_number(table)}: must be {words}", key)
    if permitted is None:
        return
    for name in table:
        if name not in permitted:
            full = f"{key}.{name}"
            raise SpecError(f"{where(full)}: {shown(full)}: unknown key; permitted are {', '.join(permitted)}", full)


def _made(kind: Callable[..., Part], key: str, where: Where, *, of: str = "", **values: Any) -> Part:
    """Return what a table makes, `of` a set. Raises SpecError with the place of what is wrong."""
    try:
        return kind(**values)
    except InputError as error:
        full = error.parameter if error.parameter.startswith("planetary.") else f"{key}.{error.parameter}"
        own = f"{of or values.get('name')}."
        if error.parameter.startswith(own):  # of a set, by its name
            full = f"{key}.{error.parameter.removeprefix(own)}"
        unit = f" {error.unit}" if error.unit else ""
        value = "is missing" if error.value is None else f"= {shown(format_number(error.value))}{unit}"
        raise SpecError(f"{where(full)}: {full} {value}: {error.permitted}", full) from error

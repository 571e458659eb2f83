"""Tables of a planetary train and the gears of its set, with every "auto" resolved mesh by mesh.

A set is `[sun] [planet] [ring]`, with `[planet_2]`, `[sun_2]`, `[ring_2]` where it has them, or lists of
`[[planetary.central]]` and `[[planetary.rim]]`, which are put under the same names: suns before rings, and the rim of the
first central as `planet`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

from gearcad.core.errors import GeometryError, InputError, SpecError, as_choice, format_number, require_number, shown
from gearcad.core.quantities import NOT_GIVEN, FieldSchema
from gearcad.core.records import PerGear, Role
from gearcad.designs.design import Where, require_sane_tables
from gearcad.designs.keys import OF_SETS, SPEEDS, DesignKind, explain_unknown_table, nearest_key
from gearcad.designs.spec import (
    AUTO,
    CLEAR,
    Given,
    Spec,
    backlash_free_distance,
    clear_tip_alteration,
    khk_reminder,
    make_gears,
    require_sound_numbers,
    resolve_profile_shifts,
    resolve_tip_alterations,
)
from gearcad.designs.train_keys import PLANETARY, PRE_STAGE, SET_FIELDS
from gearcad.geometry import Gear, ShiftSplit
from gearcad.planetary.members import Central, Rim, SetMesh
from gearcad.planetary.train_data import TrainData, settle_centre_distance

MAIN = DesignKind.PLANETARY.value

_SUNS, _RINGS, _RIMS = ("sun", "sun_2"), ("ring", "ring_2"), ("planet", "planet_2")
_LISTED = ("central", "rim", "stage")
_NEEDED = "a set needs [sun] and [ring], two suns [sun] and [sun_2], or two rings [ring] and [ring_2]"


class Tables(NamedTuple):
    """Values under their keys; what the user calls a table, where that is otherwise; the tables of centrals in their order,
    with the rim that each meshes; the stages behind the pre-stage, each by its beginning of keys."""

    values: dict[str, Given]
    names: dict[str, str]
    meshes: dict[str, str]
    stages: list[str]


def place_tables(tables: Mapping[str, Any], where: Where) -> Tables:
    """Return the values of a planetary train's tables. Raises SpecError for what it does not have,
    and for a set that is none.
    """
    _require_known(tables, where)
    main = tables.get(MAIN, {})
    listed = {key: _listed(main, key, where) for key in _LISTED}
    values = dict(_values(MAIN, {key: each for key, each in main.items() if key not in _LISTED}, where))
    for table, content in tables.items():
        if table != MAIN:
            values |= _values(table, content, where)
    stages = [f"{MAIN}.stage[{number}]" for number in range(len(listed["stage"]))]
    for stage, content in zip(stages, listed["stage"], strict=True):
        values |= _values(stage, content, where)
    if not (listed["central"] or listed["rim"]):
        return Tables(values, {}, _shorthand(tables, where), stages)
    for table in OF_SETS:
        if table in tables:
            raise SpecError(
                f"{where(table)}: [{table}] cannot stand beside [[{MAIN}.central]]: write the set in one way", table
            )
    names, meshes = _lists(listed, where)
    for table, written in names.items():
        values |= {
            f"{table}.{key[len(written) + 1 :]}": given
            for key, given in _values(written, _content(listed, written), where, fields=SET_FIELDS[table])
            if key != f"{written}.meshes"
        }
    return Tables(values, names, meshes, stages)


def _require_known(tables: Mapping[str, Any], where: Where) -> None:
    for table, content in tables.items():
        if table not in PLANETARY:
            hint = f"; did you mean [{MAIN}.{table}]?" if table in (*_LISTED, "carrier", "pre_stage", SPEEDS) else ""
            permitted = (
                f"cannot stand in the spec of a planetary train{hint}" if hint else explain_unknown_table(table, PLANETARY)
            )
            raise SpecError(f"{where(table)}: {shown(table)}: {permitted}", table)
        if not isinstance(content, Mapping):
            raise SpecError(f"{where(table)}: {table} = {format_number(content)}: must be a table, headed [{table}]", table)
    if MAIN not in tables:
        raise SpecError(
            f"{where('')}: [{MAIN}] is missing: with planets, input, output and fixed it makes a train of the gears"
        )


def _listed(main: Mapping[str, Any], key: str, where: Where) -> list[Mapping[str, Any]]:
    """Return the tables of a list."""
    content = main.get(key, [])
    if not isinstance(content, list) or not all(isinstance(each, Mapping) for each in content):
        full = f"{MAIN}.{key}"
        raise SpecError(f"{where(full)}: {full}: must be headed [[{full}]], once for each", full)
    return content


# ---------------------------------------------------------------------- values


def _values(
    owner: str, content: Mapping[str, Any], where: Where, *, fields: Mapping[str, FieldSchema] | None = None
) -> Iterator[tuple[str, Given]]:
    """Yield every value of a table under its dotted key."""
    known = fields or (PRE_STAGE if owner not in PLANETARY else PLANETARY[owner])
    for field, value in _flat(content):
        key = f"{owner}.{field}"
        spec = known.get(field)
        if spec is None and not (owner == MAIN and field.startswith(f"{SPEEDS}.")) and not (fields and field == "meshes"):
            raise SpecError(f"{where(key)}: {shown(key)}: {_unknown(owner, field, known)}", key)
        require_sane_tables(value, where, key)
        plain = _plain(value, spec)
        if spec is not None and spec.several and not isinstance(plain, tuple) and plain not in spec.words:
            words = "".join(f' or "{word}"' for word in spec.words)
            raise SpecError(f"{where(key)}: {key} = {format_number(value)}: must be a list of numbers{words}", key)
        yield key, Given(plain, key)


def _flat(content: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in content.items():
        if isinstance(value, Mapping) and value:
            yield from _flat(value, f"{before}{key}.")
        else:
            yield before + key, value


def _plain(value: Any, field: FieldSchema | None) -> Any:
    """Whole numbers as floats where floats are meant, and never -0.0; lists of numbers, and one of them, as tuples."""
    if isinstance(value, int) and not isinstance(value, bool) and not (field and field.whole):
        value = float(value)
    if isinstance(value, float):
        value = value + 0.0
    if field is None or not field.several or isinstance(value, str):
        return value
    if isinstance(value, list | tuple):
        return tuple(_plain(each, None) for each in value)
    return (value,) if isinstance(value, float) and float not in field.members else value


def _unknown(owner: str, field: str, known: Mapping[str, FieldSchema]) -> str:
    """Return the end of the message about a key that a table does not have."""
    if field == SPEEDS or any(key.startswith(f"{field}.") for key in known):
        return f"must be a table, headed [{owner}.{field}]"
    homes = [f"[{table}]" for table, keys in PLANETARY.items() if field in keys and table != owner and field not in OF_SETS]
    if homes:
        return f"unknown key here; it belongs in {' or '.join(homes)}"
    if (near := nearest_key(field, known)) is not None:
        return f"unknown key; did you mean {near}?"
    alone = [key for key in known if "." not in key]
    return f"unknown key; permitted are {', '.join(alone)}, and what gears have behind rack., body. and modification."


# ---------------------------------------------------------------------- the set


def _shorthand(tables: Mapping[str, Any], where: Where) -> dict[str, str]:
    """Return the centrals of [sun], [ring] ..., each with the rim that it meshes."""
    for first, second in (_SUNS, _RINGS, _RIMS):
        if second in tables and first not in tables:
            raise SpecError(f"{where(second)}: [{first}] is missing: [{second}] is the second of its kind", second)
    if _RIMS[0] not in tables:
        raise SpecError(f"{where(MAIN)}: [{_RIMS[0]}] is missing: the gears on the carrier")
    return _meshed([table for table in (*_SUNS, *_RINGS) if table in tables], _RIMS[1] in tables, where)


def _meshed(centrals: list[str], stepped: bool, where: Where) -> dict[str, str]:
    if len(centrals) != 2:
        there = " and ".join(f"[{table}]" for table in centrals) or "neither"
        raise SpecError(f"{where(MAIN)}: has {there}: {_NEEDED}")
    return {centrals[0]: _RIMS[0], centrals[1]: _RIMS[1] if stepped else _RIMS[0]}


def _lists(listed: Mapping[str, list[Mapping[str, Any]]], where: Where) -> tuple[dict[str, str], dict[str, str]]:
    """Return the written name of each table of the set, and the rim that each central meshes. Raises SpecError."""
    centrals, rims = listed["central"], listed["rim"]
    for key, found, counts in (("central", centrals, (2,)), ("rim", rims, (1, 2))):
        if len(found) not in counts:
            wanted = " or ".join(map(str, counts))
            raise SpecError(f"{where(MAIN)}: has {len(found)} [[{MAIN}.{key}]]: a train needs {wanted}")
    for key in ("central", "rim"):
        for number, each in enumerate(listed[key]):
            for field, kind in (("name", str), ("teeth", int)):
                full = f"{MAIN}.{key}[{number}].{field}"
                if not isinstance(each.get(field), kind):
                    permitted = "a text" if kind is str else "a whole number, negative of a ring"
                    state = f" = {format_number(each[field])}" if field in each else " is missing"
                    raise SpecError(f"{where(full)}: {full}{state}: must be {permitted}", full)
    order = sorted(range(2), key=lambda number: centrals[number]["teeth"] < 0)
    meshed = [_rim_of(centrals, rims, number, where) for number in order]
    if len(rims) == 2 and meshed[0] == meshed[1]:
        full = f"{MAIN}.central[{order[1]}].meshes"
        other = rims[1 - meshed[0]]["name"]
        raise SpecError(
            f"{where(full)}: {full} = {rims[meshed[0]]['name']!r}: must be {other!r}: each rim meshes with one", full
        )
    suns = [number for number in order if centrals[number]["teeth"] >= 0]
    tables = [*zip(_SUNS, suns, strict=False), *zip(_RINGS, order[len(suns) :], strict=False)]
    names = {table: f"{MAIN}.central[{number}]" for table, number in tables}
    names |= {table: f"{MAIN}.rim[{rim}]" for table, rim in zip(_RIMS, dict.fromkeys(meshed), strict=False)}
    return names, _meshed([table for table, _ in tables], len(rims) == 2, where)


def _rim_of(centrals: list[Mapping[str, Any]], rims: list[Mapping[str, Any]], number: int, where: Where) -> int:
    """Return the number of the rim that a central meshes."""
    known = [rim["name"] for rim in rims]
    meshes = centrals[number].get("meshes", known[0] if len(rims) == 1 else None)
    if meshes in known:
        return known.index(meshes)
    full = f"{MAIN}.central[{number}].meshes"
    state = " is missing" if meshes is None else f" = {format_number(meshes)}"
    raise SpecError(f"{where(full)}: {full}{state}: must be {' or '.join(map(repr, known))}, a rim of the planets", full)


def _content(listed: Mapping[str, list[Mapping[str, Any]]], written: str) -> Mapping[str, Any]:
    """Return the table that the user calls so."""
    key, _, number = written.removeprefix(f"{MAIN}.").partition("[")
    return listed[key][int(number[:-1])]


_ROUNDING = 1e-9
"""Change of a tip alteration, in normal modules, that is rounding."""

Inputs = dict[str, dict[str, Any]]
"""Keyword arguments of each gear, by its table."""


class TableMesh(NamedTuple):
    """The tables of a central and of the rim that it meshes, and whether the central is a ring."""

    central: str
    rim: str
    ring: bool

    def roles(self, inputs: Inputs) -> PerGear[str]:
        """Return the tables of the pinion and of the wheel, as SetMesh orders them."""
        first = not self.ring and inputs[self.central]["teeth"] <= inputs[self.rim]["teeth"]
        return PerGear(self.central, self.rim) if first else PerGear(self.rim, self.central)

    def signed(self, distance: float) -> float:
        """Return a centre distance as a pair has it: negative with a ring."""
        return -distance if self.ring else distance

    def automatic(self, inputs: Inputs) -> int:
        """Return the number of profile shifts in this mesh that are to be derived."""
        return sum(inputs[table].get("profile_shift") == AUTO for table in (self.central, self.rim))


@dataclass(frozen=True)
class TrainGears:
    """The meshes of a set by their tables, and the spec that notes what became of each "auto"."""

    spec: Spec
    meshes: tuple[TableMesh, ...]

    def made(self, inputs: Inputs) -> tuple[dict[str, Gear], float | None]:
        """Return the gears by their tables, and the centre distance (mm) if it is given or shifts follow from it.

        A ring whose shift would fit with the other sign is asked about it. Raises InputError: parameters are led by their
        table, "centre_distance" is that of the train.
        """
        with ExitStack() as reminders:
            for table in (mesh.central for mesh in self.meshes if mesh.ring):
                tried = partial(self._tried, inputs, table)
                reminders.enter_context(khk_reminder(table, inputs[table], tried))
            return self._made({table: dict(gear) for table, gear in inputs.items()})

    def _tried(self, inputs: Inputs, table: str, gear: Mapping[str, Any]) -> object:
        """Return the gears with another one among them, without a trace among the values. Raises InputError."""
        trial = replace(self, spec=replace(self.spec, values=dict(self.spec.values)))
        return trial._made({each: dict(own) for each, own in inputs.items()} | {table: dict(gear)})

    def _made(self, inputs: Inputs) -> tuple[dict[str, Gear], float | None]:
        for table, gear in inputs.items():
            require_sound_numbers(gear, table)
        automatic = {table: _automatic(gear) for table, gear in inputs.items()}
        given = self._given_distance()
        distance = self._implied_distance(inputs) if given is None else given
        self._resolve_shifts(inputs, distance)
        self._resolve_tips(inputs, distance)
        gears: dict[str, Gear] = {}
        for mesh in self.meshes:
            roles = mesh.roles(inputs)
            with self._of_mesh(mesh, roles):
                pair = make_gears(roles.map(inputs.__getitem__), roles.map(automatic.__getitem__), mesh.signed(distance))
            gears = dict(zip(roles, pair, strict=True)) | gears
        follows = given is not None or any("profile_shift" in names for names in automatic.values())
        found = distance if follows else None
        for mesh, fitted in zip(self.meshes, self._fitted(gears, inputs, found), strict=True):
            gears |= {mesh.central: self._cleared(mesh, fitted)}
        return gears, found

    def _fitted(self, gears: Mapping[str, Gear], inputs: Inputs, distance: float | None) -> tuple[SetMesh, ...]:
        """Return the meshes of the gears at one centre distance, given or not. Raises InputError."""
        names = {table: str(inputs[table]["name"]) for table in gears}
        train = TrainData(
            planets=1,
            centrals=tuple(
                Central(name=names[mesh.central], gear=gears[mesh.central], meshes=names[mesh.rim]) for mesh in self.meshes
            ),
            rims=tuple(Rim(name=names[rim], gear=gears[rim]) for rim in dict.fromkeys(mesh.rim for mesh in self.meshes)),
            input="",
            output="",
            centre_distance=NOT_GIVEN if distance is None else distance,
        )
        try:
            settle_centre_distance(train)
        except InputError as error:
            raise self._of_tables(error, names, inputs) from error
        return train.meshes

    def _of_tables(self, error: InputError, names: Mapping[str, str], inputs: Inputs) -> InputError:
        """Return an error of a train, whose parameter begins with the name of a gear, or of a mesh and a role, as one of the
        table.
        """
        parameter, permitted = error.parameter, error.permitted
        owner = next((table for table, name in names.items() if parameter.startswith(f"{name}.")), None)
        if owner is not None:
            parameter = parameter.replace(names[owner], owner, 1)
        for mesh in self.meshes:
            led = f"{names[mesh.central]}-{names[mesh.rim]}."
            if parameter.startswith(led):
                roles = mesh.roles(inputs)
                parameter, permitted = _called(parameter.removeprefix(led), roles), _called(permitted, roles)
        return type(error)(parameter, error.value, permitted, error.unit)

    # ------------------------------------------------------------------ centre distance

    def _given_distance(self) -> float | None:
        given = self.spec.values.get(f"{MAIN}.centre_distance")
        if given is None:
            return None
        require_number("centre_distance", given.value, "mm", above=0.0)
        return float(given.value)

    def _implied_distance(self, inputs: Inputs) -> float:
        """Return the one without backlash of the first mesh whose shifts are numbers. Raises InputError."""
        for mesh in self.meshes:
            if mesh.automatic(inputs):
                continue
            roles = mesh.roles(inputs)
            pair = roles.map(inputs.__getitem__)
            with self._of_mesh(mesh, roles):
                return abs(backlash_free_distance(pair, sum(resolve_profile_shifts(pair, None, None))))
        table = next(table for table in inputs if inputs[table].get("profile_shift") == AUTO)
        raise GeometryError(f"{table}.profile_shift", AUTO, f"needs centre_distance in [{MAIN}], or numbers in one mesh")

    # ------------------------------------------------------------------ "auto"

    def _resolve_shifts(self, inputs: Inputs, distance: float) -> None:
        """Replace each "auto": first in the mesh that has fewest, so that its mate's is known in the other."""
        split = self._split(inputs)
        for _ in self.meshes:
            mesh = min(self.meshes, key=lambda mesh: mesh.automatic(inputs) or len(Role) + 1)
            if not (count := mesh.automatic(inputs)):
                return
            roles = mesh.roles(inputs)
            with self._of_mesh(mesh, roles):
                both = split if count == len(Role) else None
                shifts = resolve_profile_shifts(roles.map(inputs.__getitem__), mesh.signed(distance), both)
            for table, shift in zip(roles, shifts, strict=True):
                if inputs[table].get("profile_shift") == AUTO:
                    inputs[table]["profile_shift"] = shift
                    self._note(table, "profile_shift", shift, f"{AUTO}: centre distance {distance:g} mm asks for it")

    def _split(self, inputs: Inputs) -> ShiftSplit | None:
        """Return how two automatic profile shifts share their sum, or None if the spec does not say.

        Raises GeometryError if no mesh has two automatic shifts.
        """
        given = self.spec.values.get(f"{MAIN}.profile_shift_split")
        if given is None:
            return None
        split = as_choice("profile_shift_split", given.value, ShiftSplit)
        if all(mesh.automatic(inputs) < len(Role) for mesh in self.meshes):
            raise GeometryError("profile_shift_split", split, 'needs profile_shift = "auto" on both gears of a mesh')
        return split

    def _resolve_tips(self, inputs: Inputs, distance: float) -> None:
        """Replace each "auto" by what clears the roots of all mates, and "clear" by what clears the rim's fillet."""
        found: dict[str, list[float]] = {}
        for mesh in self.meshes:
            roles = mesh.roles(inputs)
            pair = roles.map(inputs.__getitem__)
            with self._of_mesh(mesh, roles):
                total = sum(pair.map(lambda gear: gear.get("profile_shift", 0.0)))
                for table, tip in zip(roles, resolve_tip_alterations(pair, total, mesh.signed(distance)), strict=True):
                    found.setdefault(table, []).append(tip)
        written = {table: inputs[table].get("tip_alteration", AUTO) for table in found}
        for table, tips in found.items():
            inputs[table] |= {"profile_shift": inputs[table].get("profile_shift", 0.0), "tip_alteration": min(tips)}
            if written[table] == AUTO:
                self._note(table, "tip_alteration", min(tips), AUTO)
        for mesh in self.meshes:
            if written[mesh.central] == CLEAR:
                self._clear(mesh, inputs, distance)

    def _clear(self, mesh: TableMesh, inputs: Inputs, distance: float) -> None:
        """End the flank of a ring on the form circle of its rim."""
        ring = inputs[mesh.central]
        if "tip_diameter" in ring:
            permitted = f'must be left out, or tip_alteration not be "{CLEAR}"'
            raise GeometryError(f"{mesh.central}.tip_diameter", ring["tip_diameter"], permitted, "mm")
        roles = mesh.roles(inputs)
        with self._of_mesh(mesh, roles):
            tip = clear_tip_alteration(roles.map(inputs.__getitem__), mesh.signed(distance))
        ring["tip_alteration"] = tip
        self._note(mesh.central, "tip_alteration", tip, CLEAR)

    def _cleared(self, mesh: TableMesh, fitted: SetMesh) -> Gear:
        """Return the central; a ring that is to be clear is drawn in further if the edge of its tip still cuts the rim's
        fillet.
        """
        central = fitted.central.gear
        given = self.spec.values.get(f"{mesh.central}.tip_alteration")
        if given is None or given.note != CLEAR or (clear := fitted.pair.clear_tip_diameter) is None:
            return central
        change = (clear - central.tip_diameter) / (2 * central.normal_module)
        if change >= -_ROUNDING:
            return central
        self._note(mesh.central, "tip_alteration", given.value + change, CLEAR)
        return replace(central, tip_alteration=given.value + change)

    def _usual_teeth(self, mesh: TableMesh) -> str:
        """Return a hint at the number of teeth of a ring about simple planets that asks for no shift: |z_r| = z_s + 2 z_p."""
        sun = next((other.central for other in self.meshes if not other.ring and other.rim == mesh.rim), None)
        teeth = [self.spec.values.get(f"{table}.teeth") for table in (sun, mesh.rim, mesh.central)]
        if not mesh.ring or any(each is None or not isinstance(each.value, int) for each in teeth):
            return ""
        of_sun, of_planet, of_ring = (each.value for each in teeth if each is not None)
        usual = -(of_sun + 2 * of_planet)
        return "" if usual == of_ring else f"; a ring of {usual} teeth takes {of_sun} and {of_planet} without it"

    def _note(self, table: str, key: str, value: float, note: str) -> None:
        """Keep what stands for a word among the values of the spec."""
        full = f"{table}.{key}"
        self.spec.values[full] = Given(value, self.spec.values.get(full, Given(AUTO, full)).key, note)

    @contextmanager
    def _of_mesh(self, mesh: TableMesh, roles: PerGear[str]) -> Iterator[None]:
        """Turn an error about pinion, wheel or their centre distance into one about the tables and the train."""
        try:
            yield
        except InputError as error:
            head, _, rest = error.parameter.partition(".")
            role = next((role for role in Role if role.value == head), None)
            if role is not None:
                permitted = _called(error.permitted, roles)
                raise type(error)(f"{roles.pick(role)}.{rest}", error.value, permitted, error.unit) from error
            if error.parameter != "centre_distance" or not isinstance(error.value, float):
                raise
            sign = f", where it counts as {format_number(error.value)} mm" if mesh.ring else ""
            asked = _called(error.permitted, roles)
            permitted = f"in the mesh of {mesh.central} and {mesh.rim}{sign}: {asked}{self._usual_teeth(mesh)}"
            raise type(error)(error.parameter, abs(error.value), permitted, error.unit) from error


def _called(text: str, roles: PerGear[str]) -> str:
    """Return a text about pinion and wheel with their tables in place of these."""
    names = {role.value: table for role, table in roles.items()}
    return re.sub(r"\b(?:the )?(pinion|wheel)\b", lambda found: names[found[1]], text)


def _automatic(gear: Mapping[str, Any]) -> list[str]:
    """Return the fields of a gear that are to be derived."""
    defaults = {"profile_shift": 0.0, "tip_alteration": AUTO}
    return [key for key, default in defaults.items() if gear.get(key, default) in (AUTO, CLEAR)]

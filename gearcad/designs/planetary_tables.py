"""The tables of a planetary train, written in either of two ways, as values under one set of keys.

A set is `[sun] [planet] [ring]`, with `[planet_2]`, `[sun_2]`, `[ring_2]` where it has them, or lists of
`[[planetary.central]]` and `[[planetary.rim]]`, which are put under the same names: suns before rings, and the rim of the
first central as `planet`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from gearcad.designs.design import DesignKind
from gearcad.designs.files import Where, require_sane_tables
from gearcad.designs.keys import OF_SETS, SPEEDS, explain_unknown_table, nearest_key
from gearcad.designs.planetary_keys import PLANETARY, PRE_STAGE, SET_FIELDS
from gearcad.designs.spec import Given
from gearcad.errors import SpecError, format_number, shown
from gearcad.schema import FieldSchema

__all__ = ["MAIN", "Tables", "place_tables"]

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
    """The values of a planetary train's tables. Raises SpecError for what it does not have, and for a set that is none."""
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
    """The tables of a list."""
    content = main.get(key, [])
    if not isinstance(content, list) or not all(isinstance(each, Mapping) for each in content):
        full = f"{MAIN}.{key}"
        raise SpecError(f"{where(full)}: {full}: must be headed [[{full}]], once for each", full)
    return content


# ---------------------------------------------------------------------- values


def _values(
    owner: str, content: Mapping[str, Any], where: Where, *, fields: Mapping[str, FieldSchema] | None = None
) -> Iterator[tuple[str, Given]]:
    """Every value of a table under its dotted key."""
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
    """The end of the message about a key that a table does not have."""
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
    """The centrals of [sun], [ring] ..., each with the rim that it meshes."""
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
    """What the user calls the tables of the set, and the centrals among them with the rim that each meshes."""
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
    """The number of the rim that a central meshes."""
    known = [rim["name"] for rim in rims]
    meshes = centrals[number].get("meshes", known[0] if len(rims) == 1 else None)
    if meshes in known:
        return known.index(meshes)
    full = f"{MAIN}.central[{number}].meshes"
    state = " is missing" if meshes is None else f" = {format_number(meshes)}"
    raise SpecError(f"{where(full)}: {full}{state}: must be {' or '.join(map(repr, known))}, a rim of the planets", full)


def _content(listed: Mapping[str, list[Mapping[str, Any]]], written: str) -> Mapping[str, Any]:
    """The table that the user calls so."""
    key, _, number = written.removeprefix(f"{MAIN}.").partition("[")
    return listed[key][int(number[:-1])]

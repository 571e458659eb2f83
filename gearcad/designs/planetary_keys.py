"""The keys of a planetary train: of its gears, of its stages and of what stands beside them."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from gearcad.designs.keys import (
    BESIDE,
    FIELDS,
    GEAR_FIELDS,
    OF_SETS,
    OF_SPECS,
    SHARED,
    fields_of_mates,
    flat_fields,
    names_of_materials,
    nearest_key,
)
from gearcad.dynamics.options import DynamicsOptions
from gearcad.per_gear import Role
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, Rim, TrainLoad
from gearcad.schema import FieldSchema, schema_of

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["PLANETARY", "PRE_STAGE", "SET_FIELDS", "explain_unknown_planetary_column"]


def _plain(kind: type[DataclassInstance], *others: str) -> dict[str, FieldSchema]:
    """The fields of a type that are no parts, without `others`."""
    return {name: each for name, each in schema_of(kind).items() if each.part is None and name not in others}


_CENTRAL = fields_of_mates() | _plain(Central, "meshes")
_RIM = fields_of_mates() | _plain(Rim)

SET_FIELDS: dict[str, dict[str, FieldSchema]] = {table: _RIM if table.startswith("planet") else _CENTRAL for table in OF_SETS}
"""The tables of the gears of a set."""

PRE_STAGE: dict[str, FieldSchema] = {
    **{key: field for key, field in FIELDS["pair"].items() if key != "mounting_distance"},
    **_plain(PairStage, "pinion", "wheel"),
    **{f"{role.value}.{key}": field for role in Role for key, field in GEAR_FIELDS.items()},
    **{f"{role.value}.on": schema_of(PairStage)[role.value] for role in Role},
}
"""The keys of a pair before or behind the set; `pinion.on` is the member that its pinion turns with."""

_OF_VIBRATION = ("speed_from", "speed_to", "speeds", "harmonics", "stiffness", "damping_ratio")

PLANETARY: dict[str, dict[str, FieldSchema]] = {
    "planetary": {
        **_plain(PlanetaryTrain, "centrals", "rims", "stages"),
        "profile_shift_split": OF_SPECS["profile_shift_split"],
        **{key: GEAR_FIELDS[key] for key in SHARED},
        **{f"carrier.{key}": field for key, field in _plain(Carrier).items()},
        **{f"pre_stage.{key}": field for key, field in PRE_STAGE.items()},
    },
    **SET_FIELDS,
    **{table: dict(flat_fields(kind)) for table, kind in {**BESIDE, "load": TrainLoad}.items() if table != "mounting"},
    "dynamics": {key: schema_of(DynamicsOptions)[key] for key in _OF_VIBRATION},
}
PLANETARY["material"] |= names_of_materials(*OF_SETS)
"""The tables of a planetary train, likewise: its [load] is that of the output."""


def explain_unknown_planetary_column(heading: str) -> str:
    """The end of the message about a heading of a table of planetary trains that is no key."""
    first, dot, rest = heading.partition(".")
    near = difflib.get_close_matches(first.lower(), PLANETARY, n=1, cutoff=0.75) if dot else []
    table, field = (near[0], rest) if near else ("planetary", heading)
    if heading.lower() == "name":
        return "unknown column; did you mean name?"
    for meant in (field, nearest_key(field, PLANETARY[table])):
        homes = [f"{owner}.{meant}" for owner in dict.fromkeys((table, *PLANETARY)) if meant in PLANETARY[owner]]
        if homes:
            found = homes[:1] if homes[0].startswith(f"{table}.") else homes
            return f"unknown column; did you mean {' or '.join(found)}?"
    return "unknown column; must be name, or a key of a spec with its table, such as planetary.planets or sun.teeth"

"""The tables of keys that the manual shows: every key of a spec once, in the table that first has it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.designs.keys import FIELDS, OF_SHAFTS, SHAFTS, SHARED
from gearcad.designs.shaft_keys import shaft_fields
from gearcad.designs.train_keys import PLANETARY, PRE_STAGE, TRAIN
from gearcad.dynamics.trains.shaft_layout import ShaftGear
from gearcad.identify import Measurements

__all__ = ["key_tables"]

_PARTS = ("rack", "cutter", "premachining", "finishing", "making", "double_helix", "body", "modification")
_BESIDE = ("material", "load", "mounting", "rating", "check", "mesh", "dynamics", "drawing", "verify", "modify")


@cache
def key_tables() -> Mapping[str, Mapping[str, FieldSchema]]:
    """The keys of each table, and what they say of themselves."""
    gear = FIELDS["gear"]
    own_drawing = {key: each for key, each in gear.items() if key.startswith("drawing.")}
    mates = FIELDS["pinion"]
    found = {
        "gear": {key: each for key, each in gear.items() if key.partition(".")[0] not in (*_PARTS, "drawing")},
        **{f"gear.{part}": {key: each for key, each in gear.items() if key.partition(".")[0] == part} for part in _PARTS},
        "pair": {key: each for key, each in FIELDS["pair"].items() if key not in SHARED},
        "rack": {key: each for key, each in FIELDS["rack"].items() if key.partition(".")[0] not in ("material", "drawing")},
        **_spline(),
        **_shafts(),
        **{table: dict(FIELDS[table]) for table in _BESIDE},
        "part_drawing": own_drawing,
        "train": dict(TRAIN["train"]),
        **{f"train.{part}": dict(TRAIN[part]) for part in ("inertia", "shaft", "mesh", "excitation")},
        "train.shaft.gears": dict(schema_of(ShaftGear)),
        **_planetary(mates),
        "measured": dict(schema_of(Measurements)),
    }
    found["material"] |= {key: each for key, each in PLANETARY["material"].items() if key not in FIELDS["material"]}
    transient = {key: each for key, each in found["dynamics"].items() if key.startswith("transient.")}
    found["dynamics"] = {key: each for key, each in found["dynamics"].items() if key not in transient}
    found["dynamics.transient"] = {key.removeprefix("transient."): each for key, each in transient.items()}
    return found


def _spline() -> dict[str, dict[str, FieldSchema]]:
    """The keys of [spline], and those of its shaft and its hub in tables of their own."""
    found: dict[str, dict[str, FieldSchema]] = {"spline": {}, "spline.shaft": {}, "spline.hub": {}}
    for key, each in FIELDS["spline"].items():
        part, dot, _ = key.partition(".")
        found[f"spline.{part}" if dot else "spline"][key] = each
    return found


def _shafts() -> dict[str, dict[str, FieldSchema]]:
    """The keys of [shafts], of the lists that describe a shaft, and of a gear on one."""
    found: dict[str, dict[str, FieldSchema]] = {SHAFTS: {}, **{name: {} for name in OF_SHAFTS}, "shafted_gear": {}}
    for key, each in shaft_fields().items():
        table, _, field = key.partition(".")
        if table == SHAFTS:
            found[SHAFTS][field] = each
        elif table == "pinion" and "[]" not in field:
            found["shafted_gear"][field] = each
        elif table.endswith("[]"):
            found[table.removesuffix("[]")][field] = each
    return found


def _planetary(mates: Mapping[str, FieldSchema]) -> dict[str, dict[str, FieldSchema]]:
    main = {key: each for key, each in PLANETARY["planetary"].items() if key not in SHARED}
    carrier = {key.removeprefix("carrier."): each for key, each in main.items() if key.startswith("carrier.")}
    own = {key: each for key, each in PRE_STAGE.items() if FIELDS["pair"].get(key) != each}
    stage = {key: each for key, each in own.items() if key.endswith(".on") or key.partition(".")[0] not in ("pinion", "wheel")}
    return {
        "planetary": {key: each for key, each in main.items() if key.partition(".")[0] not in ("carrier", "pre_stage")},
        "planetary.carrier": carrier,
        "planetary.pre_stage": stage,
        "planetary.central": {key: each for key, each in PLANETARY["sun"].items() if mates.get(key) != each},
        "planetary.rim": {key: each for key, each in PLANETARY["planet"].items() if mates.get(key) != each},
        "planetary.load": dict(PLANETARY["load"]),
    }

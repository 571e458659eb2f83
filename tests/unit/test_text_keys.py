"""Keys of a spec that take a text: anything else is one line that names the key, in a spec and from Python."""

from __future__ import annotations

import copy
import dataclasses
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from gearcad import BasicRack, Gear, GearPair, Load, Rack
from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.designs import design_from_tables, read_spec
from gearcad.designs.keys import BESIDE, FIELDS
from gearcad.designs.train_keys import PLANETARY, TRAIN_PARTS
from gearcad.drawing.options import PartDrawing

TEMPLATES = Path(__file__).parents[2] / "templates"
NO_TEXTS = (5, 1.5, True, [1], {"some": "word"})

GEAR = {"teeth": 20, "normal_module": 2.0, "face_width": 10.0}
RACK = {"teeth": 8, "normal_module": 2.0, "face_width": 10.0, "height": 20.0}
PAIR = {"pair": {}, "pinion": GEAR, "wheel": GEAR | {"teeth": 30}}
RACK_PAIR = {"pair": {}, "pinion": GEAR, "rack": RACK}
SETS = ("planetary-24-21-66.toml", "planetary-alm.toml")


def takes_text(field: FieldSchema) -> bool:
    return field.texts or set(field.members) <= {str, type(None)}


def spec(name: str) -> dict[str, Any]:
    return tomllib.loads((TEMPLATES / name).read_text(encoding="utf-8"))


def base_of(table: str, key: str) -> Mapping[str, Any]:
    """The tables of a design in which a key can stand."""
    if table == "rack":
        return {"rack": RACK} if not key.startswith("material") else RACK_PAIR
    if table == "gear":
        return {"gear": GEAR}
    return RACK_PAIR if (table, key) == ("material", "rack") else PAIR


def cases() -> Iterator[tuple[Mapping[str, Any], tuple[str | int, ...]]]:
    """Tables of a design, and the way to a key that takes a text."""
    for table in FIELDS:
        yield from (
            (base_of(table, key), (table, *key.split("."))) for key, field in FIELDS[table].items() if takes_text(field)
        )
    for each in map(spec, SETS):
        each["planetary"].setdefault("pre_stage", {"pinion": GEAR, "wheel": PAIR["wheel"]})
        for table, fields in PLANETARY.items():
            if table in each or table in BESIDE:
                yield from ((each, (table, *key.split("."))) for key, field in fields.items() if takes_text(field))
    train = spec("train-1-stage.toml")
    for table, kind in TRAIN_PARTS.items():
        yield from ((train, ("train", table, 0, key)) for key, field in schema_of(kind).items() if takes_text(field))


CASES = list(cases())


def test_every_table_has_some() -> None:
    assert {path[0] for _, path in CASES} >= {*FIELDS, *PLANETARY, "train"} - {
        "load",
        "mounting",
        "rating",
        "planet_2",
        "sun_2",
    }
    assert len(CASES) > 200


@pytest.mark.parametrize(("base", "path"), CASES, ids=lambda each: ".".join(map(str, each)) if isinstance(each, tuple) else "")
def test_a_key_that_takes_a_text_says_so(base: Mapping[str, Any], path: tuple[str | int, ...]) -> None:
    for value in NO_TEXTS:
        tables = copy.deepcopy(dict(base))
        holder: Any = tables
        for step in path[:-1]:
            holder = holder.setdefault(step, {}) if isinstance(holder, dict) else holder[step]
        holder[path[-1]] = value
        with pytest.raises(SpecError) as caught:
            design_from_tables(tables, where=lambda key: f"some.toml, {key}", default_name="some")
        assert str(path[-1]) in str(caught.value)
        assert "\n" not in str(caught.value)


def instances() -> Iterator[Any]:
    gear, train = Gear(**GEAR), read_spec(TEMPLATES / "train-1-stage.toml").train
    yield from (gear, GearPair(pinion=gear, wheel=gear), Rack(**RACK), BasicRack(), PartDrawing())
    yield from (kind(torque=5.0) if kind is Load else kind() for kind in BESIDE.values())
    yield from (train, train.inertias[0], train.shafts[0], train.meshes[0])
    yield read_spec(TEMPLATES / SETS[0]).train


@pytest.mark.parametrize("instance", list(instances()), ids=lambda each: type(each).__name__)
def test_a_field_that_takes_a_text_says_so(instance: Any) -> None:
    for name, field in schema_of(type(instance)).items():
        if takes_text(field):
            for value in (5, 1.5, True, [1]):
                with pytest.raises(ParameterError, match=name):
                    dataclasses.replace(instance, **{name: value})

"""Keys of a spec that take a text, and the normal diametral pitch instead of the module."""

from __future__ import annotations

import copy
import dataclasses
import json
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gearcad import BasicRack, Gear, GearPair, GeometryError, Load, Rack
from gearcad.batch.study import plan_study
from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.designs import design_from_tables, read_spec
from gearcad.designs.keys import BESIDE, FIELDS, DesignKind
from gearcad.designs.table import fault_alone, missing_faults
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


INCH = 25.4


def _gear(**changes: Any) -> Gear:
    return Gear(**{"teeth": 20, "face_width": 20.0, **changes})


def test_the_module_follows_from_the_pitch_and_the_other_way_round() -> None:
    inches, metric = _gear(normal_diametral_pitch=8), _gear(normal_module=3.175)
    assert inches.normal_module == INCH / 8
    assert inches.reference_diameter == pytest.approx(20 / 8 * INCH, rel=1e-15)
    assert metric.normal_diametral_pitch == INCH / 3.175
    assert inches == metric
    assert repr(inches) == "Gear(teeth=20, normal_diametral_pitch=8.0, face_width=20.0)"
    assert repr(metric) == "Gear(teeth=20, normal_module=3.175, face_width=20.0)"
    assert eval(repr(inches)) == inches
    assert inches.to_dict() == metric.to_dict()
    assert json.loads(json.dumps(inches.to_dict()))["normal_diametral_pitch"] == 8.0


def test_replace() -> None:
    inches = _gear(normal_diametral_pitch=8)
    assert replace(inches, teeth=30).normal_module == INCH / 8
    assert replace(inches, normal_diametral_pitch=10).normal_module == 2.54
    assert replace(inches, normal_module=2.0, normal_diametral_pitch=None).normal_diametral_pitch == 12.7
    metric = _gear(normal_module=2.0)
    assert replace(metric, normal_module=4.0).normal_diametral_pitch == 6.35
    assert replace(metric, normal_module=None, normal_diametral_pitch=8).normal_module == 3.175
    with pytest.raises(GeometryError, match="must be left out where normal_module is given"):
        replace(metric, normal_diametral_pitch=8)


def test_both_neither_and_wrong_ones_are_one_line() -> None:
    for changes, message in (
        (
            {},
            "normal_module = None: must be a number at least 0.01 mm and at most 200 mm, or give normal_diametral_pitch",
        ),
        (
            {"normal_module": 2, "normal_diametral_pitch": 8},
            "normal_diametral_pitch = 8 1/inch: must be left out where normal_module is given (2 mm is 12.7/inch)",
        ),
        (
            {"normal_diametral_pitch": 0},
            "normal_diametral_pitch = 0 1/inch: must be a number at least 0.127 1/inch and at most 2540",
        ),
        ({"normal_diametral_pitch": "8"}, "normal_diametral_pitch = '8': must be a number"),
    ):
        with pytest.raises((ParameterError, GeometryError)) as refused:
            _gear(**changes)
        assert str(refused.value).startswith(message)


SPEC = """[pair]
{pair}
centre_distance = 80.0
[pinion]
teeth = 20
face_width = 25.4
profile_shift = "auto"
{pinion}
[wheel]
teeth = 30
face_width = 25.4
profile_shift = "auto"
"""


def _spec(folder: Path, pair: str = "", pinion: str = "") -> Path:
    path = folder / "inches.toml"
    path.write_text(SPEC.format(pair=pair, pinion=pinion), encoding="utf-8")
    return path


def test_in_a_spec_for_both_gears_and_for_one(tmp_path: Path) -> None:
    pair = read_spec(_spec(tmp_path, "normal_diametral_pitch = 8")).pair
    assert [gear.normal_module for gear in pair.gears] == [3.175, 3.175]
    assert pair.circumferential_backlash == pytest.approx(0, abs=1e-9)  # both shifts were found for that module
    own = read_spec(_spec(tmp_path, "normal_module = 3.175", "normal_diametral_pitch = 8")).pair
    assert repr(own.pinion).startswith("Gear(name='pinion', teeth=20, normal_diametral_pitch=8.0")
    assert own.circumferential_backlash == pytest.approx(0, abs=1e-9)


def test_faults_of_specs_name_what_was_written(tmp_path: Path) -> None:
    for pair, pinion, message in (
        (
            "",
            "",
            "line 4: pinion.normal_module is missing: must be a number at least 0.01 mm and at most 200 mm, or give",
        ),
        (
            "normal_module = 3\nnormal_diametral_pitch = 8",
            "",
            "line 3: pair.normal_diametral_pitch = 8 1/inch: must be left",
        ),
        ("normal_diametral_pitch = -8", "", "line 2: pair.normal_diametral_pitch = -8 1/inch: must be a number at least 0.127"),
        (
            "normal_diametral_pitch = 8",
            "normal_module = 3",
            "wheel.normal_module = 3.175 mm (derived): must be 3 mm, as on",
        ),
        ("diametral_pitch = 8", "", "unknown key; did you mean normal_diametral_pitch?"),
    ):
        with pytest.raises(SpecError) as refused:
            read_spec(_spec(tmp_path, pair, pinion))
        assert message in str(refused.value)


def test_faults_of_tables() -> None:
    key = "pair.normal_diametral_pitch"
    assert fault_alone(key, 8.0, str) is None
    fault = fault_alone(key, -8.0, str)
    assert fault is not None and fault.key == key
    given = {key, "pinion.teeth", "pinion.face_width", "wheel.teeth", "wheel.face_width"}
    assert list(missing_faults(given, DesignKind.PAIR, str)) == []
    assert [fault.key for fault in missing_faults(given - {key}, DesignKind.PAIR, str)] == ["pinion.normal_module"]


def test_a_study_varies_one_instead_of_the_other(tmp_path: Path) -> None:
    inches = _spec(tmp_path, "normal_diametral_pitch = 8")
    for spec, varied, gone in (
        (inches, "normal_diametral_pitch=8,10", "pair.normal_module"),
        (inches, "normal_module=2,3", "pair.normal_diametral_pitch"),
    ):
        study = plan_study(spec, [varied])
        assert f"pair.{varied.partition('=')[0]}" in study.keys
        assert gone not in study.keys


def test_a_ring_in_inches() -> None:
    tables = {"gear": {"teeth": -70, "normal_diametral_pitch": 8, "face_width": 20}}
    ring = design_from_tables(tables, where=str, default_name="ring").gear
    assert ring.reference_diameter == -70 * 3.175

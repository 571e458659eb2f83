"""Texts of specs, edited and written; keys that take a text; the normal diametral pitch instead of the module."""

import copy
import dataclasses
import json
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.specs import TEMPLATES
from support.strategies import MODIFICATIONS, build_pair, modified, pair_inputs

from gearcad import BasicRack, Gear, GearPair, GeometryError, Load, Material, Rack
from gearcad.batch.study import plan_study
from gearcad.core.errors import GearcadError, ParameterError, SpecError
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.designs import PairDesign, design_from_tables, read_spec
from gearcad.designs.keys import BESIDE, FIELDS, DesignKind
from gearcad.designs.reader import edit_spec, starter_text, starters
from gearcad.designs.spec_writers import pair_text
from gearcad.designs.table import fault_alone, missing_faults
from gearcad.designs.train_keys import PLANETARY, TRAIN_PARTS
from gearcad.drawing.options import PartDrawing
from gearcad.rating.editions import Edition
from gearcad.rating.options import RatingOptions

CHANGES: dict[str, float | str] = {
    "pair.name": "fzg-c-modified",
    "pinion.modification.tip_relief": 35.0,
    "pinion.modification.tip_relief_length": 4.95,
    "pinion.modification.tip_relief_shape": "parabolic",
    "wheel.modification.tip_relief": 39.0,
    "wheel.modification.tip_relief_length": 5.2,
}

NOTES = {"pinion.modification.tip_relief": "µm"}


def test_a_starter_gets_its_keys_and_keeps_its_comments(tmp_path: Path) -> None:
    text = (TEMPLATES / "fzg-c.toml").read_text(encoding="utf-8")
    edited = edit_spec(text, CHANGES, NOTES)
    old, new = text.splitlines(), edited.splitlines()
    changed = [line for line in new if line not in old]
    assert changed == [
        'name = "fzg-c-modified"                # the results go to output/fzg-c/',
        "modification.tip_relief = 35.0  # µm",
        "modification.tip_relief_length = 4.95",
        'modification.tip_relief_shape = "parabolic"',
        "modification.tip_relief = 39.0",
        "modification.tip_relief_length = 5.2",
    ]
    assert [line for line in old if line not in new] == ['name = "fzg-c"                # the results go to output/fzg-c/']
    path = tmp_path / "spec.toml"
    path.write_text(edited, encoding="utf-8")
    design = read_spec(path)
    assert design.name == "fzg-c-modified"
    assert design.pair is not None
    assert design.pair.pinion.modification.in_use == {
        "tip_relief": 35.0,
        "tip_relief_length": 4.95,
        "tip_relief_shape": "parabolic",
    }
    assert design.pair.wheel.modification.tip_relief_length == 5.2


KEY = "pinion.modification.tip_relief"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("[pinion]\nteeth = 20\n", "[pinion]\nteeth = 20\nmodification.tip_relief = 7.0\n"),
        ("[pinion]\n", "[pinion]\nmodification.tip_relief = 7.0\n"),
        (
            "[pinion]\nmodification.tip_relief = 20  # much\n# end\n\n[wheel]\n",
            "[pinion]\nmodification.tip_relief = 7.0  # much\n# end\n\n[wheel]\n",
        ),
        (
            "[pinion]\nteeth = 20 # z\n\n# the mate\n[wheel]\n",
            "[pinion]\nteeth = 20 # z\nmodification.tip_relief = 7.0\n\n# the mate\n[wheel]\n",
        ),
        (
            "[pinion]\nmodification = {tip_relief_length = 2, tip_relief = 3}\n",
            "[pinion]\nmodification = {tip_relief_length = 2, tip_relief = 7.0}\n",
        ),
        ("[pinion]\nmodification = {twist = 2} # one\n", "[pinion]\nmodification = {twist = 2, tip_relief = 7.0} # one\n"),
        ("[pinion]\nmodification = {}\n", "[pinion]\nmodification = {tip_relief = 7.0}\n"),
        (
            "[pinion.modification]\ntwist = 2\n[pinion]\nteeth = 20\n",
            "[pinion.modification]\ntwist = 2\ntip_relief = 7.0\n[pinion]\nteeth = 20\n",
        ),
        ("pinion.teeth = 20\n[wheel]\n", "pinion.teeth = 20\npinion.modification.tip_relief = 7.0\n[wheel]\n"),
        ("pinion = {teeth = 20}\n", "pinion = {teeth = 20, modification.tip_relief = 7.0}\n"),
        ("[pinion]\r\nteeth = 20\r\n", "[pinion]\r\nteeth = 20\r\nmodification.tip_relief = 7.0\r\n"),
        (
            "[pinion]\nmodification.tip_relief = 1\nz = 2\nmodification.twist = 3\n",
            "[pinion]\nmodification.tip_relief = 7.0\nz = 2\nmodification.twist = 3\n",
        ),
        ('[pinion]\nmodification."tip_relief" = 1\n', '[pinion]\nmodification."tip_relief" = 7.0\n'),
        (
            "pinion = {modification = {tip_relief = 3}, z = 2}\n",
            "pinion = {modification = {tip_relief = 7.0}, z = 2}\n",
        ),
        (
            '[pinion]\nname = """\n[wheel]\n"""\nteeth = 20\n',
            '[pinion]\nname = """\n[wheel]\n"""\nteeth = 20\nmodification.tip_relief = 7.0\n',
        ),
        (
            "[pinion.body]\nbore = 9\n[wheel]\nteeth = 20\n[pinion]\nteeth = 20\n# end\n",
            "[pinion.body]\nbore = 9\n[wheel]\nteeth = 20\n[pinion]\nteeth = 20\nmodification.tip_relief = 7.0\n# end\n",
        ),
        ("[check]\ntorques = [\n  1,\n]\n[pinion]", "[check]\ntorques = [\n  1,\n]\n[pinion]\nmodification.tip_relief = 7.0\n"),
    ],
)
def test_layouts(before: str, after: str) -> None:
    assert edit_spec(before, {KEY: 7.0}) == after
    assert tomllib.loads(after)["pinion"]["modification"]["tip_relief"] == 7.0


def test_a_name_comes_first_in_its_table() -> None:
    assert edit_spec("[pair]\nnormal_module = 2\n", {"pair.name": "b"}) == '[pair]\nname = "b"\nnormal_module = 2\n'


def test_a_table_that_is_not_there_comes_to_the_end() -> None:
    edited = edit_spec("[wheel]\nteeth = 20\n", {KEY: 7.0})
    assert edited == "[wheel]\nteeth = 20\n\n[pinion]\nmodification.tip_relief = 7.0\n"


def test_what_cannot_be_edited_is_said_and_not_spoilt() -> None:
    with pytest.raises(SpecError, match=r"write by hand: pinion\.modification\.tip_relief = 7\.0"):
        edit_spec("[[pinion]]\nteeth = 20\n", {KEY: 7.0})


def test_a_table_in_one_line_gets_its_keys_without_notes() -> None:
    text = "[pinion]\nmodification = { lead_crowning = 5.0 }\n"
    edited = edit_spec(text, {"pinion.modification.tip_relief": 3.0}, NOTES)
    assert edited == "[pinion]\nmodification = { lead_crowning = 5.0, tip_relief = 3.0 }\n"


PAIRS = [name for name in starters() if "[wheel]" in starter_text(name)[1]]


def read(text: str) -> PairDesign:
    """Without a name of its own it would be "unnamed"."""
    design = design_from_tables(tomllib.loads(text), where=lambda key: key, default_name="unnamed")
    assert isinstance(design, PairDesign)
    return design


@pytest.mark.parametrize("name", PAIRS)
def test_starters_are_written_as_they_were_read(name: str) -> None:
    design = read(starter_text(name)[1])
    again = read(pair_text(design))
    assert again == design
    assert again.pair.to_dict() == design.pair.to_dict()
    assert pair_text(again) == pair_text(design)


@settings(max_examples=25, deadline=None)
@given(pair_inputs(), MODIFICATIONS, st.booleans())
def test_any_pair_is_written_to_the_last_digit(inputs: dict[str, object], changes: dict[str, float] | None, held: bool) -> None:
    try:
        pair = build_pair(inputs)
        gears = [modified(gear, changes) for gear in pair.gears]
        distance = {"centre_distance": float(pair.centre_distance)} if held else {}
        pair = GearPair(pinion=gears[0], wheel=gears[1], name="any", axial_offset=pair.axial_offset, **distance)
    except GearcadError:
        assume(False)
    again = read(pair_text(PairDesign(name="any", pair=pair)))
    assert again.pair == pair
    assert again.pair.to_dict() == pair.to_dict()


def test_a_splined_bore_is_written_by_its_designation() -> None:
    bore = "N 20 x 1.25 x 14 x 9H"
    design = read(
        f'[pair]\nnormal_module = 2\nface_width = 20\n[pinion]\nteeth = 30\nbody.bore = "{bore}"\n[wheel]\nteeth = 40\n'
    )
    assert read(pair_text(design)) == design


def test_what_a_spec_would_guess_is_written() -> None:
    """The other hand, automatic tips, names of gears, and enums, digits and words of the tables beside them."""
    gears = [
        Gear(name=name, teeth=teeth, normal_module=1 / 3, face_width=20 / 7, tooth_thinning=0.01)
        for name, teeth in (("sun", 20), ('planet ü "1"', 21))
    ]
    pair = GearPair(pinion=gears[0], wheel=gears[1], name="sun-planet")
    beside = {
        "material": Material(name="16MnCr5", density=7.1e3, contact_limit=(1.1e3, 1.3e3)),
        "load": Load(torque=1e-5 / 3, speed=-1e3 / 7),
        "rating": RatingOptions(standard=Edition.DIN_1987, accuracy_grade=5),
    }
    design = PairDesign(name="sun-planet", pair=pair, **beside)
    text = pair_text(design, ["one line,", "another"])
    assert text.startswith("# one line,\n# another\n\n[pair]\n")
    assert text.count("tip_alteration = 0.0") == text.count("helix_angle = 0.0") == 2
    assert "auto" not in text
    assert read(text) == design


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
    if table == "spline":
        return {"spline": {"standard": "ISO 4156", "module": 2.0, "teeth": 20}}
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
    train["train"]["excitation"] = [{"name": "ripple", "inertia": "pinion", "order": 1.0, "amplitude": 1.0}]
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

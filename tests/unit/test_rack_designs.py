"""Racks in specs, tables, documents and jobs: what a text becomes, and where it is refused in a line."""

import json
import math
from pathlib import Path
from typing import Any

import pytest
from support.specs import FACETED_OR_FLAT

import gearcad
from gearcad import Gear, Load, Rack, RackPair, SpecError
from gearcad.batch.study import plan_study
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.designs import RackDesign, RackPairDesign, design_from_tables, open_table, read_spec
from gearcad.designs.design import Design
from gearcad.designs.reader import starter_text
from gearcad.designs.variations import column_symbol

EXACT = 1e-12

RACK: dict[str, Any] = {"teeth": 20, "normal_module": 2.0, "face_width": 20.0, "height": 18.0}


def tables(**changes: dict[str, Any] | None) -> dict[str, Any]:
    """A helical pair of module 2, z 20 and 30, with the tables' keys changed; a key set to None is taken out."""
    made: dict[str, Any] = {
        "pair": {"normal_module": 2.0, "helix_angle": 15.0, "tooth_thinning": 0.05},
        "pinion": {"teeth": 20, "face_width": 25.0},
        "rack": {"teeth": 30, "face_width": 20.0, "height": 18.0},
    }
    for table, keys in changes.items():
        if keys is None:
            del made[table]
        else:
            made[table] = {key: value for key, value in {**made.get(table, {}), **keys}.items() if value is not None}
    return made


def design(content: dict[str, Any]) -> Design:
    return design_from_tables(content, where=lambda key: f"<{key}>", default_name="trial")


def refusal(content: dict[str, Any]) -> str:
    with pytest.raises(SpecError) as caught:
        design(content)
    assert "\n" not in str(caught.value)
    return str(caught.value)


# ---------------------------------------------------------------------- specs


def test_a_rack_by_itself() -> None:
    made = design({"rack": {**RACK, "rack": {"root_radius": "full"}}, "material": {"density": 7900.0}})
    assert isinstance(made, RackDesign)
    assert made.rack.name == made.name == "trial" and made.rack.profile.root_land == 0
    document = made.to_dict()
    assert document["kind"] == "rack" and document["rack"]["over_pin"] == made.rack.over_pin
    assert document["material"]["density"] == 7900


def test_shared_values_reach_both_and_ones_own_wins() -> None:
    made = design(tables(pair={"rack": {"dedendum": 1.3}, "body": {"bore": 12.0}}, rack={"tooth_thinning": 0.02}))
    assert isinstance(made, RackPairDesign)
    pinion, rack = made.pair.pinion, made.pair.rack
    assert (pinion.helix_angle, rack.helix_angle) == (15.0, -15.0)
    assert (pinion.tooth_thinning, rack.tooth_thinning) == (0.05, 0.02)
    assert pinion.rack.dedendum == rack.rack.dedendum == 1.3 and pinion.body.bore == 12.0
    assert made.pair.mounting_distance == pytest.approx(20 / math.cos(math.radians(15)), rel=EXACT)


def test_the_mounting_distance_gives_what_is_automatic() -> None:
    made = design(tables(pair={"mounting_distance": 21.2}, pinion={"profile_shift": "auto"}))
    assert isinstance(made, RackPairDesign)
    assert made.pair.pinion.profile_shift == pytest.approx((21.2 - 20 / math.cos(math.radians(15))) / 2, rel=EXACT)
    assert made.pair.circumferential_backlash == pytest.approx(0.1 / math.cos(math.radians(15)), rel=1e-9)
    near = design(tables(pair={"mounting_distance": 20.65}))
    assert isinstance(near, RackPairDesign)
    assert near.pair.pinion.tip_alteration == pytest.approx((20.65 - 20 / math.cos(math.radians(15))) / 2, rel=1e-9)
    assert near.pair.tip_clearances.pinion == pytest.approx(0.5, rel=1e-9)


def test_documents_tell_pinion_rack_pair_and_drive() -> None:
    document = design(tables(load={"torque": 30.0, "speed": 100.0})).to_dict()
    assert [*document][:6] == ["kind", "name", "gearcad", "pinion", "rack", "pair"] and document["kind"] == "rack_pair"
    assert document["pair"]["tip_clearances"] == pytest.approx({"pinion": 0.5, "rack": 0.5})
    diameter = document["pinion"]["reference_diameter"]
    assert document["drive"]["rack_force"] == pytest.approx(60000 / diameter, rel=EXACT)
    assert document["drive"]["rack_speed"] == pytest.approx(math.pi * diameter / 600, rel=EXACT)
    assert "rack_speed" not in design(tables(load={"torque": 30.0})).to_dict()["drive"]
    json.dumps(document, allow_nan=False)


REFUSALS = [
    (
        {"rack": {"normal_module": 2.0, "face_width": 20.0, "height": 18.0}},
        "<rack.teeth>: rack.teeth is missing: must be",
    ),
    ({"rack": RACK | {"length": 100.0}}, "<rack.length>: rack.length = 100 mm: must be left out where teeth are given"),
    ({"rack": RACK | {"height": 2.0}}, "<rack.height>: rack.height = 2 mm: must be at least 2.7 mm"),
    ({"rack": RACK | {"tip_chamfer": 3.0}}, "<rack.tip_chamfer>: rack.tip_chamfer = 3 mm: must be below"),
    ({"rack": RACK | {"rack": {"root_radius": 0.6}}}, "<rack.rack.root_radius>: rack.rack.root_radius = 0.6: must be at most"),
    ({"rack": RACK | {"profile_shift": 0.1}}, "rack.profile_shift: unknown key here; it belongs in [pinion] or [wheel]"),
    ({"rack": RACK | {"heigth": 0.1}}, "rack.heigth: unknown key; did you mean height?"),
    ({"rack": RACK, "gear": {}}, "<gear>: [gear] cannot stand beside [rack]: permitted are [material]"),
    ({"rack": RACK, "check": {}}, "<check>: [check] cannot stand beside [rack]: permitted are [material]"),
    (
        tables(wheel={}),
        "<wheel>: [wheel] cannot stand beside a pinion and a [rack]: permitted are [material], [load]",
    ),
    (tables(pinion=None), "<>: [pinion] is missing: a pinion and a rack need [pair], [pinion] and [rack]"),
    (
        tables(pair={"centre_distance": 30.0}),
        "pair.centre_distance: applies to two gears, not to a pinion and a rack; did you",
    ),
    (
        tables(rack={"helix_angle": 10.0}),
        "<rack.helix_angle>: rack.helix_angle = 10 deg: must be -15 deg, opposite",
    ),
    (
        tables(pair={"mounting_distance": 20.0}),
        "<pair.mounting_distance>: pair.mounting_distance = 20 mm: must be at least",
    ),
    (
        tables(pinion={"profile_shift": "auto"}),
        "<pinion.profile_shift>: pinion.profile_shift = 'auto': needs mounting",
    ),
    (tables(pinion={"teeth": -40}), "<pinion.teeth>: pinion.teeth = -40: must be above 0: no rack meshes with a ring"),
    (
        tables(rack={"face_width": None}),
        "<rack.face_width>: rack.face_width is missing: must be a number above 0 mm",
    ),
    (tables(rack={"rack": {"pressure_angle": 19.0}}), "rack.rack.pressure_angle = 19 deg: must be 20 deg, as on the pinion"),
    (
        tables(rack={"tip_alteration": 0.25}, pinion={"teeth": 40}),
        "rack.tip_alteration = 0.25: must be below 0.25",
    ),
    (tables(load={"torque": 1e99}), "<load.torque>: load.torque = 1e+99 N·m: must be a number, 0 or from"),
]


@pytest.mark.parametrize(("content", "words"), REFUSALS)
def test_wrong_specs_are_a_line_each(content: dict[str, Any], words: str) -> None:
    assert words in refusal(content)


def test_a_pair_of_gears_has_no_mounting_distance() -> None:
    content = tables(pair={"mounting_distance": 21.0}, rack=None, wheel={"teeth": 30, "face_width": 20.0})
    assert refusal(content) == (
        "<pair.mounting_distance>: pair.mounting_distance: applies to a pinion and a [rack]; did you mean centre_distance?"
    )


# ---------------------------------------------------------------------- jobs


def test_jobs_take_racks_or_say_why_not(tmp_path: Path) -> None:
    pair = RackPair(pinion=Gear(teeth=20, normal_module=2, face_width=20), rack=Rack(**RACK))
    assert gearcad.data(pair)["pair"]["mounting_distance"] == 20
    assert gearcad.rate(pair, Load(torque=50)).nominal.flank.nominal_stress > 0
    files = gearcad.build(pair, tmp_path, FACETED_OR_FLAT, circles=True)
    assert {file.name for file in files} == {"data.json", "assembly.3mf", "assembly.glb"} | {
        f"{part}.{kind}" for part in ("pinion", "rack") for kind in FACETED_OR_FLAT
    }
    assert [file.name for file in gearcad.build(pair.rack, tmp_path / "rack", ["dxf"])] == ["data.json", "rack.dxf"]
    with pytest.raises(GeometryError, match="bracket = True: needs a pair of gears"):
        gearcad.build(pair, tmp_path, ["step"], bracket=True)
    with pytest.raises(ParameterError, match=r"^kind = 'rack and pinion': must be a .*pair.*: a pinion and a rack are for"):
        gearcad.modify(pair)  # type: ignore[arg-type]
    with pytest.raises(
        ParameterError, match=r"^kind = 'rack': must be a pair, a rack and pinion or a planetary train: a rack by itself is for"
    ):
        gearcad.rate(pair.rack)
    with pytest.raises(
        ParameterError, match=r"^mounting = None: is not an input of a rack and pinion; permitted: material, load,"
    ):
        gearcad.data(pair, mounting=None)  # type: ignore[typeddict-item]


def test_the_starter_is_sound(tmp_path: Path) -> None:
    name, text = starter_text("rack")
    (tmp_path / name).write_text(text, encoding="utf-8")
    made = read_spec(tmp_path / name)
    assert isinstance(made, RackPairDesign) and made.warnings == ()
    assert made.pair.rack.length == pytest.approx(500, abs=1e-3)
    assert made.to_dict()["drive"]["rack_force"] == pytest.approx(1885, abs=0.5)
    for line in text.splitlines():  # what is commented out can be used
        option = line.removeprefix("# ")
        if line.startswith("# ") and " = " in option and not option.startswith(("length", "mounting")):
            read = tmp_path / "option.toml"
            read.write_text(text.replace(line, option), encoding="utf-8")
            read_spec(read)


# ---------------------------------------------------------------------- tables


def rows(path: Path, text: str) -> list[Design]:
    path.write_text(text, encoding="utf-8")
    return [row.design() for row in open_table(path).rows()]


def test_tables_of_racks_and_of_pinions_and_racks(tmp_path: Path) -> None:
    one, long = rows(tmp_path / "racks.csv", "name,rack.length,normal_module,face_width,height\na,100,2,20,18\nb,200,2,20,18\n")
    assert isinstance(long, RackDesign) and long.rack.length == 200 and isinstance(one, RackDesign)
    heading = "name,normal_module,pair.helix_angle,pinion.teeth,face_width,rack.teeth,rack.height,rack.root_radius\n"
    (pair,) = rows(tmp_path / "pairs.csv", f"{heading}a,2,10,20,25,30,18,0.3\n")
    assert isinstance(pair, RackPairDesign)
    assert (pair.pair.rack.helix_angle, pair.pair.rack.rack.root_radius, pair.pair.pinion.rack.root_radius) == (-10, 0.3, 0.3)


def test_a_table_may_hold_wheels_and_racks(tmp_path: Path) -> None:
    heading = "name,normal_module,pinion.teeth,face_width,wheel.teeth,rack.teeth,rack.height\n"
    with_wheel, with_rack = rows(tmp_path / "mixed.csv", f"{heading}a,2,20,25,30,,\nb,2,20,25,,30,18\n")
    assert (with_wheel.kind.value, with_rack.kind.value) == ("pair", "rack_pair")
    with pytest.raises(SpecError, match=r"rack.teeth: cannot stand beside keys of wheel: a row makes one with a wheel or with"):
        rows(tmp_path / "both.csv", f"{heading}a,2,20,25,30,30,18\n")


def test_all_faults_of_a_row_are_found(tmp_path: Path) -> None:
    path = tmp_path / "racks.csv"
    path.write_text("name,rack.teeth,normal_module,face_width,height,tip_chamfer\na,2.5,2,-1,,9\n", encoding="utf-8")
    (row,) = open_table(path).rows()
    faults = row.all_faults()
    assert [fault.split("): ")[1].split(" ")[0] for fault in faults] == ["rack.teeth", "rack.face_width", "rack.height"]


def test_columns_of_results_have_symbols() -> None:
    assert column_symbol("rack.over_pin")[1].symbol == "M"  # type: ignore[index]
    assert column_symbol("rack.rack.root_radius")[1].symbol == "ρ_fP*"  # type: ignore[index]
    assert column_symbol("pair.travel_per_revolution")[1].unit == "mm"  # type: ignore[index]
    assert column_symbol("pair.tip_clearances.rack")[1].symbol == "c"  # type: ignore[index]
    assert column_symbol("pair.tip_clearances.pinion") == column_symbol("pair.tip_clearances.pinion")
    assert column_symbol("drive.rack_force")[1].unit == "N"  # type: ignore[index]


def test_studies_vary_racks(tmp_path: Path) -> None:
    spec = tmp_path / "rack.toml"
    spec.write_text(starter_text("rack")[1], encoding="utf-8")
    study = plan_study(spec, ["rack.length=100:200:3", "mounting_distance=21.2,21.3"])
    assert "rack.teeth" not in study.keys and study.rows == 6
    with pytest.raises(ParameterError, match=r"permitted are keys of \[pair\], \[pinion\], \[rack\], \[material\], \[load\]"):
        plan_study(spec, ["wheel.teeth=20,30"])


def test_diametral_pitch_of_both() -> None:
    made = design(tables(pair={"normal_module": None, "normal_diametral_pitch": 10.0}))
    assert isinstance(made, RackPairDesign)
    assert made.pair.rack.normal_module == made.pair.pinion.normal_module == pytest.approx(2.54, rel=EXACT)
    assert Rack(**RACK | {"normal_module": 2.0}).normal_diametral_pitch == pytest.approx(12.7, rel=EXACT)

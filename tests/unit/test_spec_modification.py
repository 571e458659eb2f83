"""Flank modifications and mounting: what is permitted, and their way through specs, tables, studies and the data sheet."""

import io
import math
import re
import tomllib
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from gearcad import FlankModification, Gear, GearPair, Mounting, ParameterError, ReliefShape, SpecError
from gearcad.batch.study import plan_study, write_study
from gearcad.cli.basics import print_datasheet
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.core.errors import GeometryError
from gearcad.designs import design_from_tables, open_table, read_spec
from gearcad.designs.design import Design
from gearcad.designs.reader import starter_text
from gearcad.designs.variations import spec_values

SPEC = """\
[pair]
normal_module = 2.0
face_width = 20.0
tooth_thinning = 0.05
modification.tip_relief = 20
modification.tip_relief_length = 1.2

[pinion]
teeth = 20
modification.tip_relief_shape = "parabolic"
modification.lead_crowning = 5.0

[wheel]
teeth = 40
modification = { tip_relief = 10.0, twist = -3 }

[mounting]
misalignment = 12
centre_distance_change = 0.02
"""

PINION = FlankModification(tip_relief=20.0, tip_relief_length=1.2, tip_relief_shape=ReliefShape.PARABOLIC, lead_crowning=5.0)
WHEEL = FlankModification(tip_relief=10.0, tip_relief_length=1.2, twist=-3.0)


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "p.toml"
    path.write_text(SPEC, encoding="utf-8")
    return path


def refusal(**changes: dict[str, Any]) -> str:
    made: dict[str, dict[str, Any]] = {
        "pair": {"normal_module": 2.0, "face_width": 20.0},
        "pinion": {"teeth": 20},
        "wheel": {"teeth": 40},
    }
    for table, keys in changes.items():
        made[table] = made.get(table, {}) | keys
    with pytest.raises(SpecError) as caught:
        design_from_tables(made, where=lambda key: f"<{key}>", default_name="trial")
    return str(caught.value)


def modifications(design: Design) -> tuple[FlankModification, FlankModification]:
    assert design.pair is not None
    return design.pair.pinion.modification, design.pair.wheel.modification


def test_what_stands_in_pair_is_for_both_and_a_gears_own_wins(spec: Path) -> None:
    design = read_spec(spec)
    assert modifications(design) == (PINION, WHEEL)
    assert design.mounting == Mounting(misalignment=12.0, centre_distance_change=0.02)


def test_data_hold_inputs_and_mounting(spec: Path) -> None:
    document = read_spec(spec).to_dict()
    assert document["pinion"]["modification"]["tip_relief_shape"] == "parabolic"
    assert document["wheel"]["modification"]["tip_relief"] == 10.0
    assert document["mounting"]["misalignment"] == 12.0
    assert document["mounting"]["wheel_pitch_error"] == 0.0


def test_a_spec_survives_the_way_through_a_table(spec: Path, tmp_path: Path) -> None:
    """Study without any change in what it varies: the row is the spec."""
    _, _, values = spec_values(spec)
    assert values["wheel.modification.twist"] == -3.0
    assert values["pinion.modification.tip_relief_shape"] == "parabolic"
    write_study(plan_study(spec, ["pinion.modification.lead_crowning=5,0", "mounting.misalignment=12"]), tmp_path / "t.csv")
    first, second = (row.design() for row in open_table(tmp_path / "t.csv").rows())
    assert modifications(first) == (PINION, WHEEL)
    assert first.mounting == read_spec(spec).mounting
    assert modifications(second)[0].lead_crowning == 0.0


def test_cells_of_a_table(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    heading = "name,normal_module,face_width,pinion.teeth,wheel.teeth,modification.tip_relief,modification.tip_relief_length,"
    heading += "pinion.modification.tip_relief_shape,wheel.modification.helix_angle_modification,mounting.misalignment"
    path.write_text(
        f"{heading}\na,2,20,20,40,15,1.5,parabolic,-4,7\nb,2,20,20,40,,,,,\nc,2,20,20,40,15,,,,\nd,2,20,20,40,,,,,2000\n"
    )
    a, b, c, d = open_table(path).rows()
    pinion, wheel = modifications(a.design())
    assert (pinion.tip_relief, pinion.tip_relief_shape) == (15.0, ReliefShape.PARABOLIC)
    assert (wheel.tip_relief, wheel.helix_angle_modification) == (15.0, -4.0)
    assert a.design().mounting == Mounting(misalignment=7.0)
    assert modifications(b.design()) == (FlankModification(), FlankModification())
    assert b.design().mounting is None
    (length,), (misalignment,) = c.all_faults(), d.all_faults()
    assert "row 4" in length
    assert "modification.tip_relief_length = 0 mm (by default): must be at least 0.001 mm for a tip_relief above 0 µm" in length
    assert "row 5 column J (d): mounting.misalignment = 2000 µm: must be a number at least -1000 µm" in misalignment


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"pinion": {"modification": {"tiprelief": 3}}},
            "<pinion.modification.tiprelief>: pinion.modification.tiprelief: unknown key; did you mean modification.tip",
        ),
        (
            {"pinion": {"lead_crowning": 3}},
            "<pinion.lead_crowning>: pinion.lead_crowning: unknown key; did you mean modification.lead_crowning?",
        ),
        (
            {"pinion": {"modification": {"tip_relief": 20}}},
            "<pinion.modification.tip_relief_length>: pinion.modification.tip_relief_length = 0 mm (by default): must be",
        ),
        (
            {"pair": {"modification": {"tip_relief": 20, "tip_relief_length": 30}}},
            "<pair.modification.tip_relief_length>: pair.modification.tip_relief_length = 30 mm: must be at most 10.44",
        ),
        (
            {"wheel": {"modification": {"tip_relief_shape": "round"}}},
            "<wheel.modification.tip_relief_shape>: wheel.modification.tip_relief_shape = 'round': must be one of 'linear', ",
        ),
        ({"wheel": {"modification": {"twist": "x"}}}, "<wheel.modification.twist>: wheel.modification.twist = 'x': must be a"),
        ({"mounting": {"misalignement": 3}}, "<mounting.misalignement>: mounting.misalignement: unknown key; did you mean mis"),
        ({"mounting": {"misalignment": "x"}}, "<mounting.misalignment>: mounting.misalignment = 'x': must be a number"),
        (
            {"check": {"pinion_tip_relief": 20.0}},
            "<check.pinion_tip_relief>: check.pinion_tip_relief: is no key any more: write pinion.modification.tip_relief and ",
        ),
        (
            {"check": {"wheel_tip_relief": 20.0}},
            "<check.wheel_tip_relief>: check.wheel_tip_relief: is no key any more: write wheel.modification.tip_relief and ",
        ),
        (
            {"check": {"tip_relief_length": 0.6}},
            "<check.tip_relief_length>: check.tip_relief_length: is no key any more: write modification.tip_relief_length of ",
        ),
    ],
)
def test_wrong_keys_and_values_name_the_right_ones(changes: dict[str, Any], message: str) -> None:
    assert refusal(**changes).startswith(message)


def test_a_column_of_before_names_the_new_one(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("name,pinion.teeth,check.pinion_tip_relief\n")
    with pytest.raises(SpecError, match=r"is no column any more: write pinion\.modification\.tip_relief and"):
        open_table(tmp_path / "t.csv")


def test_the_data_sheet_shows_what_there_is(spec: Path) -> None:
    file = io.StringIO()
    print_datasheet(read_spec(spec), Console(file=file, width=80))
    lines = {line[:39].strip(): line[39:].split() for line in file.getvalue().splitlines()}
    assert lines["tip relief"] == ["C_αa", "µm", "20.0000", "10.0000"]
    assert lines["tip relief, shape"] == ["parabolic", "linear"]
    assert lines["lead crowning"] == ["C_β", "µm", "5.0000", "-"]
    assert lines["twist of the flank"] == ["S_α", "µm", "-", "-3.0000"]
    assert lines["misalignment in the plane of action"] == ["F_βx", "µm", "12"]
    assert not {"root relief", "end relief, shape", "misalignment across that plane"} & set(lines)


@pytest.mark.parametrize("name", ["volvo-13-44", "fzg-c", "alm-18-161", "spur", "ring-22-70"])
def test_what_the_starters_offer_is_permitted(name: str) -> None:
    """Their commented lines of modifications and mounting, with the # taken away."""
    _, text = starter_text(name)
    offered = re.compile(
        r"^# (?=modification\.|\[mounting\]|misalignment(?!_sides)|pinion_pitch|wheel_pitch|centre_distance_change)", re.M
    )
    tables = tomllib.loads(offered.sub("", text))
    design = design_from_tables(tables, where=str, default_name=name)
    for gear in design.gears.values():
        assert {"tip_relief", "lead_crowning"} <= set(gear.modification.in_use)
    assert (design.mounting is None) == (name == "spur")
    assert design.mounting is None or len(tables["mounting"]) == len(fields(Mounting))


PAIR = GearPair(
    pinion=Gear(teeth=18, normal_module=1.5, face_width=10, tooth_thinning=0.05),
    wheel=Gear(teeth=41, normal_module=1.5, face_width=10),
)


def test_the_drawing_is_the_pair_itself() -> None:
    assert Mounting().mounted(PAIR) is PAIR
    assert Mounting(pinion_pitch_error=3, wheel_pitch_error=-5).pitch_error == -2.0


@pytest.mark.parametrize("change", [0.1, -0.02])
def test_base_circles_stay_and_the_line_of_action_follows(change: float) -> None:
    """T1T2 = sqrt((a + da)^2 - (r_b1 + r_b2)^2), and the pitch point divides it as it divides the centre distance."""
    pair = Mounting(centre_distance_change=change).mounted(PAIR)
    radii = [gear.base_diameter / 2 for gear in (PAIR.pinion, PAIR.wheel)]
    distance = PAIR.centre_distance + change
    whole = math.sqrt(distance**2 - sum(radii) ** 2)
    assert (pair.pinion, pair.wheel) == (PAIR.pinion, PAIR.wheel)
    assert line_of_action(pair).whole == pytest.approx(whole, rel=1e-12)
    assert pair.path_of_contact.C == pytest.approx(whole * 18 / 59, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (5.0, "mounting.centre_distance_change = 5 mm: makes a centre distance of 49.25 mm, but must be below "),
        (-0.5, "mounting.centre_distance_change = -0.5 mm: makes a centre distance of 43.75 mm, but must be at least "),
    ],
)
def test_gears_that_no_longer_mesh_are_refused(change: float, message: str) -> None:
    with pytest.raises(GeometryError) as caught:
        Mounting(centre_distance_change=change).mounted(PAIR)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    "wrong",
    [{"misalignment": 1001.0}, {"misalignment_across": math.nan}, {"wheel_pitch_error": "x"}, {"centre_distance_change": None}],
)
def test_wrong_values_are_refused(wrong: dict[str, Any]) -> None:
    (name,) = wrong
    with pytest.raises(ParameterError, match=f"{name} = .*: must be a number"):
        Mounting(**wrong)

"""Gears that are cut before their flanks are finished: published points, identities, what is refused, ratings and files."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.cases import read_cases

from gearcad import BasicRack, Gear, GearPair
from gearcad.batch.row import flat_document
from gearcad.core import symbols
from gearcad.core.errors import GeometryError, InputError, SpecError
from gearcad.core.records import Role
from gearcad.designs.reader import read_spec, starter_text
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.premachining import Finishing, Premachining, SemiTopping
from gearcad.rating import Edition
from gearcad.rating.root_section import VirtualGear, generated_section, hob_section, load_point
from gearcad.rating.root_stress import GrindingNotch, RootMesh, loaded_width, root_rating
from gearcad.sheet import sheet_of

CASES = read_cases("premachining")


def cut_before(**changes: Any) -> Gear:
    """A spur gear that a hob with a protuberance cuts before it is ground."""
    pre = {"tool_addendum": 1.4, "tool_tip_radius": 0.3, "protuberance": 0.14, "protuberance_angle": 8.0, "stock": 0.1}
    gear = {"teeth": 25, "normal_module": 3.0, "profile_shift": 0.2, "face_width": 20.0}
    given = {name: changes.pop(name) for name in list(changes) if name in Premachining.__dataclass_fields__}
    kept = {name: value for name, value in (pre | given).items() if value is not None}
    return Gear(**gear | {"premachining": Premachining(**kept)} | changes)


def of_case(name: str) -> Gear:
    """The gear of a published case."""
    given = CASES[name]["inputs"]
    pre = ("tool_addendum", "tool_tip_radius", "protuberance", "protuberance_angle", "stock")
    plain = ("teeth", "normal_module", "helix_angle", "profile_shift")
    return Gear(
        face_width=20.0,
        rack=BasicRack(pressure_angle=given["pressure_angle"]),
        premachining=Premachining(**{key: given[key] for key in pre}),
        **{key: given[key] for key in plain},
    )


@pytest.mark.parametrize("name", CASES)
def test_published_points_of_the_fillet_and_sizes(name: str) -> None:
    gear, expected = of_case(name), CASES[name]["expected"]
    profile = gear.profile
    assert gear.residual_undercut == pytest.approx(expected["s_pr"], abs=1e-12)
    assert gear.root_diameter / 2 == pytest.approx(expected["root_radius"], abs=1e-9)
    assert gear.form_diameter / 2 == pytest.approx(expected["form_radius"], abs=1e-9)
    assert math.degrees(gear.stock_angle) == pytest.approx(expected["stock_angle_deg"], abs=1e-9)
    assert gear.greatest_undercut == pytest.approx(expected["undercut_max_arc"], abs=1e-8)
    for point in expected["fillet"]:
        half = 180 / gear.teeth - point["half_space_angle_deg"]
        assert profile.half_angle(point["radius"]) == pytest.approx(half, abs=1e-9)


def test_a_tool_without_protuberance_and_stock_makes_the_plain_tooth() -> None:
    plain = Gear(teeth=17, normal_module=2.0, helix_angle=12.0, face_width=10.0, rack=BasicRack(dedendum=1.3, root_radius=0.3))
    twice = replace(plain, rack=BasicRack(), premachining=Premachining(tool_addendum=1.3, tool_tip_radius=0.3))
    radii = np.linspace(plain.root_diameter, plain.tip_diameter, 41) / 2
    assert twice.profile.half_angle(radii) == pytest.approx(plain.profile.half_angle(radii), abs=1e-11)
    assert twice.form_diameter == pytest.approx(plain.form_diameter, rel=1e-13)


def test_stock_stands_on_both_flanks_of_every_span() -> None:
    for gear in (cut_before(), cut_before(helix_angle=15.0), cut_before(tooth_thinning=0.05)):
        spans = [each.inspection.span_measurement(4) for each in (gear.precut, gear)]
        assert spans[0] - spans[1] == pytest.approx(2 * 0.1, abs=1e-12)
        radii = np.linspace(gear.form_diameter / 2, gear.tip_diameter / 2, 9)[4:]
        thicker = np.radians(gear.precut.profile.half_angle(radii) - gear.profile.half_angle(radii))
        assert thicker == pytest.approx(np.full(5, gear.stock_angle), abs=1e-12)
        assert gear.precut.tip_diameter == gear.tip_diameter


def test_stock_as_deep_as_the_protuberance_lets_the_curves_touch() -> None:
    gear = cut_before(stock=0.14)
    plain = Gear(teeth=25, normal_module=3.0, profile_shift=0.2, face_width=20.0, rack=BasicRack(dedendum=1.4, root_radius=0.3))
    assert gear.form_diameter == pytest.approx(plain.form_diameter, rel=1e-12)
    assert not gear.undercut
    assert gear.greatest_undercut == pytest.approx(0.0, abs=1e-9)


def test_a_large_wheel_shows_the_flank_of_the_protuberance() -> None:
    gear = cut_before(teeth=150, protuberance=0.2, tool_tip_radius=0.1, protuberance_angle=15.0)
    pieces = [curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET]
    assert len(pieces) == 2
    steep = pieces[1]
    base = gear.reference_diameter / 2 * math.cos(math.radians(15.0))
    radius, angle = steep.polar(np.array([0.2, 0.8]))
    roll = np.sqrt(radius**2 - base**2) / base
    assert angle[0] - angle[1] == pytest.approx((roll - np.arctan(roll))[1] - (roll - np.arctan(roll))[0], abs=1e-13)


def test_din_3972_gives_stock_and_addendum() -> None:
    third = cut_before(stock="din3972-III", tool_addendum=None, normal_module=8.0, protuberance=0.2)
    assert third.stock == pytest.approx(0.25 * 2 * math.sin(math.radians(20)))
    assert (third.reference_diameter - third.root_diameter) / 2 == pytest.approx(1.25 * 8 + 0.25 * 2 - 0.2 * 8)
    fourth = Premachining(stock="din3972-IV", tool_tip_radius=0.2)
    assert fourth.addendum_of(2.5) * 2.5 == pytest.approx(3.939, abs=5e-4)  # 3.94 mm in the standard


def test_the_root_of_a_topping_tool_is_the_tip_of_the_gear() -> None:
    assert cut_before(topping=2.9).tip_diameter == pytest.approx(75 + 2 * (0.6 + 2.9))


def test_a_ramp_leaves_a_chamfer_that_begins_on_its_own_involute() -> None:
    gear = cut_before(semi_topping=SemiTopping(angle=45.0, height=2.2))
    base = 37.5 * math.cos(math.radians(45))
    chamfer = gear.profile.curves[-2]
    assert chamfer.kind is CurveKind.CHAMFER
    radius, angle = chamfer.polar(np.array([0.0, 1.0]))
    roll = np.sqrt(radius**2 - base**2) / base
    assert angle[0] - angle[1] == pytest.approx(float(np.diff(roll - np.arctan(roll))[0]), abs=1e-13)
    assert radius[0] * 2 == pytest.approx(gear.tip_form_diameter)
    assert gear.profile.half_angle(float(radius[0])) == pytest.approx(math.degrees(angle[0]), abs=1e-11)


def test_a_short_lead_leaves_the_flank_and_another_fillet() -> None:
    usual, short = cut_before(), cut_before(tool_pressure_angle=17.5)
    radius = (usual.form_diameter + usual.tip_diameter) / 4 + 2
    assert short.profile.half_angle(radius) == pytest.approx(usual.profile.half_angle(radius), abs=1e-12)
    assert short.root_diameter == usual.root_diameter
    assert short.form_diameter != pytest.approx(usual.form_diameter, abs=1e-3)
    module = 3 * math.cos(math.radians(20)) / math.cos(math.radians(17.5))
    by_module = cut_before(tool_module=module)
    assert by_module.form_diameter == pytest.approx(short.form_diameter, rel=1e-9)


# ---------------------------------------------------------------------- rating


@pytest.mark.parametrize("helix_angle", [0.0, 18.0])
def test_the_standards_section_is_that_of_the_generated_fillet(helix_angle: float) -> None:
    gear = cut_before(helix_angle=helix_angle)
    virtual = VirtualGear.of(gear)
    load = load_point(virtual, 1.5)
    formula, generated = hob_section(gear, virtual, load), generated_section(gear, virtual, load)
    assert generated.chord == pytest.approx(formula.chord, rel=1e-9)
    assert generated.fillet_radius == pytest.approx(formula.fillet_radius, rel=1e-6)


def test_a_short_lead_hob_has_the_section_of_its_own_fillet() -> None:
    virtual = VirtualGear.of(gear := cut_before(tool_pressure_angle=19.999999999))
    load, near = load_point(virtual, 1.5), cut_before()
    section, usual = generated_section(gear, virtual, load), generated_section(near, VirtualGear.of(near), load)
    assert section.chord == pytest.approx(usual.chord, rel=1e-8)
    helical = cut_before(tool_pressure_angle=17.0, helix_angle=18.0)
    virtual = VirtualGear.of(helical)
    assert generated_section(helical, virtual, load_point(virtual, 1.5)).chord > 0


def test_a_grinding_notch_raises_the_stress_correction_factor() -> None:
    gear = notched()
    notch = GrindingNotch.of(gear)
    assert notch is not None
    assert (notch.depth, notch.radius) == (pytest.approx(0.1), 0.4)
    assert notch.factor(2.0) == pytest.approx(1.3 * 2.0 / (1.3 - 0.6 * math.sqrt(0.25)))
    deeper = replace(gear, finishing=replace(gear.finishing, notch_depth=0.2))
    assert GrindingNotch.of(deeper).factor(1.0) == pytest.approx(1.3 / (1.3 - 0.6 * math.sqrt(0.5)))  # type: ignore[union-attr]
    assert GrindingNotch.of(cut_before()) is None
    with pytest.raises(GeometryError, match="below 2"):
        GrindingNotch.of(replace(gear, finishing=replace(gear.finishing, notch_depth=1.7)))


def notched(kind: str = "generating") -> Gear:
    """A gear that is ground without a protuberance, down to a circle above its root."""
    return cut_before(
        protuberance=0.0,
        protuberance_angle=None,
        finishing=Finishing(kind=kind, end_diameter=71.9, wheel_tip_radius=0.4),
    )


@pytest.mark.parametrize("kind", ["generating", "form"])
def test_a_wheel_leaves_a_step_of_the_stock(kind: str) -> None:
    gear = notched(kind)
    assert gear.form_diameter == pytest.approx(71.9)
    *_, wheel = [curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET]
    end, flank = wheel.direction(np.array([1.0])), gear.profile.involute.direction(np.array([0.0]))
    assert math.cos(float(end[0] - flank[0])) == pytest.approx(1.0, abs=1e-12)
    start = wheel.polar(np.array([0.0]))
    assert float(start[1][0]) == pytest.approx(math.radians(gear.precut.profile.half_angle(float(start[0][0]))), abs=1e-12)


# ---------------------------------------------------------------------- what is refused

_FAULTS: list[tuple[dict[str, Any], str]] = [
    ({"tool_addendum": 6.0}, "tool_addendum"),
    ({"tool_addendum": None}, "tool_addendum"),
    ({"tool_tip_radius": None}, "tool_tip_radius"),
    ({"tool_tip_radius": 0.6}, "premachining.tool_tip_radius"),
    ({"protuberance": -0.1}, "protuberance"),
    ({"protuberance": 0.0}, "protuberance_angle"),
    ({"protuberance_angle": None}, "protuberance_angle"),
    ({"protuberance_angle": 20.0}, "premachining.protuberance_angle"),
    ({"stock": -0.1}, "stock"),
    ({"stock": "din3972-V"}, "stock"),
    ({"stock": 2.5}, "premachining.stock"),
    ({"stock": 0.2}, "finishing.end_diameter"),
    ({"stock_tolerance": 0.2}, "stock_tolerance"),
    ({"topping": 2.9, "tip_diameter": 80.0}, "tip_diameter"),
    ({"topping": 2.9, "tip_alteration": 0.1}, "tip_alteration"),
    ({"topping": 2.9, "semi_topping": SemiTopping(angle=45.0, height=2.0)}, "topping"),
    ({"semi_topping": SemiTopping(angle=45.0, height=4.0)}, "premachining.semi_topping.height"),
    ({"semi_topping": SemiTopping(angle=45.0, height=0.1)}, "premachining.semi_topping.height"),
    ({"tool_pressure_angle": 21.0}, "premachining.tool_pressure_angle"),
    ({"tool_module": 3.1}, "premachining.tool_module"),
    ({"tool_module": 2.9, "tool_pressure_angle": 15.0}, "premachining.tool_module"),
    ({"cutter_teeth": 2}, "cutter_teeth"),
    ({"cutter_teeth": 25, "topping": 2.9}, "topping"),
    ({"cutter_profile_shift": 0.1}, "cutter_profile_shift"),
    ({"root_diameter": 67.0}, "root_diameter"),
    ({"finishing": Finishing(end_diameter=68.5)}, "finishing.end_diameter"),
    (
        {"protuberance": 0.0, "protuberance_angle": None, "finishing": Finishing(end_diameter=74.0, wheel_tip_radius=0.1)},
        "finishing.wheel_tip_radius",
    ),
    (
        {"teeth": 60, "tool_addendum": 1.0, "finishing": Finishing(end_diameter=177.0, wheel_tip_radius=1.4)},
        "finishing.end_diameter",
    ),
    ({"finishing": Finishing(end_diameter=-72.0)}, "finishing.end_diameter"),
    ({"finishing": Finishing(end_diameter=82.5)}, "finishing.end_diameter"),
    ({"finishing": Finishing(end_diameter=72.0, wheel_tip_radius=2.5)}, "finishing.wheel_tip_radius"),
]


@pytest.mark.parametrize(("changes", "parameter"), _FAULTS, ids=lambda each: str(each)[:50])
def test_a_tool_that_cannot_cut_the_gear_is_refused(changes: dict[str, Any], parameter: str) -> None:
    with pytest.raises(InputError) as caught:
        cut_before(**changes)
    assert caught.value.parameter == parameter
    assert "\n" not in str(caught.value)


_SPEC = """
[gear]
teeth = 25
normal_module = 3.0
profile_shift = 0.2
face_width = 20.0
[gear.premachining]
tool_addendum = 1.4
tool_tip_radius = 0.3
protuberance = 0.14
protuberance_angle = 8.0
stock = 0.1
stock_tolerance = 0.02
semi_topping = {angle = 45.0, height = 2.2}
"""


def test_a_spec_has_all_of_it_and_data_tells_what_is_left(tmp_path: Path) -> None:
    (tmp_path / "ground.toml").write_text(_SPEC, encoding="utf-8")
    document = read_spec(tmp_path / "ground.toml").to_dict()["gear"]
    found = document["premachining"]
    assert found["semi_topping"] == {"angle": 45.0, "height": 2.2}
    assert found["residual_undercut"] == pytest.approx(0.04)
    assert found["root_form_diameter"] == pytest.approx(71.797397, abs=1e-6)
    least, most = found["least_stock"], found["most_stock"]
    assert (least["residual_undercut"], most["residual_undercut"]) == (pytest.approx(0.06), pytest.approx(0.02))
    assert least["root_form_diameter"] > found["root_form_diameter"] > most["root_form_diameter"]
    assert found["precut"]["span_measurement"] == pytest.approx(document["span_measurement"] + 0.2, abs=1e-9)
    assert json.loads(json.dumps(document)) == document


@pytest.mark.parametrize("other", ["rack.dedendum = 1.25", "cutter.teeth = 20", "rack.root_radius = 0.3"])
def test_another_tool_of_the_root_is_refused(tmp_path: Path, other: str) -> None:
    (tmp_path / "twice.toml").write_text(_SPEC.replace("face_width", f"{other}\nface_width"), encoding="utf-8")
    with pytest.raises(SpecError, match=other.split(" ")[0].replace(".", r"\.")):
        read_spec(tmp_path / "twice.toml")


_OUT_OF_RANGE = [
    ("premachining.tool_addendum", "5.1"),
    ("premachining.tool_addendum", "0.0"),
    ("premachining.tool_tip_radius", "-0.1"),
    ("premachining.tool_tip_radius", "5.5"),
    ("premachining.protuberance", "101.0"),
    ("premachining.protuberance_angle", "46.0"),
    ("premachining.protuberance_angle", "-1.0"),
    ("premachining.stock", "101.0"),
    ("premachining.stock", '"din3972-II"'),
    ("premachining.stock_tolerance", "-0.01"),
    ("premachining.topping", "-1.0"),
    ("premachining.semi_topping.angle", "19.0"),
    ("premachining.semi_topping.angle", "81.0"),
    ("premachining.semi_topping.height", "0.0"),
    ("premachining.tool_pressure_angle", "0.5"),
    ("premachining.tool_pressure_angle", "46.0"),
    ("premachining.tool_module", "0.001"),
    ("premachining.cutter_teeth", "2"),
    ("premachining.cutter_teeth", "25.5"),
    ("premachining.cutter_profile_shift", "5.1"),
    ("finishing.kind", '"honing"'),
    ("finishing.end_diameter", "3e6"),
    ("finishing.wheel_tip_radius", "0.0"),
    ("finishing.notch_depth", "-0.1"),
]
"""Keys and values that no gear can have."""

_OF_GEARS_ALONE = ("premachining.tool_p", "premachining.tool_m", "premachining.cutter", "finishing.")
_OF_RACKS = [
    *(each for each in _OUT_OF_RANGE if not each[0].startswith(_OF_GEARS_ALONE)),
    ("finishing.end_depth", "1001.0"),
    ("finishing.wheel_tip_radius", "101.0"),
    ("finishing.notch_depth", "101.0"),
]

_PLAIN_GEAR = "[gear]\nteeth = 25\nnormal_module = 3.0\nface_width = 20.0\n"
_PLAIN_RACK = "[rack]\nteeth = 8\nnormal_module = 3.0\nface_width = 20.0\nheight = 20.0\n"
_OF_TOOL = {
    "tool_addendum": "1.4",
    "tool_tip_radius": "0.3",
    "protuberance": "0.14",
    "protuberance_angle": "8.0",
    "stock": "0.1",
}


@pytest.mark.parametrize(
    ("part", "key", "value"),
    [("gear", *each) for each in _OUT_OF_RANGE] + [("rack", *each) for each in _OF_RACKS],
    ids=lambda each: each.replace("premachining", "pre"),
)
def test_a_value_out_of_range_is_refused_in_one_line(part: str, key: str, value: str, tmp_path: Path) -> None:
    """The line has the key, the value, and what is permitted."""
    keys = {f"premachining.{name}": text for name, text in _OF_TOOL.items()} | {key: value}
    lines = "".join(f"{name} = {text}\n" for name, text in keys.items())
    (tmp_path / "out.toml").write_text((_PLAIN_GEAR if part == "gear" else _PLAIN_RACK) + lines, encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        read_spec(tmp_path / "out.toml")
    text = str(caught.value)
    assert "\n" not in text
    assert f"{part}.{key} = " in text
    assert "must be" in text


def test_data_tell_the_addendum_of_din_3972_and_a_stock_beyond_the_protuberance() -> None:
    third = cut_before(stock="din3972-III", tool_addendum=None, normal_module=8.0, protuberance=0.2)
    assert third.to_dict()["premachining"]["tool_addendum"] == pytest.approx(1.25 + 0.25 * 2 / 8)
    codes = [notice.code for notice in cut_before(stock=0.13, stock_tolerance=0.02).notices]
    assert "stock-beyond-protuberance" in codes
    assert "stock-beyond-protuberance" not in [notice.code for notice in cut_before(stock_tolerance=0.02).notices]


def test_columns_of_tables_have_the_stock_and_the_sizes_before_finishing() -> None:
    columns = dict(flat_document({"gear": cut_before(stock_tolerance=0.02).to_dict()}))
    named = ("residual_undercut", "root_form_diameter", "precut.span_measurement", "precut.over_balls", "least_stock.stock")
    assert {f"gear.premachining.{name}" for name in named} < columns.keys()
    assert columns["gear.form_diameter"] == columns["gear.premachining.root_form_diameter"]
    assert {symbols.GEAR[f"premachining.{name}"].symbol for name in named} == {"s_pr", "d_Ff", "W_k", "M_dK", "q"}


def test_plain_gears_say_nothing_of_it() -> None:
    document = Gear(teeth=20, normal_module=2.0, face_width=10.0).to_dict()
    assert not {"premachining", "finishing"} & document.keys()


def test_the_weaker_root_of_a_tolerance_is_rated() -> None:

    ground, exact = (cut_before(stock=0.1, stock_tolerance=tolerance) for tolerance in (0.02, 0.0))
    stresses = {}
    ends = {"most": exact.with_stock(0.12), "least": exact.with_stock(0.08)}
    for name, gear in {"both": ground, "nominal": exact, **ends}.items():
        pair = GearPair(pinion=gear, wheel=replace(gear, teeth=41))
        mesh = RootMesh.of(pair, 1000.0, Edition.ISO_2006, 6)
        stresses[name] = root_rating(gear, mesh, loaded_width(pair, Role.PINION)).nominal_stress
    assert stresses["both"] == pytest.approx(max(stresses["most"], stresses["least"]), rel=1e-12)
    assert stresses["both"] > stresses["nominal"]


@pytest.mark.parametrize(("grade", "told"), [("accuracy_grade = 6", False), ("", True)])
def test_a_grade_that_the_gears_have_is_not_told_as_assumed(tmp_path: Path, grade: str, told: bool) -> None:
    text = starter_text("ground-25-41")[1].replace("accuracy_grade = 6", grade)
    (tmp_path / "graded.toml").write_text(text, encoding="utf-8")
    design = read_spec(tmp_path / "graded.toml")
    assert any(line.startswith("rating.accuracy_grade") for line in design.to_dict()["assumed"]) is told
    rows = [row.key for section in sheet_of(design).sections for block in section.blocks for row in block.rows]
    assert ("rating.accuracy_grade" in rows) is told

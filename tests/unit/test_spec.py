"""Specs: what a TOML text becomes, and where it is refused."""

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcad import ISO53_C, SpecError
from gearcad.core.output import json_text
from gearcad.core.records import PerGear
from gearcad.designs import design_from_tables, read_spec
from gearcad.designs.design import Design, find_lines, nearest_line
from gearcad.designs.keys import KEYS
from gearcad.geometry import profile_shift_sum, specific_sliding

EXACT = 1e-12
"""Relative: the same double-precision formula in another order."""


def tables(**changes: dict[str, Any]) -> dict[str, Any]:
    """A spur pair of module 3, z 12/24, with the tables' keys changed; a key set to None is taken out."""
    made: dict[str, dict[str, Any]] = {
        "pair": {"normal_module": 3.0},
        "pinion": {"teeth": 12, "profile_shift": 0.6, "face_width": 20.0},
        "wheel": {"teeth": 24, "profile_shift": 0.36, "face_width": 20.0},
    }
    for table, keys in changes.items():
        made[table] = {key: value for key, value in {**made.get(table, {}), **keys}.items() if value is not None}
    return made


def design(**changes: dict[str, Any]) -> Design:
    return design_from_tables(tables(**changes), where=lambda key: f"<{key}>", default_name="trial")


def refusal(**changes: dict[str, Any]) -> str:
    with pytest.raises(SpecError) as caught:
        design(**changes)
    message = str(caught.value)
    assert "\n" not in message
    return message


# ---------------------------------------------------------------------- what becomes of the values


def test_shared_values_reach_both_gears_and_a_gears_own_wins() -> None:
    pair = design(
        pair={"rack": {"root_radius": 0.3, "dedendum": 1.2}, "body": {"bore": 8.0}, "face_width": 11.0, "tooth_thinning": 0.02},
        pinion={"rack": {"root_radius": 0.25}},
        wheel={"face_width": None, "tooth_thinning": 0.03},
    ).pair
    assert pair is not None
    assert (pair.pinion.rack.root_radius, pair.pinion.rack.dedendum) == (0.25, 1.2)
    assert (pair.wheel.rack.root_radius, pair.wheel.rack.dedendum) == (0.3, 1.2)
    assert (pair.pinion.face_width, pair.wheel.face_width) == (20.0, 11.0)
    assert (pair.pinion.tooth_thinning, pair.wheel.tooth_thinning) == (0.02, 0.03)
    assert pair.pinion.body.bore == pair.wheel.body.bore == 8.0


def test_a_named_rack_of_a_gear_replaces_the_shared_rack_whole() -> None:
    pair = design(pair={"rack": {"dedendum": 1.4, "root_radius": 0.1}}, wheel={"rack": "ISO53_C"}).pair
    assert pair is not None
    assert pair.wheel.rack == ISO53_C
    assert pair.pinion.rack.dedendum == 1.4


def test_numbers_of_a_gear_change_the_shared_named_rack() -> None:
    pair = design(pair={"rack": "ISO53_C"}, pinion={"rack": {"root_radius": "full"}}).pair
    assert pair is not None
    assert pair.wheel.rack.root_radius == ISO53_C.root_radius
    assert pair.pinion.rack.root_radius == "full"


@pytest.mark.parametrize("owner", ["pair", "pinion"])
def test_wheel_takes_the_opposite_hand(owner: str) -> None:
    pair = design(**{owner: {"helix_angle": 17}}).pair
    assert pair is not None
    assert (pair.pinion.helix_angle, pair.wheel.helix_angle) == (17.0, -17.0)


def test_pinion_takes_the_opposite_hand_of_a_wheel_that_alone_has_one() -> None:
    pair = design(wheel={"helix_angle": 12.5}).pair
    assert pair is not None
    assert (pair.pinion.helix_angle, pair.wheel.helix_angle) == (-12.5, 12.5)


@pytest.mark.parametrize("owner", ["pair", "pinion", "wheel"])
def test_a_ring_takes_the_same_hand(owner: str) -> None:
    made: dict[str, dict[str, Any]] = {"pair": {}, "pinion": {"teeth": 22}, "wheel": {"teeth": -70, "profile_shift": -0.5}}
    made[owner]["helix_angle"] = 17
    pair = design(**made).pair
    assert (pair.pinion.helix_angle, pair.wheel.helix_angle) == (17.0, 17.0)


def test_spur_wheel_has_no_negative_zero() -> None:
    pair = design(pair={"helix_angle": 0}).pair
    assert pair is not None
    assert math.copysign(1.0, pair.wheel.helix_angle) == 1.0


def test_same_hand_is_refused() -> None:
    message = refusal(pair={"helix_angle": 20.0}, wheel={"helix_angle": 20.0})
    assert message == "<wheel.helix_angle>: wheel.helix_angle = 20 deg: must be -20 deg, opposite to the pinion"


def test_material_and_load_travel_along() -> None:
    made = design(material={"youngs_modulus": 205000, "name": "18CrNiMo7-6"}, load={"torque": 220})
    assert made.material is not None and made.load is not None
    assert (made.material.youngs_modulus, made.material.name, made.load.torque) == (205000.0, "18CrNiMo7-6", 220.0)
    document = made.to_dict()
    assert document["load"] == {"torque": 220.0, "speed": 0.0, "application_factor": 1.0}


def test_whole_numbers_and_floats_give_the_same_bytes() -> None:
    one = design(pair={"normal_module": 3, "centre_distance": 57}, pinion={"profile_shift": "auto"})
    other = design(pair={"normal_module": 3.0, "centre_distance": 57.0}, pinion={"profile_shift": "auto"})
    assert json_text(one.to_dict()) == json_text(other.to_dict())


# ---------------------------------------------------------------------- auto


def test_tip_alteration_is_automatic_at_the_derived_centre_distance() -> None:
    """KHK Gear Technical Reference, table 4-3: z 12/24, m 3, x 0.6/0.36, verified to all digits."""
    pair = design().pair
    assert pair is not None
    assert pair.centre_distance == pytest.approx(56.499869720305185, rel=EXACT)
    assert pair.pinion.tip_alteration == pytest.approx(-0.1267100932316051, abs=1e-12)
    assert pair.pinion.tip_diameter == pytest.approx(44.83973944061037, rel=EXACT)
    assert pair.wheel.tip_diameter == pytest.approx(79.39973944061038, rel=EXACT)
    assert pair.tip_alteration == pytest.approx(pair.pinion.tip_alteration, abs=1e-12)


def test_helical_tip_alteration_at_the_derived_centre_distance() -> None:
    """KHK table 6-1: m_n 3, z 12/60, beta 30, x 0.09809/0, verified to all digits."""
    pair = design(pair={"helix_angle": 30.0}, pinion={"profile_shift": 0.09809}, wheel={"teeth": 60, "profile_shift": 0.0}).pair
    assert pair is not None
    assert pair.centre_distance == pytest.approx(125.00000117941887, rel=EXACT)
    assert pair.pinion.tip_alteration == pytest.approx(-0.0006423218467602188, abs=1e-12)


def test_tip_alteration_at_a_given_centre_distance() -> None:
    """FZG type C: m 4.5, z 16/24, x 0.1817/0.1715, a 91.5."""
    pair = design(
        pair={"normal_module": 4.5, "centre_distance": 91.5},
        pinion={"teeth": 16, "profile_shift": 0.1817},
        wheel={"profile_shift": 0.1715},
    ).pair
    assert pair is not None
    assert pair.pinion.tip_alteration == pair.wheel.tip_alteration == pytest.approx(-0.0198666666666667, abs=1e-12)
    assert pair.pinion.tip_diameter == pytest.approx(82.4565, rel=EXACT)


def test_tip_alteration_never_lengthens() -> None:
    pair = design(pair={"centre_distance": 57.0}).pair
    assert pair is not None
    pair_without_shift = design(pair={"centre_distance": 54.1}, pinion={"profile_shift": 0}, wheel={"profile_shift": 0}).pair
    assert pair_without_shift is not None
    assert pair_without_shift.pinion.tip_alteration == 0.0


def test_a_given_tip_alteration_or_tip_diameter_wins() -> None:
    pair = design(pinion={"tip_alteration": -0.05}, wheel={"tip_diameter": 79.0}).pair
    assert pair is not None
    assert (pair.pinion.tip_alteration, pair.wheel.tip_alteration, pair.wheel.tip_diameter) == (-0.05, 0.0, 79.0)


@pytest.mark.parametrize("owner", ["pinion", "wheel"])
def test_one_automatic_shift_takes_the_rest_of_the_sum(owner: str) -> None:
    pair = design(pair={"centre_distance": 56.5}, **{owner: {"profile_shift": "auto"}}).pair
    assert pair is not None
    # x_1 + x_2 = 0.96 belongs to 56.49987 mm (KHK table 4-3); da/dx is about 2.4 mm here.
    assert pair.profile_shift_sum == pytest.approx(0.96, abs=1e-4)
    assert pair.circumferential_backlash == pytest.approx(0.0, abs=1e-12)
    assert (pair.wheel.profile_shift == 0.36) is (owner == "pinion")


def test_two_automatic_shifts_balance_the_specific_sliding_of_the_gears_that_are_made() -> None:
    pair = design(
        pair={"centre_distance": 56.5, "body": {"tip_chamfer": 0.1}},
        pinion={"profile_shift": "auto"},
        wheel={"profile_shift": "auto"},
    ).pair
    assert pair is not None
    sliding = specific_sliding(
        teeth=PerGear(12, 24),
        base_radii=PerGear(pair.pinion.base_diameter / 2, pair.wheel.base_diameter / 2),
        tip_radii=PerGear(pair.pinion.tip_form_diameter / 2, pair.wheel.tip_form_diameter / 2),
        centre_distance=56.5,
    )
    assert sliding[0] == pytest.approx(sliding[1], rel=1e-9)
    assert sliding[0] < -0.1


@pytest.mark.parametrize(("split", "first"), [("equal", 0.5), ("pinion", 1.0)])
def test_two_automatic_shifts_split_as_asked(split: str, first: float) -> None:
    pair = design(
        pair={"centre_distance": 55.5, "profile_shift_split": split},
        pinion={"profile_shift": "auto"},
        wheel={"profile_shift": "auto"},
    ).pair
    assert pair is not None
    total = profile_shift_sum(
        normal_module=3.0, teeth=PerGear(12, 24), helix_angle=0.0, pressure_angle=20.0, centre_distance=55.5
    )
    assert pair.pinion.profile_shift == pytest.approx(first * total, rel=EXACT)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"pinion": {"profile_shift": "auto"}},
            "<pinion.profile_shift>: pinion.profile_shift = 'auto': needs centre_distance in [pair]",
        ),
        (
            {"pair": {"profile_shift_split": "equal"}},
            "<pair.profile_shift_split>: pair.profile_shift_split = 'equal': needs profile_shift = \"auto\" on both gears",
        ),
        (
            {"pair": {"centre_distance": 50.0}, "pinion": {"profile_shift": "auto"}},
            "<pair.centre_distance>: pair.centre_distance = 50 mm: must be above 50.743",
        ),
        (
            {"pair": {"centre_distance": 56.5}, "pinion": {"profile_shift": "automatic"}},
            "<pinion.profile_shift>: pinion.profile_shift = 'automatic': must be a number at least -5 and at most 5, or \"",
        ),
        (
            {"pair": {"centre_distance": 56.5}, "pinion": {"profile_shift": "auto"}, "wheel": {"normal_module": 2.5}},
            "<wheel.normal_module>: wheel.normal_module = 2.5 mm: must be 3 mm, as on the pinion",
        ),
    ],
)
def test_auto_that_cannot_be_resolved_is_refused(changes: dict[str, Any], message: str) -> None:
    assert refusal(**changes).startswith(message)


def test_a_centre_distance_that_makes_no_gear_is_what_is_named() -> None:
    """And not the diameter, alteration or shift that follow from it and that nobody wrote."""
    message = refusal(pair={"centre_distance": 51.0}, pinion={"profile_shift": "auto"})
    assert message.startswith("<pair.centre_distance>: pair.centre_distance = 51 mm: asks for x1 + x2 = -0.7")
    assert " and makes pinion.tip_diameter = 33.84 mm, which must be above 34.8434 mm, the root form circle" in message
    for distance, permitted in ((38.0, "above 50.7435 mm, where"), (51.0, "at least "), (90.0, "below ")):
        expected = f"<pair.centre_distance>: pair.centre_distance = {distance:g} mm: must be {permitted}"
        assert refusal(pair={"centre_distance": distance}).startswith(expected)


def test_a_gear_that_is_wrong_at_any_centre_distance_is_named_itself() -> None:
    pair = {"centre_distance": 54.0}
    message = refusal(pair=pair, pinion={"profile_shift": "auto"}, wheel={"profile_shift": 3.0})
    assert message.startswith("<wheel.tip_diameter>: wheel.tip_diameter = ") and "pointed tooth" in message
    assert refusal(pair=pair, pinion={"profile_shift": "auto"}, wheel={"body.bore": 300.0}).startswith("<wheel.body.bore>")


# ---------------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pinion": {"teeth": 2.5}}, "<pinion.teeth>: pinion.teeth = 2.5: must be a whole number from 3 to 2000"),
        (
            {"pinion": {"teeth": 13.0}},
            "<pinion.teeth>: pinion.teeth = 13: must be a whole number from 3 to 2000 (write 13, not 13.0)",
        ),
        ({"pinion": {"teeth": None}}, "<pinion.teeth>: pinion.teeth is missing: must be a whole number from 3 to 2000"),
        (
            {"pair": {"normal_module": None}},
            "<pinion.normal_module>: pinion.normal_module is missing: must be a number at least 0.01 mm and at most 200 mm,"
            " or give normal_diametral_pitch instead"
            " (here or in [pair])",
        ),
        (
            {"pair": {"normal_module": -1}},
            "<pair.normal_module>: pair.normal_module = -1 mm: must be a number at least 0.01 mm",
        ),
        ({"wheel": {"face_width": "20"}}, "<wheel.face_width>: wheel.face_width = '20': must be a number above 0 mm"),
        ({"wheel": {"face_width": "auto"}}, "<wheel.face_width>: wheel.face_width = 'auto': must be a number above 0 mm"),
        ({"wheel": {"face_width": float("nan")}}, "<wheel.face_width>: wheel.face_width = nan mm: must be a number above 0 mm"),
        ({"pinion": {"facewidth": 3}}, "<pinion.facewidth>: pinion.facewidth: unknown key; did you mean face_width?"),
        (
            {"pinion": {"drawing": {"tooth_allowance": "cd25"}}},
            "<pinion.drawing.tooth_allowance>: pinion.drawing.tooth_allowance: unknown key here; tooth_allowance is a key "
            "of the table of the gear itself, not of its drawing",
        ),
        (
            {"pinion": {"drawing": {"centre_distance_tolerance": "js7"}}},
            "<pinion.drawing.centre_distance_tolerance>: pinion.drawing.centre_distance_tolerance: unknown key here; it "
            "belongs in [pair]",
        ),
        ({"pinion": {"z": 3}}, "<pinion.z>: pinion.z: unknown key; did you mean teeth?"),
        (
            {"pinion": {"root_radius": 3}},
            "<pinion.root_radius>: pinion.root_radius: unknown key; did you mean rack.root_radius?",
        ),
        ({"pinion": {"body": {"boer": 3}}}, "<pinion.body.boer>: pinion.body.boer: unknown key; did you mean body.bore?"),
        ({"pinion": {"qqq": 3}}, "<pinion.qqq>: pinion.qqq: unknown key; the nearest of the 131 permitted are "),
        (
            {"pinion": {"centre_distance": 3}},
            "<pinion.centre_distance>: pinion.centre_distance: unknown key here; it belongs in [pair]",
        ),
        ({"lod": {}}, "<lod>: lod: unknown table; did you mean [load]?"),
        (
            {"load": {"speed": 3}},
            "<load.torque>: load.torque is missing: must be a number, 0 or from 1e-09 to 1e+09 N·m in size",
        ),
        ({"material": {"name": 3}}, "<material.name>: material.name = 3: must be a text"),
        ({"pinion": {"rack": "DIN867"}}, "<pinion.rack>: pinion.rack = 'DIN867': must be one of 'ISO53_A', 'ISO53_B', "),
        (
            {"wheel": {"rack": {"root_radius": 0.6}}},
            "<wheel.rack.root_radius>: wheel.rack.root_radius = 0.6: must be at most 0.4719 (full radius) for dedendum 1.25",
        ),
        (
            {"pair": {"rack": {"root_radius": 0.6}}},
            "<pair.rack.root_radius>: pair.rack.root_radius = 0.6: must be at most 0.4719 (full radius) for dedendum 1.25",
        ),
        (
            {"pair": {"rack": {"dedendum": 1.5}}},
            "<pinion.rack.root_radius>: pinion.rack.root_radius = 0.38 (by default): must be at most 0.3",
        ),
        (
            {"pinion": {"body": {"hub_side": "top"}}},
            "<pinion.body.hub_side>: pinion.body.hub_side = 'top': must be one of 'front', ",
        ),
        ({"pinion": {"body": {"tip_chamfer": 9}}}, "<pinion.body.tip_chamfer>: pinion.body.tip_chamfer = 9 mm: must be "),
        (
            {"pinion": {"body": {"rim_diameter": 90}}},
            "<pinion.body.rim_diameter>: pinion.body.rim_diameter = 90 mm: must be left out",
        ),
        ({"pair": {"axial_offset": 20}}, "<pair.axial_offset>: pair.axial_offset = 20 mm: must be between -20 and 20 mm"),
        ({"pair": {"name": "a/b"}}, "<pair.name>: pair.name = 'a/b': must be a plain file name, without / "),
        (
            {"pinion": {"teeth": 10**400}},
            "<pinion.teeth>: pinion.teeth: must be a smaller number; this is a number of 401 digits",
        ),
        ({"gear": {"teeth": 3}}, "<pair>: [pair] cannot stand beside [gear]"),
    ],
)
def test_wrong_values_are_refused_by_key_value_and_what_is_permitted(changes: dict[str, Any], message: str) -> None:
    assert refusal(**changes).startswith(message)


@pytest.mark.parametrize(
    "name", ["..", ".hidden", "", "  ", "a\\b", "a\nb", "nul", "COM1.toml", "x.", "-o", "a" * 101, "\udc80"]
)
def test_names_that_are_no_plain_file_names_are_refused(name: str) -> None:
    assert ": must be a plain file name" in refusal(pair={"name": name})


@pytest.mark.parametrize("name", ["volvo-13-44", "Stirnrad 5", "växel_1", "pair.v2"])
def test_plain_names_pass(name: str) -> None:
    assert design(pair={"name": name}).name == name


@pytest.mark.parametrize("field", ["profile_shift", "tip_alteration"])
def test_single_gear_has_nothing_automatic(field: str) -> None:
    with pytest.raises(SpecError, match=rf"gear\.{field} = 'auto': must be a number: only the gears of a pair"):
        design_from_tables(
            {"gear": {"teeth": 20, "normal_module": 2.0, "face_width": 9.0, field: "auto"}},
            where=lambda key: key,
            default_name="x",
        )


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "must have [gear], or [pair] with [pinion] and [wheel]"),
        ({"pair": {}, "pinion": {}}, "[wheel] is missing: a pair needs [pair], [pinion] and [wheel]"),
        ({"gear": 3}, "gear = 3: must be a table, headed [gear]"),
    ],
)
def test_kind_of_the_spec_must_be_clear(given: dict[str, Any], message: str) -> None:
    with pytest.raises(SpecError) as caught:
        design_from_tables(given, where=lambda key: "here", default_name="x")
    assert str(caught.value).endswith(message)


# ---------------------------------------------------------------------- files and lines


def test_name_is_the_stem_of_the_file_by_default(tmp_path: Path) -> None:
    path = tmp_path / "sun gear.toml"
    path.write_bytes(b"\xef\xbb\xbf[gear]\r\nteeth = 20\r\nnormal_module = 2\r\nface_width = 9\r\n")
    made = read_spec(path)
    assert made.name == "sun gear"
    assert made.gear is not None and made.gear.name == "sun gear"
    assert json.loads(json_text(made.to_dict()))["gear"]["reference_diameter"] == 40.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[gear]\nteeth = 2.5\n", " line 2: gear.teeth = 2.5: "),
        (
            "# one\n\n[gear]\n  teeth=20\nnormal_module=2\nface_width=9\n[gear.rack]\nroot_radius = 2\n",
            " line 8: gear.rack.root_radius = 2: ",
        ),
        (
            "[gear]\nrack = { root_radius = 2 }\nteeth=20\nnormal_module=2\nface_width=9\n",
            " line 2: gear.rack.root_radius = 2: ",
        ),
        ("[gear]\nbody.bore = 3\nbody . 'bor' = 2", " line 3: gear.body.bor: unknown key"),
        ("[gear]\nteeth = 20\n", " line 1: gear.normal_module is missing: "),
        ('[gear]\n"a\\nb" = 2\n', r"gear.a\nb: unknown key; the nearest of the 111 permitted are "),
        ("gear.teeth = 2\n", " line 1: gear.teeth = 2: "),
        ("[gear]\nteeth = 20\nteeth = 21\n", " line 3, column 11: is not valid TOML: Cannot overwrite a value"),
        ("[gear]\nface_width = 18,3\n", "; write 18.3 with a point"),
        ('[gear]\nname = """\\\nteeth = 1"""\nteeth = 2\n', " line 4: gear.teeth = 2: "),
    ],
)
def test_file_and_line_lead_the_message(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "x.toml"
    path.write_text(text)
    with pytest.raises(SpecError) as caught:
        read_spec(path)
    assert str(caught.value).startswith(str(path))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_lines_of_a_shipped_template_are_those_of_its_text() -> None:
    text = (Path(__file__).parents[2] / "templates" / "volvo-13-44.toml").read_text(encoding="utf-8")
    lines = find_lines(text)
    written = text.split("\n")
    assert written[lines["wheel.rack.root_radius"] - 1].startswith("rack.root_radius = 0.32")
    assert written[lines["pair.centre_distance"] - 1].startswith("centre_distance = 80.0")
    assert nearest_line(lines, "wheel.rack.dedendum") == lines["wheel"]
    assert nearest_line(lines, "elsewhere.key") is None


def test_unreadable_files_are_one_line(tmp_path: Path) -> None:
    (tmp_path / "latin.toml").write_bytes("# dé".encode("latin-1"))
    for path, reason in (
        (tmp_path / "none.toml", "cannot be read (No such file or directory)"),
        (tmp_path, "cannot be read (Is a directory)"),
        (tmp_path / "latin.toml", "is not UTF-8 text (byte 3)"),
    ):
        with pytest.raises(SpecError) as caught:
            read_spec(path)
        assert str(caught.value).startswith(f"{path}: {reason}")


# ---------------------------------------------------------------------- anything TOML can hold

VALUES = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.integers(min_value=-(10**20), max_value=10**20),
    st.floats(min_value=0.01, max_value=40.0),
    st.integers(min_value=1, max_value=200),
    st.booleans(),
    st.sampled_from(["auto", "full", "ISO53_D", "both", "equal", ""]),
    st.text(max_size=5),
    st.lists(st.integers(), max_size=2),
    st.dictionaries(st.sampled_from(["bore", "root_radius", "x"]), st.floats(), max_size=2),
)


def _table(name: str) -> st.SearchStrategy[dict[str, Any]]:
    """Changes of up to three keys of a table, nested where the key has a dot."""

    def nest(flat: dict[str, Any]) -> dict[str, Any]:
        nested: dict[str, Any] = {}
        for key, value in flat.items():
            part, _, field = key.partition(".")
            if not field:
                nested[part] = value
            elif isinstance(nested.setdefault(part, {}), dict):
                nested[part][field] = value
        return nested

    return st.dictionaries(st.sampled_from(sorted(KEYS[name])), VALUES, max_size=3).map(nest)


@settings(max_examples=150, deadline=None)
@given(pair=_table("pair"), pinion=_table("pinion"), wheel=_table("wheel"), load=_table("load"))
def test_any_values_make_a_design_or_one_clear_line(
    pair: dict[str, Any], pinion: dict[str, Any], wheel: dict[str, Any], load: dict[str, Any]
) -> None:
    try:
        made = design(pair=pair, pinion=pinion, wheel=wheel, load={"torque": 1.0, **load})
    except SpecError as error:
        message = str(error)
        assert message.startswith("<") and ">: " in message
        assert message.isprintable()
        assert len(message) < 900
    else:
        json.loads(json_text(made.to_dict()))

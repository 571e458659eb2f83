"""Specs of planetary trains: both ways to write a set, what follows from what, and what is said of mistakes."""

import math
from pathlib import Path

import pytest
from scipy.optimize import brentq

from gearcad.core.errors import ParameterError, SpecError
from gearcad.designs import DesignKind, DesignRow, PlanetaryDesign, open_table, read_spec
from gearcad.designs.train_keys import PLANETARY
from gearcad.designs.variations import column_of_train, read_variation, spec_values

PLAIN = """
[planetary]
planets = 3
input = "sun"
output = "carrier"
fixed = "ring"
normal_module = 2.0
face_width = 20.0

[sun]
teeth = 24
profile_shift = 0.2

[planet]
teeth = 21

[ring]
teeth = -66
profile_shift = "auto"
body.rim_diameter = 160.0
"""

ALM = """
[planetary]
planets = 3
input = "pinion"
output = "ring_5"
fixed = "ring_4"
centre_distance = 69.0
face_width = 14.0

[planetary.pre_stage]
normal_module = 1.5
centre_distance = 135.0
face_width = 10.0
pinion.teeth = 18
pinion.name = "pinion"
pinion.profile_shift = 0.3422
wheel.teeth = 161
wheel.name = "gear_2"
wheel.profile_shift = 0.1682
"""

SHORT = """
[ring]
name = "ring_4"
teeth = -70
profile_shift = "auto"

[planet]
name = "rim_3"
teeth = 22
normal_module = 2.8
profile_shift = 0.5

[planet_2]
name = "rim_3p"
teeth = 21
normal_module = 2.6
profile_shift = 0.5
axial_position = 20.0

[ring_2]
name = "ring_5"
teeth = -72
profile_shift = "auto"
"""

LISTS = """
[[planetary.rim]]
name = "rim_3p"
teeth = 21
normal_module = 2.6
profile_shift = 0.5
axial_position = 20.0

[[planetary.central]]
name = "ring_4"
meshes = "rim_3"
teeth = -70
profile_shift = "auto"

[[planetary.central]]
name = "ring_5"
meshes = "rim_3p"
teeth = -72
profile_shift = "auto"

[[planetary.rim]]
name = "rim_3"
teeth = 22
normal_module = 2.8
profile_shift = 0.5
"""


def read(folder: Path, text: str) -> PlanetaryDesign:
    path = folder / "train.toml"
    path.write_text(text, encoding="utf-8")
    design = read_spec(path)
    assert isinstance(design, PlanetaryDesign)
    return design


def fault(folder: Path, text: str, *changes: tuple[str, str]) -> str:
    """What is said of a spec after changes, each of which must be possible."""
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    with pytest.raises(SpecError) as caught:
        read(folder, text)
    message = str(caught.value)
    assert message.isprintable()
    return message.replace(f"{folder}/", "")


def test_the_train_of_the_alm_thesis_has_the_shifts_that_its_centre_distance_asks_for(tmp_path: Path) -> None:
    train = read(tmp_path, ALM + SHORT).train
    assert [central.gear.profile_shift for central in train.centrals] == pytest.approx([-1.2025, -1.6794], abs=5e-5)
    assert train.basic_ratio == pytest.approx(1.0775510, abs=5e-8)
    assert [(stage.pinion, stage.wheel) for stage in train.stages] == [("pinion", "carrier")]
    assert [mesh.pair.circumferential_backlash for mesh in train.meshes] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_both_ways_to_write_a_set_make_the_same_train(tmp_path: Path) -> None:
    assert read(tmp_path, ALM + SHORT).train == read(tmp_path, ALM + LISTS).train


def test_the_ring_follows_from_sun_and_planet_where_no_centre_distance_is_given(tmp_path: Path) -> None:
    train = read(tmp_path, PLAIN).train
    sun, ring = train.meshes
    wanted = math.tan(math.radians(20)) - math.radians(20) + 2 * math.tan(math.radians(20)) * 0.2 / 45
    working = brentq(lambda angle: math.tan(angle) - angle - wanted, 0.1, 0.6)
    assert train.centre_distance == pytest.approx(45 * math.cos(math.radians(20)) / math.cos(working), abs=1e-10)
    assert ring.pair.centre_distance == -train.centre_distance == -sun.pair.centre_distance
    assert train.centrals[1].gear.profile_shift == pytest.approx(-0.2, abs=1e-12)  # z_s + z_p = |z_r| - z_p
    assert sun.pair.tip_clearances == pytest.approx((0.5, 0.5), abs=1e-12)  # shortened to 0.25 modules


@pytest.mark.parametrize("on", ["sun", "planet", "ring"])
def test_the_hand_follows_from_any_gear_of_the_set(on: str, tmp_path: Path) -> None:
    angle = {"sun": 15.0, "planet": -15.0, "ring": -15.0}
    train = read(tmp_path, PLAIN.replace(f"[{on}]", f"[{on}]\nhelix_angle = {angle[on]}")).train
    sun, ring = train.centrals
    found = (sun.gear.helix_angle, train.rims[0].gear.helix_angle, ring.gear.helix_angle)
    assert found == (angle["sun"], angle["planet"], angle["ring"])


def test_the_module_of_a_mesh_may_stand_on_either_gear(tmp_path: Path) -> None:
    moved = PLAIN.replace("normal_module = 2.0\n", "").replace("[ring]", "[ring]\nnormal_module = 2.0")
    assert read(tmp_path, moved).train == read(tmp_path, PLAIN).train


def test_a_shared_module_that_no_gear_is_left_with_is_refused(tmp_path: Path) -> None:
    own = ("[planet]", "[planet]\nnormal_module = 2.5")
    assert "planetary.normal_module = 2 mm: is no gear's: planet.normal_module = 2.5 counts before it" in fault(
        tmp_path, PLAIN, own
    )
    agreed = read(tmp_path, PLAIN.replace(own[0], own[1].replace("2.5", "2.0")))
    assert agreed.train == read(tmp_path, PLAIN).train
    pitch = PLAIN.replace("normal_module = 2.0", "normal_diametral_pitch = 12.7")
    assert "planetary.normal_diametral_pitch = 12.7 1/inch: is no gear's: " in fault(tmp_path, pitch, own)


def test_two_automatic_shifts_share_what_the_centre_distance_asks_for(tmp_path: Path) -> None:
    text = PLAIN.replace("profile_shift = 0.2", 'profile_shift = "auto"').replace(
        "teeth = 21", 'teeth = 21\nprofile_shift = "auto"'
    )
    text = text.replace("planets = 3", "planets = 3\ncentre_distance = 45.5")
    train = read(tmp_path, text).train
    assert [mesh.pair.circumferential_backlash for mesh in train.meshes] == pytest.approx([0.0, 0.0], abs=1e-9)
    equal = read(tmp_path, text.replace("planets = 3", 'planets = 3\nprofile_shift_split = "equal"')).train
    assert equal.centrals[0].gear.profile_shift == equal.rims[0].gear.profile_shift > 0.1


MISTAKES = [
    ((("planets = 3", "planet = 3"),), "line 3: planetary.planet: unknown key; did you mean planets?"),
    ((("planets = 3\n", ""),), "line 2: planetary.planets is missing: must be a whole number from 1 to 24"),
    ((("planets = 3", "planets = 2.5"),), "line 3: planetary.planets = 2.5: must be a whole number from 1 to 24"),
    ((('input = "sun"\n', ""),), "line 2: planetary.input is missing: must be sun, ring, carrier"),
    ((('fixed = "ring"', 'fixed = "rim"'),), "line 6: planetary.fixed = 'rim': must be sun, ring, carrier"),
    ((("teeth = -66", "teeth = 66"),), "line 18: ring.teeth = 66: must be negative, as a ring's (ISO 21771): write -66"),
    ((("teeth = 24", "teeth = -24"),), "line 11: sun.teeth = -24: must be above 0, for outer teeth: write 24"),
    ((("[planet]\nteeth = 21\n", ""),), "line 2: [planet] is missing: the gears on the carrier"),
    ((("[sun]", "[sun_2]"),), "line 10: [sun] is missing: [sun_2] is the second of its kind"),
    ((("teeth = 21", "teeht = 21"),), "line 15: planet.teeht: unknown key; did you mean teeth?"),
    ((("[sun]\n", "[sun]\nrim_diameter = 3\n"),), "line 11: sun.rim_diameter: unknown key; did you mean body.rim_diameter?"),
    ((("[sun]\n", "[sun]\nplanets = 3\n"),), "line 11: sun.planets: unknown key here; it belongs in [planetary]"),
    ((("[ring]", "[wheel]"),), "line 17: wheel: unknown table; permitted are [planetary], [sun], [planet], [ring], "),
    (
        (("[ring]", "[carrier]"),),
        "line 17: carrier: cannot stand in the spec of a planetary train; did you mean [planetary.carrier]?",
    ),
    (
        (("face_width = 20.0\n", ""),),
        "line 9: sun.face_width is missing: must be a number above 0 mm and at most 10000 mm (here or in [planetary])",
    ),
    (
        (("profile_shift = 0.2", 'profile_shift = "auto"'),),
        "line 12: sun.profile_shift = 'auto': needs centre_distance in [planetary], or numbers in one mesh",
    ),
    (
        (("profile_shift = 0.2", 'profile_shift = "atuo"'),),
        "line 12: sun.profile_shift = 'atuo': must be a number at least -5 and at most 5, or \"auto\"",
    ),
    (
        (("planets = 3", "planets = 3\ncentre_distance = -45.0"),),
        "line 4: planetary.centre_distance = -45 mm: must be a number above 0 mm",
    ),
    (
        (("[planet]", '[planet]\nname = "sun"'),),
        "line 15: planet.name = 'sun': must be given once: members and rims need names of their own",
    ),
    ((("[sun]", "[sun]\nsupport_stiffness = -1"),), "line 11: sun.support_stiffness = -1 N/µm: must be"),
    (
        (("[sun]", '[sun]\nname = "s"\nsupport_stiffness = -1'), ('"sun"', '"s"')),
        "line 12: sun.support_stiffness = -1 N/µm: must be",
    ),
    (
        (("[sun]", "[planetary.carrier]\npin_stifness = 1\n[sun]"),),
        "line 11: planetary.carrier.pin_stifness: unknown key; did you mean carrier.pin_stiffness?",
    ),
    (
        (("[sun]", "[planetary.carrier]\npin_stiffness = -1\n[sun]"),),
        "line 11: planetary.carrier.pin_stiffness = -1 N/µm: must be",
    ),
    (
        (("[sun]", "[planetary.speeds]\nrnig = 1\n[sun]"),),
        "line 11: planetary.speeds.rnig = 1 rpm: belongs to no member: the members are sun, ring, carrier",
    ),
    (
        (("[sun]", "[load]\ntorque = 1\nspeed = 9\n[planetary.speeds]\nsun = 1\n[sun]"),),
        "line 14: planetary.speeds.sun = 1 rpm: must not be given too: load.speed is that of sun",
    ),
    (
        (("[sun]", "[planetary.speeds]\nring = 1\n[sun]"),),
        "line 11: planetary.speeds.ring = 1 rpm: must not be given too: ring is fixed",
    ),
    (
        (("[sun]", "[load]\ntorque = 1\nspeed = 9\n[planetary.speeds]\ncarrier = 1\n[sun]"),),
        "line 14: planetary.speeds.carrier = 1 rpm: must not be given too: it follows from ring and sun",
    ),
    ((('profile_shift = "auto"', "profile_shift = 0.2"),), "ring.profile_shift = -0.2"),
]


MISTAKES_OF_ALM = [
    (
        (('profile_shift = "auto"\n\n[planet]', 'profile_shift = -1.2025\n\n[planet]'), ("centre_distance = 69.0\n", ""),
         ('teeth = -72\nprofile_shift = "auto"', "teeth = -72\nprofile_shift = -1.1794")),
        "line 41: ring_2.profile_shift = -1.1794: must be -1.6794 for one centre distance: the meshes run without backlash at"
        " 69.000 mm (ring_4-rim_3) and 67.927 mm (ring_5-rim_3p); or give one that suits both",
    ),
    (
        (('teeth = -72\nprofile_shift = "auto"', "teeth = -72\nprofile_shift = -1.1794"),),
        "line 7: planetary.centre_distance = 69 mm: must suit both meshes, which run without backlash at 69.000 mm"
        " (ring_4-rim_3) and 67.927 mm (ring_5-rim_3p)",
    ),
    (
        (("centre_distance = 135.0\n", ""), ("pinion.profile_shift = 0.3422", 'pinion.profile_shift = "auto"')),
        "line 15: planetary.pre_stage.pinion.profile_shift = 'auto': needs centre_distance in [planetary.pre_stage]",
    ),
    ((("wheel.teeth = 161", "wheel.teeht = 161"),), "line 17: planetary.pre_stage.wheel.teeht: unknown key; did you mean"),
    (
        (('wheel.name = "gear_2"', 'wheel.name = "ring_5"'),),
        "line 40: ring_2.name = 'ring_5': must be given once: every gear and the carrier have names of their own",
    ),
    (
        (('wheel.name = "gear_2"', 'wheel.on = "moon"'),),
        "line 18: planetary.pre_stage.wheel.on = 'moon': must be one of ring_4, ring_5, carrier",
    ),
    ((("axial_position = 20.0", "axial_position = 2.0"),), "line 37: planet_2.axial_position = 2 mm: must be at least"),
    ((("planets = 3", "planets = 4"),), "line 2: planetary.planet_angles = 'equal' (by default): must let the teeth fit"),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "words"), MISTAKES_OF_ALM, ids=[str(number) for number in range(len(MISTAKES_OF_ALM))])
def test_mistakes_in_stepped_sets_and_stages_are_led_back(
    changes: tuple[tuple[str, str], ...], words: str, tmp_path: Path
) -> None:
    assert words in fault(tmp_path, ALM + SHORT, *changes)


def test_mistakes_in_lists_are_led_back_to_their_tables(tmp_path: Path) -> None:
    assert "line 38: planetary.central[1].teeht: unknown key; did you mean teeth?" in fault(
        tmp_path, ALM + LISTS, ("teeth = -72", "teeth = -72\nteeht = 3")
    )
    assert "planetary.central[1].support_stiffness = -1 N/µm: must be" in fault(
        tmp_path, ALM + LISTS, ("teeth = -72", "teeth = -72\nsupport_stiffness = -1")
    )
    assert "planetary.central[0].meshes = 'rim': must be 'rim_3p' or 'rim_3', a rim of the planets" in fault(
        tmp_path, ALM + LISTS, ('meshes = "rim_3"', 'meshes = "rim"')
    )
    assert "planetary.central[1].meshes = 'rim_3': must be 'rim_3p': each rim meshes with one" in fault(
        tmp_path, ALM + LISTS, ('meshes = "rim_3p"', 'meshes = "rim_3"')
    )
    assert "[sun] cannot stand beside [[planetary.central]]: write the set in one way" in fault(
        tmp_path, ALM + LISTS, ("[planetary.pre_stage]", "[sun]\nteeth = 20\n[planetary.pre_stage]")
    )


def test_what_stands_in_planetary_and_on_a_gear_must_agree(tmp_path: Path) -> None:
    helical = PLAIN.replace("planets = 3", "planets = 3\nhelix_angle = 15.0")
    assert "planetary.helix_angle = 15 deg: must be -15 deg, opposite to planet" in fault(
        tmp_path, helical, ("teeth = 21", "teeth = 21\nhelix_angle = 15.0")
    )
    stepped = ALM.replace("planets = 3", "planets = 3\nhelix_angle = 15.0") + SHORT
    assert "is of ring_4 and its mate only: give planet_2.helix_angle too, 0 for spur teeth" in fault(tmp_path, stepped)


@pytest.mark.parametrize(("changes", "words"), MISTAKES, ids=[str(number) for number in range(len(MISTAKES))])
def test_mistakes_are_led_back_to_what_was_written(changes: tuple[tuple[str, str], ...], words: str, tmp_path: Path) -> None:
    assert words in fault(tmp_path, PLAIN, *changes)


HEADING = "name,planets,input,output,fixed,normal_module,face_width,sun.teeth,planet.teeth,ring.teeth,ring.profile_shift"
ROW = "a,3,sun,carrier,ring,2,20,24,21,-66,auto"


def table(folder: Path, *lines: str) -> list[DesignRow]:
    path = folder / "trains.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    return list(open_table(path).rows())


def test_a_row_of_a_table_makes_what_a_spec_does(tmp_path: Path) -> None:
    plain = (
        PLAIN.replace("profile_shift = 0.2\n", "")
        .replace("body.rim_diameter = 160.0\n", "")
        .replace("[planetary]", '[planetary]\nname = "a"')
    )
    (row,) = table(tmp_path, HEADING, ROW)
    assert row.design() == read(tmp_path, plain)
    more = f"{HEADING},carrier.pin_errors,planetary.speeds.ring,pre_stage.pinion.teeth,load.mesh_efficiency"
    (row,) = table(tmp_path, more.replace("fixed,", ""), ROW.replace("ring,", "") + ",20 0 0,-300,,")
    design = row.design()
    assert isinstance(design, PlanetaryDesign)
    assert design.train.carrier.pin_errors == (20.0, 0.0, 0.0)
    assert design.speeds == {"ring": -300.0}
    assert design.load is None


@pytest.mark.parametrize(
    ("heading", "words"),
    [
        ("sun.teeht", "did you mean sun.teeth?"),
        ("planetz", "did you mean planetary.planets?"),
        ("carrier.pin_stifness", "did you mean planetary.carrier.pin_stiffness?"),
        ("centre_distanc", "did you mean planetary.centre_distance?"),
        ("wheel.teeth", "cannot stand beside keys of planetary trains: a table holds these, or gears and pairs"),
        ("planetary.name", "is the name of the design; write name"),
    ],
)
def test_headings_that_no_train_has(heading: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(SpecError, match=r"trains\.csv row 1 column L") as caught:
        table(tmp_path, f"{HEADING},{heading}", f"{ROW},1")
    assert words in str(caught.value)


def test_a_row_tells_all_its_faults_at_once(tmp_path: Path) -> None:
    wrong = ROW.replace("a,3,sun", "a,0,moon").replace("24,21", "2,21").replace("2,20,", "-2,20,", 1)
    faults = [fault.partition("(a): ")[2] for row in table(tmp_path, HEADING, wrong) for fault in row.all_faults()]
    assert faults == [
        "planetary.planets = 0: must be a whole number from 1 to 24",
        "planetary.input = 'moon': must be sun, ring, carrier",
        "planetary.normal_module = -2 mm: must be a number at least 0.01 mm and at most 200 mm",
        "sun.teeth = 2: must be a whole number from 3 to 2000",
    ]


def test_a_study_varies_keys_of_a_train(tmp_path: Path) -> None:
    spec = tmp_path / "plain.toml"
    spec.write_text(PLAIN, encoding="utf-8")
    assert spec_values(spec)[0] is DesignKind.PLANETARY
    for text, key in (("sun.profile_shift=0,0.2", "sun.profile_shift"), ("planets=3,5", "planetary.planets")):
        assert read_variation(text, DesignKind.PLANETARY, sampled=False).key == key
    with pytest.raises(ParameterError, match=r"did you mean planetary\.planets"):
        read_variation("planetz=3,5", DesignKind.PLANETARY, sampled=False)


def test_every_key_has_a_symbol_in_tables_of_results() -> None:
    keys = {f"{table}.{key}" for table, fields in PLANETARY.items() for key in fields}
    assert {key for key in keys if column_of_train(key) is None} == set()
    found = column_of_train("planetary.meshes.ring_4-rim_3.transverse_contact_ratio")
    assert found is not None and (found[0], found[1].symbol) == ("ring_4-rim_3", "ε_α")
    found = column_of_train("ring_4.tip_diameter")
    assert found is not None and (found[0], found[1].symbol) == ("ring_4", "d_a")

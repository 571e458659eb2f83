"""The gear data table: what stands in it is what data.json and ISO 1328 have, rounded; and hands are those of the solids."""

import re
from dataclasses import replace

import numpy as np
import pytest

import gearcad
from gearcad import Body, DoubleHelix, FlankModification, Gear, GearPair, Material, Rack, RackPair, ShaperCutter
from gearcad.drawing.drawing_subjects import DrawnGear, Mate
from gearcad.drawing.gear_data_rows import gear_notices, gear_rows
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Pen, Polyline
from gearcad.drawing.views.gear_views import section_view
from gearcad.drawing.words import Draughting, Language, SheetWords
from gearcad.geometry import ISO53_D, BasicRack
from gearcad.geometry.gear_parts import HubSide
from gearcad.material import MaterialGroup
from gearcad.rating.tolerances import Accuracy, gear_tolerances
from gearcad.solids.facets.tessellation import tessellate, tessellate_rack

WORDS = {language: SheetWords.of(language) for language in Language}


def _pair(pinion, wheel, **given):
    """Both gears of a pair as they are drawn."""
    made = (RackPair(pinion=pinion, rack=wheel) if isinstance(wheel, Rack) else GearPair(pinion=pinion, wheel=wheel, **given),)
    return [
        DrawnGear(role=role, gear=own, grade=own.accuracy_grade if isinstance(own, Gear) else 7, mates=(mate,))
        for role, own, mate in (
            ("pinion", pinion, Mate(name="wheel", number="GC-2", gear=wheel, pair=made[0])),
            ("wheel", wheel, Mate(name="pinion", gear=pinion, pair=made[0])),
        )
    ]


def _all():
    reliefs = {
        "tip_relief": 12.5,
        "tip_relief_length": 3.25,
        "end_relief": 15,
        "end_relief_length": 2,
        "end_relief_shape": "parabolic",
    }
    relief = FlankModification(lead_crowning=8, twist=-4, **reliefs)
    helical = {"normal_module": 2.5, "face_width": 30, "tooth_allowance": "cd25", "flank_roughness": 4.8, "root_roughness": 16}
    first = Gear(teeth=17, helix_angle=-15.123456, profile_shift=0.31, accuracy_grade=6, modification=relief, **helical)
    second = Gear(teeth=43, helix_angle=15.123456, body=Body(tip_chamfer=0.3), accuracy_grade=5, **helical)
    spur = {"normal_module": 2, "face_width": 20}
    ring = Gear(teeth=-70, profile_shift=0.2, tooth_allowance="d26", cutter=ShaperCutter(teeth=25), **spur)
    inside = Gear(teeth=22, rack=BasicRack(dedendum=1.3, root_radius="full"), **spur)
    rack = Rack(teeth=20, normal_module=3, face_width=30, height=25, helix_angle=10, tip_chamfer=0.2)
    halves = DoubleHelix(gap_width=20, offset=0.25)
    double = Gear(teeth=23, normal_module=4, face_width=100, helix_angle=28, double_helix=halves, rack=ISO53_D)
    yield from _pair(first, second, centre_distance_tolerance="js7")
    yield from _pair(inside, ring)
    yield from _pair(Gear(teeth=18, normal_module=3, face_width=30, helix_angle=-10), rack)
    yield DrawnGear(role="gear", gear=double, accuracy=Accuracy.ISO_2013, grade=5)
    yield DrawnGear(role="gear", gear=Gear(teeth=400, normal_diametral_pitch=7, face_width=2, helix_angle=50), grade=8)
    yield DrawnGear(role="gear", gear=Gear(teeth=12, normal_module=0.05, face_width=0.5, tooth_thinning=0.001))
    yield DrawnGear(role="gear", gear=Gear(teeth=-90, helix_angle=12, root_diameter=-189.2, **spur))


DRAWN = tuple(_all())
NUMBER = re.compile(r"[+−]?\d+(?:[.,]\d+)?(?!\d*×)")
OWN = ("h_aP*", "h_fP*", "ρ_fP*")


def _flat(document, lead=""):
    for key, value in document.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{lead}{key}.")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield f"{lead}{key}", value


def _known(drawn):
    """All numbers of data.json and of the tolerances, by the keys of rows."""
    part = drawn.gear
    known = dict(_flat(gearcad.data(part)["rack" if isinstance(part, Rack) else "gear"]))
    if isinstance(part, Gear):
        grade = 6 if drawn.grade is None else drawn.grade
        known |= dict(_flat(gear_tolerances(part, grade, drawn.accuracy).to_dict(), "tolerances."))
        known |= {"root_radius": part.root_radius, "dedendum": part.dedendum}
    else:
        known |= {"tolerances.grade": drawn.grade}
    for mate in drawn.mates:
        known |= dict(_flat(gearcad.data(mate.pair)["pair"], "pair.")) | {"mate.teeth": mate.gear.teeth}
    return known


def _read(text, mark):
    """The numbers of a text, and half of the last digit of each."""
    for found in NUMBER.findall(text):
        plain = found.replace("−", "-").replace(mark, ".")
        yield float(plain), 0.5 * 10.0 ** -len(plain.partition(".")[2])


@pytest.mark.parametrize("language", Language)
def test_every_number_is_that_of_the_data_rounded(language):
    """Each number that is shown is one of its row's, these are those of the documents, and each of them is shown."""
    checked = 0
    for drawn in DRAWN:
        known = _known(drawn)
        for row in gear_rows(drawn, WORDS[language]):
            for key, value in row.numbers.items():
                if key not in ("corner_radius", "flank_roughness_of_grade"):  # checked below
                    assert known[key] == value, (row.key, key)
            shown = row.text.removesuffix(" × 45°") if row.key == "tip_chamfer" else row.text
            shown = shown.partition(" / GC")[0]
            if row.key in ("basic_rack", "tooth_allowance", "tolerances") or shown.startswith("—"):
                shown = ""
            words = row.words if row.key.startswith("span") else ""
            found = [each for text in (shown, *(row.limits or ()), words) for each in _read(text, language.decimal_mark)]
            values = [
                abs(value) / (1000 if key.endswith("centre_distance_allowance") else 1) for key, value in row.numbers.items()
            ]
            for value, half in found:
                assert any(abs(abs(value) - each) <= half * 1.000001 for each in values), (row.key, row.text, values)
            for each in values:
                assert any(abs(abs(value) - each) <= half * 1.000001 for value, half in found), (row.key, row.text, each)
            checked += len(values)
    assert checked > 230


def test_signs_stand_where_they_matter():
    """Teeth of rings, profile shifts, allowances and twist have theirs; diameters of rings are as one measures them."""
    rows = {row.key: row for row in gear_rows(DRAWN[3], WORDS[Language.ENGLISH])}
    assert rows["teeth"].text == "−70" and rows["reference_diameter"].text == "140.000"
    assert rows["profile_shift_of_ring"].text == "+0.2000" and rows["centre_distance"].text == "47.586"
    assert rows["tooth_allowance"].limits == ("−80 µm", "−160 µm")
    german = {row.key: row.text for row in gear_rows(DRAWN[0], WORDS[Language.GERMAN])}
    assert (german["twist"], german["tip_relief"]) == ("−4 µm", "12,5 µm / 3,25 mm")
    assert german["end_relief"] == "15 µm / 2 mm, parabolisch"


def test_gauges_are_those_of_the_kind_of_gear():
    def keys(place):
        return {row.key for row in gear_rows(DRAWN[place], WORDS[Language.SWEDISH])}

    assert {"span_teeth", "over_balls", "over_pins"} <= keys(0) and "over_pins" not in keys(2)
    assert {"span_spaces", "between_balls"} <= keys(3) and not {"span_teeth", "over_balls"} & keys(3)
    even = {row.key: row.words for row in gear_rows(DRAWN[2], WORDS[Language.ENGLISH])}
    assert even["over_balls"] == "Size over balls or pins"
    assert "over_pin" in keys(5) and not {"over_balls", "profile_shift"} & keys(5)
    assert "span_spaces" not in keys(9) and "between_balls" in keys(9)  # a helical ring


def test_limits_are_those_of_gears_as_thick_and_as_thin_as_permitted():
    gear = DRAWN[0].gear
    rows = {row.key: row for row in gear_rows(DRAWN[0], WORDS[Language.ENGLISH])}
    for limit, allowance in enumerate((gear.thickness_allowance.upper, gear.thickness_allowance.lower)):
        other = replace(gear, tooth_allowance=None, tooth_thinning=-allowance / 1e3)
        assert rows["span_teeth"].limits[limit] == f"{other.inspection.span_measurement(gear.span_teeth):.3f}"
        assert rows["over_balls"].limits[limit] == f"{other.inspection.over_balls(gear.ball_diameter):.3f}"


def test_a_planet_has_two_mates_and_one_centre_distance():
    spur = {"normal_module": 2, "face_width": 20}
    sun, planet, ring = (Gear(teeth=teeth, **spur) for teeth in (24, 21, -66))
    inner, outer = GearPair(pinion=planet, wheel=sun), GearPair(pinion=planet, wheel=ring, centre_distance=-45)
    mates = (Mate(name="sun", gear=sun, pair=inner), Mate(name="ring", gear=ring, pair=outer))
    rows = gear_rows(DrawnGear(role="planet", gear=planet, mates=mates), WORDS[Language.ENGLISH])
    found = [(row.key, row.text, dict(row.numbers)) for row in rows if row.key.startswith(("sun.", "ring."))]
    assert found == [
        ("sun.centre_distance", "45.000", {"sun.pair.centre_distance": inner.centre_distance}),
        ("sun.mate", "24 / Sun gear", {"sun.mate.teeth": 24}),
        ("ring.mate", "−66 / Ring gear", {"ring.mate.teeth": -66}),
    ]
    assert len({row.key for row in rows}) == len(rows)


def test_what_has_no_number_says_why():
    """Beyond ISO 1328 the limit that is passed, and where a gauge does not fit its reason: nothing is left out silently."""
    rows = {row.key: row for row in gear_rows(DRAWN[7], WORDS[Language.ENGLISH])}
    assert rows["helix_total"].text == "— (face width below 4 mm)" and not rows["helix_total"].numbers
    assert rows["single_pitch"].text == "30 µm" and rows["span_teeth"].text == "— (face too narrow)"
    tiny = gear_rows(DRAWN[8], WORDS[Language.GERMAN])
    assert [row.text for row in tiny if row.key == "runout"] == ["— (Teilkreisdurchmesser unter 5 mm)"]
    steep = DrawnGear(
        role="gear", gear=Gear(teeth=20, normal_module=2, face_width=20, helix_angle=50), accuracy=Accuracy.ISO_2013, grade=6
    )
    said = {row.key: row.text for row in gear_rows(steep, WORDS[Language.ENGLISH])}
    assert said["single_pitch"] == "— (helix angle above 45°)"
    assert "tolerances" in {row.key for row in gear_rows(DRAWN[5], WORDS[Language.ENGLISH])}


def test_what_is_assumed_is_said():
    unknown = DRAWN[8]
    codes = {notice.code for notice in gear_notices(unknown)}
    assert codes == {"grade-assumed", "not-covered", "no-thickness-limits", "roughness-of-grade", "no-material"}
    rows = {row.key: row for row in gear_rows(unknown, WORDS[Language.ENGLISH])}
    assert (rows["accuracy"].words, rows["accuracy"].text) == ("Accuracy grade, ISO 1328-1:1995", "6 (assumed)")
    assert rows["flank_roughness"].text == "Ra 0.8 µm"
    assert {notice.code for notice in gear_notices(DRAWN[0], DrawingOptions(material="16MnCr5"))} == set()
    assert "accuracy" not in {row.key for row in gear_rows(DRAWN[5], WORDS[Language.ENGLISH])}
    assert "rack-tolerances" in {notice.code for notice in gear_notices(DRAWN[5])}


def test_racks_have_the_names_of_iso_53_only_where_they_are_those():
    texts = {row.key: row.text for row in gear_rows(DRAWN[6], WORDS[Language.ENGLISH])}
    assert texts["basic_rack"] == "ISO 53 D"
    own = {row.symbol: row.text for row in gear_rows(DRAWN[2], WORDS[Language.ENGLISH]) if row.symbol in OWN}
    assert own == {"h_aP*": "1", "h_fP*": "1.3", "ρ_fP*": f"{BasicRack(dedendum=1.3).full_root_radius():.4f} (full radius)"}
    # A given root circle is none of the rack's: (|d_f| - |d|)/2 m_n + x.
    given = {row.symbol: row.text for row in gear_rows(DRAWN[9], WORDS[Language.ENGLISH])}
    assert float(given["h_fP*"]) == pytest.approx((189.2 - 180 / np.cos(np.radians(12))) / 4, abs=1e-6)


def test_the_root_of_a_shaped_ring_is_the_corner_of_its_tool():
    corner = next(row for row in gear_rows(DRAWN[3], WORDS[Language.ENGLISH]) if row.key == "corner_radius")
    assert corner.text == "0.760"  # 0.38 m_n


@pytest.mark.parametrize("language", Language)
def test_materials_are_named_in_every_language(language):
    words, gear = WORDS[language], Gear(teeth=20, normal_module=2, face_width=10)
    said = set()
    for group in set(MaterialGroup) - {MaterialGroup.PLASTIC}:  # which has no heat treatment
        drawn = DrawnGear(role="gear", gear=gear, material=Material(name="X", group=group, hardness=250))
        rows = {row.key: row.text for row in gear_rows(drawn, words, DrawingOptions(case_depth="0.6"))}
        assert rows["material"] == "X" and re.fullmatch(r".+, 250 (HV|HBW), CHD 0.6", rows["heat_treatment"])
        said.add(rows["heat_treatment"])
    assert len(said) >= len(MaterialGroup) - 3  # wrought and carbon steels, cast or not, are treated alike


def test_a_plastic_is_called_by_its_name_or_its_group_and_has_no_treatment():
    gear = Gear(teeth=20, normal_module=2, face_width=10)
    for name, said in ({"name": "POM"}, "POM"), ({}, "Kunststoff"):
        plastic = Material(group=MaterialGroup.PLASTIC, youngs_modulus=3000.0, **name)
        rows = {
            row.key: row.text for row in gear_rows(DrawnGear(role="gear", gear=gear, material=plastic), WORDS[Language.GERMAN])
        }
        assert rows["material"] == said and "heat_treatment" not in rows


def test_names_that_nobody_gave_are_words_and_small_modules_are_said_in_them():
    rows = {row.key: row.text for row in gear_rows(replace(DRAWN[1], material=Material()), WORDS[Language.SWEDISH])}
    assert (rows["mate"], rows["material"]) == ("17 / Pinjong", "stål (antagen)")
    small = DrawnGear(role="gear", gear=Gear(teeth=40, normal_module=0.3, face_width=5))
    said = {row.key: row.text for row in gear_rows(small, WORDS[Language.SWEDISH])}
    assert said["single_pitch"] == "— (normalmodul under 0,5 mm)"


def _drift(points, radius, count, inner, outer):
    """How far teeth turn (of a pitch, counter-clockwise) from one height to the other, by the points on their tips."""
    on_tip = points[np.abs(np.hypot(points[:, 0], points[:, 1]) - radius) < 1e-6 * radius]
    turns = [
        np.angle(np.sum(((p := on_tip[np.abs(on_tip[:, 2] - z) < 1e-9])[:, 0] + 1j * p[:, 1]) ** count / radius**count))
        for z in (inner, outer)
    ]
    return ((turns[1] - turns[0]) / (2 * np.pi) + 0.5) % 1 - 0.5


@pytest.mark.parametrize("teeth", [21, -40])
@pytest.mark.parametrize(("angle", "hand", "way"), [(12.0, "right", 1), (-12.0, "left", -1)])
def test_hands_are_those_of_the_solids(teeth, angle, hand, way):
    """A right-hand screw turns counter-clockwise towards +z, seen from there."""
    body = Body(rim_diameter=100 if teeth < 0 else None)
    gear = Gear(teeth=teeth, normal_module=2, face_width=6, helix_angle=angle, body=body)
    rows = {row.key: row.text for row in gear_rows(DrawnGear(role="gear", gear=gear), WORDS[Language.ENGLISH])}
    points = tessellate(gear, 0.05).vertices
    turned = _drift(points, abs(gear.tip_diameter) / 2, abs(teeth), 0.0, 6.0)
    assert rows["hand"] == hand
    assert turned == pytest.approx(way * 6 * np.tan(np.radians(12)) / gear.transverse_pitch, rel=1e-3)


@pytest.mark.parametrize("side", HubSide)
@pytest.mark.parametrize(("angle", "offset"), [(12.0, 0.2), (-12.0, -0.3)])
def test_hands_and_offset_of_two_halves_are_those_of_the_solid_as_it_is_drawn(side, angle, offset):
    """The half that is at the left in the section comes first, and is turned on as one sees from its end."""
    halves, body = DoubleHelix(gap_width=4, offset=offset), Body(bore=10, hub_diameter=20, hub_length=3, hub_side=side)
    gear = Gear(teeth=21, normal_module=2, face_width=16, helix_angle=angle, double_helix=halves, body=body)
    drawn = DrawnGear(role="gear", gear=gear)
    rows = {row.key: row.text for row in gear_rows(drawn, WORDS[Language.ENGLISH])}
    view = section_view(drawn, Requirements.of(drawn, DrawingOptions()), Draughting(WORDS[Language.ENGLISH]))
    lines = [each.points for each in view.figure.shapes if isinstance(each, Polyline) and each.pen is Pen.THIN]
    falling = [(end < start) == (x < right) for (x, start), (right, end) in sorted(lines)[::3]]  # right hand (ISO 2203)
    assert rows["hand_of_halves"] == " / ".join("right" if each else "left" for each in falling)
    points, radius, to_right = tessellate(gear, 0.05).vertices, gear.tip_diameter / 2, 1 if side is HubSide.BACK else -1
    drifts = [_drift(points, radius, 21, low, low + 6) for low in (0.0, 10.0)][::to_right]
    assert rows["hand_of_halves"] == " / ".join("right" if each > 0.1 else "left" for each in drifts)
    left, right = (6.0, 10.0)[::to_right]
    ahead = -to_right * _drift(points, radius, 21, right, left)  # from the left one looks along z, or against it
    assert ahead == pytest.approx(offset, abs=1e-6) and float(rows["half_offset"].replace("−", "-")) == pytest.approx(ahead)


def test_hands_of_racks_are_those_of_the_solids():
    """Right-hand teeth on +y go to -x as they rise."""
    rack = Rack(teeth=6, normal_module=2, face_width=6, height=10, helix_angle=12)
    drawn = DrawnGear(role="rack", gear=rack)
    assert {row.key: row.text for row in gear_rows(drawn, WORDS[Language.ENGLISH])}["hand"] == "right"
    tips = tessellate_rack(rack).vertices
    tips = tips[np.abs(tips[:, 1] - rack.tip_height) < 1e-9]
    inside = [np.sort(tips[(np.abs(tips[:, 2] - z) < 1e-9) & (tips[:, 0] > 8) & (tips[:, 0] < 30), 0]) for z in (0.0, 6.0)]
    gaps = inside[1][:, None] - inside[0][None, :]
    assert gaps.flat[np.abs(gaps + 6 * np.tan(np.radians(12))).argmin()] == pytest.approx(-6 * np.tan(np.radians(12)), abs=1e-6)

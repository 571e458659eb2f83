"""What sheets demand: sizes with the limits of their fits, keyways, chamfers; run-out and roughness by the accuracy grade."""

from dataclasses import fields, replace

import pytest

from gearcad import Body, DoubleHelix, Gear, Material, Rack
from gearcad.core.errors import ParameterError
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.requirements import Requirements, hole_position
from gearcad.drawing.words import Language, SheetWords, Size
from gearcad.geometry import HubSide

USUAL = DrawingOptions()
HUB = {"hub_diameter": 60, "hub_length": 8, "hub_side": HubSide.BOTH}
BODY = Body(bore=40, keyway=True, end_chamfer=1.5, end_chamfer_angle=22.5, tip_chamfer=0.3, **HUB)
GEAR = Gear(teeth=41, normal_module=3, face_width=30, body=BODY)


def _of(gear, options=USUAL, **drawn):
    return Requirements.of(DrawnGear(role="gear", gear=gear, **drawn), options)


def _limits(size):
    return None if size.upper is None else (round(size.upper * 1000, 6), round(size.lower * 1000, 6))


def test_sizes_of_a_gear_with_hub_and_keyway():
    """Limits by hand from ISO 286-2 and DIN 6885-1."""
    found = _of(GEAR)
    said = {each.name: getattr(found, each.name) for each in fields(found) if isinstance(getattr(found, each.name), Size)}
    assert {name: (size.prefix, size.value, size.suffix, size.fit, _limits(size)) for name, size in said.items()} == {
        "face_width": ("", 30, "", "h11", (0, -130)),
        "tip": ("⌀", 129, "", "h9", (0, -100)),
        "bore": ("⌀", 40, "", "H7", (25, 0)),
        "keyway_width": ("", 12, "", "JS9", (21.5, -21.5)),
        "keyway_depth": ("", 43.3, "", "", (200, 0)),
        "hub_diameter": ("⌀", 60, "", "", None),
        "hub_width": ("", 46, "", "", None),
        "end_chamfer": ("2× ", 1.5, "×22.5°", "", None),
        "tip_chamfer": ("", 0.3, "×45°", "", None),
    }
    assert found.bore.envelope and not found.tip.envelope
    assert _of(GEAR, DrawingOptions(language=Language.GERMAN)).end_chamfer.suffix == "×22,5°"


def test_fits_are_those_that_one_asks_for():
    tight = DrawingOptions(bore_tolerance="K7", tip_tolerance="", keyway_tolerance="P9", face_width_tolerance="js9")
    found = _of(GEAR, tight)
    assert _limits(found.bore) == (7, -18) and _limits(found.keyway_width) == (-18, -61)
    assert found.tip == Size(value=129.0, prefix="⌀") and _limits(found.face_width) == (26, -26)
    assert not _of(GEAR, DrawingOptions(bore_tolerance="")).bore.envelope


def test_tips_of_external_gears_are_shafts_and_those_of_rings_holes():
    with pytest.raises(ParameterError, match=r"tip_tolerance = 'H9': must be the class of a shaft"):
        _of(GEAR, DrawingOptions(tip_tolerance="H9"))
    ring = Gear(teeth=-70, normal_module=2, face_width=20)
    assert [_of(ring, DrawingOptions(tip_tolerance=given)).tip.fit for given in ("h8", "H8")] == ["H8", "H8"]


def test_a_ring_has_a_hole_for_its_tips_and_a_rim():
    body = Body(rim_diameter=170, bolt_circle=158, bolt_holes=8, bolt_diameter=6)
    found = _of(Gear(teeth=-70, normal_module=2, face_width=20, body=body))
    assert (found.tip.fit, _limits(found.tip), found.tip.value) == ("H9", (100, 0), 136)
    assert (found.rim.fit, _limits(found.rim)) == ("h7", (0, -40))
    assert (found.bolts.prefix, found.bolts.value, found.bolt_circle.value) == ("8×⌀", 6, 158)
    assert found.bore is None and found.cylindricity == 10  # a quarter of IT7


def test_racks_and_halves():
    rack = _of(Rack(teeth=10, normal_module=3, face_width=30, height=25))
    assert (rack.height.value, rack.reference_height.value, rack.tip, rack.tip_runout) == (28, 25, None, None)
    assert rack.length.value == pytest.approx(94.2477796) and rack.notices == ()
    double = _of(Gear(teeth=23, normal_module=4, face_width=100, helix_angle=28, double_helix=DoubleHelix(gap_width=20)))
    assert double.gap_width.value == 20 and double.gap_diameter.value == double.drawn.gear.gap_diameter
    apex = _of(Gear(teeth=23, normal_module=4, face_width=100, helix_angle=28, double_helix=DoubleHelix(gap_width=0)))
    assert apex.gap_width is None


@pytest.mark.parametrize(
    ("width", "bore", "more"), [(6.0, 20.0, 0.1), (8.0, 20.0, 0.2), (36.0, 110.0, 0.3), (100.5, 120.0, None)]
)
def test_keyways_of_ones_own_have_the_allowance_of_their_width(width, bore, more):
    body = Body(bore=bore, keyway_width=width, keyway_depth=4)
    depth = _of(Gear(teeth=100, normal_module=2, face_width=20, body=body)).keyway_depth
    assert (depth.value, depth.upper) == (bore + 4, more)


def test_beyond_tables_a_class_stands_alone_or_general_tolerances_hold_and_both_are_said():
    large = Gear(teeth=300, normal_module=4, face_width=600, body=Body(bore=600))
    found = _of(large, DrawingOptions(bore_tolerance="K6"))
    assert (found.bore.fit, found.bore.upper) == ("K6", None) and _limits(found.tip) == (0, -260)
    assert [(each.code, each.text[:16]) for each in found.notices] == [("fit-without-limits", "bore: limits of ")]
    huge = _of(Gear(teeth=400, normal_module=10, face_width=100))
    assert huge.tip == Size(value=4020.0, prefix="⌀")
    assert [each.code for each in huge.notices] == ["beyond-fits", "no-datum"]


def test_run_out_is_half_of_that_of_the_teeth():
    """F_r by hand, of means 79.06 and 2.646 mm: 0.24 · 2.646 + √79.06 + 5.6 = 15.1 µm in grade 5, √2 times as much a grade."""
    assert [_of(GEAR, grade=grade).tip_runout for grade in (4, 5, 6, 7, 8)] == [5, 7, 10, 15, 21]
    given = _of(GEAR, DrawingOptions(tip_runout=20.0, face_runout=15.0))
    assert (given.tip_runout, given.face_runout) == (20, 15)
    assert _of(replace(GEAR, body=Body())).tip_runout is None
    small = Gear(teeth=30, normal_module=0.3, face_width=5, body=Body(bore=3))
    assert _of(small).tip_runout is None and [each.code for each in _of(small).notices] == ["no-runout"]


def test_symmetry_position_and_parallelism_are_proposed_unless_they_are_given():
    """Half of 43 µm of 12 JS9; 3.5 % of 6.6 mm in steps; IT7 of 400 to 500 mm is 63 µm."""
    body = Body(rim_diameter=170, bolt_circle=158, bolt_holes=8, bolt_diameter=6.6)
    ring = Gear(teeth=-70, normal_module=2, face_width=20, body=body)
    rack = Rack(length=450, normal_module=3, face_width=30, height=25)
    own = DrawingOptions(keyway_symmetry=9, bolt_position=80, back_parallelism=7)
    for options, found in ((USUAL, (21, 200, 63, 31)), (own, (9, 80, 7, 3))):
        of_rack = _of(rack, options, grade=7)
        both = _of(GEAR, options).keyway_symmetry, _of(ring, options).bolt_position
        assert (*both, of_rack.back_parallelism, of_rack.back_flatness) == pytest.approx(found)
    assert _of(GEAR, DrawingOptions(keyway_tolerance="")).keyway_symmetry is None
    assert _of(ring).bolt_circle.exact and not _of(replace(ring, body=replace(body, rim_diameter=None))).bolt_circle.exact


@pytest.mark.parametrize(
    ("hole", "clearance"), [(3.4, 0.4), (5.5, 0.5), (9, 1), (13.5, 1.5), (17.5, 1.5), (26, 2), (39, 3), (70, 6)]
)
def test_two_parts_with_medium_holes_fit_wherever_those_are_permitted(hole, clearance):
    """Holes for bolts M3 to M64 of ISO 273: where the other part is tapped both tolerances share the clearance."""
    assert 0 < hole_position(hole) / 1000 <= clearance / 2


def test_roughness_goes_by_grade_unless_it_is_given():
    found = [_of(GEAR, grade=grade) for grade in range(3, 11)]
    assert [each.flanks.value for each in found] == [0.4, 0.4, 0.8, 0.8, 1.6, 3.2, 6.3, 6.3]
    assert [each.bore_roughness for each in found] == [0.8, 0.8, 0.8, 1.6, 1.6, 1.6, 1.6, 1.6]
    fine = _of(GEAR, DrawingOptions(bore_tolerance="H6"), grade=8)
    assert (fine.bore_roughness, fine.face_roughness) == (0.8, 1.6)
    given = _of(replace(GEAR, flank_roughness=4.0), DrawingOptions(bore_roughness=0.4, surface_roughness=6.3))
    assert (given.flanks.parameter, given.flanks.value, given.bore_roughness, given.rest_roughness) == ("Rz", 4, 0.4, 6.3)


@pytest.mark.parametrize("language", Language)
def test_what_is_ours_is_marked_and_treatment_is_said(language):
    words = SheetWords.of(language)
    hard = Material(name="Eh MQ", hardness=720)  # a quality of ISO 6336-5, which is no material
    found = _of(GEAR, replace(USUAL, case_depth="0.6"), material=hard)
    assert found.material(words) == words["data.steel"]
    assert _of(GEAR, USUAL, material=replace(hard, name="18CrNiMo7-6")).material(words) == "18CrNiMo7-6"
    assert found.heat_treatment(words) == f"{words['data.group_case_hardened']}, 720 HV, CHD 0.6"
    deep = _of(GEAR, replace(USUAL, case_depth="CHD 0.6"), material=hard)
    assert deep.heat_treatment(words) == found.heat_treatment(words)
    assert found.tooth_notes(words) == (words["data.note_by_grade"],)
    few = replace(GEAR, teeth=14, body=Body())
    assert few.undercut and words["data.note_undercut"] in _of(few).tooth_notes(words)
    given = DrawingOptions(
        tip_runout=20, face_runout=15, bore_roughness=0.8, keyway_symmetry=20, material="20MnCr5", heat_treatment="58+4 HRC"
    )
    told = _of(replace(GEAR, flank_roughness=4.0), given, material=hard)
    assert told.tooth_notes(words) == () and (told.material(words), told.heat_treatment(words)) == ("20MnCr5", "58+4 HRC")

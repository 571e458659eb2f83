"""[drawing] and the drawings of gears, and what sheets demand: fits, keyways, chamfers, run-out and roughness."""

import json
import re
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from gearcad import Body, DoubleHelix, Gear, Material, Rack
from gearcad.core.errors import ParameterError, SpecError
from gearcad.designs import read_spec
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.reader import design_from_tables, design_from_values, starter_text
from gearcad.designs.spec_writers import pair_text
from gearcad.designs.table import open_table
from gearcad.designs.variations import spec_values
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.options import DrawingOptions, PartDrawing, Projection, Revision, SheetSize
from gearcad.drawing.requirements import Requirements, hole_position
from gearcad.drawing.words import Language, SheetWords, Size
from gearcad.geometry import HubSide

_GEAR: dict[str, Any] = {"teeth": 20, "normal_module": 2.0, "face_width": 20.0}
_SET = {"planets": 3, "input": "S1", "output": "carrier", "fixed": "ring", "normal_module": 2.0, "face_width": 20.0}
_OWN = {"number": "P-1", "bore_tolerance": "H6"}

KINDS: dict[str, tuple[dict[str, Any], str]] = {
    "gear": ({"gear": {**_GEAR, "drawing": _OWN}}, "gear"),
    "pair": ({"pair": {}, "pinion": {**_GEAR, "drawing": _OWN}, "wheel": {**_GEAR, "teeth": 41}}, "pinion"),
    "rack": ({"rack": {**_GEAR, "height": 20.0, "drawing": _OWN}}, "rack"),
    "rack_pair": ({"pair": {}, "pinion": _GEAR, "rack": {**_GEAR, "height": 20.0, "drawing": _OWN}}, "rack"),
    "planetary": (
        {
            "planetary": _SET,
            "sun": {"teeth": 24, "name": "S1", "drawing": _OWN},
            "planet": {"teeth": 21},
            "ring": {"teeth": -66},
        },
        "S1",
    ),
}
"""Tables of each kind of design, and the name of the gear that has a drawing of its own."""


def _design(tables: dict[str, Any]) -> ToothedDesign:
    design = design_from_tables(tables, where=lambda key: f"<{key}>", default_name="some")
    assert isinstance(design, ToothedDesign)
    return design


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_reads_the_drawing_and_that_of_a_gear(kind: str) -> None:
    tables, gear = KINDS[kind]
    design = _design({**tables, "drawing": {"number": "4711", "sheet": "A2", "language": "sv", "notes": ["a", "b"]}})
    options = DrawingOptions(number="4711", sheet=SheetSize.A2, language=Language.SWEDISH, notes=("a", "b"))
    assert design.kind.value == kind
    assert (design.drawing, design.drawings) == (options, {gear: PartDrawing(**_OWN)})
    document = json.loads(json.dumps(design.to_dict()))
    assert (document["drawing"]["number"], document["drawings"]) == ("4711", {gear: _OWN})


@pytest.mark.parametrize("kind", KINDS)
def test_a_document_without_a_drawing_has_no_key_more(kind: str) -> None:
    tables, gear = KINDS[kind]
    table = "sun" if gear == "S1" else gear
    bare = {**tables, table: {key: value for key, value in tables[table].items() if key != "drawing"}}
    with_it, without = _design({**tables, "drawing": {"title": "x"}}).to_dict(), _design(bare).to_dict()
    assert with_it.keys() - without.keys() == {"drawing", "drawings"}
    assert {key: with_it[key] for key in without} == without


def test_a_part_has_what_the_drawing_has_but_for_its_own_and_for_what_names_the_assembly() -> None:
    options = DrawingOptions(number="1", title="Drive", revision="B", owner="me", material="steel", bore_tolerance="H8")
    part = PartDrawing(number="2", bore_tolerance="H6")
    found = options.of_part(part, alone=False)
    assert (found.number, found.title, found.revision, found.owner) == ("2", "", "", "me")
    assert (found.material, found.bore_tolerance) == ("steel", "H6")
    assert options.of_part(None, alone=True) == options
    assert options.of_part(None, alone=False).number == ""
    assert options.of_part(part, alone=True).title == "Drive"


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"sheet": "A7"}, "drawing.sheet = 'A7': must be one of 'auto', 'A4', 'A3', 'A2', 'A1', 'A0'"),
    ({"scale": "3:7"}, "drawing.scale = '3:7': must be \"auto\" or a scale of ISO 5455: "),
    ({"language": "fr"}, "drawing.language = 'fr': must be one of 'en', 'de', 'sv'"),
    ({"projection": "second"}, "drawing.projection = 'second': must be one of 'first', 'third'"),
    ({"bore_tolerance": "Z99"}, "drawing.bore_tolerance = 'Z99': must be a letter ("),
    ({"bore_tolerance": "p6"}, "drawing.bore_tolerance = 'p6': must be the class of a hole, in capitals, such as \"P6\""),
    ({"keyway_tolerance": "js9"}, "drawing.keyway_tolerance = 'js9': must be the class of a hole"),
    ({"face_width_tolerance": "H11"}, "drawing.face_width_tolerance = 'H11': must be the class of a shaft, in small letters"),
    ({"rim_tolerance": "K7"}, "drawing.rim_tolerance = 'K7': must be the class of a shaft, in small letters, such as \"k7\""),
    ({"title": 7}, "drawing.title = 7: must be a text"),
    ({"title": "a\x07"}, "drawing.title = 'a\\x07': must be a text without hidden or control characters; U+0007 is one"),
    ({"owner": "a\u202eb"}, "drawing.owner = 'a\\u202eb': must be a text without hidden or control characters; U+202E is one"),
    ({"owner": "a\u200bb"}, "drawing.owner = 'a\\u200bb': must be a text without hidden or control characters; U+200B is one"),
    ({"owner": "a\u2060b"}, "drawing.owner = 'a\\u2060b': must be a text without hidden or control characters; U+2060 is one"),
    ({"owner": "a\u00adb"}, "drawing.owner = 'a\\xadb': must be a text without hidden or control characters; U+00AD is one"),
    ({"title": "a" * 2001}, "must be a text of at most 2000 characters, not 2001"),
    ({"notes": 3}, "drawing.notes = 3: must be a list of texts"),
    ({"notes": [3]}, "drawing.notes = 3: must be a text"),
    ({"revisions": ["A"]}, "drawing.revisions = 'A': must be a list of lists of index, text, date and name"),
    ({"date": "31.1.2026"}, "drawing.date = '31.1.2026': must be a date as year-month-day"),
    ({"date": "2026-02-30"}, "drawing.date = '2026-02-30': must be a date as year-month-day"),
    ({"surface_roughness": -1.0}, "drawing.surface_roughness = -1 µm: must be a number at least 0.005 µm"),
    ({"titel": "x"}, "drawing.titel: unknown key; did you mean title?"),
]


@pytest.mark.parametrize(("values", "message"), WRONG)
def test_what_is_wrong_is_one_line(values: dict[str, Any], message: str) -> None:
    with pytest.raises(SpecError) as caught:
        _design({"gear": _GEAR, "drawing": values})
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_the_drawing_of_a_gear_is_checked_alike() -> None:
    for values, message in (
        ({"tip_tolerance": "h99"}, "<pinion.drawing.tip_tolerance>: pinion.drawing.tip_tolerance = 'h99': must be"),
        ({"sheat": "A3"}, "pinion.drawing.sheat: unknown key; did you mean drawing.sheet?"),
        ({"owner": "me"}, "pinion.drawing.owner: unknown key"),
    ):
        with pytest.raises(SpecError) as caught:
            _design({"pair": {}, "pinion": {**_GEAR, "drawing": values}, "wheel": _GEAR})
        assert message in str(caught.value) and "\n" not in str(caught.value)


def test_texts_become_one_line_and_lists_are_read_from_one_text_too() -> None:
    options = DrawingOptions(
        title=" Gear\n\tof  teeth ", notes="one | two\nthree", revisions="A; first; 2026-01-31; MB | B; wider"
    )
    assert options.title == "Gear of teeth" and options.notes == ("one", "two", "three")
    assert options.changes == (Revision("A", "first", "2026-01-31", "MB"), Revision("B", "wider"))
    assert (options.index, options.factor, DrawingOptions(scale="1:5").factor) == ("B", None, 0.2)
    assert DrawingOptions(revision="C", revisions=(("A", "x"),)).index == "C"
    for text in ("Ω δοκός", "Шестерня", "歯車", "ترس مسنن", "⚙️ 👩‍🔧", "<img src=x onerror=alert(1)>", "%%c \\P {x}"):
        assert DrawingOptions(title=text).title == text


def test_the_date_is_that_of_the_files_unless_it_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert DrawingOptions().issued == "2023-11-14"
    assert DrawingOptions(date="2026-01-31").issued == "2026-01-31"


def test_a_table_has_columns_of_drawings(tmp_path: Path) -> None:
    table = tmp_path / "t.csv"
    heading = "name,pinion.teeth,wheel.teeth,normal_module,face_width"
    heading += ",drawing.number,pinion.drawing.number,drawing.notes,drawing.template"
    table.write_text(f"{heading}\na,20,41,2,20,4711,007,one | two,company.toml\nb,20,41,2,20,,,,\n", encoding="utf-8")
    first, second = (row.design() for row in open_table(table).rows())
    assert isinstance(first, ToothedDesign) and isinstance(second, ToothedDesign)
    template = str(tmp_path / "company.toml")
    assert first.drawing == DrawingOptions(number="4711", notes=("one", "two"), template=template)
    assert first.drawings == {"pinion": PartDrawing(number="007")} and (second.drawing, second.drawings) == (None, {})
    table.write_text("name,teeth,normal_module,face_width,drawing.sheet,gear.drawing.rim_tolerance\na,20,2,20,A7,Z9\n", "utf-8")
    faults = next(iter(open_table(table).rows())).all_faults()
    assert [fault.partition(" (a): ")[2].partition(" = ")[0] for fault in faults] == [
        "drawing.sheet",
        "gear.drawing.rim_tolerance",
    ]


_SPEC = """
[pair]
normal_module = 2.0
face_width = 20.0
[pinion]
teeth = 20
drawing.revisions = [["A", "first issue", 2026-01-31, "MB"], ["B", "wider"]]
[wheel]
teeth = 41
[drawing]
date = 2026-01-31
notes = ["one", "two, and three"]
template = "company.toml"
projection = "third"
"""


def test_a_spec_comes_back_from_cells_and_from_the_spec_of_its_pair(tmp_path: Path) -> None:
    path = tmp_path / "some.toml"
    path.write_text(_SPEC, encoding="utf-8")
    design = read_spec(path)
    assert isinstance(design, PairDesign) and design.drawing is not None
    assert design.drawing.date == "2026-01-31" and design.drawing.projection is Projection.THIRD
    assert design.drawing.template == str(tmp_path / "company.toml")
    assert design.to_dict()["drawing"]["template"] == "company.toml"
    kind, name, values = spec_values(path)
    assert values["pinion.drawing.revisions"] == "A; first issue; 2026-01-31; MB | B; wider"
    again = design_from_values(values, kind, where=str, default_name=name)
    assert again == design
    path.write_text(pair_text(design), encoding="utf-8")
    assert read_spec(path) == design
    path.write_text(_SPEC.replace("two, and three", "two | three"), encoding="utf-8")
    with pytest.raises(
        SpecError, match=r"line 12: drawing.notes = 'two \| three': cannot stand in a table: has \| or a new line"
    ):
        spec_values(path)


def test_python_gives_lists_and_words() -> None:
    assert PartDrawing(revisions=[["A", "x"]]).revisions == (("A", "x"),)  # type: ignore[arg-type]
    assert DrawingOptions(language="de").language is Language.GERMAN  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"^case_depth = 0.8: must be a text, in quotation marks"):
        PartDrawing(case_depth=0.8)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["spur", "volvo-13-44", "planetary-24-21-66"])
def test_what_starters_have_in_comments_of_drawings_can_be_used(name: str, tmp_path: Path) -> None:
    _, text = starter_text(name)
    head, found, options = text.partition("# [drawing]")
    spec = tmp_path / f"{name}.toml"
    spec.write_text(head + (found + options).replace("\n# ", "\n").removeprefix("# "), encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, ToothedDesign) and design.drawing is not None and design.drawing.number.startswith("471")
    if name == "spur":  # it shows all there is
        assert all(re.search(rf"\b{field.name}\b", options) for field in fields(DrawingOptions) if field.name != "revision")
    else:
        assert design.drawings and all(each.number for each in design.drawings.values())


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

"""Faults of the rows of a design table: all of them, each a line that names row, column, key, value and what is permitted."""

import csv
import io
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.sheets import ERROR, faults_of, rows_of

from gearcad import SpecError


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


WRONG = """# Rows that are wrong, each in its own way
name,normal_module,helix_angle,centre_distance,pinion.teeth,wheel.teeth,pinion.profile_shift,face_width,pinion.rack,rack.root_radius,pinion.body.bore,load.torque
good,2.5,28,,13,44,0.1,18,,,10,220
half a tooth,2.5,28,,13.5,44,0.1,18,,,10,220
negative width,2.5,28,,13,44,0.1,-3,,,10,220
steep,2.5,95,,13,44,0.1,18,,,10,220
toothless,2.5,28,,13,,0.1,18,,,10,220
without module,,28,,13,44,0.1,18,,,10,220
words,2.5,28,,13,44,some,18,,,10,220
rack,2.5,28,,13,44,0.1,18,ISO53_E,,10,220
near,2.5,28,74,13,44,auto,18,,,10,220
overlap,2.5,28,79,13,44,0.1,18,,,10,220
round,2.5,28,,13,44,0.1,18,,0.6,10,220
pointed,2.5,28,,13,44,1.9,18,,,10,220
bore,2.5,28,,13,44,0.1,18,,,35,220
../above,2.5,28,,13,44,0.1,18,,,10,220
,2.5,28,,13,44,0.1,18,,,10,220
reference,2.5,28,,13,44,0.1,#REF!,,,10,220
comma,"2,5",28,,13,44,0.1,18,,,10,220
moved,2,5,28,,13,44,0.1,18,,,10,220
unloaded,2.5,28,,13,44,0.1,18,,,10,heavy
"two
lines",2.5,28,,13,44,0.1,18,,,10,220
"""

PLAIN = "must be a plain file name"
FAULTS = [
    "row 4 column E (half a tooth): pinion.teeth = 13.5: must be a whole number from 3 to 2000",
    "row 5 column H (negative width): pair.face_width = -3 mm: must be a number above 0 mm and at most 10000 mm",
    "row 6 column C (steep): pair.helix_angle = 95 deg: must be a number at least -75 deg and at most 75 deg",
    "row 7 column F (toothless): wheel.teeth is missing: must be a whole number from 3 to 2000",
    "row 8 column B (without module): pinion.normal_module is missing: must be a number at least 0.01 mm and at most 200 mm,"
    " or give normal_diametral_pitch instead"
    " (here or in [pair])",
    "row 9 column G (words): pinion.profile_shift = 'some': must be a number at least -5 and at most 5, or \"auto\"",
    "row 10 column I (rack): pinion.rack = 'ISO53_E': must be one of 'ISO53_A', 'ISO53_B', 'ISO53_C', 'ISO53_D',"
    " or be described by rack.addendum, rack.dedendum ...",
    "row 11 column D (near): pair.centre_distance = 74 mm: must be above 74.6055 mm, where the base circles touch",
    "row 12 column D (overlap): pair.centre_distance = 79 mm: must be at least 80.9433975 mm for these profile shifts and"
    " thinning, or the shift sum at most -0.633400: the backlash would be -1.479853 mm",
    "row 13 column J (round): pair.rack.root_radius = 0.6: must be at most 0.4719 (full radius) for dedendum 1.25,"
    " pressure angle 20 deg, no thinning",
    "row 14 (pointed): pinion.tip_diameter = 50.18830435 mm (derived): must be at most 49.7296 mm (pointed tooth)",
    "row 15 column K (bore): pinion.body.bore = 35 mm: must be at most 30.5585 mm (a rim of 0.1 m_n inside the root circle"
    " 31.0585 mm)",
    f"row 16 column A (../above): name = '../above': {PLAIN}, without / \\ < > : \" | ? * and control characters",
    f"row 17 column A: name = '': {PLAIN}: a text that is not empty",
    f"row 18 column H (reference): pair.face_width = '#REF!': {ERROR}",
    "row 19 column B (comma): pair.normal_module = '2,5': must have a decimal point: write 2.5"
    " (a decimal comma needs semicolons between the cells)",
    "row 20 column M (moved): '220': has no heading above it; a decimal comma needs semicolons between the cells",
    "row 21 column L (unloaded): load.torque = 'heavy': must be a number, 0 or from 1e-09 to 1e+09 N·m in size",
    f"row 22 column A (two\\nlines): name = 'two\\nlines': {PLAIN}, without / \\ < > : \" | ? * and control characters",
]


def test_twenty_kinds_of_wrong_rows_give_as_many_clear_messages() -> None:
    assert faults_of(WRONG, "pairs.csv") == [f"pairs.csv {fault}" for fault in FAULTS]


def test_a_row_of_the_table_raises_its_first_fault() -> None:
    good, *wrong = rows_of(WRONG, "pairs.csv")
    assert good.design().name == "good"
    for row, fault in zip(wrong, FAULTS, strict=True):
        with pytest.raises(SpecError) as caught:
            row.design()
        assert str(caught.value) == f"pairs.csv {fault}"


def test_all_single_faults_of_a_row_are_told_from_left_to_right() -> None:
    """What is missing on both gears is missed once; what does not fit is not told, for it may come from the rest."""
    heading, _ = WRONG.split("\ngood,")
    content = heading + "\na/b,,99,10,2,,9,0,ISO,#N/A,-1,full\n"
    assert [fault.partition(": ")[2] for fault in faults_of(content)] == [
        f"name = 'a/b': {PLAIN}, without / \\ < > : \" | ? * and control characters",
        "pinion.normal_module is missing: must be a number at least 0.01 mm and at most 200 mm,"
        " or give normal_diametral_pitch instead (here or in [pair])",
        "pair.helix_angle = 99 deg: must be a number at least -75 deg and at most 75 deg",
        "pinion.teeth = 2: must be a whole number from 3 to 2000",
        "wheel.teeth is missing: must be a whole number from 3 to 2000",
        'pinion.profile_shift = 9: must be a number at least -5 and at most 5, or "auto"',
        "pair.face_width = 0 mm: must be a number above 0 mm and at most 10000 mm",
        "pinion.rack = 'ISO': must be one of 'ISO53_A', 'ISO53_B', 'ISO53_C', 'ISO53_D', or be described by rack.addendum,"
        " rack.dedendum ...",
        f"pair.rack.root_radius = '#N/A': {ERROR}",
        "pinion.body.bore = -1 mm: must be a number at least 0 mm",
        "load.torque = 'full': must be a number, 0 or from 1e-09 to 1e+09 N·m in size",
    ]


def test_single_faults_behind_a_combination_that_fails_are_told_too() -> None:
    content = "name,teeth,normal_module,face_width,body.keyway_width\na,20,2,-1,6\n"
    assert faults_of(content) == [
        "t.csv row 2 (a): gear.body.keyway_depth = 0 mm (by default): must be above 0 mm, as keyway_width is given",
        "t.csv row 2 column D (a): gear.face_width = -1 mm: must be a number above 0 mm and at most 10000 mm",
    ]
    content = "name,teeth,normal_module,face_width,load.speed\na,20,2,-1,3\n"
    assert faults_of(content) == [
        "t.csv row 2 (a): load.torque is missing: must be a number, 0 or from 1e-09 to 1e+09 N·m in size",
        "t.csv row 2 column D (a): gear.face_width = -1 mm: must be a number above 0 mm and at most 10000 mm",
    ]
    content = "name,teeth,normal_module,face_width,body.bore,body.keyway_width,body.keyway_depth\na,20,2,-1,6,9,1\n"
    assert faults_of(content) == [
        "t.csv row 2 column D (a): gear.face_width = -1 mm: must be a number above 0 mm and at most 10000 mm",
        "t.csv row 2 column F (a): gear.body.keyway_width = 9 mm: must be at most 5.4 mm (0.9 of the bore)",
    ]


VALUES = st.sampled_from(["", "0", "-1", "1", "20", "2.5", "1e9", "auto", "full", "#N/A", "1,5", "ISO53_C", "x"])


@settings(max_examples=80, deadline=None)
@given(cells=st.lists(VALUES, min_size=13, max_size=13))
def test_a_row_has_no_faults_exactly_if_it_makes_a_design(cells: list[str]) -> None:
    heading = WRONG.split("\n")[1] + ",pinion.body.keyway_width,wheel.tip_diameter"
    buffer = io.StringIO()
    csv.writer(buffer).writerow(["a", *cells])
    [row] = rows_of(f"{heading}\n{buffer.getvalue()}")
    faults = row.all_faults()
    assert len(set(faults)) == len(faults)
    assert all(fault.startswith("t.csv row 2 ") and fault.isprintable() for fault in faults)
    if faults:
        with pytest.raises(SpecError) as caught:
            row.design()
        assert str(caught.value) in faults
    else:
        assert row.design().name == "a"

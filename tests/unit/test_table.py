"""Design tables: keys of columns, values of cells, designs of rows, and the faults of all rows with their place."""

import csv
import io
import pickle
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.batches import ERROR, SHEET_GEARS, faults_of, refusal_of, sheet_rows_of, values_of
from support.specs import TEMPLATES

from gearcad import SpecError
from gearcad.core.shelf_tables import column_letter
from gearcad.designs import design_from_tables, open_table, read_spec
from gearcad.designs.design import require_plain_name
from gearcad.designs.train_keys import COLUMNS

pytestmark = pytest.mark.usefixtures("here")


# ---------------------------------------------------------------------- headings


@pytest.mark.parametrize(
    ("heading", "keys"),
    [
        ("name,teeth,rack.root_radius,body.bore", ("name", "gear.teeth", "gear.rack.root_radius", "gear.body.bore")),
        ("teeth,gear.face_width,name", ("gear.teeth", "gear.face_width", "name")),
        ("name,helix_angle,wheel.teeth", ("name", "pair.helix_angle", "wheel.teeth")),
        ("name,pair.helix_angle,rack", ("name", "pair.helix_angle", "pair.rack")),
        ("name,pinion.name,material.name,load.torque", ("name", "pinion.name", "material.name", "load.torque")),
        ("name,gear.teeth,pinion.teeth", ("name", "gear.teeth", "pinion.teeth")),
        ('"name" , "teeth",,face_width,,', ("name", "gear.teeth", "gear.face_width")),
        ("name", ("name",)),
    ],
)
def test_headings_become_full_keys(heading: str, keys: tuple[str, ...]) -> None:
    Path("t.csv").write_text(heading.replace('" ', '"'))
    assert open_table("t.csv").keys == keys


def test_every_key_of_a_spec_can_be_a_column() -> None:
    """All of them: a table of pairs has no [gear], one of gears nothing of pairs."""
    for owners in (("gear", "material", "load"), ("pair", "pinion", "wheel", "material", "load")):
        keys = tuple(f"{owner}.{field}" for owner in owners for field in COLUMNS[owner])
        Path("t.csv").write_text(",".join(("name", *keys)))
        assert open_table("t.csv").keys == ("name", *keys)


PERMITTED_LOAD = (
    "unknown column; permitted behind load. are torque, speed, application_factor, ambient_temperature, duty, lubrication, "
    "housing_area, housing_resistance"
)
EXAMPLES = "unknown column; must be name, or a key of a spec with its table, such as"


@pytest.mark.parametrize(
    ("heading", "faults"),
    [
        ("name,pinon.teeth,wheel.teeth", ["column B: pinon.teeth: unknown column; did you mean pinion.teeth?"]),
        ("name,wheel.teeth,Teeth", ["column C: Teeth: unknown column; did you mean pinion.teeth or wheel.teeth?"]),
        ("name,Pinion.Teeth", ["column B: Pinion.Teeth: unknown column; did you mean pinion.teeth?"]),
        ("name,pair.m_n", ["column B: pair.m_n: unknown column; did you mean pair.normal_module?"]),
        ("name,pinion.z", ["column B: pinion.z: unknown column; did you mean pinion.teeth?"]),
        (
            "name,pinion.centre_distance",
            ["column B: pinion.centre_distance: unknown column; did you mean pair.centre_distance?"],
        ),
        ("name,pair.teeth", ["column B: pair.teeth: unknown column; did you mean pinion.teeth or wheel.teeth?"]),
        ("name,wheel.face_width [mm]", ["column B: wheel.face_width [mm]: unknown column; did you mean wheel.face_width?"]),
        ("name,root_radius", ["column B: root_radius: unknown column; did you mean gear.rack.root_radius?"]),
        ("name,centre_distance", ["column B: centre_distance: unknown column; did you mean pair.centre_distance?"]),
        ("name,torque", ["column B: torque: unknown column; did you mean load.torque?"]),
        ("name,load.qq", [f"column B: load.qq: {PERMITTED_LOAD}"]),
        ("name,qq", [f"column B: qq: {EXAMPLES} gear.teeth or load.torque"]),
        ("name,pair.rack,qq", [f"column C: qq: {EXAMPLES} pair.normal_module, pinion.teeth or load.torque"]),
        ('name,"a\nb"', [f"column B: a\\nb: {EXAMPLES} gear.teeth or load.torque"]),
        ('name,"teeth;x"', ["column B: teeth;x: unknown column; did you mean gear.teeth?"]),
        ("name,pair.name", ["column B: pair.name: is the name of the design; write name"]),
        ("name,name", ["column B: name: is the same as column A (name); keep one of them"]),
        (
            "name,pair.helix_angle,wheel.teeth,helix_angle",
            ["column D: helix_angle: is the same as column B (pair.helix_angle); keep one of them"],
        ),
        (
            "name,gear.teeth,wheel.teeth,helix_angle,teeth,hub_side",
            [
                "column D: helix_angle: could be of a gear or of a pair, and this table has both;"
                " write gear.helix_angle or pair.helix_angle",
                "column E: teeth: could be of a gear or of a pair, and this table has both;"
                " write gear.teeth or pinion.teeth or wheel.teeth",
                "column F: hub_side: unknown column; did you mean pair.body.hub_side?",
            ],
        ),
        (
            "Name,,wheel.teeth,wheel.teeth",
            [
                "column A: Name: unknown column; did you mean name?",
                "column D: wheel.teeth: is the same as column C (wheel.teeth); keep one of them",
                "has no column name, which every table needs: it gives each design a name and a folder",
            ],
        ),
    ],
)
def test_all_faults_of_a_heading_are_told_at_once(heading: str, faults: list[str]) -> None:
    lines = refusal_of(f"# comment\n\n{heading}\n").split("\n")
    assert lines == [f"t.csv row 3{' ' if fault.startswith('column') else ': '}{fault}" for fault in faults]


@pytest.mark.parametrize(
    ("index", "letter"), [(0, "A"), (25, "Z"), (26, "AA"), (51, "AZ"), (52, "BA"), (701, "ZZ"), (702, "AAA")]
)
def test_columns_are_lettered_as_in_a_spreadsheet(index: int, letter: str) -> None:
    assert column_letter(index) == letter


@pytest.mark.parametrize("content", ["", "\n\n", " ,,\n", "# only\n#comments\n", "sep=;\n"])
def test_a_file_without_a_heading_is_no_table(content: str) -> None:
    assert refusal_of(content) == "t.csv: has no heading; `gearcad new pairs` makes a table that has one"


def test_a_heading_alone_is_a_table_without_rows() -> None:
    assert sheet_rows_of(SHEET_GEARS) == []


# ---------------------------------------------------------------------- rows


def test_rows_are_counted_as_a_spreadsheet_shows_them() -> None:
    """Comments, blank rows and records of several lines are one row each, a line `sep=` is none."""
    content = (
        'sep=,\n# one, "two\n\n"# of\n2 lines",,\n'
        + SHEET_GEARS
        + ',,,\na,20,2,10\n, # "x",,\n\n"b\nc",20,2,10\n\n#d,20,2,10\ne,20,2,10'
    )
    assert [(row.number, row.name) for row in sheet_rows_of(content)] == [(6, "a"), (9, "b\nc"), (12, "e")]


def test_comments_are_not_confused_with_errors_of_a_spreadsheet() -> None:
    names = ["#N/A", "#NAME?", "#DIV/0!", "#BEZUG!", "#NV"]
    content = SHEET_GEARS + "".join(f"{name},20,2,10\n" for name in (*names, "#a!", "#N/A here", "# #N/A", "#", "#1!"))
    assert [row.name for row in sheet_rows_of(content)] == names
    assert faults_of(content)[0] == f"t.csv row 2 column A (#N/A): name = '#N/A': {ERROR}"
    assert len(faults_of(content)) == len(names)


def test_blank_cells_are_left_out_and_short_rows_filled_up() -> None:
    rows = sheet_rows_of("name,teeth,normal_module,face_width,body.bore,material.name\na,20, ,10\nb,20,2,10,\xa0,\n")
    assert [row.values for row in rows] == [
        {"gear.teeth": 20, "gear.face_width": 10.0},
        {"gear.teeth": 20, "gear.normal_module": 2.0, "gear.face_width": 10.0},
    ]
    design = rows[1].design()
    assert (design.name, design.material, design.load) == ("b", None, None)


def test_a_row_makes_what_the_same_spec_makes() -> None:
    [row] = [row for row in open_table(TEMPLATES / "pairs.csv").rows() if row.name == "volvo-13-44"]
    spec = read_spec(TEMPLATES / "volvo-13-44.toml")
    made = row.design()
    gears = {role: replace(getattr(spec.pair, role), tooth_allowance=None) for role in ("pinion", "wheel")}
    assert made.pair == replace(spec.pair, **gears, centre_distance_tolerance=None)  # the table has no limits
    assert (made.name, made.kind, made.load) == (spec.name, spec.kind, spec.load)


def test_material_and_load_are_there_if_a_cell_of_theirs_is() -> None:
    heading = SHEET_GEARS.strip() + ",material.youngs_modulus,material.name,load.torque\n"
    first, second = (row.design() for row in sheet_rows_of(heading + "a,20,2,10,205000,12,\nb,20,2,10,,,7\n"))
    assert first.material is not None and second.load is not None
    assert (first.material.youngs_modulus, first.material.name, first.load) == (205000.0, "12", None)
    assert (second.material, second.load.torque) == (None, 7.0)


MIXED = "name,gear.teeth,pinion.teeth,wheel.teeth,gear.normal_module,pair.normal_module,gear.face_width,pair.face_width\n"


def test_a_mixed_table_makes_gears_and_pairs() -> None:
    rows = sheet_rows_of(MIXED + "g,20,,,2,,10,\np,,20,30,,2,,10\n")
    assert [list(row.design().gears) for row in rows] == [["gear"], ["pinion", "wheel"]]


def test_a_row_of_a_mixed_table_makes_one_thing() -> None:
    assert faults_of(MIXED + "both,20,20,30,,2,,10\nneither,,,,,,,\nx,#REF!,20,30,,2,,10\n") == [
        "t.csv row 2 column C (both): pinion.teeth: cannot stand beside keys of gear: a row makes a gear or a pair",
        "t.csv row 3 (neither): makes nothing: every cell of gear, pair, pinion and wheel is blank",
        f"t.csv row 4 column B (x): gear.teeth = '#REF!': {ERROR}",
        "t.csv row 4 column C (x): pinion.teeth: cannot stand beside keys of gear: a row makes a gear or a pair",
    ]


def test_rows_begin_anew_with_every_call_and_travel_between_processes() -> None:
    Path("t.csv").write_text("name;teeth;face_width\na;20;1,5\nb;20;1.5\n")
    table = open_table("t.csv")
    once = list(table.rows())
    assert once == list(table.rows()) == pickle.loads(pickle.dumps(once))
    assert [len(row.faults) for row in once] == [0, 1]


def test_a_fault_of_a_row_travels_between_processes_with_its_key() -> None:
    with pytest.raises(SpecError) as caught:
        sheet_rows_of(SHEET_GEARS + "a,2,2,10\n")[0].design()
    copy = pickle.loads(pickle.dumps(caught.value))
    assert (str(copy), copy.key) == (
        "t.csv row 2 column B (a): gear.teeth = 2: must be a whole number from 3 to 2000",
        "gear.teeth",
    )


# ---------------------------------------------------------------------- values of cells


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2", 2.0),
        ("+2.50", 2.5),
        ("-0.378", -0.378),
        ("\N{MINUS SIGN}0.378", -0.378),
        (".5", 0.5),
        ("5.", 5.0),
        ("1.5E-3", 0.0015),
        ("205000", 205000.0),
        ("auto", "auto"),
        ("1_000", "1_000"),
        ("٢", "٢"),
        ("0x10", "0x10"),
        ("1 000", "1 000"),
        ("nan", "nan"),
        ("1.234.567", "1.234.567"),
        ("'-0.5", -0.5),
    ],
)
def test_numbers_are_plain_decimal_numbers(text: str, value: float | str) -> None:
    for separator in ",;\t":
        [[read]] = values_of(f"name{separator}tip_alteration\na{separator}{text}\n")
        assert (type(read), read) == (type(value), value)


@pytest.mark.parametrize(("text", "value"), [("18,3", 18.3), (",5", 0.5), ("-1,5e2", -150.0), ("5,", 5.0), ("1,2,3", "1,2,3")])
def test_a_decimal_comma_is_read_where_semicolons_separate(text: str, value: float | str) -> None:
    assert values_of(f"name;tip_alteration\na;{text}\n") == [[value]]


@pytest.mark.parametrize(("text", "value"), [("20", 20), ("20.0", 20), ("2e1", 20), ("20.5", 20.5), ("-3", -3), ("1e16", 1e16)])
def test_teeth_are_whole_if_the_number_is(text: str, value: float) -> None:
    [[read]] = values_of(f"name,teeth\na,{text}\n")
    assert (type(read), read) == (type(value), value)


def test_texts_stay_texts_even_if_they_look_like_numbers() -> None:
    heading = "name;pinion.name;material.name;rack;profile_shift_split;wheel.body.hub_side\n"
    [row] = sheet_rows_of(heading + "12;1,5;1.7131;2;3;4\n")
    assert (row.name, list(row.values.values()), row.faults) == ("12", ["1,5", "1.7131", "2", "3", "4"], ())


def test_an_apostrophe_before_a_formula_is_taken_off() -> None:
    """Tables of results have it, so that no spreadsheet runs the text; another apostrophe is the name's own."""
    assert [row.name for row in sheet_rows_of("name\n'=1+2\n''@x\n'x\n=x\n")] == ["=1+2", "'@x", "'x", "=x"]


NO_COMMA = "must have a decimal point: write 18.3 (a decimal comma needs semicolons between the cells)"


@pytest.mark.parametrize(
    ("separator", "cell", "fault"),
    [
        (",", '"18,3"', f"'18,3': {NO_COMMA}"),
        ("\t", "18,3", f"'18,3': {NO_COMMA}"),
        (",", '"1,234.5"', "'1,234.5': has a comma and a point; write it without a thousands separator"),
        (";", "1.234,5", "'1.234,5': has a comma and a point; write it without a thousands separator"),
        (";", "#WERT!", f"'#WERT!': {ERROR}"),
        (",", "1e400", "'1e400': must be a smaller number"),
        (",", "nan", "'nan': must be a number above 0 mm and at most 10000 mm"),
        (",", "-inf", "'-inf': must be a number above 0 mm and at most 10000 mm"),
        (",", "1 000", "'1 000': must be a number above 0 mm and at most 10000 mm"),
    ],
)
def test_a_cell_that_is_no_number_says_so(separator: str, cell: str, fault: str) -> None:
    content = f"{SHEET_GEARS}a,20,2,".replace(",", separator) + cell
    assert faults_of(content) == [f"t.csv row 2 column D (a): gear.face_width = {fault}"]


def test_decimal_points_and_commas_do_not_mix() -> None:
    """205.000 is 205 or 205000, depending on who wrote it: the first sign of the table decides, and rows that differ fail."""
    heading = "name;teeth;normal_module;face_width;material.youngs_modulus;material.name\n"
    tail = "write all numbers of a table alike"
    assert faults_of(heading + "a;20;2;10;;1.7\nb;20;2;10,5;205.000;\nc;20;2;11.5;;\nd;20;2,5;10;;\n") == [
        "t.csv row 3 column E (b): material.youngs_modulus = '205.000': has a decimal point,"
        f" but gear.face_width in row 3 has a decimal comma; {tail}",
        "t.csv row 4 column D (c): gear.face_width = '11.5': has a decimal point,"
        f" but gear.face_width in row 3 has a decimal comma; {tail}",
    ]
    assert faults_of(heading + "a;20;2.5;10,5;;\n") == [
        "t.csv row 2 column D (a): gear.face_width = '10,5': has a decimal comma,"
        f" but gear.normal_module in row 2 has a decimal point; {tail}"
    ]
    assert faults_of(heading + "a;20;2.5;10;205.000;\n") == []


def test_a_cell_without_a_heading_is_a_fault_and_hides_the_rest_of_its_row() -> None:
    comma = "; a decimal comma needs semicolons between the cells"
    assert faults_of("name,,teeth,normal_module,face_width\na,,20,2,18,3\nb,x,-1,2,10\nc,,-1,2,10,,\n") == [
        f"t.csv row 2 column F (a): '3': has no heading above it{comma}",
        f"t.csv row 3 column B (b): 'x': has no heading above it{comma}",
        "t.csv row 4 column C (c): gear.teeth = -1: must be a whole number from 3 to 2000, "
        "or from -2000 to -10 (internal gear)",
    ]
    assert faults_of("name\tteeth\n../a\t-1\tx\n") == ["t.csv row 2 column C (../a): 'x': has no heading above it"]


# ---------------------------------------------------------------------- templates and names


@pytest.mark.parametrize(("name", "kind"), [("pairs.csv", "pair"), ("gears.csv", "gear"), ("rings.csv", "pair")])
def test_templates_are_tables_of_good_designs(name: str, kind: str) -> None:
    rows = list(open_table(TEMPLATES / name).rows())
    assert 4 <= len(rows) <= 6
    assert [row.design().kind.value for row in rows] == [kind] * len(rows)


@pytest.mark.parametrize("name", ["pairs.csv", "gears.csv", "rings.csv"])
def test_templates_open_well_in_a_spreadsheet(name: str) -> None:
    """Plain ASCII, comments of one cell wherever the spreadsheet separates, every row as wide as the heading."""
    text = (TEMPLATES / name).read_bytes().decode("ascii")
    comments = [line for line in text.splitlines() if line.startswith("#")]
    assert len(comments) > 8
    assert not any(character in line for line in comments for character in ',;\t"')
    widths = {len(cells) for cells in csv.reader(text.splitlines()) if not cells[0].startswith("#")}
    assert len(widths) == 1


@pytest.mark.parametrize(("name", "permitted"), [("界" * 66, True), ("界" * 67, False), ("ä" * 100, True)])
def test_names_fit_into_file_systems(name: str, permitted: bool) -> None:
    if permitted:
        require_plain_name(name)
    else:
        with pytest.raises(ValueError, match="must be a plain file name of at most 200 bytes in UTF-8"):
            require_plain_name(name)


def test_a_row_and_a_spec_in_tables_give_the_same_design() -> None:
    [row] = sheet_rows_of(
        "name,normal_module,pinion.teeth,wheel.teeth,face_width,rack,wheel.rack.root_radius\na,2,20,30,10,ISO53_C,full\n"
    )
    tables = {
        "pair": {"name": "a", "normal_module": 2, "face_width": 10, "rack": "ISO53_C"},
        "pinion": {"teeth": 20},
        "wheel": {"teeth": 30, "rack": {"root_radius": "full"}},
    }
    assert row.design() == design_from_tables(tables, where=lambda key: key, default_name="")


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
    good, *wrong = sheet_rows_of(WRONG, "pairs.csv")
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
    [row] = sheet_rows_of(f"{heading}\n{buffer.getvalue()}")
    faults = row.all_faults()
    assert len(set(faults)) == len(faults)
    assert all(fault.startswith("t.csv row 2 ") and fault.isprintable() for fault in faults)
    if faults:
        with pytest.raises(SpecError) as caught:
            row.design()
        assert str(caught.value) in faults
    else:
        assert row.design().name == "a"

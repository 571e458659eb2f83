"""Files of design tables: texts in every dialect, workbooks, and files that are neither."""

import csv
import datetime
import io
import os
import sys
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.batches import ERROR, GOOD, SHEET_GEARS, refusal_of, sheet_rows_of, values_of, workbook

from gearcad import SpecError
from gearcad.designs import open_table
from gearcad.designs.table import DesignRow

FLAT = 50_000
"""Bytes by which the peak of memory may differ between a short table and a long one, whose rows would take 20 MB."""

MODEST = 8_000_000
"""Bytes of memory in which a workbook is refused that unpacks to more."""


pytestmark = pytest.mark.usefixtures("here")


def workbook_rows(rows: list[list[Any]]) -> list[DesignRow]:
    return list(open_table(workbook(rows)).rows())


# ---------------------------------------------------------------------- texts


@pytest.mark.parametrize(
    ("content", "numbers"),
    [
        ("# a; b\tc\nname,teeth,profile_shift\na,20,0.5\n", [20, 0.5]),
        ("name;teeth;profile_shift\na;20;0,5\n", [20, 0.5]),
        ("name\tteeth\tprofile_shift\na\t20\t0.5\n", [20, 0.5]),
        ('"# x\n y; ""z"" ",,\n# "\n,,\nname,teeth,profile_shift\na,20,0.5\n', [20, 0.5]),
        ('sep=;\r\nname;"teeth";profile_shift\r\na;20;0,5\r\n', [20, 0.5]),
        ('"sep=\t"\nname\tteeth\tprofile_shift\na\t20\t0.5\n', [20, 0.5]),
        ("name,teeth,profile_shift\ra,20,0.5\r", [20, 0.5]),
        ("name, teeth, profile_shift\n a, 20 ,\t0.5", [20, 0.5]),
    ],
)
def test_the_heading_tells_what_separates_the_cells(content: str, numbers: list[float]) -> None:
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        assert values_of(content.encode(encoding)) == [numbers]


BINARY = "t.csv: is not a text; save it as CSV UTF-8 (a workbook is named .xlsx)"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            (SHEET_GEARS + GOOD + "grün,20,2,10\n").encode("latin-1"),
            "t.csv line 3: is not UTF-8 text (byte 3 of the line); save it as CSV UTF-8",
        ),
        ((SHEET_GEARS + GOOD).encode("utf-16")[:-1], "t.csv: is not UTF-16 text; save it as CSV UTF-8"),
        ((SHEET_GEARS + GOOD).encode("utf-16-le"), BINARY),
        ((SHEET_GEARS + "a\0b,20,2,10\n").encode(), BINARY),
        (
            (SHEET_GEARS + GOOD + '"b,20,2,10\n' + GOOD).encode(),
            "t.csv row 3: a quotation mark opens a cell here and never closes",
        ),
        (
            (SHEET_GEARS + '"b,20,2,10\n' + GOOD * 15000).encode(),
            "t.csv row 2: has a cell of more than 131072 characters; does a quotation mark open and never close?",
        ),
        (
            (SHEET_GEARS + GOOD + '"b"c,20,2,10\n').encode(),
            "t.csv row 3: a closing quotation mark must end its cell; inside a cell write the mark twice",
        ),
    ],
)
def test_a_broken_text_says_where(content: bytes, message: str) -> None:
    assert refusal_of(content) == message


def test_quotation_marks_in_comments_do_not_matter() -> None:
    content = '# 5" pipe\n# see, "this\n' + SHEET_GEARS + '# and, "that"x\n,,"# quoted, too"\n' + GOOD
    assert [(row.number, row.name) for row in sheet_rows_of(content)] == [(6, "good")]


@pytest.mark.parametrize(
    ("name", "make", "message"),
    [
        (
            "none.csv",
            None,
            "cannot be read (No such file or directory); give a design table, or make one with `gearcad new pairs`",
        ),
        (
            "none.xlsx",
            None,
            "cannot be read (No such file or directory); give a design table, or make one with `gearcad new pairs`",
        ),
        ("t.csv", Path.mkdir, "cannot be read (Is a directory); give a design table, or make one with `gearcad new pairs`"),
        ("t.xlsx", Path.mkdir, "cannot be read (Is a directory); give a design table, or make one with `gearcad new pairs`"),
        ("t.xls", Path.touch, "cannot be read; save it as CSV UTF-8, or as a workbook .xlsx"),
        ("t.ODS", Path.touch, "cannot be read; save it as CSV UTF-8, or as a workbook .xlsx"),
        ("t.xlsx", Path.touch, "is no workbook that can be read; save the table by itself as .xlsx, or as CSV UTF-8"),
        ("pipe", os.mkfifo, "must be an ordinary file: it is read more than once"),
    ],
)
def test_a_file_that_is_no_table_is_one_line(name: str, make: Callable[[Path], None] | None, message: str) -> None:
    if make is not None:
        make(Path(name))
    with pytest.raises(SpecError) as caught:
        open_table(name)
    assert str(caught.value) == f"{name}: {message}"


def test_memory_does_not_grow_with_the_table() -> None:
    def peak(rows: int) -> int:
        with Path("long.csv").open("w") as file:
            file.write("name,normal_module,helix_angle,pinion.teeth,wheel.teeth,face_width,load.torque\n")
            file.writelines(f"row-{number},2.5,28,13,44,18,220\n" for number in range(rows))
        tracemalloc.start()
        try:
            assert sum(1 for _ in open_table("long.csv").rows()) == rows
            return tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()

    peak(10)  # what is made once
    assert peak(10_000) < peak(500) + FLAT


# ---------------------------------------------------------------------- workbooks

HEADING = ["name", "teeth", "normal_module", "face_width", "material.name"]


def test_cells_of_a_workbook_have_types() -> None:
    rows = workbook_rows(
        [["# a comment", 1], HEADING, [12.0, 20.0, 2, 18.3, 1.7131], [], [None, "# x"], [True, 20, "2.5", 10, 7.0]]
    )
    assert [(row.number, row.name, list(row.values.values())) for row in rows] == [
        (3, "12", [20, 2.0, 18.3, "1.7131"]),
        (6, "TRUE", [20, 2.5, 10.0, "7"]),
    ]
    assert [row.all_faults() for row in rows] == [[], []]


def test_a_zero_in_a_workbook_is_a_number() -> None:
    [row] = workbook_rows([["name", "helix_angle", "pinion.profile_shift"], [0, 0, 0.0]])
    assert (row.name, row.values) == ("0", {"pair.helix_angle": 0.0, "pinion.profile_shift": 0.0})


def test_cells_of_a_workbook_without_a_value_for_us_are_faults() -> None:
    date = "is a date, which the spreadsheet made of it; format the cell as a number or a text, and enter it again"
    no_value = "is a formula without a value; save the workbook in a spreadsheet, or write the number"
    rows = workbook_rows(
        [
            HEADING,
            ["date", 20, 2, datetime.date(2026, 3, 18), None],
            ["formula", 20, "=1+1", 10, None],
            ["error", 20, 2, "#N/A", None],
            ["comma", 20, "2,5", 10, None],
            ["boolean", 20, 2, True, None],
            ["stray", 20, 2, 10, None, 0],
            [datetime.time(13, 44), 20, 2, 10, None],
        ]
    )
    assert [row.all_faults() for row in rows] == [
        [f"t.xlsx row 2 column D (date): gear.face_width = '2026-03-18 00:00:00': {date}"],
        [f"t.xlsx row 3 column C (formula): gear.normal_module = '=1+1': {no_value}"],
        [f"t.xlsx row 4 column D (error): gear.face_width = '#N/A': {ERROR}"],
        ["t.xlsx row 5 column C (comma): gear.normal_module = '2,5': must have a decimal point: write 2.5"],
        ["t.xlsx row 6 column D (boolean): gear.face_width = 'TRUE': must be a number above 0 mm and at most 10000 mm"],
        ["t.xlsx row 7 column F (stray): '0': has no heading above it"],
        [f"t.xlsx row 8 column A (13:44:00): name = '13:44:00': {date}"],
    ]


def rewritten(path: Path, part: str, changes: list[tuple[bytes, bytes]]) -> Path:
    """The same workbook as another program would have written it: texts of one part replaced, each of which must be there."""
    with zipfile.ZipFile(path) as old, zipfile.ZipFile("saved.xlsx", "w") as new:
        for name in old.namelist():
            content = old.read(name)
            for before, after in changes if name == part else []:
                assert before in content
                content = content.replace(before, after)
            new.writestr(name, content)
    return Path("saved.xlsx")


def test_a_formula_with_a_stored_value_is_that_value() -> None:
    """As a spreadsheet saves it: the value beside the formula, which for an empty text is marked as one."""
    path = rewritten(
        workbook([HEADING[:4], ["a", 20, "=1+1", 10], ["b", 20, 2, 10], ["c", 20, 2, 10]]),
        "xl/worksheets/sheet1.xml",
        [
            (b'<c r="C2"><f>1+1</f><v></v></c>', b'<c r="C2"><f>1+1</f><v>2.5</v></c>'),
            (b'<c r="C3" t="n"><v>2</v></c>', b'<c r="C3" t="str"><f>""</f><v></v></c>'),
            (b'<c r="C4" t="n"><v>2</v></c>', b'<c r="C4" t="e"><f>1/0</f><v>#DIV/0!</v></c>'),
        ],
    )
    first, second, third = open_table(path).rows()
    assert first.values["gear.normal_module"] == 2.5
    assert "gear.normal_module" not in second.values and not second.faults
    assert third.faults == (f"saved.xlsx row 4 column C (c): gear.normal_module = '#DIV/0!': {ERROR}",)


def test_the_sheet_in_front_counts() -> None:
    book = openpyxl.Workbook()
    book.create_sheet("second").append(["name", "teeth"])
    book.active = 1
    book.save("t.xlsx")
    assert open_table("t.xlsx").keys == ("name", "gear.teeth")
    path = rewritten(Path("t.xlsx"), "xl/workbook.xml", [(b'activeTab="1"', b'activeTab="7"')])
    with pytest.raises(SpecError) as caught:
        open_table(path)
    assert str(caught.value) == "saved.xlsx: has no sheet in front; save the table by itself as .xlsx, or as CSV UTF-8"


def inflated(part: str, old: str, new: str) -> Path:
    """A workbook of one good row with a text in one of its parts replaced."""
    good = workbook([SHEET_GEARS.strip().split(","), ["good", 20, 2, 10]], "good.xlsx")
    with zipfile.ZipFile(good) as before, zipfile.ZipFile("t.xlsx", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as after:
        for name in before.namelist():
            content = before.read(name).decode()
            assert name != SHEET or not old or old in content
            after.writestr(name, content.replace(old, new, 1) if name == part else content)
        if part not in before.namelist():
            after.writestr(part, new)
    return Path("t.xlsx")


SHEET, STRINGS = "xl/worksheets/sheet1.xml", "xl/sharedStrings.xml"


@pytest.mark.parametrize(
    ("part", "old", "new", "message"),
    [
        (SHEET, ">good<", f">{'x' * 5_000_000}<", "t.xlsx: has a cell of more than 131072 characters"),
        (SHEET, ">good<", f">{'x' * 140_000}<", "t.xlsx row 2: has a cell of more than 131072 characters"),
        (
            STRINGS,
            "",
            f"<sst><si><t>{'x' * 5_000_000}</t></si></sst>",
            "t.xlsx: has a cell of more than 131072 characters",
        ),
        (
            STRINGS,
            "",
            f"<sst>{'<si><t>a</t></si>' * 2_000_000}</sst>",
            "t.xlsx: its xl/sharedStrings.xml has 34 MB unpacked, of which at most 32 MB are read; "
            "save the table by itself as .xlsx, or as CSV UTF-8",
        ),
    ],
    ids=["huge cell", "long cell", "huge text", "many texts"],
)
def test_a_workbook_larger_than_a_table_is_refused_before_it_is_unpacked(part: str, old: str, new: str, message: str) -> None:
    inflated(part, old, new)
    tracemalloc.start()
    try:
        with pytest.raises(SpecError) as caught:
            list(open_table("t.xlsx").rows())
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert str(caught.value) == message
    assert peak < MODEST


def test_a_workbook_needs_openpyxl(monkeypatch: pytest.MonkeyPatch) -> None:
    path = workbook([HEADING])
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(SpecError) as caught:
        open_table(path)
    assert str(caught.value) == 't.xlsx: needs openpyxl: pip install "gearcad[xlsx]", or save the table as CSV UTF-8'


# ---------------------------------------------------------------------- one table, many dialects

KEYS = ["teeth", "normal_module", "profile_shift", "rack.root_radius", "rack", "material.name"]
NUMBERS = st.one_of(
    st.floats(-1e15, 1e15).map(lambda number: float(f"{number:.12g}")),  # a workbook holds 15 digits
    st.integers(-(10**9), 10**9).map(float),
)
TEXTS = st.text(st.sampled_from("aZß界 ,;\t\"'#=.-12/\n"), min_size=1, max_size=8).filter(
    lambda text: text == text.strip() and text[0] not in "#='-" and "\n#" not in text
)
TABLES = st.lists(
    st.tuples(
        TEXTS,
        st.none() | st.integers(-5, 3000),
        st.none() | NUMBERS,
        st.none() | NUMBERS | st.just("auto"),
        st.none() | NUMBERS | st.just("full"),
        st.none() | st.sampled_from(["ISO53_A", "12"]),
        st.none() | TEXTS,
    ),
    max_size=4,
)


def as_text(table: list[list[Any]], separator: str, decimal: str, **options: Any) -> str:
    buffer = io.StringIO()
    writer = csv.writer(buffer, delimiter=separator, **options)
    for cells in table:
        writer.writerow([repr(cell).replace(".", decimal) if isinstance(cell, float) else cell for cell in cells])
    return buffer.getvalue()


DIALECTS: dict[str, Callable[[list[list[Any]]], bytes]] = {
    "comma": lambda table: as_text(table, ",", ".", lineterminator="\n").encode(),
    "Excel's UTF-8": lambda table: as_text(table, ",", ".").encode("utf-8-sig"),
    "quoted": lambda table: as_text(table, ",", ".", quoting=csv.QUOTE_ALL).encode(),
    "semicolon": lambda table: as_text(table, ";", ".").encode(),
    "European Excel": lambda table: as_text(table, ";", ",").encode("utf-8-sig"),
    "tab": lambda table: as_text(table, "\t", ".").encode(),
    "Excel's Unicode text": lambda table: as_text(table, "\t", ".").encode("utf-16"),
    "separator line": lambda table: b"sep=;\r\n" + as_text(table, ";", ",").encode(),
}


@settings(max_examples=30, deadline=None)
@given(designs=TABLES)
@example(designs=[("a", 20, 2.0, -0.378, "full", "12", "1.5"), ("1", None, 1e-7, None, None, None, 'x;,\t"y')])
@example(designs=[(name, None, None, None, None, None, None) for name in (";#", ",#", "a\nb", 'x, "#"')])
def test_every_dialect_reads_to_the_same_rows(designs: list[tuple[Any, ...]]) -> None:
    comment = ['# 1,5; "x"', *[None] * len(KEYS)]
    blank: list[Any] = [None] * (len(KEYS) + 1)
    table = [comment, ["name", *KEYS], blank, *map(list, designs), comment]
    expected = [
        (
            4 + number,
            name,
            {
                "material.name" if key == "material.name" else f"gear.{key}": value
                for key, value in zip(KEYS, values, strict=True)
                if value is not None
            },
        )
        for number, (name, *values) in enumerate(designs)
    ]
    for dialect, write in DIALECTS.items():
        rows = sheet_rows_of(write(table))
        assert [(row.number, row.name, row.values) for row in rows] == expected, dialect
        assert not any(row.faults for row in rows)
    assert [(row.number, row.name, row.values) for row in workbook_rows(table)] == expected

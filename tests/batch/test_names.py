"""Names become folders: none leaves the output folder, none is one that some file system cannot hold."""

from pathlib import Path

import pytest
from support.batches import read_results

from gearcad import SpecError
from gearcad.batch import run_table
from gearcad.jobs.job import Data

pytestmark = pytest.mark.usefixtures("kept_workers")

DATA = (Data(),)

PLAIN = "must be a plain file name"
SIGNS = f'{PLAIN}, without / \\ < > : " | ? * and control characters'
ENDS = f"{PLAIN}: not begun with a point, a dash or a space, nor ended with a point or space"
WINDOWS = f"{PLAIN}: Windows keeps this one for itself"

BAD = {
    "../x": SIGNS,
    "..": ENDS,
    ".": ENDS,
    "/abs": SIGNS,
    "a/b": SIGNS,
    "a\\b": SIGNS,
    "C:x": SIGNS,
    "a\tb": SIGNS,
    "a\nb": SIGNS,
    "a\u202eb": SIGNS,
    "CON": WINDOWS,
    "nul": WINDOWS,
    "aux.txt": WINDOWS,
    "COM1 .x": WINDOWS,
    "trailing.": ENDS,
    "-rf": ENDS,
    ".hidden": ENDS,
    ".gearcad-batch": ENDS,
    "a" * 101: f"{PLAIN} of at most 100 characters",
    "\N{GEAR}" * 100: f"{PLAIN} of at most 200 bytes in UTF-8",
    "": f"{PLAIN}: a text that is not empty",
    "results.csv": "must be another one; this is the name of a table of results",
    "Columns.CSV": "must be another one; this is the name of a table of results",
    "Results.Parquet": "must be another one; this is the name of a table of results",
}
"""Names, and the end of the message about each."""

TWINS = {
    "volvo": ("Volvo", "must be unique, for it names a folder; row 2 has 'Volvo', which some file systems take for the same"),
    "Volvo": ("Volvo", "must be unique, for it names a folder; row 2 has it too"),
    "STRASSE": (
        "straße",
        "must be unique, for it names a folder; row 2 has 'straße', which some file systems take for the same",
    ),
    "a\u0308": (
        "\u00e4",
        "must be unique, for it names a folder; row 2 has '\u00e4', which some file systems take for the same",
    ),
}
"""A name, that of the first row, and the message: two that some file systems hold for one."""


def table(folder: Path, *names: str) -> Path:
    """A table of gears with these names; each is quoted, so that it may hold anything."""
    quoted = ['"' + name.replace('"', '""') + '"' for name in names]
    text = "teeth,name,normal_module,face_width\n" + "".join(f"{17 + n},{name},1,5\n" for n, name in enumerate(quoted))
    path = folder / "table.csv"
    path.write_bytes(text.encode("utf-8"))
    return path


def test_bad_names_are_refused_with_their_places_and_nothing_is_made(tmp_path: Path) -> None:
    path = table(tmp_path, "good", *BAD, "other")
    with pytest.raises(SpecError) as caught:
        run_table(path, tmp_path / "deep" / "out", DATA, jobs=1)
    lines = str(caught.value).split("\n")
    for number, (name, line) in enumerate(zip(BAD, lines, strict=True), start=3):
        assert line.startswith(f"{path} row {number} column B"), name
        assert ": name = " in line and line.endswith(BAD[name]), name
    assert [each.name for each in tmp_path.iterdir()] == ["table.csv"]


def test_name_with_a_nul_is_refused_with_the_whole_file(tmp_path: Path) -> None:
    """It is no text: perhaps a workbook, or UTF-16."""
    path = table(tmp_path, "good", "a\0b")
    with pytest.raises(SpecError, match=r"is not a text; save it as CSV UTF-8"):
        run_table(path, tmp_path / "out", DATA, jobs=1, keep_going=True)
    assert [each.name for each in tmp_path.iterdir()] == ["table.csv"]


def test_keep_going_makes_the_others_and_stays_in_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "inside" / "out"
    names = ["good", *BAD, "other", "other"]
    summary = run_table(table(tmp_path, *names), folder, DATA, jobs=1, keep_going=True)
    assert (summary.ok, summary.failed, summary.not_run) == (2, len(BAD) + 1, 0)
    assert [line["status"] for line in read_results(folder)] == ["ok", *["failed"] * len(BAD), "ok", "failed"]
    made = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*")}
    files = {f"inside/out/{name}/{file}" for name in ("good", "other") for file in ("data.json", "manifest.json")}
    results = {f"inside/out/{name}" for name in ("results.csv", "columns.csv", "results.parquet")}
    assert made == {"table.csv", "inside", "inside/out", "inside/out/good", "inside/out/other"} | files | results


@pytest.mark.parametrize("name", TWINS, ids=ascii)
def test_names_that_are_one_folder_somewhere_are_refused(name: str, tmp_path: Path) -> None:
    first, end = TWINS[name]
    path = table(tmp_path, first, name)
    with pytest.raises(SpecError) as caught:
        run_table(path, tmp_path / "out", DATA, jobs=1)
    assert str(caught.value) == f"{path} row 3 column B ({name}): name = {name!r}: {end}"
    assert [each.name for each in tmp_path.iterdir()] == ["table.csv"]


def test_twins_are_found_however_far_apart(tmp_path: Path) -> None:
    names = [f"row {number}" for number in range(300)]
    path = table(tmp_path, *names, "ROW 7", "row 299")
    with pytest.raises(SpecError) as caught:
        run_table(path, tmp_path / "out", DATA, jobs=2)
    first, second = str(caught.value).split("\n")
    assert (
        first.endswith("row 9 has 'row 7', which some file systems take for the same") and f"{path} row 302 column B" in first
    )
    assert second.endswith("row 301 has it too") and f"{path} row 303 column B" in second


def test_faults_of_a_name_and_of_its_row_are_told_together(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("name,teeth,normal_module,face_width\nCON,2,1,5\nok,20,1,5\nOK,2,1,5\n")
    with pytest.raises(SpecError) as caught:
        run_table(path, tmp_path / "out", DATA, jobs=1)
    places = [line.split(": ")[0] for line in str(caught.value).split("\n")]
    assert places == [
        f"{path} row {where}" for where in ("2 column A (CON)", "2 column B (CON)", "4 column B (OK)", "4 column A (OK)")
    ]


def test_odd_but_harmless_names_are_folders(tmp_path: Path) -> None:
    """A name is a text, whatever number it could be."""
    names = ("a b", "größer", "1e5", "2.5", "x=y", "ok~", "a" * 100, "+a", "@x", "=1+2", "'quoted'", "#x", "it's, well", "conx")
    assert run_table(table(tmp_path, *names), tmp_path / "out", DATA, jobs=1).ok == len(names)
    assert [name for name in names if not (tmp_path / "out" / name / "data.json").is_file()] == []

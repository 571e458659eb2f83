"""What stands in a manifest, jobs of rows beside data, build and check, and names that become folders."""

import csv
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from support.batches import GEARS, lies, made_now, read_results, snapshot, write_table
from support.commands import read_json

import gearcad
from gearcad import SpecError
from gearcad.batch import BatchSummary, run_table
from gearcad.batch.row import MANIFEST, Manifest, RowPart, inputs_hash, read_manifest
from gearcad.designs.variations import column_symbol
from gearcad.jobs import VERBS, job_of
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data
from gearcad.jobs.strength import Stiffness
from gearcad.solids import Format

pytestmark = pytest.mark.usefixtures("kept_workers")

POINTS = (Build(formats=(Format.CSV,)),)


def test_manifest_names_gearcad_the_parts_and_every_file_with_its_size(tmp_path: Path) -> None:
    run_table(write_table(tmp_path / "table.csv", GEARS[:2]), tmp_path / "out", POINTS, jobs=1)
    folder = tmp_path / "out" / "spur"
    document = read_json(folder / "manifest.json")
    assert len(document.pop("inputs")) == 64
    assert document == {
        "gearcad": gearcad.__version__,
        "parts": {
            "csv": {"options": {}, "files": {"gear.csv": (folder / "gear.csv").stat().st_size}},
            "data": {"options": {}, "files": {"data.json": (folder / "data.json").stat().st_size}},
        },
    }


def test_files_may_be_called_as_gears_are(tmp_path: Path) -> None:
    """Else every run would make them again, and none would remove what a changed row has no longer."""
    names = ("drawing-assembly.dxf", "drawing-rim_3.pdf", "S1.step", "Großrad (2).step", "stage 1/drawing-pinion.dxf")
    manifest = Manifest("x", {"draw": RowPart({}, dict.fromkeys(names, 7))})
    (tmp_path / MANIFEST).write_text(manifest.text(), encoding="utf-8")
    assert read_manifest(tmp_path) == manifest
    for name in (
        "../x.dxf",
        "a/../x.dxf",
        "a/b/c.dxf",
        "/a.dxf",
        "a\\b.dxf",
        ".hidden.dxf",
        "C:x.dxf",
        "a\ud800.dxf",
        "a\x00.dxf",
        "a.dxf/",
    ):
        (tmp_path / MANIFEST).write_text(Manifest("x", {"draw": RowPart({}, {name: 7})}).text(), encoding="utf-8")
        assert read_manifest(tmp_path) is None, name


def test_hash_is_of_the_inputs_whatever_their_order() -> None:
    assert inputs_hash({"name": "a", "gear.teeth": 20}) == inputs_hash({"gear.teeth": 20, "name": "a"})
    others = [{"name": "a", "gear.teeth": 21}, {"name": "b", "gear.teeth": 20}, {"name": "a", "wheel.teeth": 20}, {"name": "a"}]
    assert len({inputs_hash(inputs) for inputs in others} | {inputs_hash({"name": "a", "gear.teeth": 20})}) == 5


def test_hash_is_of_the_source_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A checkout changes under one version."""
    monkeypatch.chdir(tmp_path)  # Python looks for packages here first
    copy = Path(shutil.copytree(Path(gearcad.__file__).parent, tmp_path / "gearcad"))

    def hash_there() -> str:
        code = "from gearcad.batch.row import MANIFEST, Manifest, RowPart, inputs_hash, read_manifest; print(inputs_hash({}))"
        environment = os.environ | {"PYTHONPATH": str(tmp_path)}
        return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment).stdout

    found = [hash_there()]
    assert found[0].strip() == inputs_hash({})
    for change in ("designs/keys.py", "solids/new.py"):
        with (copy / change).open("a") as file:
            file.write("# another comment\n")
        found.append(hash_there())
    assert len(set(found)) == 3


# ---------------------------------------------------------------------- manifests that lie


def _edited(**changes: Any) -> Callable[[dict[str, Any]], str]:
    return lambda document: json.dumps(document | changes)


def _listing(file: Any, size: Any = 5, *, unfinished: bool = False) -> Callable[[dict[str, Any]], str]:
    """A manifest that lists a file as finished; with `unfinished` as one to be removed, and of other inputs."""

    def edit(document: dict[str, Any]) -> str:
        if unfinished:
            return json.dumps(document | {"inputs": "other", "unfinished": [file]})
        document["parts"]["csv"]["files"] = {file: size}
        return json.dumps(document)

    return edit


LIES: dict[str, Callable[[dict[str, Any]], str | bytes]] = {
    "binary": lambda _: os.urandom(1000),
    "utf-16": lambda document: json.dumps(document).encode("utf-16"),
    "a list": lambda _: "[]",
    "deep": lambda _: "[" * 100_000,
    "no parts": lambda document: json.dumps({"inputs": document["inputs"]}),
    "parts are a list": _edited(parts=["csv"]),
    "parts are null": _edited(parts=None),
    "options are a number": _edited(parts={"csv": {"options": 5, "files": {}}}),
    "files are a text": _edited(parts={"csv": {"options": {}, "files": "gear.csv"}}),
    "unfinished is a number": _edited(unfinished=5),
    "unfinished holds a list": _edited(unfinished=[["gear.csv"]]),
    "infinite size": _listing("gear.csv", float("inf")),
    "size is a text": _listing("gear.csv", "many"),
    "another size": _listing("gear.csv", 12),
    "other inputs": _edited(inputs="x"),
    **{
        f"lists {file[:8]!a}": _listing(file)
        for file in ("../../x", "/etc/hostname", "..", ".", "", "a\0b", "\ud800", "x" * 999)
    },
    **{
        f"gave up {file[:8]!a}": _listing(file, unfinished=True)
        for file in (
            "../../precious",
            "..",
            ".",
            "",
            "a\0b",
            "\ud800",
            "x" * 999,
            "notes",
            "sub",
            "manifest.json",
            "a/b",
            "a\\b",
        )
    },
}


def test_manifest_that_cannot_be_believed_does_no_harm(tmp_path: Path) -> None:
    """Each lie in a row of its own, beside files and folders of the user."""
    rows = {f"row {number}": lie for number, lie in enumerate(LIES)}
    lines = (GEARS[0], *(f"{name},{12 + n % 9},1,2," for n, name in enumerate(rows)))
    table = write_table(tmp_path / "table.csv", lines)
    run_table(table, tmp_path / "out", POINTS, jobs=1)
    before = snapshot(tmp_path / "out")
    own = [tmp_path / "precious", *(tmp_path / "out" / name / file for name in rows for file in ("notes", "sub/x"))]
    for path in own:
        path.parent.mkdir(exist_ok=True)
        path.write_text("kept")
    for name, lie in rows.items():
        manifest = tmp_path / "out" / name / "manifest.json"
        told = LIES[lie](read_json(manifest))
        manifest.write_bytes(told if isinstance(told, bytes) else told.encode("utf-8", "surrogatepass"))
    assert run_table(table, tmp_path / "out", POINTS, jobs=1).errors == ()
    assert [lie for name, lie in rows.items() if name not in made_now(tmp_path / "out")] == []
    assert [path for path in own if path.read_text() != "kept"] == []
    after = snapshot(tmp_path / "out")
    assert {name: content for name, content in after.items() if name in before} == before
    assert {name for name in after if name not in before} == {
        f"{name}/{own}" for name in rows for own in ("notes", "sub", "sub/x")
    }


LINES = (
    "name,gear.teeth,gear.normal_module,gear.face_width,"
    "pair.normal_module,pinion.teeth,wheel.teeth,pinion.face_width,wheel.face_width,load.torque",
    "good,,,,2,20,30,20,20,60",
    "idle,,,,2,20,31,20,20,",
    "alone,20,2,20,,,,,,",
)

METHODS = ("iso6336", "weber-banaschek")


def make(folder: Path, job: Stiffness) -> BatchSummary:
    return run_table(write_table(folder / "table.csv", LINES), folder / "out", [job], jobs=1)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("rows")
    summary = make(folder, Stiffness(methods=METHODS))
    assert (summary.ok, summary.failed) == (1, 2)
    table = folder / "table.csv"
    assert summary.errors == (
        f"{table} row 3 (idle): load.torque is missing: must be given, in N·m on the pinion: stiffness depends on it",
        f"{table} row 4 (alone): kind = 'gear': must be a pair or a rack and pinion: a single gear has no mesh",
    )
    return folder / "out"


def test_columns_are_the_figures_of_the_document(made: Path) -> None:
    line = read_results(made)[0]
    document = read_json(made / "good" / "stiffness.json")
    assert (line["files.data.json"], line["files.stiffness.json"]) == ("good/data.json", "good/stiffness.json")
    for method in METHODS:
        assert float(line[f"stiffness.{method}.mean"]) == document["methods"][method]["mean"]
    assert "stiffness.iso6336.maximum" not in line  # the standard knows the means only
    with (made / "columns.csv").open(encoding="utf-8", newline="") as file:
        units = {row["column"]: (row["symbol"], row["unit"]) for row in csv.DictReader(file)}
    assert units["stiffness.weber-banaschek.c_gamma_beta"] == ("c_γβ", "N/(mm·µm)")
    assert units["stiffness.iso6336.mean"] == ("", "N/µm")
    assert [heading for heading in line if heading.startswith("stiffness.") and column_symbol(heading) is None] == []


def test_parts_are_kept_while_their_options_are(made: Path) -> None:
    parts = read_json(made / "good" / "manifest.json")["parts"]
    assert parts["stiffness"]["options"] == {"methods": list(METHODS)}
    assert list(parts["stiffness"]["files"]) == ["stiffness.json"]
    make(made.parent, Stiffness(methods=METHODS))
    assert "good" not in made_now(made)
    make(made.parent, Stiffness(methods=["iso6336"]))
    assert "good" in made_now(made)
    assert lies(made) == []


def test_rows_without_a_report_get_one_where_it_is_asked_for(tmp_path: Path) -> None:
    row = tmp_path / "out" / "good"
    make(tmp_path, Stiffness(methods=["iso6336"], report=False))
    assert sorted(path.name for path in row.iterdir()) == ["data.json", "manifest.json", "stiffness.json"]
    assert "files.stiffness.html" not in read_results(tmp_path / "out")[0]
    without = (row / "stiffness.json").read_bytes()
    make(tmp_path, Stiffness(methods=["iso6336"]))
    assert "good" in made_now(tmp_path / "out")
    assert (row / "stiffness.json").read_bytes() == without
    assert read_results(tmp_path / "out")[0]["files.stiffness.html"] == "good/stiffness.html"
    for report in (False, True):  # one that is there stays, and costs nothing again
        make(tmp_path, Stiffness(methods=["iso6336"], report=report))
        assert "good" not in made_now(tmp_path / "out")
    (row / "stiffness.html").unlink()
    make(tmp_path, Stiffness(methods=["iso6336"]))
    assert "good" in made_now(tmp_path / "out")
    assert lies(tmp_path / "out") == []


def test_every_job_with_a_document_of_its_own_is_a_part() -> None:
    """`build` has parts by their formats, and the document of `data`."""
    own = [verb for verb in VERBS if verb in job_of(verb)().parts]
    assert own == [
        "data",
        "draw",
        "picture",
        "verify",
        "check",
        "mesh",
        "rate",
        "stiffness",
        "dynamics",
        "planetary",
        "shafts",
        "modify",
    ]


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

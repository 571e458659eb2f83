"""The table of results: every number of every design, in the order of the table, as CSV and as Parquet."""

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support import jobs
from support.batches import GEARS, MIXED, PAIRS, read_results, rows_of, write_table
from support.commands import read_json

from gearcad.batch import BatchSummary, Decimal, run_table
from gearcad.batch import run as run_module
from gearcad.core.errors import OutputError, ParameterError
from gearcad.designs import read_spec
from gearcad.designs.cells import cell_text
from gearcad.designs.table import open_table
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data, Job
from gearcad.solids import FileOptions, Format

pytestmark = pytest.mark.usefixtures("kept_workers")

DATA = (Data(),)
POINTS = (Build(formats=(Format.CSV,)),)

FIRST = ["name", "status", "error", "warnings", "seconds"]

TEXTS = ("name", "rack", "hub_side", "profile_shift_split")


def make(folder: Path, lines: tuple[str, ...], wanted: tuple[Job[Any, Any], ...] = DATA, **options: Any) -> BatchSummary:
    return run_table(write_table(folder / "table.csv", lines), folder / "out", wanted, **({"jobs": 1} | options))


@pytest.fixture(scope="module")
def mixed(kept_workers: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Gears and pairs in one table, made with their tool-path points."""
    folder = tmp_path_factory.mktemp("mixed")
    summary = make(folder, MIXED, POINTS, jobs=2)
    assert (summary.ok, summary.failed, summary.not_run, summary.errors, summary.stopped) == (3, 0, 0, (), "")
    assert summary.results == tuple(folder / "out" / name for name in ("results.csv", "columns.csv", "results.parquet"))
    return folder


def spec_of(row: dict[str, str], path: Path) -> Path:
    """The same design as a spec in TOML: one key a line, texts in quotes."""
    owners: dict[str, list[str]] = {"gear": []} if "gear.teeth" in row else {"pair": [], "pinion": [], "wheel": []}
    owners[next(iter(owners))].append(f"name = {json.dumps(row['name'])}")
    for key, cell in row.items():
        if key != "name":
            owner, field = key.split(".", 1)
            value = json.dumps(cell) if cell == "auto" or field in TEXTS else cell
            owners.setdefault(owner, []).append(f"{field} = {value}")
    path.write_text("".join(f"[{owner}]\n" + "".join(f"{line}\n" for line in lines) for owner, lines in owners.items()))
    return path


def leaves(document: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    """Every number, text and truth of data.json but warnings, notices, assumed values, courses, and the three that head it."""
    if isinstance(document, dict):
        for name, value in document.items():
            if name not in ("warnings", "notices", "assumed", "specific_sliding_path"):
                yield from leaves(value, f"{key}.{name}" if key else name)
    elif isinstance(document, list | tuple):
        for name, value in zip(("pinion", "wheel"), document, strict=True):
            yield from leaves(value, f"{key}.{name}")
    elif "." in key:
        yield key, document


def value_of(cell: str, like: Any) -> Any:
    """What a cell says, as the kind of value that it should be."""
    if isinstance(like, bool):
        return {"true": True, "false": False}[cell]
    if like is None:
        return cell or None
    return type(like)(cell) if not isinstance(like, float) else float(cell)


def test_every_derived_number_equals_that_of_the_same_spec_to_the_last_digit(mixed: Path, tmp_path: Path) -> None:
    results = read_results(mixed / "out")
    for row, result in zip(rows_of(MIXED), results, strict=True):
        expected = dict(leaves(read_spec(spec_of(row, tmp_path / "spec.toml")).to_dict()))
        assert len(expected) > 40
        assert {key: value_of(result[key], value) for key, value in expected.items()} == expected
        others = {key for key in result if "." in key and not key.startswith("files.")} - set(expected)
        assert {key: result[key] for key in others if result[key]} == {key: str(float(row[key])) for key in others & set(row)}


def test_lines_are_in_the_order_of_the_table(mixed: Path) -> None:
    results = read_results(mixed / "out")
    assert [(line["name"], line["status"], line["error"]) for line in results] == [
        ("zeta", "ok", ""), ("alpha", "ok", ""), ("mu", "ok", ""),
    ]  # fmt: skip


def test_headings_are_states_then_files_then_inputs_then_what_is_derived(mixed: Path) -> None:
    headings = list(read_results(mixed / "out")[0])
    files = ["files.data.json", "files.pinion.csv", "files.wheel.csv", "files.gear.csv"]
    inputs = list(open_table(mixed / "table.csv").keys[1:])
    head = FIRST + files + inputs
    assert headings[: len(head)] == head
    assert len(set(headings)) == len(headings)
    assert {"gear.tip_diameter", "pair.path_of_contact.A", "pair.working_pitch_diameters.wheel"} < set(headings[len(head) :])


def test_inputs_keep_the_order_of_the_table_though_a_first_row_lacks_some(tmp_path: Path) -> None:
    lines = ("name,teeth,profile_shift,normal_module,face_width,rack", "a,20,,1,5,", "b,20,0.1,1,5,ISO53_C")
    make(tmp_path, lines)
    headings = list(read_results(tmp_path / "out")[0])
    inputs = [f"gear.{field}" for field in ("teeth", "profile_shift", "normal_module", "face_width", "rack")]
    assert headings[len(FIRST) + 1 :][: len(inputs)] == inputs


def test_paths_of_the_files_are_those_that_are_there(mixed: Path) -> None:
    folder = mixed / "out"
    for line in read_results(folder):
        listed = {cell for key, cell in line.items() if key.startswith("files.") and cell}
        made = {path.relative_to(folder).as_posix() for path in (folder / line["name"]).iterdir()}
        assert listed == made - {f"{line['name']}/manifest.json"}
        for key, cell in line.items():
            assert not key.startswith("files.") or not cell or cell == f"{line['name']}/{key.removeprefix('files.')}"


def test_data_json_is_that_of_the_spec(mixed: Path, tmp_path: Path) -> None:
    row = rows_of(MIXED)[0]
    expected = json.dumps(Data().complete_document(read_spec(spec_of(row, tmp_path / "spec.toml"))), indent=2) + "\n"
    assert (mixed / "out" / "zeta" / "data.json").read_text() == expected


def test_what_was_derived_stands_in_the_place_of_auto(mixed: Path) -> None:
    line = read_results(mixed / "out")[0]
    document = read_json(mixed / "out" / "zeta" / "data.json")
    assert float(line["wheel.profile_shift"]) == document["wheel"]["profile_shift"] != 0.0


def test_warnings_are_led_by_what_they_are_about(tmp_path: Path) -> None:
    lines = ("name,teeth,normal_module,face_width", "undercut,10,1,5", "plain,30,1,5")
    make(tmp_path, lines)
    undercut, plain = read_results(tmp_path / "out")
    found = open_table(tmp_path / "table.csv")
    expected = "; ".join(next(found.rows()).design().warnings)
    assert undercut["warnings"] == expected and expected.startswith("gear: ")
    assert plain["warnings"] == ""


def test_parquet_holds_what_the_csv_holds_with_types(mixed: Path) -> None:
    from pyarrow.parquet import read_table

    table = read_table(mixed / "out" / "results.parquet")
    lines = read_results(mixed / "out")
    assert table.column_names == list(lines[0])
    for found, line in zip(table.to_pylist(), lines, strict=True):
        assert {key: value_of(line[key], value) for key, value in found.items()} == found
    kinds = {"gear.teeth": "int64", "pair.gear_ratio": "double", "pinion.undercut": "bool", "gear.name": "string"}
    assert {key: str(table.schema.field(key).type) for key in kinds} == kinds
    assert str(table.schema.field("seconds").type) == "double"


def test_without_pyarrow_there_is_the_csv_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _name: None)
    summary = make(tmp_path, GEARS)
    assert [path.name for path in summary.results] == ["results.csv", "columns.csv"]
    assert not (tmp_path / "out" / "results.parquet").exists()


def test_file_is_utf_8_with_commas_points_and_plain_line_ends(tmp_path: Path) -> None:
    lines = ("name;teeth;normal_module;face_width", "Stirnrad größer;20;1,5;7,25")
    make(tmp_path, lines)
    content = (tmp_path / "out" / "results.csv").read_bytes()
    assert content.startswith(b"name,status,")
    assert b"\r" not in content and content.count(b"\n") == 2
    assert ",20,1.5,7.25," in content.decode("utf-8") and "Stirnrad größer,ok," in content.decode("utf-8")


def test_decimal_comma_is_what_excel_opens_in_europe(tmp_path: Path) -> None:
    """The same cells, semicolons between them, and the mark by which Excel knows UTF-8; the inputs are a table again."""
    lines = ("name,teeth,normal_module,face_width", "größer 1.5 2.5,20,1.5,7.25", "b,21,2,0.125")
    make(tmp_path, lines)
    point = read_results(tmp_path / "out")
    make(tmp_path, lines, decimal=Decimal.COMMA)
    content = (tmp_path / "out" / "results.csv").read_bytes().decode("utf-8")
    assert content.startswith("\ufeffname;status;")
    found = list(csv.DictReader(content[1:].splitlines(), delimiter=";"))
    assert [line["name"] for line in found] == ["größer 1.5 2.5", "b"]
    for line, expected in zip(found, point, strict=True):
        for key, cell in line.items():
            text = key in ("name", "error", "warnings", "seconds", "gear.name") or key.startswith("files.")
            assert text or cell == expected[key].replace(".", ","), key
    assert (found[0]["gear.normal_module"], found[1]["gear.face_width"]) == ("1,5", "0,125")
    explained = (tmp_path / "out" / "columns.csv").read_text(encoding="utf-8-sig").splitlines()
    assert explained[0] == "column;symbol;unit;of;words;source"


def test_lists_have_the_decimal_comma_too() -> None:
    assert cell_text((40.0, 82.5), Decimal.COMMA) == "40,0 82,5"
    assert cell_text((40.0, 82.5), Decimal.POINT) == "40.0 82.5"


def test_columns_csv_has_symbol_and_unit_of_every_column(mixed: Path) -> None:
    with (mixed / "out" / "columns.csv").open(encoding="utf-8", newline="") as file:
        explained = {line.pop("column"): line for line in csv.DictReader(file)}
    assert list(explained) == list(read_results(mixed / "out")[0])
    assert all(line["words"] for line in explained.values())
    assert explained["pinion.tip_diameter"] == {
        "symbol": "d_a", "unit": "mm", "of": "pinion", "words": "tip diameter", "source": "4.5",
    }  # fmt: skip
    assert explained["files.gear.csv"]["words"] == "path of a file, from the folder of this table"


# ---------------------------------------------------------------------- spreadsheets

FORMULAS = ("=1+2", "+a", "@x", "=cmd", "'=twice", "''@thrice")


def test_texts_that_a_spreadsheet_would_run_have_an_apostrophe_in_front(tmp_path: Path) -> None:
    lines = (
        "name,teeth,normal_module,face_width,profile_shift",
        *(f"'{name},20,1,5,-0.25" for name in FORMULAS),
        "it's,20,1,5,",
    )
    make(tmp_path, lines)
    results = read_results(tmp_path / "out")
    assert [line["name"] for line in results] == [*(f"'{name}" for name in FORMULAS), "it's"]
    assert all((tmp_path / "out" / name / "data.json").is_file() for name in FORMULAS)
    for line in results[:-1]:
        for key, cell in line.items():
            if cell.lstrip("'").startswith(("=", "+", "@")):
                assert cell.startswith("'"), key
        assert line["gear.profile_shift"] == "-0.25"


def test_results_are_read_back_with_their_names(tmp_path: Path) -> None:
    """The columns of the inputs alone are a design table again."""
    lines = ("name,teeth,normal_module,face_width", *(f"'{name},20,1,5" for name in FORMULAS))
    make(tmp_path, lines)
    keys = open_table(tmp_path / "table.csv").keys
    with (tmp_path / "again.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, keys, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(read_results(tmp_path / "out"))
    assert [row.name for row in open_table(tmp_path / "again.csv").rows()] == list(FORMULAS)
    assert [row.all_faults() for row in open_table(tmp_path / "again.csv").rows()] == [[]] * len(FORMULAS)


def test_parquet_has_texts_as_they_are(tmp_path: Path) -> None:
    from pyarrow.parquet import read_table

    make(tmp_path, ("name,teeth,normal_module,face_width", *(f"'{name},20,1,5" for name in FORMULAS)))
    table = read_table(tmp_path / "out" / "results.parquet")
    assert table["name"].to_pylist() == list(FORMULAS)
    assert table["files.data.json"].to_pylist() == [f"{name}/data.json" for name in FORMULAS]


def test_error_that_begins_with_the_name_of_a_formula_is_made_harmless(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_table(Path("=1.csv"), ("name,teeth,normal_module,face_width", "a,2,1,5", "b,20,1,5"))
    run_table("=1.csv", Path("out"), DATA, jobs=1, keep_going=True)
    assert read_results(Path("out"))[0]["error"].startswith("'=1.csv row 2 column B (a): gear.teeth = 2: must be ")


# ---------------------------------------------------------------------- rows that fail


def test_faulty_rows_stand_in_their_place_with_their_error_and_their_inputs(tmp_path: Path) -> None:
    lines = ("name,teeth,normal_module,face_width", "a,20,1,5", "b,2,1,-5", "c,many,1,5", "d,21,1,5")
    summary = make(tmp_path, lines, keep_going=True)
    table = tmp_path / "table.csv"
    b = (
        f"{table} row 3 column B (b): gear.teeth = 2: must be a whole number from 3 to 2000; "
        f"{table} row 3 column D (b): gear.face_width = -5 mm: must be a number above 0 mm and at most 10000 mm"
    )
    c = f"{table} row 4 column B (c): gear.teeth = 'many': must be a whole number from 3 to 2000"
    assert (summary.ok, summary.failed, summary.not_run, summary.errors) == (2, 2, 0, (b, c))
    results = read_results(tmp_path / "out")
    assert [(line["name"], line["status"], line["error"]) for line in results] == [
        ("a", "ok", ""), ("b", "failed", b), ("c", "failed", c), ("d", "ok", ""),
    ]  # fmt: skip
    assert [line["gear.teeth"] for line in results] == ["20", "2", "many", "21"]
    assert [line["gear.face_width"] for line in results] == ["5.0", "-5.0", "5.0", "5.0"]
    for line in results[1:3]:
        assert not any(line[key] for key in line if key.startswith("files.") or key == "gear.tip_diameter")
    assert sorted(path.name for path in (tmp_path / "out").iterdir() if path.is_dir()) == ["a", "d"]


DEADLY = {
    "segfault-1": "killed its process (SIGSEGV)",
    "exit-1": "ended its process (exit status 3)",
    "kill-1": "killed its process (SIGKILL, perhaps for want of memory)",
}


def test_row_that_takes_its_worker_with_it_costs_that_row_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_module, "make_row", jobs.make_row_or_die)
    names = ["a", "segfault-1", "b", "exit-1", "c", "kill-1", "d", "e"]
    lines = ("name,teeth,normal_module,face_width", *(f"{name},{20 + n},1,5" for n, name in enumerate(names)))
    summary = make(tmp_path, lines, jobs=2)
    results = read_results(tmp_path / "out")
    place = f"{tmp_path / 'table.csv'} row "
    expected = {name: f"{place}{2 + n} ({name}): {DEADLY[name]}" if name in DEADLY else "" for n, name in enumerate(names)}
    assert {line["name"]: line["error"] for line in results} == expected
    assert [line["status"] for line in results] == ["failed" if name in DEADLY else "ok" for name in names]
    assert (summary.ok, summary.failed, summary.not_run) == (5, 3, 0)
    assert list(summary.errors) == list(filter(None, expected.values()))
    assert sorted(path.name for path in (tmp_path / "out").iterdir() if path.is_dir()) == ["a", "b", "c", "d", "e"]
    monkeypatch.undo()
    again = make(tmp_path, lines)
    assert (again.ok, again.failed) == (8, 0)
    made = [line["name"] for line in read_results(tmp_path / "out") if line["seconds"]]
    assert made == list(DEADLY)


def test_row_without_end_is_stopped_at_its_time_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_module, "make_row", jobs.make_row_or_die)
    table = write_table(tmp_path / "table.csv", ("name,teeth,normal_module,face_width", "a,20,1,5", "hang-1,20,1,5"))
    summary = run_table(table, tmp_path / "out", DATA, jobs=1, time_limit=1.5)  # far more than the first row takes
    assert (summary.ok, summary.errors) == (1, (f"{table} row 3 (hang-1): was stopped at its time limit of 1.5 s",))


def test_want_of_memory_fails_the_row(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_module, "make_row", jobs.make_row_or_die)
    summary = make(tmp_path, ("name,teeth,normal_module,face_width", "memory-1,20,1,5", "b,20,1,5"))
    assert (summary.ok, summary.failed) == (1, 1)
    assert summary.errors == (f"{tmp_path / 'table.csv'} row 2 (memory-1): MemoryError: no memory for 3 faces",)


def test_error_of_a_row_names_the_row_once(tmp_path: Path) -> None:
    """A pair that can be computed but not built with these options: the row's place leads what the builder says."""
    lines = ("name,normal_module,pinion.teeth,wheel.teeth,pinion.face_width,wheel.face_width", "bare,1,17,22,2,2")
    summary = make(tmp_path, lines, (Build(formats=(Format.STEP,), options=FileOptions(bracket=True)),))
    (error,) = summary.errors
    assert error.startswith(f"{tmp_path / 'table.csv'} row 2 (bare): pinion.body.bore = 0 mm: must be above 0 mm")
    assert read_results(tmp_path / "out")[0]["error"] == error


# ---------------------------------------------------------------------- the rest of the summary


def test_progress_counts_rows_in_both_phases(tmp_path: Path) -> None:
    seen: list[tuple[str, float, float]] = []
    lines = (*GEARS, "bad,2,1,2,", "worse,3,1,2,80")
    make(tmp_path, lines, keep_going=True, progress=lambda *step: seen.append(step))
    assert [step for step in seen if step[0].startswith("checking")] == [("checking, 2 failed", 5, 0)]
    assert [step for step in seen if step[0].startswith("making")] == [("making, 2 failed", done, 5) for done in (2, 3, 4, 5)]


def test_options_are_checked_first(tmp_path: Path) -> None:
    for options, message in (
        ({"time_limit": 0.0}, "time_limit = 0 s: must be a number above 0 s"),
        ({"time_limit": 1e12}, "time_limit = 1e+12 s: must be a number above 0 s and at most "),
        ({"time_limit": float("nan")}, "time_limit = nan s: must be a number above 0 s"),
        ({"jobs": 0}, "jobs = 0: must be a whole number from 1 to 1024"),
        ({"jobs": 5000}, "jobs = 5000: must be a whole number from 1 to 1024"),
    ):
        with pytest.raises(ParameterError) as caught:
            run_table(write_table(tmp_path / "table.csv", GEARS), tmp_path / "out", DATA, **({"jobs": 1} | options))
        assert str(caught.value).startswith(message)
    with pytest.raises(ParameterError, match=r"^do = '': must be one or more of data, build"):
        run_table(write_table(tmp_path / "table.csv", GEARS), tmp_path / "out", ())
    with pytest.raises(
        ParameterError, match=f"^format = '': must be one or more of {', '.join(kind.value for kind in Format)}$"
    ):
        Build(formats=())
    assert not (tmp_path / "out").exists()


def test_table_in_the_place_of_its_own_results_is_refused(tmp_path: Path) -> None:
    """The user's table would be lost."""
    table = write_table(tmp_path / "results.csv", PAIRS)
    before = table.read_bytes()
    with pytest.raises(OutputError, match=r"results\.csv"):
        run_table(table, tmp_path, DATA, jobs=1)
    assert table.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["results.csv"]

"""`gearcad batch` as a user meets it: what it prints and where, exit statuses, job, all faults at once."""

import csv
import json
import os
import re
import select
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import Result
from support.batches import GEARS, read_results, write_table
from support.commands import invoke, run
from support.processes import PATIENCE, batch_command, run_batch
from support.specs import TEMPLATES

import gearcad

pytestmark = pytest.mark.usefixtures("kept_workers")

BAD = (*GEARS[:2], "flat,2,1,2,", "steep,17,1,3,95")
BAD_LINES = [
    "table.csv row 3 column B (flat): gear.teeth = 2: must be a whole number from 3 to 2000",
    "table.csv row 4 column E (steep): gear.helix_angle = 95 deg: must be a number at least -75 deg and at most 75 deg",
]

COUNT = r"\d+ rows ok, \d+ failed(, \d+ not run)? in \d+\.\d s \(\S+ rows/s\)"
"""The last line on stderr."""


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def batch(*arguments: str, status: int = 0) -> Result:
    """Run in-process in the current folder; checks the exit status and that no traceback shows."""
    result = run("batch", *arguments, status=status)
    assert "Traceback" not in result.output
    return result


def test_results_are_on_stdout_and_the_rest_on_stderr() -> None:
    write_table(Path("table.csv"), GEARS)
    result = batch("table.csv", "--do", "data", "-j", "1")
    assert result.stdout.splitlines() == [f"output/table/{name}" for name in ("results.csv", "columns.csv", "results.parquet")]
    assert all(Path(line).is_file() for line in result.stdout.splitlines())
    job, count = result.stderr.splitlines()
    assert re.fullmatch(r"making: 3 of 3 rows, 0 failed, \S+ rows/s", job)
    assert re.fullmatch(COUNT, count) and count.startswith("3 rows ok, 0 failed in ")


def test_default_is_step_and_stl_in_a_folder_named_after_the_table() -> None:
    write_table(Path("small gears.csv"), GEARS[:2])
    batch("small gears.csv", "-j", "1", "--quiet")
    files = {path.name for path in Path("output/small gears/spur").iterdir()}
    assert files == {"data.json", "gear.step", "gear.stl", "manifest.json"}


def test_quiet_prints_the_results_only() -> None:
    write_table(Path("table.csv"), GEARS)
    result = batch("table.csv", "--do", "data", "-j", "1", "--quiet", "-o", "elsewhere")
    assert (result.stdout, result.stderr) == ("elsewhere/results.csv\nelsewhere/columns.csv\nelsewhere/results.parquet\n", "")


def test_json_is_one_document() -> None:
    write_table(Path("table.csv"), BAD)
    result = batch("table.csv", "--do", "data", "-j", "1", "--json", "--keep-going", status=1)
    assert json.loads(result.stdout) == {
        "kind": "batch",
        "gearcad": gearcad.__version__,
        "results": [f"output/table/{name}" for name in ("results.csv", "columns.csv", "results.parquet")],
        "ok": 1,
        "failed": 2,
        "not_run": 0,
        "short": 0,
        "errors": BAD_LINES,
        "passed": False,
        "strength": None,
        "not_judged": [],
        "warnings": [],
    }


def test_faults_are_all_told_before_anything_is_made() -> None:
    write_table(Path("table.csv"), BAD)
    result = batch("table.csv", "--do", "data", status=2)
    assert (result.stdout, result.stderr.splitlines()) == ("", [f"Error: {line}" for line in BAD_LINES])
    assert [path.name for path in Path().iterdir()] == ["table.csv"]


def test_keep_going_makes_the_good_rows_and_ends_with_1() -> None:
    write_table(Path("table.csv"), BAD)
    result = batch("table.csv", "--do", "data", "-j", "1", "--keep-going", status=1)
    *_, first, second, count = result.stderr.splitlines()
    assert [first, second] == [f"Error: {line}" for line in BAD_LINES]
    assert count.startswith("1 rows ok, 2 failed in ")
    assert [line["status"] for line in read_results(Path("output/table"))] == ["ok", "failed", "failed"]
    assert (
        batch("table.csv", "--do", "data", "-j", "1", "--keep-going", "--quiet", status=1).stderr
        == f"Error: {BAD_LINES[0]}\nError: {BAD_LINES[1]}\n"
    )


MANY_FAULTS = {
    "good,2.5,28,80,13,0.107,18.3,0.08,0.48,44,-0.378,15.1,220": None,
    ",2,,,13,,10,,,44,,10,": "column A: name = '': must be a plain file name",
    "../x,2,,,20,,10,,,44,,10,": "column A (../x): name = '../x': must be a plain file name, without / ",
    "Good,2,,,20,,10,,,44,,10,": "column A (Good): name = 'Good': must be unique, for it names a folder; row 2 has 'good'",
    "half,2,,,20.5,,10,,,44,,10,": "column E (half): pinion.teeth = 20.5: must be a whole number from 3 to 2000",
    "text,2,,,20,,wide,,,44,,10,": "column G (text): pinion.face_width = 'wide': must be a number above 0 mm",
    "negative,2,,,20,,10,,,44,,-3,": "column L (negative): wheel.face_width = -3 mm: must be a number above 0 mm",
    "missing,2,,,20,,10,,,,,10,": "column J (missing): wheel.teeth is missing: must be a whole number from 3 to 2000",
    "steep,2,80,,20,,10,,,44,,10,": "column C (steep): pair.helix_angle = 80 deg: must be a number at least -75 deg",
    "tight,2,,60,20,auto,10,,,44,,10,": "column D (tight): pair.centre_distance = 60 mm: must be above 60.1",
    "overlap,2,,63,20,0,10,,,44,0,10,": "column D (overlap): pair.centre_distance = 63 mm: must be at least 64",
    "round,2,,,20,,10,,0.6,44,,10,": "column I (round): pinion.rack.root_radius = 0.6: must be at most 0.47",
    "pointed,2,,,20,2,10,,,44,,10,": "(pointed): pinion.tip_diameter = 50.82574989 mm (derived): must be at most 50.51",
    "still,2,,,20,,10,,,44,,10,nan": "column M (still): load.torque = 'nan': must be a number",
}
"""Rows, and the message about each but the first."""


def test_each_kind_of_wrong_row_has_its_message() -> None:
    heading = "name,normal_module,helix_angle,centre_distance,pinion.teeth,pinion.profile_shift,pinion.face_width,"
    heading += "pinion.tooth_thinning,pinion.rack.root_radius,wheel.teeth,wheel.profile_shift,wheel.face_width,load.torque"
    write_table(Path("pairs.csv"), (heading, *MANY_FAULTS))
    result = batch("pairs.csv", status=2)
    expected = [f"Error: pairs.csv row {row} {text}" for row, text in enumerate(MANY_FAULTS.values(), 2) if text]
    lines = result.stderr.splitlines()
    assert [line[: len(text)] for line, text in zip(lines, expected, strict=True)] == expected
    assert len(lines) == 13 and not Path("output").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere.csv"], "nowhere.csv: cannot be read (No such file or directory)"),
        (["table.csv", "--do", "data,print"], "do = 'print': must be one of 'data', 'build'"),
        (
            ["table.csv", "--format", "step,iges"],
            "format = 'iges': must be one of 'step', 'stl', ",
        ),
        (["table.csv", "--chord-error", "0"], "chord_error = 0 mm: must be a number above 0 mm"),
        (["table.csv", "-j", "0"], "jobs = 0: must be a whole number from 1 to 1024"),
        (["table.csv", "--time-limit", "-1"], "time_limit = -1 s: must be a number above 0 s"),
        (["table.csv", "-j", "two"], "Invalid value for '-j' / '--jobs': 'two' is not a valid integer"),
        ([], "Missing argument 'TABLE'"),
        (["empty.csv"], "empty.csv: has no heading; `gearcad new pairs` makes a table that has one"),
        (["bare.csv"], "bare.csv: has a heading but no design; add a row with a name for each gear or pair"),
        (["wrong.csv"], "wrong.csv row 1 column B: teehts: unknown column; did you mean gear.teeth?"),
        (["."], ".: cannot be read (Is a directory)"),
    ],
)
def test_what_cannot_be_run_is_one_line_with_status_2_and_leaves_nothing(arguments: list[str], message: str) -> None:
    for name, lines in (("table", GEARS), ("empty", ()), ("bare", GEARS[:1]), ("wrong", ("name,teehts", "a,20"))):
        write_table(Path(f"{name}.csv"), lines)
    result = batch(*arguments, status=2)
    assert result.stderr.startswith(f"Error: {message}") and result.stderr.count("\n") == 1
    assert result.stdout == "" and not Path("output").exists()


@pytest.mark.parametrize("kind", ["pairs", "gears"])
def test_templates_are_made_without_a_fault(kind: str) -> None:
    result = batch(str(TEMPLATES / f"{kind}.csv"), "--do", "data", "-j", "1", "--json")
    document = json.loads(result.stdout)
    assert document["ok"] >= 5 and (document["failed"], document["errors"]) == (0, [])
    assert Path(document["results"][0]) == Path(f"output/{kind}/results.csv")


# ---------------------------------------------------------------------- as a process


def test_status_of_the_process() -> None:
    """Of runs without a fault it is 0, as wherever one is run."""
    write_table(Path("table.csv"), BAD)
    for options, status in ((("--keep-going",), 1), ((), 2)):
        assert run_batch("table.csv", "--do", "data", "-j", "1", "--quiet", *options).returncode == status


def test_progress_is_a_line_now_and_then_without_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    from gearcad.cli import job

    monkeypatch.setattr(job, "_SECONDS_BETWEEN_LINES", 0.0)
    write_table(Path("table.csv"), (*GEARS, *(f"row {n},{20 + n},1,2," for n in range(57))))
    lines = batch("table.csv", "--do", "data", "-j", "1").stderr.splitlines()
    checking = [line for line in lines if line.startswith("checking: ")]
    making = [line for line in lines if line.startswith("making: ")]
    assert [re.match(r"checking: (\d+) rows, 0 failed, \S+ rows/s$", line)[1] for line in checking] == ["50", "60"]
    assert [line.split()[1] for line in making] == [str(done) for done in range(61)]
    assert all(re.fullmatch(r"making: \d+ of 60 rows, 0 failed, \S+ rows/s(, \d+ s left)?", line) for line in making)


def on_a_terminal(*arguments: str) -> tuple[int, str]:
    """Exit status, and what a terminal shows of stderr."""
    import pty

    ours, theirs = pty.openpty()
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "120", "NO_COLOR": "1"}
    with subprocess.Popen(batch_command(*arguments), stderr=theirs, stdout=subprocess.DEVNULL, env=environment) as process:
        os.close(theirs)
        shown = b""
        while select.select([ours], [], [], PATIENCE)[0]:
            try:
                shown += os.read(ours, 65536)
            except OSError:  # Linux says so at the end
                break
    os.close(ours)
    return process.returncode, shown.decode()


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminal")
def test_progress_on_a_terminal_is_a_bar_with_rows_failures_and_rate() -> None:
    write_table(Path("table.csv"), (*BAD, *(f"row {n},{20 + n},1,2," for n in range(40))))
    status, shown = on_a_terminal("table.csv", "--format", "csv", "-j", "1", "--keep-going")
    assert status == 1
    assert "making" in shown and "43/43" in shown and "2 failed" in shown and "rows/s" in shown
    assert "41 rows ok, 2 failed in " in shown and "Traceback" not in shown


def test_command_imports_nothing_heavy() -> None:
    """Workers do; the parent stays small and starts at once."""
    write_table(Path("table.csv"), GEARS)
    heavy = ["scipy", "cadquery", "OCP", "trimesh", "ezdxf", "matplotlib", "gmsh", "skfem", "distributed"]
    code = f"""
import sys
from gearcad.cli import main
main(['batch', 'table.csv', '--format', 'stl,csv', '--quiet'], standalone_mode=False)
print([name for name in {heavy} if name in sys.modules], file=sys.stderr)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE)
    assert done.stderr == "[]\n"


def test_workbook_gives_what_the_csv_gives() -> None:
    openpyxl = pytest.importorskip("openpyxl")
    write_table(Path("table.csv"), GEARS)
    book = openpyxl.Workbook()
    for row in csv.reader(GEARS):
        book.active.append([float(cell) if re.fullmatch(r"-?[\d.]+", cell) else cell or None for cell in row])
    book.save("table.xlsx")
    batch("table.csv", "--format", "csv", "-j", "1", "--quiet", "-o", "one")
    batch("table.xlsx", "--format", "csv", "-j", "1", "--quiet", "-o", "other")
    assert [line | {"seconds": ""} for line in read_results(Path("one"))] == [
        line | {"seconds": ""} for line in read_results(Path("other"))
    ]
    assert Path("one/left/manifest.json").read_bytes() == Path("other/left/manifest.json").read_bytes()


def test_help_names_the_command_among_the_others() -> None:
    text = invoke("--help").stdout
    assert text.index("  build ") < text.index("  batch ")
    text = invoke("batch", "--help").stdout
    for word in ("TABLE", "--jobs", "--do", "--format", "--time-limit", "--fresh", "--keep-going", "--cluster", "--json"):
        assert word in text

"""`gearcad verify`: specs, tables, baselines, evidence, and what it says of wrong input."""

import csv
import json
import shutil
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main

SPEC = """[pair]
name = "small"
normal_module = 2.0
helix_angle = 12.0
tooth_thinning = 0.03
face_width = 10.0

[pinion]
teeth = 12
profile_shift = 0.2
body.bore = 8.0

[wheel]
teeth = 17

[drawing]
owner = "Example AB"
technical_reference = "Gearbox 7"
creator = "A. Person"
revision = "C"
"""
TABLE = """name,gear.teeth,gear.normal_module,gear.face_width,gear.body.bore
one,12,2,8,6
two,13,2,8,0
"""


def run(*arguments: object) -> Result:
    return CliRunner().invoke(main, ["verify", *map(str, arguments)])


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a verified pair; its spec lies beside it."""
    folder = tmp_path_factory.mktemp("verified")
    (folder / "small.toml").write_text(SPEC)
    told = run(folder / "small.toml", "-o", folder / "out", "--junit", folder / "tests" / "junit.xml", "--quiet")
    assert told.exit_code == 0, told.output
    assert "FAILED" not in told.output
    return folder


def test_document_has_the_promised_keys(made: Path) -> None:
    document = json.loads((made / "out" / "verify.json").read_text())
    assert document["kind"] == "verify" and document["passed"] is True and document["strength"] is None
    assert {"STEP", "STL", "3MF", "GLB", "DXF", "geometry"} <= {claim["claim"] for claim in document["claims"]}
    wanted = {"claim", "level", "quantity", "computed", "reference", "deviation", "permitted", "judge", "passed", "seconds"}
    assert all(wanted <= set(claim) for claim in document["claims"])
    assert document["spec"]["pair"]["centre_distance"] > 0
    names = {path.name for path in (made / "out").iterdir()}
    assert set(document["files"]) == names - {"verify.json", "verify.html", "verify.pdf"}
    assert all(len(digest) == 64 for digest in document["files"].values())


def test_page_and_pdf_have_the_heading(made: Path) -> None:
    page = (made / "out" / "verify.html").read_text()
    for text in ("Example AB", "Gearbox 7", "A. Person", "revision C", "All claims passed"):
        assert text in page
    assert (made / "out" / "verify.pdf").read_bytes().startswith(b"%PDF-")


def test_junit_has_a_case_for_each_claim(made: Path) -> None:
    document = json.loads((made / "out" / "verify.json").read_text())
    root = ElementTree.fromstring((made / "tests" / "junit.xml").read_text())
    (suite,) = root.findall("testsuite")
    verdicts = [claim["passed"] for claim in document["claims"]]
    assert len(suite.findall("testcase")) == len(verdicts) == int(suite.get("tests", 0))
    assert len(suite.findall("testcase/skipped")) == verdicts.count(None) == int(suite.get("skipped", 0))
    assert suite.findall("testcase/failure") == []


def test_files_that_somebody_has_changed_fail(made: Path, tmp_path: Path) -> None:
    delivered = tmp_path / "delivered"
    delivered.mkdir()
    for path in (made / "out").iterdir():
        (delivered / path.name).write_bytes(path.read_bytes())
    told = run(made / "small.toml", "-o", tmp_path / "good", "--files", delivered, "--quiet")
    assert told.exit_code == 0, told.output
    assert sorted(path.name for path in (tmp_path / "good").iterdir()) == ["verify.html", "verify.json", "verify.pdf"]
    content = bytearray((delivered / "pinion.stl").read_bytes())
    content[84 + 12 : 84 + 16] = b"\x00\x00\x80\x3f"  # x of a corner becomes 1 mm
    (delivered / "pinion.stl").write_bytes(bytes(content))
    (delivered / "wheel.step").unlink()
    told = run(made / "small.toml", "-o", tmp_path / "bad", "--files", delivered, "--quiet")
    assert told.exit_code == 1
    assert "FAILED STL, pinion.stl" in told.output and "no file wheel.step" in told.output
    assert json.loads((tmp_path / "bad" / "verify.json").read_text())["passed"] is False
    assert "Claims FAILED" in (tmp_path / "bad" / "verify.html").read_text()


def test_baseline_tells_what_moved_the_greatest_first(made: Path, tmp_path: Path) -> None:
    spec = tmp_path / "small.toml"
    spec.write_text(SPEC)
    told = run(spec, "-o", tmp_path / "same", "--baseline", made / "out", "--quiet")
    assert (told.exit_code, "Moved" in told.output) == (0, False), told.output
    spec.write_text(SPEC.replace("profile_shift = 0.2", "profile_shift = 0.4"))
    told = run(spec, "-o", tmp_path / "moved", "--baseline", made / "out", "--quiet")
    assert told.exit_code == 1
    assert any(line.startswith("Moved: small: spec.pinion.") for line in told.output.splitlines())
    changes = [line.rpartition("(")[2].rstrip(" %)") for line in told.output.splitlines() if line.startswith("Moved: small")]
    sizes = [float("inf") if change == "changed" else abs(float(change)) for change in changes]
    assert sizes == sorted(sizes, reverse=True)


def test_tolerance_of_the_spec_holds_and_the_option_wins(tmp_path: Path) -> None:
    """A face width that is 0.001 % less: volumes move by as much, which 0.01 % permits and 0.0001 % does not."""
    spec = tmp_path / "gear.toml"
    wide = "[gear]\nteeth = 12\nnormal_module = 2.0\nface_width = 10.0\n"
    narrower = wide.replace("10.0", "9.9999")
    spec.write_text(wide)
    assert run(spec, "-o", tmp_path / "baseline", "--quiet").exit_code == 0

    def moved(text: str, *options: str) -> list[str]:
        spec.write_text(text)
        told = run(spec, "-o", tmp_path / "out", "--baseline", tmp_path / "baseline", "--quiet", *options)
        found = [line for line in told.output.splitlines() if line.startswith("Moved")]
        assert told.exit_code == bool(found), told.output
        return found

    assert any("STEP: gear.step: volume" in line for line in moved(narrower))
    assert moved(f"{narrower}\n[verify]\ntolerance = 1e-4\n") == []
    assert moved(f"{narrower}\n[verify]\ntolerance = 1e-4\n", "--tolerance", "1e-6")
    assert moved(f"{narrower}\n[verify]\ntolerance = 1e-6\n", "--tolerance", "1e-4") == []


def test_level_of_the_spec_holds_and_the_option_wins(tmp_path: Path) -> None:
    spec = tmp_path / "gear.toml"
    spec.write_text('[gear]\nteeth = 20\nnormal_module = 2.0\nface_width = 10.0\n[verify]\nlevel = "strength"\n')
    for options, level in (((), "strength"), (("--level", "files"), "files")):
        assert run(spec, "-o", tmp_path / "out", "--quiet", *options).exit_code == 0
        assert json.loads((tmp_path / "out" / "verify.json").read_text())["level"] == level


@pytest.mark.usefixtures("kept_workers")
def test_each_row_has_the_tolerance_of_its_column(tmp_path: Path) -> None:
    heading, one, two = TABLE.splitlines()
    path = tmp_path / "gears.csv"

    def moved(width: str, *options: object) -> set[str]:
        rows = (f"{line.replace(',8,', f',{width},')},{tolerance}" for line, tolerance in ((one, "1e-3"), (two, "1e-6")))
        path.write_text("\n".join((f"{heading},verify.tolerance", *rows, "")))
        told = run(path, "-o", tmp_path / width, "-j", 1, "--quiet", *options)
        return {line.split(": ")[1] for line in told.output.splitlines() if line.startswith("Moved: ")}

    assert moved("8") == set()
    assert moved("8.001", "--baseline", tmp_path / "8") == {"two"}
    assert moved("8.001", "--baseline", tmp_path / "8" / "results.csv") == {"two"}
    assert moved("8.001", "--baseline", tmp_path / "8", "--tolerance", "1e-3") == set()


@pytest.fixture(scope="module")
def table(kept_workers: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("table")
    (folder / "gears.csv").write_text(TABLE)
    told = run(folder / "gears.csv", "-o", folder / "out", "-j", 1, "--quiet")
    assert told.exit_code == 0, told.output
    return folder


def test_a_table_has_an_index_and_a_page_for_each_row(table: Path) -> None:
    index = (table / "out" / "index.html").read_text()
    for name in ("one", "two"):
        assert f'href="{name}/verify.html"' in index
        assert (table / "out" / name / "verify.pdf").is_file()
        assert not list((table / "out" / name).glob("*.step"))
    assert len(ElementTree.fromstring((table / "out" / "junit.xml").read_text()).findall("testsuite")) == 2
    rows = list(csv.DictReader((table / "out" / "results.csv").read_text(encoding="utf-8-sig").splitlines()))
    assert [row["verify.passed"] for row in rows] == ["true", "true"]
    assert any(key.startswith("verify.STEP: gear.step: volume") for key in rows[0])


@pytest.mark.usefixtures("kept_workers")
def test_the_index_has_the_rows_of_the_table_alone(table: Path, tmp_path: Path) -> None:
    """A row that is gone, and one that is wrong now, have pages of a former run."""
    out = tmp_path / "out"
    shutil.copytree(table / "out", out)
    (tmp_path / "gears.csv").write_text(TABLE.replace("two,13,2,8,0", "two,13,2,-8,0\nthree,14,2,8,0").replace("one,", "uno,"))
    told = run(tmp_path / "gears.csv", "-o", out, "-j", 1, "--quiet")
    assert told.exit_code == 1
    index, root = (out / "index.html").read_text(), ElementTree.fromstring((out / "junit.xml").read_text())
    assert [name in index for name in ("uno/verify.html", "three/verify.html", "one/verify.html", "two/verify.html")] == [
        True,
        True,
        False,
        False,
    ]
    assert [suite.get("name") for suite in root] == ["three", "uno", "rows"]


@pytest.mark.usefixtures("kept_workers")
def test_results_of_a_table_are_a_baseline(table: Path) -> None:
    baseline = table / "baseline.csv"
    baseline.write_bytes((table / "out" / "results.csv").read_bytes())
    told = run(table / "gears.csv", "-o", table / "out", "-j", 1, "--quiet", "--baseline", baseline)
    assert (told.exit_code, "Moved" in told.output) == (0, False), told.output
    baseline.write_text(baseline.read_text().replace("\none,", "\nuno,"))
    told = run(table / "gears.csv", "-o", table / "out", "-j", 1, "--quiet", "--baseline", baseline)
    assert told.exit_code == 1
    assert "Moved: one: design: nothing -> one" in told.output and "Moved: uno: design: uno -> nothing" in told.output


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--level", "most"), "level = 'most': must be one of 'files', 'strength', 'full'"),
        (("--tolerance", "2"), "tolerance = 2: must be a number at least 0 and at most 0.999"),
        (("--baseline", "nowhere"), "baseline = 'nowhere': must be a folder of an earlier run, or its results.csv"),
        (("--files", "nowhere"), "files = 'nowhere': must be a folder with the files of the design"),
        (("-j", "2"), "jobs = 2: needs a design table: a spec is one design"),
    ],
)
def test_wrong_input_is_one_line(tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    (tmp_path / "small.toml").write_text(SPEC)
    told = run(tmp_path / "small.toml", "-o", tmp_path / "out", *arguments)
    assert (told.exit_code, told.output.strip()) == (2, f"Error: {message}")
    assert not (tmp_path / "out").exists()

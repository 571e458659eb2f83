"""`gearcad draw`: sheets of a spec as files, what the screen says of them, and the same in tables."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from support.written_sheet import read_sheet

import gearcad
from gearcad import Gear, ParameterError
from gearcad.cli import main
from gearcad.designs import read_spec
from gearcad.designs.reader import starter_text
from gearcad.jobs.draw import Draw

STARTERS = (
    *("volvo-13-44", "alm-18-161", "double-23-81", "fzg-c", "planetary-24-21-66", "planetary-alm", "planetary-differential"),
    *("rack", "reducer-21-43", "ring-22-70", "spur", "uhlir-19-23"),
)


def _spec(name: str, folder: Path) -> Path:
    file, text = starter_text(name)
    (folder / file).write_text(text, encoding="utf-8")
    return folder / file


def _draw(spec: Path, *options: str) -> Result:
    return CliRunner().invoke(main, ["draw", str(spec), "-o", str(spec.parent / "out"), *options])


def test_a_gear_is_drawn(tmp_path: Path) -> None:
    """Files, a line a sheet, and numbers that are those of the data sheet."""
    spec = _spec("spur", tmp_path)
    spec.write_text(
        spec.read_text(encoding="utf-8") + '\n[drawing]\nnumber = "GC-7"\nlanguage = "sv"\nsheet = "A2"\n', encoding="utf-8"
    )
    result = _draw(spec, "--language", "de", "--sheet", "a3")
    assert result.exit_code == 0, result.output
    names = ["drawing.dxf", "drawing.svg", "drawing.pdf", "draw.json"]
    lines = result.stdout.splitlines()
    assert lines[0].split()[:3] == ["gear", "A3", "2:1"]
    assert [Path(line).name for line in lines[-4:]] == names
    document = json.loads((tmp_path / "out" / "draw.json").read_text(encoding="utf-8"))
    (of_gear,) = document["sheets"]
    assert (document["kind"], of_gear["number"], of_gear["size"], of_gear["files"]) == ("draw", "GC-7", "A3", names[:3])
    sheet = read_sheet(tmp_path / "out" / "drawing.dxf")
    assert sheet.faults == []
    assert {"GC-7", "A3", "Normalmodul"} <= set(sheet.words)
    assert read_spec(spec).gears["gear"].tip_diameter in of_gear["numbers"].values()


def test_wrong_options_are_told(tmp_path: Path) -> None:
    spec = _spec("spur", tmp_path)
    for options, told in (
        (("--scale", "1:3"), "Error: scale = '1:3': must be \"auto\" or a scale of ISO 5455"),
        (("--sheet", "B4"), "Error: sheet = 'B4': must be one of"),
        (("--language", "fi"), "Error: language = 'fi': must be one of 'en', 'de', 'sv'"),
        (("--format", "dwg"), "Error: format = 'dwg': must be one of 'dxf', 'svg', 'pdf'"),
        (("--sheet", "A4", "--scale", "5:1"), "Error: "),
    ):
        result = _draw(spec, *options)
        assert result.exit_code == 2 and result.stderr.startswith(told) and result.stderr.count("\n") == 1, result.stderr
    assert not (tmp_path / "out").exists()
    with pytest.raises(ParameterError, match="colour = 'red': is not an option of drawings"):
        Draw(given={"colour": "red"})
    with pytest.raises(ParameterError, match=r"formats = \[\]: must be a list of formats"):
        Draw(formats=[])  # type: ignore[arg-type]


def test_a_train_of_pairs_is_told_all_that_can_be_drawn(tmp_path: Path) -> None:
    result = _draw(_spec("train-pairs", tmp_path))
    kinds = "a gear, a pair, a rack, a rack and pinion or a planetary train"
    assert result.exit_code == 2 and f"must be {kinds}: `gearcad dynamics` writes the specs of the pairs" in result.stderr


def test_a_pair_has_a_sheet_for_each_gear_and_one_for_both(tmp_path: Path) -> None:
    job = Draw(formats=["dxf", "pdf"])  # type: ignore[arg-type]
    drawing = job.run(read_spec(_spec("fzg-c", tmp_path)))
    names = [file.name for file in job.write(drawing, tmp_path / "out")]
    parts = ("assembly", "pinion", "wheel")
    assert names == [*(f"drawing-{part}.{end}" for part in parts for end in ("dxf", "pdf")), "drawing.pdf", "draw.json"]
    assert (tmp_path / "out" / "drawing.pdf").read_bytes().count(b"/Type /Page\n") == 3
    assert read_sheet(tmp_path / "out" / "drawing-assembly.dxf").faults == []
    assert {job.part_of(name) for name in names} == {"draw"}


def test_a_train_has_a_sheet_for_each_gear_that_differs(tmp_path: Path) -> None:
    from gearcad.jobs.draw import drawn_gears

    assert [gear.role for gear in drawn_gears(read_spec(_spec("planetary-24-21-66", tmp_path)))] == ["sun", "ring", "planet"]
    found = {gear.role: gear for gear in drawn_gears(read_spec(_spec("planetary-alm", tmp_path)))}
    assert list(found) == ["ring_4", "ring_5", "rim_3", "rim_3p", "pinion_1", "gear_2"]
    assert [mate.name for mate in found["rim_3"].mates] == ["ring_4"]


@pytest.mark.long
def test_rows_of_tables_are_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("table.csv").write_text("name,teeth,normal_module,face_width,drawing.number\none,20,2,20,GC-9\n", encoding="utf-8")
    result = CliRunner().invoke(main, ["batch", "table.csv", "--do", "draw", "-j", "1"])
    assert result.exit_code == 0, result.output
    folder = tmp_path / "output" / "table" / "one"
    assert {"drawing.dxf", "drawing.svg", "drawing.pdf", "draw.json"} <= {file.name for file in folder.iterdir()}
    assert "GC-9" in read_sheet(folder / "drawing.dxf").words


@pytest.mark.long
@pytest.mark.parametrize("language", ["en", "de", "sv"])
@pytest.mark.parametrize("name", STARTERS)
def test_nothing_overlaps_on_the_sheets_of_starters(name: str, language: str, tmp_path: Path) -> None:
    job = Draw(given={"language": language})
    drawing = job.run(read_spec(_spec(name, tmp_path)))
    files = job.write(drawing, tmp_path / "out")
    assert {file.name: read_sheet(file).faults for file in files if file.suffix == ".dxf" and read_sheet(file).faults} == {}


def test_python_draws_too() -> None:
    drawing = gearcad.draw(Gear(teeth=20, normal_module=2, face_width=20), language="de", scale="1:1")
    (sheet,) = drawing.sheets
    assert (sheet.name, sheet.scale) == ("gear", 1.0)

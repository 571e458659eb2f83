"""A second run makes what is missing or changed, and nothing else; what it finds there is believed only if it is whole."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from support import jobs
from support.batches import GEARS, PAIRS, lies, made_now, read_results, snapshot, times, write_table
from support.commands import read_json

from gearcad.batch import BatchSummary, run_table
from gearcad.batch import run as run_module
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data, Job
from gearcad.solids import FileOptions, Format

pytestmark = pytest.mark.usefixtures("kept_workers")

POINTS = (Build(formats=(Format.CSV,)),)
DATA = (Data(),)


def make(
    folder: Path, lines: tuple[str, ...] = GEARS, wanted: tuple[Job[Any, Any], ...] = POINTS, **options: Any
) -> BatchSummary:
    summary = run_table(write_table(folder / "table.csv", lines), folder / "out", wanted, jobs=1, **options)
    assert lies(folder / "out") == []
    return summary


def files_of(folder: Path, name: str) -> set[str]:
    return {path.name for path in (folder / "out" / name).iterdir()}


@pytest.fixture(scope="module")
def first_run(kept_workers: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("first")
    assert make(folder).ok == 3
    assert made_now(folder / "out") == ["spur", "left", "right"]
    return folder


@pytest.fixture
def made(first_run: Path, tmp_path: Path) -> Path:
    """Three gears with their points, made by a first run."""
    return Path(shutil.copytree(first_run, tmp_path, dirs_exist_ok=True))


def test_second_run_makes_nothing_and_tells_the_same(made: Path) -> None:
    before, files = snapshot(made / "out"), times(made / "out")
    summary = make(made)
    assert (summary.ok, summary.failed, summary.not_run) == (3, 0, 0)
    assert made_now(made / "out") == []
    assert (snapshot(made / "out"), times(made / "out")) == (before, files)


CHANGES = {
    "another value": ("left,17,1,3,-15", "left,17,1,3.5,-15"),
    "a cell that was blank": ("spur,12,1,2,", "spur,12,1,2,5"),
    "a cell that is blank now": ("left,17,1,3,-15", "left,17,1,3,"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_changed_row_is_made_again_and_no_other(change: str, made: Path) -> None:
    old, new = CHANGES[change]
    files = times(made / "out")
    lines = tuple(new if line == old else line for line in GEARS)
    assert lines != GEARS
    make(made, lines)
    name = old.partition(",")[0]
    assert made_now(made / "out") == [name]
    assert {path.partition("/")[0] for path, when in times(made / "out").items() if files[path] != when} == {name}
    fresh = made / "fresh"
    fresh.mkdir()
    make(fresh, lines)
    assert snapshot(made / "out") == snapshot(fresh / "out")


def test_columns_and_rows_may_change_places(made: Path) -> None:
    heading = GEARS[0].split(",")
    turned = tuple(",".join(reversed(line.split(","))) for line in (GEARS[0], *reversed(GEARS[1:])))
    assert turned[0].split(",") == heading[::-1]
    make(made, turned)
    assert made_now(made / "out") == []
    assert [line["name"] for line in read_results(made / "out")] == ["right", "left", "spur"]


def test_files_of_a_row_that_is_now_another_thing_vanish(tmp_path: Path) -> None:
    """A pair becomes a gear: pinion and wheel go."""
    heading = "name,gear.teeth,gear.normal_module,gear.face_width,pair.normal_module,pinion.teeth,wheel.teeth,"
    heading += "pinion.face_width,wheel.face_width"
    make(tmp_path, (heading, "x,,,,1,17,20,2,2", "y,20,1,2,,,,,"))
    assert files_of(tmp_path, "x") == {"data.json", "manifest.json", "pinion.csv", "wheel.csv"}
    make(tmp_path, (heading, "x,25,1,2,,,,,", "y,20,1,2,,,,,"))
    assert files_of(tmp_path, "x") == {"data.json", "manifest.json", "gear.csv"}
    assert made_now(tmp_path / "out") == ["x"]


def test_row_taken_out_of_the_table_keeps_its_folder(made: Path) -> None:
    make(made, GEARS[:3])
    assert [line["name"] for line in read_results(made / "out")] == ["spur", "left"]
    assert files_of(made, "right") == {"data.json", "gear.csv", "manifest.json"}


def test_folder_with_another_name_is_not_taken_for_the_row(made: Path) -> None:
    """The name stands in the files too."""
    (made / "out" / "spur").rename(made / "out" / "other")
    make(made, (GEARS[0], GEARS[1].replace("spur", "other")))
    assert made_now(made / "out") == ["other"]
    assert read_json(made / "out" / "other" / "data.json")["name"] == "other"


# ---------------------------------------------------------------------- damage


DAMAGES: dict[str, Callable[[Path], Any]] = {
    "gone": Path.unlink,
    "torn": lambda path: path.write_bytes(path.read_bytes()[:-1]),
    "half": lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
    "empty": lambda path: path.write_bytes(b""),
}


def test_damaged_file_is_made_again(tmp_path: Path) -> None:
    """Each damage to each kind of file, in a row of its own; a manifest without its last byte, a new line, is whole."""
    damages = [(file, how) for file in ("gear.csv", "data.json") for how in DAMAGES]
    damages += [("manifest.json", how) for how in ("gone", "half", "empty")]
    names = [f"{how} {file}" for file, how in damages]
    lines = (GEARS[0], "whole,25,1,2,", *(f"{name},{12 + n},1,2," for n, name in enumerate(names)))
    make(tmp_path, lines)
    before = snapshot(tmp_path / "out")
    for name, (file, how) in zip(names, damages, strict=True):
        DAMAGES[how](tmp_path / "out" / name / file)
    make(tmp_path, lines)
    assert made_now(tmp_path / "out") == names
    assert snapshot(tmp_path / "out") == before


def test_users_own_files_survive_every_kind_of_run(made: Path) -> None:
    own = {"notes.txt": "mine", "gear.dat": "mine too", ".hidden": "", "sub/deep.txt": "below"}
    for name, text in own.items():
        path = made / "out" / "left" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    (made / "out" / "README").write_text("about these gears")
    changed = (*GEARS[:2], "left,18,1,3,-15", GEARS[3])
    for lines, wanted, fresh in (
        (GEARS, POINTS, True),
        (changed, POINTS, False),
        (GEARS, (Build(formats=(Format.DXF,)),), False),
        (changed, DATA, False),
    ):
        make(made, lines, wanted, fresh=fresh)
        assert {name: (made / "out" / "left" / name).read_text() for name in own} == own
    assert (made / "out" / "README").read_text() == "about these gears"


def test_row_that_was_damaged_and_fails_is_told(made: Path) -> None:
    """A folder in the place of a file cannot be replaced."""
    (made / "out" / "left" / "gear.csv").unlink()
    (made / "out" / "left" / "gear.csv" / "sub").mkdir(parents=True)
    for _ in range(2):
        summary = make(made)
        place = f"{made / 'table.csv'} row 3 (left): output = '{made / 'out' / 'left'}': cannot be written (Is a directory)"
        assert [error.startswith(place) for error in summary.errors] == [True]
        assert (summary.ok, summary.failed) == (2, 1)
    (made / "out" / "left" / "gear.csv" / "sub").rmdir()
    (made / "out" / "left" / "gear.csv").rmdir()
    assert make(made).failed == 0


# ---------------------------------------------------------------------- other options


def test_another_format_is_added_and_nothing_else_is_touched(made: Path) -> None:
    points = {path: when for path, when in times(made / "out").items() if path.endswith("gear.csv")}
    make(made, wanted=(Build(formats=(Format.DXF,)),))
    assert files_of(made, "left") == {"data.json", "gear.csv", "gear.dxf", "manifest.json"}
    assert {path: times(made / "out")[path] for path in points} == points
    assert "files.gear.csv" not in read_results(made / "out")[0]
    make(made, wanted=(Build(formats=(Format.DXF, Format.CSV)),))
    assert made_now(made / "out") == []
    assert {key for key in read_results(made / "out")[0] if key.startswith("files.")} == {
        "files.data.json", "files.gear.dxf", "files.gear.csv",
    }  # fmt: skip


def test_chord_error_makes_the_facets_again_and_nothing_else(tmp_path: Path) -> None:
    both = (Format.STL, Format.CSV)
    make(tmp_path, GEARS[:3], (Build(formats=both),))
    before, old = snapshot(tmp_path / "out"), times(tmp_path / "out")
    make(tmp_path, GEARS[:3], (Build(formats=both, options=FileOptions(chord_error=0.02)),))
    assert made_now(tmp_path / "out") == ["spur", "left"]
    new = times(tmp_path / "out")
    again = {path.partition("/")[2] for path in old if old[path] != new[path]}
    assert again == {"gear.stl", "data.json", "manifest.json"}  # the data come with every build
    assert snapshot(tmp_path / "out")["left/gear.stl"] != before["left/gear.stl"]
    assert snapshot(tmp_path / "out")["left/data.json"] == before["left/data.json"]
    make(tmp_path, GEARS[:3], (Build(formats=both),))
    assert snapshot(tmp_path / "out") == before


def test_bracket_makes_the_step_files_again(tmp_path: Path) -> None:
    lines = (PAIRS[0] + ",pinion.body.bore,wheel.body.bore", PAIRS[1] + ",4,6")
    make(tmp_path, lines, (Build(formats=(Format.STEP, Format.CSV)),))
    before = times(tmp_path / "out")
    make(tmp_path, lines, (Build(formats=(Format.STEP, Format.CSV), options=FileOptions(bracket=True)),))
    after = times(tmp_path / "out")
    changed = {path.partition("/")[2] for path in before if before[path] != after[path]}
    assert changed == {"assembly.step", "pinion.step", "wheel.step", "data.json", "manifest.json"}


def test_bracket_of_a_single_gear_is_no_matter(tmp_path: Path) -> None:
    """A table may hold both."""
    make(tmp_path, GEARS[:2], (Build(formats=(Format.STEP,), options=FileOptions(bracket=True)),))
    assert files_of(tmp_path, "spur") == {"data.json", "gear.step", "manifest.json"}


def test_fresh_makes_all_again_with_the_same_bytes(made: Path) -> None:
    before, old = snapshot(made / "out"), times(made / "out")
    make(made, fresh=True)
    assert made_now(made / "out") == ["spur", "left", "right"]
    assert snapshot(made / "out") == before
    assert [path for path, when in times(made / "out").items() if when == old[path]] == []


def test_data_alone_keeps_the_solids_of_the_same_inputs_and_removes_those_of_others(made: Path) -> None:
    make(made, wanted=DATA)
    assert made_now(made / "out") == []
    assert files_of(made, "left") == {"data.json", "gear.csv", "manifest.json"}
    assert "files.gear.csv" not in read_results(made / "out")[0]
    make(made, (*GEARS[:2], "left,18,1,3,-15", GEARS[3]), DATA)
    assert made_now(made / "out") == ["left"]
    assert files_of(made, "left") == {"data.json", "manifest.json"}
    assert files_of(made, "spur") == {"data.json", "gear.csv", "manifest.json"}
    make(made, wanted=POINTS)
    assert made_now(made / "out") == ["left"]


# ---------------------------------------------------------------------- another gearcad


def test_another_gearcad_makes_all_again(made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = snapshot(made / "out")
    monkeypatch.setattr(run_module, "make_row", jobs.make_row_of_another_gearcad)
    make(made)
    assert made_now(made / "out") == ["spur", "left", "right"]
    make(made)
    assert made_now(made / "out") == []
    monkeypatch.undo()
    make(made)
    assert made_now(made / "out") == ["spur", "left", "right"]
    assert snapshot(made / "out") == before

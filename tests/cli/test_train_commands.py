"""Commands of pairs with a train of pairs: a folder a mesh, one document, a line a mesh on the screen; tables of trains."""

import csv
import json
from pathlib import Path

import pytest
from support.commands import invoke, read_json

import gearcad
from gearcad.batch import run_table
from gearcad.core.errors import ParameterError, SpecError
from gearcad.designs import read_spec
from gearcad.designs.design import files_only_in, with_files_found
from gearcad.designs.reader import design_from_values, starter_text
from gearcad.designs.spec_writers import pair_text
from gearcad.designs.train_designs import DesignedPair, TrainDesign
from gearcad.designs.variations import spec_values
from gearcad.jobs.strength import Rate

PAIRS = "train-pairs"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    file, text = starter_text(PAIRS)
    Path(file).write_text(text, encoding="utf-8")
    return Path(file)


def test_rate_writes_a_folder_a_mesh(here: Path) -> None:
    result = invoke("rate", str(here), "--quiet")
    assert result.exit_code == 0, result.stderr
    lines = result.stdout.splitlines()
    assert [line.split() for line in lines[:3]] == [
        ["mesh", "N·m", "rpm", "S_H", "S_F", "verdict", "folder"],
        ["stage", "1", "40", "2950", "-", "-", "not", "asked", "for", "stage", "1"],
        ["stage", "2", "-120", "-983.333", "-", "-", "not", "asked", "for", "stage", "2"],
    ]
    folder = Path("output") / PAIRS
    assert lines[-5:] == [str(folder / "rate.json")] + [
        str(folder / mesh / name) for mesh in ("stage 1", "stage 2") for name in ("rate.json", "rate.html")
    ]
    document = read_json(folder / "rate.json")
    assert {name: each["load"] for name, each in document["meshes"].items()} == {
        "stage 1": {"torque": 40.0, "speed": 2950.0, "driver": "pinion"},
        "stage 2": {"torque": -120.0, "speed": -983.333333333, "driver": "pinion"},
    }
    again = invoke("rate", str(here), "--json", "--quiet")
    assert json.loads(again.stdout) == document


def test_data_has_the_pairs(here: Path) -> None:
    document = json.loads(invoke("data", str(here), "--json").stdout)
    alone = document["meshes"]["stage 2"]
    assert (
        alone["load"]["torque"] == -120.0 and alone["wheel"]["teeth"] == 48 and document["mesh"]["stage 2"]["pair"] == "stage 2"
    )
    screen = invoke("data", str(here)).stdout
    assert "gear ratio                                       u                         3     2.66667" in screen


@pytest.mark.long
def test_a_table_of_trains(here: Path, tmp_path: Path) -> None:
    """Figures of each mesh have columns, and files of the folders of meshes are resumed as all others are."""
    design = read_spec(here)
    assert isinstance(design, TrainDesign)
    for mesh in design.train.meshes:
        assert isinstance(mesh.pair, DesignedPair)
        Path(f"{mesh.name}.toml").write_text(pair_text(mesh.pair.design), encoding="utf-8")
    meshes = ("1", "2")
    heads = [
        "name", "train.speed", "train.torques.pinion 1", "train.torques.wheel 2",
        *(f"inertia.{part} {n}.inertia" for n in meshes for part in ("pinion", "wheel")),
        "shaft.s.start", "shaft.s.end", "shaft.s.torsional_stiffness",
        *(f"mesh.stage {n}.{key}" for n in meshes for key in ("pinion", "wheel", "pair")),
    ]  # fmt: skip
    rows = [
        [f"t{torque}", 1000, torque, -8 * torque, *(4 * [0.001]), "wheel 1", "pinion 2", 1e4]
        + [value for n in meshes for value in (f"pinion {n}", f"wheel {n}", f"stage {n}.toml")]
        for torque in (10, 40)
    ]
    with Path("trains.csv").open("w", newline="") as file:
        csv.writer(file).writerows([heads, *rows])
    summary = run_table("trains.csv", Path("out"), [Rate()], jobs=1)
    assert summary.passed, summary.errors
    with Path("out/results.csv").open() as file:
        lines = list(csv.DictReader(file))
    for line, torque in zip(lines, (10, 40), strict=True):
        assert float(line["meshes.stage 2.load.torque"]) == -3 * torque and float(line["meshes.stage 1.pair.gear_ratio"]) == 3
        alone = read_json(Path("out") / line["files.stage 2/rate.json"])
        assert float(line["rate.stage 2.sigma_H.pinion"]) == alone["stresses"]["sigma_H"]["pinion"]
    with Path("out/columns.csv").open() as file:
        told = {line[0]: line[1:4] for line in csv.reader(file)}
    assert told["rate.stage 2.sigma_H.pinion"] == ["σ_H", "MPa", "stage 2 pinion"]
    assert told["meshes.stage 1.pinion.reference_diameter"] == ["d", "mm", "stage 1 pinion"]
    made = {path: path.stat().st_mtime_ns for path in Path("out").rglob("rate.html")}
    assert len(made) == 4
    Path("out/t10/stage 1/rate.html").unlink()
    assert run_table("trains.csv", Path("out"), [Rate()], jobs=1).passed
    after = {path: path.stat().st_mtime_ns for path in Path("out").rglob("rate.html")}
    assert {path for path in made if after[path] == made[path]} == {
        Path("out/t40") / f"stage {n}" / "rate.html" for n in meshes
    }


@pytest.mark.parametrize("name", ["train-pairs", "two-stage"])
def test_pairs_and_shafts_in_cells(name: str, tmp_path: Path) -> None:
    """A study writes pairs, segments, bearings and gears of a spec into cells: the row of the table makes the same train."""
    file, text = starter_text(name)
    (tmp_path / file).write_text(text, encoding="utf-8")
    kind, own, values = spec_values(tmp_path / file)
    made = design_from_values(values, kind, where=lambda key: key, default_name=own)
    read = read_spec(tmp_path / file)
    assert isinstance(made, TrainDesign) and isinstance(read, TrainDesign)
    for table in ("inertias", "shafts", "torques", "speed", "model"):
        assert getattr(made.train, table) == getattr(read.train, table)
    for mesh, other in zip(made.train.meshes, read.train.meshes, strict=True):
        assert isinstance(mesh.pair, DesignedPair) and isinstance(other.pair, DesignedPair)
        assert (mesh.pair.design, mesh.mesh_angle) == (other.pair.design, other.mesh_angle)


def test_a_cell_that_is_no_toml_is_told(tmp_path: Path) -> None:
    file, text = starter_text("two-stage")
    (tmp_path / file).write_text(text, encoding="utf-8")
    kind, own, values = spec_values(tmp_path / file)
    values["mesh.stage 1.pair"] = "{teeth = }"
    with pytest.raises(SpecError, match=r"mesh.stage 1.pair.*must be the name of a file, or a table in one line"):
        design_from_values(values, kind, where=lambda key: key, default_name=own)


def test_files_in_cells_stay_in_the_folder_of_the_page(tmp_path: Path) -> None:
    """A table in one line names no file that a table by itself could not name."""
    values = {"mesh.m.pair": '{pinion = {body = {step = "../blank.step"}}}'}
    found = with_files_found(values, tmp_path)["mesh.m.pair"]
    assert found["pinion"]["body"]["step"] == str(tmp_path / "../blank.step")
    with files_only_in(tmp_path), pytest.raises(ParameterError, match="must be a file in the folder of the page"):
        with_files_found(values, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize(
    "command",
    [
        ("data",), ("rate",), ("shafts",), ("build", "--format", "step,dxf"), ("draw", "--format", "svg"), ("picture",),
        ("mesh", "--what", "sector"), ("stiffness", "--method", "iso6336"), ("dynamics",), ("check",),
    ],
)  # fmt: skip
def test_every_command_runs_on_the_reducer(command: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    file, text = starter_text("two-stage")
    Path(file).write_text(text, encoding="utf-8")
    verb, *options = command
    quiet = [] if verb == "data" else ["--quiet"]
    result = invoke(verb, file, *options, *quiet)
    assert result.exit_code == 0, result.stderr


def test_verbs_of_python_take_a_train(here: Path, tmp_path: Path) -> None:
    design = gearcad.read(here)
    assert isinstance(design, TrainDesign)
    assert next(sheet.name for sheet in gearcad.draw(design).sheets) == "arrangement"
    made = gearcad.build(design, tmp_path / "made", ["csv", "dxf"])
    assert {"stage 1/pinion.dxf", "stage 2/wheel.csv"} <= {path.relative_to(tmp_path / "made").as_posix() for path in made}
    assert [each.mesh.name for each in gearcad.rate(design).meshes] == ["stage 1", "stage 2"]  # type: ignore[union-attr]

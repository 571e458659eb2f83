"""Charts of dynamics as CSV: what JSON and npz hold, with all digits, under headings with units."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from gearcad.cli import main
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.result_tables import stacked
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.jobs.dynamics import Dynamics, table_files

TEMPLATES = Path(__file__).parents[2] / "templates"


def read(path: Path) -> dict[str, list[str]]:
    """Cells of each column."""
    with path.open(encoding="utf-8", newline="") as file:
        heads, *rows = csv.reader(file)
    return dict(zip(heads, map(list, zip(*rows, strict=True)), strict=True))


def numbers(cells: list[str]) -> list[float]:
    return [float(cell) for cell in cells]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, and no pictures: they take most of the time."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, path: path.touch())
    return tmp_path


def run(text: str, *options: str) -> Path:
    """Study a spec; the folder."""
    Path("it.toml").write_text(text, encoding="utf-8")
    result = CliRunner().invoke(main, ["dynamics", "it.toml", "--quiet", "-o", "out", *options])
    assert result.exit_code == 0, result.output
    return Path("out")


def test_tables_of_a_train_are_its_document(here: Path) -> None:
    text = (TEMPLATES / "train-2-stage.toml").read_text(encoding="utf-8") + "speeds = 20\nspeed_from = 8000.0\n"
    folder = run(text)
    document = json.loads((folder / "dynamics.json").read_text(encoding="utf-8"))
    chart, of = read(folder / "dynamics-chart.csv"), document["chart"]
    assert numbers(chart["speed (rpm)"]) == document["speed"]
    assert numbers(chart["tooth_frequency (1/s)"]) == of["frequency"]
    assert numbers(chart["tooth_frequency (Hz)"]) == pytest.approx([32 * each / 60 for each in document["speed"]])
    for stage in ("stage 1", "stage 2"):
        assert numbers(chart[f"kv.{stage}"]) == of["kv"][stage]
        assert numbers(chart[f"least_force.{stage} (N)"]) == of["least_force"][stage]
    assert numbers(chart["shaft_overload.middle"]) == of["shaft_overload"]["middle"]
    assert chart["stable"] == [str(each).lower() for each in of["stable"]]
    moved = read(folder / "dynamics-displacements.csv")
    assert numbers(moved["approach_amplitude.stage 2 (µm)"]) == of["displacements"]["approach_amplitude"]["stage 2"]
    assert numbers(moved["turn_greatest.third (arcsec)"]) == of["displacements"]["turn_greatest"]["third"]
    lines = read(folder / "dynamics-transmission-error.csv")
    with np.load(folder / "dynamics.npz", allow_pickle=False) as arrays:
        first = arrays["transmission_error_order"].tolist().index(1.0)
        assert numbers(lines["stage 2.order 1 (µm)"]) == arrays["transmission_error"][:, first, 1].tolist()
    modes = read(folder / "dynamics-modes.csv")
    assert numbers(modes["frequency (1/s)"]) == document["modes"]["circular"]
    shapes = [numbers(modes[f"shape.{name} (rad)"]) for name in ("first", "second", "third", "fourth")]
    assert np.array(shapes).T.tolist() == document["modes"]["shape"]
    course = read(folder / "dynamics-course.csv")
    period = 60 / (32 * document["course"]["speed"])
    assert numbers(course["time (s)"]) == pytest.approx([each * period for each in document["course"]["turn"]])
    assert numbers(course["force.stage 2 (N)"]) == [each[1] for each in document["course"]["force"]]


def test_tables_of_the_contact_model_and_none_of_another(here: Path) -> None:
    """A motion of many samples is thinned out, and says nothing else; what belongs to another result goes."""
    text = (TEMPLATES / "uhlir-19-23.toml").read_text(encoding="utf-8")
    text = text.replace("speeds = 41", "speeds = 3").replace("duration = 1.0", "duration = 0.3")
    folder = run(text)
    document = json.loads((folder / "dynamics.json").read_text(encoding="utf-8"))["campbell"]
    campbell, history = read(folder / "dynamics-campbell.csv"), read(folder / "dynamics-history.csv")
    assert numbers(campbell["greatest_approach (µm)"]) == document["greatest_approach"]
    assert numbers(campbell["peak_2 (Hz)"]) == [peaks[1][0] for peaks in document["peaks"]]
    with np.load(folder / "dynamics.npz", allow_pickle=False) as arrays:
        assert len(arrays["history_time"]) == 60_000 and len(history["time (s)"]) == 20_000
        assert numbers(history["time (s)"]) == arrays["history_time"][::3].tolist()
        assert numbers(history["wheel_angle (deg)"]) == arrays["history_wheel_angle"][::3].tolist()
        spectrum = read(folder / "dynamics-spectrum.csv")
        assert numbers(spectrum["frequency (Hz)"]) == arrays["frequency"].tolist()
    assert sorted(path.name for path in folder.glob("*.csv")) == [
        f"dynamics-{name}.csv" for name in ("campbell", "history", "spectrum")
    ]
    mesh = text.replace('model = "contact"', 'stiffness = "potential-energy"').replace("speed_to = 20000.0", "speed_to = 9e4")
    run(mesh.replace("speed_from = 0.0", "speed_from = 8e4"))
    assert sorted(path.name for path in folder.glob("*.csv")) == [
        f"dynamics-{name}.csv"
        for name in ("chart", "course-lines", "course", "displacements", "mesh-stiffness", "modes", "transmission-error")
    ]


def test_names_are_no_formulas_and_every_table_is_known(tmp_path: Path) -> None:
    """A spreadsheet runs a cell that begins with =; a table that a later result does not have must go."""
    train = Train(
        name="it",
        model=TrainModel.MASSLESS,
        inertias=(Inertia(name="=1+2", inertia=0.01), Inertia(name="b", inertia=0.02)),
        shafts=(Shaft(name="s", start="ground", end="=1+2", torsional_stiffness=1e4),),
        meshes=(
            ToothMesh(name="m", pinion="=1+2", wheel="b", teeth=20, stiffness=1.0, base_radii=(40.0, 80.0), damping_ratio=0.1),
        ),
        torques={"=1+2": 100.0, "b": 200.0},
    )
    study = study_train(train, DynamicsOptions(speeds=4))
    files = table_files("dynamics", study.tables())
    assert set(files) <= set(Dynamics.sometimes)
    for name, write in files.items():
        write(tmp_path / name)
    modes = read(tmp_path / "dynamics-modes.csv")
    assert any(cell.startswith("'=1+2") for cell in modes["most_in"])
    assert not any(cell.startswith("=") for column in modes.values() for cell in column)


def test_tables_under_each_other_leave_blank_what_one_has_not() -> None:
    one = {"chart": {"speed": np.array([1.0, 2.0]), "shaft": np.array([3.0, 4.0])}}
    other = {"chart": {"speed": np.array([5.0]), "standard": [6.0]}, "more": {"x": [True]}}
    assert stacked("model", ("a", "b"), (one, other)) == {
        "chart": {
            "model": ["a", "a", "b"],
            "speed": [1.0, 2.0, 5.0],
            "shaft": [3.0, 4.0, None],
            "standard": [None, None, 6.0],
        },
        "more": {"model": ["b"], "x": [True]},
    }


def test_no_value_is_no_cell(tmp_path: Path) -> None:
    (write,) = table_files("dynamics", {"x": {"a (N)": np.array([1 / 3, np.nan]), "b": [None, True]}}).values()
    write(tmp_path / "x.csv")
    assert (tmp_path / "x.csv").read_text(encoding="utf-8") == "a (N),b\n0.3333333333333333,\n,true\n"

"""`gearcad dynamics` of specs with [dynamics.transient] and campbell, as a user meets it."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.train import Train
from gearcad.report.dynamics import dynamics_html

TEMPLATES = Path(__file__).parents[2] / "templates"

TRAIN = (TEMPLATES / "train-1-stage.toml").read_text(encoding="utf-8") + "speeds = 4\n"

PAIR = """
[pair]
normal_module = 2.0
face_width = 20.0
tooth_thinning = 0.05
[pinion]
teeth = 20
body.bore = 12.0
[wheel]
teeth = 30
body.bore = 20.0
[load]
torque = 50.0
speed = 6000.0
[dynamics]
stiffness = "potential-energy"
speeds = 3
speed_to = 20000.0
pinion_inertia = 4e-5
wheel_inertia = 2e-4
"""

RUN = """
[dynamics.transient]
speed_from = 9000
speed_to = 12000
duration = 0.05
"""

SPECTRA = 'campbell = "on"\nduration = 0.02\nsampling = 100000\n'


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, list(arguments))


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def spec(text: str) -> str:
    Path("it.toml").write_text(text, encoding="utf-8")
    return "it.toml"


@pytest.mark.parametrize(("text", "folder"), [(TRAIN, "train-1-stage"), (PAIR, "it")])
def test_runs_and_spectra_are_in_all_files(text: str, folder: str, here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, path: path.touch())
    result = run("dynamics", spec(text + SPECTRA + RUN))
    assert result.exit_code == 0, result.output
    assert "in time: 9000 to 12000 rpm, 0.05 s by" in result.stdout
    assert "greatest force of mesh:" in result.stdout
    assert "spectra at 4 speeds" in result.stdout or "spectra at 3 speeds" in result.stdout
    assert "] transient" in result.stderr and "] campbell" in result.stderr
    output = Path("output") / folder
    document = json.loads((output / "dynamics.json").read_text(encoding="utf-8"))
    transient, campbell = document["transient"], document["campbell"]
    assert (transient["speed_from"], transient["speed_to"]) == (9000.0, pytest.approx(12000.0))
    (greatest,) = transient["greatest"]
    assert 1 < greatest["factor"] < 3
    with np.load(output / "dynamics.npz", allow_pickle=False) as arrays:
        assert arrays["transient_factor"].max() == greatest["factor"]
        assert arrays["transient_force"].shape == (len(arrays["transient_time"]), 1)
        speeds, frequencies = arrays["campbell_speed"], arrays["campbell_frequency"]
        assert arrays["campbell_pinion_speed"].shape == (len(speeds), len(frequencies))
        np.testing.assert_allclose(arrays["campbell_pinion_speed"][:, 0], speeds * np.pi / 30, rtol=1e-3)
    assert campbell["speeds"] == speeds.tolist()
    np.testing.assert_allclose(speeds, speeds[-1] * np.arange(1, len(speeds) + 1) / len(speeds))  # even, none at standstill
    with (output / "dynamics-transient.csv").open(encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0][:3] == ["time (s)", "speed (rpm)", "overload.mesh"]
    assert max(float(row[2]) for row in rows[1:]) == pytest.approx(greatest["factor"], rel=1e-6)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (TRAIN + RUN + "torque_of = 2", "dynamics.transient.torque_of: unknown key; did you mean torque_"),
        (PAIR + RUN + "torque_of = 2", "dynamics.transient.torque_of: unknown key"),
        (TRAIN + RUN + "torque_at = 0.01", "torque_at = 0.01 s: needs torque_to"),
        (PAIR + RUN.replace("0.05", "-1"), "dynamics.transient.duration = -1 s: must be"),
        (TRAIN + RUN.replace("0.05", "'long'"), "dynamics.transient.duration = 'long'"),
        (TRAIN + RUN.replace("0.05", "100000"), "dynamics.transient.duration = 100000 s: must be at most"),
        (TRAIN + RUN + "torque_to = 2\ntorque_at = 1.0", "torque_at = 1 s: must be at most 0.05 s"),
        (TRAIN + "transient = 3", "transient"),
        (PAIR + "transient = 3", "transient"),
        (TRAIN + 'campbell = "yes"', "campbell"),
        (TRAIN + 'campbell = "on"\nduration = 100', "dynamics.duration = 100 s: must be at most"),
        (
            PAIR.replace('stiffness = "potential-energy"', 'model = "contact"') + RUN,
            'must be "mesh" beside [dynamics.transient]',
        ),
    ],
)
def test_what_cannot_be_run_is_told_in_a_line(text: str, words: str, here: Path) -> None:
    result = run("dynamics", spec(text), "--quiet")
    assert result.exit_code == 2 and isinstance(result.exception, SystemExit), result.output
    assert words in result.stderr and result.stderr.count("\n") == 1, result.stderr
    assert "fault of gearcad" not in result.stderr
    assert not Path("output").exists() or not list(Path("output").rglob("dynamics.*"))


def test_runs_and_spectra_are_in_the_report() -> None:
    train = Train(
        inertias=(Inertia(name="pinion", inertia=0.004), Inertia(name="wheel", inertia=0.03)),
        meshes=(
            ToothMesh(
                name="mesh",
                pinion="pinion",
                wheel="wheel",
                base_radii=(40, 80),
                teeth=20,
                stiffness=300.0,
                variation=0.2,
                damping_ratio=0.07,
            ),
        ),
        torques={"pinion": 200.0, "wheel": 400.0},
    )
    run = TransientOptions(speed_from=5000.0, speed_to=7000.0, duration=0.02)
    options = DynamicsOptions(speeds=4, speed_to=9000.0, transient=run, campbell="on", duration=0.01, sampling=1e5)
    page = dynamics_html(study_train(train, options), "it")
    for words in ("Run with changing speed", "Run over time", "Campbell diagram", "No speed is chaotic"):
        assert words in page


def test_a_run_can_be_varied(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, path: path.touch())
    result = run("dynamics", spec(TRAIN + RUN), "--quiet", "--vary", "dynamics.transient.duration=0.02,0.05")
    assert result.exit_code == 0, result.output

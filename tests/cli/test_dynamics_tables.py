"""Charts of dynamics as CSV, lists of models in a spec, [dynamics.transient] and campbell."""

import csv
import re
from dataclasses import replace
from pathlib import Path

import lxml.html
import numpy as np
import pytest
from click.testing import Result
from support.commands import invoke, read_json
from support.specs import TEMPLATES

from gearcad.core.errors import ParameterError
from gearcad.designs import TrainDesign, read_spec
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.result_tables import stacked
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.jobs.dynamics import Dynamics, table_files
from gearcad.report.dynamics import dynamics_html


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
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, _head, path: path.touch())
    return tmp_path


def run(text: str, *options: str) -> Path:
    """Study a spec; the folder."""
    Path("it.toml").write_text(text, encoding="utf-8")
    result = invoke("dynamics", "it.toml", "--quiet", "-o", "out", *options)
    assert result.exit_code == 0, result.output
    return Path("out")


def test_tables_of_a_train_are_its_document(here: Path) -> None:
    text = (TEMPLATES / "train-2-stage.toml").read_text(encoding="utf-8") + "speeds = 20\nspeed_from = 8000.0\n"
    folder = run(text)
    document = read_json(folder / "dynamics.json")
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
    document = read_json(folder / "dynamics.json")["campbell"]
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


TRAIN = (TEMPLATES / "train-1-stage.toml").read_text(encoding="utf-8") + "speeds = 120\n"
COUPLED = """
[train]
model = ["massless", "exact"]
[[train.inertia]]
name = "a"
inertia = 1.0
[[train.inertia]]
name = "b"
inertia = 2.0
[[train.shaft]]
name = "s"
start = "a"
end = "b"
length = 500.0
diameter = 40.0
"""


def level_run(text: str, *arguments: str) -> Result:
    Path("it.toml").write_text(text, encoding="utf-8")
    return invoke("dynamics", "it.toml", "--quiet", *arguments)


def with_models(models: str, text: str = TRAIN) -> str:
    return re.sub(r"(?m)^model = .*$", f"model = {models}", text)


@pytest.fixture
def level_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    return tmp_path


@pytest.mark.usefixtures("no_pictures")
def test_what_no_chart_shows_is_in_the_headline(level_here: Path) -> None:
    result = level_run(
        with_models('["isolated", "massless"]').replace("speeds = 120", "speeds = 20") + "operating_to = 99999.0\n"
    )
    assert "of which not judged: 16000 to 99999 rpm, beyond the last speed of the chart, held against" in result.stdout
    page = Path("output/train-1-stage/dynamics.html").read_text(encoding="utf-8")
    assert "Not judged: 16" in page


@pytest.mark.usefixtures("no_pictures")
def test_a_list(level_here: Path) -> None:
    """The order of the list is that of tables and charts."""
    result = level_run(with_models('["exact", "isolated"]') + "operating_to = 12000.0\n")
    assert result.exit_code == 0, result.output
    document = read_json("output/train-1-stage/dynamics.json")
    assert document["labels"] == ["exact", "isolated"] and document["reference"] == "exact" and document["enough"] is None
    assert document["operating_range"] == {"first": 16.0, "last": 12000.0, "source": "operating range"}
    (verdict,) = document["verdicts"]
    assert verdict["status"] == "not enough" and verdict["sentence"] in document["sentence"]
    first = result.stdout[result.stdout.index('"isolated" is not enough') :].splitlines()[0]
    assert verdict["sentence"].startswith(first.rstrip(".")) and len(first) < 200
    worst = max(each["excess"] for each in verdict["underestimates"])
    assert worst == pytest.approx(0.2255, abs=2e-3)
    assert verdict["deciding"][0]["shares"][0]["name"] == "input"
    with np.load("output/train-1-stage/dynamics.npz", allow_pickle=False) as arrays:
        assert arrays["exact/kv"].shape[0] >= 120 and "isolated/shaft_overload" in arrays
    page = lxml.html.parse("output/train-1-stage/dynamics.html").getroot()
    assert "is not enough: it misses the resonance" in page.text_content()


def test_a_list_of_one_is_one_word(level_here: Path) -> None:
    designs = []
    for models in ('"modes"', '["modes"]'):
        Path("it.toml").write_text(with_models(models), encoding="utf-8")
        designs.append(read_spec(Path("it.toml")))
    assert designs[0] == designs[1]


@pytest.mark.long
def test_a_list_of_one_is_the_plain_study(level_here: Path) -> None:
    """Byte for byte."""
    files = {}
    for models in ('"modes"', '["modes"]'):
        assert level_run(with_models(models)).exit_code == 0
        files[models] = {path.name: path.read_bytes() for path in Path("output/train-1-stage").iterdir()}
    assert files['"modes"'] == files['["modes"]'] and len(files['["modes"]']) > 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (with_models("[]"), r"line 10: train.model = \[\]: must hold one at least of isolated, massless"),
        (with_models('["exact", "exact"]'), r"line 10: train.model = 'exact': stands twice in the list"),
        (with_models('["exact", "heavy"]'), r"line 10: train.model = 'heavy': must be one of 'isolated'"),
        (with_models('["exact", 3]'), r"line 10: train.model = 3: must be one of"),
        (with_models('[["exact"], "isolated"]'), r"train.model = \['exact'\]: must be one of"),
        (COUPLED, r"line 3: train.model = 'massless, exact': must be one model for a train without meshes"),
        (
            with_models('["exact", "isolated"]', COUPLED),
            r"line 3: train.model = 'isolated': must be a model with shafts: .* the train has no meshes",
        ),
        (with_models('["exact", "modes"]').replace("modes = 2 ", "modes = 9 "), r"input.modes = 9: must be at most half"),
        (with_models('["exact", "modes"]') + "operating_to = 0.0\n", r"dynamics.operating_to = 0 rpm"),
        (with_models('["exact", "modes"]') + "operating_from = 9.0\noperating_to = 9.0\n", r"must be above operating_from"),
        (with_models('["exact", "modes"]') + "operating_from = 20000.0\n", r"operating_from = 20000 rpm: must be below"),
        (with_models('["exact", "modes"]') + "level_tolerance = 0.0\n", r"level_tolerance = 0: must be"),
    ],
)
def test_a_wrong_list_gets_one_line(level_here: Path, text: str, words: str) -> None:
    result = level_run(text)
    assert result.exit_code == 2 and len(result.stderr.splitlines()) == 1 and "Traceback" not in result.stderr
    assert re.search(words, result.stderr), result.stderr
    assert not Path("output").exists()


def test_models_in_python() -> None:
    design = read_spec(TEMPLATES / "train-1-stage.toml")
    assert isinstance(design, TrainDesign)
    assert design.models == (TrainModel.MODES,)
    several = replace(design, other_models=("exact",))  # type: ignore[arg-type]
    assert several.models == (TrainModel.MODES, TrainModel.EXACT)
    with pytest.raises(ParameterError, match="stands twice"):
        replace(several, train=replace(design.train, model="exact"))


TIME_TRAIN = (TEMPLATES / "train-1-stage.toml").read_text(encoding="utf-8") + "speeds = 4\n"

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


def time_run(*arguments: str) -> Result:
    return invoke(*arguments)


@pytest.fixture
def time_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def spec(text: str) -> str:
    Path("it.toml").write_text(text, encoding="utf-8")
    return "it.toml"


@pytest.mark.parametrize(("text", "folder"), [(TIME_TRAIN, "train-1-stage"), (PAIR, "it")])
def test_runs_and_spectra_are_in_all_files(text: str, folder: str, time_here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, _head, path: path.touch())
    result = time_run("dynamics", spec(text + SPECTRA + RUN))
    assert result.exit_code == 0, result.output
    assert "in time: 9000 to 12000 rpm, 0.05 s by" in result.stdout
    assert "greatest force of mesh:" in result.stdout
    assert "spectra at 4 speeds" in result.stdout or "spectra at 3 speeds" in result.stdout
    assert "] transient" in result.stderr and "] campbell" in result.stderr
    output = Path("output") / folder
    document = read_json(output / "dynamics.json")
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
        (TIME_TRAIN + RUN + "torque_of = 2", "dynamics.transient.torque_of: unknown key; did you mean torque_"),
        (PAIR + RUN + "torque_of = 2", "dynamics.transient.torque_of: unknown key"),
        (TIME_TRAIN + RUN + "torque_at = 0.01", "torque_at = 0.01 s: needs torque_to"),
        (PAIR + RUN.replace("0.05", "-1"), "dynamics.transient.duration = -1 s: must be"),
        (TIME_TRAIN + RUN.replace("0.05", "'long'"), "dynamics.transient.duration = 'long'"),
        (TIME_TRAIN + RUN.replace("0.05", "100000"), "dynamics.transient.duration = 100000 s: must be at most"),
        (TIME_TRAIN + RUN + "torque_to = 2\ntorque_at = 1.0", "torque_at = 1 s: must be at most 0.05 s"),
        (TIME_TRAIN + "transient = 3", "transient"),
        (PAIR + "transient = 3", "transient"),
        (TIME_TRAIN + 'campbell = "yes"', "campbell"),
        (TIME_TRAIN + 'campbell = "on"\nduration = 100', "dynamics.duration = 100 s: must be at most"),
        (
            PAIR.replace('stiffness = "potential-energy"', 'model = "contact"') + RUN,
            'must be "mesh" beside [dynamics.transient]',
        ),
    ],
)
def test_what_cannot_be_run_is_told_in_a_line(text: str, words: str, time_here: Path) -> None:
    result = time_run("dynamics", spec(text), "--quiet")
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


def test_a_run_can_be_varied(time_here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, _head, path: path.touch())
    result = time_run("dynamics", spec(TIME_TRAIN + RUN), "--quiet", "--vary", "dynamics.transient.duration=0.02,0.05")
    assert result.exit_code == 0, result.output

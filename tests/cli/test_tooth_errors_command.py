"""K_v with tooth errors that are drawn, by the command: documents, tables, report, and what cannot be asked for."""

import csv
from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
import pytest
from click.testing import Result
from matplotlib.figure import Figure
from support.commands import invoke, read_json
from support.specs import TEMPLATES
from support.trains import one_stage

from gearcad import Gear, GearPair, Load, Material
from gearcad.core.errors import ParameterError
from gearcad.core.records import Role
from gearcad.dynamics.engagement import engaged
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.pair_study import study_pair
from gearcad.dynamics.tooth_errors.error_result import BAND, ErrorStudy, ToothLaw
from gearcad.dynamics.tooth_errors.error_sources import engaged_teeth, mesh_teeth, pair_teeth
from gearcad.dynamics.tooth_errors.error_study import ErrorPlan, Sampling, study_errors
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.mesh_excitation import train_excitation
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.tooth_deviations import ErrorDistribution
from gearcad.dynamics.trains.train import EngagedMesh, Train
from gearcad.jobs.dynamics import Dynamics
from gearcad.plots.speeds import plot_tooth_errors
from gearcad.report import write_dynamics_report
from gearcad.report.document import sentences
from gearcad.report.dynamics import error_table
from gearcad.stiffness import METHODS

FIGURE_5 = 'tooth_errors = "on"\naccuracy_grade = 9\npremature_engagement = "on"\n'


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, and no pictures: they take most of the time."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, _head, path: path.touch())
    return tmp_path


def run(more: str, *options: str) -> Result:
    text = (TEMPLATES / "train-1-stage.toml").read_text(encoding="utf-8") + more
    Path("it.toml").write_text(text, encoding="utf-8")
    return invoke("dynamics", "it.toml", "-o", "out", *options)


def options(**more: object) -> DynamicsOptions:
    given = {"tooth_errors": "on", "premature_engagement": "on", "accuracy_grade": 9, "speeds": 5, "speed_to": 12000.0}
    return DynamicsOptions(**(given | more))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def study() -> TrainStudy:
    return study_train(replace(one_stage("modes"), speed=6764.0), options(error_samples=12))


@pytest.mark.long
def test_documents_and_tables_are_the_samples(here: Path) -> None:
    result = run(FIGURE_5 + "error_samples = 4\nspeeds = 3\n")
    assert result.exit_code == 0, result.output
    document = read_json("out/dynamics.json")["tooth_errors"]
    arrays = np.load("out/dynamics.npz")
    samples = arrays["errors_kv"][:, :, 0]
    assert samples.shape == (4, 3)
    kv = document["kv"]["mesh"]
    assert kv["median"] == pytest.approx(np.median(samples, axis=0))
    assert kv["lower_quantile"] == pytest.approx(np.quantile(samples, BAND[0], axis=0))
    assert kv["upper_quantile"] == pytest.approx(np.quantile(samples, BAND[1], axis=0))
    assert (kv["least"], kv["most"]) == (samples.min(axis=0).tolist(), samples.max(axis=0).tolist())
    assert document["speed"] == pytest.approx([16000 / 3, 32000 / 3, 16000])
    assert (document["law"], document["teeth"], document["whole_period"]) == ("single teeth", 144, True)
    with Path("out/dynamics-tooth-errors.csv").open(encoding="utf-8", newline="") as file:
        heads, *rows = csv.reader(file)
    found = dict(zip(heads, np.array(rows, float).T, strict=True))
    assert found["kv_median.mesh"].tolist() == kv["median"]
    assert found["kv_sample_3.mesh"].tolist() == samples[2].tolist()
    assert "tooth errors of grade 9, 4 samples: median up to" in result.output
    # A study without them leaves no table of another behind.
    assert "dynamics-tooth-errors.csv" in Dynamics.sometimes


def test_the_first_samples_are_those_of_fewer(study: TrainStudy) -> None:
    fewer = study_train(study.train, options(error_samples=3)).errors
    assert study.errors is not None and fewer is not None
    assert (fewer.factors == study.errors.factors[:3]).all()
    assert (fewer.nominal == study.errors.nominal).all()


def test_figure_5_of_the_paper(study: TrainStudy) -> None:
    """Overloads are much greater than with a smooth stiffness at omega_3, where one looks at a speed asked for."""
    of = study.errors
    assert of is not None
    row = int(np.flatnonzero(of.speeds == 6764.0)[0])
    smooth = study.up.factors[int(np.abs(study.speeds - 6764.0).argmin()), 0]
    assert smooth == pytest.approx(1.448, abs=2e-3)
    assert of.median[row, 0] == pytest.approx(2.2, abs=0.1)
    assert of.nominal[row, 0] < of.least[row, 0]
    assert not study.train.meshes[0].pitch_deviations and study.excitation.meshes[0].error is None


@pytest.mark.long
def test_report(study: TrainStudy, tmp_path: Path) -> None:
    write_dynamics_report(study, "it", tmp_path / "it.html")
    page = (tmp_path / "it.html").read_text(encoding="utf-8")
    assert "With tooth errors" in page and "12 samples of teeth" in page
    assert "no upper bound" in page


def test_table_sentences_and_picture(study: TrainStudy) -> None:
    said = sentences("captions_dynamics.txt", "tooth_errors", study)
    assert "Each pair of teeth is a spring by itself" in said
    assert "no upper bound: with a probability of 95 % it is above number 3 from the top of 12" in said
    table = error_table(study)
    assert table is not None and len(table.rows) == 2
    assert table.rows[1][1] == "at the speed asked for"
    axes = plot_tooth_errors(study, Figure().subplots())
    labels = [each.get_text() for each in axes.get_legend().get_texts()]
    assert labels[0] == "5 % to 95 %"
    drawn = {line.get_label(): line.get_ydata() for line in axes.get_lines()}
    assert study.errors is not None
    assert np.asarray(drawn["median"]) == pytest.approx(study.errors.median[:, 0])
    with pytest.raises(ValueError, match="no tooth errors were drawn"):
        plot_tooth_errors(replace(study, errors=None))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("error_samples = 0\n", "error_samples = 0: must be a whole number from 1 to 10000"),
        ("error_samples = 3\n", 'error_samples = 3: must be 1 unless tooth_errors is "on"'),
        ('error_distribution = "gauss"\n', "must be one of 'uniform', 'normal'"),
        ('premature_engagement = "sometimes"\n', 'must be "on" or "off"'),
    ],
)
def test_what_cannot_be_drawn(here: Path, more: str, message: str) -> None:
    result = run(more)
    assert result.exit_code == 2
    assert message in result.output and "Traceback" not in result.output
    assert not Path("out").exists()


def test_speeds_at_which_teeth_ring_out_long_before_the_next() -> None:
    train = one_stage("modes")
    teeth = [mesh_teeth(train.meshes[0], 0, 44497.0, None, single=True)]
    plan = ErrorPlan(law=ToothLaw.SINGLE, samples=5, distribution=ErrorDistribution.UNIFORM, seed=0, grade=None)

    def drawn(speeds: list[float]) -> ErrorStudy:
        return study_errors(system(train), train_excitation(train), teeth, np.array(speeds), 18, plan)

    with pytest.raises(ParameterError, match=r"speed_to = 10 rpm: must be above 30\.87 rpm"):
        drawn([1.0, 10.0])
    found = drawn([10.0, 40.0, 70.0])
    assert found.speeds.tolist() == [40.0, 70.0]
    assert found.notices[0].code == "errors-from-speed"
    # Teeth without errors are all alike.
    assert found.samples == 1 and (found.factors[0] == found.nominal).all()


def test_a_failure_and_a_wish_to_stop_end_all_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C comes while samples run: it is raised again, and nothing runs on."""
    train, stopped = one_stage("modes"), Event()
    sampling = Sampling._block

    def watched(self: Sampling, *arguments: object) -> object:
        found = sampling(self, *arguments)  # type: ignore[arg-type]
        stopped.set()
        return found

    monkeypatch.setattr(Sampling, "_block", watched)

    def heard(_share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study_train(train, options(error_samples=400, speeds=100), drawn=heard)
    assert stopped.is_set()


# ---------------------------------------------------------------------- pairs


def spur_pair() -> GearPair:
    pinion, wheel = (Gear(teeth=z, normal_module=2, face_width=15, tooth_thinning=0.05) for z in (20, 30))
    return GearPair(pinion=pinion, wheel=wheel)


def test_a_pair_has_its_own_teeth_and_tolerances() -> None:
    pair, load = spur_pair(), Load(torque=60.0, speed=9000.0)
    cycle = METHODS["potential-energy"](pair=pair)(load)
    asked = options(error_samples=6, accuracy_grade=7, speed_to=12000.0)
    found = study_pair(pair, Material(), load, cycle, (2e-5, 1.4e-4), asked)
    of = found.study.errors
    assert of is not None and of.teeth == 60
    assert found.study.excitation.meshes[0].error is not None
    assert (of.median >= of.nominal - 1e-3).all()
    assert any("stiffness of Potential energy" in each for each in found.warnings)


def test_the_mesh_of_a_pair_in_a_train_has_the_teeth_of_the_pair() -> None:
    mesh = ToothMesh(name="m", pinion="p", wheel="w", pair=spur_pair(), phase=0.25)
    inertias = (Inertia(name="p", inertia=2e-5), Inertia(name="w", inertia=1.4e-4))
    train = Train(model="isolated", inertias=inertias, meshes=(mesh,), torques={"p": 60.0, "w": 90.0}, speed=9000.0)
    own = engaged(train, DynamicsOptions(stiffness="potential-energy")).meshes[0]
    assert isinstance(own, EngagedMesh)
    found = engaged_teeth(own, 0, errors=True, single=True)
    alone = pair_teeth(spur_pair(), own.course.cycle, own.teeth_of.rating, single=True, source="x")
    assert found.spring is not None and alone.spring is not None
    assert found.spring.stiffness.tolist() == alone.spring.stiffness.tolist()
    assert found.spring.gap.tolist() == alone.spring.gap.tolist()
    assert found.spring.lead == pytest.approx(alone.spring.lead - 0.25)
    assert found.tolerances == alone.tolerances
    reversed_course = replace(own, course=replace(own.course, driver=Role.WHEEL))
    driven = engaged_teeth(reversed_course, 0, errors=True, single=True)
    assert driven.spring is not None
    assert driven.spring.gap.tolist() == alone.spring.gap[::-1].tolist()
    assert engaged_teeth(own, 0, errors=False, single=True).tolerances is None

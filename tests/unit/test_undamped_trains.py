"""Trains without damping: modes, runs in time against a closed form and scipy, and what is said of loads over speed."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from gearcad.cli import main
from gearcad.core.errors import ParameterError, SolverError
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.dynamics.train_study import study_train, study_undamped
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.steady_response import UndampedError
from gearcad.dynamics.trains.train import Train

STARTER = (Path(__file__).parents[2] / "templates" / "train-1-stage.toml").read_text(encoding="utf-8")

UNDAMPED = STARTER.replace("damping_ratio = 0.05", "damping_ratio = 0").replace("damping = 14660.0", "damping = 0")

RUN = "[dynamics.transient]\nspeed_from = 2000\nspeed_to = 2600\nduration = 0.02\n"

STIFFNESS, FORCE, RATIO = 3e8, 5000.0, 20
"""N/m, N at rest, and teeth of the pinion."""

MASS = 1 / (0.04**2 / 0.004 + 0.08**2 / 0.03)
"""Of both gears on the line of action, in kg."""

STEPS = 2e-3
"""Relative error of forces by 80 steps a vibration or more."""

PHASE = 0.01
"""Of the swing: what phases of 6 or 22 vibrations are late by so many steps comes to 0.0043."""


def pair(**more: object) -> Train:
    """A pair without damping; its mesh is as stiff everywhere unless `more` says otherwise."""
    mesh: dict[str, object] = {"stiffness": STIFFNESS / 1e6, "variation": 0.0, "damping": 0.0, **more}
    return Train(
        inertias=(Inertia(name="pinion", inertia=0.004), Inertia(name="wheel", inertia=0.03)),
        meshes=(ToothMesh(name="mesh", pinion="pinion", wheel="wheel", base_radii=(40, 80), teeth=RATIO, **mesh),),  # type: ignore[arg-type]
        torques={"pinion": 200.0, "wheel": 400.0},
        speed=3000.0,
    )


def test_a_torque_step_swings_for_ever_as_an_undamped_oscillator() -> None:
    """Force 1.5 - cos(omega t) of that at rest after a step from 0.5 to 1.5, from crest to crest."""
    omega = math.sqrt(STIFFNESS / MASS)
    lasts = 60 / omega
    step = TransientOptions(duration=lasts, torque_from=0.5, torque_to=1.5, torque_at=lasts / 3, sampling=20 * omega)
    found = study_undamped(pair(), DynamicsOptions(transient=step))
    assert found.modes.circular[-1] == pytest.approx(omega, rel=1e-9)
    run = found.transient
    assert run is not None
    later = run.time > lasts / 3
    expected = np.where(later, 1.5 - np.cos(omega * (run.time - lasts / 3)), 0.5)
    np.testing.assert_allclose(run.force[:, 0] / FORCE, expected, atol=PHASE)
    assert run.greatest[0].factor == pytest.approx(2.5, rel=STEPS)
    assert {each.code for each in found.notices} == {"no-damping", "not-settled"}


def test_a_mesh_of_varying_stiffness_moves_as_scipy_integrates_it() -> None:
    """k (1 - 0.2 cos(tooth phase)), from the state that the run begins with."""
    omega, lasts = math.sqrt(STIFFNESS / MASS), 0.01
    tooth = 2 * math.pi * 3000 / 60 * RATIO
    options = TransientOptions(duration=lasts, sampling=20 * omega)
    run = study_undamped(pair(variation=0.2), DynamicsOptions(transient=options)).transient
    assert run is not None

    def rates(t: float, x: NDArray[np.float64]) -> list[float]:
        return [x[1], (FORCE - STIFFNESS * (1 - 0.2 * math.cos(tooth * t)) * x[0]) / MASS]

    approach = 1e-6 * run.approach[:, 0]
    rate = float(np.gradient(approach[:7], float(run.time[1]), edge_order=2)[0])
    expected = solve_ivp(
        rates, (0, lasts), [approach[0], rate], "DOP853", t_eval=run.time[run.time <= lasts], rtol=1e-9, atol=1e-15
    ).y[0]
    swing = np.ptp(expected)
    assert swing > 0.2 * FORCE / STIFFNESS
    np.testing.assert_allclose(approach[: len(expected)], expected, atol=PHASE * swing, rtol=0)


def test_only_what_is_shaken_needs_damping() -> None:
    assert study_train(pair(), DynamicsOptions(speeds=5)).up.factors == pytest.approx(1.0)
    for speeds in (5, 200):  # whether a speed of the chart meets a resonance or not
        with pytest.raises(UndampedError, match=r"mesh\.damping = 0 N·s/m: must be above 0"):
            study_train(pair(variation=0.2), DynamicsOptions(speeds=speeds, speed_to=1000.0))


def test_flanks_that_pull_are_told() -> None:
    step = TransientOptions(duration=0.01, torque_from=1.0, torque_to=0.2)
    bonded, parting = (study_undamped(pair(backlash=each), DynamicsOptions(transient=step)).notices for each in (None, 100.0))
    assert "flanks-would-part" in [each.code for each in bonded]
    assert "flanks-would-part" not in [each.code for each in parting]


def test_a_run_that_grows_beyond_all_numbers_says_what_bounds_it() -> None:
    """Twice the natural frequency: parametric resonance of flanks that stick, about exp(0.05 omega t)."""
    twice = 2 * math.sqrt(STIFFNESS / MASS) * 60 / (2 * math.pi * RATIO)
    step = TransientOptions(duration=1.2, speed_from=twice, torque_from=0.5, torque_to=1.0, torque_at=0.0)
    with pytest.raises(SolverError, match=r"grows without bound before .* s: more damping limits it, or a backlash"):
        study_undamped(pair(variation=0.2), DynamicsOptions(transient=step))


def test_a_run_needs_a_speed() -> None:
    train = replace(pair(), speed=0.0)
    with pytest.raises(ParameterError, match=r"dynamics\.transient\.speed_from is missing: must be given, or train\.speed"):
        study_undamped(train, DynamicsOptions(transient=TransientOptions()))
    assert study_undamped(train).transient is None


# ---------------------------------------------------------------------- as a user meets it


def _run(tmp_path: Path, text: str, *more: str) -> tuple[int, str, dict[str, object]]:
    (tmp_path / "it.toml").write_text(text, encoding="utf-8")
    result = CliRunner().invoke(main, ["dynamics", str(tmp_path / "it.toml"), "-o", str(tmp_path / "out"), *more])
    written = tmp_path / "out" / "dynamics.json"
    return result.exit_code, result.output, json.loads(written.read_text(encoding="utf-8")) if written.exists() else {}


def test_modes_are_written_and_the_run_in_time_is_offered(tmp_path: Path) -> None:
    status, words, document = _run(tmp_path, UNDAMPED)
    assert status == 0
    assert "loads over speed are left out: without damping" in words and "or [dynamics.transient] for a run in time" in words
    assert "chart" not in document and "transient" not in document
    assert document["modes"]["frequency"][1] == pytest.approx(2029.56, rel=1e-5)  # type: ignore[index]
    page = (tmp_path / "out" / "dynamics.html").read_text(encoding="utf-8")
    assert "1 mesh</p>" in page and "no mesh" not in page


def test_the_run_in_time_is_written(tmp_path: Path) -> None:
    status, words, document = _run(tmp_path, UNDAMPED + RUN)
    assert status == 0 and "greatest force of mesh:" in words and "[dynamics.transient] for a run" not in words
    transient = document["transient"]
    factor = transient["greatest"][0]["factor"]  # type: ignore[index]
    # The input shaft carries 0.16 N·m at rest, hundreds in the run: no torque is referred to that.
    assert [each["name"] for each in transient["greatest_of_shafts"]] == ["output"]  # type: ignore[index]
    with np.load(tmp_path / "out" / "dynamics.npz", allow_pickle=False) as arrays:
        assert arrays["transient_factor"].max() == factor > 1
    assert (tmp_path / "out" / "dynamics-transient.csv").exists()
    page = (tmp_path / "out" / "dynamics.html").read_text(encoding="utf-8")
    assert ">Run in time</h2>" in page and "the forces depend on how the run begins" in page


@pytest.mark.parametrize(
    ("text", "more"),
    [
        (UNDAMPED.replace('model = "modes"', 'model = ["massless", "modes"]'), ()),
        (UNDAMPED, ("--vary", "shaft.*.damping_ratio=0,0.05")),
    ],
)
def test_nothing_is_laid_over_loads_that_there_are_not(tmp_path: Path, text: str, more: tuple[str, ...]) -> None:
    status, words, _ = _run(tmp_path, text, *more)
    assert status == 1 and "with [dynamics.transient], a run in time" in words

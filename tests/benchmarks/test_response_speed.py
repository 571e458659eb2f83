"""Timings of dynamics: `pytest -m benchmark_suite tests/benchmarks/test_response_speed.py`

K_v charts, branches of sweeps, runs in time, levels, the Campbell study of Uhlir's thesis (16 hours there) beside a plain loop
of solve_ivp, and drawn tooth errors (processor time of all threads). Kernels are compiled before, or read from disk.
"""

import math
import time
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.responses import VARIATION, cosine, oscillator, preloaded, two_stages
from support.specs import TEMPLATES
from support.trains import THESIS_SPEEDS, one_stage, thesis_model

from gearcad import Load, Material
from gearcad.core.runtime import templates
from gearcad.designs import read_spec
from gearcad.designs.train_designs import TrainDesign
from gearcad.dynamics.level_study import study_levels
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.pair_study import study_pair
from gearcad.dynamics.response.branch_continuation import trace
from gearcad.dynamics.response.kv_chart import KvChart, kv_chart
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.time_domain.campbell import campbell
from gearcad.dynamics.time_domain.contact_model import ContactModel
from gearcad.dynamics.time_domain.motion import MovingSystem, RunCourse
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.mesh_excitation import Excitation, MeshExcitation, square_stiffness, train_excitation
from gearcad.dynamics.trains.shaft_lines import System, system
from gearcad.dynamics.trains.train import TrainModel
from gearcad.stiffness import METHODS

pytestmark = pytest.mark.benchmark_suite

SPEEDS = np.linspace(100, 30000, 1000)
MOST_SECONDS = 1.0


def chart(system: System, excitation: Excitation) -> KvChart:
    """With the stability of every motion."""
    return kv_chart(periodic_response(system, excitation, SPEEDS, harmonics=6))


@pytest.mark.parametrize("train", ["one stage, 3 modes", "two stages, 4 modes", "one stage, 10 modes"])
def test_kv_chart(benchmark: Any, train: str) -> None:
    benchmark.group = "K_v chart, 1,000 speeds, 6 harmonics"
    single = Excitation(meshes=(MeshExcitation(stiffness=square_stiffness(1.6)),))
    mode = MeshExcitation(stiffness=square_stiffness(1.6))
    cases = {
        "one stage, 3 modes": (preloaded([3719.3, 14682.9, 64.6], [0.566, -0.256, 0.287], 0.05), cosine(VARIATION)),
        "two stages, 4 modes": (two_stages(), Excitation(meshes=(mode, mode))),
        "one stage, 10 modes": (preloaded(np.linspace(0, 4e4, 10).tolist(), [0.2] * 10, 0.02), single),
    }
    benchmark.pedantic(chart, cases[train], rounds=5, warmup_rounds=1)
    assert benchmark.stats["median"] < MOST_SECONDS


def test_branch_with_jump(benchmark: Any) -> None:
    benchmark.group = "branch over 231 speeds, 16 harmonics, with a jump"
    excitation = cosine(0.2, phase=180.0, backlash=5e6)
    found = benchmark.pedantic(trace, (oscillator(0.05), excitation, np.linspace(0.2, 2.5, 231)), rounds=3)
    assert found.run.max() == 2


STEPS = 200_000

NANOSECONDS = 400.0
"""A step of three modes and one mesh. It takes 120 on a quiet machine."""


def test_a_step_of_three_modes(benchmark: Any) -> None:
    design = read_spec(TEMPLATES / "train-1-stage.toml")
    assert isinstance(design, TrainDesign)
    of = system(design.train)
    assert of.mesh.shape == (3, 1)
    moving = MovingSystem.lumped(of, train_excitation(design.train))
    benchmark.group = f"motion in time: {STEPS} steps of three modes and one mesh"
    benchmark.pedantic(lambda: moving.run(RunCourse.steady(3000.0), 1e-6, STEPS, ends=[STEPS]), rounds=7, warmup_rounds=1)
    step = 1e9 * benchmark.stats.stats.median / STEPS
    benchmark.extra_info["nanoseconds"] = step
    print(f"\n{step:.0f} ns a step")
    assert step < NANOSECONDS


FOUR = (TrainModel.ISOLATED, TrainModel.MASSLESS, TrainModel.MODES, TrainModel.EXACT)
LEVEL_MOST_SECONDS = 3.0


@pytest.mark.parametrize("train", ["train-1-stage", "train-2-stage"])
def test_four_levels(benchmark: Any, train: str) -> None:
    """CPU time: other work on the machine does not count."""
    benchmark.group = "four models, 1,000 speeds each"
    design = read_spec(TEMPLATES / f"{train}.toml")
    assert isinstance(design, TrainDesign)
    spent = []

    def run() -> None:
        start = time.process_time()
        found = study_levels(design.train, FOUR, design.dynamics)
        spent.append(time.process_time() - start)
        assert len(found.sentence) > 100 and all(len(study.speeds) >= 1000 for study in found.studies)

    benchmark.pedantic(run, rounds=3, warmup_rounds=1)
    assert min(spent) < LEVEL_MOST_SECONDS


SECONDS = 2.0
"""41 speeds, 1 s, 200 kHz with spectra, statistics and flags, on 2 cores. It takes 0.4 s, or 1.2 s on a busy machine."""

RATIO = 100.0
"""How many times as long a plain loop takes at least."""

PART = 0.1
"""Seconds of motion that the plain loop is timed for, of the whole one."""

PLAIN = (6000.0, 20000.0)
"""Speeds (rpm) at which it is; their mean stands for all of them."""


def _plain(model: ContactModel, speed: float, duration: float) -> Any:
    """The contact model as (3.44) to (3.47) have it, teeth looked for at each evaluation, by RK45 without events."""
    radii = [1e-3 * radius for radius in model.base_radii]
    first, last, pitch = (1e-3 * x for x in (model.first_contact, model.last_contact, model.base_pitch))
    stiffness, torques = 1e6 * model.pair_stiffness, (model.torque, model.torque * radii[1] / radii[0])

    def rates(_: float, state: Any) -> list[float]:
        travel = radii[0] * state[0]
        approach = travel + radii[1] * state[1]
        pairs = math.floor((last - travel) / pitch) - math.ceil((first - travel) / pitch) + 1
        force = stiffness * pairs * max(approach, 0.0) + model.damping * (radii[0] * state[2] + radii[1] * state[3])
        accelerations = [(torques[i] - radii[i] * force) / model.inertias[i] for i in range(2)]
        return [state[2], state[3], *accelerations]

    rate = speed * math.pi / 30
    start = [0.0, 0.0, rate, -rate * radii[0] / radii[1]]
    times = np.arange(0, duration, 1 / 200_000)
    return solve_ivp(rates, (0, duration), start, t_eval=times, rtol=1e-6, atol=1e-9)


def test_campbell_study_of_the_thesis(benchmark: Any) -> None:
    model = thesis_model()
    benchmark.group = "Campbell study: 41 speeds, 1 s, 200 kHz"
    study = benchmark.pedantic(lambda: campbell(model, THESIS_SPEEDS), rounds=7, warmup_rounds=1)
    assert study.pinion_speed.shape == (41, 15001)
    own = benchmark.stats.stats.median

    began = time.perf_counter()
    for speed in PLAIN:
        assert _plain(model, speed, PART).success
    plain = (time.perf_counter() - began) / len(PLAIN) / PART * len(THESIS_SPEEDS)
    benchmark.extra_info |= {"solve_ivp": plain, "ratio": plain / own}
    print(
        f"\nCampbell study {own:.2f} s, solve_ivp in a loop {plain:.0f} s (from {PART:g} s at {PLAIN} rpm),"
        f" ratio {plain / own:.0f}"
    )
    assert own < SECONDS
    assert plain > RATIO * own


ERROR_SECONDS = 20.0
"""Of processor time, the chart without errors included."""


def drawn(samples: int, speeds: int | None = None, **more: Any) -> DynamicsOptions:
    return DynamicsOptions(
        tooth_errors="on", premature_engagement="on", accuracy_grade=9, error_samples=samples, speeds=speeds, **more
    )


def processor_seconds(study: Any, benchmark: Any) -> float:
    """Of one run, after one that compiles."""
    before = time.process_time()
    benchmark.pedantic(study, rounds=1)
    return time.process_time() - before


def test_train_of_the_paper(benchmark: Any) -> None:
    train = one_stage("modes")
    study_train(train, drawn(1, 2, speed_to=16000.0))
    took = processor_seconds(lambda: study_train(train, drawn(100, speed_to=16000.0)), benchmark)
    print(f"\n100 samples at 200 speeds of a train: {took:.1f} s of processor time")
    assert took < ERROR_SECONDS


def test_pair_of_gears(benchmark: Any) -> None:
    pair = read_spec(templates() / "fzg-c.toml").pair  # type: ignore[union-attr]
    material, load, inertias = Material(), Load(torque=302.0), (3.1e-4, 1.5e-3)
    cycle = METHODS["plane-strain"](pair=pair, material=material)(load)

    def study(options: DynamicsOptions) -> object:
        return study_pair(pair, material, load, cycle, inertias, options)  # type: ignore[arg-type]

    study(drawn(1, 2))
    took = processor_seconds(lambda: study(drawn(100)), benchmark)
    print(f"\n100 samples at 200 speeds of a pair: {took:.1f} s of processor time")
    assert took < ERROR_SECONDS

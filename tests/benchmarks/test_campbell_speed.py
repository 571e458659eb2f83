"""Timing of the Campbell study of Uhlir's thesis (16 hours there), beside a plain loop of solve_ivp measured in the same run.

`pytest -m benchmark_suite tests/benchmarks/test_campbell_speed.py --benchmark-columns=median,rounds -s`

The kernels are compiled before, or read from disk.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.pairs import THESIS_SPEEDS, thesis_model

from gearcad.dynamics.time_domain.campbell import campbell
from gearcad.dynamics.time_domain.contact_model import ContactModel

pytestmark = pytest.mark.benchmark_suite

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

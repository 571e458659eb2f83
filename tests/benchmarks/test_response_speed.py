"""Timings of forced vibration: a K_v chart of 1,000 speeds, and the branch of a sweep with backlash.

`pytest -m benchmark_suite tests/benchmarks/test_response_speed.py --benchmark-columns=median,rounds`
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.responses import VARIATION, cosine, oscillator, preloaded, two_stages

from gearcad.dynamics.response.branch_continuation import trace
from gearcad.dynamics.response.kv_chart import KvChart, kv_chart
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.trains.mesh_excitation import Excitation, MeshExcitation, square_stiffness
from gearcad.dynamics.trains.shaft_lines import System

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

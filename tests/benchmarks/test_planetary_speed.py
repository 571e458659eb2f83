"""Timings of the vibration of planetary trains: natural modes, and loads over speed.

`pytest -m benchmark_suite tests/benchmarks/test_planetary_speed.py --benchmark-columns=median,rounds`
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.mode_trains import MASSES, TRAINS, on_springs

from gearcad.dynamics.planetary.planar_model import train_springs
from gearcad.dynamics.planetary.planetary_excitation import planetary_system
from gearcad.dynamics.planetary.planetary_modes import planetary_modes
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.trains.mesh_excitation import Excitation, MeshExcitation, square_stiffness

pytestmark = pytest.mark.benchmark_suite

MOST_SECONDS = {"modes": 0.05, "chart": 30.0}


@pytest.mark.parametrize("kind", ["A", "D"])
def test_modes(benchmark: Any, kind: str) -> None:
    train = on_springs(TRAINS[kind], support=60.0, pin=200.0)
    benchmark.group = "natural modes of a planetary train, from its gears"
    modes = benchmark(lambda: planetary_modes(train_springs(train, (400.0, 500.0)), MASSES))
    assert len(modes) == 17
    assert benchmark.stats["median"] < MOST_SECONDS["modes"]


def test_chart(benchmark: Any) -> None:
    """Six meshes whose stiffness jumps, 1,000 speeds."""
    train = on_springs(TRAINS["A"], support=60.0, pin=200.0)
    torques = {"a": 100.0, "b": 275.0, "carrier": -375.0}
    system = planetary_system(train_springs(train, (400.0, 500.0)), MASSES, torques, damping_ratio=0.07)
    meshes = tuple(MeshExcitation(stiffness=square_stiffness(1.6), phase=100.0 * mesh) for mesh in range(6))
    speeds = np.linspace(500, 80_000, 1000)
    benchmark.group = "loads over speed of a planetary train"
    found = benchmark.pedantic(lambda: over_speed(system, Excitation(meshes=meshes), speeds), rounds=1)
    assert found.up.factors.max() > 1.2
    assert benchmark.stats["median"] < MOST_SECONDS["chart"]

"""Timing of motions in time: steps of a train, and a run-up through its resonances.

`pytest -m benchmark_suite tests/benchmarks/test_in_time_speed.py --benchmark-columns=median,rounds -s`

The kernel is compiled before, or read from disk.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gearcad.designs import read_spec
from gearcad.designs.train_designs import TrainDesign
from gearcad.dynamics.time_domain.motion import MovingSystem, RunCourse
from gearcad.dynamics.trains.mesh_excitation import train_excitation
from gearcad.dynamics.trains.shaft_lines import system

pytestmark = pytest.mark.benchmark_suite

TEMPLATES = Path(__file__).parents[2] / "templates"

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

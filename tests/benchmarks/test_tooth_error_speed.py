"""Timing of tooth errors drawn many times: 100 samples at 200 speeds of Osinski's train, and of a pair of gears.

`pytest -m benchmark_suite tests/benchmarks/test_tooth_error_speed.py --benchmark-columns=median,rounds -s`

Processor time of all threads; the kernels are compiled before, or read from disk.
"""

from __future__ import annotations

import time
from typing import Any

import pytest
from support.trains import one_stage

from gearcad import Load, Material
from gearcad.core.runtime import templates
from gearcad.designs import read_spec
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.pair_study import study_pair
from gearcad.dynamics.train_study import study_train
from gearcad.stiffness import METHODS

pytestmark = pytest.mark.benchmark_suite

SECONDS = 20.0
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
    assert took < SECONDS


def test_pair_of_gears(benchmark: Any) -> None:
    pair = read_spec(templates() / "fzg-c.toml").pair  # type: ignore[union-attr]
    material, load, inertias = Material(), Load(torque=302.0), (3.1e-4, 1.5e-3)
    cycle = METHODS["plane-strain"](pair=pair, material=material)(load)

    def study(options: DynamicsOptions) -> object:
        return study_pair(pair, material, load, cycle, inertias, options)  # type: ignore[arg-type]

    study(drawn(1, 2))
    took = processor_seconds(lambda: study(drawn(100)), benchmark)
    print(f"\n100 samples at 200 speeds of a pair: {took:.1f} s of processor time")
    assert took < SECONDS

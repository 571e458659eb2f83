"""Timing of a train by four of its models: charts of 1,000 speeds each, and the verdict.

`pytest -m benchmark_suite tests/benchmarks/test_level_speed.py --benchmark-columns=median,rounds`
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest

from gearcad.designs import TrainDesign, read_spec
from gearcad.dynamics.level_study import study_levels
from gearcad.dynamics.trains.train import TrainModel

pytestmark = pytest.mark.benchmark_suite

TEMPLATES = Path(__file__).parents[2] / "templates"
FOUR = (TrainModel.ISOLATED, TrainModel.MASSLESS, TrainModel.MODES, TrainModel.EXACT)
MOST_SECONDS = 3.0


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
    assert min(spent) < MOST_SECONDS

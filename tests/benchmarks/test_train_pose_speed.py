"""How long a train takes to be put together and posed: `pytest -m benchmark_suite tests/benchmarks/test_train_pose_speed.py`"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from support.planetary import thesis_train

from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.poses import train_harmonics

pytestmark = pytest.mark.benchmark_suite

MOST = 0.05
"""Seconds on one core."""


def all_data(train: PlanetaryTrain) -> None:
    """A train made anew of its gears, put together, posed, with its phases, harmonics, and all that documents say of it."""
    made = replace(train)
    made.pose(3.0)
    train_harmonics(made, made.phases)
    made.to_dict()


def test_all_data_of_a_train(benchmark: Any) -> None:
    train = thesis_train()
    benchmark.group = "planetary trains"
    benchmark.pedantic(lambda: all_data(train), rounds=20, warmup_rounds=2)
    assert benchmark.stats.stats.median < MOST


def test_a_pose(benchmark: Any) -> None:
    train = thesis_train()
    benchmark.group = "planetary trains"
    benchmark.pedantic(lambda: train.pose(3.0), rounds=50, warmup_rounds=2)
    assert benchmark.stats.stats.median < MOST / 50

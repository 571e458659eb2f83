"""Timings of planetary statics: sharing with run-out of all members, and the running of the Alm thesis's train.

`pytest -m benchmark_suite tests/benchmarks/test_planetary_sharing_speed.py --benchmark-columns=median,rounds`
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from support.dense_sharing import dense_sharing
from support.sets import alm_train
from support.sharing_trains import Trapezoid, output_torque, sun_set

from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.planetary_statics import torsional_stiffness
from gearcad.dynamics.planetary.quasi_static_run import run_train
from gearcad.planetary import Carrier, PlanetaryTrain, TrainLoad

pytestmark = pytest.mark.benchmark_suite

STIFFNESS = {"sun-planet": 400.0, "ring-planet": 500.0}

MOST_SECONDS = 0.5


def flawed(run_out: float) -> PlanetaryTrain:
    """Six planets, their pins up to 20 µm off, the sun floating."""
    train = sun_set(6, floating=("sun",), carrier=Carrier(pin_stiffness=300.0, pin_errors=(-20.0, 8, 0, 0, 5, 0)))
    return replace(train, centrals=tuple(replace(each, run_out=run_out) for each in train.centrals))


@pytest.mark.parametrize("what", ["errors of pins", "and run-out of two", "dense matrix", "torsional stiffness"])
def test_sharing(benchmark: Any, what: str) -> None:
    benchmark.group = "load sharing, 6 planets"
    train = flawed(20.0 if what == "and run-out of two" else 0.0)
    job = {"dense matrix": dense_sharing, "torsional stiffness": torsional_stiffness}.get(what, share_load)
    benchmark.pedantic(job, (train, TrainLoad(torque=output_torque(train)), STIFFNESS), rounds=10, warmup_rounds=1)
    assert benchmark.stats["median"] < MOST_SECONDS


@pytest.mark.parametrize("torque", [1600.0, 40.0], ids=["in contact", "parted"])
def test_running(benchmark: Any, torque: float) -> None:
    """A turn of the carrier, 70 base pitches, some 5,000 places."""
    benchmark.group = "running over a turn of the carrier"
    train = alm_train(carrier=Carrier(support_stiffness=80.0, pin_stiffness=300.0, pin_errors=(9.0, -4.0, 2.0)))
    train = replace(train, centrals=(train.centrals[0], replace(train.centrals[1], run_out=15.0)))
    courses = {
        "ring_4-rim_3": Trapezoid(212.2, 354.2, 0.72),
        "ring_5-rim_3p": Trapezoid(208.2, 356.9, 0.62),
        "pre_stage": Trapezoid(121.1, 214.7, 0.57),
    }
    load = TrainLoad(torque=torque, speed=955.0)
    benchmark.pedantic(run_train, (train, load, courses), rounds=5, warmup_rounds=1)
    assert benchmark.stats["median"] < MOST_SECONDS * (1 if torque > 1000 else 4)

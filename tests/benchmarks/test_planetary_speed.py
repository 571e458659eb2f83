"""Timings of planetary trains: `pytest -m benchmark_suite tests/benchmarks/test_planetary_speed.py`

Solids are made in a process of its own, which tells its peak memory; times are after imports.
"""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.dense_trains import dense_sharing
from support.planetary import thesis_train
from support.planetary_trains import MASSES, TRAINS, Trapezoid, alm_train, on_springs, output_torque, sun_set

from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.planar_model import train_springs
from gearcad.dynamics.planetary.planetary_excitation import planetary_system
from gearcad.dynamics.planetary.planetary_modes import planetary_modes
from gearcad.dynamics.planetary.planetary_statics import torsional_stiffness
from gearcad.dynamics.planetary.quasi_static_run import run_train
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.trains.mesh_excitation import Excitation, MeshExcitation, square_stiffness
from gearcad.planetary import Carrier, PlanetaryTrain, TrainLoad
from gearcad.planetary.poses import train_harmonics

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


STIFFNESS = {"sun-planet": 400.0, "ring-planet": 500.0}

SHARING_MOST_SECONDS = 0.5


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
    assert benchmark.stats["median"] < SHARING_MOST_SECONDS


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
    assert benchmark.stats["median"] < SHARING_MOST_SECONDS * (1 if torque > 1000 else 4)


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


_CODE = """
import json, resource, sys, tempfile, time
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import cadquery
from support.train_solids import alm_train
from gearcad.solids import FileOptions, Format
from gearcad.solids.files.train_products import TrainProduct
train = alm_train()
found = {}
with tempfile.TemporaryDirectory() as folder:
    for kind in (Format.STEP, Format.GLB):
        start = time.perf_counter()
        path = Path(folder, f"assembly.{kind.value}")
        kind.entry.write_train(TrainProduct(train, FileOptions(carrier=True, turning=True)), path)
        found[f"{kind.value} s"] = time.perf_counter() - start
        found[f"{kind.value} MB"] = path.stat().st_size / 1e6
        if kind is Format.STEP:
            found["peak GB"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9
print(json.dumps(found))
"""

_STEP, _GLB, _PEAK = 10.0, 5.0, 1.5
"""Seconds and GB (10^9 bytes, imports included) that the train of the thesis may take: three stepped planets in two rings, with
carrier and pre-stage."""

_SIZE = 8.0
"""MB of STEP: seven bodies, however many planets."""


def test_files_of_the_thesis_train(record_property: Any) -> None:
    folder = str(Path(__file__).parents[1])
    done = subprocess.run([sys.executable, "-c", _CODE, folder], check=True, capture_output=True, text=True)
    found = json.loads(done.stdout)
    for key, value in found.items():
        record_property(key, value)
    print("\n" + ", ".join(f"{key} {value:.2f}" for key, value in found.items()))
    assert found["step s"] < _STEP
    assert found["glb s"] < _GLB
    assert found["peak GB"] < _PEAK
    assert found["step MB"] < _SIZE

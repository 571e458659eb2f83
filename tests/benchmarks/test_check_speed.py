"""Timings of the structural check, with brute force beside it: `pytest -m benchmark_suite tests/benchmarks/test_check_speed.py`

Each case runs in a process of its own, which tells its peak memory; times are after imports. Compare within one run.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.benchmark_suite

_PREPARE = """
import json, resource, time
import gmsh, skfem, scipy.interpolate, scipy.sparse.linalg
from dataclasses import replace
from gearcad import Gear, GearPair, Load, Material
from gearcad.check.run import check_pair
from gearcad.check.task import check_task
from support.brute import nodal_compliance
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.shared.bodies import BodyModel
from gearcad.meshing.outline import MeshSizes
pair = GearPair(
    pinion=Gear(teeth=18, normal_module=1.5, face_width=10, profile_shift=0.3422, tip_alteration=-0.0104),
    wheel=Gear(teeth=161, normal_module=1.5, face_width=10, profile_shift=0.1682, tip_alteration=-0.0104),
    centre_distance=135.0,
)
start = time.perf_counter()
"""

_TELL = """
seconds = time.perf_counter() - start
print(json.dumps({"seconds": seconds, "peak_GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9}))
"""

CASES = {
    "full rings": ("PlaneCycle.run(plane_pair(pair, Material()), 12.7, 60)", 1.5, 0.5),
    "3 teeth": ("PlaneCycle.run(plane_pair(pair, Material(), body=BodyModel(teeth=3)), 12.7, 60)", 0.8, 0.5),
    "whole check": ("check_pair(check_task(pair, Material(), Load(torque=12.7)))", 10.0, 1.0),
    "brute force, 8 um": (
        "PlaneCycle.run(plane_pair(pair, Material(), sizes=replace(MeshSizes(), flank=0.0053, corner=0.0053), "
        "solve=nodal_compliance), 12.7, 60)",
        None,
        None,
    ),
}
"""What is timed, and how many seconds and GB (10^9 bytes, imports included) it may take; none for the witness."""


def _run(code: str) -> dict[str, float]:
    prepare = f"import sys; sys.path.append({str(Path(__file__).parents[1])!r})\n{_PREPARE}"  # the witness is in `support`
    done = subprocess.run([sys.executable, "-c", prepare + code + _TELL], check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize("name", CASES)
def test_check(benchmark: Any, name: str) -> None:
    code, seconds, memory = CASES[name]
    benchmark.group = "structural check, 18/161, 60 positions"
    runs: list[dict[str, float]] = []
    benchmark.pedantic(lambda: runs.append(_run(code)), rounds=1 if seconds is None else 3, warmup_rounds=0)
    benchmark.extra_info |= {key: min(run[key] for run in runs) for key in runs[0]}
    print(name, benchmark.extra_info)
    if seconds is not None and memory is not None:
        assert benchmark.extra_info["seconds"] < seconds
        assert benchmark.extra_info["peak_GB"] < memory


_INTERNAL = """
from gearcad import Body
from gearcad.geometry import ShaperCutter
pinion = Gear(teeth=22, normal_module=2.0, face_width=14, profile_shift=0.3, body=Body(bore=16.0))
wheel = Gear(teeth=70, normal_module=2.0, face_width=14, profile_shift=-0.3, body=Body(bore=110.0))
ring = replace(wheel, teeth=-70, tip_alteration=-0.1, cutter=ShaperCutter(teeth=25), body=Body(rim_diameter=170.0))
begun = time.process_time()
check_pair(check_task(GearPair(pinion=pinion, wheel={}), Material(), Load(torque=100.0)))
start = time.perf_counter() - (time.process_time() - begun)
"""
"""Tells the seconds of the processor, which other work on the machine does not lengthen."""

_MOST_FOR_A_RING = 1.5
"""Times what a wheel with as many teeth takes: one more neighbour on each side stands in full, as more pairs can touch."""


def test_a_ring_is_checked_nearly_as_fast_as_a_wheel() -> None:
    """The best of three, in turn."""
    found = {name: min(_run(_INTERNAL.format(name))["seconds"] for _ in range(3)) for name in ("wheel", "ring")}
    print(f"wheel {found['wheel']:.2f} s, ring {found['ring']:.2f} s, ratio {found['ring'] / found['wheel']:.2f}")
    assert found["ring"] < _MOST_FOR_A_RING * found["wheel"]

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
from support.brute import nodal_compliance
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.shared.bodies import BodyModel
from gearcad.meshing.section import MeshSizes
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
    "whole check": ("check_pair(pair, Material(), Load(torque=12.7))", 10.0, 1.0),
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

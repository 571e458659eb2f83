"""Timings of checks: `pytest -m benchmark_suite tests/benchmarks/test_solid_speed.py`

Solid pairs, and the check with brute force beside it. Each case runs in a process of its own, which tells its peak memory;
times are after imports. Compare within one run.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.benchmark_suite

_CODE = """
import json, resource, time
import gmsh, skfem, scipy.interpolate, scipy.linalg, scipy.sparse
from dataclasses import replace
from threadpoolctl import threadpool_limits
from gearcad import FlankModification, Material, Mounting
from gearcad.contact.shared.bodies import Cuts
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import solid_pair
from gearcad.designs import read_spec
from gearcad.designs.reader import starter_text
import tempfile, pathlib
with tempfile.TemporaryDirectory() as folder:
    spec = pathlib.Path(folder) / "volvo-13-44.toml"
    spec.write_text(starter_text("volvo")[1])
    pair = read_spec(spec).pair
held = pair.gears.map(lambda gear: gear.root_diameter - 4 * gear.normal_module)
sectors = BodyModel(teeth=3, cuts=Cuts.FREE, inner_diameters=held)
modified = replace(pair, pinion=replace(pair.pinion, modification=FlankModification(tip_relief=15, tip_relief_length=2.0)))
with threadpool_limits(1):
    start = time.perf_counter()
    model = solid_pair(pair, Material(youngs_modulus=205e3), body=BODY)
    SolidCycle.run(model, 220.0, 24)
    first = time.perf_counter()
    SolidCycle.run(model, 150.0, 24)
    load = time.perf_counter()
    SolidCycle.run(model.remade(modified, Mounting()), 220.0, 24)
    modification = time.perf_counter()
print(json.dumps({
    "bodies and 24 positions": first - start, "new load": load - first, "new modification": modification - load,
    "peak_GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9,
}))
"""

CASES = {"3 teeth": ("sectors", 60.0, 2.0), "full rings": ("None", 60.0, 5.0)}
"""Bodies, and how many seconds and GB (10^9 bytes, imports included) the Volvo pair may take."""

_AGAIN = 1.0
"""s: a new load or modification on the same bodies."""


@pytest.mark.parametrize("name", CASES)
def test_volvo_pair(name: str, record_property: Any) -> None:
    body, seconds, memory = CASES[name]
    done = subprocess.run([sys.executable, "-c", _CODE.replace("BODY", body)], check=True, capture_output=True, text=True)
    found = json.loads(done.stdout)
    for key, value in found.items():
        record_property(key, value)
    print(f"\n{name}: " + ", ".join(f"{key} {value:.2f}" for key, value in found.items()))
    assert found["bodies and 24 positions"] < seconds
    assert found["peak_GB"] < memory
    assert max(found["new load"], found["new modification"]) < _AGAIN


_RING_CODE = """
import json, time
import gmsh, skfem, scipy.interpolate, scipy.linalg, scipy.sparse
from threadpoolctl import threadpool_limits
from gearcad import Body, Gear, GearPair, Load, Material, ShaperCutter
from gearcad.check.options import CheckOptions
from gearcad.check.run import check_pair
from gearcad.check.task import check_task
common = {"normal_module": 2.0, "face_width": 14}
pinion = Gear(teeth=22, helix_angle=15, profile_shift=0.3, body=Body(bore=20), **common)
wheel = Gear(teeth=70, helix_angle=-15, body=Body(bore=110), **common)
ring = Gear(
    teeth=-70, helix_angle=15, profile_shift=-0.3, cutter=ShaperCutter(teeth=25, tip_radius=0.2),
    body=Body(rim_diameter=170), **common,
)
found = []
with threadpool_limits(1):
    for mate in (wheel, ring):
        start = time.process_time()
        check_pair(check_task(GearPair(pinion=pinion, wheel=mate), Material(), Load(torque=100), CheckOptions(model="3d")))
        found.append(time.process_time() - start)
print(json.dumps(found))
"""

_RING = 1.5
"""Seconds of a check of a pinion in a ring, over those beside a wheel of as many teeth."""


def test_a_ring_costs_about_as_much_as_a_wheel(record_property: Any) -> None:
    done = subprocess.run([sys.executable, "-c", _RING_CODE], check=True, capture_output=True, text=True)
    wheel, ring = json.loads(done.stdout)
    record_property("wheel", wheel)
    record_property("ring", ring)
    print(f"\nchecked beside a wheel in {wheel:.1f} s, in a ring in {ring:.1f} s")
    assert ring < _RING * wheel


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

CHECK_CASES = {
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


@pytest.mark.parametrize("name", CHECK_CASES)
def test_check(benchmark: Any, name: str) -> None:
    code, seconds, memory = CHECK_CASES[name]
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

"""Timings of solid pairs: `pytest -m benchmark_suite tests/benchmarks/test_solid_speed.py`

Each case runs in a process of its own, which tells its peak memory; times are after imports, and of the same run.
"""

from __future__ import annotations

import json
import subprocess
import sys
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

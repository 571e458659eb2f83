"""Timings of solids of trains: `pytest -m benchmark_suite tests/benchmarks/test_train_solid_speed.py`

In a process of its own, which tells its peak memory; times are after imports.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.benchmark_suite

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

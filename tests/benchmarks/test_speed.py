"""Timings of gears and commands, beside py_gearworks: `pytest -m benchmark_suite tests/benchmarks/test_speed.py`

Large gears and commands: CPU seconds of one process, after a small gear has warmed it up. `-s` shows the shares.
Compare medians within one run; machines are shared and noisy. `beside.py` compares two checkouts.
"""

import math
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from beside import Run, run
from OCP.BRepMesh import BRepMesh_IncrementalMesh

from gearcad import BasicRack, Body, Gear
from gearcad.solids import gear_solid, tessellate, write_step, write_stl
from gearcad.solids.body_plan import STEEL
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.solid import SolidProduct, gear_boundary
from gearcad.solids.files.step import write_product

pytestmark = pytest.mark.benchmark_suite

GEARS: dict[str, dict[str, Any]] = {
    "spur m2 z30": {"teeth": 30, "normal_module": 2.0, "face_width": 20.0},
    "helical z13": {
        "teeth": 13, "normal_module": 2.5, "face_width": 18.3, "helix_angle": 28.0, "profile_shift": 0.107,
        "tooth_thinning": 0.08, "rack": BasicRack(root_radius=0.48),
    },
    "helical z44": {
        "teeth": 44, "normal_module": 2.5, "face_width": 15.1, "helix_angle": -28.0, "profile_shift": -0.378,
        "tooth_thinning": 0.16, "rack": BasicRack(root_radius=0.32),
    },
    "spur m1.5 z161": {"teeth": 161, "normal_module": 1.5, "face_width": 10.0, "profile_shift": 0.1682},
}  # fmt: skip


def _py_gearworks(given: dict[str, Any]) -> Callable[[], Any]:
    peer = pytest.importorskip("py_gearworks", reason="the bench extra is not installed")
    rack = given.get("rack", BasicRack())
    shared = {
        "number_of_teeth": given["teeth"], "module": given["normal_module"], "height": given["face_width"],
        "profile_shift": given.get("profile_shift", 0.0), "dedendum_coefficient": rack.dedendum, "tip_truncation": 0.0,
        "root_fillet": rack.root_radius,
    }  # fmt: skip
    if given.get("helix_angle"):
        helix = math.radians(given["helix_angle"])
        return lambda: peer.HelicalGear(helix_angle=helix, **shared).build_part()
    return lambda: peer.SpurGear(**shared).build_part()


@pytest.mark.parametrize("name", GEARS)
def test_profile(benchmark: Any, name: str) -> None:
    benchmark.group = f"profile within 1 um: {name}"
    benchmark(lambda: Gear(**GEARS[name]).profile.points(0.001))


@pytest.mark.parametrize("maker", ["gearcad", "py_gearworks"])
@pytest.mark.parametrize("name", GEARS)
def test_solid(benchmark: Any, name: str, maker: str) -> None:
    benchmark.group = f"solid: {name}"
    build = (lambda: gear_solid(Gear(**GEARS[name]))) if maker == "gearcad" else _py_gearworks(GEARS[name])
    benchmark.pedantic(build, rounds=7, warmup_rounds=1)


@pytest.mark.parametrize("sign", [1, -1], ids=["external", "ring"])
@pytest.mark.parametrize("teeth", [40, 120, 300])
def test_solid_of_a_ring(benchmark: Any, teeth: int, sign: int) -> None:
    """A ring costs what an external gear of as many teeth does: 0.9 to 1.2 of it."""
    benchmark.group = f"solid: {teeth} teeth, outside and inside"
    body = Body(bore=20, end_chamfer=1) if sign > 0 else Body(rim_diameter=2.5 * teeth, end_chamfer=1)
    given = {"teeth": sign * teeth, "normal_module": 2.0, "face_width": 12.0, "helix_angle": 20.0, "body": body}
    benchmark.pedantic(lambda: gear_solid(Gear(**given)), rounds=7, warmup_rounds=1)


@pytest.mark.parametrize("name", GEARS)
def test_step(benchmark: Any, name: str, tmp_path: Path) -> None:
    benchmark.group = f"STEP: {name}"
    solid = gear_solid(Gear(**GEARS[name]))
    benchmark.pedantic(lambda: write_step(solid, tmp_path / "gear.step", name="gear"), rounds=5, warmup_rounds=1)
    benchmark.extra_info["bytes"] = (tmp_path / "gear.step").stat().st_size


@pytest.mark.parametrize("chord_error", [0.005, 0.001])
@pytest.mark.parametrize("name", GEARS)
def test_stl(benchmark: Any, name: str, chord_error: float, tmp_path: Path) -> None:
    benchmark.group = f"STL at {1000 * chord_error:g} um: {name}"
    gear = Gear(**GEARS[name])
    benchmark.pedantic(lambda: write_stl(tessellate(gear, chord_error), tmp_path / "gear.stl"), rounds=7, warmup_rounds=1)
    benchmark.extra_info["triangles"] = len(tessellate(gear, chord_error).faces)


@pytest.mark.parametrize("name", GEARS)
def test_brep_mesh_at_one_micrometre(benchmark: Any, name: str) -> None:
    """The kernel's own mesher on the same solid at the same absolute chord error, without writing a file."""
    benchmark.group = f"STL at 1 um: {name}"
    solid = gear_solid(Gear(**GEARS[name]))
    benchmark.pedantic(lambda: BRepMesh_IncrementalMesh(solid.wrapped, 0.001, False, 1.0, False), rounds=1, warmup_rounds=0)


def test_import(benchmark: Any) -> None:
    """A whole interpreter: `python -c pass` takes part of it."""
    benchmark.group = "import gearcad (new process)"
    benchmark.pedantic(lambda: subprocess.run([sys.executable, "-c", "import gearcad"], check=True), rounds=7, warmup_rounds=1)


def test_peak_memory(benchmark: Any) -> None:
    """Peak memory of the process so far, after the largest gear (MiB)."""
    benchmark.group = "memory"
    benchmark.pedantic(lambda: gear_solid(Gear(**GEARS["spur m1.5 z161"])), rounds=1)
    benchmark.extra_info["peak_MiB"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


TEETH = (75, 150, 300, 600)

MOST = {0.0: 0.5, 15.0: 1.0}
"""CPU seconds that the data and the STEP file of 300 teeth may take, by helix angle: a helicoid has four times the poles."""

EXPONENT = 1.15
"""Of time over the number of teeth."""


def _gear(teeth: int, helix: float) -> Gear:
    return Gear(teeth=teeth, normal_module=2, face_width=20, helix_angle=helix, body=Body(bore=20))


def _least(action: Callable[[], object], rounds: int = 5) -> float:
    action()
    times = []
    for _ in range(rounds):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def _exponent(seconds: dict[int, float]) -> float:
    return float(np.polyfit(np.log(list(seconds)), np.log(list(seconds.values())), 1)[0])


@pytest.mark.parametrize("helix", MOST)
def test_step_is_linear_in_teeth(helix: float, tmp_path: Path, record_property: Any) -> None:
    def written(teeth: int) -> None:
        write_product(SolidProduct("gear", gear_boundary(_gear(teeth, helix)), STEEL), tmp_path / "gear.step")

    seconds = {teeth: _least(lambda teeth=teeth: written(teeth)) for teeth in TEETH}
    record_property("seconds", seconds)
    exponent = _exponent(seconds)
    print(f"\n{seconds}, exponent {exponent:.2f}")
    assert seconds[300] < MOST[helix]
    assert exponent < EXPONENT


def test_solid_of_the_kernel_is_linear_in_teeth(record_property: Any) -> None:
    seconds = {teeth: _least(lambda teeth=teeth: kernel_solid(gear_boundary(_gear(teeth, 0.0)))) for teeth in TEETH}
    record_property("seconds", seconds)
    print(f"\n{seconds}, exponent {_exponent(seconds):.2f}")
    assert _exponent(seconds) < EXPONENT


ROOT = Path(__file__).parents[2]

_RUNS = 5

START_MOST = {
    "data spur.toml": 0.15,
    "data volvo-13-44.toml": 0.15,
    "build spur.toml": 0.18,
    "build volvo-13-44.toml": 0.26,
    "build ring-22-70.toml": 0.26,
    "build planetary-24-21-66.toml": 0.32,
}
"""Share of what `import cadquery` takes: half as much again as was measured on a busy machine."""


def _median(*command: str) -> float:
    found = [run([sys.executable, *command], ROOT, ROOT / "templates", 60.0, of_output=False) for _ in range(_RUNS + 1)][1:]
    return statistics.median(each.seconds for each in found if isinstance(each, Run))


@pytest.fixture(scope="module")
def library() -> float:
    """What the import takes (s)."""
    return _median("-c", "import cadquery")


@pytest.mark.parametrize("command", START_MOST)
def test_a_command_takes_less_than_a_cad_kernel_does(command: str, library: float) -> None:
    seconds = _median("-m", "gearcad", *command.split())
    print(f"gearcad {command}: {seconds:.2f} s, {seconds / library:.3f} of import cadquery ({library:.2f} s)")
    assert seconds < START_MOST[command] * library

"""Timings of large gears: `pytest -m benchmark_suite tests/benchmarks/test_large_gear_speed.py`

CPU seconds of one process, after a small gear has warmed it up, least of several rounds.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcad import Body, Gear
from gearcad.solids.body_plan import STEEL
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.solid import SolidProduct, gear_boundary
from gearcad.solids.files.step import write_product

pytestmark = pytest.mark.benchmark_suite

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

"""How many variants a second a search for sizes rates on one core, and in how much memory.

`pytest -m benchmark_suite tests/benchmarks/test_sizing_speed.py`
"""

import tracemalloc
from typing import Any

import pytest

from gearcad import Load, Material, PerGear
from gearcad.rating import RatingOptions
from gearcad.sizing import SizeTask
from gearcad.sizing.search import survey

pytestmark = pytest.mark.benchmark_suite

LEAST_RATE = 100_000.0
"""Variants rated in full, a second and core."""

MOST_MEMORY = 200e6
"""Bytes of arrays at a time, however many variants there are."""

EH = Material(name="Eh MQ")
TASK = SizeTask(
    load=Load(torque=302.0, speed=1500.0, application_factor=1.25),
    ratio=1.5,
    materials=PerGear(EH, EH),
    rating=RatingOptions(life=20000.0),
)


def test_variants_a_second(benchmark: Any) -> None:
    benchmark.group = "search for sizes"
    seen = benchmark.pedantic(survey, (TASK,), rounds=3, warmup_rounds=1)
    benchmark.extra_info["variants rated"] = seen.rated
    assert seen.rated > 5e5
    assert seen.rated / benchmark.stats["median"] > LEAST_RATE


def test_memory() -> None:
    tracemalloc.start()
    survey(TASK)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < MOST_MEMORY

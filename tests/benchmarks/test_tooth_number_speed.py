"""How long a search for tooth numbers takes: `pytest -m benchmark_suite tests/benchmarks/test_tooth_number_speed.py`"""

from __future__ import annotations

from typing import Any

import pytest

from gearcad.planetary.members import SetType
from gearcad.planetary.search import search
from gearcad.planetary.tooth_numbers import SearchTask

pytestmark = pytest.mark.benchmark_suite

MOST_SECONDS = 2.0
"""For a hundred thousand sets and more, twenty trains made of the best."""

TASKS = {
    "A": SearchTask(ratio=5.2, module=2.0, planets=(2, 6), teeth=(15, 110)),
    "B": SearchTask(ratio=7.3, module=2.0, module_2=2.5, types=(SetType.B,)),
    "C": SearchTask(ratio=-30.0, module=2.0, types=(SetType.C,)),
    "D": SearchTask(ratio=13.9, module=2.0, types=(SetType.D,)),
}


@pytest.mark.parametrize("name", TASKS)
def test_search(benchmark: Any, name: str) -> None:
    benchmark.group = "search for tooth numbers"
    result = benchmark.pedantic(search, (TASKS[name],), rounds=3, warmup_rounds=1)
    assert result.considered > 1e5
    assert len(result.found) == 20
    assert benchmark.stats["median"] < MOST_SECONDS


def test_nothing_found(benchmark: Any) -> None:
    """Then the tolerance is widened until something is."""
    benchmark.group = "search for tooth numbers"
    result = benchmark.pedantic(search, (SearchTask(ratio=90.0, module=2.0, planets=(2, 6)),), rounds=3, warmup_rounds=1)
    assert result.nearest
    assert benchmark.stats["median"] < MOST_SECONDS

"""Timings of searches: `pytest -m benchmark_suite tests/benchmarks/test_search_speed.py`"""

from typing import Any

import numpy as np
import pytest
from support.checks import PAIRS, TORQUES, coarse_model
from threadpoolctl import threadpool_limits

from gearcad.contact.modification_search import start_search
from gearcad.geometry import ReliefShape
from gearcad.planetary.members import SetType
from gearcad.planetary.search import search
from gearcad.planetary.tooth_numbers import SearchTask

pytestmark = pytest.mark.benchmark_suite

VARIANTS = 60
"""As many as a generation of the search has."""

LEAST = 300.0
"""Variants a second on one core."""


@pytest.mark.parametrize("name", PAIRS)
def test_variants(benchmark: Any, name: str) -> None:
    with threadpool_limits(1):
        search = start_search(coarse_model(name), TORQUES[name], ReliefShape.LINEAR)
        share = np.random.default_rng(0).random((VARIANTS, len(search.low)))
        amounts = search.low + share * (search.high - search.low)
        benchmark.group = "variants of flank modifications"
        benchmark.pedantic(lambda: search.outcomes(amounts), rounds=8, warmup_rounds=1)
    benchmark.extra_info["variants a second"] = VARIANTS / benchmark.stats.stats.min
    print(name, [given.cells for given in search.variants.positions], benchmark.extra_info)
    assert benchmark.extra_info["variants a second"] > LEAST


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

"""How many variants of flank modifications a second: `pytest -m benchmark_suite tests/benchmarks/test_search_speed.py`"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.coarse import PAIRS, TORQUES, coarse_model
from threadpoolctl import threadpool_limits

from gearcad.contact.modification_search import start_search
from gearcad.geometry import ReliefShape

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

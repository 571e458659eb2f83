"""Brent's rule finds what SciPy's finds, bit for bit: our gears do not change with the import that is saved."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest
from scipy.optimize import brentq

from gearcad import SolverError
from gearcad.geometry.involute import root_between


def functions(chance: random.Random) -> Callable[[float], float]:
    a, b, c, d = (chance.uniform(-3, 3) for _ in range(4))
    kinds: tuple[Callable[[float], float], ...] = (
        lambda x: a * x**3 + b * x + c,
        lambda x: math.atan(a * (x - c)) + b / 1000,
        lambda x: math.exp(a * x) - abs(b),
        lambda x: a * math.sin(d * x) + b * x,
        lambda x: math.copysign(1.0, x - c),
    )
    return chance.choice(kinds)


@pytest.mark.parametrize("tolerances", [{}, {"xtol": 1e-14}, {"xtol": 1e-15, "rtol": 8.9e-16}])
def test_roots_are_those_of_scipy_to_the_last_bit(tolerances: dict[str, float]) -> None:
    chance, found = random.Random(3), 0
    while found < 500:
        function, low, high = functions(chance), chance.uniform(-4, 0), chance.uniform(0, 4)
        if function(low) * function(high) > 0:
            continue
        found += 1
        assert root_between(function, low, high, **tolerances) == brentq(function, low, high, **tolerances)


def test_ends_of_one_sign_are_refused() -> None:
    with pytest.raises(ValueError, match="different signs"):
        root_between(lambda x: x + 2.0, 0.0, 1.0)


def test_root_that_is_not_reached_is_an_error() -> None:
    with pytest.raises(SolverError, match="no root to 1e-300"):
        root_between(lambda x: (x - 0.3) ** 5, 0.0, 1.0, xtol=1e-300, rtol=1e-17)

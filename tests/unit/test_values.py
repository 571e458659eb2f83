"""Functions of numbers or arrays: a number gives the number of `math`, an array the same to rounding."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gearcad.core import values

ROUNDING = 1e-15
"""Relative: numpy's functions are not those of `math`, whose last digits may differ."""

ONE = (
    (values.sin, math.sin),
    (values.cos, math.cos),
    (values.tan, math.tan),
    (values.arcsin, math.asin),
    (values.arccos, math.acos),
    (values.arctan, math.atan),
    (values.radians, math.radians),
    (values.degrees, math.degrees),
    (values.root, math.sqrt),
    (values.fourth_root, lambda value: math.pow(value, 0.25)),
    (values.magnitude, abs),
)
TWO = (
    (values.larger, max),
    (values.smaller, min),
    (values.hypot, math.hypot),
    (values.arctan2, math.atan2),
    (values.with_sign, math.copysign),
)
PLACES = [0.05, 0.3, 0.7, 0.95]


@pytest.mark.parametrize(("function", "of_number"), ONE)
def test_one_argument(function: Callable[..., Any], of_number: Callable[..., float]) -> None:
    expected = [of_number(place) for place in PLACES]
    assert [function(place) for place in PLACES] == expected
    assert all(type(function(place)) is float for place in PLACES)
    assert function(np.array(PLACES)) == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize(("function", "of_numbers"), TWO)
@pytest.mark.parametrize("other", [-0.4, 0.5])
def test_two_arguments(function: Callable[..., Any], of_numbers: Callable[..., float], other: float) -> None:
    expected = [of_numbers(place, other) for place in PLACES]
    assert [function(place, other) for place in PLACES] == expected
    assert all(type(function(place, other)) is float for place in PLACES)
    for given in (other, np.full(len(PLACES), other)):
        assert function(np.array(PLACES), given) == pytest.approx(expected, rel=ROUNDING)
    assert function(PLACES[0], np.array([other])) == pytest.approx([expected[0]], rel=ROUNDING)

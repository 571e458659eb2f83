"""Splines of our own beside those of SciPy, whose formulas they are."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, PchipInterpolator

from gearcad.splines import cubic_spline, monotone_spline

ROUNDING = 1e-12
"""Of values about 1: two ways to solve some thirty equations."""


def _values(count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return np.cumsum(rng.uniform(0.2, 1.0, count)), rng.normal(size=(count, 5))


@pytest.mark.parametrize("count", [2, 3, 4, 5, 30])
def test_a_cubic_spline_is_that_of_scipy(count: int) -> None:
    places, values = _values(count)
    at = np.linspace(places[0] - 0.3, places[-1] + 0.3, 41)
    np.testing.assert_allclose(cubic_spline(places, values)(at), CubicSpline(places, values)(at), rtol=0, atol=100 * ROUNDING)
    np.testing.assert_allclose(cubic_spline(places, values[:, 0])(places[1]), values[1, 0], rtol=0, atol=ROUNDING)


def test_a_monotone_spline_is_that_of_scipy() -> None:
    places, values = _values(40)
    values[5:9, 0] = 0.7  # a level piece, and turns everywhere
    values[:, 1] = np.sort(values[:, 1])
    at = np.linspace(places[0], places[-1], 301)
    found = monotone_spline(places, values)(at)
    np.testing.assert_allclose(found, PchipInterpolator(places, values)(at), rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("make, witness", [(cubic_spline, CubicSpline), (monotone_spline, PchipInterpolator)])
def test_integrals_are_those_of_scipy(make, witness) -> None:
    places, values = _values(12)
    at = np.linspace(places[0], places[-1], 23).reshape(1, 23)
    np.testing.assert_allclose(make(places, values).integral(at), witness(places, values).antiderivative()(at), atol=ROUNDING)


def test_a_cubic_is_met_everywhere() -> None:
    places = np.array([0.0, 0.3, 1.0, 1.1, 2.5])
    at = np.linspace(-1, 3, 17)
    np.testing.assert_allclose(cubic_spline(places, places**3 - places)(at), at**3 - at, atol=ROUNDING)

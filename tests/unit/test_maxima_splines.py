"""Maxima and splines are those of SciPy, whose packages are not imported for them."""

from __future__ import annotations

import numpy as np
import pytest

from gearcad.dynamics.maxima import apart, outstanding
from gearcad.geometry.spline import Spline

ROUNDING = 1e-13
"""Relative: two ways of solving the same equations, of splines whose places are a thousandth of their mean step apart."""


@pytest.mark.parametrize("seed", range(40))
def test_maxima_that_stand_out(seed: int) -> None:
    """Of courses of whole numbers, which stay alike at many places."""
    from scipy.signal import find_peaks

    random = np.random.default_rng(seed)
    values = np.cumsum(random.integers(-2, 3, random.integers(1, 150))).astype(float)
    for prominence in (0.0, 1.0, 3.5):
        assert outstanding(values, prominence).tolist() == find_peaks(values, prominence=prominence)[0].tolist()


@pytest.mark.parametrize("seed", range(40))
def test_maxima_apart_from_each_other(seed: int) -> None:
    from scipy.signal import find_peaks

    values = np.random.default_rng(seed).normal(size=150)
    for distance in (1, 2, 7, 40):
        assert apart(values, distance).tolist() == find_peaks(values, distance=distance)[0].tolist()


def test_of_two_maxima_that_are_alike_one_stays() -> None:
    values = np.array([0.0, 2, 0, 2, 2, 0, 1, 0])
    assert apart(values, 1).tolist() == [1, 3, 6]
    assert apart(values, 3).tolist() == [3, 6]


@pytest.mark.parametrize("count", [4, 5, 40])
@pytest.mark.parametrize("shape", [(), (3,)])
def test_splines_and_their_integrals(count: int, shape: tuple[int, ...]) -> None:
    from scipy.interpolate import CubicSpline

    random = np.random.default_rng(count)
    places, values = np.cumsum(random.uniform(0.001, 2.0, count)), random.normal(size=(count, *shape))
    at = np.linspace(places[0] - 0.1, places[-1] + 0.1, 60).reshape(3, 20)
    theirs = CubicSpline(places, values)
    for own, other in ((Spline(places, values), theirs), (Spline(places, values).integral, theirs.antiderivative())):
        np.testing.assert_allclose(own(at), other(at), rtol=0, atol=ROUNDING * np.abs(other(at)).max())


def test_a_cubic_is_its_own_spline() -> None:
    places = np.array([0.0, 0.3, 1.0, 1.2, 2.0])
    np.testing.assert_allclose(Spline(places, places**3)(np.array([-1.0, 0.7, 3.0])), [-1.0, 0.343, 27.0], atol=1e-12)


def test_splines_need_four_places() -> None:
    with pytest.raises(ValueError, match="needs 4 places"):
        Spline(np.arange(3.0), np.zeros(3))

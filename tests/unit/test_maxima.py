"""Maxima are those of SciPy, whose package is not imported for them."""

from __future__ import annotations

import numpy as np
import pytest

from gearcad.dynamics.time_domain.spectra import apart, outstanding


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

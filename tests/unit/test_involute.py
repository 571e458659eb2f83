"""The involute function and its inverse."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from gearcad import GearcadError
from gearcad.geometry import inverse_involute, involute

ROUNDING = 1e-13
"""Relative: some units in the last place."""


@pytest.mark.parametrize("angle", [1e-3, 0.1, 1.0, 14.5, 20.0, 22.402523646885253, 45.0, 70.0, 89.0, 89.99])
def test_inverse_involute_returns_the_angle(angle: float) -> None:
    # At small angles inv a = a^3/3 loses eps/a^2 of relative precision to the difference tan a - a.
    rounding = max(ROUNDING, 4e-16 / math.radians(angle) ** 2)
    assert inverse_involute(involute(angle)) == pytest.approx(angle, rel=rounding)


def test_arrays_keep_their_shape() -> None:
    angles = np.linspace(5, 80, 24).reshape(2, 3, 4)
    found = inverse_involute(involute(angles))
    assert found.shape == angles.shape
    assert_allclose(found, angles, rtol=ROUNDING)
    assert isinstance(involute(20.0), float)
    assert isinstance(inverse_involute(0.0149), float)


def test_known_values() -> None:
    # inv 20 deg = 0.014904383867336446 (every gear book prints 0.014904)
    assert involute(20.0) == pytest.approx(0.014904383867336446, rel=ROUNDING)
    assert involute(0.0) == 0.0
    assert inverse_involute(0.0) == 0.0


@pytest.mark.parametrize("value", [-1e-12, -1.0, math.nan])
def test_no_angle_has_a_negative_involute(value: float) -> None:
    with pytest.raises(GearcadError) as caught:
        inverse_involute(np.array([0.01, value]))
    assert "involute" in str(caught.value)

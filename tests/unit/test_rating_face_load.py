"""Face load factors: values by hand, the row of springs behind them, and running in."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from gearcad import Gear, GearPair, ParameterError
from gearcad.rating import RunningIn, face_load_factor, root_face_load_factor, running_in_beta, width_to_height
from gearcad.rating.load_factor_formulas import bearing_width, face_load_exponent


@pytest.mark.parametrize(
    ("misalignment", "stiffness", "load", "width", "factor"),
    [
        (10.0, 17.0, 300.0, 0.5 + 300 / 170, 1 + 170 / 600),  # 1.2833: all of the width carries
        (10.0, 20.0, 100.0, 1.0, 2.0),  # the load ends just at the edge
        (40.0, 20.0, 100.0, 0.5, 4.0),  # half of the width carries a triangle
        (-40.0, 20.0, 100.0, 0.5, 4.0),  # at the other end
        (0.0, 17.0, 300.0, math.inf, 1.0),
    ],
)
def test_values_by_hand(misalignment: float, stiffness: float, load: float, width: float, factor: float) -> None:
    assert bearing_width(misalignment, stiffness, load) == pytest.approx(width, rel=1e-12)
    assert face_load_factor(misalignment, stiffness, load) == pytest.approx(factor, rel=1e-12)


@pytest.mark.parametrize("misalignment", [1.0, 7.0, 18.0, 35.0, 200.0])
def test_a_row_of_springs_has_that_factor(misalignment: float) -> None:
    """Springs of 16 N/(mm·µm) under flanks that stand off by up to F_beta: pressed together until they carry the load."""
    stiffness, mean = 16.0, 150.0
    stand_off = misalignment * (np.arange(20_000) + 0.5) / 20_000

    def carried(approach: float) -> np.ndarray:
        return stiffness * np.maximum(approach - stand_off, 0)

    approach = brentq(lambda value: carried(value).mean() - mean, 0, 1000, xtol=1e-12)
    assert face_load_factor(misalignment, stiffness, mean) == pytest.approx(stiffness * approach / mean, rel=1e-4)


def test_the_root_feels_less_of_it_the_narrower_the_tooth() -> None:
    """N_F at b/h = 8 is 64/73; below 3 it stays 9/13."""
    assert root_face_load_factor(1.5, 8.0) == pytest.approx(1.5 ** (64 / 73), rel=1e-12)
    assert face_load_exponent(3.0) == face_load_exponent(1.2) == pytest.approx(9 / 13, rel=1e-12)
    assert root_face_load_factor(1.0, 8.0) == 1.0


def test_the_narrower_tooth_for_its_height_counts() -> None:
    """Module 2: both teeth are 4.5 mm high; the pinion is the narrower one."""
    pair = GearPair(
        pinion=Gear(teeth=20, normal_module=2.0, face_width=18.0), wheel=Gear(teeth=40, normal_module=2.0, face_width=22.0)
    )
    assert width_to_height(pair) == pytest.approx(4.0, rel=1e-12)


@pytest.mark.parametrize(
    ("material", "misalignment", "speed", "limit", "expected"),
    [
        (RunningIn.SURFACE_HARDENED, 20.0, 3.0, None, 3.0),
        (RunningIn.SURFACE_HARDENED, 40.0, 30.0, None, 6.0),
        (RunningIn.SURFACE_HARDENED, 90.0, 30.0, None, 6.0),
        (RunningIn.CAST_IRON, 100.0, 5.0, None, 55.0),
        (RunningIn.CAST_IRON, 100.0, 10.0, None, 45.0),
        (RunningIn.CAST_IRON, 100.0, 10.1, None, 22.0),
        (RunningIn.THROUGH_HARDENED, 100.0, 5.0, 640.0, 50.0),
        (RunningIn.THROUGH_HARDENED, 100.0, 10.0, 640.0, 40.0),
        (RunningIn.THROUGH_HARDENED, 100.0, 10.1, 640.0, 20.0),
        (RunningIn.THROUGH_HARDENED, 10.0, 1.0, 300.0, 10.0),
    ],
)
def test_running_in(material: RunningIn, misalignment: float, speed: float, limit: float | None, expected: float) -> None:
    assert running_in_beta(misalignment, material, speed, limit) == pytest.approx(expected, rel=1e-12)


def test_through_hardened_flanks_need_their_limit() -> None:
    with pytest.raises(ParameterError, match="flank_limit = None: must be a number above 0 MPa"):
        running_in_beta(10.0, RunningIn.THROUGH_HARDENED, 1.0)

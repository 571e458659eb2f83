"""MeshCycle: means, series and the curve between its points, against closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcad.core.errors import SolverError
from gearcad.mesh_cycle import MeshCycle

Floats = NDArray[np.float64]


def _cycle(angle: Floats, stiffness: Floats, **more: Any) -> MeshCycle:
    return MeshCycle(
        method="made up",
        holds=(),
        torque=1.0,
        force=100.0,
        width=10.0,
        roll_angle=angle,
        mesh_stiffness=stiffness,
        tangent_stiffness=1.1 * stiffness,
        transmission_error=np.divide(100.0, stiffness, where=stiffness != 0, out=np.zeros_like(stiffness)),
        **more,
    )


def _square(low: float = 100.0, high: float = 160.0, share: float = 0.57) -> MeshCycle:
    """High for a share of a pitch of 20 deg, that begins at -10 deg."""
    jump = -10 + 20 * share
    angle = np.r_[np.linspace(-10, jump, 101), np.linspace(jump, 10, 75)]
    return _cycle(angle, np.r_[np.full(101, high), np.full(75, low)])


def test_mean_with_a_jump() -> None:
    assert _square().mean == pytest.approx(0.57 * 160 + 0.43 * 100, rel=1e-14)
    assert _square().secant_per_width == pytest.approx(_square().mean / 10, rel=1e-14)
    assert _square().tangent_mean == pytest.approx(1.1 * _square().mean, rel=1e-14)


def test_mean_between_jumps_is_of_fourth_order() -> None:
    angle = np.r_[np.linspace(-10, 0, 11), np.linspace(0, 10, 11)]
    stiffness = np.r_[50 + np.exp(angle[:11] / 10), 80 + np.exp(angle[11:] / 10)]
    exact = 65 + (math.e - 1 / math.e) / 2
    assert _cycle(angle, stiffness).mean == pytest.approx(exact, rel=1e-7)


def test_mean_of_a_periodic_curve() -> None:
    angle = np.linspace(-9.5, 10.5, 41)
    smooth = 1 / (2 + np.cos(2 * np.pi * angle / 20))
    assert _cycle(angle, 100 * smooth).mean == pytest.approx(100 / math.sqrt(3), rel=1e-12)


def test_series_of_a_square_wave() -> None:
    """a_n, b_n of a square wave in closed form; the phase counts from roll angle 0."""
    series = _square().fourier(12)
    n = np.arange(1, 13)
    first, last = -math.pi, -math.pi + 2 * math.pi * 0.57
    assert series.mean == pytest.approx(_square().mean, rel=1e-14)
    assert series.cosine == pytest.approx(60 * (np.sin(n * last) - np.sin(n * first)) / (np.pi * n), abs=60 * 2e-5)
    assert series.sine == pytest.approx(-60 * (np.cos(n * last) - np.cos(n * first)) / (np.pi * n), abs=60 * 2e-5)
    assert series.amplitude == pytest.approx(np.hypot(series.cosine, series.sine))


def test_series_sums_to_the_curve() -> None:
    angle = np.linspace(-10, 10, 81)
    curve = 100 + 20 * np.cos(2 * np.pi * angle / 20 + 0.3) + 5 * np.sin(6 * np.pi * angle / 20)
    series = _cycle(angle, curve).fourier(5)
    turns = 2 * np.pi * np.outer(np.arange(1, 6), angle) / 20
    assert series.mean + series.cosine @ np.cos(turns) + series.sine @ np.sin(turns) == pytest.approx(curve, rel=1e-12)


def test_more_harmonics_than_points_tell() -> None:
    with pytest.raises(ValueError, match=r"harmonics = 40: must be a whole number from 1 to 20"):
        _cycle(np.linspace(0, 20, 81), np.full(81, 100.0)).fourier(40)


def test_curve_goes_on() -> None:
    cycle = _square()
    assert cycle.stiffness_at([-9.0, 11.0, 31.0, -29.0]) == pytest.approx([160.0] * 4)
    assert cycle.stiffness_at(9.0) == 100.0
    assert cycle.stiffness_at(9.0, tangent=True) == pytest.approx(110.0)
    assert cycle.pitch_point == 160.0
    assert (cycle.maximum, cycle.minimum, cycle.pitch_angle) == (160.0, 100.0, 20.0)
    assert cycle.error_peak_to_peak == pytest.approx(100 / 100 - 100 / 160)


@pytest.mark.parametrize("wrong", [math.nan, math.inf, 0.0, -3.0])
def test_never_without_a_value(wrong: float) -> None:
    with pytest.raises(SolverError, match="made up"):
        _cycle(np.linspace(0, 20, 5), np.array([1.0, 2.0, wrong, 2.0, 1.0]))


def test_arrays_are_read_only_and_document_is_plain() -> None:
    cycle = replace(_square(), pairs=(0,), load_share=np.ones((176, 1)), compliance_parts={"all": np.ones(176)})
    with pytest.raises(ValueError, match="read-only"):
        cycle.mesh_stiffness[0] = 1.0
    document = cycle.to_dict()
    assert document["c_gamma_beta"] == cycle.secant_per_width
    assert document["mesh_cycle"]["compliance_parts"]["all"] == [1.0] * 176
    assert "maximum" not in replace(cycle, mean_only=True).to_dict()

"""Gears that travel as well as turn, against Newton's equations of two free bodies, integrated by scipy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.free_bodies import FreeBodies, Period
from support.responses import cosine

from gearcad.core.records import Floats
from gearcad.dynamics.response.kv_chart import KvChart, kv_chart
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings

PAIR = PairOnBearings(
    masses=(0.8, 3.1),
    inertias=(4e-4, 7e-3),
    base_radii=(28.0, 66.0),
    working_transverse_pressure_angle=21.5,
    mesh_stiffness=240.0,
    bearing_stiffness=((300.0, 120.0), (450.0, 900.0)),
    torque=80.0,
    mesh_damping=900.0,
    bearing_damping=150.0,
)
RING = replace(PAIR, base_radii=(28.0, -66.0), bearing_stiffness=((500.0, 700.0), (200.0, 90.0)))
VARIATION = 0.3

SAMPLED = 1e-4
"""Relative: how far greatest values of some hundred samples a period are off those of others."""


def half_range(course: Floats) -> float:
    return float(np.ptp(course)) / 2


def same(chart: KvChart, row: int, expected: Period, pair: PairOnBearings, tolerance: float) -> None:
    """All that a chart tells of one speed."""
    force = pair.torque / (pair.base_radii[0] / 1000)
    assert chart.factors[row, 0] * force == pytest.approx(expected.spring.max(), rel=tolerance)
    assert chart.damped[row, 0] * force == pytest.approx(expected.force.max(), rel=tolerance)
    assert chart.least[row, 0] * force == pytest.approx(expected.spring.min(), rel=tolerance, abs=tolerance * force)
    moved = chart.displacements
    assert moved.approaches[row, 0] == pytest.approx(1e6 * half_range(expected.approach), rel=tolerance)
    assert moved.deepest[row, 0] == pytest.approx(1e6 * expected.approach.max(), rel=tolerance)
    turns = [3600 * np.degrees(half_range(turn)) for turn in expected.turns]
    assert moved.turns[row] == pytest.approx(turns, rel=tolerance)
    assert np.isnan(moved.farthest[row]).all()  # free to turn
    loads = chart.bearings
    assert loads is not None and loads.static == pytest.approx(force)
    along = np.array([np.sin(a := np.radians(pair.working_transverse_pressure_angle)), np.cos(a)])
    for gear, (sense, on) in enumerate(zip((-1, 1), expected.bearings, strict=True)):
        assert loads.greatest[row, gear] == pytest.approx(np.hypot(*on).max(), rel=tolerance)
        line = sense * along @ on
        assert loads.along[row, :, gear] == pytest.approx([line.max(), line.min()], rel=tolerance, abs=tolerance * force)
        across = np.array([along[1], -along[0]]) @ on
        assert loads.across[row, :, gear] == pytest.approx([across.max(), across.min()], abs=tolerance * force)


@pytest.mark.parametrize("pair", [PAIR, RING], ids=["wheel", "ring"])
def test_flanks_in_contact(pair: PairOnBearings) -> None:
    frequencies = [4000.0, 9000.0, 16400.0, 26000.0]
    chart = kv_chart(periodic_response(pair.system(), cosine(VARIATION), frequencies, harmonics=40))
    for row, frequency in enumerate(frequencies):
        same(chart, row, FreeBodies(pair, frequency, VARIATION).periodic(), pair, SAMPLED)


@pytest.mark.long
@pytest.mark.parametrize(
    ("mesh_damping", "backlash", "frequency"), [(600.0, np.inf, 31000.0), (400.0, 8.0, 30500.0)], ids=["parted", "at the back"]
)
def test_flanks_that_part(mesh_damping: float, backlash: float, frequency: float) -> None:
    """Between the jumps, where running up and down show the same, from rest; with 8 µm the flanks at the back meet too."""
    pair = replace(PAIR, mesh_damping=mesh_damping, bearing_damping=2000.0)
    over = over_speed(pair.system(), cosine(VARIATION, backlash=backlash), np.linspace(10500.0, 31500.0, 43))
    expected = FreeBodies(pair, frequency, VARIATION, backlash * 1e-6).settled(120)
    assert over.down is not None
    for chart in (over.up, over.down):
        row = int(np.flatnonzero(chart.frequencies == frequency)[0])
        assert chart.least[row, 0] <= 0
        same(chart, row, expected, pair, SAMPLED)

"""Forced vibration: the resonance charts of J. Osinski's paper (computed anew), Meissner's and Mathieu's equations, the jump.

Figures of the paper's trains were computed by another harmonic balance of the whole system and by time integration; those of
the jump by Runge-Kutta with 100 steps a period, 200 periods at every speed.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b
from support.floquet import floquet_multipliers, monodromy
from support.responses import STIFFNESS, VARIATION, cosine, isolated, oscillator, preloaded, two_stages

from gearcad.dynamics.response.branch_continuation import trace
from gearcad.dynamics.response.kv_chart import kv_chart
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, CurveStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import Direction

COMPONENT_MODES = [3719.28572070, 14682.88891153, 64.56267647]
"""Of the two shafts, clamped at the far end with their gear at the other: two of the first, one of the second (1/s)."""

MODE_AT_MESH = [0.56626937, -0.25649627, 0.28662289]
"""What these modes move along the line of action."""

GRID = np.arange(100, 30001, 50.0)
CHART = 0.01
"""The charts are read at every 50 1/s, and their peaks are broad: frequencies within 1 %."""

VALUE = 1e-3
"""Peak values were given with three decimals."""


def train(loss: float) -> System:
    return preloaded(COMPONENT_MODES, MODE_AT_MESH, loss)


def peaks(system: System) -> NDArray[np.float64]:
    """Frequencies and values of the peaks above 1.05."""
    found = kv_chart(periodic_response(system, cosine(VARIATION), GRID)).peaks()
    return np.array([peak for peak in found if peak.factor > 1.05])


def test_isolated_pair() -> None:
    assert peaks(isolated())[-1] == pytest.approx([19750, 1.615], rel=CHART)
    assert peaks(isolated())[-1, 1] == pytest.approx(1.615, abs=VALUE)


def test_train_with_shafts() -> None:
    expected = np.array([[1650, 1.176], [6350, 1.092], [12650, 1.452], [20600, 1.55]])
    found = peaks(train(0.05))
    assert found[:, 0] == pytest.approx(expected[:, 0], rel=CHART)
    assert found[:, 1] == pytest.approx(expected[:, 1], abs=VALUE)


@pytest.mark.parametrize(
    ("loss", "third", "fourth"), [(0.01, 1.742, 1.589), (0.02, 1.625, 1.579), (0.05, 1.452, 1.55), (0.1, 1.348, 1.512)]
)
def test_damping_of_the_shafts(loss: float, third: float, fourth: float) -> None:
    assert peaks(train(loss))[-2:, 1] == pytest.approx([third, fourth], abs=VALUE)


def test_strongly_damped_shafts() -> None:
    """At WM = 0.2 the third resonance is no more than a shoulder of the fourth."""
    chart = kv_chart(periodic_response(train(0.2), cosine(VARIATION), GRID))
    assert peaks(train(0.2))[-1, 1] == pytest.approx(1.462, abs=VALUE)
    assert chart.factors[(GRID > 11500) & (GRID < 13500), 0].max() == pytest.approx(1.291, abs=VALUE)


@pytest.mark.parametrize("frequency", [6350.0, 12750.0, 19863.0])
def test_against_time_integration(frequency: float) -> None:
    """From the state that harmonic balance gives, four tooth periods by DOP853 come back to it."""
    system = train(0.05)
    response = periodic_response(system, cosine(VARIATION), [frequency], harmonics=8)
    period = 2 * np.pi / frequency
    # Modes from the mesh force: each is an oscillator of its own.
    force = response.spring_forces(count=256)[0, :, 0] + response.damping_forces(count=256)[0, :, 0]
    order = np.arange(33)
    spectrum = np.fft.rfft(force)[:33] / 256
    load = np.where(order[:, None] == 0, system.load, 0)
    rates = 1j * order[:, None] * frequency
    modes = (load - spectrum[:, None] * system.mesh[:, 0]) / (system.squares + rates**2 + rates * system.damping)
    twice = np.where(order == 0, 1, 2)
    start = np.concatenate([twice @ modes.real, twice @ (rates * modes).real])

    def derivative(t: float, state: NDArray[np.float64]) -> NDArray[np.float64]:
        z, speed = state[:3], state[3:]
        y, rate = system.mesh[:, 0] @ z, system.mesh[:, 0] @ speed
        push = STIFFNESS * (1 - VARIATION * np.cos(frequency * t)) * y + system.mesh_damping[0] * rate
        return np.concatenate([speed, system.load - system.squares * z - system.damping * speed - system.mesh[:, 0] * push])

    times = 3 * period + period * np.arange(256) / 256
    solved = solve_ivp(derivative, (0, 4 * period), start, "DOP853", rtol=1e-11, atol=1e-15, t_eval=times)
    expected = system.mesh[:, 0] @ solved.y[:3]
    found = response.approach(count=256)[0, :, 0]
    assert np.abs(found - expected).max() < 2e-5 * np.abs(expected).max()


@pytest.mark.parametrize(("phase", "expected"), [(0.0, [34.3, 1.52, 13.9]), (180.0, [10.7, 21.2, 4.95])])
def test_two_stages_in_and_out_of_phase(phase: float, expected: list[float]) -> None:
    """Half range of the first mesh (µm) at the three upper natural frequencies; c1 = c3 = c5 = 1 N·m·s/rad of (3.1)."""
    shape = CosineStiffness(variation=VARIATION)
    excitation = Excitation(meshes=(MeshExcitation(stiffness=shape), MeshExcitation(stiffness=shape, phase=phase)))
    response = periodic_response(two_stages(), excitation, [9971, 16559, 24976], harmonics=5)
    assert np.ptp(response.approach()[:, :, 0], axis=1) / 2 * 1e6 == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(("frequency", "trace_"), [(2.0, -2.0898294263), (1.0, 2.0149153984), (0.7, -1.7532506102)])
def test_meissner(frequency: float, trace_: float) -> None:
    """y'' + (1 + 0.3 sgn cos nu t) y = 0: the trace of its monodromy matrix in closed form."""
    quarter = np.pi / 2
    shape = CurveStiffness(phase=quarter * np.array([-1, 1, 1, 3]), stiffness=np.array([1.3, 1.3, 0.7, 0.7]))
    excitation = Excitation(meshes=(MeshExcitation(stiffness=shape),))
    half, a, b = np.pi / frequency, np.sqrt(1.3), np.sqrt(0.7)
    exact = 2 * np.cos(a * half) * np.cos(b * half) - (a / b + b / a) * np.sin(a * half) * np.sin(b * half)
    found = np.trace(monodromy(oscillator(0.0), excitation, frequency))
    assert found == pytest.approx(exact, abs=1e-12)
    assert found == pytest.approx(trace_, abs=1e-10)
    multipliers = floquet_multipliers(oscillator(0.0), excitation, frequency)
    assert (np.abs(multipliers[0]) > 1 + 1e-6) == (abs(exact) > 2)


@pytest.mark.parametrize(
    ("boundary", "order", "q", "sign"),
    [(mathieu_a, 1, 0.1, -1), (mathieu_b, 1, 0.1, -1), (mathieu_a, 1, 0.5, -1), (mathieu_a, 2, 0.5, 1), (mathieu_b, 2, 0.5, 1)],
)
def test_mathieu(boundary: object, order: int, q: float, sign: int) -> None:
    """y'' + (a - 2 q cos 2t) y = 0: the monodromy over pi has trace 2 sign on the boundaries a_n(q), b_n(q)."""
    exact = float(boundary(order, q))  # type: ignore[operator]

    def excess(a: float) -> float:
        return float(np.trace(monodromy(oscillator(0.0, a), cosine(2 * q / a), 2.0))) - 2 * sign

    assert brentq(excess, exact - 0.02, exact + 0.02, xtol=1e-13) == pytest.approx(exact, abs=1e-8)


SPEEDS = np.linspace(0.2, 2.5, 231)


def run(damping_ratio: float, variation: float, direction: Direction) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Greatest force over the static one with a backlash of five static deflections, and where it jumped."""
    # The backlash is in µm, the static deflection 1 m.
    excitation = cosine(variation, phase=180.0, backlash=5e6)
    response = trace(oscillator(damping_ratio), excitation, SPEEDS).sweep(direction)
    assert response.stable.all()
    return (response.spring_forces() + response.damping_forces()).max(axis=1)[:, 0], response.jumps


def test_jump_with_hysteresis() -> None:
    up, jumps_up = run(0.05, 0.2, Direction.UP)
    down, jumps_down = run(0.05, 0.2, Direction.DOWN)
    # By time integration 2.7954 at 0.91 and 2.8893 at 0.86. A tooth that lifts off there takes some 100 periods to settle.
    assert (up.max(), SPEEDS[up.argmax()]) == (pytest.approx(2.7954, rel=1e-3), pytest.approx(0.91))
    assert (down.max(), SPEEDS[down.argmax()]) == (pytest.approx(2.8893, rel=1e-3), pytest.approx(0.86, abs=0.011))
    assert jumps_up == pytest.approx([0.91])
    assert len(jumps_down) == 1
    different = SPEEDS[np.abs(up - down) > 0.02]
    assert len(different) == pytest.approx(7, abs=1)
    assert different[-1] == pytest.approx(0.90)


@pytest.mark.parametrize(
    ("damping_ratio", "variation", "most"), [(0.05, 0.1, 2.01136), (0.1, 0.206, 2.08148), (0.2, 0.206, 1.55612)]
)
def test_no_jump(damping_ratio: float, variation: float, most: float) -> None:
    up, jumps_up = run(damping_ratio, variation, Direction.UP)
    down, jumps_down = run(damping_ratio, variation, Direction.DOWN)
    assert not len(jumps_up) and not len(jumps_down)
    assert up.max() == pytest.approx(most, rel=2e-4)
    assert up == pytest.approx(down, abs=1e-9)

"""Lines of the dynamic transmission error, where closed forms know them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from support.responses import MESH_DAMPING, STIFFNESS, isolated, two_stages

from gearcad.dynamics.response.kv_chart import lines_that_matter
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.tooth_deviations import TransmissionError

BALANCE = 2e-5
"""Of the static deflection: what the harmonic balance leaves over."""


def test_errors_of_teeth_on_a_constant_stiffness() -> None:
    """y = e (k + i w c)/(k - m w^2 + i w c) at every order of the shaft: here 1, 5 and 8 turns in 5 teeth."""
    coefficients = np.zeros(9, complex)
    coefficients[[1, 5, 8]] = 4.0, 3.0j, 1.0 - 1.0j
    error = TransmissionError(coefficients=coefficients, teeth=5)
    system = isolated()
    mass = 1 / float(system.mesh[:, 0] @ system.mesh[:, 0])
    excitation = Excitation(meshes=(MeshExcitation(stiffness=CosineStiffness(variation=0.0), error=error),))
    chart = over_speed(system, excitation, np.linspace(3000.0, 25000.0, 40)).up
    found = chart.transmission
    assert found.orders.tolist() == [0.2, 1.0, 1.6]
    omega = chart.frequencies[:, None] * found.orders
    spring = STIFFNESS + 1j * omega * MESH_DAMPING
    expected = 2 * np.abs(coefficients[[1, 5, 8]] * spring / (spring - mass * omega**2))
    static = float(chart.static_forces[0]) / STIFFNESS * 1e6
    assert found.amplitudes[:, :, 0] == pytest.approx(expected, abs=BALANCE * static)


def test_orders_are_those_of_the_first_mesh() -> None:
    """A second mesh of 3/2 of its tooth frequency: the strongest lines of each mesh are those of its own stiffness."""
    first = MeshExcitation(stiffness=CosineStiffness(variation=0.2))
    second = MeshExcitation(stiffness=CosineStiffness(variation=0.2), frequency_ratio=Fraction(3, 2))
    found = over_speed(two_stages(), Excitation(meshes=(first, second)), np.linspace(3000.0, 4000.0, 5)).up.transmission
    for mesh, order in ((0, 1.0), (1, 1.5)):
        assert found.orders[found.amplitudes[:, :, mesh].max(axis=0).argmax()] == order
    assert (2 * found.orders % 1 == 0).all() and (np.diff(found.orders) > 0).all()


def test_lines_that_matter() -> None:
    sizes = np.array([[1.0, 0.0], [0.0, 5.0], [0.0005, 0.001], [0.2, 0.0], [0.0, 0.0]])
    assert lines_that_matter(sizes, 1e-3, 10).tolist() == [0, 1, 3]
    assert lines_that_matter(sizes, 1e-3, 2).tolist() == [0, 1]
    assert lines_that_matter(np.zeros((3, 2)), 1e-3, 2).tolist() == []
    assert lines_that_matter(np.zeros((0, 2)), 1e-3, 2).tolist() == []

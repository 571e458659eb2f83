"""The pair on bearings: its modal structure, and limits with closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad.dynamics.trains.six_dof import PairOnBearings

PAIR = PairOnBearings(
    masses=(0.8, 3.1),
    inertias=(4e-4, 7e-3),
    base_radii=(28.0, 66.0),
    working_transverse_pressure_angle=21.5,
    mesh_stiffness=240.0,
    bearing_stiffness=((300.0, 300.0), (450.0, 450.0)),
    torque=80.0,
)


def _hz(stiffness: float, mass: float) -> float:
    return math.sqrt(1e6 * stiffness / mass) / (2 * math.pi)


def _along_the_line_of_action(pair: PairOnBearings) -> np.ndarray:
    """Frequencies (Hz) of the chain bearing - pinion - mesh - wheel - bearing with the gears' turning in it."""
    r1, r2 = (radius / 1000 for radius in pair.base_radii)
    turning = 1 / (r1**2 / pair.inertias[0] + r2**2 / pair.inertias[1])
    masses = np.array([*pair.masses, turning])
    direction = np.array([1.0, -1.0, 1.0])
    springs = np.diag([pair.bearing_stiffness[0][0], pair.bearing_stiffness[1][0], 0.0])
    stiffness = 1e6 * (springs + pair.mesh_stiffness * np.outer(direction, direction))
    root = np.sqrt(masses)
    return np.sqrt(np.linalg.eigvalsh(stiffness / np.outer(root, root))) / (2 * math.pi)


def test_modal_structure_on_isotropic_bearings() -> None:
    """One free turn, one mode of each gear square to the line of action on its bearing alone, and three along the line."""
    across = [_hz(300, 0.8), _hz(450, 3.1)]
    expected = sorted([0.0, *across, *_along_the_line_of_action(PAIR)])
    assert PAIR.frequencies() == pytest.approx(expected, rel=1e-9, abs=1e-3)


def test_modes_square_to_the_line_of_action_leave_the_mesh_alone() -> None:
    system = PAIR.system()
    _, modes = np.linalg.eigh(system.stiffness_matrix())
    approach = np.abs(system.mesh[:, 0] @ modes)
    assert (approach < 1e-9 * approach.max()).sum() == 3  # with the free turn


def test_angle_does_not_matter_on_isotropic_bearings_and_does_on_others() -> None:
    turned = replace(PAIR, working_transverse_pressure_angle=0.0)
    assert turned.frequencies() == pytest.approx(PAIR.frequencies(), rel=1e-9, abs=1e-3)
    soft = replace(PAIR, bearing_stiffness=((300.0, 30.0), (450.0, 45.0)))
    other = replace(soft, working_transverse_pressure_angle=0.0)
    assert max(abs(a - b) for a, b in zip(soft.frequencies(), other.frequencies(), strict=True)) > 1


def test_stiff_bearings_leave_the_torsional_pair() -> None:
    stiff = replace(PAIR, bearing_stiffness=((1e9, 1e9), (1e9, 1e9)))
    r1, r2 = 0.028, 0.066
    isolated = math.sqrt(240e6 * (r1**2 / 4e-4 + r2**2 / 7e-3)) / (2 * math.pi)
    assert stiff.frequencies()[1] == pytest.approx(isolated, rel=1e-6)


def test_static_deflection() -> None:
    """Bearings carry the normal force, and the mesh is pressed by it."""
    system = PAIR.system()
    moved = np.linalg.lstsq(system.stiffness_matrix(), system.load, rcond=1e-12)[0]
    force = 80.0 / 0.028
    assert system.stiffness[0] * (system.mesh[:, 0] @ moved) == pytest.approx(force, rel=1e-9)
    pinion, wheel = moved[:2] / math.sqrt(0.8), moved[3:5] / math.sqrt(3.1)
    assert 300e6 * np.hypot(*pinion) == pytest.approx(force, rel=1e-9)
    assert 450e6 * np.hypot(*wheel) == pytest.approx(force, rel=1e-9)
    assert wheel[0] > 0 > pinion[0]  # pushed apart


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("masses", (0.0, 1.0), "masses = 0 kg: must be a number above 0"),
        ("mesh_stiffness", -5.0, "mesh_stiffness = -5 N/µm: must be a number above 0"),
        ("bearing_stiffness", ((1.0, 0.0), (1.0, 1.0)), "bearing_stiffness = 0 N/µm: must be a number above 0"),
    ],
)
def test_unphysical(field: str, value: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(PAIR, **{field: value})

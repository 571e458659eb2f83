"""The pair on bearings: its modal structure, and limits with closed forms."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad.core.records import PerGear
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings
from gearcad.dynamics.trains.train import Train, TrainModel

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


def test_modes_across_the_line_of_action_are_each_gear_s_own() -> None:
    """omega = sqrt(k/m), all of it in one bearing: teeth do not shake them."""
    modes = PAIR.modes()
    assert modes.frequency == pytest.approx(PAIR.frequencies(), rel=1e-9, abs=1e-3)
    for words, (stiffness, mass) in {"pinion": (300, 0.8), "wheel": (450, 3.1)}.items():
        mode = modes.words.index(f"{words} travels across the line of action")
        assert modes.circular[mode] == pytest.approx(math.sqrt(1e6 * stiffness / mass), rel=1e-12)
        assert not modes.shaken[mode] and modes.potential[mode].tolist() == [0.0, *np.eye(2)[int(words == "wheel")]]
    assert modes.shaken.sum() == 3
    assert modes.kinetic.sum(axis=1) == pytest.approx(np.ones(6)) and modes.potential[1:].sum(axis=1) == pytest.approx(
        np.ones(5)
    )


def test_modes_of_two_alike_gears() -> None:
    """Together along the line of action the mesh does nothing; against each other half of the pair is a chain of two masses."""
    m, j, r, k, kb = 1.0, 5e-4, 0.03, 3e8, 2e8
    alike = replace(
        PAIR,
        masses=(m, m),
        inertias=(j, j),
        base_radii=(30.0, 30.0),
        mesh_stiffness=300.0,
        bearing_stiffness=((200.0,) * 2,) * 2,
    )
    modes = alike.modes()
    alone, words = math.sqrt(kb / m), list(modes.words)
    together = words.index("both gears travel together, along the line of action")
    assert modes.circular[2:5] == pytest.approx([alone] * 3, rel=1e-9) and together in (2, 3, 4)
    assert sorted(words[2:5]) == sorted(
        ["pinion travels across the line of action", "wheel travels across the line of action", words[together]]
    )
    assert not modes.shaken[[0, 2, 3, 4]].any()
    # y = 2 (u + s), s = r phi: m u'' + kb u + k y = 0, j/r^2 s'' + k y = 0.
    chain = np.array([[(kb + 2 * k) / m, 2 * k / m], [2 * k * r**2 / j, 2 * k * r**2 / j]])
    squares, shapes = np.linalg.eig(chain)
    order = np.argsort(squares)
    assert modes.circular[[1, 5]] == pytest.approx(np.sqrt(squares[order]), rel=1e-9)
    assert [words[1], words[5]] == [
        "both gears travel against each other, along the line of action",
        "gears turn against each other",
    ]
    for mode, (u, s) in zip((1, 5), shapes.T[order], strict=True):
        assert modes.potential[mode, 0] == pytest.approx(
            4 * k * (u + s) ** 2 / (4 * k * (u + s) ** 2 + 2 * kb * u**2), rel=1e-9
        )


@pytest.mark.parametrize("stiffness", [1e9, 1e-6])
def test_modes_at_the_limits(stiffness: float) -> None:
    """Rigid bearings leave the torsional mode; none leave two bodies that float."""
    modes = replace(PAIR, bearing_stiffness=((stiffness,) * 2,) * 2).modes()
    r1, r2 = 0.028, 0.066
    compliance = r1**2 / 4e-4 + r2**2 / 7e-3 + (0 if stiffness > 1 else 1 / 0.8 + 1 / 3.1)
    (mode,) = np.flatnonzero(modes.potential[:, 0] > 0.5)
    assert modes.circular[mode] == pytest.approx(math.sqrt(240e6 * compliance), rel=1e-6)
    assert modes.words[mode] == "gears turn against each other" and modes.potential[mode, 0] == pytest.approx(1.0, abs=1e-6)
    assert mode == (1 if stiffness > 1 else 5)


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


def test_a_chart_reaches_the_highest_mode_that_teeth_shake() -> None:
    """A heavy rotor on the pinion's shaft leaves the turning slow: what travels is met far beyond."""
    pair = replace(PAIR, inertias=PerGear(0.1, 7e-3))
    train = Train(
        model=TrainModel.ISOLATED,
        inertias=(Inertia(name="pinion", inertia=0.1), Inertia(name="wheel", inertia=7e-3)),
        meshes=(
            ToothMesh(
                name="mesh", pinion="pinion", wheel="wheel", base_radii=PerGear(28.0, 66.0), stiffness=240.0, teeth=20,
                damping_ratio=0.05, variation=0.1,
            ),
        ),
        torques={"pinion": 80.0, "wheel": 80.0 * 66 / 28},
    )  # fmt: skip
    study = study_train(train, DynamicsOptions(speeds=20), bearings=replace(pair, mesh_damping=500.0, bearing_damping=100.0))
    assert study.on_bearings is not None
    highest = 60 * study.on_bearings.frequency[study.on_bearings.potential[:, 0] > 0.02].max() / 20
    assert study.modes.rpm.max() * 1.5 < highest and study.speeds.max() == pytest.approx(1.5 * highest)
    assert {each.met.mode for each in study.resonances if each.met} <= set(np.flatnonzero(study.on_bearings.shaken) + 1)
    assert [each.name for each in study.greatest_amplitudes] == ["pinion", "wheel", "mesh", "pinion", "wheel"]
    json.dumps(study.to_dict(), allow_nan=False)

"""Torsional stiffness of the Alm thesis's train: its power law, its tables 4 and 5, and what its bearings imply."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.sets import alm_train

from gearcad.core.records import Floats
from gearcad.dynamics.planetary.planetary_statics import TwistSource, torsional_stiffness, twist_of
from gearcad.planetary import TrainLoad
from gearcad.planetary.power import forces, power_flow

TORQUE = 1600.0

COUNT = np.array([1, 3, 3])
"""Of the pre-stage, and of each ring of the set."""

LAW = np.array([2.4e6, 2.4e6, 2.1e6])
"""K of table 2 in N/mm^1.5, F = K delta^1.5."""

MESHES = {"ring_4-rim_3": 314.547, "ring_5-rim_3p": 300.683, "pre_stage": 181.640}
"""N/µm, tables 4 and 5."""


def normal_forces(torque: float = TORQUE) -> Floats:
    """Of the pre-stage, ring 4 and ring 5."""
    train = alm_train()
    found = forces(train, power_flow(train, TrainLoad(torque=torque)))
    meshes = (found.stages["pre_stage"], *found.meshes.values())
    return np.array([mesh.normal for mesh in meshes])


def twist(torque: float) -> float:
    """By the power law (rad)."""
    acting = normal_forces(torque)
    return math.radians(float(twist_of(np.sum(COUNT * acting * 1000 * (acting / LAW) ** (1 / 1.5)), torque)))


def test_the_power_law_of_the_thesis() -> None:
    acting = normal_forces()
    assert acting == pytest.approx([1014.84, 5374.64, 6063.69], abs=0.005)
    assert 1000 * (acting / LAW) ** (1 / 1.5) == pytest.approx([5.634, 17.117, 20.277], abs=0.0005)
    assert math.degrees(twist(TORQUE)) == pytest.approx(0.023297, abs=5e-7)
    assert TORQUE / twist(TORQUE) == pytest.approx(3.935e6, abs=500)
    assert 2 / (twist(TORQUE + 1) - twist(TORQUE - 1)) == pytest.approx(5.902e6, abs=500)


def test_the_linear_stiffness_of_tables_4_and_5() -> None:
    found = torsional_stiffness(alm_train(), TrainLoad(torque=TORQUE), MESHES)
    assert found.stiffness == pytest.approx(3.950e6, abs=500)
    acting = normal_forces()
    stiffness = np.array([MESHES[name] for name in ("pre_stage", "ring_4-rim_3", "ring_5-rim_3p")])
    by_hand = COUNT * acting**2 / stiffness / 1e6 / TORQUE
    added = {each.name: math.radians(each.twist) for each in found.contributions}
    assert [added[name] for name in ("pre_stage", "ring_4-rim_3", "ring_5-rim_3p")] == pytest.approx(by_hand, rel=1e-9)
    assert found.share(TwistSource.MESH) + found.share(TwistSource.STAGE) == pytest.approx(1, abs=1e-12)
    assert found.rigid[0] == "pins"


def test_the_bearings_of_the_thesis_imply_a_pin_stiffness() -> None:
    """Its 3.14e6 N·m/rad has bearings besides meshes: 420 N/µm a pin by its power law, 414 by its tables; not fitted."""
    left = TORQUE / 3.14e6 - twist(TORQUE)
    assert left == pytest.approx(1.029e-4, abs=1e-7)
    train = alm_train()
    pin = forces(train, power_flow(train, TrainLoad(torque=TORQUE))).pin
    assert (abs(pin.radial), abs(pin.tangential)) == pytest.approx((4772.44, 556.29), abs=0.005)
    assert 3 * pin.size**2 / (TORQUE * left) / 1e6 == pytest.approx(420.4, abs=0.1)
    found = torsional_stiffness(train, TrainLoad(torque=TORQUE), MESHES)
    assert found.implied_pin_stiffness(3.14e6) == pytest.approx(414.07, abs=0.01)

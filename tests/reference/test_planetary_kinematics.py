"""Speeds, torques, efficiencies and forces of planetary sets of all types, and of the train of the Alm thesis."""

import math

import pytest
from support.cases import data_rows
from support.planetary_trains import alm_train, unchecked_set
from support.published import Published

from gearcad.planetary import TrainLoad
from gearcad.planetary.power import efficiency, forces, power_flow
from gearcad.planetary.train_data import speeds, willis_row

MESH_EFFICIENCY = math.sqrt(0.985 * 0.99)

SETS = {
    "A": ((24, 21, 21, -66), -2.75, 90),
    "B": ((24, 40, 22, -74), -5.606060606060606, 1744),
    "C": ((30, 24, 23, 31), 1.0782608695652174, 54),
    "D": ((-70, 22, 21, -72), 1.0775510204081633, 114),
    "D in phase": ((-75, 24, 21, -72), 1.0971428571428572, 51),
}
"""Teeth of a, its rim, the rim of b, b; basic ratio; positions of planets (own computation in closed form)."""

CASES = [
    (kind, roles, float(ratio), float(planet), tuple(map(float, torques)), float(efficient), float(rolling))
    for kind, roles, ratio, planet, *torques, efficient, rolling in data_rows("planetary_kinematics")
]
"""Own computation; torques agreed with powers balanced mesh by mesh on 3972 random sets."""


ALM = "Alm, master's thesis on a planetary train: its own statics"


def named(role: str) -> str:
    return "carrier" if role == "c" else role


@pytest.mark.parametrize(("kind", "roles", "ratio", "planet", "torques", "efficient", "rolling"), CASES)
def test_sets_have_the_speeds_torques_and_efficiency_of_willis(
    kind: str, roles: str, ratio: float, planet: float, torques: tuple[float, ...], efficient: float, rolling: float
) -> None:
    teeth = SETS[kind][0]
    fixed, driving, driven = map(named, roles)
    train = unchecked_set(*teeth, stepped=kind != "A", fixed=fixed, input=driving, output=driven)
    found = speeds(train, {driving: 1.0})
    assert found.members[driving] / found.members[driven] == pytest.approx(ratio, rel=1e-12)
    assert found.planet_relative == pytest.approx(planet, rel=1e-12)
    assert efficiency(train, MESH_EFFICIENCY) == pytest.approx(efficient, rel=1e-12)
    output = torques["abc".index(roles[2])]
    flow = power_flow(train, TrainLoad(torque=abs(output), speed=1.0, mesh_efficiency=MESH_EFFICIENCY))
    assert [flow.torques[name] for name in train.members] == pytest.approx(torques, rel=1e-12)
    assert flow.rolling_ratio == pytest.approx(rolling, rel=1e-12)
    assert flow.efficiency == pytest.approx(efficient, rel=1e-12)


@pytest.mark.parametrize("kind", SETS)
def test_basic_ratio_and_positions(kind: str) -> None:
    teeth, basic_ratio, positions = SETS[kind]
    train = unchecked_set(*teeth, stepped=kind != "A")
    row = willis_row(train)
    assert -row["b"] / row["a"] == pytest.approx(basic_ratio, rel=1e-15)
    assert abs(row["carrier"]) // math.gcd(*teeth[1:3]) == positions


@pytest.mark.parametrize(("in_phase", "ratio"), [(False, -124.28070175438597), (True, -101.01960784313727)])
def test_ratio_of_the_thesis(in_phase: bool, ratio: float) -> None:
    assert alm_train(in_phase=in_phase).ratio == pytest.approx(ratio, rel=1e-14)


def test_ratio_as_printed(published: Published) -> None:
    published("i", alm_train().ratio, "-124.28", 0.005, ALM)


def test_efficiency_of_the_set_of_the_thesis() -> None:
    """Of both meshes together 0.99; own computation, three decimals."""
    train, in_phase = alm_train(stages=()), alm_train(in_phase=True, stages=())
    assert efficiency(train, math.sqrt(0.99)) == pytest.approx(0.886, abs=5e-4)
    assert efficiency(train, math.sqrt(0.99), back=True) == pytest.approx(0.870, abs=5e-4)
    assert efficiency(in_phase, math.sqrt(0.99)) == pytest.approx(0.907, abs=5e-4)


@pytest.mark.parametrize(("in_phase", "force"), [(False, 1014.838), (True, 1248.518)])
def test_force_of_the_pre_stage_of_the_thesis(in_phase: bool, force: float) -> None:
    train = alm_train(in_phase=in_phase)
    found = forces(train, power_flow(train, TrainLoad(torque=1600.0)))
    assert found.stages["pre_stage"].normal == pytest.approx(force, abs=1e-3)


def test_forces_in_the_set_of_the_thesis(published: Published) -> None:
    """Normal forces of the thesis's own statics. On the pin 4772 N inwards; along the circle what the carrier's torque asks:
    1600/13.8947 N·m on three pins at 69 mm, which is 556.3 N."""
    train = alm_train()
    found = forces(train, power_flow(train, TrainLoad(torque=1600.0)))
    published("normal force of mesh 3-4, N", found.meshes["ring_4-rim_3"].normal, 5374.64, 0.01, ALM)
    published("normal force of mesh 3'-5, N", found.meshes["ring_5-rim_3p"].normal, 6063.69, 0.01, ALM)
    published("radial force on a pin, N", found.pin.radial, "-4772", 0.5, ALM)
    assert found.pin.tangential == pytest.approx(1600 / 13.894736842105257 / (3 * 0.069), rel=1e-12)

"""Loads of the meshes of trains as pairs: against members' torques, the power that rolls, and the Alm thesis."""

import math
from itertools import product

import pytest
from support.loaded_trains import alm_set, simple_set
from support.sets import alm_train

from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.power import FactorSource, MeshLoad, forces, mesh_load_factor, mesh_loads, power_flow

_RPM = math.pi / 30


def loads(train: PlanetaryTrain, k_gamma: float | None = None, **given: float | None) -> dict[str, MeshLoad]:
    return mesh_loads(train, power_flow(train, TrainLoad(**{"torque": 1600.0, "speed": 1000.0} | given)), k_gamma)


def test_the_alm_thesis_has_these_forces() -> None:
    found = loads(alm_train())
    assert found["ring_4-rim_3"].normal_force == pytest.approx(5374.64, abs=0.005)
    assert found["ring_5-rim_3p"].normal_force == pytest.approx(6063.69, abs=0.005)
    # 1600 N·m over the ratio of pinion and ring, and three planets.
    assert abs(found["ring_5-rim_3p"].load.torque) == pytest.approx(1600 / 3 * 21 / 72)


SETS = [simple_set(24, 21), simple_set(20, 32), alm_set(), simple_set(24, 21, input="carrier", output="sun")]


@pytest.mark.parametrize(("train", "torque", "speed"), list(product(SETS, (500.0, -500.0), (900.0, -900.0))))
def test_torques_and_power_of_all_planets_are_the_members(train: PlanetaryTrain, torque: float, speed: float) -> None:
    """Without losses, the torques on the pinions of a planet's meshes, taken to its centrals, are those of the members."""
    flow = power_flow(train, TrainLoad(torque=torque, speed=speed))
    found, members = mesh_loads(train, flow), flow.speeds.members
    carrier = train.carrier.name
    for mesh in train.meshes:
        own, central = found[mesh.name], mesh.central
        on_central = train.planets * own.load.torque * central.gear.teeth / mesh.pair.pinion.teeth
        assert on_central == pytest.approx(flow.torques[central.name], rel=1e-12)
        rolls = on_central * (members[central.name] - members[carrier])
        assert own.driver is (mesh.central_role if rolls > 0 else mesh.rim_role)
        assert (own.load.torque * own.load.speed > 0) is (own.driver is Role.PINION)
        power = train.planets * abs(own.load.torque * own.load.speed) * _RPM
        assert power == pytest.approx(flow.rolling_power, rel=1e-12)
        assert own.normal_force == pytest.approx(forces(train, flow).meshes[mesh.name].normal, rel=1e-12)
    # One drives the planets, the other is driven by them; neither turns a planet by itself.
    first, second = (found[mesh.name].driver is mesh.central_role for mesh in train.meshes)
    assert first is not second
    a, b = (found[mesh.name].normal_force * mesh.rim_base_radius for mesh in train.meshes)
    assert a == pytest.approx(b, rel=1e-12)


def test_losses_part_the_meshes() -> None:
    found = loads(simple_set(24, 21), mesh_efficiency=0.98)
    sun, ring = (found[name].normal_force for name in ("sun-planet", "ring-planet"))
    assert ring / sun == pytest.approx(0.98**2, rel=1e-12)  # both losses stand at the ring


def test_k_gamma_multiplies_the_application_factor_only() -> None:
    plain, uneven = (loads(simple_set(24, 21), k, application_factor=1.25)["sun-planet"] for k in (None, 1.2))
    assert uneven.load.torque == plain.load.torque
    assert uneven.load.application_factor == pytest.approx(1.5)
    assert (uneven.application_factor, uneven.mesh_load_factor) == (1.25, (1.2, FactorSource.COMPUTED))
    with pytest.raises(ParameterError, match=r"load.mesh_load_factor = 3.1: must be .* at most 3"):
        loads(simple_set(24, 21), mesh_load_factor=3.1)
    with pytest.raises(ParameterError, match=r"mesh_load_factor = 0.9: must be"):
        TrainLoad(torque=1.0, mesh_load_factor=0.9)


def test_the_k_gamma_that_is_given_wins() -> None:
    for given, computed, wanted in (
        (1.3, 1.1, (1.3, FactorSource.GIVEN)),
        (None, 1.1, (1.1, FactorSource.COMPUTED)),
        (None, 1 - 1e-15, (1.0, FactorSource.COMPUTED)),
        (None, 1 + 2e-15, (1.0, FactorSource.COMPUTED)),
        (None, None, (1.0, FactorSource.EQUAL)),
    ):
        load = TrainLoad(torque=1600.0, mesh_load_factor=given)
        assert mesh_load_factor(alm_set(), load, computed) == wanted


def test_load_cycles_are_those_that_teeth_count() -> None:
    """24/21/-66, carrier held in mind: in a turn of the sun against it each tooth meets three planets."""
    found = loads(simple_set(24, 21), speed=375.0)
    carrier = 375 * 24 / 90
    sun, ring = found["sun-planet"], found["ring-planet"]
    assert (sun.contacts, ring.contacts) == (PerGear(1, 3), PerGear(1, 3))  # the planet is the smaller: the pinion
    assert sun.cycles_per_minute == pytest.approx(((375 - carrier) * 24 / 21, 3 * (375 - carrier)))
    assert ring.cycles_per_minute == pytest.approx((carrier * 66 / 21, 3 * carrier))


def test_a_train_at_rest_goes_as_its_input_would() -> None:
    moving, resting = (loads(simple_set(20, 32), speed=speed) for speed in (50.0, 0.0))
    for name, own in resting.items():
        assert own.driver is moving[name].driver
        assert own.load.torque == moving[name].load.torque
        assert own.load.speed == 0
    differential = simple_set(20, 32, fixed=None)
    flow = power_flow(differential, TrainLoad(torque=100.0), {"ring": 0.0})
    assert [own.driver for own in mesh_loads(differential, flow).values()] == [Role.PINION, Role.PINION]


def test_a_set_that_turns_as_one_rolls_nowhere() -> None:
    """Rounding of the carrier's speed is no speed."""
    train = simple_set(24, 21, fixed=None)
    flow = power_flow(train, TrainLoad(torque=100.0, speed=33.3), {"ring": 33.3 + 1e-9})
    for own in mesh_loads(train, flow).values():
        assert own.load.speed == 0
        assert own.cycles_per_minute == (0.0, 0.0)


@pytest.mark.parametrize("planets", [1, 2, 5])
def test_any_number_of_planets(planets: int) -> None:
    found = loads(simple_set(24, 21, planets=planets), mesh_load_factor=float(planets))
    assert found["sun-planet"].load.application_factor == planets
    assert found["sun-planet"].contacts == PerGear(1, planets)
    total = planets * found["sun-planet"].load.torque
    assert total == pytest.approx(1600 * 24 / 90 * 21 / 24)


def test_a_load_beyond_what_pairs_have_names_its_mesh() -> None:
    with pytest.raises(ParameterError, match=r"sun-planet.application_factor = 180: must be"):
        loads(simple_set(24, 21), application_factor=90.0, mesh_load_factor=2.0)

"""Speeds and power of planetary trains at their limits, and forces on planets against vectors in space."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.planetary_trains import alm_train, gear, stage, unchecked_set

from gearcad.core.errors import GeometryError, ParameterError, SolverError
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim, TrainLoad
from gearcad.planetary.power import PowerFlow, TrainForces, efficiency, forces, power_flow
from gearcad.planetary.train_data import TrainData, shafts_of, speeds


def plain(**fields: Any) -> TrainData:
    """Sun, planets, ring, carrier of 24/21/-66."""
    return unchecked_set(24, 21, 21, -66, stepped=False, **({"planets": 3, "input": "a", "output": "carrier"} | fields))


def nearly_one(**fields: Any) -> TrainData:
    """A set with i0 = 99·101/100^2, which 0.9999 is."""
    return unchecked_set(100, 99, 100, 101, **fields)


@pytest.mark.parametrize(
    ("train", "given", "message"),
    [
        (plain(fixed="b"), {}, "speeds = []: must have one more, of a, carrier"),
        (plain(), {"a": 5.0}, "speeds = ['a']: must have one more, of b, carrier"),
        (plain(), {}, "speeds = []: must have two more, of a, b, carrier: no member is fixed"),
        (
            plain(),
            {"a": 1.0, "b": 1.0, "carrier": 1.0},
            "speeds.carrier = 1 rpm: must not be given too: it follows from a and b",
        ),
        (plain(fixed="b"), {"b": 2.0}, "speeds.b = 2 rpm: must not be given too: b is fixed"),
        (alm_train(), {"carrier": 1.0, "pinion_1": 2.0}, "it turns with carrier, which is given"),
        (plain(fixed="b"), {"sun": 2.0}, "speeds.sun = 2 rpm: belongs to no member: the members are a, b, carrier"),
        (plain(fixed="b"), {"a": math.nan}, "speeds.a = nan"),
    ],
)
def test_speeds_that_are_missing_or_too_many_are_named(train: TrainData, given: dict[str, float], message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        speeds(train, given)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_speed_of_a_differential() -> None:
    """Both centrals equal: all turns as one. Opposed as their teeth: the carrier rests."""
    together = speeds(plain(), {"a": 30.0, "b": 30.0})
    assert together.members["carrier"] == pytest.approx(30.0, rel=1e-15)
    assert together.planet_relative == pytest.approx(0.0, abs=1e-13)
    assert speeds(plain(), {"a": 66.0, "b": -24.0}).members["carrier"] == 0.0


def test_ratio_of_a_train() -> None:
    train = alm_train()
    assert (
        train.ratio == speeds(train, {"pinion_1": 1.0}).members["pinion_1"] / speeds(train, {"pinion_1": 1.0}).members["ring_5"]
    )
    assert alm_train(fixed=None).ratio is None


def test_a_differential_shares_torque_and_its_speeds_decide_power() -> None:
    """24/66 of the ring's torque on the sun at any speeds; a set that turns as one loses nothing."""
    load = TrainLoad(torque=90.0, speed=10.0, mesh_efficiency=0.97)
    for second in (-2.0, 0.0, 10.0):
        flow = power_flow(plain(), TrainLoad(torque=90.0, speed=10.0), {"b": second})
        assert flow.torques == pytest.approx({"a": 24.0, "b": 66.0, "carrier": -90.0}, rel=1e-13)
        assert sum(flow.powers.values()) == pytest.approx(0.0, abs=1e-12)
        assert flow.efficiency == pytest.approx(1.0, rel=1e-13)
        assert flow.efficiency_back is None
    coupled = power_flow(plain(), load, {"b": 10.0})
    assert coupled.torques == pytest.approx({"a": 24.0, "b": 66.0, "carrier": -90.0}, rel=1e-12)
    assert coupled.rolling_power == 0.0
    assert coupled.efficiency == pytest.approx(1.0, rel=1e-12)
    rolling = power_flow(plain(), load, {"b": -2.0})
    assert rolling.torques["b"] / rolling.torques["a"] == pytest.approx(66 / 24 * 0.97**2, rel=1e-13)
    with pytest.raises(ParameterError, match="one more"):
        power_flow(plain(), load)


def test_a_set_near_the_basic_ratio_of_one_locks_itself() -> None:
    """i0 = 0.9999: the carrier drives a at 1/10000 of its speed and keeps a quarter of a percent; never the other way."""
    train = nearly_one(fixed="b", input="carrier", output="a")
    assert train.basic_ratio == pytest.approx(0.9999, rel=1e-15)
    expected = (1 - 0.9999) / (1 - 0.9999 * 0.98**2)  # -P_a/P_c with T_b = -i0 eta^2 T_a
    assert efficiency(train, 0.98) == pytest.approx(expected, rel=1e-9)
    assert efficiency(train, 0.98, back=True) < 0
    flow = power_flow(train, TrainLoad(torque=-10.0, speed=100.0, mesh_efficiency=0.98))
    assert flow.self_locking
    assert flow.powers["a"] > 0 and flow.powers["carrier"] > 0
    assert sum(flow.losses.values()) == pytest.approx(sum(flow.powers.values()), rel=1e-12)
    driving = nearly_one(fixed="b", input="a", output="carrier")
    with pytest.raises(SolverError, match=r"locks itself; it turns where meshes keep more than 0\.99995"):
        power_flow(driving, TrainLoad(torque=10.0, speed=100.0, mesh_efficiency=0.98))
    assert efficiency(driving, 0.98) < 0
    assert power_flow(driving, TrainLoad(torque=-10.0, speed=1.0, mesh_efficiency=0.98)).torques["a"] < 0
    assert power_flow(driving, TrainLoad(torque=10.0, speed=100.0, mesh_efficiency=0.99996)).efficiency > 0


def test_a_basic_ratio_of_one_is_refused() -> None:
    centrals = (Central(name="a", gear=gear(24), meshes="p"), Central(name="b", gear=gear(24), meshes="q"))
    rims = (Rim(name="p", gear=gear(30)), Rim(name="q", gear=gear(30)))
    with pytest.raises(GeometryError, match="turn as one and the carrier is free"):
        PlanetaryTrain(planets=3, centrals=centrals, rims=rims, input="a", output="carrier", fixed="b")


def test_at_rest_the_signs_are_those_of_a_forward_input() -> None:
    load = TrainLoad(torque=1600.0)
    rest, turning = power_flow(alm_train(), load), power_flow(alm_train(), TrainLoad(torque=1600.0, speed=100.0))
    assert rest.torques == turning.torques
    assert set(rest.powers.values()) == {0.0}
    assert rest.efficiency == turning.efficiency
    assert rest.rolling_ratio == turning.rolling_ratio
    backwards = power_flow(alm_train(), TrainLoad(torque=1600.0, speed=-100.0))
    assert backwards.torques == {name: -torque for name, torque in turning.torques.items()}
    assert backwards.powers == pytest.approx(turning.powers)


def test_without_load_nothing_flows() -> None:
    flow = power_flow(alm_train(), TrainLoad(torque=0.0, speed=100.0, mesh_efficiency=0.9))
    assert set(flow.torques.values()) == set(flow.powers.values()) == set(flow.losses.values()) == {0.0}
    assert flow.rolling_ratio is None
    assert flow.circulation == "no power flows"
    assert flow.efficiency == power_flow(alm_train(), TrainLoad(torque=1.0, speed=100.0, mesh_efficiency=0.9)).efficiency


def test_words_say_whether_power_circulates() -> None:
    def flow(train: TrainData) -> PowerFlow:
        return power_flow(train, TrainLoad(torque=1.0))

    assert flow(plain(fixed="b")).circulation == "no power circulates: 0.7333 of what goes in rolls through the meshes"
    assert flow(alm_train()).circulation == "power circulates: 12.89 times what goes in rolls through the meshes"


def test_back_driving_turns_the_torque_over() -> None:
    forward, back = (power_flow(plain(fixed="b"), TrainLoad(torque=torque, speed=1.0)) for torque in (90.0, -90.0))
    assert back.torques == {name: -torque for name, torque in forward.torques.items()}


def test_a_fixed_carrier_is_a_pair_of_gears_in_series() -> None:
    train = plain(fixed="carrier", output="b")
    flow = power_flow(train, TrainLoad(torque=66.0, speed=11.0, mesh_efficiency=0.99))
    assert flow.speeds.members["b"] == -4.0
    assert flow.torques["a"] == pytest.approx(24 / 0.99**2, rel=1e-14)
    assert (flow.efficiency, flow.efficiency_back) == pytest.approx((0.99**2, 0.99**2), rel=1e-14)


def test_a_fixed_shaft_of_a_stage_holds_its_member() -> None:
    train = plain(fixed="worm", stages=(stage("brake", ("worm", 17), ("b", 85)),))
    flow = power_flow(train, TrainLoad(torque=90.0, speed=1.0, mesh_efficiency=0.9))
    assert flow.speeds.members["b"] == 0.0
    assert flow.torques["b"] == 0.0
    assert flow.torques["worm"] == pytest.approx(-flow.set_torques["b"] * 17 / 85, rel=1e-14)
    assert flow.losses["brake"] == 0.0


def test_an_idle_stage_carries_nothing() -> None:
    flow = power_flow(plain(fixed="b", stages=(stage("pump", ("a", 20), ("pump", 20)),)), TrainLoad(torque=1.0, speed=3.0))
    assert flow.torques["pump"] == 0.0
    assert flow.speeds.members["pump"] == -3.0
    assert tuple(flow.stage_torques["pump"]) == (0.0, 0.0)


def test_stages_must_be_a_tree() -> None:
    loop = plain(stages=(stage("loop", ("a", 20), ("carrier", 40)),))
    with pytest.raises(GeometryError, match=r"loop\.wheel = 'carrier': must be a shaft of its own"):
        shafts_of(loop)
    loose = plain(stages=(stage("loose", ("x", 20), ("y", 40)),))
    with pytest.raises(GeometryError, match=r"loose\.wheel = 'y': must be one of a, b, carrier"):
        shafts_of(loose)


def test_roles_must_be_of_different_members() -> None:
    with pytest.raises(
        GeometryError, match="output = 'pinion_1': must turn with another member of the set than input = carrier"
    ):
        alm_train(input="carrier", output="pinion_1")


def test_as_a_document() -> None:
    document = power_flow(alm_train(), TrainLoad(torque=1600.0, speed=100.0)).to_dict()
    assert document["stage_torques"]["pre_stage"]["pinion"] == document["torques"]["pinion_1"]
    assert document["speeds"]["members"]["ring_5"] == pytest.approx(100 / -124.28070175438597)


def helical(hand: float, *, axial_position: float = 0.0, stepped: bool = False) -> TrainData:
    """24/21/-66 with a sun of that helix angle, its ring on a second rim if stepped."""
    rims = (
        Rim(name="p", gear=gear(21, 2.0, 0.0, -hand), axial_position=0.0),
        Rim(name="q", gear=gear(21, 2.0, 0.0, -hand), axial_position=axial_position),
    )
    centrals = (
        Central(name="sun", gear=gear(24, 2.0, 0.0, hand), meshes="p"),
        Central(name="ring", gear=gear(-66, 2.0, 0.0, -hand), meshes="q" if stepped else "p"),
    )
    return TrainData(planets=3, centrals=centrals, rims=rims[: 1 + stepped], input="sun", output="carrier", fixed="ring")


def forces_of(train: TrainData, torque: float = 90.0, speed: float = 0.0) -> TrainForces:
    return forces(train, power_flow(train, TrainLoad(torque=torque, speed=speed)))


def test_a_right_hand_sun_that_turns_left_pushes_the_planet_down() -> None:
    """Fingers of the right hand along its turn, the thumb shows the thrust on the driver."""
    found = forces_of(helical(15.0))
    sun, ring = found.meshes["sun-p"], found.meshes["ring-p"]
    assert sun.axial < 0 < ring.axial
    assert forces_of(helical(-15.0)).meshes["sun-p"].axial == -sun.axial
    assert forces_of(helical(15.0), torque=-90.0).meshes["sun-p"].axial == -sun.axial
    reference_radius = helical(15.0).centrals[0].gear.reference_diameter / 2e3
    assert -sun.axial == pytest.approx(90 / 3.75 / 3 / reference_radius * math.tan(math.radians(15)), rel=1e-12)


def test_forces_and_moments_on_the_pin_are_those_of_vectors() -> None:
    """Each mesh pushes at its pitch point; moments about the middle of the planet's teeth by cross products."""
    train = helical(20.0, axial_position=31.0, stepped=True)
    found = forces_of(train)
    total, moment = np.zeros(3), np.zeros(3)
    planet = train.meshes[0].pair.centre_distance / 1e3
    for mesh, sign in zip(train.meshes, (1, -1), strict=True):
        force = found.meshes[mesh.name]
        pitch_radius = abs(mesh.pair.working_pitch_diameters.pick(mesh.central_role)) / 2e3
        vector = np.array([force.radial, force.tangential, force.axial])
        place = np.array([pitch_radius - planet, 0.0, -sign * 31e-3 / 2])
        total, moment = total + vector, moment + np.cross(place, vector)
    pin = found.pin
    assert [pin.radial, pin.tangential, pin.axial] == pytest.approx(total, rel=1e-12, abs=1e-9)
    assert [pin.tilting_radial, pin.tilting_tangential, 0.0] == pytest.approx(moment, rel=1e-10, abs=1e-9)
    assert pin.tilting_moment == pytest.approx(np.hypot(*moment[:2]), rel=1e-10)


def test_helical_planets_tilt_though_their_axial_forces_cancel() -> None:
    pin = forces_of(helical(15.0)).pin
    assert pin.axial == pytest.approx(0.0, abs=1e-9)
    assert abs(pin.tilting_tangential) > 1.0
    assert forces_of(helical(0.0)).pin.tilting_moment == 0.0


def test_a_normal_force_is_across_the_line_of_action() -> None:
    for mesh, force in zip(alm_train().meshes, forces_of(alm_train(), 1600.0).meshes.values(), strict=True):
        assert math.hypot(force.tangential, force.radial) == pytest.approx(force.normal, rel=1e-13)
        assert -force.radial / abs(force.tangential) == pytest.approx(math.tan(mesh.working_pressure_angle), rel=1e-12)


@pytest.mark.parametrize("planets", [1, 2, 24])
def test_planets_share_the_torque(planets: int) -> None:
    train = unchecked_set(24, 21, 21, -66, stepped=False, planets=planets, input="a", output="carrier", fixed="b")
    assert forces_of(train).meshes["a-rim"].normal * planets == pytest.approx(
        24e3 / (12 * math.cos(math.radians(20))), rel=1e-13
    )


def test_centrifugal_force_of_a_planet() -> None:
    """0.5 kg at 22.5 mm and 100 rad/s: 112.5 N, away from the axis."""
    train = replace(
        unchecked_set(24, 21, 21, -66, stepped=False, planets=3, input="a", output="carrier", fixed="b"), centre_distance=22.5
    )
    assert forces_of(train, speed=100.0).pin.centrifugal is None
    heavy = replace(train, carrier=Carrier(planet_mass=0.5))
    pin = forces_of(heavy, speed=3.75 * 100 * 30 / math.pi).pin
    assert pin.centrifugal == pytest.approx(112.5, rel=1e-12)
    assert pin.size == pytest.approx(math.hypot(pin.radial + 112.5, pin.tangential), rel=1e-14)


def test_no_torque_no_force() -> None:
    document = forces_of(alm_train(), 0.0).to_dict()
    assert set(document["meshes"]["ring_4-rim_3"].values()) == set(document["stages"]["pre_stage"].values()) == {0.0}
    assert document["pin"]["size"] == 0.0


def test_what_is_nothing_has_no_sign() -> None:
    """Spur teeth push neither way along the axis: 0, not -0, in either sense of the torque."""
    for torque in (90.0, -90.0):
        for force in forces_of(helical(0.0), torque).meshes.values():
            assert force.axial == 0.0 and math.copysign(1.0, force.axial) == 1.0

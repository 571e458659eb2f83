"""Forces on planets, against vectors in space."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.sets import alm_train, gear, unchecked_set

from gearcad.planetary import Carrier, Central, Rim, TrainLoad
from gearcad.planetary.power import TrainForces, forces, power_flow
from gearcad.planetary.train_data import TrainData


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

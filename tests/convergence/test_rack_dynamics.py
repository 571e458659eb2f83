"""Vibration of a pinion and a rack: closed forms, and the limit of wheels of many teeth."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import gearcad
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.pair_study import study_pair
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mesh_cycle import MeshCycle

PINION = Gear(teeth=20, normal_module=2, face_width=20, tooth_thinning=0.03)
RACK = Rack(teeth=40, normal_module=2, face_width=20, height=12, tooth_thinning=0.03)
PAIR = RackPair(pinion=PINION, rack=RACK)
LOAD = Load(torque=40.0, speed=300.0)
OPTIONS = DynamicsOptions(accuracy_grade=6, speeds=12, harmonics=6, speed_from=2000.0, speed_to=40_000.0)
INERTIA, MASS = 6e-5, 7.5


def cycle() -> MeshCycle:
    """A mesh cycle that swings by a tenth; nothing here asks how it was found."""
    angle = np.linspace(-9.0, 9.0, 61)
    stiffness = 500 * (1 + 0.1 * np.cos(2 * np.pi * angle / 18))
    force = 2000 * LOAD.torque / PINION.base_diameter
    fields = {"mesh_stiffness": stiffness, "tangent_stiffness": stiffness, "transmission_error": force / stiffness}
    return MeshCycle(method="plane-strain", holds=(), torque=LOAD.torque, force=force, width=20.0, roll_angle=angle, **fields)


def study(pair: RackPair | GearPair, inertias: PerGear[float]):
    return study_pair(pair, Material(), LOAD, cycle(), inertias, OPTIONS).study


def test_natural_frequency_is_that_of_pinion_and_mass():
    found = study(PAIR, PerGear(INERTIA, MASS * (PAIR.pitch_radius / 1000) ** 2))
    base, cosine = PINION.base_diameter / 2000, math.cos(math.radians(20))
    circular = math.sqrt(500e6 * (base**2 / INERTIA + cosine**2 / MASS))
    assert found.modes.frequency[1] == pytest.approx(circular / (2 * math.pi), rel=1e-9)


def test_loads_over_speed_are_the_limit_of_wheels():
    """Loads of the teeth of wheels of 500 and 1000 teeth whose rims have the rack's mass, extrapolated in 1/z."""
    own = study(PAIR, PerGear(INERTIA, MASS * (PAIR.pitch_radius / 1000) ** 2))
    found = []
    for teeth in (500, 1000):
        wheel = Gear(teeth=teeth, normal_module=2, face_width=20, tooth_thinning=0.03)
        pair = GearPair(pinion=PINION, wheel=wheel, centre_distance=20 + teeth)
        found.append(study(pair, PerGear(INERTIA, MASS * (teeth / 1000) ** 2)).up.factors)
    assert own.up.factors == pytest.approx(2 * found[1] - found[0], rel=1e-6)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"model": "contact"}, "dynamics.model = 'contact': must be \"mesh\" for a rack"),
        ({"wheel_inertia": 1.0}, "dynamics.wheel_inertia = 1 kg·m²: must be left out for a rack"),
        ({"pinion_bearing_stiffness": 90.0, "wheel_bearing_stiffness": 90.0}, "dynamics.pinion_bearing_stiffness = 90 N/µm"),
        ({"premature_engagement": "on"}, "dynamics.error_samples = 1: must be 1 for a rack, and premature_engagement off"),
    ],
)
def test_bad_input_is_one_line(options, message):
    given = DynamicsOptions(accuracy_grade=6, **options)
    with pytest.raises(ParameterError) as raised:
        gearcad.dynamics(PAIR, LOAD, dynamics=given)
    assert str(raised.value).startswith(message) and "\n" not in str(raised.value)


def test_masses_of_racks_are_of_racks_and_helical_ones_need_a_method():
    with pytest.raises(ParameterError, match=r"^dynamics\.rack_mass = 3 kg: must be left out for a pair of gears"):
        gearcad.dynamics(GearPair(pinion=PINION, wheel=PINION), LOAD, dynamics=DynamicsOptions(rack_mass=3.0))
    rack = Rack(length=250.0, normal_module=2, face_width=20, height=12, helix_angle=-10.0)
    helical = RackPair(pinion=replace(PINION, helix_angle=10.0), rack=rack)
    with pytest.raises(GeometryError, match=r"^pair\.helix_angle = 10 deg: must be 0 for a rack: no method knows"):
        gearcad.dynamics(helical, LOAD, dynamics=OPTIONS)


@pytest.mark.long
def test_mass_is_that_of_the_solid_unless_it_is_given():
    quick = replace(OPTIONS, speeds=2)
    own = gearcad.dynamics(PAIR, LOAD, dynamics=quick)
    profile = RACK.profile
    places = np.linspace(-RACK.root_depth, RACK.tip_height, 20_001)
    teeth = 2 * np.trapezoid(profile.half_thickness(places), places) * RACK.whole_pitches
    area = RACK.length * (RACK.height - RACK.root_depth) + teeth
    assert own.rack_mass == pytest.approx(area * RACK.face_width * Material().density * 1e-9, rel=1e-6)
    assert gearcad.dynamics(PAIR, LOAD, dynamics=replace(quick, rack_mass=3.0)).rack_mass == pytest.approx(3.0, rel=1e-12)

"""Ratings of the meshes of trains: as those of pairs, with the factors that planets add."""

import math
from dataclasses import replace
from typing import Any

import pytest
from support.loaded_trains import alm_set, simple_set
from support.sets import alm_train

from gearcad.core.records import PerGear
from gearcad.dynamics.planetary.planar_model import train_masses
from gearcad.dynamics.planetary.planetary_strength import TrainRating, rate_train
from gearcad.load import Load
from gearcad.material import Material, MaterialGroup
from gearcad.planetary import Carrier, PlanetaryTrain, TrainLoad
from gearcad.planetary.power import mesh_loads, power_flow, stage_loads
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.nominal_rating import rate

STEEL = Material(group=MaterialGroup.CASE_HARDENED)


def rated(train: PlanetaryTrain, computed: float | None = None, **given: Any) -> TrainRating:
    flow = power_flow(train, TrainLoad(**{"torque": 200.0, "speed": 1500.0} | given))
    loads, stages = mesh_loads(train, flow, computed), stage_loads(train, flow)
    return rate_train(train, loads, stages, train_masses(train), STEEL)


def weighed(train: PlanetaryTrain) -> PlanetaryTrain:
    """With inertias that are round numbers."""
    centrals = tuple(replace(each, mass=1.0, inertia=4e-4) for each in train.centrals)
    return replace(train, centrals=centrals, carrier=Carrier(planet_mass=0.3, planet_inertia=7e-5))


def test_a_mesh_is_rated_as_its_pair() -> None:
    train = weighed(simple_set(24, 21))
    found = rated(train, 1.2, application_factor=1.25)
    for mesh in train.meshes:
        own = found.meshes[mesh.name]
        force = {"sun-planet": 200 * 24 / 90 / 24, "ring-planet": 200 * 66 / 90 / 66}[mesh.name] / 3 * 21  # on the planet
        alone = rate(mesh.pair, STEEL, Load(torque=force, application_factor=1.5))
        assert own.rating.root_stresses == pytest.approx(alone.root_stresses)
        assert own.rating.contact_stresses == pytest.approx(alone.contact_stresses)
        document = own.to_dict()
        assert (document["K_A"], document["K_gamma"], document["K_gamma_source"]) == (1.25, 1.2, "computed")
        assert document["sigma_H0"] == alone.to_dict()["sigma_H0"]


def test_inertias_that_count_in_one_mesh() -> None:
    """m_red of ISO 6336-1 for planets, as remembered: J_p J_s/(N J_p r_s² + J_s r_p²), and J_p/r_p² at a ring that is held."""
    train = weighed(simple_set(24, 21))
    found = rated(train)
    r_s, r_p = (each.base_diameter / 2000 for each in (train.centrals[0].gear, train.rims[0].gear))
    by_hand = {"sun-planet": 7e-5 * 4e-4 / (3 * 7e-5 * r_s**2 + 4e-4 * r_p**2), "ring-planet": 7e-5 / r_p**2}
    for mesh in train.meshes:
        own = found.meshes[mesh.name]
        plain = DynamicFactor.of(mesh.pair, STEEL, own.load.load, PerGear(1e-4, 1e-4))
        wanted = replace(plain, reduced_mass=by_hand[mesh.name] / mesh.pair.common_width.width)
        assert own.dynamic_factor == pytest.approx(float(wanted.values(own.load.load.speed)), rel=1e-12)
        assert own.dynamic_factor > 1
        assert "K_v" in own.verify


def test_planets_of_simple_sets_bend_both_ways() -> None:
    simple, stepped = rated(simple_set(24, 21)), rated(alm_set(), torque=1600.0)
    for own in simple.meshes.values():
        document = own.to_dict()
        assert (document["pinion"]["Y_M"], document["wheel"]["Y_M"]) == (0.7, 1.0)
        assert "pinion.Y_M" in document["verify"]
    swapped = rated(simple_set(20, 32)).meshes["sun-planet"].to_dict()
    assert (swapped["pinion"]["Y_M"], swapped["wheel"]["Y_M"]) == (1.0, 0.7)
    for own in stepped.meshes.values():
        assert own.mean_stress_factor == (1.0, 1.0)
        assert not any(name.endswith("Y_M") for name in own.verify)


def test_what_is_not_known_is_said() -> None:
    """A ring without a rim has no inertia; it counts only where the ring turns."""
    turning = rated(simple_set(24, 21, fixed="carrier", output="ring"))
    assert turning.meshes["sun-planet"].dynamic_factor is not None
    assert turning.meshes["ring-planet"].dynamic_factor is None
    assert "rim_diameter" in turning.meshes["ring-planet"].to_dict()["K_v_unknown"]
    assert rated(simple_set(24, 21)).meshes["ring-planet"].dynamic_factor is not None
    resting = rated(simple_set(24, 21), torque=0.0)
    assert not resting.meshes
    assert resting.to_dict()["sun-planet"]["unrated"].startswith("torque = 0")
    assert {notice.code for notice in resting.notices} == {"unrated"}
    assert [str(notice) for notice in turning.notices] == [
        "rating: the inertias that count in K_v and Y_M = 0.7 of planets that bend both ways: as remembered of ISO 6336, whose"
        " text was not at hand: verify them before they decide",
        "rating: ring-planet: K_v is not known: " + turning.meshes["ring-planet"].no_dynamic_factor,
    ]


def test_the_alm_train_and_its_stage() -> None:
    train = alm_train()
    found = rated(train, torque=1600.0, speed=954.93)
    for name, force in (("ring_4-rim_3", 5374.64), ("ring_5-rim_3p", 6063.69)):
        document = found.to_dict()[name]
        assert document["F_bn"] == pytest.approx(force, abs=0.005)
        assert document["load"]["normal_force"] == pytest.approx(force, abs=0.005)
    base_diameter = 18 * 1.5 * math.cos(math.pi / 9)
    assert found.stages["pre_stage"].normal_force == pytest.approx(2000 * 1600 / 124.2807 / base_diameter, rel=1e-6)

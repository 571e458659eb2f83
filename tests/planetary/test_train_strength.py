"""Whether planetary trains hold: every mesh by the rating of pairs, with what planets add, and every gear by all its meshes."""

import math
from dataclasses import replace
from typing import Any

import pytest
from support.loaded_trains import alm_set, pre_stage, simple_set

from gearcad.core.records import PerGear, Role, Verdict
from gearcad.dynamics.planetary.planar_model import train_masses
from gearcad.dynamics.planetary.planetary_strength import TrainRating, rate_train
from gearcad.material import Material, MaterialGroup
from gearcad.planetary import Carrier, PlanetaryTrain, TrainLoad
from gearcad.planetary.power import mesh_loads, power_flow, stage_loads
from gearcad.plots import plot
from gearcad.rating import RatingOptions
from gearcad.rating.strength import RatedPart, rate_strength

EH = Material(name="Eh MQ")
LIFE = RatingOptions(life=10_000.0)


def weighed(train: PlanetaryTrain) -> PlanetaryTrain:
    """With inertias that are round numbers: no solids are made."""
    centrals = tuple(replace(each, mass=1.0, inertia=4e-4) for each in train.centrals)
    return replace(train, centrals=centrals, carrier=Carrier(planet_mass=0.3, planet_inertia=7e-5))


def rated(train: PlanetaryTrain, material: Any = EH, options: RatingOptions = LIFE, **given: Any) -> TrainRating:
    flow = power_flow(train, TrainLoad(**{"torque": 200.0, "speed": 1500.0, "mesh_load_factor": 1.1} | given))
    loads, stages = mesh_loads(train, flow), stage_loads(train, flow)
    return rate_train(train, loads, stages, train_masses(train, material), material, options)


def test_meshes_are_rated_as_pairs_with_what_planets_add() -> None:
    train = weighed(simple_set(24, 21))
    found = rated(train)
    for mesh in train.meshes:
        load, own = found.meshes[mesh.name].load, found.meshes[mesh.name]
        contacts = PerGear.each(lambda role, mesh=mesh: 3.0 if role is mesh.central_role else 1.0)
        bends = PerGear.each(lambda role, mesh=mesh: 1.0 if role is mesh.central_role else 0.7)
        options = replace(
            LIFE,
            mesh_load_factor=1.1,
            dynamic_factor=own.dynamic_factor,
            contacts_per_turn=tuple(contacts),
            mean_stress_factor=tuple(bends),
        )
        alone = rate_strength(mesh.pair, EH, replace(load.load, application_factor=1.0), options)
        whole = found.strength.meshes[mesh.name]
        for part in RatedPart:
            for role in Role:
                assert whole.parts[part].pick(role).safety == pytest.approx(alone.parts[part].pick(role).safety, rel=1e-12)


def test_load_cycles_are_those_of_a_flank_against_the_carrier() -> None:
    """Sun 24, ring 66: the sun turns 66/90 of its speed against the carrier, and meets three planets a turn."""
    strength = rated(weighed(simple_set(24, 21))).strength
    minutes, sun = 60 * LIFE.life, 1500 * 66 / 90  # type: ignore[operator]
    wanted = {"sun": sun * 3, "planet": sun * 24 / 21, "ring": sun * 24 / 66 * 3}
    for name, per_minute in wanted.items():
        for each in strength.members[name].every:
            assert each.cycles == pytest.approx(minutes * per_minute, rel=1e-12)


def test_a_picture_has_the_least_safety_of_every_gear() -> None:
    strength = rated(weighed(simple_set(24, 21))).strength
    flanks, roots = plot(strength).containers
    for bars, part in ((flanks, RatedPart.FLANK), (roots, RatedPart.ROOT)):
        least = [gear.least(part) for gear in strength.members.values()]
        assert [bar.get_height() for bar in bars] == [each.safety for each in least if each is not None]
    assert "<img" in strength._repr_html_()
    unlimited = rated(weighed(simple_set(24, 21)), Material()).strength
    assert "not asked for" in unlimited._repr_html_() and "<img" not in unlimited._repr_html_()


def test_gears_have_the_least_of_their_meshes() -> None:
    strength = rated(weighed(simple_set(24, 21))).strength
    planet = strength.members["planet"]
    assert set(planet.flank) == set(planet.root) == {"sun-planet", "ring-planet"}
    least = planet.least(RatedPart.FLANK)
    assert least is not None
    assert least.safety == min(each.safety for each in planet.flank.values() if each.safety is not None)
    assert planet.flank[least.mesh].safety == least.safety
    document = strength.summary()
    assert document["safety"]["planet"]["flank"] == least.safety
    assert document["safety"]["planet"]["flank_mesh"] == least.mesh
    assert set(document["safety"]) == {"sun", "ring", "planet"}


def test_verdicts() -> None:
    train = weighed(simple_set(24, 21))
    light, heavy = rated(train, torque=50.0).strength, rated(train, torque=5000.0).strength
    assert (light.strength, light.verdict) == (Verdict.PASSED, "strength passed")
    assert heavy.strength is Verdict.FAILED
    assert heavy.verdict.startswith("strength NOT passed: flank of sun in sun-planet")
    assert heavy.passed is False
    for name, gear in heavy.members.items():
        for part in RatedPart:
            assert gear.least(part).safety < light.members[name].least(part).safety  # type: ignore[union-attr]


def test_what_is_not_known_is_not_judged() -> None:
    train = weighed(simple_set(24, 21))
    soft = rated(train, {"sun": EH, "planet": EH, "ring": Material(group=MaterialGroup.CASE_HARDENED)}).strength
    assert soft.strength is Verdict.NOT_JUDGED
    assert soft.members["ring"].least(RatedPart.FLANK) is None
    assert soft.members["sun"].least(RatedPart.FLANK) is not None
    assert "passed" not in soft.verdict
    free = weighed(simple_set(24, 21, fixed="carrier", output="ring"))
    flow = power_flow(free, TrainLoad(torque=200.0, speed=1500.0))
    masses = train_masses(free)
    ring = replace(masses.members["ring"], inertia=None, why="ring: its rim is not known")
    unknown = replace(masses, members={**masses.members, "ring": ring})
    turning = rate_train(free, mesh_loads(free, flow), {}, unknown, EH, LIFE).strength
    assert turning.unrated["ring-planet"] == "K_v = None: must be known: ring: its rim is not known"
    assert turning.strength is Verdict.NOT_JUDGED
    shared = rated(train, options=replace(LIFE, mesh_load_factor=1.2)).strength
    assert shared.unrated["sun-planet"].startswith("rating.mesh_load_factor = 1.2: must be left out")


def test_nominal_ratings_stay_as_they_were() -> None:
    """The full rating stands beside what documents had."""
    train = weighed(simple_set(24, 21))
    found = rated(train)
    document = found.to_dict()
    for name, each in found.meshes.items():
        assert {key: value for key, value in document[name].items() if key != "rate"} == each.to_dict()
        full = document[name]["rate"]
        assert full["factors"]["K_gamma"] == 1.1
        assert full["factors"]["K_v"] == each.dynamic_factor
        assert "nominal" not in full
        assert {"K_v", "planet.Y_M"} <= set(full["verify"])


def test_stepped_trains_with_a_stage() -> None:
    """Teeth of stepped planets bend one way; the stage is a pair of its own."""
    train = weighed(replace(alm_set(), stages=(pre_stage(),), input="pinion_1"))
    strength = rated(train, torque=300.0).strength
    assert set(strength.meshes) | set(strength.unrated) == {"ring_4-rim_3", "ring_5-rim_3p", "pre_stage"}
    assert strength.meshes["ring_4-rim_3"].options.mean_stress_factor == (1.0, 1.0)
    assert strength.meshes["pre_stage"].options.contacts_per_turn == 1.0
    assert {"pinion_1", "gear_2", "rim_3", "ring_4"} <= set(strength.members)
    assert math.isfinite(strength.members["pinion_1"].least(RatedPart.ROOT).safety)  # type: ignore[union-attr]

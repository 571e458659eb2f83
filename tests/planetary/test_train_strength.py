"""Whether planetary trains hold: every mesh by the rating of pairs, with what planets share, and its sheet."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from support.planetary_trains import alm_set, alm_train, pre_stage, simple_set

from gearcad.core.records import PerGear, Role, Verdict
from gearcad.designs.reader import read_spec
from gearcad.dynamics.planetary.planar_model import train_masses
from gearcad.dynamics.planetary.planetary_strength import TrainRating, rate_train
from gearcad.jobs.strength import Rate
from gearcad.load import Load
from gearcad.material import Material, MaterialGroup
from gearcad.page.panels.sheet_content import Figures, strength_figures
from gearcad.planetary import Carrier, PlanetaryTrain, TrainLoad
from gearcad.planetary.power import mesh_loads, power_flow, stage_loads
from gearcad.plots import plot
from gearcad.rating import RatingOptions
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.nominal_rating import rate
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


STEEL = Material(group=MaterialGroup.CASE_HARDENED)


def mesh_rated(train: PlanetaryTrain, computed: float | None = None, **given: Any) -> TrainRating:
    flow = power_flow(train, TrainLoad(**{"torque": 200.0, "speed": 1500.0} | given))
    loads, stages = mesh_loads(train, flow, computed), stage_loads(train, flow)
    return rate_train(train, loads, stages, train_masses(train), STEEL)


def mesh_weighed(train: PlanetaryTrain) -> PlanetaryTrain:
    """With inertias that are round numbers."""
    centrals = tuple(replace(each, mass=1.0, inertia=4e-4) for each in train.centrals)
    return replace(train, centrals=centrals, carrier=Carrier(planet_mass=0.3, planet_inertia=7e-5))


def test_a_mesh_is_rated_as_its_pair() -> None:
    train = mesh_weighed(simple_set(24, 21))
    found = mesh_rated(train, 1.2, application_factor=1.25)
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
    train = mesh_weighed(simple_set(24, 21))
    found = mesh_rated(train)
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
    simple, stepped = mesh_rated(simple_set(24, 21)), mesh_rated(alm_set(), torque=1600.0)
    for own in simple.meshes.values():
        document = own.to_dict()
        assert (document["pinion"]["Y_M"], document["wheel"]["Y_M"]) == (0.7, 1.0)
        assert "pinion.Y_M" in document["verify"]
    swapped = mesh_rated(simple_set(20, 32)).meshes["sun-planet"].to_dict()
    assert (swapped["pinion"]["Y_M"], swapped["wheel"]["Y_M"]) == (1.0, 0.7)
    for own in stepped.meshes.values():
        assert own.mean_stress_factor == (1.0, 1.0)
        assert not any(name.endswith("Y_M") for name in own.verify)


def test_what_is_not_known_is_said() -> None:
    """A ring without a rim has no inertia; it counts only where the ring turns."""
    turning = mesh_rated(simple_set(24, 21, fixed="carrier", output="ring"))
    assert turning.meshes["sun-planet"].dynamic_factor is not None
    assert turning.meshes["ring-planet"].dynamic_factor is None
    assert "rim_diameter" in turning.meshes["ring-planet"].to_dict()["K_v_unknown"]
    assert mesh_rated(simple_set(24, 21)).meshes["ring-planet"].dynamic_factor is not None
    resting = mesh_rated(simple_set(24, 21), torque=0.0)
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
    found = mesh_rated(train, torque=1600.0, speed=954.93)
    for name, force in (("ring_4-rim_3", 5374.64), ("ring_5-rim_3p", 6063.69)):
        document = found.to_dict()[name]
        assert document["F_bn"] == pytest.approx(force, abs=0.005)
        assert document["load"]["normal_force"] == pytest.approx(force, abs=0.005)
    base_diameter = 18 * 1.5 * math.cos(math.pi / 9)
    assert found.stages["pre_stage"].normal_force == pytest.approx(2000 * 1600 / 124.2807 / base_diameter, rel=1e-6)


def test_every_mesh_has_its_own_sections() -> None:
    design = read_spec(Path(__file__).parents[2] / "templates" / "planetary-24-21-66.toml")
    job = Rate(report=False)
    expected = job.document(job.run(design))
    found: Figures = strength_figures(design)
    assert {section.name for section in found.sections} == {"", *expected["meshes"]}
    for name, mesh in expected["meshes"].items():
        gears = list(mesh["gears"].values()) if "gears" in mesh else ["pinion", "wheel"]
        stresses = mesh["stresses"]["sigma_F"]
        cells = [found.cells[f"{name}.factors.sigma_F", gear].value for gear in gears]
        assert cells == list(stresses.values())
        assert found.cells[f"{name}.factors.K_gamma", ""].value == mesh["factors"]["K_gamma"]

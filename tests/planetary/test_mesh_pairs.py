"""The meshes of planetary trains as pairs: designs, specs, loads, and structural checks."""

import math
import tomllib
from dataclasses import replace
from itertools import product
from typing import Any

import pytest
from support.planetary_trains import alm_set, alm_train, pre_stage, simple_set

from gearcad import Load, Material, check, dynamics, rate, stiffness
from gearcad.check.comparison import ComparisonRole
from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.designs import MeshPairs, PairDesign, PlanetaryDesign, design_from_tables
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.power import FactorSource, MeshLoad, forces, mesh_load_factor, mesh_loads, power_flow
from gearcad.rating.editions import Edition
from gearcad.rating.options import RatingOptions


def design(train: PlanetaryTrain, **given: Any) -> PlanetaryDesign:
    load = TrainLoad(torque=1600.0, speed=954.93)
    return PlanetaryDesign(**{"name": "train", "train": train, "load": load} | given)


def read(text: str) -> PairDesign:
    """The name of the file is no help."""
    found = design_from_tables(tomllib.loads(text), where=lambda key: key, default_name="unnamed")
    assert isinstance(found, PairDesign)
    return found


ALM = alm_set(stages=(pre_stage(),), input="pinion_1")
TRAINS = [ALM, simple_set(24, 21), simple_set(20, 32, helix_angle=12.5), simple_set(24, 21, fixed=None)]


@pytest.mark.parametrize("train", TRAINS, ids=lambda train: f"{train.set_type.value}{train.planets}")
def test_specs_give_the_pairs_to_the_last_digit(train: PlanetaryTrain) -> None:
    given = {"material": Material(name="steel", root_limit=400.0), "rating": RatingOptions(standard=Edition.DIN_1987)}
    speeds = {} if train.fixed else {"ring": 11.1}
    pairs = MeshPairs(design=design(train, speeds=speeds, **given), computed_factor=1.1)
    names = [*(mesh.name for mesh in train.meshes), *(stage.name for stage in train.stages)]
    assert list(pairs.texts) == [f"{name}.toml" for name in names]
    for name, text in zip(names, pairs.texts.values(), strict=True):
        assert read(text) == pairs.designs[name]
        assert read(text).pair.to_dict() == pairs.designs[name].pair.to_dict()
    for mesh in train.meshes:
        own = pairs.designs[mesh.name]
        assert own.name == own.pair.name == f"train-{mesh.name}"
        assert replace(own.pair, name=mesh.name) == mesh.pair


def test_loads_of_the_alm_thesis() -> None:
    pairs = MeshPairs(design=design(ALM))
    forces = {name: abs(each.load.torque) * 2000 / each.pair.pinion.base_diameter for name, each in pairs.designs.items()}
    assert forces["ring_4-rim_3"] == pytest.approx(5374.64, abs=0.005)
    assert forces["ring_5-rim_3p"] == pytest.approx(6063.69, abs=0.005)
    assert forces["pre_stage"] == pytest.approx(1014.84, abs=0.005)


def test_what_a_spec_says_of_its_load() -> None:
    """K_gamma as given, as computed, or none; nothing of a load that is not there."""
    simple = simple_set(24, 21)
    by_errors = MeshPairs(design=design(simple, load=TrainLoad(torque=200, application_factor=1.25)), computed_factor=1.2)
    text = by_errors.texts["sun-planet.toml"]
    assert "# application_factor is K_A 1.25 times K_gamma 1.2 (computed of the train's errors)." in text
    assert read(text).load.application_factor == 1.5
    assert "# they have 0.7 (Y_M of ISO 6336-3, recalled)." in text
    given = MeshPairs(design=design(simple, load=TrainLoad(torque=200, mesh_load_factor=1.3)), computed_factor=1.2)
    assert "K_gamma 1.3 (as given)" in given.texts["ring-planet.toml"]
    assert "K_gamma 1 (equal shares)" in MeshPairs(design=design(alm_set())).texts["ring_4-rim_3.toml"]
    assert "Y_M" not in MeshPairs(design=design(alm_set())).texts["ring_4-rim_3.toml"]
    bare = MeshPairs(design=design(simple, load=None)).texts["sun-planet.toml"]
    assert "# The train has no load." in bare
    assert read(bare).load is None


def test_jobs_of_pairs_name_the_specs() -> None:
    """check, stiffness and dynamics of a planetary train, in one line; its meshes are taken."""
    own = design(simple_set(24, 21))
    for job in (check, stiffness, dynamics):
        with pytest.raises(ParameterError) as caught:
            job(own)
        message = str(caught.value)
        assert "`gearcad planetary` writes the specs of its meshes for that, sun-planet.toml and ring-planet.toml" in message
        assert "\n" not in message
    pairs = MeshPairs(design=own).designs
    assert stiffness(pairs["ring-planet"], methods=["iso6336"]).load == pairs["ring-planet"].load
    twice = replace(pairs["sun-planet"], load=Load(torque=2 * pairs["sun-planet"].load.torque))
    stress, more = (rate(each).nominal.root_stresses.pinion for each in (pairs["sun-planet"], twice))
    assert more == pytest.approx(2 * stress)


def test_every_spec_has_a_file_of_its_own() -> None:
    twice = replace(pre_stage(), name="ring_4-rim_3")
    with pytest.raises(ParameterError, match=r"name = 'ring_4-rim_3': must be given once: every mesh and stage"):
        design(alm_set(stages=(twice,), input="pinion_1"))
    with pytest.raises(ParameterError, match="must be a plain file name"):
        design(alm_set(stages=(replace(pre_stage(), name="pre/stage"),), input="pinion_1"))


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


CHECK_ALM = PlanetaryDesign(
    name="alm", train=alm_set(stages=(pre_stage(),), input="pinion_1"), load=TrainLoad(torque=1600, speed=954.93)
)
SIMPLE = PlanetaryDesign(
    name="simple",
    train=simple_set(24, 21, rim_diameter=165.0),
    load=TrainLoad(torque=200, speed=1500, mesh_load_factor=1.2, application_factor=1.25),
)
PAIRS = [*MeshPairs(design=CHECK_ALM).designs.values(), *MeshPairs(design=SIMPLE).designs.values()]

BALANCE = 1e-6
"""Relative: what forces at the held circle are off the torque that is applied."""


@pytest.mark.long
@pytest.mark.parametrize("design", PAIRS, ids=lambda design: design.name)
def test_gates_of_the_check(design: PairDesign) -> None:
    found = check(design)
    gates = [each for each in found.comparisons if each.role is ComparisonRole.GATE]
    assert len(gates) == 9
    assert all(each.passed for each in gates)
    torque = abs(design.load.torque) * design.load.application_factor
    reactions = {each.quantity: each for each in gates if each.quantity.startswith("torque reaction")}
    assert reactions["torque reaction of the pinion"].reference == pytest.approx(torque, rel=1e-12)
    on_wheel = torque * abs(design.pair.gear_ratio)
    assert reactions["torque reaction of the wheel"].reference == pytest.approx(on_wheel, rel=1e-12)
    for each in reactions.values():
        assert each.computed == pytest.approx(each.reference, rel=BALANCE)
    assert {each.quantity for each in gates} >= {"peak contact pressure", "half width of contact"}
    for position in found.cycle.positions:
        shares = [contact.share for contact in position.contacts]
        assert sum(shares) == pytest.approx(1, abs=1e-9)
    # One pair carries all of it for part of the mesh, as contact ratios below 2 have it.
    assert {len(position.contacts) for position in found.cycle.positions} == {1, 2}

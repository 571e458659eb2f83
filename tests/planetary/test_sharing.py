"""Load sharing and twist against one dense matrix; springs that can only press against all their active sets."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from support.dense_trains import dense_sharing
from support.planetary_trains import TRAINS, alm_train, output_torque, simple_set, sun_set

from gearcad.core.errors import GeometryError, ParameterError, SolverError
from gearcad.core.records import Bools, Floats
from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.planetary_statics import Equilibrium, TwistSource, torsional_stiffness, train_statics
from gearcad.dynamics.planetary.planetary_strength import published_factors
from gearcad.geometry import Gear, GearPair
from gearcad.planetary import Carrier, PairStage, PlanetaryTrain, TrainLoad
from gearcad.planetary.power import forces, power_flow

DENSE = 1e-5
"""Of the mean force: what open meshes of the one matrix still carry, and rigid pins that are 1e8 N/µm there."""

STIFFNESS = {"sun-planet": 400.0, "ring-planet": 500.0}


def springy(
    train: PlanetaryTrain, seed: int, *, errors: float = 10.0, rigid_pins: bool = False, softest: float = 0.0
) -> PlanetaryTrain:
    """With random errors, and bearings of which one floats or is the softest."""
    random = np.random.default_rng(seed)
    supports = [float(each) for each in random.permutation([softest, 30.0, 200.0])]
    rims = tuple(replace(rim, tooth_errors=tuple(random.normal(0, errors, train.planets))) for rim in train.rims)
    a, b = (replace(each, support_stiffness=k) for each, k in zip(train.centrals, supports, strict=False))
    carrier = Carrier(
        support_stiffness=supports[2],
        pin_stiffness=None if rigid_pins else 250.0,
        pin_errors=tuple(random.normal(0, errors, train.planets)),
    )
    return replace(train, centrals=(a, b), rims=rims, carrier=carrier)


def by_name(train: PlanetaryTrain) -> dict[str, float]:
    first, second = train.meshes
    return {first.name: 400.0, second.name: 500.0}


@pytest.mark.parametrize("torque", [800.0, -800.0])
@pytest.mark.parametrize("kind", TRAINS)
def test_forces_are_those_of_the_dense_matrix(kind: str, torque: float) -> None:
    train = springy(TRAINS[kind], seed=sum(map(ord, kind)), rigid_pins=kind == "B")
    load, stiffness = TrainLoad(torque=torque, speed=100.0), by_name(train)
    found = share_load(train, load, stiffness)
    expected, _ = dense_sharing(train, load, stiffness)
    for mesh, force in zip(found.meshes.values(), expected, strict=True):
        assert mesh.force == pytest.approx(force, abs=DENSE * force.mean())


@pytest.mark.parametrize("torque", [400.0, 60.0])
def test_planets_that_errors_part_from_their_teeth_carry_nothing(torque: float) -> None:
    train = springy(simple_set(20, 28, planets=4), seed=3, errors=60.0, softest=5.0)
    load = TrainLoad(torque=torque)
    found = share_load(train, load, STIFFNESS)
    expected, _ = dense_sharing(train, load, STIFFNESS)
    assert found.meshes["sun-planet"].force == pytest.approx(expected[0], abs=DENSE * expected[0].mean())
    assert found.unloaded == tuple(np.flatnonzero(expected[0] == 0)) != ()
    assert any("planets without contact" in text for text in found.warnings)


@pytest.mark.parametrize("in_phase", [False, True])
def test_twist_is_the_virtual_work_of_all_springs(in_phase: bool) -> None:
    """And the one matrix, in which the stage is a spring to a pinion in space, has the same in the mean over a turn."""
    stiffness = {"ring_4-rim_3": 314.5, "ring_5-rim_3p": 300.7, "pre_stage": 181.6}
    train = springy(alm_train(in_phase=in_phase), seed=1, errors=0.0)
    load = TrainLoad(torque=1600.0)
    found = torsional_stiffness(train, load, stiffness)
    turned = [dense_sharing(train, load, stiffness, carrier_angle=angle)[1] for angle in (0, 120, 240)]
    # Pinned members turn at 1e12 N·m/rad.
    assert found.twist == pytest.approx(np.mean(turned), rel=1e-5)
    assert sum(each.share for each in found.contributions) == pytest.approx(1, abs=1e-12)
    assert found.share(TwistSource.PIN) > 0.25 and found.share(TwistSource.SUPPORT) > 0.005


def test_shaft_stiffness_adds_the_squares_of_torques() -> None:
    train = simple_set()
    sun, ring = train.centrals
    shafts = {"sun": 2e5, "ring": 5e6, "carrier": 1e6}
    centrals = (replace(sun, torsional_stiffness=shafts["sun"]), replace(ring, torsional_stiffness=shafts["ring"]))
    soft = replace(train, centrals=centrals, carrier=Carrier(torsional_stiffness=shafts["carrier"]))
    load = TrainLoad(torque=900.0)
    more = torsional_stiffness(soft, load, STIFFNESS).twist - torsional_stiffness(train, load, STIFFNESS).twist
    torques = power_flow(train, load).torques
    by_hand = sum(torques[name] ** 2 / k for name, k in shafts.items()) / 900.0
    assert np.radians(more) == pytest.approx(by_hand, rel=1e-9)


@pytest.mark.parametrize("train", [simple_set(), TRAINS["C"], alm_train(stages=())], ids=["A", "C", "D"])
def test_without_errors_pins_carry_what_the_balance_has(train: PlanetaryTrain) -> None:
    load = TrainLoad(torque=500.0, speed=10.0)
    pins, expected = share_load(train, load, by_name(train)).pins, forces(train, power_flow(train, load)).pin
    assert pins.radial == pytest.approx(expected.radial, abs=1e-6)
    assert pins.tangential == pytest.approx(expected.tangential, abs=1e-6)


@pytest.mark.parametrize("floating", [(), ("sun",)])
def test_run_out_is_taken_at_its_worst_angles(floating: tuple[str, ...]) -> None:
    """All planets in contact, forces are linear: their greatest is F_0 + sum e |A - i B|, and the dense matrix agrees."""
    train = sun_set(5, floating=floating, carrier=Carrier(pin_stiffness=300.0, pin_errors=(9.0, 0, 0, -4.0, 0)))
    centrals = tuple(replace(each, run_out=e) for each, e in zip(train.centrals, (12.0, 20.0), strict=True))
    train, load = replace(train, centrals=centrals), TrainLoad(torque=output_torque(train))
    found = share_load(train, load, STIFFNESS)
    still, _ = dense_sharing(train, load, STIFFNESS)
    bare, waves = replace(train, carrier=replace(train.carrier, pin_errors=())), np.zeros((2, 5))
    for central in train.centrals:
        alone = replace(bare, centrals=tuple(replace(e, run_out=e.run_out * (e is central)) for e in train.centrals))
        cos, sin = (
            dense_sharing(alone, load, STIFFNESS, run_out_angles={central.name: angle})[0] - still.mean() for angle in (0, 90)
        )
        waves += np.hypot(cos, sin)
    # `still` has the run-out at 0 deg too; without it:
    steady, _ = dense_sharing(replace(train, centrals=sun_set(5, floating=floating).centrals), load, STIFFNESS)
    for place, mesh in enumerate(found.meshes.values()):
        assert mesh.greatest == pytest.approx(steady[place] + waves[place], rel=DENSE)
        assert mesh.least == pytest.approx(steady[place] - waves[place], rel=2 * DENSE)
    assert found.turning == ("run-out of sun", "run-out of ring")
    assert found.mesh_load_factor > 1.03


def test_where_contact_is_lost_the_worst_angle_is_no_less_than_any_other() -> None:
    train = sun_set(4, carrier=Carrier(pin_stiffness=300.0, pin_errors=(30.0, -30.0, 0, 0), run_out=15.0))
    train = replace(train, centrals=tuple(replace(each, run_out=40.0) for each in train.centrals))
    load = TrainLoad(torque=output_torque(train, 15000.0))
    found = share_load(train, load, STIFFNESS)
    assert 0 in found.unloaded and found.mesh_load_factor > 1.5
    statics = train_statics(train, load, STIFFNESS)
    angles = np.random.default_rng(0).uniform(0, 2 * np.pi, (500, 3))
    assert statics.state(angles).forces[:, statics.meshes[0]].max() <= found.meshes["sun-planet"].greatest.max() * (1 + 1e-9)


def test_errors_of_a_plain_rim_do_the_same_in_either_mesh() -> None:
    """The planet turns until both meshes share them: so they are counted once."""
    train = sun_set(4, carrier=Carrier(pin_stiffness=300.0))
    errors = (10.0, -5.0, 3.0, 0.0)
    rimmed = replace(train, rims=(replace(train.rims[0], tooth_errors=errors),))
    statics = train_statics(rimmed, TrainLoad(torque=output_torque(train)), STIFFNESS)
    in_ring = statics.gap.copy()
    in_ring[statics.meshes[1]], in_ring[statics.meshes[0]] = statics.gap[statics.meshes[0]], 0.0
    for gap in (statics.gap, in_ring):
        found, _ = statics.equilibrium.forces(statics.compliance[None], gap[None], statics.load[None])
        assert found[0, statics.meshes] == pytest.approx(share_forces(rimmed), rel=1e-9)


def share_forces(train: PlanetaryTrain) -> np.ndarray:
    found = share_load(train, TrainLoad(torque=output_torque(train)), STIFFNESS)
    return np.array([mesh.force for mesh in found.meshes.values()])


RANDOM = [*TRAINS.values(), sun_set(6), sun_set(4), simple_set(26, 18, planets=5, planet_angles="permitted")]


@pytest.mark.parametrize("seed", range(24))
def test_any_state_is_in_balance_fits_and_presses(seed: int) -> None:
    """The conditions of the one least energy: whatever fulfils them is the answer, however it was found."""
    random = np.random.default_rng(seed)
    train = springy(RANDOM[seed % len(RANDOM)], seed, errors=float(random.choice([3.0, 300.0])), rigid_pins=seed % 2 == 0)
    uneven = {mesh.name: random.uniform(50, 600, train.planets) for mesh in train.meshes}
    load = TrainLoad(torque=float(random.choice([-1, 1]) * 10 ** random.uniform(1, 4)), speed=50.0)
    statics = train_statics(train, load, uneven)
    state, springs, meshes = statics.state(), statics.equilibrium, statics.meshes.ravel()
    forces, stretch = state.forces[0], (state.yielding + state.gap - state.opening)[0]
    assert forces @ springs.vectors == pytest.approx(statics.load, abs=1e-9 * forces.max())
    moved = springs.displacement(stretch[None])[0]
    assert springs.vectors @ moved == pytest.approx(stretch, abs=1e-9 * np.abs(stretch).max())
    assert forces[meshes].min() >= 0 and state.opening.min() >= 0
    assert not (forces[meshes] * state.opening[0, meshes]).max() > 1e-9 * forces.max() * np.abs(stretch).max()
    assert not np.delete(state.opening[0], meshes).any()


def test_an_eccentric_carrier_is_both_centrals_the_other_way() -> None:
    train = sun_set(4, carrier=Carrier(pin_stiffness=300.0, run_out=10.0))
    load, turned = TrainLoad(torque=output_torque(train)), np.array([[0.3], [2.0], [4.1]])
    alone = train_statics(train, load, STIFFNESS).state(turned).forces
    centrals = tuple(replace(each, run_out=10.0) for each in train.centrals)
    both = train_statics(replace(train, centrals=centrals, carrier=replace(train.carrier, run_out=0.0)), load, STIFFNESS)
    opposite = both.state(np.hstack([turned, turned]) + np.pi).forces
    meshes = both.meshes.ravel()
    assert np.ptp(alone[:, meshes]) > 1000
    assert alone[:, meshes] == pytest.approx(opposite[:, meshes], rel=1e-9)


def test_a_stage_behind_the_set_twists_as_a_train_of_its_own() -> None:
    gear = Gear(teeth=30, normal_module=2, face_width=10)
    pair = GearPair(pinion=gear, wheel=replace(gear, teeth=60))
    behind = PairStage(name="behind", pair=pair, pinion="carrier", wheel="out")
    staged = simple_set(stages=(behind,), output="out")
    found = torsional_stiffness(staged, TrainLoad(torque=2000.0, speed=10.0), STIFFNESS | {"behind": 200.0})
    before = torsional_stiffness(simple_set(), TrainLoad(torque=1000.0, speed=10.0), STIFFNESS)
    force = 2000 / (pair.wheel.base_diameter / 2000)
    assert found.twist == pytest.approx(before.twist / 2 + np.degrees(force**2 / 200e6 / 2000), rel=1e-9)


def test_what_tilts_planets_is_told_to_be_left_out() -> None:
    for train, words in (
        (TRAINS["A helical"], "axial forces"),
        (alm_train(), "meshes in different planes"),
        (simple_set(), ""),
    ):
        found = share_load(train, TrainLoad(torque=500.0, speed=10.0), by_name(train))
        told = [notice.text for notice in found.notices if notice.code == "planets-parallel"]
        assert told == ([f"planets stand parallel: how far {words} tilt them is left out"] if words else [])


def test_what_cannot_be_shared_is_refused() -> None:
    train, load = simple_set(), TrainLoad(torque=500.0)
    with pytest.raises(ParameterError, match=r"torque = 0 N·m: must not be 0"):
        share_load(train, TrainLoad(torque=0.0), STIFFNESS)
    alone = simple_set(planets=1)
    sun, ring = alone.centrals
    with pytest.raises(GeometryError, match=r"sun.support_stiffness = 0 N/µm: .*as sun floats"):
        share_load(replace(alone, centrals=(replace(sun, support_stiffness=0.0), ring)), load, STIFFNESS)
    assert share_load(alone, load, STIFFNESS).shares == pytest.approx(1)
    pushed = alm_train(carrier=Carrier(support_stiffness=0.0))
    fourth, fifth = pushed.centrals
    pushed = replace(pushed, centrals=(fourth, replace(fifth, support_stiffness=0.0)))
    with pytest.raises(GeometryError, match="as carrier and ring_5 float"):
        share_load(pushed, load, {"ring_4-rim_3": 300.0, "ring_5-rim_3p": 300.0})


def test_planets_that_would_have_to_pull_are_told() -> None:
    """The sun floats between three planets that stand on one side of it."""
    train = simple_set(20, 28, planet_angles=(0.0, 78.75, 157.5))
    sun, ring = train.centrals
    train = replace(train, centrals=(replace(sun, support_stiffness=0.0), ring))
    with pytest.raises(SolverError, match="teeth would have to pull, as sun floats"):
        share_load(train, TrainLoad(torque=500.0), STIFFNESS)


def test_places_that_nothing_decides_are_told() -> None:
    train = simple_set()
    train = replace(train, centrals=tuple(replace(each, support_stiffness=0.0) for each in train.centrals))
    found = share_load(train, TrainLoad(torque=500.0), STIFFNESS)
    assert found.undetermined == ("sun", "ring")
    assert found.shares == pytest.approx(1)
    assert any("nothing decides where sun and ring float" in text for text in found.warnings)


def test_published_factors_have_their_sources() -> None:
    assert [published_factors(n)[0].factor for n in (1, 3, 4, 5, 6, 12)] == [1.0, 1.0, 1.2, 1.3, 1.4, 1.4]
    assert [len(published_factors(n)) for n in (2, 3, 6, 7)] == [1, 2, 2, 1]
    assert all(each.source and each.recalled is (each.source == "IEC 61400-4") for each in published_factors(4))


def test_the_document_is_plain() -> None:
    train = springy(simple_set(20, 28, planets=4), seed=3)
    found = share_load(train, TrainLoad(torque=500.0), STIFFNESS).to_dict()
    assert found["mesh_load_factor"] == max(found["greatest_shares"])
    assert set(found["meshes"]) == set(STIFFNESS) and len(found["pins"]["greatest"]) == 4
    stiff = torsional_stiffness(train, TrainLoad(torque=500.0), STIFFNESS)
    assert stiff.to_dict()["stiffness"] == pytest.approx(500.0 / np.radians(stiff.twist))
    with pytest.raises(ParameterError, match="must be below"):
        stiff.implied_pin_stiffness(1e12)


EXACT = 1e-9


def _by_hand(vectors: Floats, press: Bools, compliance: Floats, gap: Floats, load: Floats) -> list[Floats]:
    """Forces of every active set that fulfils all conditions: F >= 0 where closed, no overlap where open."""
    count, found = len(press), []
    size = vectors.shape[1]
    places = np.flatnonzero(press)
    for off in (set(each) for number in range(len(places) + 1) for each in combinations(places, number)):
        on, apart = [j for j in range(count) if j not in off], sorted(off)
        matrix = np.block([[-np.diag(compliance[on]), vectors[on]], [vectors[on].T, np.zeros((size, size))]])
        right = np.r_[gap[on], load]
        solved, *_ = np.linalg.lstsq(matrix, right, rcond=1e-12)
        forces = np.zeros(count)
        forces[on] = solved[: len(on)]
        opening = gap[apart] - vectors[apart] @ solved[len(on) :]
        if np.allclose(matrix @ solved, right, atol=1e-8) and (forces[places] > -EXACT).all() and (opening > -EXACT).all():
            found.append(forces)
    return found


@pytest.mark.parametrize("seed", range(40))
def test_forces_are_those_of_the_one_active_set(seed: int) -> None:
    random = np.random.default_rng(seed)
    size = int(random.integers(2, 5))
    count = size + int(random.integers(1, 5))
    vectors, press = random.normal(size=(count, size)), random.random(count) < 0.7
    compliance = random.uniform(0.1, 3, count)
    gap, load = random.normal(size=count) * random.choice([0.1, 3]), random.uniform(0, 1, count) @ vectors
    springs = Equilibrium(vectors=vectors, press=press)
    case = compliance[None], gap[None], load[None]
    forces, opening = springs.forces(*case)
    sets = _by_hand(vectors, press, compliance, gap, load)
    assert sets  # the load is one that pressing springs can carry
    for other in sets:  # degenerate ones differ in what is open, not in forces
        assert forces[0] == pytest.approx(other, abs=EXACT * np.abs(other).max())
    assert (opening[0] >= 0).all()
    elongation = compliance * forces[0] + gap - opening[0]
    assert vectors @ springs.displacement(elongation[None])[0] == pytest.approx(elongation, abs=EXACT)


def test_there_is_none_where_a_spring_would_have_to_pull() -> None:
    """Two springs on either side of a body that is pulled between them, and a third that ties it."""
    vectors = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])
    springs = Equilibrium(vectors=vectors, press=np.array([True, True, False]))
    one = np.ones((1, 3))
    forces, opening = springs.forces(one, np.zeros((1, 3)), np.array([[2.0, 5.0]]))
    assert forces[0] == pytest.approx([2, 0, 5]) and opening[0] == pytest.approx([0, 2, 0])
    only = Equilibrium(vectors=vectors[::2], press=np.array([True, False]))
    with pytest.raises(SolverError, match="no compressive forces"):
        only.forces(one[:, :2], np.zeros((1, 2)), np.array([[-2.0, 5.0]]))


def test_many_cases_are_each_by_itself() -> None:
    random = np.random.default_rng(7)
    vectors, press = random.normal(size=(8, 4)), np.arange(8) < 5
    compliance, gap = random.uniform(0.1, 3, (20, 8)), random.normal(size=(20, 8))
    load = random.uniform(0, 1, (20, 8)) @ vectors
    springs = Equilibrium(vectors=vectors, press=press)
    together, _ = springs.forces(compliance, gap, load)
    alone = [springs.forces(compliance[i : i + 1], gap[i : i + 1], load[i : i + 1])[0][0] for i in range(20)]
    assert together == pytest.approx(np.array(alone), abs=1e-10)


def test_what_springs_cannot_carry_is_found() -> None:
    springs = Equilibrium(vectors=np.array([[1.0, 0.0], [2.0, 0.0]]), press=np.array([True, True]))
    assert springs.redundancy == 1
    assert springs.unbalanced(np.array([[3.0, 0.0], [3.0, 0.5]])) == pytest.approx(np.array([[0, 0], [0, 0.5]]))

"""Load sharing, running and torsional stiffness of planetary trains against closed forms and the Alm thesis."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.planetary_trains import SUN_FORCE, Trapezoid, alm_train, output_torque, sun_set

from gearcad.core.records import Floats
from gearcad.dynamics.planetary.load_sharing import LoadSharing, share_load
from gearcad.dynamics.planetary.planetary_statics import TwistSource, torsional_stiffness, twist_of
from gearcad.dynamics.planetary.quasi_static_run import Running, run_train
from gearcad.planetary import Carrier, PlanetaryTrain, TrainLoad
from gearcad.planetary.power import forces, power_flow

CLOSED = 1e-9
"""Exactly held supports leave the closed forms nothing but rounding."""

PATH = 62.64774948768101
"""N/µm: 1/k_p = 1/400 + 1/500 + (2 cos 22 deg)²/300."""

STIFFNESS = {"sun-planet": 400.0, "ring-planet": 500.0}

SHARES = {
    3: ([1.0, 1.0, 1.0], 1.0774479757998967),
    4: ([1.0387239878999484, 0.9612760121000516, 1.0387239878999484, 0.9612760121000516], 1.1161719636998453),
    5: ([1.0774479757998967, 0.9373432713979437, 1.023932740702108, 1.023932740702108, 0.9373432713979437], 1.1548959515997936),
    6: ([1.1161719636998453, 0.9225520242001032, 1.0, 1.0387239878999484, 1.0, 0.9225520242001032], 1.1936199394997418),
}
"""20 µm on the pin of planet 1, sun floating; held: K_gamma, where all others have 0.9612760121000516. Own closed form,
F_n = F/N - k_p (P e)_n, e = 2 e_t cos alpha, P = I - A (A'A)^-1 A', A = [1, cos psi, sin psi] (held: A = 1)."""


def shared(train: PlanetaryTrain) -> LoadSharing:
    return share_load(train, TrainLoad(torque=output_torque(train)), STIFFNESS)


def pinned(planets: int, *errors: float, floating: tuple[str, ...] = ()) -> PlanetaryTrain:
    errors += (0.0,) * (planets - len(errors))
    return sun_set(planets, floating=floating, carrier=Carrier(pin_stiffness=300.0, pin_errors=errors))


@pytest.mark.parametrize("planets", SHARES)
def test_shares_are_those_of_the_closed_form(planets: int) -> None:
    floating, held = SHARES[planets]
    found = shared(pinned(planets, -20.0, floating=("sun",)))
    assert found.shares == pytest.approx(floating, abs=CLOSED)
    assert found.mesh_load_factor == pytest.approx(max(floating), abs=CLOSED)
    assert found.meshes["sun-planet"].force.sum() == pytest.approx(SUN_FORCE, rel=CLOSED)
    found = shared(pinned(planets, -20.0))
    assert found.shares == pytest.approx([held, *[0.9612760121000516] * (planets - 1)], abs=CLOSED)


@pytest.mark.parametrize("planets", [4, 5, 6])
def test_any_pin_errors_follow_the_projector(planets: int) -> None:
    errors = np.random.default_rng(planets).normal(0, 12, planets)
    psi = 2 * np.pi * np.arange(planets) / planets
    a = np.stack([np.ones(planets), np.cos(psi), np.sin(psi)], -1)
    projector = np.eye(planets) - a @ np.linalg.solve(a.T @ a, a.T)
    if planets == 5:
        assert projector == pytest.approx(2 / 5 * np.cos(2 * (psi[:, None] - psi)), abs=1e-12)
    expected = SUN_FORCE / planets - PATH * projector @ (2 * errors * np.cos(np.radians(22)))
    found = shared(pinned(planets, *errors, floating=("sun",)))
    assert found.meshes["sun-planet"].force == pytest.approx(expected, rel=CLOSED)


@pytest.mark.parametrize("floating", ["sun", "ring", "carrier"])
@pytest.mark.parametrize("seed", range(3))
def test_three_planets_share_alike_where_a_member_floats(floating: str, seed: int) -> None:
    """Whatever the errors and the stiffnesses of single meshes, with a bearing that gives way elsewhere."""
    random = np.random.default_rng(seed)
    train = pinned(3, *random.normal(0, 40, 3), floating=(floating,))
    rims = (replace(train.rims[0], tooth_errors=tuple(random.normal(0, 40, 3))),)
    others = {name: float(random.uniform(10, 500)) for name in ("sun", "ring") if name != floating}
    centrals = tuple(
        replace(each, support_stiffness=others.get(each.name, 0.0), run_out=30.0 if each.name == "sun" else 0.0)
        for each in train.centrals
    )
    train = replace(train, rims=rims, centrals=centrals)
    uneven = {name: random.uniform(100, 600, 3) for name in STIFFNESS}
    found = share_load(train, TrainLoad(torque=output_torque(train)), uneven)
    assert found.shares == pytest.approx(1, abs=CLOSED)
    assert found.mesh_load_factor == pytest.approx(1, abs=CLOSED)


def test_four_planets_share_in_opposite_pairs() -> None:
    shares = shared(pinned(4, -20.0, 7.0, 11.0, -3.0, floating=("sun",))).shares
    assert shares[0] == pytest.approx(shares[2], abs=CLOSED)
    assert shares[1] == pytest.approx(shares[3], abs=CLOSED)
    change = PATH * 2 * np.cos(np.radians(22)) * (20 + 7 - 11 - 3) / 4
    assert shares[0] == pytest.approx(1 + change / (SUN_FORCE / 4), abs=CLOSED)


MESHES = {"ring_4-rim_3": 314.547, "ring_5-rim_3p": 300.683, "pre_stage": 181.640}
"""N/µm, tables 4 and 5 of the Alm thesis."""


@pytest.mark.parametrize(("in_phase", "force", "amplitude"), [(False, 1014.838, 14.07), (True, 1248.518, 18.76)])
def test_the_force_of_the_stage_makes_the_carrier_synchronous_wave(in_phase: bool, force: float, amplitude: float) -> None:
    """Carrier floating, three planets: decided by balance alone. The reference is sampled every 5 deg: 0.1 % lower at most."""
    train = alm_train(in_phase=in_phase, carrier=Carrier(support_stiffness=0.0))
    for stiffness in (MESHES, {name: 3 * k for name, k in MESHES.items()}):
        found = share_load(train, TrainLoad(torque=1600.0), stiffness)
        assert found.turning == ("forces of stages",)
        assert 100 * (found.greatest_shares - 1) == pytest.approx(amplitude, abs=0.05)
        assert 100 * (1 - found.least_shares) == pytest.approx(amplitude, abs=0.05)
        assert found.meshes["ring_5-rim_3p"].force == pytest.approx(6063.691, abs=0.001)
    # Pins in balance with the force across the axis: N/2 times amplitude times the force of a pin.
    acting = forces(train, power_flow(train, TrainLoad(torque=1600.0)))
    assert acting.stages["pre_stage"].normal == pytest.approx(force, abs=0.001)
    assert found.mesh_load_factor - 1 == pytest.approx(2 * force / (3 * acting.pin.size), rel=1e-6)


@pytest.mark.parametrize(("ring", "percent", "within"), [(1000.0, 7.9, 0.05), (1.0, 0.09, 0.005), (0.0, 0.0, 1e-9)])
def test_a_supported_carrier_leaves_the_wave_to_the_bearing_of_ring_5(ring: float, percent: float, within: float) -> None:
    """1e5 N/mm at the carrier: own computation, and the thesis's remark that a floating ring 5 removes the wave."""
    train = alm_train(carrier=Carrier(support_stiffness=100.0, pin_stiffness=1e4))
    fourth, fifth = train.centrals
    train = replace(train, centrals=(fourth, replace(fifth, support_stiffness=ring)))
    found = share_load(train, TrainLoad(torque=1600.0), MESHES)
    assert 100 * (found.mesh_load_factor - 1) == pytest.approx(percent, abs=within)


def test_without_a_stage_there_is_no_wave() -> None:
    train = alm_train(stages=(), carrier=Carrier(support_stiffness=0.0))
    found = share_load(train, TrainLoad(torque=1600.0), MESHES)
    assert not found.turning and found.mesh_load_factor == pytest.approx(1, abs=CLOSED)


COURSES = {
    "ring_4-rim_3": Trapezoid(212.207, 354.224, 0.7206),
    "ring_5-rim_3p": Trapezoid(208.207, 356.886, 0.622),
    "pre_stage": Trapezoid(121.070, 214.695, 0.573),
}
"""Least and greatest stiffness as printed; two pairs for as long as the mean asks for."""

SECONDS = 3600
"""Arc seconds in a degree."""


@cache
def run(in_phase: bool, carrier: float | None, ring: float | None) -> Running:
    """With stiffnesses (N/µm) of the bearings of carrier and ring 5, None held; pins of 1e7 N/mm."""
    train = alm_train(in_phase=in_phase, carrier=Carrier(support_stiffness=carrier, pin_stiffness=1e4))
    fourth, fifth = train.centrals
    train = replace(train, centrals=(fourth, replace(fifth, support_stiffness=ring)))
    return run_train(train, TrainLoad(torque=1600.0, speed=955.0), COURSES, steps=64)


def test_figure_53_planets_out_of_phase_share_unevenly_at_mesh_frequency() -> None:
    found = run(False, None, None)
    assert (found.shares.min(), found.shares.max()) == pytest.approx((0.837, 1.081), abs=0.0006)
    assert found.mesh_load_factor == found.shares.max()


def test_figure_54_planets_in_phase_share_evenly() -> None:
    assert np.abs(run(True, None, None).shares - 1).max() < 3e-5


@pytest.mark.parametrize(("in_phase", "percent"), [(False, 14.07), (True, 18.76)])
def test_a_floating_carrier_leaves_the_wave_of_the_stage_only(in_phase: bool, percent: float) -> None:
    found = run(in_phase, 0.0, 100.0)
    assert found.mesh_share_ripple < 1e-9
    assert 100 * (found.shares.max() - 1) == pytest.approx(percent, abs=0.05)
    assert 100 * (1 - found.shares.min()) == pytest.approx(percent, abs=0.05)
    # Synchronous with the carrier: planets carry most a third of its turn after each other.
    most = found.carrier_angle[found.shares.argmax(axis=1)]
    assert np.sort(np.mod(most - most[0], 360)) == pytest.approx([0, 120, 240], abs=0.2)


@pytest.mark.parametrize("ring", [1000.0, 1.0])
def test_the_slow_part_is_what_sharing_has_with_mean_compliances(ring: float) -> None:
    """7.7 % and 0.09 % here; 7.9 % with the means of the stiffnesses as printed."""
    found = run(False, 100.0, ring)
    places = np.linspace(0, 1, 100001)
    mean = {name: 1 / np.mean(1 / each.stiffness_at(places)) for name, each in COURSES.items()}
    still = share_load(found.train, TrainLoad(torque=1600.0), mean)
    assert found.slow_shares.max(axis=1) == pytest.approx(still.greatest_shares, abs=1e-6)
    assert found.slow_shares.min(axis=1) == pytest.approx(still.least_shares, abs=1e-6)


@pytest.mark.parametrize(
    ("in_phase", "carrier", "ring", "seconds"),
    [(False, None, None, 34.67), (True, None, None, 48.25), (False, 0.0, 100.0, 38.03), (True, 0.0, 100.0, 49.09)],
)
def test_planets_in_phase_make_more_ripple_of_the_twist(
    in_phase: bool, carrier: float | None, ring: float | None, seconds: float
) -> None:
    """Peak to peak, by an own dense computation in 6,000 steps of a quarter turn; the other way round than the shares."""
    assert SECONDS * run(in_phase, carrier, ring).mesh_ripple == pytest.approx(seconds, abs=0.05)


def test_the_greatest_ripple_is_that_of_all_meshes_together() -> None:
    """In phase, held: all planets go from one pair to two at once; both meshes and the stage meet sooner or later."""
    found = run(True, None, None)
    forces = {name: force[0] for name, force in found.forces.items()}
    work = sum(
        3 * forces[name].mean() ** 2 * (1 / each.least - 1 / each.most) for name, each in COURSES.items() if name in forces
    )
    stage = COURSES["pre_stage"]
    work += 1248.518**2 * (1 / stage.least - 1 / stage.most)
    assert found.mesh_ripple == pytest.approx(np.degrees(work / 1600e6), rel=1e-3)


TORQUE = 1600.0

COUNT = np.array([1, 3, 3])
"""Of the pre-stage, and of each ring of the set."""

LAW = np.array([2.4e6, 2.4e6, 2.1e6])
"""K of table 2 in N/mm^1.5, F = K delta^1.5."""


def normal_forces(torque: float = TORQUE) -> Floats:
    """Of the pre-stage, ring 4 and ring 5."""
    train = alm_train()
    found = forces(train, power_flow(train, TrainLoad(torque=torque)))
    meshes = (found.stages["pre_stage"], *found.meshes.values())
    return np.array([mesh.normal for mesh in meshes])


def twist(torque: float) -> float:
    """By the power law (rad)."""
    acting = normal_forces(torque)
    return math.radians(float(twist_of(np.sum(COUNT * acting * 1000 * (acting / LAW) ** (1 / 1.5)), torque)))


def test_the_power_law_of_the_thesis() -> None:
    acting = normal_forces()
    assert acting == pytest.approx([1014.84, 5374.64, 6063.69], abs=0.005)
    assert 1000 * (acting / LAW) ** (1 / 1.5) == pytest.approx([5.634, 17.117, 20.277], abs=0.0005)
    assert math.degrees(twist(TORQUE)) == pytest.approx(0.023297, abs=5e-7)
    assert TORQUE / twist(TORQUE) == pytest.approx(3.935e6, abs=500)
    assert 2 / (twist(TORQUE + 1) - twist(TORQUE - 1)) == pytest.approx(5.902e6, abs=500)


def test_the_linear_stiffness_of_tables_4_and_5() -> None:
    found = torsional_stiffness(alm_train(), TrainLoad(torque=TORQUE), MESHES)
    assert found.stiffness == pytest.approx(3.950e6, abs=500)
    acting = normal_forces()
    stiffness = np.array([MESHES[name] for name in ("pre_stage", "ring_4-rim_3", "ring_5-rim_3p")])
    by_hand = COUNT * acting**2 / stiffness / 1e6 / TORQUE
    added = {each.name: math.radians(each.twist) for each in found.contributions}
    assert [added[name] for name in ("pre_stage", "ring_4-rim_3", "ring_5-rim_3p")] == pytest.approx(by_hand, rel=1e-9)
    assert found.share(TwistSource.MESH) + found.share(TwistSource.STAGE) == pytest.approx(1, abs=1e-12)
    assert found.rigid[0] == "pins"


def test_the_bearings_of_the_thesis_imply_a_pin_stiffness() -> None:
    """Its 3.14e6 N·m/rad has bearings besides meshes: 420 N/µm a pin by its power law, 414 by its tables; not fitted."""
    left = TORQUE / 3.14e6 - twist(TORQUE)
    assert left == pytest.approx(1.029e-4, abs=1e-7)
    train = alm_train()
    pin = forces(train, power_flow(train, TrainLoad(torque=TORQUE))).pin
    assert (abs(pin.radial), abs(pin.tangential)) == pytest.approx((4772.44, 556.29), abs=0.005)
    assert 3 * pin.size**2 / (TORQUE * left) / 1e6 == pytest.approx(420.4, abs=0.1)
    found = torsional_stiffness(train, TrainLoad(torque=TORQUE), MESHES)
    assert found.implied_pin_stiffness(3.14e6) == pytest.approx(414.07, abs=0.01)

"""Load sharing of planets against closed forms, and what the pre-stage of the Alm thesis does to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.sets import alm_train
from support.sharing_trains import SUN_FORCE, output_torque, sun_set

from gearcad.dynamics.planetary.load_sharing import LoadSharing, share_load
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

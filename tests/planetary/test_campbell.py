"""Campbell data of planetary trains: frequencies of what shakes them, and which modes the planets' phases let it shake."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from support.mode_trains import MASSES, TRAINS, lin_parker_train, masses_of, on_springs
from support.planetary import thesis_train

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.dynamics.planetary.planar_model import train_springs
from gearcad.dynamics.planetary.planetary_modes import (
    LineKind,
    ModeKind,
    PlanetaryCampbell,
    modal_shares,
    planetary_campbell,
    planetary_modes,
)
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.poses import train_harmonics

STIFFNESS = (400.0, 500.0)

RULE = {
    "24/3": "RRRRRR",
    "25/3": "TTRTTR",
    "26/3": "TTRTTR",
    "24/4": "RRRRRR",
    "25/4": "TPTRTP",
    "26/4": "PRPRPR",
    "27/4": "TPTRTP",
    "24/5": "TPPTRT",
    "27/5": "PTTPRP",
    "28/6": "PPRPPR",
    "27/6": "PRPRPR",
}
"""Teeth of a central and planets: kinds that the harmonics 1 to 6 of its meshes excite, by k = m z mod N."""


@pytest.mark.parametrize("case", RULE)
@pytest.mark.parametrize("sign", [1, -1])
def test_forces_on_modes_follow_the_rule_of_phases(case: str, sign: int) -> None:
    """Found with the modes themselves, which know nothing of the rule."""
    teeth, planets = (int(each) for each in case.split("/"))
    springs = lin_parker_train(
        planets,
        meshes=(3e8, 4.2e8),
        angles=(25.0, 21.0),
        supports={"c": 8e7, "r": 1.5e8, "s": 3e7},
        torsion={"c": 5e7, "r": 9e8, "s": 0.0},
        pin=1.2e8,
    )
    modes = planetary_modes(springs, masses_of((0.7, 0.6), c=(3.2, 3.9), r=(2.1, 2.6), s=(0.5, 0.45)))
    ahead = sign * teeth * np.arange(planets) / planets + 0.37
    for harmonic, expected in enumerate(RULE[case], 1):
        for mesh in ("s-p", "r-p"):
            shares = modal_shares(modes, mesh, ahead, harmonic)
            found = {family.kind for family, share in zip(modes.families, shares, strict=True) if share}
            kind = {"R": ModeKind.ROTATIONAL, "T": ModeKind.TRANSLATIONAL, "P": ModeKind.PLANET}[expected]
            assert found == {kind} or (planets == 3 and kind is ModeKind.PLANET and not found)
            assert shares.max() <= 1 + 1e-12
            if kind is ModeKind.ROTATIONAL:
                assert shares[shares > 0] == pytest.approx(1.0)


def _campbell(train: PlanetaryTrain, highest: float, **given: object) -> PlanetaryCampbell:
    modes = planetary_modes(train_springs(train, STIFFNESS), MASSES)
    return planetary_campbell(train, modes, train.phases, highest, **given)  # type: ignore[arg-type]


def test_frequencies_of_a_sun_planet_ring_train() -> None:
    """Sun in, ring fixed: n_c = n_s z_s/(z_s + |z_r|)."""
    train = on_springs(TRAINS["A"], support=60.0, pin=200.0)
    campbell = _campbell(train, 20_000.0, harmonics=3)
    carrier = Fraction(24, 90)
    mesh, planet = float(66 * carrier / 60), float(Fraction(66, 21) * carrier / 60)
    assert [(line.name, line.kind) for line in campbell.lines] == [
        ("a-rim1", LineKind.MESH),
        ("2 x a-rim1", LineKind.MESH),
        ("3 x a-rim1", LineKind.MESH),
        ("b-rim1", LineKind.MESH),
        ("2 x b-rim1", LineKind.MESH),
        ("3 x b-rim1", LineKind.MESH),
        ("planets past a", LineKind.PASS),
        ("planets past b", LineKind.PASS),
        ("planet on its pin", LineKind.TURN),
    ]
    passing = [float(3 * (1 - carrier) / 60), float(3 * carrier / 60)]
    expected = [*(m * mesh for m in (1, 2, 3, 1, 2, 3)), *passing, planet]
    assert [line.per_rpm for line in campbell.lines] == pytest.approx(expected, rel=1e-12)


def test_resonances_are_where_lines_meet_modes() -> None:
    campbell = _campbell(on_springs(TRAINS["B"], support=60.0, pin=200.0), 20_000.0)
    assert [each.speed for each in campbell.resonances] == sorted(each.speed for each in campbell.resonances)
    for each in campbell.resonances:
        line, family = campbell.lines[each.line], campbell.families[each.family]
        assert line.per_rpm * each.speed == pytest.approx(family.frequency) == pytest.approx(each.frequency)
        assert 0 < each.speed <= 20_000
        if line.kind is LineKind.MESH:
            assert each.excited == (campbell.shares[each.line, each.family] > 0)
        else:
            assert each.excited is None
    met = sum(0 < family.frequency / line.per_rpm <= 20_000 for line in campbell.lines for family in campbell.families)
    assert len(campbell.resonances) == met > len(campbell.excited) > 0
    # 24 teeth and four planets: all in phase; 74 teeth: each against the next.
    assert campbell.kinds_excited("a-rim1", 1) == (ModeKind.ROTATIONAL,)
    assert campbell.kinds_excited("b-rim2", 1) == (ModeKind.PLANET,)
    assert campbell.kinds_excited("b-rim2", 2) == (ModeKind.ROTATIONAL,)
    plain = campbell.to_dict()
    assert plain["lines"][0]["name"] == "a-rim1" and plain["shares"][-1][0] is None


def test_a_load_near_a_resonance_is_told() -> None:
    train = on_springs(TRAINS["B"], support=60.0, pin=200.0)
    met = _campbell(train, 20_000.0).excited[0]
    for share, told in ((1.0, True), (0.951, True), (1.049, True), (0.949, False), (1.051, False)):
        # Whether the speed is drawn or not, and whichever way the input turns.
        for highest, sense in ((20_000.0, 1), (100.0, -1)):
            campbell = _campbell(train, highest, speed=sense * share * met.speed)
            assert campbell.speed == pytest.approx(share * met.speed)
            assert all(each.excited and abs(campbell.speed / each.speed - 1) <= 0.05 for each in campbell.near)
            found = [each for each in campbell.near if (each.line, each.family) == (met.line, met.family)]
            assert bool(found) == told
            words = [notice.text for notice in campbell.notices if f"{met.speed:.5g} rpm" in notice.text]
            assert bool(words) == told
            assert not told or campbell.lines[met.line].name in words[0]
    # Beside one at which the planets take each other off nothing is told of it.
    idle = next(each for each in _campbell(train, 20_000.0).resonances if each.excited is False)
    near = _campbell(train, 20_000.0, speed=idle.speed).near
    assert (idle.line, idle.family) not in {(each.line, each.family) for each in near}
    assert not _campbell(train, 20_000.0).notices and not _campbell(train, 20_000.0, speed=0.0).near


def test_unequal_planets_are_excited_by_their_own_phases() -> None:
    """At angles where teeth let them stand the sums do not vanish."""
    train = on_springs(TRAINS["A"], support=60.0, pin=200.0)
    modes = planetary_modes(train_springs(train, STIFFNESS), MASSES)
    even, uneven = np.array([0.0, 1 / 3, 2 / 3]), np.array([0.0, 0.3, 2 / 3])
    rotational = [place for place, family in enumerate(modes.families) if family.kind is ModeKind.ROTATIONAL][1:]
    assert not modal_shares(modes, "a-rim1", even, 1)[rotational].any()
    expected = abs(np.exp(2j * np.pi * uneven).sum()) / 3
    assert modal_shares(modes, "a-rim1", uneven, 1)[rotational] == pytest.approx(expected)


@pytest.mark.parametrize("kind", TRAINS)
def test_sums_over_phases_say_the_same_as_the_modes(kind: str) -> None:
    """Torque and force of a harmonic on the members, which know of no modes."""
    train = on_springs(TRAINS[kind], support=60.0, pin=200.0)
    modes = planetary_modes(train_springs(train, STIFFNESS), MASSES)
    campbell = planetary_campbell(train, modes, train.phases, 1000.0)
    for name, sums in train_harmonics(train).items():
        for each in sums:
            kinds = campbell.kinds_excited(name, each.harmonic)
            assert each.excited == (ModeKind.ROTATIONAL in kinds, ModeKind.TRANSLATIONAL in kinds)


def test_stages_and_stepped_planets_have_lines_of_their_own() -> None:
    """The train of the Alm thesis: 18 teeth on the shaft that drives, and rims of 22 and 21."""
    train = thesis_train()
    masses = masses_of((0.7, 3e-4), carrier=(3.2, 6e-3), ring_4=(2.0, 9e-3), ring_5=(2.1, 9e-3))
    modes = planetary_modes(train_springs(train, STIFFNESS), masses)
    campbell = planetary_campbell(train, modes, train.phases, 3000.0, harmonics=1)
    found = {line.name: line.per_rpm for line in campbell.lines}
    carrier = Fraction(18, 161)
    assert found["stage"] == pytest.approx(18 / 60)
    assert found["ring_4-rim_3"] == pytest.approx(float(70 * carrier / 60))
    assert found["ring_5-rim_3p"] == pytest.approx(float(70 * Fraction(21, 22) * carrier / 60))
    # Everything is held in place but the turning: what would travel is a matter of the planets alone.
    assert campbell.kinds_excited("ring_4-rim_3", 1) == (ModeKind.PLANET,)
    assert campbell.kinds_excited("ring_5-rim_3p", 1) == (ModeKind.ROTATIONAL,)


def test_a_differential_needs_its_second_speed() -> None:
    train = replace(on_springs(TRAINS["A"], support=60.0, pin=200.0), fixed=None)
    with pytest.raises(ParameterError, match="must have one more"):
        _campbell(train, 3000.0)
    campbell = _campbell(train, 3000.0, given_speeds={"b": -1000.0}, harmonics=1)
    carrier = (24 * 3000 - 66 * 1000) / 90
    assert campbell.lines[0].per_rpm == pytest.approx(24 * (3000 - carrier) / 60 / 3000)
    with pytest.raises(GeometryError, match="nothing meshes"):
        _campbell(train, 3000.0, given_speeds={"b": 3000.0})

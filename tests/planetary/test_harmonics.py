"""Which harmonics shake what: the published rule, and sums over the planets."""

from __future__ import annotations

import math

import pytest
from support.planetary import simple_train, thesis_train

from gearcad.planetary.poses import Excited, excited_modes, harmonic_sums, train_harmonics
from gearcad.planetary.train_data import permitted_steps

RULE = {
    (24, 3): "RRRRRR",
    (25, 3): "TTRTTR",
    (26, 3): "TTRTTR",
    (24, 4): "RRRRRR",
    (25, 4): "TPTRTP",
    (26, 4): "PRPRPR",
    (27, 4): "TPTRTP",
    (24, 5): "TPPTRT",
    (27, 5): "PTTPRP",
    (28, 6): "PPRPPR",
    (27, 6): "PRPRPR",
}
"""Modes that harmonics 1 to 6 shake, by teeth of the central and planets: rotational, translational, planets' only."""

LETTERS = {Excited(True, False): "R", Excited(False, True): "T", Excited(False, False): "P"}


@pytest.mark.parametrize("case", RULE)
def test_equal_planets_follow_the_rule(case: tuple[int, int]) -> None:
    teeth, planets = case
    assert "".join(LETTERS[excited_modes(teeth, planets, harmonic)] for harmonic in range(1, 7)) == RULE[case]


@pytest.mark.parametrize("planets", [1, 2, 3, 4, 5, 6, 7])
@pytest.mark.parametrize("teeth", [24, 25, -66, -71])
def test_sums_say_the_same_as_the_rule(teeth: int, planets: int) -> None:
    angles = [360 * number / planets for number in range(planets)]
    sums = harmonic_sums([-teeth * angle / 360 % 1 for angle in angles], angles)
    assert [each.excited for each in sums] == [excited_modes(teeth, planets, each.harmonic) for each in sums]


def test_both_meshes_of_trains_have_their_own() -> None:
    """The thesis's: ring 4 out of phase, ring 5 in phase; 25/20/-65 alike in both meshes."""
    fourth, fifth = train_harmonics(thesis_train()).values()
    assert [LETTERS[each.excited] for each in fourth] == list("TTRTTR")
    assert [LETTERS[each.excited] for each in fifth] == list("RRRRRR")
    sun, ring = train_harmonics(simple_train((25, 20, -65), (0.2, 0.2, -0.6), 3)).values()
    assert [LETTERS[each.excited] for each in sun] == [LETTERS[each.excited] for each in ring] == list("TTRTTR")


def test_unequal_planets_leave_some_of_everything() -> None:
    """Four planets of 25/20/-65 put in at 0, 22, 45 and 68 ninetieths of a turn, added up as vectors."""
    steps = (0, 22, 45, 68)
    train = simple_train((25, 20, -65), (0.2, 0.2, -0.6), 4, planet_angles=[4.0 * step for step in steps])
    for each in train_harmonics(train)["sun-planet"]:
        waves = [-each.harmonic * 25 * step / 90 * 2 * math.pi for step in steps]
        places = [2 * math.pi * step / 90 for step in steps]
        torque = math.hypot(sum(map(math.cos, waves)), sum(map(math.sin, waves))) / 4
        assert each.torque == pytest.approx(torque, abs=1e-9)
        # A force along x and y that turns with the pitch circle: its real and imaginary parts, at their greatest over time.
        forces = [
            math.hypot(
                sum(math.cos(w + s * p) for w, p in zip(waves, places, strict=True)),
                sum(math.sin(w + s * p) for w, p in zip(waves, places, strict=True)),
            )
            / 4
            for s in (1, -1)
        ]
        assert each.force == pytest.approx(max(forces), abs=1e-9)
        assert 0 < each.torque < 1


def test_permitted_angles_balance_where_positions_are_equally_near() -> None:
    """17/16/-49: of 66 positions 16 and 17, 49 and 50 are equally near to quarters of a turn: opposite ones are chosen."""
    train = simple_train((17, 16, -49), (0.4, 0.4, -1.2), 4, planet_angles="permitted")
    assert train.angles == pytest.approx((0, 92.7272727, 180, 272.7272727))
    assert train.unbalance == pytest.approx(0, abs=1e-12)
    assert train_harmonics(train)["sun-planet"][0].torque == pytest.approx(0, abs=1e-9)
    for positions in range(7, 100):
        for planets in range(2, min(positions, 7)):
            steps = permitted_steps(positions, planets)
            assert len(set(steps)) == planets
            off = [abs(step - positions * number / planets) for number, step in enumerate(steps)]
            assert max(off) <= 0.5

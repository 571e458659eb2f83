"""The search for modifications, on FZG C gears: what it finds, against what is known of good tip relief."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from gearcad import Mounting
from gearcad.geometry import ReliefShape
from gearcad.ltca.search import Found, Search, start_search
from gearcad.ltca.solid_cycle import run_solid_cycle
from gearcad.ltca.solid_pair import loaded_left
from gearcad.ltca.variants import Condition, with_amounts
from gearcad.modify import unmirrored
from tests.support.coarse import PAIRS, TORQUES, coarse_model, coarse_pair

TORQUE = TORQUES["FZG C"]

_GENEROUS = 1.3
"""Of the pressure of plain flanks: so much that the pressure at the bend of a linear relief does not decide."""


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.ltca.search._GENERATIONS", 10)


@pytest.fixture(scope="module")
def search() -> Search:
    with threadpool_limits(1):
        return start_search(coarse_model("FZG C"), TORQUE, ReliefShape.LINEAR)


def best(search: Search, share: float) -> Found:
    with threadpool_limits(1):
        return search.best([share * float(search.plain.pressures[0])])


def test_tip_relief_halves_the_transmission_error_as_the_rules_of_the_field_say(
    search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gearcad.ltca.search._GENERATIONS", 25)
    found = best(search, _GENEROUS)
    model = coarse_model("FZG C")
    proposed = model.remade(with_amounts(model.pair, found.amounts, ReliefShape.LINEAR), Mounting())
    before, after = (run_solid_cycle(each, TORQUE, 24) for each in (model, proposed))
    errors = [float(np.ptp(cycle.values("transmission_error"))) for cycle in (before, after)]
    # Solved in full on finer lines it is what the search saw, and far less than before.
    assert errors[1] == pytest.approx(found.peak_to_peak, abs=0.1)
    assert errors[1] < 0.4 * errors[0]
    assert found.bounded
    assert found.edges_free
    assert not any(contact.edge for position in after.positions for contact in position.contacts)
    # Relief at the tip about equals what one pair of teeth gives way under the load; long relief begins where a second pair
    # takes over, (eps_alpha - 1) p_b below the tip, short relief after half of that (Niemann/Winter, vol. 2; Houser).
    path = model.pair.path_of_contact
    longest = path.E - path.A - model.line.pitch
    named = found.named
    for owner in ("pinion", "wheel"):
        assert 0.8 * search.deflection < named[f"{owner}.tip_relief"] < 1.3 * search.deflection
        assert 0.5 * longest < named[f"{owner}.tip_relief_length"] < longest
    assert found.named["pinion.helix_angle_modification"] == 0


def test_proposals_are_round_and_the_same_each_time(search: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.ltca.search._GENERATIONS", 2)
    first, second = (search.run(2000.0) for _ in range(2))
    np.testing.assert_array_equal(first.amounts, second.amounts)
    lengths = first.amounts[[1, 3]] / 0.05
    np.testing.assert_allclose(lengths, np.round(lengths), atol=1e-9)
    amounts = first.amounts[[0, 2, 4, 5]]
    np.testing.assert_array_equal(amounts, np.round(amounts))


def test_a_bound_of_the_pressure_is_kept_and_one_that_cannot_be_gives_way_to_the_next(search: Search) -> None:
    plain = float(search.plain.pressures[0])
    with threadpool_limits(1):
        found = search.best([0.5 * plain, 1.03 * plain])
    assert found.bound == 1.03 * plain
    assert found.bounded
    assert 0.98 * found.bound < found.outcome.pressures[0] < 1.001 * found.bound  # it is what stops the search
    assert found.peak_to_peak < 0.6 * search.plain.peak_to_peak[0]


def test_the_helix_is_turned_after_a_misaligned_wheel(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.ltca.search._GENERATIONS", 5)
    model = coarse_model("FZG C")
    mounting = Mounting(misalignment=30.0)
    with threadpool_limits(1):
        search = start_search(model.remade(model.pair, mounting), TORQUE, ReliefShape.PARABOLIC)
        aligned = start_search(model, TORQUE, ReliefShape.PARABOLIC)
        found = best(search, 1.05)
    # Both faces are 14 mm wide, so 30 µm of the helix make up for 30 µm of the axis, and pressures are those of aligned gears.
    assert search.plain.pressures[0] == pytest.approx(aligned.plain.pressures[0], rel=1e-6)
    assert found.named["pinion.helix_angle_modification"] == pytest.approx(30, abs=8)
    without = replace(found, amounts=found.amounts * [1, 1, 1, 1, 1, 0]).amounts
    pressures = search.outcomes(np.stack([found.amounts, without]), Condition(TORQUE)).pressures
    assert pressures[1] > 1.15 * pressures[0]


@pytest.mark.parametrize("name", PAIRS)
def test_amounts_found_on_the_mirror_image_are_those_of_the_pair(name: str) -> None:
    pair, amounts = coarse_pair(name), np.array([20.0, 2.0, 18.0, 1.5, 3.0, 7.0])
    modified = with_amounts(pair, unmirrored(amounts, pair, -1.0), ReliefShape.LINEAR)
    mirrored = with_amounts(loaded_left(pair, -1.0), amounts, ReliefShape.LINEAR)
    assert loaded_left(modified, -1.0) == mirrored
    assert with_amounts(pair, unmirrored(amounts, pair, 1.0), ReliefShape.LINEAR) == with_amounts(
        pair, amounts, ReliefShape.LINEAR
    )

"""Contacts that a pair of sections has solved are not solved again; where the search for what touches begins is no matter."""

from dataclasses import replace

import numpy as np
import pytest
from support.checks import small_check

from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import KnownContacts, PlanePair, solve_contact
from gearcad.contact.shared.local_contact import _cell_by_cell, _positive, complementary
from gearcad.stiffness import PlaneStrainContact

_POSITIONS, _SINGLE = 12, 25
_SAME = 1e-11
"""Relative: the same equations, solved in another order."""


def fresh() -> PlanePair:
    return replace(small_check().cycle.model, known=KnownContacts())


def test_positions_that_two_counts_have_in_common_are_the_same_numbers() -> None:
    few, many = (fresh().roll_angles(count) for count in (12, 60))
    assert list(few) == list(many[2::5])
    assert list(-few[::-1]) == list(few)
    assert np.diff(many) == pytest.approx(360 / 16 / 60)


def test_stiffness_of_a_check_takes_the_contacts_of_its_cycle() -> None:
    check, model = small_check(), fresh()
    cycle = PlaneCycle.run(model, check.torque, _POSITIONS)
    single = model.single_stiffness(check.torque)
    assert len(model.known) == _POSITIONS + _SINGLE
    method = PlaneStrainContact(pair=check.pair, material=check.material, bodies=model)
    found = method(check.load, _POSITIONS)
    assert len(model.known) == 3 * _POSITIONS + _SINGLE  # softer and harder ones for the slope
    assert found.single_stiffness == single * model.width
    assert list(found.transmission_error[:-1]) == list(cycle.values("transmission_error"))


def test_sign_of_the_torque_is_no_matter_to_what_is_known() -> None:
    model = fresh()
    assert model.solve(1.0, 300.0) is model.solve(1.0, -300.0)
    assert model.solve(1.0, 300.0) is not model.solve(1.0, 300.0, single=True)


def test_contact_is_the_same_from_any_guess() -> None:
    model, force = fresh(), 800.0
    found = model.solve(4.0, 302.0)
    others = [model.solve(angle, torque) for angle, torque in ((4.1, 400.0), (-9.0, 10.0))]
    for like in (None, found, *others):
        again = solve_contact(found.pairs, model.bodies, force, like)
        first = solve_contact(found.pairs, model.bodies, force)
        assert again.approach == pytest.approx(first.approach, rel=_SAME)
        assert again.forces == pytest.approx(first.forces, rel=_SAME)


@pytest.mark.parametrize("seed", range(6))
def test_complementarity_has_one_solution_from_any_start(seed: int) -> None:
    random = np.random.default_rng(seed)
    place = np.sort(random.uniform(-3, 3, 40))
    matrix = np.exp(-np.abs(place[:, None] - place)) + 0.05 * np.eye(40)
    gap, width = place**2 * random.uniform(0.5, 1.5, 40), random.uniform(0.5, 1.5, 40)
    pressure, approach = complementary(matrix, gap, width, 3.0)
    for touching in (random.random(40) < 0.3, random.random(40) < 0.01, np.zeros(40, bool)):
        other, same = complementary(matrix, gap, width, 3.0, touching)
        assert other == pytest.approx(pressure, rel=_SAME, abs=_SAME)
        assert same == pytest.approx(approach, rel=_SAME)
    other, same = _cell_by_cell(matrix, gap, width, 3.0)
    assert other == pytest.approx(pressure, rel=_SAME, abs=_SAME)
    assert same == pytest.approx(approach, rel=_SAME)


@pytest.mark.parametrize("seed", range(20))
def test_a_compliance_with_an_error_below_zero_still_carries_the_load(seed: int) -> None:
    """A coarse mesh may leave a negative eigenvalue, for which no set of cells need be right: lesser ones are raised."""
    random = np.random.default_rng(seed)
    place = np.linspace(-3, 3, 60)
    matrix = np.exp(-((place[:, None] - place) ** 2)) - 0.02 * np.eye(60)
    assert np.linalg.eigvalsh(matrix)[0] == pytest.approx(-0.02, abs=1e-6)
    raised = _positive(matrix)
    assert np.linalg.eigvalsh(raised)[0] == pytest.approx(0.02, abs=1e-6)
    gap, width = place**2 * random.uniform(0.5, 1.5, 60), np.ones(60)
    pressure, approach = complementary(matrix, gap, width, 3.0)
    opening = raised @ pressure + gap - approach
    assert pressure.sum() == pytest.approx(3.0, rel=1e-9)
    assert pressure.min() >= 0
    assert opening.min() > -1e-9
    assert np.abs(pressure * opening).max() < 1e-9

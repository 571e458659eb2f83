"""Many variants at once against the same contact solved one by one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.coarse import PAIRS, TORQUES, coarse_model

from gearcad import FlankModification, Mounting
from gearcad.contact.modification_variants import Condition, FlankVariants, Outcomes, with_amounts
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.line_contact import LineSolution, gaps, plain_widths, solve_lines, start_distances
from gearcad.contact.solid.pair import KnownResponses
from gearcad.geometry import GearPair, ReliefShape

HIGH = np.array([60.0, 6.0, 60.0, 6.0, 15.0, 12.0])
LOW = np.array([0.0, 1.5, 0.0, 1.5, 0.0, -12.0])

TRANSMISSION_ERROR = 2e-3
"""Relative: other cells' ellipses are as wide as the mean load makes them; 0.03 % to 0.1 % was found."""

PRESSURE = 0.01
"""Relative: the square root of the load of a cell."""

PRESSURE_OF_LINES = 0.02
"""Relative: the cells of both have other lengths, so the last one more than three half widths away is another."""


def variants(name: str, shape: ReliefShape, mounting: Mounting, count: int = 5) -> FlankVariants:
    model = coarse_model(name)
    given = FlankModification(root_relief=6, root_relief_length=1.0, profile_crowning=3, twist=4, helix_angle_modification=5)
    pair = replace(model.pair, wheel=replace(model.pair.wheel, modification=given))
    roomy = replace(model.remade(with_amounts(pair, HIGH, shape), mounting), cells=18, known=KnownResponses())
    return FlankVariants(roomy, shape, count, TORQUES[name])


def drawn(count: int) -> np.ndarray:
    amounts = LOW + np.random.default_rng(7).random((count, len(LOW))) * (HIGH - LOW)
    amounts[0, [0, 2]] = 0.0
    return amounts


MOUNTINGS = (Mounting(), Mounting(misalignment=9.0, misalignment_across=60.0, wheel_pitch_error=4.0))


@pytest.mark.parametrize("shape", ReliefShape)
@pytest.mark.parametrize("name", (*PAIRS, "ring"))
@pytest.mark.parametrize("mounting", MOUNTINGS, ids=["as drawn", "deviations"])
def test_gaps_of_variants_are_those_of_the_pairs(name: str, shape: ReliefShape, mounting: Mounting) -> None:
    of = variants(name, shape, mounting)
    condition = Condition(of.torque, misalignment=-4.0, pitch_error=2.0)
    amounts = drawn(6)
    for given in of.positions[::2]:
        normal, radii = of.gaps(given, amounts, condition)
        for number, each in enumerate(amounts):
            pair = with_amounts(of.roomy.pair, each, shape)
            expected = gaps(given.lines, pair, condition.mounted(mounting), of.roomy.helix)
            np.testing.assert_allclose(normal[number], expected.normal, rtol=0, atol=1e-12)
            np.testing.assert_allclose(radii[number], expected.radii, rtol=1e-9)


@pytest.mark.parametrize("given", [0.5, 0.0])
def test_a_given_transition_is_kept_as_far_as_it_fits(given: float) -> None:
    of = variants(next(iter(PAIRS)), ReliefShape.LINEAR, MOUNTINGS[0])
    gears = [replace(gear, modification=FlankModification(tip_relief_transition=given)) for gear in of.roomy.pair.gears]
    of = replace(of, roomy=replace(of.roomy, pair=replace(of.roomy.pair, pinion=gears[0], wheel=gears[1])))
    amounts = np.array([[20.0, 1.5, 30.0, 0.1, 0.0, 0.0], [20.0, 1.5, 0.0, 0.0, 0.0, 0.0]])
    pair = with_amounts(of.roomy.pair, amounts[0], ReliefShape.LINEAR)
    used = [gear.flank_form.transitions["tip_relief"].length for gear in pair.gears]
    assert used == pytest.approx([given, min(given, 0.2)])
    assert with_amounts(of.roomy.pair, amounts[0], ReliefShape.PARABOLIC).pinion.modification.tip_relief_transition is None
    given_gaps, _ = of.gaps(of.positions[0], amounts, Condition(of.torque))
    expected = gaps(of.positions[0].lines, pair, of.roomy.mounting, of.roomy.helix)
    np.testing.assert_allclose(given_gaps[0], expected.normal, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", (*PAIRS, "ring"))
def test_outcomes_are_those_of_the_contact_solved_in_full(name: str) -> None:
    of = variants(name, ReliefShape.PARABOLIC, MOUNTINGS[1])
    amounts, condition = drawn(5), Condition(0.8 * of.torque, misalignment=5.0)
    found = of.outcomes(amounts, condition)
    force = of.force(condition.torque)
    assert force == pytest.approx(0.8 * of.torque * 1000 / of.roomy.base_radius / math.cos(of.roomy.helix))
    for number, each in enumerate(amounts):
        pair = with_amounts(of.roomy.pair, each, of.shape)
        solved = [
            solve_lines(given, gaps(given.lines, pair, condition.mounted(MOUNTINGS[1]), of.roomy.helix), force)
            for given in of.positions
        ]
        errors = [1000 * each.approach / math.cos(of.roomy.helix) for each in solved]
        np.testing.assert_allclose(found.transmission_errors[number], errors, rtol=TRANSMISSION_ERROR)
        assert found.peak_to_peak[number] == pytest.approx(np.ptp(errors), abs=TRANSMISSION_ERROR * max(errors))
        assert found.pressures[number] == pytest.approx(max(interior_pressure(of, pair, each) for each in solved), rel=PRESSURE)
        assert found.edge_shares[number] == pytest.approx(max(map(edge_share, solved)), abs=PRESSURE)


def interior_pressure(of: FlankVariants, pair: GearPair, solution: LineSolution) -> float:
    """Return the greatest pressure (MPa) away from edges and, by plain half widths, from starts of reliefs."""
    lines, width, action = solution.given.lines, of.roomy.width, of.roomy.remade(pair, of.roomy.mounting).line
    to_edge = np.concatenate([np.minimum(line.edge_distance, width / 2 - abs(line.across)) for line in lines])
    to_start = np.concatenate([np.minimum(*start_distances(line, action)) for line in lines])
    curvature = np.concatenate([line.curvature for line in lines])
    widths = plain_widths(solution.given, curvature, of.roomy.helix, solution.forces)
    margins = np.minimum(to_edge - 3 * solution.half_widths, to_start - 3 * widths)
    greatest = float(solution.pressures[margins > 0].max(initial=0.0))
    parts = (solution.given.split(each) for each in (margins, solution.pressures, solution.forces))
    for margin, pressure, force in zip(*parts, strict=True):  # between cells, where the margin ends
        for here in np.flatnonzero((np.diff(margin > 0)) & (force[1:] > 0) & (force[:-1] > 0)):
            pair_of = slice(here, here + 2)
            order = np.argsort(margin[pair_of])
            greatest = max(greatest, float(np.interp(0.0, margin[pair_of][order], pressure[pair_of][order])))
    return greatest


def edge_share(solution: LineSolution) -> float:
    on_edge = np.concatenate([line.on_edge for line in solution.given.lines])
    return float(solution.forces[on_edge].sum() / solution.forces.sum())


@pytest.mark.parametrize("name", PAIRS)
def test_pressure_beside_the_start_of_a_linear_relief_is_left_out_as_in_the_check(name: str) -> None:
    of = variants(name, ReliefShape.LINEAR, Mounting(), 12)
    # Crowned: of coarse cells at the ends of the face the check tells what lies between them too.
    amounts = np.array([[40.0, 5.0, 40.0, 5.0, 6.0, 0.0], [25.0, 3.0, 0.0, 4.0, 5.0, 0.0]])
    found = of.outcomes(amounts, Condition(of.torque))
    for number, each in enumerate(amounts):
        modified = of.roomy.remade(with_amounts(of.roomy.pair, each, of.shape), Mounting())
        cycle = SolidCycle.run(modified, of.torque, 12)
        checked = [
            max((contact.peak_pressure for contact in position.interior_contacts), default=0.0) for position in cycle.positions
        ]
        assert max(checked) == pytest.approx(found.pressures[number], rel=PRESSURE_OF_LINES)


def test_a_variant_without_any_interior_pressure_keeps_to_no_bound() -> None:
    nothing, some = np.zeros((1, 3)), np.array([[0.0, 900.0, 0.0]])
    pressures = [Outcomes(np.ones((1, 3)), each, np.zeros((1, 3))).pressures[0] for each in (nothing, some)]
    assert pressures == [math.inf, 900.0]


def test_edges_of_tips_carry_load_until_relief_frees_them() -> None:
    of = variants("FZG C", ReliefShape.LINEAR, Mounting(), 24)
    amounts = np.array([[0.0, 4.0, 0.0, 4.0, 0.0, 0.0], [60.0, 4.0, 60.0, 4.0, 0.0, 0.0]])
    found = of.outcomes(amounts, Condition(TORQUES["FZG C"]))
    # Without relief the next tooth comes into contact early and takes the load of a pair in full contact: almost half.
    assert found.edge_shares[0] == pytest.approx(0.45, abs=0.1)
    assert found.edge_shares[1] == 0

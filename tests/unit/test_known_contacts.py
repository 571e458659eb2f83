"""Contacts solved before, where a linear relief starts, and of many variants at once."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.checks import PAIRS, TORQUES, coarse_model, small_check

from gearcad import FlankModification, Gear, Mounting
from gearcad.contact.modification_variants import Condition, FlankVariants, Outcomes, with_amounts
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import KnownContacts, PlanePair, solve_contact
from gearcad.contact.shared.line_of_action import TransverseFlank
from gearcad.contact.shared.local_contact import (
    GapCurve,
    onsets,
    press,
    rounded_kink_pressure,
    start_distance,
)
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.line_contact import LineSolution, gaps, plain_widths, solve_lines, start_distances
from gearcad.contact.solid.pair import KnownResponses
from gearcad.core.complementarity import _cell_by_cell, _positive, complementary
from gearcad.core.records import Floats
from gearcad.geometry import GearPair, ReliefShape
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


STEEL = 113187.0
"""Reduced modulus of two steel bodies (MPa)."""

PRINTED = 0.002
"""Relative: pressures by another program (a linear complementarity problem of 2,000 cells), rounded to a MPa."""

TABLE = [
    (300, 8, 0.01, 0.2, 1370),
    (300, 8, 0.01, 0.1, 1490),
    (300, 8, 0.01, 0.05, 1613),
    (300, 8, 0.01, 0.025, 1737),
    (300, 8, 0.02, 0.2, 1556),
    (300, 8, 0.02, 0.1, 1790),
    (300, 8, 0.02, 0.05, 2036),
    (300, 8, 0.02, 0.025, 2285),
    (300, 8, 0.036, 0.2, 1815),
    (300, 8, 0.036, 0.1, 2221),
    (300, 8, 0.036, 0.05, 2660),
    (300, 8, 0.036, 0.025, 3106),
    (500, 12, 0.02, 0.2, 1774),
    (500, 12, 0.02, 0.1, 2018),
    (500, 12, 0.02, 0.05, 2266),
    (500, 12, 0.02, 0.025, 2516),
    (300, 5, 0.03, 0.2, 1945),
    (300, 5, 0.03, 0.1, 2276),
    (300, 5, 0.03, 0.05, 2640),
    (300, 5, 0.03, 0.025, 3013),
]
"""Load (N/mm), reduced radius (mm), slope behind the kink, length of its rounding (mm), greatest pressure (MPa)."""


@pytest.mark.parametrize(("load", "radius", "slope", "length", "expected"), TABLE)
def test_greatest_pressure_over_a_rounded_kink(
    load: float, radius: float, slope: float, length: float, expected: float
) -> None:
    closed = rounded_kink_pressure(load, radius, slope, length, STEEL)
    assert closed == pytest.approx(expected, rel=PRINTED)
    nominal = np.linspace(-0.3, radius * slope + 0.3, 241)[:, None]
    loads, start = np.full(len(nominal), load), (np.zeros(len(nominal)), np.full(len(nominal), 0.2))
    found = press(lambda place: rounded(place, nominal, radius, slope, length), loads, STEEL, start, length)
    assert found.resolved.all()
    assert float(found.peaks.max()) == pytest.approx(closed, rel=1e-3)


def rounded(place: Floats, nominal: Floats, radius: float, slope: float, length: float) -> GapCurve:
    """Return the gap of a cylinder that would touch `nominal` behind a kink, which a parabola rounds."""
    past = np.clip(place + nominal + length / 2, 0, length)
    beyond = np.maximum(place + nominal - length / 2, 0)
    inside = (past > 0) & (past < length)
    return GapCurve(
        place**2 / (2 * radius) + slope * (past**2 / (2 * length) + beyond),
        place / radius + slope * past / length,
        1 / radius + slope / length * inside,
    )


def test_closed_forms_at_their_limits() -> None:
    """A wide rounding, a kink that is none (Hertz), and one as long as the contact, of which all is a smaller cylinder."""
    assert rounded_kink_pressure(300, 8, 0.036, 0.4, STEEL) == pytest.approx(1524.4, rel=1e-3)
    hertz = math.sqrt(300 * STEEL / (math.pi * 8))
    assert rounded_kink_pressure(300, 8, 1e-9, 0.1, STEEL) == pytest.approx(hertz, rel=1e-4)
    within = math.sqrt(300 * STEEL / math.pi * (1 / 8 + 0.036 / 0.6))
    assert rounded_kink_pressure(300, 8, 0.036, 0.6, STEEL) == pytest.approx(within, rel=1e-4)


def test_a_short_rounding_adds_as_much_with_each_halving() -> None:
    """12,500 D MPa in steel: the logarithm of a sharp kink, E* D ln 2/(2 pi)."""
    short, half = (rounded_kink_pressure(300, 8, 0.02, length, STEEL) for length in (0.02, 0.01))
    assert half - short == pytest.approx(STEEL * 0.02 * math.log(2) / (2 * math.pi), rel=0.01)


def test_a_contact_away_from_the_kink_is_that_of_a_cylinder() -> None:
    """Hertz's half width, pressure and own distance, and the place: R D back from where the exact cylinder would touch."""
    nominal = np.array([[-1.0], [1.0]])
    found = press(
        lambda place: rounded(place, nominal, 8.0, 0.036, 0.1), np.full(2, 300.0), STEEL, (np.zeros(2), np.full(2, 0.2)), 0.1
    )
    half = math.sqrt(4 * 300 * 8 / (math.pi * STEEL))
    assert found.half_widths == pytest.approx(half, rel=1e-9)
    assert found.peaks == pytest.approx(2 * 300 / (math.pi * half), rel=1e-6)
    assert found.own == pytest.approx(math.exp(-0.5) / 2 * half, rel=1e-6)
    assert found.middle == pytest.approx([0.0, -8 * 0.036], abs=1e-9)
    assert found.least == pytest.approx([0.0, 0.036 * 1.0 - 8 * 0.036**2 / 2], abs=1e-9)


@pytest.mark.parametrize("load", [1e-3, 0.1, 10.0, 300.0])
def test_small_loads_press_where_the_gap_is_least(load: float) -> None:
    """A pair of teeth that comes in beside a relief: Hertz's width, R D away from where Newton's steps would begin."""
    nominal, half = np.full((3, 1), 1.0), math.sqrt(4 * load * 8 / (math.pi * STEEL))
    start = np.zeros(3), half * np.array([1 / 8, 1.0, 8.0])
    found = press(lambda place: rounded(place, nominal, 8.0, 0.036, 0.1), np.full(3, load), STEEL, start, 0.1)
    assert found.settled.all()
    assert found.half_widths == pytest.approx(half, rel=1e-6)
    assert found.least == pytest.approx(0.036 - 8 * 0.036**2 / 2, abs=1e-9)


def test_a_transition_too_short_for_the_places_is_not_resolved() -> None:
    nominal = np.array([[0.1]])
    found = press(
        lambda place: rounded(place, nominal, 8.0, 0.036, 1e-5), np.array([300.0]), STEEL, (np.zeros(1), np.ones(1)), 1e-5
    )
    assert not found.resolved.any()


@pytest.mark.parametrize(("relief", "sense"), [("tip_relief", 1), ("root_relief", -1)])
def test_contacts_beside_a_start(relief: str, sense: int) -> None:
    """Slope and length along the tangent, by r_b/rho; from half a transition before the onset to R D and half behind it."""
    gear = Gear(teeth=23, normal_module=2.5, face_width=16.0, profile_shift=0.2)
    amounts = {relief: 18.0, f"{relief}_length": 2.0, f"{relief}_transition": 0.3}
    form = replace(gear, modification=FlankModification(**amounts)).flank_form  # type: ignore[arg-type]
    (onset,) = onsets(TransverseFlank(form, 8.0))
    assert onset.roll == pytest.approx(form.last - 2.0 if sense > 0 else form.first + 2.0)
    stretch = form.base_radius / onset.roll
    assert onset[1:] == pytest.approx((0.3 / stretch, 0.009 * stretch, sense))
    along = np.array([-0.5, 0.1, 0.5])  # mm along the tangent towards the relief
    lengths = np.sqrt(onset.roll**2 + 2 * form.base_radius * sense * along)
    shift, half = 8 * onset.slope, onset.length / 2
    expected = [0.5 - half, max(-0.1, 0.1 - shift) - half, 0.5 - shift - half]
    assert start_distance(form.base_radius, onset, lengths, 8.0) == pytest.approx(expected, abs=1e-9)


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

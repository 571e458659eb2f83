"""Single teeth as springs, at rest, and what is drawn of their errors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad import Load
from gearcad.core.records import PerGear
from gearcad.core.runtime import templates
from gearcad.designs import read_spec
from gearcad.dynamics.tooth_errors.error_result import quantile_ranks
from gearcad.dynamics.tooth_errors.error_sources import ErrorDraw, MeshTeeth, mesh_teeth, with_short_period
from gearcad.dynamics.tooth_errors.tooth_springs import (
    PairErrors,
    ToothSpring,
    at_rest,
    cycle_spring,
    even_spring,
    pair_path,
    standard_path,
)
from gearcad.dynamics.trains.members import ToothMesh
from gearcad.dynamics.trains.tooth_deviations import ErrorDistribution, random_deviations
from gearcad.rating.tolerances import flank_tolerances
from gearcad.stiffness.methods import METHODS

TURNS = np.arange(2000) / 2000
RATIO, MEAN = 1.6, 705.0


def spring() -> ToothSpring:
    """The teeth that are assumed of Osinski's train, gaps up to half a millimetre."""
    return even_spring(standard_path(PerGear(50.7, 135.3), 18, RATIO), RATIO, MEAN, 500.0, 0.0)


def teeth(distribution: str = "uniform", grade: int = 9) -> MeshTeeth:
    tolerances = PerGear(*(flank_tolerances(grade, d, 6.0) for d in (108.0, 288.0)))
    return MeshTeeth(name="mesh", number=0, teeth=PerGear(18, 48), contact_ratio=RATIO, tolerances=tolerances)


# ---------------------------------------------------------------------- at rest


def test_rigid_teeth_make_a_square_wave() -> None:
    rest = at_rest(spring(), 1e-2, TURNS)
    stiffness = 1e-2 / rest.approach / 1e6
    each = MEAN / RATIO
    assert np.unique(stiffness.round(3)).tolist() == pytest.approx([each, 2 * each], abs=2e-3)
    assert rest.contact_ratio == pytest.approx(RATIO, abs=2e-3)
    assert rest.stiffness == pytest.approx(1e6 * MEAN, rel=1e-3)


@pytest.mark.parametrize("force", [1.0, 1e3, 44497.0, 3e5])
@pytest.mark.parametrize("size", [0.0, 1.0])
def test_forces_of_all_pairs_are_the_load(force: float, size: float) -> None:
    errors = teeth().pair_errors(ErrorDraw(ErrorDistribution.UNIFORM, 3, 1)).times(size)
    rest = at_rest(spring(), force, 144 * TURNS, errors)
    assert rest.forces.sum(axis=1) == pytest.approx(force, rel=1e-9)
    assert rest.forces.min() >= 0


def test_the_harder_the_load_the_more_teeth_carry() -> None:
    ratios = [at_rest(spring(), force, TURNS).contact_ratio for force in (1.0, 1e3, 1e4, 4.4e4, 2e5)]
    assert np.diff(ratios).min() > 0.01
    assert ratios[0] == pytest.approx(RATIO, abs=5e-3)


def test_the_approach_is_that_of_a_search_in_steps() -> None:
    """Force over approach, pair by pair, interpolated to the load: no order of gaps, no straight pieces."""
    of, errors = spring(), teeth().pair_errors(ErrorDraw(ErrorDistribution.UNIFORM, 0, 0))
    turn, force = 31.37, 2e4
    approach = np.linspace(-2e-4, 5e-4, 700_001)
    carried = np.zeros_like(approach)
    for tooth in range(28, 35):
        place = turn + of.lead - tooth
        if of.first <= place <= of.last:
            gap = np.interp(place, of.places, of.gap) + errors.position[tooth] + errors.slope[tooth] * place
            carried += np.interp(place, of.places, of.stiffness) * np.maximum(approach - gap, 0)
    found = at_rest(of, force, np.array([turn]), errors).approach[0]
    assert found == pytest.approx(np.interp(force, carried, approach), abs=1e-10)


def test_assumed_teeth_have_the_mean_stiffness_that_is_given_under_their_load() -> None:
    mesh = ToothMesh(name="m", pinion="a", wheel="b", base_radii=(50.7, 135.3), stiffness=MEAN, teeth=18)
    made = mesh_teeth(mesh, 0, 44497.0, None, single=True).spring
    assert made is not None
    rest = at_rest(made, 44497.0, TURNS)
    assert rest.stiffness == pytest.approx(1e6 * MEAN, rel=2e-3)
    assert rest.contact_ratio > 1.8


@pytest.mark.parametrize("method", ["potential-energy", "iso6336-b"])
def test_single_pairs_of_a_cycle_carry_as_the_cycle_does_where_none_is_early(method: str) -> None:
    """Under next to no load premature engagement has no part in it: mean stiffness and contact ratio are those of the cycle."""
    design = read_spec(templates() / "fzg-c.toml")
    name = method if method in METHODS else next(each for each, of in METHODS.items() if of.mean_only)
    cycle = METHODS[name](pair=design.pair)(Load(torque=302.0))
    path = pair_path(design.pair)
    rest = at_rest(cycle_spring(path, cycle, 200.0, helical=False), 1e-3, TURNS)
    assert rest.stiffness / 1e6 == pytest.approx(cycle.tangent_mean, rel=5e-3)
    assert rest.contact_ratio == pytest.approx(path.contact_ratio, abs=2e-3)


@pytest.mark.long
@pytest.mark.parametrize(("torque", "ratio"), [(302.0, 0.03), (60.0, 0.02)])
def test_teeth_meet_as_early_as_finite_elements_say(torque: float, ratio: float) -> None:
    """Teeth in contact on the mean, FZG C: 1.583 and 1.508 by finite elements at 120 positions, without load 1.438.

    The elements bend neighbouring teeth as well, springs side by side do not.
    """
    design = read_spec(templates() / "fzg-c.toml")
    cycle = METHODS["plane-strain"](pair=design.pair, material=design.material)(Load(torque=torque))
    by_elements = (cycle.load_share[:-1] > 0).sum(axis=1).mean()
    path = pair_path(design.pair)
    rest = at_rest(cycle_spring(path, cycle, 200.0, helical=False), cycle.force, TURNS)
    assert rest.contact_ratio == pytest.approx(by_elements, abs=ratio)
    assert rest.contact_ratio > path.contact_ratio + 0.05
    assert 1e6 * rest.approach.mean() == pytest.approx(cycle.mean_of(cycle.transmission_error), rel=0.06)


def test_teeth_that_go_backwards_are_the_same_from_behind() -> None:
    of = spring()
    ahead, back = at_rest(of, 3e4, TURNS), at_rest(of.backwards, 3e4, -TURNS)
    assert back.approach == pytest.approx(ahead.approach, rel=1e-12)


# ---------------------------------------------------------------------- draws


def test_sample_0_has_the_pinion_of_a_chart() -> None:
    tolerances = flank_tolerances(9, 108.0, 6.0)
    alone = replace(teeth(), wheel_drawn=False).pair_errors(ErrorDraw(ErrorDistribution.UNIFORM, 5, 0))
    one = random_deviations(18, tolerances, 5)
    assert alone.position == pytest.approx(1e-6 * one.position, rel=1e-15)
    assert alone.slope == pytest.approx(1e-6 / RATIO * one.slope, rel=1e-15)


def test_both_gears_have_errors_that_come_again_when_the_same_teeth_meet() -> None:
    of, draw = teeth(), ErrorDraw(ErrorDistribution.UNIFORM, 0, 7)
    whole = of.pair_errors(draw).position
    pinion = replace(of, wheel_drawn=False).pair_errors(draw).position
    wheel = whole - np.resize(pinion, 144)
    assert len(whole) == 144
    assert wheel == pytest.approx(np.resize(wheel[:48], 144), abs=1e-18)
    assert 1e6 * np.ptp(wheel) <= of.tolerances.wheel.cumulative_pitch + 1e-9  # type: ignore[union-attr]
    assert abs(pinion.sum()) < 1e-18 * 1e6


@pytest.mark.parametrize("grade", [0, 5, 12])
def test_normal_errors_keep_their_tolerance_and_are_smaller_than_even_ones(grade: int) -> None:
    """A tolerance of three standard deviations against one over the root of three of it: 0.577 to 0.333, but for the cut."""
    tolerances = flank_tolerances(grade, 108.0, 6.0)
    slopes = {
        kind: random_deviations(20_000, tolerances, 1, distribution=kind).slope / tolerances.profile_slope
        for kind in ErrorDistribution
    }
    assert max(np.abs(each).max() for each in slopes.values()) <= 1
    assert slopes[ErrorDistribution.UNIFORM].std() == pytest.approx(1 / math.sqrt(3), rel=0.02)
    # Cut at three standard deviations a normal distribution has 0.9866 of its own.
    assert slopes[ErrorDistribution.NORMAL].std() == pytest.approx(0.9866 / 3, rel=0.02)


def test_gears_of_other_numbers_are_others() -> None:
    of = teeth()
    found = [of.pair_errors(ErrorDraw(ErrorDistribution.UNIFORM, 0, number)).position for number in range(30)]
    assert np.abs(np.corrcoef(found) - np.eye(30)).max() < 0.75
    assert not np.allclose(found[0], of.pair_errors(ErrorDraw(ErrorDistribution.UNIFORM, 1, 0)).position)


def test_wheels_whose_teeth_hardly_ever_meet_the_same_have_no_errors() -> None:
    from fractions import Fraction

    tolerances = teeth().tolerances
    hunting = MeshTeeth(name="h", number=0, teeth=PerGear(17, 83), contact_ratio=RATIO, tolerances=tolerances)
    (kept,) = with_short_period([hunting], [Fraction(1)])
    assert (kept.wheel_drawn, kept.period) == (False, 17)
    (both,) = with_short_period([teeth()], [Fraction(1)])
    assert (both.wheel_drawn, both.period) == (True, 144)


def test_one_tooth_has_no_neighbour_to_be_out_of_place_to() -> None:
    worm = replace(teeth(), teeth=PerGear(1, 48), wheel_drawn=False)
    assert not worm.pair_errors(ErrorDraw(ErrorDistribution.UNIFORM, 0, 0)).position.any()


def test_no_errors_are_no_gaps() -> None:
    assert at_rest(spring(), 1e4, TURNS, PairErrors()).approach == pytest.approx(at_rest(spring(), 1e4, TURNS).approach)


# ---------------------------------------------------------------------- quantiles


@pytest.mark.parametrize(("count", "quantile"), [(100, 0.95), (100, 0.5), (59, 0.95), (1000, 0.95)])
def test_ranks_of_a_quantile_hold_it_nine_times_of_ten(count: int, quantile: float) -> None:
    """The number of values below the quantile is binomial: summed term by term."""
    low, high = quantile_ranks(count, quantile)
    assert low is not None and high is not None
    below = [math.comb(count, k) * quantile**k * (1 - quantile) ** (count - k) for k in range(count + 1)]
    assert sum(below[low:high]) >= 0.9
    assert sum(below[:low]) <= 0.05 and sum(below[high:]) <= 0.05
    # One rank further in on either side would not do.
    assert sum(below[: low + 1]) > 0.05 and sum(below[high - 1 :]) > 0.05


def test_few_samples_do_not_bound_a_high_quantile() -> None:
    assert quantile_ranks(58, 0.95).high is None
    assert quantile_ranks(1, 0.95) == (None, None) or quantile_ranks(1, 0.95).high is None

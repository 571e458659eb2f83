"""The pair on bearings, and single teeth as springs: modal structure, limits with closed forms, errors that are drawn."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad import Load
from gearcad.core.records import PerGear
from gearcad.core.runtime import templates
from gearcad.designs import read_spec
from gearcad.dynamics.options import DynamicsOptions
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
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings
from gearcad.dynamics.trains.tooth_deviations import ErrorDistribution, random_deviations
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.rating.tolerances import flank_tolerances
from gearcad.stiffness.methods import METHODS

PAIR = PairOnBearings(
    masses=(0.8, 3.1),
    inertias=(4e-4, 7e-3),
    base_radii=(28.0, 66.0),
    working_transverse_pressure_angle=21.5,
    mesh_stiffness=240.0,
    bearing_stiffness=((300.0, 300.0), (450.0, 450.0)),
    torque=80.0,
)


def _hz(stiffness: float, mass: float) -> float:
    return math.sqrt(1e6 * stiffness / mass) / (2 * math.pi)


def _along_the_line_of_action(pair: PairOnBearings) -> np.ndarray:
    """Frequencies (Hz) of the chain bearing - pinion - mesh - wheel - bearing with the gears' turning in it."""
    r1, r2 = (radius / 1000 for radius in pair.base_radii)
    turning = 1 / (r1**2 / pair.inertias[0] + r2**2 / pair.inertias[1])
    masses = np.array([*pair.masses, turning])
    direction = np.array([1.0, -1.0, 1.0])
    springs = np.diag([pair.bearing_stiffness[0][0], pair.bearing_stiffness[1][0], 0.0])
    stiffness = 1e6 * (springs + pair.mesh_stiffness * np.outer(direction, direction))
    root = np.sqrt(masses)
    return np.sqrt(np.linalg.eigvalsh(stiffness / np.outer(root, root))) / (2 * math.pi)


def test_modal_structure_on_isotropic_bearings() -> None:
    """One free turn, one mode of each gear square to the line of action on its bearing alone, and three along the line."""
    across = [_hz(300, 0.8), _hz(450, 3.1)]
    expected = sorted([0.0, *across, *_along_the_line_of_action(PAIR)])
    assert PAIR.frequencies() == pytest.approx(expected, rel=1e-9, abs=1e-3)


def test_modes_square_to_the_line_of_action_leave_the_mesh_alone() -> None:
    system = PAIR.system()
    _, modes = np.linalg.eigh(system.stiffness_matrix())
    approach = np.abs(system.mesh[:, 0] @ modes)
    assert (approach < 1e-9 * approach.max()).sum() == 3  # with the free turn


def test_angle_does_not_matter_on_isotropic_bearings_and_does_on_others() -> None:
    turned = replace(PAIR, working_transverse_pressure_angle=0.0)
    assert turned.frequencies() == pytest.approx(PAIR.frequencies(), rel=1e-9, abs=1e-3)
    soft = replace(PAIR, bearing_stiffness=((300.0, 30.0), (450.0, 45.0)))
    other = replace(soft, working_transverse_pressure_angle=0.0)
    assert max(abs(a - b) for a, b in zip(soft.frequencies(), other.frequencies(), strict=True)) > 1


def test_stiff_bearings_leave_the_torsional_pair() -> None:
    stiff = replace(PAIR, bearing_stiffness=((1e9, 1e9), (1e9, 1e9)))
    r1, r2 = 0.028, 0.066
    isolated = math.sqrt(240e6 * (r1**2 / 4e-4 + r2**2 / 7e-3)) / (2 * math.pi)
    assert stiff.frequencies()[1] == pytest.approx(isolated, rel=1e-6)


def test_modes_across_the_line_of_action_are_each_gear_s_own() -> None:
    """omega = sqrt(k/m), all of it in one bearing: teeth do not shake them."""
    modes = PAIR.modes()
    assert modes.frequency == pytest.approx(PAIR.frequencies(), rel=1e-9, abs=1e-3)
    for words, (stiffness, mass) in {"pinion": (300, 0.8), "wheel": (450, 3.1)}.items():
        mode = modes.words.index(f"{words} travels across the line of action")
        assert modes.circular[mode] == pytest.approx(math.sqrt(1e6 * stiffness / mass), rel=1e-12)
        assert not modes.shaken[mode] and modes.potential[mode].tolist() == [0.0, *np.eye(2)[int(words == "wheel")]]
    assert modes.shaken.sum() == 3
    assert modes.kinetic.sum(axis=1) == pytest.approx(np.ones(6)) and modes.potential[1:].sum(axis=1) == pytest.approx(
        np.ones(5)
    )


def test_modes_of_two_alike_gears() -> None:
    """Together along the line of action the mesh does nothing; against each other half of the pair is a chain of two masses."""
    m, j, r, k, kb = 1.0, 5e-4, 0.03, 3e8, 2e8
    alike = replace(
        PAIR,
        masses=(m, m),
        inertias=(j, j),
        base_radii=(30.0, 30.0),
        mesh_stiffness=300.0,
        bearing_stiffness=((200.0,) * 2,) * 2,
    )
    modes = alike.modes()
    alone, words = math.sqrt(kb / m), list(modes.words)
    together = words.index("both gears travel together, along the line of action")
    assert modes.circular[2:5] == pytest.approx([alone] * 3, rel=1e-9) and together in (2, 3, 4)
    assert sorted(words[2:5]) == sorted(
        ["pinion travels across the line of action", "wheel travels across the line of action", words[together]]
    )
    assert not modes.shaken[[0, 2, 3, 4]].any()
    # y = 2 (u + s), s = r phi: m u'' + kb u + k y = 0, j/r^2 s'' + k y = 0.
    chain = np.array([[(kb + 2 * k) / m, 2 * k / m], [2 * k * r**2 / j, 2 * k * r**2 / j]])
    squares, shapes = np.linalg.eig(chain)
    order = np.argsort(squares)
    assert modes.circular[[1, 5]] == pytest.approx(np.sqrt(squares[order]), rel=1e-9)
    assert [words[1], words[5]] == [
        "both gears travel against each other, along the line of action",
        "gears turn against each other",
    ]
    for mode, (u, s) in zip((1, 5), shapes.T[order], strict=True):
        assert modes.potential[mode, 0] == pytest.approx(
            4 * k * (u + s) ** 2 / (4 * k * (u + s) ** 2 + 2 * kb * u**2), rel=1e-9
        )


@pytest.mark.parametrize("stiffness", [1e9, 1e-6])
def test_modes_at_the_limits(stiffness: float) -> None:
    """Rigid bearings leave the torsional mode; none leave two bodies that float."""
    modes = replace(PAIR, bearing_stiffness=((stiffness,) * 2,) * 2).modes()
    r1, r2 = 0.028, 0.066
    compliance = r1**2 / 4e-4 + r2**2 / 7e-3 + (0 if stiffness > 1 else 1 / 0.8 + 1 / 3.1)
    (mode,) = np.flatnonzero(modes.potential[:, 0] > 0.5)
    assert modes.circular[mode] == pytest.approx(math.sqrt(240e6 * compliance), rel=1e-6)
    assert modes.words[mode] == "gears turn against each other" and modes.potential[mode, 0] == pytest.approx(1.0, abs=1e-6)
    assert mode == (1 if stiffness > 1 else 5)


def test_static_deflection() -> None:
    """Bearings carry the normal force, and the mesh is pressed by it."""
    system = PAIR.system()
    moved = np.linalg.lstsq(system.stiffness_matrix(), system.load, rcond=1e-12)[0]
    force = 80.0 / 0.028
    assert system.stiffness[0] * (system.mesh[:, 0] @ moved) == pytest.approx(force, rel=1e-9)
    pinion, wheel = moved[:2] / math.sqrt(0.8), moved[3:5] / math.sqrt(3.1)
    assert 300e6 * np.hypot(*pinion) == pytest.approx(force, rel=1e-9)
    assert 450e6 * np.hypot(*wheel) == pytest.approx(force, rel=1e-9)
    assert wheel[0] > 0 > pinion[0]  # pushed apart


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("masses", (0.0, 1.0), "masses = 0 kg: must be a number above 0"),
        ("mesh_stiffness", -5.0, "mesh_stiffness = -5 N/µm: must be a number above 0"),
        ("bearing_stiffness", ((1.0, 0.0), (1.0, 1.0)), "bearing_stiffness = 0 N/µm: must be a number above 0"),
    ],
)
def test_unphysical(field: str, value: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(PAIR, **{field: value})


def test_a_chart_reaches_the_highest_mode_that_teeth_shake() -> None:
    """A heavy rotor on the pinion's shaft leaves the turning slow: what travels is met far beyond."""
    pair = replace(PAIR, inertias=PerGear(0.1, 7e-3))
    train = Train(
        model=TrainModel.ISOLATED,
        inertias=(Inertia(name="pinion", inertia=0.1), Inertia(name="wheel", inertia=7e-3)),
        meshes=(
            ToothMesh(
                name="mesh", pinion="pinion", wheel="wheel", base_radii=PerGear(28.0, 66.0), stiffness=240.0, teeth=20,
                damping_ratio=0.05, variation=0.1,
            ),
        ),
        torques={"pinion": 80.0, "wheel": 80.0 * 66 / 28},
    )  # fmt: skip
    study = study_train(train, DynamicsOptions(speeds=20), bearings=replace(pair, mesh_damping=500.0, bearing_damping=100.0))
    assert study.on_bearings is not None
    highest = 60 * study.on_bearings.frequency[study.on_bearings.potential[:, 0] > 0.02].max() / 20
    assert study.modes.rpm.max() * 1.5 < highest and study.speeds.max() == pytest.approx(1.5 * highest)
    assert {each.met.mode for each in study.resonances if each.met} <= set(np.flatnonzero(study.on_bearings.shaken) + 1)
    assert [each.name for each in study.greatest_amplitudes] == ["pinion", "wheel", "mesh", "pinion", "wheel"]
    json.dumps(study.to_dict(), allow_nan=False)


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

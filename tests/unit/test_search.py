"""The search for modifications, on FZG C gears: what it finds, against what is known of good tip relief."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from support.checks import PAIRS, TORQUES, coarse_model, coarse_pair
from threadpoolctl import threadpool_limits

from gearcad import Mounting
from gearcad.check.summary import PRESSURE
from gearcad.contact.load_range import LoadRange, ModifyOptions, Statistic
from gearcad.contact.modification_search import FoundModification, Search, _Sampling, start_search
from gearcad.contact.modification_variants import AMOUNTS, Condition, with_amounts
from gearcad.contact.shared.line_of_action import loaded_left
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.errors import ParameterError
from gearcad.geometry import ReliefShape
from gearcad.jobs.modify import _best, _modified, _polished, _tried, unmirrored

TORQUE = TORQUES["FZG C"]

_GENEROUS = 1.3
"""Of the pressure of plain flanks: so much that the pressure does not decide."""


_TIGHT = 1.02
"""So little that it does."""

BETWEEN = 0.3
"""µm of the peak to peak, of 15 without relief, that peaks between the positions of the search hide."""

EDGE = 0.003
"""Share of the load that edges of tips may carry between those positions; without relief it is 0.45."""

BEST = 1.02
"""Of the objective: nothing near a proposal is lower by more."""


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.contact.modification_search._GENERATIONS", 3)
    monkeypatch.setattr("gearcad.contact.modification_search._STARTS", 1)


@pytest.fixture(scope="module")
def fine() -> Search:
    """At as many positions as the command takes."""
    with threadpool_limits(1):
        return start_search(coarse_model("FZG C"), TORQUE, ReliefShape.LINEAR)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.contact.modification_search._SPUR", _Sampling(8, 12, 3))


@pytest.fixture(scope="module")
def search() -> Search:
    """At few positions: enough to tell how it searches."""
    with threadpool_limits(1), pytest.MonkeyPatch.context() as patch:
        patch.setattr("gearcad.contact.modification_search._SPUR", _Sampling(8, 12, 3))
        return start_search(coarse_model("FZG C"), TORQUE, ReliefShape.LINEAR)


def best(search: Search, share: float) -> FoundModification:
    with threadpool_limits(1):
        return search.best([share * float(search.plain.pressures[0])])


def run(search: Search, bound: float, *, edges: bool = True) -> FoundModification:
    """One bound (MPa) and nothing else; `edges` tells whether those of tips may carry load."""
    return search._settled(bound, search._survey(bound), edges=edges)


@pytest.mark.long
def test_tip_relief_halves_the_transmission_error_as_the_rules_of_the_field_say(fine: Search) -> None:
    found = best(fine, _GENEROUS)
    model = coarse_model("FZG C")
    proposed = model.remade(with_amounts(model.pair, found.amounts, ReliefShape.LINEAR), Mounting())
    before, after = SolidCycle.run(model, TORQUE, 24), SolidCycle.run(proposed, TORQUE, 96)
    errors = [float(np.ptp(cycle.values("transmission_error"))) for cycle in (before, after)]
    # Solved in full on finer lines, at twice as many positions, it is what the search saw, and far less than before.
    assert errors[1] == pytest.approx(found.peak_to_peak, abs=BETWEEN)
    assert after.worst_contact[1].peak_pressure == pytest.approx(found.outcome.pressures[0], rel=0.015)
    assert errors[1] < 0.4 * errors[0]
    assert found.bounded
    assert found.edges_free
    shares = [
        contact.forces[contact.line.on_edge].sum() / sum(each.force for each in position.contacts)
        for position in after.positions
        for contact in position.contacts
    ]
    assert max(shares) < EDGE
    # Relief at the tip about equals what one pair of teeth gives way under the load; long relief begins where a second pair
    # takes over, (eps_alpha - 1) p_b below the tip, short relief after half of that (Niemann/Winter, vol. 2; Houser).
    path = model.pair.path_of_contact
    longest = path.E - path.A - model.line.pitch
    named = dict(zip(AMOUNTS, found.amounts.tolist(), strict=True))
    for owner in ("pinion", "wheel"):
        assert 0.8 * fine.deflection < named[f"{owner}.tip_relief"] < 1.3 * fine.deflection
        assert 0.5 * longest < named[f"{owner}.tip_relief_length"] < longest
    assert named["pinion.helix_angle_modification"] == 0


def grid(found: FoundModification, search: Search, reach: int) -> np.ndarray:
    """All amounts (v, 6) up to so many steps of 1 µm and 0.05 mm from those found, jointly; of the crowning one."""
    around = np.arange(-reach, reach + 1)
    steps = np.array(list(itertools.product(around, around, around, around, (0, 1) if reach < 3 else (-1, 0, 1), (0,))))
    amounts = found.amounts + steps * [1.0, 0.05, 1.0, 0.05, 1.0, 1.0]
    return amounts[((amounts >= search.low - 1e-9) & (amounts <= search.high + 1e-9)).all(axis=1)]


def least(search: Search, bound: float, amounts: np.ndarray) -> float:
    with threadpool_limits(1):
        return float(search.scores(search.outcomes(amounts), bound, edges=True).min())


def test_no_variant_of_a_fine_grid_around_a_proposal_is_better(search: Search) -> None:
    # The pressure is what stops the search: its bound and the kinks of the transmission error make a narrow, crooked valley.
    bound = _TIGHT * float(search.plain.pressures[0])
    with threadpool_limits(1):
        found = run(search, bound)
    proposal = least(search, bound, found.amounts[None])
    assert proposal < BEST * least(search, bound, grid(found, search, 1))


@pytest.mark.long
@pytest.mark.parametrize("shape", ReliefShape)
@pytest.mark.parametrize("name", [*PAIRS, "Alm"])
def test_no_variant_is_better_by_exhaustive_search(name: str, shape: ReliefShape, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    with threadpool_limits(1):
        search = start_search(coarse_model(name), TORQUES[name], shape)
        for share in (1.05, 1.2):
            bound = share * float(search.plain.pressures[0])
            found = run(search, bound)
            proposal = least(search, bound, found.amounts[None])
            every = grid(found, search, 3)
            assert proposal < BEST * min(least(search, bound, part) for part in np.array_split(every, 10))
            drawn = np.random.default_rng(1).random((10_000, 6))
            assert proposal < least(search, bound, search.low + drawn * (search.high - search.low))


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "shape"), [("FZG C", ReliefShape.LINEAR), ("FZG C", ReliefShape.PARABOLIC), ("helical", ReliefShape.LINEAR)]
)
def test_no_neighbour_of_a_checked_proposal_is_better(name: str, shape: ReliefShape, monkeypatch: pytest.MonkeyPatch) -> None:
    """The bound is kept by a check's pressure; neighbours are judged at 240 positions, between which nothing is missed."""
    monkeypatch.undo()
    model, torque = coarse_model(name), TORQUES[name]
    with threadpool_limits(1):
        plain = _modified(model, np.zeros(len(AMOUNTS)), shape, torque, 24).extreme(PRESSURE)
        assert plain is not None
        bounds = [1.05 * plain.value]
        best = _polished(model, _best(_tried(model, torque, shape, bounds, 24, True), bounds), 24)
        assert best.bounded
        dense = replace(best.search, variants=replace(best.search.variants, count=240, more=()), surveyed=None)
        own, edges = dense.outcomes(best.found.amounts[None]), not best.found.edges_free
        aim = float(own.pressures[0]) * bounds[0] / best.figures.contact_pressure
        every = np.array_split(grid(best.found, dense, 2), 10)
        least = min(float(dense.scores(dense.outcomes(part), aim, edges=edges).min()) for part in every)
    assert dense.scores(own, aim, edges=edges)[0] < BEST * least


def test_proposals_are_round_and_the_same_each_time(search: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.contact.modification_search._GENERATIONS", 2)
    monkeypatch.setattr("gearcad.contact.modification_search._STARTS", 1)
    first, second = (run(replace(search), 2000.0) for _ in range(2))  # anew: what a search has seen it does not solve again
    np.testing.assert_array_equal(first.amounts, second.amounts)
    lengths = first.amounts[[1, 3]] / 0.05
    np.testing.assert_allclose(lengths, np.round(lengths), atol=1e-9)
    amounts = first.amounts[[0, 2, 4, 5]]
    np.testing.assert_array_equal(amounts, np.round(amounts))


def test_a_bound_of_the_pressure_is_kept_and_one_that_cannot_be_gives_way_to_the_next(search: Search) -> None:
    plain = float(search.plain.pressures[0])
    with threadpool_limits(1):
        found = search.best([0.5 * plain, _TIGHT * plain])
    assert found.bound == _TIGHT * plain
    assert found.bounded
    assert 0.98 * found.bound < found.outcome.pressures[0] < 1.001 * found.bound  # it is what stops the search
    assert found.peak_to_peak < 0.6 * search.plain.peak_to_peak[0]


@pytest.mark.long
@pytest.mark.usefixtures("few")
def test_the_helix_is_turned_after_a_misaligned_wheel(search: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.contact.modification_search._GENERATIONS", 3)
    model = coarse_model("FZG C")
    mounting = Mounting(misalignment=30.0)
    with threadpool_limits(1):
        turned = start_search(model.remade(model.pair, mounting), TORQUE, ReliefShape.PARABOLIC)
        found = best(turned, 1.05)
    # Both faces are 14 mm wide, so 30 µm of the helix make up for 30 µm of the axis, and pressures are those of aligned gears.
    assert turned.plain.pressures[0] == pytest.approx(search.plain.pressures[0], rel=1e-6)
    assert found.amounts[AMOUNTS.index("pinion.helix_angle_modification")] == pytest.approx(30, abs=8)
    without = replace(found, amounts=found.amounts * [1, 1, 1, 1, 1, 0]).amounts
    pressures = turned.outcomes(np.stack([found.amounts, without]), Condition(TORQUE)).pressures
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


@pytest.mark.parametrize(
    ("errors", "free", "chosen"),
    [
        ((5.1, 5.6), (False, True), 1),  # half of what 5.1 gains on 15 is the most that free edges may cost
        ((5.1, 10.2), (False, True), 0),
        ((5.1, 5.6), (False, False), 0),
        ((5.6, 5.1), (True, True), 1),
    ],
)
def test_of_two_shapes_the_one_with_free_edges_is_proposed_if_it_is_worth_it(
    search: Search, errors: tuple[float, float], free: tuple[bool, bool], chosen: int
) -> None:
    assert search.dearest(5.1) == pytest.approx((5.1 + float(search.plain.peak_to_peak[0])) / 2)
    tried = [
        SimpleNamespace(found=SimpleNamespace(edges_free=edges), bounded=True, bound=1800.0, price=error, search=search)
        for error, edges in zip(errors, free, strict=True)
    ]
    assert _best(tried, []) is tried[chosen]
    broken = SimpleNamespace(found=SimpleNamespace(edges_free=True), bounded=False, bound=1800.0, price=1.0, search=search)
    assert _best([broken, *tried], []) is tried[chosen]


@pytest.mark.parametrize(
    "statistic", [Statistic.MEAN, *(pytest.param(each, marks=pytest.mark.long) for each in (Statistic.MEDIAN, Statistic.WORST))]
)
def test_one_load_gives_the_proposal_of_its_torque_to_the_bit(search: Search, statistic: Statistic) -> None:
    bound = _GENEROUS * float(search.plain.pressures[0])
    over = replace(search, loads=LoadRange((TORQUE,), (0.3,), statistic))
    with threadpool_limits(1):
        one, other = run(search, bound), run(over, bound)
    assert np.array_equal(one.amounts, other.amounts)
    assert one.peak_to_peak == other.peak_to_peak
    assert np.array_equal(one.outcome.figures, other.outcome.figures)


def test_statistics_of_loads_go_by_their_weights() -> None:
    values, torques = np.array([[4.0, 1.0, 2.0], [1.0, 1.0, 7.0]]), (100.0, 200.0, 300.0)
    found = {each: LoadRange(torques, (2.0, 1.0, 1.0), each).of(values).tolist() for each in Statistic}
    assert found == {Statistic.MEAN: [2.75, 2.5], Statistic.MEDIAN: [2.0, 1.0], Statistic.WORST: [4.0, 7.0]}
    assert LoadRange((100.0, -200.0), (1.0, 1.0)).greatest == -200.0


@pytest.mark.long
def test_a_proposal_over_loads_is_better_over_them_than_that_of_the_greatest(search: Search) -> None:
    loads = LoadRange((TORQUE, 0.6 * TORQUE), (1.0, 2.0))
    over = replace(search, loads=loads)
    bound = _GENEROUS * float(search.plain.pressures[0])
    with threadpool_limits(1):
        one, found = run(search, bound), run(over, bound)
        # Each load by itself, without what joins them.
        swings = [
            np.array([search.outcomes(each.amounts[None], Condition(torque)).peak_to_peak[0] for torque in loads.torques])
            for each in (one, found)
        ]
    of_one, of_found = (float(np.average(each, weights=loads.weights)) for each in swings)
    assert found.peak_to_peak == pytest.approx(of_found, rel=1e-9)
    assert of_found < 0.9 * of_one
    assert swings[0][0] < swings[1][0]
    assert found.bounded


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("200", "must be a list of"),
        ([[200, 1, 2]], "must be a list of"),
        ([], "must have from 1 to"),
        ([[200, 1], [-100, 1]], "torques of one sense"),
        ([[200, 0]], "weights above 0"),
        ([[200, 1], [200, 2]], "each torque once"),
    ],
)
def test_absurd_loads_are_told(given: object, said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        ModifyOptions(loads=given)  # type: ignore[arg-type]


def test_loads_of_a_cell_are_those_of_a_list() -> None:
    assert ModifyOptions(loads="200:0.25 150:0,75").loads == ((200.0, 0.25), (150.0, 0.75))  # type: ignore[arg-type]

"""How far one chart is off another: the definition by plain loops, and all that is not judged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.trains import one_stage

from gearcad.core.errors import GeometryError
from gearcad.core.records import Bools, Floats, Notice
from gearcad.dynamics.level_agreement import SHIFT, Agreement, Reason, agreement
from gearcad.dynamics.level_verdict import LevelStatus, LevelVerdict, finest_first
from gearcad.dynamics.options import DynamicsOptions, OperatingRange, RangeSource, operating_range
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.train import TrainModel

SPEEDS = np.linspace(1000.0, 9000.0, 401)
WHOLE = OperatingRange(2000.0, 8000.0, RangeSource.GIVEN)


@pytest.fixture(scope="module")
def plain() -> TrainStudy:
    return study_train(one_stage("massless"), DynamicsOptions(speeds=10, speed_to=9000.0))


def drawn(plain: TrainStudy, factors: Floats, *, stable: Bools | None = None, least: Floats | None = None) -> TrainStudy:
    """A study whose chart is as given; its shafts carry nothing."""
    nothing = np.full((len(SPEEDS), 2), np.nan)
    up = replace(
        plain.up,
        frequencies=SPEEDS * np.pi * 18 / 30,
        factors=factors[:, None],
        least=np.full((len(SPEEDS), 1), 0.5) if least is None else least[:, None],
        shaft_factors=nothing,
        stable=np.ones(len(SPEEDS), bool) if stable is None else stable,
        notices=(),
    )
    return replace(plain, up=up, down=None, found=())


def bump(centre: float, height: float, width: float = 0.02) -> Floats:
    return np.asarray(1 + height / (1 + ((SPEEDS / centre - 1) / width) ** 2), float)


def held(reference: TrainStudy, level: TrainStudy, over: OperatingRange = WHOLE) -> Agreement:
    return agreement(reference, level, ("exact", "isolated"), over)


def status(found: Agreement, tolerance: float = 0.05) -> LevelStatus:
    return LevelVerdict(
        model=TrainModel.ISOLATED,
        reference=TrainModel.EXACT,
        tolerance=tolerance,
        agreement=found,
        resonances=(),
        decisions=(),
    ).status


def test_the_definition(plain: TrainStudy) -> None:
    """By loops over all pairs of speeds, both ways."""
    random = np.random.default_rng(7)
    one, two = (1 + 0.2 * random.random(len(SPEEDS)) * bump(4000, 2) for _ in range(2))
    found = held(drawn(plain, one), drawn(plain, two))
    (under,), (over,) = found.under, found.over
    for said, greater, other in ((under, one, two), (over, two, one)):
        rows = []
        for speed, load in zip(SPEEDS, greater, strict=True):
            if 2000 <= speed <= 8000:
                near = other[(SPEEDS >= speed / (1 + SHIFT)) & (SPEEDS <= speed * (1 + SHIFT))]
                rows.append((load - near.max(), speed))
        assert (said.excess, said.speed) == pytest.approx(max(rows), rel=1e-9)


def test_resonances_may_be_off_a_little(plain: TrainStudy) -> None:
    reference = drawn(plain, bump(4000, 1.0))
    assert status(held(reference, drawn(plain, bump(4080, 1.0)))) is LevelStatus.ENOUGH
    off = held(reference, drawn(plain, bump(4400, 1.0)))
    assert status(off) is LevelStatus.NOT_ENOUGH and off.under[0].excess > 0.5 and off.over[0].excess > 0.5
    higher = held(reference, drawn(plain, bump(4000, 1.1)))
    assert higher.over[0].excess == pytest.approx(0.1, abs=1e-3) and higher.under[0].excess < 0.01


def test_what_is_not_judged_is_no_agreement(plain: TrainStudy) -> None:
    """Unstable motions, flanks that would part, and speeds that the chart does not have: of either model."""
    same, faulty = drawn(plain, bump(4000, 1.0)), (SPEEDS > 5000) & (SPEEDS < 5500)
    parted = drawn(plain, bump(4000, 1.0), least=np.where(faulty, -0.1, 0.5))
    unstable = drawn(plain, bump(4000, 1.0), stable=~faulty)
    for level, reason in ((parted, Reason.APART), (unstable, Reason.UNSTABLE)):
        for of, to, chart in ((same, level, "isolated"), (level, same, "exact")):
            found = held(of, to)
            (gap,) = found.not_judged
            assert status(found) is LevelStatus.OPEN and gap.reason is reason and gap.charts == (chart,)
            # As far as a resonance may be off, speeds beside these are not judged either.
            assert gap.first == pytest.approx(4900, abs=1) and gap.last == pytest.approx(5600, abs=1)
    found = held(same, same, OperatingRange(500.0, 9500.0, RangeSource.GIVEN))
    assert [(each.reason, each.first, each.last) for each in found.not_judged] == [
        (Reason.BELOW, 500.0, pytest.approx(1000.0)),
        (Reason.BEYOND, pytest.approx(9000.0), 9500.0),
    ]
    assert status(found) is LevelStatus.OPEN
    none = held(same, same, OperatingRange(20000.0, 30000.0, RangeSource.GIVEN))
    assert status(none) is LevelStatus.OPEN and none.underestimate is None


def test_a_fault_hides_no_difference_elsewhere(plain: TrainStudy) -> None:
    level = drawn(plain, bump(4400, 1.0), stable=SPEEDS < 6000)
    assert status(held(drawn(plain, bump(4000, 1.0)), level)) is LevelStatus.NOT_ENOUGH


def test_doubts_leave_it_open(plain: TrainStudy) -> None:
    same = drawn(plain, bump(4000, 1.0))
    doubtful = replace(same, found=(Notice("hardly-damped", "natural frequencies of 12 Hz have a damping ratio below 0.0005"),))
    found = held(same, doubtful)
    assert status(found) is LevelStatus.OPEN and found.doubts[0].charts == ("isolated",)


def test_shafts_that_one_model_knows_only(plain: TrainStudy) -> None:
    same = drawn(plain, bump(4000, 1.0))
    known = replace(same, up=replace(same.up, shaft_factors=np.ones((len(SPEEDS), 2))))
    found = held(known, same)
    assert found.unheld == ("input", "output") and status(found) is LevelStatus.OPEN
    assert [each.kind for each in held(known, known).curves] == ["mesh", "shaft", "shaft"]


def test_operating_ranges() -> None:
    train, chart = one_stage("exact"), (10.0, 9000.0)
    assert operating_range(train.speed, DynamicsOptions(), chart) == (10.0, 9000.0, RangeSource.CHART)
    fast = replace(train, speed=-6000.0)
    assert operating_range(fast.speed, DynamicsOptions(), chart) == (10.0, 6000.0, RangeSource.SPEED)
    assert operating_range(fast.speed, DynamicsOptions(operating_to=7000.0), chart) == (10.0, 7000.0, RangeSource.GIVEN)
    assert operating_range(fast.speed, DynamicsOptions(operating_from=0.0), chart) == (0.0, 6000.0, RangeSource.GIVEN)
    # A speed below the chart: all of it is outside, and nothing is judged.
    assert operating_range(5.0, DynamicsOptions(), chart) == (0.0, 5.0, RangeSource.SPEED)
    with pytest.raises(GeometryError, match=r"operating_from = 6000 rpm: must be below the speed of the train, 6000 rpm"):
        operating_range(fast.speed, DynamicsOptions(operating_from=6000.0), chart)


def test_the_finest_comes_first() -> None:
    assert [each.value for each in finest_first(TrainModel)] == ["exact", "elements", "modes", "massless", "isolated"]

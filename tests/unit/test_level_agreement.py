"""Agreement of charts; elements of shafts with many half waves; lines of the dynamic transmission error."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from support.responses import MESH_DAMPING, STIFFNESS, isolated, two_stages
from support.trains import one_stage

from gearcad.core.errors import GeometryError
from gearcad.core.records import Bools, Floats, Notice, PerGear
from gearcad.dynamics.level_agreement import SHIFT, Agreement, Reason, agreement
from gearcad.dynamics.level_study import study_levels
from gearcad.dynamics.level_verdict import LevelStatus, LevelVerdict, finest_first
from gearcad.dynamics.options import DynamicsOptions, OperatingRange, RangeSource, operating_range
from gearcad.dynamics.response.kv_chart import lines_that_matter
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.tooth_deviations import TransmissionError
from gearcad.dynamics.trains.train import Train, TrainModel, good_up_to

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


HALF_WAVES_SPEEDS = np.linspace(4150.0, 4250.0, 3)


def long_shaft(model: str, order: int = 12, length: float = 12000.0) -> Train:
    """Behind a stage: c = 3207.7 m/s, so a half wave is as long as the shaft at 133.65 Hz, 400.96 rpm of 20 teeth."""
    return Train(
        model=TrainModel(model),
        order=order,
        inertias=tuple(Inertia(name=name, inertia=each) for name, each in (("p", 0.004), ("w", 0.02), ("l", 0.5))),
        shafts=(Shaft(name="out", start="w", end="l", length=length, diameter=60.0, damping=0.05),),
        meshes=(
            ToothMesh(
                name="g", pinion="p", wheel="w", base_radii=PerGear(40.0, 80.0), stiffness=300.0, teeth=20, damping=2000.0,
                variation=0.02,
            ),
        ),
        torques={"p": 100.0, "l": 200.0},
    )  # fmt: skip


def test_exact_raises_its_order_and_elements_tell() -> None:
    options = DynamicsOptions(speeds=2)
    fine = study_train(long_shaft("elements", 40), options, speeds=HALF_WAVES_SPEEDS)
    own = study_train(long_shaft("exact"), options, speeds=HALF_WAVES_SPEEDS)
    coarse = study_train(long_shaft("elements"), options, speeds=HALF_WAVES_SPEEDS)
    assert own.train.order == 32  # 3 * 4250 / 400.96, upwards
    at = [np.interp(HALF_WAVES_SPEEDS, study.speeds, study.up.factors[:, 0]) for study in (fine, own, coarse)]
    assert np.abs(at[1] - at[0]).max() < 1e-3
    told = [any(notice.code == "coarse-elements" for notice in study.notices) for study in (fine, own, coarse)]
    assert told == [False, False, True]
    assert abs(good_up_to(coarse.train) / 4 - 400.96) < 0.1


def test_a_short_shaft_keeps_its_order_and_no_order_is_above_forty() -> None:
    options = DynamicsOptions(speeds=2)
    assert study_train(long_shaft("exact", length=1000.0), options, speeds=HALF_WAVES_SPEEDS).train.order == 12
    longest = study_train(long_shaft("exact", length=24000.0), options, speeds=HALF_WAVES_SPEEDS)
    assert longest.train.order == 40
    assert any("accurate up to 2673" in notice.text for notice in longest.notices)


def test_levels_do_not_judge_what_elements_do_not_follow() -> None:
    options = DynamicsOptions(speeds=3, speed_from=2500.0, speed_to=2900.0, operating_from=2550.0, operating_to=2850.0)
    study = study_levels(long_shaft("exact", length=24000.0), [TrainModel.MODES, TrainModel.EXACT], options)
    (verdict,) = study.verdicts
    (gap,) = [each for each in verdict.agreement.not_judged if each.reason is Reason.COARSE]
    assert 2673 / 1.03 < gap.first < 2673.1 and gap.last == 2850.0 and gap.charts == ("exact",)
    assert verdict.status is not LevelStatus.ENOUGH


BALANCE = 2e-5
"""Of the static deflection: what the harmonic balance leaves over."""


def test_errors_of_teeth_on_a_constant_stiffness() -> None:
    """y = e (k + i w c)/(k - m w^2 + i w c) at every order of the shaft: here 1, 5 and 8 turns in 5 teeth."""
    coefficients = np.zeros(9, complex)
    coefficients[[1, 5, 8]] = 4.0, 3.0j, 1.0 - 1.0j
    error = TransmissionError(coefficients=coefficients, teeth=5)
    system = isolated()
    mass = 1 / float(system.mesh[:, 0] @ system.mesh[:, 0])
    excitation = Excitation(meshes=(MeshExcitation(stiffness=CosineStiffness(variation=0.0), error=error),))
    chart = over_speed(system, excitation, np.linspace(3000.0, 25000.0, 40)).up
    found = chart.transmission
    assert found.orders.tolist() == [0.2, 1.0, 1.6]
    omega = chart.frequencies[:, None] * found.orders
    spring = STIFFNESS + 1j * omega * MESH_DAMPING
    expected = 2 * np.abs(coefficients[[1, 5, 8]] * spring / (spring - mass * omega**2))
    static = float(chart.static_forces[0]) / STIFFNESS * 1e6
    assert found.amplitudes[:, :, 0] == pytest.approx(expected, abs=BALANCE * static)


def test_orders_are_those_of_the_first_mesh() -> None:
    """A second mesh of 3/2 of its tooth frequency: the strongest lines of each mesh are those of its own stiffness."""
    first = MeshExcitation(stiffness=CosineStiffness(variation=0.2))
    second = MeshExcitation(stiffness=CosineStiffness(variation=0.2), frequency_ratio=Fraction(3, 2))
    found = over_speed(two_stages(), Excitation(meshes=(first, second)), np.linspace(3000.0, 4000.0, 5)).up.transmission
    for mesh, order in ((0, 1.0), (1, 1.5)):
        assert found.orders[found.amplitudes[:, :, mesh].max(axis=0).argmax()] == order
    assert (2 * found.orders % 1 == 0).all() and (np.diff(found.orders) > 0).all()


def test_lines_that_matter() -> None:
    sizes = np.array([[1.0, 0.0], [0.0, 5.0], [0.0005, 0.001], [0.2, 0.0], [0.0, 0.0]])
    assert lines_that_matter(sizes, 1e-3, 10).tolist() == [0, 1, 3]
    assert lines_that_matter(sizes, 1e-3, 2).tolist() == [0, 1]
    assert lines_that_matter(np.zeros((3, 2)), 1e-3, 2).tolist() == []
    assert lines_that_matter(np.zeros((0, 2)), 1e-3, 2).tolist() == []

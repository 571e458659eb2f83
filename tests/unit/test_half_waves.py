"""Elements of shafts where the teeth raise more half waves than they follow."""

from __future__ import annotations

import numpy as np

from gearcad.core.records import PerGear
from gearcad.dynamics.level_agreement import Reason
from gearcad.dynamics.level_study import study_levels
from gearcad.dynamics.level_verdict import LevelStatus
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.train import Train, TrainModel, good_up_to

SPEEDS = np.linspace(4150.0, 4250.0, 3)


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
    fine = study_train(long_shaft("elements", 40), options, speeds=SPEEDS)
    own = study_train(long_shaft("exact"), options, speeds=SPEEDS)
    coarse = study_train(long_shaft("elements"), options, speeds=SPEEDS)
    assert own.train.order == 32  # 3 * 4250 / 400.96, upwards
    at = [np.interp(SPEEDS, study.speeds, study.up.factors[:, 0]) for study in (fine, own, coarse)]
    assert np.abs(at[1] - at[0]).max() < 1e-3
    told = [any(notice.code == "coarse-elements" for notice in study.notices) for study in (fine, own, coarse)]
    assert told == [False, False, True]
    assert abs(good_up_to(coarse.train) / 4 - 400.96) < 0.1


def test_a_short_shaft_keeps_its_order_and_no_order_is_above_forty() -> None:
    options = DynamicsOptions(speeds=2)
    assert study_train(long_shaft("exact", length=1000.0), options, speeds=SPEEDS).train.order == 12
    longest = study_train(long_shaft("exact", length=24000.0), options, speeds=SPEEDS)
    assert longest.train.order == 40
    assert any("accurate up to 2673" in notice.text for notice in longest.notices)


def test_levels_do_not_judge_what_elements_do_not_follow() -> None:
    options = DynamicsOptions(speeds=3, speed_from=2500.0, speed_to=2900.0, operating_from=2550.0, operating_to=2850.0)
    study = study_levels(long_shaft("exact", length=24000.0), [TrainModel.MODES, TrainModel.EXACT], options)
    (verdict,) = study.verdicts
    (gap,) = [each for each in verdict.agreement.not_judged if each.reason is Reason.COARSE]
    assert 2673 / 1.03 < gap.first < 2673.1 and gap.last == 2850.0 and gap.charts == ("exact",)
    assert verdict.status is not LevelStatus.ENOUGH

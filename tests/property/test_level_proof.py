"""What is said of "isolated" is true of random drives: by K_v of full matrices, and by what comes of taking a part away."""

from collections import Counter
from dataclasses import dataclass, replace
from random import Random

import numpy as np
import pytest
from support.dense_trains import DenseTrain, dense_train, isolated_rpm, random_drive

from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats
from gearcad.dynamics.level_agreement import SHIFT, Difference
from gearcad.dynamics.level_study import study_levels
from gearcad.dynamics.level_verdict import LevelStatus, LevelStudy, LevelVerdict
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.trains.members import Shaft
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.steady_response import static_state
from gearcad.dynamics.trains.train import Train, TrainModel

TOLERANCE = 0.05

SLACK = 0.01
"""Of the load: speeds of both lie beside each other, and charts are straight lines between them within a fiftieth."""

STEP = 0.004
"""Relative, of speeds: a fifth of the half width of the sharpest resonance."""

MANY = range(20)


@dataclass(frozen=True)
class Case:
    """A drive, its verdict, and its own K_v by full matrices with all shafts and isolated."""

    train: Train
    study: LevelStudy
    verdict: LevelVerdict
    exact: DenseTrain
    isolated: DenseTrain


def case(seed: int, *, speeds: int = 300) -> Case:
    train, random = random_drive(seed), Random(seed + 1000)
    first, last = random.uniform(0.1, 0.7) * isolated_rpm(train), random.uniform(0.8, 1.3) * isolated_rpm(train)
    options = DynamicsOptions(speeds=speeds, operating_from=first, operating_to=last, level_tolerance=TOLERANCE)
    study = study_levels(train, (TrainModel.ISOLATED, TrainModel.EXACT), options)
    return Case(train, study, study.verdicts[0], dense_train(train), dense_train(train, isolated=True))


def loads(of: DenseTrain, speeds: Floats) -> tuple[Floats, Floats]:
    """K_v (s, m) of every mesh, and whether (s,) flanks would part."""
    found = [of.factors(float(speed)) for speed in speeds]
    return np.array([most for most, _ in found]), np.array([least.min() <= 0 for _, least in found])


def require_true(of: Case) -> str:
    """Raise AssertionError unless the verdict is right by its own numbers; what it is."""
    status, found = of.verdict.status, of.verdict.agreement
    speeds = np.geomspace(of.study.over.first / (1 + SHIFT), of.study.over.last * (1 + SHIFT), _count(of.study))
    exact, isolated = loads(of.exact, speeds), loads(of.isolated, speeds)
    under = over = 0.0
    for row, speed in enumerate(speeds):
        if of.study.over.first <= speed <= of.study.over.last:
            near = np.abs(np.log(speeds / speed)) <= np.log(1 + SHIFT) + 1e-9
            if not (exact[1][near] | isolated[1][near]).any():
                under = max(under, float((exact[0][row] - isolated[0][near].max(axis=0)).max()))
                over = max(over, float((isolated[0][row] - exact[0][near].max(axis=0)).max()))
    if status is not LevelStatus.NOT_ENOUGH:
        assert max(under, over) <= TOLERANCE + SLACK, (under, over)
        return status.value
    little, much = found.underestimate, found.overestimate
    assert little is not None and much is not None
    checked = [of_exact for of_exact in (True, False) if _confirmed(of, little if of_exact else much, of_exact=of_exact)]
    return status.value if checked else "parted"


def _count(study: LevelStudy) -> int:
    return int(np.log(study.over.last / study.over.first * (1 + SHIFT) ** 2) / STEP)


def _confirmed(of: Case, said: Difference, *, of_exact: bool) -> bool:
    """Whether the difference could be held against full matrices, which know no flanks that part: it is right then."""
    if said.excess <= TOLERANCE:
        return False
    near = said.speed * np.geomspace(1 / (1 + SHIFT), 1 + SHIFT, 41)
    greater, other = (of.exact, of.isolated) if of_exact else (of.isolated, of.exact)
    (most,), parted = loads(greater, np.array([said.speed]))
    others, more_parted = loads(other, near)
    if parted.any() or more_parted.any():
        return False
    mesh = of.study.mesh_names.index(said.curve.name)
    assert most[mesh] == pytest.approx(said.greater, abs=SLACK)
    assert others[:, mesh].max() == pytest.approx(said.other, abs=SLACK)
    return True


@pytest.mark.parametrize("seed", [3, 18])
def test_the_sentence_is_right(seed: int) -> None:
    """Not enough, and enough."""
    of = case(seed)
    assert require_true(of) == ("enough" if seed == 18 else "not enough")
    assert f'"isolated" is {of.verdict.status.value}' in of.study.sentence


@pytest.mark.long
def test_the_sentence_is_right_on_twenty_drives() -> None:
    found = Counter(require_true(case(seed)) for seed in MANY)
    assert found["enough"] >= 4 and found["not enough"] >= 6 and found["not enough"] + found["enough"] >= 14, found


# ---------------------------------------------------------------------- what decides


def without(train: Train, name: str, *, coupling: bool) -> Train:
    """The shaft without mass, or so soft that it couples nothing."""

    def instead(shaft: Shaft) -> Shaft:
        if shaft.name != name:
            return shaft
        bare = {"length": None, "diameter": None, "modes": None}
        return replace(shaft, torsional_stiffness=shaft.stiffness * (1e-3 if coupling else 1.0), **bare)

    return replace(train, shafts=[instead(shaft) for shaft in train.shafts])


def excess(train: Train, models: tuple[TrainModel, TrainModel], said: Difference, *, under: bool) -> float:
    """The greatest of the same sense about the same speed."""
    speed = said.speed
    options = DynamicsOptions(
        speeds=60, speed_from=0.9 * speed, speed_to=1.1 * speed, operating_from=0.995 * speed, operating_to=1.005 * speed
    )
    found = study_levels(train, models, options).verdicts[0].agreement
    return max(each.excess for each in (found.under if under else found.over) if each.curve == said.curve)


def require_decided(train: Train, verdict: LevelVerdict) -> str:
    """Raise AssertionError unless the differences go where the part that is named first is taken away; what it was."""
    models = (verdict.model, TrainModel.EXACT)
    little, much = verdict.too_little, verdict.too_much
    said = little or much
    assert said is not None
    named = [each for each in verdict.decisions if each.curve == said.curve and abs(each.speed / said.speed - 1) < 0.05]
    share = named[0].shares[0]
    coupling = share.kind != "mass"
    shaft = share.through[0] if share.through else share.name
    before = excess(train, models, said, under=little is not None)
    after = excess(without(train, shaft, coupling=coupling), models, said, under=little is not None)
    assert after < max(0.5 * before, 0.02), (shaft, share.kind, before, after)
    return share.kind


def test_what_is_named_decides() -> None:
    """Without the neighbouring stage, whose mode it is, the resonance goes."""
    of = case(11)
    assert require_decided(of.train, of.verdict) == "mesh"


@pytest.mark.long
def test_what_is_named_decides_on_many_drives() -> None:
    found = Counter[str]()
    for seed in MANY:
        of = case(seed)
        if of.verdict.status is LevelStatus.NOT_ENOUGH:
            found[require_decided(of.train, of.verdict)] += 1
    assert found.total() >= 8, found


@pytest.mark.parametrize("seed", [5, 20])
def test_a_soft_coupling_beside_a_light_shaft_is_no_torque_out_of_balance(seed: int) -> None:
    """The highest modes of the light shaft are so stiff that a free turn is known to a millionth only; loads are right."""
    train = random_drive(seed)
    of = system(train)
    assert of.stiffness * static_state(of).approach == pytest.approx(dense_train(train).forces, rel=1e-5)
    pushed = replace(of, load=of.load + of.inertias[:, 0] * 1.0)
    with pytest.raises(GeometryError, match="they must balance"):
        static_state(pushed)

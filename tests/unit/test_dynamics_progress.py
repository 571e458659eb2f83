"""How far studies of dynamics are: forwards only, to the end, and what hears of it can end them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.pairs import thesis_model
from support.responses import cosine, oscillator

from gearcad.core.runtime import cores, onwards, part
from gearcad.designs import TrainDesign
from gearcad.designs.reader import read_spec
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.time_domain import campbell as module
from gearcad.dynamics.time_domain.campbell import campbell
from gearcad.jobs.dynamics import Dynamics

TEMPLATES = Path(__file__).parents[2] / "templates"


@pytest.mark.parametrize("backlash", [None, math.inf])
def test_a_chart_tells_how_far_it_is(backlash: float | None) -> None:
    """Of a resonance over which flanks stick, or part: many shares, never backwards, most of it told."""
    told: list[float] = []
    over_speed(oscillator(0.05), cosine(0.2, phase=180.0, backlash=backlash), np.linspace(0.5, 1.4, 13), share=told.append)
    assert len(set(told)) > 3 and told == sorted(told)
    assert 0 < told[0] < 0.6 and told[-1] == 1


def test_speeds_are_counted_and_an_interrupt_ends_a_study(monkeypatch: pytest.MonkeyPatch) -> None:
    speeds, told, begun = np.linspace(1000.0, 4000.0, 40), list[tuple[int, int]](), list[float]()
    motion = module.time_history

    def noted(model: object, speed: float, **options: object) -> object:
        begun.append(speed)
        return motion(model, speed, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "time_history", noted)
    campbell(thesis_model(), speeds[:3], duration=0.01, counted=lambda done, count: told.append((done, count)))
    assert told == [(1, 3), (2, 3), (2, 3)]
    begun.clear()

    def interrupt(_done: int, _count: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        campbell(thesis_model(), speeds, duration=0.2, counted=interrupt)
    assert len(begun) < 20


def test_runs_in_time_of_a_train_are_told_beforehand() -> None:
    """A Campbell diagram by its duration, drawn errors by the number of samples; nothing of what is soon there."""
    design = read_spec(TEMPLATES / "train-pairs.toml")
    assert isinstance(design, TrainDesign)

    def seconds(**options: object) -> float:
        found = Dynamics().expected(replace(design, dynamics=replace(design.dynamics, **options)))
        assert found is not None
        return found.seconds

    assert Dynamics().expected(design) is None
    half, whole = seconds(campbell="on", duration=0.5), seconds(campbell="on")
    drawn = [seconds(tooth_errors="on", error_samples=count) for count in (9, 19, 29)]
    assert drawn[2] - drawn[1] == pytest.approx(drawn[1] - drawn[0], rel=1e-9)
    # 54 CPU seconds were measured for the first, and more than 289 for some 20 samples.
    assert 25 < whole * cores() < 110 and whole > 1.3 * half
    assert drawn[1] * cores() > 289


def test_shares_of_parts() -> None:
    told: list[float] = []
    share = onwards(told.append)
    for done in (0.0, 0.5, 1.0):
        part(share, 0.2, 0.6)(done)
    part(share, 0.2, 0.6)(0.0)  # once more
    assert told == pytest.approx([0.2, 0.4, 0.6, 0.6])

"""How far studies of dynamics are: forwards only, to the end, and what hears of it can end them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.pairs import thesis_model
from support.responses import cosine, oscillator

from gearcad.dynamics.charts.over_speed import over_speed
from gearcad.dynamics.tooth_springs import campbell as module
from gearcad.dynamics.tooth_springs.campbell import campbell
from gearcad.progress import onwards, part


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


def test_shares_of_parts() -> None:
    told: list[float] = []
    share = onwards(told.append)
    for done in (0.0, 0.5, 1.0):
        part(share, 0.2, 0.6)(done)
    part(share, 0.2, 0.6)(0.0)  # once more
    assert told == pytest.approx([0.2, 0.4, 0.6, 0.6])

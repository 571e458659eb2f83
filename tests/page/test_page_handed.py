"""What a tab leaves to its next page is taken once, and ends where nobody comes for it."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from gearcad.designs.reader import starter_text
from gearcad.page import session
from gearcad.page.runs import Runs, runs_of
from gearcad.page.session import SessionHandover, hand_over, take_over
from gearcad.page.workbench import BesideDesign, Workbench


def _left() -> SessionHandover:
    return SessionHandover(BesideDesign(Workbench(starter_text("spur")[1], "mine", Path())), Runs())


def test_what_is_left_is_taken_once() -> None:
    left = _left()
    key = hand_over(left)
    assert take_over("another") is None
    assert take_over(key) is left
    assert take_over(key) is None
    left.runs.close()


def test_runs_that_nobody_takes_over_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "_SECONDS", 0.01)
    left = _left()
    key = hand_over(left)
    end = time.monotonic() + 10
    while runs_of(left.runs.key) is not None and time.monotonic() < end:
        time.sleep(0.01)
    assert runs_of(left.runs.key) is None and take_over(key) is None

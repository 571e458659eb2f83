"""Solid bodies that the machine has no memory for are refused before they are begun."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from gearcad import Gear, GearPair, Load, Material
from gearcad.check import CheckOptions, run
from gearcad.check.run import check_pair, expected_solid
from gearcad.check.task import CheckTask, check_task
from gearcad.core.errors import ParameterError

PAIR = GearPair(
    pinion=Gear(teeth=20, normal_module=2, face_width=60, helix_angle=15, tooth_thinning=0.05),
    wheel=Gear(teeth=30, normal_module=2, face_width=60, helix_angle=-15, tooth_thinning=0.05),
)


def task(refinement: float, convergence: str = "on") -> CheckTask:
    options = CheckOptions(refinement=refinement, convergence=convergence)
    return check_task(PAIR, Material(), Load(torque=100), options)


@pytest.fixture
def needed(monkeypatch: pytest.MonkeyPatch) -> float:
    """Bytes that a check takes, on a machine with a little less."""
    memory = expected_solid(task(1.0)).memory
    monkeypatch.setattr(run, "machine_memory", lambda: 0.9 * memory)
    return memory


def test_bodies_for_which_there_is_no_memory_are_refused(needed: float) -> None:
    there = re.escape(f"there are {0.9 * needed / 1e9:.3g} GB")
    with pytest.raises(ParameterError, match=f"GB of memory, or fewer without convergence, and {there}; about 0.92 would do"):
        check_pair(check_task(PAIR, Material(), Load(torque=100), CheckOptions()))


def test_what_is_told_would_do(needed: float) -> None:
    run.require_room(task(0.92))
    run.require_room(task(1.0, "off"))
    with pytest.raises(ParameterError):
        run.require_room(task(1.0))


def test_a_machine_with_room_refuses_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = task(1.0)
    monkeypatch.setattr(run, "machine_memory", lambda: expected_solid(wanted).memory)
    run.require_room(wanted)
    run.require_room(replace(wanted, load=Load(torque=200)))

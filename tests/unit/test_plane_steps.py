"""What a check in the plane is said to take, before it does."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gearcad import Gear, GearPair, Load
from gearcad.check.options import CheckOptions
from gearcad.check.run import expected_check, plane_steps
from gearcad.check.task import check_task

PAIR = GearPair(
    pinion=Gear(teeth=16, normal_module=4.5, face_width=14.0), wheel=Gear(teeth=24, normal_module=4.5, face_width=14.0)
)


def steps(**options: object) -> dict[str, float]:
    asked = replace(CheckOptions(), **options)
    return plane_steps(check_task(PAIR, material=None, load=Load(torque=302.0), options=asked))  # type: ignore[arg-type]


def test_steps_follow_what_is_asked_for() -> None:
    usual = steps()
    assert steps(convergence="off")["convergence"] == 0.0
    assert steps(torques=(100.0,))["torque sweep"] == pytest.approx(usual["torque sweep"] / 5)
    more, most = (steps(positions=count)["mesh cycle"] - usual["mesh cycle"] for count in (120, 180))
    assert most == pytest.approx(2 * more) and more > 0
    fine, finer = (steps(refinement=factor)["mesh cycle"] - usual["mesh cycle"] for factor in (2.0, 3.0))
    assert finer / fine == pytest.approx(8 / 3)


def test_all_of_them_are_what_the_check_takes() -> None:
    from gearcad import Material

    asked = CheckOptions(model="2d")
    assert expected_check(check_task(PAIR, Material(), Load(torque=302.0), asked)).seconds == pytest.approx(
        sum(steps().values())
    )

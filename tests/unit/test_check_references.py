"""What a check holds its figures against: the references of the very load, and what both sides leave out."""

from __future__ import annotations

from dataclasses import replace

import pytest
from support.checks import small_check, small_solid_check

from gearcad import Load
from gearcad.check.face import face_factors
from gearcad.check.judge import standards
from gearcad.check.result import Task


def task_of(result: Task, **changes: object) -> Task:
    """The task of a check with changes."""
    return replace(Task(**result.inputs), **changes)


def test_references_of_stiffness_are_those_of_the_load() -> None:
    """15.12 N·m are 30 N/mm: ISO 6336-1 (90) leaves 0.3^0.25 of the stiffness that 302 N·m have."""
    heavy, light = (task_of(small_check(), load=Load(torque=torque)) for torque in (302.0, 15.12))
    assert light.rating.specific_load == pytest.approx(30.0)
    found = [{each.quantity: each.reference for each in standards(task, small_check().summary)} for task in (heavy, light)]
    for quantity in ("mean mesh stiffness", "single stiffness"):
        assert found[1][quantity] / found[0][quantity] == pytest.approx(0.3**0.25, rel=1e-9)


def test_misalignment_meets_the_stiffness_of_the_load() -> None:
    """K_H_beta - 1 goes with c_gamma_beta over the load: with the power -3/4 of a load below 100 N/mm."""
    task = task_of(small_solid_check())
    width, radius = task.pair.common_width.width, task.pair.pinion.reference_diameter / 2000
    factors = [face_factors(task_of(task, load=Load(torque=load * width * radius))).flank for load in (95.0, 90.0)]
    assert all(factor < 2 for factor in factors)
    assert (factors[1] - 1) / (factors[0] - 1) == pytest.approx((90 / 95) ** -0.75, rel=1e-9)

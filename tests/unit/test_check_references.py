"""What a check holds its figures against: the references of the very load, and what both sides leave out."""

from __future__ import annotations

from dataclasses import replace

import pytest
from support.checks import small_check, small_solid_check
from support.coarse import coarse_model

from gearcad import Load, Material, Mounting
from gearcad.check.gates import compare_solid, standards
from gearcad.check.options import CheckOptions
from gearcad.check.summary import summarise_solid
from gearcad.check.task import CheckTask, face_factors
from gearcad.contact.solid.cycle import SolidCycle

_UNEVEN = 0.05
"""How uneven exact flanks of aligned spur gears carry along the face, away from its ends; 46 % against the mean length."""


def test_references_of_stiffness_are_those_of_the_load() -> None:
    """15.12 N·m are 30 N/mm: ISO 6336-1 (90) leaves 0.3^0.25 of the stiffness that 302 N·m have."""
    heavy, light = (replace(small_check().task, load=Load(torque=torque)) for torque in (302.0, 15.12))
    assert light.rating.specific_load == pytest.approx(30.0)
    found = [{each.quantity: each.reference for each in standards(task, small_check().summary)} for task in (heavy, light)]
    for quantity in ("mean mesh stiffness", "single stiffness"):
        assert found[1][quantity] / found[0][quantity] == pytest.approx(0.3**0.25, rel=1e-9)


def test_misalignment_meets_the_stiffness_of_the_load() -> None:
    """K_H_beta - 1 goes with c_gamma_beta over the load: with the power -3/4 of a load below 100 N/mm."""
    task = small_solid_check().task
    width, radius = task.pair.common_width.width, task.pair.pinion.reference_diameter / 2000
    factors = [face_factors(replace(task, load=Load(torque=load * width * radius))).flank for load in (95.0, 90.0)]
    assert all(factor < 2 for factor in factors)
    assert (factors[1] - 1) / (factors[0] - 1) == pytest.approx((90 / 95) ** -0.75, rel=1e-9)


def test_the_greatest_line_load_is_held_against_the_shortest_lines() -> None:
    """Spur gears carry all of the load on one line of the common width: what is above that is unevenness along it alone."""
    model, load = coarse_model("FZG C"), Load(torque=302.0)
    task = CheckTask(pair=model.pair, material=Material(), load=load, mounting=Mounting(), options=CheckOptions(model="3d"))
    cycle = SolidCycle.run(model, load.torque, 12)
    found = {each.quantity: each for each in compare_solid(task, cycle, summarise_solid(cycle, 12.0), ())}
    line = found["greatest line load"]
    assert line.reference == pytest.approx(302e3 / (model.pair.pinion.base_diameter / 2) / 14.0, rel=1e-9)
    assert line.passed and 0 < line.deviation < _UNEVEN

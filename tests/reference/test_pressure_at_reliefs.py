"""Pressure where linear reliefs start, of whole models: plane and solid, with every internal length halved, against a trial.

The trial: z 21/43, m 3, a 97, b 25, 200 N·m, 18 µm over 1 mm of roll, by another program of the same method.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import gearcad
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.shared.loaded import Cycle
from gearcad.contact.shared.local_contact import onsets, start_lengths
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.core.records import PerGear, Role
from gearcad.geometry import GearPair

TORQUE = 200.0

TRIAL = 0.01
"""Relative: a program of its own, with meshes of its own."""

BOTH_MODELS = 0.02
"""Relative: plane strain against the middle of solid bodies 25 mm wide."""

HALVED = 0.01
"""Relative: what every internal length halved may change."""

AWAY = {"plane": 1166.0, "solid": 1180.0}
"""The trial's greatest pressures (MPa) away from ends and starts."""

STARTS = {
    0.15: (PerGear(1319.0, 1621.0), PerGear(1315.0, 1617.0)),
    0.3: (PerGear(1076.0, 1331.0), PerGear(1073.0, 1328.0)),
}
"""By transition (mm of roll), the trial's pressures (MPa): plane, and solid in the middle of the face."""


def pair_with(transition: float) -> GearPair:
    pair = gearcad.read(Path(gearcad.__file__).parents[1] / "templates" / "reducer-21-43.toml").pair
    pinion, wheel = (
        replace(gear, modification=replace(gear.modification, tip_relief_transition=transition)) for gear in pair.gears
    )
    return replace(pair, pinion=pinion, wheel=wheel)


@cache
def plane() -> PlanePair:
    return plane_pair(pair_with(0.3), gearcad.Material(name="steel"))


@cache
def solid() -> SolidPair:
    return solid_pair(pair_with(0.3), gearcad.Material(name="steel"))


def greatest(cycle: Cycle) -> PerGear[float]:
    """Return the greatest pressures (MPa) at the starts as contacts pass them."""
    angles = cycle.model.roll_angle(start_lengths(cycle.model.line)).tolist()
    told = [contact.start_pressures for angle in angles for contact in cycle.contacts_at(angle)]
    return PerGear.each(lambda role: float(np.nanmax([each.pick(role) for each in told])))


def in_the_middle(cycle: SolidCycle) -> PerGear[float]:
    """Return those of solid bodies in the middle of the face, of the contacts at the transitions themselves."""
    line, found = cycle.model.line, PerGear[list[float]]([], [])
    for angle in cycle.model.roll_angle(start_lengths(line)).tolist():
        for contact in cycle.contacts_at(angle):
            middle = int(np.argmin(np.abs(contact.line.across)))
            for role, flank in line.flanks.items():
                length = contact.line.places.pick(role)[0][middle]
                if any(abs(length - onset.roll) < 1.0 for onset in onsets(flank)):
                    found.pick(role).append(float(contact.pressures[middle]))
    return found.map(max)


def away(cycle: Cycle) -> float:
    found = cycle.worst_contact
    assert found is not None and found[1].interior_pressure is not None
    return found[1].interior_pressure


@pytest.mark.parametrize("transition", STARTS)
def test_plane_contact_has_the_pressure_of_the_trial(transition: float) -> None:
    model = plane().with_flanks(pair_with(transition))
    assert greatest(PlaneCycle(model, TORQUE)) == pytest.approx(STARTS[transition][0], rel=TRIAL)


def test_a_kink_leaves_the_pressure_away_from_it_as_it_is() -> None:
    for transition in (0.0, 0.3):
        cycle = PlaneCycle.run(plane().with_flanks(pair_with(transition)), TORQUE, 60)
        assert away(cycle) == pytest.approx(AWAY["plane"], rel=TRIAL)


@pytest.mark.long
@pytest.mark.parametrize("transition", STARTS)
def test_solid_contact_has_the_pressure_of_the_trial_and_of_the_plane(transition: float) -> None:
    flanks = pair_with(transition)
    middle = in_the_middle(SolidCycle(solid().with_flanks(flanks), TORQUE))
    assert middle == pytest.approx(STARTS[transition][1], rel=TRIAL)
    assert middle == pytest.approx(greatest(PlaneCycle(plane().with_flanks(flanks), TORQUE)), rel=BOTH_MODELS)


@pytest.mark.long
def test_a_kink_leaves_the_pressure_of_solid_bodies_away_from_it_as_it_is() -> None:
    for transition in (0.0, 0.3):
        cycle = SolidCycle.run(solid().with_flanks(pair_with(transition)), TORQUE, 24)
        assert away(cycle) == pytest.approx(AWAY["solid"], rel=TRIAL)
        told = [contact.start_pressures.pick(role) for _, contact in cycle.contacts for role in Role]
        assert np.isnan(told).all() == (transition == 0.0)


@pytest.mark.long
def test_no_internal_length_decides_the_pressure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half as long: cells along the line, places across it, steps of slopes and of positions; twice the dofs of the bodies."""
    before = greatest(SolidCycle(solid(), TORQUE))
    plane_before = greatest(PlaneCycle(plane(), TORQUE))
    for name, value in (
        ("gearcad.contact.solid.line_contact.BEND", 0.025),
        ("gearcad.contact.solid.relief_start._STEP", 0.5e-4),
        ("gearcad.contact.shared.local_contact._OF_TRANSITION", 16),
        ("gearcad.contact.shared.local_contact._OF_WIDTH", 96),
        ("gearcad.contact.shared.local_contact._STEPS", 12),
        ("gearcad.contact.plane.pair._OF_TRANSITION", 16),
        ("gearcad.contact.plane.pair._CELLS", 132),
    ):
        monkeypatch.setattr(name, value)
    finer = solid_pair(pair_with(0.3), gearcad.Material(name="steel"), sizes=SolidSizes().refined(1.26), cells=120)
    assert greatest(SolidCycle(finer, TORQUE)) == pytest.approx(before, rel=HALVED)
    assert greatest(PlaneCycle(plane().with_flanks(pair_with(0.3)), TORQUE)) == pytest.approx(plane_before, rel=HALVED)

"""The check of solid bodies of a pair with a ring: gates, what it says, its files; which teeth of a pair move each other."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from gearcad import Body, FlankModification, Gear, GearPair, Load, Material, Mounting
from gearcad.check.comparison import ComparisonRole
from gearcad.check.options import CheckOptions
from gearcad.check.result import SolidCheck
from gearcad.check.run import check_pair
from gearcad.check.task import check_task, face_factors
from gearcad.contact.shared.line_of_action import LineOfAction, facing_gap, facing_teeth, line_of_action, nearest
from gearcad.contact.solid.pair import teeth_moved
from gearcad.core.errors import ParameterError
from gearcad.core.records import Role
from gearcad.geometry import ShaperCutter
from gearcad.plots.check import plot_contact_pattern, plot_line_loads, plot_root_along_face, plot_tooth

STEEL = Material()
RELIEVED = FlankModification(tip_relief=8.0, tip_relief_length=1.5)
PAIR = GearPair(
    pinion=Gear(
        teeth=22,
        normal_module=2.0,
        face_width=8,
        helix_angle=15,
        profile_shift=0.3,
        body=Body(bore=20.0),
        modification=RELIEVED,
    ),
    wheel=Gear(
        teeth=-70,
        normal_module=2.0,
        face_width=6.5,
        helix_angle=15,
        profile_shift=-0.3,
        tip_alteration=-0.1,
        cutter=ShaperCutter(teeth=25, tip_radius=0.2),
        body=Body(rim_diameter=175.0),
        modification=FlankModification(tip_relief=6.0, tip_relief_length=2.0),
    ),
)
COARSE = CheckOptions(model="3d", convergence="off", torques=(60.0,), positions=12, body_teeth=3, refinement=0.7)
TORQUE = 60.0


@pytest.fixture(scope="module")
def result() -> SolidCheck:
    found = check_pair(check_task(PAIR, STEEL, Load(torque=TORQUE), COARSE))
    assert isinstance(found, SolidCheck)
    return found


def test_a_helical_pair_with_a_ring_is_checked_like_any_other(result: SolidCheck) -> None:
    assert CheckOptions().model_for(PAIR).value == "3d"
    gates = {each.quantity: each for each in result.comparisons if each.role is ComparisonRole.GATE}
    reaction = gates["torque reaction of the wheel"]
    assert reaction.passed and reaction.reference == pytest.approx(TORQUE * 70 / 22, rel=1e-12)
    assert gates["torque reaction of the pinion"].passed
    assert result.bodies["wheel"] == "3 teeth with fixed cuts, held on diameter 175 mm"
    told = {notice.code for notice in result.notices}
    assert not told & {"no-rim", "no-bore", "rigid-rim", "conformal-contact", "thin-rim"}
    depths = result.explanations.stiffness.rim_depths
    assert depths.wheel == pytest.approx((175 - abs(PAIR.wheel.root_diameter)) / 2 / 2.0, rel=1e-9)


def test_loads_of_lines_add_up(result: SolidCheck) -> None:
    """In check.json too: what all lines carry is the normal force, and their places on the ring are signed."""
    force = TORQUE * 1000 / (PAIR.pinion.base_diameter / 2) / math.cos(math.radians(PAIR.pinion.base_helix_angle))
    form = PAIR.wheel.flank_form
    for lines in json.loads(json.dumps(result.own_document))["load_distribution"]:
        carried = sum(np.dot(line["line_load"], line["length"]) for line in lines)
        assert carried == pytest.approx(force, rel=1e-6)
        for line in lines:
            touching = np.array(line["pinion_roll_length"]) + np.array(line["wheel_roll_length"])
            on_flank = touching[~np.array(line["on_edge"])]
            assert on_flank == pytest.approx(np.full(len(on_flank), PAIR.base_tangent.length), rel=1e-9)
            assert form.first - 1e-9 < min(line["wheel_roll_length"]) and max(line["wheel_roll_length"]) < form.last + 1e-9


def test_its_stress_is_written_and_drawn_as_the_ring_stands(result: SolidCheck, tmp_path: Path) -> None:
    result.stress_files["stress_wheel.vtu"](tmp_path / "ring.vtu")
    points = meshio.read(tmp_path / "ring.vtu").points
    radii = np.hypot(points[:, 0], points[:, 1])
    profile = PAIR.wheel.profile
    assert radii.min() == pytest.approx(profile.tip_diameter / 2, rel=1e-9)
    assert radii.max() == pytest.approx(175 / 2, rel=1e-9)
    # The picture turns it, so that the tip is up, and leaves out what is far from the teeth.
    surface = result.tooth_surfaces.wheel
    height = np.ptp(surface.points[:, 0])
    assert profile.root_diameter / 2 - profile.tip_diameter / 2 < height < 10.0
    upper, lower = (surface.points[surface.points[:, 0] * sign > 0.4 * height] for sign in (1, -1))
    assert np.ptp(upper[:, 1]) < np.ptp(lower[:, 1])
    for axes in (plot_contact_pattern(result, Role.WHEEL), plot_line_loads(result), plot_root_along_face(result)):
        assert axes.collections or axes.lines
    assert plot_tooth(surface).collections


def test_right_flanks_carry_as_left_ones_do(result: SolidCheck) -> None:
    """A pair whose middles stand in one plane is the image of that of the other hand, seen from the other end."""
    other = check_pair(check_task(PAIR, STEEL, Load(torque=-TORQUE), COARSE))
    assert other.summary.mesh_stiffness_mean == pytest.approx(result.summary.mesh_stiffness_mean, rel=1e-6)
    assert other.summary.root_tension == pytest.approx(tuple(result.summary.root_tension), rel=1e-5)
    assert other.cycle.load_along_face[1] == pytest.approx(result.cycle.load_along_face[1][::-1], rel=1e-4)


def test_method_c_minds_which_flank_of_the_ring_carries() -> None:
    """What takes the ring's flank back above is what misalignment does, and a helix modification of the pinion undoes it."""
    for torque in (TORQUE, -TORQUE):
        for hand in (15.0, -15.0, 0.0):
            pinion, wheel = (replace(gear, helix_angle=hand) for gear in PAIR.gears)
            changed = replace(PAIR.wheel.modification, helix_angle_modification=10.0)
            plain = replace(PAIR, pinion=pinion, wheel=wheel)
            pair = replace(plain, wheel=replace(wheel, modification=changed))
            form = pair.wheel.flank_form
            low, high = form.depth(-23.0, np.array([0.0, form.width]), left=torque < 0)
            given = (STEEL, Load(torque=torque), CheckOptions(model="3d"), Mounting(misalignment=3.0))
            found = face_factors(check_task(pair, *given)).misalignment
            assert found == pytest.approx(3.0 + 1000 * (high - low), rel=1e-9)


@pytest.mark.parametrize("hold", ["bolts", "free"])
def test_solid_rings_are_held_all_round(hold: str) -> None:
    options = CheckOptions(model="3d", wheel_support=hold)
    with pytest.raises(ParameterError, match=rf"check.wheel_support = '{hold}': must be \"rigid\""):
        check_pair(check_task(PAIR, STEEL, Load(torque=TORQUE), options))


def least_gap(line: LineOfAction, tooth: int, length: float) -> float:
    """Of the flanks of a pair of teeth (mm), infinite where they do not face each other."""
    if (found := nearest(line, tooth, length)) is None:
        return math.inf
    return float(facing_gap(line, tooth, length, np.array([found[1]]))[1][0])


def test_pairs_that_can_touch_move_each_other() -> None:
    """Flanks that are nearly alike stay close far beyond the path of contact: counted tooth by tooth."""
    for teeth, least in ((-60, 3), (-90, 2)):
        pinion = Gear(teeth=40, normal_module=2.0, face_width=14, tip_alteration=-0.2)
        wheel = Gear(teeth=teeth, normal_module=2.0, face_width=14, tip_alteration=-0.3, cutter=ShaperCutter(teeth=15))
        pair = GearPair(pinion=pinion, wheel=wheel)
        line, middle = line_of_action(pair), pair.path_of_contact.C
        most = 0
        for length in np.linspace(middle - line.pitch / 2, middle + line.pitch / 2, 41):
            found = (least_gap(line, tooth, length + tooth * line.pitch) for tooth in facing_teeth(line))
            most = max(most, sum(gap < 0.02 * 2.0 for gap in found))
        assert teeth_moved(pair) == most - 1 >= least

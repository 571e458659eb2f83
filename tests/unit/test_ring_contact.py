"""Contact of a pinion inside a ring: gaps, the line of action, poses, and the check of its solid bodies."""

import json
import math
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
from support.brute import nodal_compliance
from support.dense_contact import involute, pair_of_tooth_0

from gearcad import Body, Gear, GearPair, Load, Material, Mounting
from gearcad.check.comparison import ComparisonRole
from gearcad.check.options import CheckOptions
from gearcad.check.result import SolidCheck
from gearcad.check.run import check_pair
from gearcad.check.task import check_task, face_factors
from gearcad.contact.plane.cycle import PlaneCycle, contact_frame, tooth_field
from gearcad.contact.plane.pair import PlanePair, contact_pairs, plane_pair
from gearcad.contact.shared.line_of_action import LineOfAction, facing_gap, facing_teeth, line_of_action, nearest, overlap
from gearcad.contact.solid.pair import teeth_moved
from gearcad.core.errors import ParameterError
from gearcad.core.records import Role
from gearcad.geometry import FlankModification, ReliefShape, ShaperCutter
from gearcad.meshing.outline import MeshSizes
from gearcad.plots.check import plot_contact_pattern, plot_line_loads, plot_root_along_face, plot_tooth

STEEL = Material()
CUTTER = ShaperCutter(teeth=25)
RING = Gear(
    teeth=-70,
    normal_module=2.0,
    face_width=14,
    profile_shift=-0.3,
    tip_alteration=-0.1,
    cutter=CUTTER,
    body=Body(rim_diameter=170.0),
)
PAIR = GearPair(pinion=Gear(teeth=22, normal_module=2.0, face_width=14, profile_shift=0.3), wheel=RING)
TORQUE = 100.0

REACH = 1.0
"""Half widths from the end of a flank within which its edge carries."""


@pytest.fixture(scope="module")
def model() -> PlanePair:
    return plane_pair(PAIR, STEEL)


@pytest.fixture(scope="module")
def cycle(model: PlanePair) -> PlaneCycle:
    return PlaneCycle.run(model, TORQUE, 12)


# The line of action


@pytest.mark.parametrize("part", [0.0, 0.3, 0.8, 1.0])
def test_gap_is_that_of_two_involutes_unrolled_to_the_same_side(part: float) -> None:
    """Both base circles lie on one side of the line of action, and places along the tangent are the same for both."""
    line, path = line_of_action(PAIR), PAIR.path_of_contact
    length = path.A + 0.02 + part * (path.E - path.A - 0.04)
    pair = pair_of_tooth_0(PAIR, length, 0.3, 60)
    between = np.zeros(len(pair.cells.place))
    for gear, contact, lengths, sense in (
        (PAIR.pinion, length, pair.cells.lengths.pinion, 1),
        (PAIR.wheel, length - line.whole, -pair.cells.lengths.wheel, -1),
    ):
        base = abs(gear.base_diameter) / 2
        points = involute(base, -contact / base, lengths)
        assert points[:, 0] - base == pytest.approx(pair.cells.place, abs=1e-9)
        between += sense * (points[:, 1] + contact)
    assert pair.cells.gap == pytest.approx(between + pair.cells.width**2 / 24 / pair.radius, abs=1e-9)
    assert (between > 0).all()


def test_radius_is_that_of_a_round_flank_in_a_hollow_one() -> None:
    pair = pair_of_tooth_0(PAIR, PAIR.path_of_contact.C, 0.1, 66)
    sine = math.sin(math.radians(PAIR.working_transverse_pressure_angle))
    first, second = (abs(diameter) / 2 * sine for diameter in PAIR.working_pitch_diameters)
    assert pair.radius == pytest.approx(first * second / (second - first), rel=1e-9)


def test_pairs_follow_each_other_by_the_base_pitch_and_end_with_the_path() -> None:
    line, path = line_of_action(PAIR), PAIR.path_of_contact
    assert line.whole < 0
    for length in np.linspace(path.A - 2 * line.pitch, path.E + 2.1 * line.pitch, 61) + 0.001:
        found = contact_pairs(line, float(length), lambda _tooth, _radius: 0.05, 66, 0.0)
        expected = [tooth for tooth in range(-9, 10) if path.A < length + tooth * line.pitch < path.E]
        assert [pair.tooth for pair in found] == expected
    assert len(facing_teeth(line)) > 3


def test_flanks_face_each_other_between_their_ends() -> None:
    """At the ends of what the tangent allows one flank ends: their radii are those of the ends of the involutes."""
    line = line_of_action(PAIR)
    for length in np.linspace(*PAIR.path_of_contact[::4], 7)[1:-1]:
        low, high = overlap(line, float(length))
        assert low < 0 < high
        facing, _ = facing_gap(line, 0, float(length), np.array([low, high]))
        ends = [
            min(abs(found - end) for end in (flank.first, flank.last))
            for flank, lengths in zip(line.flanks, facing, strict=True)
            for found in lengths
        ]
        assert sorted(ends)[:2] == pytest.approx([0, 0], abs=1e-9)


def test_tip_relief_of_a_ring_opens_the_gap_at_its_tip() -> None:
    relief = FlankModification(tip_relief=20.0, tip_relief_length=1.5, tip_relief_transition=0.0)
    line = line_of_action(replace(PAIR, wheel=replace(RING, modification=relief)))
    first = PAIR.path_of_contact.A
    for beyond, depth in ((0.0, 0.020), (0.75, 0.010), (1.5, 0.0), (4.0, 0.0)):
        _, gap = facing_gap(line, 0, first + beyond, np.zeros(1))
        assert gap == pytest.approx(depth, rel=0.02, abs=1e-9)  # what lies behind comes from a little nearer to the root


def test_a_steeper_helix_of_a_ring_acts_on_the_flank_that_carries() -> None:
    """The pinion's left flank meets flanks with y < 0: where sections turn counter-clockwise with z these come nearer."""
    change = FlankModification(helix_angle_modification=10.0)
    pair = GearPair(pinion=PAIR.pinion, wheel=replace(RING, modification=change, face_width=20.0), axial_offset=5.0)
    line = line_of_action(pair)
    _, gap = facing_gap(line, 0, PAIR.path_of_contact.C, np.zeros(1))
    along = (pair.wheel.face_width / 2 + pair.common_width.offset - pair.axial_offset) / pair.wheel.face_width - 0.5
    exact = pair.wheel.flank_form.depth(-20.0, pair.wheel.face_width * (along + 0.5), left=False)
    assert gap == pytest.approx(float(exact), abs=1e-9)
    assert abs(gap[0]) > 1e-3


# Bodies in mesh


def test_the_hubs_balance_the_torque(cycle: PlaneCycle) -> None:
    for position in cycle.positions:
        assert position.torques.pinion == pytest.approx(TORQUE, rel=1e-5)
        # Where the edge of a tip touches, by its lever, also before the contact has left the flank altogether.
        levers = position.torque_ratios.wheel
        nearest = min(contact.edge_distance / contact.hertz_half_width for contact in position.contacts)
        assert (levers != 1) == (nearest < REACH)
        assert position.torques.wheel == pytest.approx(TORQUE * 70 / 22 * levers, rel=1e-5)


def test_pressures_are_those_of_a_round_flank_in_a_hollow_one(cycle: PlaneCycle) -> None:
    interior = [contact for _, contact in cycle.interior_contacts]
    assert len(interior) > 8
    for contact in interior:
        assert contact.peak_pressure == pytest.approx(contact.hertz_pressure, rel=0.01)
        assert contact.half_width == pytest.approx(contact.hertz_half_width, rel=0.01)


def test_the_field_shows_the_ring_where_it_stands(cycle: PlaneCycle) -> None:
    """Models see a ring mirrored; what is drawn is the true one. Without backlash its teeth stand as the pair poses them."""
    position = cycle.positions[5]
    line, angle = cycle.model.line, math.radians(PAIR.working_transverse_pressure_angle)
    length = cycle.model.roll_length(position.roll_angle)
    heading = math.radians(PAIR.pinion.base_half_angle) - length / cycle.model.base_radius
    pose = PAIR.wheel_pose(math.degrees(-angle - heading))
    for tooth in (-1, 0, 1):
        field = tooth_field(cycle, position, Role.WHEEL, tooth)
        away = field.outline - [pose.x, pose.z]
        turned = np.degrees(np.arctan2(away[:, 1], away[:, 0])) - pose.rotation - tooth * 360 / 70
        radius = np.hypot(*away.T)
        steep = (radius < RING.profile.root_diameter / 2 * (1 - 1e-6)) & (radius > RING.profile.tip_diameter / 2 * (1 + 1e-9))
        half = RING.profile.half_angle(radius[steep])
        assert np.abs(turned[steep]) == pytest.approx(half, abs=1e-6)
        assert line.whole < 0 and np.hypot(*field.points.T).min() > 15


def test_the_contact_lies_on_both_flanks_of_the_field(cycle: PlaneCycle) -> None:
    position = cycle.positions[8]
    contact = max(position.interior_contacts, key=lambda each: each.force)
    centre, frame = contact_frame(cycle, contact)
    for role, sense in ((Role.PINION, -1), (Role.WHEEL, 1)):
        field = tooth_field(cycle, position, role, contact.tooth)
        assert np.hypot(*(field.outline - centre).T).min() < 0.15
        deepest = field.points[np.argmax(field.von_mises)] - centre
        assert 0.4 < sense * (deepest @ frame)[1] / contact.hertz_half_width < 1.2


@pytest.mark.long
def test_flanks_meshed_finely_tell_the_same_without_flamant(model: PlanePair) -> None:
    """Elements that carry the contact themselves, with nothing taken off: stiffness within 0.5 %, root tension within 1 %."""
    fine = replace(MeshSizes(), flank=0.012, corner=0.01)
    brute = plane_pair(PAIR, STEEL, sizes=fine, solve=nodal_compliance)
    for angle in (-6.0, 1.0):
        own, witness = (PlaneCycle(each, TORQUE).solve(angle) for each in (model, brute))
        assert own.stiffness == pytest.approx(witness.stiffness, rel=0.005)
        assert tuple(each.stress for each in own.tension) == pytest.approx(
            tuple(each.stress for each in witness.tension), rel=0.01
        )


def test_a_great_ring_and_a_great_wheel_meet_in_the_rack() -> None:
    """Stiffness of the pair as the number of teeth goes to infinity on either side: the difference falls as 1/z."""
    found = {}
    for teeth in (-800, -400, 400, 800):
        wheel = Gear(teeth=teeth, normal_module=2.0, face_width=14, tip_alteration=-0.1)
        pair = GearPair(pinion=PAIR.pinion, wheel=replace(wheel, profile_shift=math.copysign(0.0, teeth)))
        held = replace(pair, wheel=replace(pair.wheel, body=body_of(pair.wheel)))
        found[teeth] = PlaneCycle(plane_pair(held, STEEL), TORQUE).solve(0.0).stiffness
    near, far = found[400] - found[-400], found[800] - found[-800]
    assert abs(far) < 0.65 * abs(near)
    rack_inside, rack_outside = (2 * found[2 * teeth] - found[teeth] for teeth in (-400, 400))
    assert rack_inside == pytest.approx(rack_outside, rel=0.005)


def body_of(gear: Gear) -> Body:
    """Four modules of rim, inside or outside."""
    root = abs(gear.root_diameter)
    return Body(rim_diameter=root + 16.0) if gear.internal else Body(bore=root - 16.0)


RELIEVED = FlankModification(tip_relief=8.0, tip_relief_length=1.5, tip_relief_shape=ReliefShape.PARABOLIC)
SOLID_PAIR = GearPair(
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
        modification=replace(RELIEVED, tip_relief=6.0, tip_relief_length=2.0),
    ),
)
COARSE = CheckOptions(model="3d", convergence="off", torques=(60.0,), positions=12, body_teeth=3, refinement=0.7)
SOLID_TORQUE = 60.0


def coarse_check(torque: float, shape: ReliefShape = ReliefShape.PARABOLIC) -> SolidCheck:
    """The check of the solid pair with tip reliefs of this shape, which looks for extremes at one more position each."""
    pinion, wheel = (
        replace(gear, modification=replace(gear.modification, tip_relief_shape=shape)) for gear in SOLID_PAIR.gears
    )
    pair = replace(SOLID_PAIR, pinion=pinion, wheel=wheel)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gearcad.contact.shared.loaded._MOST", 1)
        found = check_pair(check_task(pair, STEEL, Load(torque=torque), COARSE))
    assert isinstance(found, SolidCheck)
    return found


@pytest.fixture(scope="module")
def result() -> SolidCheck:
    return coarse_check(SOLID_TORQUE)


def test_a_helical_pair_with_a_ring_is_checked_like_any_other(result: SolidCheck) -> None:
    assert CheckOptions().model_for(SOLID_PAIR).value == "3d"
    gates = {each.quantity: each for each in result.comparisons if each.role is ComparisonRole.GATE}
    reaction = gates["torque reaction of the wheel"]
    assert reaction.passed and reaction.reference == pytest.approx(SOLID_TORQUE * 70 / 22, rel=1e-12)
    assert gates["torque reaction of the pinion"].passed
    assert result.bodies["wheel"] == "3 teeth with fixed cuts, held on diameter 175 mm"
    told = {notice.code for notice in result.notices}
    assert not told & {"no-rim", "no-bore", "rigid-rim", "conformal-contact", "thin-rim"}
    depths = result.explanations.stiffness.rim_depths
    assert depths.wheel == pytest.approx((175 - abs(SOLID_PAIR.wheel.root_diameter)) / 2 / 2.0, rel=1e-9)


def test_loads_of_lines_add_up(result: SolidCheck) -> None:
    """In check.json too: what all lines carry is the normal force, and their places on the ring are signed."""
    force = (
        SOLID_TORQUE * 1000 / (SOLID_PAIR.pinion.base_diameter / 2) / math.cos(math.radians(SOLID_PAIR.pinion.base_helix_angle))
    )
    form = SOLID_PAIR.wheel.flank_form
    documents = json.loads(json.dumps(result.own_document))["load_distribution"]
    for lines, position in zip(documents, result.cycle.positions, strict=True):
        # Each line by its lever, which is that of the base circle but where the edge of the pinion's tip touches.
        levers = {contact.tooth: contact.arms.pinion for contact in position.contacts}
        carried = sum(np.dot(line["line_load"], line["length"]) * levers[line["tooth"]] for line in lines)
        assert carried == pytest.approx(force, rel=1e-6)
        for line in lines:
            touching = np.array(line["pinion_roll_length"]) + np.array(line["wheel_roll_length"])
            on_flank = touching[~np.array(line["on_edge"])]
            assert on_flank == pytest.approx(np.full(len(on_flank), SOLID_PAIR.base_tangent.length), rel=1e-9)
            assert form.first - 1e-9 < min(line["wheel_roll_length"]) and max(line["wheel_roll_length"]) < form.last + 1e-9


def test_its_stress_is_written_and_drawn_as_the_ring_stands(result: SolidCheck, tmp_path: Path) -> None:
    result.stress_files["stress_wheel.vtu"](tmp_path / "ring.vtu")
    points = meshio.read(tmp_path / "ring.vtu").points
    radii = np.hypot(points[:, 0], points[:, 1])
    profile = SOLID_PAIR.wheel.profile
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


@pytest.mark.parametrize("shape", [ReliefShape.PARABOLIC, pytest.param(ReliefShape.LINEAR, marks=pytest.mark.long)])
def test_right_flanks_carry_as_left_ones_do(shape: ReliefShape, request: pytest.FixtureRequest) -> None:
    """A pair whose middles stand in one plane is the image of that of the other hand, seen from the other end."""
    plain = shape is ReliefShape.PARABOLIC
    result = request.getfixturevalue("result") if plain else coarse_check(SOLID_TORQUE, shape)
    other = coarse_check(-SOLID_TORQUE, shape)
    assert other.summary.mesh_stiffness_mean == pytest.approx(result.summary.mesh_stiffness_mean, rel=1e-6)
    assert other.summary.root_tension == pytest.approx(tuple(result.summary.root_tension), rel=1e-5)
    assert other.cycle.load_along_face[1] == pytest.approx(result.cycle.load_along_face[1][::-1], rel=1e-4)


def test_method_c_minds_which_flank_of_the_ring_carries() -> None:
    """What takes the ring's flank back above is what misalignment does, and a helix modification of the pinion undoes it."""
    for torque in (SOLID_TORQUE, -SOLID_TORQUE):
        for hand in (15.0, -15.0, 0.0):
            pinion, wheel = (replace(gear, helix_angle=hand) for gear in SOLID_PAIR.gears)
            changed = replace(SOLID_PAIR.wheel.modification, helix_angle_modification=10.0)
            plain = replace(SOLID_PAIR, pinion=pinion, wheel=wheel)
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
        check_pair(check_task(SOLID_PAIR, STEEL, Load(torque=SOLID_TORQUE), options))


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

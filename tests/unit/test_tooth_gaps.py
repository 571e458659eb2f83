"""Gaps between teeth and contacts of a pair in mesh, against turned profiles, outlines and points of both surfaces."""

import math
import random
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.clearance import turn_to_touch
from support.dense_contact import distance_in_space, gap_along_action, middle_height, pinion_points, taken_back, wheel_points

from gearcad import BasicRack, Body, FlankModification, Gear, GearcadError, GearPair, Mounting, ReliefShape, ShaperCutter
from gearcad.contact.plane.pair import contact_pairs
from gearcad.contact.shared.line_of_action import line_of_action, nearest
from gearcad.core.records import Floats, PerGear, Role
from gearcad.dynamics.tooth_errors.tooth_springs import ToothPath, pair_path, standard_path
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.interference import RollingEdge, deepest_cut, tip_edges
from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.bodies.body_mesh import contacts, posed, poses

POINTS = 100_001
"""Of a profile: chords of 0.1 µm on flanks of 10 mm, 1e-9 mm off the curve."""

SAME_MICROMETRES = 2e-3
"""What the interpolation of turned profiles leaves, of gaps up to a millimetre."""


def _pair(wheel: int, shift: float = 0.3, **more: Any) -> GearPair:
    sizes = {"normal_module": 3.0, "face_width": 10.0, "tooth_thinning": 0.05}
    pinion = Gear(teeth=18, profile_shift=shift, **sizes, **more)  # type: ignore[arg-type]
    return GearPair(pinion=pinion, wheel=Gear(teeth=wheel, **sizes))  # type: ignore[arg-type]


def _angles(base: float, contact: float, length: Floats) -> tuple[Floats, Floats]:
    """Radius and polar angle of an involute that touches at `contact`, from the base tangent point on, by inv = tan - arc."""
    roll = length / base
    return np.hypot(base, length), contact / base - (roll - np.arctan(roll))


def _brute_gap(path: ToothPath, place: float) -> float:
    """Gap (µm) by turning the wheel about its axis until its profile meets that of the pinion, at a place from T1 (mm)."""
    pinion, wheel = path.flanks
    radius, angle = _angles(pinion.base_radius, place, np.linspace(pinion.first, pinion.last, POINTS))
    x, up = radius * np.sin(angle), radius * np.cos(angle) - pinion.base_radius
    ring = wheel.base_radius < 0
    base, side = abs(wheel.base_radius), -1.0 if ring else 1.0
    # Seen from the wheel's axis, from the line to its base tangent point on.
    x, up = side * (path.whole - x), (side * (wheel.base_radius - up)) if not ring else up - wheel.base_radius
    seen_radius, seen_angle = np.hypot(x, up), np.arctan2(x, up)
    contact = side * (path.whole - place)
    own_radius, own_angle = _angles(base, contact, np.sort(np.abs(np.linspace(wheel.first, wheel.last, POINTS))))
    order = np.argsort(seen_radius)
    low, high = max(own_radius.min(), seen_radius.min()), min(own_radius.max(), seen_radius.max())
    radii = np.linspace(low, high, POINTS)
    apart = np.interp(radii, seen_radius[order], seen_angle[order]) - np.interp(radii, own_radius, own_angle)
    return float(1000 * base * (side * apart).min())


@pytest.mark.parametrize("teeth", [48, 18, -70])
@pytest.mark.parametrize("beyond", [0.02, 0.1, 0.3])
def test_gap_beyond_the_path_is_that_of_turned_profiles(teeth: int, beyond: float) -> None:
    path = pair_path(_pair(teeth))
    half = path.contact_ratio / 2
    for place in (-half - beyond, half + beyond):
        found = float(path.gaps(np.array([place]))[0])
        assert found == pytest.approx(_brute_gap(path, path.middle + place * path.pitch), abs=SAME_MICROMETRES)
        assert found > 0.01


def test_exact_flanks_touch_all_along_their_path() -> None:
    path = pair_path(_pair(48))
    inside = np.linspace(-0.5, 0.5, 101) * path.contact_ratio
    assert np.abs(path.gaps(inside)).max() < 1e-8


def test_near_the_path_it_is_the_gap_of_the_contact_model() -> None:
    """That looks along the line of action, by a parabola: the same to second order."""
    pair = _pair(48)
    line, path = line_of_action(pair), pair_path(pair)
    place = path.first - 0.02 * path.pitch
    along = nearest(line, 0, place)
    assert along is not None
    assert float(path.gaps((np.array([place]) - path.middle) / path.pitch)[0]) == pytest.approx(1000 * along[0], rel=0.06)


def test_tip_relief_opens_the_gap_where_it_is() -> None:
    """By the contact model, which looks for the nearest points of the modified flanks along the line of action."""
    relieved = _pair(48, modification=FlankModification(tip_relief=20.0, tip_relief_length=1.5))
    line, path = line_of_action(relieved), pair_path(relieved)
    ends = path.contact_ratio / 2 + np.array([-0.4, 0.0, 0.05])
    along = [nearest(line, 0, path.middle + place * path.pitch) for place in ends.tolist()]
    found = path.gaps(ends)
    assert found == pytest.approx([1000 * each[0] for each in along if each is not None], rel=0.03, abs=1e-3)
    # Less than the relief: just below it the flanks are still near.
    assert 8.0 < found[1] < 20.0


@pytest.mark.parametrize(
    ("radii", "teeth", "ratio"), [((50.7, 135.3), 18, 1.6), ((50.0, -150.0), 20, 1.8), ((40.0, 40.0), 40, 1.2)]
)
def test_assumed_teeth_have_the_contact_ratio_and_equal_addenda(radii: tuple[float, float], teeth: int, ratio: float) -> None:
    path = standard_path(PerGear(*radii), teeth, ratio)
    assert path is not None
    assert path.contact_ratio == pytest.approx(ratio, rel=1e-12)
    one, other = (abs(each) / math.cos(math.radians(20)) for each in radii)
    tips = math.hypot(radii[0], path.last) - one, math.hypot(radii[1], path.whole - path.first) - other
    assert tips[0] == pytest.approx(math.copysign(1, radii[1]) * tips[1], abs=1e-9)


def test_no_assumed_teeth_have_a_path_longer_than_their_line_of_action() -> None:
    assert standard_path(PerGear(50.0, 50.0), 8, 1.6) is None


ALL = FlankModification(
    tip_relief=18.0,
    tip_relief_length=1.5,
    tip_relief_shape=ReliefShape.PARABOLIC,
    root_relief=9.0,
    root_relief_length=0.8,
    profile_crowning=3.0,
    pressure_angle_modification=-4.0,
    lead_crowning=6.0,
    end_relief=11.0,
    end_relief_length=3.0,
    helix_angle_modification=7.0,
    twist=8.0,
)


def pair(helix: float = 0.0, modification: FlankModification | None = None, offset: float = 0.0) -> GearPair:
    of = modification or FlankModification()
    return GearPair(
        pinion=Gear(teeth=19, normal_module=2.0, face_width=18.0, helix_angle=helix, profile_shift=0.3, modification=of),
        wheel=Gear(teeth=37, normal_module=2.0, face_width=14.0, helix_angle=-helix, modification=of),
        axial_offset=offset,
    )


@pytest.mark.parametrize("helix", [0.0, 20.0, -20.0])
def test_exact_flanks_touch_along_the_line_of_contact(helix: float) -> None:
    """And open as s^2/(2 rho) beside it; on the teeth before and behind, too."""
    made = pair(helix, offset=1.0)
    heights = middle_height(made) + np.array([-3.0, 0.0, 2.0])
    length, lean = made.path_of_contact.C, math.tan(math.radians(made.pinion.base_helix_angle))
    gap = gap_along_action(made, Mounting(), length, 0, heights, np.array([0.0, 0.05, -0.05]))
    assert gap[:, 0] == pytest.approx([0, 0, 0], abs=1e-8)
    whole = line_of_action(made).whole
    for row, z in enumerate(heights):
        contact = length + (z - middle_height(made)) * lean
        assert gap[row, 1:].mean() == pytest.approx(0.05**2 * whole / 2 / contact / (whole - contact), rel=2e-3)


@pytest.mark.parametrize("helix", [20.0, -20.0])
def test_points_turn_with_the_hand_of_the_gear(helix: float) -> None:
    """One roll length at all heights is a screw line: its polar angle grows by tan(beta) z/r, less on the other hand."""
    made = pair(helix)
    heights = np.array([0.0, 9.0, 18.0])
    for gear, sense, points in ((made.pinion, 1, pinion_points), (made.wheel, -1, wheel_points)):
        found = points(made, Mounting(), made.path_of_contact.C, 0, np.full(3, 9.0), heights)
        axis = np.array([0.0, 0.0]) if sense == 1 else np.array([sum(_bases(made)), line_of_action(made).whole])
        angle = np.unwrap(np.arctan2(*(found[:, :2] - axis).T[::-1]))
        turn = 2 * math.pi * heights / gear.lead * math.copysign(1, gear.helix_angle)
        assert angle - angle[0] == pytest.approx(turn, abs=1e-9)


def _bases(made: GearPair) -> tuple[float, float]:
    return made.pinion.base_diameter / 2, made.wheel.base_diameter / 2


@pytest.mark.parametrize("helix", [0.0, 25.0, -25.0])
def test_depths_agree_with_those_of_the_product(helix: float) -> None:
    """Two ways of writing the same standard; every term is there."""
    for gear in (pair(helix, ALL).pinion, pair(helix, ALL).wheel):
        form = gear.flank_form
        lengths, heights = np.linspace(form.first, form.last, 41)[:, None], np.linspace(0, gear.face_width, 31)
        assert taken_back(gear, lengths, heights) == pytest.approx(form.depth(lengths, heights), abs=1e-12)


def test_displacements_come_out_as_they_are_meant() -> None:
    """Misalignment opens towards larger z by all of it over the common width; a proud tooth closes; across hardly counts."""
    made = pair(15.0)
    middle, half = middle_height(made), made.common_width.width / 2
    heights, places = middle + np.array([-half, 0.0, half]), np.array([0.0])
    length = made.path_of_contact.C
    for mounting, expected in (
        (Mounting(misalignment=20.0), [-0.010, 0.0, 0.010]),
        (Mounting(pinion_pitch_error=4.0, wheel_pitch_error=3.0), [-0.007] * 3),
        (Mounting(misalignment_across=20.0), [0.0] * 3),
    ):
        gap = gap_along_action(made, mounting, length, 0, heights, places)[:, 0]
        assert gap == pytest.approx(expected, abs=2e-5)
    early = made.path_of_contact.A + 0.3
    other = gap_along_action(made, Mounting(pinion_pitch_error=4.0), early, 1, heights[1:2], places)
    assert other[0, 0] == pytest.approx(0, abs=1e-8)


def test_across_moves_the_parabola_of_the_gap() -> None:
    """A wheel moved along the tangent takes its flank with it: the gap is no longer least at the same place."""
    made = pair()
    top = np.array([middle_height(made) + made.common_width.width / 2])
    places, length = np.linspace(-0.2, 0.2, 401), made.path_of_contact.C
    gap = gap_along_action(made, Mounting(misalignment_across=80.0), length, 0, top, places)[0]
    # Curvatures 1/L1 of the pinion at 0 and 1/L2 of the wheel at 0.04 mm: in between by their weights.
    whole = line_of_action(made).whole
    assert places[gap.argmin()] == pytest.approx(0.04 * length / whole, abs=2e-3)


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_the_plane_gap_agrees(part: float) -> None:
    """Of spur gears, in the middle of the common face width: the depths over the curves, to 0.01 µm."""
    made = pair(0.0, ALL, offset=3.0)
    path = made.path_of_contact
    length = path.A + part * (path.E - path.A)
    mounting = Mounting(misalignment=15.0)
    found = contact_pairs(line_of_action(made), length, lambda *_: 0.15, 40, 0.1)
    (middle,) = [each for each in found if each.tooth == 0]
    cells = middle.cells
    witness = gap_along_action(made, mounting, length, 0, np.array([middle_height(made)]), cells.place)[0]
    mean = cells.width**2 / 24 * (1 / middle.lengths.pinion + 1 / middle.lengths.wheel)
    assert cells.gap - mean == pytest.approx(witness, abs=1e-5)


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_distance_in_space_is_the_gap_seen_square(helix: float) -> None:
    """The flank's normal leans by the base helix angle against the transverse section."""
    made = replace(pair(helix), axial_offset=0.5)
    mounting = Mounting(misalignment=20.0, pinion_pitch_error=-12.0)
    height = middle_height(made) + 3.0
    lean = math.tan(math.radians(made.pinion.base_helix_angle))
    contact = made.path_of_contact.C + 3.0 * lean
    gap = gap_along_action(made, mounting, made.path_of_contact.C, 0, np.array([height]), np.array([0.0]))[0, 0]
    distance = distance_in_space(made, mounting, made.path_of_contact.C, 0, contact, height)
    assert gap > 0.01
    assert distance == pytest.approx(gap * math.cos(math.radians(made.pinion.base_helix_angle)), rel=2e-3)


COUNT = 60


def gear(chance: random.Random, teeth: int, helix: float) -> Gear:
    given: dict[str, Any] = {"teeth": teeth, "normal_module": 1.0, "face_width": 8.0, "helix_angle": helix}
    given["profile_shift"] = chance.choice([0.0, round(chance.uniform(-0.3, 0.7), 2)])
    given["body"] = Body(tip_chamfer=chance.choice([0.0, 0.05]))
    given["rack"] = BasicRack(root_radius=chance.choice([0.0, 0.2, 0.38, "full"]), addendum=chance.choice([1.0, 1.1]))
    given["cutter"] = ShaperCutter(teeth=chance.choice([None, None, 25]))
    return Gear(**given)


def pairs() -> list[GearPair]:
    chance, found = random.Random(4), list[GearPair]()
    while len(found) < COUNT:
        helix = chance.choice([0.0, 15.0, 30.0])
        try:
            both = gear(chance, chance.randint(8, 60), helix), gear(chance, chance.randint(12, 120), -helix)
            found.append(GearPair(pinion=both[0], wheel=both[1]))
        except GearcadError:
            continue
    return found


def test_edge_that_bounds_keep_off_the_fillet_is_beside_it_everywhere() -> None:
    sure, unsure, cuts = 0, 0, 0
    for pair in pairs():
        for role in Role:
            own, mate = pair.gears.pick(role).profile, pair.gears.pick(role.mate).profile
            for radius, angle in tip_edges(mate):
                edge = RollingEdge.of(own, mate, radius, angle, pair.centre_distance, pair.working_transverse_pressure_angle)
                if edge is None or own.undercut:
                    continue
                depth = deepest_cut(own, edge.path, edge.farthest).depth
                if edge.stays_off(own.fillet):
                    sure += 1
                    assert depth < 0
                else:
                    unsure += 1
                    cuts += depth > 0
    assert sure > 2 * unsure > 0 and cuts > 0


TOUCHING = 1e-9
"""rad: what the search for the touching turn leaves."""

NEAR = 2e-3
"""mm: twice the spacing of points; with it flanks that touch have some, others of these pairs have none."""

MIDDLE = 0.04
"""mm of roll: how far the middle of the points that are near may be off, by their curvature and spacing."""

NEAR = 2e-3
"""mm: twice the spacing of points; with it flanks that touch have some, others of these pairs have none."""

MIDDLE = 0.04
"""mm of roll: how far the middle of the points that are near may be off, by their curvature and spacing."""


def _posed_pair(
    teeth: tuple[int, int], helix: float = 0.0, shifts: tuple[float, float] = (0.0, 0.0), **changes: float
) -> GearPair:
    pinion, wheel = (
        Gear(teeth=z, normal_module=2.0, face_width=b, helix_angle=sense * helix, profile_shift=x, tooth_thinning=thinning)
        for z, b, sense, x, thinning in zip(teeth, (20.0, 14.0), (1, -1), shifts, (0.03, 0.11), strict=True)
    )
    return GearPair(pinion=pinion, wheel=wheel, **changes)


PAIRS = {
    "spur": _posed_pair((17, 31)),
    "shifted": _posed_pair((13, 44), shifts=(0.4, -0.2), axial_offset=4.0),
    "helical": _posed_pair((20, 33), helix=28.0, shifts=(0.2, 0.1), axial_offset=-2.5),
    "left hand": _posed_pair((24, 20), helix=-17.0),
}


@pytest.mark.parametrize("left", [True, False])
@pytest.mark.parametrize("roll_angle", [-6.0, pytest.param(0.0, marks=pytest.mark.long), 4.3])
@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
def test_flanks_of_posed_gears_touch(pair: GearPair, roll_angle: float, left: bool) -> None:
    place = poses(pair, roll_angle, solid=True, left=left)
    free = pair.wheel_pose(place.pinion.rotation)
    side = 1 if left else -1
    turn = math.radians(place.wheel.rotation - free.rotation) - side * turn_to_touch(pair, place.pinion.rotation, side)
    assert math.remainder(turn, 2 * math.pi / pair.wheel.teeth) == pytest.approx(0, abs=TOUCHING)
    assert place.wheel[1:] == free[1:]


def _outline(gear: Gear, z: float) -> ElementMesh:
    """Flanks of all teeth as points in the section at z, dense; no elements."""
    curve = next(curve for curve in gear.profile.curves if curve.kind is CurveKind.INVOLUTE)
    flank = curve.points(np.linspace(0, 1, 4001))
    tooth = np.concatenate([flank, flank * [1, -1]])
    lead = math.copysign(gear.lead, gear.helix_angle) if gear.helix_angle else math.inf
    turns = 2 * math.pi * (np.arange(gear.teeth) / gear.teeth + z / lead)
    points = np.concatenate([tooth @ np.array([[math.cos(t), math.sin(t)], [-math.sin(t), math.cos(t)]]) for t in turns])
    points = np.c_[points, np.full(len(points), z)]
    none = Faces(np.empty(0, np.int32), np.empty(0, np.int8))
    return ElementMesh(Element.HEX8, points, np.arange(8, dtype=np.int32)[None], {"gear": slice(0, 1)}, {"bore": none})


def _touching(pair: GearPair, mesh: ElementMesh) -> PerGear[dict[int, float]]:
    """Teeth, and the roll lengths in the middle of what comes within NEAR of a tooth of the mate."""
    split = len(mesh.points) * pair.pinion.teeth // (pair.pinion.teeth + pair.wheel.teeth)
    flat = PerGear(mesh.points[:split, :2], mesh.points[split:, :2])

    def teeth(role: Role) -> dict[int, float]:
        gear = pair.gears.pick(role)
        apart, _ = cKDTree(flat.pick(role.mate)).query(flat.pick(role), distance_upper_bound=NEAR)
        away = flat.pick(role) - ([0, 0] if role is Role.PINION else [pair.centre_distance, 0])
        lengths = np.sqrt((away**2).sum(-1) - gear.base_diameter**2 / 4 + 1e-9).reshape(gear.teeth, -1)
        near = np.isfinite(apart).reshape(lengths.shape)
        return {tooth: float(lengths[tooth][near[tooth]].mean()) for tooth in np.flatnonzero(near.any(1)).tolist()}

    return PerGear.each(teeth)


@pytest.mark.parametrize("left", [True, False])
@pytest.mark.parametrize("roll_angle", [-8.5, 0.5])
@pytest.mark.parametrize("name", ["shifted", "helical"])
def test_pairs_of_teeth_touch_where_contacts_says(name: str, roll_angle: float, left: bool) -> None:
    pair = PAIRS[name]
    height = pair.pinion.face_width / 2 + pair.common_width.offset
    for away in (0.0, 1.5):  # from the middle of the common face width: there helical teeth touch as at another roll angle
        z = PerGear(height + away, height + away + (pair.wheel.face_width - pair.pinion.face_width) / 2 - pair.axial_offset)
        mesh = posed(pair, PerGear(*map(_outline, pair.gears, z)), roll_angle, left=left)
        assert np.ptp(mesh.points[:, 2]) == pytest.approx(0, abs=1e-12)
        turned = math.degrees(2 * away * math.tan(math.radians(pair.pinion.helix_angle)) / pair.pinion.reference_diameter)
        expected = contacts(pair, roll_angle + (turned if left else -turned), left=left)
        for role, found in _touching(pair, mesh).items():
            teeth = pair.gears.pick(role).teeth
            assert {math.remainder(tooth, teeth): length for tooth, length in found.items()} == pytest.approx(
                expected.pick(role), abs=MIDDLE
            )


def test_contacts_beyond_the_path_are_at_the_ends_of_flanks() -> None:
    pair = PAIRS["spur"]
    first, _ = pair.usable_path
    angle = math.degrees((first - pair.path_of_contact.C - 0.01) / (pair.pinion.base_diameter / 2))
    assert 0 not in contacts(pair, angle).pinion
    both = contacts(pair, angle, beyond=0.02)
    assert both.pinion[0] == pytest.approx(first)
    assert both.wheel[0] == pytest.approx(math.sqrt(pair.wheel.tip_form_diameter**2 - pair.wheel.base_diameter**2) / 2)


def test_an_approach_turns_the_pinion_into_the_wheel() -> None:
    pair = PAIRS["helical"]
    near, far = (poses(pair, 2.0, approach, solid=True).pinion.rotation for approach in (0.005, 0.0))
    assert math.radians(near - far) * pair.pinion.base_diameter / 2 == pytest.approx(0.005)
    assert poses(pair, 2.0, 0.005, solid=True).wheel == poses(pair, 2.0, solid=True).wheel


def test_sections_are_not_turned_by_the_helix() -> None:
    pair = PAIRS["helical"]
    flat = poses(pair, 2.0, solid=False)
    spur = replace(pair, axial_offset=0.0)
    assert flat == poses(spur, 2.0, solid=False)
    assert flat.wheel.z == 0.0

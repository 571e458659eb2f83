"""A pair in mesh: flanks touch, where `contacts` says, by outlines that know no formula for it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from support.clearance import turn_to_touch

from gearcad import Gear, GearPair
from gearcad.core.records import PerGear, Role
from gearcad.geometry.profile import CurveKind
from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.bodies.body_mesh import contacts, posed, poses

Floats = NDArray[np.float64]

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


def _pair(teeth: tuple[int, int], helix: float = 0.0, shifts: tuple[float, float] = (0.0, 0.0), **changes: float) -> GearPair:
    pinion, wheel = (
        Gear(teeth=z, normal_module=2.0, face_width=b, helix_angle=sense * helix, profile_shift=x, tooth_thinning=thinning)
        for z, b, sense, x, thinning in zip(teeth, (20.0, 14.0), (1, -1), shifts, (0.03, 0.11), strict=True)
    )
    return GearPair(pinion=pinion, wheel=wheel, **changes)


PAIRS = {
    "spur": _pair((17, 31)),
    "shifted": _pair((13, 44), shifts=(0.4, -0.2), axial_offset=4.0),
    "helical": _pair((20, 33), helix=28.0, shifts=(0.2, 0.1), axial_offset=-2.5),
    "left hand": _pair((24, 20), helix=-17.0),
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

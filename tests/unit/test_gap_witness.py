"""The witness of the gap is itself right: exact flanks touch, parabolas open, displacements come out, the plane gap agrees."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.gap import distance_in_space, gap_along_action, middle_height, pinion_points, taken_back, wheel_points

from gearcad import FlankModification, Gear, GearPair, Mounting, ReliefShape
from gearcad.contact.plane.pair import contact_pairs
from gearcad.contact.shared.line_of_action import line_of_action

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

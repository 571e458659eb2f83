"""Views of external gears: what ISO 2203 says of them, sizes at scale, and the hand of the teeth as the solid has it."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from gearcad import Body, Gear
from gearcad.drawing.gear_views import Along, end_face, half_section
from gearcad.drawing.shapes import Circle, Figure, Hatching, Line, Pen, Polyline
from gearcad.geometry import DoubleHelix
from gearcad.geometry.body import HubSide
from gearcad.solids import tessellate

SCALE = 0.5

BODY = Body(
    bore=20.0, keyway_width=6.0, keyway_depth=2.8, hub_diameter=34.0, hub_length=8.0, end_chamfer=1.5, end_chamfer_angle=30.0
)
GEAR = Gear(teeth=30, normal_module=2.5, face_width=25.0, helix_angle=20.0, body=BODY)


def _flat_lines(figure: Figure, pen: Pen, *, above: bool) -> list[tuple[float, float, float]]:
    """Left end, right end and height of lines along the axis, rounded; those above the axis, or below it."""
    lines = [each for each in figure.shapes if isinstance(each, Line) and each.pen is pen and each.start[1] == each.end[1]]
    found = [(*sorted((each.start[0], each.end[0])), each.start[1]) for each in lines if (each.start[1] > 0) is above]
    return [tuple(round(value, 9) for value in line) for line in found]


def _silhouette(figure: Figure) -> Polyline:
    (found,) = (each for each in figure.shapes if isinstance(each, Polyline) and each.closed)
    return found


def _area(points: list[tuple[float, float]]) -> float:
    x, y = np.array(points).T
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


def test_half_section_has_the_sizes_of_the_gear_at_scale() -> None:
    figure = half_section(GEAR, Along.of(GEAR, SCALE))
    outline = _silhouette(figure)
    assert outline.box.width == pytest.approx(SCALE * (25 + 8))
    assert outline.box.height == pytest.approx(SCALE * GEAR.tip_diameter)
    depth = 1.5 * math.tan(math.radians(30))
    expected = 25 * GEAR.tip_diameter + 8 * 34 - 4 * 0.5 * 1.5 * depth
    assert _area(outline.points[:-1]) == pytest.approx(SCALE**2 * expected)
    left, right = -SCALE * 33 / 2, SCALE * 33 / 2
    lines = _flat_lines(figure, Pen.OUTLINE, above=True)
    wall = math.sqrt(10**2 - 3**2)
    assert sorted(lines, key=lambda each: each[2]) == [
        pytest.approx((left, right, SCALE * wall)),
        pytest.approx((left, right, SCALE * (10 + 2.8))),
        pytest.approx((left, left + SCALE * 25, SCALE * GEAR.root_diameter / 2)),
    ]


def test_teeth_are_not_hatched_and_no_root_is_drawn_outside() -> None:
    figure = half_section(GEAR, Along.of(GEAR, SCALE))
    (hatching,) = (each for each in figure.shapes if isinstance(each, Hatching))
    (edge,) = hatching.edges
    root, opening = GEAR.root_diameter / 2, 10 + 2.8
    assert _area([corner[:2] for corner in edge]) == pytest.approx(SCALE**2 * (25 * (root - opening) + 8 * (17 - opening)))
    assert max(y for _, y, _ in edge) == pytest.approx(SCALE * root)
    assert _flat_lines(figure, Pen.OUTLINE, above=False) == []
    half = GEAR.reference_diameter / 2
    for above in (True, False):
        ((start, end, height),) = [each for each in _flat_lines(figure, Pen.CENTRE, above=above) if each[2]]
        assert abs(height) == pytest.approx(SCALE * half)
        assert end - start == pytest.approx(SCALE * 25 + 6)


def test_chamfer_deeper_than_the_teeth_cuts_hatching_and_root() -> None:
    gear = Gear(teeth=30, normal_module=1.0, face_width=20.0, body=Body(end_chamfer=4.0))
    (hatching,) = (each for each in half_section(gear, Along.of(gear, 1.0)).shapes if isinstance(each, Hatching))
    root, face = gear.root_diameter / 2, gear.tip_diameter / 2 - 4.0
    assert _area([corner[:2] for corner in hatching.edges[0]]) == pytest.approx(20 * root - (root - face) ** 2)


@pytest.mark.parametrize("gap", [8.0, 0.0])
def test_edges_of_chamfers_and_grooves_are_seen_outside(gap: float) -> None:
    gear = Gear(
        teeth=30,
        normal_module=2.5,
        face_width=40.0,
        helix_angle=30.0,
        double_helix=DoubleHelix(gap_width=gap),
        body=Body(end_chamfer=1.0),
    )
    lines = [each for each in half_section(gear, Along.of(gear, 1.0)).shapes if isinstance(each, Line)]
    upright = sorted(each.start[0] + 20 for each in lines if each.start[0] == each.end[0])
    assert upright == pytest.approx([1, 15, 16, 24, 25, 39] if gap else [1, 39])
    assert all(max(each.start[1], each.end[1]) == 0 for each in lines if each.start[0] == each.end[0])


def _turns(gear: Gear) -> tuple[np.ndarray, np.ndarray]:
    """Heights of the layers of the solid's triangles, and by how much the teeth are turned there (rad), from its vertices."""
    vertices = tessellate(gear, 0.02).vertices
    x, y, z = vertices[np.hypot(vertices[:, 0], vertices[:, 1]) > gear.tip_diameter / 2 - 1e-6].T
    heights, layer = np.unique(np.round(z, 6), return_inverse=True)
    waves = np.exp(1j * gear.teeth * np.arctan2(y, x))
    phases = np.angle(np.bincount(layer, waves.real) + 1j * np.bincount(layer, waves.imag))
    return heights, np.unwrap(phases) / gear.teeth


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize(("helix_angle", "gap"), [(20.0, None), (-20.0, None), (20.0, 0.0), (-20.0, 6.0)])
def test_flanks_run_as_on_the_solid(helix_angle: float, gap: float | None, direction: int) -> None:
    gear = Gear(teeth=12, normal_module=2.0, face_width=20.0, helix_angle=helix_angle, double_helix=DoubleHelix(gap_width=gap))
    figure = half_section(gear, Along.of(gear, SCALE, direction))
    rows = [each.points for each in figure.shapes if isinstance(each, Polyline) and each.pen is Pen.THIN]
    assert len(rows) == (6 if gap else 3)
    heights, turns = _turns(gear)
    right, up = np.array([0.0, 0.0, direction]), np.array([1.0, 0.0, 0.0])
    towards = np.cross(right, up)  # the eye
    for row in rows:
        for (x, y), (end, top) in pairwise(row):
            at = np.array([x, end]) / SCALE * direction + gear.face_width / 2
            turned = np.interp(at, heights, turns)
            angles = math.atan2(towards[1], towards[0]) + turned - turned.mean()
            points = gear.reference_diameter / 2 * np.column_stack([np.cos(angles), np.sin(angles), at / 1e9])
            assert (points @ towards > 0).all()  # on the side that one sees
            seen = np.arcsin(points @ up / (gear.reference_diameter / 2)) * gear.reference_diameter / 2  # unrolled
            assert (top - y) / (end - x) == pytest.approx((seen[1] - seen[0]) / ((at[1] - at[0]) * direction), rel=0.02)


def test_spur_gears_have_no_direction() -> None:
    gear = Gear(teeth=12, normal_module=2.0, face_width=20.0)
    assert not any(
        each.pen is Pen.THIN for each in half_section(gear, Along.of(gear, 1.0)).shapes if isinstance(each, Polyline)
    )


@pytest.mark.parametrize("side", HubSide)
@pytest.mark.parametrize("front", [True, False])
def test_face_view_shows_the_end_that_one_sees(side: HubSide, front: bool) -> None:
    gear = Gear(teeth=30, normal_module=2.5, face_width=25.0, body=Body(bore=20, hub_diameter=34, hub_length=8, hub_side=side))
    circles = [each for each in end_face(gear, SCALE, front=front).shapes if isinstance(each, Circle)]
    thick = sorted(2 * each.radius / SCALE for each in circles if each.pen is Pen.OUTLINE)
    hub = [34.0] if side is HubSide.BOTH or (side is HubSide.FRONT) is front else []
    assert thick == pytest.approx([20.0, *hub, gear.tip_diameter])
    assert [2 * each.radius / SCALE for each in circles if each.pen is Pen.CENTRE] == pytest.approx([75.0])


def test_keyway_is_up_and_its_contour_is_closed() -> None:
    (opening,) = (each for each in end_face(GEAR, 1.0).shapes if isinstance(each, Polyline))
    assert opening.closed
    assert opening.box == pytest.approx((-10.0, -10.0, 10.0, 12.8))
    angle = math.asin(0.3)
    expected = math.pi * 100 - (angle - 0.3 * math.cos(angle)) * 100 + 6 * (12.8 - 10 * math.cos(angle))
    assert _area(opening.points[:-1]) == pytest.approx(expected, rel=3e-3)  # of chords

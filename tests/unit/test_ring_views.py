"""Views of rings and racks: what ISO 2203 says of them, sizes at scale, and the hand of the teeth as the solid has it."""

import math
from itertools import product
from typing import TypeVar

import numpy as np
import pytest

from gearcad.core.records import Floats
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.drawing_symbols import freehand
from gearcad.drawing.layout import dressed
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Arc, Circle, Dimension, Figure, Hatching, Line, Pen, Polyline
from gearcad.drawing.views.rack_views import (
    RackRange,
    end_section,
    front_figure,
    front_view,
    plan_figure,
    plan_view,
    teeth_between,
    tooth_middles,
)
from gearcad.drawing.views.ring_views import Meridian, end_face, face_view, full_section, hole_places, section_view
from gearcad.drawing.views.tooth_detail import detail_mark
from gearcad.drawing.words import Draughting, Language, SheetWords
from gearcad.geometry import Body, Gear, Rack
from gearcad.solids import tessellate, tessellate_rack

SCALE = 0.5
CHORD = 0.01  # mm of paper: an arc of 7.5 degrees of a fillet and its chord, where it is steep
BODY = Body(rim_diameter=170.0, bolt_circle=155.0, bolt_holes=7, bolt_diameter=6.6, end_chamfer=1.0)
RING = Gear(teeth=-66, normal_module=2.0, face_width=24.0, helix_angle=15.0, body=BODY)
BARE = Gear(teeth=-40, normal_module=3.0, face_width=20.0)
RACKS = {
    "spur": Rack(teeth=12, normal_module=2.0, face_width=20.0, height=15.0, tip_chamfer=0.15),
    "long": Rack(teeth=75, normal_module=2.0, helix_angle=-19.52808, face_width=24.0, height=22.0),
    "cut": Rack(length=163.0, normal_module=3.0, helix_angle=10.0, face_width=20.0, height=15.0),
    "one": Rack(teeth=1, normal_module=5.0, face_width=40.0, height=30.0),
    "endless": Rack(teeth=2000, normal_module=1.0, face_width=5.0, height=4.0, helix_angle=45.0),
}


def area(points: list[tuple[float, float]]) -> float:
    x, y = np.array(points).T
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


Kind = TypeVar("Kind")


def of_kind(figure: Figure, kind: type[Kind]) -> list[Kind]:
    return [each for each in figure.shapes if isinstance(each, kind)]


def demands(gear: Gear | Rack, language: Language = Language.ENGLISH) -> tuple[DrawnGear, Requirements, SheetWords]:
    drawn = DrawnGear(role="gear", gear=gear, grade=6)
    return drawn, Requirements.of(drawn, DrawingOptions(language=language)), SheetWords.of(language)


# ---------------------------------------------------------------------- rings


def test_both_sides_of_a_ring_are_cut_and_its_teeth_are_not_hatched() -> None:
    figure = full_section(Meridian(RING, SCALE))
    tip, root, rim, width = abs(RING.tip_diameter) / 2, abs(RING.root_diameter) / 2, 85.0, 24.0
    outlines = [each for each in of_kind(figure, Polyline) if each.closed]
    expected = SCALE**2 * (width * (rim - tip) - 1.0)  # two chamfers of 1 by 1 mm
    assert [area(each.points[:-1]) for each in outlines] == pytest.approx([expected, expected])
    cut = sum(area([corner[:2] for corner in each.edges[0]]) for each in of_kind(figure, Hatching))
    assert cut == pytest.approx(SCALE**2 * 2 * width * (rim - root - 6.6))
    thick = {round(abs(each.start[1]), 9) for each in of_kind(figure, Line) if each.pen is Pen.OUTLINE}
    assert {round(SCALE * radius, 9) for radius in (root, tip, tip + 1.0, 77.5 - 3.3, 77.5 + 3.3)} == thick
    centre = {round(abs(each.start[1]), 9) for each in of_kind(figure, Line) if each.pen is Pen.CENTRE}
    assert centre == {0.0, 38.75, round(SCALE * abs(RING.reference_diameter) / 2, 9)}


@pytest.mark.parametrize("count", [4, 6, 7, 8, 12, 24])
def test_the_ring_round_the_enlarged_tooth_is_off_the_bolt_holes(count: int) -> None:
    body = Body(rim_diameter=240.0, bolt_circle=222.0, bolt_holes=count, bolt_diameter=9.0)
    gear = Gear(teeth=-70, normal_module=2.8, face_width=14.0, profile_shift=-1.2025, body=body)
    ring = next(iter(of_kind(next(iter(detail_mark(demands(gear)[0], Figure(()), SCALE))), Circle)))
    apart = min(math.dist(ring.centre, place) for place in hole_places(Meridian(gear, SCALE)))
    assert apart > ring.radius + SCALE * 9.0 / 2


def test_a_chamfer_deeper_than_the_teeth_cuts_the_root() -> None:
    ring = Gear(teeth=-60, normal_module=1.0, face_width=20.0, body=Body(rim_diameter=90.0, end_chamfer=4.0))
    hatchings = of_kind(full_section(Meridian(ring, 1.0)), Hatching)
    root, face = abs(ring.root_diameter) / 2, abs(ring.tip_diameter) / 2 + 4.0
    assert area([corner[:2] for corner in hatchings[0].edges[0]]) == pytest.approx(20 * (45 - root) - (face - root) ** 2)


def test_face_of_a_ring_has_its_circles_and_a_hole_up() -> None:
    ring = Meridian(RING, SCALE)
    circles = of_kind(end_face(ring), Circle)
    thick = sorted(each.radius for each in circles if each.pen is Pen.OUTLINE and each.centre == (0.0, 0.0))
    assert thick == pytest.approx([SCALE * abs(RING.tip_diameter) / 2, SCALE * (abs(RING.tip_diameter) / 2 + 1), SCALE * 85])
    assert [each.radius for each in circles if each.pen is Pen.CENTRE] == pytest.approx(
        [SCALE * abs(RING.reference_diameter) / 2]
    )
    arcs = of_kind(end_face(ring), Arc)  # from hole to hole: dashes begin there
    assert [each.radius for each in arcs] == pytest.approx(7 * [SCALE * 77.5])
    assert sorted(each.start % 360 for each in arcs) == pytest.approx(sorted((90 + 360 * k / 7) % 360 for k in range(7)))
    holes = [each for each in circles if each.radius == pytest.approx(SCALE * 3.3)]
    assert len(holes) == 7 and hole_places(ring)[0] == pytest.approx((0.0, 38.75))


def test_a_ring_without_a_rim_ends_in_a_freehand_line() -> None:
    ring = Meridian(BARE, SCALE)
    assert not any(each.closed for each in of_kind(full_section(ring), Polyline))
    assert any(each.closed and each.pen is Pen.THIN for each in of_kind(end_face(ring), Polyline))
    view = dressed(section_view(*demands(BARE)[:2], Draughting(SheetWords.of(Language.GERMAN), SCALE)))
    assert view is not None and "Außenform nicht festgelegt" in [text.words for text in view.texts]


def test_a_freehand_line_far_larger_than_paper_has_few_waves() -> None:
    """A ring of 17 m at 50:1, as where a scale is looked for: some 660 000 waves of 4 mm."""
    line = freehand([(0.0, 0.0), (1e6, 0.0), (1e6, 1e6)], closed=True)
    assert 500 < len(line.vertices) <= 1001


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("helix_angle", [20.0, -20.0])
def test_flanks_of_a_ring_run_as_on_its_solid(helix_angle: float, direction: int) -> None:
    """The far side of the opening: where the solid's teeth that are level with the axis at mid face width go from there."""
    ring = Gear(teeth=-40, normal_module=2.0, face_width=20.0, helix_angle=helix_angle, body=Body(rim_diameter=110.0))
    rows = [each.points for each in of_kind(full_section(Meridian(ring, SCALE, direction)), Polyline) if each.pen is Pen.THIN]
    vertices = tessellate(ring, 0.02).vertices
    x, y, z = vertices[np.hypot(vertices[:, 0], vertices[:, 1]) < abs(ring.tip_diameter) / 2 + 1e-6].T
    heights, layer = np.unique(np.round(z, 6), return_inverse=True)
    waves = np.exp(1j * 40 * np.arctan2(y, x))
    turns = np.unwrap(np.angle(np.bincount(layer, waves.real) + 1j * np.bincount(layer, waves.imag))) / 40
    right, up = np.array([0.0, 0.0, direction]), np.array([1.0, 0.0, 0.0])
    eye = np.cross(right, up)
    for row in rows:
        (left, low), (end, high) = row
        at = np.array([left, end]) / SCALE * direction + 10.0
        turned = np.interp(at, heights, turns)
        angles = math.atan2(-eye[1], -eye[0]) + turned - turned.mean()  # away from the eye
        rise = abs(ring.reference_diameter) / 2 * np.sin(angles - math.atan2(up[1], up[0]) + math.pi / 2)
        assert (high - low) / (end - left) == pytest.approx((rise[1] - rise[0]) / ((at[1] - at[0]) * direction), rel=0.02)
    assert len(rows) == 3


# ---------------------------------------------------------------------- racks


def heights_of(vertices: Floats, z: float) -> tuple[Floats, Floats]:
    """x and y of the solid's vertices in an end face, above its back."""
    face = vertices[np.abs(vertices[:, 2] - z) < 1e-9]
    face = face[face[:, 1] > face[:, 1].min() + 1e-6]
    return face[:, 0], face[:, 1]


@pytest.mark.parametrize("name", [name for name in RACKS if name != "endless"])
def test_teeth_of_a_rack_are_those_of_the_solid_at_the_end_that_one_sees(name: str) -> None:
    rack = RACKS[name]
    span = RackRange(rack, SCALE)
    x, y = heights_of(tessellate_rack(rack, 1e-3).vertices, rack.face_width)
    outlines = [each for each in of_kind(front_figure(span), Polyline) if each.pen is Pen.OUTLINE]
    for (low, high), outline in zip(span.toothed, outlines, strict=True):
        near = (x > low + 1e-6) & (x < high - 1e-6)
        paper = np.array([[span.across(place) for place in x[near]], SCALE * y[near]]).T
        points = np.array([point for point in outline.points if point[1] > -SCALE * rack.height + 1e-6])
        assert np.interp(paper[:, 0], *points.T) == pytest.approx(paper[:, 1], abs=CHORD)


@pytest.mark.parametrize("name", ["long", "cut", "endless"])
def test_teeth_run_from_above_as_their_drift(name: str) -> None:
    rack = RACKS[name]
    lines = [each for each in of_kind(plan_figure(RackRange(rack, SCALE)), Line) if each.pen is Pen.THIN]
    assert len(lines) == 3
    for line in lines:
        (x, y), (end, low) = line.start, line.end  # y up is towards z = 0
        assert (end - x) / (y - low) == pytest.approx(-math.tan(math.radians(rack.helix_angle)))


@pytest.mark.parametrize("name", ["long", "cut"])
def test_teeth_run_from_above_as_on_the_solid(name: str) -> None:
    """By how much the tips at the two ends of the solid are apart, whole pitches aside."""
    rack = RACKS[name]
    vertices = tessellate_rack(rack, 0.01).vertices
    tips = vertices[vertices[:, 1] > rack.tip_height - 1e-6]
    turns = [
        np.exp(2j * math.pi * tips[np.abs(tips[:, 2] - z) < 1e-9, 0] / rack.transverse_pitch).sum()
        for z in (0.0, rack.face_width)
    ]
    line = next(each for each in of_kind(plan_figure(RackRange(rack, SCALE)), Line) if each.pen is Pen.THIN)
    (x, y), (end, low) = line.start, line.end
    drawn = (end - x) / (y - low) * rack.face_width / rack.transverse_pitch
    solid = float(np.angle(turns[1] / turns[0])) / (2 * math.pi)
    assert (drawn - solid + 0.5) % 1.0 - 0.5 == pytest.approx(0.0, abs=0.05)
    assert abs((-drawn - solid + 0.5) % 1.0 - 0.5) > 0.1  # the other hand would be seen


def test_a_long_rack_is_broken_and_says_its_length() -> None:
    rack = RACKS["long"]
    span = RackRange(rack, 1.0)
    assert 2 * span.right == pytest.approx(6 * 24.0 + 3.0) and len(span.parts) == 2
    view = dressed(front_view(*demands(rack)[:2], Draughting(SheetWords.of(Language.ENGLISH), 1.0)))
    assert view is not None
    (length,) = [each for each in of_kind(view, Dimension) if "500" in [text.words for text in Figure.of(each).texts]]
    measured = math.dist(length.first, length.second) / (length.scale or 1.0)
    assert (length.words, measured) == ("<>", pytest.approx(500.0))
    names = sorted(text.at[1] for text in view.texts if text.words == "B")
    assert length.line[1] < names[0] and -22.0 - names[0] == pytest.approx(names[1] - 2.0)  # as far below as above
    first, second = tooth_middles(span)
    assert second - first == pytest.approx(rack.transverse_pitch)
    assert len(RackRange(RACKS["cut"], 1.0).parts) == 1


@pytest.mark.parametrize("name", RACKS)
def test_the_ring_of_the_detail_is_round_a_tooth(name: str) -> None:
    rack = RACKS[name]
    view = front_figure(RackRange(rack, SCALE))
    ring = next(iter(of_kind(next(iter(detail_mark(demands(rack)[0], view, SCALE))), Circle)))
    (outline, *_) = (each for each in of_kind(view, Polyline) if each.pen is Pen.OUTLINE)
    assert ring.centre[0] in [pytest.approx(middle) for middle in tooth_middles(RackRange(rack, SCALE)) or [0.0]]
    teeth = [x for x, y in outline.points if y > SCALE * rack.tip_height - 1e-6]
    assert min(teeth) - 1e-6 <= ring.centre[0] <= max(teeth) + 1e-6


def test_the_end_of_a_rack_is_hatched_below_its_roots() -> None:
    rack = RACKS["cut"]
    figure = end_section(*demands(rack)[:2], Draughting(SheetWords.of(Language.ENGLISH), SCALE)).figure
    (hatching,) = of_kind(figure, Hatching)
    assert area([corner[:2] for corner in hatching.edges[0]]) == pytest.approx(SCALE**2 * 20 * (15 - rack.root_depth))
    assert figure.box.top > SCALE * rack.tip_height
    assert plan_view(*demands(RACKS["spur"])[:2], Draughting(SheetWords.of(Language.ENGLISH))) is None


# ---------------------------------------------------------------------- marks


@pytest.mark.parametrize("number", range(7), ids=["ring", "bare", *RACKS])
def test_all_marks_have_a_place(number: int) -> None:
    gear, language = (RING, BARE, *RACKS.values())[number], tuple(Language)[number % 3]
    drawn, needed, words = demands(gear, language)
    sizes = [view(drawn, needed, Draughting(words, SCALE)) for view in _views(gear)]
    said = ""
    for view in sizes:
        figure = dressed(view)
        assert figure is not None
        said += " ".join(text.words for text in figure.texts) + " "
    shown = (needed.face_width, needed.tip, needed.rim, needed.bolt_circle, needed.bolts, needed.end_chamfer)
    deviations = needed.bolt_position, needed.back_parallelism, needed.back_flatness
    assert all(words.shortest(each / 1000, 4) in said for each in deviations if each is not None)
    for size in (*shown, needed.length, needed.height, needed.reference_height):
        assert size is None or size.prefix + words.shortest(size.value, size.decimals) in said


def _views(gear: Gear | Rack):  # type: ignore[no-untyped-def]
    return (front_view, end_section) if isinstance(gear, Rack) else (section_view, face_view)


@pytest.mark.parametrize("side", [-1, 1])
def test_teeth_of_a_rack_are_cut_off_where_they_are_asked_to_end(side: int) -> None:
    """In the middle of flanks, whose height there is known, and in the middle of a tooth and of a space."""
    rack = Rack(teeth=10, normal_module=2.0, face_width=20.0, height=20.0)
    pitch, on_flank = rack.transverse_pitch, side * rack.profile.half_thickness(0.3)
    cases = ((1.5 + on_flank, 0.3), (1.5, rack.profile.tip_height), (1.5 + side * pitch / 2, -2.5))
    for (low, below), (high, above) in product(cases, repeat=2):
        found = teeth_between(rack, low, high + 3 * pitch, 1.5)
        assert found[0][:2] == pytest.approx((low, below), abs=1e-9)
        assert found[-1][:2] == pytest.approx((high + 3 * pitch, above), abs=1e-9)

"""Views of external gears and details of teeth: what ISO 2203 says of them, sizes at scale, exact outlines."""

import math
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest

from gearcad import Body, Gear
from gearcad.core.records import Floats
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.layout import dressed
from gearcad.drawing.options import SCALES, DrawingOptions
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Arc, Circle, Dimension, Figure, Hatching, Line, MeasuredDistance, Pen, Polyline, Text
from gearcad.drawing.views.gear_figures import Along, Silhouette, end_face, half_section
from gearcad.drawing.views.gear_views import SectionSizes, face_view, section_view
from gearcad.drawing.views.modification_diagrams import helix_depths, modification_figures, profile_depths
from gearcad.drawing.views.tooth_detail import detail_scale, levels_of, spread, tooth_figure, tooth_outline
from gearcad.drawing.words import Draughting, Language, SheetWords, Size
from gearcad.geometry import BasicRack, DoubleHelix, FlankModification, Rack, ReliefShape, ShaperCutter
from gearcad.geometry.curves import parameters_within
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_parts import HubSide
from gearcad.solids import tessellate

SCALE = 0.5

BODY = Body(
    bore=20.0, keyway_width=6.0, keyway_depth=2.8, hub_diameter=34.0, hub_length=8.0, end_chamfer=1.5, end_chamfer_angle=30.0
)
GEAR = Gear(teeth=30, normal_module=2.5, face_width=25.0, helix_angle=20.0, body=BODY)


def _flat_lines(figure: Figure, pen: Pen, *, above: bool) -> list[tuple[float, ...]]:
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


def _dressed(gear: Gear, scale: float = 1.0) -> list[Figure]:
    """Both views with all their marks."""
    drawn = DrawnGear(role="gear", gear=gear)
    requirements, draughting = Requirements.of(drawn, DrawingOptions()), Draughting(SheetWords.of(Language.ENGLISH), scale)
    found = [dressed(view(drawn, requirements, draughting)) for view in (section_view, face_view)]
    assert all(figure is not None for figure in found)
    return [figure for figure in found if figure is not None]


def _said(figure: Figure, scale: float) -> list[tuple[float, str]]:
    """What each dimension measures (mm of the part), and what it says."""
    found = []
    for each in (each for each in figure.shapes if isinstance(each, Dimension)):
        across, up = (abs(one - other) / scale for one, other in zip(each.first, each.second, strict=True))
        length = {MeasuredDistance.HORIZONTAL: across, MeasuredDistance.VERTICAL: up}[each.measured]
        found.append((length, "".join(part.words for part in each.parts if isinstance(part, Text))))
    return sorted(found)


def test_sizes_measure_what_they_say() -> None:
    section, face = _dressed(GEAR, SCALE)
    assert [text for _, text in _said(section, SCALE)] == ["25h110−0.13", "33", "⌀34", "⌀84.813h90−0.087"]
    assert [length for length, _ in _said(section, SCALE)] == pytest.approx([25, 33, 34, GEAR.tip_diameter])
    assert [text for _, text in _said(face, SCALE)] == ["6JS9±0.015", "22.8+0.10"]
    assert [length for length, _ in _said(face, SCALE)] == pytest.approx([6, 22.8])
    texts = [each.words for figure in (section, face) for each in figure.texts]
    assert texts.count("2×") == 2  # run-out and roughness of both faces
    assert {"2× 1.5×30°", "Ra 1.6", "Ra 0.8", "A", "2×", "⌀20", "H7", "0.015"} <= set(texts)


def test_groove_and_hubs_of_double_helical_gears_are_dimensioned() -> None:
    body = Body(bore=20.0, hub_diameter=34.0, hub_length=5.0, hub_side=HubSide.BOTH, end_chamfer=1.0)
    gear = Gear(teeth=30, normal_module=2.5, face_width=40, helix_angle=30, double_helix=DoubleHelix(gap_width=8), body=body)
    section, _ = _dressed(gear)
    floor = gear.gap_diameter / 2
    assert [round(length, 6) for length, _ in _said(section, 1.0)] == [5, 8, 16, 34, 40, 50, round(gear.tip_diameter, 6)]
    words = [each.words for each in section.texts]
    assert f"⌀{gear.gap_diameter:.1f}" in words and "4× 1×45°" in words
    arrow = next(each for each in section.shapes if isinstance(each, Line) and each.start == pytest.approx((0.0, -floor)))
    for each in (part for shape in section.shapes if isinstance(shape, Dimension) for part in shape.parts):
        assert not (isinstance(each, Line) and _cross(arrow, each))
    given = Requirements.of(
        DrawnGear(role="gear", gear=replace(gear, double_helix=DoubleHelix(gap_width=8, gap_diameter=75.125))), DrawingOptions()
    )
    assert given.gap_diameter == Size(value=75.125, prefix="⌀")


def test_every_place_of_a_chamfers_leader_is_outside_the_gear() -> None:
    """Arrows end on one of the four chamfers, and come from beyond the tip circle and the end faces."""
    outline = Silhouette(GEAR, Along.of(GEAR, SCALE))
    requirements = Requirements.of(DrawnGear(role="gear", gear=GEAR), DrawingOptions())
    places = list(SectionSizes(outline, requirements, Draughting(SheetWords.of(Language.ENGLISH), SCALE)).end_chamfer())
    arrows = [next(each for each in figure.shapes if isinstance(each, Line)) for figure in places]
    left, right = -SCALE * 33 / 2, SCALE * (25 - 33 / 2)
    tip, depth = SCALE * GEAR.tip_diameter / 2, SCALE * 1.5 * math.tan(math.radians(30))
    for (x, y), (end_x, end_y) in ((each.start, each.end) for each in arrows):
        assert min(abs(x - left), abs(x - right)) == pytest.approx(SCALE * 1.5 / 2)
        assert abs(y) == pytest.approx(tip - depth / 2)
        assert abs(end_y) > tip and end_y * y > 0
        assert (end_x - x) * (x - (left + right) / 2) > 0
    assert {(x > 0, y > 0) for x, y in (each.start for each in arrows)} == {
        (a, b) for a in (True, False) for b in (True, False)
    }


def _cross(one: Line, other: Line) -> bool:
    """Whether two lines have a point in common within both."""
    ways = np.array([one.end, other.start]) - [one.start, other.end]
    if abs(np.linalg.det(ways)) < 1e-9:
        return False
    along = np.linalg.solve(ways.T, np.array(other.start) - one.start)
    return bool(((along > 1e-6) & (along < 1 - 1e-6)).all())


def test_marks_keep_off_each_other_and_the_outline() -> None:
    """By boxes and points along lines, not by what placed them."""
    for figure in _dressed(GEAR, SCALE):
        boxes = [each.box for each in figure.texts]
        assert not any(one.meets(other) for i, one in enumerate(boxes) for other in boxes[:i])
        starts, ends = (np.array(points) for points in zip(*figure.segments, strict=True))
        points = (starts[:, None] + np.linspace(0, 1, 50)[:, None] * (ends - starts)[:, None]).reshape(-1, 2)
        low, high = np.array(boxes)[:, None, :2], np.array(boxes)[:, None, 2:]
        assert not ((low < points) & (points < high)).all(axis=-1).any()


def test_edges_of_chamfers_that_would_run_into_others_are_thin() -> None:
    """Chamfers of 1.5 mm, 0.87 mm of radius: edges are seen from 0.4 mm of paper on, thick from 1 mm on."""
    gear = Gear(teeth=30, normal_module=2.5, face_width=25.0, body=BODY)
    for scale, edges, circles in ((2.0, (3, 0), (3, 0)), (1.0, (3, 0), (2, 1)), (0.5, (1, 2), (2, 1)), (0.2, (1, 0), (2, 0))):
        pens = (Pen.OUTLINE, Pen.THIN)
        lines = [each for each in half_section(gear, Along.of(gear, scale)).shapes if isinstance(each, Line)]
        upright = [each.pen for each in lines if each.start[0] == each.end[0]]
        assert tuple(upright.count(pen) for pen in pens) == edges, scale
        rings = [each.pen for each in end_face(gear, scale).shapes if isinstance(each, Circle)]
        assert tuple(rings.count(pen) for pen in pens) == circles, scale


MICROMETRE = 1e-3
FULL = BasicRack(root_radius="full")

GEARS = {
    "spur": Gear(teeth=30, normal_module=2, face_width=20, body=Body(bore=20, tip_chamfer=0.2)),
    "helical": Gear(teeth=18, normal_module=5, face_width=20, helix_angle=-30, profile_shift=0.4, rack=FULL),
    "undercut": Gear(teeth=8, normal_module=1, face_width=5),
    "few": Gear(teeth=5, normal_module=3, face_width=9, profile_shift=0.55, tip_alteration=-0.3),
    "fewest": Gear(teeth=3, normal_module=5, face_width=9, profile_shift=0.9, tip_alteration=-0.6),
    "many": Gear(teeth=500, normal_module=0.05, face_width=0.5),
    "shaped ring": Gear(
        teeth=-66, normal_module=2, face_width=20, cutter=ShaperCutter(teeth=25), body=Body(rim_diameter=170, tip_chamfer=0.1)
    ),
    "ring": Gear(teeth=-40, normal_module=50, face_width=200, helix_angle=20),
    "rack": Rack(teeth=10, normal_module=2, face_width=20, height=15, tip_chamfer=0.15),
    "helical rack": Rack(teeth=10, normal_module=3, face_width=20, height=15, helix_angle=35, rack=FULL),
}
MODIFIED = {
    "profile": FlankModification(
        tip_relief=20, tip_relief_length=1.5, root_relief=10, root_relief_length=1, tip_relief_shape=ReliefShape.PARABOLIC
    ),
    "crowned": FlankModification(profile_crowning=5, lead_crowning=-8, end_relief=12, end_relief_length=2),
    "slopes": FlankModification(pressure_angle_modification=6, helix_angle_modification=-10, twist=12),
}


def drawn(name: str, language: Language = Language.ENGLISH) -> Figure:
    part = DrawnGear(role="gear", gear=GEARS[name])
    return tooth_figure(part, Draughting(SheetWords.of(language), detail_scale(part)))


def exact(gear: Gear | Rack) -> Floats:
    """Points of the left half of the tooth as its detail stands, far closer than a micrometre."""
    half = [curve.points(parameters_within(curve, min(2e-5 * gear.normal_module, 2e-4))) for curve in gear.profile.curves]
    points = np.concatenate(half)
    return points if isinstance(gear, Rack) else np.stack([-points[:, 1], points[:, 0]], -1)


@pytest.mark.parametrize("name", GEARS)
def test_the_outline_is_the_exact_profile(name: str) -> None:
    gear = GEARS[name]
    corners = np.array(tooth_outline(gear))
    chord = np.diff(corners[:, :2], axis=0)
    tops = corners[:-1, :2] + chord / 2 + corners[:-1, 2:] / 2 * np.stack([chord[:, 1], -chord[:, 0]], -1)
    points = np.concatenate([corners[:, :2], tops])
    points[:, 0] = -abs(points[:, 0])  # both flanks on the left one
    curve = exact(gear)
    start, way = curve[:-1], np.diff(curve, axis=0)
    start, way = start[length := np.hypot(*way.T) > 0], way[length]
    share = np.clip(((points[:, None] - start) * way).sum(-1) / (way**2).sum(-1), 0, 1)
    away = np.hypot(*np.moveaxis(points[:, None] - start - share[..., None] * way, -1, 0)).min(axis=1)
    assert away.max() < MICROMETRE
    apex = corners[len(corners) // 2, :2]
    assert corners[0, :2] == pytest.approx(curve[0], abs=5e-6) and apex == pytest.approx(curve[-1], abs=1e-9)


@pytest.mark.parametrize("name", [name for name, gear in GEARS.items() if isinstance(gear, Gear)])
def test_circles_have_their_diameters_and_say_them(name: str) -> None:
    gear, figure = GEARS[name], drawn(name)
    assert isinstance(gear, Gear)
    scale = detail_scale(DrawnGear(role="gear", gear=gear))
    sizes = {
        "d_a": gear.tip_diameter,
        "d_Fa": gear.tip_form_diameter,
        "d": gear.reference_diameter,
        "d_b": gear.base_diameter,
        "d_Ff": gear.form_diameter,
        "d_f": gear.root_diameter,
    }
    radii = [shape.radius for shape in figure.shapes if isinstance(shape, Arc)]
    written = " ".join(text.words for text in figure.texts)
    for level in levels_of(gear):
        size = abs(sizes[level.symbol])
        assert min(abs(radius - scale * size / 2) for radius in radii) < 1e-9 * scale * size
        assert f"⌀{size:.3f}" in written
    assert scale in SCALES.values()
    ratio = next(key for key, value in SCALES.items() if value == scale)
    assert f"Z ({ratio})" in written


@pytest.mark.parametrize("name", GEARS)
def test_no_text_of_a_detail_meets_another_or_a_line(name: str) -> None:
    figure = drawn(name, Language.GERMAN)
    assert not any(one.box.meets(other.box) for one, other in combinations(figure.texts, 2))
    lines = [each for shape in figure.shapes if isinstance(shape, Line | Polyline) for each in shape.segments]
    along = np.linspace(0, 1, 60)[:, None]
    points = np.concatenate([np.array(start) * (1 - along) + np.array(end) * along for start, end in lines])
    for text in figure.texts:
        box = text.box
        inside = (points > (box.left, box.bottom)).all(axis=1) & (points < (box.right, box.top)).all(axis=1)
        assert not inside.any(), text.words


def test_heights_of_a_rack_are_named() -> None:
    rack = GEARS["rack"]
    words = [text.words for text in drawn("rack").texts]
    assert isinstance(rack, Rack)
    for height in (rack.tip_height, rack.tip_form_height, rack.form_depth, rack.root_depth, rack.height):
        assert any(f"{height:.3f}" in each for each in words)
    assert "(0.15×45°)" in words


def modified(kind: str, **other: object) -> Gear:
    return Gear(teeth=30, normal_module=2, face_width=20, helix_angle=15, modification=MODIFIED[kind], **other)  # type: ignore[arg-type]


@pytest.mark.parametrize("teeth", [30, -60])
@pytest.mark.parametrize("kind", MODIFIED)
def test_profile_and_helix_diagrams_are_the_depths_of_the_flank(kind: str, teeth: int) -> None:
    """Profile at a height and helix at mid profile together are the flank's own depth at the corners and in the middle."""
    gear = Gear(teeth=teeth, normal_module=2, face_width=20, helix_angle=15, modification=MODIFIED[kind])
    form = gear.flank_form
    profile, helix = profile_depths(gear), helix_depths(gear)
    assert profile is not None
    by_key = {each.key: each.at_places for each in profile.series}
    middle = by_key["profile_middle"]
    for key, z in (("profile_start", 0.0), ("profile_middle", gear.face_width / 2), ("profile_end", gear.face_width)):
        for left in (True, False):
            along = 0.0
            if helix is not None:
                right_of_paper = left is gear.internal
                keys = ("flanks", "flank_right" if right_of_paper else "flank_left")
                series = next(each for each in helix.series if each.key in keys)
                along = float(series.at_places[list(helix.places).index(z)])
            depths = 1000 * form.depth(profile.places, z, left=left)
            assert by_key.get(key, middle) + along == pytest.approx(depths, abs=1e-9)
    sizes = (gear.form_diameter, gear.tip_form_diameter)
    assert profile.diameters is not None
    assert profile.diameters[[0, -1]] == pytest.approx(np.abs(sizes), rel=1e-12)
    assert np.abs(profile.places) == pytest.approx(np.sqrt(profile.diameters**2 - gear.base_diameter**2) / 2, rel=1e-9)


def test_a_tip_relief_by_hand() -> None:
    """Nothing 1.5 mm of roll below the tip, 20 µm at it; so the table says, and what the root relief's transition takes off."""
    gear = modified("profile")
    profile = profile_depths(gear)
    assert profile is not None
    roll = math.sqrt(gear.tip_form_diameter**2 - gear.base_diameter**2) / 2 - 1.5
    begin = math.hypot(gear.base_diameter, 2 * roll)
    assert profile.series[0].at_places == pytest.approx([10.0, 10 * 0.2 / 8, 0.0, 20.0], abs=1e-9)
    (figure,) = modification_figures(DrawnGear(role="gear", gear=gear), Draughting(SheetWords.of(Language.SWEDISH)))
    words = [text.words for text in figure.texts]
    assert f"{begin:.3f}".replace(".", ",") in words and "20,0" in words
    curve = next(shape for shape in figure.shapes if isinstance(shape, Polyline))
    assert curve.points[-1][1] == pytest.approx(-15.0) and max(y for _, y in curve.points) == pytest.approx(0.0)


def test_both_halves_of_a_double_helical_gear_are_alike_from_outside() -> None:
    gear = modified("slopes", double_helix=DoubleHelix(gap_width=4))
    helix = helix_depths(gear)
    assert helix is not None
    lower, upper = (half.gear.flank_form for half in halves(gear))
    middle = (lower.first + lower.last) / 2
    for each in helix.series:
        left = each.key == "flank_left"
        for form, heights in ((lower, helix.places), (upper, gear.half_width - helix.places)):
            at_middle = form.depth(middle, gear.half_width / 2, left=left)
            assert each.at_places == pytest.approx(1000 * (form.depth(middle, heights, left=left) - at_middle), abs=1e-9)


@pytest.mark.parametrize("side", [HubSide.FRONT, HubSide.BACK])
def test_the_helix_diagram_lies_as_the_section_does(side: HubSide) -> None:
    """Its left end is that of the section: z = face width, unless a hub is behind z = 0. Both say which end z counts from."""
    gear = replace(modified("slopes"), body=Body(hub_diameter=20, hub_length=2, hub_side=side))
    helix = helix_depths(gear)
    assert helix is not None
    figures = modification_figures(DrawnGear(role="gear", gear=gear), Draughting(SheetWords.of(Language.ENGLISH)))
    curves = [shape for shape in figures[1].shapes if isinstance(shape, Polyline)]
    for curve, series in zip(curves, helix.series, strict=True):
        x, y = np.array(curve.points).T
        seen = series.along[::-1] if side is HubSide.FRONT else series.along
        assert (np.diff(x) > 0).all() and np.ptp(y) > 1
        assert y == pytest.approx(-15 * seen / (helix.extent[1] - helix.extent[0]))
    for figure in figures:
        words = {text.words for text in figure.texts}
        assert f"z from the {'right' if side is HubSide.FRONT else 'left'} end of the section" in words
        assert "+ material removed, − material added" in words


def test_what_is_not_modified_has_no_diagram() -> None:
    draughting = Draughting(SheetWords.of(Language.ENGLISH))
    for name in ("spur", "ring", "rack"):
        assert modification_figures(DrawnGear(role="gear", gear=GEARS[name]), draughting) == ()


def test_labels_keep_their_order_and_distance() -> None:
    wanted = sorted(np.random.default_rng(5).uniform(0, 20, 12))
    found = spread(wanted, 2.5)
    assert min(after - before for before, after in pairwise(found)) >= 2.5 - 1e-12
    assert np.mean(found) == pytest.approx(np.mean(wanted))
    assert spread([0.0, 5.0], 2.0) == [0.0, 5.0]

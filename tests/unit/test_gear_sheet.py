"""The sheet of a gear, its mass, dimensions, symbols and tables: what they say and where they stand."""

import math
from dataclasses import replace
from itertools import islice

import pytest

from gearcad import Body, DoubleHelix, Gear, GearPair, Material
from gearcad.drawing.annotation_text import Cell, deviations, symbol, table, written_size
from gearcad.drawing.assembly_sheets import draw_pair
from gearcad.drawing.dimensions import (
    Characteristic,
    Side,
    circle_dimension,
    datum,
    frame_leader,
    leader,
    linear_dimension,
    tolerance_frame,
)
from gearcad.drawing.drawing_subjects import DrawnGear, DrawnPair
from gearcad.drawing.drawing_symbols import roughness
from gearcad.drawing.gear_sheet import DrawingSheet, draw_gear, mass_of
from gearcad.drawing.options import DrawingOptions, PartDrawing, Projection, SheetSize
from gearcad.drawing.shapes import Circle, Dimension, Figure, Filled, Hatching, Line, MeasuredDistance, Pen, Point, text_width
from gearcad.drawing.words import Draughting, Language, SheetWords, Size
from gearcad.geometry import Rack
from gearcad.geometry.gear_parts import HubSide

BODY = Body(bore=20.0, keyway_width=6.0, keyway_depth=2.8, hub_diameter=34.0, hub_length=8.0, end_chamfer=1.5)
GEAR = Gear(teeth=30, normal_module=2.5, face_width=25.0, helix_angle=20.0, body=BODY)
RING = Gear(teeth=-40, normal_module=2.0, face_width=20.0, body=Body(rim_diameter=100.0))
RACK = Rack(teeth=20, normal_module=2.0, face_width=20.0, height=18.0, helix_angle=15.0)
OPTIONS = DrawingOptions(number="GC-1002", date="2026-01-31", scale="1:1", sheet=SheetSize.A3)


def _drawn(gear: Gear | Rack, options: DrawingOptions = OPTIONS) -> DrawingSheet:
    return draw_gear(DrawnGear(role="gear", gear=gear), options)


def _words(sheet: DrawingSheet) -> list[str]:
    return [each.words for each in sheet.figure.texts]


def _middle_of_tips(sheet: DrawingSheet, gear: Gear) -> Point:
    """Of the tip circle of the view along the axis."""
    radius = sheet.scale * gear.tip_diameter / 2
    circles = [each for each in sheet.figure.shapes if isinstance(each, Circle) and each.pen is Pen.OUTLINE]
    (found,) = (each.centre for each in circles if math.isclose(each.radius, radius))
    return found


def test_numbers_shown_are_those_of_documents() -> None:
    sheet = _drawn(GEAR)
    document = GEAR.to_dict()
    shown = {key: value for key, value in sheet.shown.items() if key in document}
    assert len(shown) > 10
    assert shown == {key: pytest.approx(document[key], abs=0) for key in shown}
    assert {key: sheet.shown[f"sizes.{key}"] for key in ("tip", "bore", "keyway_depth", "hub_width", "hub_diameter")} == {
        "tip": GEAR.tip_diameter,
        "bore": 20.0,
        "keyway_depth": 22.8,
        "hub_width": 33.0,
        "hub_diameter": 34.0,
    }
    texts = _words(sheet)
    assert {"GC-1002", "79.813", "74.426", "right", "20.0000°", "Gear wheel", "2026-01-31"} <= set(texts)


@pytest.mark.parametrize("gear", [RING, RACK], ids=["ring", "rack"])
def test_rings_and_racks_have_sheets_too(gear: Gear | Rack) -> None:
    sheet = _drawn(gear)
    assert {"Ring gear" if gear is RING else "Rack", "Gear data"} <= set(_words(sheet))
    assert sheet.paper.holds(sheet.figure.box)


def test_nothing_is_outside_the_paper_or_over_other_texts() -> None:
    sheet = _drawn(GEAR, replace(OPTIONS, language=Language.GERMAN))
    boxes = [each.box for each in sheet.figure.texts]
    assert sheet.paper.holds(sheet.figure.box)
    assert not any(one.meets(other) for i, one in enumerate(boxes) for other in boxes[:i])


@pytest.mark.parametrize(("projection", "side"), [(Projection.FIRST, HubSide.FRONT), (Projection.THIRD, HubSide.BACK)])
def test_the_view_along_the_axis_stands_where_the_projection_has_it(projection: Projection, side: HubSide) -> None:
    """One sees the hub there, from the left of the section: it is at the right, in third angle projection at the left."""
    gear = replace(GEAR, body=replace(BODY, hub_side=side))
    sheet = _drawn(gear, replace(OPTIONS, projection=projection))
    (hatching,) = (each for each in sheet.figure.shapes if isinstance(each, Hatching))
    across = _middle_of_tips(sheet, gear)[0]
    assert (across > hatching.box.middle[0]) is (projection is Projection.FIRST)
    hub = [each for each in hatching.edges[0] if math.isclose(each[1] - _middle_of_tips(sheet, gear)[1], 17.0 * sheet.scale)]
    assert max(x for x, _, _ in hub) < hatching.box.middle[0]


def test_the_table_of_the_gear_wins() -> None:
    own = PartDrawing(number="P-7", sheet=SheetSize.A2, scale="1:2")
    sheet = draw_gear(DrawnGear(role="pinion", gear=GEAR), OPTIONS, own, alone=False)
    assert (sheet.number, sheet.size, sheet.scale, sheet.title) == ("P-7", (594.0, 420.0), 0.5, "Pinion")


def test_sheets_are_documents_of_their_size() -> None:
    document = _drawn(GEAR).document()
    assert document.header["$EXTMAX"][:2] == (420.0, 297.0)
    assert not document.audit().errors


def test_sheets_say_what_is_assumed_and_how_it_is_hardened() -> None:
    sheet = _drawn(GEAR, replace(OPTIONS, heat_treatment="carburised", case_depth="0.6"))
    assert "carburised, CHD 0.6" in _words(sheet)
    assert {"no-thickness-limits", "no-material"} <= {each.code for each in sheet.notices}


@pytest.mark.parametrize(
    ("gear", "scale", "detailed"),
    [
        (
            Gear(teeth=30, normal_module=2.0, face_width=20.0, body=Body(bore=20.0, keyway_width=6.0, keyway_depth=2.8)),
            0.5,
            True,
        ),
        (Gear(teeth=44, normal_module=2.5, face_width=15.0, helix_angle=28.0, body=Body(bore=45.0)), 0.5, False),
    ],
    ids=["spur", "wheel"],
)
def test_simple_gears_have_a_sheet_that_can_be_read_on_a4(gear: Gear, scale: float, detailed: bool) -> None:
    """Without the tooth in detail, and saying so, only where that would make the views too small."""
    for language in Language:
        sheet = _drawn(gear, DrawingOptions(sheet=SheetSize.A4, language=language))
        left_out = [str(each) for each in sheet.notices if each.code == "drawing-without-detail"]
        assert (sheet.size, sheet.scale) == ((210.0, 297.0), scale)
        assert left_out == ([] if detailed else ["tooth in detail: no room on A4"])
        assert ("Z" in _words(sheet)) is detailed
        assert all(sheet.paper.holds(text.box) for text in sheet.figure.texts)


def test_views_that_cannot_be_read_on_the_sheet_asked_for_are_told() -> None:
    """At a scale that was asked for they are as wanted."""
    wide = Gear(teeth=81, normal_module=4.0, face_width=60.0, body=Body(bore=110.0))
    notices = _drawn(wide, DrawingOptions(sheet=SheetSize.A4, scale="1:20")).notices
    assert "drawing-small" not in {each.code for each in notices}
    small = Gear(teeth=20, normal_module=0.01, face_width=0.2)
    assert "drawing-small" in {each.code for each in _drawn(small, DrawingOptions(sheet=SheetSize.A3)).notices}
    assert "drawing-small" not in {each.code for each in _drawn(small, DrawingOptions()).notices}


PROMISED = 2e-4
"""Of volumes: the chords of the solid, a thousandth of a module off it."""

STEEL = Material()
KEYED = Body(bore=20, keyway_width=6, keyway_depth=2.8, hub_diameter=34, hub_length=8, end_chamfer=1, tip_chamfer=0.2)
RIM = Body(rim_diameter=170, bolt_circle=155, bolt_holes=8, bolt_diameter=6.6, end_chamfer=1)


# Volumes in mm³ of the exact solids, by OCP's VolumeProperties.
@pytest.mark.parametrize(
    ("part", "volume"),
    [
        (Gear(teeth=30, normal_module=2, face_width=20, body=KEYED), 53932.11),
        (Gear(teeth=23, normal_module=4, face_width=60, helix_angle=28, body=Body(bore=40, end_chamfer=1)), 431347.87),
        (Gear(teeth=23, normal_module=4, face_width=150, helix_angle=28, double_helix=DoubleHelix(gap_width=30)), 1213948.56),
        (Gear(teeth=-66, normal_module=2, face_width=20, body=RIM), 173995.13),
        (Rack(teeth=20, normal_module=2, face_width=20, height=18, helix_angle=15, tip_chamfer=0.15), 46560.57),
    ],
    ids=["keyed", "helical", "double helical", "ring", "rack"],
)
def test_masses_are_those_of_exact_solids(part: Gear | Rack, volume: float) -> None:
    found = mass_of(DrawnGear(role="gear", gear=part, material=Material(density=2700)))
    assert found == pytest.approx(volume * 2.7e-6, rel=PROMISED)


def test_what_is_not_known_has_no_mass() -> None:
    """Neither without a material, nor a ring that ends nowhere, nor what such a part belongs to."""
    ring, wheel = Gear(teeth=-60, normal_module=2, face_width=20), Gear(teeth=20, normal_module=2, face_width=20)
    assert mass_of(DrawnGear(role="ring", gear=ring, material=STEEL)) is None
    assert mass_of(DrawnGear(role="gear", gear=wheel)) is None
    for material, told in ((STEEL, True), (None, False)):
        parts = (DrawnGear(role="pinion", gear=wheel, material=STEEL), DrawnGear(role="wheel", gear=wheel, material=material))
        sheet = draw_pair(DrawnPair(name="p", pair=GearPair(pinion=wheel, wheel=wheel), parts=parts), DrawingOptions())
        assert ("mass" in sheet.shown) is told
        assert any(text.words.endswith(" kg") for text in sheet.figure.texts) is told


def test_title_blocks_say_the_mass() -> None:
    """Between those of steel cylinders through tips and through roots; a pair has twice that of its gears."""
    gear = Gear(teeth=30, normal_module=2, face_width=20, body=Body(bore=20))
    drawn = DrawnGear(role="gear", gear=gear, material=STEEL)
    sheet = draw_gear(drawn, DrawingOptions())
    least, most = (math.pi / 4 * (each**2 - 20**2) * 20 * 7.85e-6 for each in (gear.root_diameter, gear.tip_diameter))
    assert least < sheet.shown["mass"] < most
    assert f"{sheet.shown['mass']:.3g} kg" in [text.words for text in sheet.figure.texts]
    pair = draw_pair(DrawnPair(name="p", pair=GearPair(pinion=gear, wheel=gear), parts=(drawn, drawn)), DrawingOptions())
    assert pair.shown["mass"] == pytest.approx(2 * sheet.shown["mass"])


ENGLISH, GERMAN = SheetWords.of(Language.ENGLISH), SheetWords.of(Language.GERMAN)
HALF_SIZE = Draughting(ENGLISH, 0.5)


def only(figure: Figure) -> Dimension:
    """The dimension that a figure is."""
    (shape,) = figure.shapes
    assert isinstance(shape, Dimension)
    return shape


@pytest.mark.parametrize(
    ("size", "texts", "words"),
    [
        (Size(value=80.0), ["80"], "<>"),
        (Size(value=80.0, fit="h11", upper=0.0, lower=-0.19), ["80", "h11", "0", "−0,19"], "<> h11 {\\H0.7x;\\S0^−0,19;}"),
        (Size(value=80.0, upper=0.0105, lower=-0.0105), ["80", "±0,0105"], "<> %%p0,0105"),
        (Size(value=80.0, prefix="⌀", upper=0.05, lower=0.0205), ["⌀80", "+0,0500", "+0,0205"], None),
        (Size(value=80.0, prefix="⌀", envelope=True), ["⌀80", "E"], "%%c<> (E)"),
        (Size(value=79.5, reference=True), ["(79,5", ")"], "(79,5)"),  # measures 80
        (Size(value=80.0, suffix="×45°"), ["80×45°"], "<>×45%%d"),
    ],
)
def test_what_a_dimension_says(size: Size, texts: list[str], words: str | None) -> None:
    figure = next(linear_dimension((0.0, 0.0), (40.0, 0.0), Side.BELOW, size, Draughting(GERMAN, 0.5), clear=-5.0))
    assert [each.words for each in figure.texts] == texts
    assert words is None or only(figure).words == words


@pytest.mark.parametrize("side", Side)
def test_lanes_go_outwards_and_extension_lines_reach_past_them(side: Side) -> None:
    first, second = side.point(-20.0, 3.0 * side.outwards), side.point(20.0, 3.0 * side.outwards)
    found = linear_dimension(first, second, side, Size(value=80.0), HALF_SIZE, clear=4.0 * side.outwards)
    lanes = [only(each) for each in found]
    outs = sorted({round(side.out(each.line) * side.outwards, 9) for each in lanes})
    assert outs == pytest.approx([14.0 + 9.0 * number for number in range(len(outs))])
    for each in lanes:
        lines = [part for part in each.parts if isinstance(part, Line)]
        crossing = [line for line in lines if side.along(line.start) == side.along(line.end)]
        reach = [side.out(line.end) * side.outwards for line in crossing]
        assert reach == pytest.approx([side.out(each.line) * side.outwards + 1.5] * 2)
        assert [side.out(line.start) * side.outwards for line in crossing] == pytest.approx([3.8] * 2)
        assert each.measured is (MeasuredDistance.VERTICAL if side.is_upright else MeasuredDistance.HORIZONTAL)
        assert abs(side.along(each.second) - side.along(each.first)) / HALF_SIZE.scale == pytest.approx(80.0)


@pytest.mark.parametrize("length", [0.5, 3.0, 8.0, 15.0, 60.0])
@pytest.mark.parametrize("side", Side)
def test_the_text_of_a_dimension_meets_none_of_its_own_lines(side: Side, length: float) -> None:
    size = Size(value=length, prefix="⌀", fit="H7", upper=0.025, lower=0.0, envelope=True)
    draughting = Draughting(ENGLISH)
    both = linear_dimension(side.point(0.0, 0.0), side.point(length, 0.0), side, size, draughting, clear=0.0)
    for figure in islice(both, 8):
        whole = [each.box for each in figure.texts]
        for part in only(figure).parts:
            if isinstance(part, Line | Filled):
                assert not any(part.box.grown(0.25).meets(box) for box in whole)


def test_arrows_are_of_fifteen_degrees_and_touch_what_is_measured() -> None:
    dimension = only(
        next(linear_dimension((3.0, 0.0), (43.0, 0.0), Side.ABOVE, Size(value=40.0), Draughting(ENGLISH), clear=0.0))
    )
    arrows = [part for part in dimension.parts if isinstance(part, Filled)]
    assert [each.points[0][0] for each in arrows] == [3.0, 43.0]
    for each in arrows:
        tip, one, other = each.points
        angles = [math.atan2(y - tip[1], x - tip[0]) for x, y in (one, other)]
        assert math.degrees(abs(math.remainder(angles[0] - angles[1], math.tau))) == pytest.approx(15.0)
        assert each.box.width == pytest.approx(3.2)


def test_a_leader_to_a_circle_is_square_to_it_and_no_dimension_of_a_program() -> None:
    """LibreCAD draws diameters anew across the circle, wherever their text was."""
    for figure in islice(circle_dimension((5.0, 5.0), 20.0, Size(value=80.0, prefix="⌀"), HALF_SIZE), 12):
        assert not [each for each in figure.shapes if isinstance(each, Dimension)]
        (point,) = (each for each in figure.shapes if isinstance(each, Filled))
        line = next(each for each in figure.shapes if isinstance(each, Line))
        assert point.points[0] == line.start and math.dist(line.start, (5.0, 5.0)) == pytest.approx(20.0)
        assert math.dist(line.end, (5.0, 5.0)) == pytest.approx(20.0 + math.dist(*line.segments[0]))
        assert [each.words for each in figure.texts] == ["⌀80"]


def test_subscripts_are_smaller_and_lower() -> None:
    base, small = symbol("A_sne").at((10.0, 20.0)).texts
    assert (base.words, small.words) == ("A", "sne")
    assert small.height < base.height and small.at[1] < base.at[1] and small.start[0] > base.box.right - 0.2
    assert [each.words for each in symbol("A_sne / A_sni").at((0.0, 0.0)).texts] == ["A", "sne", " / A", "sni"]
    assert [each.words for each in symbol("z").at((0.0, 0.0)).texts] == ["z"]


def test_the_width_of_a_written_size_is_that_of_its_texts() -> None:
    written = written_size(Size(value=40.0, fit="H7", upper=0.025, lower=0.0), ENGLISH)
    assert written.width == pytest.approx(
        text_width("40", 3.5) + text_width("H7", 3.5) + 2 * 0.35 * 3.5 + text_width("+0.025", 2.45)
    )
    upper, lower = written.at((0.0, 0.0)).texts[-2:]
    assert upper.words == "+0.025" and lower.words == "0"
    assert lower.start[0] - upper.start[0] == pytest.approx(text_width("+", 2.45))  # digits in line


@pytest.mark.parametrize("side", Side)
def test_a_tolerance_frame_points_squarely_at_its_edge(side: Side) -> None:
    frame = tolerance_frame(Characteristic.CIRCULAR_RUNOUT, "0.02", ("A",))
    for figure in frame_leader((7.0, 9.0), side, frame):
        (point,) = (each for each in figure.shapes if isinstance(each, Filled) and each.points[0] == (7.0, 9.0))
        middle = tuple((one + other) / 2 for one, other in zip(*point.points[1:], strict=True))
        assert ((middle[0] - 7.0) / 3.2, (middle[1] - 9.0) / 3.2) == pytest.approx(side.value)


@pytest.mark.parametrize("side", Side)
def test_marks_of_an_edge_stand_outside_it(side: Side) -> None:
    start, end = side.point(0.0, 0.0), side.point(40.0, 0.0)
    found = [next(roughness(start, end, side, "Ra 1.6", HALF_SIZE)), next(datum("A", side.point(20.0, 0.0), side))]
    for figure in found:
        box = figure.box
        nearest = {Side.LEFT: -box.right, Side.RIGHT: box.left, Side.ABOVE: box.bottom, Side.BELOW: -box.top}[side]
        assert nearest == pytest.approx(0.0, abs=1e-9)


def test_a_leader_tries_all_directions_before_it_gets_longer() -> None:
    tips = [each.segments[0] for each in islice(leader((0.0, 0.0), "8×⌀12", HALF_SIZE, (30.0, 150.0)), 4)]
    assert len(tips) == 4
    lines = [each.shapes[1] for each in islice(leader((0.0, 0.0), "8×⌀12", HALF_SIZE, (30.0, 150.0)), 4)]
    lengths = [math.dist(each.start, each.end) for each in lines if isinstance(each, Line)]
    assert lengths[0] == pytest.approx(lengths[1]) and lengths[2] == pytest.approx(lengths[3]) and lengths[2] > lengths[0]


def test_a_table_shortens_what_does_not_fit_and_names_it() -> None:
    long = "a text that is by far too long for its narrow cell"
    figure, shortened = table(
        (30.0, 12.0), [[Cell("Heading")], [Cell(long), Cell("d_b", symbolic=True)], [Cell("x"), Cell("3")]]
    )
    assert shortened == (long,)
    assert figure.box == pytest.approx((0.0, -3 * 6.4, 42.0, 0.0))
    assert all(figure.box.holds(text.box) for text in figure.texts)


def test_stacked_limits_with_units_do_not_touch() -> None:
    """The tail of µ reaches below the line."""
    upper, lower = deviations("−70 µm", "−110 µm", 2.5).at((0.0, 0.0)).texts
    assert upper.box.bottom > lower.box.top

"""Dimensions, symbols and tables: what they say, where they stand, and what a CAD program would measure."""

from __future__ import annotations

import math
from itertools import islice

import pytest

from gearcad.drawing.annotation_text import Cell, deviations, symbol, table, written_size
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
from gearcad.drawing.drawing_symbols import roughness
from gearcad.drawing.shapes import Dimension, Figure, Filled, Line, MeasuredDistance, text_width
from gearcad.drawing.words import Draughting, Language, SheetWords, Size

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

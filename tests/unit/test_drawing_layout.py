"""Layout: marks that clash with nothing, lanes in order, the largest scale, and what is said where there is no room."""

from collections.abc import Callable, Iterator
from itertools import combinations, product

import numpy as np
import pytest

from gearcad.core.errors import ParameterError
from gearcad.drawing.dimensions import Characteristic, Side, frame_leader, leader, linear_dimension, tolerance_frame
from gearcad.drawing.layout import Fixed, View, Views, arranged, dressed
from gearcad.drawing.options import SCALES, Projection, SheetSize
from gearcad.drawing.placement import Occupied, Room
from gearcad.drawing.shapes import Anchor, Box, Dimension, Figure, Hatching, Line, Pen, Point, Polyline, Shape, Text
from gearcad.drawing.words import Draughting, Language, SheetWords, Size

WORDS = SheetWords.of(Language.ENGLISH)


def rectangle(box: Box, pen: Pen = Pen.OUTLINE) -> Polyline:
    return Polyline.straight(
        [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)], pen, closed=True
    )


def block(width: float, height: float, name: str = "block") -> Callable[[float], View]:
    """A rectangle with sizes on all sides, at any scale."""

    def made(scale: float) -> View:
        draughting, right, top = Draughting(WORDS, scale), width / 2 * scale, height / 2 * scale
        frame = tolerance_frame(Characteristic.CIRCULAR_RUNOUT, "0.02", "A")
        over = Size(value=width, fit="h11", upper=0.0, lower=-0.16)
        return View(
            name,
            Figure.of(rectangle(Box(-right, -top, right, top))),
            (
                lambda: linear_dimension((-right, -top), (right, -top), Side.BELOW, over, draughting, clear=-top),
                lambda: linear_dimension(
                    (-right / 3, -top), (right / 4, -top), Side.BELOW, Size(value=width * 7 / 24), draughting, clear=-top
                ),
                lambda: linear_dimension(
                    (-right, -top), (-right, top), Side.LEFT, Size(value=height), draughting, clear=-right
                ),
                lambda: linear_dimension(
                    (right, -top / 2), (right, top / 2), Side.RIGHT, Size(value=height / 2), draughting, clear=right
                ),
                lambda: frame_leader((right / 2, top), Side.ABOVE, frame),
                lambda: leader((right, -top), "1×45°", draughting),
            ),
        )

    return made


def fixed(sheet: SheetSize, scale: str) -> Fixed:
    """A frame, a title block at the lower right, and a table at the upper right."""
    width, height = sheet.size
    free = Box(20.0, 10.0, width - 10.0, height - 10.0)
    taken = (Box(width - 190.0, 10.0, width - 10.0, 60.0), Box(width - 124.0, height - 150.0, width - 10.0, height - 10.0))
    return Fixed(Figure.of(*(rectangle(each, Pen.FRAME) for each in (free, *taken))), free, taken)


def parts(shape: Shape) -> Iterator[Shape]:
    if isinstance(shape, Dimension):
        yield from shape.parts
    else:
        yield shape


def overlaps(figure: Figure) -> list[str]:
    """Texts over texts or over lines, by points on a fine grid within each text's box (not by the clipping of the layout)."""
    shapes = [part for shape in figure.shapes for part in parts(shape)]
    texts = [shape for shape in shapes if isinstance(shape, Text)]
    pairs = [(one, other) for one, other in combinations(texts, 2) if one.box.grown(1.0).meets(other.box)]
    found = [f"{one.words} on {other.words}" for one, other in pairs if _inside(_grid(one.box), other.box).any()]
    lines = np.array([(*start, *end) for shape in shapes for start, end in shape.segments]).reshape(-1, 2, 2)
    share = np.linspace(0.0, 1.0, 401)[:, None, None]
    for text in texts:
        low, high = np.array(text.box[:2]), np.array(text.box[2:])
        near = lines[((lines.min(axis=1) < high) & (lines.max(axis=1) > low)).all(axis=1)]
        points = ((1 - share) * near[:, 0] + share * near[:, 1]).reshape(-1, 2)
        if _inside(points, text.box).any():
            found.append(f"line through {text.words}")
    return found


def _grid(box: Box) -> np.ndarray:
    return np.stack(np.meshgrid(np.linspace(box.left, box.right, 40), np.linspace(box.bottom, box.top, 12)), -1).reshape(-1, 2)


def _inside(points: np.ndarray, box: Box) -> np.ndarray:
    return (points > np.array(box[:2])).all(axis=1) & (points < np.array(box[2:])).all(axis=1)


@pytest.mark.parametrize(
    "size", [(120.0, 80.0), (12.0, 90.0), (90.0, 3.0), (0.4, 0.3), (26.0, 26.0), (33.0, 26.0), (400.0, 5.0)]
)
def test_no_text_of_a_view_is_over_another_or_a_line(size: tuple[float, float]) -> None:
    figure = dressed(block(*size)(1.0))
    assert figure is not None
    assert overlaps(figure) == []
    below = {
        round(each.line[1], 6): abs(each.second[0] - each.first[0])
        for each in figure.shapes
        if isinstance(each, Dimension) and each.line[1] < -size[1] / 2 and each.first[1] == each.second[1]
    }
    assert [below[each] for each in sorted(below, reverse=True)] == sorted(below.values())  # the shorter inside
    assert len(below) == 2


def test_marks_that_clash_with_what_stands_are_placed_elsewhere() -> None:
    view = block(60.0, 40.0)(1.0)
    free = dressed(view)
    obstacle = Figure.of(Line((-60.0, -26.5), (60.0, -26.5)))
    around = dressed(view, obstacles=(obstacle,))
    assert free is not None and around is not None and around != free
    assert overlaps(around + obstacle) == [] != overlaps(free + obstacle)
    assert dressed(view, within=view.figure.box.grown(8.0)) is None


@pytest.mark.parametrize("width", [7.0, 130.0, 300.0, 700.0, 2600.0])
def test_the_scale_is_the_largest_that_has_room(width: float) -> None:
    """As exhaustive trial of all sheets and scales finds it."""

    def views(scale: float) -> Views:
        side = width / 2 * scale
        square = Figure.of(rectangle(Box(-side, -side, side, side)))
        return Views(((View("front", square), View("end", square)),))

    found = arranged(views, fixed)
    fits = {}
    for sheet, (scale, factor) in product((SheetSize.A3, SheetSize.A2, SheetSize.A1, SheetSize.A0), SCALES.items()):
        side = width * factor
        free, taken = fixed(sheet, scale).free, fixed(sheet, scale).taken
        tops = np.arange(free.bottom + side + 2.0, free.top - 1.9, 0.5)  # as near as it may be where there is little room
        beside_table = tops > taken[1].bottom - 2.0
        over_block = tops - side > taken[0].top + 2.0
        right = np.where(beside_table, taken[1].left, np.where(over_block, free.right, taken[0].left))
        if factor <= 50 and (right - free.left >= 2 * side + 2.0 + 6.0 + 2.0).any():
            fits.setdefault(sheet, factor)
    good = [each for each in (SheetSize.A3, SheetSize.A2) if fits.get(each, 0.0) >= 0.5]
    good += [each for each, scale in fits.items() if scale >= 0.2]
    sheet = good[0] if good else max(fits, key=lambda each: fits[each])
    assert (found.sheet, found.factor) == (sheet, fits[sheet])
    assert found.figure == arranged(views, fixed).figure


@pytest.mark.parametrize("projection", Projection)
def test_views_stand_as_the_projection_says(projection: Projection) -> None:
    rows = lambda scale: Views(  # noqa: E731
        (
            (block(90.0, 40.0, "front")(scale), block(30.0, 40.0, "from the left")(scale)),
            (block(90.0, 30.0, "from above")(scale),),
        ),
        (View("detail", Figure.of(rectangle(Box(0.0, 0.0, 40.0, 30.0)))),),
    )
    at = arranged(rows, fixed, projection=projection).origins
    sign = 1 if projection is Projection.FIRST else -1
    assert at["front"][1] == at["from the left"][1] and at["front"][0] == at["from above"][0]
    assert (at["from the left"][0] - at["front"][0]) * sign > 0
    assert (at["front"][1] - at["from above"][1]) * sign > 0


def test_blocks_and_views_are_apart_from_each_other_and_from_what_is_fixed() -> None:
    generator = np.random.default_rng(20)
    for _ in range(3):
        sizes = generator.uniform(20.0, 90.0, (2, 2))
        loose = generator.uniform(15.0, 60.0, (2, 2))
        rest = tuple(View(f"d{n}", Figure.of(rectangle(Box(0.0, 0.0, *each)))) for n, each in enumerate(loose.tolist()))
        made = {}

        def views(scale: float, sizes: np.ndarray = sizes, rest: tuple[View, ...] = rest, made: dict = made) -> Views:
            row = tuple(block(*each, f"v{n}")(scale) for n, each in enumerate(sizes.tolist()))
            made.update({view.name: view for view in (*row, *rest)})
            return Views((row,), rest)

        found = arranged(views, fixed)
        views(found.factor)
        boxes = [_moved(made[name], at) for name, at in found.origins.items()]
        area = fixed(found.sheet, found.scale)
        assert len(boxes) == 4
        assert not any(one.meets(other) for one, other in combinations((*boxes, *area.taken), 2))
        assert all(area.free.holds(each) for each in boxes)
        assert overlaps(found.figure) == []


def _moved(view: View, at: Point) -> Box:
    figure = dressed(view)
    assert figure is not None
    return figure.moved(*at).box


@pytest.mark.parametrize(
    ("sheet", "scale", "said"),
    [
        (SheetSize.A4, "5:1", "scale = '5:1': has no room on A4; 1:1 has; sheet A3 has"),
        (SheetSize.AUTO, "50:1", "scale = '50:1': has no room on any sheet up to A0; 20:1 has"),
    ],
)
def test_what_cannot_be_is_refused_with_what_can(sheet: SheetSize, scale: str, said: str) -> None:
    with pytest.raises(ParameterError) as caught:
        arranged(lambda each: Views(((block(45.0, 30.0)(each),),)), fixed, sheet=sheet, scale=scale)
    assert str(caught.value) == said


def test_a_sheet_that_is_too_small_names_one_that_is_not() -> None:
    big = View("big", Figure.of(rectangle(Box(0.0, 0.0, 190.0, 150.0))))
    with pytest.raises(ParameterError, match=r"^sheet = 'A4': no scale has room on A4; sheet A3 has at 10:1$"):
        arranged(lambda scale: Views(((block(9.0, 5.0)(scale),),), (big,)), fixed, sheet=SheetSize.A4)


def test_a_text_and_random_lines_clash_where_points_of_them_are_near_it() -> None:
    """Against 2001 points of each line; lines that only just graze it are left out."""
    generator = np.random.default_rng(5)
    text = Text("40 h11", (0.0, 0.0))
    occupied, near, far = Occupied(Figure.of(text)), text.box.grown(0.57), text.box.grown(0.63)
    ends = generator.uniform(-25.0, 35.0, (300, 2, 2))
    share = np.linspace(0.0, 1.0, 2001)[:, None]
    crossed = 0
    for start, end in ends.tolist():
        points = (1 - share) * np.array(start) + share * np.array(end)
        within, outside = _inside(points, near).any(), not _inside(points, far).any()
        crossed += within
        if within or outside:
            line = Line((start[0], start[1]), (end[0], end[1]))
            assert occupied.clashes(Figure.of(line)) is bool(within)
            assert Occupied(Figure.of(line)).clashes(Figure.of(text)) is bool(within)
    assert 40 < crossed < 260


def test_texts_keep_off_hatching_and_symbols_and_dimension_lines_off_each_other() -> None:
    hole = ((10.0, 10.0, 0.0), (30.0, 10.0, 0.0), (30.0, 30.0, 0.0), (10.0, 30.0, 0.0))
    area = Figure.of(Hatching((tuple((x, y, 0.0) for x, y in ((0, 0), (40, 0), (40, 40), (0, 40))), hole)))
    occupied = Occupied(area)
    where = [((20.0, 20.0), False), ((5.0, 36.0), True), ((38.0, 20.0), True), ((60.0, 20.0), False), ((11.0, 20.0), True)]
    for place, clash in where:
        assert occupied.clashes(Figure.of(Text("Ra", place, 2.5, Anchor.MIDDLE))) is clash
    frame = tolerance_frame(Characteristic.CIRCULAR_RUNOUT, "0.02", "A")
    assert Occupied(frame).clashes(Figure.of(Line((3.0, -9.0), (3.0, 9.0))))  # through the cell of the symbol
    near, wide = Draughting(WORDS), Size(value=30.0)
    lanes = list(linear_dimension((0.0, 0.0), (30.0, 0.0), Side.BELOW, wide, near, clear=0.0))
    other = next(linear_dimension((28.0, 0.0), (60.0, 0.0), Side.BELOW, Size(value=32.0), near, clear=0.0))
    beside = next(linear_dimension((30.0, 0.0), (60.0, 0.0), Side.BELOW, wide, near, clear=0.0))
    assert Occupied(lanes[0]).clashes(other) and not Occupied(lanes[0]).clashes(beside)
    assert Occupied(lanes[0]).clashes(Figure.of(Text("x", (10.0, -11.0))))


@pytest.mark.parametrize(
    ("up", "along", "doubled"), [(0.0, 5.0, 0), (0.2, 5.0, 1), (-0.9, 5.0, 1), (1.1, 5.0, 0), (0.2, 19.5, 0)]
)
def test_lines_that_would_look_doubled_are_better_avoided(up: float, along: float, doubled: int) -> None:
    """A leader 0.2 mm beside an extension line looks like a thick one; upon it, further off, or past its end it does not."""
    for turn in (1, -1):
        standing, line = (
            Line(start[::turn], end[::turn], Pen.DIMENSION)
            for start, end in (((0.0, 0.0), (20.0, 0.0)), ((along, up), (along + 20.0, up)))
        )
        assert Occupied(Figure.of(standing)).crossings(Figure.of(line)) == doubled


def test_views_have_the_air_around_them_that_a_room_asks_for() -> None:
    """Two views of 40 and 30 mm, 10 mm apart and 5 mm from the edges, need 90 mm, beside a taken box as well."""
    views = (Box(-20.0, -10.0, 20.0, 10.0), Box(0.0, -10.0, 30.0, 10.0))
    assert Room(Box(0.0, 0.0, 89.9, 30.0)).places([views]) is None
    assert Room(Box(0.0, 0.0, 90.0, 29.9)).places([views]) is None
    found = Room(Box(100.0, 0.0, 190.0, 30.0)).places([views])
    assert found is not None
    np.testing.assert_allclose(found[0], [(125.0, 15.0), (155.0, 15.0)], atol=1e-9)
    behind = Room(Box(0.0, 0.0, 100.0, 30.0), taken=(Box(0.0, 0.0, 10.0, 30.0),)).places([views])
    assert behind is not None
    np.testing.assert_allclose(behind[0], [(35.0, 15.0), (65.0, 15.0)], atol=1e-9)
    assert Room(Box(0.0, 0.0, 99.9, 30.0), taken=(Box(0.0, 0.0, 10.0, 30.0),)).places([views]) is None

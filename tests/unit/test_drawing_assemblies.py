"""Assemblies on paper: what is where and what is hidden, by formulas; every number is that of the documents."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.path import Path as Outline
from support.planetary_trains import alm_train
from support.written_sheet import read_sheet

from gearcad import Body, Gear, GearPair, Rack, RackPair
from gearcad.core.dxf import write_document as write_dxf
from gearcad.core.errors import ParameterError
from gearcad.core.runtime import templates
from gearcad.designs import read_spec
from gearcad.drawing.assembly_sheets import draw_pair, draw_train, train_rows
from gearcad.drawing.drawing_subjects import DrawnGear, DrawnPair, DrawnTrain
from gearcad.drawing.dxf_export import sheet_document
from gearcad.drawing.gear_data_rows import gear_notices
from gearcad.drawing.gear_sheet import DrawingSheet
from gearcad.drawing.layout import View
from gearcad.drawing.options import DrawingOptions, PartDrawing, Projection, SheetSize
from gearcad.drawing.shapes import Circle, Hatching, Pen, Polyline, Text
from gearcad.drawing.views.assembly_figures import Where, pieces
from gearcad.drawing.views.pair_views import pair_face, pair_section
from gearcad.drawing.views.train_views import PosedTrain, train_face, train_section
from gearcad.drawing.words import Draughting, Language, SheetWords
from gearcad.jobs.draw import drawn_gears
from gearcad.planetary import Central, PlanetaryTrain, Rim

EXACT = 1e-9
"""mm: what follows by a formula of two terms."""

PAPER = Draughting(SheetWords.of(Language.ENGLISH), 2.0)

STARTERS = ("fzg-c", "ring-22-70", "double-23-81", "rack", "planetary-alm", "planetary-differential")


def gear(teeth: int, width: float, **more: Any) -> Gear:
    return Gear(teeth=teeth, normal_module=2.0, face_width=width, **more)


def external(**more: Any) -> GearPair:
    """A narrow pinion, its wheel on both sides 3 mm wider; working pitch circles that are not the reference circles."""
    pinion = gear(20, 10.0, profile_shift=0.4, body=Body(bore=12.0))
    return GearPair(pinion=pinion, wheel=gear(31, 16.0, profile_shift=0.3), **more)


def racked() -> RackPair:
    pinion, rack = gear(20, 14.0), Rack(teeth=30, normal_module=2.0, face_width=10.0, height=12.0)
    return RackPair(pinion=pinion, rack=rack, mounting_distance=20.3)


def lines(view: View, pen: Pen) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Ends of all straight pieces of a pen in mm of the part, (n, 2, 2); a closed line has them all."""
    found = [each for shape in view.figure.shapes if getattr(shape, "pen", None) is pen for each in shape.segments]
    return np.array(found).reshape(-1, 2, 2) / PAPER.scale


def circles(view: View, pen: Pen) -> dict[tuple[float, float], set[float]]:
    """Radii about each centre, in mm of the part."""
    found: dict[tuple[float, float], set[float]] = {}
    for shape in view.figure.shapes:
        if isinstance(shape, Circle) and shape.pen is pen:
            centre = round(shape.centre[0] / PAPER.scale, 6), round(shape.centre[1] / PAPER.scale, 6)
            found.setdefault(centre, set()).add(shape.radius / PAPER.scale)
    return found


def test_pieces_are_inside_or_outside_as_their_points_are() -> None:
    generator = np.random.default_rng(5)
    for _ in range(60):
        angles = np.sort(generator.uniform(0, math.tau, 7))
        polygons = [
            tuple(
                map(
                    tuple,
                    generator.uniform(-3, 3, 2)
                    + np.stack([np.cos(angles), np.sin(angles)], -1) * generator.uniform(1, 4, (7, 1)),
                )
            )
            for _ in range(3)
        ]
        start, end = map(tuple, generator.uniform(-6, 6, (2, 2)))
        found = list(pieces((start, end), polygons))
        assert found[0][0][0] == start and found[-1][0][1] == end
        shares = generator.uniform(0, 1, 40)
        points = np.array(start) + shares[:, None] * (np.array(end) - np.array(start))
        inside = np.any([Outline(polygon).contains_points(points) for polygon in polygons], axis=0)
        for (one, other), where in found:
            low, high = (
                np.linalg.norm(np.array(each) - start) / np.linalg.norm(np.array(end) - start) for each in (one, other)
            )
            within = (shares > low + 1e-6) & (shares < high - 1e-6)
            assert np.all(inside[within] == (where is Where.INSIDE))


def test_a_line_along_an_edge_is_neither_before_nor_behind() -> None:
    square = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
    found = [(where, start[0], end[0]) for (start, end), where in pieces(((-1.0, 2.0), (3.0, 2.0)), [square])]
    assert found == [(Where.OUTSIDE, -1.0, 0.0), (Where.EDGE, 0.0, 2.0), (Where.OUTSIDE, 2.0, 3.0)]


# ---------------------------------------------------------------------- pairs


@pytest.mark.parametrize("pair", [external(), read_spec(templates() / "ring-22-70.toml").pair], ids=["external", "ring"])
def test_pitch_circles_touch_between_axes_at_the_centre_distance(pair: GearPair) -> None:
    view, distance = pair_face(pair, PAPER), abs(pair.centre_distance)
    found = circles(view, Pen.CENTRE)
    upper, lower = min(found[0.0, round(distance, 6)]), min(found[0.0, 0.0])
    assert upper + math.copysign(lower, pair.wheel.teeth) == pytest.approx(pair.centre_distance, abs=EXACT) or (
        lower - upper == pytest.approx(distance, abs=EXACT)
    )
    assert lower / upper == pytest.approx(abs(pair.gear_ratio), rel=1e-12)
    tips = circles(view, Pen.OUTLINE)
    assert abs(pair.pinion.tip_diameter) / 2 in tips[0.0, round(distance, 6)]
    assert abs(pair.wheel.tip_diameter) / 2 in tips[0.0, 0.0]


def test_what_the_pinions_teeth_hide_is_dashed() -> None:
    """The wheel's tip line behind the pinion's tooth, as wide as the pinion; beside it, it is seen."""
    pair = external()
    view, tip = pair_section(pair, PAPER), pair.wheel.tip_diameter / 2
    (hidden,) = lines(view, Pen.HIDDEN)
    assert sorted(hidden[:, 0]) == pytest.approx([-5.0, 5.0], abs=EXACT)
    assert hidden[:, 1] == pytest.approx([tip, tip], abs=EXACT)
    level = [each for each in lines(view, Pen.OUTLINE) if np.all(np.abs(each[:, 1] - tip) < EXACT)]
    assert sorted(sorted(each[:, 0]) for each in level) == [pytest.approx([-8.0, -5.0]), pytest.approx([5.0, 8.0])]


def test_hatching_ends_at_the_roots_and_goes_two_ways() -> None:
    pair = external()
    found = [shape for shape in pair_section(pair, PAPER).figure.shapes if isinstance(shape, Hatching)]
    assert {shape.angle for shape in found} == {45.0, 135.0}
    upper = max(y for shape in found for edge in shape.edges for _, y, _ in edge) / PAPER.scale
    assert upper == pytest.approx(pair.centre_distance + pair.pinion.root_diameter / 2, abs=EXACT)
    lower = min(y for shape in found for edge in shape.edges for _, y, _ in edge) / PAPER.scale
    assert lower == pytest.approx(-pair.wheel.root_diameter / 2, abs=EXACT)


def test_a_ring_of_no_rim_is_shown_as_far_as_its_bolts_need() -> None:
    body = Body(bolt_circle=155.0, bolt_holes=8, bolt_diameter=6.6)
    pair = GearPair(pinion=gear(20, 20.0), wheel=Gear(teeth=-66, normal_module=2.0, face_width=24.0, body=body))
    faces = [shape for shape in pair_section(pair, PAPER).figure.shapes if isinstance(shape, Hatching)]
    heights = [y / PAPER.scale for shape in faces for edge in shape.edges for _, y, _ in edge]
    assert (max(heights), min(heights)) == pytest.approx((77.5 + 6.6, -77.5 - 6.6), abs=EXACT)
    rims = [radius for radii in circles(pair_face(pair, PAPER), Pen.THIN).values() for radius in radii]
    assert max(rims) == pytest.approx(77.5 + 6.6)


def test_a_rack_stands_at_its_mounting_distance_and_its_pitch_line_touches() -> None:
    pair = racked()
    view = pair_face(pair, PAPER)
    ((centre, radii),) = circles(view, Pen.CENTRE).items()
    levels = [each[0, 1] for each in lines(view, Pen.CENTRE) if abs(each[0, 1] - each[1, 1]) < EXACT]
    assert centre == (0.0, 20.3)
    assert any(abs(20.3 - min(radii) - level) < EXACT for level in levels)
    assert lines(view, Pen.OUTLINE)[:, :, 1].min() == pytest.approx(-pair.rack.height, abs=EXACT)


def test_no_ring_is_seen_through_the_bore_of_its_pinion() -> None:
    pair = read_spec(templates() / "ring-22-70.toml").pair
    bore, middle = pair.pinion.body.bore / 2, abs(pair.centre_distance)
    upright = [each for each in lines(pair_section(pair, PAPER), Pen.OUTLINE) if abs(each[0, 0] - each[1, 0]) < EXACT]
    in_bore = [each for each in upright if abs(each[:, 1].mean() - middle) < bore]
    assert {round(abs(each[0, 0]), 6) for each in in_bore} == {pair.pinion.face_width / 2}


# ---------------------------------------------------------------------- trains


def unequal() -> PlanetaryTrain:
    """Five planets as near to equal angles as the teeth let them stand."""
    ring = gear(-67, 14.0, tip_alteration=-0.1, body=Body(rim_diameter=160.0))
    centrals = (Central(name="sun", gear=gear(25, 14.0), meshes="planet"), Central(name="ring", gear=ring, meshes="planet"))
    rims = (Rim(name="planet", gear=gear(21, 14.0, body=Body(bore=12.0))),)
    given: dict[str, Any] = {"input": "sun", "output": "carrier", "fixed": "ring", "planet_angles": "permitted"}
    return PlanetaryTrain(planets=5, centrals=centrals, rims=rims, **given)


def test_members_are_called_by_words_unless_they_have_names() -> None:
    plan = PosedTrain(read_spec(templates() / "planetary-24-21-66.toml").train)
    items = {key: number for number, key in enumerate(plan.layout.bodies, 1)}
    found = {row.key: row for row in train_rows(plan, items, SheetWords.of(Language.SWEDISH))}
    assert found["ratio"].words == "Utväxling solhjul : planethållare" and found["fixed"].text == "Ringhjul"


def test_planets_stand_where_the_train_has_them() -> None:
    train = unequal()
    found = circles(train_face(PosedTrain(train), PAPER), Pen.OUTLINE)
    poses = train.pose().planets
    turn = math.radians(90 - poses[0].angle)
    for pose in poses:
        at = complex(pose.x, pose.y) * complex(math.cos(turn), math.sin(turn))
        nearest = min(found, key=lambda centre: abs(complex(*centre) - at))
        assert abs(complex(*nearest) - at) < 1e-5
        assert train.rims[0].gear.tip_diameter / 2 in found[nearest]
    assert {abs(central.gear.tip_diameter) / 2 for central in train.centrals} <= found[0.0, 0.0]


def test_of_stepped_planets_the_rim_behind_the_larger_one_is_dashed() -> None:
    """Rim 3 begins at z = 0 and is larger; seen from above it is behind rim 3p, which hides nothing of it."""
    train = alm_train()
    view = train_face(PosedTrain(train), PAPER)
    tips = {rim.name: rim.gear.tip_diameter / 2 for rim in train.rims}
    assert tips["rim_3"] > tips["rim_3p"]
    assert not circles(view, Pen.HIDDEN).get((0.0, 69.0))
    turned = replace(train.rims[1], axial_position=-20.0)
    other = train_face(PosedTrain(replace(train, rims=(train.rims[0], turned), stages=(), input="carrier")), PAPER)
    assert circles(other, Pen.HIDDEN)[0.0, 69.0] == {tips["rim_3p"]}


def test_stages_are_turned_into_the_plane_at_their_centre_distance() -> None:
    plan = PosedTrain(alm_train())
    assert [body.height for body in plan.stages] == [135.0, 0.0]
    view = train_section(plan, {key: 1 for key in (*plan.layout.bodies, "carrier")}, PAPER)
    levels = {round(each[0, 1], 6) for each in lines(view, Pen.CENTRE) if abs(each[0, 1] - each[1, 1]) < EXACT}
    assert {135.0, 69.0, 0.0, -69.0} <= levels


# ---------------------------------------------------------------------- sheets


@cache
def starter(name: str) -> Any:
    return read_spec(templates() / f"{name}.toml")


def drawn(design: Any, **options: Any) -> DrawingSheet:
    if hasattr(design, "train"):
        return draw_train(DrawnTrain(name=design.name, train=design.train), DrawingOptions(**options))
    mate = design.pair.rack if hasattr(design.pair, "rack") else design.pair.wheel
    roles = {"pinion": design.pair.pinion, ("rack" if mate.name == "rack" else "wheel"): mate}
    parts = tuple(DrawnGear(role=role, gear=each) for role, each in roles.items())
    return draw_pair(DrawnPair(name=design.name, pair=design.pair, parts=parts), DrawingOptions(**options))  # type: ignore[arg-type]


@cache
def sheet_of(name: str) -> DrawingSheet:
    return drawn(starter(name))


def looked_up(document: dict[str, Any], key: str) -> Any:
    """What stands under a key with dots; names of meshes and stages have none."""
    found: Any = document
    for part in key.split("."):
        found = found[part]
    return found


@pytest.mark.parametrize("name", STARTERS)
def test_numbers_are_those_of_the_documents(name: str) -> None:
    design = starter(name)
    sheet, document = sheet_of(name), design.to_dict()
    shown = {key: value for key, value in sheet.shown.items() if "tolerances" not in key}
    assert len(shown) >= 6
    for key, value in shown.items():
        assert value == looked_up(document, key), key


@pytest.mark.parametrize("name", ["fzg-c", "planetary-alm"])
def test_every_item_has_a_line_and_a_balloon(name: str) -> None:
    sheet = sheet_of(name)
    shapes = sheet.figure.shapes
    numbers = [shape for shape in shapes if isinstance(shape, Text) and shape.height == 5.0 and shape.words.isdigit()]
    balloons = [number.words for number in numbers]
    listed = [text.words for text in sheet.figure.texts]
    assert sorted(balloons) == [str(number + 1) for number in range(len(balloons))]
    assert len(balloons) == {"fzg-c": 2, "planetary-alm": 7}[name]
    assert all(listed.count(number) >= 2 for number in balloons)
    rings = [shape.vertices for shape in shapes if isinstance(shape, Polyline) and len(shape.vertices) == 2 and shape.closed]
    around = {((one[0] + other[0]) / 2, one[1]) for one, other in rings if one[1:] == other[1:] and one[2] == 1.0}
    for number in numbers:
        assert min(math.dist(number.at, centre) for centre in around) < 1e-9


def test_a_centre_distance_has_its_limits_and_backlash_its_extremes() -> None:
    pair = external(centre_distance_tolerance="js7")
    sheet = drawn(type("Design", (), {"name": "pair", "pair": pair}), language=Language.GERMAN)
    texts = [text.words for text in sheet.figure.texts]
    assert "js7" in texts and "±0,015" in texts  # IT7 of 50 to 80 mm is 30 µm (ISO 286-1)
    limits = pair.backlash_limits
    assert limits is not None
    assert sheet.shown["pair.backlash_limits.normal_least"] == limits.normal_least
    assert not sheet.notices


def test_without_limits_the_sheet_says_so() -> None:
    assert "no-limits" in [notice.code for notice in drawn(type("Design", (), {"name": "pair", "pair": external()})).notices]
    for name in ("rack", "planetary-alm"):
        assert "no-limits" in [notice.code for notice in sheet_of(name).notices]
    assert "— (not for racks)" in [text.words for text in sheet_of("rack").figure.texts]


@pytest.mark.parametrize("name", ["spur", "reducer-21-43", "volvo-13-44", "fzg-c", "ring-22-70", "double-23-81"])
def test_sheets_of_starters_have_limits(name: str) -> None:
    """Of tooth thickness and its gauges, and of the centre distance."""
    design = starter(name)
    codes = {notice.code for each in drawn_gears(design) for notice in gear_notices(each)}
    assert "no-thickness-limits" not in codes
    assert name == "spur" or design.pair.centre_distance_tolerance == "js7"


def test_parts_are_called_as_their_own_sheets_are() -> None:
    pair = external()
    parts = tuple(DrawnGear(role=role, gear=each) for role, each in (("pinion", pair.pinion), ("wheel", pair.wheel)))
    own = {"wheel": PartDrawing(number="W-7", title="Bull wheel", material="42CrMo4")}
    sheet = draw_pair(DrawnPair(name="pair", pair=pair, parts=parts), DrawingOptions(number="A-1"), own)  # type: ignore[arg-type]
    texts = {text.words for text in sheet.figure.texts}
    assert {"W-7", "Bull wheel", "42CrMo4", "A-1", "Pinion"} <= texts


def test_what_has_no_room_is_refused() -> None:
    with pytest.raises(ParameterError, match="1:5"):
        drawn(starter("double-23-81"), sheet=SheetSize.A3, scale="1:1")


def test_it_is_seen_which_circles_are_drawn() -> None:
    """At another centre distance than the reference one, those that touch are the working pitch circles."""
    said = " ".join(text.words for text in sheet_of("fzg-c").figure.texts)
    assert "⌀73.200" in said and "⌀109.800" in said  # 2 a/(1 + u) of a = 91.5, u = 1.5; d = 72 and 108
    plain = GearPair(pinion=gear(20, 10.0), wheel=gear(31, 10.0))
    sheet = drawn(type("Design", (), {"name": "pair", "pair": plain}))
    assert "pitch circles" not in " ".join(text.words for text in sheet.figure.texts)


@pytest.mark.long
@pytest.mark.parametrize("language", Language)
@pytest.mark.parametrize("projection", Projection)
def test_nothing_overlaps_and_nothing_leaves_the_frame(language: Language, projection: Projection, tmp_path: Path) -> None:
    for name in (*STARTERS, "planetary-24-21-66", "planetary-alm-in-phase", "volvo-13-44", "alm-18-161", "reducer-21-43"):
        sheet = drawn(starter(name), language=language, projection=projection)
        document = sheet_document(sheet.figure, sheet.size, sheet.scale, title=sheet.title, language=language)
        write_dxf(document, tmp_path / "sheet.dxf")
        assert read_sheet(tmp_path / "sheet.dxf").faults == [], name


@pytest.mark.parametrize("sheet", [size for size in SheetSize if size is not SheetSize.AUTO])
def test_a_train_has_room_on_every_paper(sheet: SheetSize) -> None:
    found = drawn(starter("planetary-24-21-66"), sheet=sheet)
    assert found.size == sheet.size

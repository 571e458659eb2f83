"""The sheet of one gear: what it shows is what documents say, its views stand as the projection has them."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from gearcad import Body, Gear
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.gear_sheet import DrawingSheet, draw_gear
from gearcad.drawing.options import DrawingOptions, PartDrawing, Projection, SheetSize
from gearcad.drawing.shapes import Circle, Hatching, Pen, Point
from gearcad.drawing.words import Language
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

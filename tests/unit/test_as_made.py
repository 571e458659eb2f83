"""Teeth as they are made: distances of made outlines from nominal ones, by brute force, and moulds that shrink to the part."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.nearest import nearest

from gearcad.core.errors import InputError
from gearcad.geometry import Body, Gear, ShaperCutter
from gearcad.geometry.as_made import MadeTeeth
from gearcad.geometry.curves import Land
from gearcad.geometry.making import Making
from gearcad.geometry.premachining import Finishing, Premachining

EXACT = 1e-9
"""mm: what the outlines are asked to keep; the search by zooming ends far below."""

_PRE = Premachining(tool_addendum=1.4, tool_tip_radius=0.3, protuberance=0.14, protuberance_angle=8.0, stock=0.1)
GEARS = {
    "spur": Gear(teeth=25, normal_module=2.0, face_width=10.0, profile_shift=0.2),
    "helical": Gear(teeth=25, normal_module=2.0, face_width=10.0, helix_angle=30.0),
    "chamfered": Gear(teeth=25, normal_module=2.0, face_width=10.0, body=Body(tip_chamfer=0.2)),
    "undercut": Gear(teeth=10, normal_module=2.0, face_width=10.0),
    "ring": Gear(teeth=-60, normal_module=2.0, face_width=10.0),
    "helical ring": Gear(teeth=-60, normal_module=2.0, face_width=10.0, helix_angle=20.0, cutter=ShaperCutter(teeth=20)),
    "shaped": Gear(teeth=25, normal_module=2.0, face_width=10.0, cutter=ShaperCutter(teeth=20, tip_radius=0.2)),
    "pre-cut": Gear(teeth=25, normal_module=2.0, face_width=10.0, profile_shift=0.2, premachining=_PRE),
    "notch": Gear(
        teeth=25,
        normal_module=2.0,
        face_width=10.0,
        premachining=replace(_PRE, protuberance=0.0, protuberance_angle=None),
        finishing=Finishing(end_diameter=47.3),
    ),
}


def _samples(made: MadeTeeth, count: int) -> np.ndarray:
    curves = [curve for curve in made.profile.curves if not isinstance(curve, Land)]
    return np.concatenate([curve.points(np.linspace(0.02, 0.98, count)) for curve in curves])


@pytest.mark.parametrize("name", GEARS)
@pytest.mark.parametrize("offset", [0.15, -0.15])
def test_every_point_of_the_outline_is_the_offset_away_from_the_nominal_one(name: str, offset: float) -> None:
    """On the side that the sign says: the tooth is thicker, or thinner, on the middle of its flank."""
    gear = replace(GEARS[name], making=Making(process="mould", shrinkage_radial=1.5, offset=offset))
    made, scale = gear.as_made.made, 1 / 0.985  # type: ignore[attr-defined]
    points = _samples(made, 5 if gear.helix_angle else 9)
    away = nearest(gear, scale, points, made.twist)
    tip = scale * gear.profile.tip_form_diameter / 2
    radius = np.hypot(*points.T)
    flank_end = made.profile.involute.polar(1.0)[0]
    inside = radius > tip + 0.1 if gear.internal else radius < min(tip, flank_end)  # beyond, the flank was longer
    assert np.count_nonzero(inside) > 0.5 * len(points)
    np.testing.assert_allclose(away[inside], abs(offset), atol=EXACT)
    middle = scale * abs(gear.reference_diameter) / 2
    nominal = scale * 2 * middle / scale * math.radians(gear.profile.half_angle(middle / scale))
    thicker = 2 * middle * math.radians(made.profile.half_angle(middle)) - nominal
    assert math.copysign(1, thicker) == math.copysign(1, offset)
    assert abs(thicker) > 2 * abs(offset)


@pytest.mark.parametrize("name", ["spur", "helical", "ring"])
def test_gauges_find_what_the_offset_adds(name: str) -> None:
    """Parallel flanks: a span grows by 2 e, and so does the dimension over balls that are smaller by 2 e."""
    gear, offset = GEARS[name], 0.05
    made = replace(gear, making=Making(process="mould", offset=offset)).as_made.made  # type: ignore[attr-defined]
    ball, smaller = gear.ball_diameter, gear.ball_diameter - 2 * offset
    if not gear.internal:
        assert made.span_over(gear.span_teeth) == pytest.approx(gear.span_measurement + 2 * offset, abs=1e-12)
    nominal = gear.between_balls if gear.internal else gear.over_balls
    centre = nominal + ball if gear.internal else nominal - ball
    found = made.over_balls(smaller)
    assert (found + smaller if gear.internal else found - smaller) == pytest.approx(centre, abs=1e-10)


def test_balls_of_a_cavity_are_those_in_a_ring_whose_spaces_the_teeth_fill() -> None:
    """A cavity that is not scaled is a ring of the same module whose spaces are as wide as the teeth."""
    gear = replace(GEARS["spur"], making=Making(process="mould"))
    cavity = gear.as_made.made.cavity_document()  # type: ignore[attr-defined]
    ring = Gear(teeth=-25, normal_module=2.0, face_width=10.0, profile_shift=-0.2, tip_alteration=0.2, tip_diameter=-49.0)
    assert cavity["between_balls"] == pytest.approx(ring.inspection.between_balls(cavity["ball_diameter"]), abs=1e-9)


SHRINKAGES = [(2.0, None, None), (2.0, 1.6, 1.2), (1.5, 2.5, None)]


@pytest.mark.parametrize("shrinkages", SHRINKAGES)
@pytest.mark.parametrize("name", ["spur", "helical", "chamfered", "ring", "pre-cut"])
def test_a_part_that_shrinks_in_its_mould_is_the_nominal_one(name: str, shrinkages: tuple[float | None, ...]) -> None:
    """Radii by s_r, thicknesses on their circles by s_t, the width by s_z."""
    radial, tangential, axial = shrinkages
    making = Making(process="mould", shrinkage_radial=radial, shrinkage_tangential=tangential, shrinkage_axial=axial)
    gear = replace(GEARS[name], making=making)
    mould = gear.as_made
    across = radial if tangential is None else tangential
    for curve in mould.profile.curves[1:-1]:
        radii, halves = curve.polar(np.linspace(0, 1, 17))
        part_radii = radii * (1 - radial / 100)
        thickness = 2 * radii * halves * (1 - across / 100)
        nominal = 2 * part_radii * np.radians(gear.profile.half_angle(part_radii))
        np.testing.assert_allclose(thickness, nominal, atol=EXACT)
    along = radial if axial is None else axial
    assert mould.face_width * (1 - along / 100) == pytest.approx(gear.face_width, abs=EXACT)
    assert mould.tip_diameter * (1 - radial / 100) == pytest.approx(gear.tip_diameter, abs=EXACT)
    if gear.helix_angle:
        assert mould.lead * (1 - along / 100) == pytest.approx(gear.lead, abs=1e-9 * gear.lead)


def test_the_body_is_scaled_and_its_walls_are_moved() -> None:
    body = Body(bore=12.0, keyway_width=3.0, keyway_depth=1.4, hub_diameter=20.0, hub_length=5.0, end_chamfer=0.5)
    making = Making(process="print", shrinkage_radial=1.0, shrinkage_axial=2.0, offset=-0.1, hole_growth=0.25)
    made = Gear(teeth=25, normal_module=2.0, face_width=10.0, body=body, making=making).as_made.body
    assert made.bore == pytest.approx(12.0 / 0.99 + 0.2 + 0.25)
    assert made.keyway_width == pytest.approx(3.0 / 0.99 + 0.2)
    assert made.bore / 2 + made.keyway_depth == pytest.approx((6.0 + 1.4) / 0.99 + 0.1)  # the floor
    assert (made.hub_diameter, made.hub_length) == (pytest.approx(20.0 / 0.99 - 0.2), pytest.approx(5.0 / 0.98))
    assert made.end_chamfer == pytest.approx(0.5 / 0.98)
    assert made.end_chamfer * math.tan(math.radians(made.end_chamfer_angle)) == pytest.approx(0.5 / 0.99)


WRONG = [
    ({"kerf": 0.1}, {}, "process is missing"),
    ({"process": "cast"}, {}, 'process = \'cast\': must be "mould", "print", "wire" or "laser"'),
    ({"process": "mould", "kerf": 0.1}, {}, 'kerf = 0.1 mm: must be left out of process "mould": it is of "wire" or "laser"'),
    ({"process": "laser", "spark_gap": 0.1}, {}, 'spark_gap = 0.1 mm: must be left out of process "laser"'),
    ({"process": "wire", "shrinkage_radial": 1.0}, {}, 'shrinkage_radial = 1 %: must be left out of process "wire"'),
    ({"process": "mould", "shrinkage_radial": 50.0}, {}, "shrinkage_radial = 50 %: must be a number at least -20 %"),
    ({"process": "wire", "kerf": 1.6}, {}, "making.kerf = 1.6 mm: must be at most 1.52 mm with this spark gap and offset"),
    ({"process": "print", "offset": 0.8}, {}, "making.offset = 0.8 mm: must be at most 0.76 mm: the fillets"),
    ({"process": "print", "offset": -1.8}, {}, "making.offset = -1.8 mm: must be nearer to 0 mm: the tooth closes"),
    ({"process": "laser", "kerf": 0.2}, {"helix_angle": 10.0}, "helix_angle = 10 deg: must be 0 deg for process"),
    ({"process": "mould", "shrinkage_tangential": 19.0}, {}, "making.shrinkage_tangential = 19 %: must be nearer to 0 %"),
    ({"process": "print", "hole_growth": -8.0}, {"body": Body(bore=6.0)}, "making.hole_growth = -8 mm: must be nearer to 0"),
    ({"process": "print", "first_layer": 2.0}, {"face_width": 1.5}, "making.first_layer = 2 mm: must be below 1.5 mm"),
    (
        {"process": "print", "first_layer": 0.2},
        {"body": Body(end_chamfer=0.3)},
        "making.first_layer = 0.2 mm: must be left out",
    ),
    ({"process": "wire", "kerf": 0.6}, {"body": Body(bore=6.0, keyway_width=1.0, keyway_depth=0.2)}, "making.kerf = 0.6 mm"),
]


@pytest.mark.parametrize(("making", "changes", "message"), WRONG)
def test_what_cannot_be_made_is_refused_in_one_line(making: dict[str, Any], changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        Gear(**{"teeth": 20, "normal_module": 2.0, "face_width": 10.0, **changes}, making=Making(**making))
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)

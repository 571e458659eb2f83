"""Details of teeth and diagrams of modifications: exact outlines, circles with their names, depths of the flanks."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest

from gearcad.core.records import Floats
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.options import SCALES
from gearcad.drawing.shapes import Arc, Figure, Line, Polyline
from gearcad.drawing.views.modification_diagrams import helix_depths, modification_figures, profile_depths
from gearcad.drawing.views.tooth_detail import detail_scale, levels_of, spread, tooth_figure, tooth_outline
from gearcad.drawing.words import Draughting, Language, SheetWords
from gearcad.geometry import BasicRack, Body, DoubleHelix, FlankModification, Gear, Rack, ReliefShape, ShaperCutter
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_parts import HubSide
from gearcad.geometry.profile import parameters_within

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

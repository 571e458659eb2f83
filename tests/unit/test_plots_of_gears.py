"""Pictures of gears, pairs and meshes: what they show is where it is, and nothing is cut off or lies on anything else."""

import io
import math
import xml.etree.ElementTree as ElementTree
from base64 import b64decode
from dataclasses import replace
from inspect import signature
from itertools import combinations
from math import radians, tan
from pathlib import Path
from re import search

import numpy as np
import pytest
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from support.checks import small_check

import gearcad
from gearcad import BasicRack, Body, FlankModification, Gear, GearPair, GeometryError, Load, ParameterError, ShaperCutter, plots
from gearcad.plots.check import plot_mesh_stiffness, plot_stress_field
from gearcad.plots.gears import pair_inches, plot_body_mesh, plot_pair, plot_section_mesh, pointed_shift, undercut_shift
from gearcad.plots.paper import legend_above, new_figure, prepared
from gearcad.plots.stiffness import plot_stiffness

GEARS = {
    "spur": Gear(teeth=18, normal_module=3, face_width=20, profile_shift=0.2),
    "helical, thinned, full radius": Gear(
        teeth=14,
        normal_module=2,
        face_width=20,
        helix_angle=-25,
        tooth_thinning=0.1,
        rack=BasicRack(root_radius="full", dedendum=1.4),
    ),
}

PAIRS = {
    "external": GearPair(
        pinion=Gear(teeth=18, normal_module=3, face_width=20, helix_angle=15, tooth_thinning=0.05),
        wheel=Gear(teeth=41, normal_module=3, face_width=20, helix_angle=-15, tooth_thinning=0.05),
    ),
    "ring": GearPair(
        pinion=Gear(teeth=22, normal_module=2, face_width=20, tooth_thinning=0.03),
        wheel=Gear(teeth=-70, normal_module=2, face_width=20, tooth_thinning=0.03),
    ),
}

STEP = 1e-6
"""Of a shift: far more than rounding, far less than anybody sees."""


@pytest.mark.parametrize("name", GEARS)
def test_limits_of_the_shift_are_those_of_real_gears(name: str) -> None:
    gear = GEARS[name]
    for teeth in (9, 17, 26):
        limit = undercut_shift(gear, teeth)
        below, above = (replace(gear, teeth=teeth, profile_shift=limit + side * STEP) for side in (-1, 1))
        assert (below.undercut, above.undercut) == (True, False)
        for land in (0.2, 0.4):
            thin = replace(gear, teeth=teeth, profile_shift=pointed_shift(gear, teeth, land))
            assert thin.tip_thickness == pytest.approx(land * gear.normal_module, abs=1e-9)
    axes = plots.plot_shift_limits(gear)
    undercut = axes.get_lines()[0]
    assert undercut.get_ydata()[17 - 6] == undercut_shift(gear, 17) and undercut.get_xdata()[17 - 6] == 17
    with pytest.raises(GeometryError, match=r"^teeth = 18: must be those of an external gear that is hobbed"):
        plots.plot_shift_limits(replace(GEARS["spur"], cutter=ShaperCutter(teeth=25)))


@pytest.mark.parametrize("name", PAIRS)
def test_backlash_grows_by_twice_the_tangent_of_the_working_pressure_angle(name: str) -> None:
    pair = PAIRS[name]
    circumferential, normal, *_ = plots.plot_backlash(pair).get_lines()
    x, y = circumferential.get_data()
    slope = np.interp(0.5, x, y) - np.interp(-0.5, x, y)
    side = -1 if pair.internal else 1
    assert slope == pytest.approx(side * 2 * tan(radians(pair.working_transverse_pressure_angle)), rel=2e-3)
    assert np.interp(0, x, y) == pytest.approx(1000 * pair.circumferential_backlash, rel=1e-6)
    assert np.interp(0, *normal.get_data()) == pytest.approx(1000 * pair.normal_backlash, rel=1e-6)
    assert min(y) >= 0


def test_a_modification_is_drawn_to_its_greatest_depth() -> None:
    gear = replace(GEARS["spur"], modification=FlankModification(tip_relief=20, tip_relief_length=2.5, lead_crowning=8))
    drawn = plots.plot_modification(gear).collections[0].get_array()
    assert drawn.max() == pytest.approx(28)
    assert drawn.min() == pytest.approx(0)
    with pytest.raises(GeometryError, match=r"^modification = 'none': must be given, to be drawn"):
        plots.plot_modification(GEARS["spur"])


def test_every_picture_can_be_drawn_on_given_axes_and_is_described() -> None:
    drawing = [name for name in plots.__all__ if name == "plot" or name.startswith("plot_")]
    for name in drawing:
        assert signature(getattr(plots, name)).parameters["ax"].default is None, name
    beside = {"plot_contours", "plot_scatter", "plot_mesh_stiffness"}  # what plot_results and plot_stiffness do from numbers
    told = {
        name for name in drawing if f"{name}(" in plots.__doc__ or f"{name} " in plots.__doc__ or f"{name}\n" in plots.__doc__
    }
    assert set(drawing) - told == beside


def test_a_notebook_shows_axes_and_results() -> None:
    pair = PAIRS["external"]
    named = GearPair(pinion=pair.pinion, wheel=pair.wheel, name="a & b")
    axes = plots.plot(named)
    assert axes._repr_png_().startswith(b"\x89PNG")
    result = gearcad.stiffness(named, Load(torque=50), methods=["iso6336", "potential-energy"])
    html = result._repr_html_()
    ElementTree.fromstring(html)
    assert "a &amp; b" in html and "iso6336" in html
    assert b64decode(search(r"base64,([^\"]*)", html)[1]).startswith(b"\x89PNG")
    unlimited = gearcad.rate(named, Load(torque=50, speed=1000))  # of a material without limits there is no life to draw
    assert "strength not asked for" in unlimited._repr_html_() and "<img" not in unlimited._repr_html_()
    with pytest.raises(GeometryError, match=r"must have limits of the flank, for its life to be drawn"):
        plots.plot(unlimited)
    own = axes.figure.subplots()
    assert plots.plot(result.cycles[0], ax=own) is own
    with pytest.raises(ParameterError, match=r"^shown = 'int': must be one of Gear, GearPair,"):
        plots.plot(3)


def test_a_table_of_results_is_drawn_by_the_keys_of_its_columns(tmp_path: Path) -> None:
    table = tmp_path / "results.csv"
    table.write_text("name,status,pinion.profile_shift,pair.transverse_contact_ratio\na,ok,0.1,1.6\nb,ok,0.2,1.5\n")
    (line,) = plots.plot_results(table, "pinion.profile_shift", "transverse_contact_ratio").get_lines()
    assert list(line.get_xdata()) == [0.1, 0.2] and list(line.get_ydata()) == [1.6, 1.5]


MESHING_PAIRS = {
    "spur": GearPair(
        pinion=Gear(teeth=16, normal_module=4.5, face_width=14, profile_shift=0.18, tooth_thinning=0.05, body=Body(bore=30)),
        wheel=Gear(teeth=24, normal_module=4.5, face_width=14, profile_shift=0.17, tooth_thinning=0.05),
    ),
    "helical, odd wheel": GearPair(
        pinion=Gear(teeth=13, normal_module=2.5, face_width=18, helix_angle=28, profile_shift=0.1, tooth_thinning=0.08),
        wheel=Gear(teeth=45, normal_module=2.5, face_width=15, helix_angle=-28, tooth_thinning=0.16),
        axial_offset=1.3,
    ),
}

CHORDS = 0.02
"""mm: what the drawn outlines may be off, chords and rounded-off backlash."""


@pytest.mark.parametrize("name", MESHING_PAIRS)
def test_teeth_stand_in_spaces(name: str) -> None:
    pair = MESHING_PAIRS[name]
    axes = plot_pair(pair)
    pinion, wheel = (patch.get_xy()[:-1] for patch in axes.patches if hasattr(patch, "get_xy"))
    assert np.hypot(*pinion.T).max() == pytest.approx(pair.pinion.tip_diameter / 2, rel=1e-12)
    assert np.hypot(wheel[:, 0] - pair.centre_distance, wheel[:, 1]).max() == pytest.approx(
        pair.wheel.tip_diameter / 2, rel=1e-12
    )
    near = wheel[np.hypot(*wheel.T) < pair.pinion.tip_diameter / 2]
    radius, pitch = np.hypot(*near.T), 2 * math.pi / pair.pinion.teeth
    angle = np.abs((np.arctan2(near[:, 1], near[:, 0]) + pitch / 2) % pitch - pitch / 2)
    room = radius * (angle - np.radians(pair.pinion.profile.half_angle(radius)))
    # Clear of the pinion's teeth, and closest where half the backlash is left on each side.
    assert -CHORDS < room.min() - pair.circumferential_backlash / 2 < CHORDS + 0.1 * pair.pinion.normal_module
    assert room.min() > 0


@pytest.mark.parametrize("name", MESHING_PAIRS)
def test_path_of_contact_lies_between_the_tips(name: str) -> None:
    pair = MESHING_PAIRS[name]
    line, path = (np.asarray(drawn.get_xydata()) for drawn in plot_pair(pair).lines[-2:])
    first, last = path
    wheel = np.array([pair.centre_distance, 0.0])
    assert np.hypot(*(first - wheel)) == pytest.approx(pair.wheel.tip_form_diameter / 2, rel=1e-9)
    assert np.hypot(*last) == pytest.approx(pair.pinion.tip_form_diameter / 2, rel=1e-9)
    assert np.hypot(*line[0]) == pytest.approx(pair.pinion.base_diameter / 2, rel=1e-12)
    assert np.hypot(*(line[-1] - wheel)) == pytest.approx(pair.wheel.base_diameter / 2, rel=1e-12)


def test_picture_is_never_too_high_nor_too_low() -> None:
    alike = Gear(teeth=20, normal_module=1, face_width=5)
    assert 2.2 <= pair_inches(GearPair(pinion=alike, wheel=alike))[1] <= 5.0
    assert pair_inches(GearPair(pinion=alike, wheel=Gear(teeth=300, normal_module=1, face_width=5)))[1] == 5.0


GEAR = Gear(teeth=12, normal_module=2, face_width=6, profile_shift=0.3, body=Body(bore=8))


def outlines(axes: object) -> list[np.ndarray]:
    return [path.vertices for drawn in axes.collections for path in drawn.get_paths()]


def area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return float(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1])) / 2


@pytest.mark.parametrize("element", ["quad8", "tri6"])
def test_a_section_is_drawn_with_all_its_elements(element: str) -> None:
    result = gearcad.mesh(GEAR, what="teeth:3", element=element)
    drawn = outlines(plot_section_mesh(result.mesh))
    assert len(drawn) == len(result.mesh.cells)
    assert sum(map(area, drawn)) == pytest.approx(result.judged["gear"].whole, rel=3e-3)  # edges are drawn straight


def test_both_gears_of_a_pair_are_drawn_in_their_colours_in_a_window() -> None:
    mesh = gearcad.mesh(GearPair(pinion=GEAR, wheel=GEAR), size=1).mesh
    axes = plot_section_mesh(mesh, window=(13.0, 0.0, 3.0))
    pinion, wheel = axes.collections
    assert not np.allclose(pinion.get_facecolor(), wheel.get_facecolor())
    assert 0 < len(outlines(axes)) < len(mesh.cells) / 2
    assert axes.get_ylim() == (-3.0, 3.0)


@pytest.mark.parametrize("element", ["hex8", "hex20"])
def test_a_body_shows_its_end_and_what_it_hides_is_left_out(element: str) -> None:
    mesh = gearcad.mesh(GEAR, what="ring", element=element, size=1).mesh
    above = plot_body_mesh(mesh, pitch=90)
    faces = {name: len(mesh.sides[name]) for name in ("end_back", "end_front")}
    assert faces["end_front"] <= len(outlines(above)) <= faces["end_front"] + 0.01 * sum(map(len, mesh.sides.values()))
    below = plot_body_mesh(mesh, pitch=-90)
    assert faces["end_back"] <= len(outlines(below))


_ROUNDING = 0.5
"""Pixels by which boxes may touch."""

_MOST_EMPTY = 0.1
"""Inches that may be left at the edges."""

_SVG_DPI = 72


def wide_numbers(figure):
    axes = prepared(figure.subplots(), "place in mm", "stress in MPa")
    axes.plot([0.0, 12345678.0], [-0.000125, 0.000125], label="a long name of the only curve")
    legend_above(axes, 2)


def many_rows(figure):
    axes = prepared(figure.subplots(), r"$\sigma_{F0}$", r"$\frac{c_\gamma}{c'}$")
    for number in range(9):
        axes.plot([0, 1], [number, -number], label=f"curve {number} of those with quite long names")
    axes.secondary_xaxis("top").set_xlabel("the same in other units")
    legend_above(axes, 3, raised=34.0)


def grid(figure):
    panels = figure.subplots(3, 2, sharex=True, squeeze=False).ravel()
    for number, panel in enumerate(panels):
        prepared(panel, "speed in rpm", "load in N").plot([0, 1], [0, 10.0 ** (2 * number)], label="load")
        panel.set_title(f"shaft {number}", fontsize=9, loc="left")
    panels[1].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)


def labels_of_the_figure(figure):
    left, right = figure.subplots(1, 2, sharey=True)
    for panel in (left, right):
        panel.plot([0, 1e6], [0, 1e6], label="curve")
    figure.supxlabel("place in mm")
    figure.supylabel("compliance in µm/N")
    figure.legend(["curve"], loc="outside upper left", ncols=3)


def colour_bar(figure):
    axes = prepared(figure.subplots(), "speed in rpm", "frequency in Hz")
    figure.colorbar(ScalarMappable(), ax=axes, label="amplitude in µm", extend="max")


def fixed_aspect(figure):
    figure.set_size_inches(6.6, 3.7)  # nearly that of the axes: made wider they are lower, made higher they are narrower
    axes = figure.subplots()
    axes.set(xlim=(0, 29), ylim=(-12, 8), aspect="equal", xlabel="from the axis in mm", ylabel="across in mm")
    figure.colorbar(ScalarMappable(), ax=axes, label="stress in MPa", extend="max")


def field(figure):
    plot_stress_field(small_check(), figure.subplots())


def stiffness(figure):
    plot_mesh_stiffness(small_check(), figure.subplots())


def methods(figure):
    plot_stiffness(small_check().stiffness_methods.comparison, figure.subplots())


_DRAWN = (wide_numbers, many_rows, grid, labels_of_the_figure, colour_bar, fixed_aspect, field, stiffness, methods)


def drawn_boxes(figure, kind):
    """What axes, legends and texts of a figure take in pixels, each time that it is drawn while it is saved."""
    boxes, plain = [], Figure.draw

    def measured(self, renderer):
        plain(self, renderer)
        boxes.append([each.get_tightbbox(renderer) for each in (*self.axes, *self.legends, *self.texts)])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "draw", measured)
        figure.savefig(io.BytesIO(), format=kind)
    return boxes


@pytest.mark.parametrize(("draw", "kind"), [*((draw, "png") for draw in _DRAWN), (grid, "svg"), (stiffness, "svg")])
def test_nothing_is_cut_off_or_lies_on_anything_else(draw, kind):
    figure = new_figure((6.6, 4.8))
    draw(figure)
    (boxes,) = drawn_boxes(figure, kind)  # drawn once
    size = figure.get_size_inches() * (figure.dpi if kind == "png" else _SVG_DPI)
    for box in boxes:
        assert (box.min > -_ROUNDING).all() and (box.max < size + _ROUNDING).all()
    for pair in combinations(boxes, 2):
        common = Bbox.intersection(*pair)
        assert common is None or min(common.size) < _ROUNDING


def test_axes_fill_what_their_texts_leave():
    figure = new_figure()
    prepared(figure.subplots(), "x", "y")
    ((box,),) = drawn_boxes(figure, "png")
    assert max(*box.min, *(figure.bbox.size - box.max)) < _MOST_EMPTY * figure.dpi

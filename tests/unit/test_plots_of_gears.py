"""Pictures that a notebook asks for: limits, backlash and modifications where they are, and results that show themselves."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from base64 import b64decode
from dataclasses import replace
from inspect import signature
from math import radians, tan
from pathlib import Path
from re import search

import numpy as np
import pytest

import gearcad
from gearcad import BasicRack, FlankModification, Gear, GearPair, GeometryError, Load, ParameterError, ShaperCutter, plots
from gearcad.plots.gears import pointed_shift, undercut_shift

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

"""`identify` on published gears: what a book prints of them is read as if calipers had."""

from __future__ import annotations

import pytest
from support.cases import case

import gearcad
from gearcad import BasicRack, Gear

PRINTED = 0.005
"""Uncertainty of readings that a book prints to 0.01 mm or finer."""


def test_profile_shifted_pair_of_the_gear_technical_reference() -> None:
    """KHK Gear Technical Reference (SDP/SI D785), m 3, z 12 and 24, x 0.6 and 0.36: circles and distance as printed."""
    given, printed = case("book_khk_shifted_spur")["inputs"], case("book_khk_shifted_spur")["expected_printed"]
    pinion = Gear(teeth=12, normal_module=3, face_width=20, profile_shift=0.6)
    found = gearcad.identify(
        given["z"][0],
        tip_diameter=float(printed["da1"]),
        root_diameter=float(printed["df1"]),
        span={2: pinion.inspection.span_measurement(2)},
        helix_angle=0,
        centre_distance=float(printed["a"]),
        mate_teeth=given["z"][1],
        mate_tip_diameter=float(printed["da2"]),
        uncertainty=PRINTED,
    )
    assert found.certain and found.best.gear.normal_module == given["m"] and found.best.gear.rack.pressure_angle == 20
    assert found.best.gear.profile_shift == pytest.approx(given["x"][0], abs=0.02)


def test_helical_pinion_of_the_gear_technical_reference() -> None:
    """The same book, helical gears of the normal system: m_n 3, 30 degrees; the helix angle only as paper shows it."""
    given, printed = case("book_khk_helical_normal")["inputs"], case("book_khk_helical_normal")["expected_printed"]
    made = Gear(teeth=12, normal_module=3, face_width=20, helix_angle=30, profile_shift=given["x"][0])
    found = gearcad.identify(
        given["z"][0],
        tip_diameter=float(printed["da1"]),
        root_diameter=float(printed["df1"]),
        span={count: made.inspection.span_measurement(count) for count in (2, 3)},
        tip_helix_angle=33.0,
        centre_distance=float(printed["a"]),
        mate_teeth=given["z"][1],
        mate_tip_diameter=float(printed["da2"]),
        uncertainty=PRINTED,
    )
    best = found.best
    assert best.gear.normal_module == given["mn"] and best.gear.rack.pressure_angle == given["alpha_n"]
    assert abs(best.gear.helix_angle - given["beta"]) < 3 * best.helix_uncertainty + 0.01
    assert abs(best.gear.profile_shift - given["x"][0]) < 3 * best.shift_uncertainty + 0.001


def test_a_gear_of_no_series_has_many_names() -> None:
    """Flanks have a base pitch, no module: m 4.98 at 26.325 degrees and m 5 at 26.784 degrees are the same gear.

    Example of the abstract of "Recreating the geometry of non-standard gears" (mmsconf.eu, MMS 2022, paper 900), of which
    pi m cos(alpha) agrees to 0.0001 mm. Whatever name is found has that base pitch, and it is not called certain.
    """
    gear = Gear(
        teeth=30,
        normal_module=4.98,
        profile_shift=0.0695,
        face_width=40,
        rack=BasicRack(pressure_angle=26.325, addendum=0.795, dedendum=0.795 + 0.383, root_radius=0.2),
    )
    spans = {count: gear.inspection.span_measurement(count) for count in (4, 5, 6)}
    found = gearcad.identify(
        30, tip_diameter=gear.tip_diameter, root_diameter=gear.root_diameter, span=spans, helix_angle=0, uncertainty=PRINTED
    )
    assert not found.certain and found.fits
    for each in (found.best, *found.rivals):
        assert each.series == "free" and each.gear.base_diameter == pytest.approx(gear.base_diameter, abs=0.05)

"""Specific sliding against velocities of points that turn with their gears, and what a data sheet has of it."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from gearcad import BasicRack, Gear, GearPair, Load, Material, Rack, RackPair, plots
from gearcad.cli import main
from gearcad.rating.strength import rate_strength
from gearcad.report.strength import rate_html

EXACT = 1e-9
"""Relative: the same velocities by two ways."""

PAIRS = {
    "spur": GearPair(
        pinion=Gear(teeth=17, normal_module=2, face_width=20, profile_shift=0.3),
        wheel=Gear(teeth=43, normal_module=2, face_width=20),
    ),
    "helical": GearPair(
        pinion=Gear(teeth=21, normal_module=3, face_width=30, helix_angle=25, profile_shift=0.2),
        wheel=Gear(teeth=50, normal_module=3, face_width=30, helix_angle=-25, profile_shift=-0.1),
    ),
    "ring": GearPair(
        pinion=Gear(teeth=22, normal_module=2, face_width=20, profile_shift=0.3, rack=BasicRack(addendum=0.8)),
        wheel=Gear(teeth=-70, normal_module=2, face_width=20, profile_shift=-0.3, rack=BasicRack(addendum=0.8)),
    ),
}


def sliding_by_velocities(
    distance: float, base_radius: float, angle: float, centre: float, ratio: float
) -> tuple[float, float]:
    """zeta of pinion and wheel where they touch `distance` (mm) from T1: (v_own - v_mate)/v_own along the common tangent.

    The pinion turns at 1 rad/s about the origin, the wheel at 1/`ratio` the other way about (centre, 0), signs as of rings.
    """
    normal, tangent = np.array([math.sin(angle), math.cos(angle)]), np.array([-math.cos(angle), math.sin(angle)])
    point = base_radius * np.array([math.cos(angle), -math.sin(angle)]) + distance * normal
    x, y = point
    pinion = np.array([-y, x]) @ tangent
    wheel = -np.array([-y, x - centre]) @ tangent / ratio
    assert np.array([-y, x]) @ normal == pytest.approx(-np.array([-y, x - centre]) @ normal / ratio)  # they stay in contact
    return (pinion - wheel) / pinion, (wheel - pinion) / wheel


@pytest.mark.parametrize("name", PAIRS)
def test_specific_sliding_is_that_of_velocities(name: str) -> None:
    pair = PAIRS[name]
    path, (first, last) = pair.path_of_contact, pair.usable_path
    places = np.array([first, path.B, path.D, last, 0.4 * first + 0.6 * last])
    found = np.transpose(pair.specific_sliding_at(places))
    angle, ratio = math.radians(pair.working_transverse_pressure_angle), pair.wheel.teeth / pair.pinion.teeth
    for place, zeta in zip(places, found, strict=True):
        by_hand = sliding_by_velocities(place, pair.pinion.base_diameter / 2, angle, pair.centre_distance, ratio)
        assert zeta == pytest.approx(by_hand, rel=EXACT)
    told = pair.specific_sliding
    assert (told.pinion_A, told.wheel_A) == pytest.approx(tuple(found[0]), rel=EXACT)
    assert (told.pinion_E, told.wheel_E) == pytest.approx(tuple(found[3]), rel=EXACT)
    assert told.greatest == pytest.approx(np.abs(found[[0, 3]]).max(), rel=EXACT)
    assert np.transpose(pair.specific_sliding_at(path.C)) == pytest.approx(np.zeros((1, 2)), abs=EXACT)


def test_a_rack_slides_as_a_wheel_of_very_many_teeth() -> None:
    pinion = Gear(teeth=20, normal_module=2, face_width=20)
    rack = RackPair(pinion=pinion, rack=Rack(teeth=20, normal_module=2, face_width=20, height=20))
    wheels = (GearPair(pinion=pinion, wheel=Gear(teeth=teeth, normal_module=2, face_width=20)) for teeth in (1000, 2000))
    places = np.linspace(*rack.usable_path, 7)
    nearer, near = (np.array(wheel.specific_sliding_at(places)) for wheel in wheels)
    # What is left is in proportion to 1/z: with it taken off, to its square.
    assert np.array(rack.specific_sliding_at(places)) == pytest.approx(2 * near - nearer, abs=1e-3)


def test_a_contact_that_begins_at_the_base_circle_slides_without_limit() -> None:
    """There the pinion's flank stands still: zeta of the pinion has no finite value, and JSON has null."""
    pair = GearPair(pinion=Gear(teeth=18, normal_module=2, face_width=9), wheel=Gear(teeth=18, normal_module=2, face_width=9))
    ((own, _),) = np.transpose(pair.specific_sliding_at(0.0))
    assert math.isinf(own)


def test_the_data_sheet_has_it(tmp_path: Path) -> None:
    spec = str(tmp_path / "reducer.toml")
    CliRunner().invoke(main, ["new", "reducer", "-o", spec])
    shown = CliRunner().invoke(main, ["data", spec]).stdout
    told = json.loads(CliRunner().invoke(main, ["data", spec, "--json"]).stdout)["pair"]["specific_sliding"]
    assert "specific sliding at A, pinion" in shown and "ζ_A1" in shown
    assert told["greatest"] == max(abs(value) for key, value in told.items() if key != "greatest")


@pytest.mark.parametrize("name", PAIRS)
def test_data_have_it_along_the_path(name: str) -> None:
    pair = PAIRS[name]
    document = pair.to_dict()
    along, ends = document["specific_sliding_path"], document["specific_sliding"]
    assert (along["distance"][0], along["distance"][-1]) == pair.usable_path
    assert along["pinion"] == pytest.approx(list(pair.specific_sliding_at(along["distance"]).pinion), rel=EXACT)
    assert (along["pinion"][0], along["wheel"][-1]) == pytest.approx((ends["pinion_A"], ends["wheel_E"]), rel=EXACT)


def test_the_report_of_a_rating_draws_it() -> None:
    page = rate_html(rate_strength(PAIRS["spur"], Material(), Load(torque=10.0)), "spur")
    assert "Specific sliding along the path of contact" in page
    greatest = PAIRS["spur"].specific_sliding.greatest
    assert greatest is not None and f"The greatest is {greatest:.4g}" in page


def test_it_is_drawn_along_the_path() -> None:
    pair = PAIRS["spur"]
    pinion, wheel, *_ = plots.plot_sliding(pair).get_lines()
    assert pinion.get_ydata()[0] == pytest.approx(pair.specific_sliding.pinion_A)
    assert wheel.get_ydata()[-1] == pytest.approx(pair.specific_sliding.wheel_E)

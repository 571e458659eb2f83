"""Pairs with a ring: own closed forms computed apart, the example of KHK, the public table of SDP/SI, and geometry by hand.

The sections of the pairs of `internal_pairs.json`, posed by its numbers, do not overlap in nine positions, nor 2 µm before
their backlash is used up, and do 2 µm behind.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from support.cases import half_unit
from support.published import Published

from gearcad import BasicRack, Gear, GearPair
from gearcad.core.records import Role
from gearcad.geometry import ShaperCutter
from gearcad.geometry.interference import InternalTips, ToothTips

EXACT = 1e-10

GRID = 5e-8
"""Their margin of radial assembly is the least of 20,001 places over a quarter turn, ours the least of all."""

_FILE = Path(__file__).parent.parent / "data" / "internal_pairs.json"
CASES: dict[str, dict[str, Any]] = {entry["id"]: entry for entry in json.loads(_FILE.read_text(encoding="utf-8"))}
cases = pytest.mark.parametrize("name", CASES)


def _pair(name: str, face_width: float = 20.0) -> GearPair:
    given = CASES[name]["inputs"]

    def gear(index: int, **cut: Any) -> Gear:
        radius = given["root_radius"][index]
        rack = {key: given[key][index] for key in ("addendum", "dedendum")}
        return Gear(
            teeth=given["teeth"][index],
            normal_module=given["normal_module"],
            face_width=face_width,
            helix_angle=given["helix_angle"][index],
            profile_shift=given["profile_shift"][index],
            tooth_thinning=given["tooth_thinning"][index],
            rack=BasicRack(
                pressure_angle=given["pressure_angle"], **rack, **({} if radius is None else {"root_radius": radius})
            ),
            **cut,
        )

    cutter = ShaperCutter(teeth=given["cutter_teeth"], tip_radius=given["cutter_tip_radius"])
    return GearPair(pinion=gear(0), wheel=gear(1, cutter=cutter), centre_distance=given["centre_distance"])


@cases
def test_pair_and_its_gears(name: str) -> None:
    pair, expected = _pair(name), CASES[name]["expected"]
    path = expected["path_of_contact"]
    assert pair.path_of_contact == pytest.approx([path[key] for key in "ABCDE"], rel=EXACT)
    assert pair.base_tangent.length == pytest.approx(expected["line_of_action_T1T2"], rel=EXACT)
    for key in ("tip_diameter", "root_diameter", "form_diameter"):
        assert [getattr(gear, key) for gear in pair.gears] == pytest.approx(expected[f"{key}s"], rel=EXACT)
    for key in ("centre_distance", "reference_centre_distance", "working_transverse_pressure_angle", "gear_ratio",
                "working_pitch_diameters", "active_root_diameters", "transverse_contact_ratio", "circumferential_backlash",
                "tip_clearances"):  # fmt: skip
        assert getattr(pair, key) == pytest.approx(expected[key], rel=EXACT), key
    assert pair.notices == ()
    known = {"path_of_contact", "line_of_action_T1T2", "margin_involute_mm", "margin_trochoid_mm", "margin_radial_mm"}
    assert len(expected) == 3 + 9 + len(known)


@cases
def test_margins_of_interference(name: str) -> None:
    """Their trochoid margin has half of the backlash on either side; ours is that of flanks in contact, as they run."""
    pair, expected = _pair(name), CASES[name]["expected"]
    margins = pair.interference_margins
    assert margins is not None
    assert margins.involute == pytest.approx(expected["margin_involute_mm"], rel=EXACT)
    half = pair.circumferential_backlash / 2 * pair.wheel.tip_diameter / pair.working_pitch_diameters.wheel
    assert margins.trochoid + half == pytest.approx(expected["margin_trochoid_mm"], rel=EXACT)
    assert margins.radial == pytest.approx(expected["margin_radial_mm"], rel=GRID)
    assert margins.radial <= expected["margin_radial_mm"]


@cases
def test_least_radial_margin_is_found(name: str) -> None:
    pair = _pair(name)
    r_1, r_2 = (gear.profile.tip_diameter / 2 for gear in pair.gears)
    psi_1, theta_2 = (math.radians(gear.profile.half_angle(gear.profile.tip_diameter / 2)) for gear in pair.gears)
    z_1, z_2 = (gear.tooth_count for gear in pair.gears)
    eta_2 = math.pi / z_2 - theta_2
    found = minimize_scalar(
        lambda u: r_2 * math.sin(u * z_1 / z_2 + eta_2) - r_1 * math.sin(u + psi_1),
        bounds=(0, math.pi / 2),
        method="bounded",
        options={"xatol": 1e-12},
    )
    assert pair.interference_margins is not None
    assert pair.interference_margins.radial == pytest.approx(found.fun, rel=1e-9)


KHK = {"alpha_wt": "31.0937", "a": "13.1683", "db1": "45.105", "db2": "67.658", "dw1": "52.673", "dw2": "79.010",
       "da1": "54.000", "da2": "69.000", "df1": "40.500", "df2": "82.500"}  # fmt: skip
"""Printed for m 3, z 16/24, x 0/+0.5 (SDP/SI D785, profile shifted internal gear); alpha_wt is 0.8 units off."""


def test_example_of_khk(published: Published) -> None:
    """KHK writes z2 = 24 and x2 = +0.5 for our -24 and -0.5."""
    pinion = Gear(teeth=16, normal_module=3, face_width=20)
    ring = Gear(teeth=-24, normal_module=3, face_width=20, profile_shift=-0.5, tip_diameter=-69.0)
    pair = GearPair(pinion=pinion, wheel=ring)
    found = {"alpha_wt": pair.working_transverse_pressure_angle, "a": -pair.centre_distance}
    for role, gear in pair.gears.items():
        sizes = {"db": gear.base_diameter, "dw": pair.working_pitch_diameters.pick(role)}
        sizes |= {"da": gear.tip_diameter, "df": gear.root_diameter}
        found |= {f"{key}{1 if role is Role.PINION else 2}": abs(size) for key, size in sizes.items()}
    assert found.keys() == KHK.keys()
    for key, text in KHK.items():
        units = 2 if key == "alpha_wt" else 1
        within = units * half_unit(text) * (1 + 1e-9)
        published(key, found[key], text, within, "SDP/SI D785, profile shifted internal gear, m 3, z 16/24")


INFEED = {15: 34, 16: 34, 17: 35, 18: 36, 19: 37, 20: 38, 21: 39, 22: 40, 24: 42, 25: 43, 28: 46, 30: 48, 31: 49, 32: 50,
          33: 51, 34: 52, 35: 53, 38: 56, 40: 58, 42: 60, 44: 62, 48: 66, 50: 68, 56: 74, 60: 78, 64: 82, 66: 84, 80: 98,
          96: 114, 100: 118}  # fmt: skip
"""SDP/SI D785, table 5-3a: the least ring that a pinion cutter of so many teeth is fed into radially without trimming it."""


@pytest.mark.parametrize("teeth", INFEED)
def test_least_ring_for_radial_infeed_of_sdp(teeth: int) -> None:
    """20 degrees, no shifts, addendum 1 of the ring and 1.25 of the cutter; 33 would be free of z_0 = 15, if its tip (r = 15.5)
    were outside its base circle (15.506)."""
    angle = math.radians(20)
    inv, cosine = math.tan(angle) - angle, math.cos(angle)
    tip, base = teeth / 2 + 1.25, teeth / 2 * cosine
    roll = math.sqrt(tip**2 - base**2) / base
    half = math.pi / 2 / teeth + inv
    cutter = ToothTips(teeth, base, half, ((tip, half - roll + math.atan(roll)),))

    def free(ring: int) -> bool:
        if ring / 2 - 1 <= ring / 2 * cosine:
            return False
        mate = ToothTips.sharp(ring, ring / 2 * cosine, math.pi / 2 / ring - inv, ring / 2 - 1)
        return InternalTips(cutter, mate, (ring - teeth) / 2).radial_margin >= 0

    assert free(INFEED[teeth]) and not free(INFEED[teeth] - 1)


# ---------------------------------------------------------------------- by hand: the plane, the line of action, slices


def _on_line_of_action(pair: GearPair, axis: float, radius: float) -> float:
    """Distance from T1 (mm) at which the line of action leaves a circle about an axis; both axes are on x, the ring's at 0."""
    angle = math.radians(pair.working_transverse_pressure_angle)
    a = -pair.centre_distance
    # T1 is the foot on the line from the pinion's axis; the line runs across the line of centres, to the pinion's left flanks.
    foot = np.array([a + pair.pinion.base_diameter / 2 * math.cos(angle), -pair.pinion.base_diameter / 2 * math.sin(angle)])
    way = np.array([math.sin(angle), math.cos(angle)])
    rest = foot - [axis, 0.0]
    along = float(rest @ way)
    return -along + math.sqrt(along**2 - float(rest @ rest) + radius**2)


@cases
def test_ends_of_contact_and_active_circles_in_the_plane(name: str) -> None:
    pair = _pair(name)
    pinion, ring = (gear.profile for gear in pair.gears)
    a = -pair.centre_distance
    first = _on_line_of_action(pair, 0.0, ring.tip_diameter / 2)
    last = _on_line_of_action(pair, a, pinion.tip_diameter / 2)
    assert (pair.path_of_contact.A, pair.path_of_contact.E) == pytest.approx((first, last), rel=1e-12)
    ends = (_on_line_of_action(pair, a, pinion.form_diameter / 2), _on_line_of_action(pair, 0.0, ring.form_diameter / 2))
    assert pair.usable_path == pytest.approx((max(first, ends[0]), min(last, ends[1])), rel=1e-12)
    margins = pair.interference_margins
    assert margins is not None
    assert (margins.pinion_fillet, margins.wheel_fillet) == pytest.approx((first - ends[0], ends[1] - last), rel=1e-9)
    for diameter, axis, place in zip(pair.active_root_diameters, (a, 0.0), (first, last), strict=True):
        assert _on_line_of_action(pair, axis, abs(diameter) / 2) == pytest.approx(place, rel=1e-12)


@pytest.mark.parametrize("name", [name for name in CASES if "helical" in name])
@pytest.mark.parametrize("width", [9.0, 31.0])
def test_lines_of_contact_of_helical_pairs_slice_by_slice(name: str, width: float) -> None:
    """In a slice, a left flank touches where its roll length takes the line of action, if both tips reach there."""
    pair = _pair(name, width)
    pinion, ring = (gear.profile for gear in pair.gears)
    slices = 40_001
    z = (np.arange(slices) + 0.5) * width / slices
    twist = np.tan(math.radians(pair.pinion.helix_angle)) / (pair.pinion.reference_diameter / 2) * z
    working = math.radians(pair.working_transverse_pressure_angle)
    base, tangent = pinion.base_diameter / 2, -pair.centre_distance * math.sin(working)
    # The flank leaves its base circle at half the base tooth angle from the middle of its tooth; T1 is at -alpha_wt.
    at_pitch_point = math.tan(working) - working - math.radians(pinion.base_half_angle)
    for turn in np.linspace(-0.5, 0.7, 5) * 360 / pair.pinion.teeth:
        middle = twist[slices // 2]
        start = at_pitch_point + math.radians(turn) + twist - middle + math.radians(pinion.base_half_angle)
        teeth = 2 * math.pi / pair.pinion.teeth * np.arange(-12, 13)[:, None]
        roll = base * (start + teeth + working)
        inside = (roll > 0) & (np.hypot(base, roll) <= pinion.tip_diameter / 2)
        inside &= np.hypot(ring.base_diameter / 2, tangent + roll) >= ring.tip_diameter / 2
        total = inside.sum() * width / slices / math.cos(math.radians(pair.pinion.base_helix_angle))
        assert pair.contact_line_length(turn) == pytest.approx(total, abs=width * 6 / slices)
    across = width * math.tan(math.radians(abs(pair.pinion.base_helix_angle)))
    assert pair.overlap_ratio == pytest.approx(across / pair.pinion.transverse_base_pitch, rel=1e-12)
    assert pair.contact_line_lengths.mean == pytest.approx(
        pair.transverse_contact_ratio * width / math.cos(math.radians(pair.pinion.base_helix_angle)), rel=1e-12
    )

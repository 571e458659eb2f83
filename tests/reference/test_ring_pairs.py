"""Pairs with a ring, and roots cut by a pinion-type shaper cutter: closed forms, KHK's example, brute force."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from support.cases import data_rows, half_unit
from support.published import Published
from support.rings import Cutter, half_space_angle

from gearcad import BasicRack, Gear, GearPair
from gearcad.core.records import Role
from gearcad.geometry import ShaperCutter
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.fillets import ShaperTip
from gearcad.geometry.gear_tools import full_corner_radius
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


ENVELOPE = 1e-12
"""mm, what the project promises being 1e-9: closed form and brute force agree to rounding, 5e-14 mm."""


def _gear(teeth: int, cutter: int | None, tip_radius: float | None, **inputs: Any) -> Gear:
    shaper = ShaperCutter(teeth=cutter, tip_radius=tip_radius, profile_shift=inputs.pop("cutter_shift", 0.0))
    return Gear(teeth=teeth, cutter=shaper, **{"normal_module": 2.0, "face_width": 10.0} | inputs)


RINGS = {
    "spur": _gear(-70, 25, 0.15, normal_module=2.8, profile_shift=-1.2025),
    "shifted cutter": _gear(-48, 25, 0.3, profile_shift=-0.2, cutter_shift=0.1),
    "thinned": _gear(-100, 34, 0.2, normal_module=3.0, tooth_thinning=0.12, cutter_shift=-0.05),
    "right hand": _gear(-75, 27, 0.25, normal_module=2.7, profile_shift=-0.16, helix_angle=15.0, cutter_shift=0.1),
    "left hand": _gear(-60, 22, 0.3, normal_module=4.0, profile_shift=0.3, helix_angle=-28.0, rack=BasicRack(addendum=0.9)),
    "steep": _gear(-90, 40, 0.2, helix_angle=45.0),
    "25 degrees": _gear(
        -90, 30, 0.1, normal_module=1.5, profile_shift=0.4, cutter_shift=0.2, rack=BasicRack(pressure_angle=25, dedendum=1.2)
    ),
    "sharp cutter": _gear(-70, 30, 0.0),
    "full radius": _gear(-70, 30, None, rack=BasicRack(root_radius="full")),
    "cutter nearly as large": _gear(-70, 60, None),
    "small module": _gear(-300, 50, 0.2, normal_module=0.01),
    "large module": _gear(-30, 14, 0.1, face_width=20.0, normal_module=200.0, profile_shift=-0.6, rack=BasicRack(addendum=0.6)),
    "root diameter given": _gear(-70, 25, 0.15, root_diameter=-144.0),
    "form root": _gear(-70, None, 0.15, normal_module=2.8, profile_shift=-1.2025),
    "helical form root": _gear(-75, None, 0.25, normal_module=2.7, profile_shift=-0.46, helix_angle=15.0, tooth_thinning=0.05),
    "full form root": _gear(-40, None, None, rack=BasicRack(root_radius="full"), profile_shift=-0.5),
    "many teeth": _gear(-2000, 100, 0.2),
}
SHAPED = {
    "spur": _gear(30, 25, 0.2),
    "helical": _gear(30, 25, 0.2, helix_angle=25.0, profile_shift=0.2, cutter_shift=0.1),
    "thinned": _gear(41, 30, 0.25, tooth_thinning=0.1, helix_angle=-15.0),
    "sharp": _gear(30, 25, 0.0),
    "full radius": _gear(30, 25, None, rack=BasicRack(root_radius="full")),
    "undercut": _gear(10, 25, 0.2),
    "undercut, helical, thinned": _gear(10, 25, 0.1, helix_angle=-20.0, tooth_thinning=0.05),
    "undercut, sharp": _gear(12, 50, 0.0),
    "undercut, few teeth": _gear(8, 30, 0.1, profile_shift=0.5),
    "many cutter teeth": _gear(20, 200, 0.3),
}


@pytest.mark.parametrize("gear", [*RINGS.values(), *SHAPED.values()], ids=[f"{kind} {name}" for kind, group in (
    ("ring", RINGS), ("external", SHAPED)) for name in group])  # fmt: skip
def test_envelope_by_brute_force(gear: Gear) -> None:
    """Fillet and involute, without any use of the normal; lengths per millimetre of module where it is large."""
    tool = gear.profile.tool
    assert isinstance(tool, ShaperTip)
    cutter = Cutter.of(gear, tool.radius / gear.normal_module)
    root, form, tip = (abs(size) / 2 for size in (gear.root_diameter, gear.form_diameter, gear.tip_diameter))
    radii = np.concatenate([np.linspace(root, form, 12)[1:], np.linspace(form, tip, 6)[1:]])
    found = math.pi / gear.tooth_count - np.radians(gear.profile.half_angle(radii))
    swept = [half_space_angle(gear, cutter, radius) for radius in radii]
    assert found * radii == pytest.approx(np.array(swept) * radii, abs=max(ENVELOPE, 2e-14 * root), rel=0)


def test_what_was_looked_at() -> None:
    """The undercut ones are undercut, and the full radii leave no root land."""
    assert {name for name, gear in SHAPED.items() if gear.undercut} == {name for name in SHAPED if name.startswith("undercut")}
    assert not any(ring.undercut for ring in RINGS.values())
    for gear in (RINGS["full radius"], RINGS["full form root"], SHAPED["full radius"]):
        assert gear.profile.curves[0].kind is CurveKind.FILLET
        assert full_corner_radius(gear) * gear.normal_module == gear.profile.tool.radius


_FIGURES = {name: [*map(float, figures)] for name, *figures in data_rows("ring_fillets")}
VALUES = [
    (name, *figures[:3], [figures[first : first + 3] for first in range(3, len(figures), 3)])
    for name, figures in _FIGURES.items()
]
"""Root form diameter, full radius in modules, tip diameter of the cutter, and points of the fillet: theta (degrees), radius,
half space angle (rad). Computed apart, with a brute-force envelope that agreed to 3.2e-13 mm."""


@pytest.mark.parametrize(("name", "form", "full", "tip", "points"), VALUES, ids=[value[0] for value in VALUES])
def test_values(name: str, form: float, full: float, tip: float, points: list[list[float]]) -> None:
    ring = RINGS[name]
    tool = ring.profile.tool
    assert isinstance(tool, ShaperTip)
    assert ring.form_diameter == pytest.approx(form, rel=EXACT)
    assert full_corner_radius(ring) == pytest.approx(full, rel=EXACT)
    assert 2 * tool.tip_radius == pytest.approx(tip, rel=EXACT)
    for theta, radius, angle in points:
        assert tool.cut(math.radians(theta)) == pytest.approx((radius, angle), rel=EXACT)


FULL_RADII = {
    None: {-40: (0.464, 0.411, 0.305, 0.140), -60: (0.467, 0.432, 0.362, 0.257), -200: (0.470, 0.460, 0.440, 0.409)},
    25: {-60: (0.292, 0.373, 0.334, 0.238), -80: (0.332, 0.373, 0.346, 0.276), -200: (0.362, 0.373, 0.363, 0.337)},
}
"""Full radius in modules for x = 0.5, 0, -0.5, -1 by number of teeth, without a cutter and with one of 25 teeth."""


@pytest.mark.parametrize("cutter", FULL_RADII)
def test_full_radii(cutter: int | None) -> None:
    for teeth, expected in FULL_RADII[cutter].items():
        ring = _gear(teeth, cutter, 0.1, rack=BasicRack(addendum=0.1))
        found = [full_corner_radius(replace(ring, profile_shift=shift)) for shift in (0.5, 0.0, -0.5, -1.0)]
        assert found == pytest.approx(expected, abs=6e-4)


@pytest.mark.parametrize("changes", [{}, {"helix_angle": 25.0}, {"tooth_thinning": 0.1, "profile_shift": 0.3}, {"teeth": 10}])
def test_a_cutter_of_very_many_teeth_is_a_rack(changes: dict[str, Any]) -> None:
    """The difference of the outlines goes with 1/z_0."""
    rack = _gear(**{"teeth": 30, "cutter": None, "tip_radius": None, **changes})
    radii = np.linspace(rack.root_diameter / 2, rack.tip_diameter / 2, 40)[1:-1]

    def off(teeth: int) -> Any:
        shaped = replace(rack, cutter=ShaperCutter(teeth=teeth))
        return np.radians(shaped.profile.half_angle(radii) - rack.profile.half_angle(radii)) * radii

    far, near = off(1000), off(2000)
    assert np.abs(near).max() < 4e-3
    fillet = np.abs(near) > 1e-4
    assert fillet.any()
    assert far[fillet] / near[fillet] == pytest.approx(2.0, abs=0.05)  # but for 1/z_0²


@pytest.mark.parametrize("gear", [*RINGS.values(), *SHAPED.values()])
def test_inverse_without_loss_near_the_root(gear: Gear) -> None:
    """theta of a radius, and that radius back, from a millionth of the corner on."""
    tool = gear.profile.tool
    last = gear.profile._last_theta
    theta = np.concatenate([[0.0], last * np.logspace(-6, 0, 200)])
    radius = tool.cut(theta)[0]
    found = tool.theta_at(radius, last)
    assert tool.cut(found)[0] == pytest.approx(radius, rel=4e-16)
    # A radius is known to its last digit, and goes with theta squared.
    root = abs(gear.root_diameter) / 2
    slope = np.maximum(np.abs(np.gradient(radius, theta)), 1e-30)
    assert np.all((np.abs(found - theta) < 4e-16 * root / slope + 2e-14)[20:])


@pytest.mark.parametrize("gear", [*RINGS.values(), *SHAPED.values()])
def test_direction_is_that_of_the_points(gear: Gear) -> None:
    (fillet,) = (curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET)
    s = np.linspace(0.02, 0.98, 25)
    step = 1e-6
    ahead = fillet.points(s + step) - fillet.points(s - step)
    found = fillet.direction(s)
    off = ahead[:, 0] * np.sin(found) - ahead[:, 1] * np.cos(found)
    along = ahead[:, 0] * np.cos(found) + ahead[:, 1] * np.sin(found)
    assert np.all(along > 0)
    assert off / along == pytest.approx(np.zeros(25), abs=1e-6)


# ---------------------------------------------------------------------- a cutter that trims tips


def _infeed(cutter: int, ring: int) -> InternalTips | None:
    """A sharp cutter of addendum 1.25 in a ring of addendum 1; None where its tip circle is inside its base circle."""
    angle = math.radians(20)
    involute = math.tan(angle) - angle
    bases = [teeth / 2 * math.cos(angle) for teeth in (cutter, ring)]
    tips = (cutter / 2 + 1.25, ring / 2 - 1)
    if tips[1] <= bases[1]:
        return None
    at_tip = math.acos(bases[0] / tips[0])
    half = math.pi / (2 * cutter) + involute
    corner = (tips[0], half - math.tan(at_tip) + at_tip)
    return InternalTips(
        ToothTips(cutter, bases[0], half, (corner,)),
        ToothTips.sharp(ring, bases[1], math.pi / (2 * ring) - involute, tips[1]),
        (ring - cutter) / 2,
    )


def test_infeed_as_tabulated() -> None:
    """All thirty rows; for 15 teeth it is the base circle that rules out the ring of 33."""
    found = {}
    for cutter in INFEED:
        rings = range(cutter + 3, cutter + 40)
        found[cutter] = next(ring for ring in rings if (tips := _infeed(cutter, ring)) and tips.radial_margin >= 0)
    assert found == INFEED


@pytest.mark.parametrize("cutter", [teeth for teeth in INFEED if teeth >= 24][::4])
def test_infeed_of_gears_as_tabulated(cutter: int) -> None:
    def codes(teeth: int) -> set[str]:
        return {notice.code for notice in _gear(-teeth, cutter, 0.0).notices}

    assert "cutter-trims-on-infeed" not in codes(INFEED[cutter])
    assert "cutter-trims-on-infeed" in codes(INFEED[cutter] - 1)


@pytest.mark.parametrize("tip_radius", [0.0, 0.2])
@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_tips_are_trimmed_where_the_envelope_says_so(tip_radius: float, helix: float) -> None:
    """The envelope reaches beyond the flank at the tip by what the notice says, and a cutter that would do leaves it alone."""

    def excess(ring: Gear) -> float:
        radius = -ring.tip_diameter / 2
        space = math.pi / ring.tooth_count - math.radians(ring.profile.half_angle(radius))
        return radius * (half_space_angle(ring, Cutter.of(ring, tip_radius), radius) - space)

    verdicts = set()
    for teeth in (50, 58, 60, 61, 62, 63, 66):
        ring = _gear(-70, teeth, tip_radius, helix_angle=helix)
        notices = [notice for notice in ring.notices if notice.code == "cutter-trims-tips"]
        verdicts.add(bool(notices))
        assert (excess(ring) > 1e-6) is bool(notices)
        if notices:
            words = notices[0].text.replace(";", "").split()
            assert float(words[words.index("mm") - 1]) == pytest.approx(excess(ring), rel=0.02)
            assert excess(_gear(-70, int(words[-4]), tip_radius, helix_angle=helix)) < 1e-9
    assert verdicts == {True, False}

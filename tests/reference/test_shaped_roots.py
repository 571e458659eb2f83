"""Roots cut by a pinion-type shaper cutter, and form roots: against brute force, values computed apart, and a rack."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.envelope import Cutter, half_space_angle

from gearcad import BasicRack, Gear
from gearcad.geometry import ShaperCutter
from gearcad.geometry.fillets import ShaperTip
from gearcad.geometry.gear_data import full_corner_radius
from gearcad.geometry.interference import InternalTips, ToothTips
from gearcad.geometry.profile import CurveKind

ENVELOPE = 1e-12
"""mm, what the project promises being 1e-9: closed form and brute force agree to rounding, 5e-14 mm."""

EXACT = 1e-10
"""Relative, between two closed forms; also of angles (rad)."""


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


VALUES: list[tuple[str, float, float, float, list[tuple[float, float, float]]]] = [
    ("spur", -209.08350289122316, 0.21598349492567578, 77.89008412659561, [
        (0.0, 104.867, 0.0009682870804292178),
        (23.447036870118552, 104.82380687070216, 0.0028797319552670425),
        (58.61759217529637, 104.54175144561155, 0.005585534990404942),
    ]),
    ("shifted cutter", -100.84611487868244, 0.3418520951175533, 55.41200287683204, [
        (24.030184671352075, 50.83762607906678, 0.006517657958017297),
        (60.07546167838019, 50.42305743934122, 0.014370868526191516),
    ]),
    ("thinned", -306.2136257488554, 0.442377055394422, 109.20168744553828, [
        (25.02299144641811, 153.67676351424382, 0.004893944102589412),
        (62.55747861604528, 153.1068128744277, 0.008018435033023574),
    ]),
    ("right hand", -215.85106055827123, 0.36960059292744857, 82.764321792813, [
        (24.428706499093348, 108.5486711022862, 0.005111195143833855),
        (61.07176624773337, 107.92553027913561, 0.010275632853436092),
    ]),
    ("left hand", -276.7906285272349, 0.39348088488848715, 109.77912590444794, [
        (24.966709815475426, 139.56321685929043, 0.006814030458465192),
        (62.416774538688564, 138.39531426361745, 0.01461139487190559),
    ]),
    ("25 degrees", -136.60504875545047, 0.18439778812572644, 49.29733408693167, [
        (22.537136739347673, 68.6693314065565, 0.002958012562159872),
        (56.34284184836918, 68.30252437772522, 0.007617087386296434),
    ]),
    ("form root", -209.29164688038563, 0.2437212070437437, 209.734, [
        (24.738762225812536, 104.82860196086928, 0.0031876705306151895),
        (61.84690556453134, 104.64582344019281, 0.00504971023611038),
    ]),
    ("helical form root", -218.09758117108402, 0.41472188228439927, 218.87742653304184, [
        (0.0, 109.43871326652092, 0.002726081390214287),
        (13.038086824714862, 109.42142554877644, 0.004166850485693207),
    ]),
]  # fmt: skip
"""Root form diameter, full radius in modules, tip diameter of the cutter, and points of the fillet: theta (degrees), radius,
half space angle (rad). Computed apart, with a brute-force envelope that agreed to 3.2e-13 mm."""


@pytest.mark.parametrize(("name", "form", "full", "tip", "points"), VALUES, ids=[value[0] for value in VALUES])
def test_values(name: str, form: float, full: float, tip: float, points: list[tuple[float, float, float]]) -> None:
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

INFEED = {
    15: 34, 16: 34, 17: 35, 18: 36, 19: 37, 20: 38, 21: 39, 22: 40, 24: 42, 25: 43, 28: 46, 30: 48, 31: 49, 32: 50, 33: 51,
    34: 52, 35: 53, 38: 56, 40: 58, 42: 60, 44: 62, 48: 66, 50: 68, 56: 74, 60: 78, 64: 82, 66: 84, 80: 98, 96: 114, 100: 118,
}  # fmt: skip
"""SDP/SI D785, table 5-3a: the least ring that a cutter of so many teeth does not trim as it is fed in; 20 deg, no shifts."""


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

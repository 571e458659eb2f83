"""Any inputs make either a sane tooth, ring or shaped gear, or an error that names its parameter."""

import json
import math
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from support.rings import Cutter, half_space_angle
from support.strategies import HELIX, MODULE, PRESSURE_ANGLE, SHIFT, build_gear, gear_inputs, names_a_field

from gearcad import BasicRack, Body, Gear
from gearcad.core.errors import InputError
from gearcad.geometry import ShaperCutter
from gearcad.geometry.curves import CurveKind, Involute
from gearcad.geometry.fillets import ShaperTip

ROUNDING = 1e-12
"""Relative rounding of radii and angles."""


def check_gear(gear: Gear) -> None:
    half_pitch = math.pi / gear.teeth
    assert gear.root_diameter <= gear.form_diameter * (1 + ROUNDING)
    assert gear.base_diameter <= gear.form_diameter * (1 + ROUNDING)
    assert gear.form_diameter < gear.tip_form_diameter <= gear.tip_diameter
    s = np.linspace(0, 1, 201)
    last = gear.root_diameter / 2
    for curve in gear.profile.curves:
        radius, angle = curve.polar(s)
        # Radii never fall from root to tip and each radius has one half angle within the pitch: no self-intersection.
        assert radius[0] == pytest.approx(last, rel=ROUNDING)
        assert np.all(np.diff(radius) >= -ROUNDING * radius[0])
        assert np.all(angle <= half_pitch * (1 + ROUNDING))
        assert np.all(angle[:-1] > 0)
        if curve.kind in (CurveKind.INVOLUTE, CurveKind.CHAMFER, CurveKind.TIP, CurveKind.ROOT):
            assert np.all(np.diff(angle) < 0)
        if curve.kind is CurveKind.FILLET and not gear.undercut:
            assert np.all(np.diff(angle) <= ROUNDING)
        last = radius[-1]
    assert last == pytest.approx(gear.tip_diameter / 2, rel=ROUNDING)
    turn = float(gear.profile.curves[-2].direction(0.0) - gear.profile.curves[-3].direction(1.0))
    if not gear.undercut and not gear.body.tip_chamfer:
        assert turn == pytest.approx(0, abs=1e-7)
    json.dumps(gear.to_dict(), allow_nan=False)  # every derived number exists


def check_inputs(inputs: dict[str, Any]) -> None:
    try:
        gear = build_gear(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert names_a_field(error), error
    else:
        event("made")
        check_gear(gear)


@settings(max_examples=80)
@given(gear_inputs())
def test_gear_or_error(inputs: dict[str, Any]) -> None:
    check_inputs(inputs)


@pytest.mark.long
@settings(max_examples=10_000)
@given(gear_inputs())
def test_gear_or_error_long(inputs: dict[str, Any]) -> None:
    check_inputs(inputs)


ENVELOPE = 1e-11
"""Share of the module, and of the radius in double precision a hundredth of that: closed form against brute force."""

FIELDS = {each.name for kind in (Gear, BasicRack, Body, ShaperCutter) for each in fields(kind)}
"""What a user can change; a part that is wrong by itself is not yet anybody's."""

TEETH = st.one_of(st.integers(-60, -10), st.integers(-120, -24), st.integers(-2000, -10))


def _number(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False, allow_infinity=False)


@st.composite
def ring_inputs(draw: st.DrawFn) -> dict[str, Any]:
    """Inputs of a ring, its cutter as a share of its teeth; lengths in normal modules."""
    return {
        "teeth": draw(TEETH),
        "normal_module": draw(MODULE),
        "helix_angle": draw(HELIX),
        "profile_shift": draw(SHIFT),
        "thinning": draw(st.one_of(st.just(0.0), _number(0, 0.15))),
        "width": draw(_number(0.5, 10)),
        "pressure_angle": draw(PRESSURE_ANGLE),
        "addendum": draw(_number(0.3, 1.1)),
        "clearance": draw(_number(0.05, 0.4)),
        "root_radius": draw(st.sampled_from([0.38, 0.2, 0.0, "full"])),
        "tip_change": draw(st.one_of(st.none(), _number(-0.4, 0.4))),
        "tip_chamfer": draw(st.one_of(st.just(0.0), _number(0.01, 0.2))),
        "cutter": draw(st.one_of(st.none(), _number(0.1, 1.02))),
        "cutter_shift": draw(st.one_of(st.just(0.0), _number(-0.5, 0.5))),
        "cutter_radius": draw(st.one_of(st.none(), _number(0.0, 0.45))),
        "rim": draw(st.one_of(st.none(), _number(-0.5, 5.0))),
    }


def build_ring(inputs: dict[str, Any], *, external: bool = False) -> Gear:
    """The ring of some drawn inputs, or the external gear of as many teeth and that cutter; raises GearcadError."""
    m, teeth = inputs["normal_module"], abs(inputs["teeth"])
    share = 0.7 if external and inputs["cutter"] is None else inputs["cutter"]
    rack = {"pressure_angle": inputs["pressure_angle"], "addendum": inputs["addendum"], "root_radius": inputs["root_radius"]}
    cutter_teeth = None if share is None else min(max(round(share * teeth), 3), 2000)
    body = {"tip_chamfer": inputs["tip_chamfer"] * m}
    if inputs["rim"] is not None and not external:
        body["rim_diameter"] = (teeth + 5 + 2 * inputs["rim"]) * m / math.cos(math.radians(inputs["helix_angle"]))
    plain = {
        "teeth": teeth if external else -teeth,
        "normal_module": m,
        "face_width": inputs["width"] * m,
        "helix_angle": inputs["helix_angle"],
        "profile_shift": inputs["profile_shift"],
        "tooth_thinning": inputs["thinning"] * m,
        "rack": BasicRack(**rack, dedendum=inputs["addendum"] + inputs["clearance"]),
        "cutter": ShaperCutter(teeth=cutter_teeth, profile_shift=inputs["cutter_shift"], tip_radius=inputs["cutter_radius"]),
        "body": Body(**body),
    }
    if inputs["tip_change"] is None:
        return Gear(**plain)
    sign = 1 if external else -1
    tip = plain["teeth"] * m / math.cos(math.radians(inputs["helix_angle"])) + 2 * m * (
        inputs["addendum"] + inputs["profile_shift"] + sign * inputs["tip_change"]
    )
    return Gear(**plain, tip_diameter=tip)


def check_outline(gear: Gear) -> None:
    """Radii run one way, half angles stay inside the pitch, and curves go on where the last ended, in its direction."""
    profile, s = gear.profile, np.linspace(0, 1, 65)
    way = -1 if gear.internal else 1
    half_pitch = math.pi / gear.tooth_count
    last, heading = profile.root_diameter / 2, None
    for curve in profile.curves:
        radius, angle = curve.polar(s)
        assert radius[0] == pytest.approx(last, rel=ROUNDING)
        assert np.all(way * np.diff(radius) >= -ROUNDING * radius[0])
        assert np.all(angle <= half_pitch * (1 + ROUNDING))
        assert np.all(angle[:-1] > 0)
        if curve.kind is not CurveKind.FILLET or not gear.undercut:
            assert np.all(np.diff(angle) <= 1e-13)
        joins = not gear.undercut and curve.kind is CurveKind.INVOLUTE
        if joins and heading is not None:
            assert abs(math.remainder(float(curve.direction(0.0)) - heading, 2 * math.pi)) < 1e-6
        last, heading = radius[-1], float(curve.direction(1.0))
    assert last == pytest.approx(profile.tip_diameter / 2, rel=ROUNDING)


def check_half_angles(gear: Gear) -> None:
    """half_angle is the inverse of every curve, and the involute is what the thickness on the reference circle says."""
    profile = gear.profile
    for curve in profile.curves:
        if curve.kind in (CurveKind.FILLET, CurveKind.INVOLUTE, CurveKind.CHAMFER):
            radius, angle = curve.polar(np.linspace(0.2, 0.98, 12))
            found = np.radians(profile.half_angle(radius))
            # A radius is known to its last digit; a flat fillet's angle changes much with it.
            across = np.abs(np.gradient(angle, radius)) if np.all(np.diff(radius)) else np.full(radius.shape, np.inf)
            assert np.all(np.abs(found - angle) <= 1e-13 + 8e-16 * radius * across)
    (flank,) = (curve for curve in profile.curves if isinstance(curve, Involute))
    at_reference = gear.normal_tooth_thickness / (gear.normal_module * gear.teeth)
    shift = math.tan(math.radians(gear.transverse_pressure_angle)) - math.radians(gear.transverse_pressure_angle)
    assert math.degrees(at_reference + shift) == pytest.approx(gear.base_half_angle, abs=1e-10)
    assert flank.base_half_angle == math.radians(profile.base_half_angle)


def check_area(gear: Gear) -> None:
    """Area inside the contour against that of the half angles, integrated along each curve: the integral of r^2 d(angle)/2."""
    chord = 1e-4 * gear.normal_module
    x, y = gear.profile.points(chord).T
    polygon = float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2
    exact = 0.0
    for curve in gear.profile.curves:
        s = np.polynomial.legendre.leggauss(32)[0] / 2 + 0.5
        weights = np.polynomial.legendre.leggauss(32)[1] / 2
        radius, _ = curve.polar(s)
        step = 1e-6
        low, high = np.maximum(s - step, 0), np.minimum(s + step, 1)
        slope = (curve.polar(high)[1] - curve.polar(low)[1]) / (high - low)
        exact -= float(np.sum(weights * radius**2 * slope))
    lengths = float(np.hypot(np.diff(x), np.diff(y)).sum())
    assert polygon == pytest.approx(exact, abs=2 * chord * lengths)


def check_envelope(gear: Gear) -> None:
    """What the cutter sweeps on two circles, through fillet and flank; more where it trims tips, and says so."""
    tool = gear.profile.tool
    assert isinstance(tool, ShaperTip)
    cutter = Cutter.of(gear, tool.radius / gear.normal_module)
    root, form, tip = (
        size / 2 for size in (gear.profile.root_diameter, gear.profile.form_diameter, gear.profile.tip_form_diameter)
    )
    trims = any(notice.code == "cutter-trims-tips" for notice in gear.notices)
    for radius in (root + 0.6 * (form - root), form + 0.3 * (tip - form)):
        space = math.pi / gear.tooth_count - math.radians(gear.profile.half_angle(radius))
        more = (half_space_angle(gear, cutter, radius) - space) * radius
        rounding = ENVELOPE * gear.normal_module + 2e-13 * (radius + cutter.tip_radius)
        assert more > -rounding
        assert more < rounding or trims


def ring_check_inputs(inputs: dict[str, Any], *, external: bool = False) -> None:
    try:
        gear = build_ring(inputs, external=external)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert "\n" not in str(error)
        assert error.parameter.rpartition(".")[2] in FIELDS, error
        return
    event("made, by a cutter" if gear.cutter.teeth else "made, form root")
    check_outline(gear)
    check_half_angles(gear)
    check_area(gear)
    if gear.internal or gear.cutter.teeth:
        check_envelope(gear)
    json.dumps(gear.to_dict(), allow_nan=False)  # every derived number exists
    if gear.internal:
        assert gear.between_balls is not None
        assert gear.root_diameter <= gear.form_diameter * (1 - ROUNDING) < gear.tip_form_diameter < gear.base_diameter < 0
        other_hand = replace(gear, helix_angle=-gear.helix_angle)
        assert np.array_equal(other_hand.profile.points(0.1), gear.profile.points(0.1))


@settings(max_examples=50)
@given(ring_inputs())
def test_ring_or_error(inputs: dict[str, Any]) -> None:
    ring_check_inputs(inputs)


@settings(max_examples=50)
@given(ring_inputs())
def test_shaped_gear_or_error(inputs: dict[str, Any]) -> None:
    ring_check_inputs(inputs, external=True)


@pytest.mark.long
@settings(max_examples=5_000)
@given(ring_inputs())
def test_ring_or_error_long(inputs: dict[str, Any]) -> None:
    ring_check_inputs(inputs)
    ring_check_inputs(inputs, external=True)

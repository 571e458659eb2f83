"""The tooth outline: the involute function, its curves, their joints, undercut, and polylines along it."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from support.samples import SAMPLES

from gearcad import BasicRack, Gear, GearcadError, GeometryError, ParameterError
from gearcad.geometry import inverse_involute, involute
from gearcad.geometry.curves import Curve, CurveKind, parameters_within

ANGLE = 1e-10
"""rad: what the project promises for half angles."""

JOINT = 1e-9
"""mm: gap between neighbouring curves that rounding may leave, per mm of radius well below 1e-11."""

gears = pytest.mark.parametrize("gear", SAMPLES.values(), ids=SAMPLES.keys())


def _curve(gear: Gear, kind: CurveKind) -> Curve:
    (found,) = (curve for curve in gear.profile.curves if curve.kind is kind)
    return found


# ---------------------------------------------------------------------- joints


@gears
def test_curves_join_in_a_point(gear: Gear) -> None:
    for before, after in pairwise(gear.profile.curves):
        assert_allclose(before.points(1.0), after.points(0.0), atol=JOINT, rtol=0)


@gears
def test_outline_runs_from_space_to_tooth(gear: Gear) -> None:
    first, last = gear.profile.curves[0].polar(0.0), gear.profile.curves[-1].polar(1.0)
    assert first[0] == pytest.approx(gear.root_diameter / 2, abs=JOINT)
    assert first[1] == pytest.approx(math.pi / gear.teeth, abs=ANGLE)
    assert last[0] == pytest.approx(gear.tip_diameter / 2, abs=JOINT)
    assert last[1] == 0.0


@gears
def test_fillet_is_tangent_to_the_root_circle(gear: Gear) -> None:
    fillet = _curve(gear, CurveKind.FILLET)
    assert fillet.direction(0.0) == pytest.approx(float(fillet.polar(0.0)[1]) - math.pi / 2, abs=ANGLE)


@gears
def test_fillet_is_tangent_to_the_involute_unless_undercut(gear: Gear) -> None:
    turn = float(_curve(gear, CurveKind.INVOLUTE).direction(0.0) - _curve(gear, CurveKind.FILLET).direction(1.0))
    if gear.undercut:
        assert turn < -1e-4  # a re-entrant corner: the outline turns clockwise there
    else:
        assert turn == pytest.approx(0.0, abs=ANGLE)


@gears
def test_direction_is_that_of_the_points(gear: Gear) -> None:
    for curve in gear.profile.curves:
        s = np.linspace(0.05, 0.95, 19)
        step = 1e-5
        chord = curve.points(s + step) - curve.points(s - step)
        heading = np.arctan2(chord[:, 1], chord[:, 0])
        # central differences: step^2 times the third derivative, and rounding of positions over the step
        assert_allclose(np.angle(np.exp(1j * (heading - curve.direction(s)))), 0, atol=2e-6)


# ---------------------------------------------------------------------- half angles


@gears
def test_half_angle_is_the_inverse_of_the_curves(gear: Gear) -> None:
    s = np.linspace(0, 1, 101)
    for curve in gear.profile.curves:
        if curve.kind in (CurveKind.ROOT, CurveKind.TIP):
            continue
        radius, angle = curve.polar(s)
        # Near the root circle the fillet is tangent to it: an angle is known to sqrt(eps) only, a position to 1e-9 mm.
        found = np.radians(gear.profile.half_angle(radius))
        away = radius > gear.root_diameter / 2 * (1 + 1e-6)
        assert_allclose(found[away], angle[away], atol=ANGLE, rtol=0)


@gears
def test_theta_at_is_the_inverse_of_cut(gear: Gear) -> None:
    tool = gear.profile.tool
    theta = np.linspace(0, tool.last_angle, 400)[20:]
    radius, _ = tool.cut(theta)
    assert_allclose(tool.theta_at(radius, tool.last_angle), theta, rtol=1e-9)


def test_half_angle_keeps_shape_and_refuses_other_radii() -> None:
    profile = SAMPLES["spur"].profile
    radii = np.linspace(profile.root_diameter / 2, profile.tip_diameter / 2, 12).reshape(3, 4)
    assert profile.half_angle(radii).shape == (3, 4)
    assert isinstance(profile.half_angle(30.0), float)
    for radius in (profile.root_diameter / 2 - 1e-3, profile.tip_diameter / 2 + 1e-3, math.nan):
        with pytest.raises(ParameterError, match=r"must be from 27\.5 to 32 mm"):
            profile.half_angle(radius)


# ---------------------------------------------------------------------- undercut


@pytest.mark.parametrize("teeth", [6, 8, 12, 16, 17, 18, 24])
@pytest.mark.parametrize("shift", [-0.2, 0.0, 0.25])
def test_undercut_iff_the_tool_reaches_below_the_base_tangent_point(teeth: int, shift: float) -> None:
    if (teeth, shift) == (6, -0.2):
        return  # severed
    gear = Gear(teeth=teeth, normal_module=2.0, face_width=5, profile_shift=shift)
    # The straight flank of ISO 53 A ends 0.99997 m_n below the reference line; pitch point to base tangent point: r sin^2 a.
    straight = 1.25 - 0.38 * (1 - math.sin(math.radians(20))) - shift
    assert gear.undercut is (straight > teeth / 2 * math.sin(math.radians(20)) ** 2)
    # Independent of that: the involute starts at the base circle's side of the tool's last contact, or is cut off.
    sharp = _curve(gear, CurveKind.INVOLUTE).direction(0.0) - _curve(gear, CurveKind.FILLET).direction(1.0)
    assert gear.undercut is bool(sharp < -1e-8)


@pytest.mark.parametrize("name", [name for name, gear in SAMPLES.items() if gear.undercut])
def test_form_circle_of_undercut_by_brute_force(name: str) -> None:
    """The lowest radius at which the involute is still inside what a fine scan of the trochoid leaves."""
    gear = SAMPLES[name]
    base, tool = gear.base_diameter / 2, gear.profile.tool
    theta = np.linspace(0, tool.last_angle, 2_000_001)
    radius, angle = tool.cut(theta)
    above = radius >= base
    roll = np.sqrt((radius[above] / base) ** 2 - 1)
    involute = math.radians(gear.profile.base_half_angle) - (roll - np.arctan(roll))
    left = math.pi / gear.teeth - angle[above] - involute  # what the fillet leaves, beyond the involute
    crossing = int(np.flatnonzero(left >= 0)[0])
    step = radius[above][crossing] - radius[above][crossing - 1] if crossing else 1e-6
    assert gear.form_diameter / 2 == pytest.approx(radius[above][crossing], abs=2 * step)
    assert np.all(left[crossing:] >= 0)  # there is no second crossing


@pytest.mark.parametrize("teeth", [8, 10, 12])
@pytest.mark.parametrize("excess", [-1e-15, 0.0, 1e-15, 1e-12])
def test_undercut_by_rounding_starts_at_the_base_circle(teeth: int, excess: float) -> None:
    """At 30 degrees r sin^2 a = m z/8 exactly, so a sharp tool of that depth just reaches the base tangent point."""
    rack = BasicRack(pressure_angle=30.0, addendum=0.5, dedendum=1.25 + excess, root_radius=0.0)
    gear = Gear(
        teeth=teeth, normal_module=1.0, face_width=5, profile_shift=1.25 - teeth / 8, tip_diameter=teeth + 0.6, rack=rack
    )
    # r_Ff - r_b grows with the square of the roll angle, and undercut below rounding is none
    assert gear.form_diameter == pytest.approx(gear.base_diameter, rel=1e-9)


def test_17_teeth_are_undercut_by_17_nanometres() -> None:
    gear = SAMPLES["barely undercut"]
    assert gear.undercut
    assert (gear.form_diameter - gear.base_diameter) / 2 == pytest.approx(1.7e-5, abs=0.05e-5)


def test_teeth_are_refused_exactly_where_undercut_severs_them() -> None:
    def gear(shift: float) -> Gear:
        return Gear(
            teeth=5, normal_module=1.0, face_width=5, profile_shift=shift, rack=BasicRack(dedendum=1.4, root_radius=0.2)
        )

    refused, made = -0.4, -0.35
    while made - refused > 1e-12:
        middle = (refused + made) / 2
        try:
            gear(middle)
        except GeometryError as error:
            assert error.parameter == "teeth"
            assert "undercut severs the tooth" in str(error)
            refused = middle
        else:
            made = middle
    radius, angle = _curve(gear(made), CurveKind.FILLET).polar(np.linspace(0, 1, 1_000_001))
    assert np.min(2 * radius * angle) == pytest.approx(4e-6, abs=1e-9)  # the least land (mm) that a solid tells apart


# ---------------------------------------------------------------------- lands


def test_full_radius_has_no_root_land() -> None:
    kinds = [curve.kind for curve in SAMPLES["full radius"].profile.curves]
    assert kinds == [CurveKind.FILLET, CurveKind.INVOLUTE, CurveKind.TIP]
    outline = SAMPLES["full radius"].profile.points(0.001)
    middle = math.pi / 24
    assert_allclose(outline[-1], 32.25 * np.array([math.cos(middle), math.sin(middle)]), atol=1e-12)


def test_tip_chamfer_takes_its_height_off_at_45_degrees() -> None:
    gear = SAMPLES["chamfered"]
    plain = replace(gear, body=replace(gear.body, tip_chamfer=0.0))
    assert gear.tip_form_diameter == pytest.approx(gear.tip_diameter - 0.6, abs=1e-12)
    low, high = (_curve(gear, CurveKind.CHAMFER).points(end) for end in (0.0, 1.0))
    assert np.hypot(*low) == pytest.approx(gear.tip_form_diameter / 2, abs=JOINT)
    assert np.hypot(*high) == pytest.approx(gear.tip_diameter / 2, abs=JOINT)
    outward = low / np.hypot(*low)
    along = (high - low) / np.hypot(*(high - low))
    assert float(outward @ along) == pytest.approx(math.cos(math.pi / 4), abs=1e-12)
    above = np.linspace(gear.tip_form_diameter / 2, gear.tip_diameter / 2, 20)[1:]
    assert np.all(gear.profile.half_angle(above) < plain.profile.half_angle(above))
    below = np.linspace(gear.root_diameter / 2, gear.tip_form_diameter / 2, 20)
    assert_allclose(gear.profile.half_angle(below), plain.profile.half_angle(below), atol=1e-12)


# ---------------------------------------------------------------------- polylines


def _chord_errors(curve: Curve, s: np.ndarray) -> np.ndarray:
    """Largest distance (mm) of the curve from each of the chords between neighbouring parameters."""
    points = curve.points(s[:-1, None] + np.diff(s)[:, None] * np.linspace(0, 1, 41))
    chord, from_start = points[:, -1:] - points[:, :1], points - points[:, :1]
    across = np.abs(chord[..., 0] * from_start[..., 1] - chord[..., 1] * from_start[..., 0])
    return np.max(across / np.maximum(np.hypot(chord[..., 0], chord[..., 1]), 1e-300), axis=1)


def _fewest_chords(curve: Curve, chord_error: float) -> int:
    """Number of chords if each is made as long as the error allows, one after the other."""
    count, start = 0, 0.0
    while start < 1:
        low, high = start, 1.0
        for _ in range(40):
            middle = (low + high) / 2
            fits = _chord_errors(curve, np.array([start, middle]))[0] <= chord_error
            low, high = (middle, high) if fits else (low, middle)
        start = 1.0 if high >= 1 else low
        count += 1
    return count


@gears
@pytest.mark.parametrize("relative", [1e-2, 1e-3, 1e-5])
def test_polyline_keeps_the_chord_error(gear: Gear, relative: float) -> None:
    error = relative * gear.normal_module
    for curve in gear.profile.curves:
        assert _chord_errors(curve, parameters_within(curve, error)).max() <= error


@gears
def test_polyline_is_not_wasteful(gear: Gear) -> None:
    error = 1e-3 * gear.normal_module
    for curve in gear.profile.curves:
        chords = len(parameters_within(curve, error)) - 1
        assert chords <= max(1.5 * _fewest_chords(curve, error), 1)


@gears
def test_tooth_outline_is_symmetric_and_closes_into_a_contour(gear: Gear) -> None:
    error = 0.002 * gear.normal_module
    tooth = gear.profile.points(error)
    assert_allclose(tooth, tooth[::-1] * [1, -1], atol=1e-12 * gear.tip_diameter)
    contour = gear.profile.contour(error)
    assert contour.shape == (gear.teeth * (len(tooth) - 1), 2)
    x, y = contour.T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    # Counter-clockwise, between the root and tip circles, and equal to the sum over the half tooth by polar integration.
    exact = 0.0
    for curve in gear.profile.curves:
        radius, angle = curve.polar(np.linspace(0, 1, 20001))
        exact += gear.teeth * float(np.sum((radius[1:] ** 2 + radius[:-1] ** 2) / 2 * -np.diff(angle)))
    perimeter = float(np.sum(np.hypot(*(contour - np.roll(contour, -1, axis=0)).T)))
    assert area == pytest.approx(exact, abs=perimeter * error)


def test_chord_error_must_be_positive() -> None:
    with pytest.raises(ParameterError, match="chord_error = 0 mm: must be a number above 0 mm"):
        SAMPLES["spur"].profile.points(0)


@pytest.mark.parametrize("radius", [0.0, 1e-4, 0.2, "full"])
def test_any_root_radius_meets_root_circle_and_involute(radius: float) -> None:
    gear = Gear(teeth=20, normal_module=2.0, face_width=5, profile_shift=0.2, rack=BasicRack(root_radius=radius))
    assert gear.profile.half_angle(gear.root_diameter / 2) <= 180 / 20
    assert gear.root_diameter == pytest.approx(40 - 4 * 1.05, abs=1e-12)


ROUNDING = 1e-13
"""Relative: some units in the last place."""


@pytest.mark.parametrize("angle", [1e-3, 0.1, 1.0, 14.5, 20.0, 22.402523646885253, 45.0, 70.0, 89.0, 89.99])
def test_inverse_involute_returns_the_angle(angle: float) -> None:
    # At small angles inv a = a^3/3 loses eps/a^2 of relative precision to the difference tan a - a.
    rounding = max(ROUNDING, 4e-16 / math.radians(angle) ** 2)
    assert inverse_involute(involute(angle)) == pytest.approx(angle, rel=rounding)


def test_arrays_keep_their_shape() -> None:
    angles = np.linspace(5, 80, 24).reshape(2, 3, 4)
    found = inverse_involute(involute(angles))
    assert found.shape == angles.shape
    assert_allclose(found, angles, rtol=ROUNDING)
    assert isinstance(involute(20.0), float)
    assert isinstance(inverse_involute(0.0149), float)


def test_known_values() -> None:
    # inv 20 deg = 0.014904383867336446 (every gear book prints 0.014904)
    assert involute(20.0) == pytest.approx(0.014904383867336446, rel=ROUNDING)
    assert involute(0.0) == 0.0
    assert inverse_involute(0.0) == 0.0


@pytest.mark.parametrize("value", [-1e-12, -1.0, math.nan])
def test_no_angle_has_a_negative_involute(value: float) -> None:
    with pytest.raises(GearcadError) as caught:
        inverse_involute(np.array([0.01, value]))
    assert "involute" in str(caught.value)

"""Inputs: derived and overridden diameters, frozen objects, and what is said of wrong ones."""

import copy
import json
import math
import pickle
import re
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from typing import Any

import numpy as np
import pytest
from support.cases import volvo_pair
from support.samples import SAMPLES
from support.strategies import permitted_beside

from gearcad import BasicRack, Body, Gear, GearcadError, GearPair, GeometryError, ParameterError, ToothProfile
from gearcad.core.errors import at_least, at_most
from gearcad.core.records import PerGear
from gearcad.geometry import NAMED_RACKS, split_profile_shift


def _gear(**inputs: Any) -> Gear:
    return Gear(**{"teeth": 20, "normal_module": 2.0, "face_width": 10.0, **inputs})


def _wheel(**inputs: Any) -> Gear:
    return _gear(**{"teeth": 40, **inputs})


def _pair(**inputs: Any) -> GearPair:
    return GearPair(**{"pinion": _gear(), "wheel": _wheel(), **inputs})


# ---------------------------------------------------------------------- derived and given


def test_replace_derives_again() -> None:
    gear = replace(_gear(), profile_shift=0.3)
    assert (gear.tip_diameter, gear.root_diameter) == (pytest.approx(45.2), pytest.approx(36.2))
    pair = replace(_pair(), pinion=gear)
    assert pair.centre_distance == pytest.approx(GearPair(pinion=gear, wheel=_wheel()).centre_distance, abs=1e-12)
    assert pair.centre_distance > 60.5


def test_replace_keeps_what_was_given() -> None:
    gear = replace(_gear(tip_diameter=43.5, root_diameter=35.5), profile_shift=0.1)
    assert (gear.tip_diameter, gear.root_diameter) == (43.5, 35.5)
    assert replace(_pair(centre_distance=60.2), name="other").centre_distance == 60.2
    # A plain float of a derived value is a given one.
    fixed = replace(_gear(), tip_diameter=float(_gear().tip_diameter))
    assert replace(fixed, profile_shift=0.3).tip_diameter == 44.0


def test_given_tip_circle_wins_over_tip_alteration() -> None:
    gear = _gear(tip_diameter=43.5, tip_alteration=-0.4)
    assert gear.tip_diameter == 43.5
    assert gear.profile.curves[-1].polar(0.0)[0] == pytest.approx(21.75, abs=1e-12)


@pytest.mark.parametrize("shift", [-0.2, 0.0, 0.378])
def test_given_root_circle_prescribes_the_tool(shift: float) -> None:
    """Section 7.1 of the Chalmers thesis, which counts the shift twice: h_fP = (d - d_f)/(2 m_n) + x."""
    gear = _gear(root_diameter=35.2, profile_shift=shift, rack=BasicRack(root_radius=0.2))
    assert gear.dedendum == pytest.approx((40 - 35.2) / 4 + shift, abs=1e-12)
    assert gear.profile.curves[0].polar(0.0)[0] == pytest.approx(17.6, abs=1e-12)
    fillet = gear.profile.tool
    assert 2 * fillet.cut(0.0)[0] == pytest.approx(35.2, abs=1e-12)
    same = _gear(profile_shift=shift, rack=BasicRack(dedendum=gear.dedendum, root_radius=0.2))
    assert same.root_diameter == pytest.approx(35.2, abs=1e-12)
    assert same.form_diameter == pytest.approx(gear.form_diameter, abs=1e-12)


def test_root_radius_full_is_resolved_for_the_gear() -> None:
    gear = _gear(rack=BasicRack(root_radius="full"), tooth_thinning=0.1)
    assert gear.root_radius == pytest.approx(BasicRack().full_root_radius(thinning=0.05), abs=1e-15)
    assert gear.profile.tool.u == pytest.approx(0, abs=1e-12)


def test_named_racks_are_those_of_iso_53() -> None:
    # ISO 53:1998, table 1: h_fP and rho_fP of types A to D
    expected = {"A": (1.25, 0.38), "B": (1.25, 0.30), "C": (1.25, 0.25), "D": (1.40, 0.39)}
    for letter, (dedendum, radius) in expected.items():
        rack = NAMED_RACKS[f"ISO53_{letter}"]
        assert (rack.pressure_angle, rack.addendum, rack.dedendum, rack.root_radius) == (20, 1, dedendum, radius)


def test_inputs_are_frozen() -> None:
    pair = _pair()
    for thing, name in (
        (pair, "axial_offset"),
        (pair.pinion, "teeth"),
        (pair.pinion.rack, "addendum"),
        (pair.pinion.body, "bore"),
    ):
        with pytest.raises(FrozenInstanceError):
            setattr(thing, name, 1)
    with pytest.raises(FrozenInstanceError):
        pair.pinion.profile.teeth = 3  # type: ignore[misc]


def test_gears_compare_copy_and_travel() -> None:
    pair = volvo_pair()
    assert pair == volvo_pair()
    assert hash(pair.pinion) == hash(volvo_pair().pinion)
    for other in (pickle.loads(pickle.dumps(pair)), copy.deepcopy(pair)):
        assert other == pair
        assert replace(other.pinion, profile_shift=0.0).tip_diameter != pair.pinion.tip_diameter


def test_infinite_lead_is_none_in_a_document() -> None:
    assert _gear().to_dict()["lead"] is None
    assert _gear(helix_angle=10.0).to_dict()["lead"] == pytest.approx(
        math.pi * 40 / math.cos(math.radians(10)) / math.tan(math.radians(10))
    )


# ---------------------------------------------------------------------- warnings


def test_warnings_of_a_gear() -> None:
    assert _gear().warnings == ()
    notice, *_ = SAMPLES["undercut"].notices
    assert notice.code == "undercut" and str(notice) == SAMPLES["undercut"].warnings[0]
    pointed = _gear(teeth=12, profile_shift=0.7)
    assert 0 < pointed.tip_thickness < 0.4
    assert any("thin tip" in text for text in pointed.warnings)


def test_clean_pair_has_no_warnings_and_rounding_is_not_one() -> None:
    assert _pair().warnings == ()
    for shift in (0.1, 0.2, 0.3, 0.318):
        assert _pair(wheel=_wheel(profile_shift=shift)).warnings == ()


# ---------------------------------------------------------------------- wrong inputs

NAN = math.nan

SINGLE: list[tuple[Callable[..., Any], dict[str, Any], str, str]] = [
    (_gear, {"teeth": 2.5}, "teeth", "teeth = 2.5: must be a whole number from 3 to 2000"),
    (_gear, {"teeth": 2}, "teeth", "must be a whole number from 3 to 2000"),
    (_gear, {"teeth": True}, "teeth", "must be a whole number from 3 to 2000"),
    (
        _gear,
        {"normal_module": 0},
        "normal_module",
        "normal_module = 0 mm: must be a number at least 0.01 mm and at most 200 mm",
    ),
    (_gear, {"normal_module": "2"}, "normal_module", "normal_module = '2': must be a number"),
    (_gear, {"face_width": -5}, "face_width", "face_width = -5 mm: must be a number above 0 mm"),
    (_gear, {"helix_angle": 95}, "helix_angle", "helix_angle = 95 deg: must be a number at least -75 deg and at most 75 deg"),
    (_gear, {"helix_angle": 1e-7}, "helix_angle", "helix_angle = 1e-07 deg: must be 0 or at least 1e-06 deg"),
    (_gear, {"helix_angle": NAN}, "helix_angle", "helix_angle = nan deg: must be a number"),
    (_gear, {"profile_shift": 6}, "profile_shift", "must be a number at least -5 and at most 5"),
    (_gear, {"tip_alteration": -6}, "tip_alteration", "must be a number at least -5 and at most 5"),
    (_gear, {"tooth_thinning": -0.1}, "tooth_thinning", "tooth_thinning = -0.1 mm: must be a number at least 0 mm"),
    (_gear, {"tip_diameter": 0}, "tip_diameter", "must be a number above 0 mm"),
    (_gear, {"root_diameter": -1}, "root_diameter", "must be a number above 0 mm"),
    (_gear, {"name": " "}, "name", "must be a text that is not blank"),
    (_gear, {"rack": 20}, "rack", "must be a BasicRack"),
    (_gear, {"body": 5.0}, "body", "must be a Body"),
    (BasicRack, {"pressure_angle": 50}, "pressure_angle", "must be a number at least 5 deg and at most 45 deg"),
    (BasicRack, {"addendum": 0}, "addendum", "must be a number above 0 and at most 5"),
    (BasicRack, {"root_radius": "round"}, "root_radius", 'must be a number at least 0, or "full"'),
    (BasicRack, {"root_radius": -0.1}, "root_radius", "must be a number at least 0"),
    (Body, {"bore": -1}, "bore", "must be a number at least 0 mm"),
    (Body, {"hub_side": "top"}, "hub_side", "must be one of 'front', 'back', 'both'"),
    (Body, {"tip_chamfer": 1e-5}, "tip_chamfer", "must be 0 or at least 0.001 mm"),
    (Body, {"end_chamfer_angle": 90}, "end_chamfer_angle", "must be a number at least 5 deg and at most 85 deg"),
    (_pair, {"pinion": None}, "pinion", "must be a Gear"),
    (_pair, {"axial_offset": NAN}, "axial_offset", "must be a number"),
    (_pair, {"centre_distance": -80}, "centre_distance", "must be a number above 0 mm"),
]


@pytest.mark.parametrize(("make", "inputs", "parameter", "text"), SINGLE, ids=[f"{row[2]}-{i}" for i, row in enumerate(SINGLE)])
def test_one_wrong_value(make: Callable[..., Any], inputs: dict[str, Any], parameter: str, text: str) -> None:
    with pytest.raises(ParameterError) as caught:
        make(**inputs)
    assert caught.value.parameter == parameter
    assert text in str(caught.value)
    assert isinstance(caught.value, ValueError)
    assert "\n" not in str(caught.value)


BORE = {"bore": 20.0}
COMBINED: list[tuple[Callable[..., Any], dict[str, Any], str, str]] = [
    (_gear, {"rack": BasicRack(root_radius=0.5)}, "rack.root_radius", "(full radius) for dedendum 1.25, pressure angle 20 deg"),
    (_gear, {"rack": BasicRack(dedendum=2.3, root_radius=0.0)}, "rack.dedendum", "where the tool's flanks meet"),
    (_gear, {"root_diameter": 31.0, "rack": BasicRack(root_radius=0.0)}, "root_diameter", "where the tool's flanks meet"),
    (_gear, {"root_diameter": 41.0}, "root_diameter", "no tool depth left"),
    (_gear, {"tip_diameter": 48.0}, "tip_diameter", "(pointed tooth)"),
    (_gear, {"tip_diameter": 37.0}, "tip_diameter", "no involute is left on the flank"),
    (_gear, {"teeth": 8, "tip_diameter": 15.2}, "tip_diameter", "no involute is left on the flank"),
    (_gear, {"body": Body(bore=34.7)}, "body.bore", "a rim of 0.1 m_n inside the root circle 35 mm"),
    (_gear, {"body": Body(hub_diameter=36, hub_length=5)}, "body.hub_diameter", "inside the root circle"),
    (_gear, {"body": Body(**BORE, hub_diameter=20.1, hub_length=5)}, "body.hub_diameter", "to hold bore and keyway"),
    (_gear, {"body": Body(end_chamfer=5.1)}, "body.end_chamfer", "0.49 of the face width"),
    (_gear, {"body": Body(bore=30.0, end_chamfer=4.0, end_chamfer_angle=70)}, "body.end_chamfer", "some end face left"),
    (_gear, {"teeth": 14, "profile_shift": 0.4, "body": Body(tip_chamfer=2.0)}, "body.tip_chamfer", "no tip land is left"),
    (_gear, {"profile_shift": -0.5, "tip_diameter": 40, "body": Body(tip_chamfer=1.9)}, "body.tip_chamfer", "no involute"),
    (_gear, {"face_width": 0.01}, "face_width", "(0.01 m_n)"),
    (_gear, {"helix_angle": 33.0, "face_width": 470}, "face_width", "(720 deg of twist)"),
    (_pair, {"axial_offset": 11.0}, "axial_offset", "for the gears to face each other"),
    (_pair, {"wheel": _wheel(normal_module=2.00001)}, "wheel.normal_module", "must be 2 mm, as on the pinion"),
    (_pair, {"wheel": _wheel(helix_angle=10.0)}, "wheel.helix_angle", "opposite to the pinion"),
    (_pair, {"wheel": _wheel(rack=BasicRack(pressure_angle=21))}, "wheel.rack.pressure_angle", "must be 20 deg"),
    (_pair, {"centre_distance": 59.9}, "centre_distance", "the backlash would be -0.07"),
    (_pair, {"centre_distance": 60.0, "wheel": _wheel(profile_shift=0.2)}, "centre_distance", "for these profile shifts"),
    (_pair, {"wheel": _wheel(tip_diameter=85.1)}, "wheel.tip_diameter", "the tip reaches the pinion's root circle"),
    (_pair, {"pinion": _gear(tip_diameter=45.2)}, "pinion.tip_diameter", "the tip reaches the wheel's root circle"),
]  # fmt: skip


def _with(make: Callable[..., Any], inputs: dict[str, Any], parameter: str, value: float) -> Any:
    """Make the same thing with one parameter changed."""
    first, _, rest = parameter.partition(".")
    if rest:
        owner = inputs.get(first, _wheel() if first == "wheel" else _gear())
        if "." in rest:
            middle, _, last = rest.partition(".")
            return make(**{**inputs, first: replace(owner, **{middle: replace(getattr(owner, middle), **{last: value})})})
        return make(**{**inputs, first: replace(owner, **{rest: value})})
    return make(**{**inputs, first: value})


@pytest.mark.parametrize(("make", "inputs", "parameter", "text"), COMBINED, ids=[f"{r[2]}-{i}" for i, r in enumerate(COMBINED)])
def test_wrong_combination_states_a_limit_that_is_itself_permitted(
    make: Callable[..., Any], inputs: dict[str, Any], parameter: str, text: str
) -> None:
    with pytest.raises(GeometryError) as caught:
        make(**inputs)
    _with(make, inputs, parameter, permitted_beside(caught.value, parameter, text))


def test_keyway_that_does_not_fit() -> None:
    with pytest.raises(GeometryError) as caught:
        Body(bore=10, keyway_width=9.5, keyway_depth=2)
    assert "keyway_width = 9.5 mm: must be at most 9 mm (0.9 of the bore)" in str(caught.value)
    with pytest.raises(GeometryError) as caught:
        Body(bore=10, keyway_width=3)
    assert "keyway_depth = 0 mm: must be above 0 mm, as keyway_width is given" in str(caught.value)
    with pytest.raises(GeometryError) as caught:
        _gear(body=Body(bore=30, keyway_width=8, keyway_depth=3.3))
    assert caught.value.parameter == "body.keyway_depth"


def test_chamfer_that_would_add_material() -> None:
    """With 5 teeth the flank leans in by more than 45 degrees at the tip, so the chamfer line would lie outside of it."""
    with pytest.raises(GeometryError) as caught:
        Gear(teeth=5, normal_module=1.0, face_width=5, profile_shift=0.2, tip_diameter=6.9, body=Body(tip_chamfer=0.02))
    assert "body.tip_chamfer = 0.02 mm: must be 0 mm: at this tip circle the flank leans in" in str(caught.value)
    assert math.degrees(math.acos(5 * math.cos(math.radians(20)) / 6.9)) == pytest.approx(47.1, abs=0.05)


def test_shift_that_leaves_no_tooth() -> None:
    with pytest.raises(GeometryError) as caught:
        _gear(profile_shift=-2.2)
    # s_n = 0 at x = -pi/(4 tan 20 deg) = -2.157866
    assert "profile_shift = -2.2: must be above -2.15786: no tooth on the reference circle" in str(caught.value)


def test_thinning_that_takes_the_whole_tooth() -> None:
    with pytest.raises(GeometryError) as caught:
        _gear(tooth_thinning=3.2)
    assert "tooth_thinning = 3.2 mm: must be below 3.14159 mm, the normal tooth thickness" in str(caught.value)
    with pytest.raises(GeometryError, match="pointed tooth"):
        _gear(tooth_thinning=2.0)


def test_axes_closer_than_the_base_circles() -> None:
    with pytest.raises(GeometryError) as caught:
        _pair(centre_distance=50.0)
    # (20 + 40) cos 20 deg = 56.381557 mm, whatever the shifts
    assert "centre_distance = 50 mm: must be above 56.3816 mm, where the base circles touch" in str(caught.value)


def test_no_centre_distance_without_backlash() -> None:
    with pytest.raises(GeometryError) as caught:
        GearPair(pinion=_gear(profile_shift=-0.5), wheel=_wheel(profile_shift=-0.9))
    assert caught.value.parameter == "wheel.profile_shift"
    limit = float(re.search(r"above (-[\d.]+)", str(caught.value))[1])  # type: ignore[index]
    # inv alpha_w = 0 at x_1 + x_2 = -(z_1 + z_2) inv(20)/(2 tan 20)
    assert limit - 0.5 == pytest.approx(-60 * 0.014904383867 / (2 * math.tan(math.radians(20))), abs=1e-5)
    GearPair(pinion=_gear(profile_shift=-0.5, tip_diameter=39.5), wheel=_wheel(profile_shift=limit, tip_diameter=78.0))


@pytest.mark.parametrize("value", [0.47191, 123456.7, 1e-7 / 3, -5.4321987, 0.0, 99.99996])
def test_limits_are_rounded_to_the_permitted_side(value: float) -> None:
    low, high = float(at_most(value)), float(at_least(value))
    assert low <= value <= high
    assert high - low <= 1.0001e-5 * abs(value)
    assert max(len(text.replace("-", "").replace(".", "").lstrip("0")) for text in (at_most(value), at_least(value))) <= 9


def test_profile_on_its_own_names_its_own_parameters() -> None:
    profile = SAMPLES["spur"].profile
    with pytest.raises(GeometryError) as caught:
        replace(profile, tip_chamfer=2.0)
    assert caught.value.parameter == "tip_chamfer"
    assert isinstance(profile, ToothProfile)
    assert issubclass(GeometryError, GearcadError)


def test_gears_too_far_apart_to_touch_are_refused_at_the_limit_that_is_printed() -> None:
    pinion, wheel = (Gear(teeth=z, normal_module=2, face_width=10) for z in (20, 35))
    with pytest.raises(GeometryError, match=r"centre_distance = 70 mm: must be below [\d.]+ mm") as caught:
        GearPair(pinion=pinion, wheel=wheel, centre_distance=70)
    limit = float(caught.value.permitted.split()[3])
    nearly = GearPair(pinion=pinion, wheel=wheel, centre_distance=limit)
    assert 0 < nearly.transverse_contact_ratio < 1e-3


def test_whole_and_numpy_numbers_are_the_same_gear() -> None:
    one = Gear(teeth=20, normal_module=2.0, face_width=10.0)
    other = Gear(teeth=np.int64(20), normal_module=2, face_width=np.float32(10))
    assert json.dumps(one.to_dict()) == json.dumps(other.to_dict())


@pytest.mark.parametrize("name", ["a\x01b", "two\nlines", "\t"])
def test_names_without_control_characters(name: str) -> None:
    with pytest.raises(ParameterError, match="name = "):
        Gear(name=name, teeth=20, normal_module=2, face_width=10)


def test_a_split_given_as_text_is_what_it_says() -> None:
    common = {
        "normal_module": 2.0,
        "teeth": PerGear(20, 35),
        "helix_angle": 0.0,
        "pressure_angle": 20.0,
        "centre_distance": 56.0,
    }
    assert split_profile_shift(0.5, "equal", **common) == (0.25, 0.25)
    with pytest.raises(ParameterError, match="'equal', 'pinion', 'equal_specific_sliding'"):
        split_profile_shift(0.5, "fair", **common)


def test_ball_of_a_steep_gear_with_a_large_pressure_angle() -> None:
    """tan^2 beta_b is large here, and the balanced ball hardly rises above the touching point."""
    rack = BasicRack(pressure_angle=44.31357297955632, addendum=1.2899095893191663, dedendum=0.2151733, root_radius=0.0)
    gear = Gear(
        teeth=9, normal_module=137.8, helix_angle=-74.0103, profile_shift=2.780184, face_width=156.0, tip_alteration=-0.9067,
        rack=rack,
    )  # fmt: skip
    touches = gear.inspection.ball_contact_diameter(gear.ball_diameter)
    assert gear.base_diameter < touches < gear.form_diameter  # the ball is made to touch lower, and the data sheet says so
    assert any(warning.startswith("balls: ") for warning in gear.warnings)
    assert gear.over_balls > gear.tip_diameter


def test_pins_of_an_odd_helical_gear_lie_half_an_axial_pitch_apart() -> None:
    gear = Gear(teeth=13, normal_module=2, face_width=10, helix_angle=1.0)
    axial_pitch = math.pi * 2 / math.sin(math.radians(1.0))
    assert gear.pin_axial_shift == pytest.approx(axial_pitch / 2, rel=1e-12)
    assert any(warning.startswith("pins: ") for warning in gear.warnings)
    assert replace(gear, teeth=14).pin_axial_shift == 0

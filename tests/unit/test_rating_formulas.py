"""Identities and limits of the ratings, where the formulas leave their ranges, and the document of a rating."""

import json
import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import event, given, settings
from support.cases import STEEL, numbers, sample_pair, shortened, swapped
from support.strategies import build_pair, pair_inputs

from gearcad import ISO53_D, BasicRack, Body, Gear, GearPair, GeometryError, Load, ParameterError
from gearcad.core import symbols
from gearcad.core.errors import InputError
from gearcad.rating import Edition, Rating, RatingOptions, gear_blank_factor, rate
from gearcad.rating.contact_stress import contact_factor, contact_ratio_factor, helix_angle_factor, single_contact_curvature
from gearcad.rating.tooth_stiffness import (
    basic_rack_factor,
    low_load_factor,
    material_factor,
    rim_thickness_ratio,
    tooth_flexibility,
)

EXACT = 1e-12
"""Relative: the same quantity by two formulas."""

LOAD = Load(torque=350.0)


@pytest.mark.parametrize("helix", [0.0, 15.0, 28.0])
def test_contact_stress_is_hertz_at_the_pitch_point(helix: float) -> None:
    """Z_H Z_E sqrt(...) is the peak pressure of one line b/cos beta_b long; Z_eps and Z_beta are all that is added."""
    pair = sample_pair(helix)
    rating = rate(pair, STEEL, LOAD)
    contact, lean = rating.pitch_point, math.cos(math.radians(pair.pinion.base_helix_angle))
    alone = replace(contact, load_per_width=rating.normal_force / (28 / lean)).peak_pressure
    flank = rating.flank
    assert flank.nominal_stress == pytest.approx(alone * flank.contact_ratio_factor * flank.helix_angle_factor, rel=EXACT)


def test_single_contact_factors_are_ratios_of_curvature() -> None:
    """M_1 and M_2 follow from the radii of curvature at C, B and D."""
    pair = sample_pair(0.0, body=Body(tip_chamfer=0.2))
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    radius = {name: place * (whole - place) for name, place in pair.path_of_contact._asdict().items()}
    expected = [math.sqrt(radius["C"] / radius[name]) for name in ("B", "D")]
    assert single_contact_curvature(pair) == pytest.approx(expected, rel=EXACT)
    assert rate(pair, STEEL, LOAD).flank.contact_factors.pinion == pytest.approx(expected[0], rel=EXACT)
    assert expected[0] > 1 > expected[1]
    assert rate(pair, STEEL, LOAD).flank.contact_factors.wheel == 1


def test_torque_elasticity_and_application_factor() -> None:
    pair = sample_pair()
    one = rate(pair, STEEL, LOAD)
    other = rate(pair, replace(STEEL, youngs_modulus=51500.0), Load(torque=-700.0, application_factor=1.5))
    assert other.flank.nominal_stress / one.flank.nominal_stress == pytest.approx(math.sqrt(2 / 4), rel=EXACT)
    assert other.roots.pinion.nominal_stress / one.roots.pinion.nominal_stress == pytest.approx(2, rel=EXACT)
    assert other.pitch_point.half_width / one.pitch_point.half_width == pytest.approx(math.sqrt(8), rel=EXACT)
    assert other.stiffness.mesh_alpha / one.stiffness.mesh_alpha == pytest.approx(1 / 4, rel=EXACT)
    assert other.root_stresses == pytest.approx([1.5 * gear.nominal_stress for gear in other.roots], rel=EXACT)
    stress = other.flank.nominal_stress * math.sqrt(1.5)
    assert other.contact_stresses == pytest.approx([stress * other.flank.contact_factors.pinion, stress], rel=EXACT)
    assert other.specific_load == pytest.approx(1.5 * 2 * one.specific_load, rel=EXACT)


@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_exchanged_gears(helix: float) -> None:
    """The wheel may drive: the same forces rate the same, with the gears' own values exchanged."""
    pair = replace(sample_pair(helix), axial_offset=1.5)
    ahead = rate(pair, STEEL, LOAD).to_dict()
    back = rate(swapped(pair), STEEL, Load(torque=350 * pair.gear_ratio)).to_dict()
    back["pinion"], back["wheel"], back["Z_B"], back["Z_D"] = back["wheel"], back["pinion"], back["Z_D"], back["Z_B"]
    assert numbers(back) == pytest.approx(numbers(ahead), rel=1e-11)


def test_equal_gears_are_rated_equally() -> None:
    gear = Gear(teeth=25, normal_module=2.0, face_width=20.0, profile_shift=0.2)
    rating = rate(shortened(GearPair(pinion=gear, wheel=gear)), STEEL, LOAD)
    assert rating.roots.pinion == rating.roots.wheel
    assert rating.flank.contact_factors.pinion == pytest.approx(rating.flank.contact_factors.wheel, rel=EXACT)
    # With equal teeth but unequal shifts the order of the gears must not matter either.
    other = replace(gear, profile_shift=-0.1)
    stiffness = [rate(GearPair(pinion=a, wheel=b), STEEL, LOAD).stiffness for a, b in ((gear, other), (other, gear))]
    assert stiffness[0] == stiffness[1]


def test_spur_is_the_limit_of_helical() -> None:
    spur, nearly = (numbers(rate(sample_pair(helix), STEEL, LOAD).to_dict()) for helix in (0.0, 1e-6))
    for name in ("p_0", "b_H"):  # the lines of contact of a spur pair jump where those of a helical pair run in
        spur.pop(name), nearly.pop(name)
    assert nearly == pytest.approx(spur, rel=1e-6)


# ---------------------------------------------------------------------- the factors one by one


def test_flexibility_is_the_series_of_the_standard() -> None:
    """Every coefficient of table 9 by itself: differences of q' in one variable at a time."""
    infinite = (1e300, 1e300)
    assert tooth_flexibility(infinite, (0.0, 0.0)) == pytest.approx(0.04723, rel=EXACT)
    found = [
        tooth_flexibility((1.0, 1e300), (0.0, 0.0)) - 0.04723,
        tooth_flexibility((1e300, 1.0), (0.0, 0.0)) - 0.04723,
        (tooth_flexibility(infinite, (1.0, 0.0)) - tooth_flexibility(infinite, (-1.0, 0.0))) / 2,
        tooth_flexibility((1.0, 1e300), (1.0, 0.0)) - tooth_flexibility(infinite, (1.0, 0.0)) - 0.15551,
        (tooth_flexibility(infinite, (0.0, 1.0)) - tooth_flexibility(infinite, (0.0, -1.0))) / 2,
        tooth_flexibility((1e300, 1.0), (0.0, 1.0)) - tooth_flexibility(infinite, (0.0, 1.0)) - 0.25791,
        (tooth_flexibility(infinite, (1.0, 0.0)) + tooth_flexibility(infinite, (-1.0, 0.0))) / 2 - 0.04723,
        (tooth_flexibility(infinite, (0.0, 1.0)) + tooth_flexibility(infinite, (0.0, -1.0))) / 2 - 0.04723,
    ]
    table = [0.15551, 0.25791, -0.00635, -0.11654, -0.00193, -0.24188, 0.00529, 0.00182]
    assert found == pytest.approx(table, abs=1e-14)


def test_rack_factor() -> None:
    assert [basic_rack_factor(depth, 20.0) for depth in (1.2, 1.25, 1.4)] == pytest.approx([1, 0.975, 0.9], rel=EXACT)
    assert basic_rack_factor(1.0, 25.0) == pytest.approx(1.1 * 1.1, rel=EXACT)
    plain = sample_pair(0.0)
    mixed = replace(plain, wheel=replace(plain.wheel, rack=ISO53_D))
    assert rate(mixed, STEEL, LOAD).stiffness.rack_factor == pytest.approx((0.975 + 0.9) / 2, rel=EXACT)


def test_blank_factor() -> None:
    assert gear_blank_factor() == gear_blank_factor(1.0, 7.0) == 1
    assert gear_blank_factor(0.3, 3.0) == pytest.approx(1 + math.log(0.3) / (5 * math.exp(0.6)), rel=EXACT)
    assert gear_blank_factor(0.1, 0.5) == gear_blank_factor(0.2, 1.0)
    assert gear_blank_factor(2.0, 2.0) == gear_blank_factor(1.2, 2.0)


def test_blank_of_a_pair() -> None:
    """The pair's C_R is the mean of both gears: here of a solid pinion and a wheel with b_s/b = 0.3, s_R/m_n = 3."""
    plain = sample_pair()
    bodies = Body(web_thickness=0.3 * 28, rim_thickness=9.0), Body(web_thickness=0.1 * 28, rim_thickness=2.4)
    solid, webbed, thin = (
        rate(replace(plain, wheel=replace(plain.wheel, body=body)), STEEL, LOAD) for body in (Body(), *bodies)
    )
    factor = 1 + math.log(0.3) / (5 * math.exp(0.6))
    assert webbed.stiffness.mesh_beta / solid.stiffness.mesh_beta == pytest.approx((1 + factor) / 2, rel=EXACT)
    assert webbed.to_dict()["C_R"] == pytest.approx((1 + factor) / 2, rel=EXACT)
    assert webbed.warnings == ()
    assert thin.stiffness.blank_factor == pytest.approx((1 + gear_blank_factor(0.2, 1.0)) / 2, rel=EXACT)
    assert "webs of 0.2 to 1.2 b, the wheel's 0.1 b counts as 0.2 b" in thin.warnings[0]
    assert "rims from 1 m_n on, the wheel's 0.8 m_n counts as 1 m_n" in thin.warnings[1]


def test_low_load_and_material() -> None:
    assert [low_load_factor(load) for load in (1600.0, 100.0)] == [1, 1]
    assert low_load_factor(6.25) == pytest.approx(0.5, rel=EXACT)
    assert [material_factor(modulus) for modulus in (190e3, 205e3, 216e3)] == [1, 1, 1]
    assert material_factor(70e3) == pytest.approx(70 / 206, rel=EXACT)
    light = rate(sample_pair(), STEEL, Load(torque=1.0, application_factor=2.0))
    values = light.to_dict()
    factor = (2 * light.tangential_force / 28 / 100) ** 0.25
    assert values["low_load_factor"] == pytest.approx(factor, rel=EXACT)
    for name in ("c_prime", "c_gamma_alpha", "c_gamma_beta"):
        assert values[f"{name}_lowload"] == pytest.approx(values[name] * factor, rel=EXACT)
    found = light.stiffness
    assert [found.single, found.mesh_alpha, found.mesh_beta] == [
        values[f"{name}_lowload"] for name in ("c_prime", "c_gamma_alpha", "c_gamma_beta")
    ]


def test_flank_factors() -> None:
    assert contact_ratio_factor(1.6, 0.0) == pytest.approx(math.sqrt(0.8), rel=EXACT)
    assert contact_ratio_factor(1.6, 0.5) == pytest.approx(math.sqrt(0.4 + 0.5 / 1.6), rel=EXACT)
    assert contact_ratio_factor(1.6, 1.7) == pytest.approx(math.sqrt(1 / 1.6), rel=EXACT)
    assert [contact_factor(1.1, overlap) for overlap in (0.0, 0.4, 1.0, 2.0)] == pytest.approx([1.1, 1.06, 1, 1], rel=EXACT)
    assert contact_factor(0.9, 0.0) == 1
    for helix in (-25.0, 25.0):
        one, other = (helix_angle_factor(helix, edition) for edition in (Edition.ISO_2006, Edition.DIN_1987))
        assert one * other == pytest.approx(1, rel=EXACT)
        assert one == pytest.approx(1 / math.sqrt(math.cos(math.radians(25))), rel=EXACT)


def _warnings(pair: GearPair, load: Load = LOAD) -> str:
    return "\n".join(rate(pair, STEEL, load).warnings)


def test_nothing_to_warn_about() -> None:
    assert rate(sample_pair(), STEEL, LOAD).warnings == ()


def _deep_pair() -> GearPair:
    gear = Gear(teeth=50, normal_module=2.0, face_width=20.0, rack=BasicRack(addendum=1.25, dedendum=1.5, root_radius=0.25))
    return GearPair(pinion=gear, wheel=replace(gear, teeth=60))


STEEP = BasicRack(pressure_angle=26.0, root_radius=0.2)
STUBBY = BasicRack(addendum=0.7)
SHARP = BasicRack(root_radius=0.0)


@pytest.mark.parametrize(
    ("pair", "expected"),
    [
        (sample_pair(32.0), "ISO 6336 is confirmed for helix angles up to 30 deg, here 32 deg"),
        (sample_pair(0.0, rack=STEEP), "ISO 6336 is confirmed for pressure angles from 15 to 25 deg, here 26 deg"),
        (sample_pair(0.0, profile_shift=-0.3), "c': q' is stated for x_1 + x_2 from -0.5 to 2, here -0.6"),
        (sample_pair(0.0, rack=STUBBY), "c_gamma: stated from a contact ratio of 1.2, here 1.1"),
        (sample_pair(0.0, rack=SHARP), "wheel root: Y_F and Y_S are stated for a tool with a rounded tip, here it is sharp"),
        (_deep_pair(), "sigma_H: Z_eps, Z_B and Z_D hold for a contact ratio up to 2, here 2.1"),
        (_deep_pair(), "pinion root: Y_F assumes that one pair of teeth carries alone, but eps_alphan is 2.1"),
    ],
)
def test_ranges(pair: GearPair, expected: str) -> None:
    assert expected in _warnings(pair)


def test_range_of_the_notch() -> None:
    pair = sample_pair(0.0, rack=BasicRack(root_radius=0.02))
    pair = replace(pair, wheel=replace(pair.wheel, teeth=180, profile_shift=0.6), centre_distance=None)
    section = rate(pair, STEEL, LOAD).roots.wheel.section
    assert section.notch_parameter > 8
    assert section.notch_parameter == pytest.approx(section.chord / 2 / section.fillet_radius, rel=EXACT)
    assert f"wheel root: Y_S is stated for q_s from 1 to 8, here {section.notch_parameter:.3g}" in _warnings(pair)


def test_tangent_beyond_the_fillet() -> None:
    gear = Gear(
        teeth=60,
        normal_module=2.0,
        face_width=10.0,
        profile_shift=0.3,
        rack=BasicRack(pressure_angle=35.0, addendum=0.8, dedendum=0.9, root_radius=0.1),
    )
    pair = GearPair(pinion=gear, wheel=gear)
    assert not rate(pair, STEEL, LOAD).roots.wheel.section.on_fillet
    assert "wheel root: the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold" in _warnings(pair)


def test_range_of_the_shifts() -> None:
    gear = Gear(teeth=19, normal_module=3.0, face_width=30.0, profile_shift=-0.1)
    pair = GearPair(pinion=gear, wheel=replace(gear, teeth=47, profile_shift=0.2))
    assert "c': q' is stated for x_1 >= x_2, here -0.1 and 0.2" in _warnings(pair)


def test_high_load() -> None:
    assert "c': confirmed up to a specific load of 1600 N/mm, here 1695 N/mm" in _warnings(sample_pair(), Load(torque=1400.0))


def test_thin_rim_raises_the_root_stress() -> None:
    plain = sample_pair(0.0)
    solid = rate(plain, STEEL, LOAD)
    for bore, words in ((44.0, "weakens the root (below 1.2)"), (49.0, "is at most 0.5, which the standard asks to avoid")):
        bored = replace(plain, pinion=replace(plain.pinion, body=Body(bore=bore)))
        gear, rating = bored.pinion, rate(bored, STEEL, LOAD)
        ratio = (gear.root_diameter - bore) / (gear.tip_diameter - gear.root_diameter)
        assert rim_thickness_ratio(gear) == pytest.approx(ratio, rel=EXACT)
        factor = 1.6 * math.log(2.242 / ratio)
        assert rating.roots.pinion.nominal_stress / solid.roots.pinion.nominal_stress == pytest.approx(factor, rel=EXACT)
        disc, warning = rating.warnings
        assert [notice.code for notice in rating.notices] == ["stiffness-solid-disc", "thin-rim"]
        assert disc == f"c': C_R is 1 of a solid disc, but the pinion has only {ratio:.3g} tooth heights under the root"
        assert warning == f"pinion rim: {ratio:.3g} tooth heights under the root {words}; Y_B = {factor:.4g}"
        assert rate(bored, STEEL, LOAD, RatingOptions(standard=Edition.DIN_1987)).roots.pinion.rim_thickness_factor == 1
    webbed = replace(plain, pinion=replace(plain.pinion, body=Body(web_thickness=10.0, rim_thickness=5.0)))
    assert rim_thickness_ratio(webbed.pinion) == pytest.approx(ratio * 5 / ((webbed.pinion.root_diameter - 49) / 2))
    keyed = replace(plain.pinion, body=Body(bore=30.0, keyway_width=8.0, keyway_depth=3.3))
    assert rim_thickness_ratio(keyed) < rim_thickness_ratio(replace(keyed, body=Body(bore=30.0)))


def test_deep_teeth_of_high_accuracy() -> None:
    pair = _deep_pair()
    ratio = pair.transverse_contact_ratio
    assert 2.05 < ratio < 2.5
    coarse, fine = (rate(pair, STEEL, LOAD, RatingOptions(accuracy_grade=grade)) for grade in (6, 4))
    assert fine.roots.wheel.nominal_stress / coarse.roots.wheel.nominal_stress == pytest.approx(
        2.366 - 0.666 * ratio, rel=EXACT
    )


# ---------------------------------------------------------------------- errors and documents


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"standard": "AGMA"}, "standard = 'AGMA': must be one of 'ISO 6336:2006', 'ISO 6336:2019', 'DIN 3990:1987'"),
        ({"accuracy": "DIN 3962"}, "accuracy = 'DIN 3962': must be one of 'ISO 1328-1:1995', 'ISO 1328-1:2013'"),
        ({"accuracy_grade": 13}, "accuracy_grade = 13: must be a whole number from 0 to 12"),
        ({"accuracy": "ISO 1328-1:2013", "accuracy_grade": 12}, "accuracy_grade = 12: must be a whole number from 1 to 11"),
    ],
)
def test_refuses_options(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        RatingOptions(**options)
    assert str(caught.value) == message


def test_refuses_no_load() -> None:
    with pytest.raises(ParameterError, match="torque = 0 N·m: must not be 0 N·m: a rating needs a load"):
        rate(sample_pair(), STEEL, Load(torque=0.0))


def test_refuses_a_pair_that_does_not_always_touch() -> None:
    pair = sample_pair(0.0, rack=BasicRack(addendum=0.4))
    permitted = r"transverse_contact_ratio = 0\.\d+: must be at least 1 and below 3 for a rating: nothing touches for part of"
    with pytest.raises(GeometryError, match=permitted):
        rate(pair, STEEL, LOAD)


def test_refuses_single_contact_below_a_base_circle() -> None:
    gear = Gear(teeth=6, normal_module=2.0, face_width=10.0, rack=BasicRack(addendum=0.9))
    pair = GearPair(pinion=gear, wheel=replace(gear, teeth=60))
    for each, owner in ((pair, "pinion"), (swapped(pair), "wheel")):
        permitted = rf"^{owner}\.tip_diameter = 15.6 mm: must be larger for a rating: .* below the {owner}'s base circle$"
        with pytest.raises(GeometryError, match=permitted):
            rate(each, STEEL, LOAD)


def test_standard_may_be_named() -> None:
    edition = rate(sample_pair(), STEEL, LOAD, RatingOptions(standard="DIN 3990:1987")).edition  # type: ignore[arg-type]
    assert edition is Edition.DIN_1987
    assert (edition.part(3), edition.dated_part(3)) == ("DIN 3990-3", "DIN 3990-3:1987")


def test_document_has_a_symbol_for_everything() -> None:
    document = rate(sample_pair(), STEEL, LOAD).to_dict()
    assert json.loads(json.dumps(document)) == document
    assert set(document) - {"pinion", "wheel", "warnings", "notices"} == set(symbols.RATING)
    assert set(document["pinion"]) == set(document["wheel"]) == set(symbols.GEAR_RATING)
    for table in (symbols.RATING, symbols.GEAR_RATING):
        words = [symbol.words for symbol in table.values()]
        assert len(set(words)) == len(words)
        assert all(words)


def _assert_sound(pair: GearPair, rating: Rating) -> None:
    found = numbers(rating.to_dict())
    assert all(math.isfinite(number) for number in found.values())
    angles = {"pinion.alpha_Fen", "wheel.alpha_Fen"}  # negative where few teeth lean in above the load
    assert all(number > 0 for name, number in found.items() if name not in angles)
    assert rating.contact_stresses[0] >= rating.flank.nominal_stress


@settings(max_examples=100)
@given(pair_inputs())
def test_any_pair_is_rated_or_refused_in_one_line(inputs: dict[str, Any]) -> None:
    try:
        pair = build_pair(inputs)
    except InputError:
        return
    try:
        rating = rate(pair, STEEL, Load(torque=-50.0))
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert "\n" not in str(error)
        return
    event("rated")
    _assert_sound(pair, rating)

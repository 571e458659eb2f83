"""Where the formulas leave their ranges, what is refused, and the document of a rating."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import event, given, settings
from support.ratings import STEEL, numbers, sample_pair, swapped
from support.strategies import build_pair, pair_inputs

from gearcad import BasicRack, Body, Gear, GearPair, GeometryError, Load, ParameterError
from gearcad.core import symbols
from gearcad.core.errors import InputError
from gearcad.rating import Edition, Rating, RatingOptions, rate
from gearcad.rating.tooth_stiffness import rim_thickness_ratio

EXACT = 1e-12
"""Relative: the same quantity by two formulas."""

LOAD = Load(torque=350.0)


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

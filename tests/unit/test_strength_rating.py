"""Full ratings and load spectra: closed forms between results, Miner's sum by hand, and faults in one line."""

import json
import math
import re
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

from gearcad import (
    BasicRack,
    Body,
    DoubleHelix,
    Gear,
    GearPair,
    GeometryError,
    Load,
    Material,
    ParameterError,
    Rack,
    RackPair,
    rate,
)
from gearcad.core.output import json_text
from gearcad.core.records import PerGear, Verdict
from gearcad.material import MaterialGroup as G
from gearcad.rating import RatingOptions, RootShift
from gearcad.rating.factors import flank_life_factor, flank_points, root_life_factor, root_points
from gearcad.rating.load_factors import BodyLoad
from gearcad.rating.strength import RatedPart, StrengthRating, rate_strength
from gearcad.rating.strength.duty import (
    FLANK_POWER,
    ROOT_POWER,
    damage_sum,
    equivalent_torque,
    life_at_failure,
    permissible_cycles,
    permissible_torque,
    safety_at_failure,
    torque_at_safety,
    torque_exponent,
)

EXACT = 1e-9
CASE_HARDENED = Material(name="Eh MQ")
LOAD = Load(torque=250.0, speed=1500.0, application_factor=1.25)
LIFE = RatingOptions(life=2000.0)
UNSHAKEN = replace(LOAD, application_factor=1.0)
SINGLE = (([[1.0, 1.0]], 1.0), ([[0.25, 1.0], [0.75, 1.0, 1.0]], 1.0), ([[0.25, 1.0], [0.75, 0.0]], 0.25))
"""Spectra of one load, and the share of the life that it has."""


def spur_pair(**inputs: Any) -> GearPair:
    gears = (Gear(teeth=z, normal_module=3, face_width=30, body=Body(bore=20), **inputs) for z in (20, 50))
    return GearPair(**dict(zip(("pinion", "wheel"), gears, strict=True)))


def rated(options: RatingOptions = LIFE, load: Load = LOAD, **inputs: Any) -> StrengthRating:
    return rate_strength(spur_pair(**inputs), CASE_HARDENED, load, options)


def test_stress_and_strength_are_their_products() -> None:
    rating = rated()
    k, flank = rating.load_factors, rating.nominal.flank
    assert k is not None
    factors = k.application * k.mesh_load * k.dynamic * k.face_flank * k.transverse_flank
    assert rating.flank.pinion.stress == pytest.approx(
        flank.contact_factors.pinion * flank.nominal_stress * math.sqrt(factors), rel=EXACT
    )
    factors *= k.face_root * k.transverse_root / (k.face_flank * k.transverse_flank)
    assert rating.root.wheel.stress == pytest.approx(rating.nominal.roots.wheel.nominal_stress * factors, rel=EXACT)
    assert rating.flank.wheel.strength == pytest.approx(1500 * math.prod(rating.flank.wheel.factors.values()), rel=EXACT)
    assert rating.root.pinion.strength == pytest.approx(2 * 425 * math.prod(rating.root.pinion.factors.values()), rel=EXACT)
    assert rating.flank.pinion.cycles == 60 * 1500 * 2000
    assert rating.flank.wheel.cycles == pytest.approx(60 * 1500 * 2000 / 2.5, rel=EXACT)
    assert rating.root.pinion.safety == rating.root.pinion.strength / rating.root.pinion.stress


@pytest.mark.parametrize(("life", "flank", "root"), [(2000.0, False, False), (100.0, True, False), (10.0, True, True)])
def test_factors_of_limited_life_are_to_be_verified(life: float, flank: bool, root: bool) -> None:
    """90 000 load cycles an hour of the pinion: Eh lives for ever from 5e7 on at its flanks, from 3e6 on at its roots."""
    verify = rated(RatingOptions(life=life)).verify
    assert {symbol in verify for symbol in ("Z_L", "Z_v", "Z_R", "Z_W", "Z_X")} == {flank}
    assert {symbol in verify for symbol in ("Y_delta_relT", "Y_RrelT", "Y_X")} == {root}


def test_life_and_torque_are_those_at_which_the_required_safety_is_left() -> None:
    rating = rated(load=replace(LOAD, torque=350.0))
    life = rating.life
    assert life is not None
    assert life == rating.flank.pinion.life < 2000
    assert rated(replace(LIFE, life=life), replace(LOAD, torque=350.0)).flank.pinion.safety == pytest.approx(1, rel=EXACT)
    for part, role in ((RatedPart.FLANK, "pinion"), (RatedPart.ROOT, "wheel")):
        torque = getattr(rating.parts[part], role).permissible_torque
        found = getattr(rated(load=replace(LOAD, torque=torque)).parts[part], role)
        assert found.safety == pytest.approx(found.required, rel=EXACT)


def test_a_spectrum_of_one_load_is_that_load() -> None:
    """Also beyond 10^10 load cycles; parts of the life without torque have no load cycles."""
    for life, (spectrum, share) in product((2000.0, 2e6), SINGLE):
        plain = rated(replace(LIFE, life=share * life), UNSHAKEN)
        several = rated(RatingOptions(life=life, spectrum=spectrum), UNSHAKEN)
        for (_, one), (_, other) in zip(plain.every, several.every, strict=True):
            assert (other.safety, other.stress, other.cycles) == pytest.approx((one.safety, one.stress, one.cycles), rel=EXACT)
            assert (other.damage, share * other.life) == pytest.approx((one.damage, one.life), rel=EXACT)
        assert "beyond-knee" not in {notice.code for notice in several.notices}


def test_what_is_told_of_a_spectrum_is_of_its_greatest_torque() -> None:
    several = rated(RatingOptions(life=2e5, spectrum=[[0.9, 0.8, 1.5], [0.1, 1.25, 0.5]]), UNSHAKEN)
    alone = rated(load=Load(torque=1.25 * 250, speed=750))
    assert (several.governing_number, several.governing.load.speed) == (2, 750.0)
    assert "load 2: 312.5 N·m, 750 rpm" in several.told_load and not alone.told_load
    assert several.governing.factors.to_dict() == pytest.approx(alone.load_factors.to_dict(), rel=EXACT)
    for (_, one), (_, other) in zip(several.every, alone.every, strict=True):
        assert one.stress == pytest.approx(other.stress, rel=EXACT)
    speed_factor = several.flank.pinion.resistance.endurance["Z_v"]
    assert speed_factor == pytest.approx(alone.flank.pinion.resistance.endurance["Z_v"], rel=EXACT)


def test_damage_beyond_the_last_corner_is_told() -> None:
    """The line of ISO 6336-6 goes on where Z_NT and Y_NT stay, which 10^11 load cycles tell apart."""
    spectrum = [[0.5, 0.9], [0.5, 1.0]]
    codes = [
        {notice.code for notice in rated(RatingOptions(life=life, spectrum=spectrum), UNSHAKEN).notices} for life in (20, 2e6)
    ]
    assert ["beyond-knee" in each for each in codes] == [False, True]


def test_scuffing_that_no_safety_is_asked_of_is_told_with_the_verdict() -> None:
    options = replace(LIFE, scuffing_stage=5, oil_viscosity_40=100.0)
    verdict = rated(options, replace(UNSHAKEN, speed=6000.0)).verdict
    assert re.search(r"; scuffing not judged \(no required_safety_scuffing\): risk (high|critical), S_int \d\.\d\d", verdict)
    assert "scuffing" not in rated(replace(options, scuffing_stage=12), replace(UNSHAKEN, torque=20.0)).verdict


def test_a_life_and_load_cycles_are_not_both_given() -> None:
    with pytest.raises(ParameterError, match=r"^load_cycles = 10000000: must be left out beside life = 2000 h, or life$"):
        replace(LIFE, load_cycles=1e7)


def test_an_uneven_load_that_is_given_says_how_much_of_the_width_carries() -> None:
    texts = rated(replace(LIFE, face_load_factor=4.0)).warnings
    assert any("carried by 50% of the face width" in text for text in texts)


def test_a_spectrum_is_between_its_least_and_its_greatest_load() -> None:
    plain = replace(LOAD, application_factor=1.0)
    found = rated(replace(LIFE, spectrum=[[0.1, 1.25], [0.9, 0.8, 1.2]]), plain).flank.pinion.safety
    least, most = (rated(load=replace(plain, torque=250 * share)).flank.pinion.safety for share in (1.25, 0.8))
    assert least < found < most


def test_a_double_helical_pair_is_two_halves() -> None:
    def pair(width: float, torque: float, **inputs: Any) -> StrengthRating:
        gears = (
            Gear(teeth=z, normal_module=3, face_width=width, helix_angle=helix, **inputs) for z, helix in ((20, 25), (50, -25))
        )
        pair = GearPair(**dict(zip(("pinion", "wheel"), gears, strict=True)))
        return rate_strength(pair, CASE_HARDENED, replace(LOAD, torque=torque), replace(LIFE, shaft_deflection=3.0))

    half, whole = pair(25, 200), pair(60, 400, double_helix=DoubleHelix(gap_width=10))
    for one, other in zip(half.every, whole.every, strict=True):
        assert other[1].safety == pytest.approx(one[1].safety, rel=EXACT)
        assert other[1].permissible_torque == pytest.approx(2 * one[1].permissible_torque, rel=1e-6)


def test_the_softer_gear_says_what_the_film_is() -> None:
    soft = Material(name="V MQ", hardness=250.0, yield_strength=600.0)
    rating = rate_strength(spur_pair(), PerGear(CASE_HARDENED, soft), LOAD, LIFE)
    assert (
        rating.flank.pinion.factors["Z_L"] > rated().flank.pinion.factors["Z_L"] > 1
    )  # thick oil, which soft flanks gain more by
    assert rating.flank.wheel.factors["Z_W"] > 1 == rating.flank.pinion.factors["Z_W"]


def test_root_shift() -> None:
    thin = {"tooth_thinning": 0.2}
    nominal = rated(replace(LIFE, root_shift=RootShift.NOMINAL), **thin).nominal.roots
    assert nominal.pinion.form_factor == pytest.approx(rated().nominal.roots.pinion.form_factor, rel=EXACT)
    assert rated(**thin).nominal.roots.pinion.form_factor > nominal.pinion.form_factor


STEEL = Material()
LIGHT = replace(LOAD, torque=150.0)
ASKED = replace(LIFE, required_safety_root=1.4)
GIVEN = RatingOptions(dynamic_factor=1.1, load_cycles=1e7)


@pytest.mark.parametrize(
    ("material", "load", "options", "inputs", "unjudged", "reason"),
    [
        (STEEL, LIGHT, ASKED, {}, 4, "is not known: the material has no group"),
        (CASE_HARDENED, replace(LIGHT, speed=0.0), LIFE, {}, 4, "the speed is 0 rpm"),
        (CASE_HARDENED, replace(LIGHT, speed=0.0), GIVEN, {}, 0, ""),
        (Material(group="Eh", contact_endurance_limit=1500.0), LIGHT, LIFE, {}, 2, "sigma_Flim is not known"),
        (Material(contact_endurance_limit=1500.0, root_endurance_limit=430.0), LIGHT, LIFE, {}, 4, "the material has no group"),
        (CASE_HARDENED, LIGHT, LIFE, {"body": Body(bore=50)}, 1, "Y_B holds for rims of more than 0.5 tooth heights"),
        (CASE_HARDENED, LIGHT, LIFE, {"addendum": 1.3}, 2, "hold for a transverse contact ratio up to 2"),
        (CASE_HARDENED, replace(LIGHT, application_factor=1.0), RatingOptions(spectrum=[[1, 1]]), {}, 4, "needs life or load"),
        (CASE_HARDENED, LIGHT, replace(LIFE, face_load_factor="fe"), {}, 4, "face_load_factor = 'fe': must be"),
        (CASE_HARDENED, LIGHT, replace(LIFE, required_safety_scuffing=1.5), {}, 1, "scuffing_stage"),
    ],
)
def test_what_is_not_judged_says_why(
    material: Material, load: Load, options: RatingOptions, inputs: dict[str, Any], unjudged: int, reason: str
) -> None:
    gears = [
        Gear(
            teeth=z,
            normal_module=3,
            face_width=30,
            body=inputs.get("body", Body()) if z == 20 else Body(),
            rack=BasicRack(addendum=inputs.get("addendum", 1.0), dedendum=inputs.get("addendum", 1.0) + 0.25, root_radius=0.2),
        )
        for z in (20, 50)
    ]
    rating = rate_strength(GearPair(pinion=gears[0], wheel=gears[1]), material, load, options)
    assert len(rating.not_judged) == unjudged
    assert rating.passed is (None if unjudged else True)
    assert all(reason in why for why in rating.not_judged.values())
    assert reason in rating.verdict
    json.loads(json_text(rating.to_dict()))


def test_a_failure_outweighs_what_was_not_judged() -> None:
    material = Material(group="Eh", contact_endurance_limit=500.0)
    rating = rate_strength(spur_pair(), material, LOAD, LIFE)
    assert (rating.strength, rating.passed) == (Verdict.FAILED, False)
    assert rating.verdict.startswith("strength NOT passed: flank of the pinion, flank of the wheel; not judged: root of")


@pytest.mark.parametrize(
    ("material", "load", "options", "text"),
    [
        (Material(name="Eh MQ", hardness=500.0), LOAD, LIFE, r"hardness = 500 HV: must be from 660 to 800 HV"),
        (Material(name="V MQ"), LOAD, LIFE, r"hardness is missing: must be given, from 200 to 360 HV"),
        (CASE_HARDENED, replace(LOAD, torque=0.0), LIFE, r"^torque = 0 N·m: must not be 0"),
        (CASE_HARDENED, LOAD, replace(LIFE, spectrum=[[1, 1]]), r"^load\.application_factor = 1\.25: must be 1 with a load"),
    ],
)
def test_faults_are_one_line(material: Material, load: Load, options: RatingOptions, text: str) -> None:
    with pytest.raises(ParameterError, match=text) as caught:
        rate_strength(spur_pair(), material, load, options)
    assert "\n" not in str(caught.value)


def test_a_face_load_factor_of_bodies_is_cited_as_theirs() -> None:
    found = rate_strength(spur_pair(), CASE_HARDENED, LOAD, LIFE, body_load=BodyLoad(1.5, 11.6, mounted=False))
    document = found.to_dict()
    assert document["factors"]["K_Hbeta"] == 1.5
    assert "Method A" in document["sources"]["K_Hbeta"]
    assert any("F_beta_y = 11.6 µm of Method C" in each for each in document["assumed"])


def test_a_contact_ratio_below_one_is_no_pair_to_rate() -> None:
    gears = [Gear(teeth=z, normal_module=3, face_width=30, tip_alteration=-0.8) for z in (20, 50)]
    with pytest.raises(GeometryError, match=r"transverse_contact_ratio = 0\.\d+: must be at least 1"):
        rate(GearPair(pinion=gears[0], wheel=gears[1]), LOAD)


def test_a_rack_is_judged_by_load_factors_that_are_given() -> None:
    pair = RackPair(
        pinion=Gear(teeth=24, normal_module=3, face_width=30),
        rack=Rack(teeth=40, normal_module=3, face_width=30, height=30.0),
    )
    rating = rate_strength(pair, CASE_HARDENED, LOAD, LIFE)
    assert "must be a number for a rack" in rating.verdict
    given = replace(LIFE, dynamic_factor=1.1, face_load_factor=1.3, transverse_load_factor=1.0)
    rating = rate_strength(pair, CASE_HARDENED, LOAD, given)
    assert rating.passed is not None
    assert rating.root.wheel.stress == pytest.approx(rating.nominal.roots.wheel.nominal_stress * 1.25 * 1.1 * 1.3, rel=EXACT)
    assert set(rating.to_dict()["safety"]["flank"]) == {"pinion", "rack"}
    assert "load cycles of the rack are those of the pinion" in rating.assumed


FLANK = tuple((cycles, 1300 * factor) for cycles, factor in flank_points(G.CASE_HARDENED))
ROOT = tuple((cycles, 860 * factor) for cycles, factor in root_points(G.CASE_HARDENED))
CYCLES, STRESSES = np.array([1e4, 1e6, 1e8, 3e9]), np.array([1500.0, 1200, 950, 700])


def _by_hand(stress: float) -> float:
    """N of a flank, with the slopes worked out: 13.2225 of limited life, which goes on above 2080 MPa, 32.6008 beyond."""
    if stress >= 1300:
        return 5e7 * (1300 / stress) ** (math.log(500) / math.log(1.6))
    return 5e7 * (1300 / stress) ** (math.log(200) / math.log(1 / 0.85))


def test_permissible_cycles() -> None:
    stresses = np.array([2500.0, 2081, 2080, 1900, 1300, 1200, 1105, 900, 0.001])
    expected = [_by_hand(float(stress)) for stress in stresses]
    assert permissible_cycles(stresses, FLANK)[:-1] == pytest.approx(expected[:-1], rel=1e-9)
    assert permissible_cycles(0.0, FLANK) > 1e200
    kept = permissible_cycles(stresses, FLANK, endurance=True)
    assert kept[:7] == pytest.approx(expected[:7], rel=1e-9)
    assert kept[7:].tolist() == [math.inf, math.inf]
    level = tuple((cycles, 1300 * factor) for cycles, factor in flank_points(G.CASE_HARDENED, long_life=1.0))
    assert permissible_cycles(np.array([1300.001, 1300, 800]), level) == pytest.approx([5e7, math.inf, math.inf], rel=1e-4)


def test_a_static_strength_below_endurance_holds_for_more_cycles_too() -> None:
    odd = ((1e3, 100.0), (3e6, 120.0), (1e10, 102.0))
    assert permissible_cycles(np.array([100.1, 100, 50]), odd).tolist() == [0, math.inf, math.inf]


def test_the_line_of_limited_life_goes_on_above_the_static_strength() -> None:
    """No jump at the corner; twice the stress is 2^-13.2225 of the cycles; a level start goes on from where it ends."""
    found = permissible_cycles(np.array([2080 * (1 - 1e-9), 2080 * (1 + 1e-9), 4160.0]), FLANK)
    assert found == pytest.approx([1e5, 1e5, 1e5 * 2 ** -(math.log(500) / math.log(1.6))], rel=1e-6)
    level = ((1e3, 2080.0), *FLANK)
    assert permissible_cycles(np.array([2080.001, 4160.0]), level) == pytest.approx(found[1:], rel=1e-5)
    # The safety is never more than the static strength over the greatest stress.
    assert safety_at_failure(np.array([1.0]), np.array([4160.0]), FLANK) == pytest.approx(0.5, rel=1e-12)


@pytest.mark.parametrize("endurance", [False, True])
def test_the_safety_is_that_of_a_damage_of_one(endurance: bool) -> None:
    """Against the damage at 20,001 safeties, summed by hand."""
    tried = np.linspace(0.8, 1.6, 20_001)
    limit = 1105 if endurance else 0
    damage = [
        sum(n / max(_by_hand(s * each), 1e-99) for n, s in zip(CYCLES, STRESSES, strict=True) if s * each >= limit)
        for each in tried[::100]
    ]
    found = [damage_sum(CYCLES, STRESSES, FLANK, safety=each, endurance=endurance) for each in tried[::100]]
    inside = [each for each, value in enumerate(damage) if value < 1e50]
    assert np.array(found)[inside] == pytest.approx(np.array(damage)[inside], rel=1e-9)
    safety = safety_at_failure(CYCLES, STRESSES, FLANK, endurance=endurance)
    assert damage_sum(CYCLES, STRESSES, FLANK, safety=safety, endurance=endurance) <= 1
    assert damage_sum(CYCLES, STRESSES, FLANK, safety=safety * (1 + 1e-9), endurance=endurance) > 1
    assert tried[::100][np.searchsorted(damage, 1) - 1] <= safety <= tried[::100][np.searchsorted(damage, 1)]


def test_one_load_has_the_safety_of_the_life_factor() -> None:
    for cycles in (1.0, 1e3, 1e5, 3e6, 5e7, 2e8, 1e10):
        one = np.array([cycles])
        flank = 1300 * flank_life_factor(cycles, G.CASE_HARDENED) / 1000
        assert safety_at_failure(one, np.array([1000.0]), FLANK) == pytest.approx(flank, rel=1e-9)
        root = 860 * root_life_factor(cycles, G.CASE_HARDENED) / 400
        assert safety_at_failure(one, np.array([400.0]), ROOT) == pytest.approx(root, rel=1e-9)


def test_more_load_and_more_cycles_are_never_safer() -> None:
    chance = np.random.default_rng(19)
    for _ in range(20):
        cycles, stresses = 10 ** chance.uniform(3, 10, 5), chance.uniform(500, 1600, 5)
        safety = safety_at_failure(cycles, stresses, FLANK)
        which = int(chance.integers(5))
        more, higher = cycles.copy(), stresses.copy()
        more[which] *= 2
        higher[which] *= 1.1
        assert safety_at_failure(more, stresses, FLANK) <= safety
        assert safety_at_failure(cycles, higher, FLANK) <= safety
        assert safety_at_failure(cycles, 2 * stresses, FLANK) == pytest.approx(safety / 2, rel=1e-9)


def test_no_load_and_no_number() -> None:
    assert safety_at_failure(np.array([0.0, 1e6]), np.array([5000.0, 0]), FLANK) == math.inf
    assert damage_sum(np.array([0.0, 1e5]), np.array([5000.0, 2080]), FLANK) == pytest.approx(1)
    assert damage_sum(np.array([1.0, 1e5]), np.array([5000.0, 2080]), FLANK) == pytest.approx(1 + 1 / _by_hand(5000.0))
    with pytest.raises(ParameterError, match="stress"):
        safety_at_failure(np.array([1.0]), np.array([math.nan]), FLANK)


def test_life() -> None:
    damage = damage_sum(CYCLES, STRESSES, FLANK)
    life = life_at_failure(20_000.0, damage)
    assert damage_sum(CYCLES * life / 20_000, STRESSES, FLANK) == pytest.approx(1, rel=1e-12)
    assert life_at_failure(20_000.0, 0.0) == math.inf
    assert life_at_failure(20_000.0, math.inf) == 0


@pytest.mark.parametrize(("points", "power"), [(flank_points(G.NITRIDED), FLANK_POWER), (root_points(G.NITRIDED), ROOT_POWER)])
def test_the_equivalent_torque_does_the_same_damage_in_limited_life(points: tuple, power: float) -> None:
    curve = tuple((cycles, 1000 * factor) for cycles, factor in points)
    cycles, torques = np.array([2e4, 1e5, 3e5]), np.array([160.0, 140, 130])
    stresses = 1200 * (torques / 150) ** (1 / power)
    assert np.all((stresses > 1000) & (stresses < curve[0][1]))
    steady = equivalent_torque(cycles, torques, torque_exponent(points, power))
    whole, stress = np.array([cycles.sum()]), np.array([1200 * (steady / 150) ** (1 / power)])
    assert damage_sum(whole, stress, curve) == pytest.approx(damage_sum(cycles, stresses, curve), rel=1e-12)
    assert equivalent_torque(np.zeros(2), np.ones(2), 6.0) == 0
    assert equivalent_torque(np.ones(2), np.array([1e6, 1e6]), 84.0) == pytest.approx(1e6)


def test_torque_for_a_safety() -> None:
    """Where load factors stay, in closed form; where they depend on torque, S = 100/(T + 20) is 1.25 at 60 N·m."""
    assert permissible_torque(300.0, 1.5, 1.2, FLANK_POWER) == pytest.approx(300 * 1.5625)
    assert torque_at_safety(lambda torque: 1.5 * math.sqrt(300 / torque), 1.2, 300.0) == pytest.approx(300 * 1.5625, rel=1e-11)
    for begin in (0.01, 60.0, 5e4):
        assert torque_at_safety(lambda torque: 100 / (torque + 20), 1.25, begin) == pytest.approx(60, rel=1e-11)
    assert torque_at_safety(lambda torque: 10 / (torque + 20), 1.25, 1.0) == 0
    assert torque_at_safety(lambda torque: 5.0, 1.25, 1.0) == math.inf

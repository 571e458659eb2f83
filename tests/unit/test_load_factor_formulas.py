"""Formulas of the load factors and face load factors: values by hand and of printed reports, limits, many variants at once."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from gearcad import BasicRack, Body, Gear, GearPair
from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear
from gearcad.rating import root_face_load_factor, width_to_height
from gearcad.rating.editions import Edition
from gearcad.rating.load_factor_formulas import (
    FlankWear,
    RunningIn,
    arrangement_factor,
    bearing_width,
    body_mass,
    dynamic_factor_b,
    dynamic_factor_c,
    face_load_exponent,
    face_load_factor,
    flank_limit,
    helix_factors,
    initial_misalignment,
    least_misalignment,
    manufacturing_misalignment,
    mass_of,
    pair_mass,
    proven_misalignment,
    resonance_speed,
    root_limit,
    running_in_beta,
    shaft_deflection,
    shaft_term,
    speed_measure,
    transverse_load_factor,
    within,
)
from gearcad.rating.options import BearingArrangement, HelixModification

EXACT = 1e-12
"""Relative: the same quantity by two formulas."""

RNG_SEED = 19


def of_report(teeth: int, helix: float) -> Gear:
    """Gears of the report "helical 25/40": tip and root circles as printed there."""
    circles = {25: (57.209, 50.047), 40: (89.134, 81.42)}[teeth]
    return Gear(
        teeth=teeth,
        normal_module=2.0,
        helix_angle=helix,
        face_width=26.0,
        rack=BasicRack(dedendum=1.3, root_radius=0.3),
        tip_diameter=circles[0],
        root_diameter=circles[1],
    )


# ---------------------------------------------------------------------- masses and K_v


def test_mass_and_resonance_of_printed_reports() -> None:
    """Printed: 0.0074 kg/mm and 18419 rpm, by (30), which takes the wheel for u times the pinion; both bodies: 18482 rpm."""
    pinion, wheel = (mass_of(of_report(teeth, helix), 7800.0) for teeth, helix in ((25, 20.0), (40, -20.0)))
    by_standard, by_bodies = pair_mass(pinion, 1.6**2 * pinion), pair_mass(pinion, wheel)
    assert by_standard == pytest.approx(0.0074, abs=5e-5)
    assert resonance_speed(25, 17.21, by_standard) == pytest.approx(18419, abs=50)
    assert by_bodies == pytest.approx(0.00735, abs=5e-6)
    assert resonance_speed(25, 17.2047, by_bodies) == pytest.approx(18482, abs=5)


def test_masses_of_bodies() -> None:
    """A disc of 100 mm turns as J = m d²/8, over (d_b/2)²; bores, rims and rings take off or add what is inside."""
    disc = 7.85e-6 * math.pi / 4 * 100**2  # kg/mm
    assert body_mass(110.0, 90.0, 80.0, 0.0, 7850.0) == pytest.approx(disc * 100**2 / 8 / 40**2, rel=EXACT)
    plain = Gear(teeth=40, normal_module=2.0, face_width=20.0)
    bored = Gear(teeth=40, normal_module=2.0, face_width=20.0, body=Body(bore=30.0))
    webbed = Gear(teeth=40, normal_module=2.0, face_width=20.0, body=Body(bore=20.0, web_thickness=5.0, rim_thickness=6.0))
    middle = (84 + 75) / 2
    lighter = [mass_of(gear, 7850.0) / mass_of(plain, 7850.0) for gear in (bored, webbed)]
    assert lighter == pytest.approx([1 - (30 / middle) ** 4, 1 - (63 / middle) ** 4], rel=EXACT)
    ring = Gear(teeth=-70, normal_module=2.0, face_width=20.0, body=Body(rim_diameter=180.0))
    free = Gear(teeth=-70, normal_module=2.0, face_width=20.0)
    middle = (abs(ring.tip_diameter) + abs(ring.root_diameter)) / 2
    inertia = math.pi / 32 * 7.85e-6 * (180**4 - middle**4)
    assert mass_of(ring, 7850.0) == pytest.approx(inertia / (ring.base_diameter / 2) ** 2, rel=EXACT)
    assert math.isinf(mass_of(free, 7850.0))
    assert pair_mass(0.01, math.inf) == pytest.approx(0.01, rel=EXACT)


def test_method_c() -> None:
    """By hand: s = 8.33 * 25/100 * 1.6/sqrt(3.56); grade 6, 216.8 N/mm: 1 + (13.3/216.8 + .0087)(2.071 - .357 s) s."""
    s = 8.33 * 25 / 100 * 1.6 / math.sqrt(3.56)
    assert speed_measure(8.33, 25, 1.6) == pytest.approx(s, rel=EXACT)
    helical = 1 + (13.3 / 216.8 + 0.0087) * (2.071 - 0.357 * s) * s
    spur = 1 + (14.9 / 216.8 + 0.0193) * (2.071 - 0.357 * s) * s
    assert dynamic_factor_c(216.8, s, 1.4, 6) == pytest.approx(helical, rel=EXACT)
    assert dynamic_factor_c(216.8, s, 0.0, 6) == pytest.approx(spur, rel=EXACT)
    assert dynamic_factor_c(216.8, s, 0.25, 6) == pytest.approx(spur - 0.25 * (spur - helical), rel=EXACT)
    assert dynamic_factor_c(216.8, s, 1.4, 6, Edition.DIN_1987) == pytest.approx(1 + (13.3 / 216.8 + 0.0087) * s, rel=EXACT)
    assert dynamic_factor_c(40.0, 0.1, 0.0, 12) == dynamic_factor_c(100.0, 0.1, 0.0, 12)
    assert dynamic_factor_c(150.0, 0.1, 1.0, 3) == pytest.approx(1 + (1.9 / 150 + 0.0087) * 0.2, rel=EXACT)
    assert dynamic_factor_c(150.0, 6.0, 1.0, 3) == pytest.approx(1 + (1.9 / 150 + 0.0087) * 6.0, rel=EXACT)
    with pytest.raises(ParameterError, match="accuracy_grade = 2: must be"):
        dynamic_factor_c(216.8, s, 1.4, 2)


K_1 = {3: (2.1, 1.9), 4: (3.9, 3.5), 5: (7.5, 6.7), 6: (14.9, 13.3), 7: (26.8, 23.9), 8: (39.1, 34.8), 9: (52.8, 47.0)}
K_1 |= {10: (76.6, 68.2), 11: (102.6, 91.4), 12: (146.3, 130.3)}
"""ISO 6336-1:2006, table 4: K_1 of spur and helical gears by grades of accuracy."""


@pytest.mark.parametrize("grade", K_1)
def test_grades_of_method_c(grade: int) -> None:
    for overlap_ratio, k_1, k_2 in ((0.0, K_1[grade][0], 0.0193), (1.0, K_1[grade][1], 0.0087)):
        factor = dynamic_factor_c(250.0, 4.0, overlap_ratio, grade)
        assert factor == pytest.approx(1 + (k_1 / 250 + k_2) * 4.0, rel=EXACT)


def test_method_c_is_worse_with_speed_and_grade_and_better_with_load() -> None:
    measure, load = np.r_[np.linspace(0, 2.9, 300), np.linspace(3.01, 9, 50)], np.linspace(20, 900, 100)[:, None]
    grades = np.array([dynamic_factor_c(load, measure, 0.4, grade) for grade in range(3, 13)])
    assert (np.diff(grades, axis=0)[:, :, 1:] > 0).all()
    assert (np.diff(grades, axis=2) > 0).all()
    assert (np.diff(grades, axis=1) <= 0).all()
    edge = dynamic_factor_c(200.0, np.array([0.2, 0.2 + 1e-9]), 0.0, 8)
    assert edge[0] == pytest.approx(edge[1], rel=2e-4)  # 2 and 2.071 - 0.0714: the printed constants


def test_method_b_for_many_variants() -> None:
    """Each of many is what it is alone; continuous over the ranges; no deviation makes it smaller."""
    rng = np.random.default_rng(RNG_SEED)
    n = 400
    ratio, load, contact = rng.uniform(0.01, 2.5, n), rng.uniform(20, 900, n), rng.uniform(1.05, 4, n)
    effects = dict(zip(("pitch_effect", "profile_effect", "relief_effect"), rng.uniform(0, 1, (3, n)), strict=True))
    many = dynamic_factor_b(ratio, load, contact, **effects)
    for each in range(0, n, 40):
        alone: Any = dynamic_factor_b(
            float(ratio[each]), float(load[each]), float(contact[each]), **{key: float(v[each]) for key, v in effects.items()}
        )
        assert isinstance(alone, float)
        assert alone == many[each]
    worse = dynamic_factor_b(ratio, load, contact, **{**effects, "pitch_effect": effects["pitch_effect"] + 0.1})
    assert (worse > many).all()
    for knee in (1.15, 1.5):
        low, high = (dynamic_factor_b(np.full(n, knee + step), load, contact, **effects) for step in (-1e-9, 1e-9))
        assert high == pytest.approx(low, abs=1e-7)


# ---------------------------------------------------------------------- across the face


def test_printed_misalignments() -> None:
    """Two reports: f_ma = 20.51 µm of 14 and 15 (20.518, cut off there), 12.73 of 9 and 9; the floor there is 4.5."""
    assert manufacturing_misalignment(14.0, 15.0) == pytest.approx(20.518, abs=5e-4)
    assert manufacturing_misalignment(9.0, 9.0) == pytest.approx(12.73, abs=0.005)
    assert least_misalignment(300.0, 9.0) == 4.5
    assert least_misalignment(1000.0, 9.0) == 5.0


def test_shaft_deflection() -> None:
    """(57) with the pinion in the middle: 0.023 F_m/b (b/d_1)², in µm; off it, by hand; (58) has halves."""
    middle = shaft_deflection(400.0, 40.0, 50.0, shaft_term=0.0)
    assert middle == pytest.approx(0.023 * 400 * 0.64, rel=EXACT)
    assert shaft_term(0.48, 200.0, 20.0, 50.0, 40.0) == pytest.approx(0.48 * 200 * 20 / 50**2 * (50 / 40) ** 4, rel=EXACT)
    off = shaft_deflection(400.0, 40.0, 50.0, shaft_term=1.875)
    assert off == pytest.approx(0.023 * 400 * 2.875 * 0.64, rel=EXACT)
    opposite = shaft_deflection(400.0, 40.0, 50.0, shaft_term=-1.875)
    assert opposite == pytest.approx(0.023 * 400 * (1.175 + 0.3) * 0.64, rel=EXACT)
    halves = shaft_deflection(400.0, 20.0, 50.0, shaft_term=0.0, double_helical=True)
    assert halves == pytest.approx(0.046 * 400 * 1.5 * 0.16, rel=EXACT)


@pytest.mark.parametrize(
    ("place", "plain", "stiff"),
    [("a", 0.8, 0.48), ("b", -0.8, -0.48), ("c", 1.33, 1.33), ("d", -0.6, -0.36), ("e", -1.0, -0.6)],
)
def test_places_of_the_pinion(place: str, plain: float, stiff: float) -> None:
    """K' of figure 13; a pinion that is hardly thicker than its shaft stiffens nothing."""
    where = BearingArrangement(place)
    assert arrangement_factor(where, True, np.array([1.149, 1.15])).tolist() == [plain, stiff]
    assert arrangement_factor(where, False, 2.0) == plain


def test_helix_modifications_leave_less() -> None:
    """Table 8, in the order of the options, with f_sh = 10 and f_ma = 20 µm; (53) takes f_Hbeta5 off f_sh."""
    left = [initial_misalignment(10.0, 20.0, helix_factors(each, Edition.ISO_2006), 0.0) for each in HelixModification]
    assert left == pytest.approx([13.3 + 20, 13.3 + 10, 6.65 + 10, 1.33 + 20, 1.33 + 10, 9.31 + 14], rel=EXACT)
    none = helix_factors(HelixModification.NONE, Edition.ISO_2006)
    assert proven_misalignment(10.0, 20.0, none, 0.0) == pytest.approx(6.7, rel=EXACT)
    assert proven_misalignment(10.0, 13.0, none, 4.5) == 4.5
    din = [helix_factors(each, Edition.DIN_1987).compliance for each in HelixModification]
    assert din == [0.023, 0.012, 0.012, 0.023, 0.023, 0.016]


def test_printed_root_factor() -> None:
    """K_Hbeta 1.19, b 15 mm, h 2.25 mm: 1.16."""
    assert root_face_load_factor(1.19, 15 / 2.25) == pytest.approx(1.16, abs=0.005)


def test_face_load_of_many_variants() -> None:
    """As of each alone; it rises with the misalignment, falls with the load, and is continuous at 2; the root's is smaller."""
    off, load = np.linspace(0, 80, 161), np.linspace(30, 900, 60)[:, None]
    found = face_load_factor(off, 17.0, load)
    assert found[5, 70] == face_load_factor(float(off[70]), 17.0, float(load[5, 0]))
    assert (found[:, 0] == 1).all()
    assert (np.diff(found, axis=1) > 0).all()
    assert (np.diff(found[:, 1:], axis=0) < 0).all()
    low, high = face_load_factor(np.array([2 * 300 / 17 * (1 - 1e-9), 2 * 300 / 17 * (1 + 1e-9)]), 17.0, 300.0)
    assert low == pytest.approx(2, abs=1e-8) == pytest.approx(high, abs=1e-8)
    roots = root_face_load_factor(found, np.linspace(1, 20, 161))
    assert ((roots >= 1) & (roots <= found)).all()


def test_running_in_of_two_materials_is_the_mean_of_theirs() -> None:
    wear = FlankWear(PerGear(RunningIn.SURFACE_HARDENED, RunningIn.THROUGH_HARDENED), PerGear(None, 640.0))
    assert float(wear.beta(20.0, 3.0)) == pytest.approx((3.0 + 10.0) / 2, rel=EXACT)
    assert float(wear.alpha(20.0, 3.0)) == pytest.approx((1.5 + 5.0) / 2, rel=EXACT)
    many = running_in_beta(np.array([10.0, 90.0]), RunningIn.THROUGH_HARDENED, np.array([1.0, 20.0]), np.array([320.0, 640.0]))
    assert many.tolist() == [10.0, 20.0]


# ---------------------------------------------------------------------- between pairs of teeth


def test_transverse_factor_by_hand() -> None:
    """c_gamma 20, f - y = 7.4 µm, 500 N/mm: q = 0.296; the same from both formulas at eps_gamma = 2."""
    assert transverse_load_factor(1.6, 20.0, 8.0, 0.6, 500.0) == pytest.approx(0.8 * (0.9 + 0.4 * 0.296), rel=EXACT)
    above = 0.9 + 0.4 * math.sqrt(2 * 1.9 / 2.9) * 0.296
    assert transverse_load_factor(2.9, 20.0, 8.0, 0.6, 500.0) == pytest.approx(above, rel=EXACT)
    low, high = transverse_load_factor(np.array([2.0, 2.0 + 1e-10]), 20.0, 8.0, 0.6, 500.0)
    assert low == pytest.approx(high, rel=1e-9)


def test_limits_are_those_of_one_pair_that_carries_all() -> None:
    """A spur pair: K_Halpha Z_eps² = 1 and K_Falpha Y_eps = 1 at the limits, eps_gamma = eps_alpha = 1.6."""
    ratio_factor = math.sqrt((4 - 1.6) / 3)
    assert flank_limit(1.6, 1.6, ratio_factor) * ratio_factor**2 == pytest.approx(1, rel=EXACT)
    assert root_limit(1.6, 1.6) * (0.25 + 0.75 / 1.6) == pytest.approx(1, rel=EXACT)
    assert within(0.7, 1.25) == 1.0
    assert within(1.9, 1.25) == 1.25
    assert within(1.1, 0.98) == 1.0
    load = np.linspace(10, 1000, 200)
    factor = within(transverse_load_factor(1.6, 20.0, 12.0, 0.9, load), 1.25)
    assert (np.diff(factor) <= 0).all()
    assert factor[0] == 1.25
    assert factor[-1] == 1.0


# ---------------------------------------------------------------------- table 8 of ISO 6336-1


TABLE_8 = {
    HelixModification.NONE: (1.0, 1.0),
    HelixModification.CROWNING: (1.0, 0.5),
    HelixModification.FULL_CROWNING: (0.5, 0.5),
    HelixModification.HELIX_CORRECTION: (0.1, 1.0),
    HelixModification.CORRECTION_AND_CROWNING: (0.1, 0.5),
    HelixModification.END_RELIEF: (0.7, 0.7),
}
"""B_1 and B_2 of ISO 6336-1:2006, table 8, as printed."""


@pytest.mark.parametrize("modification", list(HelixModification))
def test_helix_modifications_leave_what_table_8_prints(modification: HelixModification) -> None:
    """F_beta_x = 1.33 B_1 f_sh + B_2 f_ma (52): each part alone shows its own factor."""
    factors = helix_factors(modification, Edition.ISO_2006)
    first, second = TABLE_8[modification]
    assert initial_misalignment(10.0, 0.0, factors, 0.0) == pytest.approx(13.3 * first, rel=EXACT)
    assert initial_misalignment(0.0, 10.0, factors, 0.0) == pytest.approx(10.0 * second, rel=EXACT)


DIN_HELIX = {
    HelixModification.NONE: (1.0, 1.0, 0.023),
    HelixModification.CROWNING: (1.0, 0.5, 0.012),
    HelixModification.FULL_CROWNING: (1.0, 0.5, 0.012),
    HelixModification.END_RELIEF: (1.0, 0.7, 0.016),
}
"""B_1, B_2 and the compliance (µm mm/N) of DIN 3990-1:1987, where a modification reduces the compliance, not B_1."""


@pytest.mark.parametrize("modification", list(DIN_HELIX))
def test_helix_modifications_of_din(modification: HelixModification) -> None:
    """With b = d_1 and B* = 1 between bearings alike far, f_sh is the compliance times F_m/b."""
    factors = helix_factors(modification, Edition.DIN_1987)
    first, second, compliance = DIN_HELIX[modification]
    deflection = shaft_deflection(100.0, 40.0, 40.0, shaft_term=0.0, compliance=factors.compliance)
    assert deflection == pytest.approx(100 * compliance, rel=EXACT)
    assert initial_misalignment(deflection, 0.0, factors, 0.0) == pytest.approx(133 * first * compliance, rel=EXACT)
    assert initial_misalignment(0.0, 10.0, factors, 0.0) == pytest.approx(10.0 * second, rel=EXACT)


@pytest.mark.parametrize(
    ("misalignment", "stiffness", "load", "width", "factor"),
    [
        (10.0, 17.0, 300.0, 0.5 + 300 / 170, 1 + 170 / 600),  # 1.2833: all of the width carries
        (10.0, 20.0, 100.0, 1.0, 2.0),  # the load ends just at the edge
        (40.0, 20.0, 100.0, 0.5, 4.0),  # half of the width carries a triangle
        (-40.0, 20.0, 100.0, 0.5, 4.0),  # at the other end
        (0.0, 17.0, 300.0, math.inf, 1.0),
    ],
)
def test_values_by_hand(misalignment: float, stiffness: float, load: float, width: float, factor: float) -> None:
    assert bearing_width(misalignment, stiffness, load) == pytest.approx(width, rel=1e-12)
    assert face_load_factor(misalignment, stiffness, load) == pytest.approx(factor, rel=1e-12)


@pytest.mark.parametrize("misalignment", [1.0, 7.0, 18.0, 35.0, 200.0])
def test_a_row_of_springs_has_that_factor(misalignment: float) -> None:
    """Springs of 16 N/(mm·µm) under flanks that stand off by up to F_beta: pressed together until they carry the load."""
    stiffness, mean = 16.0, 150.0
    stand_off = misalignment * (np.arange(20_000) + 0.5) / 20_000

    def carried(approach: float) -> np.ndarray:
        return stiffness * np.maximum(approach - stand_off, 0)

    approach = brentq(lambda value: carried(value).mean() - mean, 0, 1000, xtol=1e-12)
    assert face_load_factor(misalignment, stiffness, mean) == pytest.approx(stiffness * approach / mean, rel=1e-4)


def test_the_root_feels_less_of_it_the_narrower_the_tooth() -> None:
    """N_F at b/h = 8 is 64/73; below 3 it stays 9/13."""
    assert root_face_load_factor(1.5, 8.0) == pytest.approx(1.5 ** (64 / 73), rel=1e-12)
    assert face_load_exponent(3.0) == face_load_exponent(1.2) == pytest.approx(9 / 13, rel=1e-12)
    assert root_face_load_factor(1.0, 8.0) == 1.0


def test_the_narrower_tooth_for_its_height_counts() -> None:
    """Module 2: both teeth are 4.5 mm high; the pinion is the narrower one."""
    pair = GearPair(
        pinion=Gear(teeth=20, normal_module=2.0, face_width=18.0), wheel=Gear(teeth=40, normal_module=2.0, face_width=22.0)
    )
    assert width_to_height(pair) == pytest.approx(4.0, rel=1e-12)


@pytest.mark.parametrize(
    ("material", "misalignment", "speed", "limit", "expected"),
    [
        (RunningIn.SURFACE_HARDENED, 20.0, 3.0, None, 3.0),
        (RunningIn.SURFACE_HARDENED, 40.0, 30.0, None, 6.0),
        (RunningIn.SURFACE_HARDENED, 90.0, 30.0, None, 6.0),
        (RunningIn.CAST_IRON, 100.0, 5.0, None, 55.0),
        (RunningIn.CAST_IRON, 100.0, 10.0, None, 45.0),
        (RunningIn.CAST_IRON, 100.0, 10.1, None, 22.0),
        (RunningIn.THROUGH_HARDENED, 100.0, 5.0, 640.0, 50.0),
        (RunningIn.THROUGH_HARDENED, 100.0, 10.0, 640.0, 40.0),
        (RunningIn.THROUGH_HARDENED, 100.0, 10.1, 640.0, 20.0),
        (RunningIn.THROUGH_HARDENED, 10.0, 1.0, 300.0, 10.0),
    ],
)
def test_running_in(material: RunningIn, misalignment: float, speed: float, limit: float | None, expected: float) -> None:
    assert running_in_beta(misalignment, material, speed, limit) == pytest.approx(expected, rel=1e-12)


def test_through_hardened_flanks_need_their_limit() -> None:
    with pytest.raises(ParameterError, match="flank_limit = None: must be a number above 0 MPa"):
        running_in_beta(10.0, RunningIn.THROUGH_HARDENED, 1.0)

"""Tolerances of flanks and allowances of tooth thickness and centre distance: formulas by hand and tables."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad import Gear, GearPair, GeometryError, Load, Material, ParameterError, SpecError
from gearcad.core import symbols
from gearcad.designs import PairDesign
from gearcad.geometry.fits import centre_distance_allowance, limit_deviations, standard_tolerance, tooth_thickness_allowance
from gearcad.rating import iso1328_2013
from gearcad.rating.editions import mean_of_range
from gearcad.rating.strength import rate_strength
from gearcad.rating.tolerances import Accuracy, GearTolerances, flank_tolerances, gear_tolerances
from gearcad.report.strength import backlash_rows, tolerance_rows

DIN_3967 = [  # two public transcriptions
    ("cd27", 100, -70, -170),
    ("cd25", 40, -54, -84),
    ("cd25", -82, -70, -110),  # of a ring
    ("a25", 10, -100, -120),
    ("a25", 10.001, -135, -165),
    ("h21", 10_000, 0, -40),
]

DIN_3967_TABLE_1 = """
10: 100 85 70 58 48 40 33 22 10 5 0
50: 135 110 95 75 65 54 44 30 14 7 0
125: 180 150 125 105 85 70 60 40 19 9 0
280: 250 200 170 140 115 95 80 56 26 12 0
560: 330 280 230 190 155 130 110 75 35 17 0
1000: 450 370 310 260 210 175 145 100 48 22 0
1600: 600 500 420 340 290 240 200 135 64 30 0
2500: 820 680 560 460 390 320 270 180 85 41 0
4000: 1100 920 760 620 520 430 360 250 115 56 0
6300: 1500 1250 1020 840 700 580 480 330 155 75 0
10000: 2000 1650 1350 1150 940 780 640 450 210 100 0
"""
"""Up to a reference diameter: -A_sne of a, ab, b, bc, c, cd, d, e, f, g and h."""

DIN_3967_TABLE_2 = """
10: 3 5 8 12 20 30 50 80 130 200
50: 5 8 12 20 30 50 80 130 200 300
125: 6 10 16 25 40 60 100 160 250 400
280: 8 12 20 30 50 80 130 200 300 500
560: 10 16 25 40 60 100 160 250 400 600
1000: 12 20 30 50 80 130 200 300 500 800
1600: 16 25 40 60 100 160 250 400 600 1000
2500: 20 30 50 80 130 200 300 500 800 1300
4000: 25 40 60 100 160 250 400 600 1000 1600
6300: 30 50 80 130 200 300 500 800 1300 2000
10000: 40 60 100 160 250 400 600 1000 1600 2400
"""
"""Up to a reference diameter: T_sn of the series 21 to 30, each the next number of R 5 or R 10 after the one before."""

ISO_286 = [  # full public tables; 60 M6 is the worked example of ISO 286-1
    *[("H7", 40, 25, 0), ("g6", 40, -9, -25), ("f7", 40, -25, -50), ("k6", 40, 18, 2), ("n6", 40, 33, 17), ("p6", 40, 42, 26)],
    *[("h6", 40, 0, -16), ("H7", 25, 21, 0), ("g6", 25, -7, -20), ("H7", 10, 15, 0), ("g6", 6, -4, -12), ("H8", 6, 18, 0)],
    *[("H7", 100, 35, 0), ("K7", 20, 6, -15), ("F7", 90, 71, 36), ("M6", 60, -5, -24), ("N9", 3, -4, -29), ("N9", 14, 0, -43)],
    *[("js7", 600, 35, -35), ("j6", 40, 11, -5), ("r6", 100, 73, 51), ("P9", 14, -18, -61), ("M6", 300, -9, -41)],
]


@pytest.mark.parametrize(("name", "diameter", "upper", "lower"), DIN_3967)
def test_allowances_of_din_3967(name, diameter, upper, lower):
    assert tooth_thickness_allowance(name, diameter) == (upper, lower)


def test_tables_of_din_3967():
    """All of them, typed by diameters; the module has them by letters and series."""
    upper, widths = (
        [[float(number) for number in line.replace(":", "").split()] for line in table.strip().splitlines()]
        for table in (DIN_3967_TABLE_1, DIN_3967_TABLE_2)
    )
    for (most, *allowances), (_, *tolerances) in zip(upper, widths, strict=True):
        letters = "a ab b bc c cd d e f g h".split()
        found = [tooth_thickness_allowance(f"{letter}21", most) for letter in letters]
        assert [-each.upper for each in found] == allowances
        found = [tooth_thickness_allowance(f"h{series}", most) for series in range(21, 31)]
        assert [each.tolerance for each in found] == tolerances


@pytest.mark.parametrize(("tolerance_class", "size", "upper", "lower"), ISO_286)
def test_limit_deviations_of_iso_286(tolerance_class, size, upper, lower):
    assert limit_deviations(tolerance_class, size) == (upper, lower)


SHAFTS = """
3: 20 14 6 2 0 2 4 6
6: 30 20 10 4 1 4 8 12
10: 40 25 13 5 1 6 10 15
18: 50 32 16 6 1 7 12 18
30: 65 40 20 7 2 8 15 22
50: 80 50 25 9 2 9 17 26
80: 100 60 30 10 2 11 20 32
120: 120 72 36 12 3 13 23 37
180: 145 85 43 14 3 15 27 43
250: 170 100 50 15 4 17 31 50
315: 190 110 56 17 4 20 34 56
400: 210 125 62 18 4 21 37 62
500: 230 135 68 20 5 23 40 68
"""
"""ISO 286-1, fundamental deviations up to a size: below it for d, e, f and g, above it for k, m, n and p."""

TIGHT_SHAFTS = """
3: 10 14 18 | 6: 15 19 23 | 10: 19 23 28 | 18: 23 28 33 | 24: 28 35 41 | 30: 28 35 48 | 40: 34 43 60 | 50: 34 43 70
65: 41 53 87 | 80: 43 59 102 | 100: 51 71 124 | 120: 54 79 144 | 140: 63 92 170 | 160: 65 100 190 | 180: 68 108 210
200: 77 122 236 | 225: 80 130 258 | 250: 84 140 284 | 280: 94 158 315 | 315: 98 170 350 | 355: 108 190 390 | 400: 114 208 435
450: 126 232 490 | 500: 132 252 540
"""
"""The same of r, s and u."""


def test_tables_of_iso_286():
    """Typed by sizes; holes mirror the shafts, higher by the difference of two grades where these are fine."""
    rows = [list(map(int, row.replace(":", "").split())) for row in SHAFTS.strip().splitlines()]
    for size, *deviations in rows:
        for letter, deviation in zip("defgkmnp", deviations, strict=True):
            shaft, hole = limit_deviations(f"{letter}6", size), limit_deviations(f"{letter.upper()}7", size)
            if letter in "defg":
                assert (shaft.upper, hole.lower) == (-deviation, deviation)
                continue
            assert shaft.lower == deviation
            finer = standard_tolerance(7, size) - standard_tolerance(6, size) if size > 3 else 0
            assert hole.upper == finer - deviation
    for row in TIGHT_SHAFTS.replace("\n", "|").split("|"):
        if row.strip():
            size, *deviations = map(int, row.replace(":", "").split())
            assert [limit_deviations(f"{letter}6", size).lower for letter in "rsu"] == deviations


def test_m_is_the_difference_of_two_grades():
    """ISO 286-1: m begins IT7 - IT6 above the size, from 3 mm on."""
    for size in (6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500):
        assert limit_deviations("m6", size).lower == standard_tolerance(7, size) - standard_tolerance(6, size)


@pytest.mark.parametrize("wrong", ["J7", "hH7", "Js7", "j8", "h15", "x6", "7", "H", "", None])
def test_a_class_that_iso_286_has_not_or_that_is_not_tabled(wrong):
    with pytest.raises(ParameterError, match="must be a letter"):
        limit_deviations(wrong, 40)


@pytest.mark.parametrize(
    ("tolerance_class", "size"),
    [("g6", 500.1), ("H7", 0.0), ("H12", 500.1), ("js12", 500.1), ("h9", 3150.1), ("js7", 3150.1), ("H7", math.nan)],
)
def test_a_size_beyond_the_tables(tolerance_class, size):
    with pytest.raises(ParameterError, match="size = "):
        limit_deviations(tolerance_class, size)


def test_centre_distances():
    assert centre_distance_allowance("js7", 91.5) == 17.5 and centre_distance_allowance("js8", -120.0) == 27.0


def _gear(teeth, helix=0.0, **given):
    return Gear(teeth=teeth, normal_module=3.0, face_width=20.0, helix_angle=helix, **given)


def test_the_thinning_is_the_mean_of_the_allowance():
    """And follows it when another is asked for, or none."""
    gear = _gear(21, tooth_allowance="cd25")
    assert gear.tooth_thinning == 0.09
    assert replace(gear, tooth_allowance="e24", profile_shift=0.1).tooth_thinning == 0.0525
    assert replace(gear, tooth_allowance=None).tooth_thinning == 0.0
    assert replace(gear, tooth_allowance=None, tooth_thinning=0.09).inspection == gear.inspection
    assert eval(repr(gear)) == gear


def test_a_series_without_a_letter_is_the_tolerance_of_a_thinning():
    """The thinning stays what was given, and lies in the middle of the limits."""
    gear = _gear(21, tooth_thinning=0.06, tooth_allowance="25")
    assert (gear.tooth_thinning, gear.thickness_allowance) == (0.06, (-40.0, -80.0))
    same = _gear(21, tooth_allowance="e25")
    assert same.tooth_thinning == 0.06 and same.thickness_limits == gear.thickness_limits
    assert eval(repr(gear)) == gear


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"tooth_allowance": "CD 25"}, r'= \'CD 25\': must be a letter .* \(write "cd25"\)$'),
        ({"tooth_allowance": "cd31"}, 'such as "cd25"; or, beside tooth_thinning, "25"$'),
        ({"tooth_allowance": "25"}, 'must have a letter, as in "cd25", or tooth_thinning of at least 0.02 mm beside it'),
        ({"tooth_allowance": "25", "tooth_thinning": 0.019}, "tooth_thinning of at least 0.02 mm"),
        ({"tooth_allowance": "cd25", "tooth_thinning": 0.0}, r"must be left out where tooth_thinning is given \(0 mm\)"),
        ({"tooth_allowance": "cd25", "teeth": 2000, "normal_module": 6.0}, "DIN 3967 ends at a reference diameter of 10000 mm"),
        ({"tooth_allowance": "h30", "normal_module": 0.1}, "takes up to 0.2 mm off teeth that are 0.157079 mm thick"),
    ],
)
def test_an_allowance_that_cannot_be(given, message):
    with pytest.raises((ParameterError, GeometryError), match=message):
        Gear(**{"teeth": 21, "normal_module": 3.0, "face_width": 20.0} | given)


PAIRS = {
    "spur": ((21, 40), 0.0, None),
    "helical, far apart": ((21, 40), 15.0, 96.0),
    "ring": ((21, -70), 0.0, None),
}


@pytest.mark.parametrize("case", PAIRS)
def test_limits_are_those_of_the_gears_at_their_extremes(case):
    """Gauges and backlash between tolerances are what gears as thick, or thin, as permitted have at the outer distances."""
    (z1, z2), helix, distance = PAIRS[case]
    hands = (helix, helix if z2 < 0 else -helix)
    toleranced = [_gear(z, hand, tooth_allowance="cd26") for z, hand in zip((z1, z2), hands, strict=True)]
    given = {} if distance is None else {"centre_distance": distance}
    pair = GearPair(pinion=toleranced[0], wheel=toleranced[1], centre_distance_tolerance="js8", **given)
    limits, apart = pair.backlash_limits, pair.centre_distance_allowance / 1000

    def extremes(allowance):
        gears = [replace(each, tooth_allowance=None, tooth_thinning=allowance(each) / -1000) for each in toleranced]
        made = [GearPair(pinion=gears[0], wheel=gears[1], centre_distance=pair.centre_distance + s * apart) for s in (-1, 1)]
        return gears, [(each.circumferential_backlash, each.normal_backlash) for each in made]

    thick, least = extremes(lambda gear: gear.thickness_allowance.upper)
    thin, most = extremes(lambda gear: gear.thickness_allowance.lower)
    assert limits[1::2] == pytest.approx(min(least), abs=1e-12)
    assert limits[2::2] == pytest.approx(max(most), abs=1e-12)
    for gear, *pairs in zip(toleranced, thick, thin, strict=True):
        count, ball, found = gear.inspection.spanned, gear.ball_diameter, gear.thickness_limits
        spans = sorted(each.inspection.span_measurement(count) for each in pairs)
        assert found.span_measurement == pytest.approx(spans, abs=1e-12)
        over = [each.inspection.between_balls(ball) if gear.internal else each.inspection.over_balls(ball) for each in pairs]
        assert (found.between_balls or found.over_balls) == pytest.approx(sorted(over), abs=1e-12)
        # A_W = A_sn cos alpha_n (DIN 3967).
        change = (found.span_measurement.greatest - found.span_measurement.least) / math.cos(math.radians(20))
        assert change * 1000 == pytest.approx(gear.thickness_allowance.tolerance, rel=1e-9)


def test_backlash_by_the_formula_of_din_3967():
    """j_t = -(A_sn1 + A_sn2)/cos β ± 2 A_a tan α_wt holds to second order on gears without profile shift."""
    pair = GearPair(
        pinion=_gear(21, 15.0, tooth_allowance="cd25"),
        wheel=_gear(40, -15.0, tooth_allowance="cd25"),
        centre_distance_tolerance="js7",
    )
    thick, thin = (2 * each / 1000 / math.cos(math.radians(15)) for each in (70, 110))
    apart = 2 * 0.0175 * math.tan(math.radians(pair.working_transverse_pressure_angle))
    second_order = 0.02 * 0.0175  # (j_t A_a)/a and the change of tan α_wt, with room
    assert pair.backlash_limits.circumferential_least == pytest.approx(thick - apart, abs=second_order)
    assert pair.backlash_limits.circumferential_greatest == pytest.approx(thin + apart, abs=second_order)
    assert pair.to_dict()["backlash_limits"]["centre_distance_allowance"] == 17.5
    assert (
        "backlash_limits"
        not in replace(pair, pinion=_gear(21, 15.0), wheel=_gear(40, -15.0), centre_distance_tolerance=None).to_dict()
    )


def test_a_coarse_distance_for_fine_teeth_is_told():
    pair = GearPair(pinion=_gear(21, tooth_allowance="h21"), wheel=_gear(40), centre_distance_tolerance="js10")
    assert [notice.code for notice in pair.notices] == ["backlash-may-vanish"]
    with pytest.raises(ParameterError, match=r"'JS7': must be one of js5 to js11 .* \(write \"js7\"\)"):
        replace(pair, centre_distance_tolerance="JS7")
    far = {"pinion": replace(pair.pinion, teeth=1200, tooth_allowance=None), "wheel": _gear(1200)}
    with pytest.raises(GeometryError, match=r"ISO 286 has no tolerances above 3150 mm"):
        replace(pair, **far)


def test_what_a_spec_shares():
    """An allowance in [pair] is both gears', unless one has its own or a thinning."""

    def read(**tables):
        main = {"normal_module": 3.0, "face_width": 20.0, "tooth_allowance": "cd25"}
        given = {
            "pair": main | tables.get("pair", {}),
            "pinion": {"teeth": 21},
            "wheel": {"teeth": 40} | tables.get("wheel", {}),
        }
        return PairDesign.read(given, lambda key: "pair.toml", "pair").pair.gears.map(lambda gear: gear.tooth_thinning)

    assert tuple(read()) == (0.09, 0.09)
    assert tuple(read(wheel={"tooth_allowance": "e24"})) == (0.09, 0.0525)
    assert tuple(read(wheel={"tooth_thinning": 0.02})) == (0.09, 0.02)
    with pytest.raises(SpecError, match=r"pair.tooth_allowance = 'cd25': must be left out where tooth_thinning is given"):
        read(pair={"tooth_thinning": 0.02})


def test_a_rating_tells_the_limits_of_its_gears():
    """In its document and in the tables of its report, where lengths have the digits in which limits differ."""
    pair = GearPair(pinion=_gear(21, tooth_allowance="cd25"), wheel=_gear(40), centre_distance_tolerance="js7")
    rating = rate_strength(pair, Material(), Load(torque=100.0, speed=500.0))
    document = rating.to_dict()
    tolerances = document["tolerances"]
    assert tolerances["pinion"]["thickness_limits"] == pair.pinion.thickness_limits.to_dict()
    assert "thickness_limits" not in tolerances["wheel"] and tolerances["backlash_limits"] == pair.backlash_limits._asdict()
    rows = {row.words: row.values for row in tolerance_rows(document, rating.names)}
    assert rows["upper allowance of tooth thickness"] == ("-70", "–")
    assert rows["single pitch deviation"] == ("8.5", "8.5")
    spans = pair.pinion.thickness_limits.span_measurement
    assert rows["span measurement, least"] == (f"{spans.least:.4f}", "–")
    assert next(row.values for row in backlash_rows(document)) == ("17.5",)


OLD, NEW = Accuracy.ISO_1995, Accuracy.ISO_2013


def of(accuracy=OLD, grade=5, **sizes):
    given = {"teeth": 40, "reference_diameter": 120.0, "normal_module": 3.0, "face_width": 30.0, "helix_angle": 0.0}
    return GearTolerances(accuracy=accuracy, grade=grade, **given | sizes)


BY_HAND = {  # for d above 50 to 125, m above 2 to 3.5, b above 20 to 40 mm, means 79.06, 2.646, 28.28 mm: grades 5, 6, 7
    "f_pt": (6.0, 8.5, 12.0),
    "F_p": (19.0, 27.0, 38.0),
    "F_alpha": (8.0, 11.0, 16.0),
    "f_falpha": (6.0, 8.5, 12.0),
    "f_Halpha": (5.0, 7.0, 10.0),
    "F_beta": (8.5, 12.0, 17.0),
    "f_Hbeta": (6.0, 8.5, 12.0),
    "f_fbeta": (6.0, 8.5, 12.0),
    "F_r": (15.0, 21.0, 30.0),
}


def test_grades_of_1995():
    found = [of(grade=grade).to_dict() for grade in (5, 6, 7)]
    assert {symbol: tuple(each[symbol] for each in found) for symbol in BY_HAND} == BY_HAND


def test_radial_composite_deviations():
    """By hand for d above 50 to 125 and m above 2.5 to 4 mm, means 79.06 and 3.162 mm; and for small gears, 10 and 0.316 mm."""
    assert [of(grade=grade).radial_composite for grade in (5, 6, 7)] == [25.0, 36.0, 51.0]
    assert [of(grade=grade).radial_tooth_to_tooth for grade in (5, 6, 7)] == [10.0, 14.0, 20.0]
    assert of(reference_diameter=10.0, normal_module=0.4).radial_composite == 11.0
    # Beyond the tables a gear's own sizes count.
    assert of(reference_diameter=1600.0, normal_module=20.0).radial_composite == round(3.2 * 20 + 1.01 * 40 + 6.4)


def test_single_flank_composite_deviations_go_by_the_contact_ratio():
    """f_i'/K is 4.3 + 5.86 + 7.86 = 18.0 µm in grade 5; K is 0.4 from a total contact ratio of 4 on."""
    for grade, of_unit_factor in zip((5, 6, 7), (18.0, 25.0, 36.0), strict=True):
        # K = 0.2 (ε + 4)/ε is 1 at ε = 1.
        assert of(grade=grade).tooth_to_tooth(1.0) == of_unit_factor
    assert of(grade=9).tooth_to_tooth(4.0) == of(grade=9).tooth_to_tooth(6.0)
    assert of().to_dict(1.0)["F_i1"] == 37.0  # 18.9 + 18.0 before rounding
    assert "f_i1" not in of().to_dict()


def test_classes_of_2013():
    """Class 6 of m_n 3, z 40, b 30 in a public worked example: f_pT 8.94, rounded 9 µm."""
    assert of(NEW, 6).single_pitch == 9.0
    assert of(NEW, 8, teeth=32).sector_pitches == 4
    # Over a quarter of the teeth the tolerance is that of all of them.
    assert of(NEW, 8, teeth=8).sector_pitch == of(NEW, 8, teeth=8).cumulative_pitch
    found = of(NEW, 5).to_dict()
    assert found["F_alphaT"] == round(math.hypot(5.32, 6.65) * 2) / 2
    assert found["F_betaT"] == 9.5  # 9.6999, of 6.4647 and 7.2315
    assert found["F_rT"] == round(0.9 * (0.24 + 0.55 * 120**0.5 + 2.1 + 12))
    assert set(found) == {"accuracy", "grade", "not_covered", "verify", "unconfirmed", "F_rT"} | {
        f"{symbol}T" for symbol in ("f_p", "F_pk", "F_p", "f_Halpha", "f_falpha", "F_alpha", "f_Hbeta", "f_fbeta", "F_beta")
    }


@pytest.mark.parametrize("accuracy", Accuracy)
def test_arrays_and_numbers_have_one_truth(accuracy):
    """All tolerances of variants, at the limits of the ranges too, are those of each by itself, and grow with the grade."""
    drawn = np.random.default_rng(19)
    sizes = {
        "teeth": drawn.integers(5, 200, 40),
        "reference_diameter": np.r_[5.0, 20.0, 125.0, 10_000.0, drawn.uniform(5, 2000, 36)],
        "normal_module": np.r_[0.5, 2.0, 3.5, 70.0, drawn.uniform(0.5, 30, 36)],
        "face_width": np.r_[4.0, 10.0, 1000.0, 20.001, drawn.uniform(4, 300, 36)],
        "helix_angle": drawn.uniform(0, 45, 40),
    }
    many = of(accuracy, 8, **sizes).to_dict()
    coarser = of(accuracy, 9, **sizes).to_dict()
    each = [of(accuracy, 8, **{name: values[i].item() for name, values in sizes.items()}).to_dict() for i in range(40)]
    for symbol in [symbol for symbol in many if symbol[1] == "_"]:
        np.testing.assert_array_equal(many[symbol], [one[symbol] for one in each], err_msg=symbol)
        assert np.all(coarser[symbol] > many[symbol]), symbol


def test_what_a_standard_does_not_cover_is_said_and_never_a_number():
    narrow = of(face_width=3.0, grade=3)
    with pytest.raises(ParameterError, match=r"face_width = 3 mm: must be a number at least 4 mm and at most 1000 mm"):
        _ = narrow.helix_slope
    found = narrow.to_dict()
    assert found["F_beta"] is None and found["F_i2"] is None and found["f_pt"] == flank_tolerances(3, 120.0, 3.0).single_pitch
    assert [reason.split(" = ")[0] for reason in found["not_covered"]] == ["face_width", "accuracy_grade"]
    assert of(NEW, helix_angle=46.0).to_dict()["f_pT"] is None
    np.testing.assert_array_equal(np.isnan(of(face_width=np.array([3.0, 4.0, np.nan])).helix_slope), [True, False, True])
    np.testing.assert_array_equal(np.isnan(of(NEW, teeth=np.array([4, 5, 1001])).single_pitch), [True, False, True])
    with pytest.raises(ParameterError, match="accuracy_grade = 0: must be a whole number from 1 to 11"):
        of(NEW, 0)
    with pytest.raises(ParameterError, match="accuracy = 'ISO 1328-1:2013'"):
        _ = of(NEW).radial_composite
    with pytest.raises(ParameterError, match="total_contact_ratio = 0"):
        of().tooth_to_tooth(0.0)


def test_a_ring_has_the_tolerances_of_its_magnitudes():
    gear = Gear(teeth=70, normal_module=2.0, face_width=20.0, helix_angle=10.0)
    ring = replace(gear, teeth=-70)
    assert gear_tolerances(ring, 7).to_dict() == gear_tolerances(gear, 7).to_dict()


def test_every_tolerance_has_a_symbol():
    beside = {"accuracy", "grade", "verify", "unconfirmed", "not_covered"}
    assert {*of().to_dict(2.0), *of(NEW).to_dict()} - beside == set(symbols.TOLERANCES)


EXACT = 1e-12
"""Relative: a formula against its terms, added up by hand."""

CLASS_5 = {  # d = 10000, m_n = 10, b = 400 mm: square roots 100 and 20
    "single_pitch": 10 + 4 + 5,
    "cumulative_pitch": 20 + 55 + 7 + 12,
    "profile_slope": 4 + 10 + 4,
    "profile_form": 5.5 + 5,
    "profile_total": math.hypot(18, 10.5),
    "runout": 0.9 * 94,
    "helix_slope": 5 + 7 + 4,
    "helix_form": 7 + 9 + 4,
    "helix_total": math.hypot(16, 20),
}


@pytest.mark.parametrize("name", CLASS_5)
def test_terms_of_class_5_of_2013(name):
    """A gear so large that each term of a formula is more than the last digit: no constant hides behind rounding."""
    formula = getattr(iso1328_2013, name)
    size = 400.0 if name.startswith("helix") else 10.0
    assert formula(10000.0, size) == pytest.approx(CLASS_5[name], rel=EXACT)


def test_sector_pitch_of_class_5_of_2013():
    """Over a quarter of the teeth: f_pT + (0.001 d + 0.55 sqrt(d) + 0.3 m_n + 7) = F_pT."""
    assert iso1328_2013.sector_pitch(10000.0, 10.0, 10, 40) == pytest.approx(19 + 10 + 55 + 3 + 7, rel=EXACT)
    assert iso1328_2013.sector_pitch(10000.0, 10.0, 5, 40) == pytest.approx(19 + (10 + 55 + 3 + 7) / 2, rel=EXACT)


def test_ranges_end_with_their_upper_limit():
    """ISO 1328-1:1995 has "above 5 up to 20": the limit belongs to the range below it, and so does the greatest of all."""
    limits = (5.0, 20.0, 45.0, 80.0)
    means = {5.5: 10.0, 20.0: 10.0, 20.01: 30.0, 45.0: 30.0, 45.01: 60.0, 80.0: 60.0, 80.01: 80.01, 200.0: 200.0}
    for value, mean in means.items():
        assert mean_of_range(value, limits) == pytest.approx(mean, rel=EXACT), value
    assert mean_of_range(np.array(list(means)), limits) == pytest.approx(list(means.values()), rel=EXACT)


@pytest.mark.parametrize(("teeth", "diameter", "printed"), [(36, 756.0, 36.0), (95, 285.0, 43.0), (-93, 279.0, 54.0)])
def test_sector_pitches_of_1995_are_whole_ones(teeth, diameter, printed):
    """F_pk goes up to k = z/8, cut off: 4 of 36 teeth, 11 of 95 and of 93; the edition of 2013 takes the nearest."""
    whole = {36: 4, 95: 11, -93: 11}[teeth]
    assert of(teeth=abs(teeth), reference_diameter=diameter).sector_pitches == whole
    assert of(NEW, teeth=abs(teeth), reference_diameter=diameter).sector_pitches == {36: 5, 95: 12, -93: 12}[teeth]

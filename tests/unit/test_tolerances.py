"""Tolerances of flanks: formulas worked out by hand, numbers and arrays by the same formulas, sizes beyond the standards."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad import Gear, ParameterError
from gearcad.core import symbols
from gearcad.rating import iso1328_2013
from gearcad.rating.editions import mean_of_range
from gearcad.rating.tolerances import Accuracy, GearTolerances, flank_tolerances, gear_tolerances

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

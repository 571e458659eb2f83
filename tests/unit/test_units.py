"""Units of what is shown and typed: sizes against handbooks, and values that return without drift."""

import random

import pytest

from gearcad.core.units import ShownUnit, UnitSystem, measures_in, shown_unit

ROUND_TRIPS = 1000

SEVEN_DIGITS = 5e-7
"""Rounding of the factors of the source, relative."""


def _inch(unit: str, key: str = "") -> ShownUnit:
    found = shown_unit(UnitSystem.INCH, unit, key)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("unit", "name", "size"),
    [
        ("mm", "in", 25.4),
        ("µm", "µin", 0.0254),
        ("N", "lbf", 4.448222),
        ("N·m", "lbf·in", 0.1129848),
        ("MPa", "ksi", 6.894757),
        ("N/mm", "lbf/in", 0.1751268),
        ("N/µm", "lbf/µin", 175.1268),
        ("N/(mm·µm)", "lbf/(in·µin)", 6.894757),
        ("m/s", "ft/s", 0.3048),
        ("kg", "lb", 0.4535924),
        ("kg/m³", "lb/in³", 27679.90),
        ("kg·m²", "lb·in²", 2.926397e-4),
        ("N·m/rad", "lbf·in/rad", 0.1129848),
        ("N·s/m", "lbf·s/in", 175.1268),
    ],
)
def test_sizes_are_those_of_nist_sp_811(unit: str, name: str, size: float) -> None:
    """NIST Special Publication 811 (2008), Appendix B.8: factors to seven digits, and what is made of them."""
    found = _inch(unit)
    assert found.name == name
    assert float(found.size) == pytest.approx(size, rel=SEVEN_DIGITS)


@pytest.mark.parametrize("unit", ["", "deg", "rpm", "1/inch", "°C", "mm²/s", "Hz", "h", "kg/µm"])
def test_units_without_others_stay(unit: str) -> None:
    assert shown_unit(UnitSystem.INCH, unit) is None


def test_metric_units_and_modules_stay() -> None:
    assert shown_unit(UnitSystem.METRIC, "mm") is None
    assert shown_unit(UnitSystem.INCH, "mm", "pair.normal_module") is None
    assert shown_unit(UnitSystem.INCH, "mm", "gear.transverse_module") is None


def test_what_is_typed_in_inches_is_exact_in_mm() -> None:
    inch = _inch("mm")
    assert [inch.stored(typed) for typed in ("1", "0.5", "3.937", "-2,75", "1e-3", "0")] == [
        *("25.4", "12.7", "99.9998", "-69.85", "0.0254", "0"),
    ]


def test_what_is_typed_is_shown_as_it_was_typed() -> None:
    inch, draw = _inch("mm"), random.Random(1)
    for _ in range(ROUND_TRIPS):
        typed = f"{draw.uniform(-50, 50):.{draw.randint(1, 11)}g}"
        plain = repr(float(typed)).removesuffix(".0")
        assert inch.shown(inch.stored(typed)) == plain


@pytest.mark.parametrize("unit", ["mm", "µm", "N·m", "MPa", "kg/m³"])
def test_a_value_in_the_units_of_specs_keeps_its_text_however_often_it_is_shown_and_typed(unit: str) -> None:
    other, draw = _inch(unit), random.Random(2)
    for _ in range(50):
        text = first = repr(draw.uniform(0, 1000) if draw.random() < 0.5 else round(draw.uniform(0, 1000), 2))
        for _ in range(ROUND_TRIPS // 50):
            text = other.stored(other.shown(text), (text,))
        assert text == first
    text = "97.30000000000001"
    for _ in range(ROUND_TRIPS):
        text = other.stored(other.shown(text), ("", text))
    assert text == "97.30000000000001"


def test_a_typed_value_stays_the_same_number_without_what_it_was() -> None:
    inch = _inch("mm")
    first = text = inch.stored("3.14159265")
    for _ in range(ROUND_TRIPS):
        text = inch.stored(inch.shown(text))
    assert float(text) == float(first) == pytest.approx(79.79645331, abs=1e-8)


def test_words_lists_and_half_typed_numbers() -> None:
    inch = _inch("mm")
    assert inch.shown("auto") == inch.stored("auto") == "auto"
    assert inch.shown("N 30 x 1.25 x 22 x 9H") == inch.stored("N 30 x 1.25 x 22 x 9H") == "N 30 x 1.25 x 22 x 9H"
    assert inch.shown("25.4 50.8") == "1 2"
    assert inch.stored("1 2") == "25.4 50.8"
    assert inch.stored("1.234,5") == "1.234,5"
    assert (inch.stored(""), inch.stored("-"), inch.stored("1e999999")) == ("", "-", "1e999999")
    assert inch.shown("100") == "3.937008"


@pytest.mark.parametrize(
    ("metric", "inches"),
    [
        (
            "face_width = -25.4 mm: must be a number above 0 mm and at most 10000 mm",
            "face_width = -1 in: must be a number above 0 in and at most 393.701 in",
        ),
        ("must be from 6 to 500 mm for a keyway", "must be from 0.2362 to 19.69 in for a keyway"),
        ("must be above 12.3 and at most 15.0359 mm, the tip", "must be above 0.4843 and at most 0.5919646 in, the tip"),
        ("tension 430 MPa at 200 N·m, 1450 rpm", "tension 62.37 ksi at 1770 lbf·in, 1450 rpm"),
        ("a gap of ±12 µm, −2.54 mm", "a gap of ±472.4 µin, −0.1 in"),
        (
            "tooth_stiffness = 14.2 N/µm of one pair, 3 N/(mm·µm)",
            "tooth_stiffness = 0.08108 lbf/µin of one pair, 0.4351 lbf/(in·µin)",
        ),
        (
            "normal_module = 99 mm: must be at most 20 mm; the tip is at 12.7 mm",
            "normal_module = 99 mm: must be at most 20 mm; the tip is at 0.5 in",
        ),
        ("22 teeth of module 1.25 mm on 30.48 mm", "22 teeth of module 1.25 mm on 1.2 in"),
        ("its backlash is 0.254 mm, 0.08 normal modules", "its backlash is 0.01 in, 0.08 normal modules"),
        ("face_width = '12 mm': must be a number", "face_width = '12 mm': must be a number"),
        ("spec.toml line 12, column 3: 5 mm/s, N 30 x 1.25", "spec.toml line 12, column 3: 5 mm/s, N 30 x 1.25"),
    ],
)
def test_messages_have_their_numbers_in_inches(metric: str, inches: str) -> None:
    """By hand from NIST SP 811: 1 in = 25.4 mm, 1 ksi = 6.894757 MPa, 1 lbf·in = 0.1129848 N·m."""
    assert measures_in(UnitSystem.METRIC, metric) == metric
    assert measures_in(UnitSystem.INCH, metric) == inches


def test_messages_in_inches_have_a_decimal_comma_where_the_page_has() -> None:
    assert measures_in(UnitSystem.INCH, "über 12,7 und höchstens 25.4 mm", comma=True) == "über 0,5 und höchstens 1 in"

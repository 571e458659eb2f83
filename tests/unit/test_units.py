"""Units of what is shown and typed: sizes against handbooks, and values that return without drift."""

import random

import pytest

from gearcad.core.units import ShownUnit, UnitSystem, shown_unit

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

"""What a table of results has of a check: verdicts, deviations, errors and safeties, each with a symbol."""

import pytest
from support.checks import small_check, small_solid_check

from gearcad.batch.row import flat_document
from gearcad.check.columns import check_columns
from gearcad.check.comparison import Subject
from gearcad.check.result import check_document
from gearcad.core import symbols
from gearcad.core.records import Role, Verdict
from gearcad.designs.variations import column_symbol
from gearcad.rating.strength import RatedPart


def test_columns_are_what_the_report_judges() -> None:
    result = small_check()
    document = check_document(result)
    columns = dict(flat_document({"check": check_columns(document)}))
    compared = {each.quantity: each for each in result.comparisons}
    peak, width = compared["peak contact pressure"], compared["half width of contact"]
    assert peak.deviation is not None and width.deviation is not None
    assert columns["check.hertz_pressure_deviation"] == pytest.approx(100 * peak.deviation, rel=1e-12)
    assert columns["check.hertz_half_width_deviation"] == pytest.approx(100 * width.deviation, rel=1e-12)
    for quantity, column in (
        ("sampling error of the root stresses", "sampling_error_root_tension"),
        ("sampling error of the contact pressure", "sampling_error_contact_pressure"),
    ):
        assert columns[f"check.{column}"] == compared[quantity].computed
    for part, both in result.safeties.parts.items():
        for role in Role:
            found = both.pick(role)
            assert columns[f"check.S_{part.index}_fe.{role.value}"] == found.safety
            assert columns[f"check.S_{part.index}.{role.value}"] == found.rated.safety
        assert columns[f"check.S_{part.index}_required"] == both.pinion.rated.required
    assert [heading for heading in columns if column_symbol(heading) is None] == []


def test_every_comparison_of_solid_bodies_but_strength_has_a_column_with_a_symbol() -> None:
    result = small_solid_check()
    columns = dict(flat_document({"check": check_columns(check_document(result))}))
    compared = [
        each
        for each in result.comparisons
        if each.subject is not Subject.STRENGTH and "over rim" not in each.quantity  # of the model, in gates_failed
    ]
    told = [
        heading for heading in columns if "_deviation" in heading or ("_error_" in heading and "transmission" not in heading)
    ]
    assert len(told) == len(compared) > 10
    assert columns["check.face_load_factor_deviation"] == pytest.approx(
        100 * next(each.deviation for each in compared if each.quantity == "face load factor K_Hbeta"), rel=1e-12
    )
    assert [heading for heading in columns if column_symbol(heading) is None] == []


def test_root_stress_against_a_limit_is_not_that_against_the_standard() -> None:
    document = check_document(small_check())
    strength = {"quantity": "root stress, pinion", "subject": "strength", "deviation": 9.0, "role": "gate", "passed": False}
    columns = check_columns(document | {"comparisons": [*document["comparisons"], strength]})
    assert columns["root_stress_deviation_pinion"] == check_columns(document)["root_stress_deviation_pinion"]
    assert "root stress, pinion" in columns["gates_failed"]


@pytest.mark.parametrize(
    ("strength", "below", "safety", "verdict"),
    [
        ("not asked for", ["S_H of the pinion"], 0.5, "not asked for"),
        ("passed", ["S_H of the pinion"], 0.5, "failed"),
        ("passed", [], None, "not judged"),
        ("failed", [], 1.5, "passed"),
    ],
)
def test_verdict_of_safeties_by_finite_elements(strength: str, below: list[str], safety: float | None, verdict: str) -> None:
    gears = {role.value: {"fe_safety": safety, "rated_safety": 1.0, "required": 1.0} for role in Role}
    safeties = {part.value: gears for part in RatedPart} | {"below_required": below}
    document = check_document(small_check()) | {"strength": strength, "safeties": safeties}
    assert check_columns(document)["strength_fe"] == Verdict(verdict).value


def test_every_column_has_words_of_its_own() -> None:
    words = [symbol.words for symbol in (symbols.CHECK | symbols.CHECK_COLUMNS).values()]
    assert len(set(words)) == len(words)

"""Gates and references of a check: one that cannot be evaluated is not passed and says why; figures that are absent."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import lxml.html
import numpy as np
import pytest
from support.checks import coarse_model, small_check, small_solid_check

from gearcad import Load, Material, Mounting
from gearcad.check.comparison import Comparison, ComparisonRole, Subject, agrees, at_most, beside, verdict
from gearcad.check.convergence import sweep_point
from gearcad.check.gates import compare_common, compare_plane, compare_solid, standards
from gearcad.check.notices import common_notices
from gearcad.check.options import CheckOptions
from gearcad.check.result import CheckResult, PlaneCheck, SolidCheck, check_document
from gearcad.check.summary import PlaneSummary, SolidSummary, Summary, summarise_plane, summarise_solid
from gearcad.check.task import CheckTask, face_factors
from gearcad.cli.strength import print_verdict
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.output import json_text
from gearcad.core.records import NOT_ASKED_WORDS, Notice, PerGear, Verdict
from gearcad.report import report_html
from gearcad.report.check import CheckSections


def gate(computed: float | None, subject: Subject = Subject.NUMERICS, reason: str = "") -> Comparison:
    return at_most("stress", computed, 100.0, "MPa", "limit", subject=subject, reason=reason)


@pytest.mark.parametrize("computed", [None, math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("against", [agrees, beside])
def test_what_is_no_number_is_never_passed(computed: float | None, against: Callable[..., Comparison]) -> None:
    for each in (
        gate(computed),
        against("pressure", computed, 5.0, 1.0, "MPa", "Hertz"),
        against("pressure", 5.0, computed, 1.0, "MPa", "Hertz"),
        against("pressure", 5.0, 0.0, 1.0, "MPa", "Hertz"),
    ):
        document = each.to_dict()
        assert (each.passed, each.evaluated, document["passed"], document["evaluated"]) == (False,) * 4
        assert document["deviation"] is None
        assert "not a finite number" in document["reason"]
        json_text(document)  # strict: no NaN, no Infinity
    assert gate(None, reason="nothing touches").reason == "nothing touches"


def test_gates_are_passed_up_to_their_bounds() -> None:
    assert gate(100.0).passed and not gate(math.nextafter(100.0, 200.0)).passed
    assert agrees("pressure", 101.0, 100.0, 0.0101, "MPa", "Hertz").passed
    assert not agrees("pressure", 98.9, 100.0, 0.01, "MPa", "Hertz").passed
    assert gate(100.0).reason == ""


def test_verdicts_keep_numerics_and_strength_apart() -> None:
    good, bad = gate(1.0), gate(None, Subject.STRENGTH)
    outside = beside("root stress", 9.0, 1.0, 0.1, "MPa", "ISO 6336")
    assert verdict([good, bad, outside], Subject.NUMERICS) is Verdict.PASSED
    assert verdict([good, bad, outside], Subject.STRENGTH) is Verdict.FAILED
    assert verdict([good, outside], Subject.STRENGTH) is Verdict.NOT_JUDGED
    assert verdict([good, outside], Subject.STANDARD) is Verdict.NOT_JUDGED  # information decides nothing


_LACKING = "; ".join(f"sigma_{part}lim is not known: the material has no group, and no limit is given" for part in "HF")
"""Local limits replace no endurance limit."""

_ENDED = "linear elasticity is exceeded, see the warnings"
"""Of a load whose root stress is above a yield strength of 1 MPa."""


@pytest.mark.parametrize(
    ("gates", "material", "said", "passed"),
    [
        ([gate(1.0)], Material(), f"numerics passed; strength {NOT_ASKED_WORDS}", True),
        (
            [gate(1.0), gate(1.0, Subject.STRENGTH)],
            Material(root_limit=1.0),
            f"numerics passed; strength not judged: {_LACKING}",
            False,
        ),
        (
            [gate(999.0), gate(999.0, Subject.STRENGTH)],
            Material(contact_limit=1.0, root_limit=1.0, yield_strength=1.0),
            f"numerics NOT passed; {_ENDED}; strength failed",
            False,
        ),
        (
            [gate(None), gate(1.0, Subject.STRENGTH)],
            Material(contact_limit=1.0, root_limit=1.0, yield_strength=1.0),
            f"numerics NOT passed; {_ENDED}; strength not judged: {_LACKING}",
            False,
        ),
    ],
)
def test_one_line_tells_what_was_judged(gates: list[Comparison], material: Material, said: str, passed: bool) -> None:
    result = replace(small_check(), comparisons=tuple(gates), task=replace(small_check().task, material=material))
    assert (result.verdict, result.passed) == (said, passed)


def test_the_screen_keeps_columns_apart_and_tells_the_use_of_limits(capsys: pytest.CaptureFixture[str]) -> None:
    result = replace(small_check(), task=replace(small_check().task, load=Load(torque=30200.0)))
    huge = beside("root stress, wheel", -2.0594e5, 4.0592e14, 0.25, "MPa", "ISO 6336")
    silent = agrees("peak contact pressure", None, None, 0.01, "MPa", "Hertz", reason="no contact is inside")
    changed = replace(result, comparisons=(gate(87.25), silent, huge), notices=(Notice("thin-rim", "the rim is thin"),))
    print_verdict("pair", changed)
    lines = capsys.readouterr().out.splitlines()
    rows = [line.split(maxsplit=1) for line in lines[:4]]
    assert [row[0] for row in rows] == ["quantity", "ok", "FAILED", "OUTSIDE"]
    starts = [lines[0].index(word) + len(word) for word in ("computed", "reference", "deviation", "permitted")]
    for line, cells in zip(
        lines[1:4],
        (("87.25", "100", "87.25 %", "of limit"), ("-", "-", "-", "±1 %"), ("-2.0594e+05", "4.0592e+14", "-100.00 %", "±25 %")),
        strict=True,
    ):
        for end, cell in zip(starts, cells, strict=True):
            assert line[:end].endswith("  " + cell)
    text = "\n".join(lines)
    assert "in band, OUTSIDE: information" in text
    assert "Not evaluated: peak contact pressure: no contact is inside" in text
    # The check's own warnings, and the rating's.
    assert "Warning: the rim is thin" in text
    assert result.rating.warnings
    assert all(f"Warning: rating: {warning}" in text for warning in result.rating.warnings)
    assert lines[-1].startswith("pair at 30200 N·m: numerics NOT passed; strength not judged: sigma_Hlim is not known")


def test_limits_of_each_gear_are_judged() -> None:
    small = small_check()
    own = PerGear(Material(contact_limit=900.0, root_limit=500.0), Material(contact_limit=300.0))
    task = replace(small.task, material=own)
    every = tuple(compare_common(task, small.cycle, small.summary, (), equilibrium="", errors=()))
    found = {each.quantity: each.reference for each in every if each.subject is Subject.STRENGTH}
    assert found == {"contact pressure, pinion": 900.0, "contact pressure, wheel": 300.0, "root stress, pinion": 500.0}
    result = replace(small, task=task, comparisons=every)
    of_stress = [f"von Mises stress below the flank of the {gear}" for gear in ("pinion", "wheel")]
    assert result.without_limit == ("root stress of the wheel", *of_stress)
    assert result.verdict.endswith(f"not judged, no limit given: {', '.join(result.without_limit)}")


_UNEVEN = 0.05
"""How uneven exact flanks of aligned spur gears carry along the face, away from its ends; 46 % against the mean length."""


def test_references_of_stiffness_are_those_of_the_load() -> None:
    """15.12 N·m are 30 N/mm: ISO 6336-1 (90) leaves 0.3^0.25 of the stiffness that 302 N·m have."""
    heavy, light = (replace(small_check().task, load=Load(torque=torque)) for torque in (302.0, 15.12))
    assert light.rating.specific_load == pytest.approx(30.0)
    found = [{each.quantity: each.reference for each in standards(task, small_check().summary)} for task in (heavy, light)]
    for quantity in ("mean mesh stiffness", "single stiffness"):
        assert found[1][quantity] / found[0][quantity] == pytest.approx(0.3**0.25, rel=1e-9)


def test_misalignment_meets_the_stiffness_of_the_load() -> None:
    """K_H_beta - 1 goes with c_gamma_beta over the load: with the power -3/4 of a load below 100 N/mm."""
    task = small_solid_check().task
    width, radius = task.pair.common_width.width, task.pair.pinion.reference_diameter / 2000
    factors = [face_factors(replace(task, load=Load(torque=load * width * radius))).flank for load in (95.0, 90.0)]
    assert all(factor < 2 for factor in factors)
    assert (factors[1] - 1) / (factors[0] - 1) == pytest.approx((90 / 95) ** -0.75, rel=1e-9)


def test_the_greatest_line_load_is_held_against_the_shortest_lines() -> None:
    """Spur gears carry all of the load on one line of the common width: what is above that is unevenness along it alone."""
    model, load = coarse_model("FZG C"), Load(torque=302.0)
    task = CheckTask(pair=model.pair, material=Material(), load=load, mounting=Mounting(), options=CheckOptions(model="3d"))
    cycle = SolidCycle.run(model, load.torque, 12)
    found = {each.quantity: each for each in compare_solid(task, cycle, summarise_solid(cycle, 12.0), ())}
    line = found["greatest line load"]
    assert line.reference == pytest.approx(302e3 / (model.pair.pinion.base_diameter / 2) / 14.0, rel=1e-9)
    assert line.passed and 0 < line.deviation < _UNEVEN


LIMITS = Material(name="tin", contact_limit=1e6, root_limit=1e6, yield_strength=1e6)
"""Limits that no stress here exceeds: a figure that is not there is not below them."""


@cache
def overloaded_plane() -> PlaneCheck:
    """FZG C at 3e5 N·m: contacts are wider than the flanks."""
    result, load = small_check(), Load(torque=3e5)
    cycle = PlaneCycle.run(result.cycle.model, load.torque, 12)
    summary, sweep = summarise_plane(cycle, 12.0), (sweep_point(cycle), sweep_point(PlaneCycle.run(result.cycle.model, 3e4, 4)))
    task = replace(result.task, load=load, material=LIMITS)
    changed = replace(result, task=task, cycle=cycle, summary=summary, sweep=sweep)
    return replace(changed, comparisons=compare_plane(task, cycle, summary, result.convergence))


@cache
def overloaded_solid() -> SolidCheck:
    """A narrow helical pair at 1e4 N·m: half widths of 4 mm, on teeth 4.5 mm deep."""
    result, load = small_solid_check(), Load(torque=1e4)
    cycle = SolidCycle.run(coarse_model("helical"), load.torque, 6)
    summary, sweep = summarise_solid(cycle, 12.0), (sweep_point(cycle), *result.sweep)
    task = replace(result.task, load=load, material=LIMITS)
    changed = replace(result, task=task, cycle=cycle, summary=summary, sweep=sweep)
    return replace(changed, comparisons=compare_solid(task, cycle, summary, result.convergence))


def nulls(result: CheckResult) -> set[str]:
    """Figures without a value, but for those of bores, which are kept round here."""
    summary = check_document(result)["summary"]
    return {name for name, value in summary.items() if value is None and not name.startswith("bore")}


PRESSURES = {"contact_pressure", "contact_pressure_pitch_point", "half_width_pitch_point", "von_mises", "von_mises_depth"}


def test_a_pressure_that_no_contact_has_is_absent() -> None:
    assert nulls(overloaded_plane()) == PRESSURES | {"von_mises_half_plane"}
    places = {"contact_pressure_across", "contact_pressure_radius_pinion", "contact_pressure_radius_wheel", "line_load_max"}
    assert nulls(overloaded_solid()) == PRESSURES | places
    for result in (overloaded_plane(), overloaded_solid()):
        document = check_document(result)
        assert document["extremes"]["contact_pressure"] is None
        assert document["torque_sweep"][0]["contact_pressure"] is None
        assert "half widths" in document["not_evaluated"]["contact_pressure"]
        json_text(document)  # strict: no NaN, no Infinity
    assert check_document(small_check())["not_evaluated"] == {} == check_document(small_solid_check())["not_evaluated"]


@pytest.mark.parametrize("overloaded", [overloaded_plane, overloaded_solid])
def test_gates_without_a_figure_fail_and_say_why(overloaded: object) -> None:
    result: CheckResult = overloaded()  # type: ignore[operator]
    silent = {each.quantity: each for each in result.comparisons if each.role is ComparisonRole.GATE and not each.evaluated}
    wanted = {"sampling error of the contact pressure", "contact pressure", "von Mises stress below the flank"}
    wanted |= {"peak contact pressure", "half width of contact"} if isinstance(result, PlaneCheck) else set()
    assert set(silent) == wanted
    assert all("half widths" in each.reason and not each.passed for each in silent.values())
    assert (result.numerics, result.strength, result.passed) == (Verdict.FAILED, Verdict.FAILED, False)
    # Both root stresses are there, and below their limit.
    assert all(
        each.passed
        for each in result.comparisons
        if each.quantity.startswith("root stress") and each.role is ComparisonRole.GATE
    )
    warnings = list(map(str, common_notices(result.task, result.cycle, result.summary)))
    assert any("the root stress is" in text and "linear elasticity means little" in text for text in warnings)


@pytest.mark.parametrize("overloaded", [overloaded_plane, pytest.param(overloaded_solid, marks=pytest.mark.long)])
def test_the_report_says_what_is_not_there(overloaded: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CheckSections, "stiffness", "none here")
    result: CheckResult = overloaded()  # type: ignore[operator]
    text = lxml.html.document_fromstring(report_html(result, "absurd")).text_content()
    assert "peak contact pressure: not evaluated: at none of" in text or isinstance(result, SolidCheck)
    assert "contact pressure: not evaluated: at none of" in text
    assert "None" not in text and "nan" not in text.split()


def summary_of(model: str, count: int) -> Summary:
    """That of a mesh cycle of very few positions."""
    if model == "2d":
        return summarise_plane(PlaneCycle.run(small_check().cycle.model, 302.0, count), 12.0)
    return summarise_solid(SolidCycle.run(coarse_model("FZG C"), 302.0, count), 12.0)


@pytest.mark.parametrize("model", ["2d", "3d"])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_very_few_positions_tell_what_they_have_and_not_how_exact_it_is(model: str, count: int) -> None:
    summary = summary_of(model, count)
    assert isinstance(summary, PlaneSummary | SolidSummary)
    assert math.isinf(summary.sampling_error["root_tension_pinion"])
    assert summary.root_tension.pinion > 0 and summary.contact_pressure is not None
    if isinstance(summary, SolidSummary):
        assert len(summary.transmission_error_harmonics) == (count - 1) // 2


def test_a_tooth_that_stands_back_does_not_touch_at_the_pitch_point() -> None:
    """Then its neighbours carry; there is no pressure to tell, and its share of the load is none."""
    model = small_check().cycle.model
    back = replace(model, line=replace(model.line, proud=-2.0))
    summary = summarise_plane(PlaneCycle.run(back, 30.0, 4), 12.0)
    assert (summary.contact_pressure_pitch_point, summary.half_width_pitch_point) == (None, None)
    assert summary.share_pitch_point == 0.0
    assert "does not touch" in summary.missing["contact_pressure_pitch_point"]


def test_a_width_that_pressures_do_not_have_fails_its_gate(monkeypatch: pytest.MonkeyPatch) -> None:
    result = small_check()
    contact = next(contact for _, contact in result.cycle.interior_contacts)
    hollow = np.linspace(-1, 1, len(contact.pressures)) ** 2 + 1
    for pressures in (np.where(hollow == hollow[3], 1.0, 0.0), hollow):
        assert math.isnan(replace(contact, pressures=pressures).half_width)
    monkeypatch.setattr(PlanePairContact, "half_width", property(lambda _contact: math.nan))
    found = {each.quantity: each for each in compare_plane(result.task, result.cycle, result.summary, ())}
    assert found["peak contact pressure"].passed
    silent = found["half width of contact"]
    assert (silent.passed, silent.evaluated) == (False, False)
    assert "no width" in silent.reason

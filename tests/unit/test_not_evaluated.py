"""Checks at loads and mountings at which figures have no valid position: these are absent, and what rests on them fails."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import lxml.html
import numpy as np
import pytest
from support.checks import small_check, small_solid_check
from support.coarse import coarse_model

from gearcad import Load, Material
from gearcad.check.comparison import ComparisonRole
from gearcad.check.convergence import sweep_point
from gearcad.check.gates import compare_plane, compare_solid
from gearcad.check.notices import common_notices
from gearcad.check.result import CheckResult, PlaneCheck, SolidCheck, check_document
from gearcad.check.summary import PlaneSummary, SolidSummary, Summary, summarise_plane, summarise_solid
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.output import json_text
from gearcad.core.records import Verdict
from gearcad.report import report_html
from gearcad.report.check import CheckSections

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

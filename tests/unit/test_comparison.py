"""A gate that cannot be evaluated is not passed, and says why; the verdict tells numerics from strength."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from support.checks import small_check

from gearcad import Load, Material
from gearcad.check.comparison import Comparison, Subject, agrees, at_most, beside, verdict
from gearcad.check.gates import compare_common
from gearcad.cli.strength import print_verdict
from gearcad.core.output import json_text
from gearcad.core.records import NOT_ASKED_WORDS, Notice, PerGear, Verdict


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

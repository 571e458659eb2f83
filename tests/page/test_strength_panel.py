"""The rating of the page: what `gearcad rate --json` gives, with all digits; what is to be given where there is none."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gearcad.designs.design import Design
from gearcad.designs.reader import read_spec
from gearcad.jobs.strength import Rate
from gearcad.load import Load
from gearcad.page.panels.sheet_content import Figures, shown_figures, strength_figures, warm_up
from gearcad.page.words import PageLanguage, PageWords
from gearcad.page.workbench import Workbench
from gearcad.rating.options import RatingOptions

TEMPLATES = Path(__file__).parents[2] / "templates"

LONGEST = 0.15
"""Seconds of one rating of a pair, many times what it takes: the page has 0.3 s for it."""


def starter(name: str) -> Design:
    return read_spec(TEMPLATES / f"{name}.toml")


def document(design: Design) -> dict[str, Any]:
    job = Rate(report=False)
    return job.document(job.run(design))


def value(found: Figures, key: str, column: str = "") -> Any:
    return found.cells[key, column].value


@pytest.mark.parametrize("name", ["reducer-21-43", "volvo-13-44", "ring-22-70", "rack"])
def test_values_are_those_of_rate_json_with_all_digits(name: str) -> None:
    design = starter(name)
    found, expected = strength_figures(design), document(design)
    compared = 0
    for (key, column), cell in found.cells.items():
        _, table, *inner = key.split(".")
        of = expected
        for each in (table, *inner):
            of = of[each] if each in of else expected["stresses"][each]
        compared += 1
        if isinstance(of, dict):
            of = of[column]
        elif column:  # Z_B and Z_D are of one gear each
            of = of if cell.value is not None else None
        assert cell.value == of
    assert compared > 20
    assert found.title.startswith(f"strength {expected['strength']}")


def test_a_rating_follows_within_its_time() -> None:
    design = starter("reducer-21-43")
    warm_up(design)
    begun = time.thread_time()
    strength_figures(design)
    assert time.thread_time() - begun < LONGEST


def test_without_a_load_one_line_says_what_to_give() -> None:
    design = replace(starter("reducer-21-43"), load=None)
    found = strength_figures(design)
    text = "load.torque is missing: must be given, in N·m on the pinion: without it there is no stress"
    assert found.notices == ({"text": text, "keys": ["load.torque"]},)
    assert not found.cells


@pytest.mark.parametrize("name", ["spur", "train-1-stage"])
def test_what_carries_nothing_has_no_rating_and_no_warning(name: str) -> None:
    shown = shown_figures(strength_figures(starter(name)), PageWords.of(PageLanguage.GERMAN))
    assert shown["lines"] == [{"label": "", "text": "Für diese Art von Auslegung gibt es keinen Tragfähigkeitsnachweis."}]
    assert not shown["notices"]


def test_why_nothing_is_judged_stands_apart_from_the_verdict() -> None:
    found = strength_figures(starter("double-23-81"))
    shown = shown_figures(found, PageWords.of(PageLanguage.GERMAN))
    assert shown["title"] == "Tragfähigkeit nicht verlangt"
    assert found.title == f"strength not asked for: {shown['reason']}"


def test_what_only_the_document_of_a_rating_finds_to_be_wrong_is_a_line_too(tmp_path: Path) -> None:
    bench = Workbench((TEMPLATES / "reducer-21-43.toml").read_text(encoding="utf-8"), "trial", tmp_path)
    bench.change({"pinion.material.root_endurance_limit": "0.001"})
    assert bench.fault is None
    assert "N·m in size" in strength_figures(bench.design).notices[0]["text"]


def test_finite_elements_are_left_to_a_run() -> None:
    design = replace(starter("reducer-21-43"), rating=RatingOptions(face_load_factor="fe"))
    found = strength_figures(design)
    assert found.notices[0]["keys"] == ["rating.face_load_factor"]
    assert not found.cells


def test_a_verdict_is_coloured_and_stands_beside_that_of_a_kept_design() -> None:
    design = starter("reducer-21-43")
    passed = strength_figures(design)
    failed = strength_figures(replace(design, load=Load(torque=10 * design.load.torque, speed=design.load.speed)))  # type: ignore[attr-defined]
    assert (passed.verdict, failed.verdict) == ("passed", "failed")
    shown = shown_figures(failed, PageWords.of(PageLanguage.ENGLISH), kept=passed)
    assert shown["title"].startswith("strength NOT passed")
    assert shown["beside"] == passed.title

"""What the page tells of runs: what they would take, why they would not begin, and their verdicts in its words."""

from __future__ import annotations

from pathlib import Path

from gearcad.designs.reader import read_spec
from gearcad.page.panels.runs import expected_of, figures_beside
from gearcad.page.run_process import RunRequest
from gearcad.page.runs import Run
from gearcad.page.words import PageLanguage, PageWords

TEMPLATES = Path(__file__).parents[2] / "templates"


def test_what_would_not_begin_says_why() -> None:
    found = expected_of(read_spec(TEMPLATES / "volvo-13-44.toml"))
    assert found["check-2d"].why.startswith("pair.helix_angle = 28 deg: must be 0 for model 2d")
    assert not found["check-2d"].told
    assert not found["check-3d"].why
    assert found["check-3d"].told.startswith("≈ ")
    assert "about" not in found["check-3d"].told


def test_verdicts_are_told_in_the_words_of_the_page() -> None:
    asked = RunRequest(kind="rate", text="", name="trial", folder="", into="")
    runs = [
        Run(number, asked, {}, figures={"strength": said}) for number, said in enumerate(("passed", "failed", "not judged"))
    ]
    cells = {language: figures_beside(runs, PageWords.of(language))[0]["cells"] for language in PageLanguage}
    assert cells[PageLanguage.GERMAN] == ["bestanden", "nicht bestanden", "nicht beurteilt"]
    assert cells[PageLanguage.ENGLISH] == ["passed", "not passed", "not judged"]

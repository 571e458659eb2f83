"""A train several times side by side: document, arrays, tables and pictures hold the numbers of the studies."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import lxml.html
import numpy as np
import pytest

from gearcad.cli.dynamics import _lines
from gearcad.core.errors import ParameterError
from gearcad.core.records import Notice
from gearcad.designs import TrainDesign, read_spec
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.train import TrainModel
from gearcad.dynamics.variant_comparison import SideBySide
from gearcad.plots import plot
from gearcad.plots.paper import short
from gearcad.plots.trains import plot_factors_beside, plot_overloads_beside
from gearcad.report import write_dynamics_report
from gearcad.report.dynamics import greatest_table, resonance_table

TEMPLATES = Path(__file__).parents[2] / "templates"
LABELS = ("exact", "isolated <1>")


@pytest.fixture(scope="module")
def both() -> SideBySide:
    design = read_spec(TEMPLATES / "train-1-stage.toml")
    assert isinstance(design, TrainDesign)
    options = replace(design.dynamics, speeds=120)
    studies = [study_train(replace(design.train, model=TrainModel(word)), options) for word in ("exact", "isolated")]
    return SideBySide(name="it", what="$model$", labels=LABELS, studies=tuple(studies))


def test_every_resonance_is_that_of_a_study(both: SideBySide) -> None:
    """The isolated pair has the resonance of the teeth only, 2.4 % below that with shafts."""
    exact, isolated = both.studies
    (last,) = [each for each in both.resonances if each.shown[1] is not None]
    assert last.shown[0] is not None and last.shown[1] is not None
    assert last.shown[1].factor == isolated.greatest.factor and last.shown[1].speed == isolated.greatest.speed
    assert last.moved(1, 0) == pytest.approx(isolated.greatest.speed / exact.greatest.speed - 1, rel=1e-12)
    peaks = {round(each.speed, 6) for each in exact.resonances}
    assert {round(each.shown[0].speed, 6) for each in both.resonances if each.shown[0]} == peaks and len(peaks) == 5
    assert [each.factor for each in both.greatest] == [exact.greatest.factor, isolated.greatest.factor]
    assert [each.label for each in both.shaft_overloads] == ["exact"]


def test_documents(both: SideBySide, tmp_path: Path) -> None:
    document, arrays = both.to_dict(), both.arrays()
    assert document["labels"] == list(LABELS) and document["studies"][1] == both.studies[1].to_dict()
    assert document["resonances"][-1]["shown"]["isolated <1>"]["factor"] == both.studies[1].greatest.factor
    np.testing.assert_array_equal(arrays["isolated <1>/kv"], both.studies[1].up.factors)
    assert any("K_v of mesh" in line for line in _lines(both))
    write_dynamics_report(both, both.name, tmp_path / "it.html")
    page = lxml.html.parse(tmp_path / "it.html")
    assert page.xpath("//td[text()='isolated <1>']") and len(page.xpath("//figure")) == 3
    greatest = both.studies[1].greatest
    assert greatest_table(both).rows[1][1:] == ("isolated <1>", "1.615", short(greatest.speed))
    off = 100 * (greatest.speed / both.studies[0].greatest.speed - 1)
    assert resonance_table(both).rows[-1][3:] == (short(greatest.speed), f"{off:+.2f}", "1.615")


def test_pictures_have_a_line_for_each_study(both: SideBySide) -> None:
    (panel,) = plot_factors_beside(both).axes
    drawn = {str(line.get_label()): line.get_ydata() for line in panel.lines}
    np.testing.assert_array_equal(drawn["isolated <1>"], both.studies[1].up.factors[:, 0])
    (line,) = [line for line in plot(both).lines if line.get_label() == "isolated <1>"]
    np.testing.assert_array_equal(line.get_ydata(), both.studies[1].up.factors[:, 0])
    assert "<img" in both._repr_html_() and "isolated &lt;1&gt;" in both._repr_html_()
    (panel,) = plot_overloads_beside(both).axes
    assert [line.get_label() for line in panel.lines] == ["exact"]


def test_labels_must_differ(both: SideBySide) -> None:
    with pytest.raises(ParameterError, match="one for each of 2 studies"):
        replace(both, labels=("exact", "exact"))


def test_what_all_have_to_say_is_said_once(both: SideBySide) -> None:
    common, own = Notice("a", "of all"), Notice("b", "of one", where="mesh")
    exact, isolated = (replace(study, found=(common,)) for study in both.studies)
    found = replace(both, studies=(exact, replace(isolated, found=(common, own)))).warnings
    assert found == ("of all", "isolated <1>: mesh: of one")

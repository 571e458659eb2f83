"""Modifications on the page: the error at once is that of the check, what is drawn is bounded, and a drag is one step."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcad import check
from gearcad.check import CheckOptions
from gearcad.core.errors import ParameterError
from gearcad.designs.pair_designs import PairDesign
from gearcad.page.live_modifications import QUICK, DrawnModification, _bodies, drawn_gears, live_error
from gearcad.page.workbench import Workbench

TEXT = """[pair]
normal_module = 3
face_width = 12
tooth_thinning = 0.05
modification.tip_relief = 18.0  # both
modification.tip_relief_length = 2.0
[pinion]
teeth = 21
[wheel]
teeth = 32
[load]
torque = 120
[check]
refinement = 0.5
convergence = "off"
body_teeth = 5
"""


def _bench(tmp_path: Path) -> Workbench:
    return Workbench(TEXT, "mine", tmp_path)


def _design(bench: Workbench) -> PairDesign:
    assert isinstance(bench.design, PairDesign)
    return bench.design


@pytest.mark.long
def test_the_error_of_kept_bodies_is_that_of_a_check(tmp_path: Path) -> None:
    bench = _bench(tmp_path)
    live_error(_design(bench))
    made = _bodies.cache_info().misses
    bench.change(DrawnModification.of("pinion", {"tip_relief": 30.0, "tip_relief_length": 1.5}, _design(bench)).texts, 1)
    bench.change(DrawnModification.of("wheel", {"profile_crowning": 6.0}, _design(bench)).texts, 2)
    found = live_error(_design(bench))
    assert _bodies.cache_info().misses == made, "the bodies are kept"
    options = CheckOptions(refinement=0.5, convergence="off", body_teeth=5, torques=[20.0])
    cycle = check(_design(bench), check=options, model="2d").cycle  # bodies meshed with the modifications in place
    assert found["errors"] == pytest.approx(cycle.values("transmission_error").tolist(), rel=1e-6)
    assert found["peak_to_peak"] == pytest.approx(np.ptp(cycle.values("transmission_error")), rel=1e-6)


def test_fewer_positions_are_among_those_of_a_check(tmp_path: Path) -> None:
    design = _design(_bench(tmp_path))
    quick, full = live_error(design, QUICK), live_error(design)
    assert len(quick["angles"]) == QUICK
    at = dict(zip(np.round(full["angles"], 9), full["errors"], strict=True))
    assert quick["errors"] == pytest.approx([at[angle] for angle in np.round(quick["angles"], 9)], rel=1e-6)


def test_curves_are_the_parabolas_and_lines_of_the_standard(tmp_path: Path) -> None:
    bench = _bench(tmp_path)
    values = {"lead_crowning": 8.0, "helix_angle_modification": 5.0, "end_relief": 4.0, "end_relief_length": 3.0}
    bench.change(DrawnModification.of("pinion", values, _design(bench)).texts, 1)
    pinion, wheel = drawn_gears(_design(bench))
    across = np.linspace(-1, 1, len(pinion["lead"]))
    ends = np.maximum((np.abs(across) - 0.5) / 0.5, 0)  # 3 of the 6 mm of half the width
    assert pinion["lead"] == pytest.approx((8 * across**2 - 2.5 * across + 4 * ends).tolist(), abs=2e-3)
    assert max(map(abs, wheel["lead"])) == 0
    assert pinion["profile"][-1] == wheel["profile"][-1] == 18.0


def test_a_drag_is_one_step_and_keeps_comments(tmp_path: Path) -> None:
    bench = _bench(tmp_path)
    for amount in (19.04, 22.06, 25.08):
        bench.change(DrawnModification.of("pinion", {"tip_relief": amount, "tip_relief_length": 2.0}, _design(bench)).texts, -2)
    assert _design(bench).pair.pinion.modification.tip_relief == 25.1
    assert _design(bench).pair.wheel.modification.tip_relief == 18.0
    assert "modification.tip_relief = 18.0  # both" in bench.text
    bench.undo()
    assert bench.text == TEXT and not bench.can_undo


@pytest.mark.parametrize(
    ("role", "values"),
    [
        ("both", {"tip_relief": 1.0}),
        ("pinion", {"teeth": 3}),
        ("pinion", {"__class__": 1.0}),
        ("pinion", {"tip_relief": math.nan}),
        ("pinion", {"tip_relief": math.inf}),
        ("pinion", {"tip_relief": "18"}),
        ("pinion", {"tip_relief": True}),
        ("pinion", {"tip_relief": [1.0]}),
    ],
)
def test_what_the_browser_may_not_send_is_refused(tmp_path: Path, role: str, values: dict[str, Any]) -> None:
    with pytest.raises(ParameterError):
        DrawnModification.of(role, values, _design(_bench(tmp_path)))


def test_what_is_drawn_too_far_ends_where_it_may(tmp_path: Path) -> None:
    bench = _bench(tmp_path)
    form = _design(bench).pair.pinion.flank_form
    drawn = DrawnModification.of(
        "pinion", {"tip_relief": -5.0, "tip_relief_length": 99.0, "lead_crowning": -2e6}, _design(bench)
    )
    assert drawn.values["tip_relief"] == 0.0 and drawn.values["lead_crowning"] == -1000.0
    assert form.last - form.first - 0.01 < drawn.values["tip_relief_length"] <= form.last - form.first


def test_what_is_drawn_in_inches_comes_back_without_drift(tmp_path: Path) -> None:
    bench = _bench(tmp_path)
    drawn = DrawnModification.of(
        "pinion", {"tip_relief": 900 * 0.0254, "tip_relief_length": 0.06 * 25.4}, _design(bench), finer=2
    )
    assert drawn.values == {"tip_relief": 22.86, "tip_relief_length": 1.524}
    bench.change(drawn.texts, 1)
    assert _design(bench).pair.pinion.modification.tip_relief / 0.0254 == pytest.approx(900)


def test_without_a_load_the_reason_is_told(tmp_path: Path) -> None:
    bench = Workbench(TEXT.replace("[load]\ntorque = 120\n", ""), "mine", tmp_path)
    found = live_error(_design(bench))
    assert found["peak_to_peak"] is None and "load.torque" in found["why_not"]

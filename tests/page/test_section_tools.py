"""Drawn and measured in the section: handles write inputs, measures are those of the standard, the tool leaves the tooth."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcad.designs.design import Design
from gearcad.designs.reader import starter_text
from gearcad.geometry import Gear
from gearcad.page.panels.drawn_data import section_of
from gearcad.page.panels.section_handles import drawn_text, handles_of, section_gears
from gearcad.page.run_process import design_of
from gearcad.page.section_measures import asked_of, gaps_of, pins_at, thickness_at, tool_at
from gearcad.page.workbench import Workbench

SPUR = "[gear]\nteeth = 24\nnormal_module = 2.5\nface_width = 10\n"


def _design(starter: str) -> Design:
    return design_of(starter_text(starter)[1], starter, Path())


def _bench(starter: str) -> Workbench:
    return Workbench(starter_text(starter)[1], starter, Path())


def _gears(design: Design) -> dict[str, Gear]:
    return {each.name: each.gear for each in section_gears(design, {})}


def test_handles_stand_on_their_circles() -> None:
    handles = {handle["key"]: handle for handle in handles_of(_design("reducer-21-43"), {})}
    assert handles["pinion.profile_shift"]["radius"] == pytest.approx(3 * 21 / 2 + 0.2 * 3)
    assert handles["pair.centre_distance"]["value"] == 97.0
    for handle in handles.values():  # a hand that moves to another radius writes the value that has it there
        assert (handle["radius"] - handle["zero"]) * handle["factor"] == pytest.approx(handle["value"])


@pytest.mark.parametrize("key", ["wheel.tip_diameter", "wheel.profile_shift", "pinion.tip_diameter"])
def test_what_a_handle_of_a_ring_writes_is_where_the_hand_is(key: str, tmp_path: Path) -> None:
    bench = Workbench(starter_text("ring-22-70")[1], "ring", tmp_path)
    (before,) = (handle for handle in handles_of(bench.design, bench.tables) if handle["key"] == key)
    wanted = before["radius"] + 0.05
    bench.change(drawn_text(bench.design, bench.tables, key, (wanted - before["zero"]) * before["factor"]), -5)
    assert bench.fault is None
    (after,) = (handle for handle in handles_of(bench.design, bench.tables) if handle["key"] == key)
    assert after["radius"] == pytest.approx(wanted, abs=3e-4)


@pytest.mark.parametrize("starter", ["rack", "planetary-alm", "planetary-differential", "planetary-24-21-66"])
def test_handles_stand_where_the_section_draws_their_circles_and_lines(starter: str) -> None:
    bench = _bench(starter)
    drawn = section_of(bench.design)
    assert drawn is not None
    handles = handles_of(bench.design, bench.tables)
    assert len({handle["key"] for handle in handles}) == len(handles)
    for handle in handles:
        body = drawn["bodies"][handle["body"]]
        assert {type(value) for value in handle.values()} <= {str, int, float, list}, "the browser is sent plain values"
        assert (handle["radius"] - handle["zero"]) * handle["factor"] == pytest.approx(handle["value"])
        if handle["kind"] == "tip_diameter":
            assert 2 * handle["radius"] == pytest.approx(body["circles"]["tip"])
        elif handle["kind"] == "mounting_distance":
            assert handle["radius"] == pytest.approx(body["place"][0] + body["circles"]["reference"])
        elif handle["kind"] == "tip_alteration":
            assert handle["radius"] == pytest.approx(body["place"][0] - body["circles"]["tip"])
        elif handle["kind"] == "centre_distance":
            assert handle["radius"] == pytest.approx(math.hypot(*body["place"]))
            assert handle["direction"] == pytest.approx(math.atan2(*reversed(body["place"])))


@pytest.mark.parametrize(
    ("starter", "key", "moved"),
    [
        ("rack", "pair.mounting_distance", 0.05),
        ("rack", "rack.tip_alteration", 0.05),
        ("rack", "pinion.tip_diameter", -0.05),
        ("planetary-alm", "ring_2.tip_diameter", 0.03),
        ("planetary-alm", "planet.profile_shift", -0.02),
        ("planetary-alm", "planetary.centre_distance", 0.02),
        ("planetary-alm", "planetary.pre_stage.centre_distance", 0.05),
        ("planetary-alm", "planetary.pre_stage.wheel.profile_shift", -0.02),
        ("planetary-24-21-66", "sun.profile_shift", -0.01),
    ],
)
def test_what_a_handle_of_a_rack_or_a_train_writes_is_where_the_hand_is(starter: str, key: str, moved: float) -> None:
    bench = _bench(starter)
    (before,) = (handle for handle in handles_of(bench.design, bench.tables) if handle["key"] == key)
    wanted = before["radius"] + moved
    text = drawn_text(bench.design, bench.tables, key, (wanted - before["zero"]) * before["factor"])
    bench.change(text, -5)
    assert bench.fault is None
    (after,) = (handle for handle in handles_of(bench.design, bench.tables) if handle["key"] == key)
    assert after["radius"] == pytest.approx(wanted, abs=6e-4)


def test_of_many_gears_the_handles_are_those_of_one() -> None:
    bench = _bench("planetary-alm")
    names = [each.name for each in section_gears(bench.design, bench.tables)]
    keys = [handle["key"] for handle in handles_of(bench.design, bench.tables, names.index("ring_5"))]
    assert keys == ["ring_2.tip_diameter", "ring_2.profile_shift", "planetary.centre_distance"]
    keys = [handle["key"] for handle in handles_of(bench.design, bench.tables, names.index("gear_2"))]
    assert keys[0] == "planetary.pre_stage.wheel.tip_diameter" and keys[-1] == "planetary.pre_stage.centre_distance"


def test_a_drag_is_one_step(tmp_path: Path) -> None:
    text = starter_text("reducer-21-43")[1]
    bench = Workbench(text, "mine", tmp_path)
    for shift in (0.21, 0.25, 0.3):
        bench.change(drawn_text(bench.design, bench.tables, "pinion.profile_shift", shift), -1_000_001)
    assert bench.design.gears["pinion"].profile_shift == 0.3  # type: ignore[attr-defined]
    bench.undo()
    assert bench.text == text and not bench.can_undo


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("load.torque", 5.0),
        ("pinion.teeth", 30),
        ("pinion.profile_shift", math.nan),
        ("pinion.profile_shift", math.inf),
        ("pinion.profile_shift", "0.3"),
        ("pinion.profile_shift", True),
        ("pinion.profile_shift", 1e9),
        ("__class__", 1.0),
    ],
)
def test_what_the_browser_may_not_write_is_left_out(key: str, value: Any) -> None:
    assert drawn_text(_design("reducer-21-43"), {}, key, value) == {}


@pytest.mark.parametrize(
    "told", [{"gear": 99}, {"gear": -1}, {"gear": True}, {"gear": "x", "size": -1}, {"size": math.inf}, {"size": True}, {}]
)
def test_what_the_browser_may_not_ask_for_is_the_usual(told: dict[str, Any]) -> None:
    assert asked_of(told) == (0, None)


def test_thickness_is_that_of_the_standard() -> None:
    """Of a spur gear s = pi m/2 on the reference circle, elsewhere s_y = d_y (s/d + inv alpha - inv alpha_y) (ISO 21771)."""
    (gear,) = _gears(design_of(SPUR, "spur", Path())).values()
    assert thickness_at(gear, None)["arc"] == pytest.approx(math.pi * 2.5 / 2, rel=1e-9)
    alpha, at = math.radians(20), math.acos(60 * math.cos(math.radians(20)) / 63)
    thick = 63 * (math.pi / 48 + math.tan(alpha) - alpha - (math.tan(at) - at))
    found = thickness_at(gear, 63.0)
    assert found["arc"] == pytest.approx(thick, rel=1e-9)
    assert found["chord"] == pytest.approx(63 * math.sin(thick / 63), rel=1e-9)
    assert thickness_at(gear, 500.0)["diameter"] == gear.tip_diameter


def test_pins_touch_both_flanks() -> None:
    """A pin at its circle is as far from the drawn outline as its radius."""
    for starter, name in (("reducer-21-43", "pinion"), ("ring-22-70", "wheel")):
        gear = _gears(_design(starter))[name]
        found = pins_at(gear, None)
        centre = found["circle"] / 2 * np.array([math.cos(math.pi / gear.tooth_count), math.sin(math.pi / gear.tooth_count)])
        outline = gear.profile.points(1e-5)
        near = np.linspace(outline[:-1], outline[1:], 40).reshape(-1, 2)  # chords of the outline
        assert np.hypot(*(near - centre).T).min() == pytest.approx(
            found["pin"] / 2, abs=2e-3 if gear.modification.present else 5e-5
        )


def test_gaps_are_the_backlash_of_the_sheet() -> None:
    found = gaps_of(_design("reducer-21-43"))
    assert found is not None
    # Spur: the normal backlash is the circumferential one times cos(alpha_wt), cos(alpha_wt) = m (z1 + z2)/2 cos 20/a.
    assert found["normal"] == pytest.approx(found["circumferential"] * 3 * 64 / 2 * math.cos(math.radians(20)) / 97, rel=1e-9)
    assert found["line_of_action"] == pytest.approx(found["normal"], rel=1e-9)
    assert gaps_of(design_of(SPUR, "spur", Path())) is None


@pytest.mark.parametrize(("starter", "name"), [("reducer-21-43", "pinion"), ("volvo-13-44", "wheel"), ("ring-22-70", "wheel")])
def test_the_tool_leaves_the_tooth_and_nothing_more(starter: str, name: str) -> None:
    """Outlines of all positions touch the drawn outline of the gear, and none cuts into it."""
    gear = _gears(_design(starter))[name]
    found = tool_at(gear)
    points = np.concatenate([np.reshape(outline, (-1, 2)) for stand in found["stands"] for outline in stand])
    radius, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    low, high = sorted((abs(gear.root_diameter) / 2, abs(gear.tip_diameter) / 2))
    inside = (radius > low + 1e-3) & (radius < high - 1e-3) & (np.abs(angle) < math.pi / gear.tooth_count)
    half = np.radians(gear.profile.half_angle(radius[inside]))
    into = (half - np.abs(angle[inside])) * radius[inside]  # mm into the tooth, along the circle
    if gear.internal:
        assert radius.max() == pytest.approx(high, abs=5e-3)
    else:
        assert radius.min() == pytest.approx(low, abs=5e-3)
    taken_off = max(0.03, gear.modification.tip_relief / 1000)
    assert into.max() < taken_off, "modifications are no part of the tool"
    assert into.max() > -0.02, "some position touches the flank"

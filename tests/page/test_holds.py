"""Ranked inputs of every kind of spec, and what follows from what, against the closed form of the working pressure angle."""

import math
from collections.abc import Mapping
from typing import Any

import pytest
from support.specs import starter_specs

from gearcad.core.runtime import templates
from gearcad.page.fields import fields_of, ranked_fields, used_texts
from gearcad.page.panels.holds import HoldSwitches
from gearcad.page.words import PageLanguage, PageWords
from gearcad.page.workbench import Workbench

KINDS = [spec.stem for spec in starter_specs()]

CLOSE = 1e-8
"""Error (mm, or modules) that the decimals of written values leave."""


def _bench(name: str) -> Workbench:
    return Workbench((templates() / f"{name}.toml").read_text(encoding="utf-8"), name, templates())


def _switches(bench: Workbench) -> HoldSwitches:
    return HoldSwitches(bench, PageWords.of(PageLanguage.ENGLISH))


def _press(bench: Workbench, switches: HoldSwitches, what: str) -> None:
    bench.change(switches.press(what))
    assert bench.fault is None


def _type(bench: Workbench, switches: HoldSwitches, key: str, text: str, step: int) -> None:
    bench.change({key: text}, step, switches.followers(key, text))


def _on(switches: HoldSwitches) -> set[str]:
    return {each["what"] for each in switches.state()["holds"] if each["on"]}


def _inv(angle: float) -> float:
    return math.tan(angle) - angle


def _angle_of(value: float) -> float:
    """The angle (rad) of an involute function, by Newton's method."""
    angle = (3 * value) ** (1 / 3) if value > 0 else 0.0
    for _ in range(60):
        angle -= (_inv(angle) - value) / math.tan(angle) ** 2
    return angle


def _transverse(m: float, beta: float) -> tuple[float, float]:
    """Transverse module (mm) and pressure angle (rad) of a rack of 20 degrees."""
    return m / math.cos(math.radians(beta)), math.atan(math.tan(math.radians(20)) / math.cos(math.radians(beta)))


def _distance(z: tuple[int, int], x_sum: float, m: float, beta: float) -> float:
    """Centre distance (mm) without backlash of these profile shifts; the second gear has negative teeth where it is a ring."""
    transverse, alpha = _transverse(m, beta)
    working = _angle_of(_inv(alpha) + 2 * x_sum * math.tan(math.radians(20)) / sum(z))
    return sum(z) * transverse / 2 * math.cos(alpha) / math.cos(working)


def _shift_sum(z: tuple[int, int], a: float, m: float, beta: float) -> float:
    """Sum of the profile shifts without backlash at a centre distance (mm)."""
    transverse, alpha = _transverse(m, beta)
    working = math.acos(sum(z) * transverse * math.cos(alpha) / (2 * a))
    return sum(z) * (_inv(working) - _inv(alpha)) / (2 * math.tan(math.radians(20)))


def test_the_closed_form_is_that_of_textbooks() -> None:
    """z = 12 and 24, m = 3 mm, x = 0.6 and 0.36: a = 56.4999 mm (KHK, Gear technical reference, profile shifted spur gears)."""
    assert _distance((12, 24), 0.96, 3.0, 0.0) == pytest.approx(56.4999, abs=1e-4)
    assert _shift_sum((12, 24), 56.4999, 3.0, 0.0) == pytest.approx(0.96, abs=1e-4)


# ---------------------------------------------------------------------------------------------------- ranking


@pytest.mark.parametrize("name", KINDS)
def test_the_main_inputs_of_every_kind_are_fields_of_it(name: str) -> None:
    bench = _bench(name)
    fields = {
        field["key"]
        for table in fields_of(bench.design, bench.tables)
        for group in table["groups"]
        for field in group["fields"]
    }
    ranked = ranked_fields(bench.design, bench.tables)
    keys = [key for row in ranked["rows"] for key in row["keys"] if key]
    assert set(keys) <= fields
    assert len(keys) == len(set(keys))
    assert all(len(row["keys"]) == (1 if row["shared"] else len(ranked["columns"])) for row in ranked["rows"])


def test_ten_inputs_of_a_pair_come_first_pinion_and_wheel_side_by_side() -> None:
    bench = _bench("reducer-21-43")
    ranked = ranked_fields(bench.design, bench.tables)
    assert ranked["columns"] == ["Pinion", "Wheel"]
    assert [row["keys"] for row in ranked["rows"]] == [
        ["pinion.teeth", "wheel.teeth"],
        ["pair.normal_module"],
        ["pair.helix_angle"],
        ["pinion.profile_shift", "wheel.profile_shift"],
        ["pinion.face_width", "wheel.face_width"],
        ["pair.centre_distance"],
        ["load.torque"],
        ["load.speed"],
        ["material.name"],
        ["rating.accuracy_grade"],
    ]


def test_an_input_stands_where_the_spec_has_it() -> None:
    bench = _bench("reducer-21-43")
    bench.change({"pair.normal_module": "", "pinion.normal_module": "3", "wheel.normal_module": "3", "material.wheel": "St MQ"})
    keys = [row["keys"] for row in ranked_fields(bench.design, bench.tables)["rows"]]
    assert ["pinion.normal_module", "wheel.normal_module"] in keys
    assert ["material.pinion", "material.wheel"] in keys
    bench.change({"pinion.normal_module": "", "wheel.normal_module": "", "pair.normal_diametral_pitch": "8"})
    assert ["pair.normal_diametral_pitch"] in [row["keys"] for row in ranked_fields(bench.design, bench.tables)["rows"]]


def test_a_rack_has_a_length_in_place_of_teeth() -> None:
    bench = _bench("rack")
    bench.change({"rack.teeth": "", "rack.length": "500"})
    assert bench.fault is None
    assert ranked_fields(bench.design, bench.tables)["rows"][0]["keys"] == ["pinion.teeth", "rack.length"]


# ---------------------------------------------------------------------------------------------------- hold a, hold x


@pytest.mark.parametrize(
    ("key", "text"), [("pinion.teeth", "22"), ("wheel.teeth", "42"), ("pair.normal_module", "2.95"), ("pair.helix_angle", "5")]
)
def test_a_held_centre_distance_changes_the_sum_of_the_shifts(key: str, text: str) -> None:
    bench = _bench("reducer-21-43")
    assert _on(_switches(bench)) == {"a"}
    bench.change({key: text})
    z = tuple(gear.teeth for gear in bench.design.gears.values())
    pinion = bench.design.gears["pinion"]
    expected = _shift_sum(z, 97.0, pinion.normal_module, pinion.helix_angle)
    found = sum(gear.profile_shift for gear in bench.design.gears.values())
    assert bench.fault is None
    assert found == pytest.approx(expected, abs=CLOSE)
    assert used_texts(bench.design, bench.tables)["wheel.profile_shift"] == f"{found - 0.2:.7g}"


@pytest.mark.parametrize(
    ("key", "text"), [("pinion.teeth", "22"), ("wheel.teeth", "50"), ("pair.normal_module", "4"), ("pair.helix_angle", "15")]
)
def test_held_shifts_let_the_centre_distance_follow(key: str, text: str) -> None:
    bench, tables = _bench("reducer-21-43"), dict[str, Any]()
    switches = _switches(bench)
    _press(bench, switches, "x")
    assert _on(switches) == {"x"}
    tables = bench.tables
    assert "centre_distance" not in tables["pair"]
    x_sum = tables["pinion"]["profile_shift"] + tables["wheel"]["profile_shift"]
    assert x_sum == pytest.approx(_shift_sum((21, 43), 97.0, 3.0, 0.0), abs=CLOSE)
    bench.change({key: text})
    assert bench.fault is None
    z = tuple(gear.teeth for gear in bench.design.gears.values())
    pinion = bench.design.gears["pinion"]
    expected = _distance(z, x_sum, pinion.normal_module, pinion.helix_angle)
    assert bench.design.pair.centre_distance == pytest.approx(expected, abs=CLOSE)
    assert bench.tables["wheel"]["profile_shift"] == tables["wheel"]["profile_shift"]


def test_a_ring_holds_its_negative_centre_distance() -> None:
    bench = _bench("ring-22-70")
    switches = _switches(bench)
    assert _on(switches) == {"a"}
    _press(bench, switches, "x")
    x_sum = 0.5 + bench.tables["wheel"]["profile_shift"]
    assert x_sum == pytest.approx(_shift_sum((22, -70), -69.0, 2.8, 0.0), abs=CLOSE)
    bench.change({"wheel.teeth": "-71"})
    assert bench.fault is None
    assert bench.design.pair.centre_distance == pytest.approx(_distance((22, -71), x_sum, 2.8, 0.0), abs=CLOSE)


@pytest.mark.parametrize("name", ["reducer-21-43", "ring-22-70", "rack", "double-23-81", "planetary-24-21-66", "fzg-c"])
def test_switches_are_one_step_and_lead_back_to_the_same_design(name: str) -> None:
    bench = _bench(name)
    switches = _switches(bench)
    text, before = bench.text, _measures(bench)
    for what in ("x", "a", "x", "a"):
        _press(bench, switches, what)
        assert _on(switches) == {what}
        if name != "fzg-c":  # which has backlash left over at its centre distance, that a hold takes away
            assert _measures(bench) == pytest.approx(before, abs=CLOSE)
    while bench.can_undo:
        bench.undo()
    assert bench.text == text


def _measures(bench: Workbench) -> dict[str, float]:
    found = {name: gear.profile_shift for name, gear in bench.design.gears.items()}
    of = getattr(bench.design, "pair", None) or bench.design.train
    return found | {"distance": getattr(of, "centre_distance", None) or of.mounting_distance}


def test_a_switch_is_undone_at_once() -> None:
    bench = _bench("reducer-21-43")
    text, switches = bench.text, _switches(bench)
    _press(bench, switches, "x")
    bench.undo()
    assert (bench.text, bench.can_undo) == (text, False)


def test_what_is_given_twice_leaves_the_backlash_to_follow() -> None:
    bench = _bench("volvo-13-44")
    switches = _switches(bench)
    state = switches.state()
    assert _on(switches) == set()
    assert state["note"] == ["Centre distance and profile shifts are given: the backlash follows."]
    _press(bench, switches, "a")
    assert bench.tables["wheel"]["profile_shift"] == "auto"
    found = sum(gear.profile_shift for gear in bench.design.gears.values())
    assert found == pytest.approx(_shift_sum((13, 44), 80.0, 2.5, 28.0), abs=CLOSE)


def test_the_reason_stands_with_what_follows() -> None:
    bench = _bench("reducer-21-43")
    switches = _switches(bench)
    assert switches.state()["why"] == {"wheel.profile_shift": "follows from the centre distance"}
    _press(bench, switches, "x")
    assert list(switches.state()["why"]) == ["pair.centre_distance"]
    assert HoldSwitches(bench, PageWords.of(PageLanguage.GERMAN)).state()["note"] == ["Der Achsabstand folgt."]


@pytest.mark.parametrize("name", ["spur", "planetary-alm", "train-2-stage"])
def test_what_has_no_mates_has_no_switches(name: str) -> None:
    bench = _bench(name)
    switches = _switches(bench)
    assert switches.state() == {"holds": [], "note": [], "why": {}}
    assert switches.press("a") == switches.press("u") == {}


def test_what_no_switch_sends_changes_nothing() -> None:
    bench = _bench("reducer-21-43")
    assert _switches(bench).press("<script>") == {}


# ---------------------------------------------------------------------------------------------------- hold ratio


@pytest.mark.parametrize(("key", "text", "other", "expected"), [
    ("pinion.teeth", "22", "wheel.teeth", 45),  # 22 * 43/21 = 45.05
    ("pinion.teeth", "25", "wheel.teeth", 51),  # 51.19
    ("wheel.teeth", "44", "pinion.teeth", 21),  # 21.49
    ("wheel.teeth", "45", "pinion.teeth", 22),  # 21.98
])  # fmt: skip
def test_a_held_ratio_takes_the_nearest_teeth_as_one_step(key: str, text: str, other: str, expected: int) -> None:
    bench = _bench("reducer-21-43")
    switches, before = _switches(bench), bench.text
    _press(bench, switches, "u")
    assert _on(switches) == {"a", "u"}
    for typed in (text[:1], text):
        _type(bench, switches, key, typed, step=1)
    table = other.partition(".")[0]
    assert bench.tables[table]["teeth"] == expected
    bench.undo()
    assert bench.text == before


def test_a_held_ratio_does_not_drift() -> None:
    bench = _bench("reducer-21-43")
    switches = _switches(bench)
    _press(bench, switches, "u")
    for step, teeth in enumerate([*range(21, 60), *range(60, 20, -1)]):
        _type(bench, switches, "pinion.teeth", str(teeth), step)
    assert [bench.tables[table]["teeth"] for table in ("pinion", "wheel")] == [21, 43]
    _press(bench, switches, "u")
    _type(bench, switches, "pinion.teeth", "30", 99)
    assert bench.tables["wheel"]["teeth"] == 43


def test_planets_change_with_sun_and_ring() -> None:
    """24, 21 and 66 teeth: z_r = z_s + 2 z_p stays, and 66/24 = 2.75."""
    bench = _bench("planetary-24-21-66")
    switches = _switches(bench)
    _press(bench, switches, "u")
    _type(bench, switches, "sun.teeth", "32", 1)
    teeth: Mapping[str, int] = {table: bench.tables[table]["teeth"] for table in ("sun", "planet", "ring")}
    assert teeth == {"sun": 32, "planet": 28, "ring": -88}


def test_a_held_ratio_ends_with_its_spec() -> None:
    bench = _bench("reducer-21-43")
    switches = _switches(bench)
    _press(bench, switches, "u")
    bench.open((templates() / "fzg-c.toml").read_text(encoding="utf-8"), "fzg-c")
    assert "u" not in _on(switches)
    assert switches.followers("pinion.teeth", "20") == {}

"""Random tools that cut before finishing: outlines against brute-force sweeps of the tools' own outlines."""

import math
import random
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from gearcad import BasicRack, Gear
from gearcad.core.errors import InputError
from gearcad.core.records import Floats
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.premachining import Finishing, Premachining, SemiTopping
from gearcad.verification import geometry, tool_sweep, tool_teeth

HOBS = ("free", "equal", "short", "topping", "semi", "notch", "form")
CUTTERS = ("shaper", "ring")
PERMITTED = 1e-7
"""Distance (mm) of an outline from the tools."""


def random_gear(rng: random.Random, kind: str) -> Gear:
    """A gear of random tools, or an InputError for those that cannot cut it."""
    m, angle, q = rng.choice([1.0, 1.5, 3.0, 6.0, 10.0]), rng.choice([14.5, 17.5, 20.0, 20.0, 25.0]), rng.uniform(0.01, 0.05)
    pre: dict[str, Any] = {"tool_addendum": rng.uniform(1.2, 1.5), "tool_tip_radius": rng.uniform(0.1, 0.3)}
    pre["stock"] = q * m**0.6
    pre |= {
        "protuberance": pre["stock"] + rng.uniform(0.005, 0.04) * m**0.6,
        "protuberance_angle": rng.uniform(4.0, angle - 1.0),
    }
    plain: dict[str, Any] = {"teeth": rng.choice([9, 12, 17, 25, 40, 90, 220]), "profile_shift": rng.uniform(-0.2, 0.6)}
    if kind == "equal":
        pre["stock"] = pre["protuberance"]
    elif kind == "short":
        short = angle - rng.uniform(0.5, 4.0)
        pre["protuberance_angle"] = rng.uniform(4.0, short - 1.0)
        if rng.random() < 0.5:
            pre["tool_pressure_angle"] = short
        else:
            pre["tool_module"] = m * math.cos(math.radians(angle)) / math.cos(math.radians(short))
    elif kind == "topping":
        pre["topping"] = m * rng.uniform(0.9, 1.05)
    elif kind == "semi":
        pre["semi_topping"] = SemiTopping(angle=rng.uniform(35.0, 60.0), height=m * rng.uniform(0.55, 0.8))
    elif kind in CUTTERS:
        pre |= {"cutter_teeth": rng.choice([17, 25, 40]), "protuberance_angle": rng.uniform(4.0, 9.0)}
        pre["protuberance"] = pre["stock"] + rng.uniform(0.002, 0.012) * m
        plain["teeth"] = rng.choice([-60, -90, -120] if kind == "ring" else [25, 40, 90])
    shared = {"normal_module": m, "helix_angle": rng.choice([0.0, 0.0, 10.0, -18.0, 28.0]), "face_width": 10.0}
    shared["tooth_thinning"] = rng.choice([0.0, 0.02]) * m
    if kind in ("notch", "form"):
        pre["protuberance"] = rng.choice([0.0, 0.4]) * pre["stock"]
        if not pre["protuberance"]:
            del pre["protuberance_angle"]
        rack = BasicRack(pressure_angle=angle, dedendum=pre["tool_addendum"], root_radius=min(pre["tool_tip_radius"], 0.2))
        end = Gear(rack=rack, **plain, **shared).form_diameter + m * rng.uniform(0.05, 0.3)
        how = "form" if kind == "form" else "generating"
        plain["finishing"] = Finishing(kind=how, end_diameter=end, wheel_tip_radius=m * rng.uniform(0.1, 0.25))
    return Gear(rack=BasicRack(pressure_angle=angle), premachining=Premachining(**pre), **plain, **shared)


def gears_of(kind: str, count: int, seed: int) -> list[Gear]:
    """Gears of a kind of tool that can be cut."""
    rng, found = random.Random(f"{kind} {seed}"), list[Gear]()
    for _ in range(40 * count):
        if len(found) < count:
            try:
                found.append(random_gear(rng, kind))
            except InputError:
                continue
    assert len(found) == count
    return found


def distances(gear: Gear) -> tuple[Floats, Floats]:
    """Distances (mm) of points of the outline from the nearest tool, and whether a tool makes them."""
    points = geometry._tooth(gear)
    off = np.minimum(
        geometry._swept(gear, tool_sweep.tool_of(gear), points, 0.0, 0.0), geometry._finished(gear, points, 0.0, 0.0)
    )
    return off, geometry._made_by_tool(gear, points)


def judge(gear: Gear) -> None:
    """Fail unless every point of the outline touches a tool, and none is inside one."""
    off, made = distances(gear)
    assert off.min() > -PERMITTED, gear
    assert off[made].max() < PERMITTED, gear


@pytest.mark.parametrize("kind", HOBS)
def test_outlines_touch_the_hob_and_the_wheel(kind: str) -> None:
    for gear in gears_of(kind, 4, seed=1):
        judge(gear)


@pytest.mark.parametrize("kind", CUTTERS)
def test_outlines_touch_the_shaper_cutter(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tool_teeth, "_CUTTER_POINTS", 6000)
    monkeypatch.setattr(tool_sweep, "_BEARINGS", 6001)
    for gear in gears_of(kind, 1, seed=1):
        judge(gear)


@pytest.mark.long
@pytest.mark.parametrize("kind", HOBS)
def test_three_hundred_outlines_touch_hobs_and_wheels(kind: str) -> None:
    for gear in gears_of(kind, 40, seed=2):
        judge(gear)


@pytest.mark.long
@pytest.mark.parametrize("kind", CUTTERS)
def test_outlines_touch_many_shaper_cutters(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tool_teeth, "_CUTTER_POINTS", 12000)
    monkeypatch.setattr(tool_sweep, "_BEARINGS", 6001)
    for gear in gears_of(kind, 10, seed=2):
        judge(gear)


def steep_cutter(rng: random.Random, *, ring: bool, **changes: Any) -> Gear:
    """A gear of a shaper cutter whose protuberance has any angle; an InputError where it cannot be cut."""
    m, angle = rng.choice([1.0, 3.0, 8.0]), rng.choice([14.5, 20.0, 25.0])
    stock = rng.uniform(0.01, 0.05) * m**0.6
    pre: dict[str, Any] = {
        "tool_addendum": rng.uniform(1.2, 1.5),
        "tool_tip_radius": rng.choice([0.02, 0.1, 0.2]),
        "stock": stock,
        "protuberance": stock + rng.uniform(0.002, 0.05) * m,
        "protuberance_angle": rng.uniform(1.0, 14.4),
        "cutter_teeth": rng.choice([12, 17, 25, 40, 80]),
        "cutter_profile_shift": rng.uniform(-0.3, 0.5),
    }
    for name, change in changes.items():
        pre[name] = change(pre)
    return Gear(
        teeth=rng.choice([-60, -90, -150] if ring else [12, 25, 60, 200]),
        normal_module=m,
        face_width=10.0,
        profile_shift=rng.uniform(-0.3, 0.5),
        helix_angle=rng.choice([0.0, 0.0, 15.0, -28.0]),
        rack=BasicRack(pressure_angle=angle),
        premachining=Premachining(**pre),
    )


def _trimmed(gear: Gear) -> bool:
    """Whether the cutter, as a notice says, cuts the tips of a ring, which are not in its outline."""
    return any(notice.code == "cutter-trims-tips" for notice in gear.notices)


def test_the_straight_flank_of_a_cutters_protuberance_is_a_piece_of_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tool_teeth, "_CUTTER_POINTS", 6000)
    monkeypatch.setattr(tool_sweep, "_BEARINGS", 6001)
    gear = Gear(
        teeth=-150,
        normal_module=1.0,
        helix_angle=15.0,
        face_width=10.0,
        profile_shift=-0.125,
        rack=BasicRack(pressure_angle=25.0),
        premachining=Premachining(
            tool_addendum=1.236,
            tool_tip_radius=0.1,
            stock=0.0155,
            protuberance=0.062,
            protuberance_angle=11.3,
            cutter_teeth=80,
            cutter_profile_shift=-0.135,
        ),
    )
    assert len([curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET]) == 2
    judge(gear)


@pytest.mark.long
@pytest.mark.parametrize("ring", [False, True])
def test_outlines_touch_cutters_with_any_protuberance(ring: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tool_teeth, "_CUTTER_POINTS", 12000)
    monkeypatch.setattr(tool_sweep, "_BEARINGS", 6001)
    rng, made = random.Random(17), {1: 0, 2: 0}
    while made[1] < 15 or (ring and made[2] < 8):
        try:
            gear = steep_cutter(rng, ring=ring)
        except InputError:
            continue
        pieces = len(gear.profile.root.pieces) if gear.profile.root else 0
        if made[pieces] < 15 and not _trimmed(gear):
            judge(gear)
            made[pieces] += 1


def test_a_refused_protuberance_is_cured_by_what_the_message_says() -> None:
    """Of tools that are refused for their protuberance those with less of what the message names cut the gear."""
    refused, rng = 0, random.Random(23)
    for number in range(700):
        state = rng.getstate()
        try:
            steep_cutter(rng, ring=bool(number % 2))
        except InputError as error:
            name = error.parameter.rpartition(".")[2]
            if name not in ("protuberance", "protuberance_angle") or "pressure angle" in error.permitted:
                continue
            refused += 1
            less = {
                "protuberance": lambda pre: 1.001 * pre["stock"],
                "protuberance_angle": lambda pre: pre["protuberance_angle"] / 3,
            }
            rng.setstate(state)
            try:
                steep_cutter(rng, ring=bool(number % 2), **{name: less[name]})
            except InputError as again:  # another key, which this one hid
                assert again.parameter != error.parameter
    assert 5 < refused < 40


def test_a_tool_that_is_off_by_a_micrometre_is_noticed() -> None:
    gear = gears_of("free", 1, seed=3)[0]
    off, made = distances(gear)
    points = geometry._tooth(gear)
    flank = made & (np.abs(points) > gear.form_diameter / 2 * 1.005)
    moved = geometry._finished(gear, points * np.exp(1e-3j / np.abs(points)), 0.0, 0.0)
    assert np.abs(moved[flank]).max() > 5e-4
    assert np.abs(off[flank]).max() < PERMITTED


def _hostile(rng: random.Random) -> Gear:
    """A gear of tools that mostly do not go together."""
    m, teeth = 10 ** rng.uniform(-1.0, 1.5), rng.choice([3, 8, 17, 60, 2000, -20, -120])
    pre = {"tool_addendum": rng.uniform(0.5, 2.0), "tool_tip_radius": rng.choice([0.0, 0.25, rng.uniform(0.0, 0.6)])}
    pre |= {"stock": rng.choice([0.0, "din3972-III", rng.uniform(0.0, 0.06) * m])}
    if rng.random() < 0.6:
        pre |= {"protuberance": rng.uniform(0.0, 0.06) * m, "protuberance_angle": rng.uniform(0.0, 15.0)}
    if rng.random() < 0.2:
        pre |= {"cutter_teeth": rng.choice([3, 10, 25, 60]), "cutter_profile_shift": rng.uniform(-1.0, 1.0)}
    finishing: dict[str, Any] = {"wheel_tip_radius": rng.choice([None, rng.uniform(0.001, 0.6) * m])}
    if rng.random() < 0.4:
        finishing |= {"kind": rng.choice(["generating", "form"]), "end_diameter": teeth * m * rng.uniform(0.85, 1.1)}
    return Gear(
        teeth=teeth,
        normal_module=m,
        face_width=5 * m,
        helix_angle=rng.choice([0.0, -30.0, 50.0]),
        profile_shift=rng.choice([0.0, 0.2, rng.uniform(-1.0, 1.2)]),
        rack=BasicRack(pressure_angle=rng.choice([20.0, 14.5, 8.0, 40.0])),
        premachining=Premachining(**pre),
        finishing=Finishing(**finishing),
    )


def test_tools_that_do_not_go_together_are_refused_in_one_line() -> None:
    """And what is not refused is one unbroken outline."""
    rng, made = random.Random(5), 0
    for _ in range(400):
        try:
            gear = _hostile(rng)
        except InputError as error:
            assert "\n" not in str(error)
            continue
        made += 1
        ends = [curve.points(np.array([0.0, 1.0])) for curve in gear.profile.curves]
        gaps = [float(np.hypot(*(after[0] - before[1]))) for before, after in pairwise(ends)]
        assert max(gaps) < 1e-6 * gear.normal_module, gear
    assert made > 20

"""Random gears, racks and pairs: shift diagrams, specific sliding, and data against what tools would cut and measure."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from support.commands import invoke
from support.ring_pairs import build_ring_pair, ring_pair_inputs
from support.samples import random_ring
from support.strategies import (
    build_gear,
    build_pair,
    build_rack,
    build_rack_pair,
    gear_inputs,
    pair_inputs,
    rack_inputs,
    rack_pair_inputs,
)

from gearcad import BasicRack, GearPair, Load, Material, Rack, RackPair, plots
from gearcad.core.errors import GeometryError, InputError, ParameterError, SpecError
from gearcad.core.records import Role
from gearcad.designs.reader import design_from_tables
from gearcad.geometry import Gear
from gearcad.rating.strength import rate_strength
from gearcad.report.strength import rate_html
from gearcad.sizing.geometry import Axis, Free, Limit, LimitKind, ShiftMap, gear_map, pair_map
from gearcad.verification.claims import Claim
from gearcad.verification.geometry import judge_gear, judge_pair, judge_rack

_ROUNDING = 1e-9
_SHIFTS = np.array([-0.93, -0.41, -0.07, 0.23, 0.61, 0.98, 1.37])
_HELIX = np.array([0.0, 7.3, 14.9, 22.1, 31.3])
_EXTREME = {"teeth", "root_diameter"}
"""At fault where undercut severs a tooth, which the map only calls undercut."""

Tables = dict[str, dict[str, Any]]

_SPUR: Tables = {"pair": {"normal_module": 2.0, "face_width": 10.0}, "pinion": {"teeth": 13}, "wheel": {"teeth": 29}}
_HELICAL: Tables = {
    "pair": {
        "normal_module": 3.0,
        "face_width": 20.0,
        "helix_angle": 17.0,
        "tooth_thinning": 0.06,
        "rack": {"root_radius": "full"},
    },
    "pinion": {"teeth": 17, "body": {"tip_chamfer": 0.2}, "rack": {"root_radius": "full"}},
    "wheel": {"teeth": 40, "rack": {"dedendum": 1.4}},
}
_PLAIN_TIPS: Tables = {
    "pair": {
        "normal_module": 2.0,
        "face_width": 10.0,
        "tip_alteration": 0.0,
        "rack": {"pressure_angle": 25.0, "root_radius": 0.2},
    },
    "pinion": {"teeth": 12},
    "wheel": {"teeth": 15, "tip_diameter": 33.5},
}
_AT: Tables = {
    "pair": {"normal_module": 4.0, "face_width": 30.0, "centre_distance": 100.0, "tooth_thinning": 0.05},
    "pinion": {"teeth": 15},
    "wheel": {"teeth": 33, "profile_shift": "auto"},
}


def _design(tables: Tables) -> Any:
    return design_from_tables(tables, where=lambda key: "spec", default_name="pair")


def _with(tables: Tables, values: dict[Free, float]) -> Tables:
    changed = {table: dict(content) for table, content in tables.items()}
    for free, value in values.items():
        table, _, key = ("pair.helix_angle" if free is Free.HELIX else free.value).partition(".")
        changed[table][key] = value
    return changed


def _at(limits: tuple[Limit, ...], kind: LimitKind, role: Role | None, place: tuple[int, int]) -> float:
    return next(float(each.values[place]) for each in limits if (each.kind, each.role) == (kind, role))


def _is_refused(found: ShiftMap, place: tuple[int, int]) -> bool:
    """Also where there is no mesh at all."""
    return any(not float(each.values[place]) > each.kind.refused for each in found.limits if each.kind.refused > -np.inf)


def _check(found: ShiftMap, tables: Tables) -> tuple[int, int]:
    """How many points make a pair, and how many are refused, all as the map says."""
    made = refused = 0
    for place in np.ndindex(found.up.values.size, found.across.values.size):
        values = {found.across.free: float(found.across.values[place[1]]), found.up.free: float(found.up.values[place[0]])}
        try:
            pair = _design(_with(tables, values)).pair
        except SpecError as error:
            undercut = any(_at(found.limits, LimitKind.UNDERCUT, role, place) < 0 for role in Role)
            assert _is_refused(found, place) or (undercut and error.key.rpartition(".")[2] in _EXTREME), (values, str(error))
            refused += 1
            continue
        assert not _is_refused(found, place), values
        _check_point(found.limits, pair, place)
        made += 1
    return made, refused


def _check_point(limits: tuple[Limit, ...], pair: Any, place: tuple[int, int]) -> None:
    m = pair.pinion.normal_module
    codes = [notice.code for notice in pair.notices]
    assert _at(limits, LimitKind.CONTACT_RATIO, None, place) == pytest.approx(pair.transverse_contact_ratio, abs=_ROUNDING)
    assert ("low-contact-ratio" in codes) == (_at(limits, LimitKind.CONTACT_RATIO, None, place) < 1)
    assert _at(limits, LimitKind.BACKLASH, None, place) * m == pytest.approx(pair.circumferential_backlash, abs=1e-8)
    for role, gear in pair.gears.items():
        of_gear = [notice.code for notice in gear.notices]
        assert ("undercut" in of_gear) == (_at(limits, LimitKind.UNDERCUT, role, place) < 0)
        assert _at(limits, LimitKind.TIP, role, place) * m == pytest.approx(gear.tip_thickness, abs=_ROUNDING)
        assert ("thin-tip" in of_gear) == (_at(limits, LimitKind.TIP, role, place) < LimitKind.TIP.warned)
        assert _at(limits, LimitKind.CLEARANCE, role, place) * m == pytest.approx(pair.tip_clearances.pick(role), abs=_ROUNDING)
        if not gear.undercut:
            below = gear.form_diameter > pair.active_root_diameters.pick(role) + _ROUNDING
            assert below == (_at(limits, LimitKind.INTERFERENCE, role, place) < -_ROUNDING)


@pytest.mark.parametrize(("tables", "auto_tips"), [(_SPUR, True), (_HELICAL, True), (_PLAIN_TIPS, False)])
def test_shifts_of_both_gears(tables: Tables, auto_tips: bool) -> None:
    axes = Axis(Free.FIRST, _SHIFTS), Axis(Free.SECOND, _SHIFTS + 0.013)
    found = pair_map(_design(tables).pair, *axes, rest=None, distance=False, auto_tips=auto_tips)
    made, refused = _check(found, tables)
    assert made > 20
    assert refused >= 5


def test_shifts_at_a_centre_distance_with_backlash() -> None:
    tables = _with(_AT, {Free.SECOND: 0.1})
    axes = Axis(Free.FIRST, _SHIFTS), Axis(Free.SECOND, _SHIFTS + 0.013)
    found = pair_map(_design(tables).pair, *axes, rest=None, distance=True, auto_tips=True)
    made, refused = _check(found, tables)
    assert made > 10
    assert refused > 10


def test_shift_and_helix_at_a_centre_distance() -> None:
    axes = Axis(Free.FIRST, _SHIFTS), Axis(Free.HELIX, _HELIX)
    found = pair_map(_design(_AT).pair, *axes, rest=Role.WHEEL, distance=True, auto_tips=True)
    made, refused = _check(found, _AT)
    assert made > 10
    assert refused > 3


def test_a_single_gear_over_its_teeth() -> None:
    teeth = np.array([7.0, 9.0, 12.0, 17.0, 25.0, 60.0])
    found = gear_map(Gear(teeth=20, normal_module=2.0, face_width=10.0, helix_angle=-12.0), teeth, _SHIFTS)
    _, undercut, tip = (each.values for each in found.limits)
    for row, column in np.ndindex(undercut.shape):
        wanted: dict[str, Any] = {"teeth": int(teeth[column]), "profile_shift": float(_SHIFTS[row])}
        try:
            gear = Gear(normal_module=2.0, face_width=10.0, helix_angle=-12.0, **wanted)
        except (ParameterError, GeometryError):
            assert tip[row, column] <= 0 or undercut[row, column] < 0
            continue
        assert gear.undercut == (undercut[row, column] < 0)
        assert gear.tip_thickness == pytest.approx(2 * tip[row, column], abs=_ROUNDING)


def test_rings_and_shaped_gears_have_no_map() -> None:
    ring = Gear(teeth=-60, normal_module=2.0, face_width=10.0)
    with pytest.raises(ParameterError, match="external gear from a hob"):
        gear_map(ring, np.array([60.0]), _SHIFTS)


EXACT = 1e-9
"""Relative: the same velocities by two ways."""

PAIRS = {
    "spur": GearPair(
        pinion=Gear(teeth=17, normal_module=2, face_width=20, profile_shift=0.3),
        wheel=Gear(teeth=43, normal_module=2, face_width=20),
    ),
    "helical": GearPair(
        pinion=Gear(teeth=21, normal_module=3, face_width=30, helix_angle=25, profile_shift=0.2),
        wheel=Gear(teeth=50, normal_module=3, face_width=30, helix_angle=-25, profile_shift=-0.1),
    ),
    "ring": GearPair(
        pinion=Gear(teeth=22, normal_module=2, face_width=20, profile_shift=0.3, rack=BasicRack(addendum=0.8)),
        wheel=Gear(teeth=-70, normal_module=2, face_width=20, profile_shift=-0.3, rack=BasicRack(addendum=0.8)),
    ),
}


def sliding_by_velocities(
    distance: float, base_radius: float, angle: float, centre: float, ratio: float
) -> tuple[float, float]:
    """zeta of pinion and wheel where they touch `distance` (mm) from T1: (v_own - v_mate)/v_own along the common tangent.

    The pinion turns at 1 rad/s about the origin, the wheel at 1/`ratio` the other way about (centre, 0), signs as of rings.
    """
    normal, tangent = np.array([math.sin(angle), math.cos(angle)]), np.array([-math.cos(angle), math.sin(angle)])
    point = base_radius * np.array([math.cos(angle), -math.sin(angle)]) + distance * normal
    x, y = point
    pinion = np.array([-y, x]) @ tangent
    wheel = -np.array([-y, x - centre]) @ tangent / ratio
    assert np.array([-y, x]) @ normal == pytest.approx(-np.array([-y, x - centre]) @ normal / ratio)  # they stay in contact
    return (pinion - wheel) / pinion, (wheel - pinion) / wheel


@pytest.mark.parametrize("name", PAIRS)
def test_specific_sliding_is_that_of_velocities(name: str) -> None:
    pair = PAIRS[name]
    path, (first, last) = pair.path_of_contact, pair.usable_path
    places = np.array([first, path.B, path.D, last, 0.4 * first + 0.6 * last])
    found = np.transpose(pair.specific_sliding_at(places))
    angle, ratio = math.radians(pair.working_transverse_pressure_angle), pair.wheel.teeth / pair.pinion.teeth
    for place, zeta in zip(places, found, strict=True):
        by_hand = sliding_by_velocities(place, pair.pinion.base_diameter / 2, angle, pair.centre_distance, ratio)
        assert zeta == pytest.approx(by_hand, rel=EXACT)
    told = pair.specific_sliding
    assert (told.pinion_A, told.wheel_A) == pytest.approx(tuple(found[0]), rel=EXACT)
    assert (told.pinion_E, told.wheel_E) == pytest.approx(tuple(found[3]), rel=EXACT)
    assert told.greatest == pytest.approx(np.abs(found[[0, 3]]).max(), rel=EXACT)
    assert np.transpose(pair.specific_sliding_at(path.C)) == pytest.approx(np.zeros((1, 2)), abs=EXACT)


def test_a_rack_slides_as_a_wheel_of_very_many_teeth() -> None:
    pinion = Gear(teeth=20, normal_module=2, face_width=20)
    rack = RackPair(pinion=pinion, rack=Rack(teeth=20, normal_module=2, face_width=20, height=20))
    wheels = (GearPair(pinion=pinion, wheel=Gear(teeth=teeth, normal_module=2, face_width=20)) for teeth in (1000, 2000))
    places = np.linspace(*rack.usable_path, 7)
    nearer, near = (np.array(wheel.specific_sliding_at(places)) for wheel in wheels)
    # What is left is in proportion to 1/z: with it taken off, to its square.
    assert np.array(rack.specific_sliding_at(places)) == pytest.approx(2 * near - nearer, abs=1e-3)


def test_a_contact_that_begins_at_the_base_circle_slides_without_limit() -> None:
    """There the pinion's flank stands still: zeta of the pinion has no finite value, and JSON has null."""
    pair = GearPair(pinion=Gear(teeth=18, normal_module=2, face_width=9), wheel=Gear(teeth=18, normal_module=2, face_width=9))
    ((own, _),) = np.transpose(pair.specific_sliding_at(0.0))
    assert math.isinf(own)


def test_the_data_sheet_has_it(tmp_path: Path) -> None:
    spec = str(tmp_path / "reducer.toml")
    invoke("new", "reducer", "-o", spec)
    shown = invoke("data", spec).stdout
    told = json.loads(invoke("data", spec, "--json").stdout)["pair"]["specific_sliding"]
    assert "specific sliding at A, pinion" in shown and "ζ_A1" in shown
    assert told["greatest"] == max(abs(value) for key, value in told.items() if key != "greatest")


@pytest.mark.parametrize("name", PAIRS)
def test_data_have_it_along_the_path(name: str) -> None:
    pair = PAIRS[name]
    document = pair.to_dict()
    along, ends = document["specific_sliding_path"], document["specific_sliding"]
    assert (along["distance"][0], along["distance"][-1]) == pair.usable_path
    assert along["pinion"] == pytest.approx(list(pair.specific_sliding_at(along["distance"]).pinion), rel=EXACT)
    assert (along["pinion"][0], along["wheel"][-1]) == pytest.approx((ends["pinion_A"], ends["wheel_E"]), rel=EXACT)


def test_the_report_of_a_rating_draws_it() -> None:
    page = rate_html(rate_strength(PAIRS["spur"], Material(), Load(torque=10.0)), "spur")
    assert "Specific sliding along the path of contact" in page
    greatest = PAIRS["spur"].specific_sliding.greatest
    assert greatest is not None and f"The greatest is {greatest:.4g}" in page


def test_it_is_drawn_along_the_path() -> None:
    pair = PAIRS["spur"]
    pinion, wheel, *_ = plots.plot_sliding(pair).get_lines()
    assert pinion.get_ydata()[0] == pytest.approx(pair.specific_sliding.pinion_A)
    assert wheel.get_ydata()[-1] == pytest.approx(pair.specific_sliding.wheel_E)


JUDGES: dict[str, tuple[Any, Any, Any]] = {
    "gear": (gear_inputs(), build_gear, lambda gear: judge_gear(gear, "gear", sections=2)),
    "rack": (rack_inputs(), build_rack, lambda rack: judge_rack(rack, "rack")),
    "pair": (pair_inputs(), build_pair, lambda pair: judge_pair(pair, "pair")),
    "rack pair": (rack_pair_inputs(), build_rack_pair, lambda pair: judge_pair(pair, "pair")),
    "ring pair": (ring_pair_inputs(), build_ring_pair, lambda data: judge_ring_pair(data)),
}


def judge_ring_pair(data: Any) -> list[Claim]:
    """The claims on a pair of a drawn pinion and ring; raises InputError where they do not run together."""
    return list(judge_pair(GearPair(pinion=data.pinion, wheel=data.wheel, centre_distance=data.centre_distance), "pair"))


def check(inputs: dict[str, Any], kind: str) -> None:
    _, build, judge = JUDGES[kind]
    try:
        claims = list(judge(build(inputs)))
    except InputError:
        event("refused")
        return
    for claim in claims:
        event(f"{claim.quantity}: {claim.passed}")
    # Root circles that are given far out can hold a ball off the flanks: the judge is right, and says so.
    assert not [claim for claim in claims if claim.passed is False]


@settings(max_examples=12)
@given(gear_inputs())
def test_what_is_told_of_a_few_gears_is_found(inputs: dict[str, Any]) -> None:
    check(inputs, "gear")


@settings(max_examples=12)
@given(pair_inputs())
def test_what_is_told_of_a_few_pairs_is_found(inputs: dict[str, Any]) -> None:
    check(inputs, "pair")


@pytest.mark.long
@pytest.mark.parametrize("kind", JUDGES)
def test_what_is_told_of_many_is_found(kind: str) -> None:
    @settings(max_examples=600, deadline=None)
    @given(JUDGES[kind][0])
    def many(inputs: dict[str, Any]) -> None:
        check(inputs, kind)

    many()


@pytest.mark.long
def test_what_is_told_of_a_hundred_rings_is_found() -> None:
    rng = np.random.default_rng(37)
    for _ in range(100):
        ring = random_ring(rng)
        assert not [claim for claim in judge_gear(ring, "ring", sections=2) if claim.passed is False], ring

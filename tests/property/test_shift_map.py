"""Shift diagrams against exact gears: at points of their grids specs are read, and make, warn or refuse as the map says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcad.core.errors import GeometryError, ParameterError, SpecError
from gearcad.core.records import Role
from gearcad.designs.reader import design_from_tables
from gearcad.geometry import Gear
from gearcad.sizing.geometry import Axis, Free, Limit, LimitKind, ShiftMap, gear_map, pair_map

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

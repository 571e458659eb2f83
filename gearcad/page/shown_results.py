"""Data that the page shows of a run: a check's stresses over the teeth and the mesh cycle, dynamic factors over speed.

It is made in the process of the run, from its result and its document, and read as JSON by the page. A pair of teeth is at a
place: its roll length on the pinion (mm from T1) where it touches, whatever tooth it is. Heights and roll lengths in mm.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.check.result import CheckResult, PlaneCheck, SolidCheck
from gearcad.contact.plane.cycle import tooth_loads as plane_loads
from gearcad.contact.plane.flank import seen_from
from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE, TOOTH_ORDER
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.cycle import tooth_loads as solid_loads
from gearcad.core.records import Floats, JsonObject, Role, Wholes
from gearcad.geometry.gear_data import section_turn
from gearcad.meshing.outline import OutlineSide

FILE = ".shown.json"
"""Name of the file in the folder of a run. It is no result for the user: `files` of the run do not name it."""

_MOST_ROOT = 24
"""Points along a fillet that are sent: each has the greatest stress of its neighbours."""

_ROLL_ROWS = 48
"""Rows of the pattern of contact over the roll length."""

_DIGITS = 4
"""Decimals of lengths (mm) that are sent."""


def write_shown(content: JsonObject, folder: Path) -> None:
    """Write what the page shows of a run into the folder of the run."""
    (folder / FILE).write_text(json.dumps(content, allow_nan=False), encoding="utf-8", newline="\n")


def read_shown(folder: Path) -> JsonObject | None:
    """Return what the page shows of a run; None if its folder has nothing of the kind."""
    try:
        found: JsonObject = json.loads((folder / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found


def shown_check(result: CheckResult, document: Mapping[str, Any]) -> JsonObject:
    """Return what the page shows of a check: curves of check.json, stresses over places, flanks and fillets."""
    cycle, pair = result.cycle, result.pair
    model = cycle.model
    rolls, pressures = _pattern(result)
    content: JsonObject = {
        "kind": "check",
        "model": result.model.value,
        "torque": result.torque,
        "side": 1 if result.torque > 0 else -1,
        "curves": document["mesh_cycle"],
        "summary": {key: document["summary"].get(key) for key in _SUMMARY},
        "base": model.base_radius,
        "pitch_point": pair.path_of_contact.C,
        "base_pitch": pair.pinion.transverse_base_pitch,
        "contacts": _contacts(result),
        "flanks": {role.value: _over_radius(result, role, rolls, pressures) for role in Role},
        "roots": {role.value: _roots(result, role) for role in Role},
        "pattern": {
            "across": _rounded(_across(result)),
            "pinion": _rounded(rolls),
            "wheel": _rounded(model.line.whole - rolls),
            "pressure": _with_gaps(pressures),
        },
        "teeth": {},
    }
    if isinstance(result, SolidCheck):
        content["teeth"] = {role.value: _tooth(result, role, rolls, pressures) for role in Role}
    return content


_SUMMARY = ("contact_pressure", "root_tension_pinion", "root_tension_wheel", "transmission_error_peak_to_peak")
"""Figures of the summary that are told beside the pictures."""


def _contacts(result: CheckResult) -> dict[str, list[Any]]:
    """Pressures (MPa) and shares of the load of a pair of teeth by its places (n,), as check.json has them by positions."""
    rows = sorted(
        (contact.place, contact.interior_pressure, contact.share)
        for position in result.cycle.positions
        for contact in position.contacts
    )
    places, pressures, shares = zip(*rows, strict=True)
    return {"place": _rounded(np.array(places)), "pressure": [*pressures], "share": [*shares]}


def _across(result: CheckResult) -> Floats:
    """Places (n,) of the columns of the pattern, from the middle of the common face width."""
    if isinstance(result.cycle, SolidCycle):
        across: Floats = result.cycle.load_along_face[0]
        return across
    return np.array([0.0])


def _pattern(result: CheckResult) -> tuple[Floats, Floats]:
    """Roll lengths (n,) on the pinion, and the greatest pressure of the cycle there in MPa (n, across), NaN without contact.

    A section has one column: its pressure is the same over the face width.
    """
    if isinstance(result.cycle, SolidCycle):
        cells = [
            (contact.line.places.pinion[0], contact.line.across, contact.pressures)
            for position in result.cycle.positions
            for contact in position.contacts
        ]
        roll, across, pressure = (np.concatenate(each) for each in zip(*cells, strict=True))
        loaded = pressure > 0
        roll, across, pressure = roll[loaded], across[loaded], pressure[loaded]
    else:
        rows = [
            (contact.place, 0.0, contact.interior_pressure)
            for position in result.cycle.positions
            for contact in position.contacts
            if contact.interior_pressure is not None
        ]
        roll, across, pressure = np.array(rows).reshape(-1, 3).T
    columns = _across(result)
    edges = np.linspace(roll.min(), roll.max() + 1e-9, _ROLL_ROWS + 1)
    found = np.full((_ROLL_ROWS, len(columns)), -np.inf)
    row = np.clip(np.searchsorted(edges, roll, side="right") - 1, 0, _ROLL_ROWS - 1)
    column = np.abs(across[:, None] - columns).argmin(axis=1)
    np.maximum.at(found, (row, column), pressure)
    return (edges[1:] + edges[:-1]) / 2, _filled(np.where(np.isfinite(found), found, np.nan))


def _filled(pattern: Floats) -> Floats:
    """Fill rows that no position met, between rows of the same column that were met."""
    for column in pattern.T:
        known = np.flatnonzero(~np.isnan(column))
        if len(known):
            inside = np.arange(known[0], known[-1] + 1)
            column[inside] = np.interp(inside, known, column[known])
    return pattern


def _over_radius(result: CheckResult, role: Role, rolls: Floats, pressures: Floats) -> dict[str, list[Any]]:
    """Radii (n,) of a gear, rising, and the greatest pressure (MPa) of all the face width when a contact passes there."""
    length = rolls if role is Role.PINION else result.cycle.model.line.whole - rolls
    known = ~np.isnan(pressures).all(axis=1)
    radii, greatest = result.cycle.model.bodies.pick(role).flank.radii(length[known]), np.nanmax(pressures[known], axis=1)
    order = np.argsort(radii)
    return {"radius": _rounded(radii[order]), "pressure": np.round(greatest[order], 1).tolist()}


def _roots(result: CheckResult, role: Role) -> JsonObject:
    """Stress (MPa) along the fillet below the loaded flank, (places, radii), by the place of the pair of teeth."""
    model, pitch = result.cycle.model, result.pair.pinion.transverse_base_pitch
    rows, radii = [], np.zeros(0)
    for position in result.cycle.positions:
        teeth = [contact.tooth for contact in position.contacts]
        for tooth in range(min(teeth) - 1, max(teeth) + 2):
            radii, stress = _fillet(result, position, role, tooth)
            rows.append((model.roll_length(position.roll_angle) + tooth * pitch, stress))
    rows.sort(key=lambda row: row[0])
    groups = np.array_split(np.argsort(radii), min(_MOST_ROOT, len(radii)))
    return {
        "radius": _rounded(np.array([radii[group].mean() for group in groups])),
        "place": _rounded(np.array([place for place, _ in rows])),
        "stress": [[round(float(stress[group].max()), 1) for group in groups] for _, stress in rows],
    }


def _fillet(result: CheckResult, position: Any, role: Role, tooth: int) -> tuple[Floats, Floats]:
    """Radii (n,) of the root, and its greatest tension (n,) in MPa on a tooth of the pinion's count."""
    own = tooth * TOOTH_ORDER.pick(role)
    if isinstance(result, PlaneCheck):
        fillets = result.cycle.model.fillets.pick(role)
        radii, angles = fillets.places(OutlineSide.LEFT_FILLET)
        stress = fillets.stresses(OutlineSide.LEFT_FILLET, seen_from(own, plane_loads(position.contacts, role)))
        return radii[angles >= LEAST_TANGENT_ANGLE], stress[angles >= LEAST_TANGENT_ANGLE]
    solid: Any = result.cycle.model
    fillet = solid.fillets.pick(role).loaded
    loads = [(other - own, forces) for other, forces in solid_loads(solid, position.contacts, role)]
    between = fillet.along_face @ fillet.state(loads).greater[:, fillet.is_root] @ fillet.along_root.T
    return fillet.along_root @ fillet.radii[fillet.is_root], between.max(axis=0)


def _tooth(result: SolidCheck, role: Role, rolls: Floats, pressures: Floats) -> JsonObject:
    """Surfaces of tooth 0 of a gear: von Mises stress of the most stressed tooth, and the pressure on its flank."""
    stress = result.tooth_stresses.pick(role)
    field = stress.field
    faces = field.surface
    used, index = np.unique(faces[:, :4], return_inverse=True)
    corners = index.reshape(-1, 4)
    triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    mirrored = np.array([1.0, 1.0 if result.torque > 0 else -1.0, 1.0])
    gear = result.task.gears[role]
    outside = _above_root(field.points[used], gear.profile.root_diameter / 2, gear.internal)
    return {
        "stress": _surface(field.points[used] * mirrored, triangles[outside[triangles].all(axis=1)], field.von_mises[used])
        | {"most": stress.end},
        "pressure": _flank_surface(result, role, rolls, pressures, mirrored),
    }


def _above_root(points: Floats, root: float, internal: bool) -> Any:
    """Points (n,) of the tooth, not of the body below it (mask)."""
    radius = np.hypot(points[:, 0], points[:, 1])
    return radius < root * 1.0005 if internal else radius > root * 0.9995


def _flank_surface(result: SolidCheck, role: Role, rolls: Floats, pressures: Floats, mirrored: Floats) -> JsonObject:
    """The flank of tooth 0 as far as it touches: pressure (MPa) at rolls and places across the common width."""
    model, gear = result.cycle.model, result.task.gears[role]
    known = ~np.isnan(pressures)
    rows = np.flatnonzero(known.any(axis=1))
    length = rolls if role is Role.PINION else model.line.whole - rolls
    radius, angle = model.bodies.pick(role).flank.polar(length[rows])
    low, high = model.common_heights(role)
    heights = _across(result) + (low + high) / 2
    signs = -1 if gear.internal else 1
    turned = signs * angle[:, None] + section_turn(_loaded_left(result, role), heights)[None]
    points = np.stack(
        [radius[:, None] * np.cos(turned), radius[:, None] * np.sin(turned), np.broadcast_to(heights, turned.shape)], axis=-1
    )
    count, across = turned.shape
    first = (np.arange(count - 1)[:, None] * across + np.arange(across - 1)).ravel()
    quads = np.stack([first, first + 1, first + across + 1, first + across], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    values, inside = pressures[rows].ravel(), known[rows].ravel()
    return _surface(points.reshape(-1, 3) * mirrored, triangles[inside[triangles].all(axis=1)], np.nan_to_num(values))


def _loaded_left(result: SolidCheck, role: Role) -> Any:
    """The gear of the cycle, whose left flanks carry: the mirror image under a negative torque."""
    return result.cycle.model.bodies.pick(role).flank.gear


def _surface(points: Floats, triangles: Wholes, values: Floats) -> JsonObject:
    """Points (n, 3) in mm, triangles (m, 3) and values (n,) in MPa, flat; points without a triangle are left out."""
    used, index = np.unique(triangles, return_inverse=True)
    return {
        "points": np.round(points[used], _DIGITS).ravel().tolist(),
        "triangles": index.ravel().tolist(),
        "values": np.round(values[used], 1).tolist(),
    }


def _rounded(values: Floats) -> list[float]:
    found: list[float] = np.round(values, _DIGITS).tolist()
    return found


def _with_gaps(values: Floats) -> list[list[float | None]]:
    """Return values (n, m) with None where there is none."""
    return [[None if math.isnan(value) else round(value, 1) for value in row] for row in values.tolist()]


def shown_dynamics(_result: object, document: Mapping[str, Any]) -> JsonObject | None:
    """Return dynamic factors over speed (rpm), running up and down, and those at the operating point; None without a chart."""
    chart, down = document.get("chart"), document.get("chart_down")
    if not chart or not chart.get("kv"):
        return None
    course = document.get("course") or {}
    return {
        "kind": "dynamics",
        "speed": document["speed"],
        "kv": chart["kv"],
        "kv_down": down["kv"] if down else {},
        "kv_iso6336": chart.get("kv_iso6336"),
        "operating": {"speed": course.get("speed"), "kv": dict(zip(chart["kv"], course.get("kv") or (), strict=False))},
    }

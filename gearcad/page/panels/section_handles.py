"""Handles of inputs in the section: gears that can be drawn there, the circles and lines that the hand moves, and their keys.

Found without NiceGUI. Lengths in mm, angles in radians; a body is the number of a gear in the section.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from gearcad.core.records import JsonObject, Role
from gearcad.designs.design import Design
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.designs.keys import OF_SETS
from gearcad.designs.pair_designs import PairDesign, RackPairDesign
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.train_designs import TrainDesign
from gearcad.geometry import Gear, GearPair
from gearcad.page.panels.drawn_data import layout_of, plain, ratios_of, stands_of
from gearcad.page.section_measures import LARGEST
from gearcad.solids.train_plan import stage_keys

_DIGITS = {"tip_diameter": 3, "profile_shift": 4, "centre_distance": 3, "mounting_distance": 3, "tip_alteration": 4}
"""Decimals of what is drawn, by the last part of its key."""


class SectionGear(NamedTuple):
    """A gear of the section: its name, the number of the body that shows it, and its table in the spec ("" where it has none).

    A handle can write only into a table.
    """

    name: str
    gear: Gear
    body: int
    table: str


def section_gears(design: Design, tables: Mapping[str, Any]) -> tuple[SectionGear, ...]:
    """Return the gears that can be drawn or measured in the section; `tables` are those of the spec of the design."""
    if isinstance(design, PlanetaryDesign):
        return tuple(_gears_of_set(design, tables))
    if isinstance(design, PairDesign | RackPairDesign):
        return tuple(SectionGear(name, gear, body, name) for body, (name, gear) in enumerate(design.gears.items()))
    if isinstance(design, TrainDesign) and (stands := stands_of(design)) is not None:
        return tuple(SectionGear(each.name, each.gear, body, "") for body, each in enumerate(stands.gears))
    if isinstance(design, ToothedDesign) and (gear := design.gears.get("gear")) is not None and len(design.gears) == 1:
        return (SectionGear("gear", gear, 0, "gear"),)
    return ()


def _gears_of_set(design: PlanetaryDesign, tables: Mapping[str, Any]) -> Iterator[SectionGear]:
    """Yield each gear of a train once, with the first body that shows it."""
    bodies: dict[str, int] = {}
    for body, standing in enumerate(layout_of(design).standing):
        bodies.setdefault(standing.body.key, body)
    written = {_name_in(tables, table, table): table for table in OF_SETS if isinstance(tables.get(table), Mapping)}
    train = design.train
    gears = {each.name: each.gear for each in train.centrals} | {each.name: each.gear for each in train.rims}
    for name, gear in gears.items():
        yield SectionGear(name, gear, bodies[name], written.get(name, ""))
    stages = zip(train.stages, stage_keys(train), strict=True)
    for number, (stage, keys) in enumerate(stages):
        is_written = number == 0 and isinstance(_part(tables, _PRE_STAGE), Mapping)
        for role, gear in stage.pair.gears.items():
            key = keys.pick(role)
            yield SectionGear(key, gear, bodies[key], f"{_PRE_STAGE}.{role.value}" if is_written else "")


_PRE_STAGE = "planetary.pre_stage"
"""Table of the pair before a planetary set."""


def _part(tables: Mapping[str, Any], key: str) -> Any:
    """Return the value of nested tables under a dotted key; None where there is none."""
    inner: Any = tables
    for part in key.split("."):
        inner = inner.get(part) if isinstance(inner, Mapping) else None
    return inner


def _name_in(tables: Mapping[str, Any], table: str, default: str) -> str:
    name = _part(tables, f"{table}.name")
    return name if isinstance(name, str) else default


def handles_of(design: Design, tables: Mapping[str, Any], gear: int | None = None) -> list[JsonObject]:
    """Return handles: key of the spec, body, value, and the circle (mm), line or centre that the hand moves.

    They are those of one gear by its number, and of the distances of its meshes; of all gears without a number.
    """
    gears = section_gears(design, tables)
    several = len(gears) > 1 or isinstance(design, RackPairDesign)
    found: list[JsonObject] = []
    for number, each in enumerate(gears):
        if each.table and gear in (None, number):
            mark = str(number + 1) if several else ""
            found += _handles_of_gear(each, mark)
    if isinstance(design, PairDesign):
        found.append(_distance_of_pair(design.pair))
    elif isinstance(design, RackPairDesign):
        found += _handles_of_rack(design)
    elif isinstance(design, PlanetaryDesign):
        found += _distances_of_set(design, gears, gear)
    return list(map(plain, found))


def _handles_of_gear(section_gear: SectionGear, mark: str) -> Iterator[JsonObject]:
    """Yield the handles of a gear's tip circle and profile shift; `mark` is the subscript of its symbols."""
    gear = section_gear.gear
    sign, reference = (-1 if gear.internal else 1), abs(gear.reference_diameter) / 2
    own = {"body": section_gear.body, "shape": "circle"}
    yield {
        "key": f"{section_gear.table}.tip_diameter",
        "kind": "tip_diameter",
        **own,
        "symbol": f"d_a{mark}",
        "value": float(gear.tip_diameter),
        "radius": abs(gear.tip_diameter) / 2,
        "zero": 0.0,
        "factor": 2.0 * sign,
        "unit": "mm",
    }
    yield {
        "key": f"{section_gear.table}.profile_shift",
        "kind": "profile_shift",
        **own,
        "symbol": f"x{mark}",
        "value": float(gear.profile_shift),
        "radius": reference + sign * gear.profile_shift * gear.normal_module,
        "zero": reference,
        "factor": sign / gear.normal_module,
        "unit": "",
    }


def _distance_handle(
    key: str, distance: float, radius: float, place: complex, *, body: int, direction: float = 0.0, orbit: float = 0.0
) -> JsonObject:
    """Return the handle of a centre distance, drawn at a place (mm) and moved in a direction (rad).

    `body` is `radius` (mm) away from its mate, in that direction. Both go round by `orbit` while the first gear turns by 1 rad.
    """
    return {
        "key": key,
        "kind": "centre_distance",
        "body": body,
        "shape": "centre",
        "place": [place.real, place.imag],
        "direction": direction,
        "orbit": orbit,
        "symbol": "a",
        "value": float(distance),
        "radius": radius,
        "zero": 0.0,
        "factor": math.copysign(1.0, distance * radius),
        "unit": "mm",
    }


def _distance_of_pair(pair: GearPair) -> JsonObject:
    pitch_point = complex(pair.pinion.base_diameter / 2 / math.cos(math.radians(pair.working_transverse_pressure_angle)))
    return _distance_handle("pair.centre_distance", pair.centre_distance, pair.wheel_pose().x, pitch_point, body=1)


def _handles_of_rack(design: RackPairDesign) -> Iterator[JsonObject]:
    """Yield the handles of the rack: its reference line at the mounting distance, and its tip line; both cross +x."""
    pair, rack = design.pair, design.pair.rack
    place = pair.rack_pose().x
    own = {"body": 1, "shape": "line", "direction": 0.0, "orbit": 0.0}
    tip = place - rack.tip_height
    yield {
        "key": "pair.mounting_distance",
        "kind": "mounting_distance",
        **own,
        "place": [place, 0.0],
        "symbol": "H",
        "value": float(pair.mounting_distance),
        "radius": place,
        "zero": place - pair.mounting_distance,
        "factor": 1.0,
        "unit": "mm",
    }
    yield {
        "key": "rack.tip_alteration",
        "kind": "tip_alteration",
        **own,
        "place": [tip, 0.0],
        "symbol": "k2",
        "value": float(rack.tip_alteration),
        "radius": tip,
        "zero": tip + rack.tip_alteration * rack.normal_module,
        "factor": -1.0 / rack.normal_module,
        "unit": "",
    }


def _distances_of_set(design: PlanetaryDesign, gears: Sequence[SectionGear], gear: int | None) -> Iterator[JsonObject]:
    """Yield the handle of the planets' distance, or, for a gear of the pair before the set, that of this pair."""
    layout, train = layout_of(design), design.train
    chosen = gears[gear].table if gear is not None and gear < len(gears) else ""
    of_stage = {each.table.rpartition(".")[2]: each for each in gears if each.table.startswith(_PRE_STAGE)}
    if not chosen.startswith(_PRE_STAGE):
        mesh, planet = train.meshes[0], layout.planets[0][0]
        centre, away = complex(planet.axle.x, planet.axle.y), math.atan2(planet.axle.y, planet.axle.x)
        pitch = abs(mesh.pair.working_pitch_diameters.pick(mesh.central_role)) / 2
        orbit = ratios_of(design, layout)[layout.carrier.name]
        body = next(each.body for each in gears if each.name == train.rims[0].name)
        key, point = "planetary.centre_distance", cmath.rect(pitch, away)
        distance = float(train.centre_distance)
        yield _distance_handle(key, distance, abs(centre), point, body=body, direction=away, orbit=orbit)
    if of_stage and (gear is None or chosen.startswith(_PRE_STAGE)):
        pair, standing = train.stages[0].pair, [*layout.standing]
        pinion, wheel = (standing[of_stage[role.value].body].axle for role in Role)
        between = complex(pinion.x - wheel.x, pinion.y - wheel.y)
        direction, pitch = cmath.phase(between), pair.working_pitch_diameters.wheel / 2
        point = complex(wheel.x, wheel.y) + cmath.rect(pitch, direction)
        key, body = f"{_PRE_STAGE}.centre_distance", of_stage["pinion"].body
        yield _distance_handle(key, pair.centre_distance, abs(between), point, body=body, direction=direction)


def drawn_text(design: Design, tables: Mapping[str, Any], key: str, value: Any) -> dict[str, str]:
    """Return what was drawn as it would be typed under its key; nothing for other keys, and for what is no number."""
    if key not in {handle["key"] for handle in handles_of(design, tables)}:
        return {}
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < LARGEST:
        return {}
    return {key: f"{round(float(value), _DIGITS[key.rpartition('.')[2]]) + 0.0:.12g}"}

"""How a train is built: its gears, their meshes, and the conditions of its assembly, as tables."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.geometry import Gear, GearPair
from gearcad.per_gear import Role
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.clearances import least_gap
from gearcad.plots.paper import short
from gearcad.plots.planetary.parts import stage_gear
from gearcad.report.check.tables import Row
from gearcad.report.dynamics.tables import WordTable

__all__ = ["assembly_rows", "gear_table", "mesh_table"]

_LISTED = 6
"""Most angles that have room in a line."""


def gear_table(train: PlanetaryTrain) -> WordTable:
    """All gears with their signs: the set's, then those of stages."""
    heads = ("gear", "", "z", "m_n, mm", "β, °", "x", "b, mm", "d, mm", "d_b, mm", "d_a, mm", "d_f, mm")
    rows = [(name, what, *_gear(gear)) for name, what, gear in _gears(train)]
    return WordTable(heads, rows, 2)


def _gears(train: PlanetaryTrain) -> Iterator[tuple[str, str, Gear]]:
    for central in train.centrals:
        yield central.name, "ring" if central.gear.internal else "sun", central.gear
    for rim in train.rims:
        yield rim.name, f"planet, {train.planets} of them" if train.planets > 1 else "planet", rim.gear
    for stage in train.stages:
        for role, shaft in ((Role.PINION, stage.pinion), (Role.WHEEL, stage.wheel)):
            yield stage_gear(stage, role), f"{stage.name}, turns with {shaft}", stage.pair.gears.pick(role)


def _gear(gear: Gear) -> tuple[str, ...]:
    diameters = (gear.reference_diameter, gear.base_diameter, gear.tip_diameter, gear.root_diameter)
    numbers = (gear.normal_module, gear.helix_angle, gear.profile_shift, gear.face_width, *diameters)
    return (str(gear.teeth), *map(short, numbers))


def mesh_table(train: PlanetaryTrain) -> WordTable:
    """All pairs that mesh; centre distances are signed, those of rings below 0."""
    heads = (
        "mesh",
        "z",
        "a, mm",
        "without backlash, mm",
        "Σx",
        "α_wt, °",
        "ε_α",
        "ε_β",
        "backlash j_wt, mm",
    )
    rows = [_mesh(mesh.name, (mesh.central.gear, mesh.rim.gear), mesh.pair) for mesh in train.meshes]
    rows += [_mesh(stage.name, (stage.pair.pinion, stage.pair.wheel), stage.pair) for stage in train.stages]
    return WordTable(heads, rows, 2)


def _mesh(name: str, gears: tuple[Gear, Gear], pair: GearPair) -> tuple[str, ...]:
    """A row; the teeth of the gears in the order of their names in that of the mesh."""
    numbers = (
        pair.centre_distance,
        pair.centre_distance_for(pair.profile_shift_sum),
        pair.profile_shift_sum,
        pair.working_transverse_pressure_angle,
        pair.transverse_contact_ratio,
        pair.overlap_ratio,
        _rounded(pair.circumferential_backlash),
    )
    return (name, " / ".join(str(gear.teeth) for gear in gears), *map(short, numbers))


def assembly_rows(train: PlanetaryTrain) -> list[Row]:
    """What must hold for the train to go together, each with its numbers."""
    distance = float(train.centre_distance)
    rows = [Row("centre distance of both meshes", "a", (short(distance),), "mm", "planets turn on one axis")]
    if train.planets > 1:
        gap = least_gap(train)
        apart = 2 * distance * math.sin(math.radians(gap.angle) / 2)
        first, second = (planet + 1 for planet in gap.planets)
        rows.append(
            Row(f"axes of planets {first} and {second}, the nearest", "", (short(apart),), "mm", f"{short(gap.angle)}° apart")
        )
        for rim in train.rims:
            tip = rim.gear.tip_diameter
            rows.append(
                Row(f"room between tips of {rim.name}", "", (short(apart - tip),), "mm", f"tip diameter {short(tip)} mm")
            )
    rows += [
        Row(
            "places where the teeth let a planet stand",
            "q",
            (str(train.positions),),
            "",
            "of a full turn, by the teeth of all gears",
        ),
        Row("places for a planet", "q/N", (short(train.positions / train.planets),), "", _spacing(train)),
        Row("angles of the planets", "ψ", (_angles(train),), "°", "from +x, counter-clockwise"),
        Row("pull of the planets outwards, of one", "|Σ exp(iψ)|", (short(_rounded(train.unbalance)),), "", _balance(train)),
    ]
    return rows


def _angles(train: PlanetaryTrain) -> str:
    """All of them, or of many the first and the last: the phases have all."""
    words = list(map(short, train.angles))
    return ", ".join(words if len(words) <= _LISTED else [*words[:2], "...", words[-1]])


def _spacing(train: PlanetaryTrain) -> str:
    if train.positions % train.planets == 0:
        return "whole: equal angles let the teeth fit"
    return f"not whole: angles are multiples of 360°/{train.positions} from the first"


def _balance(train: PlanetaryTrain) -> str:
    if _rounded(train.unbalance):
        return "they do not balance each other" if train.planets > 1 else "a planet alone is not balanced"
    return "they balance each other"


def _rounded(value: float) -> float:
    """Without what only rounding leaves."""
    return value if abs(value) > 1e-9 else 0.0

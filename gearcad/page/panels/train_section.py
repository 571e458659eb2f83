"""The section of a planetary train seen along its axis: every gear where it stands, and how it turns."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from gearcad.designs.kinds.planetary import PlanetaryDesign
from gearcad.jobs.products import given_speeds
from gearcad.page.last import of_last
from gearcad.page.panels.section_parts import body_of, mesh_of
from gearcad.per_gear import Role
from gearcad.planetary.mesh import SetMesh
from gearcad.planetary.shafts import shafts_of
from gearcad.solids.files.train_dxf import section_angle
from gearcad.solids.files.train_turning import turns_of
from gearcad.solids.train_layout import TrainLayout

__all__ = ["layout_of", "ratios_of", "roll_pitch", "train_section"]


def train_section(design: PlanetaryDesign) -> dict[str, Any]:
    """Gears that mesh are cut by one plane, in the middle of their teeth; planets and what is of their meshes go round."""
    layout = layout_of(design)
    ratios = ratios_of(design, layout)
    orbit, (slacks, of_planets) = ratios[layout.carrier.name], _slacks(layout)
    bodies, numbers = [], {}
    for number, standing in enumerate(layout.standing):
        numbers[standing.name] = number
        turned = [[0.0, section_angle(layout, standing)]]
        place, gear = (standing.axle.x, standing.axle.y), standing.body.gear
        axle, rest = standing.axle.name, math.radians(standing.rotation)
        slack = of_planets if standing.axle.on else slacks[axle]
        body = body_of(standing.name, gear, standing.body.colour, place, turned, ratios[axle], rest=rest, slack=slack)
        bodies.append(body | {"orbit": orbit if standing.axle.on else 0.0})
    meshes = list(_meshes(layout, numbers, orbit))
    return {"bodies": bodies, "meshes": meshes, "heights": [0.0, 0.0], "pitch": roll_pitch(design, ratios)}


@of_last
def layout_of(design: PlanetaryDesign) -> TrainLayout:
    """Where everything stands."""
    return TrainLayout(design.train, design.train.pose())


def ratios_of(design: PlanetaryDesign, layout: TrainLayout) -> dict[str, float]:
    """Turns of all axles by name, seen from what carries each, while the input turns once (the carrier, if that stands)."""
    turns = turns_of(layout, given_speeds(design))
    once = turns[design.train.input] or turns[layout.carrier.name]
    return {name: turn / once for name, turn in turns.items()}


def roll_pitch(design: PlanetaryDesign, ratios: dict[str, float]) -> float:
    """How far the input turns (rad) while a tooth of the first central passes a planet."""
    central, carrier = design.train.centrals[0], design.train.carrier.name
    return 2 * math.pi / abs(central.gear.teeth * (ratios[central.name] - ratios[carrier]))


def _slacks(layout: TrainLayout) -> tuple[dict[str, float], float]:
    """How far all turn (rad) until the left flanks of the first central touch those of the planets, and these the second.

    Shafts by their names, and planets. The first central and the carrier stay; stages keep their backlash split.
    """
    first, second = layout.train.meshes
    planet = _slack(first, first.rim_role)
    moved = -_slack(second, second.central_role) - planet * second.rim.gear.teeth / second.central.gear.teeth
    shafts = shafts_of(layout.train).items()
    found = {name: moved * float(shaft.speed_ratio) * (shaft.member == second.central.name) for name, shaft in shafts}
    return found, planet


def _slack(mesh: SetMesh, role: Role) -> float:
    """How far one of both gears turns (rad) until the left flanks of the pinion touch, backlash being split."""
    return mesh.pair.circumferential_backlash / mesh.pair.working_pitch_diameters.pick(role)


def _meshes(layout: TrainLayout, numbers: dict[str, int], orbit: float) -> Iterator[dict[str, Any]]:
    """Those of all planets; `towards` is where the mate of the pinion stands (rad).

    One side of a planet's teeth touches the first central, the other side the second.
    """
    for planet in layout.planets:
        for mesh, side in zip(layout.train.meshes, (1, -1), strict=True):
            (rim,) = (standing for standing in planet if standing.body.key == mesh.rim.name)
            members = {mesh.central_role: mesh.central.name, mesh.rim_role: rim.name}
            away = math.atan2(rim.axle.y, rim.axle.x)
            back = math.pi if mesh.rim_role is Role.PINION and mesh.external else 0.0
            pair = mesh.pair
            drawn = mesh_of(pair.pinion, pair.path_of_contact, pair.working_transverse_pressure_angle, pair.base_tangent.length)
            of = [numbers[members[role]] for role in Role]
            yield drawn | {"of": of, "towards": away + back, "orbit": orbit, "side": side}

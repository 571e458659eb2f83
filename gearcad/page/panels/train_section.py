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
from gearcad.solids.files.train_dxf import section_angle
from gearcad.solids.files.train_turning import turns_of
from gearcad.solids.train_layout import TrainLayout

__all__ = ["layout_of", "ratios_of", "roll_pitch", "train_section"]


def train_section(design: PlanetaryDesign) -> dict[str, Any]:
    """Gears that mesh are cut by one plane, in the middle of their teeth; planets and what is of their meshes go round."""
    layout = layout_of(design)
    ratios = ratios_of(design, layout)
    orbit = ratios[layout.carrier.name]
    bodies, numbers = [], {}
    for number, standing in enumerate(layout.standing):
        numbers[standing.name] = number
        turned = [[0.0, section_angle(layout, standing)]]
        place, gear = (standing.axle.x, standing.axle.y), standing.body.gear
        body = body_of(standing.name, gear, standing.body.colour, place, turned, ratios[standing.axle.name])
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


def _meshes(layout: TrainLayout, numbers: dict[str, int], orbit: float) -> Iterator[dict[str, Any]]:
    """Those of all planets; `towards` is where the mate of the pinion stands (rad)."""
    for planet in layout.planets:
        for mesh in layout.train.meshes:
            (rim,) = (standing for standing in planet if standing.body.key == mesh.rim.name)
            members = {mesh.central_role: mesh.central.name, mesh.rim_role: rim.name}
            away = math.atan2(rim.axle.y, rim.axle.x)
            back = math.pi if mesh.rim_role is Role.PINION and mesh.external else 0.0
            pair = mesh.pair
            drawn = mesh_of(pair.pinion, pair.path_of_contact, pair.working_transverse_pressure_angle, pair.base_tangent.length)
            of = [numbers[members[role]] for role in Role]
            yield drawn | {"of": of, "towards": away + back, "orbit": orbit, "slack": None}

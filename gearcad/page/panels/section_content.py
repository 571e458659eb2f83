"""What the page draws of a transverse section: outlines of a tooth, places, turns, circles, and where flanks touch."""

from __future__ import annotations

import math
from typing import Any

from gearcad.designs.design import Design
from gearcad.designs.kinds.pair import PairDesign
from gearcad.designs.kinds.planetary import PlanetaryDesign
from gearcad.designs.kinds.rack import RackDesign
from gearcad.designs.kinds.rack_pair import RackPairDesign
from gearcad.designs.kinds.toothed import ToothedDesign
from gearcad.geometry import Gear, Rack
from gearcad.page.last import of_last
from gearcad.page.panels.section_parts import body_of, drift, mesh_of, rack_of, turns
from gearcad.page.panels.train_section import train_section
from gearcad.solids.colours import PART_COLOURS, STEEL

__all__ = ["section_of"]


@of_last
def section_of(design: Design) -> dict[str, Any] | None:
    """Bodies of a design with teeth, their meshes, heights at which it can be cut, and the pitch by which it is rolled (rad).

    A body has a place, an outline of one tooth (mm), and over the height (mm, of the first) how far it is turned (rad, a rack
    moved, mm); `ratio` is how far it turns (or moves, mm) while the first turns by a radian. None for kinds without teeth.
    """
    if isinstance(design, PairDesign):
        return _of_pair(design)
    if isinstance(design, RackPairDesign):
        return _of_rack_pair(design)
    if isinstance(design, RackDesign):
        return _content(
            [rack_of(design.rack, (0.0, 0.0), 0.0, drift(design.rack, 0.0, 0.0), 0.0)], [], _heights(design.rack), 0.0
        )
    if isinstance(design, PlanetaryDesign):
        return train_section(design)
    if isinstance(design, ToothedDesign) and (gear := design.gears.get("gear")) is not None:
        body = body_of("gear", gear, STEEL, (0.0, 0.0), turns(gear, 0.0, 0.0), 1.0)
        return _content([body], [], _heights(gear), 2 * math.pi / gear.tooth_count)
    return None


def _of_pair(design: PairDesign) -> dict[str, Any]:
    pair = design.pair
    pose, pitches, active = pair.wheel_pose(), pair.working_pitch_diameters, pair.active_root_diameters
    angle = pair.working_transverse_pressure_angle
    rest, ratio = math.radians(pose.rotation), -pair.pinion.teeth / pair.wheel.teeth
    turned, slack = turns(pair.wheel, rest, pose.z), pair.circumferential_backlash / pitches.wheel
    colours = PART_COLOURS["pinion"], PART_COLOURS["wheel"]
    beside = [{"active": abs(active.pick(role)), "pitch": abs(pitches.pick(role))} for role, _ in pair.gears.items()]
    bodies = [
        body_of("pinion", pair.pinion, colours[0], (0.0, 0.0), turns(pair.pinion, 0.0, 0.0), 1.0, beside[0]),
        body_of("wheel", pair.wheel, colours[1], (pose.x, 0.0), turned, ratio, beside[1], rest=rest, slack=slack),
    ]
    low, high = max(0.0, pose.z), min(pair.pinion.face_width, pose.z + pair.wheel.face_width)
    mesh = mesh_of(pair.pinion, pair.path_of_contact, angle, pair.base_tangent.length)
    return _content(bodies, [mesh], (low, high), 2 * math.pi / pair.pinion.tooth_count)


def _of_rack_pair(design: RackPairDesign) -> dict[str, Any]:
    pair = design.pair
    pose, pinion = pair.rack_pose(), pair.pinion
    beside = {"active": pair.active_root_diameter, "pitch": 2 * pair.pitch_radius}
    body = body_of("pinion", pinion, PART_COLOURS["pinion"], (0.0, 0.0), turns(pinion, 0.0, 0.0), 1.0, beside)
    travel = drift(pair.rack, pose.y, pose.z)
    slack = -pair.circumferential_backlash / 2
    rack = rack_of(pair.rack, (pose.x, 0.0), math.radians(pose.rotation), travel, pair.pitch_radius, slack)
    rack["circles"] |= {"pitch": pair.pitch_line_height, "active": -pair.active_root_depth}
    mesh = mesh_of(pinion, pair.path_of_contact, pair.working_transverse_pressure_angle, None)
    low = max(0.0, pose.z)
    heights = low, low + pair.common_width
    return _content([body, rack], [mesh], heights, 2 * math.pi / pinion.teeth)


def _content(bodies: list[Any], meshes: list[Any], heights: tuple[float, float], pitch: float) -> dict[str, Any]:
    return {"bodies": bodies, "meshes": meshes, "heights": list(heights), "pitch": pitch}


def _heights(cut: Gear | Rack) -> tuple[float, float]:
    return 0.0, cut.face_width

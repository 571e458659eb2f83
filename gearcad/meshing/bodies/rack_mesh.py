"""Mesh of a strip of a rack's teeth in its transverse section, with named sides, as decks of a pinion and a rack have it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear
from gearcad.geometry import Rack, RackPair
from gearcad.meshing.bodies.element_mesh import BACK, ElementMesh, joined
from gearcad.meshing.bodies.section_mesh import NO_CONTACTS, TEETH_SIDES, faces_of, merged_sectors
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import Element
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.rack_section import FineZone, mesh_rack_sector

_REACH = 6.0
"""Length of the strip on each side of the loaded tooth, over its height: what the ends do to it is below 1e-5."""


def strip_teeth(rack: Rack, fewest: int = 1, reach: float = _REACH) -> int:
    """Return an odd number of teeth that reach `reach` times the height to both sides of the middle one, if there are as many.

    There are at least the `fewest` (odd).
    """
    aside = min(math.ceil(reach * (rack.height + rack.tip_height) / rack.transverse_pitch), (rack.whole_pitches - 1) // 2)
    return max(2 * aside + 1, fewest)


def mesh_strip(
    rack: Rack, *, teeth: int, sizes: MeshSizes, contacts: Mapping[int, ContactRefinement] = NO_CONTACTS
) -> ElementMesh:
    """Mesh so many teeth of a rack, an odd number round tooth 0, in triangles of second order.

    The frame is that of `rack_section`: tips along +x, tooth k at y = k p_t. Sides are as those of `mesh_section`, with teeth
    numbered up to the rack's whole pitches, "back", and the ends "end_behind" and "end_ahead", which nothing holds. Teeth in
    `contacts` have a zone of short edges. Raises ParameterError, GeometryError and SolverError.
    """
    if teeth % 2 == 0:
        raise ParameterError("teeth", teeth, "must be odd: tooth 0 stands in the middle")
    numbers, count = range(-(teeth // 2), teeth // 2 + 1), rack.whole_pitches
    zones = {number % count: zone for number, zone in contacts.items()}
    plain = mesh_rack_sector(rack, sizes.coarse() if contacts else sizes)
    near = mesh_rack_sector(rack, sizes)
    beside = {(number + step) % count for number in zones for step in (-1, 0, 1)}
    sectors = [
        mesh_rack_sector(rack, sizes, _zone(rack, zones[number % count]))
        if number % count in zones
        else near
        if number % count in beside or not zones
        else plain
        for number in numbers
    ]
    pitch = rack.transverse_pitch
    placed = [sector.points + np.array([0.0, number * pitch]) for number, sector in zip(numbers, sectors, strict=True)]
    named = []
    for place, (number, sector) in enumerate(zip(numbers, sectors, strict=True)):
        sides = {f"{name}_{number % count}": side for side, name in TEETH_SIDES.items() if side in sector.sides}
        sides[BACK] = OutlineSide.HELD
        if place == 0:
            sides["end_behind"] = OutlineSide.BEHIND
        if place == teeth - 1:
            sides["end_ahead"] = OutlineSide.AHEAD
        named.append({name: faces_of(sector, side, Element.TRI6) for name, side in sides.items()})
    return merged_sectors(Element.TRI6, sectors, placed, named, closed=False, matched=False)


def pinion_turn(pair: RackPair, roll_angle: float, *, left: bool) -> float:
    """Return the angle (rad) by which a pinion is turned whose tooth 0 touches the rack at a roll angle (deg)."""
    angle, pinion = math.radians(pair.working_transverse_pressure_angle), pair.pinion
    rolled = 2 * _touching(pair, roll_angle) / pinion.base_diameter
    turn = rolled - angle - math.radians(pinion.base_half_angle)
    return turn if left else -turn


def rack_posed(
    pair: RackPair, meshes: PerGear[ElementMesh], roll_angle: float, approach: float = 0.0, *, left: bool = True
) -> ElementMesh:
    """Return sections of a pinion and a rack in one mesh, as `posed` does those of gears.

    The pinion is about the z axis, the rack's reference line at x = H, its tips towards the pinion; left or right flanks of
    tooth 0 touch.
    """
    side, base = 1.0 if left else -1.0, pair.pinion.base_diameter / 2
    angle, touching = math.radians(pair.working_transverse_pressure_angle), _touching(pair, roll_angle)
    height = pair.pitch_line_height + (pair.path_of_contact.C - touching) * math.sin(angle)
    half = pair.rack.profile.half_thickness_on_flank(height)
    along = -base * math.sin(angle) + touching * math.cos(angle) + half
    pinion = _turned(meshes.pinion, pinion_turn(pair, roll_angle, left=left) + side * approach / base)
    rack = _turned(meshes.wheel, math.pi)
    shift = np.array([pair.mounting_distance, side * along, 0.0])
    return joined({"pinion": pinion, "wheel": replace(rack, points=rack.points + shift)})


def _touching(pair: RackPair, roll_angle: float) -> float:
    """Return the place (mm from T1) where tooth 0 touches at a roll angle (deg)."""
    return pair.path_of_contact.C + math.radians(roll_angle) * pair.pinion.base_diameter / 2


def _turned(mesh: ElementMesh, angle: float) -> ElementMesh:
    """Return a section turned about the z axis by an angle (rad)."""
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y, z = mesh.points.T
    return replace(mesh, points=np.stack([cosine * x - sine * y, sine * x + cosine * y, z], -1))


def _zone(rack: Rack, zone: ContactRefinement) -> FineZone:
    """Return the zone of a contact whose place is as `StraightFlank` has it: heights over sin alpha_t."""
    along = zone.length * math.tan(math.radians(rack.transverse_pressure_angle))
    return FineZone(along, zone.half_width, zone.edge, zone.left)

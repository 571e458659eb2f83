"""Mesh of a strip of a rack's teeth in its transverse section, with named sides, as decks of a pinion and a rack have it."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.geometry import Rack
from gearcad.meshing.bodies.element_mesh import BACK, ElementMesh
from gearcad.meshing.bodies.section_mesh import NO_CONTACTS, TEETH_SIDES, faces_of, merged_sectors
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import Element
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.rack_section import FineZone, mesh_rack_sector


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


def _zone(rack: Rack, zone: ContactRefinement) -> FineZone:
    """Return the zone of a contact whose place is as `StraightFlank` has it: heights over sin alpha_t."""
    along = zone.length * math.tan(math.radians(rack.transverse_pressure_angle))
    return FineZone(along, zone.half_width, zone.edge, zone.left)

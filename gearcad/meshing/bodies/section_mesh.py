"""The section of one gear as a mesh with named sides: one tooth and its share of the body, some teeth, or the full ring."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import ParameterError, require_whole
from gearcad.geometry import Gear
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.core import filled
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.mesh import Cells, ElementMesh, Faces
from gearcad.meshing.bodies.modified import modification_turns
from gearcad.meshing.bodies.names import body_side
from gearcad.meshing.bodies.sectors import Sectors
from gearcad.meshing.section.outline import OTHER_SIDE, MeshSizes, SectorSides, Side

__all__ = ["NO_CONTACTS", "mesh_section", "teeth_of"]


NO_CONTACTS: Mapping[int, ContactZone] = MappingProxyType({})

_OF_TEETH = {
    Side.RIGHT_ROOT: "right_root",
    Side.RIGHT_FILLET: "right_fillet",
    Side.RIGHT_FLANK: "right_flank",
    Side.TIP: "tip",
    Side.LEFT_FLANK: "left_flank",
    Side.LEFT_FILLET: "left_fillet",
    Side.LEFT_ROOT: "left_root",
}
"""Names of what each tooth has of its own; its number follows."""

_ACROSS = OTHER_SIDE | {other: side for side, other in OTHER_SIDE.items()}
_OF_RINGS = {side: _OF_TEETH[_ACROSS[side]] for side in _OF_TEETH}
"""Those of a ring, whose teeth point the other way."""


def mesh_section(
    gear: Gear,
    *,
    teeth: int | None,
    held_radius: float,
    sizes: MeshSizes,
    element: Element,
    contacts: Mapping[int, ContactZone] = NO_CONTACTS,
    modified: bool = True,
) -> ElementMesh:
    """Mesh the transverse section of a gear down, or of a ring out, to `held_radius` (mm), in elements of second order.

    `teeth` None is the full ring; an odd number of them stands around tooth 0, between two cuts. Vertices come before the
    nodes between them. Sides are, for each tooth by its number counter-clockwise from 0, "left_flank_3", "right_flank_3",
    "left_fillet_3", "right_fillet_3", "left_root_3" and "right_root_3" if there is a root land, "tip_3"; "bore", or of a ring
    "rim"; and, of less than all teeth, "cut_behind" and "cut_ahead". Left is as a tooth is seen from +z with its tip up.

    Teeth in `contacts`, by number, have a zone of short edges; of triangles, those that are not even next to one of them then
    have long ones. Of quadrangles whole rows of the tooth are thin there. With an `held_radius` of 0 the ring is a full disc
    without a bore. Flanks are modified as they are at mid face width, or, if not `modified`, exact ones; where reliefs begin
    there are vertices on both. Raises ParameterError, GeometryError and SolverError.
    """
    numbers = teeth_of(gear, teeth)
    every = Sectors.of_gear(gear, held_radius, sizes, element, contacts)
    if every.disc and teeth is not None:
        raise ParameterError("held_radius", 0.0, "must be above 0 mm for less than the full ring", "mm")
    sectors = [every.of(tooth) for tooth in numbers]
    mesh = _merged(gear, element, numbers, sectors, closed=teeth is None)
    whole = filled(mesh, sizes.growth) if every.disc else mesh
    return _turned_flanks(whole, gear) if modified and gear.modification.present else whole


def _turned_flanks(mesh: ElementMesh, gear: Gear) -> ElementMesh:
    """The section at mid face width, not turned by the helix."""
    turns = modification_turns(mesh, gear, np.array([gear.half_width / 2])).at(0)
    cosine, sine = np.cos(turns), np.sin(turns)
    x, y, z = mesh.points.T
    return replace(mesh, points=np.stack([cosine * x - sine * y, sine * x + cosine * y, z], -1))


def teeth_of(gear: Gear, teeth: int | None) -> range:
    """Teeth that are meshed, in order, counted from tooth 0 both ways. Raises ParameterError."""
    if teeth is None:
        return range(gear.tooth_count)
    require_whole("teeth", teeth, at_least=1, at_most=gear.tooth_count - 1)
    if teeth % 2 == 0:
        raise ParameterError("teeth", teeth, "must be odd: tooth 0 stands in the middle")
    return range(-(teeth // 2), teeth // 2 + 1)


def _merged(gear: Gear, element: Element, teeth: range, sectors: Sequence[SectorSides], *, closed: bool) -> ElementMesh:
    """Sectors turned to the places of their teeth, nodes on common cuts once."""
    numbers = _numbers(sectors, element.shape.vertices, closed=closed)
    points = np.zeros((1 + max(int(number.max()) for number in numbers), 3))
    cells, sides = list[Cells](), dict[str, list[Faces]]()
    elements = 0
    for tooth, sector, number in zip(teeth, sectors, numbers, strict=True):
        points[number, :2] = _turned(sector.points, 2 * math.pi * tooth / gear.tooth_count)
        cells.append(number[sector.cells].astype(np.int32))
        named = _named(gear, sector, element, tooth % gear.tooth_count)
        if not closed:
            named |= _cuts(sector, element, tooth - teeth.start, len(teeth))
        for name, faces in named.items():
            sides.setdefault(name, []).append(faces.shifted(elements))
        elements += len(sector.cells)
    every = {name: _together(parts) for name, parts in sides.items()}
    matched = {} if closed else {"cut": np.stack([numbers[0][sectors[0].behind], numbers[-1][sectors[-1].ahead]], -1)}
    return ElementMesh(element, points, np.concatenate(cells), {"gear": slice(0, elements)}, every, matched)


def _numbers(sectors: Sequence[SectorSides], vertices: int, *, closed: bool) -> list[Wholes]:
    """Numbers (n,) that the nodes of each sector get in the whole: those on the cut behind it are its neighbour's ahead."""
    owns = [np.ones(len(sector.points), bool) for sector in sectors]
    starts = [1 + int(sector.cells[:, :vertices].max()) for sector in sectors]
    for own, sector in zip(owns if closed else owns[1:], sectors if closed else sectors[1:], strict=True):
        own[sector.behind] = False
    found = [np.empty(len(own), int) for own in owns]
    count = 0
    for first in (True, False):
        for own, start, number in zip(owns, starts, found, strict=True):
            chosen = own & ((np.arange(len(own)) < start) == first)
            amount = int(chosen.sum())
            number[chosen] = np.arange(count, count + amount)
            count += amount
    for k in range(0 if closed else 1, len(sectors)):
        found[k][sectors[k].behind] = found[k - 1][sectors[k - 1].ahead]
    return found


def _named(gear: Gear, sector: SectorSides, element: Element, tooth: int) -> dict[str, Faces]:
    """Sides of a tooth's sector under the names that they have in the whole, but for the cuts."""
    names = _OF_RINGS if gear.internal else _OF_TEETH
    found = {f"{name}_{tooth}": _faces(sector, side, element) for side, name in names.items() if side in sector.sides}
    found[body_side(gear)] = _faces(sector, Side.HELD, element)
    return found


def _cuts(sector: SectorSides, element: Element, place: int, count: int) -> dict[str, Faces]:
    """The cuts that the sector in one of `count` places has beside no other."""
    found = {}
    if place == 0:
        found["cut_behind"] = _faces(sector, Side.BEHIND, element)
    if place == count - 1:
        found["cut_ahead"] = _faces(sector, Side.AHEAD, element)
    return found


def _faces(sector: SectorSides, side: Side, element: Element) -> Faces:
    """Edges of a side of the outline. Each has its middle to itself, and that belongs to one element."""
    middles = sector.cells[:, element.shape.vertices :].ravel()
    order = np.argsort(middles, kind="stable")
    at = order[np.searchsorted(middles, sector.sides[side][1::2], sorter=order)]
    found, local = np.divmod(at, element.shape.vertices)
    return Faces(found.astype(np.int32), local.astype(np.int8))


def _together(parts: Sequence[Faces]) -> Faces:
    if len(parts) == 1:
        return parts[0]
    return Faces(np.concatenate([part.elements for part in parts]), np.concatenate([part.sides for part in parts]))


def _turned(points: Floats, turn: float) -> Floats:
    """Points (n, 2) turned by an angle (rad)."""
    cosine, sine = math.cos(turn), math.sin(turn)
    result: Floats = points @ np.array([[cosine, sine], [-sine, cosine]])
    return result

"""The section of one gear as a mesh with named sides: one tooth and its share of the body, some teeth, or the full ring."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import ParameterError, require_whole
from gearcad.geometry import Gear
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.mesh import Cells, ElementMesh, Faces
from gearcad.meshing.section.outline import MeshSizes, SectorSides, Side
from gearcad.meshing.section.quads import mesh_quads
from gearcad.meshing.section.sector import mesh_sector

__all__ = ["mesh_section", "teeth_of"]


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


def mesh_section(gear: Gear, *, teeth: int | None, inner_radius: float, sizes: MeshSizes, element: Element) -> ElementMesh:
    """Mesh the transverse section of a gear down to `inner_radius` (mm), in quadrangles or triangles of second order.

    `teeth` None is the full ring; an odd number of them stands around tooth 0, between two cuts. Vertices come before the
    nodes between them. Sides are, for each tooth by its number counter-clockwise from 0, "left_flank_3", "right_flank_3",
    "left_fillet_3", "right_fillet_3", "left_root_3" and "right_root_3" if there is a root land, "tip_3"; "bore"; and, if it is
    no ring, "cut_behind" and "cut_ahead". Raises ParameterError, GeometryError and SolverError.
    """
    numbers = teeth_of(gear, teeth)
    sector = _sector(gear, inner_radius, sizes, element)
    return _merged(gear, element, numbers, [sector] * len(numbers), closed=teeth is None)


def teeth_of(gear: Gear, teeth: int | None) -> range:
    """Teeth that are meshed, in order, counted from tooth 0 both ways. Raises ParameterError."""
    if teeth is None:
        return range(gear.teeth)
    require_whole("teeth", teeth, at_least=1, at_most=gear.teeth - 1)
    if teeth % 2 == 0:
        raise ParameterError("teeth", teeth, "must be odd: tooth 0 stands in the middle")
    return range(-(teeth // 2), teeth // 2 + 1)


def _sector(gear: Gear, inner_radius: float, sizes: MeshSizes, element: Element) -> SectorSides:
    """Tooth 0 and its share of the body."""
    if element is Element.QUAD8:
        return mesh_quads(gear, inner_radius, sizes)
    if element is Element.TRI6:
        return mesh_sector(gear, inner_radius, sizes)
    raise ParameterError("element", element.value, f'must be "{Element.QUAD8.value}" or "{Element.TRI6.value}" for a section')


def _merged(gear: Gear, element: Element, teeth: range, sectors: Sequence[SectorSides], *, closed: bool) -> ElementMesh:
    """Sectors turned to the places of their teeth, nodes on common cuts once."""
    numbers = _numbers(sectors, element.shape.vertices, closed=closed)
    points = np.zeros((1 + max(int(number.max()) for number in numbers), 3))
    cells, sides = list[Cells](), dict[str, list[Faces]]()
    elements = 0
    for tooth, sector, number in zip(teeth, sectors, numbers, strict=True):
        points[number, :2] = _turned(sector.points, 2 * math.pi * tooth / gear.teeth)
        cells.append(number[sector.cells].astype(np.int32))
        for name, faces in _named(sector, element, tooth % gear.teeth, tooth - teeth.start, len(teeth), closed).items():
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


def _named(sector: SectorSides, element: Element, tooth: int, place: int, count: int, closed: bool) -> dict[str, Faces]:
    """Sides of one of `count` sectors under the names that they have in the whole."""
    found = {f"{name}_{tooth}": _faces(sector, side, element) for side, name in _OF_TEETH.items() if side in sector.sides}
    found["bore"] = _faces(sector, Side.INNER, element)
    if not closed and place == 0:
        found["cut_behind"] = _faces(sector, Side.BEHIND, element)
    if not closed and place == count - 1:
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

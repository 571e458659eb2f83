"""Mesh of the section of one gear with named sides: one tooth, some teeth, or the full ring, with modified flanks."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from types import MappingProxyType
from typing import Any

import numpy as np

from gearcad.core.errors import ParameterError, require_whole
from gearcad.core.records import Bools, Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.curves import CurveKind, parameter_at
from gearcad.geometry.gear import FlankCurve, flank_curves
from gearcad.meshing.bodies.element_mesh import Cells, ElementMesh, Faces, body_side, rises
from gearcad.meshing.bodies.sectors import ContactRefinement, Sectors, filled
from gearcad.meshing.fem import Element, laplacian
from gearcad.meshing.outline import OTHER_SIDE, MeshSizes, OutlineSide, SectorSides

_NEGLIGIBLE = 1e-14
"""Share of the greatest turn that a field may have and be left out."""


@dataclass(frozen=True)
class Turns:
    """Angles (rad) by which the nodes of a section are turned at some heights: sums of a few `fields` (k, nodes), taken with
    `shares` (heights, k).
    """

    shares: Floats
    fields: Floats

    def at(self, height: int) -> Floats:
        """Return the angles (n,) in rad of all nodes at one of the heights, by its number."""
        result: Floats = self.shares[height] @ self.fields
        return result


def modification_turns(section: ElementMesh, gear: Gear, heights: Floats) -> Turns:
    """Return the rotations at heights z (n,) in mm that move the nodes of a section of the unmodified gear onto the modified
    one.

    Flanks, fillets and chamfers turn by their depth, lands in proportion between their ends, the circle where the body ends
    not at all, both cuts alike. Inside, the turn is harmonic, so that it takes as little as can be from any element; nodes
    between vertices turn by the mean of both.
    """
    if not gear.modification.present:
        return Turns(np.zeros((len(heights), 0)), np.zeros((0, len(section.points))))
    nodes, turns = _on_outline(section, gear, heights)
    shares, sizes, given = np.linalg.svd(turns, full_matrices=False)
    kept = sizes > _NEGLIGIBLE * sizes[0] if sizes[0] else np.zeros(len(sizes), bool)
    return Turns((shares * sizes)[:, kept], _extended(section, nodes, given[kept]))


# ---------------------------------------------------------------------- the outline


class _Part(Enum):
    """Parts of the outline that modifications turn."""

    FLANK = "flank"
    FILLET = "fillet"
    ROOT = "root"
    TIP = "tip"


_TURNED = re.compile(r"(?:(left|right)_(flank|fillet|root)|(tip))_(\d+)")
"""Names of their sides, with the tooth's number."""


def _parts(section: ElementMesh) -> Iterator[tuple[_Part, str, Wholes, Wholes]]:
    """Yield each part of the outline, with nodes of all teeth and the tooth of each; "left", "right" or None, of both."""
    found: dict[tuple[str, str], list[tuple[Wholes, int]]] = {}
    for name in section.sides:
        if match := _TURNED.fullmatch(name):
            side, part, tip, tooth = match.groups()
            found.setdefault((part or tip, side), []).append((section.nodes(name).astype(np.int64), int(tooth)))
    for (part, side), of_teeth in found.items():
        numbers = np.repeat([tooth for _, tooth in of_teeth], [len(nodes) for nodes, _ in of_teeth])
        yield _Part(part), side, np.concatenate([nodes for nodes, _ in of_teeth]), numbers


def _on_outline(section: ElementMesh, gear: Gear, heights: Floats) -> tuple[Wholes, Floats]:
    """Return the nodes (m,) whose turns are known, and these (heights, m)."""
    outline = _Outline(gear, heights)
    pitch = 2 * np.pi / gear.tooth_count
    end = body_side(gear)
    held = section.nodes(end).astype(np.int64) if end in section.sides else np.zeros(0, int)
    nodes, turns = [held], [np.zeros((len(heights), len(held)))]
    for part, side, of_part, tooth in _parts(section):
        x, y = section.points[of_part, :2].T
        angle = np.remainder(np.arctan2(y, x) - pitch * tooth + np.pi, 2 * np.pi) - np.pi
        nodes.append(of_part)
        turns.append(outline.turns(part, np.hypot(x, y), angle, left=rises(gear, side)))
    every, first = np.unique(np.concatenate(nodes), return_index=True)
    return every, np.concatenate(turns, axis=1)[:, first]


@dataclass(frozen=True)
class _Outline:
    """The outline of tooth 0 at some heights (mm)."""

    gear: Gear
    heights: Floats

    def turns(self, part: _Part, radius: Floats, angle: Floats, *, left: bool) -> Floats:
        """Turns (heights, n) of points of a part at radii (mm) and angles (rad) from the middle of tooth 0."""
        if part is _Part.FLANK:
            return self._of_lengths(self._rolls(radius), left=left)
        if part is _Part.FILLET:
            return self._of_fillet_radii(radius, left=left)
        if part is _Part.TIP:
            return self._of_tip(angle)
        return self._of_root_land(np.abs(angle), left=left)

    def _rolls(self, radius: Floats) -> Floats:
        """Return the roll lengths (mm), as the flank's form has them."""
        base = self.gear.profile.base_diameter / 2
        lengths = np.sqrt(np.maximum((radius - base) * (radius + base), 0.0))
        return -lengths if self.gear.internal else lengths

    def _of_lengths(self, lengths: Floats, *, left: bool) -> Floats:
        return self.gear.flank_form.turn(lengths, self.heights[:, None], left=left)

    @property
    def _fillet(self) -> FlankCurve:
        """The piece of the fillet at the root circle, the only one that may turn less than the flank."""
        return next(each for each in flank_curves(self.gear) if each.curve.kind is CurveKind.FILLET)

    def _of_fillet_radii(self, radius: Floats, *, left: bool) -> Floats:
        """Return the turns at radii (mm) on the fillet."""
        first = self._fillet.curve
        least, most = sorted(float(first.polar(s)[0]) for s in (0.0, 1.0))
        inside: Floats = np.clip(radius, least, most)
        return self._of_fillet(np.clip(parameter_at(first, inside), 0.0, 1.0), left=left)

    def _of_fillet(self, s: Floats, *, left: bool) -> Floats:
        return self._fillet.turn(self.gear.flank_form, s, self.heights[:, None], left=left)

    def _of_tip(self, angle: Floats) -> Floats:
        """Return the turns at angles (rad) on the tip.

        Chamfers turn with the ends of the flanks, the land between its own ends.
        """
        end = np.array([self.gear.flank_form.last])
        left, right = self._of_lengths(end, left=True), self._of_lengths(end, left=False)
        land = self.gear.profile.curves[-1]
        place = np.clip(angle / float(land.polar(0.0)[1]), -1, 1)
        return left * (1 + place) / 2 + right * (1 - place) / 2

    def _of_root_land(self, angle: Floats, *, left: bool) -> Floats:
        """Return the turns at angles (rad) on the root land, from the end of this fillet to the cut in the middle of the land.

        The turn at the cut is halfway between those at both ends.
        """
        end = np.zeros(1)
        own, other = self._of_fillet(end, left=left), self._of_fillet(end, left=not left)
        middle = np.pi / self.gear.tooth_count
        place = (middle - angle) / (middle - float(self._fillet.curve.polar(0.0)[1])) / 2
        return other + (own - other) * (place + 0.5)


# ---------------------------------------------------------------------- the inside


def _extended(section: ElementMesh, nodes: Wholes, given: Floats) -> Floats:
    """Return the fields (k, n) that are `given` (k, m) at some nodes (m,), harmonic at the other vertices and the same on both
    cuts.
    """
    shape = section.element.shape
    fields = np.zeros((len(given), len(section.points)))
    fields[:, nodes] = given
    known: Bools = np.zeros(len(section.points), bool)
    known[nodes] = True
    _fill_inside(section, known, fields)
    ends = section.cells[:, np.array(shape.edges)]
    middles = section.cells[:, shape.vertices :]
    inside = ~known[middles]
    middles, ends = middles[inside], ends[inside]
    fields[:, middles] = (fields[:, ends[:, 0]] + fields[:, ends[:, 1]]) / 2
    return fields


def _fill_inside(section: ElementMesh, known: Bools, fields: Floats) -> None:
    """Set the fields (k, n) at vertices that are not known: Laplace's equation, by finite elements of first order."""
    from scipy.sparse import csr_array
    from scipy.sparse.linalg import splu

    vertices, matrix = _laplacian(section)
    same = np.arange(len(section.points))
    for pairs in section.matched.values():
        same[pairs[:, 1]] = pairs[:, 0]
    values, first, column = np.unique(same[vertices], return_index=True, return_inverse=True)
    tie = csr_array((np.ones(len(vertices)), (np.arange(len(vertices)), column)))
    matrix = (tie.T @ matrix @ tie).tocsc()
    free, fixed = np.flatnonzero(~known[values]), np.flatnonzero(known[values])
    found = fields[:, vertices[first]].T.copy()
    found[free] = splu(matrix[free][:, free]).solve(-(matrix[free][:, fixed] @ found[fixed]))
    fields[:, vertices] = found[column].T


def _laplacian(section: ElementMesh) -> tuple[Cells, Any]:
    """Return the vertices (n,) of a section, and the matrix (n, n) of Laplace's equation on them."""
    corners = section.cells[:, : section.element.shape.vertices]
    vertices, numbers = np.unique(corners, return_inverse=True)
    return vertices, laplacian(section.points[vertices, :2], numbers.reshape(corners.shape))


NO_CONTACTS: Mapping[int, ContactRefinement] = MappingProxyType({})

TEETH_SIDES = {
    OutlineSide.RIGHT_ROOT: "right_root",
    OutlineSide.RIGHT_FILLET: "right_fillet",
    OutlineSide.RIGHT_FLANK: "right_flank",
    OutlineSide.TIP: "tip",
    OutlineSide.LEFT_FLANK: "left_flank",
    OutlineSide.LEFT_FILLET: "left_fillet",
    OutlineSide.LEFT_ROOT: "left_root",
}
"""Names of what each tooth has of its own; its number follows."""

_ACROSS = OTHER_SIDE | {other: side for side, other in OTHER_SIDE.items()}
_OF_RINGS = {side: TEETH_SIDES[_ACROSS[side]] for side in TEETH_SIDES}
"""Names of sides of a ring, whose teeth point the other way."""


def mesh_section(
    gear: Gear,
    *,
    teeth: int | None,
    held_radius: float,
    sizes: MeshSizes,
    element: Element,
    contacts: Mapping[int, ContactRefinement] = NO_CONTACTS,
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
    """Return the section at mid face width, not turned by the helix."""
    turns = modification_turns(mesh, gear, np.array([gear.half_width / 2])).at(0)
    cosine, sine = np.cos(turns), np.sin(turns)
    x, y, z = mesh.points.T
    return replace(mesh, points=np.stack([cosine * x - sine * y, sine * x + cosine * y, z], -1))


def teeth_of(gear: Gear, teeth: int | None) -> range:
    """Return the teeth that are meshed, in order, counted from tooth 0 both ways. Raises ParameterError."""
    if teeth is None:
        return range(gear.tooth_count)
    require_whole("teeth", teeth, at_least=1, at_most=gear.tooth_count - 1)
    if teeth % 2 == 0:
        raise ParameterError("teeth", teeth, "must be odd: tooth 0 stands in the middle")
    return range(-(teeth // 2), teeth // 2 + 1)


def _merged(gear: Gear, element: Element, teeth: range, sectors: Sequence[SectorSides], *, closed: bool) -> ElementMesh:
    """Sectors turned to the places of their teeth, nodes on common cuts once."""
    placed, named = list[Floats](), list[dict[str, Faces]]()
    for tooth, sector in zip(teeth, sectors, strict=True):
        placed.append(_turned(sector.points, 2 * math.pi * tooth / gear.tooth_count))
        names = _named(gear, sector, element, tooth % gear.tooth_count)
        if not closed:
            names |= _cuts(sector, element, tooth - teeth.start, len(teeth))
        named.append(names)
    return merged_sectors(element, sectors, placed, named, closed=closed, matched=not closed)


def merged_sectors(
    element: Element,
    sectors: Sequence[SectorSides],
    placed: Sequence[Floats],
    named: Sequence[Mapping[str, Faces]],
    *,
    closed: bool,
    matched: bool,
) -> ElementMesh:
    """Return sectors as one mesh: their nodes `placed` (n, 2) in mm, those on common cuts once, sides as they are `named`.

    In a `closed` ring the last sector meets the first. The outer cuts are pairs of nodes where they are `matched`.
    """
    numbers = _numbers(sectors, element.shape.vertices, closed=closed)
    points = np.zeros((1 + max(int(number.max()) for number in numbers), 3))
    cells, sides = list[Cells](), dict[str, list[Faces]]()
    elements = 0
    for sector, at, number, names in zip(sectors, placed, numbers, named, strict=True):
        points[number, :2] = at
        cells.append(number[sector.cells].astype(np.int32))
        for name, faces in names.items():
            sides.setdefault(name, []).append(faces.shifted(elements))
        elements += len(sector.cells)
    every = {name: _together(parts) for name, parts in sides.items()}
    pairs = {"cut": np.stack([numbers[0][sectors[0].behind], numbers[-1][sectors[-1].ahead]], -1)} if matched else {}
    return ElementMesh(element, points, np.concatenate(cells), {"gear": slice(0, elements)}, every, pairs)


def _numbers(sectors: Sequence[SectorSides], vertices: int, *, closed: bool) -> list[Wholes]:
    """Return the numbers (n,) that the nodes of each sector get in the whole: those on the cut behind it are its neighbour's
    ahead.
    """
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
    """Return the sides of a tooth's sector under the names that they have in the whole, without the cuts."""
    names = _OF_RINGS if gear.internal else TEETH_SIDES
    found = {f"{name}_{tooth}": faces_of(sector, side, element) for side, name in names.items() if side in sector.sides}
    found[body_side(gear)] = faces_of(sector, OutlineSide.HELD, element)
    return found


def _cuts(sector: SectorSides, element: Element, place: int, count: int) -> dict[str, Faces]:
    """Return the cuts that the sector in one of `count` places has beside no other."""
    found = {}
    if place == 0:
        found["cut_behind"] = faces_of(sector, OutlineSide.BEHIND, element)
    if place == count - 1:
        found["cut_ahead"] = faces_of(sector, OutlineSide.AHEAD, element)
    return found


def faces_of(sector: SectorSides, side: OutlineSide, element: Element) -> Faces:
    """Return the edges of a side of the outline. Each has its middle to itself, and that belongs to one element."""
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
    """Return the points (n, 2) turned by an angle (rad)."""
    cosine, sine = math.cos(turn), math.sin(turn)
    result: Floats = points @ np.array([[cosine, sine], [-sine, cosine]])
    return result

"""A rack as triangles, straight from the exact outline: flat strips along the teeth, closed by construction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.geometry.rack import Rack
from gearcad.solids.facets.tessellation import Facets, permitted_chord_error
from gearcad.solids.facets.tolerance import arc_step
from gearcad.solids.rack_plan import Piece, RackPlan, RackSide, outline_pieces

__all__ = ["rack_chord_error", "tessellate_rack"]

Triangles = list[tuple[int, int, int]]
Point = Sequence[float]


def rack_chord_error(rack: Rack, chord_error: float) -> float:
    """Return the chord error (mm) that facets of a rack have. Raises as `permitted_chord_error`."""
    size = max(rack.length, rack.face_width, rack.total_height)
    return permitted_chord_error(chord_error, size, "rack", rack.normal_module)


def tessellate_rack(rack: Rack, chord_error: float = 0.005) -> Facets:
    """Triangles of the whole rack, nowhere more than `chord_error` (mm) from the exact surface; only its fillets are curved.

    As a `Rack` lies: along x, teeth up (+y), z = 0 ... face width. Errors above 0.01 m_n are made that. Raises ParameterError
    for a chord error that is not positive, or below what the float32 of mesh files resolves.
    """
    builder = _Builder(rack, rack_chord_error(rack, chord_error))
    return Facets(builder.vertices, np.array(builder.faces(), np.int64))


def _lines(rack: Rack, chord_error: float) -> tuple[Floats, set[int]]:
    """Points (n, 2) of the outline over all c, and which of them are middles of spaces."""
    points, middles = list[tuple[float, float]](), set[int]()
    for piece in outline_pieces(rack):
        (c, y), (to_c, to_y) = piece.start, piece.end
        if piece.fillet is not None:
            if not (piece.mirrored or rack.profile.root_land):
                middles.add(len(points))
            points += _along_arc(piece, chord_error)
        elif y == to_y < rack.tip_height:
            middles.add(len(points) + 1)
            points += [(c, y), ((c + to_c) / 2, y)]
        else:
            points.append((c, y))
    return np.array(points), middles


def _along_arc(piece: Piece, chord_error: float) -> list[tuple[float, float]]:
    """Points of a fillet from its start, without its end; the chord error is kept in the end faces, too."""
    assert piece.fillet is not None
    steps = math.ceil(piece.fillet.last / arc_step(piece.fillet.radius, chord_error / piece.fillet.stretch))
    points = piece.fillet.points(np.linspace(0.0, 1.0, steps + 1))
    if piece.mirrored:
        points = points[::-1] * [-1, 1]
    points[0] = piece.start[0] - piece.middle, piece.start[1]
    return [(piece.middle + x, y) for x, y in points[:-1].tolist()]


class _Builder:
    """The vertices of one rack - those of its plan at their heights, then those of its back - and its faces."""

    def __init__(self, rack: Rack, chord_error: float) -> None:
        self.rack = rack
        lines, middles = _lines(rack, chord_error)
        self.plan = RackPlan(lines[:, 0], rack.drift, rack.length, rack.face_width)
        (x, z), c = self.plan.places.T, self.plan.along
        heights = np.where(self.plan.line >= 0, lines[self.plan.line, 1], np.interp(c, *lines.T))
        top = np.stack([x, heights, z], -1)
        # Below the middles of spaces the end faces are parted, so that their triangles stay short.
        below = [i for i, line in enumerate(self.plan.line.tolist()) if line in middles and z[i] in (0.0, rack.face_width)]
        below = list(dict.fromkeys([*self.plan.corners.values(), *below]))
        self.below = {number: len(top) + i for i, number in enumerate(below)}
        under = top[below]
        under[:, 1] = -rack.height
        self.vertices = np.concatenate([top, under])

    def faces(self) -> Triangles:
        """All triangles, counter-clockwise from outside."""
        chains = {side: self.plan.chain(side) for side in RackSide}
        found = self._strips()
        for side, chain in chains.items():
            found += self._end_face(side, chain)
        return found + self._back(chains[RackSide.BOTTOM], chains[RackSide.TOP])

    def _strips(self) -> Triangles:
        """Every strip as a fan: it is convex, and flat."""
        found: Triangles = []
        for strip in self.plan.strips:
            one, other = ([way[0].start, *(edge.end for edge in way)] for way in strip.ways)
            around = list(dict.fromkeys([*one, *reversed(other)]))
            found += [(around[0], a, b) for a, b in pairwise(around[1:])]
        return found

    def _end_face(self, side: RackSide, chain: Sequence[int]) -> Triangles:
        """An end face, in parts between the vertices that have one below them."""
        axis = 0 if side in (RackSide.BOTTOM, RackSide.TOP) else 2
        if side in (RackSide.BOTTOM, RackSide.TOP):
            cuts = [i for i, number in enumerate(chain) if number in self.below]
        else:
            cuts = [0, len(chain) - 1]
        found: Triangles = []
        for first, last in pairwise(cuts):
            part = list(chain[first : last + 1])
            found += self._mountain([self.below[part[0]], *part, self.below[part[-1]]], axis)
        # Seen along +z and -x, a mountain's triangles are clockwise as they are found.
        return found if side in (RackSide.TOP, RackSide.START) else [(a, c, b) for a, b, c in found]

    def _mountain(self, chain: Wholes | list[int], axis: int) -> Triangles:
        """Triangles between a chain that never runs back along an axis and the straight line that closes it below."""
        found, stack = list[tuple[int, int, int]](), list[tuple[int, Point]]()
        for number, point in zip(chain, self.vertices[chain][:, (axis, 1)].tolist(), strict=True):
            while len(stack) > 1 and _turn(stack[-2][1], stack[-1][1], point) < 0:
                found.append((stack[-2][0], int(number), stack[-1][0]))
                stack.pop()
            stack.append((int(number), point))
        assert len(stack) == 2
        return found

    def _back(self, bottom: Sequence[int], top: Sequence[int]) -> Triangles:
        """Between the lower edges of both end faces, by turns along x."""
        low, high = ([self.below[number] for number in chain if number in self.below] for chain in (bottom, top))
        x, found, i, j = self.vertices[:, 0], list[tuple[int, int, int]](), 0, 0
        while i < len(low) - 1 or j < len(high) - 1:
            if j == len(high) - 1 or (i < len(low) - 1 and x[low[i + 1]] <= x[high[j + 1]]):
                found.append((low[i], low[i + 1], high[j]))
                i += 1
            else:
                found.append((low[i], high[j + 1], high[j]))
                j += 1
        return found


def _turn(a: Point, b: Point, c: Point) -> float:
    """Positive where a, b, c turn left."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])

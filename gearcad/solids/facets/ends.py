"""Ends of teeth as triangles: plane face, chamfer cone, bolt holes, and strips between two chains of points.

Chains are given by polar angle (rad) and vertex number, counter-clockwise seen from +z; so are the triangles. Always the
chain goes on whose next edge has its middle first, which keeps every triangle's corners within half an edge of each other.

Within one tooth, profile points are numbered 0 ... period, and points added on its levels -1, -2, ...

A tooth is covered by strips between levels: pairs of profile points of equal radius. A level that lies on the cone, or
that must stand clear of something below, is an arc with points on a fixed set of angles, so that the strips run along
the generators of the cone and never fold; any other level is the straight line between its two profile points.

As on external teeth strips run between levels, but a ring's tooth grows outwards, and a straight line across it dips towards
the tip. So strips are tried from the tip on: straight, or as arcs of more and more chords until one is straight, on the cone as
arcs with points on its generators; the first whose triangles all face upwards is taken. Where none does, the fillets have
turned along the root circle. There strips end, and what is left of the fillets and the root lands between them make the chain.

Around each hole a window reaches from circle to circle, as wide as the centre of the hole sees of the inner one, or up to the
next window. Where a side of the window is nearest to that centre, the hole has a vertex for it, and every corner of the
window is joined to the vertices between those of its two sides: no line can cross the hole. Angles are radians in here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcad.core.records import Bools, Floats, Wholes, distinct
from gearcad.geometry import Body, Gear
from gearcad.solids.facets.sampling import ToothGrid, arc_step

Chain = tuple[Sequence[float], Sequence[int]]

_TIE = 1e-12
"""Angle (rad) that puts one edge before another edge with the same middle."""


def zip_levels(lower: Chain, upper: Chain) -> list[tuple[int, int, int]]:
    """Return the triangles between two open chains, `lower` nearer to the axis."""
    (a, inner), (b, outer) = lower, upper
    i = j = 0
    faces = []
    while i < len(a) - 1 or j < len(b) - 1:
        if j == len(b) - 1 or (i < len(a) - 1 and a[i] + a[i + 1] <= b[j] + b[j + 1]):
            faces.append((inner[i + 1], inner[i], outer[j]))
            i += 1
        else:
            faces.append((outer[j], outer[j + 1], inner[i]))
            j += 1
    return faces


def upright(corners: Floats, least: float) -> bool:
    """Return whether all triangles with corners (n, 3,
    2) in mm run counter-clockwise and are nowhere lower than `least` (mm).
    """
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    longest = np.hypot(*np.moveaxis(corners - np.roll(corners, 1, axis=1), -1, 0)).max(axis=1)
    return bool(np.all(area > least * longest))


def middles(angle: Floats) -> Floats:
    """Return the angle of the middle of every edge of a closed chain, in -pi ... pi."""
    middle = angle + 0.5 * np.mod(np.roll(angle, -1) - angle, 2 * np.pi)
    result: Floats = np.mod(middle + np.pi, 2 * np.pi) - np.pi
    return result


def keyway_order(order: Floats, wall: float, lower_wall: int, outer: Floats) -> Floats:
    """Return the order in which to zip the edges of a bore with keyway: their middles, `order`, with those of its walls moved.

    A wall runs radially, so its middle does not tell which outer points it faces: that must be one beyond the angle
    `wall` (rad) at which the bore ends. `lower_wall` is the number of that edge; the floor and the upper wall follow.
    `outer` are the angles of the points of the outer chain. The edges before and after keep their sequence.
    """
    points = np.sort(np.mod(outer + np.pi, 2 * np.pi) - np.pi)
    below = int(np.searchsorted(points, -wall, side="right"))
    above = int(np.searchsorted(points, wall, side="left"))
    first = 0.5 * (points[below - 1] + points[below]) - _TIE
    last = 0.5 * (points[above - 1] + points[above]) + _TIE
    result = np.clip(order, first, last)
    result[:lower_wall] = np.minimum(order[:lower_wall], first)
    result[lower_wall] = first
    result[lower_wall + 2] = last
    result[lower_wall + 3 :] = np.maximum(order[lower_wall + 3 :], last)
    return result


def zip_rings(inner: Wholes, inner_order: Floats, outer: Wholes, outer_order: Floats) -> Wholes:
    """Return the triangles (n, 3) between two closed chains around the axis, each zipped in the order of its edges' angles.

    Edge i runs from vertex i to vertex i + 1, and the last one back to the first; orders are in -pi ... pi.
    """
    inner, inner_order = _from_the_back(inner, inner_order)
    outer, outer_order = _from_the_back(outer, outer_order)
    opposite = np.searchsorted(outer_order, inner_order, side="left") % len(outer)
    facing = np.searchsorted(inner_order, outer_order, side="right") % len(inner)
    inside = np.stack([np.roll(inner, -1), inner, outer[opposite]], -1)
    outside = np.stack([outer, np.roll(outer, -1), inner[facing]], -1)
    return np.concatenate([inside, outside])


def _from_the_back(ring: Wholes, order: Floats) -> tuple[Wholes, Floats]:
    first = int(np.argmin(order))
    return np.roll(ring, -first), np.roll(order, -first)


@dataclass(frozen=True)
class GearEnd:
    """One end of a gear: its side's `first_vertex` there, what lies inside the teeth (mm), and the `step` of arcs (rad)."""

    first_vertex: int
    top: bool
    inner_radius: float
    step: float


@dataclass(frozen=True)
class Cap:
    """Vertices (n, 3) added, faces (m, 3) as seen from outside at the top, and the ring on the end plane with its angles."""

    vertices: Floats
    faces: Wholes
    ring: Wholes
    ring_angle: Floats


class ToothEnd:
    """The levels of tooth 0 on one end; `own` are the points added, each on a level at an angle."""

    def __init__(self, grid: ToothGrid, end: GearEnd, next_vertex: int) -> None:
        self.grid, self.end, self.next_vertex = grid, end, next_vertex
        self.z = grid.layers.width - grid.setback if end.top else grid.setback
        self.turn = grid.layers.turn(self.z)
        right, left = (turns[-1 if end.top else 0] for turns in grid.turns)
        self.right, self.left = right - grid.half_angle, left + grid.half_angle
        self.own: list[tuple[int, float]] = []

    def opposite(self, level: int) -> int:
        """Return the number of the point on the left flank."""
        return 2 * self.grid.flank_steps + self.grid.tip_steps - level

    def span(self, level: int) -> tuple[float, float]:
        """Return the angles of the right and the left flank there."""
        return self.turn[level] + self.right[level], self.turn[level] + self.left[level]

    def tip(self) -> Chain:
        """Return the angles and numbers along the tip land."""
        level, (right, left) = self.grid.flank_steps, self.span(self.grid.flank_steps)
        return np.linspace(right, left, self.grid.tip_steps + 1).tolist(), list(range(level, self.opposite(level) + 1))

    def chain(self, level: int, between: Sequence[float]) -> Chain:
        """Return the angles and numbers along a level from the right flank to the left one; adds points at the angles
        `between`.
        """
        right, left = self.span(level)
        first = len(self.own)
        self.own += [(level, angle) for angle in between]
        return [right, *between, left], [level, *(-1 - first - j for j in range(len(between))), self.opposite(level)]

    # ------------------------------------------------------------------ all teeth

    def numbers(self, tooth: Wholes) -> Wholes:
        """Vertex numbers for all teeth (teeth, ...) of the numbers used within one."""
        grid = self.grid
        which = np.arange(grid.teeth).reshape(-1, *(1 for _ in tooth.shape))
        on_side = self.end.first_vertex + (which * grid.period + tooth) % (grid.teeth * grid.period)
        result: Wholes = np.where(tooth >= 0, on_side, self.next_vertex + which * len(self.own) - 1 - tooth)
        return result

    def own_vertices(self) -> Floats:
        """Return the points added on all teeth (n, 3)."""
        level = np.array([i for i, _ in self.own], int)
        angle = np.array([a for _, a in self.own]) + 2 * math.pi / self.grid.teeth * np.arange(self.grid.teeth)[:, None]
        return points_at(self.grid.radius[level], angle, self.z[level])

    @property
    def end_plane(self) -> float:
        """Height z (mm) of the end plane."""
        return self.grid.layers.width if self.end.top else 0.0


def points_at(radius: Floats, angle: Floats, z: Floats) -> Floats:
    """Return the points (n, 3) from polar coordinates, broadcast together."""
    return np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), z), -1).reshape(-1, 3)


_CLEAR = 0.01
"""Share of the step within which a level has no point of its own near its ends."""


def cap_teeth(grid: ToothGrid, end: GearEnd, next_vertex: int) -> Cap:
    """Cover the teeth on one end; new vertices are numbered from `next_vertex`."""
    return _Capper(grid, end, next_vertex).cap()


class _Capper(ToothEnd):
    def __init__(self, grid: ToothGrid, end: GearEnd, next_vertex: int) -> None:
        super().__init__(grid, end, next_vertex)
        self.arcs = self._arc_angles()

    def cap(self) -> Cap:
        grid = self.grid
        levels = [self._level(i) for i in range(grid.flank_steps + 1)]
        tooth = np.array([face for low, high in pairwise(levels) for face in zip_levels(low, high)])
        foot_angle, foot = levels[0]
        land = np.arange(foot[-1] + 1, grid.period)
        pitch = 2 * math.pi / grid.teeth
        space = np.linspace(foot_angle[-1], foot_angle[0] + pitch, grid.root_steps + 1)[1:-1]
        start = None if grid.root_steps else -1  # no root land: the next tooth begins where this one ends
        ring = np.concatenate([np.array(foot[:start]), land]).astype(np.int64)
        angle = (np.concatenate([np.array(foot_angle[:start]), space]) + pitch * np.arange(grid.teeth)[:, None]).ravel()
        vertices, faces, around = self.own_vertices(), self.numbers(tooth), self.numbers(ring).ravel()
        if grid.cone.face_radius < grid.radius[0]:
            return self._down_the_cone(vertices, faces.reshape(-1, 3), around, angle)
        return Cap(vertices, faces.reshape(-1, 3), around, angle)

    def _arc_angles(self) -> list[Floats]:
        """For every level below the tip the angles at which it has points, if its ends leave room; none: a straight line."""
        grid = self.grid
        radius, right, left = grid.radius, self.right, self.left
        tip, nothing = grid.flank_steps, np.array([])
        first_on_cone = grid.face_level if grid.cone.present else tip
        foot = left[0] - right[0]
        gap = radius[0] - self.end.inner_radius
        most = math.sqrt(gap / radius[0]) if self.end.inner_radius else math.inf
        if first_on_cone < tip:
            land = np.linspace(right[tip], left[tip], grid.tip_steps + 1)
            beyond = self.end.step * np.arange(1, math.ceil(2 * math.pi / self.end.step))
            fixed = self.turn[tip] + distinct(np.concatenate([right[tip] - beyond, land, left[tip] + beyond]))
        else:
            fixed = self.turn[0] + np.linspace(right[0], left[0], math.ceil(foot / min(most, foot)) + 1)
        straight = foot <= most
        arcs = []
        for i in range(tip):
            straight = straight or (i > 0 and radius[i] * math.cos((left[i] - right[i]) / 2) > radius[i - 1])
            arcs.append(fixed if i >= first_on_cone or not straight else nothing)
        return arcs

    def _level(self, i: int) -> Chain:
        if i == self.grid.flank_steps:
            return self.tip()
        right, left = self.span(i)
        clear = _CLEAR * self.end.step
        fixed = self.arcs[i]
        return self.chain(i, fixed[(fixed > right + clear) & (fixed < left - clear)].tolist())

    def _down_the_cone(self, vertices: Floats, faces: Wholes, ring: Wholes, angle: Floats) -> Cap:
        """Return the cap continued along the cone's generators, as the cone reaches below the teeth, to its circle in the end
        plane.
        """
        circle = points_at(np.array(self.grid.cone.face_radius), angle, np.array(self.end_plane))
        inner = self.next_vertex + len(vertices) + np.arange(len(ring))
        outer_next, inner_next = np.roll(ring, -1), np.roll(inner, -1)
        strip = np.concatenate([np.stack([inner, ring, outer_next], -1), np.stack([inner, outer_next, inner_next], -1)])
        return Cap(np.concatenate([vertices, circle]), np.concatenate([faces, strip]), inner, angle)


_CHORDS = (1, 2, 4, 8, 16, 32)
"""Numbers of chords of an arc across a tooth."""


def cap_ring_teeth(grid: ToothGrid, end: GearEnd, next_vertex: int, least: float) -> Cap:
    """Cover the teeth on one end; new vertices are numbered from `next_vertex`. No triangle is lower than `least` (mm)."""
    return _RingCapper(grid, end, next_vertex, least).cap()


class _RingCapper(ToothEnd):
    def __init__(self, grid: ToothGrid, end: GearEnd, next_vertex: int, least: float) -> None:
        super().__init__(grid, end, next_vertex)
        self.least = least
        self.on_cone = self._generators()

    def cap(self) -> Cap:
        grid, pitch = self.grid, 2 * math.pi / self.grid.teeth
        faces, neck, (neck_angle, neck_number) = self._strips()
        below = range(neck)
        right, left = ([self.span(i)[side] for i in below] for side in (0, 1))
        angles = [*right, *neck_angle, *reversed(left)]
        space = np.linspace(angles[-1], angles[0] + pitch, grid.root_steps + 1)[1:-1]
        land = range(self.opposite(0) + 1, grid.period)
        stop = None if grid.root_steps else -1  # no root land: the next tooth begins where this one ends
        angle = np.array([*angles, *space][:stop], float)
        number = np.array([*below, *neck_number, *(self.opposite(i) for i in reversed(below)), *land][:stop], np.int64)
        level = np.array([*below, *(neck for _ in neck_number), *reversed(below), *(0 for _ in space)][:stop], np.int64)
        around = (angle + pitch * np.arange(grid.teeth)[:, None]).ravel()
        set_back = np.tile(grid.setback[level] > 0, grid.teeth)
        cap = Cap(self.own_vertices(), self.numbers(faces).reshape(-1, 3), self.numbers(number).ravel(), around)
        return self._up_the_cone(cap, set_back) if set_back.any() else cap

    # ------------------------------------------------------------------ strips

    def _strips(self) -> tuple[Wholes, int, Chain]:
        """Return the triangles of one tooth, and the outermost level to which they reach."""
        inner, faces = self.tip(), list[tuple[int, int, int]]()
        for level in reversed(range(self.grid.flank_steps)):
            before = len(self.own)
            for between in self._candidates(level, inner):
                outer = self.chain(level, between)
                strip = zip_levels(inner, outer)
                if self._faces_up(level, inner, outer, strip):
                    break
                del self.own[before:]
            else:
                return np.array(faces).reshape(-1, 3), level + 1, inner
            inner = outer
            faces += strip
        return np.array(faces).reshape(-1, 3), 0, inner

    def _candidates(self, level: int, inner: Chain) -> Iterator[list[float]]:
        """Yield the angles of points between both ends of a level, outside the chain `inner`."""
        right, left = self.span(level)
        if self.on_cone is not None and level >= self.grid.face_level:
            clear = _CLEAR * self.end.step
            yield self.on_cone[(self.on_cone > right + clear) & (self.on_cone < left - clear)].tolist()
            return
        straight = len(inner[0]) == 2
        for chords in _CHORDS[:1] if straight else _CHORDS:
            yield np.linspace(right, left, chords + 1)[1:-1].tolist()

    def _generators(self) -> Floats | None:
        """Return the angles of the points on the cone: those of the tip land, parted if need be,
        and further ones by the step.
        """
        grid, tip, step = self.grid, self.grid.flank_steps, self.end.step
        if not grid.cone.present or grid.face_level == tip:
            return None
        right, left = self.span(tip)
        parts = max(1, math.ceil((left - right) / max(grid.tip_steps, 1) / step - 1e-9))
        land = np.linspace(right, left, parts * grid.tip_steps + 1)
        beyond = step * np.arange(1, math.ceil(2 * math.pi / step))
        return distinct(np.concatenate([right - beyond, land, left + beyond]))

    def _faces_up(self, level: int, inner: Chain, outer: Chain, strip: list[tuple[int, int, int]]) -> bool:
        radius = self.grid.radius
        places = {
            number: (r * math.cos(angle), r * math.sin(angle))
            for (angles, numbers), r in ((inner, radius[level + 1]), (outer, radius[level]))
            for angle, number in zip(angles, numbers, strict=True)
        }
        return upright(np.array([[places[number] for number in face] for face in strip]), self.least)

    # ------------------------------------------------------------------ the cone beyond the strips

    def _up_the_cone(self, cap: Cap, set_back: Bools) -> Cap:
        """Return the cap continued along the cone's generators, where the chain lies on the cone, to its circle in the end
        plane.
        """
        count = int(set_back.sum())
        circle = points_at(np.array(self.grid.cone.face_radius), cap.ring_angle[set_back], np.array(self.end_plane))
        outer = cap.ring.copy()
        outer[set_back] = self.next_vertex + len(cap.vertices) + np.arange(count)
        following, beyond = np.roll(cap.ring, -1), np.roll(outer, -1)
        strip = np.concatenate(
            [
                np.stack([cap.ring, outer, beyond], -1)[set_back],
                np.stack([cap.ring, beyond, following], -1)[np.roll(set_back, -1)],
            ]
        )
        return Cap(np.concatenate([cap.vertices, circle]), np.concatenate([cap.faces, strip]), outer, cap.ring_angle)


_WALL_SHARE = 0.25
"""Largest share of a wall that the chords of the two circles may take up."""

_ONE = 0.02
"""Vertices of a hole closer than this share of its step are one."""


@dataclass(frozen=True)
class Plate:
    """`angles` (n,) of the points on both circles, of radius `inner` and `outer` (mm), and the outlines of all `holes`
    (holes, m, 2) in mm, counter-clockwise. `faces` number the inner circle's points, the outer one's, then the holes'.
    """

    angles: Floats
    inner: float
    outer: float
    holes: Floats
    faces: Wholes

    @property
    def circle(self) -> Floats:
        """Points (n, 2) of the inner circle in mm."""
        return self.inner * _directions(self.angles)

    @property
    def points(self) -> Floats:
        """All points (2 n + holes m, 2) in mm."""
        around = _directions(self.angles)
        return np.concatenate([self.inner * around, self.outer * around, self.holes.reshape(-1, 2)])


def bolt_plate(body: Body, free: float, rim: float, step: float, parts: int) -> Plate:
    """Return the plate of a ring whose teeth and cones end at the radius `free` (mm) and whose rim has the radius `rim` (mm).

    `step` (rad) of the chords of a hole; those of the two circles are parted into `parts` each.
    """
    count, middle, radius = body.bolt_holes, body.bolt_circle / 2, body.bolt_diameter / 2
    walls = middle - radius - free, rim - middle - radius
    inner, outer = middle - radius - min(walls[0] / 2, radius), middle + radius + min(walls[1] / 2, radius)
    half, between = _window(math.pi / count, math.asin(radius / middle), math.acos(inner / middle))
    chord = min(half, *(arc_step(at, _WALL_SHARE * wall) for at, wall in zip((inner, outer), walls, strict=True))) / parts
    across, apart = math.ceil(2 * half / chord), math.ceil(2 * between / chord)
    first = np.concatenate([np.linspace(-half, half, across + 1), np.linspace(half, half + 2 * between, apart + 1)[1:]])
    pitch, each = 2 * math.pi / count, across + apart
    angles = (first[:each] + pitch * np.arange(count)[:, None]).ravel()
    window = _directions(first[: across + 1])
    corners = np.concatenate([inner * window[:1], outer * window, inner * window[:0:-1]]) - [middle, 0.0]
    outline, collar = _collar(corners, radius, step)
    low, beyond = np.arange(across, each), each + 1  # points of the outer circle are numbered from `beyond` on, holes' after
    high = low + beyond
    window_and_hole = (
        np.zeros(1, int),
        beyond + np.arange(across + 1),
        np.arange(across, 0, -1),
        2 * beyond + np.arange(len(outline)),
    )
    faces = np.concatenate(
        [
            np.concatenate(window_and_hole)[collar],
            np.stack([low, high, high + 1], -1),
            np.stack([low, high + 1, low + 1], -1),
        ]
    )
    kind = np.minimum(faces // beyond, 2)
    index, hole = faces - kind * beyond, np.arange(count)[:, None, None]
    on_circle = (index + hole * each) % len(angles) + kind * len(angles)
    numbers = np.where(kind < 2, on_circle, 2 * len(angles) + hole * len(outline) + index)
    holes = np.stack([(outline + np.array([middle, 0.0])) @ _turn(angle) for angle in pitch * np.arange(count)])
    return Plate(angles, inner, outer, holes, numbers.reshape(-1, 3))


def _window(share: float, least: float, most: float) -> tuple[float, float]:
    """Return half the angle of a window about the axis, and half of what lies between two windows.

    `share` of a hole is half a pitch, `least` what the hole itself takes, `most` what its centre sees of the inner circle.
    """
    half = (least + most) / 2
    return (share, 0.0) if share <= (half + most) / 2 else (half, share - half)


def _collar(corners: Floats, radius: float, step: float) -> tuple[Floats, Wholes]:
    """Return the outline (m, 2) of a hole about (0, 0), and faces between it and the corners (n, 2) of a window around it.

    Faces number the corners, then the outline.
    """
    sides = np.roll(corners, -1, axis=0) - corners
    along = np.clip(-np.sum(corners * sides, -1) / np.sum(sides**2, -1), 0.0, 1.0)
    nearest = corners + along[:, None] * sides
    foot = np.unwrap(np.arctan2(nearest[:, 1], nearest[:, 0]))
    before = np.r_[foot[-1] - 2 * math.pi, foot[:-1]]
    chords = np.where(foot - before < _ONE * step, 0, np.ceil((foot - before) / step)).astype(int)  # up to the foot of a side
    total, ends = int(chords.sum()), np.cumsum(chords)
    stretches = zip(before, foot, chords, strict=True)
    angles = np.concatenate([np.linspace(start, end, n, endpoint=False) for start, end, n in stretches])
    count = len(corners)
    side = np.arange(count)
    fans = np.repeat(side, chords)
    outline = np.arange(total)
    faces = np.concatenate(
        [
            np.stack([side, (side + 1) % count, count + ends % total], -1),
            np.stack([count + outline, fans, count + (outline + 1) % total], -1),
        ]
    )
    return radius * _directions(angles), faces


def _directions(angle: Floats) -> Floats:
    return np.stack([np.cos(angle), np.sin(angle)], -1)


def _turn(angle: float) -> Floats:
    """Return the matrix (2, 2) by which points (n, 2) are multiplied to turn them counter-clockwise; `angle` in radians."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine], [-sine, cosine]])


LEAST_SIDES = 8
"""Least number of sides of a hole, however small it is."""


class Builder:
    """Collects the vertices and faces of one gear."""

    def __init__(self, gear: Gear, grid: ToothGrid, chord_error: float) -> None:
        self.gear, self.grid, self.chord_error = gear, grid, chord_error
        self.vertices: list[Floats] = []
        self.faces: list[Wholes] = []
        self.count = 0

    def add(self, points: Floats) -> Wholes:
        """Append points (n, 3); their vertex numbers."""
        self.vertices.append(points)
        self.count += len(points)
        return np.arange(self.count - len(points), self.count)

    def side(self) -> Wholes:
        """Return the faces of all teeth, away from the axis: layers x teeth x period,
        every cell cut along its better diagonal.
        """
        grid, layers = self.grid, self.grid.layers
        radius, setback, angle = grid.outline
        z = layers.heights(setback)[:, None, :]
        turn = angle[:, None, :] + 2 * np.pi / grid.teeth * np.arange(grid.teeth)[:, None] + layers.turn(z)
        x, y, z = np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), z)
        numbers = self.add(np.stack([x, y, z], -1).reshape(-1, 3)).reshape(layers.count + 1, -1)
        a, d = numbers[:-1], numbers[1:]
        b, c = np.roll(a, -1, axis=1), np.roll(d, -1, axis=1)
        falling = np.tile(grid.falling_cells, grid.teeth)
        first = np.stack([a, b, np.where(falling, d, c)], -1)
        second = np.stack([np.where(falling, b, a), c, d], -1)
        faces: Wholes = np.stack([first, second], -2).reshape(-1, 3)
        return faces

    def circle(self, radius: float, parts: int = 1) -> Floats:
        """Return the points (n, 2) in mm of a regular polygon about the axis, from the far side; sides that would do in `parts`
        each.
        """
        sides = parts * max(LEAST_SIDES, math.ceil(2 * math.pi / arc_step(radius, self.chord_error)))
        angle = -np.pi + 2 * np.pi / sides * np.arange(sides)
        return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def wall(low: Wholes, high: Wholes) -> Wholes:
    """Wall between two equal rings, facing away from the axis."""
    following, above = np.roll(low, -1), np.roll(high, -1)
    return np.concatenate([np.stack([low, following, above], -1), np.stack([low, above, high], -1)])

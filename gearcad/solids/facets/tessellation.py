"""Gears and racks as triangles, straight from the exact profile: structured and closed by construction."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from gearcad.core.errors import ParameterError, SolverError, at_least, require_number
from gearcad.core.records import Floats, Wholes
from gearcad.geometry import Body, Gear
from gearcad.geometry.bore_teeth import bore_teeth
from gearcad.geometry.gear import halves
from gearcad.geometry.rack import Rack
from gearcad.solids.body_plan import OutlinePiece, RackPlan, RackSide, keyway_half_angle, outline_pieces, require_rim
from gearcad.solids.facets.ends import (
    LEAST_SIDES,
    Builder,
    GearEnd,
    Plate,
    bolt_plate,
    cap_ring_teeth,
    cap_teeth,
    keyway_order,
    middles,
    upright,
    wall,
    zip_rings,
)
from gearcad.solids.facets.sampling import ToothGrid, arc_step, least_distance, outermost_radius, tooth_grid

if TYPE_CHECKING:
    from trimesh import Trimesh


class DiscBuilder(Builder):
    """Builder of the triangles of an external gear."""

    def __init__(self, gear: Gear, grid: ToothGrid, chord_error: float) -> None:
        super().__init__(gear, grid, chord_error)
        self.faces.append(self.side())
        back, front = gear.body.hub_ends
        self.opening = self._opening(-back, gear.face_width + front, bore_teeth(gear))
        self._end(top=False, hub=back)
        self._end(top=True, hub=front)

    def _opening(
        self, bottom: float, top: float, teeth: Gear | None, *, open_top: bool = False
    ) -> tuple[Floats, Wholes, Wholes] | None:
        """Add the wall of the bore, with its keyway or its `teeth`, and a circle about these at the ends that are not open.

        Return the angles of the points at the ends, and their numbers at the bottom and at the top. None without a bore.
        """
        body = self.gear.body
        self.opening_radius = body.opening_diameter / 2
        if not body.bore:
            return None
        if teeth is not None:
            self.opening_radius += _COLLAR * (self._least_outside - self.opening_radius)
            bore = _BoreBuilder(
                replace(teeth, face_width=top - bottom), self.opening_radius, self.chord_error, open_top=open_top
            )
            first = self.count
            self.add(np.concatenate(bore.vertices) + np.array([0.0, 0.0, bottom]))
            self.faces += [faces + first for faces in bore.faces]
            return bore.around, bore.low + first, bore.high + first
        loop = self.circle(body.bore / 2)
        if body.keyway_width:
            loop = _keyed_bore(body, 2 * np.pi / len(loop))
        low, high = (self.add(np.column_stack([loop, np.full(len(loop), z)])) for z in (bottom, top))
        self.faces.append(wall(low, high)[:, ::-1])
        return np.arctan2(loop[:, 1], loop[:, 0]), low, high

    @property
    def _least_outside(self) -> float:
        """Least radius (mm) of what surrounds the bore on an end: roots, cone, hub, or the ground of a gap."""
        gear, cone = self.gear, self.grid.cone
        radii = [gear.root_diameter / 2, *([cone.face_radius] if cone.present else [])]
        if gear.double_helix.gap_width:
            radii.append(gear.gap_diameter / 2)
        return min([*radii, *([gear.body.hub_diameter / 2] if gear.body.hub_diameter else [])])

    def _tooth_end(self, inner_radius: float, *, top: bool) -> GearEnd:
        """Return one end of the teeth around something of a radius (mm)."""
        first = self.grid.layers.count * self.grid.teeth * self.grid.period if top else 0
        step = arc_step(self.gear.tip_diameter / 2, self.chord_error)
        return GearEnd(first_vertex=first, top=top, inner_radius=inner_radius, step=step)

    def _end(self, *, top: bool, hub: float) -> None:
        """End faces of teeth, cone, hub of a length (mm) and bore. Built as seen from outside at the top, turned over below."""
        body, faces = self.gear.body, list[Wholes]()
        z = self.gear.face_width if top else 0.0
        inner = body.hub_diameter / 2 if hub else self.opening_radius
        cap = cap_teeth(self.grid, self._tooth_end(inner, top=top), self.count)
        self.add(cap.vertices)
        faces.append(cap.faces)
        ring, angle = cap.ring, cap.ring_angle
        if hub:
            circle = self.circle(body.hub_diameter / 2)
            far = z + hub if top else z - hub
            near_ring, far_ring = (self.add(np.column_stack([circle, np.full(len(circle), level)])) for level in (z, far))
            around = np.arctan2(circle[:, 1], circle[:, 0])
            faces += [zip_rings(near_ring, middles(around), ring, middles(angle)), wall(near_ring, far_ring)]
            ring, angle, z = far_ring, around, far
        faces.append(self._centre(ring, angle, z, top=top))
        found = np.concatenate(faces)
        self.faces.append(found if top else found[:, ::-1])

    def _centre(self, ring: Wholes, angle: Floats, z: float, *, top: bool) -> Wholes:
        """Return the triangles from the innermost ring of an end to the bore, or to a point on the axis."""
        if self.opening is None:
            middle = self.add(np.array([[0.0, 0.0, z]]))
            return np.stack([np.repeat(middle, len(ring)), ring, np.roll(ring, -1)], -1)
        around, low, high = self.opening
        order, body = middles(around), self.gear.body
        if body.keyway_width:
            order = keyway_order(order, keyway_half_angle(body), (len(order) - 3) // 2, angle)
        return zip_rings(high if top else low, order, ring, middles(angle))


def _keyed_bore(body: Body, step: float) -> Floats:
    """Return the outline (2 h + 3, 2) of a bore with keyway, from the far side: h chords, wall, floor, wall, h chords."""
    radius, half_width, ends = body.bore / 2, body.keyway_width / 2, keyway_half_angle(body)
    angle = np.linspace(ends, np.pi, math.ceil((np.pi - ends) / step) + 1)
    upper = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    floor = [[radius + body.keyway_depth, -half_width], [radius + body.keyway_depth, half_width]]
    return np.concatenate([(upper * [1, -1])[::-1], floor, upper[:-1]])


_COLLAR = 0.3
"""Share of the wall about the teeth of a splined bore up to which its own triangles reach."""

_Made = TypeVar("_Made")

_PARTS = tuple(2**n for n in range(11))
"""Into how many parts the chords of a circle are parted, until no triangle between it and what it surrounds is folded."""


class _Loop(NamedTuple):
    """A closed chain on an end plane: vertex numbers, angles (rad), and points (n, 2) in mm."""

    numbers: Wholes
    angle: Floats
    points: Floats


class RingBuilder(Builder):
    """Builds a ring. Its ends are built as seen from outside at the top, the lower one turned over."""

    def __init__(self, gear: Gear, grid: ToothGrid, chord_error: float) -> None:
        super().__init__(gear, grid, chord_error)
        self.rim = require_rim(gear) / 2
        self.faces.append(self.side()[:, ::-1])
        self.ends = {top: self._teeth(top=top) for top in (False, True)}
        if gear.body.bolt_holes:
            self._add_plate(self._plate())
        circle = self._rim_circle()
        low, high = (self._surround(circle, top=top).numbers for top in (False, True))
        self.faces.append(wall(low, high))

    def _rim_circle(self) -> Floats:
        """Return the points (n, 2) in mm of the circle that closes both ends."""
        return self._fitted(lambda parts: self.circle(self.rim, parts), lambda circle: circle)

    def _height(self, *, top: bool) -> float:
        return self.gear.face_width if top else 0.0

    def _add_faces(self, faces: Wholes, *, top: bool) -> None:
        self.faces.append(faces if top else faces[:, ::-1])

    def _teeth(self, *, top: bool) -> _Loop:
        """End faces of the teeth; the chain around them."""
        grid, gear = self.grid, self.gear
        first = grid.layers.count * grid.teeth * grid.period if top else 0
        end = GearEnd(first_vertex=first, top=top, inner_radius=0.0, step=arc_step(self._widest, self.chord_error))
        cap = cap_ring_teeth(grid, end, self.count, least_distance(gear, self.chord_error))
        self.add(cap.vertices)
        self._add_faces(cap.faces, top=top)
        return _Loop(cap.ring, cap.ring_angle, np.concatenate(self.vertices)[cap.ring, :2])

    @property
    def _widest(self) -> float:
        """Radius (mm) to which teeth and cones reach."""
        reach, cone = outermost_radius(self.gear), self.grid.cone
        return max(reach, cone.face_radius) if cone.present else reach

    # ------------------------------------------------------------------ circles

    def _fitted(self, made: Callable[[int], _Made], circle_of: Callable[[_Made], Floats]) -> _Made:
        """Return the parts made in the first number in which no end triangle is folded between their circle and what is inside.

        Raises SolverError if no number of parts fits.
        """
        least = least_distance(self.gear, self.chord_error)
        for parts in _PARTS:
            found = made(parts)
            points = circle_of(found)
            angle = np.arctan2(points[:, 1], points[:, 0])
            if all(upright(np.concatenate([each.points, points])[_between(each, angle)], least) for each in self.ends.values()):
                return found
        raise SolverError(
            f"the end faces of this ring cannot be divided into triangles within {self.chord_error:g} mm: "
            "give another chord_error"
        )

    def _surround(self, circle: Floats, *, top: bool) -> _Loop:
        """Add a circle to an end and the faces up to it; the circle is then the new boundary to be surrounded."""
        inner = self.ends[top]
        numbers = self.add(np.column_stack([circle, np.full(len(circle), self._height(top=top))]))
        outer = _Loop(numbers, np.arctan2(circle[:, 1], circle[:, 0]), circle)
        faces = _between(inner, outer.angle)
        self._add_faces(np.concatenate([inner.numbers, numbers])[faces], top=top)
        self.ends[top] = outer
        return outer

    # ------------------------------------------------------------------ bolt holes

    def _plate(self) -> Plate:
        body = self.gear.body
        step = min(arc_step(body.bolt_diameter / 2, self.chord_error), 2 * math.pi / LEAST_SIDES)

        def plate(parts: int) -> Plate:
            return bolt_plate(body, self._widest, self.rim, step, parts)

        return self._fitted(plate, lambda found: found.circle)

    def _add_plate(self, plate: Plate) -> None:
        """Faces around the holes on both ends, and the walls of the holes."""
        walls = list[Wholes]()
        for top in (False, True):
            inner = self._surround(plate.circle, top=top)
            rest = plate.points[len(plate.circle) :]
            numbers = np.concatenate(
                [inner.numbers, self.add(np.column_stack([rest, np.full(len(rest), self._height(top=top))]))]
            )
            self._add_faces(numbers[plate.faces], top=top)
            outside = slice(len(plate.circle), 2 * len(plate.circle))
            self.ends[top] = _Loop(numbers[outside], inner.angle, plate.points[outside])
            walls.append(numbers[outside.stop :].reshape(plate.holes.shape[:2]))
        for low, high in zip(*walls, strict=True):
            self.faces.append(wall(low, high)[:, ::-1])


class _BoreBuilder(RingBuilder):
    """Builds the teeth of a splined bore, and both ends up to a circle of a radius (mm); the upper one may be left open.

    `around` are the angles (rad) of the points on the circle, `low` and `high` their numbers on both ends; of an open end
    those of the teeth.
    """

    def __init__(self, teeth: Gear, radius: float, chord_error: float, *, open_top: bool) -> None:
        error = min(chord_error, _MOST_CHORD_ERROR * teeth.normal_module)
        Builder.__init__(self, teeth, tooth_grid(teeth, error), error)
        self.rim = radius
        self.faces.append(self.side()[:, ::-1])
        each_layer = self.grid.teeth * self.grid.period
        self.ends = {top: self._teeth(top=top) for top in ((False,) if open_top else (False, True))}
        circle = self._rim_circle()
        self.around: Floats = np.arctan2(circle[:, 1], circle[:, 0])
        self.low = self._surround(circle, top=False).numbers
        last = self.grid.layers.count * each_layer
        self.high = last + np.arange(each_layer) if open_top else self._surround(circle, top=True).numbers


def _between(inner: _Loop, angle: Floats) -> Wholes:
    """Return the triangles between a chain and a circle around it with points at these angles; they number the chain's points
    first.
    """
    count = len(inner.angle)
    return zip_rings(np.arange(count), middles(inner.angle), count + np.arange(len(angle)), middles(angle))


def double_facets(gear: Gear, chord_error: float) -> tuple[Floats, Wholes]:
    """Return the vertices (n, 3) in mm and faces (m, 3) of a double helical gear, within `chord_error` (mm) of the exact
    surface.
    """
    half = halves(gear)[0].gear
    grid = tooth_grid(half, chord_error, apex=not gear.double_helix.gap_width)
    pitch = 2 * math.pi / gear.tooth_count
    turned = replace(grid, layers=replace(grid.layers, start=pitch * gear.double_helix.offset))
    back, front = gear.body.hub_ends
    lower = _HalfBuilder(gear, half, grid, chord_error, back)
    upper = _HalfBuilder(gear, half, turned, chord_error, front)
    mirrored = np.concatenate(upper.vertices) * [1, 1, -1] + [0, 0, gear.face_width]
    numbers = lower.count + np.arange(upper.count)
    numbers[upper.open] = lower.open
    faces = np.concatenate([*lower.faces, numbers[np.concatenate(upper.faces)][:, ::-1]])
    vertices = np.concatenate([*lower.vertices, mirrored])
    used, again = np.unique(faces, return_inverse=True)
    return vertices[used], again.reshape(faces.shape)


class _HalfBuilder(DiscBuilder):
    """Builds the lower half, with a hub of a length (mm) below, up to the middle of the gear: `open` are vertices there."""

    def __init__(self, whole: Gear, half: Gear, grid: ToothGrid, chord_error: float, hub: float) -> None:
        Builder.__init__(self, half, grid, chord_error)
        middle = whole.face_width / 2
        self.faces.append(self.side())
        self.opening = self._opening(-hub, middle, bore_teeth(whole), open_top=True)
        self._end(top=False, hub=hub)
        rings = [self._gap(whole.gap_diameter / 2, middle)] if whole.double_helix.gap_width else [self._apex()]
        if self.opening is not None:
            rings.append(self.opening[2])
        self.open: Wholes = np.concatenate(rings)

    def _apex(self) -> Wholes:
        """Return the outline of all teeth in the middle."""
        around = self.grid.teeth * self.grid.period
        return self.grid.layers.count * around + np.arange(around)

    def _gap(self, radius: float, middle: float) -> Wholes:
        """Return the inner end of the teeth, and the ground of the gap (mm) up to the middle."""
        cap = cap_teeth(self.grid, self._tooth_end(radius, top=True), self.count)
        self.add(cap.vertices)
        circle, heights = self.circle(radius), (self.gear.face_width, middle)
        near, far = (self.add(np.column_stack([circle, np.full(len(circle), z)])) for z in heights)
        around = np.arctan2(circle[:, 1], circle[:, 0])
        self.faces += [cap.faces, zip_rings(near, middles(around), cap.ring, middles(cap.ring_angle)), wall(near, far)]
        return far


_LEAST_CHORD_ERROR = 2e-7
"""Least chord error as a share of the tip diameter: mesh files hold float32, which steps by up to 6e-8 of it."""

_MOST_CHORD_ERROR = 0.01
"""Coarsest chord error in normal modules, so that small teeth keep their shape; a tenth of the thinnest wall."""


@dataclass(frozen=True)
class Facets:
    """A closed surface of triangles: `vertices` (n, 3) in mm, `faces` (m, 3), counter-clockwise from outside; read-only."""

    vertices: Floats
    faces: Wholes

    def __post_init__(self) -> None:
        self.vertices.flags.writeable = False
        self.faces.flags.writeable = False

    @property
    def volume(self) -> float:
        """Enclosed volume in mm³."""
        a, b, c = (self.vertices[self.faces[:, corner]] for corner in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6

    def to_trimesh(self) -> Trimesh:
        """Return the surface as a `trimesh.Trimesh` in mm, for its sections, mass properties and tests of watertightness."""
        from trimesh import Trimesh

        return Trimesh(self.vertices.copy(), self.faces.copy(), process=False)


def permitted_chord_error(chord_error: float, size: float, words: str, module: float) -> float:
    """Return the chord error (mm) for a part of a size (mm) and normal module: that asked for, at most 0.01 modules.

    Raises ParameterError for one that is not positive, or below what the float32 of mesh files resolves.
    """
    require_number("chord_error", chord_error, "mm", above=0)
    if chord_error < (least := _LEAST_CHORD_ERROR * size):
        permitted = f"must be at least {at_least(least)} mm for a {words} of {size:.6g} mm (single precision)"
        raise ParameterError("chord_error", chord_error, permitted, "mm")
    return min(chord_error, _MOST_CHORD_ERROR * module)


def gear_chord_error(gear: Gear, chord_error: float) -> float:
    """Return the chord error (mm) that facets of a gear have. Raises as `permitted_chord_error`, and GeometryError."""
    outside, words = (require_rim(gear), "rim diameter") if gear.internal else (gear.tip_diameter, "tip diameter")
    return permitted_chord_error(chord_error, outside, words, gear.normal_module)


def tessellate(gear: Gear, chord_error: float = 0.005) -> Facets:
    """Return the triangles of the whole gear with its flanks as modified, nowhere more than `chord_error` (mm) from the exact
    surface.

    Teeth from z = 0 to the face width, hubs beyond. Errors above 0.01 m_n are made that, so that small teeth keep their
    shape. Raises ParameterError for a chord error that is not positive, or below what the float32 of mesh files resolves,
    GeometryError for a ring without a rim.
    """
    error = gear_chord_error(gear, chord_error)
    if gear.double_helix.present:
        return Facets(*double_facets(gear, error))
    grid = tooth_grid(gear, error)
    builder = (RingBuilder if gear.internal else DiscBuilder)(gear, grid, error)
    return Facets(np.concatenate(builder.vertices), np.concatenate(builder.faces))


Triangles = list[tuple[int, int, int]]
Point = Sequence[float]


def rack_chord_error(rack: Rack, chord_error: float) -> float:
    """Return the chord error (mm) that facets of a rack have. Raises as `permitted_chord_error`."""
    size = max(rack.length, rack.face_width, rack.total_height)
    return permitted_chord_error(chord_error, size, "rack", rack.normal_module)


def tessellate_rack(rack: Rack, chord_error: float = 0.005) -> Facets:
    """Return the triangles of the whole rack, nowhere more than `chord_error` (mm) from the exact surface; only its fillets are
    curved.

    As a `Rack` lies: along x, teeth up (+y), z = 0 ... face width. Errors above 0.01 m_n are made that. Raises ParameterError
    for a chord error that is not positive, or below what the float32 of mesh files resolves.
    """
    builder = _Builder(rack, rack_chord_error(rack, chord_error))
    return Facets(builder.vertices, np.array(builder.faces(), np.int64))


def _lines(rack: Rack, chord_error: float) -> tuple[Floats, set[int]]:
    """Return the points (n, 2) of the outline over all c, and which of them are middles of spaces."""
    points, middles = list[tuple[float, float]](), set[int]()
    for piece in outline_pieces(rack):
        (c, y), (to_c, to_y) = piece.start, piece.end
        if piece.fillet is not None:
            if not (piece.mirrored or piece.fillet.first or rack.profile.root_land):
                middles.add(len(points))
            points += _along_arc(piece, chord_error)
        elif y == to_y < rack.tip_height:
            middles.add(len(points) + 1)
            points += [(c, y), ((c + to_c) / 2, y)]
        else:
            points.append((c, y))
    return np.array(points), middles


def _along_arc(piece: OutlinePiece, chord_error: float) -> list[tuple[float, float]]:
    """Return the points of a fillet from its start, without its end; the chord error is kept in the end faces, too."""
    assert piece.fillet is not None
    steps = math.ceil(
        (piece.fillet.last - piece.fillet.first) / arc_step(piece.fillet.radius, chord_error / piece.fillet.stretch)
    )
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
        # A corner through which no line goes may lie on a fillet, below the chord between the lines beside it.
        for piece in (each for each in outline_pieces(rack) if each.fillet is not None):
            for i in np.flatnonzero((self.plan.line < 0) & (piece.start[0] < c) & (c < piece.end[0])):
                heights[i] = piece.height(float(c[i]))
        top = np.stack([x, heights, z], -1)
        # Below the middles of spaces the end faces are parted, so that their triangles stay short.
        below = [i for i, line in enumerate(self.plan.line.tolist()) if line in middles and z[i] in (0.0, rack.face_width)]
        below = list(dict.fromkeys([*self.plan.corners.values(), *below]))
        self.below = {number: len(top) + i for i, number in enumerate(below)}
        under = top[below]
        under[:, 1] = -rack.height
        self.vertices = np.concatenate([top, under])

    def faces(self) -> Triangles:
        """Return all triangles, counter-clockwise from outside."""
        chains = {side: self.plan.chain(side) for side in RackSide}
        found = self._strips()
        for side, chain in chains.items():
            found += self._end_face(side, chain)
        return found + self._back(chains[RackSide.BOTTOM], chains[RackSide.TOP])

    def _strips(self) -> Triangles:
        """Return every strip as a fan: it is convex, and flat."""
        found: Triangles = []
        for strip in self.plan.strips:
            one, other = ([way[0].start, *(edge.end for edge in way)] for way in strip.ways)
            around = list(dict.fromkeys([*one, *reversed(other)]))
            found += [(around[0], a, b) for a, b in pairwise(around[1:])]
        return found

    def _end_face(self, side: RackSide, chain: Sequence[int]) -> Triangles:
        """Return an end face, in parts between the vertices that have one below them."""
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
        """Return the triangles between a chain that never runs back along an axis and the straight line
        that closes it below.
        """
        found, stack = list[tuple[int, int, int]](), list[tuple[int, Point]]()
        for number, point in zip(chain, self.vertices[chain][:, (axis, 1)].tolist(), strict=True):
            while len(stack) > 1 and _turn(stack[-2][1], stack[-1][1], point) < 0:
                found.append((stack[-2][0], int(number), stack[-1][0]))
                stack.pop()
            stack.append((int(number), point))
        assert len(stack) == 2
        return found

    def _back(self, bottom: Sequence[int], top: Sequence[int]) -> Triangles:
        """Return the triangles between the lower edges of both end faces, in the order of x."""
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

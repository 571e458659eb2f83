"""Corners of the triangles of a tooth, so that none leaves the surface by more than the chord error.

The exact side of a tooth is a screw surface S(s, z) = R(kappa z) C(s). Its triangles are halves of the cells of a grid of
profile points and layers. The deviation of an edge that spans ds and dz is, to second order and along the normal,

    |A + B D + C D^2| / |n|     with D = kappa dz (rad)

A: sagitta of the profile, C: sagitta of the helix, B: their mixed (twist) term.

With the unit tangent t of the section, its curvature k and n = i t, the Gaussian curvature of S has the sign of -(1 + k n.C),
and 1 + k n.C is what the moment t.C of the section's normal about the axis gains along its length. On lands that stays 0, on
involutes r_b or -r_b; straight chamfers gain 1. On a fillet the normal passes through the pitch point (on a form root through
the middle of the corner) and turns away from the line to the axis, so its moment grows from 0 at the root circle. External
teeth, hobbed or shaped, go outwards there: t.C gains, no part of their side has a curvature above zero, a triangle deviates
nowhere more than on its edges, and with the better of its two diagonals a cell is hardly worse than its sides. On a ring they
go inwards: t.C falls from 0 to -r_b, fillets of helical rings bulge, and a triangle deviates most inside: see `_inside`.

On modified flanks the deviation is that of the middle of the edge from the surface. Angles are radians in here.

Profile points by layers make the cells of a grid, on the exact or the modified surface. Angles are radians in here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Bools, Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, parameters_within
from gearcad.geometry.gear import FlankCurve, flank_curves
from gearcad.geometry.gear_data import twist
from gearcad.solids.body_plan import EndCone

_CONVEX = 0.75
"""Share of the chord error for the edges on modified flanks: a triangle on a convex place deviates up to 4/3 as much inside."""


HELIX_SHARE = 0.6
"""Share of the chord error that layers use up on helical rings: on their fillets the bend of the profile adds to it."""


def outermost_radius(gear: Gear) -> float:
    """Return the radius (mm) of the circle that the toothed side reaches out to: the tips, on a ring the roots."""
    return max(gear.profile.tip_diameter, gear.profile.root_diameter) / 2


def arc_step(radius: float, chord_error: float) -> float:
    """Return the largest angle (rad) that a chord of a circle may span within `chord_error` (mm)."""
    return 2 * math.acos(max(1 - chord_error / radius, 0.5))


def least_distance(gear: Gear, chord_error: float) -> float:
    """Return the distance (mm) below which two points are made one: nothing against the chord error,
    or two steps of a float32.
    """
    return max(1e-3 * chord_error, 3e-7 * outermost_radius(gear))


def aim_for(gear: Gear, chord_error: float) -> float:
    """Return the largest deviation (mm) of an edge that keeps a gear's triangles within `chord_error` (mm)."""
    return _CONVEX * chord_error if gear.modification.present else chord_error


_MARGIN = 20.0
"""Least stretch of a column beyond a cone, in chord errors: the corner where a relief begins is off the layers by no more."""


@dataclass(frozen=True)
class Layers:
    """Copies of the section between the ends, turned by `kappa` (rad/mm, signed) per height, over `width` (mm).

    `knots` are the heights (mm) of the layers that every column has, both ends first and last; `counts` the number of
    layers between them. A column that a cone cuts short of a knot has `margin` (mm) for the layers up to it. The section at
    z = 0 is turned by `start` (rad). An `apex` is an upper end where a mirror image goes on: no cone cuts columns short there.
    """

    kappa: float
    width: float
    knots: tuple[float, ...]
    counts: tuple[int, ...]
    margin: float = 0.0
    start: float = 0.0
    apex: bool = False

    @classmethod
    def of(cls, gear: Gear, chord_error: float) -> Layers:
        kappa = twist(gear)
        width = gear.face_width
        if not gear.modification.present:
            step = arc_step(outermost_radius(gear), HELIX_SHARE * chord_error if gear.internal else chord_error)
            count = max(1, math.ceil(abs(kappa) * width / step - 1e-9))
            return cls(kappa, width, (0.0, width), (count,))
        knots = (0.0, *gear.flank_form.height_breaks, width)
        aim = aim_for(gear, chord_error)
        counts = tuple(_count(gear, kappa, low, high, aim) for low, high in pairwise(knots))
        return cls(kappa, width, knots, counts, min(_MARGIN * chord_error, (width / 2 - gear.body.end_chamfer) / 4))

    def turn(self, z: Floats) -> Floats:
        """Return the angle (rad) by which the section at heights z (mm) is turned."""
        return self.start + self.kappa * z

    @property
    def count(self) -> int:
        """Number of stretches between layers over the whole width."""
        return sum(self.counts)

    def heights(self, setback: Floats) -> Floats:
        """Return the heights z (count + 1, n) in mm of the points whose columns stop short of the ends by `setback` (n,)."""
        above = 0.0 * setback if self.apex else setback
        if len(self.counts) == 1:
            share = np.linspace(0.0, 1.0, self.count + 1)[:, None]
            result: Floats = setback + share * (self.width - (setback + above))
            return result
        inner = np.array(self.knots[1:-1])[:, None]
        low, high = setback + self.margin, self.width - above - self.margin
        knots = [
            setback,
            *np.where(inner <= self.width / 2, np.maximum(inner, low), np.minimum(inner, high)),
            self.width - above,
        ]
        parts = [np.linspace(a, b, n, endpoint=False) for (a, b), n in zip(pairwise(knots), self.counts, strict=True)]
        return np.concatenate([*parts, knots[-1][None]])


def _count(gear: Gear, kappa: float, low: float, high: float, aim: float) -> int:
    """Return the layers between two heights (mm): so many that half of the bend of a modified flank along z would use up `aim`
    (mm).

    The other half is left to the bend of the profile, as both add up in a diagonal.
    """
    form, radius = gear.flank_form, outermost_radius(gear)
    ends, z = np.array([[form.first], [form.last]]), np.array([low, (low + high) / 2, high])
    depth = np.concatenate([form.depth(ends, z, left=left) for left in (True, False)])
    rise = np.abs(depth[:, 0] - 2 * depth[:, 1] + depth[:, 2]).max() / 2 * radius / form.base_radius
    sagitta = radius * (kappa * (high - low)) ** 2 / 8 + 2 * rise
    return max(1, math.ceil(math.sqrt(sagitta / aim) - 1e-9))


_PASSES = 20
"""Rounds of splitting; each at least halves a cell that is too coarse, three are common."""

_STEP = 1e-4
"""Steps over which a normal is taken, as a share of a curve and of the face width."""


def bulges(gear: Gear, piece: FlankCurve) -> bool:
    """Return whether the Gaussian curvature of what a piece sweeps is above zero, so that triangles deviate most inside."""
    swept = gear.internal and gear.helix_angle != 0 and not gear.modification.present
    return swept and piece.curve.kind is CurveKind.FILLET


class _Deviations(NamedTuple):
    """Deviations (mm, signed) of edges along the profile, of rising and of falling diagonals: each (rows, len(s) - 1).

    A diagonal rises from root to tip.
    """

    sides: Floats
    rising: Floats
    falling: Floats


def split(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone, aim: float) -> Floats:
    """Return the parameters with the cells split that are off by more than `aim` (mm): long in z, on the cone, or bent
    unevenly.
    """
    for _ in range(_PASSES):
        worst = (_inside_cells if bulges(gear, piece) else _on_edges)(gear, piece, s, layers, cone)
        if cone.present:
            worst = np.maximum(worst, _off_cone(gear, piece, s, layers, cone))
        parts = np.ceil(np.sqrt(worst / aim) * (1 - 1e-6)).astype(int).clip(1, 16)
        if np.all(parts == 1):
            break
        s = np.append(
            np.concatenate([np.linspace(a, b, n, endpoint=False) for a, b, n in zip(s, s[1:], parts, strict=False)]), 1.0
        )
    return s


def falling_cells(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone) -> tuple[Bools, Bools]:
    """Return where cells (layers, len(s) - 1) of the right and left flank are better cut from lower right to upper left.

    Seen from outside; cells are numbered from root to tip.
    """
    found = _deviations(gear, piece, s, layers, cone)
    rising = [np.abs(d.rising) <= np.abs(d.falling) for d in found]
    if len(rising) == 1:  # the right flank is the left one turned end over end
        left = np.broadcast_to(rising[0], (layers.count, len(s) - 1))
        return left[::-1], left
    return ~rising[1], rising[0]


def _on_edges(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone) -> Floats:
    """Return the largest deviation (mm) in each column of cells (len(s) - 1,): on its sides, or on the better diagonals."""
    flanks = [[np.abs(d) for d in deviations] for deviations in _deviations(gear, piece, s, layers, cone)]
    worst: Floats = np.max([np.maximum(a.max(axis=0), np.minimum(b, c).max(axis=0)) for a, b, c in flanks], axis=0)
    return worst


def _inside_cells(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone) -> Floats:
    """Return the largest deviation (mm) inside triangles in each column of cells, where the surface bulges."""
    sides, rising, falling = (np.abs(d) for d in _of_screw(piece.curve, s, layers, cone))
    rise = layers.kappa * np.diff(layers.heights(cone.setback(piece.curve.polar(s)[0])), axis=0)
    upright = _Bend.of(piece.curve, s, layers).uprights(np.maximum(np.abs(rise[:, 1:]), np.abs(rise[:, :-1])))
    found = _inside(sides.max(axis=0), np.abs(upright).max(axis=0), np.minimum(rising, falling).max(axis=0))
    return found


def _inside(one: Floats, two: Floats, three: Floats) -> Floats:
    """Return the largest deviation of triangles whose edges deviate by these amounts, all to one side.

    By the lengths that an edge's deviation is an eighth of the square of, half the square of the radius of the circle through
    the corners: 4 abc/(2 (ab + bc + ca) - a^2 - b^2 - c^2); of an obtuse triangle that of its longest edge.
    """
    edges = np.stack([one, two, three])
    total, longest = edges.sum(axis=0), edges.max(axis=0)
    share = total**2 - 2 * (edges**2).sum(axis=0)  # 2 (ab + bc + ca) - a^2 - b^2 - c^2
    acute = 2 * longest < total
    result: Floats = np.where(acute, 4 * edges.prod(axis=0) / np.where(acute, share, 1.0), longest)
    return result


def _deviations(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone) -> list[_Deviations]:
    """Return the deviations of the left flank and, if it differs, of the right flank."""
    if not gear.modification.present:
        left = _of_screw(piece.curve, s, layers, cone)
        if not (layers.apex and cone.present):
            return [left]
        return [left, _of_screw(piece.curve, s, replace(layers, kappa=-layers.kappa), cone)]
    left = _of_modified(gear, piece, s, layers, cone, left=True)
    mirrored = not layers.kappa and not gear.modification.helix_angle_modification
    return [left, left if mirrored else _of_modified(gear, piece, s, layers, cone, left=False)]


def _off_cone(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone) -> Floats:
    """Sagitta (mm) of the chords on the cone (len(s) - 1,)."""
    radius, angle = piece.curve.polar(s)
    setback = cone.setback(radius)
    span = np.abs(np.diff(angle)) + np.abs(layers.kappa * np.diff(setback))
    if gear.modification.present:
        ends = np.stack([setback, layers.width - setback])
        turns = [piece.turn(gear.flank_form, s, ends, left=left) for left in (True, False)]
        span += np.abs(np.diff(turns)).max(axis=(0, 1))
    return np.where(setback[1:] > 0, radius[1:] * span**2 / 8, 0.0)


class _Bend(NamedTuple):
    """Bend of the side over cells of a screw surface: A, B, C and |n| of the head of this module, each (len(s) - 1,)."""

    profile: Floats
    mixed: Floats
    helix: Floats
    tilt: Floats

    @classmethod
    def of(cls, curve: Curve, s: Floats, layers: Layers) -> _Bend:
        points, middle = curve.points(s), curve.points(0.5 * (s[1:] + s[:-1]))
        heading = curve.direction(0.5 * (s[1:] + s[:-1]))
        normal = np.stack([-np.sin(heading), np.cos(heading)], -1)
        chord = points[1:] - points[:-1]
        profile = np.sum(normal * (0.5 * (points[1:] + points[:-1]) - middle), -1)
        mixed = (normal[:, 1] * chord[:, 0] - normal[:, 0] * chord[:, 1]) / 4
        helix = -np.sum(normal * middle, -1) / 8
        tilt = np.hypot(1.0, layers.kappa * (normal[:, 1] * middle[:, 0] - normal[:, 0] * middle[:, 1]))
        return cls(profile, mixed, helix, tilt)

    def deviation(self, angle: Floats) -> Floats:
        """Return the deviations (mm) of edges that go along the profile and turn by an angle (rad)."""
        result: Floats = (self.profile + angle * (self.mixed + angle * self.helix)) / self.tilt
        return result

    def uprights(self, angle: Floats) -> Floats:
        """Return the deviations (mm) of edges that turn by an angle (rad) only."""
        result: Floats = angle**2 * self.helix / self.tilt
        return result


def _of_screw(curve: Curve, s: Floats, layers: Layers, cone: EndCone) -> _Deviations:
    """Return the deviations on a screw surface to second order; one row stands for all where every layer is the same."""
    bend = _Bend.of(curve, s, layers)
    turn = layers.kappa * layers.heights(cone.setback(curve.polar(s)[0]))
    if not cone.present:  # every layer is the same
        turn = turn[:2]
    return _Deviations(
        bend.deviation(turn[:, 1:] - turn[:, :-1]),
        bend.deviation(turn[1:, 1:] - turn[:-1, :-1]),
        bend.deviation(turn[:-1, 1:] - turn[1:, :-1]),
    )


def _of_modified(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone, *, left: bool) -> _Deviations:
    """Return the deviations in the middles of the edges, along the normal; the right flank is mirrored first."""
    hand = 1 if left else -1

    def surface(s: Floats, z: Floats) -> Floats:
        radius, angle = piece.curve.polar(s)
        angle = angle + hand * (layers.kappa * z + piece.turn(gear.flank_form, s, z, left=left))
        return np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), z), -1)

    z = layers.heights(cone.setback(piece.curve.polar(s)[0]))
    corners, middle = surface(s, z), 0.5 * (s[1:] + s[:-1])

    def exact(first: tuple[slice, slice], last: tuple[slice, slice]) -> tuple[Floats, Floats]:
        height = 0.5 * (z[first] + z[last])
        return surface(middle, height), _normal(surface, middle, height, layers.width)

    def deviation(first: tuple[slice, slice], last: tuple[slice, slice], at: tuple[Floats, Floats]) -> Floats:
        place, normal = at
        result: Floats = np.sum((0.5 * (corners[first] + corners[last]) - place) * normal, -1)
        return result

    all_rows, lower, upper = slice(None), slice(None, -1), slice(1, None)
    sides = (all_rows, lower), (all_rows, upper)
    rising, falling = ((lower, lower), (upper, upper)), ((upper, lower), (lower, upper))
    of_rising = exact(*rising)
    of_falling = exact(*falling) if cone.present else of_rising  # where columns are alike, diagonals cross in their middles
    return _Deviations(deviation(*sides, exact(*sides)), deviation(*rising, of_rising), deviation(*falling, of_falling))


def _normal(surface: Callable[[Floats, Floats], Floats], s: Floats, z: Floats, width: float) -> Floats:
    """Return the unit normals of a surface by differences."""
    step = _STEP * width
    along = surface(np.clip(s + _STEP, 0, 1), z) - surface(np.clip(s - _STEP, 0, 1), z)
    normal = np.cross(along, surface(s, z + step) - surface(s, z - step))
    result: Floats = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return result


@dataclass(frozen=True)
class ToothGrid:
    """Grid of one tooth. Profile points run root to tip: `radius`, `half_angle` (rad) and `setback` (mm), each (k + 1,).

    `turns` (rad) by which the modifications turn the points of the right and left flank: each (layers + 1, k + 1). The tip
    land has `tip_steps` chords (0: pointed), the root land between two teeth `root_steps` (0: none). `falling`, each
    (layers, k), is true where a cell of the right and left flank is cut from lower right to upper left, seen towards the axis.
    `cone` has its face radius on a profile point of index `face_level` if it lies on the flank at all; 0 if at the root
    circle or on the body.
    """

    radius: Floats
    half_angle: Floats
    setback: Floats
    turns: tuple[Floats, Floats]
    tip_steps: int
    root_steps: int
    falling: tuple[Bools, Bools]
    cone: EndCone
    face_level: int
    layers: Layers
    teeth: int

    @property
    def flank_steps(self) -> int:
        return len(self.radius) - 1

    @property
    def period(self) -> int:
        """Number of profile points per tooth."""
        return 2 * self.flank_steps + self.tip_steps + self.root_steps

    @cached_property
    def outline(self) -> tuple[Floats, Floats, Floats]:
        """Radius, setback and angle from the tooth's middle of one period: counter-clockwise, from the right fillet's start.

        Angles (layers + 1, period) are without the twist of the screw. A land has its points evenly between its ends.
        """
        right, left = (turns + sign * self.half_angle for turns, sign in zip(self.turns, (-1, 1), strict=True))
        land = np.linspace(right[:, -1], left[:, -1], self.tip_steps + 1, axis=1)[:, 1:-1]
        following = 2 * math.pi / self.teeth + right[:, 0]
        space = np.linspace(left[:, 0], following, self.root_steps + 1, axis=1)[:, 1:-1]
        last = None if self.tip_steps else -1
        stop = None if self.root_steps else -1

        def around(right: Floats, tip_land: Floats, left: Floats, root_land: Floats) -> Floats:
            return np.concatenate([right, tip_land, left[..., :last][..., ::-1][..., :stop], root_land], axis=-1)

        def same(values: Floats) -> Floats:
            lands = (np.full(land.shape[1], values[-1]), np.full(space.shape[1], values[0]))
            return around(values, lands[0], values, lands[1])

        return same(self.radius), same(self.setback), around(right, land, left, space)

    @cached_property
    def falling_cells(self) -> Bools:
        """(layers, period): true where a cell is cut from its lower right to its upper left, seen towards the axis.

        On a land the diagonal is the one that spans less about the axis: against the helix.
        """
        right, left = self.falling
        _, setback, angle = self.outline
        angle = angle + self.layers.kappa * self.layers.heights(setback)
        angle = np.column_stack([angle, angle[:, 0] + 2 * math.pi / self.teeth])
        shorter = np.abs(angle[1:, :-1] - angle[:-1, 1:]) < np.abs(angle[1:, 1:] - angle[:-1, :-1])
        tip, space = self.flank_steps, self.period - self.root_steps
        return np.concatenate([right, shorter[:, tip : tip + self.tip_steps], left[:, ::-1], shorter[:, space:]], axis=1)


def tooth_grid(gear: Gear, chord_error: float, *, apex: bool = False) -> ToothGrid:
    """Grid of one tooth within `chord_error` (mm) of the surface everywhere; at an `apex` its upper end has no cone."""
    layers, pieces = replace(Layers.of(gear, chord_error), apex=apex), flank_curves(gear)
    ends = [gear.profile.root_diameter / 2, *(float(piece.curve.polar(1.0)[0]) for piece in pieces)]
    cone = EndCone.of(gear).snapped(ends, least_distance(gear, chord_error))
    samples = [_samples(gear, piece, layers, cone, chord_error) for piece in pieces]
    radius, angle, face_level = _profile(gear, pieces, samples, cone)
    setback = cone.setback(radius)
    turns = _turns(gear, pieces, samples, layers.heights(setback))
    root_steps, tip_steps = _lands(gear, radius, angle, turns, chord_error)
    if not root_steps:
        angle[0] = math.pi / gear.tooth_count
    if not tip_steps:
        angle[-1] = 0.0
    cells = zip(*(falling_cells(gear, piece, s, layers, cone) for piece, s in zip(pieces, samples, strict=True)), strict=True)
    right_cells, left_cells = (np.concatenate(falling, axis=1) for falling in cells)
    return ToothGrid(
        radius=radius,
        half_angle=angle,
        setback=setback,
        turns=turns,
        tip_steps=tip_steps,
        root_steps=root_steps,
        falling=(right_cells, left_cells),
        cone=cone,
        face_level=face_level,
        layers=layers,
        teeth=gear.tooth_count,
    )


def _profile(gear: Gear, pieces: list[FlankCurve], samples: list[Floats], cone: EndCone) -> tuple[Floats, Floats, int]:
    """Return the radius (mm) and half angle (rad) of the profile points, and the index of the one where the cone begins."""
    polar = [piece.curve.polar(s) for piece, s in zip(pieces, samples, strict=True)]
    radius = np.concatenate([polar[0][0][:1], *(r[1:] for r, _ in polar)])
    angle = np.concatenate([polar[0][1][:1], *(a[1:] for _, a in polar)])
    radius[0], radius[-1] = gear.profile.root_diameter / 2, gear.profile.tip_diameter / 2
    if not cone.present:
        return radius, angle, len(radius) - 1
    face_level = int(np.argmin(np.abs(radius - cone.face_radius)))
    if cone.beyond(radius[0]) <= 0:
        radius[face_level] = cone.face_radius
    return radius, angle, face_level


def _lands(gear: Gear, radius: Floats, angle: Floats, turns: tuple[Floats, Floats], chord_error: float) -> tuple[int, int]:
    """Chords of a whole root land and tip land, where they are widest."""
    right, left = turns
    root_half = math.pi / gear.tooth_count - angle[0] + (right[:, 0] - left[:, 0]).max() / 2
    tip_half = angle[-1] + (left[:, -1] - right[:, -1]).max() / 2
    # Ends that turn stay apart, however near they are.
    least = least_distance(gear, chord_error)
    root_near, tip_near = (0.0 if np.any([right[:, k], left[:, k]]) else least for k in (0, -1))
    root_steps = _land_steps(root_half, radius[0], chord_error, root_near)
    return root_steps, _land_steps(tip_half, radius[-1], chord_error, tip_near)


def _samples(gear: Gear, piece: FlankCurve, layers: Layers, cone: EndCone, chord_error: float) -> Floats:
    """Return the parameters of a curve, among them those where the cone begins and where it crosses a knot of the layers."""
    near, aim = least_distance(gear, chord_error), aim_for(gear, chord_error)
    s = parameters_within(piece.curve, (1 - HELIX_SHARE) * aim if bulges(gear, piece) else aim)
    if cone.present:
        depths = {0.0, *(min(z, layers.width - z) for z in layers.knots)}
        for depth in sorted(depths):
            s = _with_radius(piece.curve, s, cone.radius(depth), near)
    return split(gear, piece, s, layers, cone, aim)


def _turns(gear: Gear, pieces: list[FlankCurve], samples: list[Floats], heights: Floats) -> tuple[Floats, Floats]:
    """Return the angles (rad) by which the points of the right and left flank are turned: each (layers + 1, k + 1), as
    `heights`.
    """
    if not gear.modification.present:
        return np.zeros(heights.shape), np.zeros(heights.shape)
    ends = np.cumsum([0, *(len(s) - 1 for s in samples)])
    right, left = (
        np.concatenate(
            [
                piece.turn(gear.flank_form, s[start:], heights[:, end + start : end + len(s)], left=side)
                for piece, s, end, start in zip(pieces, samples, ends, [0, *(1 for _ in pieces[1:])], strict=False)
            ],
            axis=1,
        )
        for side in (False, True)
    )
    return right, left


def _land_steps(half_angle: float, radius: float, chord_error: float, near: float) -> int:
    """Chords of a whole land; 0 if it is too narrow to be told from a point."""
    if 2 * half_angle * radius < near:
        return 0
    return max(1, math.ceil(2 * half_angle / arc_step(radius, chord_error) - 1e-9))


def _with_radius(curve: Curve, s: Floats, at: float, near: float) -> Floats:
    """Return the parameters with the one at a radius (mm) among them, in place of any other closer than `near` (mm)."""
    radius = curve.polar(s)[0]
    rising = math.copysign(1.0, radius[-1] - radius[0])
    if not rising * radius[0] + near < rising * at < rising * radius[-1] - near:
        return s
    keep = np.abs(radius - at) > near
    keep[[0, -1]] = True
    low, high = 0.0, 1.0
    for _ in range(8):
        trial = np.linspace(low, high, 65)
        above = int(np.clip(np.searchsorted(rising * curve.polar(trial)[0], rising * at), 1, 64))
        low, high = trial[above - 1], trial[above]
    return np.sort(np.append(s[keep], 0.5 * (low + high)))

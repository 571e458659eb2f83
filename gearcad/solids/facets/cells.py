"""How far the cells of a tooth's grid are off the surface, where to split them, and along which diagonal to cut them.

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
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind
from gearcad.geometry.turned import FlankCurve
from gearcad.solids.cone import EndCone
from gearcad.solids.facets.layers import Layers

__all__ = ["bulges", "falling_cells", "split"]


_PASSES = 20
"""Rounds of splitting; each at least halves a cell that is too coarse, three are common."""

_STEP = 1e-4
"""Steps over which a normal is taken, as a share of a curve and of the face width."""


def bulges(gear: Gear, piece: FlankCurve) -> bool:
    """Whether the Gaussian curvature of what a piece sweeps is above zero, so that triangles deviate most inside."""
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
    """The parameters with the cells split that are off by more than `aim` (mm): long in z, on the cone, or bent unevenly."""
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
    """Where the cells (layers, len(s) - 1) of the right and of the left flank are better cut from lower right to upper left.

    Seen from outside; cells are numbered from root to tip.
    """
    found = _deviations(gear, piece, s, layers, cone)
    rising = [np.abs(d.rising) <= np.abs(d.falling) for d in found]
    if len(rising) == 1:  # the right flank is the left one turned end over end
        left = np.broadcast_to(rising[0], (layers.count, len(s) - 1))
        return left[::-1], left
    return ~rising[1], rising[0]


def _on_edges(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone) -> Floats:
    """Largest deviation (mm) in each column of cells (len(s) - 1,): on its sides, or on the better diagonals."""
    flanks = [[np.abs(d) for d in deviations] for deviations in _deviations(gear, piece, s, layers, cone)]
    worst: Floats = np.max([np.maximum(a.max(axis=0), np.minimum(b, c).max(axis=0)) for a, b, c in flanks], axis=0)
    return worst


def _inside_cells(gear: Gear, piece: FlankCurve, s: Floats, layers: Layers, cone: EndCone) -> Floats:
    """The same where the surface bulges: in each column the largest deviation (mm) inside triangles."""
    sides, rising, falling = (np.abs(d) for d in _of_screw(piece.curve, s, layers, cone))
    rise = layers.kappa * np.diff(layers.heights(cone.setback(piece.curve.polar(s)[0])), axis=0)
    upright = _Bend.of(piece.curve, s, layers).uprights(np.maximum(np.abs(rise[:, 1:]), np.abs(rise[:, :-1])))
    found = _inside(sides.max(axis=0), np.abs(upright).max(axis=0), np.minimum(rising, falling).max(axis=0))
    return found


def _inside(one: Floats, two: Floats, three: Floats) -> Floats:
    """Largest deviation of triangles whose edges deviate by these amounts, all to one side.

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
    """Those of the left and, where it is another one, the right flank."""
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
    """How the side bends over cells of a screw surface: A, B, C and |n| of the head of this module, each (len(s) - 1,)."""

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
        """Of edges that go along the profile and turn by an angle."""
        result: Floats = (self.profile + angle * (self.mixed + angle * self.helix)) / self.tilt
        return result

    def uprights(self, angle: Floats) -> Floats:
        """Of edges that turn by an angle only."""
        result: Floats = angle**2 * self.helix / self.tilt
        return result


def _of_screw(curve: Curve, s: Floats, layers: Layers, cone: EndCone) -> _Deviations:
    """To second order; one row stands for all where every layer is the same."""
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
    """In the middles of the edges, along the normal; the right flank is mirrored first."""
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
    """Unit normals of a surface by differences."""
    step = _STEP * width
    along = surface(np.clip(s + _STEP, 0, 1), z) - surface(np.clip(s - _STEP, 0, 1), z)
    normal = np.cross(along, surface(s, z + step) - surface(s, z - step))
    result: Floats = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return result

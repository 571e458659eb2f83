"""Where the triangles of a tooth have their corners, so that none leaves the surface by more than was asked.

Profile points by layers make the cells of a grid, on the exact or the modified surface. Angles are radians in here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, parameters_within
from gearcad.geometry.turned import FlankCurve, flank_curves
from gearcad.solids.cone import EndCone
from gearcad.solids.facets.cells import bulges, falling_cells, split
from gearcad.solids.facets.layers import Layers
from gearcad.solids.facets.tolerance import HELIX_SHARE, aim_for, arc_step, least_distance

__all__ = ["ToothGrid", "tooth_grid"]


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
    """Radius (mm) and half angle (rad) of the profile points, and the index of the one where the cone begins."""
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
    """Parameters of a curve, among them those where the cone begins and where it crosses a knot of the layers."""
    near, aim = least_distance(gear, chord_error), aim_for(gear, chord_error)
    s = parameters_within(piece.curve, (1 - HELIX_SHARE) * aim if bulges(gear, piece) else aim)
    if cone.present:
        depths = {0.0, *(min(z, layers.width - z) for z in layers.knots)}
        for depth in sorted(depths):
            s = _with_radius(piece.curve, s, cone.radius(depth), near)
    return split(gear, piece, s, layers, cone, aim)


def _turns(gear: Gear, pieces: list[FlankCurve], samples: list[Floats], heights: Floats) -> tuple[Floats, Floats]:
    """By what the points of the right and left flank are turned (rad): each (layers + 1, k + 1), as `heights`."""
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
    """The parameters with the one at a radius (mm) among them, in place of any other closer than `near` (mm)."""
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

"""Where the triangles of a tooth have their corners, so that none leaves the exact surface by more than was asked.

The side of a tooth is a screw surface S(s, z) = R(kappa z) C(s). Its triangles are halves of the cells of a grid of
profile points and layers. The deviation of an edge that spans ds and dz is, to second order and along the normal,

    |A + B D + C D^2| / |n|     with D = kappa dz (rad)

A: sagitta of the profile, C: sagitta of the helix, B: their mixed (twist) term. Every part of the side has a Gaussian
curvature of at most zero (involute helicoid and cylinders: zero), so a triangle deviates nowhere more than on its edges,
and with the better of its two diagonals a cell is hardly worse than its sides. Angles are radians in here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.geometry import Gear
from gearcad.geometry.curves import Curve, CurveKind, parameters_within

__all__ = ["EndCone", "Screw", "ToothGrid", "arc_step", "least_distance", "tooth_grid"]

Floats = NDArray[np.float64]

_PASSES = 20
"""Rounds of splitting; each at least halves a cell that is too coarse, three are common."""


def arc_step(radius: float, chord_error: float) -> float:
    """Largest angle (rad) that a chord of a circle may span within `chord_error` (mm)."""
    return 2 * math.acos(max(1 - chord_error / radius, 0.5))


def least_distance(gear: Gear, chord_error: float) -> float:
    """Distance (mm) below which two points are made one: nothing against the chord error, or two steps of a float32."""
    return max(1e-3 * chord_error, 3e-7 * gear.tip_diameter / 2)


@dataclass(frozen=True)
class EndCone:
    """The chamfer cone on both ends of the tip cylinder: `slope` is the tangent of its angle to the axis.

    `face_radius` (mm) is where the cone meets the end plane, infinite without a chamfer.
    """

    face_radius: float
    slope: float

    @classmethod
    def of(cls, gear: Gear) -> EndCone:
        slope = math.tan(math.radians(gear.body.end_chamfer_angle))
        if not gear.body.end_chamfer:
            return cls(math.inf, slope)
        return cls(gear.tip_diameter / 2 - gear.body.end_chamfer * slope, slope)

    @property
    def present(self) -> bool:
        return math.isfinite(self.face_radius)

    def setback(self, radius: Floats) -> Floats:
        """Axial distance (mm) of the surface from the end plane at `radius` (mm)."""
        result: Floats = np.maximum((radius - self.face_radius) / self.slope, 0.0)
        return result


@dataclass(frozen=True)
class Screw:
    """The motion that sweeps the section: turn per height `kappa` (rad/mm, signed), `width` (mm), number of `layers`."""

    kappa: float
    width: float
    layers: int

    @classmethod
    def of(cls, gear: Gear, chord_error: float) -> Screw:
        kappa = math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2)
        step = arc_step(gear.tip_diameter / 2, chord_error)
        layers = max(1, math.ceil(abs(kappa) * gear.face_width / step - 1e-9))
        return cls(kappa, gear.face_width, layers)

    def heights(self, setback: Floats) -> Floats:
        """Heights z (layers + 1, n) in mm of the points whose columns stop short of both ends by `setback` (n,)."""
        share = np.linspace(0.0, 1.0, self.layers + 1)[:, None]
        result: Floats = setback + share * (self.width - 2 * setback)
        return result


@dataclass(frozen=True)
class ToothGrid:
    """Grid of one tooth. Profile points run root to tip: `radius`, `half_angle` (rad) and `setback` (mm), each (k + 1,).

    The tip land has `tip_steps` chords (0: pointed), the root land between two teeth `root_steps` (0: none). `rising`
    (layers, k) is true where the diagonal of a cell of the left flank rises from root to tip. `cone` has its face
    radius on a profile point of index `face_level` if it lies on the flank at all; 0 if at or below the root circle.
    """

    radius: Floats
    half_angle: Floats
    setback: Floats
    tip_steps: int
    root_steps: int
    rising: NDArray[np.bool_]
    cone: EndCone
    face_level: int
    screw: Screw
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
        """Radius, angle from the tooth's middle and setback of one period: counter-clockwise, from the right fillet's start."""
        root, tip = float(self.half_angle[0]), float(self.half_angle[-1])
        land = np.linspace(-tip, tip, self.tip_steps + 1)[1:-1]
        space = np.linspace(root, 2 * math.pi / self.teeth - root, self.root_steps + 1)[1:-1]
        last = None if self.tip_steps else -1
        stop = None if self.root_steps else -1

        def around(values: Floats, signed: Floats, tip_land: Floats, root_land: Floats) -> Floats:
            return np.concatenate([signed, tip_land, values[:last][::-1][:stop], root_land])

        return (
            around(self.radius, self.radius, np.full(land.shape, self.radius[-1]), np.full(space.shape, self.radius[0])),
            around(self.half_angle, -self.half_angle, land, space),
            around(self.setback, self.setback, np.full(land.shape, self.setback[-1]), np.full(space.shape, self.setback[0])),
        )

    @cached_property
    def falling_cells(self) -> NDArray[np.bool_]:
        """(layers, period): true where a cell is cut from its lower right to its upper left, seen from outside.

        The right flank is the left one turned end over end. On a land the diagonal goes against the helix.
        """
        layers = self.screw.layers
        right = self.rising[::-1]
        lands = [np.full((layers, steps), self.screw.kappa > 0) for steps in (self.tip_steps, self.root_steps)]
        return np.concatenate([right, lands[0], self.rising[:, ::-1], lands[1]], axis=1)


def tooth_grid(gear: Gear, chord_error: float) -> ToothGrid:
    """Grid of one tooth within `chord_error` (mm) of the exact surface everywhere."""
    profile = gear.profile
    near = least_distance(gear, chord_error)
    screw = Screw.of(gear, chord_error)
    curves = [curve for curve in profile.curves if curve.kind not in (CurveKind.ROOT, CurveKind.TIP)]
    cone = _snapped(EndCone.of(gear), gear.root_diameter / 2, curves, near)
    samples = [_with_face(curve, parameters_within(curve, chord_error), cone, near) for curve in curves]
    samples = [_split(curve, s, screw, cone, chord_error) for curve, s in zip(curves, samples, strict=True)]

    polar = [curve.polar(s) for curve, s in zip(curves, samples, strict=True)]
    radius = np.concatenate([polar[0][0][:1], *(r[1:] for r, _ in polar)])
    angle = np.concatenate([polar[0][1][:1], *(a[1:] for _, a in polar)])
    radius[0], radius[-1] = gear.root_diameter / 2, gear.tip_diameter / 2
    root_steps = _land_steps(math.pi / gear.teeth - angle[0], radius[0], chord_error, near)
    tip_steps = _land_steps(angle[-1], radius[-1], chord_error, near)
    if not root_steps:
        angle[0] = math.pi / gear.teeth
    if not tip_steps:
        angle[-1] = 0.0
    face_level = len(radius) - 1
    if cone.present:
        face_level = int(np.argmin(np.abs(radius - cone.face_radius)))
        if cone.face_radius >= radius[0]:
            radius[face_level] = cone.face_radius
    rising = [_rising(curve, s, screw, cone) for curve, s in zip(curves, samples, strict=True)]
    return ToothGrid(
        radius=radius,
        half_angle=angle,
        setback=cone.setback(radius),
        tip_steps=tip_steps,
        root_steps=root_steps,
        rising=np.broadcast_to(np.concatenate(rising, axis=1), (screw.layers, len(radius) - 1)),
        cone=cone,
        face_level=face_level,
        screw=screw,
        teeth=gear.teeth,
    )


def _land_steps(half_angle: float, radius: float, chord_error: float, near: float) -> int:
    """Chords of a whole land; 0 if it is too narrow to be told from a point."""
    if 2 * half_angle * radius < near:
        return 0
    return max(1, math.ceil(2 * half_angle / arc_step(radius, chord_error) - 1e-9))


def _snapped(cone: EndCone, root_radius: float, curves: list[Curve], near: float) -> EndCone:
    """The cone with its face radius moved onto the end of a curve that is nearer than `near`."""
    ends = [root_radius, *(float(curve.polar(1.0)[0]) for curve in curves)]
    return next((EndCone(end, cone.slope) for end in ends if abs(end - cone.face_radius) < near), cone)


def _with_face(curve: Curve, s: Floats, cone: EndCone, near: float) -> Floats:
    """The parameters with the one at the cone's face radius among them, in place of any other closer than `near`."""
    radius = curve.polar(s)[0]
    if not radius[0] + near < cone.face_radius < radius[-1] - near:
        return s
    keep = np.abs(radius - cone.face_radius) > near
    keep[[0, -1]] = True
    low, high = 0.0, 1.0
    for _ in range(8):
        trial = np.linspace(low, high, 65)
        above = int(np.clip(np.searchsorted(curve.polar(trial)[0], cone.face_radius), 1, 64))
        low, high = trial[above - 1], trial[above]
    return np.sort(np.append(s[keep], 0.5 * (low + high)))


def _deviations(curve: Curve, s: Floats, screw: Screw, cone: EndCone) -> tuple[Floats, Floats, Floats]:
    """Deviations (mm, signed) of edges along the profile, of rising and of falling diagonals: each (rows, len(s) - 1)."""
    points, middle = curve.points(s), curve.points(0.5 * (s[1:] + s[:-1]))
    heading = curve.direction(0.5 * (s[1:] + s[:-1]))
    normal = np.stack([-np.sin(heading), np.cos(heading)], -1)
    chord = points[1:] - points[:-1]
    profile = np.sum(normal * (0.5 * (points[1:] + points[:-1]) - middle), -1)
    mixed = (normal[:, 1] * chord[:, 0] - normal[:, 0] * chord[:, 1]) / 4
    helix = -np.sum(normal * middle, -1) / 8
    tilt = np.hypot(1.0, screw.kappa * (normal[:, 1] * middle[:, 0] - normal[:, 0] * middle[:, 1]))
    turn = screw.kappa * screw.heights(cone.setback(curve.polar(s)[0]))
    if not cone.present:  # every layer is the same
        turn = turn[:2]

    def deviation(angle: Floats) -> Floats:
        result: Floats = (profile + angle * (mixed + angle * helix)) / tilt
        return result

    return (
        deviation(turn[:, 1:] - turn[:, :-1]),
        deviation(turn[1:, 1:] - turn[:-1, :-1]),
        deviation(turn[:-1, 1:] - turn[1:, :-1]),
    )


def _rising(curve: Curve, s: Floats, screw: Screw, cone: EndCone) -> NDArray[np.bool_]:
    _, rising, falling = _deviations(curve, s, screw, cone)
    result: NDArray[np.bool_] = np.abs(rising) <= np.abs(falling)
    return result


def _split(curve: Curve, s: Floats, screw: Screw, cone: EndCone, chord_error: float) -> Floats:
    """The parameters with the cells split that are still too coarse: long in z, on the cone, or bent unevenly."""
    for _ in range(_PASSES):
        sides, rising, falling = (np.abs(d) for d in _deviations(curve, s, screw, cone))
        worst = np.maximum(sides.max(axis=0), np.minimum(rising, falling).max(axis=0))
        if cone.present:
            radius, angle = curve.polar(s)
            span = np.abs(np.diff(angle)) + np.abs(screw.kappa * np.diff(cone.setback(radius)))
            worst = np.maximum(worst, np.where(radius[1:] > cone.face_radius, radius[1:] * span**2 / 8, 0.0))
        parts = np.ceil(np.sqrt(worst / chord_error) * (1 - 1e-6)).astype(int).clip(1, 16)
        if np.all(parts == 1):
            break
        s = np.append(
            np.concatenate([np.linspace(a, b, n, endpoint=False) for a, b, n in zip(s, s[1:], parts, strict=False)]), 1.0
        )
    return s

"""Exact surfaces of gears and racks, and the distances of points from them: what the points of files are held against."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import Protocol

import numpy as np

from gearcad.core.records import Bools, Floats, Wholes
from gearcad.geometry import Gear, Rack
from gearcad.geometry.bore_teeth import bore_teeth
from gearcad.geometry.curves import Chamfer, Curve, CurveKind, Fillet, FlankTrace, Involute, PlaneCurve, WheelArc
from gearcad.geometry.gear import FlankCurve, flank_curves
from gearcad.geometry.gear_data import height_in_half, section_turn, twist
from gearcad.geometry.rack_root import RackCurveKind
from gearcad.solids.body_plan import EndCone

_STEPS = 4
"""Newton's steps from the curve's point on the same radius: a point that is nearly on it is there after one."""

_TABLE = 1025
"""Points of a fillet among which the parameter of a radius is interpolated."""

_STILL = 1e-6
"""Step of a curve's parameter after which no other is needed: along 20 mm the foot then moves 20 nm, the distance 1e-6 nm."""

_BESIDE = 0.02
"""Distance (mm) from the radii of a piece at which points within those of another are held against it too: more than facets."""

_SMALL = 1e-6
"""Step of a curve's parameter over which its speed is taken."""

_CHUNK = 100_000
"""Points that are looked at together."""

Distances = Callable[[Floats], Floats]
"""Distances (n,) in mm of points (n, 3)."""


class ExactSurface(Protocol):
    """Surface of a part where its file has it: first tooth on +x, or a rack from x = 0."""

    def tooth_distances(self, points: Floats) -> Floats:
        """Return the distances (n,) in mm of points (n, 3) from flanks, fillets and tip chamfers."""

    def distances(self, points: Floats) -> Floats:
        """Return the distances (k, n) in mm of points (n, 3) from each of the k smooth surfaces of the part."""

    def teeth(self, points: Floats) -> Wholes:
        """Return the numbers (n,) of the teeth to which points (n, 3) belong."""

    @property
    def flanks(self) -> list[int]:
        """Numbers of the surfaces that are flanks."""


def surface_of(part: Gear | Rack) -> ExactSurface:
    """Return the exact surface of a gear or a rack."""
    return RackSurface(part) if isinstance(part, Rack) else GearSurface(part)


def _speed(curve: PlaneCurve, s: Floats) -> Floats:
    """Length (mm) per parameter at s (n,)."""
    low, high = np.maximum(s - _SMALL, 0.0), np.minimum(s + _SMALL, 1.0)
    step = np.hypot(*(curve.points(high) - curve.points(low)).T)
    speed: Floats = np.maximum(step / np.maximum(high - low, _SMALL), 1e-9)
    return speed


@lru_cache(16)
def _radii_of(curve: Fillet | WheelArc | FlankTrace) -> tuple[Floats, Floats]:
    """Rising radii (m,) in mm of a curve's points, and their parameters (m,)."""
    s = np.linspace(0.0, 1.0, _TABLE)
    radii = curve.polar(s)[0]
    order = np.argsort(radii, kind="stable")
    return radii[order], s[order]


def _on_radius(curve: Curve, radius: Floats) -> Floats:
    """Parameters (n,) of a curve's points near these radii (mm), or of its ends."""
    if isinstance(curve, Involute):
        base = curve.base_radius
        roll = np.sqrt(np.maximum((radius - base) * (radius + base), 0.0)) / base
        found = (roll - curve.first) / (curve.last - curve.first)
    elif isinstance(curve, Chamfer):
        run = (np.sqrt(np.maximum(2 * radius**2 - curve.radius**2, 0.0)) - curve.radius) / 2
        found = np.abs(run) / curve.run
    else:
        assert isinstance(curve, Fillet | WheelArc | FlankTrace)
        found = np.interp(radius, *_radii_of(curve))
    on_curve: Floats = np.clip(found, 0.0, 1.0)
    return on_curve


@dataclass(frozen=True)
class GearSurface:
    """Surface of a gear whose tooth 0 is on +x at z = 0: teeth with their modifications, and the body."""

    gear: Gear

    def tooth_distances(self, points: Floats) -> Floats:
        """Return the distances (n,) in mm of points (n, 3) from flanks, fillets and tip chamfers."""
        nearest: Floats = self._from_teeth(points).min(axis=0)
        return nearest

    def distances(self, points: Floats) -> Floats:
        """Return the distances (k, n) in mm of points (n, 3) from each of the k smooth surfaces of the part."""
        return np.concatenate([self._from_teeth(points), [distances(points) for distances in self._body]])

    def teeth(self, points: Floats) -> Wholes:
        """Return the numbers (n,) of the teeth to which points (n, 3) belong."""
        _, angle = self._section(points)
        numbers: Wholes = np.mod(np.rint(angle / self._pitch).astype(int), self.gear.tooth_count)
        return numbers

    @property
    def flanks(self) -> list[int]:
        """Numbers of the surfaces that are flanks."""
        return [number for number, piece in enumerate(self._pieces) if piece.curve.kind is CurveKind.INVOLUTE]

    @property
    def _pitch(self) -> float:
        return 2 * math.pi / self.gear.tooth_count

    @cached_property
    def _pieces(self) -> list[FlankCurve]:
        return flank_curves(self.gear)

    def _from_teeth(self, points: Floats) -> Floats:
        """Distances (k, n) in mm from the k pieces of the flanks; infinite for points farther than a module from one.

        Points within the radii of some pieces have finite distances from these alone.
        """
        found = np.full((len(self._pieces), len(points)), np.inf)
        radius, angle = self._section(points)
        angle = angle - self._pitch * np.rint(angle / self._pitch)
        beside = np.where(self._within(radius), _BESIDE, self.gear.normal_module)
        for number, piece in enumerate(self._pieces):
            low, high = self._radii[number]
            near = (radius > low - beside) & (radius < high + beside)
            for left in (True, False):
                chosen = np.flatnonzero(near & ((angle >= 0) == left))
                for start in range(0, len(chosen), _CHUNK):
                    which = chosen[start : start + _CHUNK]
                    found[number, which] = self._from_piece(piece, left, radius[which], angle[which], points[which, 2])
        return found

    @cached_property
    def _radii(self) -> list[tuple[float, float]]:
        """Least and greatest radius (mm) of each piece."""
        ends = [sorted(float(piece.curve.polar(end)[0]) for end in (0.0, 1.0)) for piece in self._pieces]
        return [(low, high) for low, high in ends]

    def _within(self, radius: Floats) -> Bools:
        """Which radii (mm) are those of a piece."""
        within: Bools = np.any([(radius >= low) & (radius <= high) for low, high in self._radii], axis=0)
        return within

    def _section(self, points: Floats) -> tuple[Floats, Floats]:
        """Radii (mm) and angles (rad) of points, turned back by the helix."""
        x, y, z = points.T
        return np.hypot(x, y), np.arctan2(y, x) - section_turn(self.gear, z)

    def _from_piece(self, piece: FlankCurve, left: bool, radius: Floats, angle: Floats, z: Floats) -> Floats:
        """Distances (n,) in mm of points (radius in mm, angle in rad from the middle of a tooth) from a piece of one side."""
        gear, curve, sense = self.gear, piece.curve, 1 if left else -1
        height = height_in_half(gear, z)
        angle = sense * angle
        s, moved = _on_radius(curve, radius), 1.0
        speed = _speed(curve, s)  # the same at every step: it changes little on the way to the foot
        for step in range(_STEPS + 1):
            turned = angle - sense * piece.turn(gear.flank_form, s, height, left=left)
            off = np.stack([radius * np.cos(turned), radius * np.sin(turned)], -1) - curve.points(s)
            heading = curve.direction(s)
            along = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
            across = off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)
            if step == _STEPS or moved < _STILL:
                break
            nearer = np.clip(s + along / speed, 0.0, 1.0)
            moved, s = float(np.abs(nearer - s).max(initial=0.0)), nearer
        # The section cuts the surface at a slant: the way to it in space is shorter than in the section.
        slant = twist(gear) * radius * np.cos(heading - curve.polar(s)[1])
        distance: Floats = np.hypot(np.abs(across) / np.hypot(1.0, slant), np.where((s > 0) & (s < 1), 0.0, along))
        return distance

    @cached_property
    def _body(self) -> list[Distances]:
        """Distances from lands, ends, cones, gap, and the body's own surfaces."""
        return list(self._body_surfaces())

    def _body_surfaces(self) -> Iterator[Distances]:
        gear, body = self.gear, self.gear.body
        back, front = body.hub_ends
        spline = bore_teeth(gear)
        radii = [gear.profile.tip_diameter / 2, gear.profile.root_diameter / 2]
        radii += [size / 2 for size in (body.bore, body.hub_diameter, body.rim_diameter or 0.0) if size]
        heights = [0.0, gear.face_width]
        heights += [-back] * bool(back) + [gear.face_width + front] * bool(front)
        if gear.double_helix.gap_width:
            radii.append(gear.gap_diameter / 2)
            heights += [gear.half_width, gear.face_width - gear.half_width]
        if spline is not None:
            radii.append(spline.profile.tip_diameter / 2)
            yield GearSurface(spline).tooth_distances
        for radius in radii:
            yield partial(_from_radius, radius)
        for height in heights:
            yield partial(_from_height, height)
        if body.end_chamfer:
            yield self._from_cones
        if body.keyway_width:
            yield self._from_keyway
        for number in range(body.bolt_holes):
            yield self._from_bolt(2 * math.pi * number / body.bolt_holes)

    def _from_cones(self, points: Floats) -> Floats:
        """Distances from the end chamfers of the gear, or of both halves."""
        cone, z = EndCone.of(self.gear), points[:, 2]
        beyond = cone.beyond(np.hypot(points[:, 0], points[:, 1]))
        below = np.minimum(z, self.gear.face_width - z)
        ends = [below, self.gear.half_width - below] if self.gear.double_helix.gap_width else [below]
        every = [np.abs(beyond - end * cone.slope) / math.hypot(1.0, cone.slope) for end in ends]
        nearest: Floats = np.minimum.reduce(every)
        return nearest

    def _from_keyway(self, points: Floats) -> Floats:
        """Distances from walls and floor of the keyway, which lies on +x."""
        body = self.gear.body
        half, floor = body.keyway_width / 2, body.bore / 2 + body.keyway_depth
        x, y = points[:, 0], points[:, 1]
        inside = (x > 0) & (np.abs(y) < half + body.keyway_depth) & (x < floor + body.keyway_depth)
        nearest: Floats = np.where(inside, np.minimum(np.abs(np.abs(y) - half), np.abs(x - floor)), np.inf)
        return nearest

    def _from_bolt(self, angle: float) -> Distances:
        """Distances from the bolt hole at an angle (rad)."""
        body = self.gear.body
        x, y = body.bolt_circle / 2 * math.cos(angle), body.bolt_circle / 2 * math.sin(angle)
        return lambda points: np.abs(np.hypot(points[:, 0] - x, points[:, 1] - y) - body.bolt_diameter / 2)


def _from_radius(radius: float, points: Floats) -> Floats:
    distances: Floats = np.abs(np.hypot(points[:, 0], points[:, 1]) - radius)
    return distances


def _from_height(height: float, points: Floats) -> Floats:
    distances: Floats = np.abs(points[:, 2] - height)
    return distances


@dataclass(frozen=True)
class RackSurface:
    """Surface of a rack: its teeth, and the planes of its bar."""

    rack: Rack

    def tooth_distances(self, points: Floats) -> Floats:
        """Return the distances (n,) in mm of points (n, 3) from flanks, fillets and tip chamfers."""
        nearest: Floats = self._from_outline(points, lands=False).min(axis=0)
        return nearest

    def distances(self, points: Floats) -> Floats:
        """Return the distances (k, n) in mm of points (n, 3) from each of the k smooth surfaces of the part."""
        rack = self.rack
        planes = ((0, 0.0), (0, rack.length), (1, -rack.height), (2, 0.0), (2, rack.face_width))
        return np.concatenate(
            [self._from_outline(points, lands=True), [np.abs(points[:, axis] - place) for axis, place in planes]]
        )

    def teeth(self, points: Floats) -> Wholes:
        """Return the numbers (n,) of the teeth to which points (n, 3) belong."""
        return np.rint(self._along(points) / self.rack.transverse_pitch).astype(int)

    @property
    def flanks(self) -> list[int]:
        """Numbers of the surfaces that are flanks."""
        return [number for number, curve in enumerate(self.rack.profile.curves) if curve.kind is RackCurveKind.FLANK]

    def _along(self, points: Floats) -> Floats:
        """Places (n,) in mm along the rack, from the middle of the first tooth, brought to z = 0 along the teeth."""
        rack = self.rack
        place: Floats = points[:, 0] - rack.transverse_pitch / 2 + points[:, 2] * math.tan(math.radians(rack.helix_angle))
        return place

    def _from_outline(self, points: Floats, *, lands: bool) -> Floats:
        """Distances (k, n) in mm from the curves of the teeth, square to the teeth, in the normal section."""
        rack = self.rack
        cosine = math.cos(math.radians(rack.helix_angle))
        along = self._along(points)
        along = np.abs(along - rack.transverse_pitch * np.rint(along / rack.transverse_pitch))
        flat = np.stack([-along * cosine, points[:, 1]], -1)
        curves = [curve for curve in rack.profile.curves if lands or not curve.kind.value.endswith("land")]
        return np.stack([_from_normal_curve(curve, cosine, flat) for curve in curves])


def _from_normal_curve(curve: PlaneCurve, cosine: float, flat: Floats) -> Floats:
    """Distances (n,) in mm of points (n, 2) in the normal section from a curve of the transverse one."""
    coarse = np.linspace(0.0, 1.0, 65)
    samples = curve.points(coarse) * [cosine, 1.0]
    s = coarse[np.concatenate([_nearest(samples, flat[i : i + 20_000]) for i in range(0, len(flat), 20_000)])]
    for _ in range(2 * _STEPS):
        low, high = np.maximum(s - _SMALL, 0.0), np.minimum(s + _SMALL, 1.0)
        tangent = (curve.points(high) - curve.points(low)) * [cosine, 1.0] / (high - low)[:, None]
        off = flat - curve.points(s) * [cosine, 1.0]
        s = np.clip(s + np.einsum("nc,nc->n", off, tangent) / np.maximum(np.einsum("nc,nc->n", tangent, tangent), 1e-18), 0, 1)
    distance: Floats = np.hypot(*(flat - curve.points(s) * [cosine, 1.0]).T)
    return distance


def _nearest(samples: Floats, flat: Floats) -> Wholes:
    """Numbers (n,) of the nearest of some samples (m, 2) to each point (n, 2)."""
    apart = (flat[:, None, :] - samples[None]) ** 2
    nearest: Wholes = apart.sum(axis=-1).argmin(axis=1)
    return nearest

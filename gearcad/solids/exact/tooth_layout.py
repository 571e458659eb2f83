"""Layout of tooth 0: its outline in Bezier pieces, swept along the face width between its two ends.

Exact flanks are S(u, z) = R(kappa z) C(u): the section's poles times those of (cos, sin) over the twist, so nothing is
approximated twice. Modified flanks are S(u, z) = R(kappa z + turn(u, z)) C(u), interpolated in u and z on every stretch of
the face width on which the depth is smooth. Either way neighbours have their common poles in common.

Where a flank meets the cone of an end chamfer the curve is explicit in the flank's own parameter.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Floats
from gearcad.geometry.curves import Curve, CurveKind, Land
from gearcad.geometry.gear import FlankCurve, Gear, flank_curves, halves
from gearcad.geometry.gear_data import twist
from gearcad.geometry.modification import FlankForm
from gearcad.solids.body_plan import End, gear_ends
from gearcad.solids.exact import boundary
from gearcad.solids.exact.boundary import (
    BezierCurve,
    BezierOnSurface,
    CurveForm,
    LineOnSurface,
    OnSurface,
    StraightLine,
    level_circle,
)

Error = Callable[[Floats, Floats], Floats]

_SPLIT_DEGREE = 14
"""A curve that needs a higher degree is halved instead: cheaper to evaluate, and better conditioned."""

_SAME = 1e-7
"""Radii (mm) closer than this are the same for the kernel."""


def accuracy_for(gear: Gear) -> float:
    """Return the largest deviation (mm) allowed to a fitted section: 1 nm, and less on gears so small that 0.1 ppm of volume
    shows.
    """
    return min(1e-6, 2e-7 * gear.normal_module)


@dataclass(frozen=True, eq=False)
class FlankSpan:
    """One Bezier piece of a flank: `poles` (n + 1, 2) in mm run counter-clockwise, u in [0, 1] along them.

    It is `curve` from the parameter `first` at u = 0 to `last` at u = 1, on the left or right flank.
    """

    poles: Floats
    curve: FlankCurve
    first: float
    last: float
    left: bool

    def polar(self, u: Floats) -> tuple[Floats, Floats]:
        """Return the radius (mm) and polar angle (rad) at u (n,)."""
        x, y = (boundary.bernstein(len(self.poles) - 1, u) @ self.poles).T
        return np.hypot(x, y), np.arctan2(y, x)

    def turn(self, form: FlankForm, u: Floats, z: Floats) -> Floats:
        """Return the angle (rad) by which the modifications turn the point at u at height z (mm); u and z broadcast."""
        return self.curve.turn(form, self.first + u * (self.last - self.first), z, left=self.left)

    @property
    def start(self) -> tuple[float, float]:
        """Radius (mm) and polar angle (rad) at u = 0."""
        x, y = self.poles[0]
        return math.hypot(x, y), math.atan2(y, x)

    @property
    def radii(self) -> tuple[float, float]:
        """Radius (mm) at u = 0 and u = 1."""
        start, end = np.hypot(*self.poles[[0, -1]].T)
        return float(start), float(end)


@dataclass(frozen=True)
class LandArc:
    """A land: arc of `radius` (mm) about the axis between two polar angles (rad), counter-clockwise."""

    radius: float
    first: float
    last: float

    @property
    def start(self) -> tuple[float, float]:
        """Radius (mm) and polar angle (rad)."""
        return self.radius, self.first


Piece = FlankSpan | LandArc


def tooth_outline(gear: Gear, cuts: Sequence[float] = ()) -> tuple[Piece, ...]:
    """Pieces of tooth 0 (centred on +x) from its right root to the next tooth's: right flank, tip, left flank, root land.

    Neighbouring pieces share their end points exactly. They are those of the exact profile, before any modification, but
    end where its depth is not smooth, and at the radii `cuts` (mm).
    """
    curves = gear.profile.curves
    fitted = _fitted_throughout if gear.modification.present else _fitted
    flank = [
        piece
        for curve in flank_curves(gear)
        for first, last in pairwise(_cut(curve.curve, cuts))
        for piece in fitted(curve, first, last, accuracy_for(gear))
    ]
    _join([piece.poles for piece in flank])
    half_pitch, root = math.pi / gear.tooth_count, gear.profile.root_diameter / 2
    if curves[0].kind is not CurveKind.ROOT:
        flank[0].poles[0] = root * np.array([math.cos(half_pitch), math.sin(half_pitch)])
    right = [replace(piece, poles=piece.poles * [1, -1], left=False) for piece in flank]
    left = [replace(piece, poles=piece.poles[::-1], first=piece.last, last=piece.first) for piece in reversed(flank)]
    tip = right[-1].poles[-1]
    half = -math.atan2(tip[1], tip[0])
    pieces: list[Piece] = [*right, LandArc(gear.profile.tip_diameter / 2, -half, half), *left]
    if isinstance(curves[0], Land) and curves[0].kind is CurveKind.ROOT:
        start = float(curves[0].last)
        pieces.append(LandArc(root, start, 2 * half_pitch - start))
    return tuple(pieces)


def _cut(curve: Curve, radii: Sequence[float]) -> list[float]:
    """Return the parameters from 0 to 1, with those between where a curve crosses one of the radii (mm)."""
    start, end = (float(curve.polar(s)[0]) for s in (0.0, 1.0))
    side = 1 if start < end else -1  # the radii of a ring's flank fall
    inside, last = list[float](), side * start
    for cut in sorted(side * radius for radius in radii):
        if last + _SAME < cut < side * end - _SAME:
            inside.append(cut)
            last = cut
    return [0.0, *(_crossing(lambda s: side * float(curve.polar(s)[0]), cut, 0.0, 1.0) for cut in inside), 1.0]


def _fitted(curve: FlankCurve, first: float, last: float, tolerance: float) -> list[FlankSpan]:
    """Spans of a curve of the left flank on [first, last], root to tip, within `tolerance` (mm) along the normal."""

    def deviation(values: Floats, s: Floats) -> Floats:
        off, heading = values - curve.curve.points(s), curve.curve.direction(s)
        return np.asarray(np.abs(off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)))

    return _halved(curve, first, last, deviation, tolerance)


def _fitted_throughout(curve: FlankCurve, first: float, last: float, tolerance: float) -> list[FlankSpan]:
    """Return spans within a quarter of the tolerance and along the curve too.

    Modifications turn a point by what its parameter says.
    """

    def deviation(values: Floats, s: Floats) -> Floats:
        return np.asarray(np.hypot(*(values - curve.curve.points(s)).T))

    return _halved(curve, first, last, deviation, 0.25 * tolerance)


def _halved(curve: FlankCurve, first: float, last: float, deviation: Error, tolerance: float) -> list[FlankSpan]:
    """Return the span of a curve on [first, last], or those of its halves, until the degree is moderate."""

    def parameter(t: Floats) -> Floats:
        return first + t * (last - first)

    poles = boundary.fit(
        lambda t: curve.curve.points(parameter(t)),
        lambda values, t: deviation(values, parameter(t)),
        tolerance,
        least=1 if curve.curve.kind is CurveKind.CHAMFER else 2,
        most=_SPLIT_DEGREE,
    )
    if poles is not None:
        return [FlankSpan(poles, curve, first, last, left=True)]
    middle = (first + last) / 2
    halves = (first, middle), (middle, last)
    return [span for half in halves for span in _halved(curve, *half, deviation, tolerance)]


def _join(flank: list[Floats]) -> None:
    """Make the shared ends of neighbouring pieces the same numbers (they agree to rounding already)."""
    for before, after in pairwise(flank):
        before[-1] = after[0]


def parameter_at_radius(span: FlankSpan, radius: float) -> float:
    """u at which a span crosses `radius` (mm); the radius is monotone along every piece of a flank."""
    low, high = (0.0, 1.0) if span.radii[0] < span.radii[1] else (1.0, 0.0)
    return _crossing(lambda u: float(span.polar(np.array([u]))[0][0]), radius, low, high)


def _crossing(rising: Callable[[float], float], value: float, low: float, high: float) -> float:
    """Return the place between `low` and `high` where a rising function has a value."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        if rising(middle) < value:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


_PROBES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Places across a modified surface where the degree along it is found; it is too smooth to need more in between."""

_SHARE = 0.1
"""Share of the section's tolerance for either direction of a modified surface: together they stay below a half."""


def required(poles: Floats | None, what: str) -> Floats:
    """Return the poles; SolverError if there are none."""
    if poles is None:
        raise SolverError(f"{what} needs a higher degree than the CAD kernel has ({boundary.MOST_DEGREE})")
    return poles


def sweep_of(gear: Gear, pieces: Sequence[Piece]) -> Sweep:
    """Return the sweep of the pieces of a gear's tooth 0: exact screws, or modified flanks."""
    return ModifiedSweep(gear, pieces) if gear.modification.present else Sweep(gear)


class Sweep:
    """The screw of unmodified flanks. `heights` (mm) part the face width into stretches, here one."""

    def __init__(self, gear: Gear) -> None:
        self.gear, self.width = gear, gear.face_width
        self.tolerance = accuracy_for(gear)
        self.rate = twist(gear)
        self.heights: tuple[float, ...] = (0.0, gear.face_width)

    def turn(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        """Return the angle (rad) by which the point at u of a piece is turned at height z (mm); u and z broadcast."""
        return self.rate * z

    def patches(self, piece: FlankSpan) -> list[Floats]:
        """Return the poles (n + 1, m + 1, 3) of the surface of a piece on every stretch."""
        return [self._screwed(piece.poles)]

    def section(self, piece: FlankSpan, which: int) -> Floats:
        """Return the poles (n + 1, 3) of a piece on the plane of the lower (0) or upper (1) end."""
        z = which * self.width
        cosine, sine = math.cos(self.rate * z), math.sin(self.rate * z)
        x, y = piece.poles.T
        return np.stack([cosine * x - sine * y, sine * x + cosine * y, np.full(len(x), z)], -1)

    def side(self, piece: FlankSpan, u: int, place: tuple[float, float], stretch: int) -> tuple[Floats, Floats]:
        """Return the poles (m + 1, 3) of the edge along the tooth at the end u = 0 or 1 of a piece, and those of its polar
        angle (rad).

        `place` is that end's radius (mm) and polar angle (rad).
        """
        radius, angle = place
        point = np.array([[radius * math.cos(angle), radius * math.sin(angle)]])
        return self._screwed(point)[0], np.array([angle, angle + self.rate * self.width])

    @cached_property
    def _rotation(self) -> Floats:
        """Bezier poles (m + 1, 2) of (cos, sin) of the twist over 0 ... width, to a quarter of the section's tolerance."""
        twist = self.rate * self.width
        if twist == 0:
            return np.array([[1.0, 0.0], [1.0, 0.0]])

        def rotation(t: Floats) -> Floats:
            return np.stack([np.cos(twist * t), np.sin(twist * t)], -1)

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs(values - rotation(t)).max(-1))

        bound = 0.25 * self.tolerance / (self.gear.profile.outer_diameter / 2)
        return required(boundary.fit(rotation, error, bound), "the twist of the teeth")

    def _screwed(self, poles: Floats) -> Floats:
        """Return the poles (n, m + 1, 3) of the screw surface through section poles (n, 2)."""
        x, y = poles[:, :1], poles[:, 1:]
        cosine, sine = self._rotation.T
        heights = np.broadcast_to(np.linspace(0, self.width, len(cosine)), (len(poles), len(cosine)))
        return np.stack([x * cosine - y * sine, x * sine + y * cosine, heights], -1)


class ModifiedSweep(Sweep):
    """The sweep of modified flanks: a stretch ends where the depth is not smooth along z, or its degree would be high."""

    def __init__(self, gear: Gear, pieces: Sequence[Piece]) -> None:
        super().__init__(gear)
        self.form = gear.flank_form
        spans = [piece for piece in pieces if isinstance(piece, FlankSpan)]
        breaks = (0.0, *self.form.height_breaks, self.width)
        found = [stretch for low, high in pairwise(breaks) for stretch in self._stretches(spans, low, high)]
        self.heights = (*(low for low, _, _ in found), self.width)
        self._degrees = [degree for _, _, degree in found]
        self._patches = {span: self._fitted(span) for span in spans}

    def turn(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        return self.rate * z + piece.turn(self.form, u, z)

    def _points(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        """Exact points (n, m, 2) of the modified surface at u (n,) and z (m,)."""
        radius, angle = (value[:, None] for value in piece.polar(u))
        angle = angle + self.turn(piece, u[:, None], z)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)

    def _degree(self, function: Callable[[Floats], Floats], least: int, most: int) -> int | None:
        """Degree, from `least` to `most`, that a function of [0, 1] -> (n, k), in mm, needs; None if that is not enough."""

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs(values - function(t)).max(-1))

        poles = boundary.fit(function, error, _SHARE * self.tolerance, least=least, most=most)
        return None if poles is None else len(poles) - 1

    def _stretches(self, spans: list[FlankSpan], low: float, high: float) -> list[tuple[float, float, int]]:
        """Return the stretches from `low` to `high` with their degrees along z, the same one for all pieces."""

        def along(t: Floats) -> Floats:
            z = low + t * (high - low)
            return np.concatenate([np.swapaxes(self._points(span, _PROBES, z), 0, 1).reshape(len(t), -1) for span in spans], 1)

        degree = self._degree(along, 2, _SPLIT_DEGREE)
        if degree is not None:
            return [(low, high, degree)]
        middle = (low + high) / 2
        return self._stretches(spans, low, middle) + self._stretches(spans, middle, high)

    def patches(self, piece: FlankSpan) -> list[Floats]:
        return self._patches[piece]

    def section(self, piece: FlankSpan, which: int) -> Floats:
        patch = self.patches(piece)[-which]
        return patch[:, -which]

    def side(self, piece: FlankSpan, u: int, place: tuple[float, float], stretch: int) -> tuple[Floats, Floats]:
        low, high = self.heights[stretch : stretch + 2]
        # A depth is a parabola along z, so three of its values give its poles.
        first, middle, last = place[1] + self.turn(piece, np.array(float(u)), np.array([low, (low + high) / 2, high]))
        return self.patches(piece)[stretch][-u], np.array([first, 2 * middle - (first + last) / 2, last])

    def _fitted(self, piece: FlankSpan) -> list[Floats]:
        """Return the poles of the surface of a piece on every stretch, of one degree along u."""
        places = np.concatenate([low + _PROBES * (high - low) for low, high in pairwise(self.heights)])

        def across(u: Floats) -> Floats:
            return self._points(piece, u, places).reshape(len(u), -1)

        degree = self._degree(across, len(piece.poles) - 1, boundary.MOST_DEGREE)
        if degree is None:
            raise SolverError(f"a modified flank needs a higher degree than the CAD kernel has ({boundary.MOST_DEGREE})")
        return [self._patch(piece, degree, stretch) for stretch in range(len(self._degrees))]

    def _patch(self, piece: FlankSpan, degree: int, stretch: int) -> Floats:
        low, high = self.heights[stretch : stretch + 2]
        along = self._degrees[stretch]

        def surface(u: Floats, t: Floats) -> Floats:
            return self._points(piece, u, low + t * (high - low))

        poles = boundary.interpolate_surface(surface, (degree, along))
        height = np.broadcast_to(np.linspace(low, high, along + 1), poles.shape[:2])
        return np.concatenate([poles, height[..., None]], -1)


def whole_sweep(gear: Gear, pieces: Sequence[Piece]) -> Sweep:
    """Return the sweep of the pieces of a gear's tooth 0 over its whole face width."""
    if gear.double_helix.present:
        return MirroredSweep(gear, sweep_of(halves(gear)[0].gear, pieces))
    return sweep_of(gear, pieces)


class MirroredSweep(Sweep):
    """The lower half's sweep up to the middle of the face width, and the same turned back from there."""

    def __init__(self, gear: Gear, lower: Sweep) -> None:
        super().__init__(gear)
        self.lower = lower
        self.heights = (*lower.heights, *(self.width - z for z in reversed(lower.heights[:-1])))

    def turn(self, piece: FlankSpan, u: Floats, z: Floats) -> Floats:
        return self.lower.turn(piece, u, np.minimum(z, self.width - z))

    def patches(self, piece: FlankSpan) -> list[Floats]:
        lower = self.lower.patches(piece)
        return [*lower, *(self._mirrored(patch) for patch in reversed(lower))]

    def section(self, piece: FlankSpan, which: int) -> Floats:
        lower = self.lower.section(piece, 0)
        return self._mirrored(lower)[::-1] if which else lower

    def side(self, piece: FlankSpan, u: int, place: tuple[float, float], stretch: int) -> tuple[Floats, Floats]:
        last = len(self.heights) - 2
        poles, angles = self.lower.side(piece, u, place, min(stretch, last - stretch))
        return (poles, angles) if 2 * stretch < last else (self._mirrored(poles), angles[::-1])

    def _mirrored(self, poles: Floats) -> Floats:
        """Return the poles (..., m + 1, 3), upwards, of the mirror image about the middle."""
        return poles[..., ::-1, :] * [1, 1, -1] + [0, 0, self.width]


_ROUNDING = 1e-9
"""Radii (mm) closer than this are the same: the ends have snapped to the junctions already."""


@dataclass(frozen=True)
class Segment:
    """A stretch of one piece's edge on one end, between two of the end's stations (indices, see `_stations`)."""

    piece: int
    start: int
    end: int
    first: float
    last: float
    on_cone: bool


@dataclass(frozen=True)
class Drawn:
    """Curves of a segment, for tooth 0: in space from `first` to `last`, on its own face, and on the cone (if it is there)."""

    curve: CurveForm
    first: float
    last: float
    on_face: OnSurface
    on_cone: OnSurface | None = None


@dataclass(frozen=True)
class SideEdge:
    """The edge along the tooth at a junction, on one stretch of the face width, for tooth 0.

    Its curve, the poles of its polar angle (rad) and the ends of the stretch (mm).
    """

    curve: CurveForm
    angles: Floats
    low: float
    high: float

    def on_cylinder(self, turn: float) -> OnSurface:
        """Return the edge's curve on the cylinder of a land, turned by `turn` (rad)."""
        if np.all(self.angles == self.angles[0]):
            return LineOnSurface(float(self.angles[0]) + turn, 0, 0, 1)
        poles = np.stack([self.angles + turn, np.linspace(self.low, self.high, len(self.angles))], -1)
        return BezierOnSurface(poles, self.low, self.high)


@dataclass(frozen=True)
class Rise:
    """Part of a stretch of the face width at a junction between both ends: heights (mm) of its lower and upper end."""

    stretch: int
    low: float
    high: float


class ToothLayout:
    """Tooth 0: pieces, sweep, and for each end the stations and segments of the outline."""

    def __init__(self, gear: Gear) -> None:
        self.gear = gear
        self.tolerance = accuracy_for(gear)
        self._shape(tooth_outline(gear))
        self.ends = gear_ends(gear, self.junctions[:, 0].tolist())
        cuts = [end.cone.radius(abs(z - end.z)) for end in self.ends for z in self.sweep.heights[1:-1] if end.cone.present]
        if cuts:  # so that the edge of a chamfer on a piece lies on one stretch
            self._shape(tooth_outline(gear, cuts))
        self.segments = [self._segments(end) for end in self.ends]
        self.rises = [self._rises(k) for k in range(len(self.pieces))]

    def _shape(self, pieces: tuple[Piece, ...]) -> None:
        self.pieces = pieces
        self.sweep = whole_sweep(self.gear, pieces)
        self.junctions = np.array([piece.start for piece in pieces])

    # -------------------------------------------------------------- stations of the outline

    def _flank_at(self, k: int) -> tuple[FlankSpan, int]:
        """Return a flank's piece at a junction, and its u there. One of both neighbours is a flank's,
        and the first piece is.
        """
        piece, before = self.pieces[k % len(self.pieces)], self.pieces[k - 1]
        if isinstance(piece, FlankSpan):
            return piece, 0
        assert isinstance(before, FlankSpan)
        return before, 1

    def turn(self, k: int, z: Floats) -> Floats:
        """Return the angle (rad) by which a junction is turned at heights z (mm)."""
        piece, u = self._flank_at(k)
        return self.sweep.turn(piece, np.array(float(u)), z)

    def _segments(self, end: End) -> tuple[list[Segment], Floats]:
        """Segments of one end, and the (radius, polar angle there) of its stations: the junctions, then the breaks.

        Station `len(pieces)` of a segment's end means the first junction of the next tooth.
        """
        count, found, breaks = len(self.pieces), list[Segment](), list[tuple[float, float]]()
        for k, piece in enumerate(self.pieces):
            if isinstance(piece, LandArc):
                found.append(Segment(k, k, k + 1, piece.first, piece.last, bool(end.cone.beyond(piece.radius) > 0)))
                continue
            first, last = piece.radii
            if end.cone.face_radius >= max(first, last) - _ROUNDING or end.cone.face_radius <= min(first, last) + _ROUNDING:
                found.append(Segment(k, k, k + 1, 0.0, 1.0, bool(end.cone.beyond((first + last) / 2) > 0)))
            else:
                u = parameter_at_radius(piece, end.cone.face_radius)
                angle = float(piece.polar(np.array([u]))[1][0] + self.sweep.turn(piece, np.array(u), np.array(end.z)))
                station = count + 1 + len(breaks)
                breaks.append((end.cone.face_radius, angle))
                on_cone = bool(end.cone.beyond(first) > 0)
                found.append(Segment(k, k, station, 0.0, u, on_cone))
                found.append(Segment(k, station, k + 1, u, 1.0, not on_cone))
        radius, angle = self.junctions.T
        turned = [at + float(self.turn(k, end.height(r))) for k, (r, at) in enumerate(zip(radius, angle, strict=True))]
        following = (radius[0], turned[0] + 2 * math.pi / self.gear.tooth_count)
        return found, np.array([*zip(radius, turned, strict=True), following, *breaks])

    def place(self, end: End, stations: Floats) -> Floats:
        """Return the points (n, 3) of stations (radius, polar angle) on an end of tooth 0."""
        radius, angle = stations.T
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), end.height(radius)], -1)

    def _rises(self, k: int) -> list[Rise]:
        """Return the stretches of the face width that there are at a junction."""
        low, high = (float(end.height(self.junctions[k, 0])) for end in self.ends)
        parts = [(max(low, a), min(high, b)) for a, b in pairwise(self.sweep.heights)]
        return [Rise(stretch, a, b) for stretch, (a, b) in enumerate(parts) if b - a > _SAME]

    def stretches(self, k: int) -> range:
        """Return the stretches of the face width that there are on a piece."""
        after = (k + 1) % len(self.pieces)
        low, high = (float(end.height(self.junctions[[k, after], 0]).mean()) for end in self.ends)
        first, last = np.searchsorted(self.sweep.heights[1:-1], [low, high], side="right")
        return range(int(first), int(last) + 1)

    # -------------------------------------------------------------- curves

    def draw(self, end: End, segment: Segment) -> Drawn:
        """Return the curves of one segment."""
        piece = self.pieces[segment.piece]
        if isinstance(piece, LandArc):
            z = float(end.height(piece.radius))
            first, last = (float(self.turn(k, np.array(z))) for k in (segment.start, segment.end))
            circle, on_face = level_circle(piece.radius, z), LineOnSurface(0, z, 1, 0)
            slant = (piece.radius - end.cone.face_radius) / end.cone.sine
            on_cone = LineOnSurface(0, slant, end.widens, 0) if segment.on_cone else None
            return Drawn(circle, segment.first + first, segment.last + last, on_face, on_cone)
        if segment.on_cone:
            return self._draw_on_cone(end, segment, piece)
        poles = self.sweep.section(piece, 0 if end.inward > 0 else 1)
        return Drawn(BezierCurve(poles), segment.first, segment.last, LineOnSurface(0, end.z, 1, 0))

    def _draw_on_cone(self, end: End, segment: Segment, piece: FlankSpan) -> Drawn:
        """Return the curves where a flank meets the cone. z follows from the radius, so the curve is explicit in the flank's
        own u.
        """
        first, span = segment.first, segment.last - segment.first

        def curve(t: Floats) -> Floats:
            u = first + t * span
            radius, angle = piece.polar(u)
            z = end.height(radius)
            angle = angle + self.sweep.turn(piece, u, z)
            slant = (radius - end.cone.face_radius) / end.cone.sine
            return np.stack([radius * np.cos(angle), radius * np.sin(angle), z, end.widens * angle, slant], -1)

        scale = np.array([1, 1, 1, self.gear.profile.outer_diameter / 2, 1.0])

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs((values - curve(t)) * scale).max(-1))

        poles = required(boundary.fit(curve, error, 0.25 * self.tolerance, least=3), "the edge of the end chamfer")
        along = np.linspace(first, segment.last, len(poles))
        on_face = BezierOnSurface(np.stack([along, poles[:, 2]], -1), first, segment.last)
        on_cone = BezierOnSurface(poles[:, 3:], first, segment.last)
        return Drawn(BezierCurve(poles[:, :3], first, segment.last), first, segment.last, on_face, on_cone)

    def sides(self, k: int) -> list[SideEdge]:
        """SideEdge edges at junction k, upwards."""
        piece, u = self._flank_at(k)
        radius, angle = self.junctions[k].tolist()
        found = []
        for rise in self.rises[k]:
            low, high = self.sweep.heights[rise.stretch : rise.stretch + 2]
            poles, angles = self.sweep.side(piece, u, (radius, angle), rise.stretch)
            if len(poles) == 2 and poles[0, 0] == poles[1, 0] and poles[0, 1] == poles[1, 1]:
                x, y, _ = poles[0].tolist()
                curve: CurveForm = StraightLine((x, y, 0.0), (0.0, 0.0, 1.0))
            else:
                curve = BezierCurve(poles, low, high)
            found.append(SideEdge(curve, angles, low, high))
        return found

"""Tooth 0 laid out: its outline, the sweep along the face width, and what the two ends make of it.

Where a flank meets the cone of an end chamfer the curve is explicit in the flank's own parameter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.gear import Gear
from gearcad.solids.exact import bezier
from gearcad.solids.exact.ends import End, gear_ends
from gearcad.solids.exact.forms import (
    BezierCurve,
    BezierOnSurface,
    CurveForm,
    LineOnSurface,
    OnSurface,
    StraightLine,
    level_circle,
)
from gearcad.solids.exact.mirrored import whole_sweep
from gearcad.solids.exact.outline import FlankSpan, LandArc, Piece, accuracy_for, parameter_at_radius, tooth_outline
from gearcad.solids.exact.sweep import required

__all__ = ["Drawn", "Rise", "Segment", "SideEdge", "ToothLayout"]


_ROUNDING = 1e-9
"""Radii (mm) closer than this are the same: the ends have snapped to the junctions already."""

_SAME = 1e-7
"""Heights (mm) closer than this are the same for the kernel."""


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
        """Its curve on the cylinder of a land, turned by `turn` (rad)."""
        if np.all(self.angles == self.angles[0]):
            return LineOnSurface(float(self.angles[0]) + turn, 0, 0, 1)
        poles = np.stack([self.angles + turn, np.linspace(self.low, self.high, len(self.angles))], -1)
        return BezierOnSurface(poles, self.low, self.high)


@dataclass(frozen=True)
class Rise:
    """What of a stretch of the face width there is at a junction between both ends: heights (mm) of its lower and upper end."""

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
        """A flank's piece at a junction, and its u there. One of both neighbours is a flank's, and the first piece is."""
        piece, before = self.pieces[k % len(self.pieces)], self.pieces[k - 1]
        if isinstance(piece, FlankSpan):
            return piece, 0
        assert isinstance(before, FlankSpan)
        return before, 1

    def turn(self, k: int, z: Floats) -> Floats:
        """Angle (rad) by which a junction is turned at heights z (mm)."""
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
        """Points (n, 3) of stations (radius, polar angle) on an end of tooth 0."""
        radius, angle = stations.T
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), end.height(radius)], -1)

    def _rises(self, k: int) -> list[Rise]:
        """The stretches of the face width that there are at a junction."""
        low, high = (float(end.height(self.junctions[k, 0])) for end in self.ends)
        parts = [(max(low, a), min(high, b)) for a, b in pairwise(self.sweep.heights)]
        return [Rise(stretch, a, b) for stretch, (a, b) in enumerate(parts) if b - a > _SAME]

    def stretches(self, k: int) -> range:
        """The stretches of the face width that there are on a piece."""
        after = (k + 1) % len(self.pieces)
        low, high = (float(end.height(self.junctions[[k, after], 0]).mean()) for end in self.ends)
        first, last = np.searchsorted(self.sweep.heights[1:-1], [low, high], side="right")
        return range(int(first), int(last) + 1)

    # -------------------------------------------------------------- curves

    def draw(self, end: End, segment: Segment) -> Drawn:
        """The curves of one segment."""
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
        """Where a flank meets the cone: z follows from the radius, so the curve is explicit in the flank's own u."""
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

        poles = required(bezier.fit(curve, error, 0.25 * self.tolerance, least=3), "the edge of the end chamfer")
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

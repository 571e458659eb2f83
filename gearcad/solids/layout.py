"""Tooth 0 laid out: its outline, the screw that sweeps it, and what the two ends make of it.

A face of a flank is S(u, z) = R(kappa z) C(u): its poles are the section's poles times the Bezier coefficients of
(cos, sin) over the twist, so that nothing is approximated twice and neighbours share their edge curves pole for pole.
Where a flank meets the cone of an end chamfer the curve is explicit in the flank's own parameter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.errors import SolverError
from gearcad.geometry.gear import Gear
from gearcad.solids import bezier
from gearcad.solids.ends import End, gear_ends
from gearcad.solids.kernel import Kernel, bezier_curve, bezier_curve_2d
from gearcad.solids.outline import Arc, Piece, Span, accuracy_for, parameter_at_radius, tooth_outline

__all__ = ["Drawn", "Layout", "Segment", "Side"]

Floats = NDArray[np.float64]

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

    curve: Any
    first: float
    last: float
    on_face: Any
    on_cone: Any = None


@dataclass(frozen=True)
class Side:
    """The edge along the tooth at a junction, for tooth 0: its curve over z, and its angle at z = 0 and at `width`."""

    kernel: Kernel
    curve: Any
    angles: tuple[float, float]
    width: float

    def after(self, land: bool) -> Any:
        """Its curve on the face that it begins (a land is a cylinder, a flank has it at u = 0)."""
        return self._on_cylinder(0.0) if land else self.kernel.line_2d(0, 0, 0, 1)

    def before(self, land: bool, turn: float) -> Any:
        """Its curve on the face that it ends (a flank has it at u = 1), turned by `turn` (rad) on a cylinder."""
        return self._on_cylinder(turn) if land else self.kernel.line_2d(1, 0, 0, 1)

    def _on_cylinder(self, turn: float) -> Any:
        first, last = self.angles
        if first == last:
            return self.kernel.line_2d(first + turn, 0, 0, 1)
        return bezier_curve_2d(np.array([[first + turn, 0.0], [last + turn, self.width]]), 0.0, self.width)


class Layout:
    """Tooth 0: pieces, screw, and for each end the stations and segments of the outline."""

    def __init__(self, gear: Gear, kernel: Kernel) -> None:
        self.gear, self.kernel = gear, kernel
        self.width = gear.face_width
        self.pieces: tuple[Piece, ...] = tooth_outline(gear)
        self.tolerance = accuracy_for(gear)
        self.rate = math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2)
        self.screw = self._screw_poles()
        self.junctions = np.array([self._start(piece) for piece in self.pieces])
        self.ends = gear_ends(gear, self.junctions[:, 0].tolist())
        self.segments = [self._segments(end) for end in self.ends]

    # -------------------------------------------------------------- screw

    def _screw_poles(self) -> Floats:
        """Bezier poles (m + 1, 2) of (cos, sin) of the twist over 0 ... width, to a quarter of the section's tolerance."""
        twist = self.rate * self.width
        if twist == 0:
            return np.array([[1.0, 0.0], [1.0, 0.0]])

        def rotation(t: Floats) -> Floats:
            return np.stack([np.cos(twist * t), np.sin(twist * t)], -1)

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs(values - rotation(t)).max(-1))

        bound = 0.25 * self.tolerance / (self.gear.tip_diameter / 2)
        return _required(bezier.fit(rotation, error, bound), "the twist of the teeth")

    def sweep(self, poles: Floats) -> Floats:
        """Poles (n, m + 1, 3) of the screw surface through section poles (n, 2)."""
        x, y = poles[:, :1], poles[:, 1:]
        cosine, sine = self.screw.T
        heights = np.broadcast_to(np.linspace(0, self.width, len(cosine)), (len(poles), len(cosine)))
        return np.stack([x * cosine - y * sine, x * sine + y * cosine, heights], -1)

    # -------------------------------------------------------------- stations of the outline

    @staticmethod
    def _start(piece: Piece) -> tuple[float, float]:
        """Radius and polar angle (rad) where a piece starts."""
        if isinstance(piece, Arc):
            return piece.radius, piece.first
        x, y = piece.poles[0]
        return math.hypot(x, y), math.atan2(y, x)

    def _segments(self, end: End) -> tuple[list[Segment], Floats]:
        """Segments of one end, and the (radius, angle at z = 0) of its stations: the junctions, then the breaks.

        Station `len(pieces)` of a segment's end means the first junction of the next tooth.
        """
        count, found, breaks = len(self.pieces), list[Segment](), list[tuple[float, float]]()
        for k, piece in enumerate(self.pieces):
            first, last = piece.radii if isinstance(piece, Span) else (0.0, 0.0)
            if isinstance(piece, Arc):
                found.append(Segment(k, k, k + 1, piece.first, piece.last, piece.radius > end.edge_radius))
            elif end.edge_radius >= max(first, last) - _ROUNDING or end.edge_radius <= min(first, last) + _ROUNDING:
                found.append(Segment(k, k, k + 1, 0.0, 1.0, 2 * end.edge_radius < first + last))
            else:
                u = parameter_at_radius(piece, end.edge_radius)
                angle = float(piece.polar(np.array([u]))[1][0])
                station = count + 1 + len(breaks)
                breaks.append((end.edge_radius, angle))
                found.append(Segment(k, k, station, 0.0, u, first > last))
                found.append(Segment(k, station, k + 1, u, 1.0, first < last))
        following = (self.junctions[0, 0], self.junctions[0, 1] + 2 * math.pi / self.gear.teeth)
        return found, np.array([*self.junctions, following, *breaks])

    def place(self, end: End, stations: Floats) -> Floats:
        """Points (n, 3) of stations (radius, angle at z = 0) on an end of tooth 0."""
        radius, angle = stations.T
        z = end.height(radius)
        angle = angle + self.rate * z
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)

    # -------------------------------------------------------------- curves

    def draw(self, end: End, segment: Segment) -> Drawn:
        """The curves of one segment."""
        piece, line = self.pieces[segment.piece], self.kernel.line_2d
        if isinstance(piece, Arc):
            z = float(end.height(piece.radius))
            turn = self.rate * z
            circle, on_face = self.kernel.circle(piece.radius, z), line(0, z, 1, 0)
            slant = (piece.radius - end.edge_radius) / end.sine if segment.on_cone else 0.0
            return Drawn(circle, segment.first + turn, segment.last + turn, on_face, line(0, slant, end.inward, 0))
        if segment.on_cone:
            return self._draw_on_cone(end, segment, piece)
        turn = self.rate * end.z
        cosine, sine = math.cos(turn), math.sin(turn)
        x, y = piece.poles.T
        poles = np.stack([cosine * x - sine * y, sine * x + cosine * y, np.full(len(x), end.z)], -1)
        return Drawn(bezier_curve(poles), segment.first, segment.last, line(0, end.z, 1, 0))

    def _draw_on_cone(self, end: End, segment: Segment, piece: Span) -> Drawn:
        """Where a flank meets the cone: z follows from the radius, so the curve is explicit in the flank's own u."""
        first, span = segment.first, segment.last - segment.first

        def curve(t: Floats) -> Floats:
            radius, angle = piece.polar(first + t * span)
            z = end.height(radius)
            angle = angle + self.rate * z
            slant = (radius - end.edge_radius) / end.sine
            return np.stack([radius * np.cos(angle), radius * np.sin(angle), z, end.inward * angle, slant], -1)

        scale = np.array([1, 1, 1, self.gear.tip_diameter / 2, 1.0])

        def error(values: Floats, t: Floats) -> Floats:
            return np.asarray(np.abs((values - curve(t)) * scale).max(-1))

        poles = _required(bezier.fit(curve, error, 0.25 * self.tolerance, least=3), "the edge of the end chamfer")
        along = np.linspace(first, segment.last, len(poles))
        on_face = bezier_curve_2d(np.stack([along, poles[:, 2]], -1), first, segment.last)
        on_cone = bezier_curve_2d(poles[:, 3:], first, segment.last)
        return Drawn(bezier_curve(poles[:, :3], first, segment.last), first, segment.last, on_face, on_cone)

    def side(self, k: int) -> Side:
        """Side edge at junction k."""
        radius, angle = self.junctions[k].tolist()
        x, y = radius * math.cos(angle), radius * math.sin(angle)
        if self.rate == 0:
            curve = self.kernel.line((x, y, 0.0), (x, y, 1.0))[0]
        else:
            curve = bezier_curve(self.sweep(np.array([[x, y]]))[0], 0.0, self.width)
        return Side(self.kernel, curve, (angle, angle + self.rate * self.width), self.width)


def _required(poles: Floats | None, what: str) -> Floats:
    if poles is None:
        raise SolverError(f"{what} needs a higher degree than the CAD kernel has ({bezier.MOST_DEGREE})")
    return poles

"""Surfaces and edges of a rack's teeth: planes, and cylinders of the fillets' radius, whose axes run along the teeth.

A section of such a cylinder by an end face is an ellipse, on which u of the cylinder is the ellipse's parameter and a quarter
turn: what the edge is in the cylinder's parameters is a sine, which a polynomial follows to 1e-10 mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.exact import bezier
from gearcad.solids.exact.forms import (
    BezierOnSurface,
    CircleCurve,
    CylinderSurface,
    EllipseCurve,
    Frame,
    LineOnSurface,
    OnSurface,
    PlaneSurface,
    unit,
)
from gearcad.solids.rack_plan import Piece

__all__ = ["FilletSurface", "flat_surface"]

_QUARTER = math.pi / 2
_CLOSE = 1e-10
"""Largest error (mm) of an edge's curve in the cylinder's parameters."""


def flat_surface(piece: Piece, drift: float) -> PlaneSurface:
    """The plane of a straight piece, its normal up."""
    (c, y), (to_c, to_y) = piece.start, piece.end
    normal, along = (y - to_y, to_c - c, drift * (to_y - y)), (drift, 0.0, 1.0)
    return PlaneSurface(Frame((c, y, 0.0), unit(normal), unit(along)))


@dataclass(frozen=True)
class FilletSurface:
    """The cylinder of a fillet: u = 0 is straight up from its axis, v runs along the axis from z = 0.

    Its normal points away from the axis, into the rack.
    """

    piece: Piece
    drift: float

    @property
    def _radius(self) -> float:
        assert self.piece.fillet is not None
        return self.piece.fillet.radius

    @property
    def _axis(self) -> tuple[float, float]:
        assert self.piece.fillet is not None
        return self.piece.centre, self.piece.fillet.y

    @property
    def _stretch(self) -> float:
        return math.hypot(1.0, self.drift)

    def surface(self) -> CylinderSurface:
        """The cylinder."""
        c, y = self._axis
        return CylinderSurface(Frame((c, y, 0.0), unit((self.drift, 0.0, 1.0)), (0.0, 1.0, 0.0)), self._radius)

    def u(self, c: float) -> float:
        """u (rad) of the line of constant c on it: pi at the lowest, more towards +x's left."""
        sine = (self._axis[0] - c) / (self._radius * self._stretch)
        return math.pi - math.asin(min(max(sine, -1.0), 1.0))

    def v(self, c: float, z: float) -> float:
        """v (mm) of a place on it."""
        return self._stretch * z - self.drift * self._radius * math.sin(self.u(c))

    def along_teeth(self, c: float, z: float) -> OnSurface:
        """In its parameters: the line of constant c from height z on."""
        return LineOnSurface(self.u(c), self.v(c, z), 0, 1)

    def level(self, z: float) -> CircleCurve | EllipseCurve:
        """The ellipse at height z, with the parameter u - pi/2."""
        c, y = self._axis
        frame = Frame((c + self.drift * z, y, z), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0))
        if self.drift == 0:
            return CircleCurve(frame, self._radius)
        return EllipseCurve(frame, self._radius * self._stretch, self._radius)

    def on_level(self, z: float, first: float, last: float) -> OnSurface:
        """The same in its parameters, between two parameters of the ellipse."""
        if self.drift == 0:
            return LineOnSurface(_QUARTER, z, 1, 0)
        return self._sine(self._stretch * z, -self.drift * self._radius, first, last)

    def upright(self, x: float) -> EllipseCurve:
        """The ellipse in the plane of constant x, with the parameter u - pi/2."""
        c, y = self._axis
        side = math.copysign(1.0, self.drift)
        frame = Frame((x, y, (x - c) / self.drift), (side, 0.0, 0.0), (0.0, 0.0, side))
        return EllipseCurve(frame, self._radius * self._stretch / abs(self.drift), self._radius)

    def on_upright(self, x: float, first: float, last: float) -> OnSurface:
        """The same in its parameters, between two parameters of the ellipse."""
        return self._sine(self._stretch * (x - self._axis[0]) / self.drift, self._radius / self.drift, first, last)

    def _sine(self, middle: float, amplitude: float, first: float, last: float) -> OnSurface:
        """u = t + pi/2, v = middle + amplitude sin u for t from `first` to `last`."""

        def curve(share: Floats) -> Floats:
            t = first + share * (last - first)
            return np.stack([t + _QUARTER, middle + amplitude * np.cos(t)], -1)

        def error(values: Floats, share: Floats) -> Floats:
            return np.asarray(np.abs(values - curve(share)).max(-1))

        close = max(_CLOSE, 1e-15 * (abs(middle) + abs(amplitude)))
        poles = bezier.fit(curve, error, close)
        assert poles is not None  # a sine over less than half a turn
        return BezierOnSurface(poles, first, last)

"""Surfaces and edges of a rack's teeth: planes, and cylinders of the fillets' radius, whose axes run along the teeth.

A section of such a cylinder by an end face is an ellipse, on which u of the cylinder is the ellipse's parameter and a quarter
turn: what the edge is in the cylinder's parameters is a sine, which a polynomial follows to 1e-10 mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.exact import bezier
from gearcad.solids.exact.kernel import Kernel, bezier_curve_2d
from gearcad.solids.rack_plan import Piece

__all__ = ["FilletSurface", "flat_surface"]

_QUARTER = math.pi / 2
_CLOSE = 1e-10
"""Largest error (mm) of an edge's curve in the cylinder's parameters."""


def flat_surface(piece: Piece, drift: float) -> Any:
    """The plane of a straight piece, its normal up."""
    from OCP.Geom import Geom_Plane
    from OCP.gp import gp_Dir, gp_Pnt

    (c, y), (to_c, to_y) = piece.start, piece.end
    return Geom_Plane(gp_Pnt(c, y, 0.0), gp_Dir(y - to_y, to_c - c, drift * (to_y - y)))


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

    def surface(self) -> Any:
        """The cylinder."""
        from OCP.Geom import Geom_CylindricalSurface
        from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

        c, y = self._axis
        return Geom_CylindricalSurface(gp_Ax3(gp_Pnt(c, y, 0.0), gp_Dir(self.drift, 0, 1), gp_Dir(0, 1, 0)), self._radius)

    def u(self, c: float) -> float:
        """u (rad) of the line of constant c on it: pi at the lowest, more towards +x's left."""
        sine = (self._axis[0] - c) / (self._radius * self._stretch)
        return math.pi - math.asin(min(max(sine, -1.0), 1.0))

    def v(self, c: float, z: float) -> float:
        """v (mm) of a place on it."""
        return self._stretch * z - self.drift * self._radius * math.sin(self.u(c))

    def along_teeth(self, kernel: Kernel, c: float, z: float) -> Any:
        """In its parameters: the line of constant c from height z on."""
        return kernel.line_2d(self.u(c), self.v(c, z), 0, 1)

    def level(self, z: float) -> Any:
        """The ellipse at height z, with the parameter u - pi/2."""
        from OCP.Geom import Geom_Circle, Geom_Ellipse
        from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

        c, y = self._axis
        frame = gp_Ax2(gp_Pnt(c + self.drift * z, y, z), gp_Dir(0, 0, 1), gp_Dir(-1, 0, 0))
        if self.drift == 0:
            return Geom_Circle(frame, self._radius)
        return Geom_Ellipse(frame, self._radius * self._stretch, self._radius)

    def on_level(self, kernel: Kernel, z: float, first: float, last: float) -> Any:
        """The same in its parameters, between two parameters of the ellipse."""
        if self.drift == 0:
            return kernel.line_2d(_QUARTER, z, 1, 0)
        return self._sine(self._stretch * z, -self.drift * self._radius, first, last)

    def upright(self, x: float) -> Any:
        """The ellipse in the plane of constant x, with the parameter u - pi/2."""
        from OCP.Geom import Geom_Ellipse
        from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

        c, y = self._axis
        side = math.copysign(1.0, self.drift)
        frame = gp_Ax2(gp_Pnt(x, y, (x - c) / self.drift), gp_Dir(side, 0, 0), gp_Dir(0, 0, side))
        return Geom_Ellipse(frame, self._radius * self._stretch / abs(self.drift), self._radius)

    def on_upright(self, x: float, first: float, last: float) -> Any:
        """The same in its parameters, between two parameters of the ellipse."""
        return self._sine(self._stretch * (x - self._axis[0]) / self.drift, self._radius / self.drift, first, last)

    def _sine(self, middle: float, amplitude: float, first: float, last: float) -> Any:
        """u = t + pi/2, v = middle + amplitude sin u for t from `first` to `last`."""

        def curve(share: Floats) -> Floats:
            t = first + share * (last - first)
            return np.stack([t + _QUARTER, middle + amplitude * np.cos(t)], -1)

        def error(values: Floats, share: Floats) -> Floats:
            return np.asarray(np.abs(values - curve(share)).max(-1))

        close = max(_CLOSE, 1e-15 * (abs(middle) + abs(amplitude)))
        poles = bezier.fit(curve, error, close)
        assert poles is not None  # a sine over less than half a turn
        return bezier_curve_2d(poles, first, last)

"""Stress along the root fillets: tangential strain of the free surface times E', as a response to loads on any tooth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.fea.flank import FlankCompliance
from gearcad.meshing.outline import Side

__all__ = ["FilletStress", "Fillets"]

Floats = NDArray[np.float64]

_GAUSS = 1 / np.sqrt(3)
"""Place of the two points of an edge at which strains of quadratic elements are most accurate."""


_LEAST_ANGLE = 12.0
"""Tangent angle (deg) from which on the fillet counts as the root; it is negative where undercut draws the tooth in."""


@dataclass(frozen=True)
class FilletStress:
    """The greatest tangential stress of a fillet (MPa), its radius (mm), and its angle to the middle of the tooth (deg).

    ISO 6336-3 looks where that angle is 30.
    """

    stress: float
    radius: float
    tangent_angle: float


@dataclass(frozen=True)
class Fillets:
    """The fillet under the loaded flank (tension) and the one behind it (compression), as responses of one body."""

    body: FlankCompliance

    def stresses(self, side: Side, loads: list[tuple[int, float, float]]) -> Floats:
        """Stress (MPa) at the fillet's points of tooth 0 by loads (tooth, roll length in mm, force in N per mm of width)."""
        total = np.zeros(len(self.places(side)[0]))
        for tooth, length, force in loads:
            if abs(tooth) <= self.body.neighbours:
                # A load on tooth j is seen from tooth 0 as the load on tooth 0 is from tooth -j.
                total += self._response(side, -tooth)(length) * force
        return total

    def greatest(self, side: Side, loads: list[tuple[int, float, float]]) -> FilletStress:
        """The largest tension on the left fillet, or compression on the right one."""
        stresses = self.stresses(side, loads)
        radii, angles = self.places(side)
        # Above, a contact near the start of the flank presses on the fillet: that is no bending.
        root = np.flatnonzero(angles >= _LEAST_ANGLE)
        at = root[np.argmax(stresses[root] if side is Side.LEFT_FILLET else -stresses[root])]
        return FilletStress(float(stresses[at]), float(radii[at]), float(angles[at]))

    def places(self, side: Side) -> tuple[Floats, Floats]:
        """Radius (mm) and tangent angle (deg) of each point."""
        return self._geometry[side][:2]

    @cached_property
    def _geometry(self) -> dict[Side, tuple[Floats, Floats, Floats, Floats]]:
        """Radius, tangent angle, unit tangents and metric at the points of both fillets."""
        found = {}
        points = self.body.ring.sector.mesh.points
        for side in (Side.LEFT_FILLET, Side.RIGHT_FILLET):
            edges = self._edges(side)
            where = np.einsum("qa,eac->eqc", _SHAPE, points[edges]).reshape(-1, 2)
            along = np.einsum("qa,eac->eqc", _SLOPE, points[edges]).reshape(-1, 2)
            metric = np.hypot(*along.T)
            angle = np.degrees(np.arctan2(along[:, 1], np.abs(along[:, 0])))
            found[side] = (np.hypot(*where.T), angle, along / metric[:, None], metric)
        return found

    def _edges(self, side: Side) -> NDArray[np.int64]:
        """End, middle, end of each edge, (n, 3)."""
        chain = self.body.ring.sector.mesh.sides[side]
        return np.stack([chain[:-1:2], chain[1::2], chain[2::2]], -1)

    def _response(self, side: Side, tooth: int):  # type: ignore[no-untyped-def]
        """Stress at the fillet of a tooth by 1 N per mm on tooth 0, as a function of the load's roll length."""
        if (side, tooth) not in self._splines:
            from scipy.interpolate import CubicSpline

            body = self.body
            moved = body.displacements[body.neighbours + tooth]
            if tooth == 0:
                moved = moved + body.singular
            edges = self._edges(side)
            _, _, tangent, metric = self._geometry[side]
            slopes = [np.einsum("qa,eam->eqm", _SLOPE, moved[2 * edges + axis]).reshape(-1, moved.shape[1]) for axis in (0, 1)]
            strain = (slopes[0] * tangent[:, :1] + slopes[1] * tangent[:, 1:]) / metric[:, None]
            self._splines[side, tooth] = CubicSpline(body.loads, strain * body.elasticity.modulus, axis=1)
        return self._splines[side, tooth]

    @cached_property
    def _splines(self) -> dict:  # type: ignore[type-arg]
        return {}


_AT = np.array([-_GAUSS, _GAUSS])
_SHAPE = np.stack([_AT * (_AT - 1) / 2, 1 - _AT * _AT, _AT * (_AT + 1) / 2], -1)
_SLOPE = np.stack([_AT - 0.5, -2 * _AT, _AT + 0.5], -1)

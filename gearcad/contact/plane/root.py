"""Stress along the root fillets: tangential strain of the free surface times E', as a response to loads on any tooth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.dissection import node_dofs
from gearcad.contact.plane.flank import PlaneCompliance
from gearcad.contact.plane.rim import SurfaceStresses, far_responses
from gearcad.contact.plane.support import key_load
from gearcad.contact.shared.holding import Hold
from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE, RootStress
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.shapes import GAUSS, edge_shapes, edge_slopes, edges_of

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

__all__ = ["Fillets", "ToothLoad", "seen_from"]


ToothLoad = tuple[int, float, float]
"""Tooth, roll length (mm) and force (N per mm of width)."""


@dataclass(frozen=True)
class Fillets:
    """The fillet under the loaded flank (tension) and the one behind it (compression), as responses of one body.

    Of a rim that bends, the roots of all teeth and the bore too.
    """

    body: PlaneCompliance

    def stresses(self, side: Side, loads: list[ToothLoad]) -> Floats:
        """Stress (MPa) at the points of a side of tooth 0."""
        total = np.zeros(len(self.places(side)[0]))
        for tooth, length, force in loads:
            # A load on tooth j is seen from tooth 0 as the load on tooth 0 is from tooth -j.
            if (seen := self._response(side, -tooth)) is not None:
                total += seen(np.asarray(length)) * force
        return total

    def greatest(self, side: Side, loads: list[ToothLoad]) -> RootStress:
        """The largest tension on the left fillet, or compression on the right one, of tooth 0."""
        return self._at_root(side, self.stresses(side, loads), 1 if side is Side.LEFT_FILLET else -1)

    def extreme(self, side: Side, loads: list[ToothLoad]) -> RootStress:
        """The largest tension (left fillet) or compression (right one) of the loaded teeth.

        Of a rim that bends: of the roots of all teeth, on both sides.
        """
        sign = 1 if side is Side.LEFT_FILLET else -1
        if self.body.ring.support.bends:
            found = [self._at_root(each, stress, sign) for each in _ROOT for stress in self._all_round(each, loads, sign)]
        else:
            found = [self.greatest(side, seen_from(own, loads)) for own, *_ in loads]
        return max(found, key=lambda stress: sign * stress.stress)

    def bore_tension(self, loads: list[ToothLoad]) -> float | None:
        """The largest tension (MPa) on the surface of a bore that nothing keeps round."""
        if not self.body.ring.support.bends:
            return None
        return float(max(stress.max() for stress in self._all_round(Side.HELD, loads, 1)))

    def _all_round(self, side: Side, loads: list[ToothLoad], sign: int) -> Iterator[Floats]:
        """Stresses of every tooth of the gear, with the key where it adds most tension (1) or compression (-1)."""
        torque = self.body.flank.base_radius * sum(force for *_, force in loads)
        by_key = torque * sign * (sign * self._by_key(side)).max(axis=0)
        for own in range(self.body.ring.support.teeth):
            yield self.stresses(side, seen_from(own, loads)) + by_key

    def _at_root(self, side: Side, stresses: Floats, sign: int) -> RootStress:
        radii, angles = self.places(side)
        root = np.flatnonzero(angles >= LEAST_TANGENT_ANGLE)
        at = root[np.argmax(sign * stresses[root])]
        return RootStress(float(stresses[at]), float(radii[at]), float(angles[at]))

    def places(self, side: Side) -> tuple[Floats, Floats]:
        """Radius (mm) and tangent angle (deg) of each point."""
        return self._geometry[side][:2]

    @cached_property
    def _sides(self) -> tuple[Side, ...]:
        return (*_ROOT, Side.HELD) if self.body.ring.support.bends else (Side.LEFT_FILLET, Side.RIGHT_FILLET)

    @cached_property
    def _geometry(self) -> dict[Side, tuple[Floats, Floats, SurfaceStresses]]:
        """Radius and tangent angle of the points of each side, and their stresses by displacements."""
        found = {}
        points = self.body.ring.sector.mesh.points
        for side in self._sides:
            edges = edges_of(self.body.ring.sector.mesh.sides[side])
            where = np.einsum("qa,eac->eqc", _SHAPE, points[edges]).reshape(-1, 2)
            along = np.einsum("qa,eac->eqc", _SLOPE, points[edges]).reshape(-1, 2)
            angle = np.degrees(np.arctan2(along[:, 1], np.abs(along[:, 0])))
            strain = np.tile(_SLOPE, (len(edges), 1))[:, :, None] * (along / (along**2).sum(-1, keepdims=True))[:, None]
            dofs = node_dofs(np.repeat(edges, len(_SLOPE), axis=0))
            stresses = SurfaceStresses(dofs, strain.reshape(len(where), -1) * self.body.elasticity.modulus)
            found[side] = (np.hypot(*where.T), angle, stresses)
        return found

    def _response(self, side: Side, tooth: int) -> CubicSpline | None:
        """Stress on a side of a tooth by 1 N per mm on tooth 0, as a function of the load's roll length; None if unknown."""
        support = self.body.ring.support
        place = (tooth + self.body.neighbours) % support.teeth if support.bends else tooth + self.body.neighbours
        return self._splines[side][place] if 0 <= place < len(self._splines[side]) else None

    @cached_property
    def _splines(self) -> dict[Side, tuple[CubicSpline, ...]]:
        """Stresses (points,) of each side by the roll length of the load, from tooth -neighbours on."""
        from scipy.interpolate import CubicSpline

        loads = self.body.loads
        return {side: tuple(CubicSpline(loads, each.T) for each in teeth) for side, teeth in self._responses.items()}

    @cached_property
    def _responses(self) -> dict[Side, Floats]:
        """Stresses (teeth, points, loads) by the unit loads, from tooth -neighbours on."""
        body, moved = self.body, self.body.displacements.copy()
        moved[body.neighbours] += body.singular
        return self._stresses(moved, body.hub_forces)

    def _by_key(self, side: Side) -> Floats:
        """Stresses (teeth, points) of a side by a torque of 1 (N mm per mm) from the key, less that from all round."""
        ring = self.body.ring
        if ring.support.hold is not Hold.KEY:
            return np.zeros((1, 1))
        return self._keyed[side][..., 0]

    @cached_property
    def _keyed(self) -> dict[Side, Floats]:
        ring = self.body.ring
        load = key_load(ring.sector.mesh, ring.support)
        return self._stresses(ring.solve(load)[0], ring.hub_forces(load))

    def _stresses(self, moved: Floats, hub_forces: Floats | None) -> dict[Side, Floats]:
        """Stresses (teeth, points, m) of each side by displacements (teeth in full, 2 n, m)."""
        rows = SurfaceStresses(
            *(np.concatenate(of) for of in zip(*(self._geometry[side][2] for side in self._sides), strict=True))
        )
        found = [rows.by(each) for each in moved]
        if hub_forces is not None and self.body.ring.support.bends:
            found += far_responses(self.body.ring, rows, moved, hub_forces)
        ends = np.cumsum([len(self.places(side)[0]) for side in self._sides])
        return dict(zip(self._sides, np.split(np.stack(found), ends[:-1], axis=1), strict=True))


def seen_from(own: int, loads: list[ToothLoad]) -> list[ToothLoad]:
    """Loads as a tooth sees them."""
    return [(tooth - own, length, force) for tooth, length, force in loads]


_ROOT = (Side.LEFT_FILLET, Side.LEFT_ROOT, Side.RIGHT_ROOT, Side.RIGHT_FILLET)

_PLACES = np.array([-GAUSS, GAUSS])
_SHAPE, _SLOPE = edge_shapes(_PLACES), edge_slopes(_PLACES)

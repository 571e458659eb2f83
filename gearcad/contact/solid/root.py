"""Stress of the fillet surfaces of a solid tooth, from the profile's foot to the flank and along the face width."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE
from gearcad.core.records import Floats, Wholes
from gearcad.meshing.fem import quadrature, shape_slopes, shape_values
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.quads import edges_of_chain

if TYPE_CHECKING:
    from gearcad.contact.solid.flank import SolidCompliance, ToothForces

__all__ = ["FilletState", "SolidFillet", "SolidFillets", "solid_fillets"]


_STEPS = 4
"""Steps from one point to the next in which the greatest stress is looked for."""


class FilletState(NamedTuple):
    """Principal stresses (MPa) at the points of a fillet (heights, along the profile), the greater and the lesser."""

    greater: Floats
    lesser: Floats


@dataclass(frozen=True)
class SolidFillet:
    """The fillet under the loaded flank (LEFT_FILLET: tension) or behind it (RIGHT_FILLET), as responses of one body.

    Or the bore (INNER), where it is free.
    """

    body: SolidCompliance
    side: OutlineSide

    @property
    def heights(self) -> Floats:
        """Heights z (n,) of the rows of points (mm)."""
        return self._geometry[0]

    @property
    def radii(self) -> Floats:
        """Radius (m,) of the points along the profile (mm)."""
        return self._geometry[1]

    @property
    def tangent_angles(self) -> Floats:
        """Angle (m,) between the profile's tangent and the middle of the tooth (deg)."""
        return self._geometry[2]

    @property
    def internal(self) -> bool:
        """Whether the fillet is that of a ring, and so lies outside the flank."""
        return self.body.flank.gear.internal

    @property
    def is_root(self) -> NDArray[np.bool_]:
        """Mask of the points (m,) along the profile that are the root."""
        return self.tangent_angles >= LEAST_TANGENT_ANGLE

    @cached_property
    def along_root(self) -> Floats:
        """Weights (n, root points) with which values at the points of the root give those along the profile there."""
        mesh = self.body.body.sector.mesh
        chain = mesh.section.points[mesh.side(self.side)]
        run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(chain, axis=0).T))]
        return _between(run[1::2][self.is_root])

    @cached_property
    def along_face(self) -> Floats:
        """Weights (n, heights) with which values at the rows of points give those at `heights_between`."""
        return _between(self.heights)

    @property
    def heights_between(self) -> Floats:
        """Heights (n,) in mm of the rows and of places between them."""
        result: Floats = self.along_face @ self.heights
        return result

    def state(self, loads: list[ToothForces]) -> FilletState:
        """Return the stresses on tooth 0 by loads on it and its neighbours."""
        along, axial, shear = sum(
            (self._stressed(-tooth, forces) for tooth, forces in loads if -tooth in self._responses),
            start=np.zeros((3, len(self.heights), len(self.radii))),
        )
        middle, radius = (along + axial) / 2, np.hypot((along - axial) / 2, shear)
        return FilletState(middle + radius, middle - radius)

    def _stressed(self, tooth: int, forces: Floats) -> Floats:
        """Return the stresses (3, heights, along) of tooth k by forces on tooth 0 as those of `ToothForces`."""
        count = self.body.unit_loads
        normal: Floats = self._responses[tooth] @ forces[:count]
        return normal if len(forces) == count else normal + self._by_friction[tooth] @ forces[count:]

    @cached_property
    def _by_friction(self) -> dict[int, Floats]:
        """Stresses as `_responses`, by forces along the flank."""
        return {tooth: self._stresses(self.body.friction_displacements(tooth)) for tooth in self._responses}

    @cached_property
    def _faces(self) -> Wholes:
        """Nodes (layers, edges, 8) of the fillet's faces: along the profile first, then up."""
        mesh = self.body.body.sector.mesh
        edges = edges_of_chain(mesh.side(self.side))
        return np.stack([mesh.side_faces(edges, layer) for layer in range(mesh.layers)])

    @cached_property
    def _shape(self) -> tuple[Floats, Floats]:
        """Shape functions (2, 8) and slopes (2, 2, 8) at the points of a face: half-way along the profile, below and above.

        There the strain along the profile is the mean of the edge, whatever the shape of the elements behind it.
        """
        places = quadrature("line3", 3).places
        places = np.concatenate([np.full_like(places, 0.5), places], axis=1)
        return shape_values("quad8", places), shape_slopes("quad8", places).swapaxes(0, 1)

    def _at_points(self, values: Floats) -> Floats:
        """Return the values (layers, edges, 2 points, ...) as (heights, along the profile, ...)."""
        layers, edges, _, *rest = values.shape
        return np.moveaxis(values, 2, 1).reshape(2 * layers, edges, *rest)

    @cached_property
    def _geometry(self) -> tuple[Floats, Floats, Floats]:
        mesh = self.body.body.sector.mesh
        values, slopes = self._shape
        where = self._at_points(np.einsum("qa,leac->leqc", values, mesh.points[self._faces]))
        along = np.einsum("a,eac->ec", slopes[0][0], mesh.in_section[self._faces[0]])
        angles = np.degrees(np.arctan2(along[:, 1], np.abs(along[:, 0])))
        return where[:, 0, 2], np.hypot(*np.moveaxis(where[0, :, :2], -1, 0)), angles

    @cached_property
    def _responses(self) -> dict[int, Floats]:
        """Stresses (3, heights, along, loads) of tooth k by the unit loads: along the profile, across it, and shear."""
        neighbours = self.body.neighbours
        teeth = range(-neighbours, neighbours + 1)
        found = {tooth: self._stresses(self.body.surface_displacements(tooth)) for tooth in teeth}
        if self.side is not OutlineSide.HELD:
            found[0] += self._taken_off
        return found

    @cached_property
    def _bases(self) -> tuple[list[Floats], Floats, Floats]:
        """Slopes of the faces both ways, and unit vectors along the profile and square to it, (layers, edges, 2, 3) each."""
        mesh = self.body.body.sector.mesh
        bases = [np.einsum("qa,leac->leqc", slope, mesh.points[self._faces]) for slope in self._shape[1]]
        first = bases[0] / np.linalg.norm(bases[0], axis=-1, keepdims=True)
        upright = bases[1] - (bases[1] * first).sum(-1, keepdims=True) * first
        return bases, first, upright / np.linalg.norm(upright, axis=-1, keepdims=True)

    @property
    def _taken_off(self) -> Floats:
        """The exact stresses of the fields that the elements do not have, as `_stresses`."""
        _, first, second = self._bases
        points = np.einsum("qa,leac->leqc", self._shape[0], self.body.body.sector.mesh.points[self._faces])
        on_first, on_second = (self.body.taken_off_traction(points, normals) for normals in (first, second))
        along = np.einsum("leqcm,leqc->leqm", on_first, first)
        axial = np.einsum("leqcm,leqc->leqm", on_second, second)
        shear = np.einsum("leqcm,leqc->leqm", on_first, second)
        return np.stack([self._at_points(stress) for stress in (along, axial, shear)])

    def _stresses(self, displacements: Floats) -> Floats:
        _, slopes = self._shape
        bases, first, second = self._bases
        vectors = displacements[np.searchsorted(self.body.surface, self._faces)]  # (layers, edges, 8, 3, loads)
        moved = [np.einsum("qa,leacm->leqcm", slope, vectors) for slope in slopes]
        lean, height = ((bases[1] * unit).sum(-1) for unit in (first, second))
        by_first = moved[0] / np.linalg.norm(bases[0], axis=-1)[..., None, None]
        by_second = (moved[1] - lean[..., None, None] * by_first) / height[..., None, None]
        along = np.einsum("leqcm,leqc->leqm", by_first, first)
        axial = np.einsum("leqcm,leqc->leqm", by_second, second)
        shear = np.einsum("leqcm,leqc->leqm", by_first, second) + np.einsum("leqcm,leqc->leqm", by_second, first)
        e, nu = self.body.material.youngs_modulus, self.body.material.poisson_ratio
        plane = e / (1 - nu**2)
        stresses = (plane * (along + nu * axial), plane * (axial + nu * along), e / (2 * (1 + nu)) * shear)
        return np.stack([self._at_points(stress) for stress in stresses])


class SolidFillets(NamedTuple):
    """Fillets of one gear: under the loaded flank, and behind it; and the bore, where it is free."""

    loaded: SolidFillet
    behind: SolidFillet
    bore: SolidFillet | None


def solid_fillets(body: SolidCompliance) -> SolidFillets:
    """Return the fillets of tooth 0 of a body, and its bore."""
    bore = SolidFillet(body, OutlineSide.HELD) if body.body.sector.free else None
    return SolidFillets(SolidFillet(body, OutlineSide.LEFT_FILLET), SolidFillet(body, OutlineSide.RIGHT_FILLET), bore)


def _between(places: Floats) -> Floats:
    """Return the weights (n, places) of a spline at the places (m,) and steps between them: the greatest of a few values would
    depend on where they happen to stand.
    """
    from scipy.interpolate import CubicSpline

    count = len(places)
    if count < 2:
        return np.eye(count)
    every = np.interp(np.arange(_STEPS * (count - 1) + 1) / _STEPS, np.arange(count), places)
    weights: Floats = CubicSpline(places, np.eye(count))(every)
    return weights

"""The fields that are taken off a loaded tooth: a load's on a half-space, and those of its images behind the tooth's ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.solid.boussinesq import (
    half_space_displacement,
    half_space_normal_displacement,
    half_space_traction,
)
from gearcad.contact.solid.places import Places, SolidFlank
from gearcad.material import Material

__all__ = ["Images", "TakenOff"]


@dataclass(frozen=True)
class Images:
    """Mirror images of a load behind both ends of its tooth: what a free end adds to a half-space, but for a smooth rest.

    Load and image together leave no shear on the end; the factor allows for the normal stress that they do leave there.
    """

    flank: SolidFlank
    material: Material

    factor: ClassVar[float] = 1.39
    """At nu = 0.3 (R. Guilbault, Journal of Tribology 133, 2011, 031402); elements and splines carry what it misses."""

    def loads(self, at: Floats, inward: Floats) -> tuple[Floats, Floats, Floats]:
        """Points (..., m, 3), inward normals (..., m, 3) and forces (m,) in N of all that stands for 1 N at points (..., 3)."""
        flip = np.array([1.0, 1.0, -1.0])
        ends = np.array([0.0, self.flank.gear.face_width])
        where = at[..., None, :] * flip + np.outer(2 * ends, [0.0, 0.0, 1.0])
        return where, np.broadcast_to(inward[..., None, :] * flip, where.shape), np.full(2, self.factor)

    def displacement(self, points: Floats, at: Floats, inward: Floats) -> Floats:
        """Displacement (..., 3) in mm at points by all that."""
        where, to, forces = self.loads(at, inward)
        return half_space_displacement(points, where, to, self.material, forces)

    def traction(self, points: Floats, normals: Floats, at: Floats, inward: Floats) -> Floats:
        """Traction (..., 3) in MPa on elements of surface by all that."""
        where, to, forces = self.loads(at, inward)
        return half_space_traction(points, normals, where, to, self.material, forces)

    def normal(self, moved: Places, loaded: Places) -> Floats:
        """Normal displacements (n, m) in mm at places by all that stands for 1 N at each loaded place."""
        points, normals = self.flank.points(moved), self.flank.inward(moved)
        where, to, forces = self.loads(self.flank.points(loaded), self.flank.inward(loaded))
        return half_space_normal_displacement(points, normals, where, to, self.material, forces)


class TakenOff(Images):
    """The field that is taken off: a load's in a half-space, and its images'."""

    def loads(self, at: Floats, inward: Floats) -> tuple[Floats, Floats, Floats]:
        where, to, forces = super().loads(at, inward)
        both = ((one[..., None, :], more) for one, more in ((at, where), (inward, to)))
        points, normals = (np.concatenate(each, axis=-2) for each in both)
        return points, normals, np.r_[1.0, forces]

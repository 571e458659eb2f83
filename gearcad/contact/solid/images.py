"""The fields that are taken off a loaded tooth: a load's on a half-space, and those of its images behind the tooth's ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.solid.boussinesq import half_space_displacement, half_space_traction
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

    def mirrored(self, at: Floats, inward: Floats) -> list[tuple[Floats, Floats]]:
        """Points and inward normals (n, 3) of the images of loads."""
        flip = np.array([1.0, 1.0, -1.0])
        ends = (0.0, self.flank.gear.face_width)
        return [(at * flip + np.array([0.0, 0.0, 2 * end]), inward * flip) for end in ends]

    def displacement(self, points: Floats, at: Floats, inward: Floats) -> Floats:
        """Displacement (..., 3) in mm at points by the images of one load of 1 N."""
        moved = (half_space_displacement(points, where, to, self.material) for where, to in self.mirrored(at, inward))
        return self.factor * sum(moved, start=np.zeros(points.shape))

    def traction(self, points: Floats, normals: Floats, at: Floats, inward: Floats) -> Floats:
        """Traction (..., 3) in MPa on elements of surface by the images of one load of 1 N."""
        found = (half_space_traction(points, normals, where, to, self.material) for where, to in self.mirrored(at, inward))
        return self.factor * sum(found, start=np.zeros(points.shape))

    def normal(self, moved: Places, loaded: Places) -> Floats:
        """Normal displacements (n, m) in mm at places by the images of 1 N at each loaded place."""
        points, normals = self.flank.points(moved)[:, None], self.flank.inward(moved)[:, None]
        at, inward = self.flank.points(loaded), self.flank.inward(loaded)
        result: Floats = (self.displacement(np.broadcast_to(points, (len(points), len(at), 3)), at, inward) * normals).sum(-1)
        return result


class TakenOff(Images):
    """The field that is taken off: a load's in a half-space, and its images'."""

    def displacement(self, points: Floats, at: Floats, inward: Floats) -> Floats:
        return half_space_displacement(points, at, inward, self.material) + super().displacement(points, at, inward)

    def traction(self, points: Floats, normals: Floats, at: Floats, inward: Floats) -> Floats:
        return half_space_traction(points, normals, at, inward, self.material) + super().traction(points, normals, at, inward)

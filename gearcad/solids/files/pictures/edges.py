"""Edges of facets: those at which a surface bends sharply, and those behind which it turns away from the eye."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.solids.facets.tessellation import Facets

__all__ = ["FEATURE_ANGLE", "Edges"]

FEATURE_ANGLE = 25.0
"""Degrees between faces from which on their edge is drawn, and not smoothed."""

_ACROSS = 1e-6
"""Cosine between a normal and the way to the eye that counts as none: walls along the view are not seen from either side."""

_SLIMMEST = 1e-9
"""Height over length of a triangle whose direction is known."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges between two faces: their `ends` (n, 2) by number of vertex, the `normals` (n, 2, 3) of both, which are `sharp`."""

    ends: Wholes
    normals: Floats
    sharp: Bools

    @classmethod
    def of(cls, facets: Facets) -> Self:
        """The edges between two facets that have a direction: where they are open there are none."""
        faces = facets.faces
        a, b, c = (facets.vertices[faces[:, corner]] for corner in range(3))
        across = np.cross(b - a, c - a)
        lengths = np.linalg.norm(across, axis=1)
        normals = across / np.where(lengths > 0, lengths, 1.0)[:, None]
        ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        key = ends[:, 0] * len(facets.vertices) + ends[:, 1]
        order = np.argsort(key, kind="stable")
        first = np.flatnonzero(key[order][1:] == key[order][:-1])
        one, other = order[first], order[first + 1]
        both = np.stack([normals[one % len(faces)], normals[other % len(faces)]], axis=1)
        bent = np.einsum("ij,ij->i", both[:, 0], both[:, 1]) < np.cos(np.radians(FEATURE_ANGLE))
        longest = np.linalg.norm([b - a, c - b, a - c], axis=2).max(axis=0)
        solid = lengths > _SLIMMEST * longest**2
        known = solid[one % len(faces)] & solid[other % len(faces)]
        return cls(ends[one][known], both[known], bent[known])

    def drawn(self, towards: Floats) -> Wholes:
        """Ends (k, 2) of the sharp edges and of those at which the surface turns away from an eye that way (3,)."""
        facing = self.normals @ towards > _ACROSS
        ends: Wholes = self.ends[self.sharp | (facing[:, 0] != facing[:, 1])]
        return ends

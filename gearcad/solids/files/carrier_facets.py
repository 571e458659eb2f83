"""A carrier of planets in triangles."""

from __future__ import annotations

import numpy as np

from gearcad.solids.carrier_plan import CarrierPlan
from gearcad.solids.exact.carrier import carrier_solid
from gearcad.solids.facets.tessellation import Facets

__all__ = ["carrier_facets"]


def carrier_facets(plan: CarrierPlan, chord_error: float) -> Facets:
    """The solid in triangles of the kernel, nowhere more than `chord_error` (mm) from it."""
    vertices, triangles = carrier_solid(plan).tessellate(chord_error)
    points = np.array([vertex.toTuple() for vertex in vertices])
    # The kernel meshes face by face: along their common edges the points are there twice, to the last bit.
    points, same = np.unique(points, axis=0, return_inverse=True)
    return Facets(points, same.reshape(-1)[np.array(triangles)])

"""A point load normal to the plane of a half-space: displacement and stress (Boussinesq; Johnson, Contact Mechanics, 3.2).

With n into the half-space, the vector a from the load to a point at the distance s, the depth z = a.n and c = z/s.
"""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats
from gearcad.material import Material

__all__ = ["half_space_displacement", "half_space_normal_displacement", "half_space_traction", "surface_displacement"]


def surface_displacement(distance: Floats, material: Material) -> Floats:
    """Inward displacement (mm) of the plane at `distance` (mm) from 1 N: (1 - nu^2)/(pi E d)."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    result: Floats = (1 - nu**2) / (np.pi * e * distance)
    return result


def half_space_displacement(
    points: Floats, load_at: Floats, inward: Floats, material: Material, forces: Floats | float = 1.0
) -> Floats:
    """Displacement (..., 3) in mm at `points` (..., 3) by `forces` (N) at `load_at` along the unit vector `inward`; 0 at the
    load. Of several loads, (m, 3) and (m,), the sum.

    2 pi E/(1 + nu) u = ((2 (1 - nu) + c^2) n + (c - (1 - 2 nu)/(1 + c)) (a - z n)/s)/s.
    """
    from gearcad.contact.solid.point_loads import add_displacements

    e, nu = material.youngs_modulus, material.poisson_ratio
    result = np.zeros(points.shape)
    add_displacements(_rows(points), _rows(load_at), _rows(inward), np.atleast_1d(forces), nu, result.reshape(-1, 3))
    result *= (1 + nu) / (2 * np.pi * e)
    return result


def half_space_normal_displacement(
    points: Floats, normals: Floats, load_at: Floats, inward: Floats, material: Material, forces: Floats
) -> Floats:
    """Displacements (n, m) in mm along `normals` (n, 3) at points (n, 3), each the sum by a group of loads (m, k, 3), alike in
    all groups: `forces` (k,) in N.
    """
    from gearcad.contact.solid.point_loads import add_normal_displacements

    e, nu = material.youngs_modulus, material.poisson_ratio
    result = np.zeros((len(points), len(load_at)))
    at, along = (np.ascontiguousarray(each, dtype=float) for each in (load_at, inward))
    add_normal_displacements(_rows(points), _rows(normals), at, along, forces, nu, result)
    result *= (1 + nu) / (2 * np.pi * e)
    return result


def half_space_traction(
    points: Floats, normals: Floats, load_at: Floats, inward: Floats, material: Material, forces: Floats | float = 1.0
) -> Floats:
    """Traction (..., 3) in MPa on elements of surface at `points` with `normals` t (..., 3), by the same loads.

    2 pi s^2 p = -3 c^2 (t.a/s) n - b (t.n) n + b t
                 + ((1 - 2 nu) (2 + c)/(1 + c)^2 (t.r) - 3 c (t.a/s)) r,  r = (a - z n)/s,  b = (1 - 2 nu) (c - 1/(1 + c)):
    pressure along a, as shear and radial stress join with the axial one, and what the surface's freedom adds.
    """
    from gearcad.contact.solid.point_loads import add_tractions

    result, loads = np.zeros(points.shape), (_rows(load_at), _rows(inward), np.atleast_1d(forces))
    add_tractions(_rows(points), _rows(normals), *loads, material.poisson_ratio, result.reshape(-1, 3))
    result /= 2 * np.pi
    return result


def _rows(vectors: Floats) -> Floats:
    """Vectors (..., 3) as rows of doubles."""
    return np.ascontiguousarray(vectors, dtype=float).reshape(-1, 3)

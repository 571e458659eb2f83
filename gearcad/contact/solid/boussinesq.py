"""A point load normal to the plane of a half-space: displacement and stress (Boussinesq; Johnson, Contact Mechanics, 3.2)."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats
from gearcad.material import Material

__all__ = ["half_space_displacement", "half_space_traction", "surface_displacement"]


_AT_LOAD = 1e-9
"""Distance (mm) below which a point is the load's own, where the field has no value."""


def surface_displacement(distance: Floats, material: Material) -> Floats:
    """Inward displacement (mm) of the plane at `distance` (mm) from 1 N: (1 - nu^2)/(pi E d)."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    result: Floats = (1 - nu**2) / (np.pi * e * distance)
    return result


def half_space_displacement(points: Floats, load_at: Floats, inward: Floats, material: Material) -> Floats:
    """Displacement (..., 3) in mm at `points` (..., 3) by 1 N at `load_at` along the unit vector `inward`; 0 at the load."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    depth, across, radial, distance = _cylindrical(points, load_at, inward)
    factor = (1 + nu) / (2 * np.pi * e)
    along = factor * (2 * (1 - nu) / distance + depth**2 / distance**3)
    outward = factor * (across * depth / distance**3 - (1 - 2 * nu) * across / (distance * _above(depth, distance)))
    result: Floats = along[..., None] * inward + outward[..., None] * radial
    result[distance == np.inf] = 0
    return result


def half_space_traction(points: Floats, normals: Floats, load_at: Floats, inward: Floats, material: Material) -> Floats:
    """Traction (..., 3) in MPa on elements of surface at `points` with `normals` (..., 3), by the same load."""
    nu = material.poisson_ratio
    z, r, radial, s = _cylindrical(points, load_at, inward)
    above = s * _above(z, s)
    axial = -3 * z**3 / (2 * np.pi * s**5)
    shear = -3 * r * z**2 / (2 * np.pi * s**5)
    outward = ((1 - 2 * nu) / above - 3 * r**2 * z / s**5) / (2 * np.pi)
    around = (1 - 2 * nu) / (2 * np.pi) * (z / s**3 - 1 / above)
    tangent = np.cross(np.broadcast_to(inward, radial.shape), radial)
    n_axial, n_radial, n_around = (normals * inward).sum(-1), (normals * radial).sum(-1), (normals * tangent).sum(-1)
    result: Floats = (
        (axial * n_axial + shear * n_radial)[..., None] * inward
        + (shear * n_axial + outward * n_radial)[..., None] * radial
        + (around * n_around)[..., None] * tangent
    )
    return result


def _cylindrical(points: Floats, load_at: Floats, inward: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Depth, distance from the load's axis, unit vector away from it, and distance from the load (inf at the load)."""
    away = points - load_at
    depth = (away * inward).sum(-1)
    aside = away - depth[..., None] * inward
    across = np.linalg.norm(aside, axis=-1)
    distance = np.hypot(depth, across)
    distance = np.where(distance < _AT_LOAD, np.inf, distance)
    return depth, across, aside / np.where(across > 0, across, 1.0)[..., None], distance


def _above(depth: Floats, distance: Floats) -> Floats:
    """Distance plus depth, which only vanishes straight outside the half-space."""
    result: Floats = np.maximum(distance + depth, 1e-6 * np.where(np.isinf(distance), 1.0, distance))
    return result

"""A point load normal to the plane of a half-space: displacement and stress (Boussinesq; Johnson, Contact Mechanics, 3.2).

With n into the half-space, the vector a from the load to a point at the distance s, the depth z = a.n and c = z/s.
"""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats
from gearcad.material import Material

__all__ = ["half_space_displacement", "half_space_traction", "surface_displacement"]


_AT_LOAD = 1e-9
"""Distance (mm) below which a point is the load's own, where the field has no value."""

_OUTSIDE = 1e-6
"""Least 1 + c: it only vanishes straight outside the half-space."""


def surface_displacement(distance: Floats, material: Material) -> Floats:
    """Inward displacement (mm) of the plane at `distance` (mm) from 1 N: (1 - nu^2)/(pi E d)."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    result: Floats = (1 - nu**2) / (np.pi * e * distance)
    return result


def half_space_displacement(points: Floats, load_at: Floats, inward: Floats, material: Material) -> Floats:
    """Displacement (..., 3) in mm at `points` (..., 3) by 1 N at `load_at` along the unit vector `inward`; 0 at the load.

    2 pi E/(1 + nu) u = ((2 (1 - nu) + c^2) n + (c - (1 - 2 nu)/(1 + c)) (a - z n)/s)/s.
    """
    e, nu = material.youngs_modulus, material.poisson_ratio
    away = points - load_at
    depth, near, c = _seen(away, inward)
    aside = near**2 * (c - (1 - 2 * nu) / np.maximum(1 + c, _OUTSIDE))
    along = near * (2 * (1 - nu) + c**2) - aside * depth
    result: Floats = along[..., None] * inward + aside[..., None] * away
    return (1 + nu) / (2 * np.pi * e) * result


def half_space_traction(points: Floats, normals: Floats, load_at: Floats, inward: Floats, material: Material) -> Floats:
    """Traction (..., 3) in MPa on elements of surface at `points` with `normals` t (..., 3), by the same load.

    2 pi s^2 p = -3 c^2 (t.a/s) n - b (t.n) n + b t
                 + ((1 - 2 nu) (2 + c)/(1 + c)^2 (t.r) - 3 c (t.a/s)) r,  r = (a - z n)/s,  b = (1 - 2 nu) (c - 1/(1 + c)):
    pressure along a, as shear and radial stress join with the axial one, and what the surface's freedom adds.
    """
    rest = 1 - 2 * material.poisson_ratio
    away = points - load_at
    depth, near, c = _seen(away, inward)
    above = np.maximum(1 + c, _OUTSIDE)
    on_axis, on_away = _dot(normals, inward), _dot(normals, away)
    square = near**2
    around = rest * square * (c - 1 / above)
    pressed = 3 * c * near * square * on_away
    aside = square**2 * (rest * (2 + c) / above**2 * (on_away - depth * on_axis)) - near * pressed
    along = -c * pressed - around * on_axis - aside * depth
    result: Floats = along[..., None] * inward + aside[..., None] * away + around[..., None] * normals
    return result / (2 * np.pi)


def _seen(away: Floats, inward: Floats) -> tuple[Floats, Floats, Floats]:
    """Depth z (mm), 1/s (0 at the load) and c of points `away` (..., 3) from a load."""
    depth, distance = _dot(away, inward), np.sqrt(_dot(away, away))
    near = np.divide(1.0, distance, out=np.zeros_like(distance), where=distance >= _AT_LOAD)
    return depth, near, depth * near


def _dot(first: Floats, second: Floats) -> Floats:
    """Scalar products (...) of vectors (..., 3)."""
    result: Floats = first @ second if second.ndim == 1 else np.einsum("...c,...c->...", first, second)
    return result

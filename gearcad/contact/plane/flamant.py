"""A point load on the straight edge of a half-plane: displacement and stress (Flamant; Johnson, Contact Mechanics, 2.2).

The singular part of every contact solution, known exactly, so that a finite element mesh need not resolve it.
"""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.elasticity import PlaneElasticity

__all__ = ["edge_displacement", "flamant_displacement", "flamant_traction"]


def flamant_displacement(points: Floats, load_at: Floats, inward: Floats, elasticity: PlaneElasticity) -> Floats:
    """Displacement (..., 2) in mm at `points` (..., 2) by 1 N per mm of width at `load_at` along the unit vector `inward`.

    The constant of the logarithm is such that it is ln r with r in mm; at the load itself the value is left at 0.
    """
    e, nu = elasticity.modulus, elasticity.ratio
    away = points - load_at
    across = np.array([-inward[1], inward[0]])
    r = np.hypot(away[..., 0], away[..., 1])
    at_load = r < 1e-12
    r = np.where(at_load, 1.0, r)
    cosine, sine, log = away @ inward / r, away @ across / r, np.log(r)
    angle = np.arctan2(sine, cosine)
    radial = -(2 * cosine * log + (1 - nu) * angle * sine) / (np.pi * e)
    circumferential = (2 * nu * sine + 2 * log * sine - (1 - nu) * angle * cosine + (1 - nu) * sine) / (np.pi * e)
    along = radial * cosine - circumferential * sine
    beside = radial * sine + circumferential * cosine
    result: Floats = along[..., None] * inward + beside[..., None] * across
    result[at_load] = 0
    return result


def flamant_traction(points: Floats, normals: Floats, load_at: Floats, inward: Floats) -> Floats:
    """Traction (..., 2) in MPa on elements of surface at `points` with `normals` (..., 2), by the same load.

    sigma_rr = -2 cos(theta)/(pi r) is the only stress.
    """
    away = points - load_at
    r = np.hypot(away[..., 0], away[..., 1])
    unit = away / r[..., None]
    stress = -2 * (unit @ inward) / (np.pi * r)
    result: Floats = (stress * (unit * normals).sum(-1))[..., None] * unit
    return result


def edge_displacement(distance: Floats, elasticity: PlaneElasticity) -> Floats:
    """Inward displacement (mm) of the straight edge at `distance` (mm): k(d) = -2/(pi E') ln d - (1 + nu')/(pi E')."""
    e, nu = elasticity.modulus, elasticity.ratio
    result: Floats = -(2 * np.log(distance) + 1 + nu) / (np.pi * e)
    return result

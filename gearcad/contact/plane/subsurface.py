"""Stress below a loaded flank: a half-plane under strips of constant pressure (Johnson, Contact Mechanics, 2.5)."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.elasticity import Plane, PlaneElasticity

__all__ = ["greatest_von_mises", "strip_stresses", "von_mises"]


def strip_stresses(x: Floats, depth: Floats, places: Floats, width: float, pressures: Floats) -> tuple[Floats, Floats, Floats]:
    """sigma_x, sigma_z and tau_xz (MPa) at points (x, depth) below strips of `width` (mm) centred on `places`."""
    right, left, z = x[..., None] - places + width / 2, x[..., None] - places - width / 2, depth[..., None]
    to_right, to_left = (np.maximum(end**2 + z**2, np.finfo(float).tiny) for end in (right, left))
    scale = pressures / np.pi
    # From the angles at which both ends of a strip are seen: their difference, and those of their sines and cosines, doubled.
    turned = np.arctan2(z * width, right * left + z**2) @ scale
    sines = (z * (left / to_left - right / to_right)) @ scale
    shear: Floats = (z**2 * (1 / to_right - 1 / to_left)) @ scale
    return -(turned + sines), -(turned - sines), shear


def von_mises(x: Floats, y: Floats, shear: Floats, elasticity: PlaneElasticity) -> Floats:
    """Von Mises stress (...,) in MPa of a plane state; along the axis there is nu (x + y) in plane strain, else nothing."""
    along = elasticity.material.poisson_ratio * (x + y) if elasticity.plane is Plane.STRAIN else np.zeros_like(x)
    result: Floats = np.sqrt(((x - y) ** 2 + (y - along) ** 2 + (along - x) ** 2) / 2 + 3 * shear**2)
    return result


def greatest_von_mises(
    places: Floats, width: float, pressures: Floats, half_width: float, elasticity: PlaneElasticity
) -> tuple[float, float]:
    """Greatest von Mises stress (MPa) below a contact, and its depth (mm)."""
    middle = float((places * pressures).sum() / pressures.sum())
    x, depth = np.meshgrid(
        middle + half_width * np.linspace(-1.2, 1.2, 49), half_width * np.linspace(0.05, 2.0, 79), indexing="ij"
    )
    across, down, shear = strip_stresses(x, depth, places, width, pressures)
    mises = von_mises(across, down, shear, elasticity)
    at = np.unravel_index(np.argmax(mises), mises.shape)
    return float(mises[at]), float(depth[at])

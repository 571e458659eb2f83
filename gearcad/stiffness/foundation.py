"""How a body gives way under its tooth, by formulas. Compliances per face width in mm²/N, lengths in mm, angles in radians."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gearcad.arrays import Floats
from gearcad.material import Material
from gearcad.notice import Notice
from gearcad.stiffness.section import BeamLoad, BeamTooth

__all__ = ["sainsot_foundation", "sainsot_range", "weber_foundation"]


_SAINSOT = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)
"""A ... F of L*, M*, P*, Q* (Sainsot, Velex and Duverger 2004, table 1)."""

_ANGLES, _RIMS = (0.01, 0.12), (1.4, 7.0)
"""theta_f (rad) and h_f that the series was fitted to."""


def sainsot_foundation(tooth: BeamTooth, load: BeamLoad, material: Material, rim: float) -> Floats:
    """1/(k_f) (n,) of an elastic ring under a tooth (Sainsot, Velex, Duverger, J. Mech. Des. 126 (2004), (3) ... (5)).

    cos^2 a_F/E [L* (u/S)^2 + M* u/S + P* (1 + Q* tan^2 a_F)], u from the root circle to where the force crosses the centre
    line, S = 2 r_f theta_f; `rim` h_f = r_f/r_i is the root radius over that where the body is held.
    """
    angle = tooth.root_half_angle
    series = _SAINSOT @ np.array([1 / angle**2, rim**2, rim / angle, 1 / angle, rim, 1.0])
    lever = (load.crossing - tooth.root_radius) / (2 * tooth.root_radius * angle)
    return _polynomial(load, lever, *series) / material.youngs_modulus


def sainsot_range(tooth: BeamTooth, rim: float) -> Iterator[Notice]:
    """Where the tooth leaves the range of the series."""
    for name, value, (low, high) in (("theta_f", tooth.root_half_angle, _ANGLES), ("h_f", rim, _RIMS)):
        if not low <= value <= high:
            text = f"{name} = {value:.4g} is outside the {low:g} ... {high:g} of Sainsot's foundation"
            yield Notice("foundation-range", text)


def weber_foundation(tooth: BeamTooth, load: BeamLoad, material: Material) -> Floats:
    """Compliance (n,) of an elastic half-plane under the root chord (Weber and Banaschek 1953).

    (1 - nu^2) cos^2 a_F/E [18/pi (u/S)^2 + 2 (1 - 2 nu)/(1 - nu) u/S + 4.8/pi (1 + (1 - nu)/2.4 tan^2 a_F)].
    """
    x, h = tooth.root_chord
    nu = material.poisson_ratio
    factors = (18 / math.pi, 2 * (1 - 2 * nu) / (1 - nu), 4.8 / math.pi, (1 - nu) / 2.4)
    return _polynomial(load, (load.crossing - x) / (2 * h), *factors) * (1 - nu**2) / material.youngs_modulus


def _polynomial(load: BeamLoad, lever: Floats, square: float, linear: float, shear: float, axial: float) -> Floats:
    """cos^2 a_F [square lever^2 + linear lever + shear (1 + axial tan^2 a_F)]."""
    across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
    result: Floats = across * (square * lever**2 + linear * lever + shear) + shear * axial * along
    return result

"""Stresses below a line contact, everywhere in the half-space, in closed form; shear stresses of a state.

x lies across the line of contact and z below the surface, both in half widths a; stresses are those over the greatest pressure
p_0, tension positive.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats


class PlaneStresses(NamedTuple):
    """Stresses across the line of contact, down, and shear between both."""

    across: Floats
    down: Floats
    shear: Floats


def below_line_contact(x: Floats, z: Floats) -> PlaneStresses:
    """Return sigma_x, sigma_z and tau_xz over p_0 at x and z in half widths (McEwen 1949; Johnson 4.49).

    m^2 = (r + 1 - x^2 + z^2)/2 and n^2 = (r - 1 + x^2 - z^2)/2 with r^2 = (1 - x^2 + z^2)^2 + 4 x^2 z^2, n with the sign of x:
    sigma_x = -(m (1 + (z^2 + n^2)/(m^2 + n^2)) - 2 z), sigma_z = -m (1 - (z^2 + n^2)/(m^2 + n^2)),
    tau_xz = -n (m^2 - z^2)/(m^2 + n^2).
    """
    x, z = np.broadcast_arrays(np.asarray(x, float), np.asarray(z, float))
    inner = 1 - x**2 + z**2
    root = np.hypot(inner, 2 * x * z)
    m = np.sqrt(np.maximum((root + inner) / 2, 0.0))
    n = np.copysign(np.sqrt(np.maximum((root - inner) / 2, 0.0)), x)
    square = np.maximum(m**2 + n**2, np.finfo(float).tiny)
    part = (z**2 + n**2) / square
    return PlaneStresses(-(m * (1 + part) - 2 * z), -m * (1 - part), -n * (m**2 - z**2) / square)


def largest_shear(stresses: PlaneStresses, along: Floats) -> Floats:
    """Return the largest shear stress of states in the plane with a principal stress `along` the line of contact."""
    middle = (stresses.across + stresses.down) / 2
    half = np.hypot((stresses.across - stresses.down) / 2, stresses.shear)
    result: Floats = (np.maximum(middle + half, along) - np.minimum(middle - half, along)) / 2
    return result

"""Face load factors by ISO 6336-1:2006, clause 7, Method C.

The mesh is a row of equal springs over the face width, and the flanks stand off by a line: stiffness c_gamma_beta in
N/(mm·µm), misalignment F_beta in µm, mean specific load F_m/b = F_t K_A K_v/b in N/mm, lengths in mm. Numbers give a number;
arrays broadcast.
"""

from __future__ import annotations

import numpy as np

from gearcad.geometry import GearPair
from gearcad.rating.factors.elementwise import Values, chosen, root

__all__ = [
    "bearing_width",
    "face_load_exponent",
    "face_load_factor",
    "root_face_load_factor",
    "width_to_height",
]

_LEAST_RATIO = 3.0
"""b/h below which the root's factor takes no further notice of the height."""

_OTHERWISE = 1.0
"""A b_cal/b in place of those that another formula has, so that none divides by 0."""


def bearing_width(misalignment: Values, stiffness: Values, mean_load: Values) -> Values:
    """b_cal/b: width that would carry, as a part of the face width; above 1 all of it does, and how evenly."""
    with np.errstate(divide="ignore"):
        share: Values = np.divide(2 * mean_load, np.abs(misalignment) * stiffness)
    return chosen(share <= 1, root(share), 0.5 + share / 2)


def face_load_factor(misalignment: Values, stiffness: Values, mean_load: Values) -> Values:
    """K_Hbeta: greatest load per width over the mean one, at an effective misalignment F_beta_y of the mesh.

    sqrt(2 F_beta_y c_gamma_beta/(F_m/b)) where only part of the width carries (K at least 2), else
    1 + F_beta_y c_gamma_beta/(2 F_m/b).
    """
    width = bearing_width(misalignment, stiffness, mean_load)
    whole = chosen((width > 1) & (width < np.inf), width, _OTHERWISE)
    return chosen(width <= 1, 2 / width, chosen(width < np.inf, 2 * whole / (2 * whole - 1), 1.0))


def face_load_exponent(width_to_height: Values) -> Values:
    """N_F = (b/h)^2/(1 + b/h + (b/h)^2); b/h below 3 counts as 3."""
    ratio = chosen(width_to_height > _LEAST_RATIO, width_to_height, _LEAST_RATIO)
    return ratio**2 / (1 + ratio + ratio**2)


def root_face_load_factor(flank_factor: Values, width_to_height: Values) -> Values:
    """K_Fbeta = K_Hbeta^N_F."""
    result: Values = flank_factor ** face_load_exponent(width_to_height)
    return result


def width_to_height(pair: GearPair) -> float:
    """b/h: the smaller of both gears' face width over tooth depth h = (d_a - d_f)/2."""
    return min(gear.face_width / ((gear.tip_diameter - gear.root_diameter) / 2) for gear in pair.gears)

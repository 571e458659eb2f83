"""Masses of a pair along the line of action, by ISO 6336-1:2006, 6.5.3: bodies of one thickness all over. Lengths in mm."""

from __future__ import annotations

import math

from gearcad.geometry import Gear
from gearcad.rating.factors.elementwise import Values, magnitude

__all__ = ["body_mass", "inner_diameter", "mass_of", "pair_mass"]


def body_mass(
    tip_diameter: Values, root_diameter: Values, base_diameter: Values, inner_diameter: Values, density: Values
) -> Values:
    """m* (kg/mm) = pi/8 rho |1 - q^4| d_m^4/d_b^2, d_m = (d_a + d_f)/2 and q = d_i/d_m: per width of the face.

    The density in kg/m³. `inner_diameter` d_i is that of the opening; of a ring, whose diameters may be negative, it is that
    of its outside, so that q is above 1.
    """
    middle = (tip_diameter + root_diameter) / 2
    return math.pi / 8 * density * 1e-9 * magnitude(middle**4 - inner_diameter**4) / base_diameter**2


def pair_mass(pinion: Values, wheel: Values) -> Values:
    """m_red (kg/mm) = m_1 m_2/(m_1 + m_2); infinite is the mass of a gear that is held."""
    return 1 / (1 / pinion + 1 / wheel)


def inner_diameter(gear: Gear) -> float | None:
    """d_i (mm): of the bore, or inside the rim of a gear with a web; outside the rim of a ring, None where it has none."""
    body = gear.body
    if gear.internal:
        given = body.rim_diameter
        return given if given or not body.rim_thickness else abs(gear.root_diameter) + 2 * body.rim_thickness
    return max(gear.root_diameter - 2 * body.rim_thickness, 0.0) if body.rim_thickness else body.bore


def mass_of(gear: Gear, density: float) -> float:
    """m* (kg/mm) of a gear, by its density (kg/m³); a ring whose rim is not given is held: infinite."""
    inside = inner_diameter(gear)
    if inside is None:
        return math.inf
    return body_mass(gear.tip_diameter, gear.root_diameter, gear.base_diameter, inside, density)

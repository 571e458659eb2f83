"""The unknowns of a measured gear, as one vector."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["UNKNOWNS", "Unknown"]


class Unknown(IntEnum):
    """Where each stands in the vector; lengths in mm, angles in degrees, coefficients in normal modules."""

    MODULE = 0
    PRESSURE_ANGLE = 1
    HELIX_ANGLE = 2
    SHIFT = 3
    ADDENDUM = 4
    """h_aP + k: what the tip circle stands over the shifted reference circle."""

    DEDENDUM = 5
    THINNING = 6
    """The natural logarithm of the tooth thinning, which is above 0."""

    MATE_SHIFT = 7


UNKNOWNS = len(Unknown)

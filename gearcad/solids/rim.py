"""The rim of a ring: where its solid ends."""

from __future__ import annotations

from gearcad.errors import GeometryError
from gearcad.geometry import Gear
from gearcad.geometry.limits import at_least
from gearcad.geometry.walls import least_rim_diameter

__all__ = ["require_rim"]


def require_rim(gear: Gear) -> float:
    """The rim diameter (mm) of a ring. Raises GeometryError where none was given: the teeth alone are no body."""
    rim = gear.body.rim_diameter
    if rim is None:
        permitted = f"must be given, at least {at_least(least_rim_diameter(gear))} mm: a solid of a ring ends there"
        raise GeometryError("body.rim_diameter", rim, permitted)
    return rim

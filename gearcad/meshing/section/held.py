"""Where the body of a gear ends away from its teeth, and is held."""

from __future__ import annotations

from gearcad.geometry import Gear
from gearcad.rating.rim import outer_diameter

__all__ = ["held_radius", "rim_radius"]

_RIM = 4.0
"""Depth of the body below the root circle, in normal modules, where no bore is given."""

_LEAST = 0.3
"""Its least radius over that of the root circle."""


def held_radius(gear: Gear) -> float:
    """Radius (mm) of the bore or, without one, 4 m_n below the root circle: what lies deeper hardly bends.

    Of a ring that of the rim or, without one, 3.5 m_n outside the root circle, where it is as good as a solid body.
    """
    if gear.internal:
        return outer_diameter(gear) / 2
    return gear.body.bore / 2 if gear.body.bore else rim_radius(gear)


def rim_radius(gear: Gear) -> float:
    """Radius (mm) 4 m_n below the root circle of an external gear."""
    root = gear.root_diameter / 2
    return max(root - _RIM * gear.normal_module, _LEAST * root)

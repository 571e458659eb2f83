"""Where the body of a gear ends inwards."""

from __future__ import annotations

from gearcad.geometry import Gear

__all__ = ["inner_radius", "rim_radius"]

_RIM = 4.0
"""Depth of the body below the root circle, in normal modules, where no bore is given."""

_LEAST = 0.3
"""Its least radius over that of the root circle."""


def inner_radius(gear: Gear) -> float:
    """Radius (mm) of the bore or, without one, 4 m_n below the root circle: what lies deeper hardly bends."""
    return gear.body.bore / 2 if gear.body.bore else rim_radius(gear)


def rim_radius(gear: Gear) -> float:
    """Radius (mm) 4 m_n below the root circle."""
    root = gear.root_diameter / 2
    return max(root - _RIM * gear.normal_module, _LEAST * root)

"""What the sides of meshes are called: left and right as a user sees them, a tooth's tip up, from +z."""

from __future__ import annotations

from gearcad.geometry import Gear

__all__ = ["BORE", "GAP", "RIM", "body_side", "named_left", "rises"]

BORE = "bore"
"""The inner circle of an external gear, that is none where its section is a full disc."""

GAP = "gap"
"""The ground between the halves of a double helical gear; its ends are "gap_back" and "gap_front"."""

RIM = "rim"
"""The outside of a ring."""


def body_side(gear: Gear) -> str:
    """The side where the body ends away from the teeth."""
    return RIM if gear.internal else BORE


def rises(gear: Gear, name: str) -> bool:
    """Whether the "left" or "right" flank is the one with y > 0 of a tooth on +x: the left one is, but that of a ring not."""
    return (name == "left") != gear.internal


def named_left(gear: Gear, *, positive: bool) -> bool:
    """Whether the flank with y > 0 of a tooth on +x, or else the one with y < 0, is called left."""
    return positive != gear.internal

"""Direction: how the speed changes while a chart is run through."""

from __future__ import annotations

from enum import Enum

__all__ = ["Direction"]


class Direction(Enum):
    """How the speed changes in a sweep."""

    UP = "up"
    DOWN = "down"

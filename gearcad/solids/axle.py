"""Axle: what turns as one about an axis of its own, upright in space or in what carries it."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Axle"]


@dataclass(frozen=True)
class Axle:
    """An upright axis through (x, y) (mm) and the name of what turns about it; `on` is the axle that carries it about."""

    name: str
    x: float = 0.0
    y: float = 0.0
    on: Axle | None = None

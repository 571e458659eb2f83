"""Products of solids as plain data: parts with a colour, and assemblies of them with every occurrence in its place."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcad.solids.colours import Colour
from gearcad.solids.exact.boundary import Boundary
from gearcad.solids.exact.forms import Frame, Vector

__all__ = ["AssembledProduct", "Occurrence", "Product", "SolidProduct", "placed"]


@dataclass(frozen=True, eq=False)
class SolidProduct:
    """A part called `name`: its boundary, and its colour as seen on a screen (sRGB), 0 ... 1."""

    name: str
    boundary: Boundary
    colour: Colour | None


@dataclass(frozen=True, eq=False)
class AssembledProduct:
    """An assembly called `name`. A product that occurs more than once is the very same object each time."""

    name: str
    occurrences: tuple[Occurrence, ...]


Product = SolidProduct | AssembledProduct


@dataclass(frozen=True, eq=False)
class Occurrence:
    """A product in an assembly: called `name` there, its origin and axes where the frame is."""

    name: str
    product: Product
    frame: Frame


def placed(offset: Vector = (0.0, 0.0, 0.0), rotation: float = 0.0) -> Frame:
    """The frame of what is turned by `rotation` (degrees) about its z axis, then moved by `offset` (mm)."""
    angle = math.radians(rotation)
    return Frame(offset, (0.0, 0.0, 1.0), (math.cos(angle), math.sin(angle), 0.0))

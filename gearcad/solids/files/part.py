"""Part: a named, coloured body of a scene, in its place."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.axle import Axle
from gearcad.solids.colours import STEEL, Colour
from gearcad.solids.facets.tessellation import Facets

__all__ = ["Part"]


@dataclass(frozen=True, kw_only=True)
class Part:
    """One body of a scene: turned by `rotation` (degrees, about its own z axis), then moved by `offset` (mm).

    `colour` is red, green and blue as seen on a screen (sRGB), 0 ... 1. Parts with the same facets, the very object, are one
    `product` in several places. `axle` is what it turns about in scenes that turn; a part called as its axle is turns with it.
    """

    name: str
    facets: Facets
    colour: Colour = STEEL
    rotation: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    product: str = ""
    axle: Axle | None = None

    @property
    def pose(self) -> Floats:
        """Homogeneous matrix (4, 4) of the part's place."""
        matrix = np.eye(4)
        cosine, sine = math.cos(math.radians(self.rotation)), math.sin(math.radians(self.rotation))
        matrix[:2, :2] = [[cosine, -sine], [sine, cosine]]
        matrix[:3, 3] = self.offset
        return matrix

    @property
    def made_as(self) -> str:
        """What it is called as a product: its own name, where there is only one of it."""
        return self.product or self.name

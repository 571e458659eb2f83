"""Products of shafts: names, colours, solids and facets in files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from gearcad.core.records import PerGear, Wholes
from gearcad.geometry import Gear
from gearcad.solids.body_plan import BEARING_COLOUR, BRIGHT_STEEL, SHAFT_COLOURS, STEEL, Colour
from gearcad.solids.exact.shaft_solid import turned_boundary
from gearcad.solids.exact.solid import Occurrence, SolidProduct, placed
from gearcad.solids.facets.tessellation import Facets, permitted_chord_error
from gearcad.solids.files.scenes import ScenePart
from gearcad.solids.shaft_plan import SeatedShaft, TurnedPlan

if TYPE_CHECKING:
    from gearcad.solids.files.products import FileOptions

_LEAST_SIDES = 24
"""Least number of facets around a shaft."""


def shaft_chord_error(plan: TurnedPlan, chord_error: float) -> float:
    """Return the chord error (mm) that facets of a shaft have: at most 1 % of its largest diameter.

    Raises ParameterError for one that is not positive, or below what the float32 of mesh files resolves.
    """
    return permitted_chord_error(chord_error, max(plan.shaft.length, plan.largest), "shaft", plan.largest)


def turned_facets(plan: TurnedPlan, chord_error: float) -> Facets:
    """Return the triangles of a shaft, nowhere more than `chord_error` (mm) from it; its axis on z, its left end at z = 0.

    All circles have the same number of corners, so the surface is closed. Raises as `shaft_chord_error`.
    """
    error = shaft_chord_error(plan, chord_error)
    sides = max(_LEAST_SIDES, math.ceil(math.pi / math.acos(1 - error / (plan.largest / 2))))
    turns = 2 * math.pi * np.arange(sides) / sides
    around = np.stack([np.cos(turns), np.sin(turns)], -1)
    corners, rings, count = [], list[Wholes](), 0
    for z, radius in (chain := plan.meridian()):
        points = around if radius else np.zeros((1, 2))
        corners.append(np.column_stack([radius * points, np.full(len(points), z)]))
        rings.append(count + (np.arange(sides) if radius else np.zeros(sides, int)))
        count += len(points)
    faces = []
    for number, (_, radius) in enumerate(chain):
        after = (number + 1) % len(chain)
        one, other = rings[number], rings[after]
        if radius:
            faces.append(np.stack([one, np.roll(one, -1), np.roll(other, -1)], -1))
        if chain[after][1]:
            faces.append(np.stack([one, np.roll(other, -1), other], -1))
    return Facets(np.concatenate(corners), np.concatenate(faces))


@dataclass(frozen=True, kw_only=True)
class ShaftProduct:
    """A shaft, called `name`, by itself: its axis on z, its left end at z = 0. Its facets are made once for all files."""

    plan: TurnedPlan
    name: str
    options: FileOptions
    colour: Colour = STEEL

    blanks: ClassVar[dict[str, Gear]] = {}
    """A shaft has no blank of its own."""

    @cached_property
    def facets(self) -> Facets:
        return turned_facets(self.plan, self.options.chord_error)

    def solid(self) -> SolidProduct:
        """Return the shaft as an exact solid: see `shaft_boundary`."""
        return SolidProduct(self.name, turned_boundary(self.plan), BRIGHT_STEEL)

    def scene(self) -> list[ScenePart]:
        """Return the shaft alone."""
        return [ScenePart(name=self.name, facets=self.facets, colour=self.colour)]


@dataclass(frozen=True)
class SeatedProduct:
    """A shaft where it stands in the assembly of a pair, called `name` there and as a product."""

    seated: SeatedShaft
    name: str
    options: FileOptions

    @cached_property
    def product(self) -> ShaftProduct:
        """The shaft by itself."""
        return ShaftProduct(plan=self.seated.plan, name=self.name, options=self.options, colour=self._colour)

    @property
    def _colour(self) -> Colour:
        return PerGear(*SHAFT_COLOURS).pick(self.seated.role)

    def occurrence(self) -> Occurrence:
        """Return the exact solid in its place."""
        part = SolidProduct(self.name, turned_boundary(self.seated.plan), self._colour)
        return Occurrence(self.name, part, placed((self.seated.x, 0.0, self.seated.z), self.seated.rotation))

    @cached_property
    def rings(self) -> dict[str, tuple[ShaftProduct, tuple[float, float, float]]]:
        """The bearings whose sizes are given, by their names in the assembly, and their places (mm)."""
        owner, seated = self.name.removesuffix(" shaft"), self.seated
        return {
            (name := f"{owner} bearing {number}"): (
                ShaftProduct(plan=plan, name=name, options=self.options, colour=BEARING_COLOUR),
                (seated.x, 0.0, z),
            )
            for number, (plan, z) in seated.rings.items()
        }

    def occurrences(self) -> Iterator[Occurrence]:
        """Yield the exact solids of the shaft and of its bearings in their places."""
        yield self.occurrence()
        for name, (product, place) in self.rings.items():
            part = SolidProduct(name, turned_boundary(product.plan), product.colour)
            yield Occurrence(name, part, placed(place, self.seated.rotation))

    def scene_parts(self, rotation: float) -> Iterator[ScenePart]:
        """Yield the facets of the shaft and of its bearings in their places, turned with the gear (degrees)."""
        yield self.scene_part(rotation)
        for name, (product, place) in self.rings.items():
            yield ScenePart(name=name, facets=product.facets, colour=product.colour, rotation=rotation, offset=place)

    def scene_part(self, rotation: float) -> ScenePart:
        """Return the facets in their place, turned with the gear (degrees)."""
        offset = (self.seated.x, 0.0, self.seated.z)
        product = self.product
        return ScenePart(name=self.name, facets=product.facets, colour=product.colour, rotation=rotation, offset=offset)

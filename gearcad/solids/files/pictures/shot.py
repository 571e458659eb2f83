"""Shot: a product before the camera, still or turning, and the picture of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import GeometryError
from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.cutaway import Cut, Cutaway
from gearcad.solids.files.pictures.images import Animation, write_animation, write_png
from gearcad.solids.files.pictures.loops import FRAMES_PER_SECOND, Loop, gear_loop, pair_loop, rack_loop
from gearcad.solids.files.pictures.settings import Product, apart, close_by, cuts_of, direction_of
from gearcad.solids.files.pictures.studio import Pixels, studio
from gearcad.solids.files.pictures.train_loops import train_loop
from gearcad.solids.files.pictures.views import Camera, View, close_up, framed, points_of
from gearcad.solids.files.products import GearProduct, PairProduct
from gearcad.solids.files.rack_products import RackPairProduct
from gearcad.solids.files.train_products import TrainProduct

__all__ = ["Shot", "loop_of"]

_CLOSE, _WIDE = 4.0, 1.2
"""Half the height (normal modules) that a mesh shows close by, and the least width over height at which it does."""

_OF_RACK = 1.5
"""How far of a rack is shown to either side of its pinion from the corner, in tip diameters."""

_LOOKED_AT = 8
"""Scenes of a loop for which the camera is set."""


@dataclass(frozen=True, kw_only=True)
class Shot:
    """A picture of a product in `size` (width, height) pixels; of one in a `loop` it moves. See `gearcad.picture`."""

    product: Product
    view: View = View.CORNER
    size: tuple[int, int]
    cutaway: Cutaway | None = None
    exploded: bool = False
    transparent: bool = False
    loop: Loop | None = None

    def write_png(self, path: Path) -> None:
        """Write it as it is at first."""
        with studio(self.size, transparent=self.transparent) as room:
            write_png(room.photograph(*self._set(0.0)), path)

    def write_animation(self, kind: Animation, path: Path) -> None:
        """Write all frames of its loop."""
        write_animation(self.frames(), path, kind, 1000 // FRAMES_PER_SECOND)

    def frames(self) -> Iterator[Pixels]:
        """One picture after the other; what leads on to the first is the last."""
        count = self.loop.frames if self.loop else 1
        with studio(self.size, transparent=self.transparent) as room:
            for number in range(count):
                yield room.photograph(*self._set(number / count))

    def scene(self, share: float) -> list[Part]:
        """The parts in their places at a share of the loop."""
        parts = list(self.loop.scene(share) if self.loop else self.product.scene())
        return [parts[0], *(_moved(part, self._apart) for part in parts[1:])] if any(self._apart) else parts

    def _set(self, share: float) -> tuple[Sequence[Part], Camera, dict[str, Cut]]:
        parts = self.scene(share)
        return parts, self.camera, cuts_of(self.product, parts, self.cutaway) if self.cutaway else {}

    @cached_property
    def camera(self) -> Camera:
        """From where it is seen, whatever the share."""
        width, height = self.size
        direction = direction_of(self.product, self.view)
        points = np.concatenate([self._looked_at(number / _LOOKED_AT) for number in range(_LOOKED_AT if self.loop else 1)])
        if self.view is not View.MESH:
            return framed(points, direction, width / height)
        place = close_by(self.product)
        return close_up(points, direction, (place.x, place.y), _CLOSE * place.module * max(1.0, _WIDE * height / width))

    def _looked_at(self, share: float) -> Floats:
        """Points (n, 3) that are to be in the picture at a share of the loop."""
        parts = self.scene(share)
        cuts = cuts_of(self.product, parts, self.cutaway) if self.cutaway else {}
        found = []
        for part in parts:
            points = points_of([part])
            if part.name in cuts:
                points = points[cuts[part.name].left(points)]
            if self.view is View.CORNER and isinstance(self.product, RackPairProduct):
                points = points[abs(points[:, 1]) <= _OF_RACK * self.product.pair.pinion.tip_diameter]
            found.append(points)
        return np.concatenate(found)

    @cached_property
    def _apart(self) -> tuple[float, float, float]:
        """How far parts but the first are moved (mm); trains move themselves."""
        if not self.exploded or not isinstance(self.product, PairProduct | RackPairProduct):
            return 0.0, 0.0, 0.0
        return apart(self.product, self.product.scene())


def loop_of(product: Product, view: View) -> Loop:
    """How a product turns; close by, a train is seen from its carrier. Raises GeometryError for what does not turn."""
    if isinstance(product, TrainProduct):
        return train_loop(product, carrier_held=view is View.MESH)
    if isinstance(product, PairProduct):
        return pair_loop(product)
    if isinstance(product, RackPairProduct):
        return rack_loop(product)
    if isinstance(product, GearProduct):
        return gear_loop(product)
    raise GeometryError("turning", True, "needs something that turns: a rack by itself does not")


def _moved(part: Part, by: tuple[float, float, float]) -> Part:
    x, y, z = part.offset
    return replace(part, offset=(x + by[0], y + by[1], z + by[2]))

"""Settings: how products of each kind stand before the camera - seen from which corner, where cut, how far apart."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gearcad.errors import GeometryError
from gearcad.geometry import GearPair
from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.cutaway import Cut, Cutaway
from gearcad.solids.files.pictures.views import Direction, View, points_of
from gearcad.solids.files.products import GearProduct, PairProduct
from gearcad.solids.files.rack_products import RackPairProduct, RackProduct
from gearcad.solids.files.train_products import TrainProduct

__all__ = ["Close", "Product", "apart", "close_by", "cuts_of", "direction_of"]

Product = GearProduct | PairProduct | RackProduct | RackPairProduct | TrainProduct

_FIXED = {
    View.FRONT: Direction((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    View.SIDE: Direction((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    View.TOP: Direction((0.0, 1.0, 0.0), (0.0, 0.0, -1.0)),
    View.MESH: Direction((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
}
"""Third-angle views of what stands along z."""

_UP = (0.0, 0.0, 1.0)
_OF_GEAR = Direction((0.45, -0.9, 0.8), _UP)
_OF_PAIR = Direction((-0.3, -1.0, 0.75), _UP)
_OF_RING = Direction((0.35, -0.8, 1.3), _UP)
_OF_RACK = Direction((0.5, 0.8, 1.1), (0.0, 1.0, 0.0))
_OF_RACK_PAIR = Direction((-1.1, -0.35, 0.9), _UP)
_OF_TRAIN = Direction((0.45, -0.85, 1.1), _UP)
_OF_TRAIN_APART = Direction((0.55, -0.9, 0.6), _UP)
"""From above the corner from which most of the teeth is seen."""

_GAP, _GAP_OF_RING = 0.3, 0.8
"""Between what was moved apart, as a share of the pinion's diameter: a ring is seen from high above."""


def direction_of(product: Product, view: View) -> Direction:
    """From where a product is seen in a view."""
    if view is not View.CORNER:
        return _FIXED[view]
    if isinstance(product, TrainProduct):
        return _OF_TRAIN_APART if product.options.exploded else _OF_TRAIN
    if isinstance(product, PairProduct):
        return _OF_RING if product.pair.internal else _OF_PAIR
    if isinstance(product, GearProduct):
        return _OF_RING if product.gear.internal else _OF_GEAR
    return _OF_RACK if isinstance(product, RackProduct) else _OF_RACK_PAIR


def cuts_of(product: Product, parts: Sequence[Part], cutaway: Cutaway) -> dict[str, Cut]:
    """What a cutaway takes off each part: all on the near side of the plane through the axes along x, of a quarter what is
    on one side of the part's own axis. A train is cut about its own axis, a rack across its width or in the middle of it.
    """
    near, aside = (
        np.array([0.0, -1.0, 0.0]),
        np.array([math.copysign(1.0, direction_of(product, View.CORNER).eye[0]), 0.0, 0.0]),
    )
    upper = np.array([0.0, 0.0, 1.0])
    found = {}
    for part in parts:
        point, normals = np.array(part.offset), (near, aside)
        if isinstance(product, TrainProduct):
            point = np.zeros(3)
        elif isinstance(product, RackProduct):
            point, normals = np.array([product.rack.length / 2, 0.0, product.rack.face_width / 2]), (upper, aside)
        elif isinstance(product, RackPairProduct) and part is parts[1]:
            point, normals = np.array([0.0, 0.0, part.offset[2] + product.pair.rack.face_width / 2]), (near, upper)
        found[part.name] = Cut(point, normals if cutaway is Cutaway.QUARTER else normals[:1])
    return found


def apart(product: PairProduct | RackPairProduct, parts: Sequence[Part]) -> tuple[float, float, float]:
    """How far (mm) the second part of a pair is moved for the first to come free, with a gap: a ring down, others aside.

    Trains move themselves apart.
    """
    diameter = product.pair.pinion.tip_diameter
    pinion, mate = (points_of([part]) for part in parts)
    if isinstance(product, PairProduct) and product.pair.internal:
        return 0.0, 0.0, float(pinion[:, 2].min() - mate[:, 2].max()) - _GAP_OF_RING * diameter
    return float(pinion[:, 0].max() - mate[:, 0].min()) + _GAP * diameter, 0.0, 0.0


class Close(NamedTuple):
    """The pitch point (mm) of a mesh, and its normal module."""

    x: float
    y: float
    module: float


def close_by(product: Product) -> Close:
    """Where teeth mesh; of a train those of its first central with the first planet. Raises GeometryError without a mesh."""
    if isinstance(product, GearProduct | RackProduct):
        raise GeometryError("view", View.MESH, "needs a pair or a train: one part has no mesh")
    if isinstance(product, TrainProduct):
        mesh, planet = product.train.meshes[0], product.plan.layout.planets[0][0]
        central, rim = mesh.central.gear, mesh.rim.gear
        share = central.teeth / (central.teeth + rim.teeth)  # a ring has negative teeth
        return Close(planet.axle.x * share, planet.axle.y * share, central.normal_module)
    pair = product.pair
    radius = pair.working_pitch_diameters.pinion / 2 if isinstance(pair, GearPair) else pair.pitch_radius
    return Close(radius, 0.0, pair.pinion.normal_module)

"""TrainPlan: which bodies of a planetary train are made, and where they stand - in mesh or moved apart, a carrier or none."""

from __future__ import annotations

from dataclasses import dataclass, replace

from gearcad.planetary import PlanetaryTrain
from gearcad.solids.carrier_plan import CarrierPlan, carrier_plan
from gearcad.solids.exploded import exploded as moved_apart
from gearcad.solids.train_layout import TrainLayout
from gearcad.solids.train_room import require_bodies, require_room

__all__ = ["TrainPlan"]


@dataclass(frozen=True)
class TrainPlan:
    """The layout of a train, and its carrier if one is made."""

    layout: TrainLayout
    carrier: CarrierPlan | None = None

    @classmethod
    def of(
        cls, train: PlanetaryTrain, *, carrier_angle: float = 0.0, carrier: bool = False, exploded: bool = False
    ) -> TrainPlan:
        """The plan of a train, its carrier turned by so much (degrees).

        Raises GeometryError for rings without a rim, bodies that stand in each other, a carrier for planets without bores.
        """
        layout = TrainLayout(train, train.pose(carrier_angle))
        require_bodies(layout)
        require_room(layout)
        pins = carrier_plan(layout) if carrier else None
        if not exploded:
            return cls(layout, pins)
        apart = moved_apart(layout, pins)
        return cls(apart, pins.lifted(apart.lifts[layout.carrier.name]) if pins else None)

    def turned(self, carrier_angle: float, central_turn: float) -> TrainPlan:
        """The same turned as by `PlanetaryTrain.pose` (degrees). The carrier's plan stays: as a part it turns with the pose."""
        return replace(self, layout=replace(self.layout, pose=self.layout.train.pose(carrier_angle, central_turn)))

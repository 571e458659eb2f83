"""What files hold of a planetary train: its gears each by itself, and the train in mesh, moved apart, or turning."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from gearcad.planetary import PlanetaryTrain
from gearcad.solids.carrier_plan import CarrierPlan
from gearcad.solids.colours import BRIGHT_STEEL, TRAIN_COLOURS
from gearcad.solids.exact.carrier import carrier_boundary
from gearcad.solids.exact.products import AssembledProduct, SolidProduct
from gearcad.solids.exact.train_assembly import train_product
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.carrier_facets import carrier_facets
from gearcad.solids.files.options import FileOptions
from gearcad.solids.files.part import Part
from gearcad.solids.files.products import GearProduct
from gearcad.solids.files.train_dxf import write_train_dxf
from gearcad.solids.files.train_turning import turning_of
from gearcad.solids.files.turning import Turning
from gearcad.solids.train_layout import TrainLayout
from gearcad.solids.train_plan import TrainPlan

__all__ = ["CarrierProduct", "TrainProduct"]


@dataclass(frozen=True)
class CarrierProduct:
    """The carrier of a train, called `name`: its lowest plate begins at z = 0."""

    plan: CarrierPlan
    name: str
    options: FileOptions

    @cached_property
    def facets(self) -> Facets:
        return carrier_facets(self.plan, self.options.chord_error)

    def solid(self) -> SolidProduct:
        """Pins and plates: see `carrier_boundary`."""
        return SolidProduct(self.name, carrier_boundary(self.plan), BRIGHT_STEEL)

    def scene(self) -> list[Part]:
        """The carrier alone, in the middle."""
        return [Part(name=self.name, facets=self.facets, colour=TRAIN_COLOURS["carrier"][0])]


@dataclass(frozen=True)
class TrainProduct:
    """A planetary train, as the options ask for it. Raises GeometryError where it cannot be made: see `TrainPlan`.

    `speeds` (rpm) are those that are given, by which it turns in an animation.
    """

    train: PlanetaryTrain
    options: FileOptions
    speeds: Mapping[str, float] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return self.train.name

    @cached_property
    def plan(self) -> TrainPlan:
        """What is made, and where it stands."""
        return TrainPlan.of(self.train, carrier=self.options.carrier, exploded=self.options.exploded)

    def require_room(self) -> None:
        """Raise what making the plan raises."""
        _ = self.plan

    @cached_property
    def parts(self) -> dict[str, GearProduct]:
        """The gears by the names of their files."""
        return {
            key: GearProduct(gear=body.gear, name=body.name, options=self.options, colour=body.colour)
            for key, body in TrainLayout(self.train, self.train.pose()).bodies.items()
        }

    def solid(self) -> AssembledProduct:
        """All exact solids in their places: see `train_product`."""
        return train_product(self.plan)

    def scene(self, carrier_angle: float = 0.0, central_turn: float = 0.0) -> list[Part]:
        """All bodies in their places, what is alike with the same facets; turned as by `PlanetaryTrain.pose` (degrees)."""
        return list(self._scene(self.plan.turned(carrier_angle, central_turn)))

    def other_scene(self) -> list[Part]:
        """The same moved apart, or in mesh where the scene is apart already."""
        return list(self._scene(TrainPlan.of(self.train, carrier=self.options.carrier, exploded=not self.options.exploded)))

    def turning(self) -> Turning | None:
        """How the train turns, if that is asked for."""
        return turning_of(self.plan.layout, self.speeds) if self.options.turning else None

    def write_dxf(self, path: Path) -> None:
        """All sections in mesh: see `write_train_dxf`."""
        write_train_dxf(TrainLayout(self.train, self.train.pose()), path, circles=self.options.circles)

    def _scene(self, plan: TrainPlan) -> Iterator[Part]:
        for standing in plan.layout.standing:
            product = self.parts[standing.body.key]
            yield Part(
                name=standing.name,
                facets=product.facets,
                colour=product.colour,
                rotation=standing.rotation,
                offset=standing.offset,
                product=product.name,
                axle=standing.axle,
            )
        if plan.carrier is not None and self.carrier is not None:
            axle, offset = plan.layout.carrier, (0.0, 0.0, plan.carrier.plates[0][0])
            (part,) = self.carrier.scene()
            rotation = plan.layout.pose.carrier_angle
            yield replace(part, name=axle.name, rotation=rotation, offset=offset, product=part.name, axle=axle)

    @cached_property
    def carrier(self) -> CarrierProduct | None:
        """The carrier by itself, if one is made."""
        if not self.options.carrier or self.plan.carrier is None:
            return None
        lowest = self.plan.carrier.plates[0][0]
        return CarrierProduct(self.plan.carrier.lifted(-lowest), f"{self.name} {self.train.carrier.name}", self.options)

"""Products: gears, racks and what they are in mesh, as files and pictures hold them."""

from __future__ import annotations

from collections.abc import Mapping

from gearcad.designs import PairDesign, PlanetaryDesign, RackDesign, RackPairDesign, ToothedDesign
from gearcad.errors import GeometryError
from gearcad.geometry import Gear
from gearcad.solids import FileOptions
from gearcad.solids.files.products import GearProduct, PairProduct
from gearcad.solids.files.rack_products import RackPairProduct, RackProduct
from gearcad.solids.files.train_products import TrainProduct
from gearcad.solids.rim import require_rim

__all__ = ["AssemblyProduct", "PartProduct", "products_of", "require_bodies"]

PartProduct = GearProduct | RackProduct
AssemblyProduct = PairProduct | RackPairProduct | TrainProduct


def products_of(design: ToothedDesign, options: FileOptions) -> tuple[Mapping[str, PartProduct], AssemblyProduct | None]:
    """Gears and racks by the names of their files, and what they are in mesh."""
    if isinstance(design, PlanetaryDesign):
        train = TrainProduct(design.train, options, _given_speeds(design))
        return train.parts, train
    if isinstance(design, PairDesign):
        pair = PairProduct(design.pair, options)
        return pair.parts, pair
    if isinstance(design, RackPairDesign):
        with_rack = RackPairProduct(design.pair, options)
        return with_rack.parts, with_rack
    if isinstance(design, RackDesign):
        return {"rack": RackProduct(rack=design.rack, name=design.name, options=options)}, None
    return {name: GearProduct(gear=gear, name=design.name, options=options) for name, gear in design.gears.items()}, None


def require_bodies(design: ToothedDesign, options: FileOptions) -> None:
    """Raise GeometryError for a ring without a rim, its parameter led by the gear's name, and a train that has no room."""
    for name, gear in design.gears.items():
        _require_body(name, gear)
    if isinstance(design, PlanetaryDesign):
        TrainProduct(design.train, options).require_room()


def _require_body(name: str, gear: Gear) -> None:
    try:
        if gear.internal:
            require_rim(gear)
    except GeometryError as error:
        raise error.within(name) from error


def _given_speeds(design: PlanetaryDesign) -> dict[str, float]:
    """The speeds (rpm) of a train that its design has."""
    of_load = {design.train.input: design.load.speed} if design.load is not None and design.load.speed else {}
    return {**design.speeds, **of_load}

"""Products: gears, racks and what they are in mesh, as files and pictures hold them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeAlias, cast

from gearcad.designs.design import DesignKind
from gearcad.designs.kinds.toothed import ToothedDesign
from gearcad.errors import GeometryError
from gearcad.geometry import Gear
from gearcad.solids import FileOptions
from gearcad.solids.facets.tessellation import gear_chord_error
from gearcad.solids.files.products import GearProduct, PairProduct
from gearcad.solids.rim import require_rim

if TYPE_CHECKING:
    from gearcad.designs import PairDesign, PlanetaryDesign, RackDesign, RackPairDesign
    from gearcad.solids.files.rack_products import RackPairProduct, RackProduct
    from gearcad.solids.files.train_products import TrainProduct

__all__ = ["AssemblyProduct", "PartProduct", "given_speeds", "products_of", "require_bodies", "require_facets"]

PartProduct: TypeAlias = "GearProduct | RackProduct"
AssemblyProduct: TypeAlias = "PairProduct | RackPairProduct | TrainProduct"


def products_of(design: ToothedDesign, options: FileOptions) -> tuple[Mapping[str, PartProduct], AssemblyProduct | None]:
    """Gears and racks by the names of their files, and what they are in mesh."""
    if design.kind is DesignKind.PLANETARY:
        train = _train_product(cast("PlanetaryDesign", design), options)
        return train.parts, train
    if design.kind is DesignKind.PAIR:
        pair = PairProduct(cast("PairDesign", design).pair, options)
        return pair.parts, pair
    if design.kind in (DesignKind.RACK, DesignKind.RACK_PAIR):
        return _with_rack(cast("RackDesign | RackPairDesign", design), options)
    return {name: GearProduct(gear=gear, name=design.name, options=options) for name, gear in design.gears.items()}, None


def _train_product(design: PlanetaryDesign, options: FileOptions) -> TrainProduct:
    from gearcad.solids.files.train_products import TrainProduct

    return TrainProduct(design.train, options, given_speeds(design))


def _with_rack(
    design: RackDesign | RackPairDesign, options: FileOptions
) -> tuple[Mapping[str, PartProduct], RackPairProduct | None]:
    from gearcad.designs import RackPairDesign
    from gearcad.solids.files.rack_products import RackPairProduct, RackProduct

    if isinstance(design, RackPairDesign):
        pair = RackPairProduct(design.pair, options)
        return pair.parts, pair
    return {"rack": RackProduct(rack=design.rack, name=design.name, options=options)}, None


def require_bodies(design: ToothedDesign, options: FileOptions) -> None:
    """Raise GeometryError for a ring without a rim, its parameter led by the gear's name, and a train that has no room."""
    for name, gear in design.gears.items():
        _require_body(name, gear)
    if design.kind is DesignKind.PLANETARY:
        _train_product(cast("PlanetaryDesign", design), options).require_room()


def require_facets(design: ToothedDesign, options: FileOptions) -> None:
    """Raise ParameterError for a chord error that the facets of some gear or rack cannot have, before any is made."""
    for gear in design.gears.values():
        gear_chord_error(gear, options.chord_error)
    if design.kind in (DesignKind.RACK, DesignKind.RACK_PAIR):
        from gearcad.solids.facets.rack_facets import rack_chord_error

        part = cast("RackPairDesign", design).pair if design.kind is DesignKind.RACK_PAIR else cast("RackDesign", design)
        rack_chord_error(part.rack, options.chord_error)


def _require_body(name: str, gear: Gear) -> None:
    try:
        if gear.internal:
            require_rim(gear)
    except GeometryError as error:
        raise error.within(name) from error


def given_speeds(design: PlanetaryDesign) -> dict[str, float]:
    """The speeds (rpm) of a train that its design has."""
    of_load = {design.train.input: design.load.speed} if design.load is not None and design.load.speed else {}
    return {**design.speeds, **of_load}

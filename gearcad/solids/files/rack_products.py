"""What files hold of racks: one by itself, or a pinion and a rack in mesh, under their names and in their colours there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from gearcad.geometry.rack import Rack
from gearcad.geometry.rack_pair import RackPair
from gearcad.solids.colours import BRIGHT_STEEL, PART_COLOURS, STEEL, Colour
from gearcad.solids.exact.products import AssembledProduct, SolidProduct
from gearcad.solids.exact.rack_assembly import rack_part_names, rack_product
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.facets.rack_facets import tessellate_rack
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.options import FileOptions
from gearcad.solids.files.part import Part
from gearcad.solids.files.products import GearProduct
from gearcad.solids.files.rack_dxf import write_rack_dxf
from gearcad.solids.files.rack_points import write_rack_points

__all__ = ["RackPairProduct", "RackProduct"]


@dataclass(frozen=True, kw_only=True)
class RackProduct:
    """A rack, called `name`; its facets are made once for all files that hold them."""

    rack: Rack
    name: str
    options: FileOptions
    colour: Colour = STEEL

    @cached_property
    def facets(self) -> Facets:
        return tessellate_rack(self.rack, self.options.chord_error)

    def solid(self) -> SolidProduct:
        """The rack as an exact solid: see `rack_boundary`."""
        return SolidProduct(self.name, rack_boundary(self.rack), BRIGHT_STEEL)

    def scene(self) -> list[Part]:
        """The rack alone, as it lies."""
        return [Part(name=self.name, facets=self.facets, colour=self.colour)]

    def write_dxf(self, path: Path) -> None:
        """Its side view: see `write_rack_dxf`."""
        write_rack_dxf(self.rack, path, lines=self.options.circles)

    def write_points(self, path: Path) -> None:
        """The outline of a tooth: see `write_rack_points`."""
        write_rack_points(self.rack, path)


@dataclass(frozen=True)
class RackPairProduct:
    """A pinion and a rack in mesh."""

    pair: RackPair
    options: FileOptions

    @property
    def name(self) -> str:
        return self.pair.name

    @cached_property
    def pinion(self) -> GearProduct:
        """The pinion by itself."""
        name, _ = rack_part_names(self.pair)
        return GearProduct(gear=self.pair.pinion, name=name, options=self.options, colour=PART_COLOURS["pinion"])

    @cached_property
    def rack(self) -> RackProduct:
        """The rack by itself."""
        _, name = rack_part_names(self.pair)
        return RackProduct(rack=self.pair.rack, name=name, options=self.options, colour=PART_COLOURS["rack"])

    @property
    def parts(self) -> dict[str, GearProduct | RackProduct]:
        """Both by the names of their files."""
        return {"pinion": self.pinion, "rack": self.rack}

    def solid(self) -> AssembledProduct:
        """Both exact solids posed in mesh: see `rack_product`."""
        return rack_product(self.pair)

    def scene(self, pinion_rotation: float = 0.0) -> list[Part]:
        """Both posed in mesh, the pinion turned by so much (degrees)."""
        pose = self.pair.rack_pose(pinion_rotation)
        (pinion,), (rack,) = self.pinion.scene(pinion_rotation), self.rack.scene()
        return [pinion, replace(rack, rotation=pose.rotation, offset=(pose.x, pose.y, pose.z))]

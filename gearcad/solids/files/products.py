"""What files hold: a gear or a pair in mesh, under the names and in the colours it has there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from gearcad.geometry import Gear, GearPair
from gearcad.per_gear import PerGear, Role
from gearcad.solids.colours import BRIGHT_STEEL, PART_COLOURS, STEEL, Colour
from gearcad.solids.exact.assembly import pair_product, part_names
from gearcad.solids.exact.products import AssembledProduct, SolidProduct
from gearcad.solids.exact.solid import gear_boundary
from gearcad.solids.facets.tessellation import Facets, tessellate
from gearcad.solids.files.options import FileOptions
from gearcad.solids.files.part import Part

__all__ = ["GearProduct", "PairProduct"]


@dataclass(frozen=True, kw_only=True)
class GearProduct:
    """A gear, called `name`; its facets are made once for all files that hold them."""

    gear: Gear
    name: str
    options: FileOptions
    colour: Colour = STEEL

    @cached_property
    def facets(self) -> Facets:
        return tessellate(self.gear, self.options.chord_error)

    def solid(self) -> SolidProduct:
        """The gear as an exact solid: see `gear_boundary`."""
        return SolidProduct(self.name, gear_boundary(self.gear), BRIGHT_STEEL)

    def scene(self, rotation: float = 0.0) -> list[Part]:
        """The gear alone at the origin, turned by so much (degrees)."""
        return [Part(name=self.name, facets=self.facets, colour=self.colour, rotation=rotation)]

    def write_dxf(self, path: Path) -> None:
        """Its section: see `write_dxf`."""
        from gearcad.solids.files.dxf import write_dxf

        write_dxf(self.gear, path, circles=self.options.circles)

    def write_points(self, path: Path) -> None:
        """The outline of a tooth and the tool: see `write_points`."""
        from gearcad.solids.files.points import write_points

        write_points(self.gear, path)


@dataclass(frozen=True)
class PairProduct:
    """A pair in mesh."""

    pair: GearPair
    options: FileOptions

    @property
    def name(self) -> str:
        return self.pair.name

    @cached_property
    def gears(self) -> PerGear[GearProduct]:
        """The gears, each by itself."""
        names = part_names(self.pair).gears

        def product(role: Role) -> GearProduct:
            gear, name, colour = self.pair.gears.pick(role), names.pick(role), PART_COLOURS[role.value]
            return GearProduct(gear=gear, name=name, options=self.options, colour=colour)

        return PerGear.each(product)

    @property
    def parts(self) -> dict[str, GearProduct]:
        """The gears by the names of their files."""
        return {role.value: product for role, product in self.gears.items()}

    def solid(self) -> AssembledProduct:
        """Both exact solids posed in mesh: see `pair_product`."""
        return pair_product(self.pair, bracket=self.options.bracket)

    def scene(self, pinion_rotation: float = 0.0) -> list[Part]:
        """Both gears posed in mesh, the pinion turned by so much (degrees)."""
        pose = self.pair.wheel_pose(pinion_rotation)
        (pinion,), (wheel,) = self.gears.pinion.scene(pinion_rotation), self.gears.wheel.scene()
        return [pinion, replace(wheel, rotation=pose.rotation, offset=(pose.x, 0.0, pose.z))]

"""Products of gears, pairs, racks and splines: names, colours, solids and facets in files; the options of these files."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar

from gearcad.core.errors import require_number, require_switch
from gearcad.core.records import PerGear, Role
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.rack import Rack
from gearcad.geometry.rack_pair import RackPair
from gearcad.geometry.spline import SplineJoint
from gearcad.solids.body_plan import BRIGHT_STEEL, PART_COLOURS, STEEL, Colour
from gearcad.solids.exact.assemblies import (
    pair_product,
    part_names,
    rack_part_names,
    rack_product,
    shaft_part_name,
    spline_part_name,
    spline_product,
)
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.kernel_mesh import kernel_facets
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import AssembledProduct, SolidProduct, gear_boundary
from gearcad.solids.facets.tessellation import Facets, tessellate, tessellate_rack
from gearcad.solids.files.dxf import write_rack_dxf
from gearcad.solids.files.points import write_rack_points
from gearcad.solids.files.scenes import ScenePart
from gearcad.solids.files.shaft_products import SeatedProduct, ShaftProduct
from gearcad.solids.shaft_plan import SeatedShaft


@dataclass(frozen=True, kw_only=True)
class FileOptions:
    """Options of files; a format names the options that matter to it.

    `chord_error` (mm) bounds the facets; `bracket` puts a pair on two shafts with a bracket; `circles` draws the tip,
    reference, base and root circles beside a section; `ap242` writes STEP in AP242 in place of AP214. Of a planetary train,
    `carrier` makes a carrier with pins, `exploded` moves members apart along the axis, and `turning` lets the scene turn.
    Raises ParameterError for a chord error that is not positive.
    """

    chord_error: float = 0.005
    bracket: bool = False
    circles: bool = False
    carrier: bool = False
    exploded: bool = False
    turning: bool = False
    ap242: bool = False

    def __post_init__(self) -> None:
        require_number("chord_error", self.chord_error, "mm", above=0)
        for name in ("bracket", "circles", "carrier", "exploded", "turning", "ap242"):
            require_switch(name, getattr(self, name))


@dataclass(frozen=True, kw_only=True)
class GearProduct:
    """A gear, called `name`; its facets are made once for all files that hold them."""

    gear: Gear
    name: str
    options: FileOptions
    colour: Colour = STEEL

    @cached_property
    def facets(self) -> Facets:
        if self.gear.body.step is not None:
            from gearcad.solids.exact.own_blank import toothed_blank

            return kernel_facets(toothed_blank(self.gear).wrapped, self.options.chord_error)
        if self.gear.first_layer:  # a step at its end
            return kernel_facets(kernel_solid(gear_boundary(self.gear)), self.options.chord_error)
        return tessellate(self.gear, self.options.chord_error)

    @property
    def blanks(self) -> dict[str, Gear]:
        """The gear by its name as a product, if it has a blank of its own."""
        return {self.name: self.gear} if self.gear.body.step is not None else {}

    def solid(self) -> SolidProduct:
        """Return the gear as an exact solid: see `gear_boundary`."""
        return SolidProduct(self.name, gear_boundary(self.gear), BRIGHT_STEEL)

    def scene(self, rotation: float = 0.0) -> list[ScenePart]:
        """Return the gear alone at the origin, turned by so much (degrees)."""
        return [ScenePart(name=self.name, facets=self.facets, colour=self.colour, rotation=rotation)]

    def write_dxf(self, path: Path) -> None:
        """Write the gear's section: see `write_dxf`."""
        from gearcad.solids.files.dxf import write_dxf

        write_dxf(self.gear, path, circles=self.options.circles)

    def write_points(self, path: Path) -> None:
        """The outline of a tooth and the tool: see `write_points`."""
        from gearcad.solids.files.points import write_points

        write_points(self.gear, path)


@dataclass(frozen=True, kw_only=True)
class MadeProduct(GearProduct):
    """A gear as its mould or print is made; of one that is cut, the path of the wire or beam."""

    @classmethod
    def of(cls, product: GearProduct) -> MadeProduct:
        """Return the product of the same name, as it is made."""
        made = product.gear if product.gear.making.cuts else product.gear.as_made
        return cls(gear=made, name=product.name, options=product.options, colour=product.colour)

    def write_dxf(self, path: Path) -> None:
        """Write the section as it is made, or the path: see `write_path_dxf`."""
        if not self.gear.making.cuts:
            super().write_dxf(path)
            return
        from gearcad.solids.files.cut_path import write_path_dxf

        write_path_dxf(self.gear, path)


@dataclass(frozen=True)
class PairProduct:
    """A pair in mesh, and the `seated` shafts on which its gears sit."""

    pair: GearPair
    options: FileOptions
    seated: tuple[SeatedShaft, ...] = ()

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

    @cached_property
    def shafts(self) -> tuple[SeatedProduct, ...]:
        """The shafts in their places."""
        return tuple(SeatedProduct(each, shaft_part_name(self.pair, each), self.options) for each in self.seated)

    @property
    def bodies(self) -> dict[str, ShaftProduct]:
        """The shafts by the names of their files."""
        return {each.seated.file: each.product for each in self.shafts}

    @property
    def blanks(self) -> dict[str, Gear]:
        """Gears with blanks of their own by their names as products."""
        return {name: gear for part in self.parts.values() for name, gear in part.blanks.items()}

    def solid(self) -> AssembledProduct:
        """Return both exact solids posed in mesh, with their shafts: see `pair_product`."""
        made = pair_product(self.pair, bracket=self.options.bracket)
        return (
            made
            if not self.shafts
            else replace(made, occurrences=(*made.occurrences, *(made for each in self.shafts for made in each.occurrences())))
        )

    def scene(self, pinion_rotation: float = 0.0) -> list[ScenePart]:
        """Return both gears posed in mesh, the pinion turned by an angle (degrees), then their shafts."""
        pose = self.pair.wheel_pose(pinion_rotation)
        (pinion,), (wheel,) = self.gears.pinion.scene(pinion_rotation), self.gears.wheel.scene()
        turns = {Role.PINION: pinion_rotation, Role.WHEEL: pose.rotation}
        shafts = (part for each in self.shafts for part in each.scene_parts(turns[each.seated.role]))
        return [pinion, replace(wheel, rotation=pose.rotation, offset=(pose.x, 0.0, pose.z)), *shafts]

    @cached_property
    def shaft_roles(self) -> dict[str, Role]:
        """The gears of the shafts, by the names of shafts and bearings as products."""
        return {name: each.seated.role for each in self.shafts for name in (each.name, *each.rings)}

    @property
    def rings(self) -> dict[str, ShaftProduct]:
        """The bearings whose sizes are given, by their names as products: bought parts, which have no files of their own."""
        return {name: product for each in self.shafts for name, (product, _) in each.rings.items()}


@dataclass(frozen=True)
class SplineProduct:
    """A splined shaft and the hub on it."""

    joint: SplineJoint
    options: FileOptions

    @property
    def name(self) -> str:
        return self.joint.name

    @cached_property
    def parts(self) -> dict[str, GearProduct]:
        """Shaft and hub by the names of their files."""
        return {
            name: GearProduct(
                gear=part.gear,
                name=spline_part_name(self.joint, name),
                options=self.options,
                colour=STEEL if len(self.joint.parts) == 1 else PART_COLOURS[name],
            )
            for name, part in self.joint.parts.items()
        }

    blanks: ClassVar[dict[str, Gear]] = {}
    """A spline has no blanks of its own."""

    def solid(self) -> AssembledProduct:
        """Return both exact solids on one axis: see `spline_product`."""
        return spline_product(self.joint)

    def scene(self, rotation: float = 0.0) -> list[ScenePart]:
        """Return both parts on one axis, turned together by an angle (degrees)."""
        turns = {"shaft": 0.0, "hub": self.joint.hub_rotation}
        return [scene for name, part in self.parts.items() for scene in part.scene(turns[name] + rotation)]


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

    blanks: ClassVar[dict[str, Gear]] = {}
    """A rack has no blank of its own."""

    def solid(self) -> SolidProduct:
        """Return the rack as an exact solid: see `rack_boundary`."""
        return SolidProduct(self.name, rack_boundary(self.rack), BRIGHT_STEEL)

    def scene(self) -> list[ScenePart]:
        """Return the rack alone, as it lies."""
        return [ScenePart(name=self.name, facets=self.facets, colour=self.colour)]

    def write_dxf(self, path: Path) -> None:
        """Write the rack's side view: see `write_rack_dxf`."""
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
        """Pinion and rack by the names of their files."""
        return {"pinion": self.pinion, "rack": self.rack}

    @property
    def blanks(self) -> dict[str, Gear]:
        """The pinion by its name as a product, if it has a blank of its own."""
        return self.pinion.blanks

    def solid(self) -> AssembledProduct:
        """Return both exact solids posed in mesh: see `rack_product`."""
        return rack_product(self.pair)

    def scene(self, pinion_rotation: float = 0.0) -> list[ScenePart]:
        """Return pinion and rack posed in mesh, the pinion turned by an angle (degrees)."""
        pose = self.pair.rack_pose(pinion_rotation)
        (pinion,), (rack,) = self.pinion.scene(pinion_rotation), self.rack.scene()
        return [pinion, replace(rack, rotation=pose.rotation, offset=(pose.x, pose.y, pose.z))]

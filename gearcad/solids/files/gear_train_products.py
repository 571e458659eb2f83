"""Products of a train of pairs: its gears and shafts posed in mesh, as exact solids and as scenes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from gearcad.geometry import Gear
from gearcad.solids.body_plan import PART_COLOURS, SHAFT_COLOURS, Colour
from gearcad.solids.exact.shaft_solid import turned_boundary
from gearcad.solids.exact.solid import AssembledProduct, Occurrence, SolidProduct, gear_boundary, placed
from gearcad.solids.files.products import FileOptions, GearProduct
from gearcad.solids.files.scenes import ScenePart
from gearcad.solids.files.shaft_products import ShaftProduct
from gearcad.solids.gear_train_plan import GearKey, GearTrainPlan, StandingGear, StandingShaft

_DARKER = 0.85
"""Colours of a stage against those of the stage before it."""


@dataclass(frozen=True)
class GearTrainProduct:
    """A train of pairs in mesh; its gears and shafts are called as in the train, behind its name as products."""

    plan: GearTrainPlan
    options: FileOptions

    @property
    def name(self) -> str:
        return self.plan.name

    def product_name(self, name: str) -> str:
        """Return the name of a gear or shaft as a product: no two designs may share one."""
        return f"{self.name} {name}"

    @cached_property
    def gears(self) -> dict[GearKey, GearProduct]:
        """The gears by themselves."""
        return {
            each.key: GearProduct(
                gear=each.gear, name=self.product_name(each.name), options=self.options, colour=self._colour(each)
            )
            for each in self.plan.gears
        }

    @cached_property
    def bodies(self) -> dict[str, ShaftProduct]:
        """The shafts by themselves, by their names."""
        return {
            each.name: ShaftProduct(
                plan=each.plan, name=self.product_name(each.name), options=self.options, colour=self._shaft_colour(each)
            )
            for each in self.plan.standing_shafts
        }

    def _colour(self, gear: StandingGear) -> Colour:
        stage = [mesh.name for mesh in self.plan.meshes].index(gear.key.mesh)
        red, green, blue = PART_COLOURS[gear.key.role.value]
        return red * _DARKER**stage, green * _DARKER**stage, blue * _DARKER**stage

    def _shaft_colour(self, shaft: StandingShaft) -> Colour:
        return SHAFT_COLOURS[self.plan.standing_shafts.index(shaft) % len(SHAFT_COLOURS)]

    @property
    def blanks(self) -> dict[str, Gear]:
        """Gears with blanks of their own by their names as products."""
        return {name: gear for part in self.gears.values() for name, gear in part.blanks.items()}

    def solid(self) -> AssembledProduct:
        """Return the exact solids of gears and shafts in their places."""
        found = []
        for each in self.plan.gears:
            part = SolidProduct(self.product_name(each.name), gear_boundary(each.gear), self._colour(each))
            found.append(Occurrence(each.name, part, placed((each.x, each.y, each.z), each.rotation)))
        for shaft in self.plan.standing_shafts:
            part = SolidProduct(self.product_name(shaft.name), turned_boundary(shaft.plan), self._shaft_colour(shaft))
            found.append(Occurrence(shaft.name, part, placed((shaft.x, shaft.y, shaft.z), shaft.rotation)))
        return AssembledProduct(self.name, tuple(found))

    def scene(self) -> list[ScenePart]:
        """Return gears and shafts in their places."""
        found = []
        for each in self.plan.gears:
            (part,) = self.gears[each.key].scene()
            found.append(replace(part, name=each.name, rotation=each.rotation, offset=(each.x, each.y, each.z)))
        for shaft in self.plan.standing_shafts:
            (part,) = self.bodies[shaft.name].scene()
            found.append(replace(part, name=shaft.name, rotation=shaft.rotation, offset=(shaft.x, shaft.y, shaft.z)))
        return found

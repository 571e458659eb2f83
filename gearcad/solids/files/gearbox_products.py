"""Products of a gearbox of planetary sets: its gears, and all of them posed in mesh, as exact solids and as scenes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from gearcad.geometry import Gear
from gearcad.planetary.gearbox import Gearbox
from gearcad.planetary.poses import GearPlace
from gearcad.solids.body_plan import TRAIN_COLOURS, Colour
from gearcad.solids.exact.solid import AssembledProduct, Occurrence, SolidProduct, gear_boundary, placed
from gearcad.solids.files.products import FileOptions, GearProduct
from gearcad.solids.files.scenes import ScenePart

_DARKER = 0.85
"""Colours of a set against those of the set before it."""


@dataclass(frozen=True)
class GearboxProduct:
    """A gearbox whose gears are known, in the pose in which it was put together; gears are called as in the gearbox."""

    gearbox: Gearbox
    options: FileOptions

    @property
    def name(self) -> str:
        return self.gearbox.name

    @cached_property
    def parts(self) -> dict[str, GearProduct]:
        """The gears by themselves, by names such as "set1.sun"; planets of a name are one."""
        return {
            f"{name}.{part}": GearProduct(
                gear=own.gear, name=f"{self.name} {name}.{part}", options=self.options, colour=self._colour(name, part)
            )
            for name, assembly in self.gearbox.assemblies.items()
            for part, own in assembly.gearing.gears.items()
        }

    @cached_property
    def places(self) -> dict[str, GearPlace]:
        """Places of all gears by names such as "set1.sun" and "set1.planet 2"."""
        return self.gearbox.pose()

    def part_of(self, name: str) -> str:
        """Return the name of the part of which a gear in its place is one."""
        return name if name in self.parts else name.rpartition(" ")[0]

    def _colour(self, name: str, part: str) -> Colour:
        assembly = self.gearbox.assemblies[name]
        kinds = {
            "rims": [each.name for each in assembly.subject.planets],
            "suns": [each.name for each in assembly.subject.centrals if each.teeth > 0],
            "rings": [each.name for each in assembly.subject.centrals if each.teeth < 0],
        }
        kind, names = next((kind, names) for kind, names in kinds.items() if part in names)
        red, green, blue = TRAIN_COLOURS[kind][names.index(part) % 2]
        darker = _DARKER ** list(self.gearbox.assemblies).index(name)
        return red * darker, green * darker, blue * darker

    @property
    def blanks(self) -> dict[str, Gear]:
        """Gears with blanks of their own by their names as products."""
        return {name: gear for part in self.parts.values() for name, gear in part.blanks.items()}

    def solid(self) -> AssembledProduct:
        """Return the exact solids of all gears in their places."""
        solids = {name: SolidProduct(part.name, gear_boundary(part.gear), part.colour) for name, part in self.parts.items()}
        found = [
            Occurrence(name, solids[self.part_of(name)], placed((place.x, place.y, place.height), place.rotation))
            for name, place in self.places.items()
        ]
        return AssembledProduct(self.name, tuple(found))

    def scene(self) -> list[ScenePart]:
        """Return all gears in their places."""
        scenes = {name: part.scene()[0] for name, part in self.parts.items()}
        return [
            replace(scenes[self.part_of(name)], name=name, rotation=place.rotation, offset=(place.x, place.y, place.height))
            for name, place in self.places.items()
        ]

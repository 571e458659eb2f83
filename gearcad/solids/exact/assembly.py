"""A pair posed in mesh: two named, coloured parts, optionally on two shafts with a bracket."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from gearcad.errors import GeometryError
from gearcad.geometry.gear import Gear
from gearcad.geometry.pair import GearPair
from gearcad.per_gear import PerGear, Role
from gearcad.solids.colours import PART_COLOURS
from gearcad.solids.exact.solid import gear_solid

if TYPE_CHECKING:
    import cadquery

__all__ = ["UNNAMED", "PartNames", "pair_assembly", "part_names"]

_ARM = 0.6
"""Width of the bracket's arm as a share of the thicker shaft's diameter."""

UNNAMED = ("gear", "pinion", "wheel")
"""Names that a gear has where nobody named it."""


class PartNames(NamedTuple):
    """Names of the parts of an assembly as products."""

    gears: PerGear[str]
    bracket: str


def part_names(pair: GearPair) -> PartNames:
    """Names of the parts as products: for CAD and PDM no two designs may share one.

    A gear that was given a name of its own keeps it; else it is the pair's name and what the part is.
    """
    ours = PerGear.each(lambda role: f"{pair.name} {role.value}")
    bracket = f"{pair.name} bracket"

    def own_name(role: Role) -> str:
        name = pair.gears.pick(role).name
        return ours.pick(role) if name in UNNAMED else name

    own = PerGear.each(own_name)
    return PartNames(own if len({pair.name, bracket, *own}) == 4 else ours, bracket)


def pair_assembly(pair: GearPair, *, bracket: bool = False) -> cadquery.Assembly:
    """Pinion at the origin and wheel at (centre distance, 0), a tooth in a space, the backlash split evenly.

    The parts are called as `part_names` has it. The centre distance of a ring is negative. `bracket` adds two shafts that fill
    the bores, joined by an arm below the gears. Raises GeometryError for a bracket without bores, for a ring without a rim.
    """
    import cadquery

    if bracket and pair.internal:
        raise GeometryError("bracket", True, "must be left out with a ring: it has no bore for a shaft")

    names, pose, assembly = part_names(pair), pair.wheel_pose(), cadquery.Assembly(name=pair.name)
    wheel_at = cadquery.Location(cadquery.Vector(pose.x, 0, pose.z), cadquery.Vector(0, 0, 1), pose.rotation)
    places = PerGear(None, wheel_at)
    for role, solid in pair.gears.map(gear_solid).items():
        colour = cadquery.Color(*PART_COLOURS[role.value], 1.0)
        assembly.add(solid, name=names.gears.pick(role), loc=places.pick(role), color=colour)
    if bracket:
        assembly.add(_bracket(pair), name=names.bracket, color=cadquery.Color(*PART_COLOURS["bracket"], 1.0))
    return assembly


def _bracket(pair: GearPair) -> cadquery.Solid:
    """Two shafts through the bores, standing on one arm."""
    import cadquery

    gears = pair.gears
    bores, pose = gears.map(_bore), pair.wheel_pose()
    axes, heights = PerGear(0.0, pose.x), PerGear(0.0, pose.z)
    low = min(z - gear.body.hub_ends[0] for z, gear in zip(heights, gears, strict=True))
    high = max(z + gear.face_width + gear.body.hub_ends[1] for z, gear in zip(heights, gears, strict=True))
    thickest = max(bores)
    gap, thickness, half = 0.1 * thickest, 0.5 * thickest, _ARM * thickest
    bottom = low - gap - thickness
    arm = cadquery.Workplane("XY", origin=(0, 0, bottom)).moveTo(pose.x / 2, 0).slot2D(pose.x + 2 * half, 2 * half)
    body = arm.extrude(thickness)
    for x, bore in zip(axes, bores, strict=True):
        body = body.union(cadquery.Workplane("XY", origin=(x, 0, bottom)).circle(bore / 2).extrude(high + gap - bottom))
    solid = body.val()
    assert isinstance(solid, cadquery.Shape)
    return solid.Solids()[0]


def _bore(gear: Gear) -> float:
    if not gear.body.bore:
        raise GeometryError("body.bore", gear.body.bore, "must be above 0 mm for a shaft with a bracket", "mm")
    return gear.body.bore

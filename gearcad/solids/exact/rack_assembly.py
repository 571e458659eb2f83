"""A pinion and a rack posed in mesh: two named, coloured parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.geometry.rack_pair import RackPair
from gearcad.solids.colours import PART_COLOURS
from gearcad.solids.exact.assembly import UNNAMED
from gearcad.solids.exact.rack_solid import rack_solid
from gearcad.solids.exact.solid import gear_solid

if TYPE_CHECKING:
    import cadquery

__all__ = ["rack_assembly", "rack_part_names"]


def rack_part_names(pair: RackPair) -> tuple[str, str]:
    """Names of pinion and rack as products, as `part_names` gives them to gears."""
    ours = f"{pair.name} pinion", f"{pair.name} rack"
    given, unnamed = (pair.pinion.name, pair.rack.name), (*UNNAMED, "rack")
    pinion, rack = (our if own in unnamed else own for own, our in zip(given, ours, strict=True))
    return (pinion, rack) if len({pair.name, pinion, rack}) == 3 else ours


def rack_assembly(pair: RackPair) -> cadquery.Assembly:
    """Pinion at the origin, and the rack beyond x = 0, along y, its tips towards the axis, the backlash split evenly."""
    import cadquery

    (pinion, rack), pose, assembly = rack_part_names(pair), pair.rack_pose(), cadquery.Assembly(name=pair.name)
    place = cadquery.Location(cadquery.Vector(pose.x, pose.y, pose.z), cadquery.Vector(0, 0, 1), pose.rotation)
    assembly.add(gear_solid(pair.pinion), name=pinion, color=cadquery.Color(*PART_COLOURS["pinion"], 1.0))
    assembly.add(rack_solid(pair.rack), name=rack, loc=place, color=cadquery.Color(*PART_COLOURS["rack"], 1.0))
    return assembly

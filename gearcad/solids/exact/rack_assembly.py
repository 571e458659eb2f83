"""A pinion and a rack posed in mesh: two named, coloured parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.geometry.rack_pair import RackPair
from gearcad.solids.colours import PART_COLOURS
from gearcad.solids.exact.assembly import UNNAMED
from gearcad.solids.exact.cad import cad_assembly
from gearcad.solids.exact.products import AssembledProduct, Occurrence, SolidProduct, placed
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import gear_boundary

if TYPE_CHECKING:
    import cadquery

__all__ = ["rack_assembly", "rack_part_names", "rack_product"]


def rack_part_names(pair: RackPair) -> tuple[str, str]:
    """Names of pinion and rack as products, as `part_names` gives them to gears."""
    ours = f"{pair.name} pinion", f"{pair.name} rack"
    given, unnamed = (pair.pinion.name, pair.rack.name), (*UNNAMED, "rack")
    pinion, rack = (our if own in unnamed else own for own, our in zip(given, ours, strict=True))
    return (pinion, rack) if len({pair.name, pinion, rack}) == 3 else ours


def rack_product(pair: RackPair) -> AssembledProduct:
    """Pinion at the origin, and the rack beyond x = 0, along y, its tips towards the axis, the backlash split evenly."""
    (pinion, rack), pose = rack_part_names(pair), pair.rack_pose()
    parts = (
        SolidProduct(pinion, gear_boundary(pair.pinion), PART_COLOURS["pinion"]),
        SolidProduct(rack, rack_boundary(pair.rack), PART_COLOURS["rack"]),
    )
    frames = placed(), placed((pose.x, pose.y, pose.z), pose.rotation)
    occurrences = (Occurrence(part.name, part, frame) for part, frame in zip(parts, frames, strict=True))
    return AssembledProduct(pair.name, tuple(occurrences))


def rack_assembly(pair: RackPair) -> cadquery.Assembly:
    """The same as an assembly to go on with in CadQuery: see `rack_product`."""
    return cad_assembly(rack_product(pair))

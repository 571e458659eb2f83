"""A pair posed in mesh: two named, coloured parts, optionally on two shafts with a bracket."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from gearcad.errors import GeometryError
from gearcad.geometry.pair import GearPair
from gearcad.per_gear import PerGear, Role
from gearcad.solids.colours import PART_COLOURS
from gearcad.solids.exact.bracket import bracket_boundary
from gearcad.solids.exact.cad import cad_assembly
from gearcad.solids.exact.products import AssembledProduct, Occurrence, SolidProduct, placed
from gearcad.solids.exact.solid import gear_boundary

if TYPE_CHECKING:
    import cadquery

__all__ = ["UNNAMED", "PartNames", "pair_assembly", "pair_product", "part_names"]

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


def pair_product(pair: GearPair, *, bracket: bool = False) -> AssembledProduct:
    """Pinion at the origin and wheel at (centre distance, 0), a tooth in a space, the backlash split evenly.

    The parts are called as `part_names` has it. The centre distance of a ring is negative. `bracket` adds two shafts that fill
    the bores, joined by an arm below the gears. Raises GeometryError for a bracket without bores, for a ring without a rim.
    """
    if bracket and pair.internal:
        raise GeometryError("bracket", True, "must be left out with a ring: it has no bore for a shaft")

    names, pose = part_names(pair), pair.wheel_pose()
    frames = PerGear(placed(), placed((pose.x, 0.0, pose.z), pose.rotation))
    boundaries = pair.gears.map(gear_boundary)

    def part(role: Role) -> Occurrence:
        name = names.gears.pick(role)
        return Occurrence(name, SolidProduct(name, boundaries.pick(role), PART_COLOURS[role.value]), frames.pick(role))

    parts = [*PerGear.each(part)]
    if bracket:
        product = SolidProduct(names.bracket, bracket_boundary(pair), PART_COLOURS["bracket"])
        parts.append(Occurrence(names.bracket, product, placed()))
    return AssembledProduct(pair.name, tuple(parts))


def pair_assembly(pair: GearPair, *, bracket: bool = False) -> cadquery.Assembly:
    """The same as an assembly to go on with in CadQuery: see `pair_product`."""
    return cad_assembly(pair_product(pair, bracket=bracket))

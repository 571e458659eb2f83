"""A pair posed in mesh: two named, coloured parts, optionally on two shafts with a bracket."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.errors import GeometryError
from gearcad.geometry.pair import GearPair
from gearcad.geometry.pose import mesh_pose
from gearcad.solids.exact.solid import gear_solid

if TYPE_CHECKING:
    import cadquery

__all__ = ["PART_COLOURS", "pair_assembly", "part_names"]

PART_COLOURS = {"pinion": (0.80, 0.55, 0.20), "wheel": (0.45, 0.58, 0.72), "bracket": (0.55, 0.55, 0.55)}
"""Red, green and blue of the parts, 0 ... 1."""

_ARM = 0.6
"""Width of the bracket's arm as a share of the thicker shaft's diameter."""


_UNNAMED = ("gear", "pinion", "wheel")
"""Names that a gear has where nobody named it."""


def part_names(pair: GearPair) -> dict[str, str]:
    """Names of the parts as products, by "pinion", "wheel" and "bracket": for CAD and PDM no two designs may share one.

    A gear that was given a name of its own keeps it; else it is the pair's name and what the part is.
    """
    names = {role: f"{pair.name} {role}" for role in PART_COLOURS}
    own = {role: gear.name for role, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)) if gear.name not in _UNNAMED}
    named = names | own
    return named if len({pair.name, *named.values()}) == 1 + len(named) else names


def pair_assembly(pair: GearPair, *, bracket: bool = False) -> cadquery.Assembly:
    """Pinion at the origin and wheel at (centre distance, 0), a tooth in a space, the backlash split evenly.

    The parts are called as `part_names` has it. `bracket` adds two shafts that fill the bores, joined by an arm below the
    gears. Raises GeometryError for a bracket without bores.
    """
    import cadquery

    pose = mesh_pose(pair)
    axis = cadquery.Vector(0, 0, 1)
    wheel_at = cadquery.Location(cadquery.Vector(pose.x, 0, pose.z), axis, pose.rotation)
    parts = {"pinion": (gear_solid(pair.pinion), None), "wheel": (gear_solid(pair.wheel), wheel_at)}
    if bracket:
        parts["bracket"] = (_bracket(pair), None)
    names = part_names(pair)
    assembly = cadquery.Assembly(name=pair.name)
    for role, (solid, place) in parts.items():
        assembly.add(solid, name=names[role], loc=place, color=cadquery.Color(*PART_COLOURS[role], 1.0))
    return assembly


def _bracket(pair: GearPair) -> cadquery.Solid:
    """Two shafts through the bores, standing on one arm."""
    import cadquery

    gears = {"pinion": pair.pinion, "wheel": pair.wheel}
    for owner, gear in gears.items():
        if not gear.body.bore:
            raise GeometryError(f"{owner}.body.bore", gear.body.bore, "must be above 0 mm for a shaft with a bracket", "mm")
    pose = mesh_pose(pair)
    offsets = {"pinion": (0.0, 0.0), "wheel": (pose.x, pose.z)}
    low = min(offsets[owner][1] - gear.body.hub_ends[0] for owner, gear in gears.items())
    high = max(offsets[owner][1] + gear.face_width + gear.body.hub_ends[1] for owner, gear in gears.items())
    thickest = max(gear.body.bore for gear in gears.values())
    gap, thickness, half = 0.1 * thickest, 0.5 * thickest, _ARM * thickest
    bottom = low - gap - thickness
    arm = cadquery.Workplane("XY", origin=(0, 0, bottom)).moveTo(pose.x / 2, 0).slot2D(pose.x + 2 * half, 2 * half)
    body = arm.extrude(thickness)
    for owner, gear in gears.items():
        shaft = cadquery.Workplane("XY", origin=(offsets[owner][0], 0, bottom)).circle(gear.body.bore / 2)
        body = body.union(shaft.extrude(high + gap - bottom))
    solid = body.val()
    assert isinstance(solid, cadquery.Shape)
    return solid.Solids()[0]

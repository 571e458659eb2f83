"""Assemblies posed in mesh: a pair, a pinion and a rack, a splined shaft and hub; the bracket of a pair."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from gearcad.core.errors import GeometryError
from gearcad.core.records import PerGear, Role
from gearcad.geometry.bore_teeth import free_bore
from gearcad.geometry.gear import Gear
from gearcad.geometry.pair import GearPair
from gearcad.geometry.rack_pair import RackPair
from gearcad.geometry.spline import SplineJoint
from gearcad.solids.body_plan import PART_COLOURS
from gearcad.solids.exact.boundary import (
    Boundary,
    Chain,
    CircleCurve,
    CylinderSurface,
    Frame,
    LineOnSurface,
    Recorder,
    level_plane,
    straight_line,
    upright_plane,
)
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import AssembledProduct, Occurrence, SolidProduct, cad_assembly, gear_boundary, placed
from gearcad.solids.exact.teeth import tube
from gearcad.solids.shaft_plan import SeatedShaft

if TYPE_CHECKING:
    import cadquery


_ARM = 0.6
"""Half the width of the arm as a share of the thicker shaft's diameter."""

_TOLERANCE = 1e-7
"""Tolerance (mm) of edges and vertices: planes, cylinders and circles are exact."""


def bracket_boundary(pair: GearPair) -> Boundary:
    """Return the bracket where the pair stands, its arm below the gears. Raises GeometryError for gears without bores."""
    gears, pose = pair.gears, pair.wheel_pose()
    bores, heights = gears.map(_bore), PerGear(0.0, pose.z)
    low = min(z - gear.body.hub_ends[0] for z, gear in zip(heights, gears, strict=True))
    high = max(z + gear.face_width + gear.body.hub_ends[1] for z, gear in zip(heights, gears, strict=True))
    thickest = max(bores)
    gap, thickness = 0.1 * thickest, 0.5 * thickest
    bottom = low - gap - thickness
    recorder = Recorder(_TOLERANCE / 2)
    under, over = _arm(recorder, pose.x, _ARM * thickest, (bottom, bottom + thickness))
    recorder.face(level_plane(bottom), [under], outward=False)
    feet: list[Chain] = []
    for x, bore in zip((0.0, pose.x), bores, strict=True):
        foot, head = tube(recorder, bore / 2, (bottom + thickness, high + gap), (x, 0.0), outward=True)
        feet.append(foot.loop(along=False))
        recorder.face(level_plane(high + gap), [head.loop(along=True)])
    recorder.face(level_plane(bottom + thickness), [over, *feet])
    return recorder.boundary()


def _bore(gear: Gear) -> float:
    if not gear.body.bore:
        raise GeometryError("body.bore", gear.body.bore, "must be above 0 mm for a shaft with a bracket", "mm")
    return free_bore(gear)


def _arm(recorder: Recorder, length: float, radius: float, heights: tuple[float, float]) -> tuple[Chain, Chain]:
    """Return the sides of an arm from x = 0 to `length`, rounded about both; its contours, counter-clockwise seen from +z."""
    corners = [(0.0, -radius), (length, -radius), (length, radius), (0.0, radius)]
    rings = [[recorder.vertex((x, y, z)) for x, y in corners] for z in heights]
    rise = heights[1] - heights[0]
    uprights = [
        recorder.edge(straight_line((x, y, heights[0]), (x, y, heights[1]))[0], low, high, 0.0, rise)
        for (x, y), low, high in zip(corners, *rings, strict=True)
    ]
    contours: tuple[Chain, Chain] = ([], [])
    for k, (x, y) in enumerate(corners):
        after = (k + 1) % 4
        to_x, to_y = corners[after]
        ends = []
        surface = upright_plane((x, y, heights[0]), (to_x - x, 0.0)) if k % 2 == 0 else _round_end(x, y, radius)
        for contour, ring, z in zip(contours, rings, heights, strict=True):
            if isinstance(surface, CylinderSurface):
                circle = CircleCurve(surface.frame._replace(origin=(x, 0.0, z)), radius)
                edge = recorder.edge(circle, ring[k], ring[after], 0.0, math.pi)
                recorder.lay(edge, surface, LineOnSurface(0, z, 1, 0))
            else:
                line, reach = straight_line((x, y, z), (to_x, to_y, z))
                edge = recorder.edge(line, ring[k], ring[after], 0.0, reach)
            contour.append((edge, True))
            ends.append(edge)
        if isinstance(surface, CylinderSurface):
            recorder.lay(uprights[k], surface, LineOnSurface(0, heights[0], 0, 1))
            recorder.lay(uprights[after], surface, LineOnSurface(math.pi, heights[0], 0, 1))
        low, high = ends
        recorder.face(surface, [[(low, True), (uprights[after], True), (high, False), (uprights[k], False)]])
    return contours


def _round_end(x: float, y: float, radius: float) -> CylinderSurface:
    """Return the half cylinder that begins at a corner: u = 0 there."""
    return CylinderSurface(Frame((x, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, math.copysign(1.0, y), 0.0)), radius)


UNNAMED = ("gear", "pinion", "wheel")
"""Default names of gears without a name."""


class PartNames(NamedTuple):
    """Names of the parts of an assembly as products."""

    gears: PerGear[str]
    bracket: str


def part_names(pair: GearPair) -> PartNames:
    """Return the names of the parts as products: for CAD and PDM no two designs may share one.

    A gear that was given a name of its own keeps it; else it is the pair's name and what the part is.
    """
    ours = PerGear.each(lambda role: f"{pair.name} {role.value}")
    bracket = f"{pair.name} bracket"

    def own_name(role: Role) -> str:
        name = pair.gears.pick(role).name
        return ours.pick(role) if name in UNNAMED else name

    own = PerGear.each(own_name)
    return PartNames(own if len({pair.name, bracket, *own}) == 4 else ours, bracket)


def shaft_part_name(pair: GearPair, shaft: SeatedShaft) -> str:
    """Return the name of a shaft of a pair as a product: that of the pair and what it is, which no gear of the pair has."""
    name, taken = f"{pair.name} {shaft.name}", {pair.name, *part_names(pair).gears}
    return name if name not in taken else f"{name} (2)"


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
    """Return the pair as a CadQuery assembly: see `pair_product`."""
    return cad_assembly(pair_product(pair, bracket=bracket))


def rack_part_names(pair: RackPair) -> tuple[str, str]:
    """Return the names of pinion and rack as products, as `part_names` gives them to gears."""
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
    """Return pinion and rack as a CadQuery assembly: see `rack_product`."""
    return cad_assembly(rack_product(pair))


def spline_part_name(joint: SplineJoint, part: str) -> str:
    """Return the name of the shaft or hub of a joint as a product: the joint's own where it is the only part."""
    return joint.name if len(joint.parts) == 1 else f"{joint.name} {part}"


def spline_product(joint: SplineJoint) -> AssembledProduct:
    """Shaft and hub on one axis, a tooth of the shaft in the middle of a space of the hub."""
    turns = {"shaft": 0.0, "hub": joint.hub_rotation}
    parts = {
        name: SolidProduct(spline_part_name(joint, name), gear_boundary(part.gear), PART_COLOURS[name])
        for name, part in joint.parts.items()
    }
    occurrences = (Occurrence(part.name, part, placed((0.0, 0.0, 0.0), turns[name])) for name, part in parts.items())
    return AssembledProduct(joint.name, tuple(occurrences))


def spline_assembly(joint: SplineJoint) -> cadquery.Assembly:
    """Return shaft and hub as a CadQuery assembly: see `spline_product`."""
    return cad_assembly(spline_product(joint))

"""Exact solid of a gear: teeth and blank on shared edges, as plain data or as an object of CadQuery."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from gearcad.geometry.bore_teeth import bore_teeth
from gearcad.geometry.gear import AsMadeGear, Gear
from gearcad.geometry.gear_data import twist
from gearcad.solids.body_plan import Colour, keyway_half_angle, require_rim
from gearcad.solids.exact.boundary import (
    Boundary,
    Chain,
    Frame,
    LineOnSurface,
    Point,
    Recorder,
    Vector,
    backward,
    cylinder_along_z,
    level_circle,
    level_plane,
    straight_line,
    upright_plane,
    vector,
)
from gearcad.solids.exact.kernel import kernel_solid, local_axes
from gearcad.solids.exact.teeth import Contour, add_halves, add_teeth, add_tube, circle, tube
from gearcad.solids.exact.tooth_layout import accuracy_for

if TYPE_CHECKING:
    import cadquery


@dataclass(frozen=True, eq=False)
class SolidProduct:
    """A part called `name`: its boundary, and its colour as seen on a screen (sRGB), 0 ... 1."""

    name: str
    boundary: Boundary
    colour: Colour | None


@dataclass(frozen=True, eq=False)
class AssembledProduct:
    """An assembly called `name`. A product that occurs more than once is the very same object each time."""

    name: str
    occurrences: tuple[Occurrence, ...]


Product = SolidProduct | AssembledProduct


@dataclass(frozen=True, eq=False)
class Occurrence:
    """A product in an assembly: called `name` there, its origin and axes where the frame is."""

    name: str
    product: Product
    frame: Frame


def placed(offset: Vector = (0.0, 0.0, 0.0), rotation: float = 0.0) -> Frame:
    """Return the frame of what is turned by `rotation` (degrees) about its z axis, then moved by `offset` (mm)."""
    angle = math.radians(rotation)
    return Frame(offset, (0.0, 0.0, 1.0), (math.cos(angle), math.sin(angle), 0.0))


_BOUNDARY_ATTRIBUTE = "_gearcad_made"
"""Name of the attribute of a solid that holds the boundary from which it was made."""

_PRODUCT = "product"
"""Key in the metadata of a part of an assembly: its name as a product, where its own name is that of one of many."""


def cad_solid(boundary: Boundary) -> cadquery.Solid:
    """Return the solid of a boundary."""
    import cadquery

    made = kernel_solid(boundary)
    solid = cadquery.Solid(made)
    setattr(solid, _BOUNDARY_ATTRIBUTE, (made.Located(made.Location()), boundary))
    return solid


def cad_assembly(product: AssembledProduct) -> cadquery.Assembly:
    """Return an assembly, what is alike in it one solid."""
    return _assembly(product, {})


def _assembly(product: AssembledProduct, solids: dict[SolidProduct, cadquery.Solid]) -> cadquery.Assembly:
    import cadquery

    assembly = cadquery.Assembly(name=product.name)
    for occurrence in product.occurrences:
        name, made, place = occurrence.name, occurrence.product, _location(occurrence.frame)
        metadata = {_PRODUCT: made.name}
        if isinstance(made, AssembledProduct):
            inner = _assembly(made, solids)
            inner.name = name
            inner.metadata = metadata
            assembly.add(inner, loc=place)
            continue
        if made not in solids:
            solids[made] = cad_solid(made.boundary)
        colour = None if made.colour is None else cadquery.Color(*made.colour, 1.0)
        assembly.add(solids[made], name=name, loc=place, color=colour, metadata=metadata)
    return assembly


def _location(frame: Frame) -> cadquery.Location:
    import cadquery
    from OCP.gp import gp_Ax3, gp_Trsf

    place = gp_Trsf()
    place.SetDisplacement(gp_Ax3(), local_axes(frame))
    return cadquery.Location(place)


# ---------------------------------------------------------------------- and back


def cad_product(model: cadquery.Assembly | cadquery.Solid, name: str, colour: Colour) -> Product | None:
    """Return the product of a solid, as a part of a name and colour, or of an assembly; None unless gearcad made all its
    solids.
    """
    import cadquery

    if isinstance(model, cadquery.Assembly):
        return _product_of(model, {})
    boundary = _boundary_of(model)
    return None if boundary is None else SolidProduct(name, boundary, colour)


def _product_of(node: cadquery.Assembly, parts: dict[Any, SolidProduct]) -> AssembledProduct | None:
    found = []
    for child in node.children:
        product = _product_of(child, parts) if child.children else _part_of(child, parts)
        if product is None:
            return None
        found.append(Occurrence(child.name, product, _frame(child.loc)))
    return AssembledProduct(product_name(node), tuple(found)) if node.obj is None else None


def _part_of(node: cadquery.Assembly, parts: dict[Any, SolidProduct]) -> SolidProduct | None:
    """Parts of one solid, colour and product name are one product."""
    boundary = _boundary_of(node.obj)
    if boundary is None:
        return None
    red, green, blue = (round(share, 6) for share in node.color.toTuple()[:3]) if node.color else (None, None, None)
    colour = None if red is None or green is None or blue is None else (red, green, blue)
    name = product_name(node)
    return parts.setdefault((name, boundary, colour), SolidProduct(name, boundary, colour))


def _boundary_of(solid: Any) -> Boundary | None:
    """Return the boundary of a solid that gearcad made, if it has not been moved since; else None."""
    made, boundary = getattr(solid, _BOUNDARY_ATTRIBUTE, (None, None))
    return boundary if made is not None and solid.wrapped.IsEqual(made) else None


def product_name(node: cadquery.Assembly) -> str:
    """Return the product name of a part of an assembly, or of a sub-assembly."""
    return str(node.metadata.get(_PRODUCT, node.name))


def _frame(place: cadquery.Location) -> Frame:
    from OCP.gp import gp_Ax3

    axes = gp_Ax3().Transformed(place.wrapped.Transformation())
    origin, axis, along = (
        vector((each.X(), each.Y(), each.Z())) for each in (axes.Location(), axes.Direction(), axes.XDirection())
    )
    return Frame(origin, axis, along)


def add_blank(gear: Gear, recorder: Recorder, lower: Chain, upper: Chain) -> None:
    """Add end faces, hubs and bore; `lower` and `upper` are the outer loops of the toothed part.

    Loops run counter-clockwise seen from +z.
    """
    body = gear.body
    back, front = body.hub_ends
    heights = (-back, gear.face_width + front)
    opening = _holes(gear, recorder, heights)
    for which, (loop, hub) in enumerate(((lower, back), (upper, front))):
        face_z = gear.face_width * which
        hole = opening[which] if opening else None
        if hub:
            low, high = sorted((face_z, heights[which]))
            rings = tube(recorder, body.hub_diameter / 2, (low, high), outward=True)
            inner, outer = (rings[1], rings[0]) if which == 0 else (rings[0], rings[1])
            recorder.face(level_plane(face_z), [loop, inner.loop(along=False)], outward=which == 1)
            loop = outer.loop(along=True)
        loops = [loop, hole] if hole else [loop]
        recorder.face(level_plane(heights[which]), loops, outward=which == 1)


def _holes(gear: Gear, recorder: Recorder, heights: tuple[float, float]) -> tuple[Chain, Chain] | None:
    """Add the wall of the bore. Return its loops in both end faces, clockwise seen from +z; None without a bore."""
    if (teeth := bore_teeth(gear)) is not None:
        below, above = add_teeth(teeth, recorder.moved(heights[0], 0.0))
        return backward(below), backward(above)
    if not gear.body.bore:
        return None
    low, high = (_opening(gear, recorder, z) for z in heights)
    _add_opening(gear, recorder, low, high, heights)
    return low.loop(along=False), high.loop(along=False)


def _keyway_corners(gear: Gear) -> list[tuple[float, float]]:
    """Bore meets upper wall, bore meets lower wall, lower and upper corner of the floor (mm)."""
    radius, half = gear.body.bore / 2, gear.body.keyway_width / 2
    wall = math.sqrt(radius**2 - half**2)
    floor = radius + gear.body.keyway_depth
    return [(wall, half), (wall, -half), (floor, -half), (floor, half)]


def _opening(gear: Gear, recorder: Recorder, z: float) -> Contour:
    """Return the contour of bore and keyway at height z: the arc of the bore, lower wall, floor, upper wall."""
    radius = gear.body.bore / 2
    if not gear.body.keyway_width:
        return circle(recorder, radius, z)
    corners = _keyway_corners(gear)
    starts = [recorder.vertex((x, y, z)) for x, y in corners]
    angle = keyway_half_angle(gear.body)
    edges = [recorder.edge(level_circle(radius, z), starts[0], starts[1], angle, 2 * math.pi - angle)]
    for k in (1, 2, 3):
        after = (k + 1) % 4
        line, length = straight_line((*corners[k], z), (*corners[after], z))
        edges.append(recorder.edge(line, starts[k], starts[after], 0.0, length))
    return Contour(edges, starts)


def _add_opening(gear: Gear, recorder: Recorder, low: Contour, high: Contour, heights: tuple[float, float]) -> None:
    """The wall of bore and keyway."""
    radius = gear.body.bore / 2
    if not gear.body.keyway_width:
        add_tube(recorder, radius, low, high, heights, outward=False)
        return
    corners = _keyway_corners(gear)
    angle = keyway_half_angle(gear.body)
    lines = [straight_line((*corner, heights[0]), (*corner, heights[1])) for corner in corners]
    uprights = [recorder.edge(line, low.starts[k], high.starts[k], 0.0, length) for k, (line, length) in enumerate(lines)]
    cylinder = cylinder_along_z(radius)
    recorder.lay(uprights[0], cylinder, LineOnSurface(angle, heights[0], 0, 1))
    recorder.lay(uprights[1], cylinder, LineOnSurface(2 * math.pi - angle, heights[0], 0, 1))
    for ring, z in zip((low, high), heights, strict=True):
        recorder.lay(ring.edges[0], cylinder, LineOnSurface(0, z, 1, 0))
    for k in range(4):
        after = (k + 1) % 4
        loop = [(low.edges[k], True), (uprights[after], True), (high.edges[k], False), (uprights[k], False)]
        (x0, y0), (x1, y1) = corners[k], corners[after]
        surface = upright_plane((x0, y0, heights[0]), (x1 - x0, y1 - y0)) if k else cylinder
        recorder.face(surface, [loop], outward=False)


def add_ring_blank(gear: Gear, recorder: Recorder, lower: Chain, upper: Chain) -> None:
    """Add end faces, rim and bolt holes; `lower` and `upper` are the loops of the toothed opening.

    Loops run counter-clockwise seen from +z. Raises GeometryError for a ring without a rim diameter.
    """
    heights = (0.0, gear.face_width)
    rim = tube(recorder, require_rim(gear) / 2, heights, outward=True)
    holes = [tube(recorder, gear.body.bolt_diameter / 2, heights, axis, outward=False) for axis in _bolts(gear)]
    for which, opening in enumerate((lower, upper)):
        loops = [rim[which].loop(along=True), backward(opening), *(hole[which].loop(along=False) for hole in holes)]
        recorder.face(level_plane(heights[which]), loops, outward=which == 1)


def _bolts(gear: Gear) -> list[Point]:
    """Return the axes of the bolt holes (mm), the first on +x."""
    radius, count = gear.body.bolt_circle / 2, gear.body.bolt_holes
    angles = [2 * math.pi * i / count for i in range(count)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


def stepped_boundary(gear: AsMadeGear) -> Boundary:
    """Return a print as a closed boundary: over the first layer all its walls are set back by as much as that is high."""
    height, width = gear.first_layer, gear.face_width
    recorder = Recorder(accuracy_for(gear))
    foot, rest = replace(gear.foot, face_width=height), replace(gear, face_width=width - height)
    bottom, below = add_teeth(foot, recorder)
    above, top = add_teeth(rest, recorder.moved(height, twist(gear, height)))
    lower = _walls(foot, recorder, (0.0, height))
    upper = _walls(gear, recorder, (height, width + gear.body.hub_ends[1]))
    if gear.internal:
        (rim, *holes), (outer, *others) = lower, upper
        recorder.face(level_plane(height), [below, backward(above)], outward=False)
        recorder.face(level_plane(height), [outer[0].loop(along=True), rim[1].loop(along=False)], outward=False)
        ends = ([rim[0].loop(along=True), backward(bottom)], [outer[1].loop(along=True), backward(top)])
    else:
        holes, others = lower, upper
        recorder.face(level_plane(height), [above, backward(below)], outward=False)
        ends = ([bottom], [_with_hub(gear, recorder, top)])
    for hole, other in zip(holes, others, strict=True):
        recorder.face(level_plane(height), [hole[1].loop(along=True), other[0].loop(along=False)], outward=False)
    heights = (0.0, width + gear.body.hub_ends[1])
    for which, walls in enumerate((holes, others)):
        loops = [*ends[which], *(wall[which].loop(along=False) for wall in walls)]
        recorder.face(level_plane(heights[which]), loops, outward=which == 1)
    return recorder.boundary()


def _walls(gear: Gear, recorder: Recorder, heights: tuple[float, float]) -> list[tuple[Contour, Contour]]:
    """Add the wall of the bore, or of the rim and the bolt holes; their contours at two heights."""
    if gear.internal:
        holes = [tube(recorder, gear.body.bolt_diameter / 2, heights, axis, outward=False) for axis in _bolts(gear)]
        walls = [tube(recorder, require_rim(gear) / 2, heights, outward=True), *holes]
        return [(low, high) for low, high in walls]
    if not gear.body.bore:
        return []
    low, high = (_opening(gear, recorder, z) for z in heights)
    _add_opening(gear, recorder, low, high, heights)
    return [(low, high)]


def _with_hub(gear: Gear, recorder: Recorder, loop: Chain) -> Chain:
    """Add the hub on the upper end; the loop of its own end, or that of the teeth without one."""
    front = gear.body.hub_ends[1]
    if not front:
        return loop
    width = gear.face_width
    inner, outer = tube(recorder, gear.body.hub_diameter / 2, (width, width + front), outward=True)
    recorder.face(level_plane(width), [loop, inner.loop(along=False)], outward=True)
    return outer.loop(along=True)


@lru_cache(8)  # a gear's files, its assembly and its mass ask for it
def gear_boundary(gear: Gear) -> Boundary:
    """Return the gear as a closed boundary, within 1 nm of the exact involute and fillet, or of its modified flanks.

    Teeth from z = 0 to the face width, tooth 0 centred on +x at z = 0. Raises GeometryError for a ring
    without a rim diameter.
    """
    if isinstance(gear, AsMadeGear) and gear.first_layer:
        return stepped_boundary(gear)
    recorder = Recorder(accuracy_for(gear))
    lower, upper = (add_halves if gear.double_helix.gap_width else add_teeth)(gear, recorder)
    (add_ring_blank if gear.internal else add_blank)(gear, recorder, lower, upper)
    return recorder.boundary()


def gear_solid(gear: Gear) -> cadquery.Solid:
    """Return the gear as a CadQuery solid, for `cadquery.Workplane(obj=gear_solid(gear))`: see `gear_boundary`."""
    return cad_solid(gear_boundary(gear))

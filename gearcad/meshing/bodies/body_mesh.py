"""Body of one gear in hexahedra swept along the helix, a pair in mesh, and the number of elements beforehand.

Left flanks touch, those that carry under a positive torque, or with `left` False the right ones: all is then seen in a mirror,
the plane x-z, and roll angles count clockwise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import ParameterError, require_number, require_whole
from gearcad.core.records import Floats, Notice, PerGear, Role, Wholes
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_data import height_in_half, section_turn, twist
from gearcad.geometry.gear_pictures import Pose
from gearcad.meshing.bodies.element_mesh import Cells, ElementMesh, Faces, joined
from gearcad.meshing.bodies.section_mesh import NO_CONTACTS, Turns, mesh_section, modification_turns, teeth_of
from gearcad.meshing.bodies.sectors import ContactRefinement, Sectors, disc
from gearcad.meshing.fem import Element
from gearcad.meshing.outline import Grading, MeshSizes, graded
from gearcad.meshing.sector import Stack

_LONGER = 4.0
"""Largest ratio of an edge along the tooth to one across its flank: little changes along the helix."""

_THINNER = 0.4
"""Thickness of a layer at an end of the face, or where an end relief begins, over that in the middle."""

_GROWTH = 0.3
"""Growth of the thickness of layers from there, per distance."""

_OFF_HELIX = 0.25e-3
"""Largest distance (mm) of an edge of second order from its helix between its nodes; as much is left to the section's edges."""

_FEWEST = 2
"""Number of layers of the narrowest gear."""


def body_planes(gear: Gear, sizes: MeshSizes, layers: int | None = None) -> Floats:
    """Return the heights z (n + 1,) in mm of the planes between layers, closer together at the ends of the face and of end
    reliefs.

    As many as the sizes ask for, or so many `layers`; of double helical teeth as many in both halves. Raises ParameterError for
    fewer than the end reliefs ask for.
    """
    if gear.double_helix.present:
        lower = body_planes(halves(gear)[0].gear, sizes, None if layers is None else (layers + 1) // 2)
        return np.concatenate([lower, gear.face_width - lower[-2::-1]])
    gradings = _gradings(gear, _thickness(gear, sizes))
    counts = [max(1, math.ceil(grading.edges - 1e-9)) for grading in gradings]
    if layers is None and sum(counts) < _FEWEST:
        layers = _FEWEST
    if layers is not None:
        counts = _shared([grading.edges for grading in gradings], layers)
    parts = [grading.ends(count) for grading, count in zip(gradings, counts, strict=True)]
    return np.concatenate([*(part[:-1] for part in parts), parts[-1][-1:]])


def check_planes(gear: Gear, planes: Floats) -> None:
    """Raise ParameterError for planes (n,) that do not go up from z = 0 to the face width."""
    if planes.ndim != 1 or len(planes) < 2 or not (np.diff(planes) > 0).all() or planes[0] or planes[-1] != gear.face_width:
        permitted = f"must go up from 0 to the face width, {gear.face_width:.10g} mm"
        raise ParameterError("planes", planes.tolist(), permitted, "mm")


def _thickness(gear: Gear, sizes: MeshSizes) -> float:
    """Return the greatest thickness (mm) of a layer.

    Over a layer that turns by phi a parabola is off a point that turns on the radius R by R phi^3/(72 sqrt 3) at the most.
    """
    wanted = _LONGER * sizes.flank * gear.normal_module
    if not gear.helix_angle:
        return wanted
    turn: float = (72 * math.sqrt(3) * _OFF_HELIX / (gear.profile.tip_diameter / 2)) ** (1 / 3)
    return min(wanted, turn / abs(twist(gear)))


def _gradings(gear: Gear, thickness: float) -> list[Grading]:
    """Return the face width graded in pieces between its ends and those of end reliefs."""
    ends = np.array([0.0, *gear.flank_form.height_breaks, gear.face_width])
    lengths = np.diff(ends)
    thin = np.minimum(_THINNER * thickness, np.minimum(np.r_[lengths, np.inf], np.r_[np.inf, lengths]))

    def piece(low: float, high: float) -> Grading:
        def size(run: Floats, _whole: float) -> Floats:
            near = thin + _GROWTH * np.abs(low + run[:, None] - ends)
            result: Floats = np.minimum(thickness, near.min(axis=1))
            return result

        return graded(lambda z: np.stack([z, np.zeros_like(z)], -1), size, low, high)

    return [piece(low, high) for low, high in pairwise(ends.tolist())]


def _shared(wanted: list[float], layers: int) -> list[int]:
    """Return the layers of each piece, at least one, of so many in all,
    in proportion to what is wanted (Webster's divisors).
    """
    if layers < len(wanted):
        permitted = f"must be at least {len(wanted)}: one on each side of where an end relief begins"
        raise ParameterError("layers", layers, permitted)
    given = [1] * len(wanted)
    for _ in range(layers - len(wanted)):
        given[max(range(len(wanted)), key=lambda k: wanted[k] / (given[k] + 0.5))] += 1
    return given


_AS_FILES = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19]
"""Nodes of a hexahedron in the order of `Element`, of those that a stack has: both planes, then half-way."""

_BELOW, _ABOVE, _FIRST_SIDE = 0, 1, 2
"""Sides of a hexahedron: those on planes, and that over the section's first edge."""


def mesh_body(
    gear: Gear,
    *,
    teeth: int | None,
    held_radius: float,
    sizes: MeshSizes,
    planes: Floats | None,
    element: Element,
    contacts: Mapping[int, ContactRefinement] = NO_CONTACTS,
) -> ElementMesh:
    """Mesh a gear down, or a ring out, to `held_radius` (mm) in hexahedra between `planes` (n,), heights in mm.

    Planes None are those of the sizes.

    `teeth`, `contacts` and the named sides are those of `mesh_section`; here are also "end_back" at z = 0 and "end_front" at
    the face width. Keyway, hub and end chamfers are left out: `swept_notices` says so. Quality is for the caller to measure.
    Raises ParameterError, GeometryError and SolverError.
    """
    if element not in (Element.HEX8, Element.HEX20):
        raise ParameterError("element", element.value, 'must be "hex20" or "hex8" for a swept body')
    planes = body_planes(gear, sizes) if planes is None else np.asarray(planes, float)
    check_planes(gear, planes)
    section = mesh_section(
        gear, teeth=teeth, held_radius=held_radius, sizes=sizes, element=Element.QUAD8, contacts=contacts, modified=False
    )
    return _Swept(gear, section, planes, element).mesh


def swept_notices(gear: Gear) -> list[Notice]:
    """Return a notice of the features of a gear's body that swept hexahedra leave out; an empty list if there are none."""
    body = gear.body
    features = {
        "keyway": body.keyway_width,
        "hub": body.hub_diameter,
        "bolt holes": body.bolt_holes,
        "end chamfers": body.end_chamfer,
    }
    missing = [name for name, size in features.items() if size]
    if not missing:
        return []
    words = " and ".join([*([", ".join(missing[:-1])] if missing[1:] else []), missing[-1]])
    return [Notice("swept-body", f"hexahedra are swept along the helix, without {words}; tet10 has them")]


@dataclass(frozen=True)
class _Swept:
    """A section of quadrangles of the exact gear, its vertices first, and the planes between which it is swept."""

    gear: Gear
    section: ElementMesh
    planes: Floats
    element: Element

    @property
    def mesh(self) -> ElementMesh:
        points, cells = self._points(), self._cells()
        return ElementMesh(self.element, points, cells, {"gear": slice(0, len(cells))}, self._sides(), self._matched())

    @cached_property
    def _layers(self) -> int:
        return len(self.planes) - 1

    @cached_property
    def _vertices(self) -> int:
        return 1 + int(self.section.cells[:, :4].max())

    @cached_property
    def _stack(self) -> Stack:
        if self.element is Element.HEX8:
            return Stack(self._vertices, 0, self._layers)
        return Stack(len(self.section.points), self._vertices, self._layers)

    def _cells(self) -> Cells:
        """Layer by layer, each as the quadrangles of the section."""
        quads = self.section.cells[:, :4] if self.element is Element.HEX8 else self.section.cells
        order = slice(None) if self.element is Element.HEX8 else _AS_FILES
        lowest = self._stack.elements(quads.astype(np.int64), 0)[:, order]
        rise = self._stack.elements(quads[:1].astype(np.int64), 1)[:, order] - lowest[:1]
        cells = np.empty((self._layers, *lowest.shape), np.int32)
        for layer, part in enumerate(cells):
            np.add(lowest, layer * rise, out=part, casting="same_kind")
        return cells.reshape(-1, lowest.shape[1])

    # ------------------------------------------------------------------ places

    def _points(self) -> Floats:
        """Return each plane turned by the helix, and its nodes by what modifies their flanks."""
        stack = self._stack
        middles = (self.planes[1:] + self.planes[:-1]) / 2
        heights = np.r_[self.planes, middles] if stack.half else self.planes
        turns = modification_turns(self.section, self.gear, height_in_half(self.gear, heights))
        points = np.empty((stack.total, 3))
        for number, z in enumerate(heights):
            layer = number - len(self.planes)
            start, count = (stack.plane(number), stack.nodes) if layer < 0 else (stack.middle(layer), stack.half)
            self._place(points[start : start + count], turns, number, float(z))
        return points

    def _place(self, points: Floats, turns: Turns, number: int, z: float) -> None:
        """Set the points (n, 3) of the first nodes of the section at a height."""
        angle = section_turn(self.gear, np.asarray(z)) + (turns.at(number)[: len(points)] if len(turns.fields) else 0.0)
        cosine, sine = np.cos(angle), np.sin(angle)
        x, y = self.section.points[: len(points), :2].T
        points[:, 0] = cosine * x - sine * y
        points[:, 1] = sine * x + cosine * y
        points[:, 2] = z

    # ------------------------------------------------------------------ names

    def _sides(self) -> dict[str, Faces]:
        quads = len(self.section.cells)
        found = {name: self._over(faces) for name, faces in self.section.sides.items()}
        lowest = np.arange(quads, dtype=np.int32)
        found["end_back"] = Faces(lowest, np.full(quads, _BELOW, np.int8))
        found["end_front"] = Faces(lowest + np.int32(quads * (self._layers - 1)), np.full(quads, _ABOVE, np.int8))
        return found

    def _over(self, edges: Faces) -> Faces:
        """Return the sides of hexahedra over edges of the section."""
        starts = np.arange(self._layers, dtype=np.int32)[:, None] * np.int32(len(self.section.cells))
        sides = np.tile(edges.sides + np.int8(_FIRST_SIDE), self._layers)
        return Faces((starts + edges.elements).ravel(), sides)

    def _matched(self) -> dict[str, Wholes]:
        return {name: np.stack([self._above(nodes) for nodes in pairs.T], -1) for name, pairs in self.section.matched.items()}

    def _above(self, nodes: Wholes) -> Wholes:
        """Return all nodes of the mesh above section nodes."""
        return self._stack.over(nodes[nodes < self._stack.nodes])


def posed(
    pair: GearPair, meshes: PerGear[ElementMesh], roll_angle: float, approach: float = 0.0, *, left: bool = True
) -> ElementMesh:
    """Return both gears in one mesh: the pinion about the z axis, the wheel about x = a, unmodified flanks of tooth 0 in
    contact.

    At `roll_angle` (deg, of the pinion, 0 at the pitch point) they touch in the middle of the common face width. Meshes are
    both of sections or both of solids, in coordinates of their gears; the pinion is turned further by what makes flanks
    approach by `approach` (mm along the line of action).
    """
    solid = meshes.pinion.element.shape.dimension == 3
    places = poses(pair, roll_angle, approach, solid=solid, left=left)
    return joined({role.value: _moved(meshes.pick(role), place) for role, place in places.items()})


def poses(pair: GearPair, roll_angle: float, approach: float = 0.0, *, solid: bool, left: bool = True) -> PerGear[Pose]:
    """Return the poses of both gears of `posed`: of solids, or of sections,
    which are not turned by the helix and lie at z = 0.
    """
    angle = math.radians(pair.working_transverse_pressure_angle)
    lengths = _lengths(pair, roll_angle)
    rolled = PerGear(lengths.pinion + approach, lengths.wheel)
    z = PerGear(0.0, (pair.pinion.face_width - pair.wheel.face_width) / 2 + pair.axial_offset)
    middle = _middle(pair, z.wheel)

    def pose(role: Role, facing: float, x: float) -> Pose:
        gear = pair.gears.pick(role)
        # The tangent point of the base circle is behind the line of centres by the pressure angle, the tooth that touches half
        # a tooth behind its flank.
        turn = facing - angle + 2 * rolled.pick(role) / gear.base_diameter - math.radians(gear.base_half_angle)
        helix = twist(gear, middle - z.pick(role)) if solid else 0.0
        return Pose(math.degrees((turn if left else -turn) - helix), x, z.pick(role) if solid else 0.0)

    facing = 0.0 if pair.internal else math.pi
    return PerGear(pose(Role.PINION, 0.0, 0.0), pose(Role.WHEEL, facing, pair.centre_distance))


def contacts(pair: GearPair, roll_angle: float, beyond: float = 0.0, *, left: bool = True) -> PerGear[Mapping[int, float]]:
    """Return the teeth of each gear in contact in the middle of the common face width, and their roll lengths (mm).

    Flanks are taken as unmodified. Tooth j of the pinion meets tooth -j of the wheel, or tooth j of a ring, whose roll lengths
    are negative. Pairs up to `beyond` (mm on the line of action) outside the path of contact count too; their places are the
    ends of the flanks.
    """
    middle, pitch = _lengths(pair, roll_angle).pinion, pair.pinion.transverse_base_pitch
    first, last = pair.usable_path
    teeth = range(math.ceil((first - beyond - middle) / pitch), math.floor((last + beyond - middle) / pitch) + 1)
    places = {tooth: min(max(middle + tooth * pitch, first), last) for tooth in teeth}
    sense, follows = 1 if left else -1, 1 if pair.internal else -1
    whole = pair.base_tangent.length
    return PerGear(
        {sense * tooth: place for tooth, place in places.items()},
        {follows * sense * tooth: whole - place for tooth, place in places.items()},
    )


def _middle(pair: GearPair, wheel_z: float) -> float:
    """Return the height (mm) on the pinion of the middle of the common face width,
    or of the common width of the lower halves.
    """
    if not pair.double_helical:
        return pair.pinion.face_width / 2 + pair.common_width.offset
    return (max(0.0, wheel_z) + min(pair.pinion.half_width, wheel_z + pair.wheel.half_width)) / 2


def _lengths(pair: GearPair, roll_angle: float) -> PerGear[float]:
    """Return the roll lengths (mm) at which the flanks of tooth 0 touch."""
    length = pair.path_of_contact.C + math.radians(roll_angle) * pair.pinion.base_diameter / 2
    return PerGear(length, pair.base_tangent.length - length)


def _moved(mesh: ElementMesh, pose: Pose) -> ElementMesh:
    """Return the mesh turned about the z axis and shifted."""
    turn = math.radians(pose.rotation)
    cosine, sine = math.cos(turn), math.sin(turn)
    points: Floats = mesh.points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return replace(mesh, points=points + np.array([pose.x, 0.0, pose.z]))


_FLANK = 0.25
"""Usual edge on the flanks, in normal modules."""

_FILLET_TURN = 7.5
"""Degrees that an edge of a fillet turns at most: four of them over 30 degrees."""

_DEVIATION = 0.3e-3
"""Largest distance (mm) of an edge's parabola from the curve; what modifications add is less than another 0.2 µm."""

_NEAR = 0.1
"""Largest relative difference from the number of elements that is asked for."""

_TRIES = 16

_CLOSEST = 1e-3
"""Difference below which two factors count as one."""


class Amount(NamedTuple):
    """Counts of elements and nodes of a mesh; `bytes` is the memory that they take."""

    elements: int
    nodes: int
    bytes: int


def body_sizes(gear: Gear, size: float | None = None) -> MeshSizes:
    """Sizes with edges of `size` (mm) on the flanks, None for what root stress asks for, and all others after them.

    Raises ParameterError.
    """
    if size is not None:
        require_number("size", size, "mm", above=0)
    module = gear.normal_module
    flank = _FLANK if size is None else size / module
    return MeshSizes(
        flank=flank,
        corner=0.4 * flank,
        fillet=0.5 * flank,
        outline=1.6 * flank,
        cut=1.2 * flank,
        rim=8 * flank,
        growth=0.4,
        fillet_turn=_FILLET_TURN,
        deviation=_DEVIATION / module,
    )


def expected_amount(
    gear: Gear,
    *,
    teeth: int | None,
    held_radius: float,
    sizes: MeshSizes,
    element: Element,
    contacts: Mapping[int, ContactRefinement] = NO_CONTACTS,
) -> Amount:
    """Return the amount of elements and nodes that `mesh_section` or `mesh_body` will make from the same arguments.

    For triangles, one sector of each kind is meshed to count them. Raises ParameterError, also for tetrahedra, whose number is
    not known before, GeometryError and SolverError.
    """
    if element is Element.TET10:
        raise ParameterError("element", element.value, "must not be tet10: how many there will be is not known before")
    solid = element.shape.dimension == 3
    flat = Element.QUAD8 if solid else element
    section = _Section.of(Sectors.of_gear(gear, held_radius, sizes, flat, contacts), teeth)
    nodes = section.vertices + section.edges
    if not solid:
        return _amount(element, section.elements, nodes)
    layers = len(body_planes(gear, sizes)) - 1
    over = section.vertices if element is Element.HEX8 else nodes
    between = 0 if element is Element.HEX8 else section.vertices
    return _amount(element, layers * section.elements, (layers + 1) * over + layers * between)


def _amount(element: Element, elements: int, nodes: int) -> Amount:
    coordinate, number = np.dtype(float).itemsize, np.dtype(np.int32).itemsize
    return Amount(elements, nodes, 3 * coordinate * nodes + number * element.shape.nodes * elements)


class _Section(NamedTuple):
    """Counts of a section: its elements, vertices and edges."""

    elements: int
    vertices: int
    edges: int

    @classmethod
    def of(cls, sectors: Sectors, teeth: int | None) -> _Section:
        """Return the counts of elements, vertices and edges by Euler's formula, from elements and edges of the outline."""
        counts = [sectors.count(tooth) for tooth in teeth_of(sectors.gear, teeth)]
        elements, outline = (sum(getattr(count, name) for count in counts) for name in ("elements", "outline"))
        holes = 1 if teeth is None and not sectors.disc else 0
        if teeth is not None:
            outline += counts[0].cut + counts[-1].cut
        if sectors.disc:
            inner = sum(count.inner for count in counts)
            elements += _in_disc(sectors, inner)
            outline -= inner
        edges = (sectors.element.shape.vertices * elements + outline) // 2
        return cls(elements, 1 - holes + edges - elements, edges)


def _in_disc(sectors: Sectors, edges: int) -> int:
    """Return the elements inside the inner circle."""
    angles = 2 * math.pi * np.arange(edges) / edges
    circle = sectors.inside * np.stack([np.cos(angles), np.sin(angles)], -1)
    return len(disc(circle, sectors.element, sectors.sizes.growth).cells)


def factor_for(elements: int, count: Callable[[float], int], dimension: int) -> float:
    """Return the factor by which all edges must be shorter for the number of elements to come to `elements` within 10 %.

    `count` gives the number of elements for a factor. Raises ParameterError, which names a number nearby, if none is within 10
    %.
    """
    require_whole("elements", elements, at_least=1, at_most=10**9)
    factor, low, high = 1.0, 0.0, math.inf
    tried: dict[float, int] = {}
    for _ in range(_TRIES):
        found = tried.setdefault(factor, count(factor))
        if abs(found - elements) <= _NEAR * elements:
            return factor
        low, high = (factor, high) if found < elements else (low, factor)
        factor *= float(np.clip((elements / found) ** (1 / dimension), 0.05, 20.0))
        if not low < factor < high:
            factor = math.sqrt(low * high)
        if high / max(low, 1e-300) < 1 + _CLOSEST or factor < 1e-4:
            break
    near = min(tried.values(), key=lambda found: abs(found - elements))
    raise ParameterError("elements", elements, f"cannot be met within 10 % by this layout: near is {near}")

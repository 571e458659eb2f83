"""Quadratic tetrahedra of a whole gear, with all nodes of its surface on the exact faces.

With two faces on one smooth surface they are flat where these meet. With two edges that nearly cross they are flat all over,
and vanish when both edges run through one vertex.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.errors import ParameterError, SolverError, require_number, require_whole
from gearcad.core.records import Bools, Floats, Indices, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.gear import FlankCurve, flank_curves, halves
from gearcad.geometry.gear_data import height_in_half, section_turn
from gearcad.meshing.bodies.element_mesh import Cells, ElementMesh, Faces
from gearcad.meshing.bodies.gear_faces import (
    ROOT,
    BrepFace,
    EdgeLengths,
    GearFace,
    GearFaces,
    Stage,
    SurfaceKind,
    TetrahedronGrading,
    TetrahedronMesh,
    edge_lengths,
    expected_tetrahedra,
    fill_brep,
)
from gearcad.meshing.fem import Element, scaled_jacobians
from gearcad.solids.body_plan import End, gear_ends
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.solid import gear_boundary
from gearcad.solids.exact.tooth_layout import tooth_outline

_SAMPLES = 513
"""Points of a curve among which the nearest one is where a search begins."""

_STEPS = 12
"""Newton's method takes three or four; a modification, which turns less than a part in a thousand, takes some more."""

_SAME = 1e-6
"""Points this close (mm) to the end of a curve, along it, are its end: so far may a boundary representation be off."""


@dataclass(frozen=True)
class ExactFlank:
    """A piece of the left, or right, flanks of all teeth of a gear, one surface a tooth. Its parameters are s along the curve,
    0 at the root, and z in mm.
    """

    gear: Gear
    curve: FlankCurve
    left: bool

    def points(self, s: Floats, z: Floats, teeth: Wholes) -> Floats:
        """Return the points (n, 3) of the surfaces of these teeth."""
        radius, angle = self.curve.curve.polar(s)
        angle = self._sign * angle + self._turn(s, z, teeth)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)

    def nearest(self, points: Floats, teeth: Wholes) -> Floats:
        """Return the parameters (n,) of the points of the surfaces of these teeth that are nearest at the same height.

        Those of points at an end of the curve are 0 or 1 and nothing near it.
        """
        s = self._nearest_sample(points, teeth)
        for _ in range(_STEPS):
            off = self._unturned(points, s, teeth) - self.curve.curve.points(s)
            heading = self.curve.curve.direction(s)
            along = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
            s = np.clip(s + along / self._speed(s), 0.0, 1.0)
        length = self._speed(s)
        s = np.where(s * length < _SAME, 0.0, s)
        found: Floats = np.where((1 - s) * length < _SAME, 1.0, s)
        return found

    @property
    def _sign(self) -> int:
        return 1 if self.left else -1

    def _turn(self, s: Floats, z: Floats, teeth: Wholes) -> Floats:
        """Return the angles (rad) by which points of tooth 0 at z = 0 are turned into place."""
        own = self.curve.turn(self.gear.flank_form, s, height_in_half(self.gear, z), left=self.left)
        found: Floats = own + section_turn(self.gear, z) + 2 * math.pi / self.gear.tooth_count * teeth
        return found

    def _unturned(self, points: Floats, s: Floats, teeth: Wholes) -> Floats:
        """Return the points (n, 2) as they lie beside the curve, which is that of a left flank."""
        x, y, z = points.T
        turn = -self._turn(s, z, teeth)
        cosine, sine = np.cos(turn), np.sin(turn)
        return np.stack([x * cosine - y * sine, self._sign * (x * sine + y * cosine)], -1)

    @cached_property
    def _samples(self) -> tuple[Floats, Floats, Floats]:
        """Parameters (n,), the curve's points there (n, 2) and the length (mm) that one of its parameter is (n,)."""
        s = np.linspace(0.0, 1.0, _SAMPLES)
        points = self.curve.curve.points(s)
        slopes = np.gradient(points, s, axis=0)
        return s, points, np.hypot(*slopes.T)

    def _speed(self, s: Floats) -> Floats:
        parameters, _, speeds = self._samples
        return np.interp(s, parameters, speeds)

    def _nearest_sample(self, points: Floats, teeth: Wholes) -> Floats:
        from scipy.spatial import cKDTree

        parameters, samples, _ = self._samples
        middle = np.full(len(points), 0.5)
        _, nearest = cKDTree(samples).query(self._unturned(points, middle, teeth))
        found: Floats = parameters[nearest]
        return found


_POOR = 0.06
"""Scaled Jacobian below which the mesh is improved at an element."""

_ROUNDS = 6

_SHARES = (1.0, 0.5, 0.25, 0.1, -0.1, -0.25)
"""Shares of the way along which middles are tried."""

_CHUNK = 100_000


def mended(points: Floats, cells: Cells, free: Bools) -> Floats:
    """Return the points (n, 3) with some of the `free` ones moved, which are middles of inner edges of tetrahedra (m, 10).

    Where a surface curves into flat elements, their other edges have to bend with it. A middle is tried along the mean way that
    the others of its element have gone from half-way, and stays where the worst element that has it is best.
    """
    points = points.copy()
    quality = _least_in_chunks(points, cells)
    for _ in range(_ROUNDS):
        poor = np.flatnonzero(quality < _POOR)
        before = quality[poor].copy()
        for element in poor[np.argsort(before)]:
            for node, way in _ways(points, cells[element], free):
                around = np.flatnonzero((cells[:, 4:] == node).any(-1))
                _try(points, cells[around], node, way)
                quality[around] = _least(points, cells[around])
        if np.allclose(quality[poor], before, atol=1e-4):
            break
    return points


def poor_elements(points: Floats, cells: Cells) -> Indices:
    """Return the numbers of the elements that are poor."""
    return np.flatnonzero(_least_in_chunks(points, cells) < _POOR)


def _least_in_chunks(points: Floats, cells: Cells) -> Floats:
    return np.concatenate([_least(points, cells[start : start + _CHUNK]) for start in range(0, len(cells), _CHUNK)])


def _least(points: Floats, cells: Cells) -> Floats:
    least: Floats = scaled_jacobians(Element.TET10, points[cells]).min(-1)
    return least


def _ways(points: Floats, cell: Cells, free: Bools) -> list[tuple[int, Floats]]:
    """Return the free middles of an element, and the mean way that its others have gone from half-way."""
    ends = points[cell[np.array(Element.TET10.shape.edges)]]
    off = points[cell[4:]] - ends.mean(1)
    fixed = ~free[cell[4:]]
    mean = off[fixed].sum(0) / max(np.count_nonzero(fixed), 1)
    return [(int(node), mean) for node in cell[4:][~fixed]]


def _try(points: Floats, cells: Cells, node: int, way: Floats) -> None:
    """Move a node along a way to where the worst of its elements is best, if that is anywhere else."""
    start = points[node].copy()
    best, place = float(_least(points, cells).min()), start
    for share in _SHARES:
        points[node] = start + share * way
        if (worst := float(_least(points, cells).min())) > best:
            best, place = worst, points[node].copy()
    points[node] = place


_INWARDS = (0.0, 0.1, 0.2, 0.35, 0.5)
"""Shares of the way from the middle of an edge to the other vertices around it, along which the new vertex is tried."""

_EDGES = np.array(Element.TET10.shape.edges)

_OPPOSITE = np.array([(0, 5), (1, 3), (2, 4)])
"""Edges of a tetrahedron that have no vertex in common."""

_CROSSING = 0.25
"""Edges whose middles are so near, in shares of the longer one, nearly cross."""

Edges = tuple[tuple[int, int], ...]
"""Edges, as vertices, that shall run through one new vertex: one, or two that cross."""


def inner_edges(points: Floats, cells: Cells, inner: Bools) -> list[Edges]:
    """Return the edges in which tetrahedra (m, 4) can be parted; `inner` (m, 6) tells which of theirs are inside."""
    found = dict[Edges, None]()
    for cell, free in zip(cells, inner, strict=True):
        if free.sum() == 1:
            found[(_pair(cell, int(free.argmax())),)] = None
        elif crossing := _crossing(points[cell], free):
            found[_pair(cell, crossing[0]), _pair(cell, crossing[1])] = None
    return list(found)


def _pair(cell: Cells, edge: int) -> tuple[int, int]:
    low, high = sorted(cell[_EDGES[edge]].tolist())
    return low, high


def _crossing(places: Floats, free: Bools) -> tuple[int, int] | None:
    """Return two edges inside that nearly cross, of a tetrahedron with vertices at places (4, 3)."""
    ends = places[_EDGES]
    middles, lengths = ends.mean(1), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1)
    for one, other in _OPPOSITE.tolist():
        near = float(np.linalg.norm(middles[one] - middles[other]))
        if free[one] and free[other] and near < _CROSSING * max(lengths[one], lengths[other]):
            return one, other
    return None


def part_edges(points: Floats, cells: Cells, wanted: list[Edges]) -> tuple[Floats, Cells]:
    """Return the points (n, 3) and tetrahedra (m, 4) with a vertex more for each of these; left out are those beside another
    one.
    """
    taken, more = set[int](), list[Floats]()
    kept, added = np.ones(len(cells), bool), list[Cells]()
    for edges in wanted:
        rings = [np.flatnonzero(np.isin(cells, edge).sum(-1) == 2) for edge in edges]
        around = np.unique(np.concatenate(rings))
        if taken.intersection(around.tolist()):
            continue
        taken.update(around.tolist())
        new = len(points) + len(more)
        parts = _parts(cells, rings, edges, new)
        more.append(_best(points, edges, cells[around], np.concatenate(parts)))
        kept[around] = False
        added += parts
    return np.concatenate([points, np.reshape(more, (-1, 3))]), np.concatenate([cells[kept], *added]).astype(np.int32)


def _parts(cells: Cells, rings: list[Indices], edges: Edges, new: int) -> list[Cells]:
    """Return the tetrahedra that replace those around each edge: those around both edges vanish, each other one becomes two."""
    both = np.intersect1d(rings[0], rings[-1]) if len(rings) == 2 else rings[0][:0]
    found = []
    for ring, edge in zip(rings, edges, strict=True):
        whole = cells[np.setdiff1d(ring, both)]
        found += [np.where(whole == end, new, whole) for end in edge]
    return found


def _best(points: Floats, edges: Edges, whole: Cells, parts: Cells) -> Floats:
    """Return the place (3,) of the new vertex, chosen so that the worst of the new tetrahedra is as good as possible."""
    ends = np.unique(edges)
    middle = points[ends].mean(0)
    way = points[np.setdiff1d(whole, ends)].mean(0) - middle
    tried = [middle + share * way for share in _INWARDS]
    best: Floats = tried[int(np.argmax([_worst(np.concatenate([points, place[None]]), parts) for place in tried]))]
    return best


def _worst(points: Floats, parts: Cells) -> float:
    """Six times the least volume over the cube of the longest edge; any vertex beyond the others is the last point."""
    places = points[np.minimum(parts, len(points) - 1)]
    volume = np.linalg.det(places[:, 1:] - places[:, :1])
    lengths = np.linalg.norm(places[:, _EDGES[:, 0]] - places[:, _EDGES[:, 1]], axis=-1)
    return float((volume / lengths.max(-1) ** 3).min())


_OFF = 1e-5
"""Largest distance (mm) of a node from its face; a node farther away is on another face."""

_TRIES = 4
"""Times that poor elements are parted: those beside them may be the next."""

_ROUND = ((0, 1), (1, 2), (2, 0))
"""Edges of a triangle, by the numbers of their corners."""


def quadratic(gear: Gear, faces: Sequence[GearFace], filled: TetrahedronMesh) -> tuple[Floats, Cells]:
    """Return the points (n, 3) in mm, vertices first, then the middles of edges, and cells (m, 10): order of nodes as TET10 has
    it.

    Nodes on flanks, fillets, chamfers and lands are on the exact, modified ones. Raises SolverError if a vertex is not on
    the face that it was said to be on.
    """
    filled = replace(filled, tetrahedra=_upright(filled))
    for _ in range(_TRIES):
        points, cells, free = _curved(gear, faces, filled)
        poor = poor_elements(points, cells)
        edges = inner_edges(filled.points, filled.tetrahedra[poor], free[cells[poor, 4:]])
        if not edges:
            break
        parted = part_edges(filled.points, filled.tetrahedra, edges)
        filled = replace(filled, points=parted[0], tetrahedra=parted[1])
    return points, cells


def _curved(gear: Gear, faces: Sequence[GearFace], filled: TetrahedronMesh) -> tuple[Floats, Cells, Bools]:
    """Return the points, cells, and which of the points are middles of edges inside."""
    edges, middles = _edges(filled.tetrahedra)
    surface = _Surface(gear, faces, filled, edges)
    vertices, along = surface.vertices()
    points = np.concatenate([vertices, surface.middles(vertices, along)])
    cells = np.concatenate([filled.tetrahedra, len(vertices) + middles], 1, dtype=np.int32)
    return mended(points, cells, surface.inner_middles), cells, surface.inner_middles


def _upright(filled: TetrahedronMesh) -> Cells:
    """Tetrahedra whose first three vertices are counter-clockwise seen from the fourth."""
    a, b, c, d = np.moveaxis(filled.points[filled.tetrahedra], 1, 0)
    below = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    return np.where(below[:, None], filled.tetrahedra[:, [0, 2, 1, 3]], filled.tetrahedra)


def _edges(cells: Cells) -> tuple[Cells, Cells]:
    """Return the edges (n, 2), lower vertex first, in order, and those (m, 6) of each tetrahedron."""
    keys, found = np.unique(_keys(cells[:, Element.TET10.shape.edges]), return_inverse=True)
    return np.stack(np.divmod(keys, _BASE), -1).astype(np.int32), found.reshape(-1, 6).astype(np.int32)


_BASE = 2**31


def _keys(pairs: Cells) -> Wholes:
    """Return a number for each pair of nodes (..., 2), whatever their order."""
    low, high = np.moveaxis(np.sort(pairs, -1).astype(np.int64), -1, 0)
    found: Wholes = low * _BASE + high
    return found


class _Meshed(NamedTuple):
    """A face with the numbers of the nodes and edges on it."""

    face: GearFace
    nodes: Cells
    edges: Wholes


@dataclass(frozen=True)
class _Swept:
    """Nodes on a piece of the flanks of all teeth, and the edges between them, each with its tooth."""

    flank: ExactFlank
    nodes: Cells
    teeth: Wholes
    edges: Wholes
    edge_teeth: Wholes


@dataclass(frozen=True)
class _Surface:
    """Nodes and edges of a mesh by the faces that they are on."""

    gear: Gear
    faces: Sequence[GearFace]
    filled: TetrahedronMesh
    edges: Cells

    # ------------------------------------------------------------------ which are where

    @cached_property
    def _edge_numbers(self) -> list[Wholes]:
        """Numbers of the edges on each face."""
        known = _keys(self.edges)
        return [np.unique(np.searchsorted(known, _keys(cells[:, _ROUND]))) for cells in self.filled.triangles]

    def _on(self, surface: SurfaceKind) -> Iterator[_Meshed]:
        """Yield the faces on a kind of surface."""
        for face, cells, edges in zip(self.faces, self.filled.triangles, self._edge_numbers, strict=True):
            if face.surface is surface:
                yield _Meshed(face, np.unique(cells), edges)

    def _marked(self, surface: SurfaceKind) -> tuple[Bools, Bools]:
        """Return masks of the nodes and of the edges on a kind of surface."""
        nodes, edges = np.zeros(len(self.filled.points), bool), np.zeros(len(self.edges), bool)
        for meshed in self._on(surface):
            nodes[meshed.nodes] = edges[meshed.edges] = True
        return nodes, edges

    @cached_property
    def _swept(self) -> list[_Swept]:
        """Flanks, a piece after the other."""
        groups: dict[tuple[int, bool], list[_Meshed]] = {}
        for meshed in self._on(SurfaceKind.SPLINE):
            assert meshed.face.curve is not None
            groups.setdefault((meshed.face.curve, meshed.face.left), []).append(meshed)
        curves = flank_curves(self.gear)
        return [
            _Swept(
                ExactFlank(self.gear, curves[curve], left),
                np.concatenate([each.nodes for each in members]),
                np.concatenate([np.full(len(each.nodes), each.face.tooth) for each in members]),
                np.concatenate([each.edges for each in members]),
                np.concatenate([np.full(len(each.edges), each.face.tooth) for each in members]),
            )
            for (curve, left), members in groups.items()
        ]

    @cached_property
    def _ends(self) -> tuple[End, End]:
        half = halves(self.gear)[0].gear if self.gear.double_helix.present else self.gear
        return gear_ends(half, [piece.start[0] for piece in tooth_outline(half)])

    @cached_property
    def _on_cones(self) -> tuple[Bools, Bools]:
        return self._marked(SurfaceKind.CONE)

    def _end_heights(self, radius: Floats, z: Floats) -> Floats:
        """Return the heights (mm) of the nearer end at these radii (mm); the halves of a double helical gear have two each."""
        (lower, upper), width = self._ends, self.gear.face_width
        inside = height_in_half(self.gear, z)
        heights = np.where(inside < self.gear.half_width / 2, lower.height(radius), upper.height(radius))
        return np.where(inside == z, heights, width - heights)

    @property
    def inner_middles(self) -> Bools:
        """Mask of all nodes, vertices before middles, that are in the middle of an edge inside the body."""
        free = np.ones(len(self.filled.points) + len(self.edges), bool)
        free[: len(self.filled.points)] = False
        free[len(self.filled.points) + np.concatenate(self._edge_numbers)] = False
        return free

    # ------------------------------------------------------------------ where they go

    def vertices(self) -> tuple[Floats, list[Floats]]:
        """Return the vertices (n, 3), and the parameters along the profile of those on each piece of the flanks,
        NaN elsewhere.
        """
        points, found = self.filled.points.copy(), []
        for swept in self._swept:
            at = points[swept.nodes]
            s = swept.flank.nearest(at, swept.teeth)
            moved = self._placed(swept.flank, s, at[:, 2], swept.teeth, self._on_cones[0][swept.nodes])
            if (off := float(np.abs(moved - self.filled.points[swept.nodes]).max(initial=0.0))) > _OFF:
                raise SolverError(f"a node of the mesh is {off:.3g} mm from the face of the gear that it belongs to")
            points[swept.nodes] = moved
            along = np.full(len(points), np.nan)
            along[swept.nodes] = s
            found.append(along)
        return points, found

    def middles(self, vertices: Floats, along: Sequence[Floats]) -> Floats:
        """Middles (n, 3) of the edges."""
        points: Floats = vertices[self.edges].mean(1)
        conical = self._on_cones[1]
        points[conical] = self._round_cone(points[conical])
        for face, _, edges in self._on(SurfaceKind.CYLINDER):
            points[edges] = _at_radius(points[edges], np.array(face.radius), face.axis)
        for swept, s in zip(self._swept, along, strict=True):
            ends, at = s[self.edges[swept.edges]], points[swept.edges]
            middle = swept.flank.nearest(at, swept.edge_teeth)
            for end in (0.0, 1.0):  # an edge along an end of the curve stays there
                middle = np.where((ends == end).all(-1), end, middle)
            points[swept.edges] = self._placed(swept.flank, middle, at[:, 2], swept.edge_teeth, conical[swept.edges])
        return points

    def _placed(self, flank: ExactFlank, s: Floats, z: Floats, teeth: Wholes, conical: Bools) -> Floats:
        """Return the points (n, 3) of a flank; those that are on the cone of an end chamfer too are as high as that is."""
        radius, _ = flank.curve.curve.polar(s)
        return flank.points(s, np.where(conical, self._end_heights(radius, z), z), teeth)

    def _round_cone(self, points: Floats) -> Floats:
        """Return the points (n, 3) moved onto the cones of the end chamfers."""
        lower, upper = self._ends
        inside = height_in_half(self.gear, points[:, 2])
        setback = np.minimum(inside - lower.z, upper.z - inside)
        return _at_radius(points, lower.cone.face_radius + lower.cone.side * setback * lower.cone.slope)


def _at_radius(points: Floats, radius: Floats, axis: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Return the points (n, 3) moved to a radius (mm) about an axis (mm)."""
    middle = np.array([*axis, 0.0])
    moved: Floats = points - middle
    moved[:, :2] *= (radius / np.hypot(moved[:, 0], moved[:, 1]))[:, None]
    moved += middle
    return moved


_MOST = 10_000_000
"""Largest number of tetrahedra that gmsh is asked for: they take some 10 GB, and minutes."""

_NEAR = 0.1
"""Relative deviation from the requested number of elements that needs no further try."""

_TETRAHEDRA_TRIES = 3

STANDARD = TetrahedronGrading()


def mesh_tetrahedra(
    gear: Gear,
    *,
    size: float | None = None,
    elements: int | None = None,
    refined_teeth: Collection[int] = (),
    grading: TetrahedronGrading = STANDARD,
    stage: Callable[[Stage], None] = lambda _stage: None,
) -> ElementMesh:
    """Mesh the whole part with tetrahedra of second order: edges of at most `size` (mm) on teeth, or about so many `elements`.

    One of both is given; with `elements` edges are as far off the flanks as comes of that. `refined_teeth` are numbers of teeth
    (taken modulo all of them) with finer ones. Nodes of the surface are on the exact faces, modified flanks among them. Sides
    are "left_flank_3", "right_flank_3", "left_fillet_3", "right_fillet_3" and "tip_3", which has its chamfers, of each tooth;
    "left_root_3" and "right_root_3" if there is a root land, which a jagged line parts in the middle of the space; "end_back"
    at z = 0, "end_front", and what there is of "end_chamfers", "bore", "keyway", "hub", which is round, and its ends "hub_back"
    and "hub_front", of rings "rim" and "bolt_holes". `stage` is told what begins. Quality is for the caller to measure.
    Raises ParameterError for sizes that take too many elements, and SolverError.
    """
    for tooth in refined_teeth:
        require_whole("refined_teeth", tooth, at_least=1 - gear.tooth_count, at_most=gear.tooth_count - 1)
    refined = {tooth % gear.tooth_count for tooth in refined_teeth}
    part = _Part(gear, kernel_solid(gear_boundary(gear)), refined, grading, stage)
    if size is not None and elements is None:
        require_number("size", size, above=0)
        return part.mesh(lambda _expected: size)
    if elements is None or size is not None:
        raise ParameterError("size", size, "must be given in mm, or else a number of elements")
    require_whole("elements", elements, at_least=1, at_most=_MOST)
    return replace(part, grading=replace(grading, deviation=None)).mesh_counted(elements)


_Expected = Callable[[float], float]
"""Function from a size (mm) to the expected number of tetrahedra."""


@dataclass(frozen=True)
class _Part:
    """A gear to be meshed, and what all tries to do so have in common."""

    gear: Gear
    shape: Any
    refined: Collection[int]
    grading: TetrahedronGrading
    stage: Callable[[Stage], None]

    def mesh_counted(self, elements: int) -> ElementMesh:
        """Return a mesh with about the requested number of elements: estimated, made, counted, and made again if the number is
        off.
        """

        def size(expected: _Expected) -> float:
            least = expected(self.gear.profile.tip_diameter)
            if least > aim:
                raise ParameterError("elements", elements, f"must be at least about {least * elements / aim:.0f} for this gear")
            return _solved(expected, aim, self.gear.profile.tip_diameter)

        aim = float(elements)
        for _ in range(_TETRAHEDRA_TRIES):
            mesh = self.mesh(size)
            if abs(len(mesh.cells) / elements - 1) < _NEAR:
                break
            aim *= elements / len(mesh.cells)
        return mesh

    def mesh(self, size: Callable[[_Expected], float]) -> ElementMesh:
        """Return a mesh with the size (mm) that is requested after the part is known."""
        told: list[GearFace] = []

        def lengths(faces: Sequence[BrepFace]) -> EdgeLengths:
            told.extend(GearFaces(self.gear).told(faces))

            def of(size: float) -> EdgeLengths:
                return edge_lengths(self.gear, size, self.grading, self.refined, told, faces)

            chosen = of(size(lambda each: expected_tetrahedra(of(each), faces)))
            _require_few(chosen, told, faces)
            return chosen

        filled = fill_brep(self.shape, lengths, self.stage)
        points, cells = quadratic(self.gear, told, filled)
        sides = _sides(self.gear, told, filled, cells)
        return ElementMesh(Element.TET10, points, cells, {"gear": slice(0, len(cells))}, sides)


def _solved(expected: _Expected, aim: float, most: float) -> float:
    """Return the size (mm), at most `most`, for which so many are expected: the smaller it is, the more there are."""
    low, high = 0.0, most
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if expected(middle) > aim else (low, middle)
    return high


def _require_few(lengths: EdgeLengths, told: Sequence[GearFace], faces: Sequence[BrepFace]) -> None:
    """Raise ParameterError for sizes, or faces, so small that there would be too many elements."""
    if (expected := expected_tetrahedra(lengths, faces)) <= _MOST:
        return
    narrow = int(np.argmin([face.width for face in faces]))
    where = f"{told[narrow].name} is {faces[narrow].width:.2g} mm wide"
    permitted = f"makes about {expected:.2g} tetrahedra, which must be at most {_MOST}; the narrowest face, {where}"
    raise ParameterError("size", min(lengths.faces), permitted, "mm")


# ---------------------------------------------------------------------- named sides


def _sides(gear: Gear, faces: Sequence[GearFace], filled: TetrahedronMesh, cells: Cells) -> dict[str, Faces]:
    """Return the triangles on faces of each name, as sides of tetrahedra."""
    groups: dict[str, list[Cells]] = {}
    for face, triangles in zip(faces, filled.triangles, strict=True):
        parts = _halved(gear, face.tooth, triangles, filled.points) if face.name == ROOT else {face.name: triangles}
        for name, part in parts.items():
            groups.setdefault(name, []).append(part)
    together = {name: np.concatenate(groups[name]) for name in sorted(groups, key=_in_order)}
    at = _side_places(cells, np.concatenate(list(together.values())))
    ends = np.cumsum([len(part) for part in together.values()])[:-1]
    return {
        name: Faces((where // 4).astype(np.int32), (where % 4).astype(np.int8))
        for name, where in zip(together, np.split(at, ends), strict=True)
    }


def _in_order(name: str) -> tuple[float, str]:
    """Return the sides of teeth, tooth by tooth, then the others."""
    side, _, tooth = name.rpartition("_")
    return (int(tooth), side) if tooth.isdigit() else (math.inf, name)


def _halved(gear: Gear, tooth: int, triangles: Cells, points: Floats) -> dict[str, Cells]:
    """Return a root land parted at the middle of the space: what is of this tooth,
    and of the next. No edges run along there.
    """
    x, y, z = points[triangles].mean(1).T
    middle = (tooth + 0.5) * 2 * math.pi / gear.tooth_count
    ahead = np.mod(np.arctan2(y, x) - section_turn(gear, z) - middle, 2 * math.pi) < math.pi
    before, after = ("right", "left") if gear.internal else ("left", "right")
    return {
        f"{before}_root_{tooth}": triangles[~ahead],
        f"{after}_root_{(tooth + 1) % gear.tooth_count}": triangles[ahead],
    }


def _side_places(cells: Cells, triangles: Cells) -> Wholes:
    """Return the places of triangles (k, 3) among the sides of tetrahedra (m, 10), four sides each. Raises SolverError."""
    number = np.full(int(cells.max()) + 1, -1)
    nodes = np.unique(triangles)
    number[nodes] = np.arange(len(nodes))
    sides = np.sort(number[cells[:, [face[:3] for face in Element.TET10.shape.faces]]].reshape(-1, 3), -1)
    outer = np.flatnonzero(sides[:, 0] >= 0)
    keys = _tetrahedra_keys(sides[outer], len(nodes))
    order = np.argsort(keys, kind="stable")
    wanted = _tetrahedra_keys(np.sort(number[triangles], -1), len(nodes))
    first, last = (np.searchsorted(keys, wanted, side=side, sorter=order) for side in ("left", "right"))
    if np.any(last - first != 1):
        raise SolverError("gmsh left a hole in the surface of the gear")
    found: Wholes = outer[order[first]]
    return found


def _tetrahedra_keys(triples: Wholes, count: int) -> Wholes:
    """Return a number for each triple of nodes, which are as many as `count`: some million,
    or it would not be one of its own.
    """
    found: Wholes = (triples[:, 0] * count + triples[:, 1]) * count + triples[:, 2]
    return found

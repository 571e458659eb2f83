"""A tooth sector in plane elasticity: stiffness of its elements, its hub, and both condensed to its cuts.

Nodes go with the smallest part that has all their elements, and leave their stiffness, and loads, to those around them. Fronts
are dense, and small enough for the inverse of what goes to be kept.

A bore that is not held rests on a hub that follows its motion in the mean: what the hub gives back is a traction shaped like
a rigid motion - its part along the bore, for a bore may slide and lift but not shear - that balances the teeth. The mean
motion of the bore, weighted like that traction, is nought, so the body stays where its hub is, and responses are symmetric.

The dofs of a cut are radial and tangential, so the matrices of all sectors are the same and need no turning. A bore that is
held belongs to a rigid hub with one dof, its turn: the row of that dof is the torque on the hub. A bore that is not held has a
hub that follows it (see `support`): its dofs are the forces that it gives back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.contact.shared.bodies import Chain, Hold, Support
from gearcad.core.errors import SolverError
from gearcad.core.records import Bools, Floats, Wholes
from gearcad.material import Material
from gearcad.meshing.fem import mass_matrices, quadrature, shape_slopes, shape_values, stiffness_matrices
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.quads import edges_of_chain
from gearcad.meshing.sector import SectorMesh, with_shaft

_FEW = 24
"""Elements of a part that is not divided further."""

_ORDER = 4
"""Order of quadrature over triangles: six places."""


def node_dofs(nodes: Wholes) -> Wholes:
    """Return the dofs (..., 2 n) of nodes (..., n)."""
    return (2 * nodes[..., None] + np.arange(2)).reshape(*nodes.shape[:-1], 2 * nodes.shape[-1])


class _Front(NamedTuple):
    """One step: dofs that go, those that take over their load, the inverse of the matrix of the first, that times the matrix
    across.
    """

    own: Wholes
    aside: Wholes
    inverse: Floats
    across: Floats


class Arrived(NamedTuple):
    """Loads (kept, m) that arrive at the dofs that are kept, and what each front makes of them: None where none get there.

    `work` (m, m) is that of the loads on the displacements that they cause while nothing moves at the dofs that are kept.
    """

    loads: Floats
    moved: list[Floats | None]
    work: Floats


@dataclass(frozen=True)
class Dissected:
    """Condensed mesh of so many `dofs`: its `matrix` on the dofs `kept`, which go up."""

    dofs: int
    kept: Wholes
    matrix: Floats
    fronts: list[_Front]

    def forward(self, loads: Floats) -> Arrived:
        """Return the loads (dofs, m) moved to the dofs that are kept."""
        left, moved = loads.copy(), list[Floats | None]()
        loaded: Bools = np.any(loads, axis=1)
        work = np.zeros((loads.shape[1], loads.shape[1]))
        for own, aside, inverse, across in self.fronts:
            if not loaded[own].any():
                moved.append(None)
                continue
            here = left[own]
            left[aside] -= across.T @ here
            loaded[aside] = True
            by_load: Floats = inverse @ here
            moved.append(by_load)
            work += here.T @ by_load
        return Arrived(left[self.kept], moved, work)

    def backward(self, at_kept: Floats, arrived: Arrived | None = None) -> Floats:
        """Return the displacements (dofs, m) by those of the kept dofs (kept, m), and by loads; zero for held dofs."""
        found = np.zeros((self.dofs, at_kept.shape[1]))
        found[self.kept] = at_kept
        by_loads = arrived.moved if arrived is not None else [None] * len(self.fronts)
        for (own, aside, _, across), given in zip(reversed(self.fronts), reversed(by_loads), strict=True):
            here = across @ found[aside]
            found[own] = -here if given is None else given - here
        return found


def dissect(points: Floats, triangles: Wholes, matrices: Floats, kept: Wholes, held: Wholes) -> Dissected:
    """Condense elements (m, 6) of nodes at `points` (n, 2) with their `matrices` (m, 12, 12), in x and y, to the nodes `kept`.

    Nodes `held` do not move. Raises SolverError where the others could move without a force.
    """
    order = _ordered(points[triangles[:, :3]].mean(axis=1), np.arange(len(triangles)))
    return _Dissection(triangles[order], matrices[order], len(points), kept, held).condensed()


def _ordered(centres: Floats, chosen: Wholes) -> Wholes:
    """Return the elements in an order in which each half is on one side of a line, across the length of where they are."""
    if len(chosen) <= _FEW:
        return chosen
    away = centres[chosen] - centres[chosen].mean(axis=0)
    (xx, xy), (_, yy) = away.T @ away
    angle = np.arctan2(2 * xy, xx - yy) / 2
    middle = len(chosen) // 2
    order = np.argpartition(away @ [np.cos(angle), np.sin(angle)], middle)
    result: Wholes = np.r_[_ordered(centres, chosen[order[:middle]]), _ordered(centres, chosen[order[middle:]])]
    return result


class _Remainder(NamedTuple):
    """The nodes (k,) that a part leaves, and the matrix (2 k, 2 k) on their dofs."""

    nodes: Wholes
    matrix: Floats


class _Dissection:
    """Elements in the order of their parts, and which of them are the first and the last that have each node."""

    def __init__(self, triangles: Wholes, matrices: Floats, nodes: int, kept: Wholes, held: Wholes) -> None:
        self.triangles, self.matrices, self.nodes = triangles, matrices, nodes
        number = np.arange(len(triangles)).repeat(triangles.shape[1])
        self.first, self.last = np.full(nodes, len(triangles)), np.full(nodes, -1)
        self.first[triangles.ravel()[::-1]] = number[::-1]
        self.last[triangles.ravel()] = number
        self.last[kept] = len(triangles)  # nothing has all of their elements
        self.free: Bools = np.ones(nodes, bool)
        self.free[held] = False
        self.places = np.zeros(nodes, int)
        self.fronts: list[_Front] = []

    def condensed(self) -> Dissected:
        """Condense all elements to the nodes that are kept. Raises SolverError where a matrix cannot be factorised."""
        try:
            nodes, matrix = self._eliminated(0, len(self.triangles))
        except np.linalg.LinAlgError as error:
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised ({error})") from error
        return Dissected(2 * self.nodes, node_dofs(nodes), matrix, self.fronts)

    def _eliminated(self, begin: int, end: int) -> _Remainder:
        """Return the nodes that the elements from `begin` to before `end` leave, and the matrix on their dofs."""
        parts: list[_Remainder] = []
        if end - begin > _FEW:
            middle = begin + (end - begin) // 2
            parts = [self._eliminated(begin, middle), self._eliminated(middle, end)]
            every = np.unique(np.concatenate([part.nodes for part in parts]))
        else:
            every = np.unique(self.triangles[begin:end])
            every = every[self.free[every]]
        going = (self.first[every] >= begin) & (self.last[every] < end)
        own, aside = every[going], every[~going]
        self.places[own], self.places[aside] = np.arange(len(own)), np.arange(len(own), len(every))
        matrix = self._joined(parts, len(every)) if parts else self._summed(begin, end, len(every))
        count = 2 * len(own)
        rest = matrix[count:, count:]
        if count:
            inverse = np.asarray(np.linalg.inv(matrix[:count, :count]), float)
            across = inverse @ matrix[:count, count:]
            rest = rest - matrix[count:, :count] @ across
            self.fronts.append(_Front(node_dofs(own), node_dofs(aside), inverse, across))
        return _Remainder(aside, rest)

    def _joined(self, parts: list[_Remainder], count: int) -> Floats:
        """Return the matrix (2 n, 2 n) on so many nodes by what parts have left."""
        dofs = [node_dofs(self.places[part.nodes]) for part in parts]
        entries = [(2 * count * each[:, None] + each).ravel() for each in dofs]
        return _matrix(np.concatenate(entries), np.concatenate([part.matrix.ravel() for part in parts]), 2 * count)

    def _summed(self, begin: int, end: int, count: int) -> Floats:
        """Return the matrix (2 n, 2 n) on so many nodes by elements; what is held comes after the others, and is left out."""
        triangles, size = self.triangles[begin:end], 2 * count
        dofs = node_dofs(np.where(self.free[triangles], self.places[triangles], count))
        entries = ((size + 2) * dofs[:, :, None] + dofs[:, None]).ravel()
        return _matrix(entries, self.matrices[begin:end].ravel(), size + 2)[:size, :size]


def _matrix(entries: Wholes, values: Floats, size: int) -> Floats:
    """Return a matrix (size, size) of the sums of values at entries, which are counted row by row."""
    result: Floats = np.bincount(entries, values, size * size).astype(float, copy=False)
    return result.reshape(size, size)


class Plane(Enum):
    """Strain: a wide gear; stress: a thin one."""

    STRAIN = "plane strain"
    STRESS = "plane stress"


@dataclass(frozen=True)
class PlaneElasticity:
    """Material and plane state; the two constants in which all plane problems look like plane stress."""

    material: Material
    plane: Plane = Plane.STRAIN

    @property
    def modulus(self) -> float:
        """E' (MPa): E in plane stress, E/(1 - nu^2) in plane strain."""
        nu = self.material.poisson_ratio
        return self.material.youngs_modulus / (1 - nu**2 if self.plane is Plane.STRAIN else 1.0)

    @property
    def ratio(self) -> float:
        """Poisson's ratio nu' of the plane problem: nu in plane stress, nu/(1 - nu) in plane strain."""
        nu = self.material.poisson_ratio
        return nu / (1 - nu) if self.plane is Plane.STRAIN else nu

    @property
    def lame(self) -> tuple[float, float]:
        """Lamé's constants lambda and mu (MPa) of the plane problem."""
        return self.modulus * self.ratio / (1 - self.ratio**2), self.modulus / 2 / (1 + self.ratio)


def element_stiffness(mesh: SectorMesh, elasticity: PlaneElasticity, elements: Wholes | None = None) -> Floats:
    """Return the stiffness (m, 12, 12) in N/mm per mm of width of all elements, or of some: x and y of each of its nodes in
    turn.
    """
    return stiffness_matrices("tri6", _nodes(mesh, elements), elasticity.lame, _ORDER)


def element_mass(mesh: SectorMesh, elements: Wholes | None = None) -> Floats:
    """Integrals of N^T N (m, 12, 12) in mm² over all elements, or some, by the same dofs."""
    return mass_matrices("tri6", _nodes(mesh, elements), _ORDER)


def element_forces(triangles: Wholes, matrices: Floats, moved: Floats) -> Floats:
    """Return the forces (2 n, k) of elements (m, 6) with their matrices (m, 12, 12) by displacements (2 n, k) of all nodes."""
    dofs = node_dofs(triangles)
    moves: Bools = np.any(moved, axis=1)
    strained = moves[dofs].any(axis=1)
    dofs = dofs[strained]
    each = (matrices[strained] @ moved[dofs]).reshape(dofs.size, moved.shape[1])
    order = np.argsort(dofs, axis=None, kind="stable")
    found, begin = np.unique(dofs.ravel()[order], return_index=True)
    forces = np.zeros_like(moved)
    forces[found] = np.add.reduceat(each[order], begin) if len(begin) else 0.0
    return forces


def _nodes(mesh: SectorMesh, elements: Wholes | None) -> Floats:
    """Return the nodes (m, 6, 2) in mm of all elements, or of some."""
    nodes: Floats = mesh.points[mesh.triangles if elements is None else mesh.triangles[elements]]
    return nodes


_ALONG = 7
"""Order of quadrature over a part of an edge for the tractions on the bore."""

_PARTS = 16
"""Parts of an edge, so that a keyway may end inside it."""


def with_support(mesh: SectorMesh, support: Support) -> SectorMesh:
    """Return the sector with what of the shaft belongs to it."""
    return with_shaft(mesh, support.shaft_bore) if support.hold is Hold.SHAFT else mesh


def held_nodes(mesh: SectorMesh, support: Support) -> Wholes:
    """Return the nodes that belong to the hub; of a ring on bolts those of a sector that has one, but for its cuts, which all
    share.
    """
    if support.floats:
        return np.empty(0, int)
    if support.hold is not Hold.BOLTS:
        return mesh.sides[OutlineSide.HELD]
    outside = np.hypot(*mesh.points.T) > support.bolt_circle / 2
    outside[mesh.sides[OutlineSide.HELD]] = True
    outside[mesh.ahead] = outside[mesh.behind] = False
    return np.flatnonzero(outside)


def hub_seen_by(tooth: int, support: Support) -> Floats:
    """Return the dofs of the hub as the sector of a tooth, counted from the loaded one, sees them, from those that that one
    sees.

    Those of a hub that floats are the torque and two forces; the other has its turn.
    """
    if not support.floats:
        return np.eye(1)
    cosine, sine = math.cos(tooth * 2 * math.pi / support.teeth), math.sin(tooth * 2 * math.pi / support.teeth)
    return np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])


def hub_tractions(mesh: SectorMesh, whole: SectorMesh, support: Support) -> Floats:
    """Return the nodal forces (2 n, 3) on the `whole` of a sector by torque and forces of unit shape, of a hub that floats."""
    if support.hold is Hold.SHAFT:
        shaft = np.arange(len(mesh.triangles), len(whole.triangles))
        return element_forces(whole.triangles[shaft], element_mass(whole, shaft), rigid_motions(whole.points).reshape(-1, 3))
    return _on_bore(mesh, math.pi)


def key_load(mesh: SectorMesh, support: Support) -> Floats:
    """Return the nodal forces (2 n, 1) by which a key under the middle of the sector gives a torque of 1 (N mm per mm).

    The shear over a bore as wide as the keyway, or as the sector if that is narrower.
    """
    forces = _on_bore(mesh, support.key)[:, :1]
    return forces / (forces[:, 0] @ rigid_motions(mesh.points)[..., 0].ravel())


def rigid_motions(points: Floats) -> Floats:
    """Return the displacements (n, 2, 3) of points by a turn of 1 rad and by shifts along x and y of 1."""
    x, y = points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    return np.stack([np.stack([-y, x], -1), np.stack([one, zero], -1), np.stack([zero, one], -1)], -1)


def _on_bore(mesh: SectorMesh, half: float) -> Floats:
    """Return the nodal forces (2 n, 3) by rigid motions' parts along the bore,
    as tractions up to `half` (rad) from its middle.
    """
    edges = edges_of_chain(mesh.sides[OutlineSide.HELD])
    part, weight = quadrature("line3", _ALONG)
    s = (np.arange(_PARTS)[:, None] + part[:, 0]).reshape(-1, 1) / _PARTS
    weight = np.tile(weight / _PARTS, _PARTS)
    shape, slope = shape_values("line3", s), shape_slopes("line3", s)[:, 0]
    points = np.einsum("qa,eac->eqc", shape, mesh.points[edges])
    length = np.hypot(*np.moveaxis(np.einsum("qa,eac->eqc", slope, mesh.points[edges]), -1, 0)) * weight
    angle = np.arctan2(points[..., 1], points[..., 0])
    length = np.where(np.abs(angle) <= half, length, 0.0)
    along = np.stack([-np.sin(angle), np.cos(angle)], -1)
    motions = rigid_motions(points.reshape(-1, 2)).reshape(*points.shape, 3)
    sheared = np.einsum("eqc,eqd,eqdj->eqcj", along, along, motions)
    forces = np.zeros((len(mesh.points), 2, 3))
    np.add.at(forces, edges, np.einsum("qa,eq,eqcj->eacj", shape, length, sheared))
    return forces.reshape(-1, 3)


class CutAxes(NamedTuple):
    """Nodes (k,) at the cuts of a sector, and the directions (2, 2, k) of their polar dofs: radial and tangential."""

    nodes: Wholes
    directions: Floats

    @classmethod
    def of(cls, mesh: SectorMesh) -> CutAxes:
        """Return the axes of the nodes at the cuts of a mesh."""
        nodes = np.union1d(mesh.behind, mesh.ahead)
        return cls.at(nodes, mesh.points[nodes], straight=mesh.straight)

    @classmethod
    def at(cls, nodes: Wholes, points: Floats, *, straight: bool = False) -> CutAxes:
        """Return the axes of nodes (k,) at points (k, 2): those of x and y in the `straight` row of a rack's sectors."""
        angles = np.zeros(len(points)) if straight else np.arctan2(points[:, 1], points[:, 0])
        cosine, sine = np.cos(angles), np.sin(angles)
        return cls(nodes, np.array([[cosine, sine], [-sine, cosine]]))

    def polar(self, plain: Floats) -> Floats:
        """Return values (dofs, ...) with polar dofs at the cuts, from values along x and y."""
        return self._turned(plain, self.directions)

    def plain(self, polar: Floats) -> Floats:
        """Return values (dofs, ...) along x and y, from values with polar dofs at the cuts."""
        return self._turned(polar, self.directions.swapaxes(0, 1))

    def _turned(self, given: Floats, directions: Floats) -> Floats:
        found = given.copy()
        nodes = found.reshape(-1, 2, *given.shape[1:])
        nodes[self.nodes] = np.einsum("ijk,kj...->ki...", directions, nodes[self.nodes])
        return found


@dataclass(frozen=True)
class Sector:
    """The stiffness of a tooth's sector, and what the hub does to it; dofs are in its own frame, but for those of its cuts.

    `mesh` is the gear's, `whole` has its share of the shaft too, and its elements the `stiffness` (m, 12, 12) in x and y.
    `held` dofs belong to the hub and move with `turn` (dofs,) when it turns by 1 rad, or a rack moves by 1 mm; `hub`
    (dofs, hub) are the forces of its dofs, `hub_matrix` what they do to themselves.
    """

    mesh: SectorMesh
    whole: SectorMesh
    axes: CutAxes
    stiffness: Floats
    held: Wholes
    turn: Floats
    hub: Floats
    hub_matrix: Floats

    @property
    def dofs(self) -> int:
        """Dofs of the sector, hub and cuts included."""
        return 2 * len(self.whole.points)

    @cached_property
    def behind(self) -> Wholes:
        """Dofs of the cut behind, radial and tangential in turn, but for those on the hub."""
        return self._free(self.whole.behind)

    @cached_property
    def ahead(self) -> Wholes:
        """Dofs of the cut ahead: the k-th meets the k-th of `behind`."""
        return self._free(self.whole.ahead)

    def _free(self, nodes: Wholes) -> Wholes:
        dofs = node_dofs(nodes)
        return dofs[~np.isin(dofs, self.held)]

    def let_go(self) -> Sector:
        """Return the same sector without supports."""
        nothing = np.zeros_like
        return replace(
            self, held=np.empty(0, int), turn=nothing(self.turn), hub=nothing(self.hub), hub_matrix=nothing(self.hub_matrix)
        )

    def forces(self, moved: Floats) -> Floats:
        """Return the forces (dofs, m) of the sector in N per mm of width by displacements (dofs, m) in mm."""
        return self.axes.polar(element_forces(self.whole.triangles, self.stiffness, self.axes.plain(moved)))

    def inside(self, loads: Floats) -> Floats:
        """Return the loads (dofs, m), but for those on cuts and hub."""
        found = loads.copy()
        found[self.condensed.kept] = found[self.held] = 0.0
        return found

    @cached_property
    def condensed(self) -> Dissected:
        """The sector condensed to its cuts while its hub is held; dofs are those in x and y."""
        cuts = np.union1d(self.whole.behind, self.whole.ahead)
        return dissect(self.whole.points, self.whole.triangles, self.stiffness, cuts, self.held[::2] // 2)

    @cached_property
    def at_cuts(self) -> CutAxes:
        """Axes of those dofs alone to which the sector is condensed."""
        nodes = self.condensed.kept[::2] // 2
        return CutAxes.at(np.arange(len(nodes)), self.whole.points[nodes], straight=self.whole.straight)

    @cached_property
    def cut_matrix(self) -> Floats:
        """Matrix of the condensed sector on polar dofs, in N/mm per mm of width."""
        return self.at_cuts.polar(self.at_cuts.polar(self.condensed.matrix).T).T


def make_sector(mesh: SectorMesh, elasticity: PlaneElasticity, support: Support | None = None) -> Sector:
    """Return the stiffness of a sector with polar dofs on its cuts."""
    support = support or Support()
    whole = with_support(mesh, support)
    stiffness = element_stiffness(whole, elasticity, np.arange(len(mesh.triangles)))
    if len(whole.triangles) > len(mesh.triangles):
        shaft = PlaneElasticity(support.shaft, elasticity.plane)
        shafts = element_stiffness(whole, shaft, np.arange(len(mesh.triangles), len(whole.triangles)))
        stiffness = np.concatenate([stiffness, shafts])
    held, turn = node_dofs(held_nodes(mesh, support)), np.zeros(2 * len(whole.points))
    turn[held] = rigid_motions(whole.points)[..., 2 if mesh.straight else 0].ravel()[held]
    axes = CutAxes.of(whole)
    turn, nothing = axes.polar(turn), np.zeros((len(turn), 0))
    sector = Sector(mesh, whole, axes, stiffness, held, turn, nothing, np.zeros((3, 3)))
    if support.floats:
        return replace(sector, hub=axes.polar(hub_tractions(mesh, whole, support)))
    hub = sector.forces(turn[:, None])
    return replace(sector, hub=hub, hub_matrix=turn[None] @ hub)


def chain_of(sector: Sector, onward: Floats | None = None) -> Chain:
    """Return one sector condensed to its cuts and the hub, whose dofs the next sector sees `onward`."""
    cuts = np.r_[sector.behind, sector.ahead]
    places = np.searchsorted(sector.condensed.kept, cuts)
    arrived = sector.condensed.forward(sector.inside(sector.hub))
    hub = sector.at_cuts.polar(arrived.loads)[places] + sector.hub[cuts]
    matrix = np.block([[sector.cut_matrix[np.ix_(places, places)], hub], [hub.T, sector.hub_matrix - arrived.work]])
    return Chain((matrix + matrix.T) / 2, np.eye(1) if onward is None else onward)

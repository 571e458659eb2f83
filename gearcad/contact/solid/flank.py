"""Compliance of the flank of a solid tooth: finite elements for the body, Boussinesq's half-space for the contact.

With n into the half-space, the vector a from the load to a point at the distance s, the depth z = a.n and c = z/s.

The load's field in a half-space is taken off the elements of the loaded tooth, so they carry only the smooth rest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from gearcad.contact.shared.loaded import FlankCompliance, LoadedFlank
from gearcad.contact.solid.elements import boundary_faces, layer_matrices, summing
from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, JsonObject, Wholes
from gearcad.core.runtime import Share, unheard
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.quads import edges_of_chain
from gearcad.meshing.sector import SweptMesh, turned

if TYPE_CHECKING:
    from gearcad.contact.solid.body import SolidBody

Places = tuple[Floats, Floats]
"""Roll lengths (n,) and heights z (n,) of places on a flank, in mm."""


@dataclass(frozen=True)
class SolidFlank(LoadedFlank):
    """The loaded flank over the face width, turned by `rate` (rad/mm); places on it are roll lengths and heights z (mm)."""

    rate: float

    @property
    def helix(self) -> float:
        """Base helix angle (rad), signed."""
        return math.radians(self.gear.base_helix_angle)

    def points(self, places: Places) -> Floats:
        """Return the points (n, 3) in space (mm)."""
        length, z = np.broadcast_arrays(*places)
        radius, start = self.polar(length)
        angle = start + self.rate * z
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)

    def inward(self, places: Places) -> Floats:
        """Return the unit normals (n, 3) into the tooth."""
        length, z = np.broadcast_arrays(*places)
        heading = self.heading(length) + self.rate * z
        flat, rise = math.cos(self.helix), math.sin(self.helix)
        return np.stack([flat * np.sin(heading), -flat * np.cos(heading), np.full(heading.shape, rise)], -1)

    def towards_tip(self, places: Places) -> Floats:
        """Return the unit tangents (n, 3) in the transverse section towards the tip."""
        length, z = np.broadcast_arrays(*places)
        heading = self.heading(length) + self.rate * z
        return self.upward * np.stack([np.cos(heading), np.sin(heading), np.zeros(heading.shape)], -1)


@dataclass(frozen=True)
class FlankGrid:
    """Places on the flank in rows and columns: roll lengths (rows,) and heights (columns,); a place is column * rows + row."""

    lengths: Floats
    heights: Floats

    @property
    def places(self) -> Places:
        """Roll lengths and heights (rows x columns,) of all places, column by column."""
        return np.tile(self.lengths, len(self.heights)), np.repeat(self.heights, len(self.lengths))


class GridSpline:
    """Bicubic spline through a grid as weights on its values, in coordinates spread out towards tip and end faces.

    Near an edge of the flank the response varies like the logarithm of the distance from it.
    """

    def __init__(self, grid: FlankGrid, tip: float, corner: float, width: float) -> None:
        from scipy.interpolate import CubicSpline

        self._tip, self._corner, self._width = tip, corner, width
        self._margin = width / 20
        rows, columns = self._up(grid.lengths), self._along(grid.heights)
        self._rows = CubicSpline(rows, np.eye(len(rows)))
        self._columns = CubicSpline(columns, np.eye(len(columns)))
        self._bounds = ((grid.lengths[0], min(grid.lengths[-1], tip - corner / 2)), (grid.heights[0], grid.heights[-1]))

    def _up(self, lengths: Floats) -> Floats:
        result: Floats = -np.log(np.maximum(self._tip - lengths, 0) + self._corner)
        return result

    def _along(self, heights: Floats) -> Floats:
        result: Floats = np.log((heights + self._margin) / (self._width - heights + self._margin))
        return result

    def weights(self, places: Places) -> Floats:
        """Return the weights (n, places of the grid) at places."""
        (low, high), (back, front) = self._bounds
        rows = self._rows(self._up(np.clip(places[0], low, high)))
        columns = self._columns(self._along(np.clip(places[1], back, front)))
        result: Floats = (columns[:, :, None] * rows[:, None, :]).reshape(len(rows), -1)
        return result


def surface_displacement(distance: Floats, material: Material) -> Floats:
    """Inward displacement (mm) of the plane at `distance` (mm) from 1 N: (1 - nu^2)/(pi E d)."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    result: Floats = (1 - nu**2) / (np.pi * e * distance)
    return result


def half_space_displacement(
    points: Floats, load_at: Floats, inward: Floats, material: Material, forces: Floats | float = 1.0
) -> Floats:
    """Return the displacement (..., 3) in mm at `points` (..., 3) by `forces` (N) at `load_at` along the unit vector `inward`;
    0 at the load. Of several loads, (m, 3) and (m,), the sum.

    2 pi E/(1 + nu) u = ((2 (1 - nu) + c^2) n + (c - (1 - 2 nu)/(1 + c)) (a - z n)/s)/s.
    """
    from gearcad.contact.solid.kernels import add_displacements

    e, nu = material.youngs_modulus, material.poisson_ratio
    result = np.zeros(points.shape)
    add_displacements(_rows(points), _rows(load_at), _rows(inward), np.atleast_1d(forces), nu, result.reshape(-1, 3))
    result *= (1 + nu) / (2 * np.pi * e)
    return result


def half_space_normal_displacement(
    points: Floats, normals: Floats, load_at: Floats, inward: Floats, material: Material, forces: Floats
) -> Floats:
    """Return the displacements (n, m) in mm along `normals` (n, 3) at points (n, 3), each the sum by a group of loads (m, k,
    3), alike in all groups: `forces` (k,) in N.
    """
    from gearcad.contact.solid.kernels import add_normal_displacements

    e, nu = material.youngs_modulus, material.poisson_ratio
    result = np.zeros((len(points), len(load_at)))
    at, along = (np.ascontiguousarray(each, dtype=float) for each in (load_at, inward))
    add_normal_displacements(_rows(points), _rows(normals), at, along, forces, nu, result)
    result *= (1 + nu) / (2 * np.pi * e)
    return result


def half_space_traction(
    points: Floats, normals: Floats, load_at: Floats, inward: Floats, material: Material, forces: Floats | float = 1.0
) -> Floats:
    """Return the traction (..., 3) in MPa on elements of surface at `points` with `normals` t (..., 3), by the same loads.

    2 pi s^2 p = -3 c^2 (t.a/s) n - b (t.n) n + b t
                 + ((1 - 2 nu) (2 + c)/(1 + c)^2 (t.r) - 3 c (t.a/s)) r,  r = (a - z n)/s,  b = (1 - 2 nu) (c - 1/(1 + c)):
    pressure along a, as shear and radial stress join with the axial one, and what the surface's freedom adds.
    """
    from gearcad.contact.solid.kernels import add_tractions

    result, loads = np.zeros(points.shape), (_rows(load_at), _rows(inward), np.atleast_1d(forces))
    add_tractions(_rows(points), _rows(normals), *loads, material.poisson_ratio, result.reshape(-1, 3))
    result /= 2 * np.pi
    return result


def _rows(vectors: Floats) -> Floats:
    """Return the vectors (..., 3) as rows of doubles."""
    return np.ascontiguousarray(vectors, dtype=float).reshape(-1, 3)


@dataclass(frozen=True)
class Images:
    """Mirror images of a load behind both ends of its tooth: what a free end adds to a half-space, but for a smooth rest.

    Load and image together leave no shear on the end; the factor allows for the normal stress that they do leave there.
    """

    flank: SolidFlank
    material: Material

    factor: ClassVar[float] = 1.39
    """Factor for nu = 0.3 (R. Guilbault, Journal of Tribology 133, 2011, 031402); elements and splines carry the remaining
    error.
    """

    def loads(self, at: Floats, inward: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the points (..., m, 3), inward normals (..., m, 3) and forces (m,) in N of all that stands for 1 N at points
        (..., 3).
        """
        flip = np.array([1.0, 1.0, -1.0])
        ends = np.array([0.0, self.flank.gear.face_width])
        where = at[..., None, :] * flip + np.outer(2 * ends, [0.0, 0.0, 1.0])
        return where, np.broadcast_to(inward[..., None, :] * flip, where.shape), np.full(2, self.factor)

    def displacement(self, points: Floats, at: Floats, inward: Floats) -> Floats:
        """Return the displacement (..., 3) in mm at points by all that."""
        where, to, forces = self.loads(at, inward)
        return half_space_displacement(points, where, to, self.material, forces)

    def traction(self, points: Floats, normals: Floats, at: Floats, inward: Floats) -> Floats:
        """Return the traction (..., 3) in MPa on elements of surface by all that."""
        where, to, forces = self.loads(at, inward)
        return half_space_traction(points, normals, where, to, self.material, forces)

    def normal(self, moved: Places, loaded: Places) -> Floats:
        """Return the normal displacements (n, m) in mm at places by all that stands for 1 N at each loaded place."""
        return self.moved_along(self.flank.inward(moved), moved, loaded)

    def moved_along(self, directions: Floats, moved: Places, loaded: Places) -> Floats:
        """Return the displacements (n, m) in mm along `directions` (n, 3) at places, by the same."""
        where, to, forces = self.loads(self.flank.points(loaded), self.flank.inward(loaded))
        return half_space_normal_displacement(self.flank.points(moved), directions, where, to, self.material, forces)


class TakenOff(Images):
    """Field in closed form that is subtracted from the elements: that of a load in a half-space, and of its images."""

    def loads(self, at: Floats, inward: Floats) -> tuple[Floats, Floats, Floats]:
        where, to, forces = super().loads(at, inward)
        both = ((one[..., None, :], more) for one, more in ((at, where), (inward, to)))
        points, normals = (np.concatenate(each, axis=-2) for each in both)
        return points, normals, np.r_[1.0, forces]


class NodalForces(NamedTuple):
    """Forces (n, 3, loads) in N, in turning axes, at `nodes` (n,): none at others."""

    nodes: Wholes
    values: Floats

    @property
    def dofs(self) -> Floats:
        """Forces as dofs (3 n, loads) in N."""
        return self.values.reshape(-1, self.values.shape[-1])

    def together(self, shares: Floats) -> NodalForces:
        """Return the forces of loads that act together, by shares (loads, m)."""
        return NodalForces(self.nodes, self.values @ shares)


class Remaining(NamedTuple):
    """Rest of unit loads: the `forces` that leave a smooth rest, and displacements (n, 3, loads) in mm, in turning axes, at
    the same nodes by the fields that are `taken_off`.
    """

    forces: NodalForces
    taken_off: Floats

    def taken_off_at(self, nodes: Wholes) -> Floats:
        """Return the displacements (n, 3, loads) in mm that are taken off at some nodes: 0 at those that are not near."""
        place = np.searchsorted(self.forces.nodes, nodes) % len(self.forces.nodes)
        result: Floats = np.where((self.forces.nodes[place] == nodes)[:, None, None], self.taken_off[place], 0.0)
        return result


def remaining(
    flank: SolidFlank, mesh: SweptMesh, material: Material, near: Wholes, places: Places, points: int, tell: Share
) -> Remaining:
    """Return the fields of 1 N at each place taken off the hexahedra over the quadrangles `near`, and the remaining forces.

    `points` is the number of Gauss points each way on faces close to a load. `tell` hears how much is done.
    """
    at, inward = flank.points(places), flank.inward(places)
    nodes = np.unique(mesh.over(np.unique(mesh.section.quads[near])))
    faces, field = boundary_faces(mesh, near), TakenOff(flank, material)
    displacements, pressed = np.empty((len(at), len(nodes), 3)), np.empty((len(at), len(faces.used), 3))
    around, here = np.searchsorted(nodes, faces.used), mesh.points[nodes]
    for load, (where, direction) in enumerate(zip(at, inward, strict=True)):
        displacements[load] = field.displacement(here, where, direction)
        pressed[load] = faces.forces(partial(field.traction, at=where, inward=direction), where, points)
        tell((load + 1) / len(at))
    taken_off = mesh.to_turning(np.moveaxis(displacements, 0, -1), nodes)
    forces = np.zeros_like(taken_off)
    forces[around] = -mesh.to_turning(np.moveaxis(pressed, 0, -1), faces.used)
    _add_elastic(forces, mesh, material, near, nodes, taken_off)
    return Remaining(NodalForces(nodes, forces), taken_off)


def _add_elastic(
    forces: Floats, mesh: SweptMesh, material: Material, near: Wholes, nodes: Wholes, displacements: Floats
) -> None:
    """Add to nodal forces (n, 3, m) those by which the hexahedra over some quadrangles resist displacements (n, 3, m)."""
    quads, count = mesh.section.quads[near], displacements.shape[-1]
    known: dict[float, Floats] = {}
    for layer, thickness in enumerate(np.diff(mesh.planes).round(_ROUNDED).tolist()):
        if thickness not in known:
            known[thickness] = layer_matrices(mesh, quads, layer, material)
        here = np.searchsorted(nodes, mesh.elements(quads, layer))
        resisting = known[thickness] @ displacements[here].reshape(len(quads), 60, count)
        used, sums = summing(here)
        forces[used] += (sums @ resisting.reshape(-1, 3 * count)).reshape(-1, 3, count)


_ROUNDED = 9
"""Decimals (mm) of thicknesses that count as one."""


ToothForces = tuple[int, Floats]
"""Tooth, and the force (N) at each unit load's place (see SolidCompliance.load_weights): those normal to the flank and, where
there is friction, after them those along it towards the tip.
"""

_ROWS, _FEWEST_ROWS = 8, 2
"""Unit loads up the flank, and the least between which a spline can run."""

_NEAR, _NEAR_OF_RINGS = 12, 32
"""Gauss points each way on faces near a load: a ring's tip is nearer to its last row, where fewer miss 7 % of the load."""


@dataclass(frozen=True)
class SolidCompliance(FlankCompliance):
    """Responses of a body to 1 N normal to the flank of tooth 0 at each place of `loads`.

    `moved[k]` (places of `grid`, loads) are normal displacements (mm) of the flank of tooth k; of tooth 0 they lack those of
    a half-space and of the load's images (see `Images`). `torques` (loads,) act on the hub (N mm). At the nodes
    `surface` (n,) of the loaded flank, the fillets and a free bore `displacements` (teeth, n, 3, loads) are in turning axes: on
    tooth 0, but for its bore, without the fields that were taken off. `forces` are those that elements carry of each load.
    """

    flank: SolidFlank
    body: SolidBody
    material: Material
    loads: FlankGrid
    grid: FlankGrid
    moved: dict[int, Floats]
    surface: Wholes
    displacements: Floats
    forces: NodalForces
    torques: Floats

    @property
    def neighbours(self) -> int:
        """Teeth on each side of tooth 0 whose responses are known."""
        return self.body.neighbours

    @property
    def hub_radius(self) -> float:
        """Radius at which the body is held (mm)."""
        mesh = self.body.sector.mesh
        return float(np.hypot(*mesh.section.points[mesh.side(OutlineSide.HELD)[0]]))

    @property
    def nodes(self) -> int:
        """Number of nodes in the mesh of one tooth sector."""
        return self.body.sector.mesh.nodes

    @property
    def mesh_document(self) -> JsonObject:
        """Size of the mesh of one tooth sector, as documents have it."""
        mesh = self.body.sector.mesh
        return {
            "nodes": self.nodes,
            "hexahedra": mesh.layers * len(mesh.section.quads),
            "layers": mesh.layers,
            "unit_loads": self.unit_loads,
        }

    def moved_weights(self, places: Places) -> Floats:
        """Return the weights (n, places of the grid) with which responses at the grid give those at places of the flank."""
        return self._moved_weights.weights(places)

    def load_weights(self, places: Places) -> Floats:
        """Return the weights (n, loads) with which responses to the unit loads give those to a load at places of the flank."""
        return self._load_weights.weights(places)

    @cached_property
    def _moved_weights(self) -> GridSpline:
        return GridSpline(self.grid, *self._ends)

    @cached_property
    def _load_weights(self) -> GridSpline:
        return GridSpline(self.loads, *self._ends)

    @property
    def _ends(self) -> tuple[float, float, float]:
        """Roll length of the tip (mm), the last edge before it, and the face width."""
        lengths = self.grid.lengths
        return float(lengths[-1]), float(lengths[-1] - lengths[-3]), float(self.grid.heights[-1])

    @property
    def images(self) -> Images:
        """The loads' images behind the ends of the teeth."""
        return Images(self.flank, self.material)

    @cached_property
    def along(self) -> dict[int, Floats]:
        """Displacements as `moved`, but towards the tip in the transverse section; of tooth 0 without the fields taken off."""
        mesh = self.body.sector.mesh
        on_flank, grid = _flank_grid(self.flank, mesh)
        place, towards_tip = np.searchsorted(self.surface, on_flank), self.flank.towards_tip(grid.places)
        teeth = range(-self.neighbours, self.neighbours + 1)
        return {
            tooth: _normal(mesh, self.displacements[self.neighbours + tooth][place], on_flank, towards_tip) for tooth in teeth
        }

    @cached_property
    def friction_forces(self) -> NodalForces:
        """Forces of 1 N along the flank towards its tip at each place of `loads`: on the nodes that stand there."""
        mesh, places = self.body.sector.mesh, self.loads.places
        chain = mesh.side(OutlineSide.LEFT_FLANK)[::-1]
        edges, rows = edges_of_chain(chain), np.searchsorted(self.grid.lengths, self.loads.lengths) // 2
        faces = (mesh.side_faces(edges, layer) for layer in range(mesh.layers))
        at = np.concatenate([np.r_[each[:, 7], each[-1:, 5]][rows] for each in faces])
        nodes, place = np.unique(at, return_inverse=True)
        vectors = np.zeros((len(nodes), 3, len(at)))
        vectors[place, :, np.arange(len(at))] = self.flank.towards_tip(places)
        return NodalForces(nodes, mesh.to_turning(vectors, nodes))

    @cached_property
    def by_friction(self) -> tuple[Floats, Floats]:
        """Displacements (teeth, n, 3, loads) in mm as `displacements`, and torques (loads,) as `torques`, by these forces."""
        forces = self.friction_forces
        moved = self.body.solve(forces.dofs, self.surface, at=forces.nodes)
        return moved.displacements.reshape(-1, len(self.surface), 3, len(moved.torques)), moved.torques

    def taken_off_along(self, places: Places) -> Floats:
        """Return the displacements (n, n) in mm towards the tip at places of the flank by the fields that 1 N at each has."""
        return TakenOff(self.flank, self.material).moved_along(self.flank.towards_tip(places), places, places)

    def taken_off_traction(self, points: Floats, normals: Floats) -> Floats:
        """Return the traction (..., 3, loads) in MPa by the fields that were taken off, on elements of surface of tooth 0."""
        field, places = TakenOff(self.flank, self.material), self.loads.places
        loads = zip(self.flank.points(places), self.flank.inward(places), strict=True)
        return np.stack([field.traction(points, normals, at, inward) for at, inward in loads], -1)

    def surface_displacements(self, tooth: int) -> Floats:
        """Return the displacements (n, 3, loads) in mm of the nodes `surface` of tooth k, in fixed axes."""
        return self.body.sector.mesh.to_space(self.displacements[self.neighbours + tooth], self.surface)

    def friction_displacements(self, tooth: int) -> Floats:
        """Return the displacements (n, 3, loads) in mm of the same nodes by 1 N along the flank of tooth 0 at each place."""
        return self.body.sector.mesh.to_space(self.by_friction[0][self.neighbours + tooth], self.surface)

    def tooth_displacements(self, tooth: int, loads: Sequence[ToothForces]) -> Floats:
        """Return the displacements (nodes, 3) in mm of all nodes of a tooth, in fixed axes, by loads on it and its neighbours.

        Loads on teeth further away than those whose responses are known are left out.
        """
        mesh = self.body.sector.mesh
        # A load on another tooth is seen from this one as this one sees a load on tooth 0.
        near = [(tooth - loaded, force) for loaded, force in loads if abs(tooth - loaded) <= self.neighbours]
        acting, found = np.stack([force for _, force in near], -1), np.zeros(3 * mesh.nodes)
        normal, along = acting[: self.unit_loads], acting[self.unit_loads :]
        for forces, shares in ((self.forces, normal), (self.friction_forces, along) if len(along) else (self.forces, along)):
            if len(shares):
                together = forces.together(shares)
                moved = self.body.solve(together.dofs, at=together.nodes)
                found += sum(moved.displacements[self.neighbours + apart][:, i] for i, (apart, _) in enumerate(near))
        return mesh.to_space(found.reshape(-1, 3))

    def torque(self, places: Places) -> Floats:
        """Return the torque on the hub (N mm) by 1 N at each place."""
        return -(self.load_weights(places) @ self.torques)


def solid_compliance(
    gear: Gear,
    body: SolidBody,
    material: Material,
    start: float,
    tell: Share = unheard,
    *,
    fields: bool = False,
    along: bool = False,
) -> SolidCompliance:
    """Solve the body for unit loads on some rows and columns of the flank, from the roll length `start` (mm) up.

    With `fields` the body keeps its factors for the fields of its teeth, else it is condensed again for the first one. With
    `along` it is solved for forces along the flank, too. `tell` hears how much of what comes before the body's own part is
    done: the fields of the loads.
    """
    sector = body.sector
    mesh, flank = sector.mesh, SolidFlank(gear, sector.mesh.rate)
    on_flank, grid = _flank_grid(flank, mesh)
    loads = _load_grid(grid, gear, start)
    places = loads.places
    points = _NEAR_OF_RINGS if gear.internal else _NEAR
    rest = remaining(flank, mesh, material, _near_quads(gear, mesh), places, points, tell)
    surface = _surface(mesh, free=sector.free)
    moved = body.solve(rest.forces.dofs, surface, at=rest.forces.nodes)
    displacements = moved.displacements.reshape(-1, len(surface), 3, len(places[0]))
    place, normal = np.searchsorted(surface, on_flank), flank.inward(grid.places)
    found = {
        tooth: _normal(mesh, displacements[body.neighbours + tooth][place], on_flank, normal)
        for tooth in range(-body.neighbours, body.neighbours + 1)
    }
    distance = np.linalg.norm(flank.points(grid.places)[:, None] - flank.points(places), axis=-1)
    found[0] = found[0] - np.where(distance > 1e-9, surface_displacement(np.maximum(distance, 1e-9), material), 0.0)
    found[0] -= Images(flank, material).normal(grid.places, places)
    # The elements of a bore have all of what is far from the load.
    on_tooth = np.flatnonzero(~np.isin(surface, mesh.over(mesh.side(OutlineSide.HELD))))
    displacements[body.neighbours][on_tooth] -= rest.taken_off_at(surface[on_tooth])
    result = SolidCompliance(flank, body, material, loads, grid, found, surface, displacements, rest.forces, moved.torques)
    if along:
        _ = result.by_friction
    if not fields:
        body.let_go()
    return result


def _surface(mesh: SweptMesh, *, free: bool) -> Wholes:
    """Return the nodes (n,), sorted, of the loaded flank, of the fillets, and of the bore if it is free."""
    sides = (OutlineSide.LEFT_FLANK, OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FILLET, *([OutlineSide.HELD] if free else []))
    return np.unique(mesh.over(np.unique(np.concatenate([mesh.side(side) for side in sides]))))


def _normal(mesh: SweptMesh, vectors: Floats, nodes: Wholes, inward: Floats) -> Floats:
    """Return the normal displacements (n, m) from vectors (n, 3, m) at nodes in turning axes."""
    flat = turned(inward[:, :2], -mesh.rate * mesh.heights[nodes])
    result: Floats = np.einsum("ncm,nc->nm", vectors, np.c_[flat, inward[:, 2]])
    return result


def _flank_grid(flank: SolidFlank, mesh: SweptMesh) -> tuple[Wholes, FlankGrid]:
    """Return the nodes of the flank, plane by plane from root to tip, and their places."""
    chain = mesh.side(OutlineSide.LEFT_FLANK)[::-1]
    lengths = flank.roll_lengths(np.hypot(*mesh.section.points[chain].T))
    nodes = np.concatenate([chain + mesh.plane(k) for k in range(len(mesh.planes))])
    return nodes, FlankGrid(lengths, mesh.planes)


def _load_grid(grid: FlankGrid, gear: Gear, start: float) -> FlankGrid:
    """Return the rows on vertices of the flank but for its tip corner, the first not above `start`; a column half-way up every
    layer.

    An undercut flank ends in a corner at the root as well, where no load can be taken off as one on a half-space. Raises
    SolverError where there is one row only, and nothing between rows.
    """
    vertices = grid.lengths[::2][int(gear.undercut) : -1]
    vertices = vertices[max(0, int(np.searchsorted(vertices, start, side="right")) - 1) :]
    if len(vertices) < _FEWEST_ROWS:
        text = f"the flanks of the gear with {gear.teeth} teeth have too few elements to be loaded: the mesh must be finer"
        raise SolverError(f"{text} (refinement of [check])")
    return FlankGrid(vertices[_spread(len(vertices), _ROWS)], (grid.heights[1:] + grid.heights[:-1]) / 2)


def _spread(count: int, wanted: int) -> Wholes:
    """`wanted` of `count` indices, evenly; all if there are fewer."""
    return np.unique(np.round(np.linspace(0, count - 1, min(wanted, count))).astype(int))


def _near_quads(gear: Gear, mesh: SweptMesh) -> Wholes:
    """Return the quadrangles of the tooth and a module of the body below it: where the half-space's field is taken off."""
    centre = mesh.section.points[mesh.section.quads[:, :4]].mean(axis=1)
    radius, root = np.hypot(*centre.T), gear.profile.root_diameter / 2
    if gear.internal:
        # A thin rim ends before that: what the field leaves on its held circle would be missing in the torque.
        held = np.isin(mesh.section.quads, mesh.side(OutlineSide.HELD)).any(axis=1)
        return np.flatnonzero((radius < root + gear.normal_module) & ~held)
    return np.flatnonzero(radius > root - gear.normal_module)

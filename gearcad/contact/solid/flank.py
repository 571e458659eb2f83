"""How a solid gear gives way under a point load on its flank: finite elements for the body, Boussinesq for the contact.

The load's field in a half-space is taken off the elements of the loaded tooth, so they carry only the smooth rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.solid.body import SolidBody
from gearcad.contact.solid.boussinesq import half_space_displacement, half_space_traction, surface_displacement
from gearcad.contact.solid.faces import boundary_faces
from gearcad.contact.solid.swept import SweptMesh, turned
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.meshing.outline import Side
from gearcad.progress import Share, unheard

__all__ = ["SolidCompliance", "SolidFlank", "solid_compliance"]


Places = tuple[Floats, Floats]
"""Roll lengths (n,) and heights z (n,) of places on a flank, in mm."""

_ROWS = 8
"""Unit loads up the flank."""


@dataclass(frozen=True)
class SolidFlank:
    """The loaded flank of tooth 0, the left one; places on it are roll lengths (mm) and heights z (mm)."""

    gear: Gear
    rate: float

    @property
    def base_radius(self) -> float:
        """r_b (mm)."""
        return self.gear.base_diameter / 2

    @property
    def helix(self) -> float:
        """Base helix angle (rad), signed."""
        return math.radians(self.gear.base_helix_angle)

    def points(self, places: Places) -> Floats:
        """Points (n, 3) in space (mm)."""
        length, z = np.broadcast_arrays(*places)
        roll = length / self.base_radius
        angle = math.radians(self.gear.profile.base_half_angle) - (roll - np.arctan(roll)) + self.rate * z
        radius = np.hypot(self.base_radius, length)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)

    def inward(self, places: Places) -> Floats:
        """Unit normals (n, 3) into the tooth."""
        length, z = np.broadcast_arrays(*places)
        heading = math.radians(self.gear.profile.base_half_angle) - length / self.base_radius + self.rate * z
        flat, rise = math.cos(self.helix), math.sin(self.helix)
        return np.stack([flat * np.sin(heading), -flat * np.cos(heading), np.full(heading.shape, rise)], -1)


@dataclass(frozen=True)
class Grid:
    """Places on the flank in rows and columns: roll lengths (rows,) and heights (columns,); a place is column * rows + row."""

    lengths: Floats
    heights: Floats

    @property
    def places(self) -> Places:
        """All of them."""
        return np.tile(self.lengths, len(self.heights)), np.repeat(self.heights, len(self.lengths))


@dataclass(frozen=True)
class SolidCompliance:
    """Responses of a body to 1 N normal to the flank of tooth 0 at each place of `loads`.

    `moved[k]` (places of `grid`, loads) are normal displacements (mm) of the flank of tooth k; of tooth 0 they lack those of
    a half-space and of the load's images (see `Images`). `torques` (loads,) act on the hub (N mm); `displacements` (teeth,
    dofs, loads) are in turning axes, those of tooth 0 without `taken_off` (dofs, loads), the fields that were taken off.
    """

    flank: SolidFlank
    body: SolidBody
    material: Material
    loads: Grid
    grid: Grid
    moved: dict[int, Floats]
    displacements: Floats
    taken_off: Floats
    torques: Floats

    @property
    def neighbours(self) -> int:
        """Teeth on each side of tooth 0 whose responses are known."""
        return self.body.neighbours

    @property
    def hub_radius(self) -> float:
        """Where the body is held (mm)."""
        mesh = self.body.sector.mesh
        return float(np.hypot(*mesh.section.points[mesh.side(Side.INNER)[0]]))

    def at(self, places: Places) -> Floats:
        """Weights (n, places of the grid) with which responses at the grid give those at places of the flank."""
        return self._moved_weights.at(places)

    def by(self, places: Places) -> Floats:
        """Weights (n, loads) with which responses to the unit loads give those to a load at places of the flank."""
        return self._load_weights.at(places)

    @cached_property
    def _moved_weights(self) -> _Spline:
        return _Spline(self.grid, *self._ends)

    @cached_property
    def _load_weights(self) -> _Spline:
        return _Spline(self.loads, *self._ends)

    @property
    def _ends(self) -> tuple[float, float, float]:
        """Roll length of the tip (mm), the last edge before it, and the face width."""
        lengths = self.grid.lengths
        return float(lengths[-1]), float(lengths[-1] - lengths[-3]), float(self.grid.heights[-1])

    @property
    def images(self) -> Images:
        """The loads' images behind the ends of the teeth."""
        return Images(self.flank, self.material)

    def taken_off_traction(self, points: Floats, normals: Floats) -> Floats:
        """Traction (..., 3, loads) in MPa by the fields that were taken off, on elements of surface of tooth 0."""
        field, places = _Field(self.flank, self.material), self.loads.places
        loads = zip(self.flank.points(places), self.flank.inward(places), strict=True)
        return np.stack([field.traction(points, normals, at, inward) for at, inward in loads], -1)

    def torque(self, places: Places) -> Floats:
        """Torque on the hub (N mm) by 1 N at each place."""
        return -(self.by(places) @ self.torques)


@dataclass(frozen=True)
class Images:
    """Mirror images of a load behind both ends of its tooth: what a free end adds to a half-space, but for a smooth rest.

    Load and image together leave no shear on the end; the factor allows for the normal stress that they do leave there.
    """

    flank: SolidFlank
    material: Material

    factor: ClassVar[float] = 1.39
    """At nu = 0.3 (R. Guilbault, Journal of Tribology 133, 2011, 031402); elements and splines carry what it misses."""

    def of(self, at: Floats, inward: Floats) -> list[tuple[Floats, Floats]]:
        """Points and inward normals (n, 3) of the images of loads."""
        flip = np.array([1.0, 1.0, -1.0])
        ends = (0.0, self.flank.gear.face_width)
        return [(at * flip + np.array([0.0, 0.0, 2 * end]), inward * flip) for end in ends]

    def displacement(self, points: Floats, at: Floats, inward: Floats) -> Floats:
        """Displacement (..., 3) in mm at points by the images of one load of 1 N."""
        moved = (half_space_displacement(points, where, to, self.material) for where, to in self.of(at, inward))
        return self.factor * sum(moved, start=np.zeros(points.shape))

    def traction(self, points: Floats, normals: Floats, at: Floats, inward: Floats) -> Floats:
        """Traction (..., 3) in MPa on elements of surface by the images of one load of 1 N."""
        found = (half_space_traction(points, normals, where, to, self.material) for where, to in self.of(at, inward))
        return self.factor * sum(found, start=np.zeros(points.shape))

    def normal(self, moved: Places, loaded: Places) -> Floats:
        """Normal displacements (n, m) in mm at places by the images of 1 N at each loaded place."""
        points, normals = self.flank.points(moved)[:, None], self.flank.inward(moved)[:, None]
        at, inward = self.flank.points(loaded), self.flank.inward(loaded)
        result: Floats = (self.displacement(np.broadcast_to(points, (len(points), len(at), 3)), at, inward) * normals).sum(-1)
        return result


class _Spline:
    """Bicubic spline through a grid as weights on its values, in coordinates spread out towards tip and end faces.

    Near an edge of the flank the response varies like the logarithm of the distance from it.
    """

    def __init__(self, grid: Grid, tip: float, corner: float, width: float) -> None:
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

    def at(self, places: Places) -> Floats:
        (low, high), (back, front) = self._bounds
        rows = self._rows(self._up(np.clip(places[0], low, high)))
        columns = self._columns(self._along(np.clip(places[1], back, front)))
        result: Floats = (columns[:, :, None] * rows[:, None, :]).reshape(len(rows), -1)
        return result


def solid_compliance(gear: Gear, body: SolidBody, material: Material, start: float, tell: Share = unheard) -> SolidCompliance:
    """Solve the body for unit loads on some rows and columns of the flank, from the roll length `start` (mm) up.

    `tell` hears how much of what comes before the body's own part is done: the fields of the loads.
    """
    sector = body.sector
    mesh, flank = sector.mesh, SolidFlank(gear, sector.mesh.rate)
    nodes, grid = _flank_grid(flank, mesh)
    loads = _load_grid(grid, gear, start)
    places = loads.places
    at, inward = flank.points(places), flank.inward(places)
    near = _near_quads(gear, mesh)
    touched = np.unique(mesh.over(np.unique(mesh.section.quads[near])))
    singular = np.zeros((mesh.nodes, 3, len(at)))
    forces = np.zeros_like(singular)
    faces, field = boundary_faces(mesh, near), _Field(flank, material)
    for column, (where, direction) in enumerate(zip(at, inward, strict=True)):
        singular[touched, :, column] = field.displacement(mesh.points[touched], where, direction)
        forces[:, :, column] = -faces.forces(mesh, partial(field.traction, at=where, inward=direction), where)
        tell((column + 1) / len(at))
    taken_off = mesh.to_turning(singular).reshape(sector.dofs, -1)
    right = sector.stiffness(near) @ taken_off + mesh.to_turning(forces).reshape(sector.dofs, -1)
    moved = body.solve(right)
    normal = flank.inward(grid.places)
    found = {
        tooth: _normal(mesh, moved.displacements[body.neighbours + tooth], nodes, normal)
        for tooth in range(-body.neighbours, body.neighbours + 1)
    }
    distance = np.linalg.norm(flank.points(grid.places)[:, None] - at, axis=-1)
    found[0] = found[0] - np.where(distance > 1e-9, surface_displacement(np.maximum(distance, 1e-9), material), 0.0)
    found[0] -= Images(flank, material).normal(grid.places, places)
    moved.displacements[body.neighbours] -= taken_off
    return SolidCompliance(flank, body, material, loads, grid, found, moved.displacements, taken_off, moved.torques)


def _normal(mesh: SweptMesh, displacements: Floats, nodes: Wholes, inward: Floats) -> Floats:
    """Normal displacements (nodes, m) from those of all dofs in turning axes."""
    vectors = displacements.reshape(mesh.nodes, 3, -1)[nodes]
    flat = turned(inward[:, :2], -mesh.rate * mesh.heights[nodes])
    result: Floats = np.einsum("ncm,nc->nm", vectors, np.c_[flat, inward[:, 2]])
    return result


def _flank_grid(flank: SolidFlank, mesh: SweptMesh) -> tuple[Wholes, Grid]:
    """Nodes of the flank, plane by plane from root to tip, and their places."""
    chain = mesh.side(Side.LEFT_FLANK)[::-1]
    radius = np.hypot(*mesh.section.points[chain].T)
    lengths = np.sqrt(np.maximum((radius - flank.base_radius) * (radius + flank.base_radius), 0))
    nodes = np.concatenate([chain + mesh.plane(k) for k in range(len(mesh.planes))])
    return nodes, Grid(lengths, mesh.planes)


def _load_grid(grid: Grid, gear: Gear, start: float) -> Grid:
    """Rows on vertices of the flank but for its tip corner, the first not above `start`; a column half-way up every layer.

    An undercut flank ends in a corner at the root as well, where no load can be taken off as one on a half-space.
    """
    vertices = grid.lengths[::2][int(gear.undercut) : -1]
    vertices = vertices[max(0, int(np.searchsorted(vertices, start, side="right")) - 1) :]
    return Grid(vertices[_spread(len(vertices), _ROWS)], (grid.heights[1:] + grid.heights[:-1]) / 2)


def _spread(count: int, wanted: int) -> Wholes:
    """`wanted` of `count` indices, evenly; all if there are fewer."""
    return np.unique(np.round(np.linspace(0, count - 1, min(wanted, count))).astype(int))


def _near_quads(gear: Gear, mesh: SweptMesh) -> Wholes:
    """Quadrangles of the tooth and a module of the body below it: where the half-space's field is taken off."""
    centre = mesh.section.points[mesh.section.quads[:, :4]].mean(axis=1)
    return np.flatnonzero(np.hypot(*centre.T) > gear.root_diameter / 2 - gear.normal_module)


class _Field(Images):
    """The field that is taken off: a load's in a half-space, and its images'."""

    def displacement(self, points: Floats, at: Floats, inward: Floats) -> Floats:
        return half_space_displacement(points, at, inward, self.material) + super().displacement(points, at, inward)

    def traction(self, points: Floats, normals: Floats, at: Floats, inward: Floats) -> Floats:
        return half_space_traction(points, normals, at, inward, self.material) + super().traction(points, normals, at, inward)

"""How a solid gear gives way under a point load on its flank: finite elements for the body, Boussinesq for the contact.

The load's field in a half-space is taken off the elements of the loaded tooth, so they carry only the smooth rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.shared.engaged import FlankCompliance
from gearcad.contact.solid.body import SolidBody
from gearcad.contact.solid.boussinesq import surface_displacement
from gearcad.contact.solid.images import Images, TakenOff
from gearcad.contact.solid.places import Grid, GridSpline, Places, SolidFlank
from gearcad.contact.solid.remaining import NodalForces, remaining
from gearcad.errors import SolverError
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.swept import SweptMesh, turned
from gearcad.progress import Share, unheard

__all__ = ["SolidCompliance", "ToothForces", "solid_compliance"]


ToothForces = tuple[int, Floats]
"""Tooth, and the force (N) at each unit load's place (see SolidCompliance.load_weights)."""

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
    loads: Grid
    grid: Grid
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
        """Where the body is held (mm)."""
        mesh = self.body.sector.mesh
        return float(np.hypot(*mesh.section.points[mesh.side(Side.HELD)[0]]))

    @property
    def nodes(self) -> int:
        """Of the mesh of one tooth sector."""
        return self.body.sector.mesh.nodes

    @property
    def mesh_document(self) -> dict[str, Any]:
        """Size of the mesh of one tooth sector, as documents have it."""
        mesh = self.body.sector.mesh
        return {
            "nodes": self.nodes,
            "hexahedra": mesh.layers * len(mesh.section.quads),
            "layers": mesh.layers,
            "unit_loads": self.unit_loads,
        }

    def moved_weights(self, places: Places) -> Floats:
        """Weights (n, places of the grid) with which responses at the grid give those at places of the flank."""
        return self._moved_weights.weights(places)

    def load_weights(self, places: Places) -> Floats:
        """Weights (n, loads) with which responses to the unit loads give those to a load at places of the flank."""
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

    def taken_off_traction(self, points: Floats, normals: Floats) -> Floats:
        """Traction (..., 3, loads) in MPa by the fields that were taken off, on elements of surface of tooth 0."""
        field, places = TakenOff(self.flank, self.material), self.loads.places
        loads = zip(self.flank.points(places), self.flank.inward(places), strict=True)
        return np.stack([field.traction(points, normals, at, inward) for at, inward in loads], -1)

    def surface_displacements(self, tooth: int) -> Floats:
        """Displacements (n, 3, loads) in mm of the nodes `surface` of tooth k, in fixed axes."""
        return self.body.sector.mesh.to_space(self.displacements[self.neighbours + tooth], self.surface)

    def tooth_displacements(self, tooth: int, loads: Sequence[ToothForces]) -> Floats:
        """Displacements (nodes, 3) in mm of all nodes of a tooth, in fixed axes, by loads on it and its neighbours.

        Loads on teeth further away than those whose responses are known are left out.
        """
        mesh = self.body.sector.mesh
        # A load on another tooth is seen from this one as this one sees a load on tooth 0.
        near = [(tooth - loaded, force) for loaded, force in loads if abs(tooth - loaded) <= self.neighbours]
        together = self.forces.together(np.stack([force for _, force in near], -1))
        moved = self.body.solve(together.dofs, at=together.nodes)
        found = sum(
            (moved.displacements[self.neighbours + apart][:, column] for column, (apart, _) in enumerate(near)),
            start=np.zeros(3 * mesh.nodes),
        )
        return mesh.to_space(found.reshape(-1, 3))

    def torque(self, places: Places) -> Floats:
        """Torque on the hub (N mm) by 1 N at each place."""
        return -(self.load_weights(places) @ self.torques)


def solid_compliance(
    gear: Gear, body: SolidBody, material: Material, start: float, tell: Share = unheard, *, fields: bool = False
) -> SolidCompliance:
    """Solve the body for unit loads on some rows and columns of the flank, from the roll length `start` (mm) up.

    With `fields` the body keeps its factors for the fields of its teeth, else it is condensed again for the first one. `tell`
    hears how much of what comes before the body's own part is done: the fields of the loads.
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
    if not fields:
        body.let_go()
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
    on_tooth = np.flatnonzero(~np.isin(surface, mesh.over(mesh.side(Side.HELD))))
    displacements[body.neighbours][on_tooth] -= rest.taken_off_at(surface[on_tooth])
    return SolidCompliance(flank, body, material, loads, grid, found, surface, displacements, rest.forces, moved.torques)


def _surface(mesh: SweptMesh, *, free: bool) -> Wholes:
    """Nodes (n,), sorted, of the loaded flank, of the fillets, and of the bore if it is free."""
    sides = (Side.LEFT_FLANK, Side.LEFT_FILLET, Side.RIGHT_FILLET, *([Side.HELD] if free else []))
    return np.unique(mesh.over(np.unique(np.concatenate([mesh.side(side) for side in sides]))))


def _normal(mesh: SweptMesh, vectors: Floats, nodes: Wholes, inward: Floats) -> Floats:
    """Normal displacements (n, m) from vectors (n, 3, m) at nodes in turning axes."""
    flat = turned(inward[:, :2], -mesh.rate * mesh.heights[nodes])
    result: Floats = np.einsum("ncm,nc->nm", vectors, np.c_[flat, inward[:, 2]])
    return result


def _flank_grid(flank: SolidFlank, mesh: SweptMesh) -> tuple[Wholes, Grid]:
    """Nodes of the flank, plane by plane from root to tip, and their places."""
    chain = mesh.side(Side.LEFT_FLANK)[::-1]
    lengths = flank.roll_lengths(np.hypot(*mesh.section.points[chain].T))
    nodes = np.concatenate([chain + mesh.plane(k) for k in range(len(mesh.planes))])
    return nodes, Grid(lengths, mesh.planes)


def _load_grid(grid: Grid, gear: Gear, start: float) -> Grid:
    """Rows on vertices of the flank but for its tip corner, the first not above `start`; a column half-way up every layer.

    An undercut flank ends in a corner at the root as well, where no load can be taken off as one on a half-space. Raises
    SolverError where there is one row only, and nothing between rows.
    """
    vertices = grid.lengths[::2][int(gear.undercut) : -1]
    vertices = vertices[max(0, int(np.searchsorted(vertices, start, side="right")) - 1) :]
    if len(vertices) < _FEWEST_ROWS:
        text = f"the flanks of the gear with {gear.teeth} teeth have too few elements to be loaded: the mesh must be finer"
        raise SolverError(f"{text} (refinement of [check])")
    return Grid(vertices[_spread(len(vertices), _ROWS)], (grid.heights[1:] + grid.heights[:-1]) / 2)


def _spread(count: int, wanted: int) -> Wholes:
    """`wanted` of `count` indices, evenly; all if there are fewer."""
    return np.unique(np.round(np.linspace(0, count - 1, min(wanted, count))).astype(int))


def _near_quads(gear: Gear, mesh: SweptMesh) -> Wholes:
    """Quadrangles of the tooth and a module of the body below it: where the half-space's field is taken off."""
    centre = mesh.section.points[mesh.section.quads[:, :4]].mean(axis=1)
    radius, root = np.hypot(*centre.T), gear.profile.root_diameter / 2
    if gear.internal:
        # A thin rim ends before that: what the field leaves on its held circle would be missing in the torque.
        held = np.isin(mesh.section.quads, mesh.side(Side.HELD)).any(axis=1)
        return np.flatnonzero((radius < root + gear.normal_module) & ~held)
    return np.flatnonzero(radius > root - gear.normal_module)

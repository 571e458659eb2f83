"""Compliance of a flank and stress of the root fillets of a plane tooth: finite elements, and Flamant's half-plane.

The singular part of every contact solution, known exactly, so that a finite element mesh need not resolve it.

A point load on the flank is taken off the finite element solution inside the loaded tooth, where Flamant's field is known
exactly, so the elements carry only the smooth rest (singularity subtraction).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from gearcad.contact.plane.ring import Ring, SurfaceStresses, far_responses
from gearcad.contact.plane.sector import PlaneElasticity, element_forces, key_load, node_dofs
from gearcad.contact.shared.bodies import Hold
from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE, BodyFlank, FlankCompliance, LoadedFlank, RootStress
from gearcad.core.records import Floats, JsonObject, Wholes
from gearcad.geometry import Gear
from gearcad.meshing.fem import quadrature, shape_slopes, shape_values
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.quads import edges_of_chain, mesh_quality
from gearcad.meshing.sector import SectorMesh

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline


def flamant_displacement(
    points: Floats, load_at: Floats, inward: Floats, elasticity: PlaneElasticity, middle: float = 0.0
) -> Floats:
    """Return the displacement (..., 2) in mm at `points` (..., 2) by 1 N per mm of width at `load_at` along the unit vector
    `inward`.

    The constant of the logarithm is such that it is ln r with r in mm; at the load itself the value is left at 0. A load
    along the edge has its body around the angle `middle` (rad) from its direction.
    """
    e, nu = elasticity.modulus, elasticity.ratio
    away = points - load_at
    across = np.array([-inward[1], inward[0]])
    r = np.hypot(away[..., 0], away[..., 1])
    at_load = r < 1e-12
    r = np.where(at_load, 1.0, r)
    cosine, sine, log = away @ inward / r, away @ across / r, np.log(r)
    angle = np.arctan2(sine, cosine)
    if middle:  # the angle jumps outside the body
        angle = middle + (angle - middle + np.pi) % (2 * np.pi) - np.pi
    radial = -(2 * cosine * log + (1 - nu) * angle * sine) / (np.pi * e)
    circumferential = (2 * nu * sine + 2 * log * sine - (1 - nu) * angle * cosine + (1 - nu) * sine) / (np.pi * e)
    along = radial * cosine - circumferential * sine
    beside = radial * sine + circumferential * cosine
    result: Floats = along[..., None] * inward + beside[..., None] * across
    result[at_load] = 0
    return result


def flamant_traction(points: Floats, normals: Floats, load_at: Floats, inward: Floats) -> Floats:
    """Return the traction (..., 2) in MPa on elements of surface at `points` with `normals` (..., 2), by the same load.

    sigma_rr = -2 cos(theta)/(pi r) is the only stress.
    """
    away = points - load_at
    r = np.hypot(away[..., 0], away[..., 1])
    unit = away / r[..., None]
    stress = -2 * (unit @ inward) / (np.pi * r)
    result: Floats = (stress * (unit * normals).sum(-1))[..., None] * unit
    return result


def edge_displacement(distance: Floats, elasticity: PlaneElasticity) -> Floats:
    """Inward displacement (mm) of the straight edge at `distance` (mm): k(d) = -2/(pi E') ln d - (1 + nu')/(pi E')."""
    e, nu = elasticity.modulus, elasticity.ratio
    result: Floats = -(2 * np.log(distance) + 1 + nu) / (np.pi * e)
    return result


_ALONG = 15
"""Order of quadrature over each edge for the tractions of Flamant's field."""

_AT_STRAINS = 3
"""Order of the quadrature whose two places have the most accurate strains of quadratic elements."""

Compliance = Callable[[Floats, Floats], Floats]
"""Normal displacements (n, m) in mm at roll lengths (n,) by 1 N per mm of width at roll lengths (m,)."""


class SectionFlank(BodyFlank):
    """The loaded flank of a section: its `nodes` from root to tip, and their places, `lengths` (mm).

    These are roll lengths of an involute; on the straight flank of a rack they grow as evenly along the line of action.
    """

    nodes: Wholes
    lengths: Floats

    @property
    @abstractmethod
    def sharp_root(self) -> bool:
        """Whether the flank ends in a corner at the root, beside which no load can be taken off as on a straight edge."""

    @abstractmethod
    def near_elements(self, mesh: SectorMesh) -> Wholes:
        """Return the elements of the tooth and a module of the body below it: where Flamant's field is taken off."""

    @abstractmethod
    def arc(self, lengths: Floats) -> Floats:
        """Return the distance along the flank (mm), which rises towards the tip."""

    @abstractmethod
    def length_at(self, arc: float) -> float:
        """Return the place (mm) at a distance along the flank (mm)."""

    @abstractmethod
    def heading(self, lengths: Floats) -> Floats:
        """Return the angles (rad) of the tangents of the base circle that places lie on, to the middle of the tooth."""

    @abstractmethod
    def points(self, lengths: Floats | float) -> Floats:
        """Return the points (..., 2) at places (mm)."""

    def inward(self, lengths: Floats) -> Floats:
        """Return the unit normals (..., 2) into the tooth."""
        heading = self.heading(lengths)
        return np.stack([np.sin(heading), -np.cos(heading)], -1)

    def towards_tip(self, lengths: Floats) -> Floats:
        """Return the unit tangents (..., 2) towards the tip."""
        heading = self.heading(lengths)
        tangents: Floats = self.upward * np.stack([np.cos(heading), np.sin(heading)], -1)
        return tangents


@dataclass(frozen=True)
class PlaneFlank(LoadedFlank, SectionFlank):
    """The loaded flank of a gear's section: its nodes from root to tip, and their roll lengths (mm)."""

    nodes: Wholes
    lengths: Floats

    @property
    def sharp_root(self) -> bool:
        return self.gear.undercut

    def near_elements(self, mesh: SectorMesh) -> Wholes:
        return near_elements(self.gear, mesh)

    def arc(self, lengths: Floats) -> Floats:
        """Return the arc length along the involute (mm) from the base circle, which rises towards the tip:
        rho |rho|/(2 r_b).
        """
        result: Floats = np.copysign(lengths**2, lengths) / (2 * self.base_radius)
        return result

    def length_at(self, arc: float) -> float:
        """Return the roll length (mm) at an arc length (mm)."""
        return math.copysign(math.sqrt(2 * self.base_radius * abs(arc)), arc)

    def points(self, lengths: Floats | float) -> Floats:
        """Return the points (..., 2) at roll lengths (mm)."""
        radius, angle = self.polar(np.asarray(lengths, float))
        result: Floats = radius[..., None] * np.stack([np.cos(angle), np.sin(angle)], -1)
        return result


def flank_of(gear: Gear, mesh: SectorMesh) -> PlaneFlank:
    """Return the loaded flank of a sector mesh."""
    nodes = mesh.sides[OutlineSide.LEFT_FLANK][::-1]
    lengths = LoadedFlank(gear).roll_lengths(np.hypot(*mesh.points[nodes].T))
    return PlaneFlank(gear, nodes, lengths)


@dataclass(frozen=True)
class PlaneCompliance(FlankCompliance):
    """Responses of a body to unit normal loads at `loads` (roll lengths, mm), one column each.

    `displacements` (sectors, 2 n, m) in mm in each sector's frame, without the part of tooth 0 that is Flamant's:
    there they are the smooth rest, and `singular` (2 n, m) holds what was taken off. `torques` (m,) act on the hub;
    `hub_forces` (3, m) are the dofs of a hub that follows the bore.
    """

    flank: SectionFlank
    ring: Ring
    elasticity: PlaneElasticity
    loads: Floats
    displacements: Floats
    singular: Floats
    torques: Floats
    hub_forces: Floats | None

    edge_taken_off: ClassVar[bool] = True
    """Whether `response` lacks the part of the straight edge, which the contact then adds in closed form."""

    @property
    def resolution(self) -> float:
        """Least width of a cell of contact that the response can tell from its neighbour (mm)."""
        return 0.0

    @property
    def neighbours(self) -> int:
        """Teeth in full on each side of the loaded one."""
        return len(self.displacements) // 2

    def _regular(self) -> Floats:
        """R(x, y): normal displacement of tooth 0 at x by a load at y, less that of a straight edge at that arc distance."""
        flank = self.flank
        smooth = self._normal(0)
        points = self.ring.sector.mesh.points[flank.nodes]
        inward = flank.inward(flank.lengths)
        for column, load in enumerate(self.loads):
            at = flank.points(load)
            distance = np.abs(flank.arc(flank.lengths) - flank.arc(load))
            apart = distance > 1e-9
            singular = (flamant_displacement(points, at, flank.inward(load), self.elasticity) * inward).sum(-1)
            edge = edge_displacement(np.where(apart, distance, 1.0), self.elasticity)
            smooth[:, column] += np.where(apart, singular - edge, 0.0)
        return smooth

    @cached_property
    def between_loads(self) -> CubicSpline:
        """Parts (m,) of the unit loads' responses in that to a load between theirs, by its roll length (mm)."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.loads, np.eye(len(self.loads)))

    @property
    def hub_radius(self) -> float:
        """Radius at which the body is held (mm)."""
        mesh = self.ring.sector.mesh
        return float(np.hypot(*mesh.points[mesh.sides[OutlineSide.HELD][0]]))

    @property
    def nodes(self) -> int:
        """Number of nodes in the mesh of one tooth sector."""
        return len(self.ring.sector.mesh.points)

    @property
    def mesh_document(self) -> JsonObject:
        """Size and quality of the mesh of one tooth sector, as documents have it."""
        mesh = self.ring.sector.mesh
        return {"nodes": self.nodes, **asdict(mesh_quality(mesh.points, mesh.triangles))}

    def hub_torque(self, length: float) -> float:
        """Return the torque on the hub (N mm per mm of width) by a load of 1 N per mm at a roll length (mm)."""
        return -float(np.interp(length, self.loads, self.torques))

    def response(self, tooth: int) -> Compliance:
        """Return the normal displacement of a flank by a load on tooth 0: the regular part of tooth 0, all of it of another
        tooth.

        Teeth are counted counter-clockwise.
        """

        def compliance(x: Floats, y: Floats) -> Floats:
            result: Floats = self.by_unit_loads(x)[:, tooth + self.neighbours] @ self.parts_of_loads(y).T
            return result

        return compliance

    def by_unit_loads(self, lengths: Floats) -> Floats:
        """Responses (n, teeth in full, m) at roll lengths (n,) of each tooth to the unit loads on tooth 0."""
        result: Floats = _within(self._over_flank, self._spread(lengths)).reshape(len(lengths), -1, len(self.loads))
        return result

    def along_by_unit_loads(self, lengths: Floats) -> Floats:
        """Displacements (n, teeth in full, m) towards the tip at roll lengths (n,) of each tooth, by unit loads on tooth 0.

        Of tooth 0 they lack those of a straight edge, (1 - nu')/(2 E') towards the load on both of its sides.
        """
        result: Floats = _within(self._along_flank, self._spread(lengths)).reshape(len(lengths), -1, len(self.loads))
        return result

    @cached_property
    def _along_flank(self) -> CubicSpline:
        from scipy.interpolate import CubicSpline

        flank, lengths = self.flank, self.flank.lengths
        towards_tip, values = flank.towards_tip(lengths), []
        for tooth, moved in enumerate(self.displacements, -self.neighbours):
            slid = moved[2 * flank.nodes] * towards_tip[:, :1] + moved[2 * flank.nodes + 1] * towards_tip[:, 1:]
            values.append(slid if tooth or not self.edge_taken_off else slid + self._bent_along(towards_tip))
        rows = lengths <= self._last
        return CubicSpline(self._spread(lengths[rows]), np.hstack(values)[rows])

    def _bent_along(self, towards_tip: Floats) -> Floats:
        """Displacements (nodes, m) towards the tip by the fields that were taken off, less those of a straight edge."""
        flank, points = self.flank, self.flank.points(self.flank.lengths)
        straight = -(1 - self.elasticity.ratio) / (2 * self.elasticity.modulus)
        found = np.zeros((len(points), len(self.loads)))
        for column, load in enumerate(self.loads):
            field = flamant_displacement(points, flank.points(load), flank.inward(load), self.elasticity)
            away = flank.arc(flank.lengths) - flank.arc(load)
            found[:, column] = np.where(np.abs(away) > 1e-9, (field * towards_tip).sum(-1) - straight * np.sign(away), 0.0)
        return found

    def parts_of_loads(self, lengths: Floats) -> Floats:
        """Return the parts (n, m) of the responses to the unit loads (m,) in the responses to loads at roll lengths (n,)."""
        return _within(self._over_loads, self._spread(lengths))

    @cached_property
    def _over_flank(self) -> CubicSpline:
        """Responses (teeth times m) of all teeth in full, in order, by the place on the flank."""
        from scipy.interpolate import CubicSpline

        teeth = range(-self.neighbours, self.neighbours + 1)
        values = np.hstack([self._normal(tooth) if tooth else self._regular() for tooth in teeth])
        lengths = self.flank.lengths
        rows = lengths <= self._last
        return CubicSpline(self._spread(lengths[rows]), values[rows])

    @cached_property
    def _over_loads(self) -> CubicSpline:
        from scipy.interpolate import CubicSpline

        return CubicSpline(self._spread(self.loads), np.eye(len(self.loads)))

    def _normal(self, tooth: int) -> Floats:
        nodes, inward = self.flank.nodes, self.flank.inward(self.flank.lengths)
        moved = self.displacements[self.neighbours + tooth]
        result: Floats = moved[2 * nodes] * inward[:, :1] + moved[2 * nodes + 1] * inward[:, 1:]
        return result

    @cached_property
    def _corner(self) -> float:
        """Length of the last edge before the tip corner (mm of arc): the scale below which nothing is resolved."""
        arc = self.flank.arc(self.flank.lengths)
        return float(arc[-1] - arc[-3])

    @cached_property
    def _last(self) -> float:
        """Roll length (mm) above which the mesh resolves nothing: half an edge before the tip corner."""
        arc = self.flank.arc(self.flank.lengths)
        return self.flank.length_at(float(arc[-1]) - self._corner / 2)

    def _spread(self, lengths: Floats) -> Floats:
        """-ln(arc distance to the tip + the last edge) at roll lengths: near the corner the field varies like that."""
        end = float(self.flank.arc(self.flank.lengths[-1]))
        return -np.log(np.maximum(end - self.flank.arc(np.minimum(lengths, self._last)), 0) + self._corner)


def _within(spline: CubicSpline, at: Floats) -> Floats:
    """Return the values at places, beyond the ends those of the ends."""
    result: Floats = spline(np.clip(at, spline.x[0], spline.x[-1]))
    return result


def flank_compliance(gear: Gear, ring: Ring, elasticity: PlaneElasticity) -> PlaneCompliance:
    """Solve the body for unit loads at about 24 places of the flank, graded towards the tip."""
    return solved_flank(flank_of(gear, ring.sector.mesh), ring, elasticity)


def solved_flank(flank: SectionFlank, ring: Ring, elasticity: PlaneElasticity) -> PlaneCompliance:
    """Solve the body for unit loads at about 24 places of its flank, graded towards the tip."""
    loads = _load_places(flank)
    forces, singular = _unit_forces(flank, ring, elasticity, flank.points(loads), flank.inward(loads))
    displacements, torques = ring.solve(forces)
    displacements[len(displacements) // 2] -= singular
    hub_forces = ring.hub_forces(forces) if ring.support.floats else None
    return PlaneCompliance(flank, ring, elasticity, loads, displacements, singular, torques, hub_forces)


def _unit_forces(
    flank: SectionFlank, ring: Ring, elasticity: PlaneElasticity, points: Floats, directions: Floats, middle: float = 0.0
) -> tuple[Floats, Floats]:
    """Nodal forces (2 n, m) of 1 N per mm at points (m, 2) along unit vectors, and the fields (2 n, m) to be taken off.

    `middle` (rad) is that of `flamant_displacement`.
    """
    mesh = ring.sector.mesh
    near = flank.near_elements(mesh)
    nodes = np.unique(mesh.triangles[near])
    singular = np.zeros((2 * len(mesh.points), len(points)))
    for column, (at, into) in enumerate(zip(points, directions, strict=True)):
        moved = flamant_displacement(mesh.points[nodes], at, into, elasticity, middle)
        singular[2 * nodes, column], singular[2 * nodes + 1, column] = moved.T
    forces = -_traction_forces(mesh, _boundary_edges(mesh.triangles[near]), points, directions)
    forces += element_forces(mesh.triangles[near], ring.sector.stiffness[near], singular)
    return forces, singular


def _load_places(flank: SectionFlank) -> Floats:
    """Return the roll lengths of vertices of the flank: 3 % of its length apart, closer by and by towards the tip corner.

    An undercut flank ends in a corner at the root as well, where no load can be taken off as one on a straight edge.
    """
    arc = flank.arc(flank.lengths[::2])
    to_tip = arc[-1] - arc
    first, last = int(flank.sharp_root), len(arc) - 2
    chosen = [last]
    for place in range(last - 1, first - 1, -1):
        before = to_tip[chosen[-1]]
        if place == first or to_tip[place] - before >= min(0.15 * before, 0.03 * to_tip[0]):
            chosen.append(place)
    places: Floats = flank.lengths[::2][chosen[::-1]]
    return places


def near_elements(gear: Gear, mesh: SectorMesh) -> Wholes:
    """Return the elements of the tooth and a module of the body below it: where Flamant's field is taken off."""
    centre = mesh.points[mesh.triangles[:, :3]].mean(axis=1)
    radius, root = np.hypot(*centre.T), gear.profile.root_diameter / 2
    if gear.internal:
        return np.flatnonzero(radius < root + gear.normal_module)
    return np.flatnonzero(radius > root - gear.normal_module)


def _boundary_edges(triangles: Wholes) -> Wholes:
    """Return the edges (n, 3) - end, end, middle - that belong to one of the triangles only, counter-clockwise."""
    edges = triangles[:, [[0, 1, 3], [1, 2, 4], [2, 0, 5]]].reshape(-1, 3)
    _, index, times = np.unique(edges[:, 2], return_index=True, return_counts=True)
    once: Wholes = edges[index[times == 1]]
    return once


def _traction_forces(mesh: SectorMesh, edges: Wholes, loads_at: Floats, inward: Floats) -> Floats:
    """Return the nodal forces (2 n, m) of the tractions of Flamant's fields on the edges,
    each by the load at a point (m, 2).
    """
    places, weight = quadrature("line3", _ALONG)
    shape, slope = (
        np.ascontiguousarray(each.T) for each in (shape_values("line3", places), shape_slopes("line3", places)[:, 0])
    )
    points = np.einsum("aq,eac->eqc", shape, mesh.points[edges])
    along = np.einsum("aq,eac->eqc", slope, mesh.points[edges])
    normals = np.stack([along[..., 1], -along[..., 0]], -1)  # outward, times the length per unit of s
    forces = np.zeros((len(mesh.points), 2, len(loads_at)))
    for column, (at, into) in enumerate(zip(loads_at, inward, strict=True)):
        nodal = np.einsum("aq,eqc->eac", shape * weight, flamant_traction(points, normals, at, into))
        np.add.at(forces[..., column], edges, nodal)
    return forces.reshape(-1, len(loads_at))


class ToothLoad(NamedTuple):
    """Tooth, roll length (mm) and force (N per mm of width); of a tip edge lever arm over the base radius, and tilt (rad).

    `friction` is the force along the flank towards its tip, over the normal force.
    """

    tooth: int
    length: float
    force: float
    arm: float = 1.0
    tilt: float = 0.0
    friction: float = 0.0


@dataclass(frozen=True)
class Fillets:
    """The fillet under the loaded flank (tension) and the one behind it (compression), as responses of one body.

    Of a rim that bends, the roots of all teeth and the bore too.
    """

    body: PlaneCompliance

    def stresses(self, side: OutlineSide, loads: list[ToothLoad]) -> Floats:
        """Return the stress (MPa) at the points of a side of tooth 0."""
        total = np.zeros(len(self.places(side)[0]))
        for load in loads:
            # A load on tooth j is seen from tooth 0 as the load on tooth 0 is from tooth -j.
            if (place := self._place(side, -load.tooth)) is not None:
                total += self._splines[side][place](np.asarray(load.length)) * load.force
                if load.tilt:
                    total += self._down_the_tip[side][place] * (load.tilt * load.force)
                if load.friction:
                    total += self._by_friction[0][side][place](np.asarray(load.length)) * (load.friction * load.force)
        return total

    def friction_torque(self, length: float) -> float:
        """Return the torque on the hub (N mm per mm of width) by 1 N per mm towards the tip at a roll length (mm)."""
        return -float(np.interp(length, self.body.loads, self._by_friction[1]))

    def greatest(self, side: OutlineSide, loads: list[ToothLoad]) -> RootStress:
        """Return the largest tension on the left fillet, or compression on the right one, of tooth 0."""
        return self._at_root(side, self.stresses(side, loads), 1 if side is OutlineSide.LEFT_FILLET else -1)

    def extreme(self, side: OutlineSide, loads: list[ToothLoad]) -> RootStress:
        """Return the largest tension (left fillet) or compression (right one) of the loaded teeth.

        Of a rim that bends: of the roots of all teeth, on both sides.
        """
        sign = 1 if side is OutlineSide.LEFT_FILLET else -1
        if self.body.ring.support.bends:
            found = [self._at_root(each, stress, sign) for each in _ROOT for stress in self._all_round(each, loads, sign)]
        else:
            found = [self.greatest(side, seen_from(load.tooth, loads)) for load in loads]
        return max(found, key=lambda stress: sign * stress.stress)

    def bore_tension(self, loads: list[ToothLoad]) -> float | None:
        """Return the largest tension (MPa) on the surface of a bore that nothing keeps round."""
        if not self.body.ring.support.bends:
            return None
        return float(max(stress.max() for stress in self._all_round(OutlineSide.HELD, loads, 1)))

    def _all_round(self, side: OutlineSide, loads: list[ToothLoad], sign: int) -> Iterator[Floats]:
        """Yield the stresses of every tooth of the gear, with the key where it adds most tension (1) or compression (-1)."""
        arms = (load.arm + load.friction * abs(load.length) / self.body.flank.lever for load in loads)
        torque = self.body.flank.lever * sum(load.force * arm for load, arm in zip(loads, arms, strict=True))
        by_key = torque * sign * (sign * self._by_key(side)).max(axis=0)
        for own in range(self.body.ring.support.teeth):
            yield self.stresses(side, seen_from(own, loads)) + by_key

    def _at_root(self, side: OutlineSide, stresses: Floats, sign: int) -> RootStress:
        radii, angles = self.places(side)
        root = np.flatnonzero(angles >= LEAST_TANGENT_ANGLE)
        at = root[np.argmax(sign * stresses[root])]
        return RootStress(float(stresses[at]), float(radii[at]), float(angles[at]))

    def places(self, side: OutlineSide) -> tuple[Floats, Floats]:
        """Return the radius (mm) and tangent angle (deg) of each point."""
        return self._geometry[side][:2]

    @cached_property
    def _sides(self) -> tuple[OutlineSide, ...]:
        return (
            (*_ROOT, OutlineSide.HELD) if self.body.ring.support.bends else (OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FILLET)
        )

    @cached_property
    def _geometry(self) -> dict[OutlineSide, tuple[Floats, Floats, SurfaceStresses]]:
        """Radius and tangent angle of the points of each side, and their stresses by displacements."""
        mesh, modulus = self.body.ring.sector.mesh, self.body.elasticity.modulus
        found = {side: surface_rows(mesh, side, modulus) for side in self._sides}
        return found

    def _place(self, side: OutlineSide, tooth: int) -> int | None:
        """Return the place of a tooth among the responses of a side to loads on tooth 0; None if they are unknown."""
        support = self.body.ring.support
        place = (tooth + self.body.neighbours) % support.teeth if support.bends else tooth + self.body.neighbours
        return place if 0 <= place < len(self._splines[side]) else None

    @cached_property
    def _splines(self) -> dict[OutlineSide, tuple[CubicSpline, ...]]:
        """Stresses (points,) of each side by the roll length of the load, from tooth -neighbours on."""
        from scipy.interpolate import CubicSpline

        loads = self.body.loads
        return {side: tuple(CubicSpline(loads, each.T) for each in teeth) for side, teeth in self._responses.items()}

    @cached_property
    def _responses(self) -> dict[OutlineSide, Floats]:
        """Stresses (teeth, points, loads) by the unit loads, from tooth -neighbours on."""
        body, moved = self.body, self.body.displacements.copy()
        moved[body.neighbours] += body.singular
        return self._stresses(moved, body.hub_forces)

    @cached_property
    def _down_the_tip(self) -> dict[OutlineSide, Floats]:
        """Stresses (teeth, points) by 1 N per mm along the flank of tooth 0, beside its tip and towards the root."""
        body, flank = self.body, self.body.flank
        last = body.loads[-1:]
        forces, _ = _unit_forces(flank, body.ring, body.elasticity, flank.points(last), -flank.towards_tip(last))
        hub_forces = body.ring.hub_forces(forces) if body.ring.support.floats else None
        found = self._stresses(body.ring.solve(forces)[0], hub_forces)
        return {side: stresses[..., 0] for side, stresses in found.items()}

    @cached_property
    def _by_friction(self) -> tuple[dict[OutlineSide, tuple[CubicSpline, ...]], Floats]:
        """Stresses (points,) by 1 N per mm along the flank towards its tip, as `_splines`, and torques (m,) on the hub."""
        from scipy.interpolate import CubicSpline

        body, flank, loads = self.body, self.body.flank, self.body.loads
        middle = -flank.upward * np.pi / 2
        towards_tip = flank.towards_tip(loads)
        forces, _ = _unit_forces(flank, body.ring, body.elasticity, flank.points(loads), towards_tip, middle)
        hub_forces = body.ring.hub_forces(forces) if body.ring.support.floats else None
        moved, torques = body.ring.solve(forces)
        found = self._stresses(moved, hub_forces)
        return {side: tuple(CubicSpline(loads, each.T) for each in teeth) for side, teeth in found.items()}, torques

    def _by_key(self, side: OutlineSide) -> Floats:
        """Return the stresses (teeth, points) of a side by a torque of 1 (N mm per mm) from the key,
        less that from all round.
        """
        ring = self.body.ring
        if ring.support.hold is not Hold.KEY:
            return np.zeros((1, 1))
        return self._keyed[side][..., 0]

    @cached_property
    def _keyed(self) -> dict[OutlineSide, Floats]:
        ring = self.body.ring
        load = key_load(ring.sector.mesh, ring.support)
        return self._stresses(ring.solve(load)[0], ring.hub_forces(load))

    def _stresses(self, moved: Floats, hub_forces: Floats | None) -> dict[OutlineSide, Floats]:
        """Return the stresses (teeth, points, m) of each side by displacements (teeth in full, 2 n, m)."""
        rows = SurfaceStresses(
            *(np.concatenate(of) for of in zip(*(self._geometry[side][2] for side in self._sides), strict=True))
        )
        found = [rows.by(each) for each in moved]
        if hub_forces is not None and self.body.ring.support.bends:
            found += far_responses(self.body.ring, rows, moved, hub_forces)
        ends = np.cumsum([len(self.places(side)[0]) for side in self._sides])
        return dict(zip(self._sides, np.split(np.stack(found), ends[:-1], axis=1), strict=True))


def surface_rows(mesh: SectorMesh, side: OutlineSide, modulus: float) -> tuple[Floats, Floats, SurfaceStresses]:
    """Return the radius (mm) and tangent angle (deg) of places (n,) on a side of a mesh, and their stresses by displacements.

    Of a rack it is the height over its reference line (mm) instead of the radius.

    `modulus` (MPa) is that of the plane state. The places are those where quadratic elements have the most accurate strains.
    """
    places = quadrature("line3", _AT_STRAINS).places
    shape, slope = shape_values("line3", places), shape_slopes("line3", places)[:, 0]
    edges = edges_of_chain(mesh.sides[side])
    where = np.einsum("qa,eac->eqc", shape, mesh.points[edges]).reshape(-1, 2)
    along = np.einsum("qa,eac->eqc", slope, mesh.points[edges]).reshape(-1, 2)
    angle = np.degrees(np.arctan2(along[:, 1], np.abs(along[:, 0])))
    strain = np.tile(slope, (len(edges), 1))[:, :, None] * (along / (along**2).sum(-1, keepdims=True))[:, None]
    dofs = node_dofs(np.repeat(edges, len(slope), axis=0))
    radius = where[:, 0] if mesh.straight else np.hypot(*where.T)
    return radius, angle, SurfaceStresses(dofs, strain.reshape(len(where), -1) * modulus)


def seen_from(own: int, loads: list[ToothLoad]) -> list[ToothLoad]:
    """Return the loads with tooth numbers counted from the tooth `own`."""
    return [load._replace(tooth=load.tooth - own) for load in loads]


_ROOT = (OutlineSide.LEFT_FILLET, OutlineSide.LEFT_ROOT, OutlineSide.RIGHT_ROOT, OutlineSide.RIGHT_FILLET)

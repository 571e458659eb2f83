"""Contact of a spline joint in the plane: all teeth of shaft and hub, through the play, centred or under a radial force.

Shaft and hub are rings of equal tooth sectors, so their responses follow from one sector by a Fourier sum round the axis: tooth
k answers tooth 0 by C_k = sum over n of (W + P_n^H S_n^-1 P_n) exp(2 pi i n k/z)/z, where W is the answer of a sector with held
cuts, P_n the loads that arrive at its cuts, and S_n the stiffness of the cuts for the phase 2 pi n/z between sectors.
Flanks of a joint are the same involute, so pressure spreads over all of their common height, in cells of constant pressure.
Everything is per mm of length.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.contact.plane.flank import surface_rows
from gearcad.contact.plane.sector import Plane, PlaneElasticity, Sector, make_sector, node_dofs
from gearcad.contact.shared.bodies import Support
from gearcad.core.errors import GeometryError, SolverError
from gearcad.core.records import Bools, Floats, Wholes
from gearcad.geometry.spline import SplineJoint
from gearcad.geometry.spline_part import Spline
from gearcad.geometry.spline_standards import HUB, SHAFT
from gearcad.material import Material
from gearcad.meshing.fem import quadrature, shape_slopes, shape_values
from gearcad.meshing.outline import MeshSizes, OutlineSide, edge_lengths, held_radius
from gearcad.meshing.quads import edges_of_chain
from gearcad.meshing.sector import mesh_sector

CELLS, _MOST_CELLS, _FEWEST_CELLS = 12, 6000, 4
"""Cells of a flank, the most of a joint, and the fewest of a flank where teeth are many."""

Waves = NDArray[np.complex128]
"""Amplitudes of waves round the axis."""

_PARTS = 12
"""Parts of an edge for the loads of a cell that ends inside it."""

_SIZES = MeshSizes(flank=0.07, corner=0.02, fillet=0.02)
"""Edge lengths in modules: even along the flanks, for contact is all over them."""

_ROUNDS = 200
"""Changes of the set of cells that press."""

_SIDES = (OutlineSide.LEFT_FLANK, OutlineSide.RIGHT_FLANK)
_FILLETS = (OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FILLET)


@dataclass(frozen=True)
class FlankCells:
    """Cells of equal arc length `width` (mm) on the flanks that shaft and hub have in common, from the shaft's root outwards.

    `ends` (n + 1,) are arc lengths (mm) along the involute from the base circle, of base radius `base_radius` (mm).
    """

    base_radius: float
    ends: Floats

    @property
    def width(self) -> float:
        """Arc length of a cell (mm)."""
        return float(self.ends[1] - self.ends[0])

    @property
    def count(self) -> int:
        """Number of cells of a flank."""
        return len(self.ends) - 1

    @classmethod
    def of(cls, joint: SplineJoint, count: int) -> FlankCells:
        """Return so many cells where the involutes of both parts are. Raises GeometryError where there is none."""
        shaft, hub = joint.parts[SHAFT], joint.parts[HUB]
        low = max(shaft.form_diameter, hub.tip_diameter) / 2
        high = min(hub.form_diameter, shaft.tip_diameter) / 2
        base = joint.base_diameter / 2
        if high <= max(low, base):
            raise GeometryError("nominal_diameter", joint.nominal_diameter, "must leave flanks that face each other", "mm")
        first, last = ((radius**2 - base**2) / (2 * base) for radius in (max(low, base), high))
        return cls(base, np.linspace(first, last, count + 1))

    def cell_of(self, radius: Floats) -> Floats:
        """Return the cells (n,) at radii (n,); -1 for places beside all of them."""
        arc = np.maximum(radius**2 - self.base_radius**2, 0.0) / (2 * self.base_radius)
        place = np.floor((arc - self.ends[0]) / self.width).astype(int)
        return np.where((arc >= self.ends[0]) & (arc <= self.ends[-1]), np.minimum(place, self.count - 1), -1)


@dataclass(frozen=True)
class SplineBody:
    """One part of a joint: its sector, and the nodal forces (dofs, 2 n) by unit pressure on the cells of both flanks."""

    part: Spline
    sector: Sector
    elasticity: PlaneElasticity
    loads: Floats

    @property
    def teeth(self) -> int:
        """Number of teeth."""
        return self.part.joint.count

    @cached_property
    def _cut_places(self) -> tuple[Wholes, int]:
        cuts = np.r_[self.sector.behind, self.sector.ahead]
        places: Wholes = np.searchsorted(self.sector.condensed.kept, cuts).astype(int)
        return places, len(self.sector.behind)

    @cached_property
    def _phases(self) -> Floats:
        """Phases (z,) of the harmonics (rad)."""
        return 2 * np.pi * np.arange(self.teeth) / self.teeth

    @cached_property
    def _stiffness(self) -> Waves:
        """Stiffness (z, c, c) of the cuts, one for each harmonic."""
        places, count = self._cut_places
        matrix = self.sector.cut_matrix[np.ix_(places, places)]
        here, ahead = matrix[:count, :count] + matrix[count:, count:], matrix[:count, count:]
        turn = np.exp(1j * self._phases)[:, None, None]
        result: Waves = here + ahead * turn + ahead.T * turn.conj()
        return result

    def _arriving(self, at_cuts: Floats) -> Waves:
        """Loads (z, c, m) of each harmonic by loads (kept, m) that arrive at the cuts of a sector."""
        places, count = self._cut_places
        polar = self.sector.at_cuts.polar(at_cuts)[places]
        result: Waves = polar[:count] + np.exp(-1j * self._phases)[:, None, None] * polar[count:]
        return result

    @cached_property
    def responses(self) -> Floats:
        """Mean displacement times width (z, 2 n, 2 n) of the cells of tooth k by unit pressure on those of 0 (mm²/MPa)."""
        arrived = self.sector.condensed.forward(self.loads)
        loads = self._arriving(arrived.loads)
        moved = np.linalg.solve(self._stiffness, loads)
        by_harmonic = np.einsum("zcm,zcn->zmn", loads.conj(), moved) + arrived.work
        found: Floats = np.fft.ifft(by_harmonic, axis=0).real
        return found

    def displacements(self, pressures: Floats) -> Floats:
        """Return the displacements (2 nodes, z) of all sectors by pressures (z, 2 n) on their cells."""
        loads = self.loads @ pressures.T
        arrived = self.sector.condensed.forward(loads)
        places, count = self._cut_places
        polar = self.sector.at_cuts.polar(arrived.loads)[places]
        spectrum = np.fft.fft(polar, axis=1).T  # harmonic n of load columns t
        right = spectrum[:, :count] + np.exp(-1j * self._phases)[:, None] * spectrum[:, count:]
        behind = np.fft.ifft(np.linalg.solve(self._stiffness, right[..., None])[..., 0], axis=0).real.T
        at_cuts = np.zeros((len(self.sector.condensed.kept), self.teeth))
        at_cuts[places[:count]], at_cuts[places[count:]] = behind, np.roll(behind, -1, axis=1)
        return self.sector.condensed.backward(self.sector.at_cuts.plain(at_cuts), arrived)

    def root_stresses(self, pressures: Floats) -> Floats:
        """Return the greatest tension (z,) in MPa along both fillets of every tooth."""
        moved, mesh = self.displacements(pressures), self.sector.mesh
        found = [surface_rows(mesh, side, self.elasticity.modulus)[2].by(moved) for side in _FILLETS]
        greatest: Floats = np.concatenate(found).max(axis=0)
        return greatest


def spline_body(part: Spline, cells: FlankCells, material: Material, plane: Plane, refinement: float = 1.0) -> SplineBody:
    """Mesh a part whose size is that of its solid, held where its rim or bore is, and load its cells.

    Raises GeometryError and SolverError.
    """
    gear, sizes = part.gear, _SIZES.refined(refinement)
    lengths = edge_lengths(gear, sizes, loaded=True)
    mesh = mesh_sector(gear, held_radius(gear), sizes, lengths, lengths)
    elasticity = PlaneElasticity(material, plane)
    sector = make_sector(mesh, elasticity, Support(teeth=gear.tooth_count))
    loads = np.zeros((sector.dofs, 2 * cells.count))
    places, weights = quadrature("line3", 5)
    s = (np.arange(_PARTS)[:, None] + places[:, 0]).reshape(-1, 1) / _PARTS
    shape, slope = shape_values("line3", s), shape_slopes("line3", s)[:, 0]
    for number, side in enumerate(_SIDES):
        edges = edges_of_chain(mesh.sides[side])
        points = np.einsum("qa,eac->eqc", shape, mesh.points[edges])
        along = np.hypot(*np.moveaxis(np.einsum("qa,eac->eqc", slope, mesh.points[edges]), -1, 0))
        radius, angle = np.hypot(*np.moveaxis(points, -1, 0)), np.arctan2(points[..., 1], points[..., 0])
        inward = -outward_normals(cells.base_radius, radius, angle, left=side is _SIDES[0], hub=part.is_hub)
        cell = cells.cell_of(radius)
        weight = along * np.tile(weights / _PARTS, _PARTS)
        forces = np.einsum("qa,eq,eqc->eqac", shape, weight, inward)
        for each in range(cells.count):
            own = np.where((cell == each)[..., None, None], forces, 0.0).sum(axis=1)
            column = number * cells.count + each
            np.add.at(loads[:, column], node_dofs(edges), own.reshape(len(edges), -1))
    arms = _torques(mesh.points, loads)
    return SplineBody(part, sector, elasticity, loads * (cells.base_radius * cells.width / np.abs(arms)))


def _torques(points: Floats, loads: Floats) -> Floats:
    """Return the torques (m,) of nodal forces (2 n, m) about the axis."""
    x, y = points.T
    result: Floats = x @ loads[1::2][: len(points)] - y @ loads[::2][: len(points)]
    return result


def outward_normals(base_radius: float, radius: Floats, angle: Floats, *, left: bool, hub: bool) -> Floats:
    """Return the unit normals (..., 2) out of the material of a flank at polar coordinates; they touch the base circle."""
    cosine = base_radius / radius
    sine = np.sqrt(np.maximum(1 - cosine**2, 0.0)) * (-1 if hub else 1)
    around = cosine * (1 if left else -1)
    return np.stack([sine * np.cos(angle) - around * np.sin(angle), sine * np.sin(angle) + around * np.cos(angle)], axis=-1)


@dataclass(frozen=True)
class SplineContact:
    """Pressures (z, 2 n) in MPa on the cells of the shaft's left flanks and right ones, tooth by tooth.

    `turn` (rad) and `shift` (2,) in mm are the motion of the shaft from the middle of the play; `overlap` (mm) is the worst
    penetration that is left.
    """

    cells: FlankCells
    bodies: tuple[SplineBody, SplineBody]
    pressures: Floats
    turn: float
    shift: Floats
    overlap: float

    @property
    def forces(self) -> Floats:
        """Normal force (z, 2) on the left and right flank of each tooth of the shaft (N per mm)."""
        sides = self.pressures.reshape(len(self.pressures), 2, -1)
        result: Floats = sides.sum(axis=2) * self.cells.width
        return result

    @property
    def torques(self) -> Floats:
        """Torque (z,) of each tooth about the axis (N mm per mm of length)."""
        left, right = self.forces.T
        result: Floats = self.cells.base_radius * (left - right)
        return result

    @property
    def shares(self) -> Floats:
        """Share (z,) of each tooth in the sum of all normal forces."""
        every = self.forces.sum(axis=1)
        return np.asarray(every / every.sum(), float)

    @property
    def mean_pressures(self) -> Floats:
        """Mean pressure (z, 2) over the height of each flank (MPa)."""
        result: Floats = self.pressures.reshape(len(self.pressures), 2, -1).mean(axis=2)
        return result

    @cached_property
    def root_stresses(self) -> tuple[Floats, Floats]:
        """Greatest tension (z,) at the root of every tooth of the shaft and of the hub (MPa)."""
        shaft, hub = self.bodies
        return shaft.root_stresses(self.pressures), hub.root_stresses(of_hub(self.pressures))


def of_hub(values: Floats) -> Floats:
    """Return values (z, 2 n) of the shaft's left and right flanks as (z, 2 n) of the hub's left and right ones.

    Tooth t of the hub lies between teeth t and t + 1 of the shaft: its right flank faces the left one of t, its left flank the
    right one of t + 1.
    """
    count = values.shape[1] // 2
    return np.concatenate([np.roll(values[:, count:], -1, axis=0), values[:, :count]], axis=1)


def joint_contact(
    joint: SplineJoint,
    torque: float,
    materials: tuple[Material, Material],
    *,
    play: float,
    radial_force: float = 0.0,
    plane: Plane = Plane.STRAIN,
    cells: int = CELLS,
    refinement: float = 1.0,
) -> SplineContact:
    """Return the contact of a shaft and its hub under a torque (N mm per mm) and a force along x on the shaft (N per mm).

    `play` (mm, on the reference circle) is that between the flanks; without a radial force the parts are centred. Raises
    GeometryError, and SolverError where the contact does not settle.
    """
    teeth = joint.count
    count = max(min(cells, _MOST_CELLS // (2 * teeth)), _FEWEST_CELLS)
    common = FlankCells.of(joint, count)
    shaft, hub = (
        spline_body(joint.parts[part], common, material, plane, refinement)
        for part, material in zip((SHAFT, HUB), materials, strict=True)
    )
    matrix = _full(shaft.responses) + _as_of_shaft(_full(hub.responses), teeth, count)
    width = np.full(2 * count * teeth, common.width)
    gap = play / 2 * math.cos(math.radians(joint.pressure_angle)) * width
    motions, loads = _motions(joint, common), np.array([torque, radial_force, 0.0])
    if not radial_force:
        motions, loads = motions[:1], loads[:1]
    pressure, moved, overlap = _pressed((matrix + matrix.T) / 2, gap, motions, loads, width)
    shift = moved[1:] if radial_force else np.zeros(2)
    return SplineContact(common, (shaft, hub), pressure.reshape(teeth, -1), float(moved[0]), shift, overlap)


def _full(responses: Floats) -> Floats:
    """Return the matrix (z m, z m) of all teeth from the responses (z, m, m) of each to tooth 0."""
    teeth, m, _ = responses.shape
    apart = (np.arange(teeth)[:, None] - np.arange(teeth)) % teeth
    result: Floats = responses[apart].transpose(0, 2, 1, 3).reshape(teeth * m, teeth * m)
    return result


def _as_of_shaft(matrix: Floats, teeth: int, count: int) -> Floats:
    """Return the matrix of the hub's cells in the order of the cells of the shaft that face them."""
    numbers = np.arange(2 * count * teeth).reshape(teeth, 2 * count)
    order = np.empty_like(numbers)
    order[:, :count] = numbers[:, count:]
    order[:, count:] = np.roll(numbers[:, :count], 1, axis=0)
    flat = order.ravel()
    return matrix[np.ix_(flat, flat)]


def _motions(joint: SplineJoint, cells: FlankCells) -> Floats:
    """Approach times width (3, 2 n z) of all cells by a turn of the shaft by 1 rad and by shifts of 1 mm along x and y."""
    gear = joint.parts[SHAFT].gear
    places, weights = quadrature("line3", 9)
    arc = cells.ends[:-1, None] + cells.width * places[:, 0]
    radius = np.sqrt(cells.base_radius**2 + 2 * cells.base_radius * arc)
    half = gear.profile.involute.half_angle(radius)
    turns = 2 * math.pi * np.arange(joint.count) / joint.count
    found = []
    for left in (True, False):
        angle = (half if left else -half) + turns[:, None, None]
        normals = outward_normals(cells.base_radius, np.broadcast_to(radius, angle.shape), angle, left=left, hub=False)
        mean = np.einsum("tnqc,q->tnc", normals, weights) * cells.width
        arm = np.full(mean.shape[:2], cells.base_radius * cells.width * (1 if left else -1))
        found.append(np.concatenate([arm[..., None], mean], axis=-1))
    return np.concatenate(found, axis=1).reshape(-1, 3).T


def _pressed(matrix: Floats, gap: Floats, motions: Floats, loads: Floats, width: Floats) -> tuple[Floats, Floats, float]:
    """Return pressures p >= 0 with C p + g - A^T q >= 0, complementary, and A p = loads; the motions q; the worst overlap (mm).

    By an active set that begins with the cells that the loads press, and changes all that are wrong at once. Raises
    SolverError.
    """
    active: Bools = loads @ motions / np.abs(motions).max(axis=1).max() > 0
    seen: set[bytes] = set()
    for step in range(_ROUNDS):
        pressure, moved = _equations(matrix, gap, motions, loads, active)
        opening = (matrix @ pressure + gap - moved @ motions) / width
        wrong = np.where(active, pressure <= 0, opening < -_CLOSED)
        if not wrong.any():
            return pressure, moved, float(max(-opening.min(), 0.0))
        key = active.tobytes()
        if key in seen or step > _ROUNDS // 2:  # one cell at a time, the worst first
            scale = np.where(active, -pressure / np.abs(pressure).max(), -opening / np.abs(opening).max())
            only = np.zeros_like(wrong)
            only[np.argmax(np.where(wrong, scale, -np.inf))] = True
            wrong = only
        seen.add(key)
        active = active ^ wrong
    raise SolverError("the contact of the spline did not settle; change the torque, the radial force or the play slightly")


_CLOSED = 1e-12
"""Overlap (mm) that is rounding."""


def _equations(matrix: Floats, gap: Floats, motions: Floats, loads: Floats, active: Bools) -> tuple[Floats, Floats]:
    """Return the pressures of the active cells that carry the loads, and the motions."""
    rows, free = np.flatnonzero(active), len(loads)
    count = len(rows)
    system = np.zeros((count + free, count + free))
    system[:count, :count] = matrix[np.ix_(rows, rows)]
    system[:count, count:], system[count:, :count] = -motions[:, rows].T, -motions[:, rows]
    right = np.concatenate([-gap[rows], -loads])
    solved = np.linalg.solve(system, right)
    pressure = np.zeros(len(gap))
    pressure[rows] = solved[:count]
    return pressure, solved[count:]

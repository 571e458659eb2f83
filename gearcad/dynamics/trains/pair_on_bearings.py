"""A pair of gears on elastic bearings, with six degrees of freedom, and its natural modes.

The pinion's axis is at the origin and the wheel's on +x; both angles count counter-clockwise. The pinion drives with its left
flanks: the force on the wheel points along n = (sin alpha_wt, cos alpha_wt), and the approach of the flanks is y = n
(u_1 - u_2) + r_b1 phi_1 + r_b2 phi_2. The axis of a ring is on -x, and its base radius is negative: it turns with the pinion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from gearcad.core.errors import plain_numbers, require_number
from gearcad.core.records import Bools, Floats, JsonObject, PerGear, freeze
from gearcad.dynamics.trains.shaft_lines import Bearings, System

_SHAKEN = 1e-6
"""Share of its potential energy that the mesh must hold for teeth to shake a mode."""

_MOST = 0.5
"""Share of turning in the kinetic energy, or of the mesh in the potential one, from which on gears turn against each other."""

_BOTH = 0.5
"""Ratio of the kinetic energies of both gears' travel, less to greater, from which both are said to travel."""

_STRAIGHT = 0.8
"""Share of the kinetic energy of a gear's travel in one direction from which the travel is not called oblique."""


@dataclass(frozen=True, eq=False)
class BearingModes:
    """The six natural modes of two gears on bearings, without damping, at the mean stiffness of the mesh, by rising frequency.

    `frequency` (6,) in Hz, `circular` in 1/s; the first is 0: the gears turn as a whole. `shape` (6, 6): of each mode how far
    the pinion travels along the line of action, across it, and turns (as the way at the base circle), then the same of the
    wheel, over the farthest of these; the flanks approach each other where the mesh gives way. `kinetic` (6, 6) are the shares
    of these in the kinetic energy, `potential` (6, 3) those of the mesh and of the bearings of pinion and wheel in the
    potential one: nothing in the first mode.
    """

    frequency: Floats
    circular: Floats
    shape: Floats
    kinetic: Floats
    potential: Floats

    def __post_init__(self) -> None:
        freeze(self)

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def shaken(self) -> Bools:
        """Mask of the modes (6,) that the teeth can excite, because the mesh deflects in them."""
        return np.asarray(self.potential[:, 0] > _SHAKEN, bool)

    @property
    def excited(self) -> Floats:
        """Circular frequencies (6,) in 1/s of the modes that teeth can shake, 0 for the others."""
        return np.where(self.shaken, self.circular, 0.0)

    @property
    def words(self) -> tuple[str, ...]:
        """Words for the greatest motion in each mode."""
        return tuple("both gears turn as a whole" if mode == 0 else self._words(mode) for mode in range(len(self)))

    def to_dict(self) -> JsonObject:
        """Return plain lists, under the names of the fields, and the words."""
        return {**{each.name: getattr(self, each.name).tolist() for each in fields(self)}, "words": list(self.words)}

    def _words(self, mode: int) -> str:
        shares = self.kinetic[mode].reshape(2, 3)
        if max(shares[:, 2].sum(), self.potential[mode, 0]) >= _MOST:
            return "gears turn against each other"
        travels = shares[:, :2]
        most = int(travels.sum(axis=1).argmax())
        ways = travels[most] / travels[most].sum()
        way = "along" if ways[0] > _STRAIGHT else "across" if ways[1] > _STRAIGHT else "obliquely to"
        if travels[1 - most].sum() < _BOTH * travels[most].sum():
            return f"{('pinion', 'wheel')[most]} travels {way} the line of action"
        moved = self.shape[mode].reshape(2, 3)[:, int(ways.argmax())]
        return f"both gears travel {'together' if moved.prod() > 0 else 'against each other'}, {way} the line of action"


def modes_on_bearings(stiffness: Floats, masses: Floats, springs: Floats, radii: tuple[float, float]) -> BearingModes:
    """Return the natural modes of a stiffness matrix (6, 6) in N/m and N·m/rad.

    Its coordinates are the travels along and across the line of action and the turns of both gears. `masses` (6,) in kg and
    kg·m²; `springs` (3, 6, 6) are the parts of the matrix that mesh and bearings have; `radii` (m) are those of the base
    circles.
    """
    root = np.sqrt(masses)
    squares, modes = _apart(stiffness / np.outer(root, root))
    order = np.argsort(squares, kind="stable")
    squares, moved = squares[order], (modes[:, order] / root[:, None]).T
    squares[0] = 0.0  # but for rounding: nothing holds the gears' turning
    way = moved * np.array([1.0, 1.0, radii[0], 1.0, 1.0, radii[1]])
    farthest = way[np.arange(6), np.abs(way).argmax(axis=1)]
    energy = np.einsum("nr,prs,ns->np", moved, springs, moved)
    energy[0] = 0.0
    potential = np.divide(energy, squares[:, None], out=np.zeros_like(energy), where=squares[:, None] > 0)
    omega = np.sqrt(squares)
    shape = way / farthest[:, None] + 0.0  # no -0
    return BearingModes(omega / (2 * np.pi), omega, shape, masses * moved**2, potential)


def _apart(matrix: Floats) -> tuple[Floats, Floats]:
    """Return the eigenvalues and eigenvectors of a matrix, separately for coordinates that are not coupled.

    So equal eigenvalues do not mix their modes.
    """
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components(matrix != 0, directed=False)
    values, vectors = np.zeros(len(matrix)), np.zeros_like(matrix)
    for part in range(count):
        own = np.flatnonzero(label == part)
        values[own], vectors[np.ix_(own, own)] = np.linalg.eigh(matrix[np.ix_(own, own)])
    return values, vectors


@dataclass(frozen=True, kw_only=True)
class PairOnBearings:
    """Masses (kg), inertias (kg·m²), base radii (mm), bearings (N/µm in x and y; damping N·s/m) of pinion and wheel.

    The base radius of a ring is negative.

    `working_transverse_pressure_angle` in degrees, `mesh_stiffness` in N/µm, `mesh_damping` in N·s/m, `torque` on the pinion
    in N·m (the wheel's holds it). Raises ParameterError.
    """

    masses: PerGear[float]
    inertias: PerGear[float]
    base_radii: PerGear[float]
    working_transverse_pressure_angle: float
    mesh_stiffness: float
    bearing_stiffness: PerGear[tuple[float, float]]
    mesh_damping: float = 0.0
    bearing_damping: float = 0.0
    torque: float = 0.0

    def __post_init__(self) -> None:
        for name in ("masses", "inertias", "base_radii", "bearing_stiffness"):
            object.__setattr__(self, name, PerGear(*getattr(self, name)))
        plain_numbers(self)
        for name, unit in (("masses", "kg"), ("inertias", "kg·m²"), ("base_radii", "mm")):
            for value in getattr(self, name):
                require_number(name, abs(value), unit, above=0)
        for value in (each for bearing in self.bearing_stiffness for each in bearing):
            require_number("bearing_stiffness", value, "N/µm", above=0)
        require_number("mesh_stiffness", self.mesh_stiffness, "N/µm", above=0)
        require_number("working_transverse_pressure_angle", self.working_transverse_pressure_angle, "deg", at_least=0, below=90)
        for name in ("mesh_damping", "bearing_damping"):
            require_number(name, getattr(self, name), "N·s/m", at_least=0)
        require_number("torque", self.torque, "N·m")

    def system(self) -> System:
        """Return the System of x_1, y_1, phi_1, x_2, y_2, phi_2, each times the root of its mass or inertia."""
        angle = math.radians(self.working_transverse_pressure_angle)
        first, second = (radius / 1000 for radius in self.base_radii)
        approach = np.array([math.sin(angle), math.cos(angle), first, -math.sin(angle), -math.cos(angle), second])
        masses = np.array(
            [value for mass, turn in zip(self.masses, self.inertias, strict=True) for value in (mass, mass, turn)]
        )
        springs, dampers, turns = np.zeros(6), np.zeros(6), np.zeros((6, 2))
        for gear, (bearing, inertia) in enumerate(zip(self.bearing_stiffness, self.inertias, strict=True)):
            springs[3 * gear : 3 * gear + 2] = [1e6 * each for each in bearing]
            dampers[3 * gear : 3 * gear + 2] = self.bearing_damping
            turns[3 * gear + 2, gear] = 1 / math.sqrt(inertia)
        load = np.zeros(6)
        load[2], load[5] = self.torque, self.torque * second / first
        root = np.sqrt(masses)
        return System(
            squares=springs / masses,
            damping=dampers / masses,
            mesh=(approach / root)[:, None],
            inertias=turns,
            shaft_torques=np.zeros((6, 0)),
            load=load / root,
            stiffness=np.array([1e6 * self.mesh_stiffness]),
            mesh_damping=np.array([self.mesh_damping]),
            names=(("mesh",), ("pinion", "wheel"), ()),
            bearings=self._bearings(),
        )

    def _bearings(self) -> Bearings:
        """Return the bearings along the line of action and across it."""
        sine, cosine = math.sin(angle := math.radians(self.working_transverse_pressure_angle)), math.cos(angle)
        turned = np.array([[sine, cosine], [cosine, -sine]])
        travel, stiffness = np.zeros((6, 4)), np.zeros((4, 4))
        for gear, (mass, bearing) in enumerate(zip(self.masses, self.bearing_stiffness, strict=True)):
            own = slice(2 * gear, 2 * gear + 2)
            travel[3 * gear : 3 * gear + 2, own] = turned.T / math.sqrt(mass)
            stiffness[own, own] = 1e6 * (turned * bearing) @ turned.T
        return Bearings(("pinion", "wheel"), travel, stiffness, self.bearing_damping * np.eye(4))

    def modes(self) -> BearingModes:
        """Return the six natural modes, in travels along the line of action and across it."""
        sine, cosine = math.sin(angle := math.radians(self.working_transverse_pressure_angle)), math.cos(angle)
        first, second = (radius / 1000 for radius in self.base_radii)
        approach = np.array([1.0, 0.0, first, -1.0, 0.0, second])
        springs = np.zeros((3, 6, 6))
        springs[0] = 1e6 * self.mesh_stiffness * np.outer(approach, approach)
        for gear, (x, y) in enumerate(self.bearing_stiffness):
            along, across = 3 * gear, 3 * gear + 1
            # Sums that are exact where both are alike: then nothing couples along and across.
            springs[1 + gear, along, along] = 1e6 * (y + (x - y) * sine**2)
            springs[1 + gear, across, across] = 1e6 * (y + (x - y) * cosine**2)
            springs[1 + gear, along, across] = springs[1 + gear, across, along] = 1e6 * (x - y) * sine * cosine
        masses = [value for mass, turn in zip(self.masses, self.inertias, strict=True) for value in (mass, mass, turn)]
        return modes_on_bearings(springs.sum(axis=0), np.array(masses), springs, (first, second))

    def frequencies(self) -> tuple[float, ...]:
        """Return the six natural frequencies (Hz), lowest first; that of the gears' free turning is 0."""
        squares = np.linalg.eigvalsh(self.system().stiffness_matrix())
        squares[0] = 0.0  # but for rounding: nothing holds the gears' turning
        return tuple((np.sqrt(squares) / (2 * math.pi)).tolist())

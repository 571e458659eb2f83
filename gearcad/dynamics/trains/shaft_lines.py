"""Shaft lines of a train without its meshes, and the System of their modes, on which all solvers work.

Inside the dynamics rooms numbers are in SI units (m, N, kg, s, rad); inputs and results are in the units of the package.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.core.records import Floats, Wholes
from gearcad.dynamics.trains.members import ToothMesh
from gearcad.dynamics.trains.train import Parts, Train, TrainModel, parts_of


@dataclass(frozen=True, eq=False)
class Bearings:
    """Bearings of the axes of g `gears` that travel: `travel` (n, 2g) of each (m), along the line of action and across it.

    `stiffness` (2g, 2g) in N/m and `damping` (2g, 2g) in N·s/m are those of the travels.
    """

    gears: tuple[str, ...]
    travel: Floats
    stiffness: Floats
    damping: Floats


@dataclass(frozen=True, eq=False)
class System:
    """z'' + damping z' + squares z + mesh f = load, with y = mesh^T z and f_j = k_j(t) y_j + c_j y_j'.

    z (n,) are coordinates of the shaft lines' own modes, of modal mass 1; a line that is not held has modes with squares 0.
    `mesh` (n, m) gives the approach y of the flanks along the line of action (m) in each of m meshes, positive where they
    press; `inertias` (n, i) the turn of each inertia (rad), `shaft_torques` (n, s) the torque in each shaft (N·m). `load` (n,)
    are the mean torques on the inertias; `stiffness` (m,) the mean of k_j (N/m), `mesh_damping` (m,) c_j (N·s/m).
    """

    squares: Floats
    damping: Floats
    mesh: Floats
    inertias: Floats
    shaft_torques: Floats
    load: Floats
    stiffness: Floats
    mesh_damping: Floats
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
    """Names of meshes, inertias and shafts."""
    bearings: Bearings | None = None
    """Bearings of the axes that travel; None if no axis does."""

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.squares)

    @property
    def outputs(self) -> Floats:
        """Outputs (n, i + s + t) per coordinate: turns of the inertias, torques in the shafts, travels of the axes."""
        travels = [] if self.bearings is None else [self.bearings.travel]
        return np.hstack([self.inertias, self.shaft_torques, *travels])

    @property
    def torque_outputs(self) -> slice:
        """Slice of the outputs that are torques in the shafts."""
        first = self.inertias.shape[1]
        return slice(first, first + self.shaft_torques.shape[1])

    def stiffness_matrix(self, stiffness: Floats | None = None) -> Floats:
        """Return the stiffness matrix (n, n), with the meshes at their mean stiffness or another (m,) in N/m."""
        k = self.stiffness if stiffness is None else stiffness
        result: Floats = np.diag(self.squares) + (self.mesh * k) @ self.mesh.T
        return result

    def damping_matrix(self) -> Floats:
        """Return the damping matrix (n, n) of the lines and the meshes in the coordinates."""
        result: Floats = np.diag(self.damping) + (self.mesh * self.mesh_damping) @ self.mesh.T
        return result


NumberOrArray = float | Floats
"""A value of one shaft at one frequency, or arrays of them."""


# ---------------------------------------------------------------------- elements


def twist_shapes(order: int, places: ArrayLike) -> Floats:
    """Return shape functions (order + 1, n) at places 0 ... 1 along a shaft.

    They are two linear ones, then integrated Legendre polynomials. Those vanish at both ends: N_j = (P_j - P_{j-2}) /
    sqrt(4 j - 2) (Szabo and Babuska, Finite Element Analysis, 3.1.1).
    """
    x = 2 * np.asarray(places, dtype=float) - 1
    p = [np.ones_like(x), x]
    for j in range(2, order + 1):  # Bonnet's recursion
        p.append(((2 * j - 1) * x * p[-1] - (j - 1) * p[-2]) / j)
    bubbles = [(p[j] - p[j - 2]) / math.sqrt(4 * j - 2) for j in range(2, order + 1)]
    return np.array([(1 - x) / 2, (1 + x) / 2, *bubbles])


def element_matrices(stiffness: float, inertia: float, order: int) -> tuple[Floats, Floats]:
    """Return the stiffness and inertia matrix (order + 1, order + 1) of a shaft by the shape functions of `twist_shapes`.

    The derivatives of all but the linear ones are orthonormal on [-1, 1], so the stiffness matrix is known. That of inertia has
    integrands of degree 2 order, for which Gauss's rule with order + 1 points is exact.
    """
    k = np.diag(np.full(order + 1, 2.0))
    k[:2, :2] = [[1, -1], [-1, 1]]
    points, weights = np.polynomial.legendre.leggauss(order + 1)
    shapes = twist_shapes(order, (points + 1) / 2)
    return stiffness * k, inertia / 2 * (shapes * weights) @ shapes.T


# ---------------------------------------------------------------------- the wave equation

_SMALL = 1e-2
"""Wave number below which series are more accurate than differences of large terms: the first one left out is its 6th power."""


def _wave_number(stiffness: NumberOrArray, inertia: NumberOrArray, omega: NumberOrArray) -> Floats:
    """Return beta = omega L / c = omega sqrt(J / k)."""
    result: Floats = np.asarray(omega) * np.sqrt(np.asarray(inertia) / np.asarray(stiffness))
    return result


def _two_by_two(diagonal: Floats, off: Floats) -> Floats:
    return np.moveaxis(np.array([[diagonal, off], [off, diagonal]]), (0, 1), (-2, -1))


def dynamic_stiffness(stiffness: NumberOrArray, inertia: NumberOrArray, omega: NumberOrArray) -> Floats:
    """Return the dynamic stiffness (..., 2, 2): torques on the ends of a shaft that turn harmonically.

    It is k beta [[cot beta, -1/sin beta], [..., cot beta]].
    """
    beta = _wave_number(stiffness, inertia, omega)
    per_sine = np.asarray(stiffness) / np.sinc(beta / np.pi)
    return _two_by_two(np.cos(beta) * per_sine, -per_sine)


def dynamic_inertia(stiffness: NumberOrArray, inertia: NumberOrArray, omega: NumberOrArray) -> Floats:
    """Return the dynamic inertia (..., 2, 2): minus the derivative of `dynamic_stiffness` by omega squared.

    Its quadratic form is twice the kinetic energy over omega squared, of the whole shaft.
    """
    beta = _wave_number(stiffness, inertia, omega)
    b2 = beta**2
    diagonal, off = 2 / 3 + b2 * (4 / 45 + b2 * 4 / 315), 1 / 3 + b2 * (7 / 90 + b2 * 31 / 2520)
    large = beta >= _SMALL
    b = np.where(large, beta, 1.0)
    sine, cosine = np.sin(b), np.cos(b)
    diagonal = np.where(large, 1 / sine**2 - cosine / (sine * b), diagonal)
    off = np.where(large, 1 / (sine * b) - cosine / sine**2, off)
    half = np.asarray(inertia) / 2
    return _two_by_two(half * diagonal, half * off)


def clamped_modes_below(stiffness: NumberOrArray, inertia: NumberOrArray, omega: NumberOrArray) -> NDArray[np.int64]:
    """Return J_0 of Wittrick and Williams: the number of natural frequencies below omega of a shaft with both ends clamped."""
    beta = _wave_number(stiffness, inertia, omega)
    count: NDArray[np.int64] = np.maximum(np.ceil(beta / np.pi) - 1, 0).astype(np.int64)
    return count


def twist_between(stiffness: float, inertia: float, omega: float, places: ArrayLike) -> Floats:
    """Return the turn (2, n) at places 0 ... 1 of a shaft one of whose ends turns by 1, the other by 0, harmonically."""
    beta = float(_wave_number(stiffness, inertia, omega))
    x = np.asarray(places, dtype=float)
    whole = np.sinc(beta / np.pi)
    return np.array([(1 - x) * np.sinc((1 - x) * beta / np.pi), x * np.sinc(x * beta / np.pi)]) / whole


@dataclass(frozen=True, eq=False)
class _Element:
    """A shaft: `index` (q,) of its coordinates, -1 for ground, with its stiffness and inertia matrices (q, q)."""

    index: Wholes
    stiffness: Floats
    inertia: Floats

    def of(self, modes: Floats) -> Floats:
        """Return the shaft's coordinates (q, n) in modes (N, n)."""
        result: Floats = np.where(self.index[:, None] >= 0, modes[self.index], 0.0)
        return result


@dataclass(frozen=True, eq=False)
class ShaftLines:
    """A System, and its coordinates on the shafts.

    `shafts[s]` (q, n) are coefficients of `twist_shapes` on each shaft. The quadratic forms of `shaft_stiffness[s]` and
    `shaft_inertia[s]` (q, q) in them are twice its potential, and kinetic, energy. `free` (n, r) are the turns of all that no
    shaft holds, as modes of mass 1.
    """

    parts: Parts
    system: System
    shafts: tuple[Floats, ...]
    shaft_stiffness: tuple[Floats, ...]
    shaft_inertia: tuple[Floats, ...]
    free: Floats


def system(train: Train) -> System:
    """Return the System of the train in modes of its lines.

    The part of the load that is left by rounding, where torques balance, is taken out.
    """
    return lines_of(train).system


def lines_of(train: Train) -> ShaftLines:
    """Return the train's lines, their modes, and the System that they make with the meshes."""
    parts = parts_of(train)
    elements = _elements(parts, train)
    size = max([len(parts.inertias), *(int(element.index.max()) + 1 for element in elements)])
    stiffness, inertia = np.zeros((size, size)), np.zeros((size, size))
    inertia[range(len(parts.inertias)), range(len(parts.inertias))] = parts.inertia
    for element in elements:
        inside = np.flatnonzero(element.index >= 0)
        place = np.ix_(element.index[inside], element.index[inside])
        stiffness[place] += element.stiffness[np.ix_(inside, inside)]
        inertia[place] += element.inertia[np.ix_(inside, inside)]
    squares, modes = _line_modes(parts, elements, stiffness, inertia, train.model is TrainModel.MODES)
    turns = modes.T @ inertia[:, : len(parts.inertias)] @ parts.free
    turns = turns / np.linalg.norm(turns, axis=0)
    return ShaftLines(
        parts=parts,
        system=_system(parts, elements, squares, modes, turns),
        shafts=tuple(element.of(modes) for element in elements),
        shaft_stiffness=tuple(element.stiffness for element in elements),
        shaft_inertia=tuple(element.inertia for element in elements),
        free=turns,
    )


def _elements(parts: Parts, train: Train) -> list[_Element]:
    """Return the element of every shaft, a spring where it has no mass.

    Coordinates inside shafts come after those of the inertias.
    """
    result, size = [], len(parts.inertias)
    for shaft, ends in zip(parts.shafts, parts.ends, strict=True):
        mass = 0.0 if train.model is TrainModel.MASSLESS else shaft.inertia
        order = train.order if mass else 1
        index = np.concatenate([ends, np.arange(size, size + order - 1)])
        size += order - 1
        result.append(_Element(index, *element_matrices(shaft.stiffness, mass, order)))
    return result


# ---------------------------------------------------------------------- modes of the lines


def _line_modes(
    parts: Parts, elements: list[_Element], stiffness: Floats, inertia: Floats, first_only: bool
) -> tuple[Floats, Floats]:
    """Return the squares (n,) of natural frequencies and the modes (N, n) of mass 1, line by line."""
    from scipy.linalg import eigh
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components((stiffness != 0) | (inertia != 0), directed=False)
    squares, modes = [], []
    for line in range(count):
        own = np.flatnonzero(label == line)
        square, shape = eigh(stiffness[np.ix_(own, own)], inertia[np.ix_(own, own)])
        inside = [s for s, element in enumerate(elements) if label[element.index.max()] == line]
        held = any(parts.shafts[s].held for s in inside)
        if not held:
            # All that turns turns alike; the polynomials that vanish at the ends of shafts come after the inertias.
            turn = (own < len(parts.inertias)).astype(float)
            square[0], shape[:, 0] = 0.0, turn / np.sqrt(turn @ inertia[np.ix_(own, own)] @ turn)
        kept = slice(_kept_modes(parts, inside, held) if first_only else None)
        full = np.zeros((len(stiffness), len(square)))
        full[own] = shape
        squares.append(square[kept])
        modes.append(full[:, kept])
    return np.concatenate(squares), np.concatenate(modes, axis=1)


def _kept_modes(parts: Parts, inside: list[int], held: bool) -> int | None:
    """Return the number of modes that a line keeps, None for all.

    They are those that its shafts require, and the turn of a free line as a whole.
    """
    asked = [parts.shafts[s].modes for s in inside]
    if any(modes is None for modes in asked):
        return None
    return sum(modes for modes in asked if modes is not None) + (not held)


# ---------------------------------------------------------------------- the system


def _system(parts: Parts, elements: list[_Element], squares: Floats, modes: Floats, turns: Floats) -> System:
    """Return the System of the lines' modes.

    Inertias are the first coordinates; the torque in a shaft with mass is its mean over the length.
    """
    inertias = modes[: len(parts.inertias)].T
    torques = np.zeros((len(squares), len(elements)))
    damping = np.zeros(len(squares))
    omega = np.sqrt(squares)
    per_omega = np.divide(1.0, omega, out=np.zeros_like(omega), where=omega > 0)
    for s, (shaft, element) in enumerate(zip(parts.shafts, elements, strict=True)):
        local, stiffness = element.of(modes), shaft.stiffness
        torques[:, s] = stiffness * (local[1] - local[0])
        # Twice the strain energy of the shaft in each mode: its share in the line's damping.
        energy = np.einsum("in,ij,jn->n", local, element.stiffness, local)
        damping += energy * (2 * shaft.damping_ratio * per_omega + shaft.damping / stiffness)
    load = inertias @ parts.torque
    names = (parts.meshes, parts.inertias, parts.shafts)
    return System(
        squares=squares,
        damping=damping,
        mesh=inertias @ parts.approach,
        inertias=inertias,
        shaft_torques=torques,
        load=load - turns @ (turns.T @ load),
        stiffness=parts.stiffness,
        mesh_damping=np.array([_mesh_damping(parts, column, mesh) for column, mesh in enumerate(parts.meshes)]),
        names=tuple(tuple(part.name for part in each) for each in names),  # type: ignore[arg-type]
    )


def _mesh_damping(parts: Parts, column: int, mesh: ToothMesh) -> float:
    """Return the damping of a mesh (N·s/m): as given, or 2 zeta sqrt(k m).

    m are the inertias of the pair alone, reduced to the line of action.
    """
    if mesh.damping_ratio is None:
        return mesh.damping or 0.0
    compliance = float(np.sum(parts.approach[:, column] ** 2 / parts.inertia))
    return 2 * mesh.damping_ratio * float(np.sqrt(parts.stiffness[column] / compliance))

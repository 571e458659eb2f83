"""The lines of a train - shafts and inertias, the meshes taken away - and the System of their modes. In SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.dynamics.trains.members import Mesh
from gearcad.dynamics.trains.parts import Parts, parts_of
from gearcad.dynamics.trains.shafts import element_matrices
from gearcad.dynamics.trains.system import System
from gearcad.dynamics.trains.train import Train, TrainModel

__all__ = ["Lines", "lines_of", "system"]


@dataclass(frozen=True, eq=False)
class _Element:
    """A shaft: `index` (q,) of its coordinates, -1 for ground, with its stiffness and inertia matrices (q, q)."""

    index: Wholes
    stiffness: Floats
    inertia: Floats

    def of(self, modes: Floats) -> Floats:
        """(q, n): the shaft's coordinates in modes (N, n)."""
        result: Floats = np.where(self.index[:, None] >= 0, modes[self.index], 0.0)
        return result


@dataclass(frozen=True, eq=False)
class Lines:
    """A System, and what its coordinates are on the shafts.

    `shafts[s]` (q, n) are coefficients of `twist_shapes` on each shaft; the quadratic forms of `shaft_stiffness[s]` and
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
    """The train in modes of its lines. What is left of torques that balance but for rounding is taken out of the load."""
    return lines_of(train).system


def lines_of(train: Train) -> Lines:
    """The train's lines, their modes, and the System that they make with the meshes."""
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
    return Lines(
        parts=parts,
        system=_system(parts, elements, squares, modes, turns),
        shafts=tuple(element.of(modes) for element in elements),
        shaft_stiffness=tuple(element.stiffness for element in elements),
        shaft_inertia=tuple(element.inertia for element in elements),
        free=turns,
    )


def _elements(parts: Parts, train: Train) -> list[_Element]:
    """Of every shaft, a spring where it has no mass; coordinates inside shafts come after those of the inertias."""
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
    """Squares (n,) and modes (N, n) of mass 1, line by line."""
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
        kept = slice(_kept(parts, inside, held) if first_only else None)
        full = np.zeros((len(stiffness), len(square)))
        full[own] = shape
        squares.append(square[kept])
        modes.append(full[:, kept])
    return np.concatenate(squares), np.concatenate(modes, axis=1)


def _kept(parts: Parts, inside: list[int], held: bool) -> int | None:
    """How many modes a line keeps: those that its shafts ask for, and its turn as a whole; None for all."""
    asked = [parts.shafts[s].modes for s in inside]
    if any(modes is None for modes in asked):
        return None
    return sum(modes for modes in asked if modes is not None) + (not held)


# ---------------------------------------------------------------------- the system


def _system(parts: Parts, elements: list[_Element], squares: Floats, modes: Floats, turns: Floats) -> System:
    """Inertias are the first coordinates; the torque in a shaft with mass is its mean over the length."""
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


def _mesh_damping(parts: Parts, column: int, mesh: Mesh) -> float:
    """2 zeta sqrt(k m) with m the inertias of the pair alone, reduced to the line of action (N·s/m)."""
    if mesh.damping_ratio is None:
        return mesh.damping or 0.0
    compliance = float(np.sum(parts.approach[:, column] ** 2 / parts.inertia))
    return 2 * mesh.damping_ratio * float(np.sqrt(parts.stiffness[column] / compliance))

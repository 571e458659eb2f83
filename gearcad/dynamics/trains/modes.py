"""Natural frequencies and modes of a train, by any of its models, and a count that tells whether one is missing."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.trains.components import component_modes
from gearcad.dynamics.trains.eigenmodes import ComponentModes, NaturalModes, positive
from gearcad.dynamics.trains.exact import SPLIT, DynamicTrain, dynamic_train, natural_frequencies, natural_shapes
from gearcad.dynamics.trains.lines import Lines, lines_of
from gearcad.dynamics.trains.parts import parts_of
from gearcad.dynamics.trains.shafts import dynamic_inertia, dynamic_stiffness, twist_between, twist_shapes
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.errors import ParameterError, require_number, require_whole

__all__ = ["count_below", "natural_modes"]


_NEXT = 1 + 1e-9
"""A frequency so much higher counts the mode itself; rounding of elements is below."""

_ROUNDING = 1e-9
"""How far the mass of a mode may be from 1."""


def natural_modes(train: Train, *, count: int | None = None, up_to: float | None = None, points: int = 21) -> NaturalModes:
    """The first `count` modes, or those up to a frequency in Hz; else the first ten; as many as the model has.

    Shapes of shafts are given at `points` places. Raises ParameterError.
    """
    if count is not None and up_to is not None:
        raise ParameterError("count", count, "not beside up_to: one limit only")
    if up_to is not None:
        require_number("up_to", up_to, "Hz", above=0)
    require_whole("points", points, at_least=2, at_most=10_000)
    count = 10 if count is None else count
    require_whole("count", count, at_least=1, at_most=10_000)
    limit = math.inf if up_to is None else 2 * math.pi * up_to
    places = np.linspace(0, 1, points)
    if train.model is TrainModel.EXACT:
        modes = _exact_modes(train, count, limit, places)
    else:
        modes = _line_system_modes(train, count, limit, places)
    return modes


def count_below(train: Train, frequency: float) -> int:
    """How many natural frequencies the train has below `frequency` (Hz), by Wittrick and Williams, 0 Hz counted.

    Shafts have their full mass, in the models "modes" and "elements" too. Raises ParameterError.
    """
    require_number("frequency", frequency, "Hz", above=0)
    return _count(train, 2 * math.pi * frequency)


def _count(train: Train, omega: float) -> int:
    """How many natural frequencies there are below omega (1/s)."""
    dynamic = dynamic_train(parts_of(train), massless=train.model is TrainModel.MASSLESS)
    return int(dynamic.count_below(np.array([omega]))[0])


# ---------------------------------------------------------------------- by modes of the lines


def _line_system_modes(train: Train, count: int, limit: float, places: Floats) -> NaturalModes:
    """Modes of the System. Their squares are sums of energies, which rounding cannot make negative."""
    lines = lines_of(train)
    z = _of_mass_one(lines, _modes_of(lines))
    approach, turns = lines.system.mesh.T @ z, lines.system.inertias.T @ z
    shafts = [along @ z for along in lines.shafts]
    pairs = list(zip(shafts, lines.shaft_stiffness, strict=True))
    energy = np.array([_form(local, k) for local, k in pairs]).reshape(-1, z.shape[1])
    kinetic = [_form(local, inertia) for local, inertia in zip(shafts, lines.shaft_inertia, strict=True)]
    meshes = lines.system.stiffness[:, None] * approach**2
    squares = energy.sum(axis=0) + meshes.sum(axis=0)
    rigid = lines.free.shape[1]
    squares[:rigid] = 0.0
    omega = np.sqrt(squares)
    kept = np.argsort(omega, kind="stable")
    kept = kept[omega[kept] <= limit][: count if math.isinf(limit) else None]
    shapes = [local.T @ twist_shapes(len(local) - 1, places) for local in shafts]
    per_square = np.divide(1.0, squares, out=np.zeros_like(squares), where=squares > 0)
    return _natural_modes(
        train,
        lines.parts.inertias,
        omega=omega[kept],
        shape=turns.T[kept],
        places=places,
        shaft_shape=_stacked(shapes, len(omega), len(places))[kept],
        approach=approach.T[kept],
        kinetic_inertias=(lines.parts.inertia[:, None] * turns**2).T[kept],
        kinetic_shafts=_stacked([each[:, None] for each in kinetic], len(omega), 1)[kept, :, 0],
        potential_shafts=(energy * per_square).T[kept],
        potential_meshes=(meshes * per_square).T[kept],
        components=component_modes(lines) if train.model is TrainModel.MODES else None,
    )


def _of_mass_one(lines: Lines, z: Floats) -> Floats:
    """The modes (n, m) over the root of the mass that turns in them, which is off where a shaft weighs next to nothing."""
    turns = lines.system.inertias.T @ z
    shafts = [_form(along @ z, inertia) for along, inertia in zip(lines.shafts, lines.shaft_inertia, strict=True)]
    mass = (lines.parts.inertia[:, None] * turns**2).sum(axis=0) + sum(shafts)
    scaled: Floats = z / np.sqrt(np.where(np.abs(mass - 1) > _ROUNDING, mass, 1.0))
    return scaled


def _modes_of(lines: Lines) -> Floats:
    """(n, n) modes of mass 1 in the lines' coordinates; first those in which all turns freely, which are known."""
    from scipy.linalg import eigh

    _, z = eigh(lines.system.stiffness_matrix())
    free = lines.free
    elastic = z[:, free.shape[1] :]
    elastic = elastic - free @ (free.T @ elastic)
    return np.hstack([free, elastic / np.linalg.norm(elastic, axis=0)])


# ---------------------------------------------------------------------- without discretisation


def _exact_modes(train: Train, count: int, limit: float, places: Floats) -> NaturalModes:
    """Modes of the wave equation: what every piece of a shaft does follows from its ends."""
    dynamic = dynamic_train(parts_of(train))
    if not math.isinf(limit):
        # One more, which shows where to stop: the limit itself may be a natural frequency.
        count = int(dynamic.count_below(np.array([limit]))[0]) + 1
    omega = natural_frequencies(dynamic, count)
    omega = omega[omega <= limit]
    nodes = natural_shapes(dynamic, omega)
    parts, inertias = dynamic.parts, len(dynamic.parts.inertias)
    approach = dynamic.meshes.T @ nodes
    per_square = np.divide(1.0, omega**2, out=np.zeros_like(omega), where=omega > 0)
    kinetic, energy = _piece_energies(dynamic, omega, nodes)
    return _natural_modes(
        train,
        parts.inertias,
        omega=omega,
        shape=nodes[:inertias].T,
        places=places,
        shaft_shape=_piece_shapes(dynamic, omega, nodes, places),
        approach=approach.T,
        kinetic_inertias=(parts.inertia[:, None] * nodes[:inertias] ** 2).T,
        kinetic_shafts=kinetic,
        potential_shafts=energy * per_square[:, None],
        potential_meshes=(parts.stiffness[:, None] * approach**2 * per_square).T,
    )


def _piece_energies(dynamic: DynamicTrain, omega: Floats, nodes: Floats) -> tuple[Floats, Floats]:
    """(n, s) each: twice the kinetic energy of shafts over omega squared, and twice their potential energy."""
    ends = dynamic.ends @ nodes
    each = dynamic.piece_stiffness, dynamic.piece_inertia, omega[:, None]
    moving = np.einsum("pan,npab,pbn->np", ends, dynamic_inertia(*each), ends)
    # The dynamic stiffness holds potential less kinetic energy.
    potential = np.einsum("pan,npab,pbn->np", ends, dynamic_stiffness(*each), ends) + omega[:, None] ** 2 * moving
    whole = np.zeros((len(dynamic.pieces), len(dynamic.parts.shafts)))
    whole[range(len(dynamic.pieces)), [shaft for shaft, _ in dynamic.pieces]] = 1.0
    return moving @ whole, potential @ whole


def _piece_shapes(dynamic: DynamicTrain, omega: Floats, nodes: Floats, places: Floats) -> Floats:
    """(n, s, p): turns along the shafts, of which those with mass are in two pieces."""
    result = np.zeros((len(omega), len(dynamic.parts.shafts), len(places)))
    ends = dynamic.ends @ nodes
    for piece, (shaft, second) in enumerate(dynamic.pieces):
        inside, local = np.ones(len(places), dtype=bool), places
        if dynamic.piece_inertia[piece]:
            inside = places > SPLIT if second else places <= SPLIT
            local = (places - SPLIT) / (1 - SPLIT) if second else places / SPLIT
        for mode, each in enumerate(omega):
            between = twist_between(dynamic.piece_stiffness[piece], dynamic.piece_inertia[piece], each, local[inside])
            result[mode, shaft, inside] = ends[piece, :, mode] @ between
    return result


# ---------------------------------------------------------------------- what both share


def _form(local: Floats, matrix: Floats) -> Floats:
    """Quadratic form of each column (n,)."""
    result: Floats = np.einsum("in,ij,jn->n", local, matrix, local)
    return result


def _stacked(each: list[Floats], modes: int, points: int) -> Floats:
    """(n, s, p) of arrays (n, p), of none too."""
    return np.stack(each, axis=1) if each else np.zeros((modes, 0, points))


def _natural_modes(
    train: Train,
    inertias: tuple[Any, ...],
    *,
    omega: Floats,
    shape: Floats,
    components: ComponentModes | None = None,
    **arrays: Floats,
) -> NaturalModes:
    """The result: signs set, units of the house, and a count of what is missing."""
    sign = positive(shape)[:, None]
    ratios = train.speed_ratios
    per_turn = np.array([abs(ratios[mesh.pinion]) * mesh.teeth for mesh in train.meshes])
    shafts = () if train.model is TrainModel.ISOLATED else train.shafts
    approach, shaft_shape = arrays.pop("approach"), arrays.pop("shaft_shape")
    return NaturalModes(
        frequency=omega / (2 * np.pi),
        circular=omega,
        rpm=np.divide.outer(60 / (2 * np.pi) * omega, per_turn),
        shape=sign * shape,
        shaft_shape=sign[:, :, None] * shaft_shape,
        approach=1000 * sign * approach,
        inertias=tuple(inertia.name for inertia in inertias),
        shafts=tuple(shaft.name for shaft in shafts),
        meshes=tuple(mesh.name for mesh in train.meshes),
        rigid=int((omega == 0).sum()),
        missed=max(0, _count(train, omega[-1] * _NEXT) - len(omega)) if len(omega) and omega[-1] > 0 else 0,
        component_modes=components,
        **arrays,
    )

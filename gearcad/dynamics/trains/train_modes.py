"""Natural frequencies and modes of a train by any of its models. SI units inside.

The exact model: W. H. Wittrick, F. W. Williams, A general algorithm for computing natural frequencies of elastic structures,
Quart. J. Mech. Appl. Math. 24 (1971): as many natural frequencies are below omega as the dynamic stiffness matrix has negative
eigenvalues, and the members with both ends clamped have natural frequencies below it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import ParameterError, SolverError, require_number, require_whole
from gearcad.core.records import Floats, JsonObject, freeze
from gearcad.dynamics.trains.shaft_lines import (
    ShaftLines,
    clamped_modes_below,
    dynamic_inertia,
    dynamic_stiffness,
    lines_of,
    twist_between,
    twist_shapes,
)
from gearcad.dynamics.trains.train import Parts, Train, TrainModel, parts_of


def positive(shape: Floats) -> Floats:
    """Return signs (n,) of modes (n, i) with which the first far inertia turns positively.

    That is the first inertia that turns at least half as far as any.
    """
    far = np.abs(shape) >= 0.5 * np.abs(shape).max(axis=1, keepdims=True)
    return np.where(shape[np.arange(len(shape)), far.argmax(axis=1)] < 0, -1.0, 1.0)


@dataclass(frozen=True, eq=False)
class ComponentModes:
    """n modes of lines of shafts, each by itself, without its meshes, that make up a train.

    `circular` (n,) in 1/s; `shape` (n, i) are turns of the inertias in rad and `middle` (n, s) those of the middles of shafts,
    of a modal mass of 1 kg·m², signs as of natural modes; 0 in other lines.
    """

    circular: Floats
    shape: Floats
    middle: Floats
    inertias: tuple[str, ...]
    shafts: tuple[str, ...]

    def __post_init__(self) -> None:
        freeze(self)

    def to_dict(self) -> JsonObject:
        """Return the modes as plain lists, with turns by the names of inertias and shafts."""
        return {
            "circular": self.circular.tolist(),
            "shape": dict(zip(self.inertias, self.shape.T.tolist(), strict=True)),
            "middle": dict(zip(self.shafts, self.middle.T.tolist(), strict=True)),
        }


@dataclass(frozen=True, eq=False)
class NaturalModes:
    """n natural modes of a train at the mean stiffness of its meshes, without damping, by rising frequency.

    `frequency` (n,) in Hz, `circular` in 1/s; `rpm` (n, m) is the speed of the train (of its first mesh's pinion) at which the
    tooth frequency of each mesh meets the mode. `shape` (n, i) are turns of the inertias in rad, scaled to a modal mass of
    1 kg·m²; the first inertia that turns at least half as far as any turns positively. `shaft_shape` (n, s, p) are turns at
    `places` (p,), 0 ... 1 from start to end of every shaft; `approach` (n, m) is that of the flanks in mm, positive as the mean
    torques press them. `kinetic_inertias` (n, i) and `kinetic_shafts` (n, s) are shares in the kinetic energy,
    `potential_shafts` (n, s) and `potential_meshes` (n, m) in the potential energy. Each pair sums up to 1, but the first
    `rigid` modes, at 0 Hz, have no potential energy. `missed` counts the natural frequencies below the highest of these that
    the train has besides, with the full mass of its shafts unless the model leaves it away. `component_modes` are those of
    the lines of which the model "modes" is made.
    """

    frequency: Floats
    circular: Floats
    rpm: Floats
    shape: Floats
    places: Floats
    shaft_shape: Floats
    approach: Floats
    kinetic_inertias: Floats
    kinetic_shafts: Floats
    potential_shafts: Floats
    potential_meshes: Floats
    inertias: tuple[str, ...]
    shafts: tuple[str, ...]
    meshes: tuple[str, ...]
    rigid: int
    missed: int
    component_modes: ComponentModes | None = None

    def __post_init__(self) -> None:
        freeze(self)

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def unit_shape(self) -> Floats:
        """Shape (n, i) with the squares of the turns of all inertias summing up to 1."""
        length = np.linalg.norm(self.shape, axis=1, keepdims=True)
        result: Floats = np.divide(self.shape, length, out=np.zeros_like(self.shape), where=length > 0)
        return result

    @property
    def leading_parts(self) -> tuple[tuple[str, ...], ...]:
        """Names of the parts that move most and give way most in each elastic mode: one part where both are the same.

        Empty for rigid modes.
        """
        return tuple(() if mode < self.rigid else self._leading(mode) for mode in range(len(self)))

    @property
    def most_toothed(self) -> tuple[int, float] | None:
        """Mode (from 0) whose potential energy is most in the teeth, and their share; None without elastic modes."""
        shares = self.potential_meshes[self.rigid :]
        if not shares.size:
            return None
        mode = int(shares.sum(axis=1).argmax())
        return mode + self.rigid, float(shares[mode].sum())

    def to_dict(self) -> JsonObject:
        """Return plain lists, under the names of the fields, and the leading parts."""
        values = {each.name: getattr(self, each.name) for each in fields(self) if each.name != "component_modes"}
        plain = {
            name: value.tolist() if isinstance(value, np.ndarray) else list(value) if isinstance(value, tuple) else value
            for name, value in values.items()
        }
        components = None if self.component_modes is None else self.component_modes.to_dict()
        return {
            **plain,
            "unit_shape": self.unit_shape.tolist(),
            "leading_parts": [list(names) for names in self.leading_parts],
            "component_modes": components,
        }

    def _leading(self, mode: int) -> tuple[str, ...]:
        moving = _shared(self.inertias, self.kinetic_inertias[mode]) + _shared(self.shafts, self.kinetic_shafts[mode], "shaft ")
        bent = _shared(self.shafts, self.potential_shafts[mode], "shaft ")
        bent += _shared(self.meshes, self.potential_meshes[mode], "mesh ")
        return tuple(dict.fromkeys(max(each)[1] for each in (moving, bent)))


def _shared(names: tuple[str, ...], shares: Floats, kind: str = "") -> list[tuple[float, str]]:
    """Return shares in an energy with the names of the parts that have them; a name includes the kind."""
    return [
        (float(share), name if name.startswith(kind.strip()) else kind + name)
        for name, share in zip(names, shares, strict=True)
    ]


def component_modes(lines: ShaftLines) -> ComponentModes:
    """Return the modes that the System of the lines keeps, each of mass 1, line by line.

    Osinski's (2.7) holds such a matrix.
    """
    modes = len(lines.system.squares)
    middle = [local.T @ twist_shapes(len(local) - 1, 0.5) for local in lines.shafts]
    shape: Floats = lines.system.inertias
    sign = positive(shape)[:, None]
    return ComponentModes(
        circular=np.sqrt(lines.system.squares),
        shape=sign * shape + 0.0,  # no -0
        middle=sign * (np.stack(middle, axis=1) if middle else np.zeros((modes, 0))) + 0.0,
        inertias=tuple(inertia.name for inertia in lines.parts.inertias),
        shafts=tuple(shaft.name for shaft in lines.parts.shafts),
    )


SPLIT = (3 - math.sqrt(5)) / 2
"""Place where a shaft with mass is cut, so that no mode has all nodes at rest: there are never whole half waves on both sides.
"""

_SAME = 1e-10
"""Relative distance below which frequencies are one, of several modes."""

_DOUBLINGS = 200
_HALVINGS = 200
"""Largest number of halvings; enough to separate neighbouring floats from any start."""


@dataclass(frozen=True, eq=False)
class DynamicTrain:
    """Nodes - the inertias, then the cuts of shafts - with `inertia` (n,), `meshes` (n, m), and the pieces of shafts between.

    `pieces` (p, 2) are the places of each piece's shaft, and of the piece on it: 0 or 1, or 0 for a shaft of one piece. `ends`
    (p, 2, n) select the nodes at both ends of a piece, none for ground. `free` (n, r) are the turns of pieces that nothing
    holds.
    """

    parts: Parts
    inertia: Floats
    meshes: Floats
    pieces: tuple[tuple[int, int], ...]
    ends: Floats
    piece_stiffness: Floats
    piece_inertia: Floats
    free: Floats

    def stiffness(self, omega: Floats) -> Floats:
        """Return the dynamic stiffness (q, n, n) at each of omega (q,)."""
        own = dynamic_stiffness(self.piece_stiffness, self.piece_inertia, omega[:, None])
        result: Floats = self._joined(own)
        result -= np.multiply.outer(omega**2, np.diag(self.inertia))
        result += (self.meshes * self.parts.stiffness) @ self.meshes.T
        return result

    def moving_inertia(self, omega: float) -> Floats:
        """Return the inertia (n, n) whose quadratic form is the modal mass of a shape.

        The shafts' own motion is included.
        """
        own = dynamic_inertia(self.piece_stiffness, self.piece_inertia, omega)
        return np.diag(self.inertia) + self._joined(own)

    def _joined(self, own: Floats) -> Floats:
        """Return the matrices (..., p, 2, 2) of all pieces put together, (..., n, n)."""
        result: Floats = (self.ends.transpose(0, 2, 1) @ own @ self.ends).sum(axis=-3)
        return result

    def count_below(self, omega: Floats) -> NDArray[np.int64]:
        """Return the number (q,) of natural frequencies below each of omega (q,), above 0."""
        clamped = clamped_modes_below(self.piece_stiffness, self.piece_inertia, omega[:, None]).sum(axis=1)
        negative = (np.linalg.eigvalsh(self.stiffness(omega)) < 0).sum(axis=1)
        count: NDArray[np.int64] = clamped + negative
        return count


def dynamic_train(parts: Parts, *, massless: bool = False) -> DynamicTrain:
    """Return the DynamicTrain of the parts, with the mass of their shafts or without."""
    nodes = len(parts.inertias)
    pieces, joined, matrices, free = [], [], [], list(parts.free)
    for place, (shaft, (start, end)) in enumerate(zip(parts.shafts, parts.ends.tolist(), strict=True)):
        k, inertia = shaft.stiffness, 0.0 if massless else shaft.inertia
        if not inertia:
            pieces.append((place, 0))
            joined.append((start, end))
            matrices.append((k, 0.0))
            continue
        pieces += [(place, 0), (place, 1)]
        joined += [(start, nodes), (nodes, end)]
        matrices += [(k / SPLIT, inertia * SPLIT), (k / (1 - SPLIT), inertia * (1 - SPLIT))]
        free.append(parts.free[max(start, end)])
        nodes += 1
    cuts = nodes - len(parts.inertias)
    stiffness, inertias = np.array(matrices).reshape(-1, 2).T
    # The row of ground, -1, is the last one and is left away.
    ends = np.eye(nodes + 1)[np.array(joined, dtype=np.int64).reshape(-1, 2), :nodes]
    return DynamicTrain(
        parts=parts,
        inertia=np.concatenate([parts.inertia, np.zeros(cuts)]),
        meshes=np.concatenate([parts.approach, np.zeros((cuts, parts.approach.shape[1]))]),
        pieces=tuple(pieces),
        ends=ends,
        piece_stiffness=stiffness,
        piece_inertia=inertias,
        free=np.array(free),
    )


def natural_frequencies(train: DynamicTrain, count: int) -> Floats:
    """Return the first natural frequencies (n,) in 1/s, as many as there are up to `count`, those that are 0 among them.

    Bisection by the count finds every one, multiple ones too, as exactly as rounding leaves the dynamic stiffness. Raises
    SolverError where it does not end.
    """
    rigid = train.free.shape[1]
    if not train.piece_inertia.any():
        count = min(count, len(train.inertia))
    ranks = np.arange(rigid, count)
    if not len(ranks):
        return np.zeros(min(rigid, count))
    low, high = np.zeros(len(ranks)), np.full(len(ranks), _above(train, count))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if ((middle <= low) | (middle >= high)).all():
            return np.concatenate([np.zeros(rigid), high])
        below = train.count_below(middle) > ranks
        low, high = np.where(below, low, middle), np.where(below, middle, high)
    raise SolverError("the search for natural frequencies did not converge")


def _above(train: DynamicTrain, count: int) -> float:
    """Return a frequency (1/s) with `count` natural frequencies below it. Raises SolverError where none is found."""
    k = np.trace((train.meshes * train.parts.stiffness) @ train.meshes.T) + train.piece_stiffness.sum()
    omega = math.sqrt(float(k) / train.inertia.sum())
    for _ in range(_DOUBLINGS):
        if int(train.count_below(np.array([omega]))[0]) >= count:
            return omega
        omega *= 2
    raise SolverError(f"no {count} natural frequencies were found below {omega:g} 1/s")


def natural_shapes(train: DynamicTrain, omega: Floats) -> Floats:
    """Return the turns of the nodes (n, modes) at natural frequencies, each of modal mass 1.

    `omega` are frequencies that `natural_frequencies` found.
    """
    rigid = int((omega == 0).sum())
    shapes = np.zeros((len(train.inertia), len(omega)))
    if rigid:
        shapes[:, :rigid] = _orthonormal(train.free, train.moving_inertia(0.0))
    first = rigid
    while first < len(omega):
        last = first + int((omega[first:] <= omega[first] * (1 + _SAME)).sum())
        mean = float(omega[first:last].mean())
        values, vectors = np.linalg.eigh(train.stiffness(np.array([mean]))[0])
        null = vectors[:, np.argsort(np.abs(values))[: last - first]]
        shapes[:, first:last] = _orthonormal(null, train.moving_inertia(mean))
        first = last
    return shapes


def _orthonormal(shapes: Floats, inertia: Floats) -> Floats:
    """Return shapes (n, r) of the same space, orthogonal by the inertia and of modal mass 1."""
    lower = np.linalg.cholesky(shapes.T @ inertia @ shapes)
    result: Floats = np.linalg.solve(lower, shapes.T).T
    return result


_NEXT = 1 + 1e-9
"""Factor on a frequency that counts the mode itself; rounding of elements is below."""

_ROUNDING = 1e-9
"""Greatest difference of the mass of a mode from 1."""


def natural_modes(train: Train, *, count: int | None = None, up_to: float | None = None, points: int = 21) -> NaturalModes:
    """Return the first `count` modes, or those up to a frequency in Hz; else the first ten; as many as the model has.

    Shapes of shafts are given at `points` places. Raises ParameterError.
    """
    if count is not None and up_to is not None:
        raise ParameterError("count", count, "must be left out beside up_to: give one limit only")
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
    """Return the number of natural frequencies of the train below `frequency` (Hz), by Wittrick and Williams, 0 Hz counted.

    Shafts have their full mass, in the models "modes" and "elements" too. Raises ParameterError.
    """
    require_number("frequency", frequency, "Hz", above=0)
    return _count(train, 2 * math.pi * frequency)


def _count(train: Train, omega: float) -> int:
    """Return the number of natural frequencies below omega (1/s)."""
    dynamic = dynamic_train(parts_of(train), massless=train.model is TrainModel.MASSLESS)
    return int(dynamic.count_below(np.array([omega]))[0])


# ---------------------------------------------------------------------- by modes of the lines


def _line_system_modes(train: Train, count: int, limit: float, places: Floats) -> NaturalModes:
    """Return the natural modes of the System.

    Their squares are sums of energies, which rounding cannot make negative.
    """
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


def _of_mass_one(lines: ShaftLines, z: Floats) -> Floats:
    """Return the modes (n, m) over the root of their modal mass.

    The mass is not 1 where a shaft weighs next to nothing.
    """
    turns = lines.system.inertias.T @ z
    shafts = [_form(along @ z, inertia) for along, inertia in zip(lines.shafts, lines.shaft_inertia, strict=True)]
    mass = (lines.parts.inertia[:, None] * turns**2).sum(axis=0) + sum(shafts)
    scaled: Floats = z / np.sqrt(np.where(np.abs(mass - 1) > _ROUNDING, mass, 1.0))
    return scaled


def _modes_of(lines: ShaftLines) -> Floats:
    """Return (n, n) modes of mass 1 in the lines' coordinates.

    First come those in which all turns freely, which are known.
    """
    from scipy.linalg import eigh

    _, z = eigh(lines.system.stiffness_matrix())
    free = lines.free
    elastic = z[:, free.shape[1] :]
    elastic = elastic - free @ (free.T @ elastic)
    return np.hstack([free, elastic / np.linalg.norm(elastic, axis=0)])


# ---------------------------------------------------------------------- without discretisation


def _exact_modes(train: Train, count: int, limit: float, places: Floats) -> NaturalModes:
    """Return modes of the wave equation: the motion of every piece of a shaft follows from its ends."""
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
    """Return twice the kinetic energy of shafts over omega squared, and twice their potential energy, (n, s) each."""
    ends = dynamic.ends @ nodes
    each = dynamic.piece_stiffness, dynamic.piece_inertia, omega[:, None]
    moving = np.einsum("pan,npab,pbn->np", ends, dynamic_inertia(*each), ends)
    # The dynamic stiffness holds potential less kinetic energy.
    potential = np.einsum("pan,npab,pbn->np", ends, dynamic_stiffness(*each), ends) + omega[:, None] ** 2 * moving
    whole = np.zeros((len(dynamic.pieces), len(dynamic.parts.shafts)))
    whole[range(len(dynamic.pieces)), [shaft for shaft, _ in dynamic.pieces]] = 1.0
    return moving @ whole, potential @ whole


def _piece_shapes(dynamic: DynamicTrain, omega: Floats, nodes: Floats, places: Floats) -> Floats:
    """Return the turns along the shafts (n, s, p), of which those with mass are in two pieces."""
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
    """Return the quadratic form of each column (n,)."""
    result: Floats = np.einsum("in,ij,jn->n", local, matrix, local)
    return result


def _stacked(each: list[Floats], modes: int, points: int) -> Floats:
    """Return one array (n, s, p) of s arrays (n, p), also where s is 0."""
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
    """Return the result: signs set, units of the package, and the number of frequencies that are missing."""
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

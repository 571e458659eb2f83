"""Eigenspaces of springs and masses, told apart by what the centrals of a train do in them. SI units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Indices
from gearcad.dynamics.planetary.masses import MemberMass, TrainMasses
from gearcad.dynamics.planetary.springs import TrainSprings
from gearcad.errors import ParameterError, require_number

__all__ = ["Eigenspace", "MassSprings", "ModeKind", "eigenspaces", "mass_diagonal"]

_RIGID = 1e-11
"""Of the highest frequency: rounding of a mode in which no spring gives way."""

_NEAR = 1e-6
"""Relative: modes so near to each other are told apart by what they do, not by their frequencies."""

_EQUAL = 1e-9
"""Relative: frequencies that are the same but for rounding."""

_STILL = 1e-5
"""Of a mode: what a central that rests may move."""


_UNKNOWN = MemberMass(mass=None, inertia=None)


class ModeKind(Enum):
    """What carrier and centrals do in a mode."""

    ROTATIONAL = "rotational"
    """They only turn: the planets all move alike."""

    TRANSLATIONAL = "translational"
    """They only travel: two modes at each frequency where there are three planets or more."""

    PLANET = "planet"
    """They rest."""

    MIXED = "mixed"
    """They turn and travel."""


def mass_diagonal(springs: TrainSprings, masses: TrainMasses) -> Floats:
    """(3 (N + 3),): m, m, J/r^2 (kg) of every body; 0 of what cannot move. Raises ParameterError for what moves without."""
    planar = springs.planar
    bodies = [(member.name, masses.members.get(member.name, _UNKNOWN), member.radius) for member in planar.members]
    bodies += [("planet", masses.planet, planar.planet_radius)] * planar.planets
    moving = np.abs(springs.basis).max(axis=1, initial=0.0) > 0
    result = np.zeros(len(springs.basis))
    for place, (name, body, radius) in enumerate(bodies):
        for axis, (key, value, unit) in enumerate(
            (("mass", body.mass, "kg"), ("mass", body.mass, "kg"), ("inertia", body.inertia, "kg·m²"))
        ):
            if not moving[3 * place + axis]:
                continue
            if value is None:
                raise ParameterError(f"{name}.{key}", None, f"must be given in {unit}: without it there are no dynamics")
            require_number(f"{name}.{key}", value, unit, above=0)
            result[3 * place + axis] = value if key == "mass" else value / radius**2
    return result


@dataclass(frozen=True, eq=False)
class MassSprings:
    """Springs and masses in coordinates z = L^T q, M = L L^T, so that orthonormal vectors are modes of mass 1.

    `rooted` (m, n): elongations times the roots of the stiffness, whose singular values are the frequencies: so what is 0 is 0
    but for rounding, which its square is not.
    """

    springs: TrainSprings
    mass: Floats
    lower: Floats
    rooted: Floats

    @classmethod
    def of(cls, springs: TrainSprings, masses: TrainMasses) -> MassSprings:
        """Raises ParameterError where a mass is missing."""
        mass = mass_diagonal(springs, masses)
        lower = np.asarray(np.linalg.cholesky((springs.basis.T * mass) @ springs.basis), float)
        rooted: Floats = np.linalg.solve(lower, (springs.vectors * np.sqrt(springs.stiffness)[:, None]).T).T
        return cls(springs, mass, lower, rooted)

    def places(self, modes: Floats) -> Floats:
        """(3 (N + 3), g): all coordinates in modes (n, g)."""
        result: Floats = self.springs.basis @ np.linalg.solve(self.lower.T, modes)
        return result

    def diagonal(self, modes: Floats) -> tuple[Floats, Floats]:
        """Frequencies (g,) in 1/s, rising, and the modes (n, g) in a space that is spanned by g orthonormal ones."""
        _, values, within = np.linalg.svd(self.rooted @ modes)
        omega = np.zeros(modes.shape[1])
        omega[: len(values)] = values
        return omega[::-1], (modes @ within.T)[:, ::-1]


class Eigenspace(NamedTuple):
    """Modes (n, g) of a kind at one frequency."""

    kind: ModeKind
    omega: Floats
    modes: Floats


def eigenspaces(model: MassSprings) -> Iterator[Eigenspace]:
    """Neighbouring frequencies together, told apart by kind, then by frequency again."""
    omega, modes = model.diagonal(np.eye(len(model.lower)))
    omega[omega <= _RIGID * omega[-1]] = 0.0
    for near in _runs(omega, _NEAR):
        for kind, space in _kinds(model, modes[:, near]):
            own, turned = model.diagonal(space) if omega[near[-1]] else (np.zeros(space.shape[1]), space)
            for same in _runs(own, _EQUAL):
                among = np.full(len(same), own[same].mean())
                yield Eigenspace(kind, among, _told_apart(model, turned[:, same], kind))


def _runs(omega: Floats, near: float) -> list[Indices]:
    """Rising frequencies (n,) in runs without a gap."""
    gaps = np.flatnonzero(np.diff(omega) > near * omega[1:]) + 1
    return np.split(np.arange(len(omega)), gaps)


# ---------------------------------------------------------------------- kinds


def _kinds(model: MassSprings, modes: Floats) -> list[tuple[ModeKind, Floats]]:
    """The space of some modes (n, g), split into those of each kind: modes of one frequency come in any mixture."""
    travel, turn = _travel(model, modes), _turn(model, modes)
    at_place, unturned, still = _unmoved(travel), _unmoved(turn), _unmoved(np.vstack([travel, turn]))
    rotational, translational = _without(at_place, still), _without(unturned, still)
    parts = np.hstack([rotational, translational, still])
    square = parts.shape[1] == modes.shape[1]
    if not square or np.abs(parts.T @ parts - np.eye(len(parts))).max() > _STILL:
        return [(ModeKind.MIXED, modes)]
    kinds = ModeKind.ROTATIONAL, ModeKind.TRANSLATIONAL, ModeKind.PLANET
    return [(kind, modes @ part) for kind, part in zip(kinds, (rotational, translational, still), strict=True) if part.size]


def _travel(model: MassSprings, modes: Floats) -> Floats:
    return _parts(model, modes, [0, 1, 3, 4, 6, 7])


def _turn(model: MassSprings, modes: Floats) -> Floats:
    return _parts(model, modes, [2, 5, 8])


def _parts(model: MassSprings, modes: Floats, rows: list[int]) -> Floats:
    """What members do in modes, over what all do: by way and by energy, for a heavy member moves little, a light one far."""
    places = model.places(modes)
    ways = places[rows] / np.linalg.norm(places, 2)
    return np.vstack([ways, np.sqrt(model.mass[rows])[:, None] * places[rows]])


def _unmoved(parts: Floats) -> Floats:
    """(g, d): an orthonormal basis of the mixtures of g modes in which parts (r, g) rest."""
    _, values, mixtures = np.linalg.svd(parts)
    return mixtures[int((values > _STILL).sum()) :].T


def _without(space: Floats, less: Floats) -> Floats:
    """What is left of a space (g, d) besides another (g, e) within it, as an orthonormal basis."""
    if not space.shape[1]:
        return space
    _, _, mixtures = np.linalg.svd(less.T @ space)
    left: Floats = space @ mixtures[less.shape[1] :].T
    return left


# ---------------------------------------------------------------------- which of them


def _told_apart(model: MassSprings, modes: Floats, kind: ModeKind) -> Floats:
    """Modes of one frequency, the second at rest where the first moves, and so on: not as rounding mixes them; signs set.

    Of a translational pair one travels along x, the other along y.
    """
    places, count = model.places(modes), modes.shape[1]
    sizes = np.linalg.norm(places, axis=1)
    if kind is ModeKind.TRANSLATIONAL and count == 2:
        first = 3 * int(sizes[[0, 3, 6]].argmax())
        rows = np.array([first, first + 1])
    else:
        rows = np.argsort(-np.round(sizes / sizes.max(), 6), kind="stable")[:1]
        rest = places
        for _ in range(count - 1):
            taken = rest[rows[-1]] / np.linalg.norm(rest[rows[-1]])
            rest = rest - np.outer(rest @ taken, taken)
            left = np.linalg.norm(rest, axis=1)
            rows = np.append(rows, int(np.round(left / left.max(), 6).argmax()))
    turned, lower = np.linalg.qr(places[rows].T)
    signs = np.where(np.diag(lower) < 0, -1.0, 1.0)
    result: Floats = modes @ (turned * signs)
    return result

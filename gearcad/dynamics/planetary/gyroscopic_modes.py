"""Natural modes of a planetary train whose carrier turns: Coriolis and centrifugal terms in the frame of the carrier. SI units.

The model is that of J. Lin and R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321: M q'' + W G q' + (K - W^2 K_W) q = 0, with W
the speed of the carrier. Derived from T = m/2 ((x' - W y)^2 + (y' + W x)^2) for each body, and likewise for zeta and eta of a
planet. To this belongs the stiffness of the springs that the centrifugal forces of the planets load: without it a train that is
free to turn would drift away from any position, as the centrifugal force does not turn with the carrier. It is of the same
order as K_W. Stiffness by the forces of the torques does not depend on the speed and is left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, JsonObject, Notice, freeze
from gearcad.dynamics.planetary.planar_model import (
    MeshLine,
    SpringKind,
    TrainMasses,
    TrainSprings,
    all_coordinates,
    mesh_vector,
)
from gearcad.dynamics.planetary.planetary_modes import ModeKind, mass_diagonal, why_mixed

_ROUNDING = 1e-6
"""Share of the highest frequency below which a frequency or a growth is 0 but for rounding: roots of a double root are."""

_TOLD = 0.01
"""Relative change of a natural frequency by the turning carrier from which on a notice tells it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TurningMatrices:
    """Matrices (n, n) of M q'' + W G q' + (K + W^2 K_2) q = 0 in the coordinates of the springs: kg, N/m.

    `gyroscopic` is G in kg, `by_square` K_2 in kg: the stiffness of springs under the centrifugal forces of the planets, less
    the centrifugal forces of displaced bodies.
    """

    mass: Floats
    gyroscopic: Floats
    stiffness: Floats
    by_square: Floats

    def __post_init__(self) -> None:
        freeze(self)

    @classmethod
    def of(cls, springs: TrainSprings, masses: TrainMasses) -> TurningMatrices:
        """Return the matrices of a train. Raises ParameterError where a mass is missing."""
        diagonal, basis = mass_diagonal(springs, masses), springs.basis
        travelling = diagonal.reshape(-1, 3) * [1.0, 1.0, 0.0]
        turning = np.zeros((len(diagonal), len(diagonal)))
        x = np.arange(0, len(diagonal), 3)
        turning[x, x + 1], turning[x + 1, x] = -2 * travelling[:, 0], 2 * travelling[:, 1]
        square = _stiffness_of_loaded_springs(springs, diagonal) - np.diag(travelling.ravel())
        return cls(
            mass=(basis.T * diagonal) @ basis,
            gyroscopic=basis.T @ turning @ basis,
            stiffness=springs.matrix(),
            by_square=basis.T @ square @ basis,
        )

    def roots(self, speed: float, space: Floats, free: int) -> Floats:
        """Return imaginary and real parts (2, d) of the roots in 1/s, by rising frequency, within the span of `space` (n, d).

        `speed` is that of the carrier in 1/s. Of roots that come in pairs the one of positive frequency counts; of two real
        roots the greater. `free` motions turn the train without bending a spring. By symmetry they do so at any speed: their
        roots are 0, and the smallest ones are theirs, of the order of speed^2 over the frequencies, which is left out here.
        """
        lower = np.linalg.cholesky(space.T @ self.mass @ space)
        inverse = np.linalg.solve(lower, space.T)
        gyroscopic = speed * inverse @ self.gyroscopic @ inverse.T
        stiffness = inverse @ (self.stiffness + speed**2 * self.by_square) @ inverse.T
        size = space.shape[1]
        unit = np.sqrt(np.abs(stiffness).max()) or 1.0
        system = np.block([[np.zeros((size, size)), np.eye(size)], [-stiffness / unit**2, -gyroscopic / unit]])
        found = unit * np.linalg.eigvals(system)
        found[np.argsort(np.abs(found))[: 2 * free]] = 0.0
        floor = _ROUNDING * np.abs(found).max()
        found = np.where(np.abs(found.imag) <= floor, 0.0, found.imag) * 1j + np.where(
            np.abs(found.real) <= floor, 0.0, found.real
        )
        kept = found[np.lexsort((-found.real, -found.imag))][:size]
        kept = kept[np.lexsort((kept.real, kept.imag))]
        return np.array([kept.imag, kept.real])


def _stiffness_of_loaded_springs(springs: TrainSprings, diagonal: Floats) -> Floats:
    """Return the stiffness (size, size) over all coordinates, per (1/s)^2, of springs under the centrifugal forces of planets.

    It is the force of each spring times the second derivative of its elongation, and its stiffness times the change of the
    first one, as the planets have moved outwards. The approach of a pair of flanks is
    d = r_1 t_1 + r_2 t_2 - (r_1 + r_2)(phi + inv alpha), with phi and a the direction and the length of the line of centres and
    cos alpha = (r_1 + r_2)/a; a pin moves on its circle about the carrier's axis.
    """
    planar, basis = springs.planar, springs.basis
    distance, size = planar.members[0].radius, len(diagonal)
    outwards = np.zeros(size)
    outwards[9::3] = diagonal[9::3] * distance
    rest = np.linalg.lstsq(springs.matrix(), basis.T @ outwards, rcond=None)[0]
    moved, pressing = basis @ rest, springs.stiffness * (springs.vectors @ rest)
    moved[10::3] -= moved[2]  # the frame stands where the carrier has come to rest
    on_pins, found = outwards.copy(), np.zeros((size, size))
    for member, line in enumerate(planar.meshes, 1):
        forces = pressing[springs.select(SpringKind.MESH, line.name)]
        for planet, (angle, force) in enumerate(zip(planar.angles, forces, strict=True)):
            across, curvature = _mesh_curvature(line, distance, 3 * member, 9 + 3 * planet, float(angle), size)
            vector = mesh_vector(line, member, planet, float(angle), size)
            turned = line.stiffness[planet] * curvature * (across @ moved) * np.outer(vector, across)
            found += force * curvature * np.outer(across, across) + turned + turned.T
            on_pins[9 + 3 * planet] -= force * vector[9 + 3 * planet]
    found[2, 2] += float(on_pins[9::3].sum()) / distance
    return found


def _mesh_curvature(
    line: MeshLine, distance: float, central: int, planet: int, angle: float, size: int
) -> tuple[Floats, float]:
    """Return the direction w (size,) across the line of action, and c (1/m) of its second derivative c w w^T."""
    external, alpha = 1.0 if line.external else -1.0, line.pressure_angle
    sin, cos = np.sin(alpha), np.cos(alpha)
    radial, along = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    across = np.zeros(size)
    across[central : central + 2] = -cos * radial + external * line.sense * sin * along
    across[planet : planet + 2] = cos, -external * line.sense * sin
    return across, float(-external / (distance * sin))


@dataclass(frozen=True, kw_only=True, eq=False)
class GyroscopicModes:
    """Natural frequencies over the speed of the carrier, in the frame of the carrier, without damping.

    `speed` (s,) in rpm, rising from 0; `kinds` (n,) of the modes; `frequency` (s, n) in Hz, rising within each kind; `growth`
    (s, n) in 1/s, above 0 where a mode is unstable. `operating` is the speed of the carrier at the load in rpm, None if there
    is none: it is the last but one of `speed`, or the last.
    """

    speed: Floats
    kinds: tuple[ModeKind, ...]
    frequency: Floats
    growth: Floats
    operating: float | None

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def change(self) -> float:
        """Greatest relative change of a natural frequency above 0 from the carrier at rest to the load; 0 for no load."""
        if self.operating is None:
            return 0.0
        row = int(np.flatnonzero(self.speed == self.operating)[0])
        moving = self.frequency[0] > 0
        changed = np.abs(self.frequency[row, moving] / self.frequency[0, moving] - 1)
        return float(changed.max(initial=0.0))

    @property
    def unstable_from(self) -> float | None:
        """Lowest computed speed of the carrier (rpm) at which a mode grows; None where none does."""
        rows = np.flatnonzero((self.growth > 0).any(axis=1))
        return float(self.speed[rows[0]]) if len(rows) else None

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of frequencies that the turning carrier changes, and of modes that grow."""
        found = []
        if self.change > _TOLD:
            moved = f"the turning carrier moves natural frequencies by up to {100 * self.change:.2g} %"
            words = f"{moved} at {self.operating:.5g} rpm: the Campbell diagram is that of a carrier at rest"
            found.append(Notice("modes-move", words, "modes"))
        if self.unstable_from is not None:
            words = f"a mode is unstable from {self.unstable_from:.5g} rpm of the carrier on"
            found.append(Notice("modes-grow", words, "modes"))
        return tuple(found)

    def to_dict(self) -> JsonObject:
        """Return plain lists: `frequency` and `growth` have a row for each speed."""
        return {
            "carrier_speed": self.speed.tolist(),
            "operating_speed": self.operating,
            "kind": [kind.value for kind in self.kinds],
            "frequency": self.frequency.tolist(),
            "growth": self.growth.tolist(),
            "greatest_change": self.change,
            "unstable_from": self.unstable_from,
        }


def gyroscopic_modes(
    springs: TrainSprings, masses: TrainMasses, highest_speed: float, *, operating: float | None = None, count: int = 21
) -> GyroscopicModes:
    """Return the natural frequencies at `count` speeds of the carrier from 0 to `highest_speed`, and at `operating` (rpm).

    Raises ParameterError where a mass is missing, and for a speed that is not finite.
    """
    for name, value in (("highest_speed", highest_speed), ("operating", operating)):
        if value is not None and not (np.isfinite(value) and value >= 0):
            raise ParameterError(name, value, "must be a finite speed of at least 0 rpm", "rpm")
    matrices = TurningMatrices.of(springs, masses)
    spaces = [(kind, space, _free_turns(springs, space)) for kind, space in _spaces(springs)]
    own = [] if operating is None else [operating]
    speeds = np.unique([*np.linspace(0.0, highest_speed, count), *own])
    roots = np.array([_roots_at(2 * np.pi * speed / 60, matrices, spaces) for speed in speeds.tolist()])
    return GyroscopicModes(
        speed=speeds,
        kinds=tuple(kind for kind, space, _ in spaces for _ in range(space.shape[1])),
        frequency=roots[:, 0] / (2 * np.pi),
        growth=roots[:, 1],
        operating=operating,
    )


def _roots_at(speed: float, matrices: TurningMatrices, spaces: list[tuple[ModeKind, Floats, int]]) -> Floats:
    """Return imaginary and real parts (2, n) of the roots of all spaces one after another, in 1/s."""
    return np.hstack([matrices.roots(speed, space, free) for _, space, free in spaces])


def _spaces(springs: TrainSprings) -> Iterator[tuple[ModeKind, Floats]]:
    """Yield the spaces (n, d) of coordinates in which modes of a kind are, at any speed; one of mixed ones for other trains.

    Planets alike at equal angles: a motion of all planets alike with centrals that turn, one as cos psi and sin psi with
    centrals that travel, and all others with centrals at rest.
    """
    planar, (size, coordinates) = springs.planar, springs.basis.shape
    if why_mixed(planar):
        yield ModeKind.MIXED, np.eye(coordinates)
        return
    waves = np.array([np.cos(planar.angles), np.sin(planar.angles)]).T
    alike = np.ones((planar.planets, 1))
    together = np.linalg.matrix_rank(waves)
    others = np.linalg.svd(np.hstack([alike, waves]).T)[2][1 + together :].T
    parts: tuple[tuple[ModeKind, list[int], Floats], ...] = (
        (ModeKind.ROTATIONAL, [2, 5, 8], alike),
        (ModeKind.TRANSLATIONAL, [0, 1, 3, 4, 6, 7], waves if together == 2 else _column_space(waves)),
        (ModeKind.PLANET, [], others),
    )
    places = _free_places(springs)
    for kind, of_members, of_planets in parts:
        members = np.eye(size)[:, of_members]
        moved = [np.kron(of_planets, np.eye(3)[:, [axis]]) for axis in range(3)]
        planets = np.vstack([np.zeros((9, 3 * of_planets.shape[1])), np.hstack(moved)])
        space = _column_space(np.hstack([members, planets])[places])
        if space.shape[1]:
            yield kind, space


def _free_turns(springs: TrainSprings, space: Floats) -> int:
    """Return how many independent turns of a space (n, d) bend no spring: no member leaves its axis, no planet moves out."""
    rooted = (springs.vectors * np.sqrt(springs.stiffness)[:, None]) @ space
    places = np.array(_free_places(springs))
    off_axis = np.where(places < 9, places % 3 != 2, places % 3 == 0)
    conditions = np.vstack([rooted / np.abs(rooted).max(), space[off_axis]])
    return int(space.shape[1] - np.linalg.matrix_rank(conditions, tol=1e-9))


def _free_places(springs: TrainSprings) -> list[int]:
    """Return the places of the coordinates that can move among all: those that alone make a column of the basis."""
    names = all_coordinates(springs.planar)
    return [names.index(name) for name in springs.coordinates]


def _column_space(vectors: ArrayLike) -> Floats:
    """Return an orthonormal basis (n, d) of the columns."""
    left, values, _ = np.linalg.svd(np.asarray(vectors, float), full_matrices=False)
    result: Floats = left[:, values > 1e-9 * max(values.max(initial=0.0), 1e-300)]
    return result

"""TrainSprings: all springs of a planetary train in one plane: meshes, pins, supports, and what holds the members' turning.

In SI units (N, m, rad). The coordinates stand on the carrier: x, y and u = r theta of carrier and centrals, r the base radius
or the radius of the pins; of each planet zeta outwards, eta along the carrier's rotation, and u = r theta. Elongations are
positive where flanks press. Of helical teeth it is the transverse section: planets do not tilt.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats, Indices
from gearcad.dynamics.planetary.planar import MeshLine, PlanarTrain, planar_train
from gearcad.planetary import PlanetaryTrain

__all__ = ["Spring", "SpringKind", "TrainSprings", "all_coordinates", "springs_of", "train_springs"]


class SpringKind(Enum):
    """What a spring is."""

    MESH = "mesh"
    PIN_RADIAL = "radial"
    PIN_TANGENTIAL = "tangential"
    SUPPORT_X = "x"
    SUPPORT_Y = "y"
    TORSION = "turning"


@dataclass(frozen=True)
class Spring:
    """Of `owner`: a mesh such as "sun-planet", or a member; pins are of the carrier. `planet` counts from 0."""

    kind: SpringKind
    owner: str
    planet: int | None = None

    @property
    def name(self) -> str:
        """Such as "sun-planet 1", "pin 1 radial", "carrier x"; planets are counted from 1."""
        if self.planet is None:
            return f"{self.owner} {self.kind.value}"
        number = self.planet + 1
        return f"{self.owner} {number}" if self.kind is SpringKind.MESH else f"pin {number} {self.kind.value}"


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainSprings:
    """m springs between n coordinates: elongations `vectors` @ q (m), forces `stiffness` times these (N).

    `vectors` (m, n), `stiffness` (m,) in N/m. `coordinates` (n,) are those that can move, such as "sun.x" and "planet 1.zeta";
    `basis` (3 (N + 3), n) makes all from them, in the order carrier, centrals, planets: what is held does not move, and on
    rigid pins planets go with the carrier.
    """

    planar: PlanarTrain
    springs: tuple[Spring, ...]
    vectors: Floats
    stiffness: Floats
    coordinates: tuple[str, ...]
    basis: Floats

    def __post_init__(self) -> None:
        for array in (self.vectors, self.stiffness, self.basis):
            array.flags.writeable = False

    @property
    def names(self) -> tuple[str, ...]:
        """Of the springs."""
        return tuple(spring.name for spring in self.springs)

    @property
    def members(self) -> tuple[str, ...]:
        """Carrier, then centrals."""
        return tuple(member.name for member in self.planar.members)

    def matrix(self, stiffness: Floats | None = None) -> Floats:
        """K = sum k v v^T (n, n), with these stiffnesses or others (m,) in N/m."""
        k = self.stiffness if stiffness is None else stiffness
        result: Floats = (self.vectors.T * k) @ self.vectors
        return result

    def select(self, kind: SpringKind, owner: str | None = None) -> Indices:
        """Places of the springs of a kind, of one owner or of all; those of planets in their order."""
        found = [i for i, each in enumerate(self.springs) if each.kind is kind and owner in (None, each.owner)]
        return np.array(found, np.intp)

    def turning(self, member: str) -> Floats:
        """(n,): turn of a member (rad) per coordinate; so also what a torque of 1 N·m on it does to each of them."""
        place = self.members.index(member)
        return np.asarray(self.basis[3 * place + 2] / self.planar.members[place].radius, float)


def train_springs(
    train: PlanetaryTrain,
    mesh_stiffness: tuple[ArrayLike, ArrayLike],
    *,
    held: Collection[str] | None = None,
    sense: int = 1,
) -> TrainSprings:
    """The springs of a train; see `planar_train` for what is given."""
    return springs_of(planar_train(train, mesh_stiffness, held=held, sense=sense))


def springs_of(planar: PlanarTrain) -> TrainSprings:
    """Lin and Parker's springs, of any set: K = sum k v v^T."""
    names = all_coordinates(planar)
    basis, free = _basis(planar)
    springs, vectors, stiffness = [], [], []
    for spring, k, vector in _all_springs(planar):
        if k:
            springs.append(spring)
            vectors.append(vector)
            stiffness.append(k)
    return TrainSprings(
        planar=planar,
        springs=tuple(springs),
        vectors=np.array(vectors) @ basis,
        stiffness=np.array(stiffness),
        coordinates=tuple(names[place] for place in free),
        basis=basis,
    )


def all_coordinates(planar: PlanarTrain) -> list[str]:
    """Names of the 3 (N + 3) of carrier, centrals and planets."""
    members = [f"{member.name}.{each}" for member in planar.members for each in ("x", "y", "u")]
    return members + [f"planet {n + 1}.{each}" for n in range(planar.planets) for each in ("zeta", "eta", "u")]


def _basis(planar: PlanarTrain) -> tuple[Floats, list[int]]:
    """All coordinates from those that can move, and which these are."""
    size = 9 + 3 * planar.planets
    held = set()
    for place, member in enumerate(planar.members):
        held |= {3 * place, 3 * place + 1} if member.support is None else set()
        held |= {3 * place + 2} if member.torsion is None else set()
    moving = np.diag([float(place not in held) for place in range(size)])
    if planar.pin is None:
        for n, psi in enumerate(planar.angles):
            radial, tangential = _pin_place(psi)
            moving[9 + 3 * n : 11 + 3 * n] = 0.0
            moving[9 + 3 * n] = radial @ moving[:3]
            moving[10 + 3 * n] = tangential @ moving[:3]
            held |= {9 + 3 * n, 10 + 3 * n}
    free = [place for place in range(size) if place not in held]
    return moving[:, free], free


def _pin_place(psi: float) -> tuple[Floats, Floats]:
    """(3,), (3,): how a pin goes outwards, and along the rotation, with x, y, u of the carrier."""
    sin, cos = np.sin(psi), np.cos(psi)
    return np.array([cos, sin, 0.0]), np.array([-sin, cos, 1.0])


def _all_springs(planar: PlanarTrain) -> list[tuple[Spring, float, Floats]]:
    """Each with its stiffness, 0 where there is none, and its vector over all coordinates."""
    size, carrier = 9 + 3 * planar.planets, planar.members[0].name
    result = [
        (Spring(SpringKind.MESH, line.name, n), float(line.stiffness[n]), _mesh_vector(line, place, n, psi, size))
        for place, line in enumerate(planar.meshes, 1)
        for n, psi in enumerate(planar.angles)
    ]
    for n, psi in enumerate(planar.angles):
        kinds = SpringKind.PIN_RADIAL, SpringKind.PIN_TANGENTIAL
        for axis, (kind, along) in enumerate(zip(kinds, _pin_place(psi), strict=True)):
            vector = np.zeros(size)
            vector[:3], vector[9 + 3 * n + axis] = along, -1.0
            result.append((Spring(kind, carrier, n), planar.pin or 0.0, vector))
    ways = SpringKind.SUPPORT_X, SpringKind.SUPPORT_Y, SpringKind.TORSION
    for place, member in enumerate(planar.members):
        for axis, (kind, k) in enumerate(zip(ways, (member.support, member.support, member.torsion), strict=True)):
            result.append((Spring(kind, member.name), k or 0.0, np.eye(size)[3 * place + axis]))
    return result


def _mesh_vector(line: MeshLine, member: int, planet: int, psi: float, size: int) -> Floats:
    """How flanks approach: u + e u_p - x sin(psi - e a) + y cos(psi - e a) - e zeta sin a - eta cos a, e -1 for a ring.

    The other flanks are at -a, and what turns the central the other way presses them.
    """
    e, a = 1.0 if line.external else -1.0, line.sense * line.pressure_angle
    vector = np.zeros(size)
    vector[3 * member : 3 * member + 3] = -np.sin(psi - e * a), np.cos(psi - e * a), 1.0
    vector[9 + 3 * planet : 12 + 3 * planet] = -e * np.sin(a), -np.cos(a), e * line.rim_ratio
    return line.sense * vector

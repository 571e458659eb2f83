"""What harmonics of the mesh frequency do to the members: the forces of the planets add up, or take each other off."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

from gearcad.planetary.phases import MeshPhases, mesh_phases
from gearcad.planetary.train_data import TrainData

__all__ = ["Excited", "HarmonicSum", "excited_modes", "harmonic_sums", "train_harmonics"]

HARMONICS = 6

_ROUNDING = 1e-9
"""Of what all planets in phase would do."""


class Excited(NamedTuple):
    """Which modes of a set a harmonic shakes: rotational ones, by a torque, and translational ones, by a force.

    Neither: the forces of the planets balance, and only modes in which the members rest are shaken.
    """

    rotational: bool
    translational: bool


class HarmonicSum(NamedTuple):
    """Torque and force of a harmonic on a member over those that all planets, in phase and in one direction, would give.

    Torque |sum exp(2 pi i m gamma_n)|/N, force the greater of |sum exp(i (2 pi m gamma_n +- psi_n))|/N.
    """

    harmonic: int
    torque: float
    force: float

    @property
    def excited(self) -> Excited:
        """Which modes it shakes."""
        return Excited(self.torque > 0, self.force > 0)


def excited_modes(teeth: int, planets: int, harmonic: int) -> Excited:
    """Of planets at equal angles, exactly: k = m z mod N is 0 for a torque, 1 or N - 1 for a force; z of the central.

    A planet alone has both.
    """
    remainder = harmonic * teeth % planets
    return Excited(remainder == 0, remainder in (1 % planets, planets - 1))


def harmonic_sums(relative: Sequence[float], angles: Sequence[float], harmonics: int = HARMONICS) -> tuple[HarmonicSum, ...]:
    """Of the harmonics 1, 2, ..., for planets at any `angles` (degrees) with `relative` phases (base pitches)."""
    psi = [math.radians(angle) for angle in angles]
    found = []
    for harmonic in range(1, harmonics + 1):
        turns = [2 * math.pi * harmonic * phase for phase in relative]
        torque = _share(turns)
        forces = (_share([turn + sign * angle for turn, angle in zip(turns, psi, strict=True)]) for sign in (1, -1))
        found.append(HarmonicSum(harmonic, torque, max(forces)))
    return tuple(found)


def train_harmonics(
    train: TrainData, phases: dict[str, MeshPhases] | None = None, harmonics: int = HARMONICS
) -> dict[str, tuple[HarmonicSum, ...]]:
    """Of both meshes of a train by their names."""
    phases = mesh_phases(train) if phases is None else phases
    return {name: harmonic_sums(mesh.relative, train.angles, harmonics) for name, mesh in phases.items()}


def _share(turns: Sequence[float]) -> float:
    """|sum exp(i turn)|/N, 0 where it is rounding."""
    share = abs(sum(cmath.exp(1j * turn) for turn in turns)) / len(turns)
    return share if share > _ROUNDING else 0.0

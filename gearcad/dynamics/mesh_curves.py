"""How the stiffness of a mesh goes over one tooth: shapes of mean 1, at any phase and as Fourier coefficients.

The phase of a mesh is in radians, 2 pi over a tooth. Coefficients are those of sum_n c_n e^(i n phase), n from -count to count,
of which those from 0 on are given.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.errors import ParameterError, plain_numbers, require_number
from gearcad.mesh_cycle import MeshCycle

__all__ = ["CosineStiffness", "CurveStiffness", "StiffnessShape", "cycle_stiffness", "square_stiffness"]

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


class StiffnessShape(ABC):
    """Mesh stiffness over its mean, positive everywhere."""

    @abstractmethod
    def values(self, phase: ArrayLike) -> Floats:
        """At any phases (rad)."""

    @abstractmethod
    def coefficients(self, count: int) -> Complexes:
        """Fourier coefficients (count + 1,)."""

    @property
    def jumps(self) -> Floats:
        """Phases from 0 to 2 pi where the stiffness jumps."""
        return np.zeros(0)


@dataclass(frozen=True, kw_only=True)
class CosineStiffness(StiffnessShape):
    """1 - variation cos(phase): the variation p of (2.8) of J. Osinski's paper."""

    variation: float

    def __post_init__(self) -> None:
        plain_numbers(self)
        # From 1 on the teeth would pull at some phase.
        require_number("variation", self.variation, at_least=0, below=1)

    def values(self, phase: ArrayLike) -> Floats:
        """At any phases (rad)."""
        return np.asarray(1 - self.variation * np.cos(phase), float)

    def coefficients(self, count: int) -> Complexes:
        """Fourier coefficients (count + 1,)."""
        result = np.zeros(count + 1, complex)
        result[0] = 1
        result[1:2] = -self.variation / 2
        return result


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveStiffness(StiffnessShape):
    """Straight lines between corners: `phase` (n,) rises over exactly 2 pi, and stands twice where `stiffness` (n,) jumps.

    The stiffness may have any unit: it is divided by its mean. Where both ends differ, it jumps there too.
    """

    phase: Floats
    stiffness: Floats

    def __post_init__(self) -> None:
        phase, stiffness = (np.array(each, float) for each in (self.phase, self.stiffness))
        steps = np.diff(phase)
        if phase.shape != stiffness.shape or len(phase) < 2 or not np.isfinite(phase).all() or (steps < 0).any():
            raise ParameterError("phase", f"{len(phase)} values", "must rise, with one stiffness each")
        if abs(phase[-1] - phase[0] - 2 * np.pi) > 1e-9:
            raise ParameterError("phase", float(phase[-1] - phase[0]), "must rise over exactly 2 pi rad", "rad")
        if not np.isfinite(stiffness).all() or stiffness.min() <= 0:
            raise ParameterError("stiffness", float(stiffness.min()), "must be above 0 at every phase of the mesh")
        mean = steps @ (stiffness[1:] + stiffness[:-1]) / (4 * np.pi)
        for name, array in (("phase", phase), ("stiffness", stiffness / mean)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    def values(self, phase: ArrayLike) -> Floats:
        """At any phases (rad)."""
        start = self.phase[0]
        within = np.mod(np.asarray(phase, float) - start, 2 * np.pi) + start
        return np.asarray(np.interp(within, self.phase, self.stiffness), float)

    def coefficients(self, count: int) -> Complexes:
        """Fourier coefficients (count + 1,), exactly those of the straight lines.

        Integrated by parts twice: i n c_n is the coefficient of the slope, plus what the jumps add.
        """
        order = np.arange(1, count + 1)[:, None]
        waves = np.exp(-1j * order * self.phase)
        steps, rises = np.diff(self.phase), np.diff(self.stiffness)
        straight = steps > 0
        slopes = rises[straight] / steps[straight]
        by_slopes = (np.diff(waves, axis=1)[:, straight] @ slopes) * 1j / order[:, 0]
        by_jumps = waves[:, :-1][:, ~straight] @ rises[~straight] + waves[:, 0] * (self.stiffness[0] - self.stiffness[-1])
        return np.concatenate([[1.0 + 0j], (by_slopes + by_jumps) / (2j * np.pi * order[:, 0])])

    @property
    def jumps(self) -> Floats:
        """Phases from 0 to 2 pi where the stiffness jumps."""
        found = self.phase[:-1][(np.diff(self.phase) == 0) & (np.diff(self.stiffness) != 0)]
        # What interpolation leaves between two ends that should agree is no jump.
        if abs(self.stiffness[0] - self.stiffness[-1]) > 1e-9:
            found = np.append(found, self.phase[0])
        return np.unique(np.mod(found, 2 * np.pi))


def square_stiffness(contact_ratio: float, pair_ratio: float = 1.0) -> CurveStiffness:
    """The square wave of a contact ratio: n + 1 pairs of teeth from phase 0 on for the fraction of it over n, n for the rest.

    `pair_ratio` is the stiffness of the pair that comes last over that of each of the others: 1 where all are alike.
    """
    require_number("contact_ratio", contact_ratio, at_least=1, at_most=10)
    require_number("pair_ratio", pair_ratio, above=0)
    fewer = int(contact_ratio)
    end = 2 * np.pi * (contact_ratio - fewer)
    more = fewer + (pair_ratio if end else 0.0)
    phase = np.array([0, end, end, 2 * np.pi])
    return CurveStiffness(phase=phase, stiffness=np.array([more, more, fewer, fewer], float))


def cycle_stiffness(cycle: MeshCycle, *, tangent: bool = True) -> CurveStiffness:
    """The curve of a MeshCycle; phase 0 is roll angle 0. Tangent stiffness is that of small vibrations about the load."""
    turn = 2 * np.pi / cycle.pitch_angle
    phase = cycle.roll_angle * turn
    phase[-1] = phase[0] + 2 * np.pi
    return CurveStiffness(phase=phase, stiffness=cycle.tangent_stiffness if tangent else cycle.mesh_stiffness)

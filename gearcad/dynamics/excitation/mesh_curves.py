"""How the stiffness of a mesh goes over one tooth: shapes of mean 1, at any phase and as Fourier coefficients.

The phase of a mesh is in radians, 2 pi over a tooth. Coefficients are those of sum_n c_n e^(i n phase), n from -count to count,
of which those from 0 on are given.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Complexes, Floats
from gearcad.dynamics.excitation.polyline import Polyline
from gearcad.errors import ParameterError, plain_numbers, require_number
from gearcad.mesh_cycle import MeshCycle

__all__ = ["CosineStiffness", "CurveStiffness", "StiffnessShape", "cycle_phase", "cycle_stiffness", "square_stiffness"]


class StiffnessShape(ABC):
    """Mesh stiffness over its mean, positive everywhere."""

    @abstractmethod
    def values(self, phase: ArrayLike) -> Floats:
        """Stiffness over its mean, at any phases (rad)."""

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
        """Stiffness over its mean, at any phases (rad)."""
        return np.asarray(1 - self.variation * np.cos(phase), float)

    def coefficients(self, count: int) -> Complexes:
        """Fourier coefficients (count + 1,)."""
        result = np.zeros(count + 1, complex)
        result[0] = 1
        result[1:2] = -self.variation / 2
        return result


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveStiffness(StiffnessShape):
    """Straight lines between corners, as a Polyline has them, of `stiffness` (n,) in any unit: it is divided by its mean."""

    phase: Floats
    stiffness: Floats

    def __post_init__(self) -> None:
        line = Polyline(phase=self.phase, height=self.stiffness)
        if line.height.min() <= 0:
            raise ParameterError("stiffness", float(line.height.min()), "must be above 0 at every phase of the mesh")
        line = Polyline(phase=line.phase, height=line.height / line.mean)
        object.__setattr__(self, "phase", line.phase)
        object.__setattr__(self, "stiffness", line.height)

    @cached_property
    def line(self) -> Polyline:
        """The curve itself, of mean 1."""
        return Polyline(phase=self.phase, height=self.stiffness)

    def values(self, phase: ArrayLike) -> Floats:
        """Stiffness over its mean, at any phases (rad)."""
        return self.line.values(phase)

    def coefficients(self, count: int) -> Complexes:
        """Fourier coefficients (count + 1,), exactly those of the straight lines."""
        return self.line.coefficients(count)

    @property
    def jumps(self) -> Floats:
        """Phases from 0 to 2 pi where the stiffness jumps."""
        return self.line.jumps


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
    return CurveStiffness(phase=cycle_phase(cycle), stiffness=cycle.tangent_stiffness if tangent else cycle.mesh_stiffness)


def cycle_phase(cycle: MeshCycle) -> Floats:
    """Phases (n,) of the roll angles of a MeshCycle, over exactly 2 pi."""
    phase = cycle.roll_angle * (2 * np.pi / cycle.pitch_angle)
    phase[-1] = phase[0] + 2 * np.pi
    return phase

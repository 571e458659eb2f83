"""A System and what drives it: what every balance of forces, and every motion that comes of one, begins with. SI units."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.response.flexibility import StaticState, senses, static_state
from gearcad.dynamics.trains.system import System

__all__ = ["Driven", "pressed"]


@dataclass(frozen=True, eq=False)
class Driven:
    """A System under an Excitation of its meshes."""

    system: System
    excitation: Excitation

    @cached_property
    def static(self) -> StaticState:
        """At rest under the mean load. Raises GeometryError and SolverError."""
        return static_state(self.system)

    @cached_property
    def senses(self) -> Floats:
        """Which flanks (m,) the mean load presses: 1 for those in front, -1 for those at the back."""
        return senses(self.system)

    @cached_property
    def scale(self) -> float:
        """Static deflection (m), the greatest of all meshes."""
        return float(np.abs(self.static.approach).max())


def pressed(gap: Floats, backlashes: Floats, senses: Floats) -> Floats:
    """g(y - e) in m: what the flanks that carry the load (`senses`), or those behind them, are pressed in; 0 where they part.

    A backlash of nan is that of flanks that never part.
    """
    back = np.minimum(senses * gap + np.where(np.isnan(backlashes), 0.0, backlashes), 0.0)
    return np.where(np.isnan(backlashes), gap, senses * (np.maximum(senses * gap, 0.0) + back))

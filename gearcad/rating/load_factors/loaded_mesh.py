"""LoadedMesh: a pair under a load, as all load factors see it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.per_gear import PerGear
from gearcad.rating.deviations import accuracy_grades
from gearcad.rating.dynamic_factor import flank_wear
from gearcad.rating.editions import Edition
from gearcad.rating.iso6336_1 import MeshStiffness, mesh_stiffness
from gearcad.rating.options import RatingOptions
from gearcad.rating.running_in import FlankWear

__all__ = ["LoadedMesh"]


@dataclass(frozen=True, kw_only=True)
class LoadedMesh:
    """What is rated, and what follows from it at once. Loads in N and N/mm, lengths in mm, speed in m/s."""

    pair: GearPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions

    @cached_property
    def width(self) -> float:
        """b: the common face width."""
        return self.pair.common_width.width

    @cached_property
    def specific_load(self) -> float:
        """F_t K_A K_gamma/b."""
        force = 2000 * abs(self.load.torque) / self.pair.pinion.reference_diameter
        return force * self.load.application_factor * self.options.mesh_load_factor / self.width

    @cached_property
    def stiffness(self) -> MeshStiffness:
        """At that load."""
        return mesh_stiffness(self.pair, self.materials, self.specific_load)

    @cached_property
    def speed(self) -> float:
        """v at the reference circle."""
        return math.pi * self.pair.pinion.reference_diameter * abs(self.load.speed) / 60_000

    @cached_property
    def wear(self) -> FlankWear:
        """How the flanks run in. Raises ParameterError where that depends on a limit that is not known."""
        return flank_wear(self.materials)

    @cached_property
    def grade(self) -> int:
        """The accuracy grade of the coarser gear."""
        return max(accuracy_grades(self.pair, self.options))

    def cited(self, clause: str, method: str) -> str:
        """A clause of ISO 6336-1:2006, which later editions share as far as is known; DIN 3990-1 is cited without."""
        edition = self.options.standard
        if edition is Edition.DIN_1987:
            return f"{edition.dated_part(1)} ({method})"
        return f"{Edition.ISO_2006.dated_part(1)}, {clause} ({method})"

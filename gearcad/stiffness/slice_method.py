"""What methods share that know one pair of teeth at a time: slices of the pair side by side."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property

from gearcad.arrays import Floats
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.per_gear import PerGear
from gearcad.stiffness.method import StiffnessMethod
from gearcad.stiffness.slices import SinglePair, Slices

__all__ = ["SliceMethod"]


@dataclass(frozen=True, kw_only=True)
class SliceMethod(StiffnessMethod):
    """A method that tells how far one pair of teeth gives way, at any place on the line of action."""

    @cached_property
    def slices(self) -> Slices:
        """The zone of contact."""
        return Slices(self.mounted)

    @abstractmethod
    def single(self, lengths: Floats, load: Load) -> SinglePair:
        """One pair of teeth that carries all of the load, at places (n,) from T1 on the line of action (mm)."""

    def curvatures(self, lengths: Floats) -> PerGear[Floats]:
        """Radii of curvature (n,) of both flanks in the section across the line of contact (mm)."""
        lean = math.cos(math.radians(self.mounted.pinion.base_helix_angle))
        return PerGear(lengths / lean, (self.mounted.base_tangent.length - lengths) / lean)

    @property
    def to_transverse(self) -> float:
        """1000/cos beta_b: from mm²/N of the section across the line of contact to mm·µm/N of the transverse one."""
        return 1000 / math.cos(math.radians(self.mounted.pinion.base_helix_angle))

    def _cycle(self, load: Load, count: int) -> MeshCycle:
        curves = self.slices.curves(self.single(self.slices.lengths, load), count)
        return MeshCycle(
            **self.inputs(load),
            transmission_error=self.force(load) / curves.mesh_stiffness,
            **curves._asdict(),
        )

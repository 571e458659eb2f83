"""ISO 6336-1 Method B (the same in DIN 3990-1): the mean, no course over the mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.rating import rate
from gearcad.stiffness.method import StiffnessMethod

__all__ = ["MethodB"]


@dataclass(frozen=True, kw_only=True)
class MethodB(StiffnessMethod):
    """c' and c_gamma of ISO 6336-1:2006, clause 9: c_gamma_beta is its secant stiffness, c_gamma_alpha its tangent stiffness.

    C_R by web and rim of the bodies; below 100 N/mm both fall with the fourth root of the load.
    """

    name = "iso6336"
    title = "ISO 6336-1, Method B"
    holds = ("all that Weber and Banaschek hold, times 0.8 from measurements (C_M)",)

    def _cycle(self, load: Load, count: int) -> MeshCycle:
        rating = rate(self.mounted, self.material, load)
        of = rating.stiffness
        half = 180 / self.mounted.pinion.teeth
        secant, tangent = (np.full(2, each * self.width) for each in (of.mesh_beta, of.mesh_alpha))
        return MeshCycle(
            **self.inputs(load),
            roll_angle=np.array([-half, half]),
            mesh_stiffness=secant,
            tangent_stiffness=tangent,
            transmission_error=self.force(load) / secant,
            single_stiffness=of.single * self.width,
            mean_only=True,
            notes=tuple(text for text in rating.warnings if text.startswith(("c'", "c_gamma", "ISO 6336"))) + self.left_out,
        )

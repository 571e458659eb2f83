"""ISO 6336-1 Method B (the same in DIN 3990-1): the mean, no course over the mesh."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.notice import Notice
from gearcad.rating.rate import rate
from gearcad.stiffness.method import StiffnessMethod

__all__ = ["MethodB"]


@dataclass(frozen=True, kw_only=True)
class MethodB(StiffnessMethod):
    """c' and c_gamma of ISO 6336-1:2006, clause 9: c_gamma_beta is its secant stiffness, c_gamma_alpha its tangent stiffness.

    C_R by web and rim of the bodies; below 100 N/mm both fall with the fourth root of the load.
    """

    name = "iso6336"
    title = "ISO 6336-1, Method B"
    mean_only = True
    holds = ("all that Weber and Banaschek hold, times 0.8 from measurements (C_M)",)

    def _cycle(self, load: Load, count: int) -> MeshCycle:
        found = rate(self.mounted, self.material, load).stiffness
        half = 180 / self.mounted.pinion.teeth
        secant, tangent = (np.full(2, each * self.width) for each in (found.mesh_beta, found.mesh_alpha))
        return MeshCycle(
            **self.inputs(load),
            roll_angle=np.array([-half, half]),
            mesh_stiffness=secant,
            tangent_stiffness=tangent,
            transmission_error=self.force(load) / secant,
            single_stiffness=found.single * self.width,
        )

    def notices(self, load: Load) -> Iterator[Notice]:
        for notice in rate(self.mounted, self.material, load).notices:
            if notice.code.startswith(("scope-", "stiffness-")):
                yield notice
        yield from super().notices(load)

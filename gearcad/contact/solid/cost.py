"""What solid bodies are expected to take, from the sizes of their meshes: laws of the work, factors measured."""

from __future__ import annotations

import math
from typing import NamedTuple

from gearcad.meshing.section.swept import SweptMesh

__all__ = ["POSITION_SECONDS", "BodyCost", "body_cost"]

POSITION_SECONDS = 0.025
"""For one position of a mesh cycle."""

_ROWS = 8
"""Unit loads in each layer, at the most."""

_CONDENSING = 1.2e-6
_FIELDS = 8e-6
_SOLVING = 1e-8
_JOINING = 1e-9
"""Seconds: per quadrangles^1.5 layers^3; per quadrangle, layer and load; per dof, layer, load and tooth; per cube of a cut's
dofs and doubling of the ring. Measured on one core of a server of the 2020s; within a third for 2 to 13 thousand nodes."""

_FRONTS, _COPIES, _CHAINS = 18e3, 3.0, 12.0
"""Bytes per quadrangle and squared layers of the factors, copies of the displacements, and of the ring's matrices."""


class BodyCost(NamedTuple):
    """Seconds of the steps of one body - fields of the loads, condensation, the rest - and bytes while they run."""

    fields: float
    condensation: float
    solution: float
    memory: float

    @property
    def seconds(self) -> float:
        """Of all steps."""
        return self.fields + self.condensation + self.solution


def body_cost(mesh: SweptMesh, teeth: int, neighbours: int) -> BodyCost:
    """What the bodies of a ring of `teeth` with so many `neighbours` on each side of the loaded one take."""
    quads, layers, dofs = len(mesh.section.quads), mesh.layers, 3 * mesh.nodes
    loads, told = _ROWS * layers, 2 * neighbours + 1
    cut = 3 * len(mesh.over(mesh.section.ahead))
    return BodyCost(
        fields=_FIELDS * quads * layers * loads,
        condensation=_CONDENSING * quads**1.5 * layers**3,
        solution=_SOLVING * dofs * layers * loads * told + _JOINING * cut**3 * math.log2(max(teeth, 2)),
        memory=_FRONTS * quads * layers**2 + 8 * _COPIES * told * dofs * loads + 8 * _CHAINS * (2 * cut) ** 2,
    )

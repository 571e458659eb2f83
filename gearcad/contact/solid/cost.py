"""What solid bodies are expected to take, from the sizes of their meshes: laws of the work, factors measured."""

from __future__ import annotations

import math
from typing import NamedTuple

from gearcad.meshing.section.swept import SweptMesh

__all__ = ["KEPT", "LEFT", "POSITION_SECONDS", "BodyCost", "body_cost"]

POSITION_SECONDS = 0.025
"""For one position of a mesh cycle."""

_ROWS = 8
"""Unit loads in each layer, at the most."""

_OPERATIONS, _FACTORS = 4.0e3, 370.0
"""Of the condensation, per squared quadrangles and layers^1.93, and numbers that are kept of it, per quadrangles^1.4 and
layers^1.3: within a fifth for 126 to 324 quadrangles and 5 to 63 layers."""

_ELIMINATING, _ASSEMBLING = 3.5e-11, 4.5e-4
_FIELDS = 3.5e-6
_SOLVING = 1.6e-10
_JOINING = 3.4e-11
"""Seconds: per operation, and per hexahedron; per quadrangle, layer and load; per number that is kept, load and tooth, and the
loaded one once more; per cube of a cut's dofs and step of putting rows together. Measured on one core of a server of the 2020s:
within a third for some 5 to 30 thousand nodes; the smallest meshes, which are more than dense algebra, up to 2.2 times that.
"""

_SPAN, _DOUBLED = 5.0, 3.0
"""Steps of putting one more tooth on both sides of a row, and of doubling a row."""

_FRONTS, _ROWS_OF_CUTS, _COPIES, _AT_ONCE = 2.2, 8.0, 1.6, 72
"""Numbers in memory: copies of what is kept, matrices of a cut, and copies of all dofs for so many loads at once."""

_READ = 0.35
"""Numbers in memory per dof, load and tooth that is told: the displacements that are read, and their copies.

With these the greatest memory of pairs on two cores is told at 0.99 to 1.09 of what was measured, libraries included, for 5 to
30 thousand nodes and 6 to 32 layers, a ring among them.
"""

LEFT, KEPT = 0.2, 0.72
"""Memory that is left of bodies without factors, and with them, over the most that they take."""


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
    operations, factors = _OPERATIONS * quads**2 * layers**1.93, _FACTORS * quads**1.4 * layers**1.3
    steps = _SPAN * neighbours + _DOUBLED * math.log2(max(teeth - 2 * neighbours, 2))
    numbers = _FRONTS * factors + _ROWS_OF_CUTS * cut**2 + _COPIES * dofs * min(loads, _AT_ONCE) + _READ * told * dofs * loads
    return BodyCost(
        fields=_FIELDS * quads * layers * loads,
        condensation=_ELIMINATING * operations + _ASSEMBLING * quads * layers,
        solution=_SOLVING * factors * loads * (told + 1) + _JOINING * cut**3 * steps,
        memory=8 * numbers,
    )

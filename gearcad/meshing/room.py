"""Whether what is asked for can be meshed at all: told before it begins."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcad.errors import GeometryError, InputError, ParameterError
from gearcad.machine import machine_memory
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.expected import expected_memory
from gearcad.meshing.gear_plan import SectorsPlan
from gearcad.meshing.plan import MeshPlan

__all__ = ["require_room"]

_MOST_NODES = int(np.iinfo(np.int32).max)
"""Elements number their nodes so, and files do."""

_MARGIN = 1.25
"""By how much larger than what would just do a size is that is told: amounts follow sizes roughly."""


def require_room(plan: MeshPlan) -> None:
    """Raise ParameterError, or GeometryError where nobody asks for an amount, for more nodes than can be numbered, or more
    memory than the machine has. Of tetrahedra nobody knows before.
    """
    if plan.element is Element.TRI6:
        # Triangles are counted by meshing a sector: there must not be too many for that.
        quads = {
            name: replace(each, element=Element.QUAD8) for name, each in plan.gears.items() if isinstance(each, SectorsPlan)
        }
        _require(replace(plan, gears=quads))
    _require(plan)


def _require(plan: MeshPlan) -> None:
    amount = plan.amount
    if amount is None:
        return
    nodes, needed, there = _most_nodes(plan), expected_memory(amount), machine_memory()
    excess = max(nodes / _MOST_NODES, needed / there)
    if excess > 1:
        many = f", of which a file numbers at most {_MOST_NODES}" if nodes > _MOST_NODES else ""
        text = (
            f"makes {amount.elements:.3g} {plan.element.value} with {amount.nodes:.3g} nodes{many}; "
            f"they take about {needed / 1e9:.3g} GB of memory, and there are {there / 1e9:.3g} GB"
        )
        raise _refusal(plan, text, excess)


def _most_nodes(plan: MeshPlan) -> int:
    """Nodes of the largest file; a pair in mesh is one."""
    every = [amount.nodes for each in plan.gears.values() if (amount := each.amount) is not None]
    return sum(every) if plan.pair is not None else max(every)


def _refusal(plan: MeshPlan, text: str, excess: float) -> InputError:
    """The error for what is too large by a factor, with what would do."""
    options, excess = plan.options, _MARGIN * excess
    if options.elements is not None:
        return ParameterError("elements", options.elements, f"{text}; about {options.elements / excess:.2g} would do")
    if options.size is not None:
        larger = options.size * excess ** (1 / plan.element.shape.dimension)
        return ParameterError("size", options.size, f"{text}; about {larger:.2g} mm would do", "mm")
    return GeometryError("what", plan.options.what, f"{text}; a larger size, or less of the gear, would do")

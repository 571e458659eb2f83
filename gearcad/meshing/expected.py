"""What meshes will come to, and take, before they are made."""

from __future__ import annotations

from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.sizing import Amount
from gearcad.meshing.plan import MeshPlan
from gearcad.progress import Expected
from gearcad.reprs import grouped

__all__ = ["expected_memory", "expected_mesh"]

_SECONDS = {Element.TRI6: 1e-5, Element.QUAD8: 8e-6, Element.HEX8: 6e-6, Element.HEX20: 1.2e-5}
"""To mesh, judge and write an element in the usual formats."""

_BEFORE = 0.5
"""Seconds that it takes at least."""

_COPIES, _IMPORTS = 2.2, 1e8
"""Memory at the most over that of nodes and elements, and what there is before."""


def expected_mesh(plan: MeshPlan) -> Expected | None:
    """What a mesh is expected to be and to take; None for tetrahedra, of which nobody knows."""
    amount = plan.amount
    if amount is None:
        return None
    seconds = _BEFORE + _SECONDS[plan.element] * amount.elements
    makes = f"makes {grouped(amount.elements)} {plan.element.value}, {grouped(amount.nodes)} nodes"
    return Expected(seconds, expected_memory(amount), makes)


def expected_memory(amount: Amount) -> float:
    """Bytes that meshing, judging and writing so much take at the most."""
    return _IMPORTS + _COPIES * amount.bytes

"""Whether the machine has memory for solid bodies: told before they are begun."""

from __future__ import annotations

from gearcad.check.solid.expected import expected_solid
from gearcad.check.task import CheckTask
from gearcad.errors import ParameterError
from gearcad.machine import machine_memory

__all__ = ["require_room"]


_GROWTH = 4.0
"""Power of the refinement with which memory grows: of edges and layers together."""

_MARGIN = 1.25
"""By how much less than what would just do the refinement that is told asks for: memory is known roughly."""


def require_room(task: CheckTask) -> None:
    """Raise ParameterError for bodies that take more memory than the machine has, with what would do."""
    needed, there = expected_solid(task).memory, machine_memory()
    if needed <= there:
        return
    coarser = task.options.refinement * (there / needed / _MARGIN) ** (1 / _GROWTH)
    fewer = ", or fewer without convergence" if task.options.refines else ""
    raise ParameterError(
        "check.refinement",
        task.options.refinement,
        f"the solid bodies take about {needed / 1e9:.3g} GB of memory{fewer}, and there are {there / 1e9:.3g} GB; "
        f"about {coarser:.2g} would do",
    )

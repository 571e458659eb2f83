"""The mesh stiffness of a check beside that of other methods: in closed form, at the load of the check."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

from gearcad.check.task import CheckTask
from gearcad.errors import GearcadError
from gearcad.mounting import Mounting
from gearcad.stiffness import CLOSED_FORMS, StiffnessComparison, StiffnessMethod, compare_methods
from gearcad.threads import one_thread

__all__ = ["StiffnessMethods", "stiffness_methods"]


class StiffnessMethods(NamedTuple):
    """The closed forms and the model of a check, in this order; None for a `reason` where they cannot be had."""

    comparison: StiffnessComparison | None
    reason: str = ""

    def to_dict(self) -> dict[str, Any]:
        """The figures of each as in `stiffness.json`, which has their curves too; stiffness in N/µm."""
        if self.comparison is None:
            return {"methods": {}, "left_out": {}, "reason": self.reason}
        document = self.comparison.to_dict()
        for method in document["methods"].values():
            del method["mesh_cycle"]
        return {"methods": document["methods"], "left_out": document["left_out"], "reason": ""}


def stiffness_methods(task: CheckTask, own: Callable[[Mounting], StiffnessMethod], positions: int) -> StiffnessMethods:
    """The check's `own` model, at its own even positions, beside the closed forms."""
    mounting = replace(task.mounting, centre_distance_change=0.0)  # the pair is as mounted already
    try:
        closed = compare_methods(task.pair, task.material, task.load, CLOSED_FORMS, body=task.options.body, mounting=mounting)
        # Positions and torque of the check itself: solid bodies know what they answer there.
        with one_thread():
            cycle = own(mounting)(task.load, positions)
    except GearcadError as error:
        return StiffnessMethods(None, str(error))
    return StiffnessMethods(replace(closed, cycles=(*closed.cycles, cycle)))

"""Why the root stress in the plane and that of ISO 6336 differ: the load's place, its sharing, the width, and what remains."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.check.explanation import Explanation, RootCompared, root_compared
from gearcad.check.load_share import LoadShare
from gearcad.check.plane.summary import PlaneSummary
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.meshing.section.outline import Side
from gearcad.per_gear import PerGear, Role

__all__ = ["PlaneRootExplanation", "explain_roots", "root_at_single_contact"]


@dataclass(frozen=True, kw_only=True)
class PlaneRootExplanation(Explanation):
    """With all of the load on one pair of teeth at its `outer_point` the finite elements have `single_contact` (MPa).

    There a pair carries the part `load_share` of the load. `rim_compression` (MPa) is that of a rim that bends, None of one
    that does not; `rim_thickness_factor` is Y_B.
    """

    compared: RootCompared
    outer_point: str
    single_contact: float
    load_share: float
    rim_thickness_factor: float
    rim_compression: float | None


def root_at_single_contact(cycle: PlaneCycle, role: Role) -> float:
    """Root tension (MPa) of a gear with all of the load on one pair at its outer point, D or B."""
    model, path = cycle.model, cycle.model.pair.path_of_contact
    length = PerGear(path.D, model.line.whole - path.B).pick(role)
    load = (0, length, model.force(cycle.torque))
    return model.fillets.pick(role).extreme(Side.LEFT_FILLET, [load]).stress


def explain_roots(
    task: CheckTask, cycle: PlaneCycle, summary: PlaneSummary, load_share: LoadShare
) -> PerGear[PlaneRootExplanation]:
    """Of both gears."""
    compared = root_compared(task, cycle, summary)
    path, supports = task.pair.path_of_contact, task.body.supports(task.pair)
    outer = PerGear(("D", path.D), ("B", path.B))

    def explained(role: Role) -> PlaneRootExplanation:
        letter, place = outer.pick(role)
        bends = supports.pick(role).bends
        return PlaneRootExplanation(
            compared=compared.pick(role),
            outer_point=letter,
            single_contact=root_at_single_contact(cycle, role),
            load_share=load_share.at(place),
            rim_thickness_factor=task.rating.roots.pick(role).rim_thickness_factor,
            rim_compression=summary.root_compression.pick(role) if bends else None,
        )

    return PerGear.each(explained)

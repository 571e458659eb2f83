"""The check in the plane: one mesh cycle by finite elements, refined to tell its error, and judged."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.check.convergence import FACTORS, FEW_POSITIONS, three_meshes
from gearcad.check.extremes import PLANE
from gearcad.check.notices import common_notices
from gearcad.check.options import Model
from gearcad.check.plane.judge import compare_plane
from gearcad.check.plane.result import PlaneCheck
from gearcad.check.plane.summary import summarise_plane
from gearcad.check.relief_start import relief_starts, start_comparisons, start_notices
from gearcad.check.sweep import sweep_points
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.limits import plane_pressure, thin_faces, wide_contacts
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.meshing.section import MeshSizes
from gearcad.notice import Notice
from gearcad.progress import Agenda

__all__ = ["PLANE_MEMORY", "check_plane", "plane_model", "plane_notices", "plane_steps"]

_WORTH_A_WORD = 0.01
"""How much wider than the mesh a root carries before it is told."""

_BODIES = (0.1, 0.13)
"""Seconds for two bodies: whatever their mesh, and times the square of its refinement."""

_POSITION, _SOUGHT, _SINGLE, _RATING = 0.003, 20, 25, 0.5
"""Seconds for a position; how many are sought between those of a cycle, and of one pair alone; seconds for the rest."""

PLANE_MEMORY = 0.4e9
"""Bytes."""


def plane_steps(task: CheckTask) -> dict[str, float]:
    """Seconds expected of each step, in order."""

    def bodies(factor: float) -> float:
        whatever, refined = _BODIES
        return whatever + refined * (factor * task.options.refinement) ** 2

    few = (FEW_POSITIONS + _SOUGHT) * _POSITION
    own = (task.options.positions_of(Model.PLANE) + _SOUGHT + _SINGLE) * _POSITION
    others = [bodies(factor) + own for factor in FACTORS if factor != 1] if task.options.refines else []
    return {
        "mesh cycle": bodies(1.0) + own,
        "convergence": sum(others),
        "torque sweep": len(task.torques) * few,
        "rating": _RATING,
    }


def check_plane(task: CheckTask, tell: Agenda) -> PlaneCheck:
    """Check in the transverse section through the middle of the common face width. Raises what `check_pair` does."""
    tell("mesh cycle")
    model = plane_model(task)
    cycle = PlaneCycle.run(model, task.torque, task.options.positions_of(Model.PLANE)).searched(PLANE)
    summary = summarise_plane(cycle, model.single_stiffness(task.torque))
    starts = relief_starts(cycle)
    tell("convergence")
    convergence = three_meshes(_refined(task, cycle)) if task.options.refines else ()
    tell("torque sweep")
    sweep = sweep_points(cycle, task.torques)
    tell("rating")
    comparisons = (*compare_plane(task, cycle, summary, convergence), *start_comparisons(task, starts))
    notices = (
        *common_notices(task, cycle, summary),
        *plane_notices(task),
        *wide_contacts(cycle),
        *start_notices(task, starts),
    )
    return PlaneCheck(
        task=task,
        cycle=cycle,
        summary=summary,
        sweep=sweep,
        convergence=convergence,
        comparisons=comparisons,
        notices=notices,
        relief_starts=starts,
    )


def plane_model(task: CheckTask, factor: float = 1.0) -> PlanePair:
    """Both sections of a task, their elements `factor` times smaller than it asks for. Raises what `check_pair` does."""
    options = task.options
    sizes = MeshSizes().refined(factor * options.refinement)
    error = task.mounting.pitch_error
    return plane_pair(task.pair, task.material, plane=options.plane_state, body=task.body, sizes=sizes, pitch_error=error)


def _refined(task: CheckTask, middle: PlaneCycle) -> Iterator[PlaneCycle]:
    """Yield the cycles of coarser, own and finer meshes at as many positions: the middle one has the figures that are told."""
    for factor in FACTORS:
        if factor == 1:
            yield middle
        else:
            positions = task.options.positions_of(Model.PLANE)
            yield PlaneCycle.run(plane_model(task, factor), task.torque, positions).searched(PLANE)


def plane_notices(task: CheckTask) -> Iterator[Notice]:
    """What a plane does not know of these bodies."""
    yield from thin_faces(task.pair, task.material, task.options.plane_state)
    yield from plane_pressure(task.material, task.options.plane_state)
    yield from _wider_gears(task)
    yield from _left_out(task)


def _wider_gears(task: CheckTask) -> Iterator[Notice]:
    """Gears whose root carries over more than the common width."""
    common = task.pair.common_width.width
    for role, rating in task.rating.roots.items():
        own = task.pair.gears.pick(role).face_width
        if rating.width > (1 + _WORTH_A_WORD) * common:
            carry = f"by {task.rating.edition.part(3)} {rating.width:.4g} mm carry at its root"
            yield Notice(
                "wider-root",
                f"the {role.value} is {own:.4g} mm wide, and the plane model has the {common:.4g} mm in mesh; {carry}, "
                f"with {100 * (1 - common / rating.width):.2g} % less stress; --model 3d has the whole width",
            )


def _left_out(task: CheckTask) -> Iterator[Notice]:
    along = [role for role, gear in task.pair.gears.items() if gear.modification.along_face]
    left_out = [f"the {role.value}'s modifications along the face width" for role in along]
    left_out += ["the misalignment"] if task.mounting.tilted else []
    if left_out:
        yield Notice("left-out", f"the plane model leaves out {' and '.join(left_out)}; --model 3d has them")

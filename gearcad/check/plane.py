"""The check in the plane: one mesh cycle by finite elements, refined to tell its error, and judged."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from gearcad.check.convergence import FACTORS, FEW_POSITIONS, three_meshes
from gearcad.check.judge import compare_plane
from gearcad.check.options import Model
from gearcad.check.result import PlaneCheck, Task
from gearcad.check.summary import summarise
from gearcad.check.sweep import sweep_point
from gearcad.check.warnings import corner_warnings, general_warnings
from gearcad.fea.cycle import Cycle, run_cycle, single_stiffness
from gearcad.fea.flexible_pair import FlexiblePair, flexible_pair
from gearcad.meshing import MeshSizes

__all__ = ["PLANE_STEPS", "check_plane"]

PLANE_STEPS = ("mesh cycle", "convergence", "torque sweep", "rating")


def check_plane(task: Task, tell: Callable[[str], None]) -> PlaneCheck:
    """Check in the transverse section through the middle of the common face width. Raises what `check_pair` does."""
    tell("mesh cycle")
    model = _model(task, 1.0)
    cycle = run_cycle(model, task.torque, task.options.positions_of(Model.PLANE))
    summary = summarise(cycle, single_stiffness(model, task.torque))
    tell("convergence")
    convergence = three_meshes(_refined(task, model)) if task.options.refines else ()
    tell("torque sweep")
    sweep = tuple(sweep_point(run_cycle(model, torque, FEW_POSITIONS)) for torque in task.torques)
    tell("rating")
    comparisons = compare_plane(task, cycle, summary, convergence)
    warnings = (
        *general_warnings(task, cycle, summary.contact_pressure / model.modulus),
        *corner_warnings(cycle, summary),
        *_left_out(task),
    )
    return PlaneCheck(
        **task.inputs,
        cycle=cycle,
        summary=summary,
        sweep=sweep,
        convergence=convergence,
        comparisons=comparisons,
        warnings=warnings,
    )


def _model(task: Task, factor: float) -> FlexiblePair:
    options = task.options
    sizes = MeshSizes().refined(factor * options.refinement)
    error = task.mounting.pitch_error
    return flexible_pair(task.pair, task.material, plane=options.plane_state, body=options.body, sizes=sizes, pitch_error=error)


def _refined(task: Task, middle: FlexiblePair) -> Iterator[Cycle]:
    for factor in FACTORS:
        yield run_cycle(middle if factor == 1 else _model(task, factor), task.torque, FEW_POSITIONS)


def _left_out(task: Task) -> list[str]:
    gears = (("pinion", task.pair.pinion), ("wheel", task.pair.wheel))
    left_out = [f"the {name}'s modifications along the face width" for name, gear in gears if gear.modification.along_face]
    left_out += ["the misalignment"] if task.mounting.misalignment or task.mounting.misalignment_across else []
    return [f"the plane model leaves out {' and '.join(left_out)}; --model 3d has them"] if left_out else []

"""The check of solid bodies: one mesh cycle along lines of contact, other meshes to tell its error, and the verdict."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from gearcad.check.convergence import FEW_POSITIONS, SOLID_FACTORS, three_solid_meshes
from gearcad.check.judge_solid import compare_solid
from gearcad.check.options import Model
from gearcad.check.result import SolidCheck, Task
from gearcad.check.rim import rim_warnings
from gearcad.check.solid_summary import SolidSummary, summarise_solid
from gearcad.check.sweep import sweep_point
from gearcad.check.warnings import corner_warnings, general_warnings
from gearcad.ltca.solid_cycle import SolidCycle, run_solid_cycle, solid_single_stiffness
from gearcad.ltca.solid_pair import SolidPair, SolidSizes, loaded_left, solid_pair

__all__ = ["SOLID_STEPS", "check_solid"]

SOLID_STEPS = ("body of the pinion", "body of the wheel", "mesh cycle", "torque sweep", "convergence", "rating")

_EDGE_RATIO = 1.5
"""Pressure beside an edge, over the greatest away from edges, from which on it is worth a warning."""


def check_solid(task: Task, tell: Callable[[str], None]) -> SolidCheck:
    """Check the bodies over their face widths. Raises what `check_pair` does.

    The model's left flanks carry. A negative torque loads the right ones: the pair is then mirrored in the plane x-z, which
    turns helix angles over and leaves heights and radii as they are, and all results are those of its left flanks. The
    mounting's misalignment is always that of the flanks that carry.
    """
    model = _model(task, 1.0, lambda gear: tell(f"body of the {gear}"))
    tell("mesh cycle")
    cycle = run_solid_cycle(model, task.torque, task.options.positions_of(Model.SOLID))
    summary = summarise_solid(cycle, solid_single_stiffness(model, task.torque))
    tell("torque sweep")
    sweep = tuple(sweep_point(run_solid_cycle(model, torque, FEW_POSITIONS)) for torque in task.torques)
    tell("convergence")
    convergence = three_solid_meshes(_refined(task, model)) if task.options.refines else ()
    tell("rating")
    comparisons = compare_solid(task, cycle, summary, convergence)
    modulus = task.material.youngs_modulus / (2 * (1 - task.material.poisson_ratio**2))
    warnings = (
        *general_warnings(task, cycle, summary.contact_pressure / modulus),
        *rim_warnings(task, summary),
        *corner_warnings(cycle, summary),
        *_edge_warnings(cycle, summary),
    )
    return SolidCheck(
        **task.inputs,
        cycle=cycle,
        summary=summary,
        sweep=sweep,
        convergence=convergence,
        comparisons=comparisons,
        warnings=warnings,
    )


def _model(task: Task, factor: float, progress: Callable[[str], None] = lambda _gear: None) -> SolidPair:
    sizes = SolidSizes().refined(factor * task.options.refinement)
    pair, mounting = loaded_left(task.pair, task.torque), replace(task.mounting, centre_distance_change=0.0)
    return solid_pair(pair, task.material, body=task.body, sizes=sizes, mounting=mounting, progress=progress)


def _refined(task: Task, middle: SolidPair) -> Iterator[SolidCycle]:
    for factor in SOLID_FACTORS:
        yield run_solid_cycle(middle if factor == 1 else _model(task, factor), task.torque, FEW_POSITIONS)


def _edge_warnings(cycle: SolidCycle, summary: SolidSummary) -> list[str]:
    greatest = max(float(contact.pressures.max()) for position in cycle.positions for contact in position.contacts)
    if greatest < _EDGE_RATIO * summary.contact_pressure:
        return []
    return [
        f"beside the edges of the flanks the pressure is up to {greatest:.0f} MPa, by Hertz's formula, which no edge fits; "
        "it is "
        "left out of the verdict; reliefs and crowning would lower it"
    ]

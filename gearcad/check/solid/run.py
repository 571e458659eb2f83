"""The check of solid bodies: one mesh cycle along lines of contact, other meshes to tell its error, and the verdict."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from gearcad.check.convergence import SOLID_FACTORS, three_solid_meshes
from gearcad.check.extremes import SOLID
from gearcad.check.notices import common_notices
from gearcad.check.options import Model
from gearcad.check.relief_start import relief_starts, start_comparisons, start_notices
from gearcad.check.solid.expected import BODIES, COARSER, CYCLE, FINER, RATING, SWEEP, sizes_of
from gearcad.check.solid.judge import compare_solid
from gearcad.check.solid.pictures import tooth_stresses
from gearcad.check.solid.result import SolidCheck
from gearcad.check.solid.room import require_room
from gearcad.check.solid.summary import SolidSummary, summarise_solid
from gearcad.check.sweep import sweep_points
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded_left import loaded_left
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.limits import wide_contacts
from gearcad.contact.solid.pair import SolidPair, solid_pair
from gearcad.notice import Notice
from gearcad.progress import Agenda, Share, unheard

__all__ = ["check_solid", "solid_model"]

_EDGE_RATIO = 1.5
"""Pressure beside an edge, over the greatest away from edges, from which on it is worth a warning."""


def check_solid(task: CheckTask, agenda: Agenda) -> SolidCheck:
    """Check the bodies over their face widths. Raises what `check_pair` does.

    The model's left flanks carry. A negative torque loads the right ones: the pair is then mirrored in the plane x-z, which
    turns helix angles over and leaves heights and radii as they are, and all results are those of its left flanks. The
    mounting's misalignment is always that of the flanks that carry.
    """
    require_room(task)
    model = solid_model(task, 1.0, agenda.within(BODIES), fields=True)
    positions = task.options.positions_of(Model.SOLID)
    cycle = SolidCycle.run(model, task.torque, positions, agenda.counted(CYCLE, "position")).searched(SOLID)
    summary, stresses = summarise_solid(cycle, model.single_stiffness(task.torque)), tooth_stresses(cycle)
    starts = relief_starts(cycle)
    model.let_go()
    agenda(SWEEP)
    sweep = sweep_points(cycle, task.torques)
    convergence = three_solid_meshes(_refined(task, cycle, agenda)) if task.options.refines else ()
    agenda(RATING)
    comparisons = (*compare_solid(task, cycle, summary, convergence), *start_comparisons(task, starts))
    notices = (
        *common_notices(task, cycle, summary),
        *_edge_notices(task, cycle, summary),
        *wide_contacts(cycle),
        *start_notices(task, starts),
    )
    return SolidCheck(
        task=task,
        cycle=cycle,
        summary=summary,
        tooth_stresses=stresses,
        sweep=sweep,
        convergence=convergence,
        comparisons=comparisons,
        notices=notices,
        relief_starts=starts,
    )


def solid_model(task: CheckTask, factor: float = 1.0, tell: Share = unheard, *, fields: bool = False) -> SolidPair:
    """Both bodies of a task, their elements `factor` times smaller than it asks for; left flanks carry.

    They keep what `fields` of teeth need if these are asked for. Raises what `check_pair` does.
    """
    sizes = sizes_of(task, factor)
    pair, mounting = loaded_left(task.pair, task.torque), replace(task.mounting, centre_distance_change=0.0)
    return solid_pair(pair, task.material, body=task.body, sizes=sizes, mounting=mounting, fields=fields, tell=tell)


def _refined(task: CheckTask, middle: SolidCycle, agenda: Agenda) -> Iterator[SolidCycle]:
    """Yield the cycles of coarser, own and finer bodies at as many positions; none but the own bodies are kept."""
    coarser, _, finer = SOLID_FACTORS
    yield _cycle(solid_model(task, coarser, agenda.within(COARSER)), task)
    yield middle
    yield _cycle(solid_model(task, finer, agenda.within(FINER)), task)


def _cycle(model: SolidPair, task: CheckTask) -> SolidCycle:
    return SolidCycle.run(model, task.torque, task.options.positions_of(Model.SOLID)).searched(SOLID)


def _edge_notices(task: CheckTask, cycle: SolidCycle, summary: SolidSummary) -> Iterator[Notice]:
    greatest = max(contact.edge_pressure for _, contact in cycle.contacts)
    if summary.contact_pressure is None or greatest >= _EDGE_RATIO * summary.contact_pressure:
        modified = any(gear.modification.present for gear in task.pair.gears)
        advice = "the modifications given do not prevent it" if modified else "reliefs and crowning would lower it"
        yield Notice(
            "edge-pressure",
            f"beside the edges of the flanks the pressure is up to {greatest:.0f} MPa, by Hertz's formula, which no edge fits; "
            f"it is left out of the verdict; {advice}",
        )

"""Decks of a pair: its teeth under its load as input that CalculiX runs, and what our own check finds of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from gearcad.check.options import CheckOptions, Model
from gearcad.check.task import CheckTask, check_task
from gearcad.decks.pair import PairDecks
from gearcad.decks.plane import PlaneDecks
from gearcad.designs import PairDesign
from gearcad.material import Material
from gearcad.meshing.options import MeshOptions
from gearcad.meshing.plan import MeshPlan
from gearcad.meshing.result import Deck
from gearcad.progress import Agenda, Progress

__all__ = ["make_decks"]


def make_decks(design: PairDesign, plan: MeshPlan, progress: Progress | None) -> dict[str, Deck]:
    """The decks that the options of a plan ask for, by the names of their files: one for each position.

    Raises ParameterError, GeometryError and SolverError for what cannot be checked.
    """
    if not plan.options.decks:
        return {}
    angles = dict(_positions(plan.options, design))
    agenda = Agenda(progress, dict.fromkeys(angles, 1.0))
    decks = _decks(_task(design, plan))
    made: dict[str, Deck] = {}
    for name, angle in angles.items():
        agenda(name)
        made[name] = decks.at(angle)
    return made


def _positions(options: MeshOptions, design: PairDesign) -> Iterator[tuple[str, float]]:
    """Names of files and roll angles (deg): that of the options, or so many evenly over one base pitch around it."""
    count, pitch = options.positions, 360 / design.pair.pinion.teeth
    for number in range(count):
        name = "pair_deck.inp" if count == 1 else f"pair_deck_{number + 1:0{len(str(count))}}.inp"
        yield name, options.roll + pitch * ((number + 0.5) / count - 0.5)


def _task(design: PairDesign, plan: MeshPlan) -> CheckTask:
    options = replace(design.check or CheckOptions(), model=Model.PLANE.value)
    load = design.loaded("a deck is of pressed flanks")
    return check_task(design.pair, design.material or Material(), load, options, design.mounting, design.rating)


def _decks(task: CheckTask) -> PairDecks:
    return PlaneDecks(task)
